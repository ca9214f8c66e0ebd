//! Good studies and bad ones.

mod random;

use super::*;
use crate::{Distribution, Draw};
use gyro_runner::Between;

struct Bench;

fn setters(path: &str) -> Vec<Setter> {
    let kind = match path {
        "closed.toml" => SetterKind::Controller,
        "touching.toml" => SetterKind::Contact,
        "kinked.toml" => SetterKind::Lines,
        _ => return Vec::new(),
    };
    vec![Setter { kind, name: "hold".to_owned(), inputs: vec![1] }]
}

impl Files for Bench {
    type Error = String;

    fn model(&mut self, path: &str) -> Result<Vocabulary, String> {
        if !["m.toml", "closed.toml", "touching.toml", "kinked.toml", "rough.toml"].contains(&path) {
            return Err(format!("no {path}"));
        }
        let named = |name: &str, of| Named { name: name.to_owned(), unit: "rad".to_owned(), of };
        let start = Named { name: "hinge".to_owned(), unit: "rad".to_owned(), of: Target::Start(0, 0) };
        Ok(Vocabulary {
            parameters: vec![("mass".to_owned(), 2.0), ("length".to_owned(), 0.5)],
            inputs: vec![("motor".to_owned(), 0.0), ("brake".to_owned(), 0.0)],
            setters: setters(path),
            starts: vec![start],
            driven: vec![("crank".to_owned(), "motor".to_owned())],
            rough: if path == "rough.toml" {
                ["hinge", "link"].iter().zip(0..).map(|(name, joint)| rough(name, joint)).collect()
            } else {
                Vec::new()
            },
            columns: vec![
                named("hinge", Quantity::Position(0)),
                named("hinge rate", Quantity::Rate(0)),
                named("constraint violation", Quantity::Violation),
            ],
        })
    }

    fn table(&mut self, input: usize, path: &str) -> Result<Input, String> {
        let rows = vec![[0.0, 1.0], [1.0, 2.0]];
        if path == "a.csv" {
            Ok(Input::new(input, rows, Between::Held))
        } else {
            Err("no such file".to_owned())
        }
    }
}

fn rough(name: &str, joint: usize) -> Named<(usize, usize)> {
    Named { name: name.to_owned(), unit: "rad".to_owned(), of: (joint, 0) }
}

/// What is set stays, so that nothing is to be said of it.
#[test]
fn moves_are_kept_of_rough_starts_that_do_not_vary() {
    let text = format!("{HEAD}{KEEP}vary = [{{ start = \"hinge\", uniform = [0, 1] }}]");
    let study = study(&text.replace("m.toml", "rough.toml"));
    assert_eq!(study.keep.moved, [(1, 0)]);
    let names: Vec<&str> = study.numbers.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["hinge final", "link moved at start"]);
    assert_eq!((study.keep.numbers(), study.keep.sloped_numbers()), (2, 1));
}

const HEAD: &str = "format = 1\nmodel = \"m.toml\"\nscenarios = 10\n";
const KEEP: &str = "keep = { final = \"hinge\" }\n";

fn study(text: &str) -> Study {
    match read("s.toml", text, &mut Bench) {
        Ok(study) => study,
        Err(Unreadable::Study(mistakes)) => panic!("{mistakes}"),
        Err(Unreadable::Model(words)) => panic!("{words}"),
    }
}

#[test]
fn everything_can_be_said() {
    let study = study(
        r#"
        format = 1
        model = "m.toml"
        scenarios = 1_000
        seed = 7
        sampling = "sobol"
        block = 16
        run = { t_end = 2, tolerance = 1e-6, integrator = "dop853", coordinates = "joint", every = 0.1 }
        [[vary]]
        parameter = ["mass", "length"]
        covariance = [[0.04, 0.01], [0.01, 0.09]]
        mean = [2, 0.6]
        [[vary]]
        input = "motor"
        tables = ["a.csv", "a.csv"]
        [[vary]]
        start = "hinge"
        log_grid = [0.01, 1, 3]
        [keep]
        final = ["hinge"]
        extremes = "hinge rate"
        passages = [{ of = "hinge", above = 0.5 }]
        quantiles = "hinge"
        series = ["hinge rate", "hinge"]
        estimate = true
        "#,
    );
    assert_eq!((study.plan.grid(), study.plan.scenarios()), (6, 6000));
    assert!((study.plan.axes[1].rows[1][0] - 0.1).abs() < 1e-15);
    assert_eq!((study.plan.seed, study.plan.sampling, study.block), (7, Sampling::Sobol, 16));
    let names: Vec<&str> = study.numbers.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(
        names,
        ["hinge final", "hinge rate min", "hinge rate max", "hinge above 0.5", "estimated error"]
    );
    assert_eq!((study.series.len(), study.quantiles, study.has_series), (2, 1, true));
    assert_eq!(study.keep.numbers(), names.len());
    assert_eq!(study.targets[3].0, "hinge start");
    assert!(
        matches!(&study.plan.targets[2], Target::Table(tables) if tables.len() == 2 && tables[0].index == 0)
    );
}

