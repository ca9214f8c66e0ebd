//! A solver under way.

use super::attempt::{Look, Shown};
use super::contract::Motion;
use super::course::Course;
use super::feed::{Around, Fed};
use super::kink::struck;
use super::lens::Lens;
use crate::approach::{Approach, Correction as Keeping};
use gyro_sim::integrate::Method;
use gyro_sim::{
    Control, Correction, Dop853, Error, Mechanism, Real, Scalar, Solver, Statistics, When, by_method, contact,
};
use std::fmt::Debug;

pub(super) fn explicit<M, L, C>(
    lens: L,
    correction: C,
    approach: &Approach,
    y: &L::State,
) -> Box<dyn Motion<M>>
where
    M: Mechanism<Scalar: Real> + 'static,
    L: Lens<M>,
    C: Correction<L, M> + 'static,
{
    by_method!(
        approach.integrator,
        fixed A => Box::new(Fixed(solver(lens, A::new(y), correction, approach, y), None)),
        adaptive A => adaptive(lens, A::new(y), correction, approach, y),
        implicit => adaptive(lens, Dop853::new(y), correction, approach, y),
    )
}

pub(super) fn adaptive<M, L, A, C>(
    lens: L,
    method: A,
    correction: C,
    approach: &Approach,
    y: &L::State,
) -> Box<dyn Motion<M>>
where
    M: Mechanism<Scalar: Real> + 'static,
    L: Lens<M>,
    A: Method<Fed<L, M>, M> + 'static,
    C: Correction<L, M> + 'static,
{
    Box::new(Adaptive(solver(lens, method, correction, approach, y), None))
}

type Solving<L, M, S, A, C> = Solver<Fed<L, M>, S, <M as Mechanism>::Scalar, A, Around<C, M>>;

fn solver<L, M: Mechanism<Scalar: Real>, S, A, C>(
    lens: L,
    method: A,
    correction: C,
    approach: &Approach,
    y: &S,
) -> Solving<L, M, S, A, C>
where
    S: Clone + Debug + AsRef<[M::Scalar]> + AsMut<[M::Scalar]>,
{
    let equations = Fed::of(lens);
    let correction = equations.corrected(correction);
    Solver::with_correction(equations, method, correction, Scalar::constant(0.0), y)
        .with_control(control(approach))
}

/// How an approach has steps controlled.
pub(super) fn control(approach: &Approach) -> Control {
    let mut control = Control::default();
    if let Some(tolerance) = approach.tolerance {
        control = control.with_tolerance(tolerance);
    }
    control.budget = approach.budget.unwrap_or(control.budget);
    let has_corrections = !matches!(approach.correction, Keeping::None | Keeping::Baumgarte(_));
    control.when = match (approach.when, approach.tolerance) {
        (Some(when), _) if has_corrections => when.into(),
        (None, Some(_)) if has_corrections => When::Steps(1),
        // Never, or when the schedule says so.
        _ => When::Steps(u32::MAX),
    };
    control
}

/// A method without an error estimate.
struct Fixed<L, M: Mechanism, S, A, C>(Solving<L, M, S, A, C>, Option<Course>);

/// A method with one.
struct Adaptive<L, M: Mechanism, S, A, C>(Solving<L, M, S, A, C>, Option<Course>);

impl<L, M: Mechanism<Scalar: Real>, S, A, C> Adaptive<L, M, S, A, C>
where
    S: Clone + Debug + AsRef<[M::Scalar]> + AsMut<[M::Scalar]>,
{
    /// Where the next step has to end at the latest. A knot that has been reached is left behind: what comes after it
    /// has nothing of what was before.
    fn before_knot(&mut self, t_end: f64) -> f64 {
        let Some(course) = &mut self.1 else { return t_end };
        if let Some(knot) = course.pass::<M::Scalar>(self.0.time().to_f64()) {
            self.0.dynamics_mut().enter(course, knot);
            self.0.system_has_changed();
        }
        course.ahead::<M::Scalar>().map_or(t_end, |knot| knot.min(t_end))
    }
}

macro_rules! motion {
    ($type:ident, |$self:ident, $mechanism:ident, $t_end:ident, $look:pat_param| $towards:expr) => {
        impl<M, L, A, C> Motion<M> for $type<L, M, L::State, A, C>
        where
            M: Mechanism<Scalar: Real> + 'static,
            L: Lens<M>,
            A: Method<Fed<L, M>, M>,
            C: Correction<L, M>,
        {
            fn step(&mut self, mechanism: &M, h: f64) -> Result<(), contact::Error> {
                Ok(self.0.step(mechanism, Scalar::constant(h))?)
            }
            fn step_towards(
                &mut $self,
                $mechanism: &M,
                $t_end: f64,
                $look: &mut Look<'_, M>,
            ) -> Result<(), contact::Error> {
                Ok($towards?)
            }
            fn correct(&mut self, mechanism: &M) -> Result<(), Error> {
                self.0.correct(&mechanism)
            }
            fn time(&self) -> f64 {
                self.0.time().to_f64()
            }
            fn at(&mut self, mechanism: &M, t: f64, y: &mut M::State) -> Result<(), Error> {
                let (solver, t) = (&mut self.0, Scalar::constant(t));
                let mut state = solver.state().clone();
                solver.interpolate(mechanism, t, &mut state)?;
                solver.dynamics().lens.show(mechanism, t, &state, y);
                Ok(())
            }
            fn set_input(&mut self, index: usize, value: f64) {
                self.0.dynamics_mut().set_input(index, value);
                self.0.system_has_changed();
            }
            fn follow(&mut self, inputs: Option<M>, course: Course) {
                let dynamics = self.0.dynamics_mut();
                if let Some(mechanism) = inputs {
                    dynamics.follow(mechanism);
                }
                dynamics.enter(&course, 0.0);
                self.1 = Some(course);
                self.0.system_has_changed();
            }
            fn strike(&mut self, before: [&M; 2], after: [&M; 2]) {
                let at = (self.0.time(), self.0.state());
                let y = struck(&self.0.dynamics().lens, at, [before, after]);
                self.0.set_state(&y);
                self.0.system_has_changed();
            }
            fn statistics(&self) -> Statistics {
                *self.0.statistics()
            }
            fn chart_switches(&self) -> u64 {
                Correction::<Fed<L, M>, M>::switches(self.0.correction())
            }
        }
    };
}

motion!(Adaptive, |self, mechanism, t_end, look| {
    let t_end = Scalar::constant(self.before_knot(t_end));
    let mut x = self.0.state().clone();
    self.0.step_watched(mechanism, t_end, |tried| {
        let show = |dynamics: &Fed<L, M>, t, x: &L::State, y: &mut M::State| {
            dynamics.lens.show(mechanism, t, x, y);
        };
        look(&mut Shown { tried, x: &mut x, show }).map(Scalar::constant)
    })
});

motion!(Fixed, |self, mechanism, t_end, _| {
    let h = t_end - self.time();
    self.0.step(mechanism, Scalar::constant(h))
});
