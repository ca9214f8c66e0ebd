//! Where states start: at given values, or where their rates are zero.

use super::{AssemblyError, Start};
use crate::kinematics::exact;
use crate::scalar::Scalar;
use crate::sight::Sight;
use crate::{
    BodyFrame, ForceKind, Model, Number, OutputKind, Prescribed, Quaternion, Seen, StateStart, Vector,
};
use nalgebra::{DMatrix, DVector};
use num_dual::Dual64;

/// Steps of Newton's method, and how small the last one must be, relative to the values.
const MOST_STEPS: usize = 60;
const SMALL: f64 = 1e-14;

/// The values of all states, the mechanism starting as `start` says.
pub(super) fn at(model: &Model, start: &Start) -> Result<Vec<f64>, AssemblyError> {
    let given = model.states.iter().map(|state| match &state.start {
        StateStart::At(number) => model.value(number),
        StateStart::AtRest => 0.0,
    });
    let mut values: Vec<f64> = given.collect();
    let resting: Vec<usize> =
        (0..values.len()).filter(|&state| matches!(model.states[state].start, StateStart::AtRest)).collect();
    if resting.is_empty() {
        return Ok(values);
    }
    let still = Still { model, start };
    let residual = |values: &[f64]| {
        DVector::from_iterator(resting.len(), resting.iter().map(|&state| still.rate(state, values)))
    };
    let mut rates = residual(&values);
    for _ in 0..MOST_STEPS {
        let column = |by: usize| {
            let seeded = values.iter().enumerate().map(|(state, &value)| Dual64 {
                eps: if state == by { 1.0 } else { 0.0 },
                ..Dual64::from_re(value)
            });
            let seeded: Vec<_> = seeded.collect();
            DVector::from_iterator(resting.len(), resting.iter().map(|&state| still.rate(state, &seeded).eps))
        };
        let columns: Vec<_> = resting.iter().map(|&by| column(by)).collect();
        let Some(change) = DMatrix::from_columns(&columns).lu().solve(&rates) else { break };
        let moved = |part: f64| {
            let mut moved = values.clone();
            resting.iter().zip(&change).for_each(|(&state, by)| moved[state] -= part * by);
            moved
        };
        // A step that makes the rates larger is halved: what is curved is approached all the same.
        let mut part = 1.0;
        let mut next = moved(part);
        let is_worse = |next: &[f64]| {
            let size = residual(next).norm();
            size.is_nan() || size > rates.norm()
        };
        while part > SMALL && is_worse(&next) {
            part *= 0.5;
            next = moved(part);
        }
        let is_small = |state: &usize| (next[*state] - values[*state]).abs() <= SMALL * next[*state].abs();
        let is_done = part == 1.0 && resting.iter().all(is_small) || residual(&next).norm() == 0.0;
        (rates, values) = (residual(&next), next);
        if is_done {
            return Ok(values);
        }
    }
    // What is left may be rounding of large terms.
    let worst = rates.iter().map(|rate| rate.abs()).enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
    let (place, rate) = worst.expect("some states rest");
    let size = still.size(resting[place], &values);
    if rate <= 1e-12 * size {
        return Ok(values);
    }
    let state = resting[place];
    Err(AssemblyError::Restless { state, name: model.states[state].name.clone(), rate })
}

/// A mechanism as it starts.
struct Still<'a> {
    model: &'a Model,
    start: &'a Start,
}