#[test]
fn derivatives_are_by_all_that_varies() {
    let study = study(&format!(
        "{HEAD}run = {{ coordinates = \"joint\" }}\n\
         keep = {{ final = \"hinge\", extremes = \"hinge rate\", estimate = true, sensitivities = true }}\n\
         vary = [{{ parameter = \"mass\", within = 0.1 }}, {{ start = \"hinge\", values = [0, 1] }}]"
    ));
    assert_eq!((study.keep.by.len(), study.keep.slopes(), study.slopes.len()), (2, 6, 6));
    assert_eq!(study.slopes[1].0, "d hinge final / d hinge start");
    assert_eq!(study.keep.width(5), 4 + 6);
    assert!(!study.has_series && study.series_slopes.is_empty());
}

/// Those of series are kept of what is kept for itself; a constraint's violation is rounding and has none.
#[test]
fn series_have_derivatives_and_quantiles_have_none() {
    let study = study(&format!(
        "{HEAD}run = {{ coordinates = \"joint\" }}\n\
         vary = [{{ parameter = \"mass\", within = 0.1 }}, {{ start = \"hinge\", values = [0, 1] }}]\n\
         [keep]\nquantiles = [\"hinge rate\", \"hinge\"]\n\
         series = [\"constraint violation\", \"hinge\"]\nsensitivities = true"
    ));
    let names: Vec<&str> = study.series_slopes.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["d hinge / d mass", "d hinge / d hinge start"]);
    assert!(study.has_series && study.slopes.is_empty());
    assert_eq!((study.series.len(), study.keep.sloped.len()), (3, 1));
    assert_eq!(study.keep.width(5), (3 + 2) * 5);
}

#[test]
fn within_is_about_the_models_value() {
    let study =
        study(&format!("{HEAD}{KEEP}vary = [{{ parameter = [\"mass\", \"length\"], within = 0.1 }}]"));
    let expected = [[1.9, 2.1], [0.4, 0.6]];
    for (draw, [from, to]) in study.plan.draws.iter().zip(expected) {
        let Draw::Alone { distribution: Distribution::Uniform(range), .. } = draw else { panic!("{draw:?}") };
        assert!((range[0] - from).abs() < 1e-15 && (range[1] - to).abs() < 1e-15);
    }
}

