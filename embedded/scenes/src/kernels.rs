//! What is measured, over a whole run: the same work that [`crate::runs`] does, taken apart.

use crate::mechanisms::chain::Chain;
use crate::mechanisms::gyroscope_combined_offsets::GyroscopeCombinedOffsets;
use crate::mechanisms::long_chain::LongChain;
use crate::runs::{CHAIN, PAPER, STEPS, Settings, time};
use crate::{Minimal, Simulator, demand};
use gyro_sim::generated::gyroscope::Gyroscope;
use gyro_sim::{
    Corrected, CorrectedDynamics, Direct, Dynamics, Error, Joint, JointSpace, Ode, Partition, Partitioned,
    Real, Rk4, Scalar,
};

/// A piece of work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Work {
    /// ẏ from any state.
    Derivative,
    /// ẏ from a state that was corrected a few steps ago.
    CorrectedDerivative,
    /// One RK4 step.
    Step,
    /// Five RK4 steps.
    FiveSteps,
    /// The correction after them.
    Correction,
    /// A tick of the simulator: control, ten steps, two corrections, the joints read.
    Tick,
}

impl Work {
    /// In the order of their numbers.
    pub const ALL: [Self; 6] = [
        Self::Derivative,
        Self::CorrectedDerivative,
        Self::Step,
        Self::FiveSteps,
        Self::Correction,
        Self::Tick,
    ];

    /// What tables call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Derivative => "derivative",
            Self::CorrectedDerivative => "corrected-derivative",
            Self::Step => "step",
            Self::FiveSteps => "five-steps",
            Self::Correction => "correction",
            Self::Tick => "tick",
        }
    }
}

/// Whoever counts the instructions of a piece of work.
pub trait Clock {
    /// Does the work.
    fn time<R>(&mut self, work: Work, run: impl FnOnce() -> R) -> R;
}

/// A measured run and its name.
pub type Measured<C> = (&'static str, fn(&mut C) -> Result<(), Error>);

/// All of them.
pub fn measured<T: Real, C: Clock>() -> [Measured<C>; 9] {
    [
        ("paper maximal", |clock| maximal(&Gyroscope::<T>::default(), PAPER, clock)),
        ("paper joint", |clock| joint(&Gyroscope::<T>::default(), PAPER, clock)),
        ("misaligned maximal", |clock| maximal(&GyroscopeCombinedOffsets::<T>::default(), PAPER, clock)),
        ("misaligned joint", |clock| joint(&GyroscopeCombinedOffsets::<T>::default(), PAPER, clock)),
        ("chain maximal", |clock| maximal(&Chain::<T>::default(), CHAIN, clock)),
        ("chain joint", |clock| joint(&Chain::<T>::default(), CHAIN, clock)),
        ("long-chain joint", |clock| joint(&LongChain::<T>::default(), CHAIN, clock)),
        ("paper by-hand", |clock| {
            first_order((&Minimal::<T>::new(), &()), Minimal::<T>::start(), PAPER, clock)
        }),
        ("control maximal", control::<T, C>),
    ]
}

fn maximal<M: Partition<Scalar: Real> + Dynamics + CorrectedDynamics>(
    mechanism: &M,
    settings: Settings,
    clock: &mut impl Clock,
) -> Result<(), Error> {
    let mut y = mechanism.start();
    let mut dy = y.clone();
    let (mut direct, mut rk4) = (Direct::new(Corrected, &y), Rk4::new(&y));
    let mut solver = Partitioned::new(mechanism, &y);
    let h = M::Scalar::constant(settings.step);
    for interval in 0..settings.intervals {
        let t = time(settings.step, interval);
        clock.time(Work::Derivative, || mechanism.derivative(t, &y, &mut dy));
        clock.time(Work::CorrectedDerivative, || mechanism.corrected_derivative(t, &y, &mut dy));
        let mut other = y.clone();
        clock.time(Work::Step, || rk4.step(&Corrected, mechanism, t, h, &mut other));
        clock.time(Work::FiveSteps, || direct.advance(mechanism, t, h, STEPS, &mut y))?;
        let t = time(settings.step, interval + 1);
        clock.time(Work::Correction, || solver.correct(mechanism, t, &mut y))?;
    }
    Ok(())
}

fn joint<M: JointSpace<Scalar: Real>>(
    mechanism: &M,
    settings: Settings,
    clock: &mut impl Clock,
) -> Result<(), Error> {
    first_order((&Joint, mechanism), mechanism.joint_start(), settings, clock)
}

fn first_order<D: Ode<M, Scalar: Real> + Copy, M>(
    (dynamics, model): (&D, &M),
    mut x: D::State,
    settings: Settings,
    clock: &mut impl Clock,
) -> Result<(), Error> {
    let mut dx = x.clone();
    let (mut direct, mut rk4) = (Direct::new(*dynamics, &x), Rk4::new(&x));
    let h = D::Scalar::constant(settings.step);
    for interval in 0..settings.intervals {
        let t = time(settings.step, interval);
        clock.time(Work::Derivative, || dynamics.derivative(model, t, &x, &mut dx));
        let mut other = x.clone();
        clock.time(Work::Step, || rk4.step(dynamics, model, t, h, &mut other));
        clock.time(Work::FiveSteps, || direct.advance(model, t, h, STEPS, &mut x))?;
    }
    Ok(())
}

fn control<T: Real, C: Clock>(clock: &mut C) -> Result<(), Error> {
    let mut simulator = Simulator::<T>::new();
    for tick in 0..1000 {
        clock.time(Work::Tick, || simulator.tick(demand(tick)))?;
    }
    Ok(())
}
