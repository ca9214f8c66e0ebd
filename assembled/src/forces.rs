//! Applied forces, paper, eqs. (21) and (22), viscous friction in the joints, and energy.

use crate::lowered::{Joint, Lowered, Motion, Place};
use crate::number::{Number, number};
use gyro_model::JointKind;
use gyro_sim::Energy;
use nalgebra::Vector3;

impl<T: Number> Lowered<T> {
    /// Writes `(f, n' − w̃'J'w')`, body after body.
    pub(crate) fn applied_force(&self, y: &[T], out: &mut [T]) {
        for (slot, (body, out)) in self.bodies.iter().zip(out.as_chunks_mut::<6>().0).enumerate() {
            let w = self.w(y, slot);
            out[..3].copy_from_slice((self.gravity * body.mass).as_slice());
            out[3..].copy_from_slice((-w.cross(&(body.inertia * w))).as_slice());
        }
        for joint in self.joints.iter().filter(|joint| joint.friction != T::zero()) {
            let (on_first, on_second) = self.friction(y, joint);
            add_torque(out, &joint.first.place, &on_first);
            add_torque(out, &joint.second.place, &on_second);
        }
    }

    /// The power of all friction, negative.
    pub(crate) fn power(&self, y: &[T]) -> T {
        let power = |joint: &Joint<T>| match joint.kind {
            JointKind::Revolute => {
                let (i, j) = self.motions(y, joint);
                let rate = relative_rate(joint, &i, &j);
                -joint.friction * rate * rate
            }
            JointKind::Spherical => {
                let (i, j) = self.motions(y, joint);
                -joint.friction * relative_angular_velocity(&i, &j).norm_squared()
            }
            JointKind::Fixed => T::zero(),
        };
        self.joints.iter().map(power).fold(T::zero(), |sum, power| sum + power)
    }

    /// Kinetic and potential energy.
    pub(crate) fn energy(&self, y: &[T]) -> Energy<T> {
        let mut energy = Energy { kinetic: T::zero(), potential: T::zero() };
        for (slot, body) in self.bodies.iter().enumerate() {
            let (r, s, w) = (self.r(y, slot), self.s(y, slot), self.w(y, slot));
            let twice = body.mass * s.norm_squared() + w.dot(&(body.inertia * w));
            energy.kinetic += twice * number(0.5);
            energy.potential -= body.mass * self.gravity.dot(&r);
        }
        energy
    }

    /// Torques of a joint's friction, each in its own body's frame.
    fn friction(&self, y: &[T], joint: &Joint<T>) -> (Vector3<T>, Vector3<T>) {
        let (i, j) = self.motions(y, joint);
        match joint.kind {
            JointKind::Revolute => {
                let torque = -joint.friction * relative_rate(joint, &i, &j);
                (joint.first.h * -torque, joint.second.h * torque)
            }
            JointKind::Spherical => {
                let torque = relative_angular_velocity(&i, &j) * -joint.friction;
                (-i.a.tr_mul(&(j.a * torque)), torque)
            }
            JointKind::Fixed => (Vector3::zeros(), Vector3::zeros()),
        }
    }
}

/// `h_jᵀ w'_j − h_iᵀ w'_i`: the rate of a revolute joint.
pub(crate) fn relative_rate<T: Number>(joint: &Joint<T>, i: &Motion<T>, j: &Motion<T>) -> T {
    joint.second.h.dot(&j.w) - joint.first.h.dot(&i.w)
}

/// `w'_j − A_jᵀ A_i w'_i`, in the second body's frame.
pub(crate) fn relative_angular_velocity<T: Number>(i: &Motion<T>, j: &Motion<T>) -> Vector3<T> {
    j.w - j.a.tr_mul(&(i.a * i.w))
}

fn add_torque<T: Number>(out: &mut [T], place: &Place<T>, torque: &Vector3<T>) {
    if let Place::Slot(slot) = place {
        let out = &mut out[6 * slot + 3..6 * slot + 6];
        out.iter_mut().zip(torque.iter()).for_each(|(out, torque)| *out += *torque);
    }
}
