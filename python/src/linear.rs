//! The linearisation about a state.

use crate::dynamics::Dynamics;
use gyro_runner::Input;
use gyro_runner::motion::{ByDuals, ByJacobian, COLUMNS, Linear, Linearise, OperatingPoint};
use gyro_sim::{Dual, JointSpace, Mechanism as _};

/// `None` where the loops of the mechanism cannot be closed.
pub(crate) fn linearize(dynamics: &Dynamics, t: f64, state: &[f64], inputs: &[f64]) -> Option<Linear> {
    let mechanism = &dynamics.mechanism;
    let (x, mut y) = (dynamics.whole(state), mechanism.start());
    mechanism.to_maximal(t, &x, &mut y);
    let inputs: Vec<Input> =
        inputs.iter().enumerate().map(|(index, &value)| Input::constant(index, value)).collect();
    let at = OperatingPoint { t, y: &y, angles: &dynamics.angles(state), inputs: &inputs };
    let duals = mechanism.interpreted::<Dual<f64, COLUMNS>>();
    if mechanism.has_jacobian() {
        ByJacobian(duals).linearise(mechanism, &at)
    } else {
        ByDuals(duals).linearise(mechanism, &at)
    }
}
