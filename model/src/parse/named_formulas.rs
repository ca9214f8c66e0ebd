//! Formulas that have a name, in whatever order the model file has them.

use super::expression;
use super::formulas::{self, Inputs};
use super::laws;
use super::lookup::wrong_within;
use super::numbers::broken;
use super::reader::Reader;
use super::section::{Item, Section};
use super::{names, tables};
use crate::Formula;
use crate::validate::{Owner, Place};

/// A formula whose names may not be known yet.
struct Pending<'t> {
    name: String,
    item: Item<'t>,
    text: &'t str,
    names: Vec<String>,
}

impl Pending<'_> {
    fn needs(&self, other: &Self) -> bool {
        self.names.contains(&other.name)
    }
}

/// Reads all formulas, each once those that it names are known. One that is wrong, or in a circle, is zero in others.
pub(super) fn read(reader: &mut Reader<'_>, page: &Section<'_>) {
    let mut pending: Vec<Pending<'_>> = Vec::new();
    for (index, (section, name)) in
        tables::each(reader, page, "formula", Owner::Formula).into_iter().enumerate()
    {
        unlike_numbers(reader, Owner::Formula(index), ("formula", &name));
        let Some(item) = section.find(reader, "of") else { continue };
        let Some(text) = item.text(reader) else { continue };
        match expression::parse(text) {
            Ok(term) => {
                let names = term.names().into_iter().map(str::to_owned).collect();
                pending.push(Pending { name, item, text, names });
            }
            Err(at) => broken(reader, item, text, at),
        }
    }
    while !pending.is_empty() {
        let waits = |one: &Pending<'_>| pending.iter().any(|other| one.needs(other));
        if let Some(at) = pending.iter().position(|one| !waits(one)) {
            let one = pending.remove(at);
            let known = reader.visible.clone();
            let read = laws::with_names(reader, &known, Inputs::Known, &formulas::any, |named| {
                named.formula(one.text)
            });
            let formula = read.unwrap_or_else(|fault| {
                wrong_within(reader, one.item, one.text, fault);
                Formula::zero()
            });
            reader.formulas.push((one.name, formula));
        } else {
            refuse_circle(reader, &mut pending);
        }
    }
}

/// All wait, so each names another that does: from one to the next until one comes again.
fn refuse_circle(reader: &mut Reader<'_>, pending: &mut Vec<Pending<'_>>) {
    let next = |at: usize| pending.iter().position(|other| pending[at].needs(other)).unwrap_or(at);
    let first = (0..pending.len()).fold(0, |at, _| next(at));
    let mut circle = vec![first];
    while next(circle[circle.len() - 1]) != first {
        circle.push(next(circle[circle.len() - 1]));
    }
    circle.sort_unstable();
    let members: Vec<&str> = circle.iter().map(|&at| pending[at].name.as_str()).collect();
    let message = match members.as_slice() {
        [one] => format!("the formula `{one}` names itself"),
        many => format!("the formulas {} name one another", names::list(many)),
    };
    let help = "write one of them without the others".to_owned();
    pending[circle[0]].item.wrong(reader, [message, "a circle".to_owned(), help]);
    for at in circle.into_iter().rev() {
        let one = pending.remove(at);
        reader.formulas.push((one.name, Formula::zero()));
    }
}

/// In formulas a name has one meaning.
pub(super) fn unlike_numbers(reader: &mut Reader<'_>, owner: Owner, (what, name): (&str, &str)) {
    let derived = reader.derived.iter().any(|(other, _)| other == name);
    if !derived && !reader.parameters.iter().chain(&reader.inputs).any(|other| other == name) {
        return;
    }
    let place = Place { owner, key: "name" };
    let words = [
        format!("`{name}` names a {what}, and a parameter or an input"),
        "used again".to_owned(),
        "choose another name".to_owned(),
    ];
    let span = reader.span(place);
    reader.wrong(place, span, words);
}
