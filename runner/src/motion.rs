//! A motion under way, whatever integrates it.

use crate::approach::{Approach, Coordinates, Correction as Keeping, Integrator};
use crate::offers::Offers;
use crate::pivots;
use gyro_sim::integrate::Method;
use gyro_sim::{
    Baumgarte, ByDuals, Clearance, ClosedForm, Control, Coordinate, Corrected, Correction, Dop853, Dual,
    Equations, Error, Exact, Joint, JointSpace, Kutta4, MassWeighted, Mechanism, Ode, Partition,
    Partitioning, Real, Rodas4, Scalar, Solver, Statistics, Tsit5, Uncorrected, Watched, When,
};
use std::fmt::Debug;

/// A motion of a mechanism. The mechanism is handed in at each call, so that its inputs can be set in between.
pub trait Motion<M: Mechanism> {
    /// One step of this length.
    ///
    /// # Errors
    /// [`Error`] of the solver.
    fn step(&mut self, mechanism: &M, h: f64) -> Result<(), Error>;
    /// One step under error control, not beyond `t_end`.
    ///
    /// # Errors
    /// [`Error`] of the solver.
    fn step_towards(&mut self, mechanism: &M, t_end: f64) -> Result<(), Error>;
    /// Corrects the state.
    ///
    /// # Errors
    /// [`Error`] of the correction.
    fn correct(&mut self, mechanism: &M) -> Result<(), Error>;
    /// The time, s.
    fn time(&self) -> f64;
    /// Writes the maximal state at a time within the last step.
    ///
    /// # Errors
    /// [`Error`] of the correction.
    fn at(&mut self, mechanism: &M, t: f64, y: &mut M::State) -> Result<(), Error>;
    /// An input of the mechanism has changed.
    fn set_input(&mut self, index: usize, value: f64);
    /// What the steps have cost and met.
    fn statistics(&self) -> Statistics;
    /// How often independent coordinates have been chosen anew.
    fn chart_switches(&self) -> u64;
}

/// What there is to begin motions of a mechanism with: more for some than for others.
pub trait MotionBuilder<M: Partition<Scalar: Real>> {
    /// A motion from a maximal state at time zero; in words why there cannot be one.
    ///
    /// # Errors
    /// What the mechanism lacks for this approach.
    fn begin(&self, mechanism: &M, approach: &Approach, y: &M::State) -> Result<Box<dyn Motion<M>>, String>;
    /// What can be asked for; the precision and the inputs are the run's.
    fn offers(&self) -> Offers {
        Offers { joint_space: false, derivatives: false, projection: false, ..Offers::ALL }
    }
    /// The work of the applied forces over the mechanism's size and of their moments over a radian, J: what energies are rounded
    /// against. Zero where the forces are not at hand.
    fn work_scale(&self, _mechanism: &M, _t: f64, _y: &M::State) -> f64 {
        0.0
    }
    /// The smallest pivot of the constraint Jacobian by full pivoting, lengths in units of the mechanism's size; `None` where the
    /// Jacobian is not at hand. It vanishes in singular poses.
    fn smallest_pivot(&self, _mechanism: &M, _t: f64, _y: &M::State) -> Option<f64> {
        None
    }
    /// The linearisation of the joint form about a maximal state; `None` for what has no joint form.
    ///
    /// `nearest` has for each coordinate, joint after joint, the continuous angle, which the state alone does not tell.
    fn linearise(&self, _mechanism: &M, _t: f64, _y: &M::State, _nearest: &[f64]) -> Option<Linear> {
        None
    }
}

/// A tree's joint form near a state: `ẋ ≈ f + A δx + B δu`, with x the joint coordinates and rates, u the inputs.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Linear {
    /// Time, s.
    pub t: f64,
    /// The joint state.
    pub state: Vec<f64>,
    /// Its derivative.
    pub slope: Vec<f64>,
    /// A = ∂f/∂x, row by row.
    pub by_state: Vec<f64>,
    /// B = ∂f/∂u, row by row.
    pub by_inputs: Vec<f64>,
}

