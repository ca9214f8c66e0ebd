use super::*;
use crate::args::{Cli, Command, Engine};
use clap::Parser;
use gyro_runner::Settings;

const PAGE: &str = r#"format = 1
name = "pendulum"
[[body]]
name = "ground"
fixed = true
[[body]]
name = "bob"
mass = 1
inertia = [1, 1, 1]
[[joint]]
name = "pivot"
kind = "revolute"
axis = [0, 0, 1]
zero = [1, 0, 0]
first = { body = "ground" }
second = { body = "bob", point = [0, 1, 0] }
[simulation]
"#;

/// Each line of a list, or none of them.
fn or_none<'t>(all: &[&'t str]) -> Vec<&'t str> {
    std::iter::once("").chain(all.iter().copied()).collect()
}

/// All texts made of one of each list.
fn combined(lists: &[Vec<&str>]) -> Vec<String> {
    let mut all = vec![String::new()];
    for list in lists {
        all = all.iter().flat_map(|text| list.iter().map(move |one| format!("{text}{one}"))).collect();
    }
    all
}

fn args(options: &str) -> SimulateArgs {
    let words = ["gyro", "simulate", "x.toml"].into_iter().chain(options.split_whitespace());
    match Cli::try_parse_from(words) {
        Ok(Cli { command: Command::Simulate(args), .. }) => args,
        other => panic!("{options}: {other:?}"),
    }
}

/// Contradictions of what is typed alone, written down from what the options mean.
fn is_contradictory(args: &SimulateArgs, offers: &Offers) -> bool {
    let coordinates = args.coordinates;
    (args.tolerance.is_some() && args.integrator() == Some(Integrator::Rk4))
        || (coordinates == Some(Coordinates::Joint) && !offers.joint_space)
        || (args.integrator() == Some(Integrator::Rodas4) && !offers.derivatives)
        || (offers.touches && !offers.joint_space)
        || (args.tolerance.is_some_and(|tolerance| tolerance < offers.finest_tolerance()))
}

/// Contradictions of a file with its own mechanism.
fn is_unfit(page: &Simulation, args: &SimulateArgs, offers: &Offers) -> bool {
    let of_page = |word: &str| word == "rodas4" && args.integrator().is_none();
    let is_rodas = args.integrator() == Some(Integrator::Rodas4) || page.method.is_some_and(of_page);
    let is_weighted = page.correction.as_deref() == Some("mass-weighted") && args.correction().is_none();
    let is_maximal = match args.coordinates {
        None => page.coordinates == Some("maximal"),
        typed => typed == Some(Coordinates::Maximal),
    };
    offers.touches && is_maximal && (is_rodas || is_weighted)
}

#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn what_is_typed_counts_then_what_is_written_and_nothing_is_refused_that_could_be_run() {
    let pages = combined(&[
        or_none(&["coordinates = \"joint\"\n", "coordinates = \"maximal\"\n"]),
        or_none(&["method = \"rk4\"\n", "method = \"dop853\"\n", "method = \"rodas4\"\ntolerance = 1e-7\n"]),
        or_none(&["correction = \"none\"\n", "correction = \"mass-weighted\"\n"]),
    ]);
    let options = combined(&[
        or_none(&[" --coordinates joint", " --coordinates maximal"]),
        or_none(&[" --integrator rk4", " --method tsit5", " --integrator rodas4"]),
        or_none(&[" --tolerance 1e-6", " --step 1e-2", " --correct-every 1e-2"]),
        or_none(&[" --correction none", " --method partitioned"]),
    ]);
    let engines: [(Option<Engine>, Offers); 4] = [
        (None, Offers::ALL),
        (Some(Engine::Assembled), Offers { joint_space: false, derivatives: false, ..Offers::ALL }),
        (None, Offers { epsilon: f64::from(f32::EPSILON), ..Offers::ALL }),
        (None, Offers { touches: true, ..Offers::ALL }),
    ];
    let settings = Settings { t_end: 1.0, step: 1e-3, correct_every: None, sample_every: 0.1 };
    let mut refused = 0;
    for page in &pages {
        let model = gyro_model::read("x.toml", &format!("{PAGE}{page}")).unwrap();
        for options in options.iter().filter(|options| options.matches("--method").count() < 2) {
            for (engine, offers) in &engines {
                let args = SimulateArgs { engine: *engine, ..args(options) };
                let (approach, chosen) = choose(&model, &args, offers);
                let of = format!("{page}{options} {engine:?}: {approach} ({chosen})");
                let found = offers.refusal(&settings, &approach);
                let is_impossible =
                    is_contradictory(&args, offers) || is_unfit(&model.simulation, &args, offers);
                assert!(found.is_none() || is_impossible, "{of}: {found:?}");
                refused += usize::from(found.is_some());
                check(&model.simulation, &args, &approach, &of);
            }
        }
    }
    assert!(refused > 100, "{refused}");
}

fn check(page: &Simulation, args: &SimulateArgs, approach: &Approach, of: &str) {
    if let Some(coordinates) = args.coordinates {
        assert_eq!(approach.coordinates, coordinates, "{of}");
    }
    if let Some(integrator) = args.integrator() {
        assert_eq!(approach.integrator, integrator, "{of}");
    }
    let is_fixed = args.step.or(args.correct_every).is_some() || approach.integrator == Integrator::Rk4;
    if args.tolerance.is_some() {
        assert_eq!(approach.tolerance, args.tolerance, "{of}");
    } else {
        assert_eq!(approach.tolerance.is_none(), is_fixed, "{of}");
    }
    if let Some(correction) = args.correction() {
        assert_eq!(approach.correction, correction, "{of}");
    } else if let Some(correction) = &page.correction {
        assert_eq!(approach.correction.to_string(), *correction, "{of}");
    }
    let is_explicit = matches!(approach.integrator, Integrator::Dop853);
    assert!(is_explicit || !approach.leaves_stiff, "{of}");
}

#[test]
fn where_nothing_is_said_it_is_what_an_expert_takes() {
    let model = gyro_model::read("x.toml", &format!("{PAGE}step = 0.1\n")).unwrap();
    let say = |options: &str, offers: &Offers| {
        let (approach, chosen) = choose(&model, &args(options), offers);
        (approach.to_string(), approach.leaves_stiff, chosen.to_string())
    };
    let (approach, leaves, chosen) = say("", &Offers::ALL);
    assert_eq!((approach.as_str(), leaves), ("dop853, joint coordinates, tolerance 1e-9", true));
    let words =
        "joint coordinates, as the mechanism has them; dop853 at a tolerance of 1e-9, as no method is given";
    assert_eq!(chosen, words);
    assert_eq!(say("--step 1e-3", &Offers::ALL).0, "rk4, joint coordinates");
    let assembled = Offers { joint_space: false, derivatives: false, ..Offers::ALL };
    let (approach, leaves, _) = say("--engine assembled", &assembled);
    assert_eq!(approach, "dop853, maximal coordinates, correction partition, tolerance 1e-9");
    assert!(!leaves, "there is nothing to turn to");
    let single = Offers { epsilon: f64::from(f32::EPSILON), ..Offers::ALL };
    assert_eq!(say("--precision f32", &single).0, "dop853, joint coordinates, tolerance 1e-6");
    assert!(!say("", &Offers { touches: true, ..Offers::ALL }).1, "what touches is not stiff for long");
    assert!(!say("--integrator dop853", &Offers::ALL).1, "what is asked for is not left");
}
