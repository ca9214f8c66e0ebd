//! Sampled controllers.

use num_traits::{One, Signed, ToPrimitive, Zero};
use toml::de::{DeTable, DeValue};

use super::names;
use super::numbers::{number, numbers, plain_number};
use super::reader::Reader;
use super::section::{self, Item, Section};
use super::seen::{self, Known};
use super::tables;
use crate::diagnostics::Related;
use crate::validate::{Owner, Place, rounded};
use crate::{Controller, Law, Number, Output, Rational, Seen};

const KEYS: [&str; 17] = [
    "name",
    "kind",
    "outputs",
    "inputs",
    "frequency_hz",
    "period",
    "delay",
    "setpoint",
    "limits",
    "output_step",
    "input_step",
    "kp",
    "ki",
    "kd",
    "gains",
    "numerator",
    "denominator",
];

/// Keys of all kinds.
macro_rules! with_common {
    ($($own:literal),*) => {
        &[
            "outputs", "inputs", "frequency_hz", "period", "delay", "setpoint", "limits", "output_step",
            "input_step", $($own),*
        ]
    };
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Pid,
    StateFeedback,
    TransferFunction,
}

const KINDS: [(&str, Kind); 3] = [
    ("pid", Kind::Pid),
    ("state_feedback", Kind::StateFeedback),
    ("transfer_function", Kind::TransferFunction),
];

const KINDS_KEYS: section::Kinds<'static> = &[
    ("pid", with_common!("kp", "ki", "kd")),
    ("state_feedback", with_common!("gains")),
    ("transfer_function", with_common!("numerator", "denominator")),
];

/// Reads all controllers.
pub(super) fn read(reader: &mut Reader<'_>, page: &Section<'_>, outputs: &[Output]) -> Vec<Controller> {
    let tables = tables::tables(reader, page, "controller");
    let names = tables::names(reader, &tables, Owner::Controller, "controller");
    let known = seen::known(&reader.joints, outputs);
    let named = tables.iter().zip(names).enumerate();
    let controllers: Vec<Controller> = named
        .map(|(index, ((_, table), name))| {
            let name = name.unwrap_or_else(|| format!("controller {}", index + 1));
            controller(reader, (index, table), &known, name)
        })
        .collect();
    shared(reader, &controllers);
    controllers
}

fn controller(
    reader: &mut Reader<'_>,
    (index, table): (usize, &DeTable<'_>),
    known: &Known,
    name: String,
) -> Controller {
    let title = format!("controller `{name}`");
    let section = Section::open(reader, Owner::Controller(index), &title, table, &KEYS);
    let kind = section.require_choice(reader, "kind", &title, ("kind of controller", &KINDS));
    if let Some((word, _)) = KINDS.iter().find(|(_, other)| Some(*other) == kind) {
        section::refuse_others(reader, &section, &KEYS, (word, KINDS_KEYS));
    }
    let example = "outputs = [\"...\"]: joint coordinates, their rates, numbers of outputs";
    let outputs = section.require(reader, "outputs", &title, example);
    let outputs: Option<Vec<Seen>> = outputs.and_then(|item| {
        let all = words(reader, item)?.into_iter().map(|(item, word)| seen::named(reader, item, word, known));
        all.collect::<Vec<_>>().into_iter().collect()
    });
    let example = "inputs = [\"...\"], names of [inputs]";
    let inputs = section.require(reader, "inputs", &title, example);
    let inputs: Option<Vec<usize>> = inputs.and_then(|item| {
        let all = words(reader, item)?.into_iter().map(|(item, word)| input(reader, item, word));
        all.collect::<Vec<_>>().into_iter().collect()
    });
    let sizes = outputs.as_ref().map(Vec::len).zip(inputs.as_ref().map(Vec::len));
    let n_outputs = sizes.map_or(1, |sizes| sizes.0);
    let law = law(reader, &section, &title, (kind, sizes));
    let period = period(reader, &section, &title);
    let [setpoints, output_steps] =
        ["setpoint", "output_step"].map(|key| each(reader, &section, key, n_outputs));
    Controller {
        law,
        outputs: outputs.unwrap_or_default(),
        inputs: inputs.unwrap_or_default(),
        delay: delay(reader, &section, period.as_ref()),
        period: period.as_ref().and_then(fraction).unwrap_or([1, 1]),
        setpoints,
        limits: section
            .get("limits")
            .and_then(|item| numbers(reader, item, 2))
            .and_then(|l| l.try_into().ok()),
        output_steps,
        input_step: section.number_or(reader, "input_step", 0),
        name,
    }
}

/// An array of names.
fn words<'t>(reader: &mut Reader<'_>, item: Item<'t>) -> Option<Vec<(Item<'t>, &'t str)>> {
    let key = item.key();
    let elements = item.value.get_ref().as_array();
    let words = elements.and_then(|elements| {
        let word = |value| Some((Item { value, ..item }, value.get_ref().as_str()?));
        elements.iter().map(word).collect::<Option<Vec<_>>>()
    });
    let Some(words) = words else {
        item.wrong_type(reader, "an array of names", &format!("{key} = [\"...\"]"));
        return None;
    };
    if !(1..=Controller::MOST).contains(&words.len()) {
        let help = format!("write one to {} names", Controller::MOST);
        item.wrong(
            reader,
            [format!("a controller with {} {key}", words.len()), format!("found {}", words.len()), help],
        );
        return None;
    }
    Some(words)
}