impl Linear {
    /// The same without the last element of the state: the work done, on which nothing depends.
    pub(crate) fn without_last(self) -> Self {
        let n = self.state.len();
        let n_inputs = self.by_inputs.len().checked_div(n).unwrap_or(0);
        let Some(kept) = n.checked_sub(1) else { return self };
        let rows = self.by_state.chunks_exact(n).take(kept);
        Self {
            t: self.t,
            by_state: rows.flat_map(|row| &row[..kept]).copied().collect(),
            by_inputs: self.by_inputs[..kept * n_inputs].to_vec(),
            state: self.state[..kept].to_vec(),
            slope: self.slope[..kept].to_vec(),
        }
    }
}

fn in_f64<T: Real>(numbers: &[T]) -> Vec<f64> {
    numbers.iter().map(|x| x.to_f64()).collect()
}

/// For whatever can be partitioned.
#[derive(Clone, Copy, Debug)]
pub struct Any;

/// For mechanisms with a projection too.
#[derive(Clone, Copy, Debug)]
pub struct Projecting;

/// For any mechanism whose kernels exist in dual numbers too.
#[derive(Clone, Copy, Debug)]
pub struct WithDuals<D>(pub D);

/// For trees.
#[derive(Clone, Copy, Debug)]
pub struct Tree<D>(pub D);

/// For trees with a generated Jacobian.
#[derive(Clone, Copy, Debug)]
pub struct TreeWithJacobian<D>(pub D);

/// Columns of a Jacobian that are computed at a time.
pub const COLUMNS: usize = 4;

impl<M: Partition<Scalar: Real> + 'static> MotionBuilder<M> for Any {
    fn begin(&self, mechanism: &M, approach: &Approach, y: &M::State) -> Result<Box<dyn Motion<M>>, String> {
        only_maximal(approach)?;
        only_explicit(approach)?;
        match approach.correction {
            Keeping::Partition => {
                Ok(explicit(Slopes::of(Corrected), partitioning(mechanism, y), approach, y))
            }
            Keeping::None => {
                Ok(explicit(Slopes::of(Exact), Boxed(Box::new(Watched::new(mechanism))), approach, y))
            }
            other => {
                Err(format!("the correction {other} needs a projection, which this mechanism does not have"))
            }
        }
    }
}

impl<M: Partition<Scalar: Real> + Equations + 'static> MotionBuilder<M> for Projecting {
    fn begin(&self, mechanism: &M, approach: &Approach, y: &M::State) -> Result<Box<dyn Motion<M>>, String> {
        only_maximal(approach)?;
        only_explicit(approach)?;
        let correction = keeping(mechanism, approach, y)?;
        Ok(maximal(approach, correction, y))
    }

    fn offers(&self) -> Offers {
        Offers { joint_space: false, derivatives: false, ..Offers::ALL }
    }

    fn work_scale(&self, mechanism: &M, t: f64, y: &M::State) -> f64 {
        work_scale(mechanism, t, y)
    }

    fn smallest_pivot(&self, mechanism: &M, t: f64, y: &M::State) -> Option<f64> {
        Some(pivots::smallest(mechanism, t, y))
    }
}

impl<M, D> MotionBuilder<M> for WithDuals<D>
where
    M: Partition<Scalar: Real> + Equations + 'static,
    D: Mechanism<Scalar = Dual<M::Scalar, COLUMNS>> + Clone + 'static,
{
    fn begin(&self, mechanism: &M, approach: &Approach, y: &M::State) -> Result<Box<dyn Motion<M>>, String> {
        only_maximal(approach)?;
        let correction = keeping(mechanism, approach, y)?;
        if approach.integrator == Integrator::Rodas4 {
            return Ok(implicit(approach, self.0.clone(), correction, y));
        }
        Ok(maximal(approach, correction, y))
    }

    fn offers(&self) -> Offers {
        Offers { joint_space: false, ..Offers::ALL }
    }

    fn work_scale(&self, mechanism: &M, t: f64, y: &M::State) -> f64 {
        work_scale(mechanism, t, y)
    }

    fn smallest_pivot(&self, mechanism: &M, t: f64, y: &M::State) -> Option<f64> {
        Some(pivots::smallest(mechanism, t, y))
    }
}

