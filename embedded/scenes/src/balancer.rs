//! A robot on two wheels that roll: its motors have currents, and a controller at each tick of a clock keeps it
//! upright.

use crate::digest::Digest;
use crate::kernels::{Clock, Work};
use crate::mechanisms::balancer as generated;
use crate::runs::{Bits, Outcome};
use crate::simulator::TICK;
use generated::index::{body, body_rate, joint, joint_rate};
use gyro_sim::{CloseLoops, Direct, Error, Joint, JointSpace, Real};

/// What tables call its run.
pub const NAME: &str = "balancer joint";
/// Of a run: it drives off, turns, and stands.
const TICKS: u32 = 3000;
/// Of a tick.
const STEPS: u32 = 2;
/// V for the sine of its lean, for its rate (rad/s), and for what wheels are faster than they should be (rad/s).
const GAINS: [f64; 3] = [40.0, 2.5, 0.6];
/// What a wheel's turning induces in its motor, V s/rad.
const INDUCED: f64 = 0.24;
/// V for the difference between both wheels (rad/s).
const TURNING: f64 = 0.3;
/// V.
const BATTERY: f64 = 12.0;

type Robot<T> = generated::Balancer<T>;
type Joints<T> = <Robot<T> as JointSpace>::Joints;

/// The simulated robot with its controller: all that a tick needs, in one place of known size.
#[derive(Debug)]
pub struct Balancer<T: Real> {
    robot: Robot<T>,
    solver: Direct<Joint, Joints<T>>,
    closing: CloseLoops<Robot<T>>,
    state: Joints<T>,
    ticks: u32,
}

impl<T: Real> Balancer<T> {
    /// The robot at its start, upright and at rest.
    // As a function of its own it would hold a second copy of all of it while it returns.
    #[inline(always)]
    pub fn new() -> Self {
        let robot = Robot::default();
        let state = robot.joint_start();
        Self { solver: Direct::new(Joint, &state), closing: CloseLoops::new(&robot), robot, state, ticks: 0 }
    }

    /// Sets the motors from what the sensors see, then advances; the wheels neither slip nor leave the floor.
    ///
    /// # Errors
    /// [`Error`] if the state cannot be advanced; the simulation must not go on.
    pub fn tick(&mut self) -> Result<(), Error> {
        let k = T::constant;
        // Of the wheels' mean and of half their difference, rad/s.
        let [demand, turn] = match self.ticks {
            0..1000 => [5.0, 0.0],
            1000..2000 => [5.0, 2.0],
            _ => [0.0, 0.0],
        }
        .map(k);
        let [left, right] = [joint_rate::LEFT, joint_rate::RIGHT].map(|wheel| self.at(wheel));
        let (mean, difference) = ((left + right) * k(0.5), (right - left) * k(0.5));
        let [upright, falling, fast] = GAINS.map(k);
        let lean_rate = self.at(body_rate::CHASSIS + 4);
        let common =
            upright * self.lean() + falling * lean_rate + fast * (mean - demand) + k(INDUCED) * demand;
        let steering = k(TURNING) * (turn - difference) + k(INDUCED) * turn;
        self.robot.left_voltage = limited(common - steering);
        self.robot.right_voltage = limited(common + steering);
        let (t, step) = (k(f64::from(self.ticks) * TICK), k(TICK / f64::from(STEPS)));
        self.solver.advance(&self.robot, t, step, STEPS, &mut self.state)?;
        self.ticks += 1;
        self.closing.correct(&self.robot, k(f64::from(self.ticks) * TICK), &mut self.state)
    }

    /// The sine of the chassis' lean, forwards.
    pub fn lean(&self) -> T {
        let [e0, e1, e2, e3] = [3, 4, 5, 6].map(|place| self.at(body::CHASSIS + place));
        T::constant(2.0) * (e1 * e3 + e0 * e2)
    }

    fn at(&self, index: usize) -> T {
        self.state.as_ref().get(index).copied().unwrap_or(T::constant(0.0))
    }
}

impl<T: Real> Default for Balancer<T> {
    fn default() -> Self {
        Self::new()
    }
}

fn limited<T: Real>(voltage: T) -> T {
    let battery = T::constant(BATTERY);
    if voltage > battery {
        battery
    } else if voltage < -battery {
        -battery
    } else {
        voltage
    }
}

/// The run: the digest of its states, the angles of both wheels at its end, and the sine of its largest
/// lean.
///
/// # Errors
/// That of a tick.
pub fn run<T: Bits, C: Clock>(clock: &mut C) -> Result<Outcome<T>, Error> {
    let (mut robot, mut digest, mut most) = (Balancer::<T>::new(), Digest::new(), T::constant(0.0));
    for _ in 0..TICKS {
        clock.time(Work::Tick, || robot.tick())?;
        let lean = robot.lean().abs();
        most = if lean > most { lean } else { most };
        robot.state.as_ref().iter().for_each(|x| digest.add(x.bits()));
    }
    let joints = [robot.at(joint::LEFT), robot.at(joint::RIGHT), most];
    Ok(Outcome { digest: digest.0, joints })
}
