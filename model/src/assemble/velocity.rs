//! Velocities of least change that satisfy Φ_q q̇ = ν and the rates that the model file gives.

use nalgebra::{DMatrix, DVector};

use super::START_TOLERANCE;
use super::error::AssemblyError;
use super::guess::Guess;
use super::projection::{Configuration, Scales, nearest_solution, scale_rows_and_columns};
use crate::kinematics::{Equation, Kinematics};
use crate::{Body, JointCoordinate, JointKind, Model, Number, Quaternion, RowOwner, RowUnit, Support};

/// What a rate that the model file gives may be missed by, as a part of what its equation adds up: a model file rounds
/// its numbers. The rows of Φ are met to [`START_TOLERANCE`].
const GIVEN_TOLERANCE: f64 = 1e-9;

/// Linear equations among the velocities.
struct Rates {
    matrix: DMatrix<f64>,
    right: DVector<f64>,
    /// The owner of each row.
    owners: Vec<(RowOwner, RowUnit)>,
}

/// The velocities nearest to others.
pub(super) fn velocities(
    model: &Model,
    kinematics: &Kinematics,
    scales: &Scales,
    guesses: &[Guess],
    at: &Configuration,
    from: &[f64],
) -> Result<Vec<f64>, AssemblyError> {
    // What free bodies that roll are given stays as long as all else can be met.
    let rolls = model.couplers.iter().any(|coupler| coupler.second.is_none());
    let of_free = if rolls { free(model) } else { Rates::none(model) };
    match met(model, kinematics, scales, (guesses, at, from), of_free) {
        Err(_) => met(model, kinematics, scales, (guesses, at, from), Rates::none(model)),
        found => found,
    }
}

fn met(
    model: &Model,
    kinematics: &Kinematics,
    scales: &Scales,
    (guesses, at, from): (&[Guess], &Configuration, &[f64]),
    of_free: Rates,
) -> Result<Vec<f64>, AssemblyError> {
    let rows = rows(kinematics, at);
    let n_rows = rows.owners.len();
    let all = rows.and(given(model, kinematics, guesses, at)).and(of_free).scaled(scales);
    let from = DVector::from_column_slice(from).component_div(&scales.columns);
    let (rows, given) = (all.first(n_rows), all.after(n_rows));
    let mut found = nearest_solution(&all.matrix, &all.right, &from);
    if rows.missed(&found, START_TOLERANCE).is_some() {
        // Rates that the model file rounds may be off a little: then they give way.
        found = nearest_solution(&rows.matrix, &rows.right, &found);
    }
    if rows.missed(&found, START_TOLERANCE).is_none() && given.missed(&found, GIVEN_TOLERANCE).is_none() {
        return Ok(found.component_mul(&scales.columns).as_slice().to_vec());
    }
    // Whether the rows themselves are at fault, or what the model file wants besides.
    let alone = nearest_solution(&rows.matrix, &rows.right, &from);
    let (missed, is_given) = match rows.missed(&alone, START_TOLERANCE) {
        Some(missed) => (missed, false),
        None => (given.farthest(&alone), true),
    };
    let ((owner, unit), residual) = missed;
    let residual = if unit == RowUnit::Length { residual * scales.size } else { residual };
    Err(AssemblyError::Rate { owner, name: model.named(owner), residual, unit, is_given })
}

/// The derivatives of all rows of Φ.
fn rows(kinematics: &Kinematics, at: &Configuration) -> Rates {
    Rates {
        matrix: kinematics.jacobian(&at.q, &at.near),
        right: kinematics.nu(&at.q, &at.near),
        owners: kinematics.rows().iter().map(|row| (row.owner, row.unit)).collect(),
    }
}

/// The rates of joints and the angular velocities of bodies that the model file gives.
fn given(model: &Model, kinematics: &Kinematics, guesses: &[Guess], at: &Configuration) -> Rates {
    let (mut equations, mut right, mut owners) = (Vec::new(), Vec::new(), Vec::new());
    for (joint, guess) in guesses.iter().enumerate() {
        let owner = RowOwner::Joint(joint);
        if model.joints[joint].kind == JointKind::Spherical {
            let rates: Option<Vec<f64>> = guess.rate.iter().copied().collect();
            let Some(rates) = rates else { continue };
            let value = guess.orientation.unwrap_or(Quaternion::IDENTITY);
            equations.push(Equation::Orientation { joint, value });
            // The vector part of Euler parameters grows with half the angular velocity.
            right.extend(rates.iter().map(|rate| 0.5 * rate));
            owners.extend([(owner, RowUnit::Pure); 3]);
            continue;
        }
        for (coordinate, rate) in guess.rate.iter().enumerate() {
            let Some(rate) = *rate else { continue };
            let of = JointCoordinate { joint, coordinate };
            let is_angle = model.coordinate_kind(of).is_angle();
            equations.push(Equation::Coordinate { of, value: at.near[joint][coordinate] });
            right.push(rate);
            owners.push((owner, if is_angle { RowUnit::Pure } else { RowUnit::Length }));
        }
    }
    let drift = kinematics.drift(&equations, &at.q, &at.near);
    let matrix = kinematics.gradients(&equations, &at.q, &at.near);
    let joints = Rates { matrix, right: DVector::from_vec(right) - drift, owners };
    joints.and(spins(model))
}

