//! A base moved by prescription: its pose, velocity and acceleration at any time.

use crate::DoubleDouble;
use crate::rotation::{ORIGIN, Precise, Rotation};
use crate::trajectory::{decimal, decimals};
use crate::vector::{add, cross, dot, scale};

/// `amplitude · sin(angular_frequency · t + phase)`.
///
/// The angular frequency is the `f64` itself, amplitude and phase are the decimals they print as.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sinusoid {
    /// Amplitude, rad or m.
    pub amplitude: f64,
    /// Angular frequency, rad/s.
    pub angular_frequency: f64,
    /// Phase, rad.
    pub phase: f64,
}

/// How a base moves: its origin by `translation` in the global frame, and its axes by the rotations one after
/// the other, each about an axis of the frame that the ones before it have turned. By default it rests in the
/// global frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BaseMotion {
    /// Displacement of the base's origin, m.
    pub translation: [Sinusoid; 3],
    /// Direction of each axis, of any length but zero, and angle, rad.
    pub rotations: Vec<([f64; 3], Sinusoid)>,
}

/// Motion of a frame with its origin: all but the pose itself as global vectors.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FrameMotion {
    pub(crate) rotation: Rotation,
    pub(crate) position: Precise,
    pub(crate) velocity: Precise,
    pub(crate) acceleration: Precise,
    pub(crate) angular_velocity: Precise,
    pub(crate) angular_acceleration: Precise,
}

/// A [`Sinusoid`] in double-double numbers.
#[derive(Clone, Copy, Debug)]
struct PreciseSinusoid {
    amplitude: DoubleDouble,
    frequency: DoubleDouble,
    phase: DoubleDouble,
}

/// A [`BaseMotion`] in double-double numbers.
#[derive(Clone, Debug)]
pub(crate) struct PreciseBase {
    translation: [PreciseSinusoid; 3],
    rotations: Vec<(Precise, PreciseSinusoid)>,
}

impl PreciseSinusoid {
    fn new(sinusoid: Sinusoid) -> Self {
        PreciseSinusoid {
            amplitude: decimal(sinusoid.amplitude),
            frequency: DoubleDouble::new(sinusoid.angular_frequency),
            phase: decimal(sinusoid.phase),
        }
    }

    /// Value, first and second derivative.
    fn at(&self, t: DoubleDouble) -> [DoubleDouble; 3] {
        let PreciseSinusoid { amplitude, frequency, phase } = *self;
        let (sin, cos) = (frequency * t + phase).sin_cos();
        [amplitude * sin, amplitude * frequency * cos, -(amplitude * frequency * frequency * sin)]
    }
}

impl BaseMotion {
    /// A base that turns about axes of its own and stays where it is.
    #[must_use]
    pub fn turning(rotations: Vec<([f64; 3], Sinusoid)>) -> Self {
        BaseMotion { rotations, ..BaseMotion::default() }
    }
}

impl PreciseBase {
    pub(crate) fn new(base: &BaseMotion) -> Self {
        let rotations = base.rotations.iter();
        PreciseBase {
            translation: base.translation.map(PreciseSinusoid::new),
            rotations: rotations.map(|(axis, angle)| (unit(*axis), PreciseSinusoid::new(*angle))).collect(),
        }
    }

    /// The motion at time `t`: translation, then one rotation after the other.
    pub(crate) fn at(&self, t: DoubleDouble) -> FrameMotion {
        let translation = self.translation.map(|sinusoid| sinusoid.at(t));
        let [position, velocity, acceleration] =
            core::array::from_fn(|order| translation.map(|derivatives| derivatives[order]));
        let mut frame = FrameMotion {
            rotation: Rotation::IDENTITY,
            position,
            velocity,
            acceleration,
            angular_velocity: ORIGIN,
            angular_acceleration: ORIGIN,
        };
        for (axis, angle) in &self.rotations {
            frame.turn(*axis, angle.at(t));
        }
        frame
    }
}

impl FrameMotion {
    /// A rotation about the axis `axis` of the frame by an angle with its derivatives: the axis turns with
    /// the frame so far, so ω gains u θ̇ and ω̇ gains u θ̈ + ω × u θ̇.
    pub(crate) fn turn(&mut self, axis: Precise, [angle, rate, acceleration]: [DoubleDouble; 3]) {
        let spin = scale(rate, self.rotation.times(axis));
        let change = add(scale(acceleration, self.rotation.times(axis)), cross(self.angular_velocity, spin));
        self.angular_acceleration = add(self.angular_acceleration, change);
        self.angular_velocity = add(self.angular_velocity, spin);
        self.rotation = self.rotation.then(&Rotation::about(axis, angle));
    }

    /// Moves the origin by `arm`, a global vector fixed in the frame.
    pub(crate) fn shift(&mut self, arm: Precise) {
        let (w, e) = (self.angular_velocity, self.angular_acceleration);
        self.position = add(self.position, arm);
        self.velocity = add(self.velocity, cross(w, arm));
        self.acceleration = add(self.acceleration, add(cross(e, arm), cross(w, cross(w, arm))));
    }
}

/// The direction of `axis` with length one.
///
/// # Panics
/// If it has no length.
pub(crate) fn unit(axis: [f64; 3]) -> Precise {
    assert!(axis != [0.0; 3], "an axis has a length");
    let axis = decimals(axis);
    let length = dot(axis, axis).sqrt();
    axis.map(|x| x / length)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::sub;

    /// Central differences err by this squared times the third derivative, below 1e6 here; rounding by 1e-31
    /// over it.
    const STEP: f64 = 1e-10;
    const DIFFERENCE: f64 = 1e-13;

    fn shaken() -> BaseMotion {
        let wave = |amplitude, angular_frequency, phase| Sinusoid { amplitude, angular_frequency, phase };
        BaseMotion {
            translation: [wave(0.1, 3.0, 0.4), wave(0.2, 5.0, 0.0), wave(-0.3, 7.0, 1.0)],
            rotations: vec![
                ([1.0, 0.0, 0.0], wave(0.7, 11.0, 0.2)),
                ([0.0, 1.0, 2.0], wave(0.9, 13.0, -0.5)),
            ],
        }
    }

    fn largest(v: Precise) -> f64 {
        v.iter().map(|x| x.to_f64().abs()).fold(0.0, f64::max)
    }

    #[test]
    fn velocities_and_accelerations_are_derivatives() {
        let base = PreciseBase::new(&shaken());
        let t = decimal(0.3);
        let [before, here, after] = [-STEP, 0.0, STEP].map(|step| base.at(t + DoubleDouble::new(step)));
        let slope = |a: Precise, b: Precise| sub(b, a).map(|x| x.divided_by(2.0 * STEP));
        let error = |found: Precise, a, b| largest(sub(found, slope(a, b)));
        assert!(error(here.velocity, before.position, after.position) < DIFFERENCE);
        assert!(error(here.acceleration, before.velocity, after.velocity) < DIFFERENCE);
        let (w0, w1) = (before.angular_velocity, after.angular_velocity);
        assert!(error(here.angular_acceleration, w0, w1) < DIFFERENCE);
        for k in 0..3 {
            let turning = cross(here.angular_velocity, here.rotation.0[k]);
            assert!(error(turning, before.rotation.0[k], after.rotation.0[k]) < DIFFERENCE, "axis {k}");
        }
    }
}
