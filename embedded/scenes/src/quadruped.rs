//! A quadruped in the air whose joints are held by motors: a step of its joint dynamics at each tick of a clock.

use crate::digest::Digest;
use crate::kernels::{Clock, Work};
use crate::mechanisms::quadruped as generated;
use crate::runs::{Bits, Outcome};
use crate::simulator::TICK;
use generated::index::{joint, joint_rate};
use gyro_sim::{Direct, Error, Joint, JointSpace, Mechanism, Real};

/// What tables call its run.
pub const NAME: &str = "quadruped joint";
/// Of a run.
const TICKS: u32 = 1000;
/// Of the joints' controllers, N m/rad and N m s/rad.
const GAINS: [f64; 2] = [8.0, 0.1];
/// Of four legs.
const JOINTS: usize = 12;

type Robot<T> = generated::Quadruped<T>;
type Joints<T> = <Robot<T> as JointSpace>::Joints;

/// The simulated robot with its controllers: all that a tick needs, in one place of known size.
#[derive(Debug)]
pub struct Quadruped<T: Real> {
    robot: Robot<T>,
    solver: Direct<Joint, Joints<T>>,
    state: Joints<T>,
    posture: [T; JOINTS],
    ticks: u32,
}

impl<T: Real> Quadruped<T> {
    /// The robot at its start, whose posture its joints hold.
    // As a function of its own it would hold a second copy of all of it while it returns.
    #[inline(always)]
    pub fn new() -> Self {
        let robot = Robot::default();
        let state = robot.joint_start();
        let (mut posture, angles) = ([T::constant(0.0); JOINTS], angles(state.as_ref()));
        posture.iter_mut().zip(angles).for_each(|(held, &angle)| *held = angle);
        Self { solver: Direct::new(Joint, &state), robot, state, posture, ticks: 0 }
    }

    /// Sets the motors from angles and rates, then advances.
    ///
    /// # Errors
    /// [`Error`] if the state cannot be advanced; the simulation must not go on.
    pub fn tick(&mut self) -> Result<(), Error> {
        let state = self.state.as_ref();
        let [stiffness, damping] = GAINS.map(T::constant);
        let joints = angles(state).iter().zip(rates(state)).zip(&self.posture);
        for (input, ((&angle, &rate), &held)) in joints.enumerate() {
            let torque = stiffness * (held - angle) - damping * rate;
            self.robot.set_input(input, torque);
        }
        let (t, step) = (T::constant(f64::from(self.ticks) * TICK), T::constant(TICK));
        self.solver.advance(&self.robot, t, step, 1, &mut self.state)?;
        self.ticks += 1;
        Ok(())
    }
}

impl<T: Real> Default for Quadruped<T> {
    fn default() -> Self {
        Self::new()
    }
}

/// Of all joints: they stand one after the other, from the first joint of the first leg to the last of the last.
fn angles<T>(state: &[T]) -> &[T] {
    state.get(joint::FRONT_LEFT_ROLL..=joint::HIND_RIGHT_KNEE).unwrap_or(&[])
}

fn rates<T>(state: &[T]) -> &[T] {
    state.get(joint_rate::FRONT_LEFT_ROLL..=joint_rate::HIND_RIGHT_KNEE).unwrap_or(&[])
}

/// The run: the digest of its states, and the angles of the first leg at its end.
///
/// # Errors
/// That of a tick.
pub fn run<T: Bits, C: Clock>(clock: &mut C) -> Result<Outcome<T>, Error> {
    let (mut robot, mut digest) = (Quadruped::<T>::new(), Digest::new());
    for _ in 0..TICKS {
        clock.time(Work::Tick, || robot.tick())?;
        robot.state.as_ref().iter().for_each(|x| digest.add(x.bits()));
    }
    let joints = match *angles(robot.state.as_ref()) {
        [roll, pitch, knee, ..] => [roll, pitch, knee],
        _ => [T::constant(0.0); 3],
    };
    Ok(Outcome { digest: digest.0, joints })
}
