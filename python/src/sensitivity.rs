//! How a motion depends on parameters: the generated functions in dual numbers, stepped along with their slopes.

use crate::dynamics::Dynamics;
use gyro_cli::failure::Failure;
use gyro_cli::library::Stop;
use gyro_jit::Interpreted;
use gyro_runner::motion::COLUMNS;
use gyro_sim::{Dual, Joint, JointSpace, Mechanism as _, Rk4};

type Number = Dual<f64, COLUMNS>;

/// States (x, u) at some times, row after row, and of each number the slopes by the parameters.
pub(crate) struct Sensitivities {
    pub(crate) states: Vec<f64>,
    pub(crate) slopes: Vec<f64>,
}

/// From a state at t = 0 with inputs through increasing times, by Kutta's method of order 4 in steps of at most `step`,
/// until `stop` says so.
pub(crate) fn sensitivities(
    dynamics: &Dynamics,
    (state, inputs): (&[f64], &[f64]),
    (times, step): (&[f64], f64),
    parameters: &[usize],
    stop: Stop<'_>,
) -> Result<Sensitivities, Failure> {
    let n = state.len();
    let mut found =
        Sensitivities { states: Vec::new(), slopes: vec![0.0; times.len() * n * parameters.len()] };
    // Without parameters the states are asked for all the same.
    for first in (0..parameters.len().max(1)).step_by(COLUMNS) {
        let seeded = &parameters[first.min(parameters.len())..(first + COLUMNS).min(parameters.len())];
        let mut mechanism: Interpreted<Number> = dynamics.mechanism.interpreted();
        for (index, &value) in inputs.iter().enumerate() {
            mechanism.set_input(index, Number::new(value));
        }
        for (column, &parameter) in seeded.iter().enumerate() {
            let mut value = Number::new(dynamics.mechanism.parameters()[parameter]);
            value.slopes[column] = 1.0;
            mechanism.set_parameter(parameter, value);
        }
        let (mut x, mut t) = (dynamics.whole(state).into_iter().map(Number::new).collect::<Vec<_>>(), 0.0);
        let mut method = Rk4::new(&x);
        found.states.clear();
        for (row, &to) in times.iter().enumerate() {
            t = advance(&mechanism, &mut method, (t, to, step), &mut x, stop)?;
            found.states.extend(x[..n].iter().map(|number| number.value));
            for (k, number) in x[..n].iter().enumerate() {
                let at = (row * n + k) * parameters.len() + first;
                found.slopes[at..at + seeded.len()].copy_from_slice(&number.slopes[..seeded.len()]);
            }
        }
    }
    Ok(found)
}

/// Equal steps to a time; returns it.
fn advance(
    mechanism: &Interpreted<Number>,
    method: &mut Rk4<Vec<Number>>,
    (from, to, step): (f64, f64, f64),
    x: &mut Vec<Number>,
    stop: Stop<'_>,
) -> Result<f64, Failure> {
    let n_steps = ((to - from) / step).ceil().max(0.0);
    let h = if n_steps > 0.0 { (to - from) / n_steps } else { 0.0 };
    let has_loops = !mechanism.joint_layout().closure_rows.is_empty();
    let mut done = 0.0;
    while done < n_steps {
        if stop() {
            return Err(Failure::Interrupted("interrupted".to_owned()));
        }
        method.step(&Joint, mechanism, Number::new(from + done * h), Number::new(h), x);
        done += 1.0;
        if has_loops {
            mechanism.close_positions(Number::new(from + done * h), x);
            mechanism.close_velocities(Number::new(from + done * h), x);
        }
    }
    Ok(to)
}
