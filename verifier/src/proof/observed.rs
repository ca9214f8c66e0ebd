//! What functions that observe a joint state must satisfy: they give what the textbook reads off its maximal state.

use super::case::{Arguments, Case};
use super::joints::{Motion, free_motions, velocities};
use super::residuals::differences;
use crate::field::Field;
use crate::module::frames;
use crate::point::Point;
use crate::program::Source;
use crate::tape::Term;
use gyro_model::{BodyFrame, OutputKind};

/// At the accelerations and multipliers that are proved there. What tells of multipliers is refuted without these.
pub fn outputs<'a>(case: &Case<'a>) -> Option<Vec<Term<'a>>> {
    let motion = Motion::new(case)?;
    let tells_multipliers = case.model.outputs.iter().any(|output| match output.kind {
        OutputKind::Reaction { .. } | OutputKind::Driver { .. } | OutputKind::Coupler { .. } => true,
        OutputKind::Power => case.model.is_driven(),
        _ => false,
    });
    let lambda = if case.module.programs.contains_key("corrected_multipliers") {
        case.run_with("corrected_multipliers", &motion.maximal, motion.accelerations())
    } else if tells_multipliers {
        return Some(vec![Term::one(case.point.context)]);
    } else {
        vec![Term::zero(case.point.context); case.model.rows().len()]
    };
    let textbook = case.textbook(&motion.maximal)?;
    let expected = textbook.outputs(motion.accelerations(), &lambda)?;
    let found = case.run_with("joint_outputs", &case.point, &motion.rates_of_rates);
    Some(differences(&found, &expected))
}

/// Row by row, at u̇ that no equation of motion asks for.
pub fn output_derivatives<'a>(case: &Case<'a>) -> Option<Vec<Term<'a>>> {
    let layout = case.module.joints.as_ref()?;
    let (one, rates) = (Term::one(case.point.context), &case.motion[..layout.n_rates]);
    let given = || Arguments { accelerations: rates, ..case.given(&case.point) };
    let kinds = [
        ("outputs_by_state", Source::Joint as fn(usize) -> Source, layout.n_coordinates + layout.n_rates),
        ("outputs_by_accelerations", Source::Acceleration, layout.n_rates),
        ("outputs_by_inputs", Source::Input, case.model.inputs.len()),
        ("outputs_by_parameters", Source::Parameter, case.model.parameters.len()),
    ];
    let mut residuals = Vec::new();
    for (function, source, n) in kinds {
        let found = case.results(function, given());
        for k in 0..n {
            let only = |read: Source| (read == source(k)).then_some(one);
            let [_, column] = case.run_along("joint_outputs", given(), &only)?;
            let found: Vec<_> = found.iter().skip(k).step_by(n).copied().collect();
            residuals.extend(differences(&found, &column));
        }
    }
    Some(residuals)
}

/// By columns: how much faster each frame is if one rate is greater by one.
pub fn frame_jacobians<'a>(case: &Case<'a>) -> Option<Vec<Term<'a>>> {
    let n_rates = case.module.joints.as_ref()?.n_rates;
    let maximal = case.maximal(&case.joints);
    let velocities_of = |point: &Point<Term<'a>>| {
        let textbook = case.textbook(point)?;
        let velocity = |kind: &OutputKind| textbook.output(kind, &[], &[]);
        frames(case.model).map(|frame| velocity(&frame.kind)).collect::<Option<Vec<_>>>()
    };
    let slower = velocities_of(&maximal)?.concat();
    let found = case.run("frame_jacobians", &case.point);
    let mut residuals = Vec::new();
    for (rate, column) in free_motions(case)?.into_iter().enumerate() {
        let mut faster = maximal.clone();
        let n = case.n_bodies();
        faster.state[7 * n..13 * n].iter_mut().zip(&column).for_each(|(v, by)| *v = v.add(by));
        let faster = velocities_of(&faster)?.concat();
        let found: Vec<_> = found.iter().skip(rate).step_by(n_rates).copied().collect();
        residuals.extend(differences(&found, &differences(&faster, &slower)));
    }
    Some(residuals)
}

/// The accelerations of frames where u does not change.
pub fn frame_biases<'a>(case: &Case<'a>) -> Option<Vec<Term<'a>>> {
    let layout = case.module.joints.as_ref()?;
    let (zero, one) = (Term::zero(case.point.context), Term::one(case.point.context));
    let at_rest = vec![zero; layout.n_rates];
    let given = Arguments { accelerations: &at_rest, ..case.given(&case.point) };
    let moved = case.results("joint_derivative", given);
    let [state, rates] = case.run_along("to_maximal", case.given(&case.point), &|source| match source {
        Source::Joint(k) => Some(if k < layout.n_coordinates { moved[k] } else { zero }),
        Source::Time => Some(one),
        Source::Input(k) => case.rate_of_input(k),
        _ => None,
    })?;
    let maximal = Point { state, ..case.point.clone() };
    let (textbook, accelerations) = (case.textbook(&maximal)?, velocities(case, &rates));
    let acceleration =
        |frame: &BodyFrame| textbook.output(&OutputKind::Acceleration(frame.clone()), accelerations, &[]);
    let expected = frames(case.model).map(|frame| match &frame.kind {
        OutputKind::Velocity(frame) => acceleration(frame),
        _ => None,
    });
    let expected = expected.collect::<Option<Vec<_>>>()?.concat();
    Some(differences(&case.run("frame_biases", &case.point), &expected))
}