fn input(reader: &mut Reader<'_>, item: Item<'_>, word: &str) -> Option<usize> {
    let index = reader.inputs.iter().position(|input| input == word);
    if index.is_none() {
        let known: Vec<&str> = reader.inputs.iter().map(String::as_str).collect();
        let help = match known.as_slice() {
            [] => format!("declare it: [inputs] on a line of its own, then {word} = 0"),
            known => format!("{}, or declare `{word}` under [inputs]", names::instead(word, known)),
        };
        item.wrong(reader, [format!("there is no input `{word}`"), "no such input".to_owned(), help]);
    }
    index
}

/// An input has one value.
fn shared(reader: &mut Reader<'_>, controllers: &[Controller]) {
    for (index, controller) in controllers.iter().enumerate() {
        for (k, input) in controller.inputs.iter().enumerate() {
            let earlier = controllers[..index].iter().position(|other| other.inputs.contains(input));
            let place = |index| Place { owner: Owner::Controller(index), key: "inputs" };
            let name = reader.inputs[*input].clone();
            let label = "set again".to_owned();
            let span = reader.span(place(index));
            if let Some(first) = earlier {
                let related = Related { span: reader.span(place(first)), label: "set here".to_owned() };
                let words = [
                    format!("two controllers set the input `{name}`"),
                    label,
                    "let each set an input of its own: two motors at one joint add up".to_owned(),
                ];
                reader.clash(place(index), span, related, words);
            } else if controller.inputs[..k].contains(input) {
                let help = "name it once".to_owned();
                let title = format!("controller `{}` sets the input `{name}` twice", controller.name);
                reader.wrong(place(index), span, [title, label, help]);
            }
        }
    }
}

fn law(
    reader: &mut Reader<'_>,
    section: &Section<'_>,
    title: &str,
    (kind, sizes): (Option<Kind>, Option<(usize, usize)>),
) -> Law {
    match kind {
        Some(Kind::StateFeedback) => Law::StateFeedback { gains: gains(reader, section, title, sizes) },
        Some(Kind::TransferFunction) => {
            single(reader, section, "transfer function", sizes);
            let [numerator, denominator] = ["numerator", "denominator"].map(|key| {
                let item = section.require(reader, key, title, &format!("{key} = [...], powers of 1/z"));
                item.and_then(|item| coefficients(reader, item)).unwrap_or_else(|| vec![Number::integer(1)])
            });
            Law::TransferFunction { numerator, denominator }
        }
        _ => {
            if kind.is_some() {
                single(reader, section, "PID law", sizes);
                if !["kp", "ki", "kd"].iter().any(|key| section.has(key)) {
                    section.require(reader, "kp", title, "kp = ..., and ki and kd as far as they are not 0");
                }
            }
            Law::Pid { gains: ["kp", "ki", "kd"].map(|key| section.number_or(reader, key, 0)) }
        }
    }
}

/// Laws of one output and one input.
fn single(reader: &mut Reader<'_>, section: &Section<'_>, what: &str, sizes: Option<(usize, usize)>) {
    let Some((n_outputs, n_inputs)) = sizes else { return };
    for (key, found) in [("outputs", n_outputs), ("inputs", n_inputs)] {
        if let Some(item) = section.get(key).filter(|_| found != 1) {
            let help = format!("write one name; several {key} are for kind = \"state_feedback\"");
            let message = format!("a {what} has one output and one input");
            item.wrong(reader, [message, format!("found {found} {key}"), help]);
        }
    }
}

