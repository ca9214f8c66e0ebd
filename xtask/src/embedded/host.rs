//! The same runs on this machine: what the firmware must print, bit for bit.

use super::output::{Output, Run};
use super::{folder, target};
use gyro_cli::failure::Failure;
use gyro_cli::programs::{self, output};
use gyro_cli::progress::Spinner;
use std::path::Path;
use std::process::Command;

/// What the host printed.
pub(crate) struct Expected(Vec<Run>);

/// Builds the runs for this machine, as it is and with all that its processor can do, and runs them: the bits must not
/// depend on it.
pub(crate) fn run() -> Result<Expected, Failure> {
    let _spinner = Spinner::new("building and running on the host".to_owned());
    let plain = with("host", "")?;
    let native = with("host-native", "-Ctarget-cpu=native")?;
    let expected = Expected(plain.runs);
    expected
        .compare(&[&native])
        .map_err(|words| Failure::Run(format!("this machine with `-Ctarget-cpu=native`: {words}")))?;
    Ok(expected)
}

/// A build of its own: in the main workspace, features of others would be on.
fn with(name: &str, flags: &str) -> Result<Output, Failure> {
    let target = target().join(name);
    let mut command = cargo("build", flags);
    command.args(["--release", "--package", "embedded-host", "--target-dir"]).arg(&target);
    output(&mut command)?;
    let program = Path::new("release").join(format!("embedded-host{}", std::env::consts::EXE_SUFFIX));
    let text = output(&mut Command::new(target.join(program)))?;
    Output::parse(&text).map_err(Failure::Run)
}

/// A command of Cargo for this machine, on the firmware's workspace.
pub(crate) fn cargo(subcommand: &str, flags: &str) -> Command {
    let mut command = Command::new(programs::cargo());
    command.args([subcommand, "--quiet", "--locked"]).env("RUSTFLAGS", flags);
    for name in ["CARGO_BUILD_TARGET", "CARGO_ENCODED_RUSTFLAGS", "RUSTC_BOOTSTRAP"] {
        command.env_remove(name);
    }
    command.current_dir(folder());
    command
}

impl Expected {
    /// Whether these runs, one at least, have the bits of this machine.
    pub(crate) fn has(&self, runs: &[Run]) -> Result<(), String> {
        if runs.is_empty() {
            return Err("no run at all".to_owned());
        }
        runs.iter().try_for_each(|run| self.is_same(run))
    }

    fn is_same(&self, run: &Run) -> Result<(), String> {
        match self.0.iter().find(|own| own.precision == run.precision && own.name == run.name) {
            None => Err(format!("{} {} is not known to the host", run.precision, run.name)),
            Some(own) if own != run => {
                Err(format!("{} {}: {run:x?}, on the host {own:x?}", run.precision, run.name))
            }
            Some(_) => Ok(()),
        }
    }

    /// The number of runs that others made, all with the same bits; or the first that differs or is missing.
    pub(crate) fn compare(&self, others: &[&Output]) -> Result<usize, String> {
        let made: Vec<&Run> = others.iter().flat_map(|output| &output.runs).collect();
        made.iter().try_for_each(|run| self.is_same(run))?;
        for precision in made.iter().map(|run| &run.precision) {
            let n = |runs: &mut dyn Iterator<Item = &Run>| runs.filter(|r| r.precision == *precision).count();
            let (here, there) = (n(&mut self.0.iter()), n(&mut made.iter().copied()));
            if here != there {
                return Err(format!("{there} runs in {precision}, on the host {here}"));
            }
        }
        if made.is_empty() { Err("no runs at all".to_owned()) } else { Ok(made.len()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn output(text: &str) -> Output {
        Output::parse(text).unwrap()
    }

    #[test]
    fn one_bit_or_one_run_makes_a_difference() {
        let text = "run f64 a joint 01 02 03 04\nrun f64 b joint 01 02 03 04\nrun f32 a joint 0 1 2 3\n";
        let expected = Expected(output(text).runs);
        let of_f64 = "run f64 a joint 01 02 03 04\nrun f64 b joint 01 02 03 04\n";
        assert_eq!(expected.compare(&[&output(of_f64)]), Ok(2));
        let differs = of_f64.replacen("03", "13", 1);
        assert!(expected.compare(&[&output(&differs)]).unwrap_err().starts_with("f64 a joint"));
        let digest = of_f64.replacen("01", "00", 1);
        assert!(expected.compare(&[&output(&digest)]).is_err());
        assert!(expected.compare(&[&output("run f64 a joint 01 02 03 04\n")]).is_err());
        assert!(expected.compare(&[&output("run f64 c joint 01 02 03 04\n")]).is_err());
        assert!(expected.compare(&[&output("")]).is_err());
    }
}
