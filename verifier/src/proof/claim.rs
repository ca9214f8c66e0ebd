//! What is proved of each function: numbers that must be zero wherever they exist.

mod words;

use super::case::{Arguments, Case};
use super::partition::dot;
use super::point::stretched;
use super::residuals::{differences, position_rates};
use super::{closure, joints, observed, on_request, partition};
use crate::field::Field;
use crate::module::Module;
use crate::point::Point;
use crate::tape::Term;
use crate::textbook::{Reading, Sparse};
use std::collections::BTreeMap;

/// A claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Claim {
    /// `phi` is Φ.
    Phi,
    /// `phi_q` is Φ_q, and zero where the pattern has no place.
    PhiQ,
    /// `phi_pi` is (Φ_r, Φ_π'), likewise.
    PhiPi,
    /// `nu` is ν.
    Nu,
    /// `gamma` is γ.
    Gamma,
    /// `velocity_residual` is `Φ_r s + Φ_π' w' − ν`.
    VelocityResidual,
    /// `applied_force` is `(f, n' − w̃'J'w')`.
    AppliedForce,
    /// `accelerations` and `multipliers` satisfy eq. (17).
    Motion,
    /// `project` changes the rows as asked, by the least motion in the metric of the masses.
    Projection,
    /// `derivative` gives eqs. (14), (16), these accelerations, the power and the rates of the turn references.
    Derivative,
    /// `energy` gives both energies.
    Energy,
    /// `read_joints` gives the joint coordinates, also where |p| is not one.
    Readings,
    /// `outputs` gives the outputs of the model file.
    Outputs,
    /// `chart_vectors` are the directions in which, or across which, a joint moves p.
    ChartVectors,
    /// `newton_step` is one Newton step.
    NewtonStep,
    /// `solve_velocities` satisfies eq. (19) and keeps what is independent.
    SolveVelocities,
    /// `to_maximal` gives the state that the constraints allow and of which the joint coordinates are the given ones.
    ToMaximal,
    /// `to_joints` is its inverse.
    ToJoints,
    /// `joint_accelerations` are those of eq. (17).
    JointAccelerations,
    /// `joint_derivative` gives the rates that go with the state's own, these accelerations and the power.
    JointDerivative,
    /// `joint_accelerations_at` are the same at a maximal state that satisfies the constraints.
    JointAccelerationsAt,
    /// `corrected_accelerations` are those of the bodies there.
    CorrectedAccelerations,
    /// `corrected_derivative` gives eqs. (14), (16), these accelerations, there the power, and the rates of the turn
    /// references.
    CorrectedDerivative,
    /// `corrected_multipliers` satisfy eq. (17) there.
    CorrectedMultipliers,
    /// `corrected_solution` is both.
    CorrectedSolution,
    /// `loop_closure` gives the rows that the joint coordinates do not satisfy by themselves.
    LoopClosure,
    /// `closure_distances` gives the squares of the distances of their derivatives by the rates from each other.
    ClosureDistances,
    /// `close_positions` is one Newton step for these.
    ClosePositions,
    /// `close_velocities` changes the rates such that these stay as they are.
    CloseVelocities,
    /// `joint_jacobian` is ∂f/∂x and ∂f/∂t of `joint_derivative`.
    JointJacobian,
    /// `joint_input_jacobian` is ∂f/∂(inputs).
    JointInputJacobian,
    /// `joint_parameter_jacobian` is ∂f/∂(parameters).
    JointParameterJacobian,
    /// `joint_outputs` gives the outputs of the model file at the maximal state of a joint state.
    JointOutputs,
    /// `outputs_by_state`, `outputs_by_accelerations`, `outputs_by_inputs` and `outputs_by_parameters` are its
    /// derivatives.
    OutputDerivatives,
    /// `frame_jacobians` is what velocities of frames have of the rates.
    FrameJacobians,
    /// `frame_biases` is what accelerations of frames have beside `J u̇`.
    FrameBiases,
    /// `inverse_dynamics` gives the forces that any u̇ takes.
    InverseDynamics,
    /// `bias_forces` are those that u̇ = 0 takes.
    BiasForces,
    /// `gravity_forces` are those that rest takes against gravity.
    GravityForces,
    /// `mass_matrix` is M.
    MassMatrix,
    /// `mass_factor` is its factor.
    MassFactor,
    /// `inverse_derivatives` are those of `inverse_dynamics`.
    InverseDerivatives,
    /// `forward_derivatives` are those of `joint_accelerations`, and M⁻¹.
    ForwardDerivatives,
    /// `regressor` gives the forces that inertia and gravity take of a unit of each inertial parameter.
    Regressor,
}

