//! Couplers and drivers must not contradict one another, and forces and outputs must act on something.

use super::{Owner, Place, Problem, Side};
use crate::{CoordinateKind, Element, ForceKind, JointCoordinate, Model, OutputKind, Support};

/// Everything that is wrong, couplers first.
pub(crate) fn problems(model: &Model) -> Vec<Problem> {
    let mut groups = Groups::default();
    let mut found = Vec::new();
    for (index, coupler) in model.couplers.iter().enumerate() {
        if !coupler.coordinates().into_iter().all(|on| exists(model, on)) {
            continue;
        }
        // Formulas may close circles, as loops of joints do.
        let (Some((first, ..)), Some(second)) = (coupler.linear(), coupler.second) else { continue };
        if first == second {
            found.push(with_itself(model, index, first));
        } else if !groups.join(first, second, index) {
            found.push(cycle(model, &groups, index, [first, second]));
        }
    }
    found.extend(contradicting_drivers(model, &mut groups));
    found.extend((0..model.forces.len()).filter_map(|index| idle_force(model, index)));
    found.extend((0..model.outputs.len()).filter_map(|index| fixed_output(model, index)));
    found
}

/// Whether a coordinate is one of the model's; others stand for what the model file does not name correctly.
fn exists(model: &Model, coordinate: JointCoordinate) -> bool {
    coordinate.joint < model.joints.len()
}

/// Coordinates that couplers tie together.
#[derive(Debug, Default)]
struct Groups {
    /// Pairs of coordinates that some coupler ties, with its index.
    ties: Vec<(JointCoordinate, JointCoordinate, usize)>,
}

impl Groups {
    /// Ties two coordinates; `false` if they were tied already.
    fn join(&mut self, a: JointCoordinate, b: JointCoordinate, coupler: usize) -> bool {
        let is_new = !self.reached(a).iter().any(|(c, _)| *c == b);
        if is_new {
            self.ties.push((a, b, coupler));
        }
        is_new
    }

    /// All coordinates tied to one, each with the last coupler on the way to it; none for itself.
    fn reached(&self, from: JointCoordinate) -> Vec<(JointCoordinate, Option<usize>)> {
        let mut reached = vec![(from, None)];
        let mut head = 0;
        while let Some(&(at, _)) = reached.get(head) {
            head += 1;
            for &(a, b, coupler) in &self.ties {
                for (near, far) in [(a, b), (b, a)] {
                    if near == at && !reached.iter().any(|(c, _)| *c == far) {
                        reached.push((far, Some(coupler)));
                    }
                }
            }
        }
        reached
    }
}

/// A coordinate in words.
fn shown(model: &Model, coordinate: JointCoordinate) -> String {
    let joint = &model.joints[coordinate.joint];
    let kind: CoordinateKind = model.coordinate_kind(coordinate);
    format!("`{}` of joint `{}`", kind.name(), joint.name)
}

fn with_itself(model: &Model, index: usize, first: JointCoordinate) -> Problem {
    let coupler = &model.couplers[index];
    let place = |side| Place { owner: Owner::CouplerEnd(index, side), key: "" };
    Problem::new(
        place(Side::Second),
        format!("coupler `{}` couples {} with itself", coupler.name, shown(model, first)),
        "the same coordinate as the first",
        "name two different coordinates in `first` and `second`",
    )
    .also(place(Side::First), "the first coordinate")
}

fn cycle(model: &Model, groups: &Groups, index: usize, [first, second]: [JointCoordinate; 2]) -> Problem {
    let coupler = &model.couplers[index];
    let path = groups.reached(first);
    let last = path.iter().find(|(c, _)| *c == second).and_then(|(_, coupler)| *coupler);
    let also = last.map(|other| {
        (Place { owner: Owner::Coupler(other), key: "" }, "couples the second one already".to_owned())
    });
    Problem {
        place: Place { owner: Owner::Coupler(index), key: "" },
        also,
        message: format!("coupler `{}` closes a cycle of couplers", coupler.name),
        label: format!("{} and {} are coupled without it", shown(model, first), shown(model, second)),
        help: "remove a coupler of the cycle: with it the coordinates would be coupled twice".to_owned(),
    }
}

