//! The command line of the project. See `cargo xtask --help`.

mod args;
mod columns;
mod compare;
mod embedded;
mod failure;
mod files;
mod fit;
mod folder;
mod generate;
mod inputs;
mod inspect;
mod json;
mod lanes;
mod linear;
mod linearization;
mod machine_code;
mod nested;
mod performance;
mod places;
mod plot;
mod programs;
mod progress;
mod remarks;
mod report;
mod rounding;
mod scaling;
mod scene;
mod simulate;
mod spectrum;
mod stability;
mod summary;
mod urdf;
mod variants;
mod verdict;
mod verify;
mod words;
mod write;

use args::{Cli, Command};
use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    let outcome = match Cli::parse().command {
        Command::Generate(args) => generate::generate(&args),
        Command::Simulate(args) => simulate::simulate(&args),
        Command::Inspect(args) => inspect::inspect(&args),
        Command::Import(args) => urdf::import(&args),
        Command::Performance(args) => performance::performance(&args),
        Command::Report(args) => report::report(&args),
        Command::Embedded(args) => embedded::embedded(&args),
        Command::Verify(args) => verify::verify_models(&args),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}
