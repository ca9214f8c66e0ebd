//! The contract between a mechanism and the solvers.
//!
//! The mechanism is constant; every buffer is the caller's, and its size is in its type. Generated mechanisms use
//! arrays, the runtime-assembled twin heap-backed vectors: both implement all of these traits.

use crate::{Error, Real, Scalar};
use core::fmt::Debug;

/// A buffer of scalars of a fixed length: an array, or a boxed slice.
pub trait Storage<T>: Clone + Debug + AsRef<[T]> + AsMut<[T]> {}
impl<T, B: Clone + Debug + AsRef<[T]> + AsMut<[T]>> Storage<T> for B {}

/// A first-order system `ẏ = f(t, y)`: all that an explicit integrator needs.
pub trait Ode {
    /// The number type.
    type Scalar: Scalar;
    /// The state y; for mechanisms `(q, v [, work] [, turn references])`, see the crate's conventions.
    type State: Storage<Self::Scalar>;

    /// The state at the start.
    fn start(&self) -> Self::State;
    /// Writes `f(t, y)`.
    fn derivative(&self, t: Self::Scalar, y: &Self::State, dy: &mut Self::State);
}

/// A system with its Jacobian, for implicit methods and linearisation.
pub trait Differentiable: Ode {
    /// ∂f/∂y, n × n for a state of n numbers, row by row.
    type Jacobian: Storage<Self::Scalar>;

    /// Zeroed buffer.
    fn jacobian_buffer(&self) -> Self::Jacobian;
    /// Writes ∂f/∂y, row by row, and ∂f/∂t.
    fn jacobian(&self, t: Self::Scalar, y: &Self::State, dfdy: &mut Self::Jacobian, dfdt: &mut Self::State);
}

/// A mechanism in maximal coordinates, as its solvers and observers see it.
pub trait Mechanism: Ode {
    /// One scalar for each joint row.
    type Rows: Storage<Self::Scalar>;
    /// One scalar for each joint row, then one for each body's normalisation.
    type Constraints: Storage<Self::Scalar>;
    /// Raw joint coordinates, joint after joint and coordinate after coordinate: see [`Coordinate`].
    type Readings: Storage<Self::Scalar>;

    /// Zeroed buffer.
    fn rows(&self) -> Self::Rows;
    /// Zeroed buffer.
    fn constraints(&self) -> Self::Constraints;
    /// Zeroed buffer.
    fn readings(&self) -> Self::Readings;

    /// Writes `f(t, y)` like [`Ode::derivative`], for states that were corrected a few steps ago: violations of the constraints
    /// are of the order of the integrator's error, and so is what this takes for granted. Trees need far fewer operations
    /// for it.
    fn corrected_derivative(&self, t: Self::Scalar, y: &Self::State, dy: &mut Self::State) {
        self.derivative(t, y, dy);
    }
    /// Writes Φ: joint rows, eqs. (5) to (10), then normalisations, eq. (12).
    fn phi(&self, t: Self::Scalar, y: &Self::State, out: &mut Self::Constraints);
    /// Writes `Φ_r s + Φ_π' w' − ν`, the residual of eq. (18).
    fn velocity_residual(&self, t: Self::Scalar, y: &Self::State, out: &mut Self::Rows);
    /// Kinetic and potential energy, J.
    fn energy(&self, t: Self::Scalar, y: &Self::State) -> Energy<Self::Scalar>;
    /// Writes the raw joint coordinates and rates.
    fn read_joints(&self, t: Self::Scalar, y: &Self::State, out: &mut Self::Readings);

