//! Armatures: what turns, or slides, with a joint's coordinate alone. As [`gyro_model::Joint::armature`] has it, with
//! the rate b·v of the second body relative to the first, of an angle about the second body's axis.

use crate::model::motion::Motion;
use crate::model::path::{Grip, about, along};
use crate::model::place::Moment;
use crate::model::scene::Scene;
use crate::number::{Number, number};
use gyro_model::{JointKind, Model};

/// The armature of a joint.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rotor<T> {
    pub(crate) joint: usize,
    pub(crate) inertia: T,
}

impl<T: Number> Rotor<T> {
    pub(crate) fn all(model: &Model) -> Vec<Self> {
        let joints = model.joints.iter().enumerate().filter(|(_, joint)| !joint.armature.is_zero());
        joints.map(|(joint, of)| Self { joint, inertia: number(model.value(&of.armature)) }).collect()
    }

    /// Its rate, and b: what a unit force along the coordinate does to both bodies.
    pub(crate) fn grip(&self, scene: &Scene<T>, motions: &[Motion<T>; 2]) -> Grip<T> {
        let joint = &scene.joints[self.joint];
        match joint.kind {
            JointKind::Prismatic => along(&joint.first.h, joint, motions),
            _ => about(&(motions[1].a * joint.second.h), motions),
        }
    }

    /// How fast the rate changes while no body with coordinates accelerates.
    pub(crate) fn bias(&self, scene: &Scene<T>, [i, j]: &[Motion<T>; 2]) -> T {
        let joint = &scene.joints[self.joint];
        if joint.kind == JointKind::Prismatic {
            let (u, to, from) =
                (i.direction(&joint.first.h), j.point(&joint.second.point), i.point(&joint.first.point));
            let [d, rate, second] = [to.value - from.value, to.rate - from.rate, to.second - from.second];
            return u.second.dot(&d) + u.rate.dot(&rate) * number(2.0) + u.value.dot(&second);
        }
        let axis = j.direction(&joint.second.h);
        axis.rate.dot(&(j.omega() - i.omega())) + axis.value.dot(&(j.a * j.w_dot - i.a * i.w_dot))
    }

    pub(crate) fn energy(&self, scene: &Scene<T>, at: Moment<'_, T>) -> T {
        let rate = self.grip(scene, &scene.motions(at, &scene.joints[self.joint])).rate;
        self.inertia * rate * rate * number(0.5)
    }
}