impl<M, D> MotionBuilder<M> for Tree<D>
where
    M: Partition<Scalar: Real> + JointSpace + 'static,
    D: JointSpace<Scalar = Dual<M::Scalar, COLUMNS>> + Clone + 'static,
{
    fn begin(&self, mechanism: &M, approach: &Approach, y: &M::State) -> Result<Box<dyn Motion<M>>, String> {
        if approach.coordinates == Coordinates::Maximal {
            return in_maximal(mechanism, approach, &self.0, y);
        }
        let x = joints(mechanism, y);
        if approach.integrator == Integrator::Rodas4 {
            let method = Rodas4::new(&x, vec![M::Scalar::constant(0.0); square(x.as_ref())]);
            return Ok(adaptive(joint_duals(&self.0), method, Uncorrected, approach, &x));
        }
        Ok(explicit(Joint, Uncorrected, approach, &x))
    }

    fn offers(&self) -> Offers {
        Offers::ALL
    }

    fn work_scale(&self, mechanism: &M, t: f64, y: &M::State) -> f64 {
        work_scale(mechanism, t, y)
    }

    fn smallest_pivot(&self, mechanism: &M, t: f64, y: &M::State) -> Option<f64> {
        Some(pivots::smallest(mechanism, t, y))
    }

    fn linearise(&self, mechanism: &M, t: f64, y: &M::State, nearest: &[f64]) -> Option<Linear> {
        let (x, time) = (joints_near(mechanism, t, y, nearest), Scalar::constant(t));
        let zero = M::Scalar::constant(0.0);
        let (mut by_state, mut by_time) = (vec![zero; square(x.as_ref())], x.clone());
        let mut slope = x.clone();
        mechanism.joint_derivative(time, &x, &mut slope);
        joint_duals(&self.0).jacobian(mechanism, time, &x, &mut by_state, &mut by_time);
        let n_inputs = mechanism.description().inputs.len();
        let mut by_inputs = vec![zero; n_inputs * x.as_ref().len()];
        for input in 0..n_inputs {
            let column = input_column(&self.0, input, time, x.as_ref());
            for (row, slope) in by_inputs.chunks_exact_mut(n_inputs).zip(column) {
                row[input] = slope;
            }
        }
        Some(Linear {
            t,
            state: in_f64(x.as_ref()),
            slope: in_f64(slope.as_ref()),
            by_state: in_f64(&by_state),
            by_inputs: in_f64(&by_inputs),
        })
    }
}

impl<M, D> MotionBuilder<M> for TreeWithJacobian<D>
where
    M: Partition<Scalar: Real>
        + JointSpace<
            Jacobian: AsRef<[M::Scalar]> + AsMut<[M::Scalar]> + Debug,
            InputJacobian: AsRef<[M::Scalar]>,
        > + 'static,
    D: Mechanism<Scalar = Dual<M::Scalar, COLUMNS>> + Clone + 'static,
{
    fn begin(&self, mechanism: &M, approach: &Approach, y: &M::State) -> Result<Box<dyn Motion<M>>, String> {
        if approach.coordinates == Coordinates::Maximal {
            return in_maximal(mechanism, approach, &self.0, y);
        }
        let x = joints(mechanism, y);
        if approach.integrator == Integrator::Rodas4 {
            let method = Rodas4::new(&x, mechanism.joint_buffers().jacobian);
            return Ok(adaptive(Joint, method, Uncorrected, approach, &x));
        }
        Ok(explicit(Joint, Uncorrected, approach, &x))
    }

    fn offers(&self) -> Offers {
        Offers::ALL
    }

    fn work_scale(&self, mechanism: &M, t: f64, y: &M::State) -> f64 {
        work_scale(mechanism, t, y)
    }

    fn smallest_pivot(&self, mechanism: &M, t: f64, y: &M::State) -> Option<f64> {
        Some(pivots::smallest(mechanism, t, y))
    }

    fn linearise(&self, mechanism: &M, t: f64, y: &M::State, nearest: &[f64]) -> Option<Linear> {
        let (x, time) = (joints_near(mechanism, t, y, nearest), Scalar::constant(t));
        let (mut slope, mut by_time) = (x.clone(), x.clone());
        let buffers = mechanism.joint_buffers();
        let (mut by_state, mut by_inputs) = (buffers.jacobian, buffers.input_jacobian);
        mechanism.joint_derivative(time, &x, &mut slope);
        mechanism.joint_jacobian(time, &x, &mut by_state, &mut by_time);
        mechanism.joint_input_jacobian(time, &x, &mut by_inputs);
        Some(Linear {
            t,
            state: in_f64(x.as_ref()),
            slope: in_f64(slope.as_ref()),
            by_state: in_f64(by_state.as_ref()),
            by_inputs: in_f64(by_inputs.as_ref()),
        })
    }
}

