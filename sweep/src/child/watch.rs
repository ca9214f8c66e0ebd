//! What is kept, read off a state with its derivatives.

use super::variational::{Number, Parts};
use crate::Quantity;
use crate::slopes::Sloped;
use gyro_sim::{Coordinate, Dual, Energy, JointCoordinate, JointSpace, Mechanism, Scalar, Turns};

/// Reads the quantities of states that follow each other.
pub(super) struct Watch<'m, M: JointSpace, D: JointSpace> {
    mechanism: &'m M,
    parts: Parts<D>,
    /// Continuous angles.
    turns: Turns<M>,
    read_at: f64,
    x: M::Joints,
    y: M::State,
    observed: &'m [usize],
    /// How many directions there are.
    directions: usize,
}

impl<'m, M: JointSpace<Scalar = f64>, D: JointSpace<Scalar = Number>> Watch<'m, M, D> {
    /// From a start, of which the angles are nearest to given ones.
    pub(super) fn new(
        mechanism: &'m M,
        parts: &Parts<D>,
        (state, angles): (&[f64], &[f64]),
        (observed, directions): (&'m [usize], usize),
    ) -> Self {
        let (mut x, mut y) = (mechanism.joint_start(), mechanism.start());
        x.as_mut().iter_mut().zip(state).for_each(|(to, from)| *to = *from);
        mechanism.to_maximal(0.0, &x, &mut y);
        let turns = Turns::new(mechanism, 0.0, &y, angles);
        Self { mechanism, parts: parts.clone(), turns, read_at: 0.0, x, y, observed, directions }
    }

    /// Follows the turns of angles; to be called every step.
    pub(super) fn read(&mut self, t: f64, state: &[f64]) {
        self.x.as_mut().iter_mut().zip(state).for_each(|(to, from)| *to = *from);
        self.mechanism.to_maximal(t, &self.x, &mut self.y);
        self.turns.update(self.mechanism, t, t - self.read_at, &self.y);
        self.read_at = t;
    }

    /// The quantities of a state.
    pub(super) fn columns(&mut self, t: f64, state: &[f64], columns: &[Quantity]) -> Vec<Sloped> {
        self.read(t, state);
        let mut found = vec![Sloped::default(); columns.len()];
        for (k, part) in self.parts.iter().enumerate() {
            let (mechanism, x) = (&part.mechanism, part.joints(k, state));
            let seen = Seen::new(mechanism, t, &x, self.observed);
            for (found, column) in found.iter_mut().zip(columns) {
                let number = seen.quantity(*column);
                found.slopes.extend(number.slopes);
                found.value = match *column {
                    Quantity::Position(index) => self.angle(index).unwrap_or(number.value),
                    _ => number.value,
                };
            }
        }
        found.iter_mut().for_each(|number| number.slopes.truncate(self.directions));
        found
    }

    /// A continuous angle, by its index among the coordinates of all joints.
    fn angle(&self, index: usize) -> Option<f64> {
        let joints = self.mechanism.description().joints.iter().enumerate();
        let mut all = joints.flat_map(|(joint, one)| (0..one.coordinates.len()).map(move |own| (joint, own)));
        let (joint, own) = all.nth(index)?;
        match self.turns.coordinate(self.mechanism, joint, own)? {
            JointCoordinate::Angle { position, .. } => Some(position),
            _ => None,
        }
    }
}

/// A state in dual numbers.
struct Seen<'m, D: Mechanism> {
    mechanism: &'m D,
    observed: &'m [usize],
    y: D::State,
    readings: D::Readings,
    outputs: D::Outputs,
    energy: Energy<D::Scalar>,
}

impl<'m, D: JointSpace<Scalar = Number>> Seen<'m, D> {
    fn new(mechanism: &'m D, t: f64, x: &D::Joints, observed: &'m [usize]) -> Self {
        let (t, mut y, buffers) = (Dual::new(t), mechanism.start(), mechanism.buffers());
        mechanism.to_maximal(t, x, &mut y);
        let (mut readings, mut outputs) = (buffers.readings, buffers.outputs);
        mechanism.read_joints(t, &y, &mut readings);
        mechanism.outputs(t, &y, &mut outputs);
        let energy = mechanism.energy(t, &y);
        Self { mechanism, observed, y, readings, outputs, energy }
    }

    fn quantity(&self, quantity: Quantity) -> Number {
        match quantity {
            Quantity::Position(index) => match self.reading(index) {
                // Sine and cosine, times a factor that both have.
                (Coordinate::Angle, [sine, cosine, ..]) => sine.atan2(*cosine),
                (_, readings) => readings[0],
            },
            Quantity::Rate(index) => match self.reading(index) {
                (Coordinate::Angle, readings) => readings[2],
                (_, readings) => readings[1],
            },
            Quantity::Orientation(index, k) => self.reading(index).1[k],
            Quantity::OrientationRate(index, k) => self.reading(index).1[4 + k],
            Quantity::Output(k) => self.outputs.as_ref()[k],
            Quantity::Pose(body, k) => self.y.as_ref()[7 * self.observed[body] + k],
            Quantity::Velocity(body, k) => {
                let velocities = 7 * self.mechanism.description().bodies.len();
                self.y.as_ref()[velocities + 6 * self.observed[body] + k]
            }
            Quantity::Kinetic => self.energy.kinetic,
            Quantity::Potential => self.energy.potential,
            Quantity::Energy => self.energy.total(),
            Quantity::Work => self.mechanism.work(&self.y),
            // No study asks for its derivatives.
            Quantity::Violation => Dual::new(f64::NAN),
        }
    }

    /// The readings of a coordinate and those after it.
    fn reading(&self, index: usize) -> (Coordinate, &[Number]) {
        let joints = self.mechanism.description().joints;
        let mut at = 0;
        let all = joints.iter().flat_map(|joint| joint.coordinates);
        for (k, coordinate) in all.enumerate() {
            if k == index {
                return (*coordinate, &self.readings.as_ref()[at..]);
            }
            at += coordinate.n_readings();
        }
        unreachable!("coordinates are counted as the model counts them")
    }
}
