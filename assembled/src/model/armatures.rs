//! What armatures take of the mechanism: as parts of its masses and of its forces.

use crate::model::lowered::Lowered;
use crate::model::path::Wrench;
use crate::model::place::{Moment, Place};
use crate::model::rotor::Rotor;
use crate::number::Number;

impl<T: Number> Lowered<T> {
    /// That of a joint.
    pub(crate) fn armature(&self, joint: usize) -> T {
        let own = self.rotors.iter().find(|rotor| rotor.joint == joint);
        own.map_or(T::zero(), |rotor| rotor.inertia)
    }

    /// Calls the sink with what each armature exerts on the bodies with coordinates while none of these accelerates.
    pub(crate) fn biases_of_rotors(&self, at: Moment<'_, T>, mut sink: impl FnMut(usize, Wrench<T>)) {
        for rotor in &self.rotors {
            let joint = &self.scene.joints[rotor.joint];
            let motions = self.scene.motions(at, joint);
            let taken = rotor.inertia * rotor.bias(&self.scene, &motions);
            let wrenches = rotor.grip(&self.scene, &motions).wrenches;
            for (end, wrench) in [&joint.first, &joint.second].into_iter().zip(wrenches) {
                end.place.moving_body().into_iter().for_each(|body| sink(body, wrench.times(-taken)));
            }
        }
    }

    /// Calls the sink with the entries of `Σ J b bᵀ`, several times with some.
    pub(crate) fn masses_of_rotors(&self, at: Moment<'_, T>, mut sink: impl FnMut(usize, usize, T)) {
        for rotor in &self.rotors {
            let b = self.directions(at, rotor);
            for (row, left) in b.iter() {
                b.iter().for_each(|(column, right)| sink(row, column, rotor.inertia * left * right));
            }
        }
    }

    /// Calls the sink with what these accelerations `(s̈, ẇ')` of bodies take of the armatures, `Σ J b (b·v̇)`, by
    /// place.
    pub(crate) fn taken_by_rotors(
        &self,
        at: Moment<'_, T>,
        accelerations: &[T],
        mut sink: impl FnMut(usize, T),
    ) {
        for rotor in &self.rotors {
            let b = self.directions(at, rotor);
            let rate = b.dot(accelerations);
            b.iter().for_each(|(place, b)| sink(place, rotor.inertia * b * rate));
        }
    }

    /// The power that bodies that move by prescription need against the armatures.
    pub(crate) fn power_into_rotors(&self, at: Moment<'_, T>, accelerations: &[T]) -> T {
        let mut power = T::zero();
        for rotor in &self.rotors {
            let joint = &self.scene.joints[rotor.joint];
            let motions = self.scene.motions(at, joint);
            let moved = self.directions(at, rotor).dot(accelerations);
            let taken = rotor.inertia * (moved + rotor.bias(&self.scene, &motions));
            let wrenches = rotor.grip(&self.scene, &motions).wrenches;
            let ends = [&joint.first, &joint.second].into_iter().zip(wrenches).zip(&motions);
            for ((end, wrench), motion) in ends {
                if let Place::Driven(_) = end.place {
                    power += wrench.power(motion) * taken;
                }
            }
        }
        power
    }

    /// b by places among the velocities.
    fn directions(&self, at: Moment<'_, T>, rotor: &Rotor<T>) -> Directions<T> {
        let joint = &self.scene.joints[rotor.joint];
        let [first, second] = rotor.grip(&self.scene, &self.scene.motions(at, joint)).wrenches;
        let of = |place: &Place<T>, wrench: Wrench<T>| {
            let (f, n) = (wrench.force, wrench.torque);
            Some((place.moving_body()?, [f.x, f.y, f.z, n.x, n.y, n.z]))
        };
        Directions([of(&joint.first.place, first), of(&joint.second.place, second)])
    }
}

/// b of the bodies with coordinates.
struct Directions<T>([Option<(usize, [T; 6])>; 2]);

impl<T: Number> Directions<T> {
    /// With places among the velocities.
    fn iter(&self) -> impl Iterator<Item = (usize, T)> + '_ {
        self.0.iter().flatten().flat_map(|&(body, b)| (0..6).map(move |k| (6 * body + k, b[k])))
    }

    /// b·v̇.
    fn dot(&self, accelerations: &[T]) -> T {
        self.iter().fold(T::zero(), |sum, (place, b)| sum + b * accelerations[place])
    }
}