fn only_maximal(approach: &Approach) -> Result<(), String> {
    match approach.coordinates {
        Coordinates::Maximal => Ok(()),
        Coordinates::Joint => {
            Err("joint coordinates are for trees of joints, and for generated code".to_owned())
        }
    }
}

fn only_explicit(approach: &Approach) -> Result<(), String> {
    if approach.integrator == Integrator::Rodas4 {
        return Err("rodas4 needs derivatives, which only generated code has".to_owned());
    }
    Ok(())
}

/// The work of all applied forces over the mechanism's size and of all moments over a radian, J.
fn work_scale<M: Equations<Scalar: Real>>(mechanism: &M, t: f64, y: &M::State) -> f64 {
    let mut forces = mechanism.terms().velocities;
    mechanism.applied_force(Scalar::constant(t), y, &mut forces);
    let size = mechanism.size().to_f64();
    let work = |(k, force): (usize, &M::Scalar)| {
        let force = force.abs().to_f64();
        if k % 6 < 3 { force * size } else { force }
    };
    forces.as_ref().iter().enumerate().map(work).sum()
}

fn square<T>(state: &[T]) -> usize {
    state.len() * state.len()
}

/// ∂f/∂u of one input. What the input is set to does not matter: it enters linearly.
fn input_column<T: Real, D>(duals: &D, input: usize, t: T, x: &[T]) -> Vec<T>
where
    D: JointSpace<Scalar = Dual<T, COLUMNS>> + Clone,
{
    let mut duals = duals.clone();
    let (mut arguments, zero, one) = (duals.joint_start(), T::constant(0.0), T::constant(1.0));
    let slopes = core::array::from_fn(|k| if k == 0 { one } else { zero });
    duals.set_input(input, Dual { value: zero, slopes });
    for (argument, value) in arguments.as_mut().iter_mut().zip(x) {
        *argument = Dual::new(*value);
    }
    let mut out = arguments.clone();
    duals.joint_derivative(Dual::new(t), &arguments, &mut out);
    out.as_ref().iter().map(|number| number.slopes[0]).collect()
}

/// The joint state of a maximal one, its angles nearest to given ones: one number for each coordinate, joint after joint.
fn joints_near<M: JointSpace>(mechanism: &M, t: f64, y: &M::State, nearest: &[f64]) -> M::Joints {
    let mut x = mechanism.joint_start();
    let coordinates = mechanism.description().joints.iter().flat_map(|joint| joint.coordinates);
    let mut place = 0;
    for (coordinate, angle) in coordinates.zip(nearest) {
        if let (Coordinate::Angle, Some(x)) = (coordinate, x.as_mut().get_mut(place)) {
            *x = Scalar::constant(*angle);
        }
        place += if *coordinate == Coordinate::Orientation { 4 } else { 1 };
    }
    mechanism.to_joints(Scalar::constant(t), y, &mut x);
    x
}