/// The angular velocities that the model file gives to bodies which are not free.
fn spins(model: &Model) -> Rates {
    Rates::of_bodies(model, |body| {
        let spin = (body.support == Support::Moving).then_some(body.angular_velocity.as_ref()).flatten();
        vec![(RowUnit::Pure, spin)]
    })
}

/// The velocities and angular velocities of free bodies.
fn free(model: &Model) -> Rates {
    Rates::of_bodies(model, |body| {
        let is_free = body.support == Support::Free;
        let velocity = (is_free && given_velocity(body)).then_some(&body.velocity);
        let spin = is_free.then_some(body.angular_velocity.as_ref()).flatten();
        vec![(RowUnit::Length, velocity), (RowUnit::Pure, spin)]
    })
}

/// Whether the model file gives it a velocity: zero is what it has without one.
pub(super) fn given_velocity(body: &Body) -> bool {
    !body.velocity.iter().all(Number::is_zero)
}

impl Rates {
    fn none(model: &Model) -> Self {
        Self::of_bodies(model, |_| Vec::new())
    }

    /// Velocities of bodies with coordinates, as they are.
    fn of_bodies<'m>(
        model: &'m Model,
        given: impl Fn(&'m Body) -> Vec<(RowUnit, Option<&'m [Number; 3]>)>,
    ) -> Self {
        let moving_bodies = model.coordinate_bodies();
        let wanted = moving_bodies.iter().enumerate().flat_map(|(moving_body, &body)| {
            let all = given(&model.bodies[body]).into_iter();
            all.filter_map(move |(unit, numbers)| Some((moving_body, body, unit, model.values(numbers?))))
        });
        let wanted: Vec<_> = wanted.collect();
        let mut matrix = DMatrix::zeros(3 * wanted.len(), 6 * moving_bodies.len());
        for (k, (moving_body, _, unit, _)) in wanted.iter().enumerate() {
            let first = 6 * moving_body + if *unit == RowUnit::Length { 0 } else { 3 };
            matrix.view_mut((3 * k, first), (3, 3)).fill_with_identity();
        }
        let right = DVector::from_vec(wanted.iter().flat_map(|(.., values)| *values).collect());
        let owners = wanted.iter().flat_map(|(_, body, unit, _)| [(RowOwner::Body(*body), *unit); 3]);
        Self { matrix, right, owners: owners.collect() }
    }

    /// Both sets of equations, one after the other.
    fn and(self, other: Self) -> Self {
        let (above, below) = (self.owners.len(), other.owners.len());
        let mut matrix = DMatrix::zeros(above + below, self.matrix.ncols());
        matrix.rows_mut(0, above).copy_from(&self.matrix);
        matrix.rows_mut(above, below).copy_from(&other.matrix);
        let right = DVector::from_iterator(above + below, self.right.iter().chain(&other.right).copied());
        Self { matrix, right, owners: [self.owners, other.owners].concat() }
    }

    /// Rows of lengths by the size, unknowns by their scale.
    fn scaled(mut self, scales: &Scales) -> Self {
        let scale = |(_, unit): &(RowOwner, RowUnit)| match unit {
            RowUnit::Length => 1.0 / scales.size,
            RowUnit::Pure => 1.0,
        };
        let rows = DVector::from_iterator(self.owners.len(), self.owners.iter().map(scale));
        scale_rows_and_columns(&mut self.matrix, &rows, &scales.columns);
        self.right.component_mul_assign(&rows);
        self
    }

    fn first(&self, count: usize) -> Self {
        self.part(0, count)
    }

    fn after(&self, count: usize) -> Self {
        self.part(count, self.owners.len() - count)
    }

    fn part(&self, from: usize, count: usize) -> Self {
        Self {
            matrix: self.matrix.rows(from, count).into_owned(),
            right: self.right.rows(from, count).into_owned(),
            owners: self.owners[from..from + count].to_vec(),
        }
    }

    /// The row that is violated most as a part of what it adds up, if that is more than tolerated, and by how much.
    fn missed(&self, x: &DVector<f64>, tolerance: f64) -> Option<((RowOwner, RowUnit), f64)> {
        let left = &self.matrix * x - &self.right;
        let fastest = x.amax().max(self.right.amax());
        let part = |row: usize| {
            let slopes: f64 = self.matrix.row(row).iter().map(|slope| slope.abs()).sum();
            let size = (1.0 + slopes) * fastest + self.right[row].abs();
            if left[row] == 0.0 { 0.0 } else { left[row].abs() / size }
        };
        let worst = (0..self.owners.len()).max_by(|&a, &b| part(a).total_cmp(&part(b)))?;
        (part(worst) > tolerance).then(|| (self.owners[worst], left[worst]))
    }

    fn farthest(&self, x: &DVector<f64>) -> ((RowOwner, RowUnit), f64) {
        let left = &self.matrix * x - &self.right;
        let worst = left.iamax();
        (self.owners[worst], left[worst])
    }
}
