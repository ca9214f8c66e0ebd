//! What acts on a body.

use super::jet::Jet;
use super::linear::Vector;
use super::pose::Moving;
use super::scope::Scope;
use crate::field::Field;

/// A force at the mass centre in the global frame, and a torque in the body's.
#[derive(Clone, Debug)]
pub struct Load<F> {
    pub force: Vector<F>,
    pub torque: Vector<F>,
}

impl<F: Field> Load<F> {
    pub fn none(scope: &Scope<'_, F>) -> Self {
        Self { force: scope.no_vector(), torque: scope.no_vector() }
    }

    /// A force, global frame, at a place of the global frame.
    pub fn at(body: &Moving<F>, force: &Vector<F>, place: &Vector<F>) -> Self {
        let moment = (place.clone() - &body.pose.r).cross(force);
        Self { force: force.clone(), torque: body.pose.a.transposed().apply(&moment) }
    }

    /// A torque, global frame.
    pub fn torque(body: &Moving<F>, scope: &Scope<'_, F>, torque: &Vector<F>) -> Self {
        Self { force: scope.no_vector(), torque: body.pose.a.transposed().apply(torque) }
    }

    /// Both together.
    pub fn plus(&self, other: &Self) -> Self {
        Self { force: self.force.clone() + &other.force, torque: self.torque.clone() + &other.torque }
    }

    /// Power on a body: `f·s + n'·w'`.
    pub fn power(&self, body: &Moving<F>) -> Jet<F> {
        self.force.dot(&body.s) + self.torque.dot(&body.w)
    }
}