/// The joint state of a maximal one.
fn joints<M: JointSpace>(mechanism: &M, y: &M::State) -> M::Joints {
    let mut x = mechanism.joint_start();
    mechanism.to_joints(Scalar::constant(0.0), y, &mut x);
    x
}

/// Equations of a mechanism that are integrated, and how their state is shown.
trait Lens<M: Mechanism>: Ode<M, Scalar = M::Scalar, State: 'static> + 'static {
    /// Writes the maximal state.
    fn show(&self, mechanism: &M, t: M::Scalar, from: &Self::State, to: &mut M::State);
    fn set_input(&mut self, _index: usize, _value: f64) {}
}

fn copy<M: Mechanism>(from: &M::State, to: &mut M::State) {
    to.as_mut().copy_from_slice(from.as_ref());
}

type Derivative<M> =
    dyn Fn(&M, <M as Mechanism>::Scalar, &<M as Mechanism>::State, &mut <M as Mechanism>::State);

/// Maximal coordinates: one of the right-hand sides that a mechanism has there. Boxed, like corrections, so that integrators are not
/// compiled anew for each.
struct Slopes<M: Mechanism>(Box<Derivative<M>>);

impl<M: Mechanism + 'static> Slopes<M> {
    fn of(dynamics: impl Ode<M, Scalar = M::Scalar, State = M::State> + 'static) -> Self {
        Self(Box::new(move |mechanism, t, y, dy| dynamics.derivative(mechanism, t, y, dy)))
    }
}

impl<M: Mechanism> Ode<M> for Slopes<M> {
    type Scalar = M::Scalar;
    type State = M::State;
    type Jacobian = ();

    fn derivative(&self, mechanism: &M, t: M::Scalar, y: &M::State, dy: &mut M::State) {
        self.0(mechanism, t, y, dy);
    }
}

impl<M: Mechanism<State: 'static> + 'static> Lens<M> for Slopes<M> {
    fn show(&self, _: &M, _: M::Scalar, from: &M::State, to: &mut M::State) {
        copy::<M>(from, to);
    }
}

/// Maximal coordinates, with a Jacobian by dual numbers.
type Duals<D, T> = ByDuals<Exact, D, <D as Mechanism>::State, Vec<T>, COLUMNS>;

impl<M, D> Lens<M> for Duals<D, M::Scalar>
where
    M: Mechanism<State: 'static, Scalar: 'static> + 'static,
    D: Mechanism<Scalar = Dual<M::Scalar, COLUMNS>, State: 'static> + 'static,
{
    fn show(&self, _: &M, _: M::Scalar, from: &M::State, to: &mut M::State) {
        copy::<M>(from, to);
    }
    fn set_input(&mut self, index: usize, value: f64) {
        self.in_duals_mut().set_input(index, Scalar::constant(value));
    }
}

impl<M: JointSpace<Joints: 'static> + 'static> Lens<M> for Joint {
    fn show(&self, mechanism: &M, t: M::Scalar, from: &M::Joints, to: &mut M::State) {
        mechanism.to_maximal(t, from, to);
    }
}

/// Joint coordinates, with a Jacobian by dual numbers.
type JointDuals<D, T> = ByDuals<Joint, D, <D as JointSpace>::Joints, Vec<T>, COLUMNS>;

fn joint_duals<D: JointSpace + Clone, T>(duals: &D) -> JointDuals<D, T> {
    ByDuals::new(Joint, duals.clone(), duals.joint_start())
}

impl<M, D> Lens<M> for JointDuals<D, M::Scalar>
where
    M: JointSpace<Joints: 'static, Scalar: 'static> + 'static,
    D: JointSpace<Scalar = Dual<M::Scalar, COLUMNS>, Joints: 'static> + 'static,
{
    fn show(&self, mechanism: &M, t: M::Scalar, from: &M::Joints, to: &mut M::State) {
        mechanism.to_maximal(t, from, to);
    }
    fn set_input(&mut self, index: usize, value: f64) {
        self.in_duals_mut().set_input(index, Scalar::constant(value));
    }
}

