//! Inertia tensors in their three forms.

use toml::de::DeValue;

use super::numbers::vector;
use super::reader::Reader;
use super::section::{Item, Section, all};
use crate::Number;
use crate::keys::ELEMENTS;

/// An inertia tensor: `[xx, yy, zz]`, a table of its elements or a symmetric matrix.
pub(super) fn tensor(reader: &mut Reader<'_>, item: Item<'_>) -> Option<[Number; 6]> {
    match item.value.get_ref() {
        DeValue::Table(_) => tensor_of_elements(reader, item),
        DeValue::Array(rows) if !rows.is_empty() && rows.iter().all(|row| row.get_ref().is_array()) => {
            tensor_of_rows(reader, item)
        }
        DeValue::Array(elements) if elements.len() == 3 => {
            let [xx, yy, zz] = vector(reader, item)?;
            Some([xx, yy, zz, Number::integer(0), Number::integer(0), Number::integer(0)])
        }
        _ => {
            item.wrong_type_with(
                reader,
                "three moments of inertia, a table of elements or a symmetric matrix",
                "write inertia = [xx, yy, zz], or a table of `xx`, `yy`, `zz`, `xy`, `xz`, `yz`, or three rows of three"
                    .to_owned(),
            );
            None
        }
    }
}

fn tensor_of_elements(reader: &mut Reader<'_>, item: Item<'_>) -> Option<[Number; 6]> {
    // The elements are marked under the body's own place: they are judged together, as its inertia.
    let section = Section::within(reader, item, "the inertia", &ELEMENTS)?;
    let elements = ["xx", "yy", "zz", "xy", "xz", "yz"].map(|key| {
        let number = section.given(reader, key);
        let may_lack = !section.has(key) && !section.key(key).is_required;
        number.or(may_lack.then(|| Number::integer(0)))
    });
    let [Some(xx), Some(yy), Some(zz), Some(xy), Some(xz), Some(yz)] = elements else {
        reader.doubt(item.place);
        return None;
    };
    Some([xx, yy, zz, xy, xz, yz])
}

fn tensor_of_rows(reader: &mut Reader<'_>, item: Item<'_>) -> Option<[Number; 6]> {
    if item.elements().count() != 3 {
        item.wrong_type_with(
            reader,
            "a matrix of three rows of three numbers",
            "write [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]".to_owned(),
        );
        return None;
    }
    let rows: Vec<[Number; 3]> = all(item.elements().map(|row| vector(reader, row)))?;
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
