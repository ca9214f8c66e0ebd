//! A camera on a stabilised gimbal: loops that are closed at each tick of a clock, bearings that stick, and stops.

use crate::digest::Digest;
use crate::kernels::{Clock, Work};
use crate::mechanisms::stabilised_gimbal::{Parameters, StabilisedGimbal};
use crate::runs::{Bits, Outcome};
use crate::simulator::TICK;
use gyro_sim::contact::{Contact, Error, JointInputs, Record, Stepped};
use gyro_sim::sampled::{Controller, Pid, Quantised};
use gyro_sim::{JointOutputs, JointSpace, Mechanism, Real};

/// What tables call its run.
pub const NAME: &str = "stabilised joint";
/// Length of a step, s.
const STEP: f64 = 1e-4;
/// Steps from the reading of the gyros to the motors, and from there to the end of the tick.
const STEPS: [u32; 2] = [3, 7];
/// Of a run: the vehicle rolls to one side and to the other.
const TICKS: u32 = 2000;
/// Of the vehicle, rad: four times that of the model file, and the camera hits its stop.
const ROLL: f64 = 0.6;
/// Of both rate loops, rad/s.
const BANDWIDTH: f64 = 125.0;
/// About the axes, kg m².
const INERTIAS: [f64; 2] = [0.01, 6e-3];
/// What the motors can do, N m.
const LIMIT: f64 = 2.0;
/// Of the gyros' converter, rad/s.
const RESOLUTION: f64 = 1e-5;
/// Dry friction of the bearings, moving and at rest, N m.
const FRICTION: [f64; 2] = [0.02, 0.03];
/// Of the tilt axis, degrees.
const STOPS: [f64; 2] = [-25.0, 35.0];
const RESTITUTION: f64 = 0.3;

type Joints<T> = <StabilisedGimbal<T> as JointSpace>::Joints;

/// The simulated gimbal and its controllers: all that a tick needs, in one place of known size.
#[derive(Debug)]
pub struct Stabilised<T: Real> {
    gimbal: StabilisedGimbal<T>,
    motion: Stepped<JointInputs<2>, Joints<T>, T, 2>,
    state: Joints<T>,
    outputs: <StabilisedGimbal<T> as Mechanism>::Outputs,
    /// Of pan and tilt, in that order.
    loops: [Quantised<Pid<T>, T, 1>; 2],
    ticks: u32,
}

impl<T: Real> Stabilised<T> {
    /// The gimbal at its start.
    // As a function of its own it would hold a second copy of all of it while it returns.
    #[inline(always)]
    pub fn new() -> Self {
        let k = T::constant;
        let gimbal = StabilisedGimbal::new(Parameters { roll: k(ROLL), ..Parameters::default() });
        let state = gimbal.joint_start();
        // The joint state is (pan, tilt, their rates, work); the contacts' forces are the inputs after the motors.
        let inputs = JointInputs { inputs: [2, 3] };
        Self {
            motion: Stepped::new(inputs, contacts(), &state),
            state,
            outputs: gimbal.buffers().outputs,
            gimbal,
            loops: INERTIAS.map(|inertia| Quantised {
                controller: rate_loop(inertia),
                outputs: [k(RESOLUTION)],
                inputs: k(0.0),
            }),
            ticks: 0,
        }
    }

    /// Reads the gyros, advances, sets the motors, advances to the end of the tick.
    ///
    /// # Errors
    /// [`Error`] if the state cannot be advanced; the simulation must not go on.
    pub fn tick(&mut self) -> Result<(), Error> {
        let t = self.time(0);
        self.gimbal.joint_outputs(t, &self.state, &mut self.outputs);
        let mut torques = [T::constant(0.0); 2];
        if let [_, _, _, _, tilting, panning, ..] = *self.outputs.as_ref() {
            for ((law, rate), torque) in self.loops.iter_mut().zip([panning, tilting]).zip(&mut torques) {
                law.sample(t, &[rate], core::slice::from_mut(torque));
            }
        }
        let [before, after] = STEPS;
        self.advance(0, before)?;
        [self.gimbal.pan_motor, self.gimbal.tilt_motor] = torques;
        self.motion.system_has_changed();
        self.advance(before, after)?;
        self.ticks += 1;
        Ok(())
    }

    fn advance(&mut self, begin: u32, steps: u32) -> Result<(), Error> {
        let t = self.time(begin);
        self.motion.advance(&self.gimbal, t, T::constant(STEP), steps, &mut self.state)
    }

    /// The time after so many steps of the tick.
    fn time(&self, steps: u32) -> T {
        T::constant(f64::from(self.ticks) * TICK + f64::from(steps) * STEP)
    }

    /// The joint state, for those who compare it.
    pub fn state(&self) -> &[T] {
        self.state.as_ref()
    }

    /// What the contacts have done so far.
    pub fn record(&self) -> &Record<T> {
        self.motion.record()
    }
}

impl<T: Real> Default for Stabilised<T> {
    fn default() -> Self {
        Self::new()
    }
}

/// Pan and tilt turn in bearings with friction, tilt between stops.
fn contacts<T: Real>() -> [Contact<T>; 2] {
    let k = T::constant;
    let [kinetic, at_rest] = FRICTION.map(k);
    let bearing = |index| {
        let joint = Contact::new(index, index + 2);
        joint.with_friction(kinetic, at_rest).unwrap_or(joint)
    };
    let (pan, tilt) = (bearing(0), bearing(1));
    let stops = STOPS.map(|degrees| k(degrees.to_radians()));
    [pan, tilt.with_stops(stops, k(RESTITUTION)).unwrap_or(tilt)]
}

/// Its integral is the angle in space.
fn rate_loop<T: Real>(inertia: f64) -> Pid<T> {
    let k = T::constant;
    let gains = [inertia * BANDWIDTH, inertia * BANDWIDTH * BANDWIDTH / 4.0, 0.0];
    Pid::new(gains.map(k), k(TICK)).with_limits([k(-LIMIT), k(LIMIT)])
}

/// The run: the digest of its states, the angles at its end, and what impacts have taken, J.
///
/// # Errors
/// That of a tick.
pub fn run<T: Bits, C: Clock>(clock: &mut C) -> Result<Outcome<T>, Error> {
    let (mut gimbal, mut digest) = (Stabilised::<T>::new(), Digest::new());
    for _ in 0..TICKS {
        clock.time(Work::Tick, || gimbal.tick())?;
        gimbal.state().iter().for_each(|x| digest.add(x.bits()));
    }
    let Record { impacts, caught, released, lost, .. } = *gimbal.record();
    [impacts, caught, released].into_iter().for_each(|count| digest.add(count));
    let (pan, tilt) = match *gimbal.state() {
        [pan, tilt, ..] => (pan, tilt),
        _ => (T::constant(0.0), T::constant(0.0)),
    };
    Ok(Outcome { digest: digest.0, joints: [pan, tilt, lost] })
}