/// Boxed corrections, so that integrators are not compiled anew for each.
trait Keeps<M: Mechanism> {
    fn correct(&mut self, mechanism: &M, t: M::Scalar, y: &mut M::State) -> Result<(), Error>;
    fn violation(&mut self, mechanism: &M, t: M::Scalar, y: &M::State) -> M::Scalar;
    fn switches(&self) -> u64;
}

/// All of them admit exact equations, and those that `maximal` chooses for them.
impl<M: Mechanism, C: Correction<Exact, M>> Keeps<M> for C {
    fn correct(&mut self, mechanism: &M, t: M::Scalar, y: &mut M::State) -> Result<(), Error> {
        Correction::<Exact, M>::correct(self, mechanism, t, y)
    }
    fn violation(&mut self, mechanism: &M, t: M::Scalar, y: &M::State) -> M::Scalar {
        Correction::<Exact, M>::violation(self, mechanism, t, y)
    }
    fn switches(&self) -> u64 {
        Correction::<Exact, M>::switches(self)
    }
}

struct Boxed<M: Mechanism>(Box<dyn Keeps<M>>);

impl<M, D> Correction<D, M> for Boxed<M>
where
    M: Partition<Scalar: Real>,
    D: Ode<M, Scalar = M::Scalar, State = M::State>,
{
    fn correct(&mut self, mechanism: &M, t: M::Scalar, y: &mut M::State) -> Result<(), Error> {
        self.0.correct(mechanism, t, y)
    }
    fn refer_turns(&mut self, mechanism: &M, t: M::Scalar, y: &mut M::State) {
        gyro_sim::refer_turns(mechanism, t, y);
    }
    fn violation(&mut self, mechanism: &M, t: M::Scalar, y: &M::State) -> M::Scalar {
        self.0.violation(mechanism, t, y)
    }
    fn switches(&self) -> u64 {
        self.0.switches()
    }
    fn clearance(&self, mechanism: &M, t: M::Scalar, y: &M::State) -> Option<Clearance<M::Scalar>> {
        mechanism.clearance(t, y)
    }
}

fn keeping<M>(mechanism: &M, approach: &Approach, y: &M::State) -> Result<Boxed<M>, String>
where
    M: Partition<Scalar: Real> + Equations + 'static,
{
    Ok(Boxed(match approach.correction {
        Keeping::Partition => return Ok(partitioning(mechanism, y)),
        Keeping::MassWeighted => Box::new(MassWeighted::new(mechanism)),
        Keeping::None | Keeping::Baumgarte(_) => Box::new(Watched::new(mechanism)),
        Keeping::ClosedForm => return Err("the closed form is for generated code of trees".to_owned()),
    }))
}

fn partitioning<M: Partition<Scalar: Real> + 'static>(mechanism: &M, y: &M::State) -> Boxed<M> {
    Boxed(Box::new(Partitioning::new(mechanism, Scalar::constant(0.0), y)))
}

/// Maximal coordinates of trees.
fn in_maximal<M, D>(
    mechanism: &M,
    approach: &Approach,
    duals: &D,
    y: &M::State,
) -> Result<Box<dyn Motion<M>>, String>
where
    M: Partition<Scalar: Real> + JointSpace + 'static,
    D: Mechanism<Scalar = Dual<M::Scalar, COLUMNS>> + Clone + 'static,
{
    let correction = match approach.correction {
        Keeping::ClosedForm => Boxed(Box::new(ClosedForm::new(mechanism))),
        _ => keeping(mechanism, approach, y)?,
    };
    if approach.integrator == Integrator::Rodas4 {
        return Ok(implicit(approach, duals.clone(), correction, y));
    }
    Ok(maximal(approach, correction, y))
}

