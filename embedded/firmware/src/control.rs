//! A gimbal under rate control, at a fixed rate: a millisecond of simulated time for each tick of the clock.

use crate::{board, panic, print};
use core::sync::atomic::{AtomicU32, Ordering};
use cortex_m::peripheral::{Peripherals, SYST, syst::SystClkSource};
use cortex_m_rt::exception;
use embedded_scenes::{Angles, Simulator, demand};
use gyro_sim::{Error, Real};

/// Of the processor, Hz.
const CLOCK: u32 = 25_000_000;
/// Of the loop, Hz.
const RATE: u32 = 1000;
/// Simulated time, s.
const SECONDS: u32 = 1;

/// Counted by the clock's interrupt.
static TICKS: AtomicU32 = AtomicU32::new(0);

#[exception]
fn SysTick() {
    // Nobody else writes it, so load and store will do.
    TICKS.store(TICKS.load(Ordering::Relaxed).wrapping_add(1), Ordering::Relaxed);
}

/// Runs for a second; ends with failure if the simulation cannot go on.
pub fn run<T: Real>(simulator: &mut Simulator<T>) -> ! {
    panic::fault();
    if let Some(peripherals) = Peripherals::take() {
        start_clock(peripherals.SYST);
    }
    let is_success = match simulate(simulator) {
        Ok(overruns) => {
            print::text("overruns ");
            print::number(overruns);
            print::line("");
            true
        }
        Err(error) => {
            report(error);
            false
        }
    };
    print::text("stack ");
    print::number(board::stack());
    print::line("");
    print::text("ram ");
    print::number(size_of::<Simulator<T>>() as u32);
    print::line("");
    board::exit(is_success)
}

fn start_clock(mut clock: SYST) {
    clock.set_clock_source(SystClkSource::Core);
    clock.set_reload(CLOCK / RATE - 1);
    clock.clear_current();
    clock.enable_interrupt();
    clock.enable_counter();
}

/// The loop. Returns how often a tick took longer than it may.
fn simulate<T: Real>(simulator: &mut Simulator<T>) -> Result<u32, Error> {
    let mut overruns = 0;
    for tick in 0..SECONDS * RATE {
        let now = wait();
        let angles = simulator.tick(demand(tick))?;
        if TICKS.load(Ordering::Relaxed) != now {
            overruns += 1;
        }
        if tick % 100 == 99 {
            show(tick + 1, angles);
        }
    }
    Ok(overruns)
}

/// Sleeps until the next tick; returns its number.
fn wait() -> u32 {
    let before = TICKS.load(Ordering::Relaxed);
    loop {
        cortex_m::asm::wfi();
        let now = TICKS.load(Ordering::Relaxed);
        if now != before {
            return now;
        }
    }
}

/// Angles in microradians, the rate in microradians per second.
fn show<T: Real>(tick: u32, angles: Angles<T>) {
    print::number(tick);
    print::text(" ms");
    let values = [angles.alpha, angles.beta, angles.phi, angles.beta_rate];
    for (name, value) in [" alpha ", " beta ", " phi ", " beta rate "].into_iter().zip(values) {
        print::text(name);
        print::signed((value.to_f64() * 1e6) as i32);
    }
    print::line("");
}

fn report(error: Error) {
    let (words, t) = match error {
        Error::NotFinite { t, .. } => ("the state is not finite", t),
        Error::NoConvergence { t, .. } => ("the constraints cannot be met", t),
        Error::Singular { t, .. } => ("the pose is singular", t),
        Error::Jump { t, .. } => ("a correction would be too large", t),
        // They come of error control, which is not used here.
        Error::StepTooShort { t, .. }
        | Error::TooManySteps { t, .. }
        | Error::Stiff { t, .. }
        | Error::InvalidEndTime { t, .. } => ("the steps are too short", t),
        Error::Tolerance { .. } | Error::Setting { .. } => ("the tolerance cannot be met", 0.0),
    };
    print::text(words);
    print::text(" at ms ");
    print::signed((t * 1e3) as i32);
    print::line("");
}
