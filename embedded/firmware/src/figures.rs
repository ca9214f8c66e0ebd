//! Counts instructions.
//!
//! QEMU is told to let a fixed virtual time pass for each instruction, so a timer counts them: 256 ns, of which the
//! processor's clock of 25 MHz sees 6.4 ticks. These are instructions, not cycles.

use crate::{board, panic, print};
use core::hint::black_box;
use cortex_m::peripheral::{Peripherals, SYST, syst::SystClkSource};
use embedded_scenes::kernels::{Clock, Work, measured};
use gyro_sim::Real;

/// Five instructions are 32 ticks.
const INSTRUCTIONS: u32 = 5;
const TICKS: u32 = 32;
/// The clock counts down through so many bits.
const MASK: u32 = 0xff_ffff;

/// Least, most, sum and number of what a piece of work took, instructions.
#[derive(Clone, Copy, Debug)]
struct Tally {
    least: u32,
    most: u32,
    sum: u64,
    number: u32,
}

const NONE: Tally = Tally { least: u32::MAX, most: 0, sum: 0, number: 0 };

/// The instructions of each kind of work.
#[derive(Debug)]
pub struct Counter {
    /// What it takes to time nothing.
    nothing: u32,
    tallies: [Tally; Work::ALL.len()],
}

impl Counter {
    pub(crate) fn new() -> Self {
        let mut counter = Self { nothing: 0, tallies: [NONE; Work::ALL.len()] };
        let _ = counted(|| ());
        counter.nothing = counted(|| ()).1;
        counter
    }

    pub(crate) fn print(&self, precision: &str, name: &str) {
        for (work, tally) in Work::ALL.iter().zip(&self.tallies) {
            let mean = tally.sum.checked_div(u64::from(tally.number));
            let Some(mean) = mean else { continue };
            for word in ["count ", precision, " ", name, " ", work.name()] {
                print::text(word);
            }
            for value in [tally.least, mean as u32, tally.most] {
                print::text(" ");
                print::number(value);
            }
            print::line("");
        }
    }
}

impl Clock for Counter {
    fn time<R>(&mut self, work: Work, run: impl FnOnce() -> R) -> R {
        let (result, instructions) = counted(run);
        let instructions = instructions.saturating_sub(self.nothing);
        if let Some(tally) = self.tallies.get_mut(work as usize) {
            tally.least = tally.least.min(instructions);
            tally.most = tally.most.max(instructions);
            tally.sum += u64::from(instructions);
            tally.number += 1;
        }
        result
    }
}

/// What a piece of work returns, and the instructions from one reading of the clock to the next.
#[inline(never)]
fn counted<R>(run: impl FnOnce() -> R) -> (R, u32) {
    let before = SYST::get_current();
    let result = black_box(run());
    let after = SYST::get_current();
    let ticks = before.wrapping_sub(after) & MASK;
    (result, (ticks * INSTRUCTIONS + TICKS / 2) / TICKS)
}

/// Measures everything in one precision.
pub fn run<T: Real>() -> ! {
    panic::fault();
    start();
    let precision = if size_of::<T>() == 4 { "f32" } else { "f64" };
    for (name, run) in measured::<T, Counter>() {
        let mut counter = Counter::new();
        if run(&mut counter).is_err() {
            print::line(name);
            print::line("failed");
            board::exit(false);
        }
        counter.print(precision, name);
    }
    print::line("end");
    board::exit(true)
}

/// Starts the clock and checks it.
pub(crate) fn start() {
    if let Some(peripherals) = Peripherals::take() {
        start_clock(peripherals.SYST);
    }
    check_the_clock();
}

fn start_clock(mut clock: SYST) {
    clock.set_clock_source(SystClkSource::Core);
    clock.set_reload(MASK);
    clock.clear_current();
    clock.enable_counter();
}

/// A thousand instructions that are known to be a thousand.
fn check_the_clock() {
    let nothing = Counter::new().nothing;
    let (_, instructions) = counted(|| {
        // SAFETY: it does nothing.
        unsafe { core::arch::asm!(".rept 1000", "nop", ".endr", options(nomem, nostack, preserves_flags)) }
    });
    print::text("thousand ");
    print::number(instructions - nothing);
    print::line("");
}
