//! The functions of a generated module that compute something: what each takes and gives, what it means and what is
//! claimed of it. Everything else goes by the variants of [`Kernel`], never by the text of a name.

use crate::groups::Group;
use crate::spaces::{Counts, Space};

/// A function of a generated module, in the order of the data sheet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(missing_docs, reason = "`Kernel::computes` says what each of them is")]
pub enum Kernel {
    ParameterSetup,
    Phi,
    PhiQ,
    PhiPi,
    Nu,
    Gamma,
    VelocityResidual,
    AppliedForce,
    Accelerations,
    Multipliers,
    Project,
    Derivative,
    Energy,
    ReadJoints,
    Outputs,
    ChartVectors,
    NewtonStep,
    SolveVelocities,
    JointAccelerations,
    JointDerivative,
    ToMaximal,
    ToJoints,
    JointAccelerationsAt,
    CorrectedAccelerations,
    CorrectedDerivative,
    CorrectedMultipliers,
    CorrectedSolution,
    JointJacobian,
    JointInputJacobian,
    JointParameterJacobian,
    LoopClosure,
    ClosureDistances,
    ClosePositions,
    CloseVelocities,
    JointOutputs,
    OutputsByState,
    OutputsByAccelerations,
    OutputsByInputs,
    OutputsByParameters,
    FrameJacobians,
    FrameBiases,
    InverseDynamics,
    BiasForces,
    GravityForces,
    MassMatrix,
    MassFactor,
    InverseDerivatives,
    ForwardDerivatives,
    Regressor,
}

/// A function of a generated module.
#[derive(Clone, Copy, Debug)]
pub struct Signature {
    /// Which one.
    pub kernel: Kernel,
    /// The group that it belongs to.
    pub group: Group,
    /// Its name on the data sheet.
    pub name: &'static str,
    /// What the data sheet claims that it computes.
    pub computes: &'static str,
    /// What a call does, which [`Signature::does`] completes.
    does: &'static str,
    /// The state that it is a function of, besides the time.
    pub state: State,
    /// What it needs beside the state.
    pub given: Given,
    /// How it gives its results.
    pub result: Outcome,
    /// What is proved of it.
    pub claim: Claim,
}

/// The state that a function reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// None: parameters alone.
    None,
    /// Positions and velocities of all bodies, `y`.
    Maximal,
    /// Joint coordinates and their rates, `x`.
    Joint,
}

