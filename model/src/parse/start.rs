//! The start must be given where it counts, and exist: the model file's angular velocities must be ones that the joints
//! allow.

use super::kinds::start_keys;
use super::reader::Reader;
use crate::validate::{Owner, Place, Problem};
use crate::{Attachment, Driver, JointKind, Link, Model, Tree, analyse};

/// Reports starts that would have no effect: of bodies that their joints place, and of coordinates that are driven.
pub(super) fn misplaced(reader: &mut Reader<'_>, model: &Model) {
    let mut found = Vec::new();
    for link in &Tree::of(model).links {
        if let Attachment::Joint { joint, .. } = link.attachment {
            found.extend(of_hanging(reader, model, link, model.joints[joint].kind));
        }
    }
    for (index, driver) in model.drivers.iter().enumerate() {
        if driver.coordinate.joint < model.joints.len() {
            found.extend(of_driven(reader, model, index, driver));
        }
    }
    reader.add_problems(found);
}

/// A body that hangs on a joint is placed by it.
fn of_hanging(reader: &Reader<'_>, model: &Model, link: &Link, kind: JointKind) -> Vec<Problem> {
    let name = &model.bodies[link.body].name;
    let mut keys = vec![
        (
            "position",
            "start the joint instead (`angle`, `displacement`, `orientation`), or write free = true",
        ),
        ("velocity", "give its joint a `rate` or the body an `angular_velocity`, or write free = true"),
    ];
    // The coordinate of a point on a line says nothing of how the body is turned.
    if kind != JointKind::PointOnLine {
        keys.push(("orientation", "start the joint instead (`angle`, `orientation`), or write free = true"));
    }
    let written = keys.into_iter().filter(|(key, _)| reader.is_written(Place::body(link.body, key)));
    let problem = |(key, help): (&'static str, &str)| {
        Problem::new(
            Place::body(link.body, key),
            format!("the {key} of body `{name}` follows from its joints"),
            "not allowed here",
            help.to_owned(),
        )
    };
    written.map(problem).collect()
}

/// The start of a driven coordinate is the driver's.
fn of_driven(reader: &Reader<'_>, model: &Model, index: usize, driver: &Driver) -> Vec<Problem> {
    let joint = driver.coordinate.joint;
    let coordinates = model.joints[joint].kind.coordinates();
    let (plain, degrees) = start_keys(coordinates[driver.coordinate.coordinate]);
    let mut keys = vec![plain];
    keys.extend(degrees);
    if coordinates.len() == 1 {
        keys.push("rate");
    }
    let written = keys.into_iter().filter(|key| reader.is_written(Place::joint(joint, key)));
    let problem = |key| {
        Problem::new(
            Place::joint(joint, key),
            format!("the start of joint `{}` is given by driver `{}`", model.joints[joint].name, driver.name),
            "not allowed here",
            format!("remove `{key}`: the driver's motion says where the joint starts and how fast"),
        )
        .also(Place { owner: Owner::Driver(index), key: "" }, "driven here")
    };
    written.map(problem).collect()
}

/// Assembles the start once and looks for redundant rows, to report at its place what stands in the way.
pub(super) fn check(reader: &mut Reader<'_>, model: &mut Model) {
    match model.assemble().and_then(|_| analyse(model)) {
        Ok(analysis) => model.redundant = analysis.redundant,
        Err(error) => reader.add_problems(vec![Problem::new(
            error.place().unwrap_or(Place { owner: Owner::Page, key: "" }),
            error.to_string(),
            "no consistent start",
            error.help(),
        )]),
    }
}
