//! Rigid stops and dry friction that sticks, on coordinates of a system, and surfaces that touch: motions in phases,
//! with events between them.
//!
//! A [`Contact`] acts along one coordinate. It may stop the coordinate at two ends, each unilateral: the coordinate
//! *hits* it, with an impulse that reverses the rate by Newton's law of restitution; *rests* on it, held by a force
//! that only pushes; and is *let go* when the force would have to pull. And it may rub: a coordinate that moves is
//! opposed by the kinetic level of friction, and one that is at rest *sticks*, held by whatever force it takes as long
//! as this is below the static level.
//!
//! A coordinate that is held has a rate of zero and an acceleration of zero, not small ones: it does not move by one
//! bit. Its force F makes it so, `W F + b = 0`, with b the accelerations of the coordinates without these forces and W
//! those that unit forces add: both are the system's own ([`Forced`]), whatever constraints it has.
//! ```
//! use gyro_sim::contact::{Contact, Forced, Hybrid};
//! use gyro_sim::{Control, Dop853, Ode};
//!
//! /// A ball that falls.
//! #[derive(Clone, Copy)]
//! struct Ball;
//!
//! impl Ode for Ball {
//!     type Scalar = f64;
//!     type State = [f64; 2];
//!
//!     fn derivative(&self, _: &(), _t: f64, y: &[f64; 2], dy: &mut [f64; 2]) {
//!         *dy = [y[1], -9.81];
//!     }
//! }
//!
//! impl Forced for Ball {
//!     fn rates(&self, _: &()) -> core::ops::Range<usize> {
//!         1..2
//!     }
//!     fn forced(&self, _: &(), _t: f64, y: &[f64; 2], forces: &[f64], dy: &mut [f64; 2]) {
//!         *dy = [y[1], forces[0] - 9.81];
//!     }
//! }
//!
//! # fn main() -> Result<(), gyro_sim::contact::Error> {
//! let floor = Contact::new(0, 1).with_stops([0.0, f64::INFINITY], 0.5).unwrap();
//! let start = [1.0, 0.0];
//! let mut ball = Hybrid::new(Ball, [floor], Dop853::new(&start), 0.0, &start);
//! ball.advance_to(&(), 2.0)?;
//! // After 1.35 s and some forty bounces it lies on the floor.
//! assert_eq!(*ball.state(), [0.0, 0.0]);
//! assert!((ball.record().lost - 9.81).abs() < 1e-9);
//! # Ok(())
//! # }
//! ```
//!
//! # Surfaces
//! Two bodies that touch at a point are three contacts ([`Contact::surfaces`]): the gap between them, which is
//! unilateral, and the velocities of slip along two tangents. Friction is within the cone `|f| ≤ μ f_push`, and against
//! the slip exactly where there is some. With any of them all that is said below of impacts and rest is one
//! complementarity problem in cones, which is solved by relaxation and by Newton's method; impacts have friction, and
//! restitution after Newton or Poisson. What rests is projected after each step: neither gap nor slip drifts.
//!
//! # Coordinates of loops
//! A coordinate need not be an element of the state: the system may tell its value, rate and acceleration
//! ([`Contact::seen`]), as of a joint that closes a loop. It is held to rounding. Where coordinates depend on each
//! other ([`Forced::shares`]), forces of what holds are found as those of surfaces: what one of them cannot hold
//! others do, what is at the bound of its friction pulls on while others hold it, and a coordinate that no friction
//! can hold, as in the dead centre of a linkage, passes through rest.
//!
//! # What is solved when phases change
//! * **Impacts.** All contacts that are hit, and those rested on, at one instant are resolved together: impulses P with
//!   the rates `u⁺ = u⁻ + W P` after them, P ≥ 0, `u⁺ + e u⁻ ≥ 0`, one of both zero (outward positive). A stop that is
//!   touched but being left is not to be passed, `u⁺ ≥ 0`. Where that has no solution, or would increase the kinetic
//!   energy, as it can with stops that are being left, nothing rebounds. Dry friction has no impulse: a coordinate that
//!   sticks is set free by one that reaches it.
//! * **Rest.** Where several coordinates have a rate of zero, each may be held, by a force within its bounds, or move
//!   up or down, with an acceleration that does so. All combinations are tried, those that hold most first, and the
//!   first is taken that is consistent; a coordinate whose bound was just reached is tried moving first. So the work is
//!   bounded: 3ⁿ solutions of at most n equations, n being the number of coordinates at rest.
//! * **Infinitely many impacts in finite time.** When a rebound would be slower than 1e-12 of the fastest impact on the
//!   contact, the coordinate comes to rest instead ([`Record::settled`] counts this). A mass that bounces with
//!   restitution e is then `2 v⁺ / (a (1 − e))` from its last impact, at most 1e-12 of that time for the fastest one.
//!
//! # Friction in proportion to a reaction
//! The level of friction may grow with a reaction R, as that in a bearing: by μ |R|, or μ r |R| about an axis
//! ([`Contact::with_loaded_friction`]). R depends on all accelerations and so on friction itself: it is an affine
//! function of the forces of contacts, whose coefficients the system says ([`Forced::reactions`]). Reactions, friction
//! and the forces of what is held are solved together wherever the equations are evaluated, nothing lags behind, by
//! Newton's method for `F_k = ∓(c_k + μ_k |R_k(F)|)`. Of a change of friction `L = (μ_k |∂R_k/∂F_j|)` bounds what comes
//! back. Where the spectral radius of L is less than one there is exactly one solution, and each iteration comes nearer
//! to it. Elsewhere friction may jam (Painlevé): there may be no solution, or several. The motion then ends in
//! [`Error::Jammed`], and so it does where no combination of phases is consistent.
//!
//! # Order under steps of fixed length
//! [`Hybrid::step`], and [`Stepped`] for small machines, decide at the step's end: coordinates beyond a stop are set
//! back to it and hit it; rates that have changed their sign under friction are set to zero; forces beyond their
//! bounds let go. Each is of order one in the step. What rebounds is the lesser of the rates of approach at the
//! beginning and the end of the step: a stop that is found late gives no energy, and flights shorter than a step are
//! none, so that what bounces comes to rest.