/// What a function needs beside time and state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Given {
    /// Nothing.
    Nothing,
    /// An argument of this name.
    Told(&'static str, Space),
    /// The charts of the partition.
    Charts,
    /// What another function gives, which is called first if it is needed, in a buffer of this name.
    First(&'static str, Kernel),
    /// The same, and it is part of the results.
    HandedOn(&'static str, Kernel),
}

/// How a function gives its results.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// It fills the array of this name.
    Fills(&'static str, Space),
    /// It fills two, one after the other.
    FillsTwo([(&'static str, Space); 2]),
    /// It fills an array and reads what stands there before.
    Renews(&'static str, Space),
    /// It overwrites part of the state.
    Overwrites,
    /// It returns both energies.
    Energies,
    /// It returns a four-vector for each chart.
    Vectors,
    /// It fills what depends on parameters alone.
    Derived,
}

/// What is proved of a function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Claim {
    /// Nothing: others contain it.
    None,
    /// This, in words; and against what, as the data sheet says.
    Proved(&'static str, &'static str),
    /// It is part of what is proved of another one.
    With(Kernel),
}

const MAXIMAL: State = State::Maximal;
const JOINT: State = State::Joint;
const NOTHING: Given = Given::Nothing;
const RATES: Given = Given::Told("accelerations", Space::Rates);

const fn out(space: Space) -> Outcome {
    Outcome::Fills("out", space)
}

/// What a function is a function of and how it gives its results; what its row on the data sheet says, and its
/// documentation; what is proved of it, and against what.
const fn row(
    kernel: Kernel,
    group: Group,
    name: &'static str,
    (state, given, result): (State, Given, Outcome),
    [computes, does]: [&'static str; 2],
    claim: Claim,
) -> Signature {
    Signature { kernel, group, name, computes, does, state, given, result, claim }
}

/// All functions, a row for each variant of [`Kernel`] in the same order.
#[rustfmt::skip]
const TABLE: &[Signature] = &[
    row(Kernel::ParameterSetup, Group::Mechanism, "parameter_setup", (State::None, NOTHING, Outcome::Derived),
        ["what depends on parameters alone", "What depends on parameters alone"],
        Claim::None),
    row(Kernel::Phi, Group::Mechanism, "phi", (MAXIMAL, NOTHING, out(Space::Constraints)),
        ["Φ", "Writes Φ"],
        Claim::Proved("Φ of the joints, eqs. (7) to (12)", "Φ of eqs. (7) to (12)")),
    row(Kernel::PhiQ, Group::Kinematics, "phi_q", (MAXIMAL, NOTHING, out(Space::PhiQ)),
        ["Φ_q, non-zeros in (r, p)", "Writes the non-zeros of Φ_q"],
        Claim::Proved("Φ_q by dual numbers, zero outside its pattern", "the derivatives of Φ by dual numbers")),
    row(Kernel::PhiPi, Group::Kinematics, "phi_pi", (MAXIMAL, NOTHING, out(Space::PhiPi)),
        ["(Φ_r, Φ_π'), non-zeros", "Writes the non-zeros of (Φ_r, Φ_π')"],
        Claim::Proved("½ Φ_p Gᵀ by dual numbers, zero outside its pattern", "the derivatives of Φ by dual numbers")),
    row(Kernel::Nu, Group::Kinematics, "nu", (MAXIMAL, NOTHING, out(Space::Rows)),
        ["ν", "Writes ν"],
        Claim::Proved("ν = −Φ_t", "the derivatives of Φ by dual numbers")),
    row(Kernel::Gamma, Group::Kinematics, "gamma", (MAXIMAL, NOTHING, out(Space::Rows)),
        ["γ", "Writes γ"],
        Claim::Proved("γ, minus the second derivative of Φ at s̈ = ẇ' = 0", "the derivatives of Φ by dual numbers")),
    row(Kernel::VelocityResidual, Group::Mechanism, "velocity_residual", (MAXIMAL, NOTHING, out(Space::Rows)),
        ["Φ_r s + Φ_π' w' − ν", "Writes Φ_r s + Φ_π' w' − ν"],
        Claim::Proved("Φ_r s + Φ_π' w' − ν", "the derivatives of Φ by dual numbers")),
    row(Kernel::AppliedForce, Group::Mechanism, "applied_force", (MAXIMAL, NOTHING, out(Space::Velocities)),
        ["(f, n' − w̃'J'w')", "Writes (f, n' − w̃'J'w')"],
        Claim::Proved("(f, n' − w̃'J'w')", "eq. (17)")),
    row(Kernel::Accelerations, Group::Maximal, "accelerations", (MAXIMAL, NOTHING, out(Space::Accelerations)),
        ["(s̈, ẇ'), eq. (17)", "Solves eq. (17)"],
        Claim::Proved("eq. (17) leaves no residual", "eq. (17)")),
    row(Kernel::Multipliers, Group::Maximal, "multipliers", (MAXIMAL, Given::Told("accelerations", Space::Accelerations), Outcome::Fills("lambda", Space::Rows)),
        ["λ, the accelerations being known", "Writes λ"],
        Claim::With(Kernel::Accelerations)),
    row(Kernel::Project, Group::Projection, "project", (MAXIMAL, Given::Told("rows", Space::Rows), out(Space::Velocities)),
        ["(δr, δπ') that changes the rows as given", "Solves eq. (17) without forces, the changes of the rows for γ"],
        Claim::Proved("rows change as asked; M δ ⊥ all that changes no row", "eq. (17)")),
    row(Kernel::Derivative, Group::Maximal, "derivative", (MAXIMAL, Given::HandedOn("accelerations", Kernel::Accelerations), Outcome::Fills("dy", Space::State)),
        ["ẏ but for the accelerations: eqs. (14), (16)", "Writes ẏ"],
        Claim::Proved("eqs. (14), (16), power, rates of turn references", "eqs. (14) and (16)")),
    row(Kernel::Energy, Group::Mechanism, "energy", (MAXIMAL, NOTHING, Outcome::Energies),
        ["T and V", "Kinetic and potential energy"],
        Claim::Proved("T and V", "their definitions")),
    row(Kernel::ReadJoints, Group::Mechanism, "read_joints", (MAXIMAL, NOTHING, out(Space::Readings)),
        ["joint coordinates and rates", "Writes the joint readings"],
        Claim::Proved("joint coordinates and rates, also for |p| ≠ 1", "their definitions")),
    row(Kernel::Outputs, Group::Mechanism, "outputs", (MAXIMAL, Given::First("accelerations", Kernel::Accelerations), out(Space::Outputs)),
        ["outputs, the accelerations being known", "Writes the outputs"],
        Claim::Proved("outputs at the proved accelerations and multipliers", "their definitions")),
    row(Kernel::ChartVectors, Group::Partition, "chart vectors", (MAXIMAL, NOTHING, Outcome::Vectors),
        ["for the choice of independent coordinates", "The four-vectors whose largest components are the special Euler parameters"],
        Claim::Proved("parallel to Gᵀh' or to p", "Newton's step for Φ = 0")),
    row(Kernel::NewtonStep, Group::Partition, "newton_step", (MAXIMAL, Given::Charts, Outcome::Overwrites),
        ["dependent positions, one Newton step", "One Newton step of the dependent positions"],
        Claim::Proved("linearised rows vanish, the special parameter is kept", "Newton's step for Φ = 0")),
    row(Kernel::SolveVelocities, Group::Partition, "solve_velocities", (MAXIMAL, Given::Charts, Outcome::Overwrites),
        ["dependent velocities, eq. (19)", "Solves eq. (19) for the dependent velocities"],
        Claim::Proved("velocity rows vanish, independent rates are kept", "eq. (19)")),
    row(Kernel::JointAccelerations, Group::Joint, "joint_accelerations", (JOINT, NOTHING, out(Space::Rates)),
        ["u̇ in joint coordinates", "Writes u̇"],
        Claim::Proved("with B = ∂v/∂u: Bᵀ(M v̇ − f) = −Jᵀλ, Φ_π' v̇ = γ", "eq. (17) on the constraints")),
    row(Kernel::JointDerivative, Group::Joint, "joint_derivative", (JOINT, Given::HandedOn("rates", Kernel::JointAccelerations), Outcome::Fills("dx", Space::Joints)),
        ["ẋ but for u̇", "Writes the derivative of the joint state"],
        Claim::Proved("along it the state moves by eqs. (14), (16); power", "eqs. (14) and (16) on the constraints")),
    row(Kernel::ToMaximal, Group::Joint, "to_maximal", (JOINT, NOTHING, Outcome::Fills("y", Space::State)),
        ["(q, v) of a joint state", "Writes the maximal state of a joint state"],
        Claim::Proved("rows vanish but those of loops, its joint coordinates are x and u", "Φ = 0, eq. (18) and the joint coordinates")),
    row(Kernel::ToJoints, Group::Joint, "to_joints", (MAXIMAL, NOTHING, Outcome::Renews("x", Space::Joints)),
        ["(x, u) of a maximal state", "Writes the joint state of a maximal state"],
        Claim::Proved("x and u of any state, angles by their derivative", "Φ = 0, eq. (18) and the joint coordinates")),
    row(Kernel::JointAccelerationsAt, Group::Reactions, "joint_accelerations_at", (MAXIMAL, NOTHING, out(Space::Rates)),
        ["u̇ at a corrected maximal state", "Writes u̇ at a state that satisfies the constraints"],
        Claim::Proved("the proved u̇ at the state of (x, u)", "eq. (17) on the constraints")),
    row(Kernel::CorrectedAccelerations, Group::Corrected, "corrected_accelerations", (MAXIMAL, NOTHING, out(Space::Velocities)),
        ["(s̈, ẇ') at a corrected state", "Writes (s̈, ẇ') at a state that satisfies the constraints"],
        Claim::Proved("the proved v̇ at the state of (x, u)", "eq. (17) on the constraints")),
    row(Kernel::CorrectedDerivative, Group::Corrected, "corrected_derivative", (MAXIMAL, Given::HandedOn("accelerations", Kernel::CorrectedAccelerations), Outcome::Fills("dy", Space::State)),
        ["ẏ but for the accelerations, there", "Writes ẏ"],
        Claim::Proved("eqs. (14), (16), v̇, turns; power at the state of (x, u)", "eqs. (14) and (16) on the constraints")),
    row(Kernel::CorrectedMultipliers, Group::Reactions, "corrected_multipliers", (MAXIMAL, Given::Told("accelerations", Space::Velocities), Outcome::Fills("lambda", Space::Rows)),
        ["λ at such a state and these accelerations", "Writes λ"],
        Claim::Proved("M v̇ + Φ_π'ᵀ λ = f at the state of (x, u)", "eq. (17) on the constraints")),
    row(Kernel::CorrectedSolution, Group::Reactions, "corrected_solution", (MAXIMAL, NOTHING, out(Space::Solution)),
        ["both", "Writes (s̈, ẇ') and λ at a state that satisfies the constraints"],
        Claim::Proved("the proved v̇ there, M v̇ + Φ_π'ᵀ λ = f", "eq. (17) on the constraints")),
    row(Kernel::JointJacobian, Group::Jacobian, "joint_jacobian", (JOINT, NOTHING, Outcome::FillsTwo([("dfdx", Space::Jacobian), ("dfdt", Space::Joints)])),
        ["∂f/∂x and ∂f/∂t of ẋ = f(t, x)", "Writes ∂f/∂x and ∂f/∂t"],
        Claim::Proved("`joint_derivative` by dual numbers, of x and of t", "the derivatives of `joint_derivative` by dual numbers")),
    row(Kernel::JointInputJacobian, Group::Jacobian, "joint_input_jacobian", (JOINT, NOTHING, out(Space::InputJacobian)),
        ["∂f/∂(inputs)", "Writes ∂f/∂(inputs)"],
        Claim::Proved("`joint_derivative` by dual numbers, of the inputs", "the derivatives of `joint_derivative` by dual numbers")),
    row(Kernel::JointParameterJacobian, Group::ParameterJacobian, "joint_parameter_jacobian", (JOINT, NOTHING, out(Space::ParameterJacobian)),
        ["∂f/∂(parameters)", "Writes ∂f/∂(parameters)"],
        Claim::Proved("`joint_derivative` by dual numbers, of the parameters", "the derivatives of `joint_derivative` by dual numbers")),
    row(Kernel::LoopClosure, Group::Joint, "loop_closure", (JOINT, NOTHING, out(Space::Closure)),
        ["Φ of the joints that close loops, in joint coordinates", "Writes Φ of the joints that close loops"],
        Claim::Proved("Φ of what closes loops at the state of (x, u)", "Newton's step for closed loops")),
    row(Kernel::ClosureDistances, Group::Joint, "closure_distances", (JOINT, NOTHING, out(Space::Closure)),
        ["squares of distances between the rows of the loops' Jacobian", "Writes squares of distances between the rows of the loops' Jacobian"],
        Claim::Proved("D of J Jᵀ = L D Lᵀ, J by dual numbers", "Newton's step for closed loops")),
    row(Kernel::ClosePositions, Group::Joint, "close_positions", (JOINT, NOTHING, Outcome::Overwrites),
        ["one Newton step of joint coordinates that closes loops", "One Newton step of the joint coordinates towards closed loops"],
        Claim::Proved("J δ = −Φ of what closes loops, x changes by T δ", "Newton's step for closed loops")),
    row(Kernel::CloseVelocities, Group::Joint, "close_velocities", (JOINT, NOTHING, Outcome::Overwrites),
        ["rates that keep loops closed", "Changes the rates such that loops stay closed"],
        Claim::Proved("loops stay closed; rates at which they do are kept", "Newton's step for closed loops")),
    row(Kernel::JointOutputs, Group::JointOutputs, "joint_outputs", (JOINT, Given::First("accelerations", Kernel::JointAccelerations), out(Space::Outputs)),
        ["outputs of a joint state, u̇ being known", "Writes the outputs of a joint state"],
        Claim::Proved("outputs at the state of (x, u), at the proved v̇ and λ", "the outputs' definitions on the constraints")),
    row(Kernel::OutputsByState, Group::OutputDerivatives, "outputs_by_state", (JOINT, RATES, out(Space::ByState)),
        ["∂(outputs)/∂(x, u), u̇ being held", "Writes ∂(outputs)/∂(x, u), u̇ being held"],
        Claim::Proved("`joint_outputs` by dual numbers, at any u̇", "the derivatives of `joint_outputs` by dual numbers")),
    row(Kernel::OutputsByAccelerations, Group::OutputDerivatives, "outputs_by_accelerations", (JOINT, RATES, out(Space::ByAccelerations)),
        ["∂(outputs)/∂u̇", "Writes ∂(outputs)/∂u̇"],
        Claim::With(Kernel::OutputsByState)),
    row(Kernel::OutputsByInputs, Group::OutputDerivatives, "outputs_by_inputs", (JOINT, RATES, out(Space::ByInputs)),
        ["∂(outputs)/∂(inputs), u̇ being held", "Writes ∂(outputs)/∂(inputs), u̇ being held"],
        Claim::With(Kernel::OutputsByState)),
    row(Kernel::OutputsByParameters, Group::OutputDerivatives, "outputs_by_parameters", (JOINT, RATES, out(Space::ByParameters)),
        ["∂(outputs)/∂(parameters), u̇ being held", "Writes ∂(outputs)/∂(parameters), u̇ being held"],
        Claim::With(Kernel::OutputsByState)),
    row(Kernel::FrameJacobians, Group::Frames, "frame_jacobians", (JOINT, NOTHING, out(Space::FrameJacobians)),
        ["∂(ṡ, w')/∂u of frames, row by row", "Writes ∂(ṡ, w')/∂u of frames, row by row"],
        Claim::Proved("velocities at the state of (x, u) by the rates", "the outputs' definitions on the constraints")),
    row(Kernel::FrameBiases, Group::Frames, "frame_biases", (JOINT, NOTHING, out(Space::FrameBiases)),
        ["(s̈, ẇ') of frames at u̇ = 0", "Writes (s̈, ẇ') of frames at u̇ = 0"],
        Claim::Proved("accelerations at the state of (x, u) for u̇ = 0", "the outputs' definitions on the constraints")),
    row(Kernel::InverseDynamics, Group::Inverse, "inverse_dynamics", (JOINT, RATES, out(Space::Rates)),
        ["τ = M u̇ + h of given u̇", "Writes τ = M u̇ + h of given u̇"],
        Claim::Proved("Bᵀ(M v̇ − f) at any u̇", "virtual power on the constraints")),
    row(Kernel::BiasForces, Group::Inverse, "bias_forces", (JOINT, NOTHING, out(Space::Rates)),
        ["h, that is τ at u̇ = 0", "Writes h"],
        Claim::Proved("Bᵀ(M v̇ − f) at u̇ = 0", "virtual power on the constraints")),
    row(Kernel::GravityForces, Group::Inverse, "gravity_forces", (JOINT, NOTHING, out(Space::Rates)),
        ["what of h is against gravity", "Writes what of h is against gravity"],
        Claim::Proved("−Bᵀ(m g, 0)", "virtual power on the constraints")),
    row(Kernel::MassMatrix, Group::MassMatrix, "mass_matrix", (JOINT, NOTHING, out(Space::MassMatrix)),
        ["M in joint coordinates, row by row", "Writes M in joint coordinates, row by row"],
        Claim::Proved("Bᵀ diag(M, J') B", "the kinetic energy of free motions")),
    row(Kernel::MassFactor, Group::MassMatrix, "mass_factor", (JOINT, NOTHING, out(Space::MassMatrix)),
        ["D and L of M = Lᵀ D L", "Writes D and L of M = Lᵀ D L"],
        Claim::Proved("Lᵀ D L = Bᵀ diag(M, J') B, L triangular in its order", "the kinetic energy of free motions")),
    row(Kernel::InverseDerivatives, Group::Derivatives, "inverse_derivatives", (JOINT, RATES, out(Space::InverseDerivatives)),
        ["∂τ/∂(x, u), row by row", "Writes ∂τ/∂(x, u), row by row"],
        Claim::Proved("`inverse_dynamics` by dual numbers, along the rates and of them", "the derivatives of what is proved by dual numbers")),
    row(Kernel::ForwardDerivatives, Group::Derivatives, "forward_derivatives", (JOINT, NOTHING, out(Space::ForwardDerivatives)),
        ["∂u̇/∂(x, u, τ), row by row", "Writes ∂u̇/∂(x, u, τ), row by row"],
        Claim::Proved("`joint_accelerations` by dual numbers, likewise; M M⁻¹ = 1", "the derivatives of what is proved by dual numbers")),
    row(Kernel::Regressor, Group::Regressor, "regressor", (JOINT, RATES, out(Space::Regressor)),
        ["Y of what inertia and gravity take, Y θ, row by row", "Writes Y of what inertia and gravity take, Y θ, row by row"],
        Claim::Proved("Bᵀ(M v̇ − f) of bodies with unit parameters", "virtual power on the constraints")),
];

const _: () = {
    let mut place = 0;
    while place < TABLE.len() {
        assert!(TABLE[place].kernel as usize == place, "the table has the order of the variants");
        place += 1;
    }
};

impl Kernel {
    /// All functions, in the order of the data sheet.
    pub fn all() -> impl Iterator<Item = Self> {
        TABLE.iter().map(|row| row.kernel)
    }

    /// Those of a group, in the order of its trait.
    pub fn of(group: Group) -> impl Iterator<Item = Self> {
        TABLE.iter().filter(move |row| row.group == group).map(|row| row.kernel)
    }

    /// The function of this name.
    pub fn named(function: &str) -> Option<Self> {
        Self::all().find(|kernel| kernel.function() == function)
    }

    /// Its signature.
    pub fn signature(self) -> &'static Signature {
        &TABLE[self as usize]
    }

    /// Its name on the data sheet.
    pub fn name(self) -> &'static str {
        self.signature().name
    }

    /// Its name in the text of a module.
    pub fn function(self) -> &'static str {
        // It is called by no other program.
        if self == Self::ChartVectors { "chart_vectors" } else { self.name() }
    }

    /// What the data sheet claims that it computes.
    pub fn computes(self) -> &'static str {
        self.signature().computes
    }

    /// The group that it belongs to.
    pub fn group(self) -> Group {
        self.signature().group
    }
}

impl Given {
    /// The name of the array that it stands in, if it is one of numbers.
    pub fn array(self) -> Option<&'static str> {
        match self {
            Self::Nothing | Self::Charts => None,
            Self::Told(name, _) | Self::First(name, _) | Self::HandedOn(name, _) => Some(name),
        }
    }
}

impl State {
    /// Name and type of the argument.
    pub fn argument(self) -> Option<(&'static str, Space)> {
        match self {
            Self::None => None,
            Self::Maximal => Some(("y", Space::State)),
            Self::Joint => Some(("x", Space::Joints)),
        }
    }
}

impl Signature {
    /// How its documentation begins: what a call does, and which other function it calls, as a language names that.
    pub fn does(&self, named: impl Fn(Kernel) -> String) -> String {
        match self.given {
            Given::HandedOn(_, first) => format!("{}; beyond what {} takes", self.does, named(first)),
            _ => self.does.to_owned(),
        }
    }

    /// The same in Rust's documentation.
    pub fn does_in_rust(&self) -> String {
        self.does(|first| format!("[`gyro_sim::{}::{}`]", first.group().trait_name(), first.name()))
    }

    /// The arguments that it writes, with their types.
    pub fn written(&self) -> Vec<(&'static str, Space)> {
        match self.result {
            Outcome::Fills(name, space) | Outcome::Renews(name, space) => vec![(name, space)],
            Outcome::FillsTwo(both) => both.to_vec(),
            Outcome::Overwrites => self.state.argument().into_iter().collect(),
            Outcome::Energies | Outcome::Vectors | Outcome::Derived => Vec::new(),
        }
    }

    /// The array of which it reads what it writes over.
    pub fn overwritten(&self) -> Option<Space> {
        match self.result {
            Outcome::Renews(_, space) => Some(space),
            Outcome::Overwrites => self.state.argument().map(|(_, space)| space),
            _ => None,
        }
    }

    /// How many numbers it gives, where signature and counts tell.
    pub fn n_results(&self, counts: &Counts) -> Option<usize> {
        match self.result {
            Outcome::Overwrites | Outcome::Vectors | Outcome::Derived => None,
            Outcome::Energies => Some(2),
            _ => Some(self.written().iter().map(|(_, space)| space.len(counts)).sum()),
        }
    }

    /// Whether it is for states that satisfy the constraints alone.
    pub fn is_on_constraints(&self) -> bool {
        matches!(self.group, Group::Corrected | Group::Reactions)
    }

    /// The function whose accelerations it is told or takes.
    pub fn accelerations(&self) -> Kernel {
        match self.given {
            Given::First(_, kernel) | Given::HandedOn(_, kernel) => kernel,
            Given::Told(_, Space::Rates) => Kernel::JointAccelerations,
            Given::Told(_, Space::Velocities) => Kernel::CorrectedAccelerations,
            _ => Kernel::Accelerations,
        }
    }

    /// Whether it is told accelerations that need not be those of the equations of motion.
    pub fn takes_any_accelerations(&self) -> bool {
        matches!(self.given, Given::Told(_, Space::Rates))
    }
}