/// Each mistake is shown at its line, with what to write.
#[test]
fn mistakes_name_their_line_and_the_cure() {
    let vary = |how: &str| format!("{HEAD}{KEEP}vary = [{{ parameter = \"mass\", {how} }}]");
    let sensitive = |run: &str, how: &str| {
        let keep = KEEP.replace('}', ", sensitivities = true }");
        let run = if run.is_empty() {
            String::new()
        } else {
            format!("run = {{ coordinates = \"joint\", {run} }}\n")
        };
        format!("{HEAD}{keep}vary = [{{ parameter = \"mass\", {how} }}]\n{run}")
    };
    for (text, place, words) in [
        (vary("unifrom = [1, 2]"), "s.toml:5", "write `uniform`"),
        (vary("uniform = [2, 1]"), "s.toml:5", "write the smaller number first"),
        (vary("uniform = [1, 2], normal = [1, 2]"), "s.toml:5", "write exactly one of them"),
        (vary("normal = [1, 0]"), "s.toml:5", "a standard deviation is above zero"),
        (vary("uniform = [0, 1], truncated = [0, 1]"), "s.toml:5", "`truncated` belongs to `normal`"),
        (vary("log_uniform = [-1, 1]"), "s.toml:5", "a logarithm is of positive numbers"),
        (vary("grid = [0, 1]"), "s.toml:5", "the first, the last and how many"),
        (vary("grid = [0, 1, 1]"), "s.toml:5", "how many from 2 to 1e6"),
        (vary("values = \"many\""), "s.toml:5", "`values` must be an array of numbers"),
        (vary("tables = [\"a.csv\"]"), "s.toml:5", "write input = "),
        (vary("covariance = [[-1]]"), "s.toml:5", "positive definite"),
        (vary("uniform = [0, inf]"), "s.toml:5", "two numbers"),
        (vary("uniform = [0, 1]").replace("mass", "mas"), "s.toml:5", "write `mass`"),
        (vary("uniform = [0, 1]").replace("hinge", "hing"), "s.toml:4", "write `hinge`"),
        (vary("uniform = [0, 1]").replace("format = 1", "format = 2"), "s.toml:1", "write format = 1"),
        (vary("uniform = [0, 1]").replace("scenarios = 10", ""), "s.toml:1", "write scenarios = 1000"),
        (vary("uniform = [0, 1]").replace("scenarios = 10", "scenarios = 0"), "s.toml:3", "above zero"),
        (vary("uniform = [0, 1]").replace("scenarios", "szenarios"), "s.toml:3", "write `scenarios`"),
        (vary("uniform = [0, 1]") + "\nrun = { step = 1, tolerance = 1 }", "s.toml:6", "remove `step`"),
        (vary("uniform = [0, 1]") + "\nrun = { integrator = \"rk\" }", "s.toml:6", "write `rk4`"),
        (vary("grid = [0, 1, 2]") + "\nsampling = \"saltelli\"", "s.toml:6", "with a grid"),
        (vary("uniform = [0, 1]") + "\nblock = 100_000", "s.toml:6", "too large"),
        (vary("uniform = [0, 1]") + "\nblock = \n", "s.toml:6", "cannot be read"),
        (format!("{HEAD}{KEEP}vary = [{{ start = \"hinge\", within = 1 }}]"), "s.toml:5", "a start has none"),
        (
            format!("{HEAD}{KEEP}vary = [{{ start = \"crank\", uniform = [0, 1] }}]"),
            "s.toml:5",
            "the driver `motor` says where this starts",
        ),
        (format!("{HEAD}{KEEP}vary = [{{ input = \"motor\", tables = \"b\" }}]"), "s.toml:5", "no such file"),
        (format!("{HEAD}vary = []\nkeep = {{ }}"), "s.toml:5", "nothing is kept"),
        (format!("{HEAD}vary = []\n{KEEP}").replace("final", "passages"), "s.toml:5", "an array of tables"),
        (
            sensitive("t_end = 1", "uniform = [0, 1]").replace("\"joint\"", "\"maximal\""),
            "s.toml:4",
            "write run = { coordinates = \"joint\" }",
        ),
        (
            sensitive("integrator = \"rodas4\"", "uniform = [0, 1]"),
            "s.toml:4",
            "write integrator = \"dop853\"",
        ),
        (
            sensitive("", "tables = \"a.csv\"").replace("parameter = \"mass\"", "input = \"motor\""),
            "s.toml:4",
            "no derivative",
        ),
        (
            sensitive("", "uniform = [0, 1]").replace("final", "quantiles"),
            "s.toml:4",
            "write final, extremes",
        ),
        (sensitive("", "").replace("{ parameter = \"mass\",  }", ""), "s.toml:4", "nothing varies"),
        (sensitive("", "uniform = [0, 1]").replace("true", "1"), "s.toml:4", "true or false"),
        (sensitive("", "uniform = [0, 1]").replace("m.toml", "closed.toml"), "s.toml:4", "controllers close"),
        (
            format!("{HEAD}{KEEP}vary = [{{ input = \"brake\", values = [1] }}]")
                .replace("m.toml", "closed.toml"),
            "s.toml:5",
            "the controller `hold` sets this input",
        ),
        (sensitive("", "uniform = [0, 1]").replace("m.toml", "touching.toml"), "s.toml:4", "rigid stops"),
        (sensitive("", "uniform = [0, 1]").replace("m.toml", "kinked.toml"), "s.toml:4", "jump in velocity"),
        (
            format!("{HEAD}{KEEP}vary = [{{ input = \"brake\", values = [1] }}]")
                .replace("m.toml", "touching.toml"),
            "s.toml:5",
            "the contact `hold` sets this input",
        ),
    ] {
        let Err(Unreadable::Study(mistakes)) = read("s.toml", &text, &mut Bench) else {
            panic!("no mistake in\n{text}")
        };
        let shown = mistakes.render();
        assert!(shown.contains(place) && shown.contains(words), "{text}\n{shown}");
    }
}

#[test]
fn what_is_wrong_with_the_model_is_told_as_it_is() {
    let text = format!("{HEAD}{KEEP}vary = []").replace("m.toml", "n.toml");
    assert!(
        matches!(read("s.toml", &text, &mut Bench), Err(Unreadable::Model(words)) if words == "no n.toml")
    );
}
