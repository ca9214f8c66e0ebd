//! The nearest pose, and the nearest velocities, that satisfy equations: damped Gauss–Newton steps of least change.
//!
//! Unknowns are changes (δr, δπ') of the bodies, made comparable: lengths are divided by the mechanism's size, and a
//! body of greater weight counts its changes as greater. Rows of lengths are divided by the size, too.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::START_TOLERANCE;
use crate::kinematics::{Equation, Kinematics, turned};
use crate::{Model, Quaternion, RowUnit};

/// Positions of all bodies with the joint coordinates that say on which turn angles are.
#[derive(Clone, Debug)]
pub(crate) struct Configuration {
    pub(crate) q: Vec<f64>,
    pub(crate) near: Vec<Vec<f64>>,
}

/// Equations among the poses of a mechanism's bodies, scaled.
pub(crate) struct System<'k> {
    kinematics: &'k Kinematics,
    equations: Vec<Equation>,
    /// One for each equation.
    row_scale: DVector<f64>,
    scales: &'k Scales,
}

/// How changes of bodies compare.
#[derive(Clone, Debug)]
pub(crate) struct Scales {
    /// The mechanism's size, m.
    pub(crate) size: f64,
    /// For each of the 6 nb unknowns the change in m or rad that counts as one.
    pub(crate) columns: DVector<f64>,
}

/// Damping of the steps, as a part of the largest diagonal element of J Jᵀ: where they start, where they stay effective
/// on dependent rows without being felt elsewhere, and where no step is left to try.
const DAMPING: [f64; 3] = [1e-6, 1e-13, 1e3];

/// Largest rotation of a body in one step, rad: well below the quarter turn beyond which a dot-1 row leads astray.
const LARGEST_TURN: f64 = 0.2;

/// Steps after which a projection has failed: rough guesses take some ten.
const MAX_STEPS: usize = 200;

/// The part of what it adds up that rounding leaves of an equation, at most: steps go on until then, if they still
/// gain.
const ROUNDING: f64 = 1e-14;

impl Scales {
    /// Weights and size of a model.
    pub(crate) fn of(model: &Model) -> Self {
        let size = model.size();
        let of_body = |body: usize| {
            let weight = model.value(&model.bodies[body].assembly_weight);
            let unit = if weight > 0.0 { 1.0 / weight.sqrt() } else { 1.0 };
            [size * unit, size * unit, size * unit, unit, unit, unit]
        };
        let columns: Vec<f64> = model.coordinate_bodies().into_iter().flat_map(of_body).collect();
        Self { size, columns: DVector::from_vec(columns) }
    }
}

impl Configuration {
    /// The configuration after scaled changes.
    fn changed(&self, kinematics: &Kinematics, by: &DVector<f64>) -> Self {
        let mut q = self.q.clone();
        for (pose, change) in q.chunks_exact_mut(7).zip(by.as_slice().chunks_exact(6)) {
            for k in 0..3 {
                pose[k] += change[k];
            }
            let p = Quaternion([pose[3], pose[4], pose[5], pose[6]]);
            pose[3..].copy_from_slice(&turned(p, [change[3], change[4], change[5]]).0);
        }
        let near = kinematics.coordinates(&q, &self.near);
        Self { q, near }
    }

    /// The changes (δr, δπ') that lead from another configuration to this one.
    fn difference(&self, from: &Self) -> DVector<f64> {
        let of_body = |(to, from): (&[f64], &[f64])| {
            let p = |q: &[f64]| Quaternion([q[3], q[4], q[5], q[6]]);
            let [x, y, z] = rotation_vector(p(from).conjugate() * p(to));
            [to[0] - from[0], to[1] - from[1], to[2] - from[2], x, y, z]
        };
        let pairs = self.q.chunks_exact(7).zip(from.q.chunks_exact(7));
        DVector::from_vec(pairs.flat_map(of_body).collect())
    }
}

/// The rotation vector of a unit quaternion: axis times angle, at most half a turn.
pub(crate) fn rotation_vector(p: Quaternion) -> [f64; 3] {
    let [e0, vector @ ..] = p.nearest(Quaternion::IDENTITY).0;
    let sine = vector.iter().map(|x| x * x).sum::<f64>().sqrt();
    let scale = if sine > 0.0 { 2.0 * sine.atan2(e0) / sine } else { 2.0 };
    vector.map(|x| scale * x)
}

impl<'k> System<'k> {
    pub(crate) fn new(kinematics: &'k Kinematics, equations: Vec<Equation>, scales: &'k Scales) -> Self {
        let units = equations.iter().flat_map(|equation| kinematics.units_of(equation));
        let scale = |unit| if unit == RowUnit::Length { 1.0 / scales.size } else { 1.0 };
        let row_scale = DVector::from_vec(units.map(scale).collect());
        Self { kinematics, equations, row_scale, scales }
    }

