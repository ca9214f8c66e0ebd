//! A sample of random model files is generated and proved.
//! `cargo run --release -p gyro-pages --example pages -- --count 10000` does more.

use gyro_model::Number;
use gyro_verifier::{Depth, verify};

/// Seeds of the sample. Any will do: model files are short, and a few of a thousand take long.
const SEEDS: std::ops::Range<u64> = 2000..2009;

/// What is wrong with a model file; nothing if it is generated and proved.
fn refused(seed: u64) -> Option<String> {
    let text = gyro_pages::page(seed);
    let model = match gyro_model::read_with("page.toml", &text, &mut gyro_pages::load) {
        Ok(model) => model,
        Err(problems) => return Some(format!("{problems}")),
    };
    let module = match gyro_codegen::generate_functions("page.toml", &model, &gyro_codegen::Functions::all())
    {
        Ok(module) => module,
        Err(error) => return Some(format!("{error}")),
    };
    let report = verify(&model, &module.code, &module.constants, Depth::Quick);
    (!report.is_proved()).then(|| format!("{report}"))
}

#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn random_pages_are_proved() {
    let half = |parity: u64| move |seed: &u64| seed % 2 == parity;
    let all = |parity| {
        SEEDS.filter(half(parity)).filter_map(|seed| Some((seed, refused(seed)?))).collect::<Vec<_>>()
    };
    let refused = std::thread::scope(|scope| {
        let threads = [0, 1].map(|parity| scope.spawn(move || all(parity)));
        threads.map(|thread| thread.join().expect("no panic")).concat()
    });
    let words: Vec<_> = refused.iter().map(|(seed, why)| format!("model file {seed}: {why}")).collect();
    assert!(words.is_empty(), "{} of {} model files:\n{}", words.len(), SEEDS.count(), words.join("\n"));
}

/// The same seed gives the same model file, and model files have all that there is.
#[test]
fn pages_have_everything() {
    assert_eq!(gyro_pages::page(5), gyro_pages::page(5));
    let pages: Vec<_> = (0..300).map(gyro_pages::page).collect();
    let things = [
        "revolute",
        "spherical",
        "\"fixed\"",
        "universal",
        "cylindrical",
        "prismatic",
        "planar",
        "screw",
        "point_on_line",
        "\"rod\"",
        "fixed = true",
        "\"constrained\"",
        "free = true",
        "driven",
        "[[coupler]]",
        "[[driver]]",
        "\"spring\"",
        "\"damper\"",
        "\"coulomb\"",
        "\"stop\"",
        "\"motor\"",
        "\"link\"",
        "\"load\"",
        "\"pose\"",
        "\"velocity\"",
        "\"acceleration\"",
        "\"inertial\"",
        "\"reaction\"",
        "\"driver\"",
        "\"rate\"",
        "\"energy\"",
        "\"power\"",
        "[parameters]",
        "[inputs]",
        "rough",
        "t.csv",
        "product",
        "xy =",
        "[[1",
        "pitch",
        "lead",
        "damping =",
        "* 3 / 3",
        "sqrt(",
        "^3 /",
        "d0 = ",
        "point_mass",
    ];
    for thing in things {
        let count = pages.iter().filter(|page| page.contains(thing)).count();
        assert!(count >= 3, "{thing}: on {count} of {} model files", pages.len());
    }
}

/// Arithmetic changes how numbers are written and nothing else: all numbers are the same rationals, and what is written
/// without a parameter is the same number to every engine.
#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn numbers_written_in_other_ways_are_the_same() {
    let read = |text: &str| {
        let model = gyro_model::read_with("page.toml", text, &mut gyro_pages::load);
        model.unwrap_or_else(|mistakes| panic!("{mistakes}"))
    };
    let mut n_computed = 0;
    for seed in 0..150 {
        let [written, plain] = [gyro_pages::page(seed), gyro_pages::plain_page(seed)].map(|text| read(&text));
        let (ours, theirs) = (written.numbers(), plain.numbers());
        assert_eq!(ours.len(), theirs.len(), "model file {seed}");
        for (ours, theirs) in ours.iter().zip(&theirs) {
            assert_eq!(written.exact(ours), plain.exact(theirs), "model file {seed}");
            match (ours, theirs) {
                (Number::Computed(_), _) => n_computed += 1,
                // A formula keeps its own text, in which a number is written as it is.
                (Number::Formula(ours), Number::Formula(theirs)) => {
                    assert_eq!(ours.operations, theirs.operations, "model file {seed}");
                }
                _ => assert_eq!(ours, theirs, "model file {seed}"),
            }
        }
    }
    assert!(n_computed > 50, "{n_computed} numbers that are computed from parameters");
}
