//! Attempts of steps, as runs see them who have a say.

use gyro_sim::{Mechanism, Real, Scalar, Tried};

/// An attempt of a step under error control, before it is judged.
pub trait Attempt<M: Mechanism> {
    /// The times at which it begins and ends, s.
    fn span(&self) -> [f64; 2];
    /// Whether its error is tolerated.
    fn fits(&mut self) -> bool;
    /// Writes the maximal state at a fraction of it, not corrected.
    fn at(&mut self, theta: f64, y: &mut M::State);
}

/// Who looks at attempts: where there is a time within one, it is repeated, not beyond that time.
pub type Look<'a, M> = dyn FnMut(&mut dyn Attempt<M>) -> Option<f64> + 'a;

/// An attempt, shown as a maximal state.
pub(super) struct Shown<'a, D, S, T, F> {
    pub(super) tried: &'a mut dyn Tried<D, S, T>,
    /// Room for a state.
    pub(super) x: &'a mut S,
    /// Shows a state at a time.
    pub(super) show: F,
}

impl<M, D, S, F> Attempt<M> for Shown<'_, D, S, M::Scalar, F>
where
    M: Mechanism<Scalar: Real>,
    F: Fn(&D, M::Scalar, &S, &mut M::State),
{
    fn span(&self) -> [f64; 2] {
        self.tried.span().map(Real::to_f64)
    }

    fn fits(&mut self) -> bool {
        self.tried.fits()
    }

    fn at(&mut self, theta: f64, y: &mut M::State) {
        let (theta, [from, to]) = (M::Scalar::constant(theta), self.tried.span());
        self.tried.at(theta, self.x);
        (self.show)(self.tried.dynamics(), M::Scalar::fused(theta, to - from, from), self.x, y);
    }
}
