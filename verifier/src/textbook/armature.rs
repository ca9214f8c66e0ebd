//! Armatures of joints: what turns, or slides, with a joint's coordinate alone.
//!
//! The rate is that of the second body relative to the first, `h_j·(ω_j − ω_i)` of an angle, `(h_i·d)˙` of a
//! displacement. With b, what a unit force along it does to the bodies, equal and opposite, it is `b·v`; so the inertia
//! J has the energy `½ J (b·v)²` and takes `J (b·v̇ + ḃ·v)` along b.

use super::Evaluation;
use super::jet::Jet;
use super::linear::Vector;
use super::load::Load;
use super::pose::Path;
use crate::field::Field;
use gyro_model::{CoordinateKind, JointCoordinate};

/// The armature of a joint.
pub(super) struct Rotor<F> {
    pub inertia: Jet<F>,
    /// b·v.
    pub rate: Jet<F>,
    /// ḃ·v, and what bodies without coordinates add to the acceleration.
    pub bias: F,
    /// The bodies, and b of each.
    pub along: [(usize, Load<F>); 2],
}

impl<F: Field> Evaluation<'_, F> {
    /// Those of all joints that have one.
    pub(super) fn rotors(&self) -> Vec<Rotor<F>> {
        let joints = self.textbook.model.joints.iter().enumerate();
        let with = joints.filter(|(_, joint)| !joint.armature.is_zero());
        with.map(|(joint, of)| self.rotor(joint, self.scope.number(&of.armature))).collect()
    }

    fn rotor(&self, joint: usize, inertia: Jet<F>) -> Rotor<F> {
        let (frames, on) = (&self.joints[joint], JointCoordinate { joint, coordinate: 0 });
        let (zero, bodies) = (&self.scope.zero.value, [frames.first.body, frames.second.body]);
        let poses = self.poses(Path::Motion);
        let placed = frames.placed(&poses);
        if self.textbook.model.coordinate_kind(on) == CoordinateKind::Displacement {
            let rate = placed.h_i.dot(&placed.d).derivative(zero);
            let [first, second] = self.loads_along(on, &self.scope.one);
            return Rotor {
                inertia,
                bias: rate.derivative(zero).value,
                rate: rate.frozen(),
                along: [(bodies[0], first), (bodies[1], second)],
            };
        }
        let [i, j] = bodies.map(|body| &self.moving[body]);
        // Of bodies with coordinates ω̇ = A ẇ' is left out.
        let at_rest = vec![zero.clone(); 6 * self.textbook.moving_bodies.len()];
        let [rate_i, rate_j] =
            bodies.map(|body| self.moving[body].pose.a.apply(&self.acceleration(body, &at_rest).w));
        let still = |v: &Vector<F>| Vector(v.0.each_ref().map(Jet::frozen));
        let turning = Vector(placed.h_j.0.each_ref().map(|x| x.derivative(zero).frozen()));
        let (axis, relative) = (still(&placed.h_j), j.omega() - i.omega());
        let bias = turning.dot(&relative) + axis.dot(&(rate_j - rate_i));
        let [on_first, on_second] = [(i, -axis.clone()), (j, axis.clone())]
            .map(|(body, torque)| Load::torque(body, &self.scope, &torque));
        Rotor {
            inertia,
            rate: axis.dot(&relative),
            bias: bias.value,
            along: [(bodies[0], on_first), (bodies[1], on_second)],
        }
    }

    /// b of a rotor by places among the velocities.
    pub(super) fn places_of(&self, rotor: &Rotor<F>) -> Vec<(usize, F)> {
        let ends = rotor.along.iter().filter_map(|(body, load)| {
            let first = 6 * self.textbook.moving_body_of(*body)?;
            let numbers = load.force.0.iter().chain(&load.torque.0);
            Some(numbers.enumerate().map(move |(k, x)| (first + k, x.value.clone())))
        });
        ends.flatten().collect()
    }

    /// How a rotor accelerates where bodies accelerate by `(s̈, ẇ')`.
    pub(super) fn acceleration_of(&self, rotor: &Rotor<F>, accelerations: &[F]) -> F {
        let places = self.places_of(rotor);
        places.iter().fold(rotor.bias.clone(), |sum, (place, b)| sum.add(&b.mul(&accelerations[*place])))
    }
}