    /// For each turn reference of the state, which its last elements are, the place of its angle's raw sine among the readings.
    fn turn_references(&self) -> &[u16] {
        &[]
    }
    /// Sets the turn references of a state to their angles: see [`refer_turns`](crate::refer_turns).
    fn refer_turns(&self, t: Self::Scalar, y: &mut Self::State) {
        let mut readings = self.readings();
        self.read_joints(t, y, &mut readings);
        set_turn_references(self.turn_references(), readings.as_ref(), y.as_mut());
    }
    /// Number of bodies with coordinates.
    fn n_bodies(&self) -> usize;
    /// Number of joints.
    fn n_joints(&self) -> usize;
    /// Name of a body with coordinates.
    fn body_name(&self, body: usize) -> &str;
    /// Name and coordinates of a joint.
    fn joint(&self, joint: usize) -> JointInfo<'_>;
    /// Name of a coupler of two joint coordinates.
    fn coupler_name(&self, coupler: usize) -> &str;
    /// Name of a driver of a joint coordinate.
    fn driver_name(&self, driver: usize) -> &str;
    /// What a joint row measures.
    fn row(&self, row: usize) -> RowInfo;
    /// A length typical of the mechanism, m, by which violations of length rows are divided.
    fn size(&self) -> Self::Scalar;
    /// The work done so far by non-conservative forces and drivers, J; zero where there are none, or where the page leaves it
    /// out (`count_work = false`).
    fn work(&self, y: &Self::State) -> Self::Scalar;
}

/// The steps of the coordinate partition, eqs. (18) to (20): positions and velocities are split into independent ones,
/// which keep their integrated values, and dependent ones, which follow from the constraints.
pub trait Partition: Mechanism<Scalar: Real> {
    /// Which coordinates are independent.
    type Independent: Clone + Debug + PartialEq;

    /// The best choice at a state.
    fn independent(&self, t: Self::Scalar, y: &Self::State) -> Self::Independent;
    /// Follows the motion: replaces the choice where it has become a poor one. Returns the number of switches.
    fn follow(&self, t: Self::Scalar, y: &Self::State, choice: &mut Self::Independent) -> u32;
    /// One Newton step of the dependent positions towards Φ(q, t) = 0.
    ///
    /// # Errors
    /// [`Error::Singular`] if the choice cannot be solved for.
    fn newton_step(
        &self,
        t: Self::Scalar,
        choice: &Self::Independent,
        y: &mut Self::State,
    ) -> Result<(), Error>;
    /// Whether rounding lets no row of Φ come nearer to zero, though one exceeds what is granted to rows of poses near the origin: Newton's
    /// iteration then ends. Angles of many turns are known less well than angles of a few, and a mechanism that has such
    /// rows judges each by what it subtracts ([`pivoting::is_met`](crate::pivoting::is_met)).
    fn is_met(&self, _t: Self::Scalar, _y: &Self::State, _phi: &Self::Constraints) -> bool {
        false
    }
    /// Solves eq. (19) for the dependent velocities, at corrected positions; the independent ones (components of ṙ and ṗ, or
    /// the rate about a joint's axis) keep the values that they have in `y`.
    ///
    /// # Errors
    /// [`Error::Singular`] if the choice cannot be solved for.
    fn solve_velocities(
        &self,
        t: Self::Scalar,
        choice: &Self::Independent,
        y: &mut Self::State,
    ) -> Result<(), Error>;
    /// How clear a state is of singular poses; `None` for mechanisms that have none, like trees.
    fn clearance(&self, _t: Self::Scalar, _y: &Self::State) -> Option<Clearance<Self::Scalar>> {
        None
    }
}

/// How clear a state is of singular poses, where a mechanism has more freedoms than elsewhere and could go on in more ways than one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clearance<T> {
    /// A pure number, of order one far from singular poses and zero in them.
    pub pivot: T,
    /// Whose constraint depends on others there, where that is known.
    pub owner: Option<Owner>,
}

/// A tree whose partition is unrolled: the solves behind its [`Partition`], for any scalar. They are free of branches, so that each
/// lane of a pack may be on charts of its own: see [`charts`](mod@crate::charts).
pub trait Charted: Mechanism {
    /// For each joint with charts a four-vector.
    type Vectors: Storage<[Self::Scalar; 4]>;

    /// The four-vectors whose largest components are the special Euler parameters.
    fn chart_vectors(&self, y: &Self::State) -> Self::Vectors;
    /// One Newton step of the dependent positions towards Φ(q, t) = 0, on the charts that are given as unit vectors.
    fn newton_step_on(&self, t: Self::Scalar, charts: &Self::Vectors, y: &mut Self::State);
    /// Solves eq. (19) for the dependent velocities, at corrected positions.
    fn solve_velocities_on(&self, t: Self::Scalar, charts: &Self::Vectors, y: &mut Self::State);
}

