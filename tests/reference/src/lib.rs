//! Reference solutions: motions in minimal coordinates and double-double arithmetic, or in closed form, that
//! the rest of the workspace is judged by.
//!
//! Nothing here is shared with the other crates: the equations are written by hand, the arithmetic carries
//! 106 bits, and the integrator extrapolates to order 28. Results are rounded to `f64` once, at the end. A
//! number that a caller gives as `f64` stands for the decimal it prints as, as on a page of decimals: 0.1 is
//! one tenth. SI units, angles in radians that count whole turns.
//!
//! | solution | of |
//! |---|---|
//! | [`Gyroscope`] | the gimballed gyroscope on a fixed base, by Kane's equations, in 31 digits |
//! | [`ReducedGyroscope`] | the same reduced to its inner ring's angle, with springs and friction there; for long and stiff motions |
//! | [`moving_base`] | the same on a base that rolls and pitches, with the base's work and the bearings' reactions |
//! | [`Chain`] | any chain of up to four turning or sliding freedoms, on a base that moves |
//! | [`HeavyTop`] | a body on a spherical joint |
//! | [`HookePendulum`] | a body on a universal joint |
//! | [`FourBar`] | a planar four-bar linkage, reduced to its crank |
//! | [`SliderCrank`] | plane and spatial slider-cranks, reduced to the crank |
//! | [`Peaucellier`] | the linkage that draws a straight line, reduced to its crank |
//! | [`StewartPlatform`] | a plate on six legs that forces act along |
//! | [`BushingFourBar`] | the same linkage, its coupler in halves that a stiff bushing joins |
//! | [`CarriedFourBar`] | the same linkage on a carrier that is free in space |
//! | [`GyroscopeFourBar`] | the gyroscope, its inner ring rocked from the base by a crank |
//! | [`DoubleWishbone`] | a quarter of a car on a wheel suspension of two arms |
//! | [`OneAxis`] | a rotor or slider with springs, friction, stops and a sampled input |
//! | [`Pendulum`] | a compound pendulum, its bearing's force, and the parallelogram linkage |
//! | [`Slider`], [`PlanarBlock`], [`FallingSpindle`], [`FallingScrew`], [`GearedDiscs`] | prismatic, planar, cylindrical and screw joint and a gear, in closed form |
//! | [`Bead`], [`RodPendulum`] | a body that turns freely on a line or a rod |
//! | [`Tether`] | a body on a spring-damper between two points |
//!
//! [`scene`] has one for each shipped model file, by its name: the joint coordinates at any times.
//!
//! The [`Gyroscope`] has three angles, all zero where every frame coincides with the global one:
//!
//! | angle | turns | about | orientation |
//! |---|---|---|---|
//! | α | outer ring | global y | A1 = Ry(α) |
//! | β | inner ring | z of the outer ring | A2 = A1 Rz(β) |
//! | φ | rotor | x of the inner ring | A3 = A2 Rx(φ) |
//!
//! Both rings have their mass centre at the origin; the rotor's is r3 = A2 s2' − A3 s3'. The base is fixed.
//!
//! ```
//! use gyro_reference::Gyroscope;
//!
//! let samples = Gyroscope::paper().solve(&[0.0, 0.1]);
//! assert!((samples[1].alpha - 9.336773665737815e-3).abs() < 1e-17);
//! ```

#![deny(missing_docs)]

mod base_motion;
mod body;
mod bushing;
mod carried;
mod carried_four_bar;
mod chain;
mod closed_forms;
mod closing;
mod collocation;
mod decimal;
mod double_double;
mod double_wishbone;
mod dynamics;
mod elementary;
mod extrapolation;
mod four_bar;
mod gyroscope;
mod gyroscope_four_bar;
mod heavy_top;
mod hooke;
mod jet;
mod kane;
mod link;
pub mod moving_base;
mod newton_euler;
mod one_axis;
mod one_freedom;
mod peaucellier;
mod pendulum;
mod real;
mod reduced;
mod rotation;
mod scene;
mod slider_crank;
mod solution;
mod stewart;
mod tabulated;
mod tether;
mod time_jet;
mod trajectory;
mod trigonometry;
mod vector;

pub use base_motion::{BaseMotion, Sinusoid};
pub use body::BodyState;
pub use bushing::BushingFourBar;
pub use carried::{Bead, BeadSample, FreeBody, RodPendulum, RodSample};
pub use carried_four_bar::{CarriedFourBar, Constants};
pub use chain::{Chain, ChainSample, InertialReading, Wrench};
pub use closed_forms::{Derivatives, FallingScrew, FallingSpindle, GearedDiscs, PlanarBlock, Slider};
pub use decimal::ParseDecimalError;
pub use double_double::DoubleDouble;
pub use double_wishbone::{DoubleWishbone, WishboneInstant};
pub use extrapolation::{NotConverged, Scheme};
pub use four_bar::{Bar, Branch, FourBar, FourBarSample};
pub use gyroscope::{Gyroscope, Start};
pub use gyroscope_four_bar::GyroscopeFourBar;
pub use heavy_top::{HeavyTop, TopSample};
pub use hooke::{HookePendulum, HookeSample};
pub use link::{Freedom, Link};
pub use one_axis::{AxisForce, AxisSample, OneAxis, SampledInput, Side};
pub use peaucellier::{Peaucellier, PeaucellierSample};
pub use pendulum::{Pendulum, PendulumSample};
pub use real::Real;
pub use reduced::ReducedGyroscope;
pub use scene::{JointRow, Orientation, SceneReference, scene};
pub use slider_crank::{Member, SliderCrank, SliderCrankSample};
pub use solution::Sample;
pub use stewart::{LegPart, StewartPlatform, StewartSample};
pub use tabulated::{Scene, tabulated};
pub use tether::{Tether, TetherSample};
pub use trajectory::SolveError;
