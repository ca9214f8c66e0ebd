//! One-step methods for first-order systems, and the trait that they implement.
//!
//! | method | order | for |
//! |---|---|---|
//! | [`Kutta4`] | 4, fixed steps | the paper's settings; [`Rk4`] is its bare step, for small machines |
//! | [`Tsit5`] | 5(4) | moderate tolerances |
//! | [`Dop853`] | 8(5, 3) | fine tolerances; the cheapest on smooth motions from 1e-5 on |
//! | [`Rodas4`] | 4(3), L-stable | stiff scenes; needs a system with its [`Jacobian`](crate::Jacobian) |
//!
//! A method holds its own work space, whose size is part of the type of the state: nothing is allocated. Methods do not
//! depend on mechanisms or corrections; [`Solver`](crate::Solver) combines them.

mod choice;
mod dop853;
mod kutta4;
mod lu;
mod rk4;
mod rodas4;
mod tsit5;

#[cfg(feature = "wire")]
use crate::wire::*;
pub use dop853::Dop853;
pub use kutta4::Kutta4;
pub use rk4::Rk4;
pub use rodas4::Rodas4;
pub use tsit5::Tsit5;

choice::methods! { $
    /// Kutta's classical method of order 4, fixed steps.
    fixed "rk4" Rk4 = Kutta4, 4;
    /// Tsitouras's pair of orders 5 and 4.
    adaptive "tsit5" Tsit5 = Tsit5, 5;
    /// Dormand and Prince's method of order 8.
    adaptive "dop853" Dop853 = Dop853, 8;
    /// Rodas: L-stable, of order 4.
    implicit "rodas4" Rodas4 = Rodas4, 4;
}

use crate::contract::Storage;
use crate::{Lanes, Ode, Real, Scalar, System};

/// A one-step method: a step of a given length from a given state, and the states within it.
///
/// A method that estimates its own error has an [`ERROR_ORDER`](Method::ERROR_ORDER) and implements [`Method::error`];
/// without them it is for steps of fixed length.
pub trait Method<D: Ode<M>, M = ()> {
    /// Order p: over a given time the error of fixed steps h shrinks like hᵖ.
    const ORDER: u32;
    /// The largest |hλ| of a decaying motion (real λ) that the method follows without growing; infinite for L-stable
    /// methods.
    const STABILITY: f64;
    /// The error estimate shrinks like h to the power of this; zero for a method without an estimate.
    const ERROR_ORDER: u32 = 0;

    /// Steps from `y` at `t` to [`Method::end`] at `t + h`, and counts what it evaluates. With `resumes`, `t` and `y`
    /// are those of the last attempt, or its end exactly as it was after [`Method::carry`] has returned that its slope
    /// is known: what was found there is used again.
    fn attempt(
        &mut self,
        system: System<'_, D, M>,
        t: D::Scalar,
        h: D::Scalar,
        y: &D::State,
        resumes: bool,
        work: &mut Work,
    );
    /// Where the last attempt ended.
    fn end(&self) -> &D::State;
    /// Makes the end of the last attempt the start of the next; returns whether the slope there is known already.
    fn carry(&mut self) -> bool;
    /// Prepares [`Method::between`] within the last attempt, before it is carried.
    fn prepare(
        &mut self,
        system: System<'_, D, M>,
        t: D::Scalar,
        h: D::Scalar,
        y: &D::State,
        work: &mut Work,
    );
    /// Writes the state at `t + θ h` within the step that was prepared, 0 ≤ θ ≤ 1.
    fn between(&self, theta: D::Scalar, out: &mut D::State);
    /// Numerator and denominator, squared, of an estimate of the fastest rate |λ| of the system that the last attempt
    /// has met; both zero where there is no estimate.
    fn rate(&self) -> [D::Scalar; 2];
    /// The estimated error of the last attempt in units of the tolerance, the root mean square over the elements of the
    /// state, and the index of the worst. The weights are the tolerated errors of each element. Infinite where the
    /// result of the attempt is not finite.
    fn error(&self, _h: D::Scalar, _weights: &D::State) -> (D::Scalar, usize)
    where
        D::Scalar: Real,
    {
        (D::Scalar::constant(0.0), 0)
    }
}

