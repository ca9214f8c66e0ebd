//! SIMD lanes: one call advances two, four or eight scenarios (feature `lanes`).
//!
//! A generated mechanism takes any [`Scalar`](crate::Scalar), so it takes a pack of lanes: `wide`'s [`f64x2`],
//! [`f64x4`], [`f64x8`] and [`f32x8`] are scalars here. Each lane has a state of its own, and parameters of its own,
//! because a mechanism's parameters are fields of the scalar's type. Kernels are straight-line; what a solver decides,
//! it decides lane by lane.
//!
//! * In joint coordinates [`Rk4`](crate::Rk4) takes lanes as it is; [`Direct`] watches the lanes besides.
//! * Under error control, without corrections, [`Adaptive`] has lanes with times and steps of their own.
//! * In maximal coordinates [`Partitioned`] corrects without branches: each lane is on charts of its own, and lanes
//!   that have converged are masked until all have.
//!
//! # Lanes against scalar runs
//! Each lane computes, *bit for bit*, what a run with its numbers alone computes in `f64` or `f32`. Sine and cosine of
//! `f64` are libm's, operation by operation (see `lanes/sine.rs`), and so are square roots; absolute values and choices
//! are instructions. All other functions and tables are left to libm, lane after lane, which is exact and slow. A lane
//! that fails keeps the state in which it failed, and its error; it does not disturb the others.
//!
//! # Speed
//! Packs gain only where the target has registers for them: `-C target-cpu=native`, or x86-64-v3 and v4.
//!
//! # Example
//! Eight gyroscopes of different weight:
//! ```
//! use gyro_sim::lanes::{Lanes, Partitioned, f64x8};
//! use gyro_mechanisms::gyroscope_parameters::{GyroscopeParameters, Parameters};
//! use gyro_sim::Mechanism;
//!
//! let rotor_mass = f64x8::from_lanes(|lane| 0.08 + 0.001 * lane as f64);
//! let gyroscopes = GyroscopeParameters::new(Parameters { rotor_mass, ..Parameters::default() });
//! let mut states = gyroscopes.start();
//! let mut solver = Partitioned::new(&gyroscopes, &states);
//! for interval in 0..100 {
//!     let t = f64x8::splat(5e-4 * f64::from(interval));
//!     solver.advance(&gyroscopes, t, f64x8::splat(1e-4), 5, &mut states);
//! }
//! assert_eq!(solver.failures().count(), 0);
//! let precession = |lane| states[25].lane(lane);
//! assert!(precession(7) > precession(0));
//! ```

mod adaptive;
mod chart;
mod failures;
mod packs;
mod partition;
mod sine;

pub use adaptive::{Adaptive, Outcome};
pub use failures::{Failures, MAX_LANES};
pub use partition::{Direct, Partitioned};
pub use wide::{f32x8, f64x2, f64x4, f64x8};

pub use crate::Lanes;

/// All lanes.
const fn all<T: Lanes>() -> u32 {
    (1 << T::COUNT) - 1
}

/// Where all of these numbers are finite.
fn are_finite<T: Lanes>(numbers: &[T]) -> T::Mask {
    // Zero times infinity or NaN is NaN, and stays NaN in a sum.
    let zero = T::constant(0.0);
    numbers.iter().fold(zero, |sum, x| T::fused(*x, zero, sum)).finite()
}

/// Takes back what has changed in other lanes than these.
fn keep<T: Lanes>(lanes: u32, now: &mut [T], before: &[T]) {
    if lanes == all::<T>() {
        return;
    }
    let mask = T::mask(lanes);
    for (now, before) in now.iter_mut().zip(before) {
        *now = T::select(mask, *now, *before);
    }
}

#[cfg(test)]
mod tests;
