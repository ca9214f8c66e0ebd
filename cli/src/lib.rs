//! The command line of the project, as a library: `gyro` is a binary of it, and `cargo xtask` adds the commands of
//! those who develop the project. What is public besides [`Cli`] and [`Command`] is for these.
#![cfg_attr(not(feature = "reports"), allow(dead_code, reason = "reports alone use some of it"))]

#[cfg(feature = "reports")]
mod answer;
mod args;
#[cfg(feature = "jit")]
mod batches;
mod cache;
pub mod chain;
mod check;
mod choice;
mod closed_loop;
mod columns;
mod compare;
mod contacts;
mod controllers;
mod eigenvalues;
mod equilibrium;
mod events;
mod export;
pub mod failure;
pub mod files;
mod fit;
mod folder;
mod formulas;
pub mod generate;
mod in_process;
mod inputs;
mod inspect;
mod interrupt;
mod invocation;
mod json;
mod kinks;
mod lapse;
mod left_out;
#[cfg(feature = "jit")]
pub mod library;
mod linear;
mod linearization;
pub mod machine;
pub mod machine_code;
mod nested;
mod new;
mod paths;
pub mod places;
mod plot;
pub mod programs;
pub mod progress;
mod proof;
mod remarks;
#[cfg(feature = "reports")]
mod report;
mod rolling;
mod rounding;
mod runs;
mod runtime;
mod scene;
mod schema;
mod show;
mod side_by_side;
mod simulate;
mod spectrum;
mod stability;
mod summary;
mod sweep;
mod urdf;
mod variants;
mod verdict;
mod verify;
mod words;
pub mod write;

pub use args::{Cli, Command, Common, EXIT_CODES, VERSION};
use failure::Failure;
pub use invocation::{named, parse};

impl Command {
    /// Runs the command.
    ///
    /// # Errors
    /// If the request is invalid, or the command fails.
    pub fn run(&self) -> Result<(), Failure> {
        match self {
            Self::New(args) => new::new(args),
            Self::Check(args) => check::check(args),
            Self::Schema(args) => schema::schema(args),
            Self::Generate(args) => generate::generate(args),
            Self::Simulate(args) => simulate::simulate(args),
            Self::Sweep(args) => sweep::sweep(args),
            Self::Show(args) => show::show(args),
            Self::Export(args) => export::export(args),
            Self::Inspect(args) => inspect::inspect(args),
            Self::Import(args) => urdf::import(args),
            Self::Verify(args) => verify::verify_models(args),
            #[cfg(feature = "reports")]
            Self::Report(args) => report::report(args),
            #[cfg(not(feature = "reports"))]
            Self::Report(_) => {
                Err(Failure::Usage("this program was built without the feature `reports`".to_owned()))
            }
            Self::Cache(args) => cache::cache(args),
            Self::Completions(args) => invocation::completions(args),
            #[cfg(feature = "reports")]
            Self::Answer(args) => answer::answer(args),
        }
    }
}
