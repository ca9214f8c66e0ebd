//! Equations with contacts as methods integrate them.

use super::Phase;
use super::equations::{Contacts, Forced};
use super::loads::Acting;
use super::small::{at, larger, set};
use crate::{Clearance, Correction, Error, Jacobian, Ode, Real};

/// What is smaller than this, in its unit, is differentiated as if it were that large.
const NEAR: f64 = 1e-3;

impl<M, D, T: Real, const N: usize> Ode<M> for Contacts<D, T, N>
where
    D: Forced<M, Scalar = T>,
{
    type Scalar = T;
    type State = D::State;

    fn derivative(&self, model: &M, t: T, y: &D::State, dy: &mut D::State) {
        let Acting { forces, jam, .. } = self.forces(model, (t, y), dy);
        self.dynamics.forced(model, t, y, &forces, dy);
        if jam.is_some() {
            // No step is to go on from here.
            dy.as_mut().fill(T::constant(f64::NAN));
            return;
        }
        for (k, contact) in self.contacts.iter().enumerate() {
            if self.is_pinned(k) {
                set(dy.as_mut(), contact.coordinate, T::constant(0.0));
                set(dy.as_mut(), contact.rate, T::constant(0.0));
            }
        }
    }

    fn normalise(&self, model: &M, y: &mut D::State) {
        self.dynamics.normalise(model, y);
    }
}

/// Where a contact acts, by central differences: what holds it depends on the state too.
impl<M, D, T: Real, const N: usize> Jacobian<M> for Contacts<D, T, N>
where
    D: Forced<M, Scalar = T> + Jacobian<M>,
{
    type Matrix = D::Matrix;

    fn jacobian(&self, model: &M, t: T, y: &D::State, dfdy: &mut D::Matrix, dfdt: &mut D::State) {
        if self.phases.iter().all(|phase| *phase == Phase::Free) {
            return self.dynamics.jacobian(model, t, y, dfdy, dfdt);
        }
        let step = |x: T| T::constant(libm::cbrt(T::EPSILON.to_f64())) * larger(x.abs(), T::constant(NEAR));
        let [mut there, mut before, mut after] = [y.clone(), y.clone(), y.clone()];
        let n = y.as_ref().len();
        for k in 0..n {
            let x = at(y.as_ref(), k);
            let [low, high] = [x - step(x), x + step(x)];
            set(there.as_mut(), k, low);
            self.derivative(model, t, &there, &mut before);
            set(there.as_mut(), k, high);
            self.derivative(model, t, &there, &mut after);
            set(there.as_mut(), k, x);
            let slopes = after.as_ref().iter().zip(before.as_ref());
            for (place, (after, before)) in dfdy.as_mut().iter_mut().skip(k).step_by(n).zip(slopes) {
                *place = (*after - *before) / (high - low);
            }
        }
        let [low, high] = [t - step(t), t + step(t)];
        self.derivative(model, low, y, &mut before);
        self.derivative(model, high, y, &mut after);
        let slopes = after.as_ref().iter().zip(before.as_ref());
        for (place, (after, before)) in dfdt.as_mut().iter_mut().zip(slopes) {
            *place = (*after - *before) / (high - low);
        }
    }
}

/// A correction of the equations without contacts.
#[derive(Clone, Debug)]
pub struct Kept<C>(pub C);

impl<M, D, C, T: Real, const N: usize> Correction<Contacts<D, T, N>, M> for Kept<C>
where
    D: Forced<M, Scalar = T>,
    C: Correction<D, M>,
{
    fn correct(&mut self, model: &M, t: T, y: &mut D::State) -> Result<(), Error> {
        self.0.correct(model, t, y)
    }
    fn refer_turns(&mut self, model: &M, t: T, y: &mut D::State) {
        self.0.refer_turns(model, t, y);
    }
    fn violation(&mut self, model: &M, t: T, y: &D::State) -> T {
        self.0.violation(model, t, y)
    }
    fn switches(&self) -> u64 {
        self.0.switches()
    }
    fn clearance(&self, model: &M, t: T, y: &D::State) -> Option<Clearance<T>> {
        self.0.clearance(model, t, y)
    }
}
