//! A motion under way, whatever integrates it.

use crate::approach::{Approach, Coordinates, Correction as Keeping, Integrator};
use crate::offers::Offers;
use crate::pivots;
use gyro_sim::integrate::{Embedded, Method};
use gyro_sim::{
    Baumgarte, ByDuals, Clearance, ClosedForm, Control, Coordinate, Correction, Differentiable, Dop853, Dual,
    Error, JointForm, JointJacobian, JointSpace, Kutta4, MassWeighted, Maximal, Mechanism, Ode, Partition,
    Partitioning, Ports, Projection, Real, Rodas4, Scalar, Solver, Statistics, Storage, Tsit5, Uncorrected,
    Watched, When,
};

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
pub trait Kit<M: Partition + Ports> {
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

/// A system with inputs.
pub trait Feed: Ode {
    /// Sets an input until it is set anew.
    fn feed(&mut self, index: usize, value: Self::Scalar);
}

impl<M: Ports> Feed for M {
    fn feed(&mut self, index: usize, value: M::Scalar) {
        self.set_input(index, value);
    }
}

/// Columns of a Jacobian that are computed at a time.
pub const COLUMNS: usize = 4;

impl<M: Partition + Ports + 'static> Kit<M> for Any {
    fn begin(&self, mechanism: &M, approach: &Approach, y: &M::State) -> Result<Box<dyn Motion<M>>, String> {
        only_maximal(approach)?;
        only_explicit(approach)?;
        match approach.correction {
            Keeping::Partition => Ok(explicit(Slopes::corrected(), partitioning(mechanism, y), approach, y)),
            Keeping::None => {
                Ok(explicit(Slopes::exact(), Boxed(Box::new(Watched::new(mechanism))), approach, y))
            }
            other => {
                Err(format!("the correction {other} needs a projection, which this mechanism does not have"))
            }
        }
    }
}

impl<M: Partition + Ports + Projection + 'static> Kit<M> for Projecting {
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

