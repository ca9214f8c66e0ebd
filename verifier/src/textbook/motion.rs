//! Motions prescribed in time, and the bodies that follow them.

use super::attitude::compose;
use super::jet::Jet;
use super::linear::Vector;
use super::pose::Pose;
use super::scope::Scope;
use crate::field::Field;
use gyro_model::{Body, BodyMotion, Motion};

impl<F: Field> Scope<'_, F> {
    /// A function of time.
    pub fn prescribed(&self, motion: &Motion, t: &Jet<F>) -> Jet<F> {
        match motion {
            Motion::Polynomial(coefficients) => {
                let mut power = self.one.clone();
                coefficients.iter().fold(self.zero.clone(), |sum, coefficient| {
                    let term = self.number(coefficient) * &power;
                    power = &power * t;
                    sum + term
                })
            }
            Motion::Sinusoid { amplitude, angular_frequency, phase } => {
                let argument = self.number(angular_frequency) * t + self.number(phase);
                self.number(amplitude) * self.sin(&argument)
            }
            Motion::Sum(parts) => {
                parts.iter().fold(self.zero.clone(), |sum, part| sum + self.prescribed(part, t))
            }
            Motion::Product(parts) => {
                parts.iter().fold(self.one.clone(), |product, part| product * self.prescribed(part, t))
            }
            Motion::Table(table) => self.spline(table, t),
            Motion::Lines(lines) => {
                let [from, place, rate, acceleration] =
                    lines.inputs.map(|index| Jet::constant(self.point.inputs[index].clone()));
                let u = t - &from;
                place + rate * &u + &self.half * &(acceleration * &(&u * &u))
            }
        }
    }

    /// `r0 + translation(t)` and `A0 R(axis_1, angle_1(t)) R(axis_2, angle_2(t)) ⋯`.
    pub fn driven(&self, body: &Body, motion: &BodyMotion, t: &Jet<F>) -> Option<Pose<F>> {
        let translation = Vector(motion.translation.each_ref().map(|x| self.prescribed(x, t)));
        let mut pose = self.given(body)?;
        pose.r = pose.r + translation;
        for (axis, angle) in &motion.rotations {
            let (axis, angle) = (Vector(self.unit(axis)?), self.prescribed(angle, t));
            pose.a = pose.a.product(&self.rotation_about(&axis, &angle));
            pose.p = compose(&pose.p, &self.euler_about(&axis, &angle));
        }
        Some(pose)
    }

    /// The pose that the model file gives a body.
    pub fn given(&self, body: &Body) -> Option<Pose<F>> {
        let p = self.unit(&body.orientation)?;
        Some(Pose { r: self.vector(&body.position), a: self.rotation(&p), p })
    }
}
