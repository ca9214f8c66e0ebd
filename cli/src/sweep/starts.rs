//! Where scenarios start.
//!
//! A scenario is the model with its parameters and starts, assembled as `simulate --set` would. That takes longer than
//! many a scenario. Of open trees in joint coordinates it is not needed where what varies cannot move the start in
//! joint coordinates: then all scenarios have one, save for the joints' own starts that vary.

use crate::scene::{Scene, start};
use gyro_model::{Attachment, JointCoordinate, Link, Model, Number, Rational, Tree};
use gyro_runner::{Coordinates, Start};
use gyro_sweep::study::Study;
use gyro_sweep::{Draw, Plan, Quantity, Target};

/// The model of a scenario with these values, and where it starts.
///
/// # Errors
/// What they make unphysical, or why it cannot start.
pub(super) fn assembled(
    page: &Model,
    targets: &[Target],
    values: &[f64],
) -> Result<(Model, gyro_model::Start), String> {
    let exact = |value: f64| Rational::from_float(value).ok_or_else(|| format!("{value} is not finite"));
    let (mut model, mut settings) = (page.clone(), Vec::new());
    for (target, value) in targets.iter().zip(values) {
        match *target {
            Target::Parameter(index) => settings.push((page.parameters[index].name.clone(), exact(*value)?)),
            Target::Input(index) => page.check_input(index, &exact(*value)?)?,
            Target::Table(_) => {}
            Target::Start(joint, k) => set(&mut model, joint, (k, 0), exact(*value)?),
            Target::StartRate(joint, k) => {
                // What hangs on the joint then has this rate in place of an absolute one of its own.
                if let Some(body) = hanging(&model, joint) {
                    model.bodies[body].angular_velocity = None;
                }
                set(&mut model, joint, (k, 1), exact(*value)?);
            }
        }
    }
    let (model, start) = model.with_parameters_and_start(&settings)?;
    let assemble = || model.assemble().map_err(|error| format!("{error}: {}", error.help()));
    let start = start.map_or_else(assemble, Ok)?;
    Ok((model, start))
}

/// Sets where a joint's coordinate starts, or its rate.
fn set(model: &mut Model, joint: usize, (coordinate, order): (usize, usize), value: Rational) {
    let joint = &mut model.joints[joint];
    joint.start.set.resize(joint.kind.coordinates().len(), [None, None]);
    joint.start.set[coordinate][order] = Some(Number::Exact(value));
}

/// The body that hangs on a joint of the tree.
fn hanging(model: &Model, joint: usize) -> Option<usize> {
    let is_it =
        |link: &&Link| matches!(link.attachment, Attachment::Joint { joint: own, .. } if own == joint);
    Tree::of(model).links.iter().find(is_it).map(|link| link.body)
}

/// Where a scenario starts, and how far some coordinates have been moved there from where the model file has them.
///
/// # Errors
/// Why it cannot.
pub(super) fn started(
    page: &Model,
    (targets, values): (&[Target], &[f64]),
    moved: &[(usize, usize)],
) -> Result<(Start, Vec<f64>), String> {
    let (model, assembled) = assembled(page, targets, values)?;
    let of = |&(joint, coordinate): &(usize, usize)| {
        assembled.moved_from_given(&model, JointCoordinate { joint, coordinate })
    };
    // Nobody hears of events.
    let start = Start { watches: Vec::new(), ..start(&model, &assembled) };
    Ok((start, moved.iter().map(of).collect()))
}

/// How far apart the starts are that derivatives are taken of, in parts of a target's scale. They are differences of
/// order 4: what is cut off and what is rounded are both about 1e-12.
const APART: f64 = 1e-3;

