//! One gyroscope of the ensemble.

use gyro_mechanisms::gyroscope_misalignments::{GyroscopeMisalignments, Parameters};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// The rotor's joint is on the drawing's place, an eighth of a millimetre off centre, to within this much in each
/// direction, m.
const JOINT: f64 = 2e-5;

/// The rotor's mass centre is on its spin axis to within this much in each direction, m.
const BALANCE: f64 = 2e-6;

/// The rotor's principal axis is its spin axis but for products of inertia up to this, kg·m²: about a milliradian.
const PRODUCT: f64 = 5e-9;

/// What misaligns it, in the order of the mechanism's parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Scenario(pub(crate) [f64; Scenario::SIZE]);

impl Scenario {
    /// Number of parameters.
    pub(crate) const SIZE: usize = GyroscopeMisalignments::<f64>::PARAMETERS.len();

    /// The scenario of this index, whichever others are drawn: each has a stream of random numbers of its own.
    pub(crate) fn drawn(seed: u64, index: u64) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        random.set_stream(index);
        let nominal = Parameters::<f64>::default();
        let mut within = |value: f64, tolerance: f64| value + random.random_range(-tolerance..=tolerance);
        Self([
            within(nominal.offset_x, JOINT),
            within(nominal.offset_y, JOINT),
            within(nominal.offset_z, JOINT),
            within(nominal.imbalance_y, BALANCE),
            within(nominal.imbalance_z, BALANCE),
            within(nominal.product_xy, PRODUCT),
            within(nominal.product_xz, PRODUCT),
        ])
    }
}