/// An explicit method with error estimates, which can be attempted in the lanes of packs: what has to be decided lane
/// by lane is apart from what is computed in all.
pub trait Embedded<D: Ode<M>, M = ()>: Method<D, M> {
    /// What the error of an element of the state is estimated from.
    fn estimates(&self, h: D::Scalar, element: usize) -> [D::Scalar; 2];
    /// [`Method::error`] of these estimates.
    fn size(
        h: D::Scalar,
        weights: &D::State,
        estimates: impl Fn(usize) -> [D::Scalar; 2],
    ) -> (D::Scalar, usize)
    where
        D::Scalar: Real;
    /// Makes the slopes at `t` and `y` those of the next attempts, which all resume: in lanes that were carried `y` is
    /// the end of the last attempt, in those that begin it is another state, and in others the last attempt is
    /// repeated.
    fn renew(
        &mut self,
        system: System<'_, D, M>,
        t: D::Scalar,
        y: &D::State,
        carried: <D::Scalar as Lanes>::Mask,
        begun: Option<<D::Scalar as Lanes>::Mask>,
    ) where
        D::Scalar: Lanes;
}

/// Takes over elements in these lanes.
#[inline(always)]
fn take_over<T: Lanes, S: Storage<T>>(lanes: T::Mask, to: &mut S, from: &S) {
    for (to, from) in to.as_mut().iter_mut().zip(from.as_ref()) {
        *to = T::select(lanes, *from, *to);
    }
}

/// The cost of the steps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "wire", derive(SerBin, DeBin))]
pub struct Work {
    /// Evaluations of the right-hand side.
    pub evaluations: u64,
    /// Evaluations of the Jacobian, each with a factorisation.
    pub jacobians: u64,
}

/// Writes `y + h Σ a k`.
#[inline(always)]
fn combine<T: Scalar, S: Storage<T>, const N: usize>(out: &mut S, y: &S, h: T, terms: [(f64, &S); N]) {
    let terms = terms.map(|(a, k)| (T::constant(a), k.as_ref()));
    let y = y.as_ref();
    for (i, (out, y)) in (0..y.len()).zip(out.as_mut().iter_mut().zip(y)) {
        *out = T::fused(h, sum(&terms, i), *y);
    }
}

/// `Σ a k` of one element, from coefficients.
#[inline(always)]
fn sum_at<T: Scalar, S: Storage<T>, const N: usize>(terms: [(f64, &S); N], i: usize) -> T {
    sum(&terms.map(|(a, k)| (T::constant(a), k.as_ref())), i)
}

#[inline(always)]
fn sum<T: Scalar, const N: usize>(terms: &[(T, &[T]); N], i: usize) -> T {
    let (a, k) = terms[0];
    let mut sum = a * k[i];
    for (a, k) in &terms[1..] {
        sum = T::fused(*a, k[i], sum);
    }
    sum
}

/// The root mean square of the elements' errors over their weights, and the index of the largest.
#[inline(always)]
fn root_mean_square<T: Real, S: Storage<T>>(weights: &S, error: impl Fn(usize) -> T) -> (T, usize) {
    let (mut sum, mut worst) = (T::constant(0.0), (T::constant(0.0), 0));
    // A state may have no elements.
    let mut n = 0.0_f64;
    for (i, weight) in weights.as_ref().iter().enumerate() {
        let error = (error(i) / *weight).abs();
        if !error.is_finite() {
            return (T::constant(f64::INFINITY), i);
        }
        sum = T::fused(error, error, sum);
        n += 1.0;
        if error > worst.0 {
            worst = (error, i);
        }
    }
    ((sum / T::constant(n.max(1.0))).sqrt(), worst.1)
}

/// The squares of the lengths of differences, of slopes and of the states that they belong to: a rate.
#[inline]
fn rate<T: Scalar, S: Storage<T>>(slopes: [&S; 2], states: [&S; 2]) -> [T; 2] {
    [slopes, states].map(|[a, b]| {
        let differences = a.as_ref().iter().zip(b.as_ref()).map(|(a, b)| *a - *b);
        differences.fold(T::constant(0.0), |sum, d| T::fused(d, d, sum))
    })
}
