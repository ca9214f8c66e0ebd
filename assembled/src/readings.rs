//! What joints show: angle, orientation and their rates.

use crate::forces::{relative_angular_velocity, relative_rate};
use crate::lowered::{Joint, Lowered};
use crate::number::Number;
use crate::textbook::{direction_rotation, relative_matrix};
use gyro_model::JointKind;

impl<T: Number> Lowered<T> {
    /// Number of raw readings of all joints.
    pub(crate) fn n_readings(&self) -> usize {
        self.joints.iter().map(|joint| joint.coordinate().n_readings()).sum()
    }

    /// Writes the raw readings, joint after joint.
    pub(crate) fn read_joints(&self, y: &[T], out: &mut [T]) {
        let mut rest = out;
        for joint in &self.joints {
            let (out, after) = rest.split_at_mut(joint.coordinate().n_readings());
            self.read_joint(y, joint, out);
            rest = after;
        }
    }

    fn read_joint(&self, y: &[T], joint: &Joint<T>, out: &mut [T]) {
        let (i, j) = self.motions(y, joint);
        match joint.kind {
            JointKind::Revolute => {
                // Paper, section 3: the second body's zero direction as the first body sees it.
                let zero = direction_rotation(&i.p).tr_mul(&(direction_rotation(&j.p) * joint.second.f));
                out[0] = joint.first.g.dot(&zero);
                out[1] = joint.first.f.dot(&zero);
                out[2] = relative_rate(joint, &i, &j);
            }
            JointKind::Spherical => {
                out[..4].copy_from_slice((relative_matrix(&i.p) * j.p).as_slice());
                out[4..].copy_from_slice(relative_angular_velocity(&i, &j).as_slice());
            }
            JointKind::Fixed => {}
        }
    }
}
