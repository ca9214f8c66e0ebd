//! Energy, and the power of what the energy does not account for.

use crate::model::amount::Now;
use crate::model::bushing::Part;
use crate::model::forces::Element;
use crate::model::lowered::Lowered;
use crate::model::place::{Moment, Place};
use crate::number::{Number, number};
use gyro_sim::Energy;

/// What enters a mechanism, W. Energy minus the integral of both stays constant.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Power<T> {
    /// Of non-conservative forces, on the bodies at both of their ends.
    pub(crate) non_conservative: T,
    /// Of drivers and of bodies that move by prescription: `−λᵀν`, and what these bodies do against the forces on them.
    pub(crate) drivers: T,
}

impl<T: Number> Lowered<T> {
    /// Kinetic and potential energy, the latter of gravity and springs.
    pub(crate) fn energy(&self, at: Moment<'_, T>) -> Energy<T> {
        let mut energy = Energy { kinetic: T::zero(), potential: T::zero() };
        for (moving_body, body) in self.scene.bodies.iter().enumerate() {
            let (r, s, w) = (
                self.scene.r(at.y, moving_body),
                self.scene.s(at.y, moving_body),
                self.scene.w(at.y, moving_body),
            );
            let twice = body.mass * s.norm_squared() + w.dot(&(body.inertia * w));
            energy.kinetic += twice * number(0.5);
            energy.potential -= body.mass * self.scene.gravity.dot(&r);
        }
        for element in &self.elements {
            match element {
                Element::Along { path, law } => {
                    let now = Now::new(&self.scene, at);
                    energy.potential += law.potential(&now, || path.value(&self.scene, at));
                }
                Element::Between(bushing, Part::Springs) => {
                    energy.potential += bushing.potential(&self.scene, at);
                }
                Element::Attraction { place, mass } => {
                    let r = self.scene.motion(at, place).r;
                    energy.potential += self.scene.potential_at(&r) * *mass;
                }
                Element::Between(_, Part::Rest) | Element::Ball { .. } | Element::Load { .. } => {}
            }
        }
        for rotor in &self.rotors {
            energy.kinetic += rotor.energy(&self.scene, at);
        }
        energy
    }

    /// The power of all forces and drivers, given `λᵀν` and the accelerations.
    pub(crate) fn power(&self, at: Moment<'_, T>, lambda_nu: T, accelerations: &[T]) -> Power<T> {
        let drivers = self.power_into_rotors(at, accelerations) - lambda_nu;
        let mut power = Power { non_conservative: T::zero(), drivers };
        for element in &self.elements {
            element.exert(&self.scene, at, |place, motion, wrench| {
                let on_body = wrench.power(motion);
                if !element.is_conservative() {
                    power.non_conservative += on_body;
                }
                if let Place::Driven(_) = place {
                    power.drivers -= on_body;
                }
            });
        }
        power
    }
}
