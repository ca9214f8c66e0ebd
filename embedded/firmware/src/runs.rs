//! Prints the bits of every run; the host prints the same.

use crate::{board, panic, print};
use embedded_scenes::runs::{Bits, Outcome, runs};

/// All runs in one precision.
pub fn run<T: Bits>() -> ! {
    panic::fault();
    for (name, run) in runs::<T>() {
        show(name, run());
    }
    print::line("end");
    board::exit(true)
}

/// A line: what a run came to.
pub(crate) fn show<T: Bits, E>(name: &str, outcome: Result<Outcome<T>, E>) {
    print::text("run ");
    print::text(T::NAME);
    print::text(" ");
    print::text(name);
    match outcome {
        Ok(outcome) => {
            print::text(" ");
            print::bits(outcome.digest);
            for joint in outcome.joints {
                print::text(" ");
                print::bits(joint.bits());
            }
        }
        Err(_) => print::text(" failed"),
    }
    print::line("");
}
