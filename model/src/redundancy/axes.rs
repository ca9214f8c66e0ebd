//! Along which axes a joint compares its points where some of these rows are redundant.
//!
//! Which of a joint's point rows are redundant is a set of directions: the normal of a planar loop. A selection among
//! rows along fixed axes stays right as long as these directions stay where they are. In space they do not if the body
//! turns that carries the loop; on the joint's bodies the normal stays what it is.

use nalgebra::{DMatrix, Matrix3, Vector3};

use super::select::{INDEPENDENT, extend, outside};
use super::trees::{Motions, TreeRows};
use crate::assemble::projection::{Configuration, Scales};
use crate::kinematics::{Kinematics, value_of};
use crate::{Model, RowOwner};

/// Changes of these directions below this are rounding: poses that are sampled differ by some tenths of a radian.
const STAYS: f64 = 1e-5;

/// Instants of the run at which prescribed rotations are looked at, as parts of it: without a pattern, so that no
/// period fits.
const INSTANTS: usize = 16;

/// A mechanism at poses of one rank.
pub(super) struct Poses<'a> {
    pub(super) model: &'a Model,
    pub(super) kinematics: &'a Kinematics,
    pub(super) scales: &'a Scales,
    /// The first is the start, if the rank is full there.
    pub(super) at: Vec<&'a Configuration>,
    /// With point rows along global axes.
    pub(super) jacobians: Vec<DMatrix<f64>>,
    pub(super) motions: Vec<Motions>,
    pub(super) trees: &'a TreeRows,
    /// The rows of each owner that is not of the trees, in the order in which they are preferred.
    pub(super) groups: &'a [Vec<usize>],
}

impl Poses<'_> {
    /// Of the joints that lose point rows those whose redundant directions turn in space, but less or not at all as the
    /// first body sees them.
    pub(super) fn joints_that_turn(&self, dropped: &[usize]) -> Vec<usize> {
        let rows = self.kinematics.rows();
        let loses_points = |joint: &usize| {
            let own = |row: &&usize| rows[**row].owner == RowOwner::Joint(*joint) && rows[**row].index < 3;
            self.model.joints[*joint].kind.joins_points() && dropped.iter().any(|row| own(&row))
        };
        (0..self.model.joints.len()).filter(loses_points).filter(|&joint| self.turns(joint)).collect()
    }

    /// The Jacobians with the point rows of these joints along the axes of their first bodies. At poses that satisfy
    /// the joints the derivative of `u·d` is `u·∂d`.
    pub(super) fn turned(&self, joints: &[usize]) -> Vec<Motions> {
        let turned = |((motions, jacobian), &at): ((&Motions, &DMatrix<f64>), &&Configuration)| {
            let mut turned = jacobian.clone();
            for &joint in joints {
                let (row, axes) = (self.first_row(joint), self.first_frame(joint, at));
                turned.rows_mut(row, 3).copy_from(&(axes.transpose() * jacobian.rows(row, 3)));
            }
            motions.with(&turned)
        };
        self.motions.iter().zip(&self.jacobians).zip(&self.at).map(turned).collect()
    }

    fn turns(&self, joint: usize) -> bool {
        let poses = self.motions.iter().zip(&self.jacobians);
        let in_space: Vec<Matrix3<f64>> =
            poses.map(|(motions, jacobian)| self.redundant_directions(joint, motions, jacobian)).collect();
        let on_first = in_space.iter().zip(&self.at).map(|(directions, at)| {
            let axes = self.first_frame(joint, at);
            axes.transpose() * directions * axes
        });
        let on_first: Vec<Matrix3<f64>> = on_first.collect();
        let prescribed = prescribed_turning(self.model, &in_space[0]);
        let (in_space, on_first) = (change(&in_space).max(prescribed), change(&on_first));
        in_space > STAYS && on_first < in_space
    }

    /// What points contribute to the combinations of the joint's rows that are nothing by what is preferred to it: the
    /// sum of c cᵀ over an orthonormal basis of these combinations, of whose coefficients c is the points' part.
    fn redundant_directions(&self, joint: usize, motions: &Motions, jacobian: &DMatrix<f64>) -> Matrix3<f64> {
        let mut basis = Vec::new();
        let own = self.groups.iter().position(|group| group.contains(&self.first_row(joint)));
        let (before, own) = self.groups.split_at(own.expect("each row is in a group"));
        before.iter().flatten().for_each(|&row| extend(&mut basis, motions.row(row)));
        let length = |row: usize| jacobian.row(row).norm();
        let left: Vec<_> =
            own[0].iter().map(|&row| outside(motions.row(row), &basis) * length(row)).collect();
        let size = own[0].iter().map(|&row| length(row)).fold(0.0, f64::max);
        // As many values as rows, however few motions there are.
        let (left, count) = (DMatrix::from_columns(&left), own[0].len());
        let left = left.resize_vertically(count.max(motions.count()), 0.0);
        let svd = left.svd(false, true);
        let combinations = svd.v_t.expect("asked for");
        let values = svd.singular_values.iter().enumerate();
        values.filter(|(_, value)| **value <= INDEPENDENT * size).fold(Matrix3::zeros(), |sum, (k, _)| {
            let points = Vector3::from_fn(|axis, _| combinations[(k, axis)]);
            sum + points * points.transpose()
        })
    }

    /// The joint frame (f, g, h) on the first body, in columns.
    pub(super) fn first_frame(&self, joint: usize, at: &Configuration) -> Matrix3<f64> {
        let poses: Vec<_> = self.kinematics.poses(&at.q).iter().map(value_of).collect();
        Matrix3::from_columns(&self.kinematics.posed(joint, &poses).first.map(Vector3::from))
    }

    fn first_row(&self, joint: usize) -> usize {
        let is_own = |row: &crate::Row| row.owner == RowOwner::Joint(joint);
        self.kinematics.rows().iter().position(is_own).expect("it has point rows")
    }
}

/// The largest difference from the first.
fn change(directions: &[Matrix3<f64>]) -> f64 {
    directions.iter().map(|each| (each - directions[0]).amax()).fold(0.0, f64::max)
}

/// How fast driven bodies would turn directions that they carry, in parts of their angular velocity: w × N − N w ×.
fn prescribed_turning(model: &Model, directions: &Matrix3<f64>) -> f64 {
    let mut largest = 0.0_f64;
    for body in &model.bodies {
        let Some(motion) = &body.motion else { continue };
        for instant in 0..INSTANTS {
            let part = ((instant as f64 + 1.0) * 0.618_033_988_749_894_8).fract();
            let now = motion.state(model, body, part * model.simulation.t_end);
            let [x, y, z]: [f64; 3] = now.p.rotate(now.w).into();
            let rate = Vector3::new(x, y, z);
            if rate.norm() > 0.0 {
                let spin = rate.normalize().cross_matrix();
                largest = largest.max((spin * directions - directions * spin).amax());
            }
        }
    }
    largest
}