/// All claims, in the order in which they are proved.
const ALL: [Claim; 44] = {
    use Claim::*;
    [
        Phi,
        PhiQ,
        PhiPi,
        Nu,
        Gamma,
        VelocityResidual,
        AppliedForce,
        Motion,
        Projection,
        Derivative,
        Energy,
        Readings,
        Outputs,
        ChartVectors,
        NewtonStep,
        SolveVelocities,
        LoopClosure,
        ClosureDistances,
        ClosePositions,
        CloseVelocities,
        ToMaximal,
        ToJoints,
        JointAccelerations,
        JointDerivative,
        JointAccelerationsAt,
        CorrectedAccelerations,
        CorrectedDerivative,
        CorrectedMultipliers,
        CorrectedSolution,
        JointJacobian,
        JointInputJacobian,
        JointParameterJacobian,
        JointOutputs,
        OutputDerivatives,
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
    ]
};

/// Claims about functions that may have no results.
const MAY_GIVE_NOTHING: [Claim; 14] = {
    use Claim::*;
    [
        JointInputJacobian,
        JointParameterJacobian,
        JointOutputs,
        OutputDerivatives,
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
    ]
};

impl Claim {
    /// All claims about a module, by the functions that it has.
    pub fn all(module: &Module) -> Vec<Self> {
        let is_there = |function: &&str| module.programs.contains_key(*function);
        let is_about = |claim: &Self| claim.functions().iter().all(is_there);
        let gives = |function: &str| !module.programs[function].results.is_empty();
        let mut claims: Vec<Self> = ALL.into_iter().filter(is_about).collect();
        // Of a mechanism without rates, inputs or parameters nothing may be left to say.
        claims
            .retain(|claim| !MAY_GIVE_NOTHING.contains(claim) || claim.functions().iter().any(|f| gives(f)));
        claims
    }

