//! Motions prescribed in time, and the bodies that follow them.

use super::attitude::compose;
use super::formula;
use super::jet::Jet;
use super::linear::Vector;
use super::pose::Pose;
use super::scope::Scope;
use crate::field::Field;
use gyro_model::{Body, Model, Motion, Seen};

impl<F: Field> Scope<'_, F> {
    /// A function of time; `None` where a formula is not defined.
    pub fn prescribed(&self, model: &Model, motion: &Motion, t: &Jet<F>) -> Option<Jet<F>> {
        Some(match motion {
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
                let add = |sum, part| Some(sum + self.prescribed(model, part, t)?);
                parts.iter().try_fold(self.zero.clone(), add)?
            }
            Motion::Product(parts) => {
                let multiply = |product, part| Some(product * self.prescribed(model, part, t)?);
                parts.iter().try_fold(self.one.clone(), multiply)?
            }
            Motion::Table(table) => self.spline(table, t),
            Motion::Lines(lines) => {
                let [from, place, rate, acceleration] =
                    lines.inputs.map(|index| Jet::constant(self.point.inputs[index].clone()));
                let u = t - &from;
                place + rate * &u + &self.half * &(acceleration * &(&u * &u))
            }
            Motion::Input(inputs) => {
                let [place, rate, acceleration] = inputs.map(|index| self.point.inputs[index].clone());
                // It moves where time does.
                match t.rate {
                    Some(_) => Jet { value: place, rate: Some(rate), second: Some(acceleration) },
                    None => Jet::constant(place),
                }
            }
            Motion::Formula(formula) => {
                let see = |seen| (seen == Seen::Time).then(|| t.clone());
                formula::value(model, self, &see, &formula.text)?
            }
        })
    }

    /// `r0 + translation(t)` and `A0 R(axis_1, angle_1(t)) R(axis_2, angle_2(t)) ⋯`.
    pub fn driven(&self, model: &Model, body: &Body, t: &Jet<F>) -> Option<Pose<F>> {
        let motion = body.motion.as_ref()?;
        let [x, y, z] = motion.translation.each_ref().map(|x| self.prescribed(model, x, t));
        let translation = Vector([x?, y?, z?]);
        let mut pose = self.given(body)?;
        pose.r = pose.r + translation;
        for (axis, angle) in &motion.rotations {
            let (axis, angle) = (Vector(self.unit(axis)?), self.prescribed(model, angle, t)?);
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
