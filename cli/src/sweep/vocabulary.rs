//! What a model has that a study can name: the names are those of the columns of `simulate`.

use crate::columns::{Shown, coordinates, outputs};
use crate::scene::observed;
use gyro_model::{CoordinateKind, JointCoordinate, Model, to_f64};
use gyro_sweep::study::{Named, Setter, SetterKind, Vocabulary};
use gyro_sweep::{Quantity, Target};

/// What sets inputs in runs.
fn setters(model: &Model) -> Vec<Setter> {
    let setter = |kind, name: &str, inputs: Vec<usize>| Setter { kind, name: name.to_owned(), inputs };
    let controllers = model.controllers.iter();
    let controllers = controllers.map(|one| setter(SetterKind::Controller, &one.name, one.inputs.clone()));
    let contacts = model.contacts.iter();
    let contacts = contacts.map(|one| setter(SetterKind::Contact, &one.name, vec![one.input]));
    let surfaces = model.touching.iter();
    let surfaces = surfaces.map(|one| setter(SetterKind::Contact, &one.name, one.inputs.to_vec()));
    let contacts = contacts.chain(surfaces);
    let lines = model.lines().into_iter();
    let lines = lines.map(|(name, lines)| setter(SetterKind::Lines, name, lines.inputs.to_vec()));
    let followed = model.followed_inputs().into_iter();
    let followed = followed.map(|(name, inputs)| setter(SetterKind::Lines, name, inputs.to_vec()));
    controllers.chain(contacts).chain(lines).chain(followed).collect()
}

/// What the model file gives of starts and lets the assembly move.
fn rough(model: &Model) -> Vec<Named<(usize, usize)>> {
    let shown = coordinates(model);
    let places = shown
        .iter()
        .enumerate()
        .map(|(index, one)| (one, shown[..index].iter().filter(|before| before.joint == one.joint).count()));
    let is_rough = |(one, place): &(&Shown, usize)| {
        let (start, of) =
            (&model.joints[one.joint].start, JointCoordinate { joint: one.joint, coordinate: *place });
        let is_given = start.orientation.is_some() || matches!(start.position.get(*place), Some(Some(_)));
        start.is_rough && is_given && model.drivers.iter().all(|driver| driver.coordinate != of)
    };
    let named = |(one, place): (&Shown, usize)| {
        let unit = if one.is_orientation() { "rad" } else { one.unit() };
        Named { name: one.name.clone(), unit: unit.to_owned(), of: (one.joint, place) }
    };
    let closes = !model.is_placed_by_trees();
    places.filter(|one| closes && is_rough(one)).map(named).collect()
}

const AXES: [&str; 3] = ["x", "y", "z"];

pub(super) fn vocabulary(model: &Model) -> Vocabulary {
    let valued = |all: &[gyro_model::Parameter]| {
        all.iter().map(|one| (one.name.clone(), to_f64(&one.value))).collect::<Vec<_>>()
    };
    let mut words = Vocabulary {
        parameters: valued(&model.parameters),
        inputs: valued(&model.inputs),
        setters: setters(model),
        ..Vocabulary::default()
    };
    for (index, shown) in coordinates(model).iter().enumerate() {
        let name = &shown.name;
        let Some(kind) = shown.kind else {
            words.keep_all(name, " e", "1", 0..4, |k| Quantity::Orientation(index, k));
            words.keep_all(name, " rate ", "rad/s", 0..3, |k| Quantity::OrientationRate(index, k));
            continue;
        };
        let rate = format!("{name} rate");
        words.keep(name.clone(), shown.unit(), Quantity::Position(index));
        words.keep(rate.clone(), shown.rate_unit(), Quantity::Rate(index));
        let of = model.joints[shown.joint].kind.coordinates();
        let place = of.iter().position(|other: &CoordinateKind| *other == kind).unwrap_or(0);
        let of = JointCoordinate { joint: shown.joint, coordinate: place };
        if let Some(driver) = model.drivers.iter().find(|driver| driver.coordinate == of) {
            words.driven.extend([name.clone(), rate].map(|start| (start, driver.name.clone())));
            continue;
        }
        words.start(name.clone(), shown.unit(), Target::Start(shown.joint, place));
        words.start(rate, shown.rate_unit(), Target::StartRate(shown.joint, place));
    }
    words.rough = rough(model);
    for (index, (name, unit)) in outputs(model).into_iter().enumerate() {
        words.keep(name, if unit.is_empty() { "1" } else { unit }, Quantity::Output(index));
    }
    for (index, (_, name)) in observed(model).iter().enumerate() {
        words.keep_all(name, " ", "m", 0..3, |k| Quantity::Pose(index, k));
        words.keep_all(name, " e", "1", 0..4, |k| Quantity::Pose(index, 3 + k));
        words.keep_all(name, " velocity ", "m/s", 0..3, |k| Quantity::Velocity(index, k));
        words.keep_all(name, " angular velocity ", "rad/s", 0..3, |k| Quantity::Velocity(index, 3 + k));
    }
    words.keep("kinetic energy".to_owned(), "J", Quantity::Kinetic);
    words.keep("potential energy".to_owned(), "J", Quantity::Potential);
    words.keep("energy".to_owned(), "J", Quantity::Energy);
    if model.has_work() {
        words.keep("work".to_owned(), "J", Quantity::Work);
    }
    words.keep("constraint violation".to_owned(), "1", Quantity::Violation);
    words
}

/// Adds names.
trait Words {
    fn keep(&mut self, name: String, unit: &str, of: Quantity);
    fn start(&mut self, name: String, unit: &str, of: Target);

    /// Components, numbered where their name is one letter and a number, otherwise by axes.
    fn keep_all(
        &mut self,
        name: &str,
        part: &str,
        unit: &str,
        components: std::ops::Range<usize>,
        of: impl Fn(usize) -> Quantity,
    ) {
        let prime = if part == " angular velocity " { "'" } else { "" };
        for k in components {
            let name = if part == " e" {
                format!("{name}{part}{k}")
            } else {
                format!("{name}{part}{}{prime}", AXES[k])
            };
            self.keep(name, unit, of(k));
        }
    }
}

impl Words for Vocabulary {
    fn keep(&mut self, name: String, unit: &str, of: Quantity) {
        self.columns.push(Named { name, unit: unit.to_owned(), of });
    }

    fn start(&mut self, name: String, unit: &str, of: Target) {
        self.starts.push(Named { name, unit: unit.to_owned(), of });
    }
}

#[cfg(test)]
mod tests;
