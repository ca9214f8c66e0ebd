use super::simulate::MethodName;
use super::*;
use gyro_model::parse_decimal;
use gyro_runner::{Correction, When};

fn simulate(args: &[&str]) -> Result<SimulateArgs, String> {
    let all = ["gyro", "simulate", "x.toml"].iter().chain(args);
    match Cli::try_parse_from(all) {
        Ok(Cli { command: Command::Simulate(args), .. }) => Ok(args),
        Ok(other) => Err(format!("{other:?}")),
        Err(error) => Err(error.to_string()),
    }
}

#[test]
fn every_option_is_read() {
    let args = simulate(&[
        "--engine=assembled",
        "--t-end",
        "2",
        "--step=1e-3",
        "--correct-every",
        "5e-3",
        "--method",
        "direct",
        "--precision",
        "f32",
        "--every",
        ".5",
        "--set",
        "m=-0.1",
        "--set",
        "g=1e1",
        "--input",
        "motor=a=b.csv",
        "--input",
        "brake=-1e-3",
        "--strict",
        "--out",
        "d",
        "--json",
    ])
    .unwrap();
    assert_eq!((args.engine(), args.precision, args.json), (Engine::Assembled, Precision::F32, true));
    assert_eq!((args.t_end, args.step), (Some(2.0), Some(1e-3)));
    assert_eq!((args.correct_every, args.every), (Some(5e-3), Some(0.5)));
    assert_eq!(args.method, Some(MethodName::Kept(Correction::None)));
    assert_eq!(args.set[0], ("m".to_owned(), parse_decimal("-0.1").unwrap()));
    assert_eq!(args.set[1], ("g".to_owned(), parse_decimal("10").unwrap()));
    assert_eq!(args.input[0], ("motor".to_owned(), InputSetting::File(PathBuf::from("a=b.csv"), None)));
    assert_eq!(args.input[1], ("brake".to_owned(), InputSetting::Number(-1e-3)));
    assert!(args.strict);
}

#[test]
fn mistakes_say_what_was_expected() {
    for (args, message) in [
        (&["--step", "-1"][..], "a positive number of seconds was expected"),
        (&["--t-end", "NaN"], "a positive number of seconds was expected"),
        (&["--every", "inf"], "a positive number of seconds was expected"),
        (&["--correct-every", "0"], "a positive number of seconds was expected"),
        (&["--step", "fast"], "a positive number of seconds was expected"),
        (&["--tolerance", "nan"], "a number above 0 and at most 1 was expected"),
        (&["--tolerance", "inf"], "a number above 0 and at most 1 was expected"),
        (&["--tolerance", "-1e-9"], "a number above 0 and at most 1 was expected"),
        (&["--tolerance", "0"], "a number above 0 and at most 1 was expected"),
        (&["--tolerance", ""], "a number above 0 and at most 1 was expected"),
        (&["--tolerance", "1e400"], "a number above 0 and at most 1 was expected"),
        (&["--tolerance", "2"], "a number above 0 and at most 1 was expected"),
        (&["--budget", "0"], "0 is not in 1.."),
        (&["--budget", "-1"], "invalid value"),
        (&["--budget", "nan"], "invalid"),
        (&["--budget", "1e3"], "invalid"),
        (&["--step", "1e400"], "a positive number of seconds was expected"),
        (&["--step", ""], "a positive number of seconds was expected"),
        (&["--linearize", "nan"], "0 or a positive number of seconds was expected"),
        (&["--linearize", "-1"], "0 or a positive number of seconds was expected"),
        (&["--correction", "baumgarte=nan"], "such as baumgarte=100"),
        (&["--correct-when", "violation=1e400"], "such as steps=5"),
        (&["--correct-when", "steps=1e12"], "such as steps=5"),
        (&["--input", "motor=1e400"], "`1e400` is not a finite number"),
        (&["--set", "mass"], "PARAMETER=VALUE was expected"),
        (&["--set", "mass=heavy"], "`heavy` is not a decimal number"),
        (&["--set", "mass=nan"], "`nan` is not a decimal number"),
        (&["--input", "motor"], "NAME=FILE.csv or NAME=NUMBER was expected"),
        (&["--input", "motor="], "a value is missing after `motor=`"),
        (&["--input", "motor=nan"], "`nan` is not a finite number"),
        (&["--integrator", "euler"], "rk4, tsit5, dop853 or rodas4 was expected"),
        (&["--coordinates", "polar"], "maximal or joint was expected"),
        (&["--correction", "baumgarte"], "such as baumgarte=100"),
        (&["--correct-when", "steps=0"], "such as steps=5"),
        (&["--step", "1e-3", "--tolerance", "1e-6"], "cannot be used with"),
        (&["--engine", "steam"], "in-process, generated, assembled"),
        (&["--methd", "direct"], "--method"),
    ] {
        let found = simulate(args).unwrap_err();
        assert!(found.contains(message), "{args:?}: {found}");
    }
}

#[test]
fn advice_can_be_appended_to_any_command() {
    let given =
        ["--step=1e-3", "--correct-every=5e-3", "--method=direct", "--input", "a=1", "--input", "b=2"];
    let advice = ["--step", "1e-4", "--correct-when", "steps=1", "--correction", "partition"];
    let args = simulate(&[&given[..], &advice].concat()).unwrap();
    assert_eq!((args.step, args.correct_every, args.correct_when), (Some(1e-4), None, Some(When::Steps(1))));
    assert_eq!(args.correction(), Some(Correction::Partition));
    assert_eq!(args.input.len(), 2);
}

#[test]
fn the_commands_are_consistent() {
    use clap::CommandFactory;
    Cli::command().debug_assert();
}
