//! The arguments: all commands of `gyro`, and those of developers.

use clap::{Args, Parser, Subcommand};
use gyro_cli::{Common, EXIT_CODES, VERSION};
use std::path::PathBuf;

/// From a model file of bodies and joints to Rust code and to plots.
#[derive(Debug, Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask", version = VERSION, after_help = EXIT_CODES)]
pub(crate) struct Cli {
    #[command(flatten)]
    pub(crate) common: Common,
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    #[command(flatten)]
    Gyro(Box<gyro_cli::Command>),
    Performance(PerformanceArgs),
    Embedded(EmbeddedArgs),
    Release(ReleaseArgs),
}

/// Check that all crates can be published
///
/// The tree has no changes, the changelog has the version, each manifest says what its crate is, all crates pass
/// `cargo publish --dry-run` together, and the library of the run time is small. Publishes nothing, and says how that
/// is done.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  cargo xtask release
  cargo xtask release --allow-dirty --no-build    while working on a manifest")]
pub(crate) struct ReleaseArgs {
    /// Check manifests and packages only: the tree may have changes, and the changelog no version
    #[arg(long)]
    pub(crate) allow_dirty: bool,
    /// Pack the crates, but do not build what was packed
    #[arg(long)]
    pub(crate) no_build: bool,
}

/// Measure generated code and write the tables of docs/performance.md
///
/// Times every kernel of the paper's scene beside a floor derived by hand and the forms of the runtime-assembled
/// model, in turns in one process; counts instructions where valgrind is installed; generates, compiles and runs
/// chains of more and more bodies. Everything is optimised. Takes several minutes; keep the machine otherwise idle.
#[derive(Debug, Args)]
pub(crate) struct PerformanceArgs {
    /// Document whose tables are replaced [default: docs/performance.md]
    #[arg(long, value_name = "FILE.md")]
    pub(crate) out: Option<PathBuf>,
    /// Number of bodies of the longest chain; 0 skips the chains and their table
    #[arg(long, value_name = "N", default_value_t = 256)]
    pub(crate) bodies: usize,
    /// Measure only packs of lanes and keep the other tables
    #[arg(long, conflicts_with = "bodies")]
    pub(crate) only_lanes: bool,
    /// Measure only chains and keep the other tables
    #[arg(long, conflicts_with = "only_lanes")]
    pub(crate) only_chains: bool,
}

/// Run the firmware and write docs/embedded.md
///
/// Builds the firmware in embedded/ for a Cortex-M7 and a Cortex-M4F, runs it under QEMU, compares every bit with the
/// same runs on this machine, proves by the linker that nothing panics or allocates, and writes the tables of
/// docs/embedded.md anew. The tools come from embedded/setup.sh; nothing is fetched here.
#[derive(Debug, Args)]
pub(crate) struct EmbeddedArgs {
    /// Document whose tables are replaced [default: docs/embedded.md]
    #[arg(long, value_name = "FILE.md")]
    pub(crate) out: Option<PathBuf>,
    /// Print the tables instead, and write nothing
    #[arg(long, conflicts_with = "out")]
    pub(crate) print: bool,
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_commands_are_consistent() {
        Cli::command().debug_assert();
    }

    /// Including those of `gyro`.
    #[test]
    fn examples_of_all_commands_name_cargo_xtask() {
        let mut command = gyro_cli::named(Cli::command());
        let simulate = command.find_subcommand_mut("simulate").expect("a command of `gyro`");
        assert!(
            simulate.render_help().to_string().contains("\n  cargo xtask simulate models/gyroscope.toml\n")
        );
    }
}
