//! The start must exist: the page's angular velocities must be ones that the joints allow.

use super::reader::Reader;
use crate::Model;
use crate::validate::{Owner, Place, Problem};

/// Assembles the start once, to report at its place what stands in the way.
pub(super) fn check(reader: &mut Reader<'_>, model: &Model) {
    if let Err(error) = model.assemble() {
        reader.add_problems(vec![Problem {
            place: error.place().unwrap_or(Place { owner: Owner::Page, key: "" }),
            also: None,
            message: error.to_string(),
            label: "no consistent start".to_owned(),
            help: error.help(),
        }]);
    }
}