/// A tree in joint coordinates: the state-space form, with the maps to and from maximal coordinates, and short ways to the
/// accelerations of a maximal state that satisfies the constraints.
///
/// The joint state is `(x, u [, work])`. x has, joint after joint in the order of the model page, each scalar coordinate (an angle, rad,
/// continuous over turns; a displacement, m), and then, of spherical joints and points on a line, the Euler parameters of the second
/// body in the first's frame; after the joints, of each free body `r` and `p`. u has their rates: of Euler parameters the
/// angular velocity relative to the first body in the second's frame, rad/s, of free bodies `s` and `w'`.
pub trait JointSpace: Equations {
    /// `(x, u [, work])`.
    type Joints: Storage<Self::Scalar>;
    /// One scalar for each rate.
    type Rates: Storage<Self::Scalar>;
    /// One scalar for each unknown of eq. (17).
    type Solution: Storage<Self::Scalar>;

    /// The assembled start, with all parameters at their defaults.
    fn joint_start(&self) -> Self::Joints;
    /// Zeroed buffer.
    fn rates(&self) -> Self::Rates;
    /// Zeroed buffer.
    fn solution(&self) -> Self::Solution;
    /// Writes u̇.
    fn joint_accelerations(&self, t: Self::Scalar, x: &Self::Joints, out: &mut Self::Rates);
    /// Writes the derivative of the joint state: an [`Ode`] by way of [`JointForm`].
    fn joint_derivative(&self, t: Self::Scalar, x: &Self::Joints, dx: &mut Self::Joints);
    /// The maximal state of a joint state; it satisfies the constraints.
    fn to_maximal(&self, t: Self::Scalar, x: &Self::Joints, y: &mut Self::State);
    /// The joint state of a maximal state; angles are those nearest to what `x` holds before.
    fn to_joints(&self, t: Self::Scalar, y: &Self::State, x: &mut Self::Joints);
    /// Writes u̇ at a maximal state that satisfies the constraints.
    fn joint_accelerations_at(&self, t: Self::Scalar, y: &Self::State, out: &mut Self::Rates);
    /// Writes (s̈, ẇ') at a maximal state that satisfies the constraints; elsewhere
    /// [`Equations::accelerations`] solves eq. (17).
    fn corrected_accelerations(&self, t: Self::Scalar, y: &Self::State, out: &mut Self::Velocities);
    /// Writes λ of all joint rows at such a state and these accelerations.
    fn corrected_multipliers(
        &self,
        t: Self::Scalar,
        y: &Self::State,
        accelerations: &Self::Velocities,
        lambda: &mut Self::Rows,
    );
    /// Writes both, (s̈, ẇ') and then λ, and works out only once what they have in common.
    fn corrected_solution(&self, t: Self::Scalar, y: &Self::State, out: &mut Self::Solution);
}

/// A tree's joint coordinates as a first-order system, for any explicit integrator.
#[derive(Clone, Copy, Debug)]
pub struct JointForm<'a, M>(pub &'a M);

impl<M: JointSpace> Ode for JointForm<'_, M> {
    type Scalar = M::Scalar;
    type State = M::Joints;

    fn start(&self) -> Self::State {
        self.0.joint_start()
    }
    fn derivative(&self, t: Self::Scalar, x: &Self::State, dx: &mut Self::State) {
        self.0.joint_derivative(t, x, dx);
    }
}

/// A tree whose joint form `ẋ = f(t, x)` comes with its derivatives, for implicit methods and linearisation.
///
/// They are those of the emitted functions as they stand, also along what the state cannot do (of Euler parameters, across their unit sphere).
/// Generated trees have them up to eight rates, unless a third derivative of a table would be needed.
pub trait JointJacobian: JointSpace {
    /// ∂f/∂x, n × n for a joint state of n numbers, row by row.
    type Jacobian: Storage<Self::Scalar>;
    /// ∂f/∂(inputs), n × m for m inputs, row by row.
    type InputJacobian: Storage<Self::Scalar>;

    /// Zeroed buffer.
    fn joint_jacobian_buffer(&self) -> Self::Jacobian;
    /// Zeroed buffer.
    fn input_jacobian_buffer(&self) -> Self::InputJacobian;
    /// Writes ∂f/∂x, row by row, and ∂f/∂t of [`JointSpace::joint_derivative`].
    fn joint_jacobian(
        &self,
        t: Self::Scalar,
        x: &Self::Joints,
        dfdx: &mut Self::Jacobian,
        dfdt: &mut Self::Joints,
    );
    /// Writes ∂f/∂(inputs), row by row.
    fn joint_input_jacobian(&self, t: Self::Scalar, x: &Self::Joints, out: &mut Self::InputJacobian);
}

