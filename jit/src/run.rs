//! A whole run of a compiled mechanism, for a command line: compiled here once, so that its caller need not be
//! optimised.

use crate::{Compiled, Interpreted, Native};
use gyro_runner::motion::{
    ByDuals, ByJacobian, COLUMNS, Direct, Examined, Implicit, ImplicitInJoints, ImplicitInJointsByDuals,
    InClosedForm, InJoints, Kind, Linearise, MotionBuilder, Nothing, Only, Partitioned, Projected,
    Stabilised, Touching, Tree, TreeWithJacobian, WithDuals,
};
use gyro_runner::protocol::Request;
use gyro_runner::{Approach, Coordinates, Correction, Event, Failure, Settings, Start, Summary, run_by};
use gyro_sim::{Dual, Real};
use std::io;

/// What is known of a run beside its plan. A program that rustc compiles holds the same builder of motions.
#[derive(Clone, Copy, Debug)]
pub struct Runs {
    /// Whether the mechanism has joint coordinates, in which other runs can be made.
    pub joint_space: bool,
    /// Whether it is linearised, and looked at for singular poses.
    pub is_examined: bool,
    /// Whether all functions of solvers are there, as runs need that no program for one kind of run makes.
    pub is_for_all: bool,
}

/// Numbers in which a mechanism is differentiated.
type Duals<T> = Interpreted<Dual<T, COLUMNS>>;

/// Runs a mechanism to a schedule; `tell` receives samples and progress.
///
/// # Errors
/// [`Failure`], that `tell` fails among them; the samples up to it have been told.
pub fn simulate<T: Native + Real>(
    mechanism: &mut Compiled<T>,
    runs: Runs,
    plan: (&Settings, &Approach),
    start: &Start,
    tell: &mut dyn FnMut(Event<'_>) -> io::Result<()>,
) -> Result<Summary, Failure> {
    let builder = builder(mechanism, runs, plan.1);
    run_by(mechanism, &*builder, plan, start, tell)
}

/// Answers a request as a program does that rustc compiles: samples and figures are written to `output`.
///
/// # Errors
/// As [`simulate`].
pub fn answer<T: Native + Real>(
    mechanism: &mut Compiled<T>,
    runs: Runs,
    request: &Request,
    output: &mut dyn io::Write,
) -> Result<Summary, Failure> {
    let builder = builder(mechanism, runs, &request.approach);
    gyro_runner::child::answer(mechanism, &*builder, request, output)
}

/// With what motions are begun.
fn builder<T: Native + Real>(
    mechanism: &Compiled<T>,
    runs: Runs,
    approach: &Approach,
) -> Box<dyn MotionBuilder<Compiled<T>>> {
    let (duals, has_jacobian) = (|| mechanism.interpreted::<Dual<T, COLUMNS>>(), mechanism.has_jacobian());
    if runs.is_for_all {
        return match (runs.joint_space, has_jacobian) {
            (true, true) => Box::new(TreeWithJacobian(duals())),
            (true, false) => Box::new(Tree(duals())),
            (false, _) => Box::new(WithDuals(duals())),
        };
    }
    let is_implicit = approach.integrator.is_implicit();
    match (approach.coordinates, approach.correction, is_implicit) {
        (Coordinates::Joint, _, true) if has_jacobian => only(mechanism, runs, Touching(ImplicitInJoints)),
        (Coordinates::Joint, _, true) => only(mechanism, runs, Touching(ImplicitInJointsByDuals(duals()))),
        (Coordinates::Joint, _, false) => only(mechanism, runs, Touching(InJoints)),
        (_, _, true) => only(mechanism, runs, Implicit(duals())),
        (_, Correction::Partition, _) => only(mechanism, runs, Touching(Partitioned)),
        (_, Correction::ClosedForm, _) => only(mechanism, runs, InClosedForm),
        (_, Correction::MassWeighted, _) => only(mechanism, runs, Projected),
        (_, Correction::Baumgarte(_), _) => only(mechanism, runs, Stabilised),
        (_, Correction::None, _) => only(mechanism, runs, Touching(Direct)),
    }
}

/// Runs of one kind.
fn only<T: Native + Real, K: Kind<Compiled<T>> + 'static>(
    mechanism: &Compiled<T>,
    runs: Runs,
    kind: K,
) -> Box<dyn MotionBuilder<Compiled<T>>> {
    let joint_space = runs.joint_space;
    let only = Only { kind, joint_space };
    if !runs.is_examined {
        return Box::new(only);
    }
    let linearised = Linearised::of(mechanism, joint_space);
    Box::new(Examined { runs: only, linearised })
}

/// How a mechanism is linearised.
enum Linearised<T> {
    Not,
    ByJacobian(Duals<T>),
    ByDuals(Duals<T>),
}

impl<T: Native + Real> Linearised<T> {
    fn of(mechanism: &Compiled<T>, joint_space: bool) -> Self {
        match (joint_space, mechanism.has_jacobian()) {
            (false, _) => Self::Not,
            (true, true) => Self::ByJacobian(mechanism.interpreted()),
            (true, false) => Self::ByDuals(mechanism.interpreted()),
        }
    }
}

impl<T: Native + Real> Linearise<Compiled<T>> for Linearised<T> {
    fn linearise(
        &self,
        mechanism: &Compiled<T>,
        at: &gyro_runner::motion::OperatingPoint<'_, Vec<T>>,
    ) -> Option<gyro_runner::motion::Linear> {
        match self {
            Self::Not => Nothing.linearise(mechanism, at),
            Self::ByJacobian(duals) => ByJacobian(duals.clone()).linearise(mechanism, at),
            Self::ByDuals(duals) => ByDuals(duals.clone()).linearise(mechanism, at),
        }
    }
}
