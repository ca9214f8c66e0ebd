//! Axes, zero directions and Euler parameters, decided exactly.

use num_traits::Zero;

use super::{Owner, Place, Problem, Side, rounded};
use crate::kinematics::cross;
use crate::{Body, BodyFrame, Force, ForceKind, Joint, JointEnd, JointKind, Model, Number, Output, Rational};

/// The orientation of a body.
pub(super) fn of_body(model: &Model, index: usize, body: &Body) -> Option<Problem> {
    zero_parameters(
        model,
        &body.orientation,
        Place::body(index, "orientation"),
        &format!("body `{}`", body.name),
    )
}

/// The orientation at which a spherical joint starts.
pub(super) fn of_start(model: &Model, index: usize, joint: &Joint) -> Option<Problem> {
    let parameters = joint.start.orientation.as_ref()?;
    zero_parameters(model, parameters, Place::joint(index, "orientation"), &format!("joint `{}`", joint.name))
}

/// The orientations of an output's frames.
pub(super) fn of_output(model: &Model, index: usize, output: &Output) -> Option<Problem> {
    let frames = output.kind.frames();
    let problem = |(side, frame): (Side, &BodyFrame)| {
        let owner = if frames.len() == 1 { Owner::Output(index) } else { Owner::OutputEnd(index, side) };
        let place = Place { owner, key: "orientation" };
        zero_parameters(model, frame.orientation.as_ref()?, place, &format!("output `{}`", output.name))
    };
    Side::BOTH.into_iter().zip(frames).find_map(problem)
}

/// The orientations of a bushing's frames.
pub(super) fn of_force(model: &Model, index: usize, force: &Force) -> Vec<Problem> {
    let ForceKind::Bushing(bushing) = &force.kind else { return Vec::new() };
    let one = |(side, frame): (Side, &BodyFrame)| {
        let place = Place { owner: Owner::ForceEnd(index, side), key: "orientation" };
        zero_parameters(model, frame.orientation.as_ref()?, place, &format!("force `{}`", force.name))
    };
    Side::BOTH.into_iter().zip(bushing.ends()).filter_map(one).collect()
}

fn zero_parameters(model: &Model, parameters: &[Number; 4], place: Place, of: &str) -> Option<Problem> {
    parameters.iter().all(|x| model.exact(x).is_zero()).then(|| {
        Problem::new(
            place,
            format!("the Euler parameters of {of} are all zero"),
            "no direction to normalise",
            "write [1, 0, 0, 0] for no rotation: (cos(angle/2), axis * sin(angle/2))",
        )
    })
}

/// The directions of both ends; once where they are the same.
pub(super) fn of_joint(model: &Model, index: usize) -> Vec<Problem> {
    let Joint { kind, name, first, second, .. } = &model.joints[index];
    match kind {
        JointKind::Spherical | JointKind::Rod => return Vec::new(),
        JointKind::PointOnLine => {
            return directions(model, index, Side::First, &format!("joint `{name}`")).into_iter().collect();
        }
        _ => {}
    }
    if (&first.axis, &first.zero) == (&second.axis, &second.zero) {
        return directions(model, index, Side::First, &format!("joint `{name}`")).into_iter().collect();
    }
    let of = |side: Side| format!("joint `{name}` on its {} body", side.key());
    Side::BOTH.into_iter().filter_map(|side| directions(model, index, side, &of(side))).collect()
}

/// The axis and the zero direction of one end.
fn directions(model: &Model, index: usize, side: Side, of: &str) -> Option<Problem> {
    let joint = &model.joints[index];
    let end = match side {
        Side::First => &joint.first,
        Side::Second => &joint.second,
    };
    let [axis, zero] = exact_directions(model, end);
    let place = |key| Place::end(index, side, key);
    let problem = |key, message: String, label: &str, help: String| {
        Problem::new(place(key), message, label.to_owned(), help)
    };
    let vanishes = |v: &[Rational; 3]| v.iter().all(Zero::is_zero);
    let others = [&joint.first, &joint.second].map(|end| exact_directions(model, end));
    // The direction may be shared by both ends, and must then suit both.
    let off = |key: usize| off(&others.each_ref().map(|ends| &ends[key]));
    for (key, direction, example) in [("axis", &axis, off(1)), ("zero", &zero, off(0))] {
        if vanishes(direction) {
            let message = format!("the {key} direction of {of} is zero");
            let help = format!("write a direction of any length but 0, such as {key} = {example}");
            return Some(problem(key, message, "has no direction", help));
        }
    }
    let square = |v: &[Rational; 3]| v.iter().fold(Rational::zero(), |sum, x| sum + x * x);
    let is_parallel = square(&cross(&axis, &zero)) <= square(&axis) * square(&zero) * rounded() * rounded();
    is_parallel.then(|| {
        let message = format!("the zero direction of {of} is parallel to its axis");
        let help = format!("choose a direction that is not parallel to the axis, such as zero = {}", off(0));
        let also = Some((place("axis"), "the axis".to_owned()));
        Problem { also, ..problem("zero", message, "parallel to the axis", help) }
    })
}

/// The axes about which a driven body turns.
pub(super) fn of_motion(model: &Model, index: usize, body: &Body) -> Vec<Problem> {
    let rotations = body.motion.iter().flat_map(|motion| &motion.rotations);
    let zero = rotations.filter(|(axis, _)| axis.iter().all(|x| model.exact(x).is_zero()));
    let problem = |_| {
        Problem::new(
            Place { owner: Owner::Driven(index), key: "rotations" },
            format!("a rotation of body `{}` has no axis", body.name),
            "an axis is zero",
            "write a direction of any length but 0, such as axis = [0, 0, 1]",
        )
    };
    zero.map(problem).collect()
}

fn exact_directions(model: &Model, end: &JointEnd) -> [[Rational; 3]; 2] {
    [&end.axis, &end.zero].map(|v| v.each_ref().map(|x| model.exact(x)))
}

/// A coordinate direction far from some directions, of which it is parallel to none.
fn off(directions: &[&[Rational; 3]]) -> &'static str {
    let cosine = |k: usize, v: &[Rational; 3]| {
        let square = v.iter().fold(Rational::zero(), |sum, x| sum + x * x);
        if square.is_zero() { square } else { &v[k] * &v[k] / square }
    };
    let largest = |k: usize| directions.iter().map(|v| cosine(k, v)).max();
    let best = (0..3).min_by_key(|&k| largest(k));
    ["[1, 0, 0]", "[0, 1, 0]", "[0, 0, 1]"][best.unwrap_or(0)]
}