mod cones;
mod equations;
mod error;
mod guards;
mod hybrid;
mod impacts;
mod integrated;
mod joint;
mod loads;
mod resolve;
mod rest;
mod search;
mod settle;
mod small;
mod stepped;

pub use equations::{Contacts, Forced};
pub use error::Error;
pub use hybrid::Hybrid;
pub use integrated::Kept;
pub use joint::{JointInputs, LoadedJointInputs, joint_accelerations};
pub use settle::{Change, Record};
pub use stepped::Stepped;

use crate::Real;

/// What acts along a coordinate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact<T> {
    role: Role,
    /// The indices of the coordinate and of its rate in the state.
    coordinate: usize,
    rate: usize,
    /// Where it is stopped; infinite where it is not.
    ends: [T; 2],
    restitution: T,
    /// Kinetic and static level of friction, and what the reaction adds to them.
    levels: [T; 2],
    coefficients: [T; 2],
    /// Whether restitution is that of impulses (Poisson) rather than that of rates (Newton).
    is_of_impulses: bool,
}

/// What the value and the rate of a contact are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Role {
    /// Elements of the state.
    Coordinate,
    /// A coordinate that is no element of the state, of which the system tells all.
    Seen,
    /// The gap between two surfaces, which the system tells.
    Gap,
    /// A component of the velocity with which surfaces slip: of which gap, and the first or the second.
    Slip { gap: usize, is_second: bool },
}

impl<T: Real> Contact<T> {
    /// Nothing yet, along the coordinate that has this index in the state, and its rate that one. What has no such
    /// index is zero, and stays so.
    pub fn new(coordinate: usize, rate: usize) -> Self {
        let (zero, infinite) = (T::constant(0.0), T::constant(f64::INFINITY));
        Self {
            role: Role::Coordinate,
            coordinate,
            rate,
            ends: [-infinite, infinite],
            restitution: zero,
            levels: [zero; 2],
            coefficients: [zero; 2],
            is_of_impulses: false,
        }
    }

    /// Nothing yet, along a coordinate that is no element of the state: the system tells its value, rate and
    /// acceleration ([`Forced::seen`]).
    pub fn seen() -> Self {
        Self { role: Role::Seen, ..Self::new(usize::MAX, usize::MAX) }
    }

