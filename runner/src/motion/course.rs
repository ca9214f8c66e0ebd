//! What inputs are over time.

use crate::Input;
use gyro_sim::Real;

/// What the inputs are over time, and where the motion is not smooth.
#[derive(Clone, Debug, Default)]
pub struct Course {
    /// The inputs.
    inputs: Vec<Input>,
    /// Times, s, ascending and after zero, at which steps end.
    knots: Vec<f64>,
    /// How many of them have been passed.
    passed: usize,
}

impl Course {
    /// The course of these inputs, with further knots.
    pub(crate) fn new(inputs: &[Input], further: &[f64]) -> Self {
        let mut knots: Vec<f64> =
            inputs.iter().flat_map(Input::knots).chain(further.iter().copied()).collect();
        knots.retain(|knot| *knot > 0.0);
        knots.sort_by(f64::total_cmp);
        knots.dedup();
        Self { inputs: inputs.to_vec(), knots, passed: 0 }
    }

    /// The inputs.
    pub(super) fn inputs(&self) -> &[Input] {
        &self.inputs
    }

    /// The next knot as times are counted in some precision.
    pub(super) fn ahead<T: Real>(&self) -> Option<f64> {
        self.knots.get(self.passed).map(|knot| T::constant(*knot).to_f64())
    }

    /// Passes all knots up to a time; the last of them, if there are any.
    pub(super) fn pass<T: Real>(&mut self, t: f64) -> Option<f64> {
        let before = self.passed;
        while self.ahead::<T>().is_some_and(|knot| knot <= t) {
            self.passed += 1;
        }
        (self.passed > before).then(|| self.knots[self.passed - 1])
    }
}
