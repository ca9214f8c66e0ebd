//! The numbers of a model file's outputs at a moment.

use crate::model::amount::{Amount, Now};
use crate::model::lowered::Lowered;
use crate::model::measure::Term;
use crate::model::motion::{Motion, along_pi};
use crate::model::outputs::{Quantity, Solution};
use crate::model::place::{Moment, Place};
use crate::model::rows::Row;
use crate::number::Number;
use nalgebra::Vector3;

impl<T: Number> Lowered<T> {
    /// Number of numbers of all outputs.
    pub(crate) fn n_outputs(&self) -> usize {
        self.outputs.iter().map(|output| output.columns.len()).sum()
    }

    /// Writes all outputs.
    pub(crate) fn outputs(&self, at: Moment<'_, T>, solution: Solution<'_, T>, out: &mut [T]) {
        let mut rest = &mut *out;
        for output in &self.outputs {
            let (out, after) = rest.split_at_mut(output.columns.len());
            self.output(at, solution, &output.quantity, out);
            rest = after;
        }
        // Formulas may see all others.
        let mut place = 0;
        for output in &self.outputs {
            if let Quantity::Formula(formula) = &output.quantity {
                out[place] = formula.value(&Now { outputs: out, ..Now::new(&self.scene, at) });
            }
            place += output.columns.len();
        }
    }

    fn output(&self, at: Moment<'_, T>, solution: Solution<'_, T>, quantity: &Quantity<T>, out: &mut [T]) {
        match quantity {
            Quantity::Pose(spot) => {
                out.copy_from_slice(&spot.pose(&self.scene.motion(at, &spot.place)));
            }
            Quantity::Velocity(spot) => {
                out.copy_from_slice(&spot.velocity(&self.scene.motion(at, &spot.place)));
            }
            Quantity::Acceleration(spot) => {
                let motion = self.accelerated(at, &spot.place, solution.accelerations);
                write(out, &motion.point(&spot.point).second, spot.by_axes(motion.w_dot).as_slice());
            }
            Quantity::Inertial(spot) => {
                let motion = self.accelerated(at, &spot.place, solution.accelerations);
                let gravity = self.scene.gravity_at(&motion.tip(&spot.point));
                let specific_force = motion.point(&spot.point).second - gravity;
                let [felt, w] = [motion.a.tr_mul(&specific_force), motion.w].map(|v| spot.by_axes(v));
                write(out, &felt, w.as_slice());
            }
            Quantity::Relative(frames) => out.copy_from_slice(&frames.relative(&self.scene, at)),
            Quantity::Reaction(joint, rows) => {
                let [force, torque] = self.reaction(at, *joint, rows, solution.lambda);
                write(out, &force, torque.as_slice());
            }
            Quantity::Elastic(elastic) => {
                let places = elastic.path.places(&self.scene);
                let motions = places.map(|place| self.scene.motion(at, place));
                let (x, rate) =
                    (elastic.path.value(&self.scene, at), elastic.path.grip(&self.scene, &motions).rate);
                let now = Now { line: [x, rate], ..Now::new(&self.scene, at) };
                let value = |amount: &Amount<T>| amount.value(&now);
                let deflection = x - value(&elastic.free);
                let spring = -value(&elastic.stiffness) * deflection;
                out[0] = spring - value(&elastic.damping) * rate - value(&elastic.tension);
                out[1] = if elastic.is_link { x } else { deflection };
                if let Some(out) = out.get_mut(2) {
                    *out = rate;
                }
            }
            Quantity::Bushing(bushing) => out.copy_from_slice(bushing.told(&self.scene, at).as_flattened()),
            Quantity::Load(row) => out[0] = row.map_or(T::zero(), |row| -solution.lambda[row]),
            Quantity::State(place) => out[0] = at.y[*place],
            Quantity::Formula(_) => out[0] = T::zero(),
            Quantity::Rate(formula) => {
                let jet = |term: &Term<T>| {
                    let joint = self.scene.joint(term.joint);
                    let motions = [&joint.first.place, &joint.second.place]
                        .map(|place| self.accelerated(at, place, solution.accelerations));
                    term.measure.jet(joint, &motions, at.y)
                };
                out[0] = formula.jet(&formula.terms.iter().map(jet).collect::<Vec<_>>(), at.t)[1];
            }
            Quantity::Energy => {
                let energy = self.energy(at);
                (out[0], out[1]) = (energy.kinetic, energy.potential);
            }
            Quantity::Power => {
                let power = self.power(at, solution.lambda_nu, solution.accelerations);
                (out[0], out[1]) = (power.non_conservative, power.drivers);
            }
        }
    }

    /// The motion of a body with its acceleration, prescribed or not.
    fn accelerated(&self, at: Moment<'_, T>, place: &Place<T>, accelerations: &[T]) -> Motion<T> {
        let motion = self.scene.motion(at, place);
        let Some(moving_body) = place.moving_body() else { return motion };
        let of = |from: usize| {
            Vector3::from_column_slice(&accelerations[6 * moving_body + from..6 * moving_body + from + 3])
        };
        Motion { s_dot: of(0), w_dot: of(3), ..motion }
    }

    /// `−Φ_rᵀ λ` and `−Φ_π'ᵀ λ` of a joint's rows on its second body (without coordinates: what acts on the first,
    /// turned round), the torque about the second's joint point, both in the first body's joint frame.
    fn reaction(&self, at: Moment<'_, T>, joint: usize, rows: &[usize], lambda: &[T]) -> [Vector3<T>; 2] {
        let joint = &self.scene.joints[joint];
        let motions = self.scene.motions(at, joint);
        let (side, sign) =
            if joint.second.place.moving_body().is_some() { (1, -T::one()) } else { (0, T::one()) };
        let (mut force, mut torque) = (Vector3::zeros(), Vector3::zeros());
        for &row in rows {
            let Row::Measured { terms, .. } = &self.rows[row] else { continue };
            for term in terms {
                let pull = &term.measure.pulls(joint, &motions, along_pi)[side];
                force += pull.r.transpose() * (sign * term.factor * lambda[row]);
                torque += pull.turn.transpose() * (sign * term.factor * lambda[row]);
            }
        }
        let [i, j] = &motions;
        let arm = j.tip(&joint.second.point) - motions[side].r;
        let torque = motions[side].a * torque - arm.cross(&force);
        let (f, g, h) = (i.a * joint.first.f, i.a * joint.first.g, i.a * joint.first.h);
        [force, torque].map(|v| Vector3::new(f.dot(&v), g.dot(&v), h.dot(&v)))
    }
}

fn write<T: Number>(out: &mut [T], vector: &Vector3<T>, rest: &[T]) {
    out[..3].copy_from_slice(vector.as_slice());
    out[3..].copy_from_slice(rest);
}