    /// Two surfaces that touch at a point: three contacts, of which the first has this place among all. They are the
    /// gap and the two components of the velocity with which the surfaces slip, of all of which the system tells value,
    /// rate and acceleration ([`Forced::seen`]); their forces push along the normal and rub along the two tangents.
    /// Restitution is that of rates (Newton) or of impulses (Poisson). Friction holds, or opposes the direction of slip
    /// exactly, with the static or the kinetic coefficient times the push; `None` unless restitution is between 0 and 1
    /// and `0 ≤ kinetic ≤ static`, both finite.
    #[must_use]
    pub fn surfaces(place: usize, restitution: Restitution<T>, coefficients: [T; 2]) -> Option<[Self; 3]> {
        let (zero, none) = (T::constant(0.0), usize::MAX);
        let (share, is_of_impulses) = match restitution {
            Restitution::Newton(share) => (share, false),
            Restitution::Poisson(share) => (share, true),
        };
        let of = |role| Self { role, ..Self::new(none, none) };
        let gap = Self { is_of_impulses, ..of(Role::Gap) };
        let gap = gap.with_stops([zero, T::constant(f64::INFINITY)], share)?;
        let slip = |is_second| {
            of(Role::Slip { gap: place, is_second }).with_loaded_friction(coefficients[0], coefficients[1])
        };
        Some([gap, slip(false)?, slip(true)?])
    }

    /// Stops at a lower and an upper end, in the coordinate's unit, infinite where there is none, with a coefficient of
    /// restitution; `None` if the ends are not in this order or the coefficient is not between 0 and 1.
    #[must_use]
    pub fn with_stops(self, ends: [T; 2], restitution: T) -> Option<Self> {
        let is_coefficient = T::constant(0.0) <= restitution && restitution <= T::constant(1.0);
        (ends[0] < ends[1] && is_coefficient).then_some(Self { ends, restitution, ..self })
    }

    /// Dry friction with these levels of the force (N, or N m along an angle), kinetic and static; `None` unless
    /// `0 ≤ kinetic ≤ static` and both are finite.
    #[must_use]
    pub fn with_friction(self, kinetic: T, at_rest: T) -> Option<Self> {
        let is_ordered = T::constant(0.0) <= kinetic && kinetic <= at_rest && at_rest.is_finite();
        is_ordered.then_some(Self { levels: [kinetic, at_rest], ..self })
    }

    /// Dry friction in proportion to the [reaction](Forced::reactions) R of the contact, besides: the kinetic and the
    /// static level are greater by these coefficients times |R|. A coefficient is that of friction, along an angle
    /// times the bearing's radius, m. `None` unless `0 ≤ kinetic ≤ static` and both are finite.
    #[must_use]
    pub fn with_loaded_friction(self, kinetic: T, at_rest: T) -> Option<Self> {
        let is_ordered = T::constant(0.0) <= kinetic && kinetic <= at_rest && at_rest.is_finite();
        is_ordered.then_some(Self { coefficients: [kinetic, at_rest], ..self })
    }

    /// Whether it does anything.
    fn acts(&self) -> bool {
        self.rubs() || self.grips() || self.ends.iter().any(|end| end.is_finite())
    }

    /// Whether friction opposes a coordinate.
    fn rubs(&self) -> bool {
        self.levels[1] > T::constant(0.0) || self.is_loaded()
    }

    /// Whether its friction depends on a reaction.
    fn is_loaded(&self) -> bool {
        matches!(self.role, Role::Coordinate | Role::Seen) && self.coefficients[1] > T::constant(0.0)
    }

    /// Whether friction opposes the slip of surfaces.
    fn grips(&self) -> bool {
        matches!(self.role, Role::Gap | Role::Slip { .. }) && self.coefficients[1] > T::constant(0.0)
    }

    /// Whether, of both ends, the upper one is the nearer.
    fn is_nearer_upper(&self, x: T) -> bool {
        x - self.ends[0] > self.ends[1] - x
    }

    /// The gap whose push bounds friction, and whether this is the second of the two components.
    fn slip(&self) -> Option<(usize, bool)> {
        match self.role {
            Role::Slip { gap, is_second } => Some((gap, is_second)),
            Role::Coordinate | Role::Seen | Role::Gap => None,
        }
    }
}

/// What is left after an impact of surfaces: a part from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Restitution<T> {
    /// Of the rate at which they approach each other.
    Newton(T),
    /// Of the impulse that ends the approach.
    Poisson(T),
}

/// What a contact does for the time being.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// Nothing: the coordinate moves without friction.
    Free,
    /// The coordinate moves up, against friction.
    Up,
    /// The coordinate moves down, against friction.
    Down,
    /// Friction holds it.
    Sticks,
    /// It rests on its lower stop.
    AtLower,
    /// It rests on its upper stop.
    AtUpper,
    /// Surfaces slip on each other, against friction.
    Slides,
}

impl Phase {
    /// Whether the coordinate is held.
    pub const fn is_held(self) -> bool {
        matches!(self, Self::Sticks | Self::AtLower | Self::AtUpper)
    }
}

#[cfg(test)]
mod tests;
