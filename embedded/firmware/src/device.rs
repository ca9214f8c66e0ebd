//! What runs as on a device: the bits of its run, what its ticks take, and its memory.

use crate::figures::{self, Counter};
use crate::{board, panic, print, runs};
use embedded_scenes::runs::{Bits, Outcome};

/// The run of a simulator `S` in one precision.
pub fn run<T: Bits, S, E>(name: &str, run: impl FnOnce(&mut Counter) -> Result<Outcome<T>, E>) -> ! {
    panic::fault();
    figures::start();
    let mut counter = Counter::new();
    let outcome = run(&mut counter);
    let is_success = outcome.is_ok();
    runs::show(name, outcome);
    counter.print(T::NAME, name);
    for (name, value) in [("stack ", board::stack()), ("ram ", size_of::<S>() as u32)] {
        print::text(name);
        print::number(value);
        print::line("");
    }
    print::line("end");
    board::exit(is_success)
}
