//! Continuous joint coordinates: a right-hand side sees an angle only up to whole turns, so the turns are counted here.

#[cfg(feature = "wire")]
use crate::wire::*;
use crate::{Coordinate, Mechanism, Real, Scalar};

/// Sets the turn references of a state to their angles, from which integration lets them stray: both are integrated,
/// each with errors of its own, and once they are half a turn apart a turn would be lost. No function of the state
/// changes by it but for rounding.
pub fn refer_turns<M: Mechanism>(mechanism: &M, t: M::Scalar, y: &mut M::State) {
    if !mechanism.description().turn_references.is_empty() {
        mechanism.refer_turns(t, y);
    }
}

/// Sets those turn references that have strayed from their angles by more than a quarter of a turn: for steps between
/// corrections. The others stay what integration has made of them, which is more accurate than the angles of poses, and
/// which the partition in joint coordinates goes by ([`joint_partition`](crate::joint_partition)).
pub fn keep_turns<M: Mechanism<Scalar: Real>>(mechanism: &M, t: M::Scalar, y: &mut M::State) {
    let n_references = mechanism.description().turn_references.len();
    if n_references == 0 {
        return;
    }
    let before = y.clone();
    refer_turns(mechanism, t, y);
    let quarter = M::Scalar::constant(core::f64::consts::FRAC_PI_2);
    let pairs = y.as_mut().iter_mut().rev().zip(before.as_ref().iter().rev()).take(n_references);
    for (angle, reference) in pairs {
        if (*angle - *reference).abs() < quarter {
            *angle = *reference;
        }
    }
}

/// One coordinate of a joint and its rate.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "wire", derive(SerBin, DeBin))]
pub enum JointCoordinate<T> {
    /// Continuous angle, rad, positive by the right-hand rule from the first body to the second, and its rate.
    Angle {
        /// Angle, rad.
        position: T,
        /// Rate, rad/s.
        rate: T,
    },
    /// Displacement from the first body's joint point to the second's, and its rate.
    Length {
        /// Displacement, m.
        position: T,
        /// Rate, m/s.
        rate: T,
    },
    /// Relative orientation, and the relative angular velocity in the second body's frame.
    Orientation {
        /// Euler parameters.
        position: [T; 4],
        /// Angular velocity, rad/s.
        rate: [T; 3],
    },
}

/// The joint coordinates when they were last read, angles continuous over turns. Held beside the state by the caller,
/// in buffers of the readings' own type.
///
/// An angle is continued from the last reading by the mean of the two rates, so it may turn many times between readings
/// as long as that mean predicts it to within half a turn.
#[derive(Clone, Debug)]
pub struct Turns<M: Mechanism> {
    readings: M::Readings,
    /// For each angle, at the place of its raw sine: the continuous angle; at its raw rate: the rate.
    last: M::Readings,
}

impl<M: Mechanism<Scalar: Real>> Turns<M> {
    /// Takes the angles of a state at time `t` to lie nearest to the given ones, one number for each coordinate, joint
    /// after joint (those of lengths and orientations are not looked at); angles that `nearest` does not cover to zero.
    pub fn new(mechanism: &M, t: M::Scalar, y: &M::State, nearest: &[M::Scalar]) -> Self {
        let mut turns = Self { readings: mechanism.buffers().readings, last: mechanism.buffers().readings };
        mechanism.read_joints(t, y, &mut turns.readings);
        let zero = M::Scalar::constant(0.0);
        for_each_angle(mechanism, |index, at| {
            turns.continue_angle(at, nearest.get(index).copied().unwrap_or(zero));
        });
        turns
    }

    /// Reads the state at time `t`, `dt` seconds after the last reading.
    pub fn update(&mut self, mechanism: &M, t: M::Scalar, dt: M::Scalar, y: &M::State) {
        mechanism.read_joints(t, y, &mut self.readings);
        for_each_angle(mechanism, |_, at| {
            let (last, readings) = (self.last.as_ref(), self.readings.as_ref());
            let mean_rate = (last[at + 2] + readings[at + 2]) * M::Scalar::constant(0.5);
            self.continue_angle(at, last[at] + mean_rate * dt);
        });
    }

    /// A coordinate of a joint at the last reading; `None` for one that does not exist.
    pub fn coordinate(
        &self,
        mechanism: &M,
        joint: usize,
        index: usize,
    ) -> Option<JointCoordinate<M::Scalar>> {
        let description = mechanism.description();
        let at = description.reading(joint, index)?;
        let kind = description.joints.get(joint)?.coordinates.get(index)?;
        Some(match kind {
            Coordinate::Angle => {
                let last = self.last.as_ref();
                JointCoordinate::Angle { position: last[at], rate: last[at + 2] }
            }
            Coordinate::Length => {
                let readings = self.readings.as_ref();
                JointCoordinate::Length { position: readings[at], rate: readings[at + 1] }
            }
            Coordinate::Orientation => {
                let values = &self.readings.as_ref()[at..at + 7];
                JointCoordinate::Orientation {
                    position: core::array::from_fn(|k| values[k]),
                    rate: core::array::from_fn(|k| values[4 + k]),
                }
            }
        })
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

/// Calls `f` with the index among all coordinates and the place of its readings for each angle.
fn for_each_angle<M: Mechanism>(mechanism: &M, mut f: impl FnMut(usize, usize)) {
    let (mut index, mut at) = (0, 0);
    for joint in mechanism.description().joints {
        for coordinate in joint.coordinates {
            if *coordinate == Coordinate::Angle {
                f(index, at);
            }
            index += 1;
            at += coordinate.n_readings();
        }
    }
}
