//! Pieces of text: lists, and functions that set something.

use gyro_model::Parameter;
use std::fmt::Display;

pub(super) fn list<T: Display>(items: impl IntoIterator<Item = T>) -> String {
    items.into_iter().map(|item| item.to_string()).collect::<Vec<_>>().join(", ")
}

pub(super) fn lines<T: Display>(items: impl IntoIterator<Item = T>) -> String {
    items.into_iter().map(|item| item.to_string()).collect::<Vec<_>>().join(" ")
}

pub(super) fn names<'a>(items: impl IntoIterator<Item = &'a String>) -> String {
    list(items.into_iter().map(|name| format!("{name:?}")))
}

/// `match` that sets one of some fields, or its refusal where there are none; what comes before and after it.
pub(super) fn setter(
    signature: &str,
    fields: &[Parameter],
    (of, before, after): (&str, &str, &str),
) -> String {
    if fields.is_empty() {
        return format!("{signature}(&mut self, _index: usize, _value: T) -> bool {{ false }}");
    }
    let arm = |(k, field): (usize, &Parameter)| format!("{k} => {{ {of}.{} = value; }}", field.name);
    let arms = lines(fields.iter().enumerate().map(arm));
    format!(
        "{signature}(&mut self, index: usize, value: T) -> bool {{
            {before}
            match index {{ {arms} _ => return false, }}
            {after}
            true
        }}"
    )
}