fn gains(
    reader: &mut Reader<'_>,
    section: &Section<'_>,
    title: &str,
    sizes: Option<(usize, usize)>,
) -> Vec<Vec<Number>> {
    let example = "gains = [[...]]: a row for each input, in it a number for each output";
    let item = section.require(reader, "gains", title, example);
    let (Some(item), Some((n_outputs, n_inputs))) = (item, sizes) else { return Vec::new() };
    let rows = item.value.get_ref().as_array().filter(|rows| rows.len() == n_inputs);
    let is_row = |value: &DeValue<'_>| value.as_array().is_some_and(|row| row.len() == n_outputs);
    let Some(rows) = rows.filter(|rows| rows.iter().all(|row| is_row(row.get_ref()))) else {
        let row = format!("[{}]", vec!["0"; n_outputs].join(", "));
        let what =
            format!("a matrix of {n_inputs} by {n_outputs}: a row for each input, a column for each output");
        let example = vec![row; n_inputs].join(", ");
        item.wrong_type_with(reader, &what, format!("write [{example}] in place of this, with your numbers"));
        return Vec::new();
    };
    let rows = rows.iter().map(|value| numbers(reader, Item { value, ..item }, n_outputs));
    rows.map(|row| row.unwrap_or_else(|| vec![Number::integer(0); n_outputs])).collect()
}

/// Coefficients of powers of 1/z.
fn coefficients(reader: &mut Reader<'_>, item: Item<'_>) -> Option<Vec<Number>> {
    let length = item.value.get_ref().as_array().map_or(0, |elements| elements.len());
    if (1..=Controller::MOST + 1).contains(&length) {
        return numbers(reader, item, length);
    }
    let what = format!("an array of 1 to {} numbers, powers of 1/z", Controller::MOST + 1);
    item.wrong_type(reader, &what, &format!("{} = [1, -0.5]", item.key()));
    None
}

/// A number for each output: one for all, or an array; zero unless given.
fn each(reader: &mut Reader<'_>, section: &Section<'_>, key: &'static str, n_outputs: usize) -> Vec<Number> {
    let found = section.get(key).and_then(|item| match item.value.get_ref() {
        DeValue::Array(_) => numbers(reader, item, n_outputs),
        _ => number(reader, item).map(|one| vec![one; n_outputs]),
    });
    found.unwrap_or_else(|| vec![Number::integer(0); n_outputs])
}

/// The period, s, from itself or from a frequency.
fn period(reader: &mut Reader<'_>, section: &Section<'_>, title: &str) -> Option<Rational> {
    if section.has("period") {
        let help = "remove one of the two: a period is one over a frequency";
        section.refuse(reader, "frequency_hz", &format!("{title} has a frequency and a period"), help);
    }
    let key = if section.has("period") { "period" } else { "frequency_hz" };
    let item = section.require(reader, key, title, "frequency_hz = 1000, or period = 0.001")?;
    let value = plain_number(reader, item)?;
    if !value.is_positive() {
        let unit = if key == "period" { "s" } else { "Hz" };
        let label = format!("{} {unit}", crate::to_f64(&value));
        let help = format!("write a {} greater than 0", if key == "period" { "time" } else { "frequency" });
        item.wrong(reader, [format!("the `{key}` of {title} is not positive"), label, help]);
        return None;
    }
    let period = if key == "period" { value } else { Rational::one() / value };
    if fraction(&period).is_none() {
        let help = "write it with fewer digits, or as a fraction such as \"1/3000\"".to_owned();
        let message = format!("the `{key}` of {title} is no fraction of whole numbers below 2^53");
        item.wrong(reader, [message, "its times could not be told exactly".to_owned(), help]);
        return None;
    }
    Some(period)
}

/// A period as whole numbers that are exact in `f64`.
fn fraction(period: &Rational) -> Option<[u64; 2]> {
    let exact = |n: Option<u64>| n.filter(|n| *n < 1 << 53);
    exact(period.numer().to_u64()).zip(exact(period.denom().to_u64())).map(|(n, d)| [n, d])
}

fn delay(reader: &mut Reader<'_>, section: &Section<'_>, period: Option<&Rational>) -> Rational {
    let Some(item) = section.get("delay") else { return Rational::zero() };
    let Some(delay) = plain_number(reader, item) else { return Rational::zero() };
    let longest = period.cloned().unwrap_or_else(|| delay.abs());
    if delay.is_negative() || delay > &longest * (Rational::one() + rounded()) {
        let label = format!("{} s", crate::to_f64(&delay));
        let help = format!("write a time between 0 and the period, {} s", crate::to_f64(&longest));
        item.wrong(reader, ["a delay is not negative and not longer than a period".to_owned(), label, help]);
        return Rational::zero();
    }
    delay.min(longest)
}
