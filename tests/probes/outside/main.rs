//! Runs both mechanisms and prints their states, digit for digit.

#[allow(warnings, clippy::all, reason = "generated")]
mod generated {
    include!(concat!(env!("OUT_DIR"), "/double_pendulum.rs"));
    include!(concat!(env!("OUT_DIR"), "/chain.rs"));
}

#[allow(warnings, clippy::all, reason = "generated: it is enough that it compiles")]
mod odd_names {
    include!(concat!(env!("OUT_DIR"), "/odd_names.rs"));
}

use generated::{chain::Chain, double_pendulum::DoublePendulum};
use gyro_sim::{CorrectedDynamics, Error, Partition, Partitioned};

fn run<M: Partition<Scalar = f64> + CorrectedDynamics>(mechanism: &M, corrections: u32) -> Result<(), Error> {
    let mut state = mechanism.start();
    let mut solver = Partitioned::new(mechanism, &state);
    for interval in 0..corrections {
        solver.advance(mechanism, f64::from(interval) * 5e-3, 1e-3, 5, &mut state)?;
    }
    println!("{:?}", state.as_ref());
    Ok(())
}

fn main() -> Result<(), Error> {
    let mut pendulum = DoublePendulum::<f64>::default();
    assert!(DoublePendulum::<f64>::PARAMETERS == ["bob_mass"] && pendulum.set_parameter(0, 0.35));
    run(&pendulum, 100)?;
    run(&Chain::<f64>::default(), 10)
}
