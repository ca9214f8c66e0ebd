//! Which numbers of joints' reactions redundant rows leave undetermined: multipliers that do nothing may be added to
//! those of a motion, and what of a reaction they have no part in is unique.

use nalgebra::{DMatrix, Matrix3, Vector3};

use super::axes::Poses;
use super::select::TAKES_PART;
use crate::RowOwner;
use crate::kinematics::value_of;

/// Force and torque of a joint in its first body's frame (f, g, h), the torque about the second body's joint point.
type Wrench = [f64; 6];

impl Poses<'_> {
    /// For each joint that multipliers of a dropped row reach the numbers of its reaction that they change.
    pub(super) fn loads(&self, idle: &[DMatrix<f64>], dropped: usize) -> Vec<(usize, [bool; 6])> {
        let mut changed = vec![[false; 6]; self.model.joints.len()];
        for (pose, idle) in idle.iter().enumerate() {
            let wrenches: Vec<Wrench> =
                (0..changed.len()).map(|joint| self.wrench(pose, idle, (dropped, joint))).collect();
            let largest = wrenches.iter().flatten().fold(0.0_f64, |largest, x| largest.max(x.abs()));
            for (changed, wrench) in changed.iter_mut().zip(&wrenches) {
                for (changed, part) in changed.iter_mut().zip(wrench) {
                    *changed |= part.abs() > TAKES_PART * largest;
                }
            }
        }
        changed.into_iter().enumerate().filter(|(_, changed)| changed.contains(&true)).collect()
    }

    /// What such multipliers make of a joint's reaction: torques by the size of the mechanism.
    fn wrench(&self, pose: usize, idle: &DMatrix<f64>, (dropped, joint): (usize, usize)) -> Wrench {
        let (described, bodies) = (&self.model.joints[joint], self.model.coordinate_bodies());
        let place = |body: usize| bodies.iter().position(|other| *other == body).map(|place| (body, place));
        // The reaction on the one body is the opposite of that on the other.
        let Some((body, place)) = place(described.second.body).or_else(|| place(described.first.body)) else {
            return [0.0; 6];
        };
        let (jacobian, columns) = (&self.motions[pose].jacobian, &self.scales.columns);
        let mut by = [0.0; 6];
        for (row, of) in self.kinematics.rows().iter().enumerate() {
            if of.owner == RowOwner::Joint(joint) {
                for (k, by) in by.iter_mut().enumerate() {
                    let column = 6 * place + k;
                    *by += idle[(dropped, row)] * jacobian[(row, column)] / columns[column];
                }
            }
        }
        let [x, y, z, a, b, c] = by;
        let at = self.at[pose];
        let poses: Vec<_> = self.kinematics.poses(&at.q).iter().map(value_of).collect();
        let turning = Matrix3::from_fn(|row, column| poses[body].a[row][column]);
        let second = &poses[described.second.body];
        let point = second.point(crate::Vector::from(self.model.values(&described.second.point)));
        let arm = Vector3::from(poses[body].r) - Vector3::from(point);
        let (force, frame) = (Vector3::new(x, y, z), self.first_frame(joint, at));
        let torque = (turning * Vector3::new(a, b, c) + arm.cross(&force)) / self.scales.size;
        let [force, torque] = [force, torque].map(|vector| frame.transpose() * vector);
        [force.x, force.y, force.z, torque.x, torque.y, torque.z]
    }
}
