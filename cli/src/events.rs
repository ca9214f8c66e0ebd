//! Events of a run: what is looked for, and the list of what was found.

use crate::args::EventSetting;
use crate::contacts;
use crate::failure::Failure;
use crate::formulas::formula;
use crate::words::{count, number, table};
use gyro_model::{Direction, Event, Model, Number};
use gyro_runner::{Occurrence, Watch, What};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// Adds the events of the command line to those of a model.
pub(crate) fn add(model: &mut Model, given: &[EventSetting]) -> Result<(), Failure> {
    for setting in given {
        let refused = |words: String| Failure::Usage(format!("--event {}: {words}", setting.text));
        let event = Event {
            name: setting.text.clone(),
            of: model.formula(&setting.of).map_err(refused)?,
            level: Number::Exact(setting.level.clone()),
            direction: setting.direction,
            stops: setting.stops,
        };
        model.events.push(event);
    }
    if model.events.len() > Event::MOST {
        let found = count(model.events.len() as u64, "event");
        let most = Event::MOST;
        return Err(Failure::Usage(format!("a run looks for at most {most} events, and there are {found}")));
    }
    Ok(())
}

/// What a run of a model looks for.
pub(crate) fn watches(model: &Model) -> Vec<Watch> {
    let one = |event: &Event| Watch {
        of: formula(model, &event.of),
        level: model.value(&event.level),
        rising: event.direction != Direction::Falling,
        falling: event.direction != Direction::Rising,
        stops: event.stops,
    };
    model.events.iter().map(one).collect()
}

/// Refuses a model whose events end runs.
pub(crate) fn refuse_stops(model: &Model, what: &str) -> Result<(), Failure> {
    match model.events.iter().find(|event| event.stops) {
        None => Ok(()),
        Some(event) => Err(Failure::Usage(format!(
            "{what} cannot end runs at events yet, and `{}` has the event `{}`: take its `stop` out of the model file",
            model.name, event.name
        ))),
    }
}

/// Events that a page marks at most.
const SHOWN: usize = 2000;

/// An occurrence in words: whose it is, what, and the rates before and after where there are some.
struct Told<'m> {
    name: &'m str,
    what: &'static str,
    rates: Option<[f64; 2]>,
}

fn told<'m>(model: &'m Model, occurrence: &Occurrence) -> Told<'m> {
    let of_contact = |contact: usize, what| Told { name: contacts::name(model, contact), what, rates: None };
    match occurrence.what {
        What::Crossed { event, rises } => {
            let what = if rises { "rises" } else { "falls" };
            Told { name: &model.events[event].name, what, rates: None }
        }
        What::Hit { contact, before, after } => {
            let what = if before > 0.0 { "hits upper" } else { "hits lower" };
            Told { rates: Some([before, after]), ..of_contact(contact, what) }
        }
        What::Kinks { path, before, after } => {
            let name = model.lines().get(path).map_or("", |(name, _)| name);
            Told { name, what: "jumps", rates: Some([before, after]) }
        }
        What::Rests { contact } => of_contact(contact, "rests"),
        What::Leaves { contact } => of_contact(contact, "leaves"),
        What::Sticks { contact } => of_contact(contact, "sticks"),
        What::Slips { contact } => of_contact(contact, "slips"),
    }
}

/// When what happened, for pages: each of the run's events.
pub(crate) fn times(model: &Model, occurrences: &[Occurrence]) -> Vec<(f64, String)> {
    let one = |occurrence: &Occurrence| {
        let told = told(model, occurrence);
        (occurrence.t, format!("{} {}", told.name, told.what))
    };
    occurrences.iter().take(SHOWN).map(one).collect()
}

/// For each event and what it did: how often, when first and when last.
pub(crate) fn text(model: &Model, occurrences: &[Occurrence]) -> String {
    let mut kinds: Vec<(Told<'_>, u64, [f64; 2])> = Vec::new();
    let mut places = BTreeMap::new();
    for occurrence in occurrences {
        let told = told(model, occurrence);
        let place = *places.entry((told.name, told.what)).or_insert(kinds.len());
        match kinds.get_mut(place) {
            Some((_, times, [_, last])) => (*times, *last) = (*times + 1, occurrence.t),
            None => kinds.push((told, 1, [occurrence.t; 2])),
        }
    }
    if kinds.is_empty() {
        return String::new();
    }
    let row = |(told, times, [first, last]): &(Told<'_>, u64, [f64; 2])| {
        let when = match times {
            1 => format!("at t = {} s", number(*first, 12)),
            _ => format!("at t = {} s, last at t = {} s", number(*first, 12), number(*last, 12)),
        };
        vec![told.name.to_owned(), told.what.to_owned(), count(*times, "time"), when]
    };
    format!("\nevents\n{}", table(&kinds.iter().map(row).collect::<Vec<_>>()))
}

/// The event that a run has ended at, if it has.
pub(crate) fn end<'m>(model: &'m Model, occurrences: &[Occurrence]) -> Option<&'m str> {
    let What::Crossed { event, .. } = occurrences.last()?.what else { return None };
    model.events[event].stops.then_some(model.events[event].name.as_str())
}

/// All occurrences, in order of time.
pub(crate) fn object(model: &Model, occurrences: &[Occurrence]) -> Value {
    let one = |occurrence: &Occurrence| {
        let told = told(model, occurrence);
        json!({ "t": occurrence.t, "name": told.name, "what": told.what, "rates": told.rates })
    };
    occurrences.iter().map(one).collect()
}

/// The same as a table.
pub(crate) fn csv(model: &Model, occurrences: &[Occurrence]) -> String {
    let mut text = "t [s],event,what,rate before,rate after\n".to_owned();
    for occurrence in occurrences {
        let told = told(model, occurrence);
        let _ = write!(text, "{:.16e},{},{}", occurrence.t, told.name, told.what);
        match told.rates {
            Some([before, after]) => _ = writeln!(text, ",{before:.16e},{after:.16e}"),
            None => text.push_str(",,\n"),
        }
    }
    text
}
