//! What is proved of each function: numbers that must be zero wherever they exist.

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
use gyro_program::{Claim as Statement, Group, Kernel};
use std::collections::BTreeMap;

/// A claim: what is proved of a function, by which it is named, and of those that are claimed with it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Claim(pub Kernel);

/// What of joint states is proved first: maps between states and what closes loops.
const FIRST_OF_JOINTS: [Kernel; 6] = [
    Kernel::LoopClosure,
    Kernel::ClosureDistances,
    Kernel::ClosePositions,
    Kernel::CloseVelocities,
    Kernel::ToMaximal,
    Kernel::ToJoints,
];

impl Claim {
    /// All claims about a module, by the functions that it has, in the order in which they are proved.
    pub fn all(module: &Module) -> Vec<Self> {
        let (maximal, joints): (Vec<_>, Vec<_>) =
            Kernel::all().partition(|kernel| *kernel < Kernel::JointAccelerations);
        let joints = joints.into_iter().filter(|kernel| !FIRST_OF_JOINTS.contains(kernel));
        let claims = maximal.into_iter().chain(FIRST_OF_JOINTS).chain(joints).map(Self);
        let is_made = |claim: &Self| matches!(claim.0.signature().claim, Statement::Proved(..));
        let is_there = |function: &&str| module.programs.contains_key(*function);
        let is_about = |claim: &Self| claim.functions().iter().all(is_there);
        // Of a mechanism without rates, inputs or parameters nothing may be left to say.
        let gives = |function: &str| !module.programs[function].results.is_empty();
        let says = |claim: &Self| !claim.may_give_nothing() || claim.functions().into_iter().any(gives);
        claims.filter(is_made).filter(is_about).filter(says).collect()
    }

    /// Whether the functions may have no results.
    fn may_give_nothing(self) -> bool {
        let group = self.0.group();
        self.0 == Kernel::JointInputJacobian || Group::on_request().any(|other| other == group)
    }

    /// The functions that the claim is about.
    pub fn functions(self) -> Vec<&'static str> {
        let is_meant =
            |kernel: &Kernel| *kernel == self.0 || kernel.signature().claim == Statement::With(self.0);
        Kernel::all().filter(is_meant).map(Kernel::function).collect()
    }

    /// The claim in words.
    pub fn words(self) -> &'static str {
        self.said().0
    }

    /// What its functions are proved against, for the data sheet of a module: claims next to each other share it.
    pub fn against(self) -> &'static str {
        self.said().1
    }

    fn said(self) -> (&'static str, &'static str) {
        match self.0.signature().claim {
            Statement::Proved(words, against) => (words, against),
            Statement::None | Statement::With(_) => ("", ""),
        }
    }

    /// The numbers that must be zero; `None` where the textbook divides by the number zero.
    pub(super) fn residuals<'a>(self, case: &Case<'a>) -> Option<Vec<Term<'a>>> {
        let point = &case.point;
        let textbook = case.textbook(point)?;
        let equal = |function: &str, values: Option<Vec<Term<'a>>>| {
            Some(differences(&case.run(function, point), &values?))
        };
        match self.0 {
            Kernel::Phi => Some([equal("phi", textbook.phi())?, normalisations(case)?].concat()),
            Kernel::Nu => equal("nu", textbook.nu()),
            Kernel::Gamma => equal("gamma", textbook.gamma()),
            Kernel::VelocityResidual => equal("velocity_residual", textbook.velocity_residual()),
            Kernel::AppliedForce => equal("applied_force", textbook.applied_force()),
            Kernel::Energy => equal("energy", textbook.energy().map(|energies| energies.to_vec())),
            Kernel::PhiQ => {
                let matrix = textbook.phi_q()?;
                let (values, pattern) = (case.run("phi_q", point), &case.module.phi_q_pattern);
                let on_sphere = sparse_differences(&values, pattern, matrix).concat();
                Some([on_sphere, normalisations_of_phi_q(case)?].concat())
            }
            Kernel::PhiPi => {
                let matrix = textbook.phi_pi()?;
                let (values, pattern) = (case.run("phi_pi", point), &case.module.phi_pi_pattern);
                Some(sparse_differences(&values, pattern, matrix).concat())
            }
            Kernel::Accelerations => {
                let (accelerations, multipliers) = case.motion();
                textbook.residual_of_motion(&accelerations[..6 * case.n_bodies()], &multipliers)
            }
            Kernel::Project => projection(case),
            Kernel::Derivative => derivative(case),
            Kernel::Outputs => {
                let (accelerations, multipliers) = case.motion_at_hand();
                let values = textbook.outputs(&accelerations[..6 * case.n_bodies()], &multipliers);
                Some(differences(&case.run_with("outputs", point, &accelerations), &values?))
            }
            Kernel::ReadJoints => {
                let stretched = stretched(point, &case.factors);
                Some([readings(case, point)?, angles(case, &stretched)?].concat())
            }
            Kernel::ChartVectors => partition::chart_vectors(case),
            Kernel::NewtonStep => partition::newton_step(case),
            Kernel::SolveVelocities => partition::solve_velocities(case),
            Kernel::ToMaximal => joints::to_maximal(case),
            Kernel::ToJoints => joints::to_joints(case),
            Kernel::JointAccelerations => joints::accelerations(case),
            Kernel::JointDerivative => joints::derivative(case),
            Kernel::JointAccelerationsAt => joints::accelerations_at(case),
            Kernel::CorrectedAccelerations => joints::corrected_accelerations(case),
            Kernel::CorrectedDerivative => joints::corrected_derivative(case),
            Kernel::CorrectedMultipliers => joints::corrected_multipliers(case),
            Kernel::CorrectedSolution => joints::corrected_solution(case),
            Kernel::LoopClosure => closure::loop_closure(case),
            Kernel::ClosureDistances => closure::closure_distances(case),
            Kernel::ClosePositions => closure::close_positions(case),
            Kernel::CloseVelocities => closure::close_velocities(case),
            Kernel::JointJacobian => joints::jacobian(case),
            Kernel::JointInputJacobian => joints::input_jacobian(case),
            Kernel::JointParameterJacobian => joints::parameter_jacobian(case),
            Kernel::JointOutputs => observed::outputs(case),
            Kernel::OutputsByState => observed::output_derivatives(case),
            Kernel::FrameJacobians => observed::frame_jacobians(case),
            Kernel::FrameBiases => observed::frame_biases(case),
            other => on_request::residuals(other, case),
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
    expected.extend(textbook.other_rates()?);
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