impl<M: JointJacobian> Differentiable for JointForm<'_, M> {
    type Jacobian = M::Jacobian;

    fn jacobian_buffer(&self) -> Self::Jacobian {
        self.0.joint_jacobian_buffer()
    }
    fn jacobian(&self, t: Self::Scalar, x: &Self::State, dfdx: &mut Self::Jacobian, dfdt: &mut Self::State) {
        self.0.joint_jacobian(t, x, dfdx, dfdt);
    }
}

/// The equations of motion term by term, for inspection, tests and other solvers.
pub trait Equations: Mechanism {
    /// One scalar for each velocity: `(s, w')` body after body.
    type Velocities: Storage<Self::Scalar>;
    /// The non-zeros of Φ_q with respect to (r, p), normalisation rows included.
    type PhiQ: Storage<Self::Scalar>;
    /// The non-zeros of (Φ_r, Φ_π').
    type PhiPi: Storage<Self::Scalar>;
    /// The accelerations `(s̈, ẇ')` body after body, and after them whatever [`Equations::multipliers`] needs to go on from
    /// there; possibly nothing.
    type Accelerations: Storage<Self::Scalar>;

    /// Zeroed buffer.
    fn velocities(&self) -> Self::Velocities;
    /// Zeroed buffer.
    fn phi_q_values(&self) -> Self::PhiQ;
    /// Zeroed buffer.
    fn phi_pi_values(&self) -> Self::PhiPi;
    /// Zeroed buffer.
    fn accelerations_buffer(&self) -> Self::Accelerations;
    /// Row and column of each non-zero of Φ_q, row by row.
    fn phi_q_pattern(&self) -> &[(u16, u16)];
    /// Row and column of each non-zero of (Φ_r, Φ_π'), row by row.
    fn phi_pi_pattern(&self) -> &[(u16, u16)];

    /// Writes the non-zeros of Φ_q, joint rows and normalisations, columns `(r, p)` body after body.
    fn phi_q(&self, t: Self::Scalar, y: &Self::State, out: &mut Self::PhiQ);
    /// Writes the non-zeros of (Φ_r, Φ_π'), joint rows, columns `(r, π')` body after body.
    fn phi_pi(&self, t: Self::Scalar, y: &Self::State, out: &mut Self::PhiPi);
    /// Writes ν = −Φ_t.
    fn nu(&self, t: Self::Scalar, y: &Self::State, out: &mut Self::Rows);
    /// Writes γ, the right-hand side of `Φ_r s̈ + Φ_π' ẇ' = γ`.
    fn gamma(&self, t: Self::Scalar, y: &Self::State, out: &mut Self::Rows);
    /// Writes `(f, n' − w̃'J'w')`, body after body.
    fn applied_force(&self, t: Self::Scalar, y: &Self::State, out: &mut Self::Velocities);
    /// Solves eq. (17) for the accelerations `(s̈, ẇ')`.
    fn accelerations(&self, t: Self::Scalar, y: &Self::State, out: &mut Self::Accelerations);
    /// Solves eq. (17) for the multipliers λ of all joint rows, at accelerations that [`Equations::accelerations`] has found
    /// at the same time and state.
    fn multipliers(
        &self,
        t: Self::Scalar,
        y: &Self::State,
        accelerations: &Self::Accelerations,
        lambda: &mut Self::Rows,
    );
}

/// Corrections in the metric of the masses, which favour no coordinate: they leave where they can what is heavy.
pub trait Projection: Equations {
    /// Writes `δ = (δr, δπ')` body after body, the solution of
    ///
    /// ```text
    /// [ M     Φ_π'ᵀ ] [ δ ]   [  0   ]
    /// [ Φ_π'    0   ] [ μ ] = [ rows ]        Φ_π' short for (Φ_r, Φ_π')
    /// ```
    ///
    /// at the state as it stands, off the constraints too. Of all motions by which the joint rows change by `rows` to first order it is the one of
    /// the least `δᵀ M δ`: with `rows = −Φ` a step of a correction of the positions (p follows by `δp = ½ G(p)ᵀ δπ'`), with minus the
    /// [velocity residual](Mechanism::velocity_residual) the correction of the velocities (s, w').
    fn project(&self, t: Self::Scalar, y: &Self::State, rows: &Self::Rows, out: &mut Self::Velocities);
}

