//! What acts between two frames: see [`gyro_model::Bushing`].
//!
//! Its six readings are typed as functions of the poses of both bodies. Rates and loads are their derivatives, along
//! the motion and along each unit velocity: along each, the loads have the power of the forces along the readings.

use super::Evaluation;
use super::forces::Forces;
use super::jet::Jet;
use super::laws::Own;
use super::linear::Vector;
use super::load::Load;
use super::pose::Pose;
use crate::field::Field;
use gyro_model::{Bushing, ForceKind, Output, OutputKind};
use std::array::from_fn;

/// Six numbers along the readings.
type Six<F> = [Jet<F>; 6];

impl<F: Field> Evaluation<'_, F> {
    pub(super) fn add_bushing(&self, forces: &mut Forces<F>, bushing: &Bushing) -> Option<()> {
        let [places, rates] = self.seen_between(bushing)?;
        let along = self.along_readings(bushing, &places, &rates)?;
        for ((stored, working), rate) in along.iter().zip(&rates) {
            let (pull, place) = stored;
            forces.potential = &forces.potential - pull * place * &self.scope.half;
            forces.power = &forces.power + working * rate;
        }
        let together: Vec<_> = along.iter().map(|((pull, _), working)| pull + working).collect();
        for (end, frame) in bushing.ends().into_iter().enumerate() {
            let load = self.load_of_bushing(bushing, end, &together)?;
            forces.push(frame.body, &load);
        }
        self.add_moment(forces, bushing, Own::Frames([&places, &rates]))
    }

    /// A torque by the axes of the first frame.
    fn add_moment(&self, forces: &mut Forces<F>, bushing: &Bushing, own: Own<'_, F>) -> Option<()> {
        let [i, j] = bushing.ends().map(|frame| &self.moving[frame.body]);
        let [x, y, z] = bushing.moment.each_ref().map(|number| self.strength_of(number, own));
        let by_frame = Vector([x?, y?, z?]);
        let in_body = match &bushing.first.orientation {
            Some(own) => self.scope.rotation(&self.scope.unit(own)?).apply(&by_frame),
            None => by_frame,
        };
        let torque = i.pose.a.apply(&in_body);
        let [on_first, on_second] = [(i, -torque.clone()), (j, torque)]
            .map(|(body, torque)| Load::torque(body, &self.scope, &torque));
        forces.power = &forces.power + on_first.power(i) + on_second.power(j);
        let [first, second] = bushing.ends().map(|frame| frame.body);
        forces.push(first, &on_first);
        forces.push(second, &on_second);
        Some(())
    }

    /// The readings, and the force along each.
    pub(super) fn told_of_bushing(&self, force: usize) -> Option<Vec<F>> {
        let ForceKind::Bushing(bushing) = &self.textbook.model.forces[force].kind else { return None };
        let [places, rates] = self.seen_between(bushing)?;
        let along = self.along_readings(bushing, &places, &rates)?;
        let together = along.iter().map(|((pull, _), working)| pull + working);
        Some(places.iter().cloned().chain(together).map(|number| number.value).collect())
    }

    /// Of each reading the pull of its spring with the reading, and what else acts along it.
    fn along_readings(&self, bushing: &Bushing, places: &Six<F>, rates: &Six<F>) -> Option<Vec<Along<F>>> {
        let own = Own::Frames([places, rates]);
        let one = |(k, [stiffness, damping, load]): (usize, [&gyro_model::Number; 3])| {
            let pull = -(self.scope.number(stiffness) * &places[k]);
            let drag = self.strength_of(damping, own)? * &rates[k];
            Some(((pull, places[k].clone()), self.strength_of(load, own)? - drag))
        };
        bushing.strengths().into_iter().enumerate().map(one).collect()
    }

    /// The readings and their rates.
    pub(super) fn seen_between(&self, bushing: &Bushing) -> Option<[Six<F>; 2]> {
        let poses = bushing.ends().map(|frame| {
            let moving = &self.moving[frame.body];
            self.moved(&moving.pose, &moving.s, &moving.w)
        });
        let readings = self.readings_between(bushing, &poses)?;
        let zero = &self.scope.zero.value;
        let rates = readings.each_ref().map(|reading| reading.derivative(zero).frozen());
        Some([readings.map(|reading| reading.frozen()), rates])
    }

    /// What forces along the readings do to one of the bodies: along each of its unit velocities, s and then w', the
    /// sum of the forces, each times the rate of its reading.
    fn load_of_bushing(&self, bushing: &Bushing, end: usize, along: &[Jet<F>]) -> Option<Load<F>> {
        let ends = bushing.ends().map(|frame| self.moving[frame.body].pose.clone());
        let none = self.scope.no_vector();
        let zero = &self.scope.zero.value;
        let power = |k: usize| {
            let mut unit = none.clone();
            unit.0[k % 3] = self.scope.one.clone();
            let (s, w) = if k < 3 { (&unit, &none) } else { (&none, &unit) };
            let mut poses = ends.clone();
            poses[end] = self.moved(&ends[end], s, w);
            let readings = self.readings_between(bushing, &poses)?;
            let parts =
                readings.iter().zip(along).map(|(reading, force)| force * reading.derivative(zero).frozen());
            Some(parts.fold(self.scope.zero.clone(), |sum, part| sum + part))
        };
        let powers = (0..6).map(power).collect::<Option<Vec<_>>>()?;
        let part = |from: usize| Vector(from_fn(|k| powers[from + k].clone()));
        Some(Load { force: part(0), torque: part(3) })
    }

    /// A pose on its way.
    pub(super) fn moved(&self, pose: &Pose<F>, s: &Vector<F>, w: &Vector<F>) -> Pose<F> {
        let r = from_fn(|k| Jet {
            second: s.0[k].rate.clone(),
            ..Jet::moving(pose.r.0[k].value.clone(), s.0[k].value.clone())
        });
        let p = self.turning(&pose.p, w);
        Pose { r: Vector(r), a: self.scope.rotation(&p), p }
    }

    /// x, y, z and the Cardan angles; `None` where these are not defined. What has nothing about them is not asked.
    fn readings_between(&self, bushing: &Bushing, poses: &[Pose<F>; 2]) -> Option<Six<F>> {
        let [x, y, z] = self.place_between(bushing.ends(), poses.each_ref())?.0;
        if !self.has_angles(bushing) {
            let [a, b, c] = from_fn(|_| self.scope.zero.clone());
            return Some([x, y, z, a, b, c]);
        }
        let [x_of_x, x_of_y, x_of_z, y_of_z, z_of_z] = self.turned(bushing, poses)?;
        let cosine = self.scope.sqrt(&(&y_of_z * &y_of_z + &z_of_z * &z_of_z))?;
        // tan(a/2) = sin a / (1 + cos a), but at half a turn.
        let twice = |sine: Jet<F>, with: &Jet<F>| {
            let half = self.scope.atan2(&(sine * (&cosine + with).reciprocal()?), &self.scope.one)?;
            Some(&half + &half)
        };
        let about_y = self.scope.atan2(&x_of_z, &cosine)?;
        Some([x, y, z, twice(-y_of_z, &z_of_z)?, about_y, twice(-x_of_y, &x_of_x)?])
    }

    fn has_angles(&self, bushing: &Bushing) -> bool {
        let model = self.textbook.model;
        let is_told = |output: &Output| match output.kind {
            OutputKind::Bushing { force } => {
                matches!(&model.forces[force].kind, ForceKind::Bushing(other) if std::ptr::eq(&raw const **other, bushing))
            }
            _ => false,
        };
        bushing.has_angles() || model.outputs.iter().any(is_told)
    }

    /// Entries of the matrix of the second frame's axes, by those of the first: xx, xy, xz, yz, zz.
    fn turned(&self, bushing: &Bushing, poses: &[Pose<F>; 2]) -> Option<[Jet<F>; 5]> {
        let [[xx, xy, xz], [_, _, yz], [_, _, zz]] = self.matrix_between(bushing.ends(), poses.each_ref())?.0;
        Some([xx, xy, xz, yz, zz])
    }
}

