//! Continuous joint coordinates: a right-hand side sees an angle only up to whole turns, so the turns are counted here.

use crate::{Coordinate, Mechanism, Real, Scalar};

/// One joint's coordinate and rate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum JointCoordinate<T> {
    /// Continuous angle, rad, positive by the right-hand rule from the first body to the second, and its rate.
    Angle {
        /// Angle, rad.
        position: T,
        /// Rate, rad/s.
        rate: T,
    },
    /// Relative orientation, and the relative angular velocity in the second body's frame.
    Orientation {
        /// Euler parameters.
        position: [T; 4],
        /// Angular velocity, rad/s.
        rate: [T; 3],
    },
    /// A joint that does not move.
    None,
}

/// The turn reference of each angle: the coordinate when it was last read. Held beside the state by the caller, in a
/// buffer of the readings' own type.
///
/// An angle is continued from the last reading by the mean of the two rates, so it may turn many times between readings as
/// long as that mean predicts it to within half a turn.
#[derive(Clone, Debug)]
pub struct Turns<M: Mechanism> {
    readings: M::Readings,
    /// For each angle joint, at the place of its raw sine: the continuous angle; at its raw rate: the rate.
    last: M::Readings,
}

impl<M: Mechanism<Scalar: Real>> Turns<M> {
    /// Takes the angles of a state to lie nearest to the given ones; joints that `nearest` does not cover to zero.
    pub fn new(mechanism: &M, y: &M::State, nearest: &[M::Scalar]) -> Self {
        let mut turns = Self { readings: mechanism.readings(), last: mechanism.readings() };
        mechanism.read_joints(y, &mut turns.readings);
        let zero = M::Scalar::constant(0.0);
        for_each_angle(mechanism, |joint, at| {
            turns.continue_angle(at, nearest.get(joint).copied().unwrap_or(zero));
        });
        turns
    }

    /// Reads the state `dt` seconds after the last reading.
    pub fn update(&mut self, mechanism: &M, dt: M::Scalar, y: &M::State) {
        mechanism.read_joints(y, &mut self.readings);
        for_each_angle(mechanism, |_, at| {
            let (last, readings) = (self.last.as_ref(), self.readings.as_ref());
            let mean_rate = (last[at + 2] + readings[at + 2]) * M::Scalar::constant(0.5);
            self.continue_angle(at, last[at] + mean_rate * dt);
        });
    }

    /// The coordinate of a joint at the last reading; [`JointCoordinate::None`] also for a joint that does not exist.
    pub fn joint(&self, mechanism: &M, joint: usize) -> JointCoordinate<M::Scalar> {
        let at =
            (0..joint.min(mechanism.n_joints())).map(|j| mechanism.joint(j).coordinate.n_readings()).sum();
        match mechanism_coordinate(mechanism, joint) {
            Coordinate::Angle => {
                let last = self.last.as_ref();
                JointCoordinate::Angle { position: last[at], rate: last[at + 2] }
            }
            Coordinate::Orientation => {
                let values = &self.readings.as_ref()[at..at + 7];
                JointCoordinate::Orientation {
                    position: core::array::from_fn(|k| values[k]),
                    rate: core::array::from_fn(|k| values[4 + k]),
                }
            }
            Coordinate::None => JointCoordinate::None,
        }
    }

    fn continue_angle(&mut self, at: usize, predicted: M::Scalar) {
        let readings = self.readings.as_ref();
        let principal = readings[at].atan2(readings[at + 1]);
        let turn = M::Scalar::constant(core::f64::consts::TAU);
        let angle = principal + ((predicted - principal) / turn).round() * turn;
        let rate = readings[at + 2];
        let last = self.last.as_mut();
        (last[at], last[at + 2]) = (angle, rate);
    }
}

fn mechanism_coordinate<M: Mechanism>(mechanism: &M, joint: usize) -> Coordinate {
    if joint < mechanism.n_joints() { mechanism.joint(joint).coordinate } else { Coordinate::None }
}

/// Calls `f` with the joint and the place of its readings for each joint that has an angle.
fn for_each_angle<M: Mechanism>(mechanism: &M, mut f: impl FnMut(usize, usize)) {
    let mut at = 0;
    for joint in 0..mechanism.n_joints() {
        let coordinate = mechanism.joint(joint).coordinate;
        if coordinate == Coordinate::Angle {
            f(joint, at);
        }
        at += coordinate.n_readings();
    }
}