/// What goes in at every step and what comes out besides the motion: a mechanism's inputs (motor torques) and the outputs
/// that its page asks for.
pub trait Ports: Mechanism {
    /// One scalar for each number of each output.
    type Outputs: Storage<Self::Scalar>;

    /// Zeroed buffer.
    fn outputs_buffer(&self) -> Self::Outputs;
    /// Writes all outputs, with the inputs as they are set.
    fn outputs(&self, t: Self::Scalar, y: &Self::State, out: &mut Self::Outputs);
    /// Number of numbers in the outputs.
    fn n_outputs(&self) -> usize;
    /// What a number of the outputs is; all of it empty for one that does not exist.
    fn output(&self, index: usize) -> OutputInfo<'_>;

    /// Number of inputs.
    fn n_inputs(&self) -> usize;
    /// Name of an input; empty for one that does not exist.
    fn input_name(&self, index: usize) -> &str;
    /// Sets an input until it is set anew; returns whether there is one of this index.
    fn set_input(&mut self, index: usize, value: Self::Scalar) -> bool;
}

/// One number of the outputs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OutputInfo<'a> {
    /// The output's name on the model page.
    pub name: &'a str,
    /// Which of the output's numbers it is; empty for an output of a single number.
    pub suffix: &'a str,
    /// Its unit; empty for a pure number.
    pub unit: &'a str,
}

/// Energy of a state, J.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Energy<T> {
    /// ½ Σ (sᵀ m s + w'ᵀ J' w').
    pub kinetic: T,
    /// −Σ m gᵀ r, and the energy of springs.
    pub potential: T,
}

impl<T: Scalar> Energy<T> {
    /// The sum of both.
    pub fn total(&self) -> T {
        self.kinetic + self.potential
    }
}

/// Name and coordinates of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct JointInfo<'a> {
    /// The name on the model page.
    pub name: &'a str,
    /// What its readings are, coordinate after coordinate; empty for a joint that does not move, or a rod.
    pub coordinates: &'a [Coordinate],
}

impl JointInfo<'_> {
    /// Number of raw readings of all its coordinates.
    pub fn n_readings(&self) -> usize {
        self.coordinates.iter().map(|coordinate| coordinate.n_readings()).sum()
    }
}

/// What the readings of a joint's coordinate are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coordinate {
    /// Three readings: proportional to the sine and cosine of the angle by the same positive factor, and the rate,
    /// rad/s.
    Angle,
    /// Two readings: a length, m, and its rate, m/s.
    Length,
    /// Seven readings: Euler parameters of the second body's frame in the first's, and the second body's angular
    /// velocity relative to the first, in the second body's frame, rad/s.
    Orientation,
}

impl Coordinate {
    /// Number of raw readings.
    pub const fn n_readings(self) -> usize {
        match self {
            Self::Angle => 3,
            Self::Length => 2,
            Self::Orientation => 7,
        }
    }
}

/// What a joint row measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RowInfo {
    /// The owner of the row.
    pub owner: Owner,
    /// Whether the row is a length, m; a pure number otherwise.
    pub is_length: bool,
}

/// The owner of a constraint row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Owner {
    /// A body's own constraint, by the index of the body.
    Body(u16),
    /// A joint, by its index.
    Joint(u16),
    /// A coupler of two joint coordinates, by its index.
    Coupler(u16),
    /// A driver of a joint coordinate, by its index.
    Driver(u16),
}

/// Sets the last elements of a state to the angles whose raw sines and cosines begin at these places among the readings.
pub fn set_turn_references<T: Scalar>(places: &[u16], readings: &[T], state: &mut [T]) {
    for (reference, place) in state.iter_mut().rev().zip(places.iter().rev()) {
        let at = usize::from(*place);
        if let Some([sin, cos]) = readings.get(at..at + 2) {
            let (s, c) = (reference.sin(), reference.cos());
            *reference = *reference + (*sin * c - *cos * s).atan2(*cos * c + *sin * s);
        }
    }
}