    /// The functions that the claim is about.
    pub fn functions(self) -> &'static [&'static str] {
        match self {
            Self::Phi => &["phi"],
            Self::PhiQ => &["phi_q"],
            Self::PhiPi => &["phi_pi"],
            Self::Nu => &["nu"],
            Self::Gamma => &["gamma"],
            Self::VelocityResidual => &["velocity_residual"],
            Self::AppliedForce => &["applied_force"],
            Self::Motion => &["accelerations", "multipliers"],
            Self::Projection => &["project"],
            Self::Derivative => &["derivative"],
            Self::Energy => &["energy"],
            Self::Readings => &["read_joints"],
            Self::Outputs => &["outputs"],
            Self::ChartVectors => &["chart_vectors"],
            Self::NewtonStep => &["newton_step"],
            Self::SolveVelocities => &["solve_velocities"],
            Self::ToMaximal => &["to_maximal"],
            Self::ToJoints => &["to_joints"],
            Self::JointAccelerations => &["joint_accelerations"],
            Self::JointDerivative => &["joint_derivative"],
            Self::JointAccelerationsAt => &["joint_accelerations_at"],
            Self::CorrectedAccelerations => &["corrected_accelerations"],
            Self::CorrectedDerivative => &["corrected_derivative"],
            Self::CorrectedMultipliers => &["corrected_multipliers"],
            Self::CorrectedSolution => &["corrected_solution"],
            Self::LoopClosure => &["loop_closure"],
            Self::ClosureDistances => &["closure_distances"],
            Self::ClosePositions => &["close_positions"],
            Self::CloseVelocities => &["close_velocities"],
            Self::JointJacobian => &["joint_jacobian"],
            Self::JointInputJacobian => &["joint_input_jacobian"],
            Self::JointParameterJacobian => &["joint_parameter_jacobian"],
            Self::JointOutputs => &["joint_outputs"],
            Self::OutputDerivatives => &[
                "outputs_by_state",
                "outputs_by_accelerations",
                "outputs_by_inputs",
                "outputs_by_parameters",
            ],
            Self::FrameJacobians => &["frame_jacobians"],
            Self::FrameBiases => &["frame_biases"],
            Self::InverseDynamics => &["inverse_dynamics"],
            Self::BiasForces => &["bias_forces"],
            Self::GravityForces => &["gravity_forces"],
            Self::MassMatrix => &["mass_matrix"],
            Self::MassFactor => &["mass_factor"],
            Self::InverseDerivatives => &["inverse_derivatives"],
            Self::ForwardDerivatives => &["forward_derivatives"],
            Self::Regressor => &["regressor"],
        }
    }

    /// The numbers that must be zero; `None` where the textbook divides by the number zero.
    pub(super) fn residuals<'a>(self, case: &Case<'a>) -> Option<Vec<Term<'a>>> {
        let point = &case.point;
        let textbook = case.textbook(point)?;
        let equal = |function: &str, values: Option<Vec<Term<'a>>>| {
            Some(differences(&case.run(function, point), &values?))
        };
        match self {
            Self::Phi => Some([equal("phi", textbook.phi())?, normalisations(case)?].concat()),
            Self::Nu => equal("nu", textbook.nu()),
            Self::Gamma => equal("gamma", textbook.gamma()),
            Self::VelocityResidual => equal("velocity_residual", textbook.velocity_residual()),
            Self::AppliedForce => equal("applied_force", textbook.applied_force()),
            Self::Energy => equal("energy", textbook.energy().map(|energies| energies.to_vec())),
            Self::PhiQ => {
                let matrix = textbook.phi_q()?;
                let (values, pattern) = (case.run("phi_q", point), &case.module.phi_q_pattern);
                let on_sphere = sparse_differences(&values, pattern, matrix).concat();
                Some([on_sphere, normalisations_of_phi_q(case)?].concat())
            }
            Self::PhiPi => {
                let matrix = textbook.phi_pi()?;
                let (values, pattern) = (case.run("phi_pi", point), &case.module.phi_pi_pattern);
                Some(sparse_differences(&values, pattern, matrix).concat())
            }
            Self::Motion => {
                let (accelerations, multipliers) = case.motion();
                textbook.residual_of_motion(&accelerations[..6 * case.n_bodies()], &multipliers)
            }
            Self::Projection => projection(case),
            Self::Derivative => derivative(case),
            Self::Outputs => {
                let (accelerations, multipliers) = case.motion_at_hand();
                let values = textbook.outputs(&accelerations[..6 * case.n_bodies()], &multipliers);
                Some(differences(&case.run_with("outputs", point, &accelerations), &values?))
            }
            Self::Readings => {
                let stretched = stretched(point, &case.factors);
                Some([readings(case, point)?, angles(case, &stretched)?].concat())
            }
            Self::ChartVectors => partition::chart_vectors(case),
            Self::NewtonStep => partition::newton_step(case),
            Self::SolveVelocities => partition::solve_velocities(case),
            Self::ToMaximal => joints::to_maximal(case),
            Self::ToJoints => joints::to_joints(case),
            Self::JointAccelerations => joints::accelerations(case),
            Self::JointDerivative => joints::derivative(case),
            Self::JointAccelerationsAt => joints::accelerations_at(case),
            Self::CorrectedAccelerations => joints::corrected_accelerations(case),
            Self::CorrectedDerivative => joints::corrected_derivative(case),
            Self::CorrectedMultipliers => joints::corrected_multipliers(case),
            Self::CorrectedSolution => joints::corrected_solution(case),
            Self::LoopClosure => closure::loop_closure(case),
            Self::ClosureDistances => closure::closure_distances(case),
            Self::ClosePositions => closure::close_positions(case),
            Self::CloseVelocities => closure::close_velocities(case),
            Self::JointJacobian => joints::jacobian(case),
            Self::JointInputJacobian => joints::input_jacobian(case),
            Self::JointParameterJacobian => joints::parameter_jacobian(case),
            Self::JointOutputs => observed::outputs(case),
            Self::OutputDerivatives => observed::output_derivatives(case),
            Self::FrameJacobians => observed::frame_jacobians(case),
            Self::FrameBiases => observed::frame_biases(case),
            Self::InverseDynamics => on_request::inverse_dynamics(case),
            Self::BiasForces => on_request::bias_forces(case),
            Self::GravityForces => on_request::gravity_forces(case),
            Self::MassMatrix => on_request::mass_matrix(case),
            Self::MassFactor => on_request::mass_factor(case),
            Self::InverseDerivatives => on_request::inverse_derivatives(case),
            Self::ForwardDerivatives => on_request::forward_derivatives(case),
            Self::Regressor => on_request::regressor(case),
        }
    }
}

/// The matrix that the values are, minus the given one, by rows, where either has an entry. A value without a place in
/// the matrix is a row of its own.
fn sparse_differences<F: Field>(
    values: &[F],
    pattern: &[(usize, usize)],
    expected: Sparse<F>,
) -> Vec<Vec<F>> {
    let mut differences = expected.rows;
    differences.iter_mut().flat_map(BTreeMap::values_mut).for_each(|entry| *entry = entry.neg());
    for (value, &(row, column)) in values.iter().zip(pattern) {
        match differences.get_mut(row).filter(|_| column < expected.n_columns) {
            Some(row) => {
                row.entry(column)
                    .and_modify(|entry| *entry = entry.add(value))
                    .or_insert_with(|| value.clone());
            }
            None => differences.push(BTreeMap::from([(column, value.clone())])),
        }
    }
    differences.into_iter().map(|row| row.into_values().collect()).collect()
}

