//! Where scenarios start.
//!
//! A scenario is the model with its parameters and starts, assembled as `simulate --set` would. That takes longer than
//! many a scenario. Of open trees in joint coordinates it is not needed where what varies cannot move the start in
//! joint coordinates: then all scenarios have one, save for the joints' own starts that vary.

use crate::scene::{Scene, start};
use gyro_model::{Attachment, Link, Model, Number, Rational, Tree};
use gyro_runner::{Coordinates, Integrator, Start};
use gyro_sweep::study::Study;
use gyro_sweep::{Draw, Plan, Quantity, Target};

/// The model of a scenario with these values.
///
/// # Errors
/// What they make unphysical.
pub(super) fn model(page: &Model, targets: &[Target], values: &[f64]) -> Result<Model, String> {
    let exact = |value: f64| Rational::from_float(value).ok_or_else(|| format!("{value} is not finite"));
    let mut settings = Vec::new();
    for (target, value) in targets.iter().zip(values) {
        match target {
            Target::Parameter(index) => settings.push((page.parameters[*index].name.clone(), exact(*value)?)),
            Target::Input(index) => page.check_input(*index, &exact(*value)?)?,
            _ => {}
        }
    }
    let mut model = page.with_parameters(&settings)?;
    for (target, value) in targets.iter().zip(values) {
        match *target {
            Target::Start(joint, k) => {
                let position = &mut model.joints[joint].start.position;
                position.resize(position.len().max(k + 1), None);
                position[k] = Some(Number::Exact(exact(*value)?));
            }
            Target::StartRate(joint, k) => {
                // What hangs on the joint then has this rate in place of an absolute one of its own.
                if let Some(body) = hanging(&model, joint) {
                    model.bodies[body].angular_velocity = None;
                }
                let joint = &mut model.joints[joint];
                let n = joint.kind.coordinates().len();
                let rates = joint.start.rate.get_or_insert_with(|| vec![Number::integer(0); n]);
                rates[k] = Number::Exact(exact(*value)?);
            }
            _ => {}
        }
    }
    Ok(model)
}

/// The body that hangs on a joint of the tree.
fn hanging(model: &Model, joint: usize) -> Option<usize> {
    let is_it =
        |link: &&Link| matches!(link.attachment, Attachment::Joint { joint: own, .. } if own == joint);
    Tree::of(model).links.iter().find(is_it).map(|link| link.body)
}

/// Where a scenario starts.
///
/// # Errors
/// Why it cannot.
pub(super) fn assembled(page: &Model, targets: &[Target], values: &[f64]) -> Result<Start, String> {
    let model = model(page, targets, values)?;
    let assembled = model.assemble().map_err(|error| format!("{error}: {}", error.help()))?;
    // Nobody hears of events.
    Ok(Start { watches: Vec::new(), ..start(&model, &assembled) })
}

/// How far apart the starts are that derivatives are taken of, in parts of a target's scale. They are differences of
/// order 4: what is cut off and what is rounded are both about 1e-12.
const APART: f64 = 1e-3;

/// The derivatives of a scenario's assembled start by some targets, times their scales: of each the numbers of
/// positions, velocities and turn references.
///
/// # Errors
/// Why it cannot start nearby.
pub(super) fn slopes(page: &Model, plan: &Plan, by: &[usize], values: &[f64]) -> Result<Vec<f64>, String> {
    let mut all = Vec::new();
    for target in by {
        let shifted = |parts: f64| {
            let mut values = values.to_vec();
            values[*target] += parts * APART * plan.scale(*target);
            let start = assembled(page, &plan.targets, &values)
                .map_err(|words| format!("they take a start nearby: {words}"))?;
            Ok::<_, String>([start.positions, start.velocities, start.turn_references].concat())
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
    let is_explicit = match approach.integrator {
        Integrator::Rk4 => approach.tolerance.is_none(),
        Integrator::Tsit5 | Integrator::Dop853 => approach.tolerance.is_some(),
        Integrator::Rodas4 => false,
    };
    let is_joint = |quantity: &Quantity| matches!(quantity, Quantity::Position(_) | Quantity::Rate(_));
    let is_tree = Tree::of(model).is_open() && model.couplers.is_empty() && model.drivers.is_empty();
    let is_constant = study.plan.targets.iter().all(|target| !matches!(target, Target::Table(_)));
    approach.coordinates == Coordinates::Joint
        && model.controllers.is_empty()
        && model.contacts.is_empty()
        && model.lines().is_empty()
        && gyro_codegen::lacks_joint_coordinates(model).is_none()
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
