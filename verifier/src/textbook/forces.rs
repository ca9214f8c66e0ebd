//! Forces besides gravity: see [`gyro_model::ForceKind`].

use super::Evaluation;
use super::jet::Jet;
use super::laws::{Own, Slopes};
use super::linear::Vector;
use super::load::Load;
use crate::field::Field;
use gyro_model::{ForceKind, JointCoordinate, JointKind, LoadFrame, Number, Seen, StopSide};

/// All forces but gravity together.
#[derive(Clone, Debug)]
pub struct Forces<F> {
    /// On each body of the model, whether it has coordinates or not.
    pub loads: Vec<Load<F>>,
    /// Energy of springs.
    pub potential: Jet<F>,
    /// Power of forces that store no energy.
    pub power: Jet<F>,
}

impl<F: Field> Evaluation<'_, F> {
    /// `None` where a force is not defined: at a link of zero length.
    pub(super) fn forces(&self) -> Option<Forces<F>> {
        let model = self.textbook.model;
        let (none, zero) = (Load::none(&self.scope), self.scope.zero.clone());
        let mut forces =
            Forces { loads: vec![none; model.bodies.len()], potential: zero.clone(), power: zero };
        for joint in 0..model.joints.len() {
            self.add_damping(&mut forces, joint)?;
        }
        for force in &model.forces {
            self.add(&mut forces, &force.kind)?;
        }
        Some(forces)
    }

    fn add(&self, forces: &mut Forces<F>, kind: &ForceKind) -> Option<()> {
        match kind {
            ForceKind::Spring { on, stiffness, free } => {
                let stretch = self.coordinate(*on, &self.still)? - self.scope.number(free);
                let pull = self.scope.number(stiffness) * &stretch;
                forces.potential = &forces.potential + &pull * stretch * &self.scope.half;
                self.push_along(forces, *on, &-pull);
            }
            ForceKind::Damper { on, damping } => self.add_damper(forces, *on, damping)?,
            ForceKind::Coulomb { on, level, rate } => {
                let ratio = self.coordinate_rate(*on) * self.scope.number(rate).reciprocal()?;
                let force = -(self.strength(level)? * self.scope.tanh(&ratio));
                self.work_along(forces, *on, &force);
            }
            ForceKind::Stop { on, .. } => {
                let force = self.stop(kind)?;
                self.work_along(forces, *on, &force);
            }
            ForceKind::Motor { on, value } => self.work_along(forces, *on, &self.strength(value)?),
            ForceKind::Link { .. } => self.add_link(forces, kind)?,
            ForceKind::Bushing(bushing) => self.add_bushing(forces, bushing)?,
            ForceKind::Load { .. } => self.add_load(forces, kind)?,
            ForceKind::Potential { energy } => {
                let Slopes { value, along } =
                    self.slopes(energy, |seen| matches!(seen, Seen::Coordinate(_)))?;
                forces.potential = &forces.potential + value;
                along.iter().for_each(|(on, slope)| self.push_along(forces, *on, &-slope.clone()));
            }
            ForceKind::Dissipation { power } => {
                let Slopes { along, .. } = self.slopes(power, |seen| matches!(seen, Seen::Rate(_)))?;
                for (on, slope) in along {
                    self.work_along(forces, on, &-(slope * &self.scope.half));
                }
            }
        }
        Some(())
    }

    /// A joint's own viscous damping: along its one coordinate, or against all relative rotation.
    fn add_damping(&self, forces: &mut Forces<F>, joint: usize) -> Option<()> {
        let description = &self.textbook.model.joints[joint];
        if description.damping.is_zero() {
            return Some(());
        }
        if description.kind != JointKind::Spherical {
            return self.add_damper(forces, JointCoordinate { joint, coordinate: 0 }, &description.damping);
        }
        let [first, second] = [description.first.body, description.second.body];
        let spin = self.moving[second].omega() - self.moving[first].omega();
        let drag = spin.times(&self.scope.number(&description.damping));
        forces.power = &forces.power - drag.dot(&spin);
        forces.push(first, &Load::torque(&self.moving[first], &self.scope, &drag));
        forces.push(second, &Load::torque(&self.moving[second], &self.scope, &-drag));
        Some(())
    }

    fn add_damper(&self, forces: &mut Forces<F>, on: JointCoordinate, damping: &Number) -> Option<()> {
        let force = -(self.strength(damping)? * self.coordinate_rate(on));
        self.work_along(forces, on, &force);
        Some(())
    }

    /// `∓stiffness ρ(z) − damping σ(z) ẋ` with z the depth beyond the limit.
    fn stop(&self, kind: &ForceKind) -> Option<Jet<F>> {
        let ForceKind::Stop { on, limit, side, stiffness, damping, softness } = kind else { return None };
        let [limit, stiffness, softness] =
            [limit, stiffness, softness].map(|number| self.scope.number(number));
        let damping = self.strength(damping)?;
        let beyond = self.coordinate(*on, &self.still)? - limit;
        let z = if *side == StopSide::Upper { beyond } else { -beyond };
        let root = self.scope.sqrt(&(&z * &z + &softness * &softness))?;
        let ramp = (&z + &root) * &self.scope.half;
        let slope = (&self.scope.one + &z * root.reciprocal()?) * &self.scope.half;
        let push = stiffness * ramp;
        let push = if *side == StopSide::Upper { -push } else { push };
        Some(push - damping * slope * self.coordinate_rate(*on))
    }

    /// Of a spring its force and how far it is from where it is free; of a link its thrust, its length and how fast
    /// that grows.
    pub(super) fn elastic(&self, force: usize) -> Option<Vec<F>> {
        let numbers = match &self.textbook.model.forces[force].kind {
            ForceKind::Spring { on, stiffness, free } => {
                let stretch = self.coordinate(*on, &self.still)? - self.scope.number(free);
                vec![-(self.scope.number(stiffness) * &stretch), stretch]
            }
            ForceKind::Link { first, second, stiffness, damping, free_length, tension } => {
                let [from, to] = [first, second].map(|(body, point)| {
                    let (moving, point) = (&self.moving[*body], self.scope.vector(point));
                    (moving.pose.point(&point), moving.velocity(&point))
                });
                let (line, drift) = (to.0 - from.0, to.1 - from.1);
                let length = self.scope.sqrt(&line.dot(&line))?;
                let growth = line.dot(&drift) * length.reciprocal()?;
                let pull = self.scope.number(stiffness) * (length.clone() - self.scope.number(free_length));
                let [damping, tension] =
                    [damping, tension].map(|number| self.strength_of(number, Own::Line([&length, &growth])));
                vec![-(pull + damping? * &growth + tension?), length, growth]
            }
            _ => return None,
        };
        Some(numbers.into_iter().map(|number| number.value).collect())
    }

    /// Along the line between two points.
    fn add_link(&self, forces: &mut Forces<F>, kind: &ForceKind) -> Option<()> {
        let ForceKind::Link { first, second, stiffness, damping, free_length, tension } = kind else {
            return None;
        };
        let (i, j) = (&self.moving[first.0], &self.moving[second.0]);
        let [s_i, s_j] = [&first.1, &second.1].map(|point| self.scope.vector(point));
        let [stiffness, free] = [stiffness, free_length].map(|number| self.scope.number(number));
        let d = j.pose.point(&s_j) - i.pose.point(&s_i);
        let length = self.scope.sqrt(&d.dot(&d))?;
        let unit = d.times(&length.reciprocal()?);
        let speed = unit.dot(&(j.velocity(&s_j) - i.velocity(&s_i)));
        let [damping, tension] =
            [damping, tension].map(|number| self.strength_of(number, Own::Line([&length, &speed])));
        let stretch = length - free;
        let (pull, drag) = (stiffness * &stretch, damping? * &speed + tension?);
        let force = unit.times(&-(&pull + &drag));
        forces.potential = &forces.potential + pull * stretch * &self.scope.half;
        forces.power = &forces.power - drag * speed;
        forces.push(first.0, &Load::at(i, &-force.clone(), &i.pose.point(&s_i)));
        forces.push(second.0, &Load::at(j, &force, &j.pose.point(&s_j)));
        Some(())
    }

    fn add_load(&self, forces: &mut Forces<F>, kind: &ForceKind) -> Option<()> {
        let ForceKind::Load { body, point, force, torque, frame } = kind else { return None };
        let moving = &self.moving[*body];
        let in_global = |v: Vector<F>| match frame {
            LoadFrame::Global => v,
            LoadFrame::Body => moving.pose.a.apply(&v),
        };
        let [force, torque] = [in_global(self.strengths(force)?), in_global(self.strengths(torque)?)];
        let place = moving.pose.point(&self.scope.vector(point));
        let pushed = Load::at(moving, &force, &place);
        let load = pushed.plus(&Load::torque(moving, &self.scope, &torque));
        forces.power = &forces.power + load.power(moving);
        forces.push(*body, &load);
        Some(())
    }

    /// A force along a coordinate that stores no energy.
    fn work_along(&self, forces: &mut Forces<F>, on: JointCoordinate, force: &Jet<F>) {
        forces.power = &forces.power + force * self.coordinate_rate(on);
        self.push_along(forces, on, force);
    }

    fn push_along(&self, forces: &mut Forces<F>, on: JointCoordinate, force: &Jet<F>) {
        let joint = &self.joints[on.joint];
        let [on_first, on_second] = self.loads_along(on, force);
        forces.push(joint.first.body, &on_first);
        forces.push(joint.second.body, &on_second);
    }
}

impl<F: Field> Forces<F> {
    pub(super) fn push(&mut self, body: usize, load: &Load<F>) {
        self.loads[body] = self.loads[body].plus(load);
    }
}
