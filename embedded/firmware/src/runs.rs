//! Prints the bits of every run; the host prints the same.

use crate::{board, panic, print};
use embedded_scenes::runs::{Bits, runs};

/// All runs in one precision.
pub fn run<T: Bits>() -> ! {
    panic::fault();
    for (name, run) in runs::<T>() {
        print::text("run ");
        print::text(T::NAME);
        print::text(" ");
        print::text(name);
        match run() {
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
    print::line("end");
    board::exit(true)
}
