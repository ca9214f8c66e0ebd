//! What joints show: angles, displacements, orientation and their rates.

use crate::model::forces::relative_angular_velocity;
use crate::model::joint::Joint;
use crate::model::lowered::Lowered;
use crate::model::measure::{Coordinate, Measure};
use crate::model::motion::Motion;
use crate::model::place::{Moment, Place};
use crate::model::textbook::{direction_rotation, relative_matrix};
use crate::number::Number;
use gyro_model::JointKind;

impl<T: Number> Lowered<T> {
    /// Number of raw readings of all joints.
    pub(crate) fn n_readings(&self) -> usize {
        self.scene.joints.iter().flat_map(|joint| &joint.readings).map(|reading| reading.n_readings()).sum()
    }

    /// Writes the raw readings, joint after joint.
    pub(crate) fn read_joints(&self, at: Moment<'_, T>, out: &mut [T]) {
        let mut rest = out;
        for joint in &self.scene.joints {
            let len = joint.readings.iter().map(|reading| reading.n_readings()).sum();
            let (out, after) = rest.split_at_mut(len);
            self.read_joint(at, joint, out);
            rest = after;
        }
    }

    fn read_joint(&self, at: Moment<'_, T>, joint: &Joint<T>, out: &mut [T]) {
        let motions = [self.true_motion(at, &joint.first.place), self.true_motion(at, &joint.second.place)];
        if joint.kind == JointKind::Spherical {
            let [i, j] = &motions;
            out[..4].copy_from_slice((relative_matrix(&i.p) * j.p).as_slice());
            out[4..].copy_from_slice(relative_angular_velocity(i, j).as_slice());
            return;
        }
        let mut rest = out;
        for coordinate in (0..joint.references.len()).map(|coordinate| Coordinate::of(joint, coordinate)) {
            let rate = coordinate.grip(joint, &motions).rate;
            let written = match &coordinate.measure {
                Measure::Angle(angle) => {
                    (rest[0], rest[1]) = angle.raw(joint, &motions);
                    rest[2] = rate;
                    3
                }
                Measure::Primitive(primitive) => {
                    (rest[0], rest[1]) = (primitive.jet(joint, &motions)[0], rate);
                    2
                }
            };
            rest = &mut rest[written..];
        }
    }

    /// The motion with a true rotation, also where a stage of the integrator has left p a little off unit length.
    fn true_motion(&self, at: Moment<'_, T>, place: &Place<T>) -> Motion<T> {
        let motion = self.scene.motion(at, place);
        if place.moving_body().is_some() {
            Motion { a: direction_rotation(&motion.p), ..motion }
        } else {
            motion
        }
    }
}
