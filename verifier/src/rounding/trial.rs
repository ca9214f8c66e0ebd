//! One configuration of a tree: every kernel that gives accelerations, in `f64` and in 384 bits.

use super::to_length_one;
use crate::atoms::Elementary;
use crate::field::{Field, Precision, Real};
use crate::interpreter::{self, Given};
use crate::joints::JointLayout;
use crate::module::{Module, is_on_constraints};
use crate::point::Point;
use crate::states;
use gyro_model::Model;

/// The kernels of a trial.
pub const KERNELS: [&str; 5] = [
    "accelerations",
    "corrected_accelerations",
    "corrected_solution",
    "joint_accelerations",
    "joint_accelerations_at",
];

/// What the kernels gave.
#[derive(Clone, Debug)]
pub struct Trial<'c> {
    /// The maximal state in `f64`.
    pub state: Vec<f64>,
    /// Error of each kernel in `f64`, in the order of [`KERNELS`]: the largest error of a result in terms of the
    /// largest result. Of u̇ in terms of the largest of u̇ and v̇: in gimbal lock u̇ may vanish while all else
    /// accelerates.
    pub errors: [f64; KERNELS.len()],
    /// (s̈, ẇ') in 384 bits.
    pub accelerations: Vec<Real<'c>>,
}

/// Tries a joint state `(x, u)`, the maximal state of it violated by as much as `violation` says for each of its
/// numbers. The kernels of corrected states are tried on the state itself. `None` where a kernel divides by zero in 384
/// bits, or for a mechanism that is not a tree.
pub fn trial<'c>(
    model: &Model,
    module: &Module,
    precision: &'c Precision,
    joints: &[f64],
    violation: &[f64],
) -> Option<Trial<'c>> {
    let exactly = |x: f64| Real::new(precision, x);
    let mut exact_joints: Vec<_> = joints.iter().map(|&x| exactly(x)).collect();
    module
        .joints
        .iter()
        .flat_map(JointLayout::euler)
        .for_each(|e| to_length_one(&mut exact_joints[e..e + 4]));
    let constants = interpreter::constants(precision, module);
    let start = states::point(model, precision, &module.start, 0.0, exactly);
    let run = |function: &str, point: &Point<Real<'c>>| {
        let given = Given { point, accelerations: &[], charts: &[], changes: &[], joints: &exact_joints };
        interpreter::run(module, module.programs.get(function)?, &constants, &Elementary, &given).ok()
    };
    let corrected = Point { state: run("to_maximal", &start)?, ..start };
    let mut violated = corrected.clone();
    violated.state.iter_mut().zip(violation).for_each(|(x, &by)| *x = x.add(&exactly(by)));
    let n = model.coordinate_bodies().len();
    violated.state[..7 * n].chunks_mut(7).for_each(|position| to_length_one(&mut position[3..]));

    let rounded = |numbers: &[Real<'_>]| numbers.iter().map(Real::to_f64).collect::<Vec<_>>();
    let short_constants: Vec<f64> = interpreter::constants((), module);
    let short_joints = rounded(&exact_joints);
    let run_short = |function: &str, point: &Point<f64>| {
        let given = Given { point, accelerations: &[], charts: &[], changes: &[], joints: &short_joints };
        interpreter::run(module, module.programs.get(function)?, &short_constants, &Elementary, &given).ok()
    };
    // Both are told the same state, the one that is rounded: what is left is the kernel's own error.
    let states = [rounded(&corrected.state), rounded(&violated.state)];
    let [corrected, violated] =
        states.each_ref().map(|state| states::point(model, precision, state, 0.0, exactly));
    let [short_corrected, short_violated] = states.map(|state| states::point(model, (), &state, 0.0, |x| x));
    let accelerations = run("accelerations", &violated)?;
    let mut errors = [0.0; KERNELS.len()];
    for (error, kernel) in errors.iter_mut().zip(KERNELS) {
        let (exact, rounded) = if is_on_constraints(kernel) {
            (run(kernel, &corrected)?, run_short(kernel, &short_corrected))
        } else {
            (run(kernel, &violated)?, run_short(kernel, &short_violated))
        };
        let scale = if kernel.starts_with("joint") { &accelerations[..] } else { &[] };
        *error = rounded.map_or(f64::INFINITY, |rounded| relative_error(&exact, &rounded, scale));
    }
    Some(Trial { state: short_violated.state, errors, accelerations })
}

/// The largest error in terms of the largest number, also among those of `scale`; infinite where something is not a
/// number.
pub fn relative_error(exact: &[Real<'_>], computed: &[f64], scale: &[Real<'_>]) -> f64 {
    let largest = exact.iter().chain(scale).map(|x| x.to_f64().abs()).fold(0.0, f64::max);
    let error = exact
        .iter()
        .zip(computed)
        .map(|(x, &y)| if y.is_finite() { x.sub(&x.like(y)).to_f64().abs() } else { f64::INFINITY });
    let error = error.fold(0.0, f64::max);
    if error == 0.0 { 0.0 } else { error / largest }
}
