//! Inertia tensors in their three forms.

use toml::Spanned;
use toml::de::DeValue;

use super::numbers::{number, vector};
use super::reader::Reader;
use super::section::{Item, Section};
use crate::Number;

/// An inertia tensor: `[xx, yy, zz]`, a table of its elements or a symmetric matrix.
pub(super) fn tensor(reader: &mut Reader<'_>, item: Item<'_>) -> Option<[Number; 6]> {
    match item.value.get_ref() {
        DeValue::Table(_) => tensor_of_elements(reader, item),
        DeValue::Array(rows) if !rows.is_empty() && rows.iter().all(|row| row.get_ref().is_array()) => {
            tensor_of_rows(reader, item, rows)
        }
        DeValue::Array(elements) if elements.len() == 3 => {
            let [xx, yy, zz] = vector(reader, item)?;
            Some([xx, yy, zz, Number::integer(0), Number::integer(0), Number::integer(0)])
        }
        _ => {
            item.wrong_type(
                reader,
                "three moments of inertia, a table of elements or a symmetric matrix",
                "inertia = [xx, yy, zz], or a table of `xx`, `yy`, `zz`, `xy`, `xz`, `yz`, or three rows of three",
            );
            None
        }
    }
}

const ELEMENTS: [&str; 6] = ["xx", "yy", "zz", "xy", "xz", "yz"];

fn tensor_of_elements(reader: &mut Reader<'_>, item: Item<'_>) -> Option<[Number; 6]> {
    let table = item.value.get_ref().as_table()?;
    // The elements are marked under the body's own place: they are judged together, as its inertia.
    let section = Section::open(reader, item.place.owner, "an inertia", table, &ELEMENTS);
    let mut whole = true;
    let elements = ELEMENTS.map(|key| match section.get(key) {
        Some(element) => {
            let number = number(reader, Item { place: element.place, value: element.value });
            whole &= number.is_some();
            number.unwrap_or_else(|| Number::integer(0))
        }
        None => {
            if key.as_bytes()[0] == key.as_bytes()[1] {
                whole = false;
                let words = [
                    format!("the inertia has no `{key}`"),
                    format!("needs `{key}`"),
                    format!("write {key} = ..."),
                ];
                reader.missing(item.place, words);
            }
            Number::integer(0)
        }
    });
    if !whole {
        reader.doubt(item.place);
    }
    whole.then_some(elements)
}

fn tensor_of_rows(
    reader: &mut Reader<'_>,
    item: Item<'_>,
    rows: &[Spanned<DeValue<'_>>],
) -> Option<[Number; 6]> {
    if rows.len() != 3 {
        item.wrong_type(
            reader,
            "a matrix of three rows of three numbers",
            "[[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]",
        );
        return None;
    }
    let rows: Vec<Option<[Number; 3]>> =
        rows.iter().map(|value| vector(reader, Item { place: item.place, value })).collect();
    let rows: Vec<[Number; 3]> = rows.into_iter().collect::<Option<_>>()?;
    for (i, j) in [(0, 1), (0, 2), (1, 2)] {
        if rows[i][j] != rows[j][i] {
            let axes = ["x", "y", "z"];
            let words = [
                "an inertia tensor must be symmetric".to_owned(),
                format!("{0}{1} differs from {1}{0}", axes[i], axes[j]),
                format!(
                    "write the same number in row {}, column {} and in row {1}, column {0}",
                    i + 1,
                    j + 1
                ),
            ];
            item.wrong(reader, words);
            return None;
        }
    }
    let [[xx, xy, xz], [_, yy, yz], [_, _, zz]] = <[[Number; 3]; 3]>::try_from(rows).ok()?;
    Some([xx, yy, zz, xy, xz, yz])
}
