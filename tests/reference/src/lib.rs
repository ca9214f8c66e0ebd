//! The gimballed gyroscope in minimal coordinates and double-double arithmetic: the answer the rest of the
//! workspace is judged by.
//!
//! Nothing here is shared with the other crates: the equations are Kane's, written by hand for the three joint
//! angles, the arithmetic carries 106 bits, and the integrator extrapolates to order 28.
//!
//! Three angles describe the motion, all zero where every frame coincides with the global one:
//!
//! | angle | turns | about | orientation |
//! |---|---|---|---|
//! | α | outer ring | global y | A1 = Ry(α) |
//! | β | inner ring | z of the outer ring | A2 = A1 Rz(β) |
//! | φ | rotor | x of the inner ring | A3 = A2 Rx(φ) |
//!
//! Both rings have their mass centre at the origin; the rotor's is r3 = A2 s2' − A3 s3'. The base is fixed. SI units,
//! angles in radians, φ counts whole turns.
//!
//! ```
//! use gyro_reference::Gyroscope;
//!
//! let samples = Gyroscope::paper().solve(&[0.0, 0.1]);
//! assert!((samples[1].alpha - 9.336773665737815e-3).abs() < 1e-17);
//! ```

#![deny(missing_docs)]

mod decimal;
mod double_double;
mod dynamics;
mod extrapolation;
mod gyroscope;
mod real;
mod solution;
mod tabulated;
mod trigonometry;
mod vector;

pub use decimal::ParseDecimalError;
pub use double_double::DoubleDouble;
pub use extrapolation::{NotConverged, Scheme};
pub use gyroscope::{Gyroscope, Start};
pub use real::Real;
pub use solution::{Sample, SolveError};
pub use tabulated::{Scene, tabulated};
