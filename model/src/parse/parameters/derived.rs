//! Parameters that are computed from others, in whatever order the model file has them.

use super::{Entry, VALUE, name};
use crate::parse::expression::{self, Term};
use crate::parse::lookup::named;
use crate::parse::names;
use crate::parse::numbers::computed;
use crate::parse::reader::Reader;
use crate::parse::section::Item;
use crate::validate::{Owner, Place};
use crate::{DerivedParameter, Number};

/// An entry whose names may not be known yet.
struct Pending<'t> {
    name: String,
    text: &'t str,
    term: Term,
    item: Item<'t>,
}

impl Pending<'_> {
    fn needs(&self, name: &str) -> bool {
        self.term.names().contains(&name)
    }
}

/// Computes each once all that it names is known. What is wrong, or in a circle, stands as 1 in what names it.
pub(super) fn read(reader: &mut Reader<'_>, entries: &[Entry<'_>]) -> Vec<DerivedParameter> {
    let mut pending: Vec<Pending<'_>> = Vec::new();
    for (index, &entry) in entries.iter().enumerate() {
        let place = Place { owner: Owner::DerivedParameter(index), key: "" };
        let name = name(reader, place, entry);
        let text = entry.1.get_ref().as_str().unwrap_or_default();
        if let Ok(term) = expression::parse(text) {
            pending.push(Pending { name, text, term, item: Item { place, key: VALUE, value: entry.1 } });
        }
    }
    let order: Vec<String> = pending.iter().map(|entry| entry.name.clone()).collect();
    let mut derived = Vec::new();
    while !pending.is_empty() {
        let waits = |entry: &Pending<'_>| pending.iter().any(|other| entry.needs(&other.name));
        match pending.iter().position(|entry| !waits(entry)) {
            Some(at) => derived.extend(compute(reader, &pending.remove(at))),
            None => refuse_circle(reader, &mut pending),
        }
    }
    derived.sort_by_key(|parameter: &DerivedParameter| order.iter().position(|name| *name == parameter.name));
    derived
}

fn compute(reader: &mut Reader<'_>, entry: &Pending<'_>) -> Option<DerivedParameter> {
    let number = computed(reader, entry.item, entry.text);
    reader.derived.push((entry.name.clone(), number.clone().unwrap_or_else(|| Number::integer(1))));
    number.map(|number| DerivedParameter { name: entry.name.clone(), text: entry.text.to_owned(), number })
}

/// Follows names from entry to entry until one comes again: all wait, so each names another that does.
fn refuse_circle(reader: &mut Reader<'_>, pending: &mut Vec<Pending<'_>>) {
    let next = |at: usize| pending.iter().position(|other| pending[at].needs(&other.name)).unwrap_or(at);
    let on_circle = (0..pending.len()).fold(0, |at, _| next(at));
    let mut circle = vec![on_circle];
    while next(circle[circle.len() - 1]) != on_circle {
        circle.push(next(circle[circle.len() - 1]));
    }
    circle.sort_unstable();
    let first = circle[0];
    let members: Vec<&str> = circle.iter().map(|&at| pending[at].name.as_str()).collect();
    let message = match members.as_slice() {
        [one] => format!("the parameter `{one}` is computed from itself"),
        many => format!("the parameters {} are computed from one another", names::list(many)),
    };
    let words = [message, "a circle".to_owned(), "write the number of one of them".to_owned()];
    pending[first].item.wrong(reader, words);
    for at in circle.into_iter().rev() {
        let entry = pending.remove(at);
        debug_assert!(named(reader, &entry.name).is_none());
        reader.derived.push((entry.name, Number::integer(1)));
    }
}