/// The derivatives of a scenario's assembled start by some targets, times their scales: of each the numbers of
/// positions, velocities, states and turn references.
///
/// # Errors
/// Why it cannot start nearby.
pub(super) fn slopes(page: &Model, plan: &Plan, by: &[usize], values: &[f64]) -> Result<Vec<f64>, String> {
    let mut all = Vec::new();
    for target in by {
        let shifted = |parts: f64| {
            let mut values = values.to_vec();
            values[*target] += parts * APART * plan.scale(*target);
            let (start, _) = started(page, (&plan.targets, &values), &[])
                .map_err(|words| format!("they take a start nearby: {words}"))?;
            Ok::<_, String>([start.positions, start.velocities, start.states, start.turn_references].concat())
        };
        let [far_below, below, above, far_above] =
            [shifted(-2.0)?, shifted(-1.0)?, shifted(1.0)?, shifted(2.0)?];
        let slope = |k: usize| (8.0 * (above[k] - below[k]) - (far_above[k] - far_below[k])) / (12.0 * APART);
        all.extend((0..above.len()).map(slope));
    }
    Ok(all)
}

/// Whether all scenarios start alike in joint coordinates and all that is kept is read there, so that they run in the
/// lanes of packs.
pub(super) fn are_alike(study: &Study, scene: &Scene) -> bool {
    let (model, approach) = (&scene.page, &scene.approach);
    let (method, has_tolerance) = (approach.integrator, approach.tolerance.is_some());
    let is_explicit = !method.is_implicit() && method.is_adaptive() == has_tolerance;
    let is_joint = |quantity: &Quantity| matches!(quantity, Quantity::Position(_) | Quantity::Rate(_));
    let is_tree = Tree::of(model).is_open() && model.couplers.is_empty() && model.drivers.is_empty();
    let is_constant = study.plan.targets.iter().all(|target| !matches!(target, Target::Table(_)));
    approach.coordinates == Coordinates::Joint
        && model.controllers.is_empty()
        && !model.has_rigid_contacts()
        && model.lines().is_empty()
        && is_explicit
        && is_tree
        && is_constant
        && !study.keep.estimate
        && study.keep.columns.iter().all(is_joint)
        && keeps_start(model, &study.plan.targets)
        && are_admissible(study, model)
}

/// Whether what is given of the start, and the axes that it is seen along, are numbers of the model file alone. An
/// absolute angular velocity makes joint rates depend on those of the joints before it.
fn keeps_start(model: &Model, targets: &[Target]) -> bool {
    let is_exact = |number: &Number| matches!(number, Number::Exact(_));
    let moves = |target: &Target| matches!(target, Target::Start(..) | Target::StartRate(..));
    let joints = model.joints.iter().all(|joint| {
        let start = &joint.start;
        let ends = [&joint.first, &joint.second];
        start.position.iter().flatten().all(is_exact)
            && start.rate.iter().flatten().all(is_exact)
            && start.orientation.iter().flatten().all(is_exact)
            && ends.iter().all(|end| end.axis.iter().chain(&end.zero).all(is_exact))
    });
    let bodies = model.bodies.iter().all(|body| {
        let free = body.position.iter().chain(&body.orientation).chain(&body.velocity);
        free.chain(body.angular_velocity.iter().flatten()).all(is_exact)
    });
    let is_absolute = model.bodies.iter().any(|body| body.angular_velocity.is_some());
    joints && bodies && !(is_absolute && targets.iter().any(moves))
}

/// Whether no input takes a value that it cannot have: what must hold of one is a sign or a range, and so holds between
/// two values of which it holds. Parameters are looked at by the program, scenario by scenario.
fn are_admissible(study: &Study, model: &Model) -> bool {
    let plan = &study.plan;
    let is_fit = |target: usize, value: f64| match plan.targets[target] {
        Target::Input(index) => {
            Rational::from_float(value).is_some_and(|value| model.check_input(index, &value).is_ok())
        }
        _ => true,
    };
    let on_axes = plan.axes.iter().all(|axis| {
        axis.rows
            .iter()
            .all(|row| axis.targets.iter().zip(row).all(|(target, value)| is_fit(*target, *value)))
    });
    let drawn = plan.draws.iter().all(|draw| match draw {
        Draw::Alone { target, distribution } => distribution.range().iter().all(|end| is_fit(*target, *end)),
        Draw::Together { targets, .. } => targets.iter().all(|target| is_fit(*target, f64::INFINITY)),
    });
    on_axes && drawn
}

#[cfg(test)]
mod tests;