/// The pull of a spring with its reading, and what else acts.
type Along<F> = ((Jet<F>, Jet<F>), Jet<F>);

/// A divisor that is smaller may be zero but for rounding.
const NEAR: f64 = 1e-9;

impl Evaluation<'_, f64> {
    /// Whether formulas or outputs may see the readings of a force.
    pub(super) fn is_seen(&self, index: usize) -> bool {
        let model = self.textbook.model;
        let is_it = |output: &Output| matches!(output.kind, OutputKind::Bushing { force } if force == index);
        let numbers = model.forces[index].kind.parts().numbers;
        let has_formula = numbers.iter().any(|(_, of)| of.iter().any(|number| number.formula().is_some()));
        has_formula || model.outputs.iter().any(is_it)
    }

    /// Whether the Cardan angles are defined, and not for rounding alone.
    pub(super) fn is_clear(&self, bushing: &Bushing) -> bool {
        if !self.has_angles(bushing) {
            return true;
        }
        let poses = bushing.ends().map(|frame| self.moving[frame.body].pose.clone());
        self.turned(bushing, &poses).is_some_and(|turned| {
            let [x_of_x, _, _, y_of_z, z_of_z] = turned.map(|entry| entry.value);
            let cosine = y_of_z.hypot(z_of_z);
            cosine.min(cosine + z_of_z).min(cosine + x_of_x) > NEAR
        })
    }
}
