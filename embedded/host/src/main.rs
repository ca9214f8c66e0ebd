//! What the firmware must print: the same runs on this machine.

use embedded_scenes::kernels::{Clock, Work};
use embedded_scenes::runs::{Bits, Outcome, runs};
use embedded_scenes::{balancer, quadruped, stabilised};
use std::process::ExitCode;

fn main() -> ExitCode {
    match print::<f32>().and_then(|()| print::<f64>()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn print<T: Bits>() -> Result<(), gyro_sim::contact::Error> {
    for (name, run) in runs::<T>() {
        show(name, run()?);
    }
    show(balancer::NAME, balancer::run::<T, _>(&mut Uncounted)?);
    show(quadruped::NAME, quadruped::run::<T, _>(&mut Uncounted)?);
    show(stabilised::NAME, stabilised::run::<T, _>(&mut Uncounted)?);
    Ok(())
}

fn show<T: Bits>(name: &str, outcome: Outcome<T>) {
    print!("run {} {name} {:016x}", T::NAME, outcome.digest);
    outcome.joints.iter().for_each(|x| print!(" {:016x}", x.bits()));
    println!();
}

/// Nothing is measured here.
struct Uncounted;

impl Clock for Uncounted {
    fn time<R>(&mut self, _: Work, run: impl FnOnce() -> R) -> R {
        run()
    }
}