    /// The same without some of its scalar rows: they count for nothing.
    pub(crate) fn without(mut self, rows: &[usize]) -> Self {
        for &row in rows {
            self.row_scale[row] = 0.0;
        }
        self
    }

    /// What is left of the equations, scaled.
    pub(crate) fn residual(&self, at: &Configuration) -> DVector<f64> {
        self.kinematics.values(&self.equations, &at.q, &at.near).component_mul(&self.row_scale)
    }

    /// Their derivatives with respect to the scaled changes.
    pub(crate) fn jacobian(&self, at: &Configuration) -> DMatrix<f64> {
        let mut jacobian = self.kinematics.gradients(&self.equations, &at.q, &at.near);
        scale_rows_and_columns(&mut jacobian, &self.row_scale, &self.scales.columns);
        jacobian
    }

    /// Whether the equations are met, each as well as the size of what it adds up allows.
    pub(crate) fn is_met(&self, at: &Configuration) -> bool {
        self.is_within(START_TOLERANCE, at)
    }

    /// Whether no equation is more than a part of what it adds up.
    fn is_within(&self, part: f64, at: &Configuration) -> bool {
        let sizes = self.kinematics.sizes(&self.equations, &at.q, &at.near).component_mul(&self.row_scale);
        self.residual(at).iter().zip(&sizes).all(|(left, size)| left.abs() <= part * (1.0 + size))
    }

    /// Meets the equations by small steps of least change, as nearly as that can be done from here.
    pub(crate) fn project(&self, from: &Configuration) -> Configuration {
        let (mut at, mut residual) = (from.clone(), self.residual(from));
        let mut damping = DAMPING[0];
        for _ in 0..MAX_STEPS {
            if residual.amax() == 0.0 {
                break;
            }
            let jacobian = self.jacobian(&at);
            let Some((next, left)) = self.step(&at, &residual, &jacobian, &mut damping) else { break };
            let (before, after) = (residual.norm(), left.norm());
            (at, residual) = (next, left);
            // At rounding a step no longer gains digits.
            if after > 0.5 * before && self.is_within(ROUNDING, &at) {
                break;
            }
        }
        at
    }

    /// One step that makes the residual smaller; nothing if even a short one does not.
    fn step(
        &self,
        at: &Configuration,
        residual: &DVector<f64>,
        jacobian: &DMatrix<f64>,
        damping: &mut f64,
    ) -> Option<(Configuration, DVector<f64>)> {
        while *damping <= DAMPING[2] {
            if let Some(change) =
                LeastChanges::of(jacobian, *damping).and_then(|least| least.change(residual))
            {
                let next = self.moved(at, &-change);
                let left = self.residual(&next);
                if left.norm() < residual.norm() {
                    *damping = (*damping * 0.1).max(DAMPING[1]);
                    return Some((next, left));
                }
            }
            *damping *= 10.0;
        }
        None
    }

    /// The configuration after a scaled change, which is shortened if it turns a body too far.
    pub(crate) fn moved(&self, at: &Configuration, change: &DVector<f64>) -> Configuration {
        let mut by = change.component_mul(&self.scales.columns);
        let turn = by.as_slice().chunks_exact(6).flat_map(|c| &c[3..]).fold(0.0_f64, |m, x| m.max(x.abs()));
        if turn > LARGEST_TURN {
            by *= LARGEST_TURN / turn;
        }
        at.changed(self.kinematics, &by)
    }

    /// The part of a scaled change that the equations allow, to first order.
    pub(crate) fn tangent(&self, jacobian: &DMatrix<f64>, change: &DVector<f64>) -> DVector<f64> {
        let mut tangent = change.clone();
        let Some(least) = LeastChanges::of(jacobian, DAMPING[1]) else { return tangent };
        for _ in 0..REFINEMENTS {
            let Some(off) = least.change(&(jacobian * &tangent)) else { break };
            tangent -= off;
        }
        tangent
    }

    /// Slides along the equations to the configuration that is nearest to another one, as far as steps downhill lead.
    pub(crate) fn approach(&self, mut at: Configuration, goal: &Configuration) -> Configuration {
        for _ in 0..MAX_APPROACHES {
            let way = self.scaled_difference(goal, &at);
            let along = self.tangent(&self.jacobian(&at), &way);
            if along.amax() < NEAREST {
                break;
            }
            let nearer = [1.0, 0.25, 0.05].into_iter().find_map(|part| {
                let next = self.project(&self.moved(&at, &(&along * part)));
                let distance = self.scaled_difference(goal, &next).norm();
                (self.is_met(&next) && distance < way.norm()).then_some(next)
            });
            match nearer {
                Some(next) => at = next,
                None => break,
            }
        }
        at
    }

