//! What is read off a state, and the outputs of the model file.

use super::Evaluation;
use super::attitude::{compose, conjugate};
use super::jet::Jet;
use super::linear::Vector;
use super::pose::Path;
use crate::field::Field;
use gyro_model::{BodyFrame, JointCoordinate, JointKind, OutputKind, RowOwner};

/// The reading of one coordinate of a joint.
#[derive(Clone, Debug, PartialEq)]
pub enum Reading<F> {
    /// Sine and cosine of an angle, which may be read up to one positive factor, and its rate.
    Angle {
        /// Sine.
        sine: F,
        /// Cosine.
        cosine: F,
        /// Rate.
        rate: F,
    },
    /// A length and its rate.
    Length([F; 2]),
    /// Euler parameters of the second body's frame in the first's, and the angular velocity of the second body relative
    /// to the first in the second's frame.
    Orientation([F; 7]),
}

impl<F: Field> Evaluation<'_, F> {
    /// The readings of all joints, coordinate after coordinate.
    pub fn readings(&self) -> Option<Vec<Reading<F>>> {
        let mut readings = Vec::new();
        for (joint, frames) in self.joints.iter().enumerate() {
            if frames.kind == JointKind::Spherical {
                readings.push(self.orientation(joint));
            }
            for coordinate in 0..frames.kind.coordinates().len() {
                readings.push(self.reading(JointCoordinate { joint, coordinate })?);
            }
        }
        Some(readings)
    }

    /// The reading of one coordinate.
    pub fn reading(&self, on: JointCoordinate) -> Option<Reading<F>> {
        let (kind, rate) = (self.textbook.model.coordinate_kind(on), self.coordinate_rate(on).value);
        if kind.is_angle() {
            let (sine, cosine) = self.joints[on.joint].placed(&self.still).sine_and_cosine(kind);
            return Some(Reading::Angle { sine: sine.value, cosine: cosine.value, rate });
        }
        Some(Reading::Length([self.coordinate(on, &self.still)?.value, rate]))
    }

    /// How a joint's second body is turned relative to its first.
    pub fn orientation(&self, joint: usize) -> Reading<F> {
        let frames = &self.joints[joint];
        let (i, j) = (&self.moving[frames.first.body], &self.moving[frames.second.body]);
        let [e0, e1, e2, e3] = compose(&conjugate(&i.pose.p), &j.pose.p);
        let [x, y, z] = j.pose.a.transposed().apply(&(j.omega() - i.omega())).0;
        Reading::Orientation([e0, e1, e2, e3, x, y, z].map(|x| x.value))
    }

    /// `ṙ = s` and `ṗ = ½ Gᵀ w'` body after body, eqs. (14) and (16).
    pub fn position_rates(&self) -> Vec<F> {
        let poses = self.poses(Path::Motion);
        let rate = |x: &Jet<F>| x.rate.clone().unwrap_or_else(|| self.scope.zero.value.clone());
        let moving = self.textbook.moving_bodies.iter().map(|&body| &poses[body]);
        moving.flat_map(|pose| pose.r.0.iter().chain(&pose.p).map(rate).collect::<Vec<F>>()).collect()
    }

    /// The rates of the states, then of the turn references: of what stands behind the work.
    pub fn other_rates(&self) -> Option<Vec<F>> {
        let states = self.textbook.model.states.iter();
        let rates = states.map(|state| Some(self.strength(&state.rate)?.value)).collect::<Option<Vec<_>>>();
        let turns = self.textbook.turns.iter().map(|&turn| self.coordinate_rate(turn).value);
        rates.map(|rates| rates.into_iter().chain(turns).collect())
    }

    /// The numbers of all outputs, at accelerations `(s̈, ẇ')` of the bodies with coordinates and multipliers of all
    /// rows.
    pub fn outputs(&self, accelerations: &[F], lambda: &[F]) -> Option<Vec<F>> {
        let outputs = self.textbook.model.outputs.iter();
        let numbers = outputs.map(|output| self.output(&output.kind, accelerations, lambda));
        numbers.collect::<Option<Vec<_>>>().map(|numbers| numbers.concat())
    }

    /// The numbers of one output.
    pub fn output(&self, kind: &OutputKind, accelerations: &[F], lambda: &[F]) -> Option<Vec<F>> {
        let values = |linear: Vector<F>, rest: &[Jet<F>]| {
            linear.0.iter().chain(rest).map(|x| x.value.clone()).collect::<Vec<F>>()
        };
        Some(match kind {
            OutputKind::Pose(frame) => {
                let pose = &self.moving[frame.body].pose;
                let p = match &frame.orientation {
                    Some(own) => compose(&pose.p, &self.scope.unit(own)?),
                    None => pose.p.clone(),
                };
                values(pose.point(&self.scope.vector(&frame.point)), &p)
            }
            OutputKind::Velocity(frame) => {
                let moving = &self.moving[frame.body];
                let w = self.by_axes(frame, &moving.w)?;
                values(moving.velocity(&self.scope.vector(&frame.point)), &w.0)
            }
            OutputKind::Acceleration(frame) => {
                let [linear, angular] = self.acceleration_of_point(frame, accelerations);
                values(linear, &self.by_axes(frame, &angular)?.0)
            }
            OutputKind::Inertial(frame) => {
                let [linear, _] = self.acceleration_of_point(frame, accelerations);
                let moving = &self.moving[frame.body];
                let gravity = self.gravity_at(&moving.pose.point(&self.scope.vector(&frame.point)))?;
                let felt = moving.pose.a.transposed().apply(&(linear - gravity));
                values(self.by_axes(frame, &felt)?, &self.by_axes(frame, &moving.w)?.0)
            }
            OutputKind::Relative(relative) => self.relative_now(relative.frames.each_ref())?,
            OutputKind::Reaction { joint } => {
                let [force, torque] = self.reaction(*joint, lambda)?;
                values(force, &torque.0)
            }
            OutputKind::Bushing { force } => self.told_of_bushing(*force)?,
            OutputKind::Formula(formula) => {
                vec![self.formula_output(&formula.text, accelerations, lambda)?]
            }
            OutputKind::Rate(formula) => vec![self.formula_rate(&formula.text, accelerations)?],
            OutputKind::State { state } => {
                vec![self.scope.point.own_state(self.textbook.model, *state).clone()]
            }
            OutputKind::Driver { driver } => vec![self.load(RowOwner::Driver(*driver), lambda)],
            OutputKind::Coupler { coupler } => vec![self.load(RowOwner::Coupler(*coupler), lambda)],
            OutputKind::Spring { force } | OutputKind::Link { force } => self.elastic(*force)?,
            OutputKind::Energy => self.energy()?.to_vec(),
            OutputKind::Power => self.power(lambda, accelerations)?.to_vec(),
        })
    }

    /// A vector in a body's frame, by the axes of a frame in it.
    pub(super) fn by_axes(&self, frame: &BodyFrame, vector: &Vector<F>) -> Option<Vector<F>> {
        let Some(own) = &frame.orientation else { return Some(vector.clone()) };
        Some(self.scope.rotation(&self.scope.unit(own)?).transposed().apply(vector))
    }

    /// `s̈ + A (ẇ' × s' + w' × (w' × s'))` in the global frame, and ẇ'.
    fn acceleration_of_point(&self, frame: &BodyFrame, given: &[F]) -> [Vector<F>; 2] {
        let (moving, point) = (&self.moving[frame.body], self.scope.vector(&frame.point));
        let acceleration = self.acceleration(frame.body, given);
        let relative = acceleration.w.cross(&point) + moving.w.cross(&moving.w.cross(&point));
        [acceleration.s + moving.pose.a.apply(&relative), acceleration.w]
    }

    /// `−Φ_rᵀλ` and `−A Φ_π'ᵀλ` of a joint's rows on its second body, about its joint point there, in the first body's
    /// joint frame; where the second has no coordinates, the opposite of what the rows do to the first.
    fn reaction(&self, joint: usize, lambda: &[F]) -> Option<[Vector<F>; 2]> {
        let frames = &self.joints[joint];
        let (i, j) = (frames.first.body, frames.second.body);
        let (force, torque, body) = match (self.textbook.moving_body_of(i), self.textbook.moving_body_of(j)) {
            (_, Some(moving_body)) => {
                let [force, torque] = self.taken(joint, moving_body, lambda)?;
                (-force, -torque, j)
            }
            (Some(moving_body), None) => {
                let [force, torque] = self.taken(joint, moving_body, lambda)?;
                (force, torque, i)
            }
            (None, None) => (self.scope.no_vector(), self.scope.no_vector(), j),
        };
        let place = self.moving[j].pose.point(&frames.second.point);
        let arm = self.moving[body].pose.r.clone() - place;
        let torque = self.moving[body].pose.a.apply(&torque) + arm.cross(&force);
        let placed = frames.placed(&self.still);
        let in_frame = |v: Vector<F>| Vector([&placed.f_i, &placed.g_i, &placed.h_i].map(|u| u.dot(&v)));
        Some([in_frame(force), in_frame(torque)])
    }

    /// `Φ_rᵀλ` and `Φ_π'ᵀλ` of a joint's rows for one moving_body.
    fn taken(&self, joint: usize, moving_body: usize, lambda: &[F]) -> Option<[Vector<F>; 2]> {
        let phi_pi = self.phi_pi()?;
        let rows = self.textbook.model.rows_of(RowOwner::Joint(joint));
        let column = |k: usize| {
            rows.clone().fold(self.scope.zero.clone(), |sum, row| {
                let entry = phi_pi.rows[row].get(&(6 * moving_body + k));
                entry.map_or(sum.clone(), |entry| sum + Jet::constant(entry.mul(&lambda[row])))
            })
        };
        Some([0, 3].map(|from| Vector(std::array::from_fn(|k| column(from + k)))))
    }

    /// `−λ` of a driver's row; zero where the row is redundant.
    fn load(&self, owner: RowOwner, lambda: &[F]) -> F {
        let rows = self.textbook.model.rows_of(owner);
        rows.fold(self.scope.zero.value.clone(), |sum, row| sum.sub(&lambda[row]))
    }
}
