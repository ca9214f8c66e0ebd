//! Sampled controllers.

use num_traits::{One, Signed, ToPrimitive, Zero};
use toml::de::DeValue;

use super::names;
use super::numbers::numbers;
use super::reader::Reader;
use super::section::{Item, Section, all};
use super::seen::{self, Known};
use super::tables;
use crate::diagnostics::Related;
use crate::validate::{Owner, Place, rounded};
use crate::{Controller, Law, Number, Output, Rational};

/// Reads all controllers.
pub(super) fn read(reader: &mut Reader<'_>, page: &Section<'_>, outputs: &[Output]) -> Vec<Controller> {
    let known = seen::known(reader, outputs);
    let sections = tables::each(reader, page, "controller", Owner::Controller).into_iter();
    let controllers: Vec<Controller> =
        sections.map(|(section, name)| controller(reader, section, &known, name)).collect();
    shared(reader, &controllers);
    controllers
}

fn controller(reader: &mut Reader<'_>, mut section: Section<'_>, known: &Known, name: String) -> Controller {
    let kind = section.read_kind(reader, |_, _| None);
    let outputs =
        words(reader, &section, "outputs", |reader, item, word| seen::named(reader, item, word, known));
    let inputs = words(reader, &section, "inputs", input);
    let sizes = outputs.as_ref().map(Vec::len).zip(inputs.as_ref().map(Vec::len));
    let n_outputs = sizes.map_or(1, |sizes| sizes.0);
    let law = law(reader, &section, (kind.map(|kind| kind.word), sizes));
    let period = period(reader, &section);
    let [setpoints, output_steps] = ["setpoint", "output_step"].map(|key| {
        let given = section.each(reader, key, n_outputs);
        given.unwrap_or_else(|| vec![Number::integer(0); n_outputs])
    });
    Controller {
        law,
        outputs: outputs.unwrap_or_default(),
        inputs: inputs.unwrap_or_default(),
        delay: delay(reader, &section, period.as_ref()),
        period: period.as_ref().and_then(fraction).unwrap_or([1, 1]),
        setpoints,
        limits: section.given_vector(reader, "limits"),
        output_steps,
        input_step: section.number(reader, "input_step"),
        name,
    }
}

/// What each name of an array means.
fn words<T>(
    reader: &mut Reader<'_>,
    section: &Section<'_>,
    key: &'static str,
    meaning: impl Fn(&mut Reader<'_>, Item<'_>, &str) -> Option<T>,
) -> Option<Vec<T>> {
    let item = section.find(reader, key)?;
    let words = item.texts(reader, "an array of names")?;
    if !(1..=Controller::MOST).contains(&words.len()) {
        let help = format!("write one to {} names", Controller::MOST);
        let message = format!("a controller with {} {key}", words.len());
        item.wrong(reader, [message, format!("found {}", words.len()), help]);
        return None;
    }
    all(words.into_iter().map(|(item, word)| meaning(reader, item, word)))
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
    (kind, sizes): (Option<&str>, Option<(usize, usize)>),
) -> Law {
    match kind {
        Some("state_feedback") => Law::StateFeedback { gains: gains(reader, section, sizes) },
        Some("transfer_function") => {
            single(reader, section, "transfer function", sizes);
            let [numerator, denominator] = ["numerator", "denominator"].map(|key| {
                let item = section.find(reader, key);
                item.and_then(|item| coefficients(reader, item)).unwrap_or_else(|| vec![Number::integer(1)])
            });
            Law::TransferFunction { numerator, denominator }
        }
        _ => {
            const GAINS: [&str; 3] = ["kp", "ki", "kd"];
            if kind.is_some() {
                single(reader, section, "PID law", sizes);
                if !GAINS.iter().any(|key| section.has(key)) {
                    section.require(reader, "kp");
                }
            }
            Law::Pid { gains: GAINS.map(|key| section.number(reader, key)) }
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

fn gains(reader: &mut Reader<'_>, section: &Section<'_>, sizes: Option<(usize, usize)>) -> Vec<Vec<Number>> {
    let item = section.find(reader, "gains");
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
    item.wrong_type_with(reader, &what, format!("write {} = [1, -0.5]", item.key.name));
    None
}

/// The period, s, from itself or from a frequency.
fn period(reader: &mut Reader<'_>, section: &Section<'_>) -> Option<Rational> {
    let title = &section.title;
    let twice = format!("{title} has a frequency and a period");
    let item = section.either(reader, ["period", "frequency_hz"], &twice);
    let item = item.or_else(|| section.require(reader, "frequency_hz"))?;
    let key = item.key.name;
    let value = section.plain(reader, key)?;
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
    let item = section.get("delay").zip(section.plain(reader, "delay"));
    let Some((item, delay)) = item else { return Rational::zero() };
    let longest = period.cloned().unwrap_or_else(|| delay.abs());
    if delay.is_negative() || delay > &longest * (Rational::one() + rounded()) {
        let label = format!("{} s", crate::to_f64(&delay));
        let help = format!("write a time between 0 and the period, {} s", crate::to_f64(&longest));
        item.wrong(reader, ["a delay is not negative and not longer than a period".to_owned(), label, help]);
        return Rational::zero();
    }
    delay.min(longest)
}
