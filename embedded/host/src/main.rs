//! What the firmware must print: the same runs on this machine.

use embedded_scenes::runs::{Bits, runs};
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

fn print<T: Bits>() -> Result<(), gyro_sim::Error> {
    for (name, run) in runs::<T>() {
        let outcome = run()?;
        print!("run {} {name} {:016x}", T::NAME, outcome.digest);
        outcome.joints.iter().for_each(|x| print!(" {:016x}", x.bits()));
        println!();
    }
    Ok(())
}