/// Drivers of coordinates that are driven already, directly or through couplers.
fn contradicting_drivers(model: &Model, groups: &mut Groups) -> Vec<Problem> {
    let mut found = Vec::new();
    for (index, driver) in model.drivers.iter().enumerate() {
        if !exists(model, driver.coordinate) {
            continue;
        }
        let tied = groups.reached(driver.coordinate);
        let earlier = model.drivers[..index].iter().enumerate().find_map(|(other, d)| {
            tied.iter().find(|(c, _)| *c == d.coordinate).map(|&(_, via)| (other, via))
        });
        let Some((other, via)) = earlier else { continue };
        let through = match via {
            Some(coupler) => format!(" through coupler `{}`", model.couplers[coupler].name),
            None => String::new(),
        };
        found.push(
            Problem::new(
                Place { owner: Owner::Driver(index), key: "joint" },
                format!(
                    "driver `{}` contradicts driver `{}`: {} is driven already{through}",
                    driver.name,
                    model.drivers[other].name,
                    shown(model, driver.coordinate)
                ),
                "driven twice",
                "remove one of the two drivers, or add their motions: motion = { sum = [...] }",
            )
            .also(Place { owner: Owner::Driver(other), key: "joint" }, "driven here"),
        );
    }
    found
}

/// From one pulley to the next a rope may be as long as ever.
fn is_part_of_rope(model: &Model, name: &str) -> bool {
    let mut ropes = model.elements.iter().filter(|element| element.kind == "rope");
    let part = |rope: &Element| name.strip_prefix(&rope.name)?.strip_prefix('_')?.parse::<usize>().ok();
    ropes.any(|rope| part(rope).is_some())
}

/// A link or a bushing from a body to itself, or a force that can move nothing.
fn idle_force(model: &Model, index: usize) -> Option<Problem> {
    let force = &model.forces[index];
    let moves = |body: &usize| model.bodies.get(*body).is_none_or(|b| b.support.has_coordinates());
    match &force.kind {
        ForceKind::Link { .. } if is_part_of_rope(model, &force.name) => None,
        ForceKind::Link { .. } | ForceKind::Bushing(_) => {
            let (word, [first, second]) = force.kind.between()?;
            let place = |side| Place { owner: Owner::ForceEnd(index, side), key: "body" };
            let (message, label) = if first == second {
                (format!("{word} `{}` joins a body to itself", force.name), "the same body as the first")
            } else if !moves(&first) && !moves(&second) {
                (
                    format!("{word} `{}` joins two bodies that it cannot move", force.name),
                    "fixed or driven, too",
                )
            } else {
                return None;
            };
            Some(
                Problem::new(
                    place(Side::Second),
                    message,
                    label.to_owned(),
                    "name two different bodies, of which one moves",
                )
                .also(place(Side::First), "the first body"),
            )
        }
        ForceKind::Load { body, .. } if !moves(body) => Some(Problem::new(
            Place::force(index, "body"),
            format!("load `{}` acts on a body that it cannot move", force.name),
            "fixed or driven",
            "name a body that moves, or remove the load",
        )),
        _ => None,
    }
}

/// An output of a body that does not move, or a driver's where it has none.
fn fixed_output(model: &Model, index: usize) -> Option<Problem> {
    let output = &model.outputs[index];
    let of_force = match output.kind {
        OutputKind::Spring { force } => Some((force, "spring")),
        OutputKind::Link { force } => Some((force, "link")),
        OutputKind::Bushing { force } => Some((force, "bushing")),
        _ => None,
    };
    if let Some((force, kind)) = of_force {
        let force = model.forces.get(force)?;
        return (force.kind.parts().word != kind).then(|| {
            Problem::new(
                Place { owner: Owner::Output(index), key: "force" },
                format!("output `{}` is of a {kind}, and `{}` is none", output.name, force.name),
                format!("not a {kind}"),
                format!("name a [[force]] of kind \"{kind}\""),
            )
        });
    }
    if let OutputKind::Relative(relative) = &output.kind {
        let [first, second] = relative.frames.each_ref().map(|frame| frame.body);
        let is_still = |body: usize| model.bodies.get(body).is_none_or(|body| body.support == Support::Fixed);
        return (first == second || is_still(first) && is_still(second)).then(|| {
            Problem::new(
                Place { owner: Owner::OutputEnd(index, Side::Second), key: "body" },
                format!("the frames of output `{}` do not move against one another", output.name),
                "never changes",
                "name a body that moves, seen from another",
            )
        });
    }
    let [frame] = output.kind.frames() else { return None };
    let body = model.bodies.get(frame.body).filter(|body| body.support == Support::Fixed)?;
    Some(Problem::new(
        Place { owner: Owner::Output(index), key: "body" },
        format!("output `{}` is of body `{}`, which is fixed", output.name, body.name),
        "never changes",
        "name a body that moves",
    ))
}
