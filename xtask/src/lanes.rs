//! The table of packs of lanes: measured by a program that is compiled for this machine's own processor.

use gyro_cli::failure::Failure;
use gyro_cli::programs::{built, folder, output, three};
use gyro_cli::progress::Spinner;
use std::fmt::Write as _;
use std::process::Command;

/// What only a build for this very processor uses.
const FLAGS: &str = "-C target-cpu=native";

/// Builds, measures and writes the table.
pub(crate) fn table() -> Result<String, Failure> {
    let program = built("lanes", |cargo| {
        cargo.env("RUSTFLAGS", FLAGS).env("CARGO_TARGET_DIR", folder().join("native"));
    })?;
    let _spinner = Spinner::new("measuring packs of lanes against scalar runs".to_owned());
    let rows = output(&mut Command::new(program))?;
    let mut text = format!(
        "Both sides are compiled with `{FLAGS}`: {}.\n\n| | pack | scalar runs, µs | pack, µs | times as fast |\n|---|---|---|---|---|\n",
        features()?
    );
    let mut last = "";
    for line in rows.lines() {
        let (what, row) = row(line).ok_or_else(|| {
            Failure::Run(format!("the bench printed what this command does not know: {line}"))
        })?;
        let _ = writeln!(text, "| {} | {row} |", if what == last { "" } else { what });
        last = what;
    }
    Ok(text)
}

/// What a line of benches/lanes.rs measures, and the cells of its row.
fn row(line: &str) -> Option<(&str, String)> {
    let [what, pack, scalar, packed, gain] = line.split('\t').collect::<Vec<_>>().try_into().ok()?;
    let [scalar, packed, gain] = [scalar, packed, gain].map(str::parse::<f64>);
    let (scalar, packed, gain) = (scalar.ok()? / 1e3, packed.ok()? / 1e3, gain.ok()?);
    Some((what, format!("{pack} | {} | {} | {gain:.1}", three(scalar), three(packed))))
}

/// The vector instructions that the flags allow, as rustc names them.
fn features() -> Result<String, Failure> {
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let printed = output(Command::new(rustc).args(["--print", "cfg"]).args(FLAGS.split(' ')))?;
    let names = printed.lines().filter_map(|line| line.strip_prefix("target_feature=\"")?.strip_suffix('"'));
    let vectors = ["sse4.2", "avx", "avx2", "avx512f", "fma", "neon"];
    let found: Vec<_> = names.filter(|name| vectors.contains(name)).collect();
    Ok(if found.is_empty() { "no vector instructions".to_owned() } else { found.join(", ") })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_read_whole_or_not_at_all() {
        let (what, cells) = row("newton\tf64x8\t1200.00\t200.00\t6.000").unwrap();
        assert_eq!((what, cells.as_str()), ("newton", "f64x8 | 1.20 | 0.20 | 6.0"));
        assert!(row("newton\tf64x8\t1200.00").is_none());
    }
}
