//! A solver under way.

use super::contract::Motion;
use super::lens::Lens;
use crate::approach::{Approach, Coordinates, Correction as Keeping, Integrator};
use gyro_sim::integrate::{Embedded, Method};
use gyro_sim::{
    Control, Correction, Dop853, Error, Kutta4, Mechanism, Real, Scalar, Solver, Statistics, Storage, Tsit5,
    When,
};

pub(super) fn explicit<M, L, C>(
    lens: L,
    correction: C,
    approach: &Approach,
    y: &L::State,
) -> Box<dyn Motion<M>>
where
    M: Mechanism<Scalar: Real> + 'static,
    L: Lens<M>,
    C: for<'a> Correction<L::System<'a>> + 'static,
{
    match approach.integrator {
        Integrator::Rk4 => {
            Box::new(Fixed(Moving { lens, solver: solver(Kutta4::new(y), correction, approach, y) }))
        }
        Integrator::Tsit5 => adaptive(lens, Tsit5::new(y), correction, approach, y),
        _ => adaptive(lens, Dop853::new(y), correction, approach, y),
    }
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
    A: for<'a> Embedded<L::System<'a>> + 'static,
    C: for<'a> Correction<L::System<'a>> + 'static,
{
    Box::new(Adaptive(Moving { lens, solver: solver(method, correction, approach, y) }))
}

fn solver<S: Storage<T>, T: Real, A, C>(
    method: A,
    correction: C,
    approach: &Approach,
    y: &S,
) -> Solver<S, T, A, C> {
    let mut control = Control::default();
    if let Some(tolerance) = approach.tolerance {
        control = control.with_tolerance(tolerance);
    }
    control.budget = approach.budget.unwrap_or(control.budget);
    let has_corrections = approach.coordinates == Coordinates::Maximal
        && !matches!(approach.correction, Keeping::None | Keeping::Baumgarte(_));
    control.when = match (approach.when, approach.tolerance) {
        (Some(when), _) if has_corrections => when.into(),
        (None, Some(_)) if has_corrections => When::Steps(1),
        // Never, or when the schedule says so.
        _ => When::Steps(u32::MAX),
    };
    Solver::new(method, correction, T::constant(0.0), y).with_control(control)
}

struct Moving<L, S, T, A, C> {
    lens: L,
    solver: Solver<S, T, A, C>,
}

/// A method without an error estimate.
struct Fixed<L, S, T, A, C>(Moving<L, S, T, A, C>);

/// A method with one.
struct Adaptive<L, S, T, A, C>(Moving<L, S, T, A, C>);

macro_rules! motion {
    ($type:ident, $method:ident, |$self:ident, $mechanism:ident, $t_end:ident| $towards:expr) => {
        impl<M, L, A, C> Motion<M> for $type<L, L::State, M::Scalar, A, C>
        where
            M: Mechanism<Scalar: Real> + 'static,
            L: Lens<M>,
            A: for<'a> $method<L::System<'a>>,
            C: for<'a> Correction<L::System<'a>>,
        {
            fn step(&mut self, mechanism: &M, h: f64) -> Result<(), Error> {
                let moving = &mut self.0;
                moving.solver.step(&moving.lens.system(mechanism), Scalar::constant(h))
            }
            fn step_towards(&mut $self, $mechanism: &M, $t_end: f64) -> Result<(), Error> {
                $towards
            }
            fn correct(&mut self, mechanism: &M) -> Result<(), Error> {
                let moving = &mut self.0;
                moving.solver.correct(&moving.lens.system(mechanism))
            }
            fn time(&self) -> f64 {
                self.0.solver.time().to_f64()
            }
            fn at(&mut self, mechanism: &M, t: f64, y: &mut M::State) -> Result<(), Error> {
                let (moving, t) = (&mut self.0, Scalar::constant(t));
                let mut state = moving.solver.state().clone();
                moving.solver.interpolate(&moving.lens.system(mechanism), t, &mut state)?;
                moving.lens.show(mechanism, t, &state, y);
                Ok(())
            }
            fn set_input(&mut self, index: usize, value: f64) {
                self.0.lens.set_input(index, value);
                self.0.solver.system_has_changed();
            }
            fn statistics(&self) -> Statistics {
                *self.0.solver.statistics()
            }
            fn chart_switches(&self) -> u64 {
                self.0.solver.correction().switches()
            }
        }
    };
}

motion!(Adaptive, Embedded, |self, mechanism, t_end| {
    let moving = &mut self.0;
    moving.solver.step_towards(&moving.lens.system(mechanism), Scalar::constant(t_end))
});
motion!(Fixed, Method, |self, mechanism, t_end| self.step(mechanism, t_end - self.time()));
