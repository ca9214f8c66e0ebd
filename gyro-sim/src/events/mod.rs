//! Events: when functions of time and state cross zero.
//!
//! A function `g(t, y)` that changes sign within a step is followed on the step's interpolant: the time of a crossing
//! is that of the interpolant's root, to rounding, whatever the length of the step. Methods interpolate with the
//! accuracy of their steps or one order less, so an event's time is off by about as much as the state is at the
//! tolerance, divided by the rate of g.
//! ```
//! use gyro_sim::events::{Direction, Events};
//! use gyro_sim::{Control, Dop853, Ode, Solver};
//!
//! /// ÿ = −y, as a first-order system.
//! struct Oscillator;
//!
//! impl Ode for Oscillator {
//!     type Scalar = f64;
//!     type State = [f64; 2];
//!
//!     fn derivative(&self, _: &(), _t: f64, y: &[f64; 2], dy: &mut [f64; 2]) {
//!         *dy = [y[1], -y[0]];
//!     }
//! }
//!
//! # fn main() -> Result<(), gyro_sim::Error> {
//! let start = [1.0, 0.0];
//! let control = Control::default().with_tolerance(1e-12);
//! let mut solver = Solver::new(Oscillator, Dop853::new(&start), 0.0, &start).with_control(control);
//! // Where y is 1/2, either way, and where ẏ rises through zero.
//! let mut events = Events::new([Direction::Both, Direction::Rising], &start);
//! let mut times = [0.0; 4];
//! let mut count = 0;
//! while solver.time() < 6.5 {
//!     solver.step_towards(&(), 6.5)?;
//!     events.within_last_step(&mut solver, &(), |_, _t, y| [y[0] - 0.5, y[1]], |crossing, _y| {
//!         times[count] = crossing.t;
//!         count += 1;
//!         core::ops::ControlFlow::Continue(())
//!     })?;
//! }
//! let pi = core::f64::consts::PI;
//! assert_eq!(count, 3);
//! for (found, expected) in times.iter().zip([pi / 3.0, pi, 5.0 * pi / 3.0]) {
//!     assert!((found - expected).abs() < 1e-11);
//! }
//! # Ok(())
//! # }
//! ```
//!
//! # What is found
//! A crossing is *rising* where g goes from below zero to zero or above, *falling* where it goes from above zero to
//! zero or below. A function that starts at zero has crossed nothing until it has been on one side.
//!
//! Each step is sampled at nine places, eight equal parts apart. Whatever lasts longer than an eighth of a step is
//! found: if g stays on one side for that long, a sample falls there, and its sign differs from those around it. An
//! excursion that is shorter, two crossings between neighbouring samples, is found if g turns back once between
//! them: it is looked for where g falls towards zero from the one sample and away from it at the other, and comes as
//! near as g varies over the step. What can be missed is an excursion shorter than an eighth of a step if g turns more
//! than once in that eighth; [`Control::largest_step`](crate::Control::largest_step) bounds it. A touch that does not
//! go through zero, or by less than rounding, counts or not as rounding has it.

mod root;
mod scan;

pub use root::root;
use scan::scan;
pub(crate) use scan::{Found, first_falling};

use crate::contract::Storage;
use crate::integrate::Method;
use crate::{Correction, Error, Ode, Real, Solver};
use core::ops::ControlFlow;

/// Which crossings count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Direction {
    /// From below zero to zero or above.
    Rising,
    /// From above zero to zero or below.
    Falling,
    /// All.
    #[default]
    Both,
}

impl Direction {
    fn admits(self, rises: bool) -> bool {
        match self {
            Self::Rising => rises,
            Self::Falling => !rises,
            Self::Both => true,
        }
    }
}

/// A crossing of zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing<T> {
    /// Which of the functions.
    pub event: usize,
    /// The time, s.
    pub t: T,
    /// Whether the function rises there.
    pub rises: bool,
}

/// Looks for the crossings of `N` functions in the steps of a solver.
#[derive(Clone, Debug)]
pub struct Events<S, const N: usize> {
    directions: [Direction; N],
    state: S,
}

impl<S: Clone, const N: usize> Events<S, N> {
    /// Functions of which these crossings count, of states like this one.
    pub fn new(directions: [Direction; N], y: &S) -> Self {
        Self { directions, state: y.clone() }
    }

    /// Hands the crossings within the last step to `tell`, each with the state there, in order of time, and of those at
    /// one time in the order of the functions, until it breaks. `functions` has the model, the time and the state.
    ///
    /// The step itself is as it was without events. To be called once after each step; a solver that is to go on from
    /// a crossing is begun anew there.
    ///
    /// # Errors
    /// [`Error`] of [`Solver::interpolate`]; [`Error::NotFinite`] if a function is not finite, whose index counts on
    /// from the last element of the state.
    pub fn within_last_step<D, T, A, C, M>(
        &mut self,
        solver: &mut Solver<D, S, T, A, C>,
        model: &M,
        mut functions: impl FnMut(&M, T, &S) -> [T; N],
        mut tell: impl FnMut(Crossing<T>, &S) -> ControlFlow<()>,
    ) -> Result<ControlFlow<()>, Error>
    where
        S: Storage<T>,
        T: Real,
        D: Ode<M, Scalar = T, State = S>,
        A: Method<D, M>,
        C: Correction<D, M>,
    {
        // Both closures need the solver, one after the other.
        let solver = core::cell::RefCell::new((solver, &mut self.state));
        let values = |theta: T| {
            let (solver, y) = &mut *solver.borrow_mut();
            let t = solver.within(model, theta, y)?;
            let values = functions(model, t, y);
            match values.iter().position(|value| !value.is_finite()) {
                Some(event) => Err(not_finite(t, y.as_ref().len() + event)),
                None => Ok(values),
            }
        };
        scan(&self.directions, values, |Found { event, theta, rises }| {
            let (solver, y) = &mut *solver.borrow_mut();
            let t = solver.within(model, theta, y)?;
            Ok(tell(Crossing { event, t, rises }, y))
        })
    }
}

/// The crossings of functions of time alone within an interval, looked for as [`Events`] does within a step: for those
/// who step and interpolate by other means. `tell` has them in order of time until it breaks.
///
/// # Errors
/// Those of `values` and `tell`.
pub fn crossings<T: Real, E, const N: usize>(
    directions: &[Direction; N],
    [from, to]: [T; 2],
    mut values: impl FnMut(T) -> Result<[T; N], E>,
    mut tell: impl FnMut(Crossing<T>) -> Result<ControlFlow<()>, E>,
) -> Result<ControlFlow<()>, E> {
    let (one, length) = (T::constant(1.0), to - from);
    let at = |theta: T| if theta < one { from + theta * length } else { to };
    scan(
        directions,
        |theta| values(at(theta)),
        |Found { event, theta, rises }| tell(Crossing { event, t: at(theta), rises }),
    )
}

fn not_finite<T: Real>(t: T, index: usize) -> Error {
    Error::NotFinite { t: t.to_f64(), index: u16::try_from(index).unwrap_or(u16::MAX) }
}

#[cfg(test)]
mod tests;
