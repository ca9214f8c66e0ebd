//! The tools that `embedded/setup.sh` fetches. Nothing is fetched here.

use super::target;
use gyro_cli::failure::Failure;
use gyro_cli::files;
use gyro_cli::programs::output;
use std::path::PathBuf;
use std::process::Command;

/// Where the tools are.
pub(crate) struct Tools {
    folder: PathBuf,
}

/// What the commands of this module need.
const NEEDED: [&str; 8] = [
    "rustc",
    "cargo",
    "ld.lld",
    "wasm-ld",
    "qemu-system-arm",
    "arm-none-eabi-gcc",
    "arm-none-eabi-objdump",
    "node",
];

impl Tools {
    /// The tools, or a word about what is missing and how to get it.
    pub(crate) fn find() -> Result<Self, Failure> {
        let tools = Self { folder: target().join("tools") };
        let is_missing = |name: &&str| !tools.path(name).is_file();
        let missing: Vec<&str> = NEEDED.into_iter().filter(is_missing).collect();
        if missing.is_empty() && tools.folder.join("complete").is_file() {
            return Ok(tools);
        }
        let what = if missing.is_empty() { "some tools".to_owned() } else { missing.join(", ") };
        Err(Failure::Usage(format!(
            "{what}: not in {}. This fetches them, and installs nothing on this machine:\n    {}",
            tools.folder.display(),
            files::root().join("embedded").join("setup.sh").display(),
        )))
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.join("bin").join(name)
    }

    /// A command of one of them.
    pub(crate) fn command(&self, name: &str) -> Command {
        Command::new(self.path(name))
    }

    /// A command of Cargo for a target without an operating system, on the firmware's workspace; `core` is built from
    /// its source.
    pub(crate) fn cargo(&self, subcommand: &str, triple: &str, linker: &str, flags: &str) -> Command {
        let variable = triple.to_uppercase().replace('-', "_");
        let mut command = self.command("cargo");
        for name in ["RUSTFLAGS", "CARGO_ENCODED_RUSTFLAGS", "RUSTUP_TOOLCHAIN", "RUSTC_WRAPPER"] {
            command.env_remove(name);
        }
        command
            .env("RUSTC", self.path("rustc"))
            // The options that build `core` and note stack sizes are not stable.
            .env("RUSTC_BOOTSTRAP", "1")
            .env(format!("CARGO_TARGET_{variable}_LINKER"), self.path(linker))
            .env(format!("CARGO_TARGET_{variable}_RUSTFLAGS"), flags)
            .current_dir(super::folder())
            .args([subcommand, "--quiet", "--release", "--locked", "-Zbuild-std=core", "--target", triple])
            .arg("--target-dir")
            .arg(target().join("target"));
        command
    }

    /// A line that names their versions.
    pub(crate) fn versions(&self) -> Result<String, Failure> {
        let first = |name: &str| -> Result<String, Failure> {
            let text = output(self.command(name).arg("--version"))?;
            Ok(text.lines().next().unwrap_or_default().trim().to_owned())
        };
        let names = ["rustc", "qemu-system-arm", "arm-none-eabi-gcc", "node"];
        let versions: Result<Vec<String>, Failure> = names.into_iter().map(first).collect();
        Ok(format!("{}.\n", versions?.join("; ")))
    }
}