impl Still<'_> {
    /// The rate of a state.
    fn rate<D: Scalar>(&self, state: usize, states: &[D]) -> D {
        match &self.model.states[state].rate {
            Number::Formula(formula) => Sight::new(self.model, formula).of(|seen| self.see(seen, states)),
            number => D::from(self.model.value(number)),
        }
    }

    /// How large the terms of its rate are: by how much it changes as each state is doubled.
    fn size(&self, state: usize, states: &[f64]) -> f64 {
        let now = self.rate(state, states);
        let changed = |by: usize| {
            let mut changed = states.to_vec();
            changed[by] *= 2.0;
            (self.rate(state, &changed) - now).abs()
        };
        (0..states.len()).map(changed).fold(0.0, f64::max)
    }

    fn see<D: Scalar>(&self, seen: Seen, states: &[D]) -> D {
        let joints = &self.start.joints;
        match seen {
            Seen::Coordinate(on) => D::from(joints[on.joint].position[on.coordinate]),
            Seen::Rate(on) => D::from(joints[on.joint].rate[on.coordinate]),
            Seen::Output { output, number } => match self.model.outputs[output].kind {
                OutputKind::State { state } => states[state],
                ref kind => D::from(self.number(kind, number)),
            },
            // The others are seen in links and bushings only, and nothing has happened yet.
            Seen::Time | Seen::Length | Seen::LengthRate | Seen::Between(_) | Seen::BetweenRate(_) => {
                D::zero()
            }
        }
    }

    /// A number of an output of position or velocity.
    fn number(&self, kind: &OutputKind, number: usize) -> f64 {
        match kind {
            OutputKind::Pose(frame) if number < 3 => self.tip(frame.body, &frame.point)[number],
            OutputKind::Pose(frame) => (self.body(frame.body).p * self.turn(frame)).0[number - 3],
            OutputKind::Velocity(frame) if number < 3 => self.tip_velocity(frame.body, &frame.point)[number],
            OutputKind::Velocity(frame) | OutputKind::Inertial(frame) => {
                self.turn(frame).rotate_back(self.body(frame.body).w)[number - 3]
            }
            OutputKind::Relative(relative) => self.relative(&relative.frames, number),
            OutputKind::Link { force } => match &self.model.forces[*force].kind {
                ForceKind::Link { first, second, .. } => {
                    let line = self.tip(second.0, &second.1) - self.tip(first.0, &first.1);
                    let drift = self.tip_velocity(second.0, &second.1) - self.tip_velocity(first.0, &first.1);
                    if number == 1 { line.norm() } else { line.dot(&drift) / line.norm() }
                }
                _ => f64::NAN,
            },
            OutputKind::Bushing { force } => match &self.model.forces[*force].kind {
                ForceKind::Bushing(bushing) => self.between([&bushing.first, &bushing.second])[number],
                _ => f64::NAN,
            },
            // The reader refuses what is known only once all forces are.
            _ => f64::NAN,
        }
    }

    /// Where the second of two frames is seen from the first, and its Cardan angles there.
    fn between(&self, frames: [&BodyFrame; 2]) -> [f64; 6] {
        let [p, q] = frames.map(|frame| self.body(frame.body).p * self.turn(frame));
        let [from, to] = frames.map(|frame| self.tip(frame.body, &frame.point));
        let d = p.rotate_back(to - from);
        let a = (p.conjugate() * q).matrix();
        let [about_x, about_z] = [(-a[1][2]).atan2(a[2][2]), (-a[0][1]).atan2(a[0][0])];
        [d[0], d[1], d[2], about_x, a[0][2].clamp(-1.0, 1.0).asin(), about_z]
    }

    /// A number of [`crate::Relative`].
    fn relative(&self, frames: &[BodyFrame; 2], number: usize) -> f64 {
        let [i, j] = frames.each_ref().map(|frame| self.body(frame.body));
        let [p, q] = frames.each_ref().map(|frame| self.body(frame.body).p * self.turn(frame));
        let [from, to] = frames.each_ref().map(|frame| self.tip(frame.body, &frame.point));
        let [before, after] = frames.each_ref().map(|frame| self.tip_velocity(frame.body, &frame.point));
        let (carrier, line) = (i.p.rotate(i.w), to - from);
        match number {
            0..3 => p.rotate_back(line)[number],
            3..12 => (p.conjugate() * q).matrix()[number / 3 - 1][number % 3],
            12..15 => p.rotate_back(after - before - carrier.cross(&line))[number - 12],
            _ => p.rotate_back(j.p.rotate(j.w) - carrier)[number - 15],
        }
    }

    fn turn(&self, frame: &BodyFrame) -> Quaternion {
        let own = frame.orientation.as_ref().and_then(|own| Quaternion::unit(&exact(self.model, own)));
        own.unwrap_or(Quaternion::IDENTITY)
    }

    fn tip(&self, body: usize, point: &[Number; 3]) -> Vector {
        let Prescribed { r, p, .. } = self.body(body);
        r + p.rotate(Vector::from(self.model.values(point)))
    }

    fn tip_velocity(&self, body: usize, point: &[Number; 3]) -> Vector {
        let Prescribed { p, s, w, .. } = self.body(body);
        s + p.rotate(w.cross(&Vector::from(self.model.values(point))))
    }

    fn body(&self, body: usize) -> Prescribed {
        let (model, start) = (self.model, self.start);
        let own = &model.bodies[body];
        if let Some(motion) = &own.motion {
            return motion.state(model, own, 0.0);
        }
        let none = Vector::zeros();
        let moving = model.coordinate_bodies().iter().position(|&moving| moving == body);
        let Some(place) = moving else {
            let r = Vector::from(model.values(&own.position));
            return Prescribed { r, p: own.unit_orientation(model), s: none, w: none, ds: none, dw: none };
        };
        let (q, v) = (&start.q[7 * place..7 * place + 7], &start.v[6 * place..6 * place + 6]);
        Prescribed {
            r: Vector::new(q[0], q[1], q[2]),
            p: Quaternion([q[3], q[4], q[5], q[6]]),
            s: Vector::new(v[0], v[1], v[2]),
            w: Vector::new(v[3], v[4], v[5]),
            ds: none,
            dw: none,
        }
    }
}
