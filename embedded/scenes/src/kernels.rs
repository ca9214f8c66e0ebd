//! What is measured, over a whole run: the same work that [`crate::runs`] does, taken apart.

use crate::mechanisms::chain::Chain;
use crate::mechanisms::gyroscope_combined_offsets::GyroscopeCombinedOffsets;
use crate::runs::{CHAIN, PAPER, STEPS, Settings, time};
use crate::{Minimal, Simulator, demand};
use gyro_sim::generated::gyroscope::Gyroscope;
use gyro_sim::{Direct, Error, JointForm, JointSpace, Ode, Partition, Partitioned, Real, Rk4, Scalar};

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
pub fn measured<T: Real, C: Clock>() -> [Measured<C>; 8] {
    [
        ("paper maximal", |clock| maximal(&Gyroscope::<T>::default(), PAPER, clock)),
        ("paper joint", |clock| first_order(&JointForm(&Gyroscope::<T>::default()), PAPER, clock)),
        ("misaligned maximal", |clock| maximal(&GyroscopeCombinedOffsets::<T>::default(), PAPER, clock)),
        ("misaligned joint", |clock| {
            first_order(&JointForm(&GyroscopeCombinedOffsets::<T>::default()), PAPER, clock)
        }),
        ("chain maximal", |clock| maximal(&Chain::<T>::default(), CHAIN, clock)),
        ("chain joint", |clock| first_order(&JointForm(&Chain::<T>::default()), CHAIN, clock)),
        ("paper by-hand", |clock| first_order(&Minimal::<T>::new(), PAPER, clock)),
        ("control maximal", control::<T, C>),
    ]
}

/// A mechanism between two corrections, as [`Partitioned`] integrates it.
struct Corrected<'a, M>(&'a M);

impl<M: Partition> Ode for Corrected<'_, M> {
    type Scalar = M::Scalar;
    type State = M::State;

    fn start(&self) -> M::State {
        self.0.start()
    }
    fn derivative(&self, t: M::Scalar, y: &M::State, dy: &mut M::State) {
        self.0.corrected_derivative(t, y, dy);
    }
}

fn maximal<M: Partition + JointSpace>(
    mechanism: &M,
    settings: Settings,
    clock: &mut impl Clock,
) -> Result<(), Error> {
    let corrected = Corrected(mechanism);
    let mut y = mechanism.start();
    let mut dy = y.clone();
    let (mut direct, mut rk4) = (Direct::new(&y), Rk4::new(&y));
    let mut solver = Partitioned::new(mechanism, &y);
    let h = M::Scalar::constant(settings.step);
    for interval in 0..settings.intervals {
        let t = time(settings.step, interval);
        clock.time(Work::Derivative, || mechanism.derivative(t, &y, &mut dy));
        clock.time(Work::CorrectedDerivative, || mechanism.corrected_derivative(t, &y, &mut dy));
        let mut other = y.clone();
        clock.time(Work::Step, || rk4.step(&corrected, t, h, &mut other));
        clock.time(Work::FiveSteps, || direct.advance(&corrected, t, h, STEPS, &mut y))?;
        let t = time(settings.step, interval + 1);
        clock.time(Work::Correction, || solver.correct(mechanism, t, &mut y))?;
    }
    Ok(())
}

fn first_order<O: Ode<Scalar: Real>>(
    system: &O,
    settings: Settings,
    clock: &mut impl Clock,
) -> Result<(), Error> {
    let mut x = system.start();
    let mut dx = x.clone();
    let (mut direct, mut rk4) = (Direct::new(&x), Rk4::new(&x));
    let h = O::Scalar::constant(settings.step);
    for interval in 0..settings.intervals {
        let t = time(settings.step, interval);
        clock.time(Work::Derivative, || system.derivative(t, &x, &mut dx));
        let mut other = x.clone();
        clock.time(Work::Step, || rk4.step(system, t, h, &mut other));
        clock.time(Work::FiveSteps, || direct.advance(system, t, h, STEPS, &mut x))?;
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
