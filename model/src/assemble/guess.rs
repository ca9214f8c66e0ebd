//! What the model file says of the joints' coordinates at the start: values held, guesses, rates.

use crate::kinematics::exact;
use crate::sight::Sight;
use crate::{Coupling, JointCoordinate, JointKind, Model, Quaternion};

/// A joint's start before the assembly.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Guess {
    /// A value for each scalar coordinate.
    pub(super) position: Vec<f64>,
    /// For each of them where the value comes from.
    pub(super) source: Vec<Source>,
    /// Second body in the first body's frame, where the model file gives it.
    pub(super) orientation: Option<Quaternion>,
    /// Whether the joint is spherical.
    pub(super) is_ball: bool,
    /// Whether the model file gives guesses only.
    pub(super) is_rough: bool,
    /// For each scalar coordinate (spherical: for each component of the relative angular velocity) its rate, where it
    /// is given or driven.
    pub(super) rate: Vec<Option<f64>>,
}

/// Where the value of a coordinate comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Source {
    /// The model file gives it, and the assembly must keep it.
    Held,
    /// The model file guesses it, a driver sets it, or a coupler makes it follow another.
    Guessed,
    /// It is unknown.
    Unknown,
}

/// How much of the relative pose of a joint's bodies is known or guessed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Told {
    /// All of it.
    All,
    /// Some of its coordinates.
    Part,
    /// None of it.
    Nothing,
}

impl Guess {
    /// How much of the joint's coordinates is known or guessed.
    pub(super) fn told(&self) -> Told {
        let is_turned = !self.is_ball || self.orientation.is_some();
        let is_known = |source: &Source| *source != Source::Unknown;
        match (self.source.iter().all(is_known), self.source.iter().any(is_known)) {
            (true, _) if is_turned => Told::All,
            (_, true) => Told::Part,
            _ => Told::Nothing,
        }
    }
}

/// The guesses of all joints.
///
/// A driven coordinate starts where its driver is at t = 0; the model file's value comes next; a coordinate that is
/// coupled to a known one follows it; the rest is zero.
pub(super) fn guesses(model: &Model) -> Vec<Guess> {
    let mut guesses: Vec<Guess> = (0..model.joints.len()).map(|joint| of_page(model, joint)).collect();
    for driver in &model.drivers {
        let JointCoordinate { joint, coordinate } = driver.coordinate;
        let [position, rate, _] = driver.motion.value(model, 0.0);
        let guess = &mut guesses[joint];
        guess.position[coordinate] = position;
        guess.source[coordinate] = Source::Guessed;
        guess.rate[coordinate] = Some(rate);
    }
    while let Some((of, value)) = next_coupled(model, &guesses) {
        guesses[of.joint].position[of.coordinate] = value;
        guesses[of.joint].source[of.coordinate] = Source::Guessed;
    }
    guesses
}

fn of_page(model: &Model, joint: usize) -> Guess {
    let joint = &model.joints[joint];
    let start = &joint.start;
    let n = joint.kind.coordinates().len();
    let set = |k: usize, order: usize| start.set.get(k).and_then(|set| set[order].as_ref());
    let given = |k: usize| set(k, 0).or_else(|| start.position.get(k).and_then(Option::as_ref));
    let source = |k: usize| match (given(k), start.is_rough && set(k, 0).is_none()) {
        (Some(_), false) => Source::Held,
        (Some(_), true) => Source::Guessed,
        (None, _) => Source::Unknown,
    };
    let n_rates = if joint.kind == JointKind::Spherical { 3 } else { n };
    let rates = start.rate.as_deref().unwrap_or_default();
    Guess {
        position: (0..n).map(|k| given(k).map_or(0.0, |x| model.value(x))).collect(),
        source: (0..n).map(source).collect(),
        orientation: start.orientation.as_ref().and_then(|p| Quaternion::unit(&exact(model, p))),
        is_ball: joint.kind == JointKind::Spherical,
        is_rough: start.is_rough,
        rate: (0..n_rates).map(|k| set(k, 1).or(rates.get(k)).map(|x| model.value(x))).collect(),
    }
}

/// A coordinate of which nothing is known but that a coupler ties it to another; if nothing is known of that either,
/// the first coordinate of the first such coupler is zero.
fn next_coupled(model: &Model, guesses: &[Guess]) -> Option<(JointCoordinate, f64)> {
    let known = |c: JointCoordinate| guesses[c.joint].source[c.coordinate] != Source::Unknown;
    let at = |c: JointCoordinate| guesses[c.joint].position[c.coordinate];
    let follow = |coupler: &crate::Coupler| {
        let (first, ratio, offset) = match &coupler.by {
            Coupling::Linear { first, ratio, offset } => (*first, model.value(ratio), model.value(offset)),
            by => {
                let (formula, second) = (by.formula()?, coupler.second?);
                let is_known = formula.uses().all(|(on, _)| known(on)) && !known(second);
                return is_known.then(|| (second, Sight::new(model, formula).value(at, 0.0)));
            }
        };
        let second = coupler.second?;
        match (known(first), known(second)) {
            (true, false) => Some((second, ratio * at(first) + offset)),
            (false, true) if ratio != 0.0 => Some((first, (at(second) - offset) / ratio)),
            _ => None,
        }
    };
    let seed = || {
        let followed = model.couplers.iter().filter(|coupler| coupler.second.is_some());
        let mut coordinates = followed.flat_map(|coupler| coupler.coordinates());
        coordinates.find(|on| !known(*on)).map(|on| (on, 0.0))
    };
    model.couplers.iter().find_map(follow).or_else(seed)
}