/// Explicit methods in maximal coordinates.
fn maximal<M>(approach: &Approach, correction: Boxed<M>, y: &M::State) -> Box<dyn Motion<M>>
where
    M: Partition<Scalar: Real> + Equations + 'static,
{
    let slopes = match approach.correction {
        // The projection is as good as it is only with accelerations that are exact off the constraints.
        Keeping::None | Keeping::MassWeighted => Slopes::of(Exact),
        Keeping::Baumgarte(rate) => Slopes::of(Baumgarte { rate: M::Scalar::constant(rate) }),
        _ => Slopes::of(Corrected),
    };
    explicit(slopes, correction, approach, y)
}

/// Rodas in maximal coordinates.
fn implicit<M, D>(approach: &Approach, duals: D, correction: Boxed<M>, y: &M::State) -> Box<dyn Motion<M>>
where
    M: Partition<Scalar: Real> + 'static,
    D: Mechanism<Scalar = Dual<M::Scalar, COLUMNS>> + 'static,
{
    let method = Rodas4::new(y, vec![M::Scalar::constant(0.0); square(y.as_ref())]);
    let start = duals.start();
    adaptive(ByDuals::new(Exact, duals, start), method, correction, approach, y)
}

fn explicit<M, L, C>(lens: L, correction: C, approach: &Approach, y: &L::State) -> Box<dyn Motion<M>>
where
    M: Mechanism<Scalar: Real> + 'static,
    L: Lens<M>,
    C: Correction<L, M> + 'static,
{
    match approach.integrator {
        Integrator::Rk4 => Box::new(Fixed(solver(lens, Kutta4::new(y), correction, approach, y))),
        Integrator::Tsit5 => adaptive(lens, Tsit5::new(y), correction, approach, y),
        _ => adaptive(lens, Dop853::new(y), correction, approach, y),
    }
}

fn adaptive<M, L, A, C>(
    lens: L,
    method: A,
    correction: C,
    approach: &Approach,
    y: &L::State,
) -> Box<dyn Motion<M>>
where
    M: Mechanism<Scalar: Real> + 'static,
    L: Lens<M>,
    A: Method<L, M> + 'static,
    C: Correction<L, M> + 'static,
{
    Box::new(Adaptive(solver(lens, method, correction, approach, y)))
}

fn solver<L, S, T: Real, A, C>(
    lens: L,
    method: A,
    correction: C,
    approach: &Approach,
    y: &S,
) -> Solver<L, S, T, A, C>
where
    S: Clone + Debug + AsRef<[T]> + AsMut<[T]>,
{
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
    Solver::with_correction(lens, method, correction, T::constant(0.0), y).with_control(control)
}

/// A method without an error estimate.
struct Fixed<L, S, T, A, C>(Solver<L, S, T, A, C>);

/// A method with one.
struct Adaptive<L, S, T, A, C>(Solver<L, S, T, A, C>);

macro_rules! motion {
    ($type:ident, |$self:ident, $mechanism:ident, $t_end:ident| $towards:expr) => {
        impl<M, L, A, C> Motion<M> for $type<L, L::State, M::Scalar, A, C>
        where
            M: Mechanism<Scalar: Real> + 'static,
            L: Lens<M>,
            A: Method<L, M>,
            C: Correction<L, M>,
        {
            fn step(&mut self, mechanism: &M, h: f64) -> Result<(), Error> {
                self.0.step(mechanism, Scalar::constant(h))
            }
            fn step_towards(&mut $self, $mechanism: &M, $t_end: f64) -> Result<(), Error> {
                $towards
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
                solver.dynamics().show(mechanism, t, &state, y);
                Ok(())
            }
            fn set_input(&mut self, index: usize, value: f64) {
                self.0.dynamics_mut().set_input(index, value);
                self.0.system_has_changed();
            }
            fn statistics(&self) -> Statistics {
                *self.0.statistics()
            }
            fn chart_switches(&self) -> u64 {
                Correction::<L, M>::switches(self.0.correction())
            }
        }
    };
}

motion!(Adaptive, |self, mechanism, t_end| self.0.step_towards(mechanism, Scalar::constant(t_end)));
motion!(Fixed, |self, mechanism, t_end| self.step(mechanism, t_end - self.time()));