/// With `δ = P(rows)` what the module gives: `Φ_π' P(rows) = rows` for any rows, and `(z − P(Φ_π' z))ᵀ M P(rows) = 0`
/// for any motion z. What is in the brackets changes no row, and every motion that changes none is of this form: of z =
/// 0 and no rows the second claim says that P(0) = 0. So `M δ` does no work on any motion that the rows leave free, and
/// is `−Φ_π'ᵀ μ`.
fn projection<'a>(case: &Case<'a>) -> Option<Vec<Term<'a>>> {
    let textbook = case.textbook(&case.point)?;
    let (phi_pi, mass) = (textbook.phi_pi()?, textbook.mass_matrix());
    let project =
        |changes: &[Term<'a>]| case.results("project", Arguments { changes, ..case.given(&case.point) });
    let projected = project(&case.changes);
    let mut residuals = differences(&textbook.product(&phi_pi, &projected), &case.changes);
    let other = project(&textbook.product(&phi_pi, &case.motion));
    let rest = differences(&case.motion, &other);
    residuals.push(dot(&rest, &textbook.product(&mass, &projected)));
    Some(residuals)
}

/// `pᵀp − 1` for p of any length: where it is one, zero would do.
fn normalisations<'a>(case: &Case<'a>) -> Option<Vec<Term<'a>>> {
    let (longer, rows) = (stretched(&case.point, &case.factors), case.model.rows().len());
    let (found, expected) = (case.run("phi", &longer), case.textbook(&longer)?.phi()?);
    Some(differences(found.get(rows..)?, &expected[rows..]))
}

/// `2 p` for p of any length.
fn normalisations_of_phi_q<'a>(case: &Case<'a>) -> Option<Vec<Term<'a>>> {
    let (longer, rows) = (stretched(&case.point, &case.factors), case.model.rows().len());
    let (values, pattern) = (case.run("phi_q", &longer), &case.module.phi_q_pattern);
    let matrix = case.textbook(&longer)?.phi_q()?;
    Some(sparse_differences(&values, pattern, matrix)[rows..].concat())
}

fn derivative<'a>(case: &Case<'a>) -> Option<Vec<Term<'a>>> {
    let textbook = case.textbook(&case.point)?;
    let (accelerations, multipliers) = case.motion();
    let mut expected = textbook.position_rates();
    expected.extend(accelerations[..6 * case.n_bodies()].iter().cloned());
    if case.model.has_work() {
        let [forces, drivers] = textbook.power(&multipliers, &accelerations)?;
        expected.push(forces.add(&drivers));
    }
    expected.extend(textbook.turn_rates());
    let mut residuals = differences(&case.run_with("derivative", &case.point, &accelerations), &expected);
    residuals.extend(position_rates(case, "derivative")?);
    Some(residuals)
}

fn readings<'a>(case: &Case<'a>, point: &Point<Term<'a>>) -> Option<Vec<Term<'a>>> {
    let expected = case.textbook(point)?.readings()?;
    let found = case.run("read_joints", point);
    let (mut found, mut residuals) = (found.as_slice(), Vec::new());
    for reading in expected {
        let count = match reading {
            Reading::Angle { sine, cosine, rate } => {
                residuals.push(across(&found[..2], &[sine, cosine]));
                residuals.push(found[2].sub(&rate));
                3
            }
            Reading::Length(numbers) => {
                residuals.extend(differences(&found[..2], &numbers));
                2
            }
            Reading::Orientation(numbers) => {
                residuals.extend(differences(&found[..7], &numbers));
                7
            }
        };
        found = &found[count..];
    }
    Some(residuals)
}

/// That angles read off longer Euler parameters are those of the unit ones.
fn angles<'a>(case: &Case<'a>, stretched: &Point<Term<'a>>) -> Option<Vec<Term<'a>>> {
    let expected = case.textbook(&case.point)?.readings()?;
    let found = case.run("read_joints", stretched);
    let (mut found, mut residuals) = (found.as_slice(), Vec::new());
    for reading in expected {
        let count = match reading {
            Reading::Angle { sine, cosine, .. } => {
                residuals.push(across(&found[..2], &[sine, cosine]));
                3
            }
            Reading::Length(_) => 2,
            Reading::Orientation(_) => 7,
        };
        found = &found[count..];
    }
    Some(residuals)
}

/// `a₀ b₁ − a₁ b₀`: zero where the pairs are parallel.
fn across<F: Field>(a: &[F], b: &[F; 2]) -> F {
    a[0].mul(&b[1]).sub(&a[1].mul(&b[0]))
}
