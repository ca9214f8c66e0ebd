use super::*;

#[test]
fn options_of_other_programs_are_understood() {
    for (words, meant) in [
        (["gyro", "simulate", "--duration"], Some("--t-end")),
        (["gyro", "simulate", "--dt"], Some("--step")),
        (["gyro", "simulate", "--integratr"], Some("--integrator")),
        (["gyro", "show", "--stop-time"], Some("--t-end")),
        (["gyro", "simulate", "--colour"], None),
    ] {
        let error = Cli::command().try_get_matches_from(words).expect_err("an unknown option");
        let error = with_suggestion(error, Cli::command(), words.iter().map(OsStr::new));
        let offered = match error.get(ContextKind::SuggestedArg) {
            Some(ContextValue::String(offered)) => Some(offered.as_str()),
            _ => None,
        };
        assert_eq!(offered, meant, "{words:?}: {error}");
    }
}

/// Each example is a command line of the program that was called, whichever that is.
#[test]
fn examples_name_the_program_that_was_called() {
    for name in ["gyro", "cargo xtask"] {
        let mut examples = 0;
        for subcommand in named(Cli::command().bin_name(name)).get_subcommands_mut() {
            let (command, help) =
                (subcommand.get_name().to_owned(), subcommand.render_long_help().to_string());
            assert!(!help.contains(PROGRAM), "{help}");
            assert_eq!(help.contains("cargo xtask"), name == "cargo xtask", "{help}");
            examples += help.matches(&format!("\n  {name} {command}")).count();
        }
        assert!(examples > 20, "{examples} examples of {name}");
    }
}