impl<M, D> Kit<M> for WithDuals<D>
where
    M: Partition + Ports + Projection + 'static,
    D: Ode<Scalar = Dual<M::Scalar, COLUMNS>> + Feed + Clone + 'static,
{
    fn begin(&self, mechanism: &M, approach: &Approach, y: &M::State) -> Result<Box<dyn Motion<M>>, String> {
        only_maximal(approach)?;
        let correction = keeping(mechanism, approach, y)?;
        if approach.integrator == Integrator::Rodas4 {
            return Ok(implicit(mechanism, approach, self.0.clone(), correction, y));
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

impl<M, D> Kit<M> for Tree<D>
where
    M: Partition + Ports + Projection + JointSpace + 'static,
    D: Ode<Scalar = Dual<M::Scalar, COLUMNS>> + Feed + JointSpace + Clone + 'static,
{
    fn begin(&self, mechanism: &M, approach: &Approach, y: &M::State) -> Result<Box<dyn Motion<M>>, String> {
        if approach.coordinates == Coordinates::Maximal {
            return in_maximal(mechanism, approach, &self.0, y);
        }
        let x = joints(mechanism, y);
        if approach.integrator == Integrator::Rodas4 {
            let duals = JointDuals(self.0.clone(), vec![M::Scalar::constant(0.0); square(x.as_ref())]);
            let method = Rodas4::new(&duals.system(mechanism), &x);
            return Ok(adaptive(duals, method, Uncorrected, approach, &x));
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
        let duals = JointDuals(self.0.clone(), vec![zero; square(x.as_ref())]);
        let (mut by_state, mut by_time) = (duals.1.clone(), x.clone());
        let mut slope = x.clone();
        mechanism.joint_derivative(time, &x, &mut slope);
        duals.system(mechanism).jacobian(time, &x, &mut by_state, &mut by_time);
        let n_inputs = mechanism.n_inputs();
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

impl<M, D> Kit<M> for TreeWithJacobian<D>
where
    M: Partition + Ports + Projection + JointJacobian + 'static,
    D: Ode<Scalar = Dual<M::Scalar, COLUMNS>> + Feed + Clone + 'static,
{
    fn begin(&self, mechanism: &M, approach: &Approach, y: &M::State) -> Result<Box<dyn Motion<M>>, String> {
        if approach.coordinates == Coordinates::Maximal {
            return in_maximal(mechanism, approach, &self.0, y);
        }
        let x = joints(mechanism, y);
        if approach.integrator == Integrator::Rodas4 {
            let method = Rodas4::new(&JointForm(mechanism), &x);
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
        let (mut by_state, mut by_inputs) =
            (mechanism.joint_jacobian_buffer(), mechanism.input_jacobian_buffer());
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
fn work_scale<M: Projection<Scalar: Real>>(mechanism: &M, t: f64, y: &M::State) -> f64 {
    let mut forces = mechanism.velocities();
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
    D: JointSpace<Scalar = Dual<T, COLUMNS>> + Feed + Clone,
{
    let mut duals = duals.clone();
    let (mut arguments, zero, one) = (duals.joint_start(), T::constant(0.0), T::constant(1.0));
    let slopes = core::array::from_fn(|k| if k == 0 { one } else { zero });
    duals.feed(input, Dual { value: zero, slopes });
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
    let coordinates = (0..mechanism.n_joints()).flat_map(|joint| mechanism.joint(joint).coordinates);
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

/// What a system of a mechanism is, however long the mechanism is borrowed.
trait Lens<M: Mechanism>: 'static {
    type State: Storage<M::Scalar> + 'static;
    type System<'a>: Ode<Scalar = M::Scalar, State = Self::State>
    where
        M: 'a;

    fn system<'a>(&'a self, mechanism: &'a M) -> Self::System<'a>;
    /// Writes the maximal state.
    fn show(&self, mechanism: &M, t: M::Scalar, from: &Self::State, to: &mut M::State);
    fn set_input(&mut self, _index: usize, _value: f64) {}
}

fn copy<M: Mechanism>(from: &M::State, to: &mut M::State) {
    to.as_mut().copy_from_slice(from.as_ref());
}

/// A mechanism as a system of its own.
struct Exact<'a, M>(&'a M);

impl<M: Ode> Ode for Exact<'_, M> {
    type Scalar = M::Scalar;
    type State = M::State;

    fn start(&self) -> M::State {
        self.0.start()
    }
    fn derivative(&self, t: M::Scalar, y: &M::State, dy: &mut M::State) {
        self.0.derivative(t, y, dy);
    }
}

impl<M: Mechanism> Maximal for Exact<'_, M> {
    type Mechanism = M;

    fn mechanism(&self) -> &M {
        self.0
    }
}

type Derivative<M> = dyn Fn(&M, <M as Ode>::Scalar, &<M as Ode>::State, &mut <M as Ode>::State);

/// Maximal coordinates: one of the right-hand sides that a mechanism has there. Boxed, like corrections, so that integrators are not
/// compiled anew for each.
struct Slopes<M: Mechanism>(Box<Derivative<M>>);

impl<M: Mechanism> Slopes<M> {
    /// Exact on the constraints and off them.
    fn exact() -> Self {
        Self(Box::new(|mechanism, t, y, dy| mechanism.derivative(t, y, dy)))
    }
    /// For states that are corrected every few steps.
    fn corrected() -> Self {
        Self(Box::new(|mechanism, t, y, dy| mechanism.corrected_derivative(t, y, dy)))
    }
}

impl<M: Projection> Slopes<M> {
    /// Baumgarte's, at this rate.
    fn steered(rate: f64) -> Self {
        Self(Box::new(move |mechanism, t, y, dy| {
            Baumgarte { mechanism, rate: Scalar::constant(rate) }.derivative(t, y, dy);
        }))
    }
}

/// A mechanism with one of its right-hand sides.
struct Sloped<'a, M: Mechanism>(&'a M, &'a Derivative<M>);

impl<M: Mechanism> Ode for Sloped<'_, M> {
    type Scalar = M::Scalar;
    type State = M::State;

    fn start(&self) -> M::State {
        self.0.start()
    }
    fn derivative(&self, t: M::Scalar, y: &M::State, dy: &mut M::State) {
        self.1(self.0, t, y, dy);
    }
}

impl<M: Mechanism> Maximal for Sloped<'_, M> {
    type Mechanism = M;

    fn mechanism(&self) -> &M {
        self.0
    }
}

impl<M: Mechanism<Scalar: 'static, State: 'static> + 'static> Lens<M> for Slopes<M> {
    type State = M::State;
    type System<'a> = Sloped<'a, M>;

    fn system<'a>(&'a self, mechanism: &'a M) -> Sloped<'a, M> {
        Sloped(mechanism, &*self.0)
    }
    fn show(&self, _: &M, _: M::Scalar, from: &M::State, to: &mut M::State) {
        copy::<M>(from, to);
    }
}

/// The mechanism in dual numbers, and zeros for a Jacobian.
struct Duals<D, T>(D, Vec<T>);

impl<M, D> Lens<M> for Duals<D, M::Scalar>
where
    M: Mechanism<State: 'static, Scalar: 'static> + 'static,
    D: Ode<Scalar = Dual<M::Scalar, COLUMNS>> + Feed + 'static,
{
    type State = M::State;
    type System<'a> = ByDuals<'a, Exact<'a, M>, Exact<'a, D>, Vec<M::Scalar>, COLUMNS>;

    fn system<'a>(&'a self, mechanism: &'a M) -> Self::System<'a> {
        ByDuals::new(Exact(mechanism), Exact(&self.0), &self.1)
    }
    fn show(&self, _: &M, _: M::Scalar, from: &M::State, to: &mut M::State) {
        copy::<M>(from, to);
    }
    fn set_input(&mut self, index: usize, value: f64) {
        self.0.feed(index, Scalar::constant(value));
    }
}

/// Joint coordinates.
struct Joint;

impl<M: JointSpace<Joints: 'static> + 'static> Lens<M> for Joint {
    type State = M::Joints;
    type System<'a> = JointForm<'a, M>;

    fn system<'a>(&'a self, mechanism: &'a M) -> JointForm<'a, M> {
        JointForm(mechanism)
    }
    fn show(&self, mechanism: &M, t: M::Scalar, from: &M::Joints, to: &mut M::State) {
        mechanism.to_maximal(t, from, to);
    }
}

/// Joint coordinates, with a Jacobian by dual numbers.
struct JointDuals<D, T>(D, Vec<T>);

impl<M, D> Lens<M> for JointDuals<D, M::Scalar>
where
    M: JointSpace<Joints: 'static, Scalar: 'static> + 'static,
    D: JointSpace<Scalar = Dual<M::Scalar, COLUMNS>> + Feed + 'static,
{
    type State = M::Joints;
    type System<'a> = ByDuals<'a, JointForm<'a, M>, JointForm<'a, D>, Vec<M::Scalar>, COLUMNS>;

    fn system<'a>(&'a self, mechanism: &'a M) -> Self::System<'a> {
        ByDuals::new(JointForm(mechanism), JointForm(&self.0), &self.1)
    }
    fn show(&self, mechanism: &M, t: M::Scalar, from: &M::Joints, to: &mut M::State) {
        mechanism.to_maximal(t, from, to);
    }
    fn set_input(&mut self, index: usize, value: f64) {
        self.0.feed(index, Scalar::constant(value));
    }
}

/// Boxed corrections, so that integrators are not compiled anew for each.
trait Keeps<M: Mechanism> {
    fn correct(&mut self, mechanism: &M, t: M::Scalar, y: &mut M::State) -> Result<(), Error>;
    fn violation(&mut self, mechanism: &M, t: M::Scalar, y: &M::State) -> M::Scalar;
    fn switches(&self) -> u64;
}

impl<M: Mechanism, C: Correction<M>> Keeps<M> for C {
    fn correct(&mut self, mechanism: &M, t: M::Scalar, y: &mut M::State) -> Result<(), Error> {
        Correction::correct(self, mechanism, t, y)
    }
    fn violation(&mut self, mechanism: &M, t: M::Scalar, y: &M::State) -> M::Scalar {
        Correction::violation(self, mechanism, t, y)
    }
    fn switches(&self) -> u64 {
        Correction::switches(self)
    }
}

struct Boxed<M: Mechanism>(Box<dyn Keeps<M>>);

impl<M: Partition, O: Maximal<Mechanism = M, Scalar = M::Scalar, State = M::State>> Correction<O>
    for Boxed<M>
{
    fn correct(&mut self, system: &O, t: O::Scalar, y: &mut O::State) -> Result<(), Error> {
        self.0.correct(system.mechanism(), t, y)
    }
    fn refer_turns(&mut self, system: &O, t: O::Scalar, y: &mut O::State) {
        gyro_sim::refer_turns(system.mechanism(), t, y);
    }
    fn violation(&mut self, system: &O, t: O::Scalar, y: &O::State) -> O::Scalar {
        self.0.violation(system.mechanism(), t, y)
    }
    fn switches(&self) -> u64 {
        self.0.switches()
    }
    fn clearance(&self, system: &O, t: O::Scalar, y: &O::State) -> Option<Clearance<O::Scalar>> {
        system.mechanism().clearance(t, y)
    }
}

fn keeping<M>(mechanism: &M, approach: &Approach, y: &M::State) -> Result<Boxed<M>, String>
where
    M: Partition + Projection + 'static,
{
    Ok(Boxed(match approach.correction {
        Keeping::Partition => return Ok(partitioning(mechanism, y)),
        Keeping::MassWeighted => Box::new(MassWeighted::new(mechanism)),
        Keeping::None | Keeping::Baumgarte(_) => Box::new(Watched::new(mechanism)),
        Keeping::ClosedForm => return Err("the closed form is for generated code of trees".to_owned()),
    }))
}

fn partitioning<M: Partition + 'static>(mechanism: &M, y: &M::State) -> Boxed<M> {
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
    M: Partition + Ports + Projection + JointSpace + 'static,
    D: Ode<Scalar = Dual<M::Scalar, COLUMNS>> + Feed + Clone + 'static,
{
    let correction = match approach.correction {
        Keeping::ClosedForm => Boxed(Box::new(ClosedForm::new(mechanism))),
        _ => keeping(mechanism, approach, y)?,
    };
    if approach.integrator == Integrator::Rodas4 {
        return Ok(implicit(mechanism, approach, duals.clone(), correction, y));
    }
    Ok(maximal(approach, correction, y))
}

/// Explicit methods in maximal coordinates.
fn maximal<M>(approach: &Approach, correction: Boxed<M>, y: &M::State) -> Box<dyn Motion<M>>
where
    M: Partition + Projection + 'static,
{
    let slopes = match approach.correction {
        // The projection is as good as it is only with accelerations that are exact off the constraints.
        Keeping::None | Keeping::MassWeighted => Slopes::exact(),
        Keeping::Baumgarte(rate) => Slopes::steered(rate),
        _ => Slopes::corrected(),
    };
    explicit(slopes, correction, approach, y)
}

/// Rodas in maximal coordinates.
fn implicit<M, D>(
    mechanism: &M,
    approach: &Approach,
    duals: D,
    correction: Boxed<M>,
    y: &M::State,
) -> Box<dyn Motion<M>>
where
    M: Partition + 'static,
    D: Ode<Scalar = Dual<M::Scalar, COLUMNS>> + Feed + 'static,
{
    let duals = Duals(duals, vec![M::Scalar::constant(0.0); square(y.as_ref())]);
    let method = Rodas4::new(&duals.system(mechanism), y);
    adaptive(duals, method, correction, approach, y)
}

fn explicit<M, L, C>(lens: L, correction: C, approach: &Approach, y: &L::State) -> Box<dyn Motion<M>>
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
