//! What names of numbers mean, and where in a string something is wrong.

use super::computed::Fault;
use super::reader::Reader;
use super::section::Item;
use crate::Number;

/// What the model file calls by a name.
pub(super) fn named(reader: &Reader<'_>, name: &str) -> Option<Number> {
    let parameter = reader.parameters.iter().position(|p| p == name);
    let derived = || reader.derived.iter().find(|(p, _)| p == name).map(|(_, number)| number.clone());
    parameter.map(|index| Number::Parameter { index, negated: false }).or_else(derived)
}

/// Reports what is wrong with a part of an expression.
pub(super) fn wrong_within(reader: &mut Reader<'_>, item: Item<'_>, text: &str, fault: Fault) {
    let span = reader.within(&item.span(), text, &fault.span);
    reader.wrong(item.place, span, fault.words);
}
