//! The joint form and the outputs near a state.

use super::contract::{COLUMNS, Element, Linear, OperatingPoint, in_f64, rows};
use super::independent::{Closing, reduced};
use super::lens::{joint_duals, joints_near};
use crate::input::set;
use gyro_sim::{CloseLoops, Dual, Jacobian, JointJacobian, JointSpace, Mechanism, Real, Scalar};

/// The linearisation in all joint coordinates, or with loops in independent ones; `None` where the loops cannot be
/// closed. `jacobians` gives A and B of all coordinates.
fn linearised<M, D>(
    mechanism: &M,
    duals: &D,
    at: &OperatingPoint<'_, M::State>,
    jacobians: impl FnOnce(&D, M::Scalar, &M::Joints) -> [Vec<f64>; 2],
) -> Option<Linear>
where
    M: JointSpace<Scalar: Real>,
    D: Closing<Scalar = Dual<M::Scalar, COLUMNS>> + Clone,
{
    let t = M::Scalar::constant(at.t);
    let mut x = joints_near(mechanism, at.t, at.y, at.angles);
    CloseLoops::new(mechanism).correct(mechanism, t, &mut x).ok()?;
    let mut duals = duals.clone();
    set(&mut duals, at.inputs, at.t);
    let [by_state, by_inputs] = jacobians(&duals, t, &x);
    let (mut slope, mut y, mut outputs) = (x.clone(), mechanism.start(), mechanism.buffers().outputs);
    mechanism.joint_derivative(t, &x, &mut slope);
    mechanism.to_maximal(t, &x, &mut y);
    mechanism.outputs(t, &y, &mut outputs);
    let n_inputs = mechanism.description().inputs.len();
    let [outputs_by_state, outputs_by_inputs] = if outputs.as_ref().is_empty() {
        [vec![], vec![]]
    } else {
        of_outputs(&duals, n_inputs, t, x.as_ref())
    };
    let all = Linear {
        t: at.t,
        elements: Element::all(mechanism.joint_layout()),
        state: in_f64(x.as_ref()),
        slope: in_f64(slope.as_ref()),
        by_state,
        by_inputs,
        outputs: in_f64(outputs.as_ref()),
        outputs_by_state,
        outputs_by_inputs,
    };
    let all = if mechanism.description().has_work { all.without_last() } else { all };
    if mechanism.joint_layout().closure_rows.is_empty() {
        return Some(all);
    }
    Some(reduced(mechanism, &duals, x.as_ref(), &all))
}

/// The same with A and B in dual numbers.
pub(super) fn by_duals<M, D>(mechanism: &M, duals: &D, at: &OperatingPoint<'_, M::State>) -> Option<Linear>
where
    M: JointSpace<Scalar: Real>,
    D: JointSpace<Scalar = Dual<M::Scalar, COLUMNS>> + Clone,
{
    linearised(mechanism, duals, at, |duals, t, x| {
        let zero = M::Scalar::constant(0.0);
        let (mut by_state, mut by_time) = (vec![zero; x.as_ref().len() * x.as_ref().len()], x.clone());
        joint_duals(duals).jacobian(mechanism, t, x, &mut by_state, &mut by_time);
        let by_inputs = by_inputs_of(duals, mechanism.description().inputs.len(), |duals| {
            let (mut arguments, mut out) = (duals.joint_start(), duals.joint_start());
            arguments.as_mut().iter_mut().zip(x.as_ref()).for_each(|(to, &from)| *to = Dual::new(from));
            duals.joint_derivative(Dual::new(t), &arguments, &mut out);
            out.as_ref().to_vec()
        });
        [in_f64(&by_state), by_inputs]
    })
}

/// The same with A and B as they are generated.
pub(super) fn by_jacobian<M, D>(mechanism: &M, duals: &D, at: &OperatingPoint<'_, M::State>) -> Option<Linear>
where
    M: JointJacobian<Scalar: Real>,
    D: Closing<Scalar = Dual<M::Scalar, COLUMNS>> + Clone,
{
    linearised(mechanism, duals, at, |_, t, x| {
        let (mut by_time, buffers) = (x.clone(), mechanism.jacobian_buffers());
        let (mut by_state, mut by_inputs) = (buffers.jacobian, buffers.input_jacobian);
        mechanism.joint_jacobian(t, x, &mut by_state, &mut by_time);
        mechanism.joint_input_jacobian(t, x, &mut by_inputs);
        [in_f64(by_state.as_ref()), in_f64(by_inputs.as_ref())]
    })
}

/// C and D.
fn of_outputs<T: Real, D>(duals: &D, n_inputs: usize, t: T, x: &[T]) -> [Vec<f64>; 2]
where
    D: Closing<Scalar = Dual<T, COLUMNS>> + Clone,
{
    let (t, x): (_, Vec<_>) = (Dual::new(t), x.iter().map(|&value| Dual::new(value)).collect());
    let by_state = jacobian(x.len(), |seeds| {
        let mut x = x.clone();
        x.iter_mut().zip(seeds).for_each(|(number, seed)| number.slopes = *seed);
        duals.outputs_of(t, &x)
    });
    [by_state, by_inputs_of(duals, n_inputs, |duals| duals.outputs_of(t, &x))]
}

/// The Jacobian of a function of `n` arguments, row by row; `f` is given the slopes of each argument.
fn jacobian<T: Real>(n: usize, f: impl Fn(&[[T; COLUMNS]]) -> Vec<Dual<T, COLUMNS>>) -> Vec<f64> {
    let mut columns: Vec<Vec<f64>> = Vec::new();
    for first in (0..n).step_by(COLUMNS) {
        let mut seeds = vec![[T::constant(0.0); COLUMNS]; n];
        let seeded = seeds[first..].iter_mut().take(COLUMNS).enumerate();
        seeded.for_each(|(column, seed)| seed[column] = T::constant(1.0));
        let values = f(&seeds);
        columns.extend(
            (0..COLUMNS.min(n - first))
                .map(|column| values.iter().map(|value| value.slopes[column].to_f64()).collect()),
        );
    }
    rows(&columns)
}

/// The Jacobian of a function by the inputs, row by row. What an input is set to does not matter: it enters linearly.
fn by_inputs_of<T: Real, D>(duals: &D, n_inputs: usize, f: impl Fn(&D) -> Vec<Dual<T, COLUMNS>>) -> Vec<f64>
where
    D: Mechanism<Scalar = Dual<T, COLUMNS>> + Clone,
{
    jacobian(n_inputs, |seeds| {
        let mut duals = duals.clone();
        for (index, &slopes) in seeds.iter().enumerate() {
            duals.set_input(index, Dual { value: T::constant(0.0), slopes });
        }
        f(&duals)
    })
}
