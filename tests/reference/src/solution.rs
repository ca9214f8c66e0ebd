//! The motion at the times asked for.

use crate::extrapolation::{Scheme, State};
use crate::trajectory::{SolveError, trajectory};
use crate::{DoubleDouble, Gyroscope};

/// The motion at one time: angles and rates of the joints, and the energy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample<T = f64> {
    /// Time, s.
    pub t: T,
    /// Angle of the outer ring, rad.
    pub alpha: T,
    /// Angle of the inner ring, rad.
    pub beta: T,
    /// Angle of the rotor against the inner ring, rad, over all turns.
    pub phi: T,
    /// α̇, rad/s.
    pub alpha_rate: T,
    /// β̇, rad/s.
    pub beta_rate: T,
    /// φ̇, rad/s.
    pub phi_rate: T,
    /// Kinetic energy of rings and rotor plus the rotor's potential, J; see [`Gyroscope::energy`].
    pub energy: T,
}

impl Sample<DoubleDouble> {
    /// The same sample in `f64`, each value correctly rounded.
    #[must_use]
    pub fn rounded(&self) -> Sample {
        let [t, alpha, beta, phi, alpha_rate, beta_rate, phi_rate, energy] =
            self.values().map(DoubleDouble::to_f64);
        Sample { t, alpha, beta, phi, alpha_rate, beta_rate, phi_rate, energy }
    }
}

impl<T: Copy> Sample<T> {
    /// Time, angles, rates and energy, in the order of the fields.
    #[must_use]
    pub fn values(&self) -> [T; 8] {
        let Sample { t, alpha, beta, phi, alpha_rate, beta_rate, phi_rate, energy } = *self;
        [t, alpha, beta, phi, alpha_rate, beta_rate, phi_rate, energy]
    }
}

impl Gyroscope {
    /// The motion at `times` (s, ascending from zero; repetitions allowed), correctly rounded to `f64`.
    ///
    /// A time stands for the decimal it prints as, so that 0.1 is one tenth of a second. Values are good to the last
    /// bit of the `f64`: see [`solve_precisely`](Self::solve_precisely), which also reports errors.
    ///
    /// # Panics
    /// Where `solve_precisely` with the default [`Scheme`] returns an error.
    #[must_use]
    pub fn solve(&self, times: &[f64]) -> Vec<Sample> {
        match self.solve_precisely(times, &Scheme::default()) {
            Ok(samples) => samples.iter().map(Sample::rounded).collect(),
            Err(error) => panic!("{error}"),
        }
    }

    /// The motion at `times`, as [`solve`](Self::solve) reads them, in all the digits computed.
    ///
    /// With the default scheme the error of the scenes over the first second is below 1e-24 relative to the largest
    /// value of the quantity; it grows in proportion to time.
    ///
    /// # Errors
    /// [`SolveError`] if the times do not ascend from zero or the integration does not converge.
    pub fn solve_precisely(
        &self,
        times: &[f64],
        scheme: &Scheme,
    ) -> Result<Vec<Sample<DoubleDouble>>, SolveError> {
        let start = joined(self.start.angles, self.start.rates());
        let motion = trajectory(|_, state| self.derivative(state), scheme, start, times)?;
        Ok(motion.iter().map(|(t, state)| self.sample(*t, state)).collect())
    }

    fn derivative(&self, state: &State<6>) -> State<6> {
        let (angles, rates) = parted(state);
        joined(rates, self.accelerations(angles, rates))
    }

    fn sample(&self, t: DoubleDouble, state: &State<6>) -> Sample<DoubleDouble> {
        let (angles, rates) = parted(state);
        let energy = self.energy(angles, rates);
        let ([alpha, beta, phi], [alpha_rate, beta_rate, phi_rate]) = (angles, rates);
        Sample { t, alpha, beta, phi, alpha_rate, beta_rate, phi_rate, energy }
    }
}

fn joined(angles: [DoubleDouble; 3], rates: [DoubleDouble; 3]) -> State<6> {
    let ([alpha, beta, phi], [alpha_rate, beta_rate, phi_rate]) = (angles, rates);
    [alpha, beta, phi, alpha_rate, beta_rate, phi_rate]
}

fn parted(state: &State<6>) -> ([DoubleDouble; 3], [DoubleDouble; 3]) {
    let [alpha, beta, phi, alpha_rate, beta_rate, phi_rate] = *state;
    ([alpha, beta, phi], [alpha_rate, beta_rate, phi_rate])
}