    /// The configuration on the way from one to another, each body turning about one axis.
    pub(crate) fn between(&self, from: &Configuration, to: &Configuration, part: f64) -> Configuration {
        from.changed(self.kinematics, &(to.difference(from) * part))
    }

    /// The least change that makes the equations miss by as much as is given.
    pub(crate) fn project_onto(&self, from: &Configuration, missed: &DVector<f64>) -> Configuration {
        let mut at = from.clone();
        for _ in 0..MAX_CORRECTIONS {
            let left = self.residual(&at) - missed;
            let jacobian = self.jacobian(&at);
            let least = LeastChanges::of(&jacobian, DAMPING[1]);
            let Some(change) = least.and_then(|least| least.change(&left)) else { break };
            at = self.moved(&at, &-&change);
            if change.amax() < NEAREST {
                break;
            }
        }
        at
    }

    /// From one configuration to another, scaled.
    pub(crate) fn scaled_difference(&self, to: &Configuration, from: &Configuration) -> DVector<f64> {
        to.difference(from).component_div(&self.scales.columns)
    }
}

/// Newton's steps after a short step along a path.
const MAX_CORRECTIONS: usize = 6;

/// Slides along the constraints that may follow a projection.
const MAX_APPROACHES: usize = 30;

/// A slide below this (rad, or parts of the size) is not worth while.
const NEAREST: f64 = 1e-7;

/// Repetitions that make up for the damping.
const REFINEMENTS: usize = 4;

/// Multiplies in place: rows by a part of the equations' scale, columns by that of the unknowns.
pub(crate) fn scale_rows_and_columns(matrix: &mut DMatrix<f64>, rows: &DVector<f64>, columns: &DVector<f64>) {
    for (mut column, scale) in matrix.column_iter_mut().zip(columns) {
        column.component_mul_assign(rows);
        column *= *scale;
    }
}

/// The least changes x with J x = b, damped: `Jᵀ (J Jᵀ + μ)⁻¹ b`. Dependent rows that agree do no harm.
struct LeastChanges<'j> {
    jacobian: &'j DMatrix<f64>,
    /// None if J is zero.
    factor: Option<Cholesky<f64, Dyn>>,
}

impl<'j> LeastChanges<'j> {
    /// Factors `J Jᵀ + μ`, if that can be done.
    fn of(jacobian: &'j DMatrix<f64>, damping: f64) -> Option<Self> {
        let mut normal = jacobian * jacobian.transpose();
        let largest = normal.diagonal().amax();
        if largest == 0.0 {
            return Some(Self { jacobian, factor: None });
        }
        for k in 0..normal.nrows() {
            normal[(k, k)] += damping * largest;
        }
        Some(Self { jacobian, factor: Some(Cholesky::new(normal)?) })
    }

    fn change(&self, b: &DVector<f64>) -> Option<DVector<f64>> {
        let Some(factor) = &self.factor else { return Some(DVector::zeros(self.jacobian.ncols())) };
        let change = self.jacobian.tr_mul(&factor.solve(b));
        change.iter().all(|x| x.is_finite()).then_some(change)
    }
}

/// The x nearest to another with J x = b, as nearly as that can be: refined until that gains no more digits.
pub(crate) fn nearest_solution(
    jacobian: &DMatrix<f64>,
    b: &DVector<f64>,
    from: &DVector<f64>,
) -> DVector<f64> {
    let mut x = from.clone();
    let mut left = b - jacobian * &x;
    let Some(least) = LeastChanges::of(jacobian, DAMPING[1]) else { return x };
    for refinement in 0..MAX_STEPS {
        let Some(change) = least.change(&left) else { break };
        let next = &x + change;
        let after = b - jacobian * &next;
        if refinement >= REFINEMENTS && after.norm() > 0.99 * left.norm() {
            break;
        }
        (x, left) = (next, after);
    }
    x
}

/// Numbers between −1 and 1 without a pattern: the golden-ratio sequence, so that nothing depends on a generator.
pub(crate) fn scattered(count: usize, series: usize) -> DVector<f64> {
    let [golden, plastic] = [0.618_033_988_749_894_8, 0.754_877_666_246_692_8];
    DVector::from_fn(count, |k, _| {
        let x = (k + 1) as f64 * golden + (series + 1) as f64 * plastic;
        2.0 * x.fract() - 1.0
    })
}
