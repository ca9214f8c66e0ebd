//! The runs whose bits are compared between machines.

use crate::digest::Digest;
use crate::mechanisms::chain::Chain;
use crate::mechanisms::gimbal::{Gimbal, Parameters};
use crate::mechanisms::gyroscope_combined_offsets::GyroscopeCombinedOffsets;
use crate::mechanisms::long_chain::LongChain;
use crate::{Simulator, demand};
use gyro_sim::generated::gyroscope::Gyroscope;
use gyro_sim::{
    CorrectedDynamics, Direct, Error, Joint, JointCoordinate, JointSpace, Mechanism, Partition, Partitioned,
    Real, Scalar, Turns,
};

/// A number whose bits can be looked at.
pub trait Bits: Real {
    /// `f32` or `f64`.
    const NAME: &'static str;
    /// The representation, in the low bits.
    fn bits(self) -> u64;
}

impl Bits for f32 {
    const NAME: &'static str = "f32";
    fn bits(self) -> u64 {
        u64::from(self.to_bits())
    }
}

impl Bits for f64 {
    const NAME: &'static str = "f64";
    fn bits(self) -> u64 {
        self.to_bits()
    }
}

/// What a run came to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome<T> {
    /// Of every number of every state at the corrections.
    pub digest: u64,
    /// The first three joint positions at the end.
    pub joints: [T; 3],
}

/// A run and its name.
pub type Run<T> = (&'static str, fn() -> Result<Outcome<T>, Error>);

/// All of them.
pub fn runs<T: Bits>() -> [Run<T>; 12] {
    [
        ("paper maximal", || maximal(&Gyroscope::default(), PAPER)),
        ("paper 2e-4 maximal", || maximal(&Gyroscope::default(), Settings { step: 2e-4, intervals: 1000 })),
        ("paper 5e-4 maximal", || maximal(&Gyroscope::default(), Settings { step: 5e-4, intervals: 400 })),
        ("paper 1e-3 maximal", || maximal(&Gyroscope::default(), Settings { step: 1e-3, intervals: 200 })),
        ("paper joint", || joint(&Gyroscope::default(), PAPER)),
        ("misaligned maximal", || maximal(&GyroscopeCombinedOffsets::default(), PAPER)),
        ("misaligned joint", || joint(&GyroscopeCombinedOffsets::default(), PAPER)),
        ("chain maximal", || maximal(&Chain::default(), CHAIN)),
        ("chain joint", || joint(&Chain::default(), CHAIN)),
        ("long-chain joint", || joint(&LongChain::default(), CHAIN)),
        ("control", control),
        ("driven", driven),
    ]
}

/// Step and number of intervals of five steps.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// Length of a step, s.
    pub step: f64,
    /// Corrections, or in joint coordinates groups of steps.
    pub intervals: u32,
}

/// Steps in an interval.
pub(crate) const STEPS: u32 = 5;
/// The paper's second.
pub(crate) const PAPER: Settings = Settings { step: 1e-4, intervals: 2000 };
/// A second of the chain.
pub(crate) const CHAIN: Settings = Settings { step: 1e-3, intervals: 200 };

/// Coordinate partitioning in maximal coordinates.
///
/// # Errors
/// Those of the solver.
pub fn maximal<M>(mechanism: &M, settings: Settings) -> Result<Outcome<M::Scalar>, Error>
where
    M: Partition<Scalar: Bits> + CorrectedDynamics + JointSpace,
{
    let mut state = mechanism.start();
    let mut solver = Partitioned::new(mechanism, &state);
    let (h, mut digest) = (M::Scalar::constant(settings.step), Digest::new());
    let mut joints = mechanism.joint_start();
    for interval in 0..settings.intervals {
        solver.advance(mechanism, time(settings.step, interval), h, STEPS, &mut state)?;
        mechanism.to_joints(time(settings.step, interval + 1), &state, &mut joints);
        add(&mut digest, state.as_ref());
    }
    Ok(Outcome { digest: digest.0, joints: first_three(joints.as_ref()) })
}

/// RK4 in joint coordinates.
///
/// # Errors
/// [`Error::NotFinite`] of the state at the end.
pub fn joint<M>(mechanism: &M, settings: Settings) -> Result<Outcome<M::Scalar>, Error>
where
    M: JointSpace<Scalar: Bits>,
{
    let mut x = mechanism.joint_start();
    let mut solver = Direct::new(Joint, &x);
    let (h, mut digest) = (M::Scalar::constant(settings.step), Digest::new());
    for interval in 0..settings.intervals {
        solver.advance(mechanism, time(settings.step, interval), h, STEPS, &mut x)?;
        add(&mut digest, x.as_ref());
    }
    Ok(Outcome { digest: digest.0, joints: first_three(x.as_ref()) })
}

/// The gimbal under rate control.
fn control<T: Bits>() -> Result<Outcome<T>, Error> {
    let (mut simulator, mut digest) = (Simulator::new(), Digest::new());
    let mut angles = simulator.angles();
    for tick in 0..1000 {
        angles = simulator.tick(demand(tick))?;
        add(&mut digest, simulator.state());
    }
    Ok(Outcome { digest: digest.0, joints: [angles.alpha, angles.beta, angles.phi] })
}

/// A heavier rotor, and a motor that pushes one way, then the other: what the examples in C and JavaScript do.
fn driven<T: Bits>() -> Result<Outcome<T>, Error> {
    let k = T::constant;
    let mut gimbal = Gimbal::new(Parameters { rotor_mass: k(0.085) });
    let mut state = gimbal.start();
    let mut solver = Partitioned::new(&gimbal, &state);
    let mut turns = Turns::new(&gimbal, k(0.0), &state, &[]);
    let (mut digest, mut joints) = (Digest::new(), [k(0.0); 3]);
    for interval in 0..PAPER.intervals {
        gimbal.torque = k(match interval {
            0..600 => 1e-4,
            600..1200 => -1e-4,
            _ => 0.0,
        });
        solver.advance(&gimbal, time(PAPER.step, interval), k(PAPER.step), STEPS, &mut state)?;
        let length = k(PAPER.step * f64::from(STEPS));
        turns.update(&gimbal, time(PAPER.step, interval + 1), length, &state);
        for (joint, place) in joints.iter_mut().enumerate() {
            if let Some(JointCoordinate::Angle { position, rate }) = turns.coordinate(&gimbal, joint, 0) {
                *place = position;
                add(&mut digest, &[position, rate]);
            }
        }
    }
    Ok(Outcome { digest: digest.0, joints })
}

pub(crate) fn time<T: Real>(step: f64, interval: u32) -> T {
    T::constant(step * f64::from(interval * STEPS))
}

fn add<T: Bits>(digest: &mut Digest, numbers: &[T]) {
    numbers.iter().for_each(|x| digest.add(x.bits()));
}

fn first_three<T: Real>(x: &[T]) -> [T; 3] {
    match *x {
        [a, b, c, ..] => [a, b, c],
        _ => [T::constant(0.0); 3],
    }
}
