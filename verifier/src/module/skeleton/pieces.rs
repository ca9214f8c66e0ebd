//! Pieces of text: lists, buffers, and functions that look something up.

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

/// A function that gives a buffer of zeros, one for each pair.
pub(super) fn buffers(pairs: &[(&str, &str, &str)]) -> String {
    lines(pairs.iter().map(|(function, ty, count)| {
        format!("fn {function}(&self) -> Self::{ty} {{ [T::constant(0.0); {count}] }}")
    }))
}

/// A function that fills `out`, for each pair of name and type.
pub(super) fn fillings(pairs: &[(&str, &str)]) -> String {
    lines(pairs.iter().map(|(function, ty)| {
        format!(
            "fn {function}(&self, ANY_t: T, ANY_y: &Self::State, ANY_out: &mut Self::{ty}) {{ HOLE_{function} }}"
        )
    }))
}

/// A function that gives an entry of a table by its index, or something else beyond its end.
pub(super) fn lookup(
    signature: &str,
    argument: &str,
    entry: &str,
    entries: &[String],
    otherwise: &str,
) -> String {
    let table = signature.rsplit(' ').next().unwrap_or_default().to_owned();
    let function = signature.trim_end_matches(&table);
    format!(
        "{function} {{
            const {table}: [{entry}; {}] = [{}];
            {table}.get({argument}).copied().{otherwise}
        }}",
        entries.len(),
        list(entries),
    )
}

pub(super) fn name_lookup(function: &str, argument: &str, table: &str, entries: &[&String]) -> String {
    let entries: Vec<_> = entries.iter().map(|name| format!("{name:?}")).collect();
    let signature = format!("fn {function}(&self, {argument}: usize) -> &str {table}");
    lookup(&signature, argument, "&str", &entries, "unwrap_or_default()")
}
