//! The balancing robot: the bits of its run, what its ticks take, and its memory.

use crate::figures::{self, Counter};
use crate::{board, panic, print, runs};
use embedded_scenes::balancer::{self, Balancer, NAME};
use embedded_scenes::runs::Bits;

/// The run in one precision.
pub fn run<T: Bits>() -> ! {
    panic::fault();
    figures::start();
    let mut counter = Counter::new();
    let outcome = balancer::run::<T, _>(&mut counter);
    let is_success = outcome.is_ok();
    runs::show(NAME, outcome);
    counter.print(T::NAME, NAME);
    for (name, value) in [("stack ", board::stack()), ("ram ", size_of::<Balancer<T>>() as u32)] {
        print::text(name);
        print::number(value);
        print::line("");
    }
    print::line("end");
    board::exit(is_success)
}
