//! Every kernel of every kind of mechanism: machine code has the bits of its tape.

use chacha20::ChaCha8Rng;
use gyro_codegen::{Effort, Functions, Kernel, Scheduled};
use gyro_jit::{Arguments, Compiled, Engine, Native, compile_scheduled};
use gyro_model::Model;
use gyro_sim::Real;
use gyro_sim::lanes::{Lanes, f64x2};
use rand::{RngExt, SeedableRng};
use std::fs;
use std::path::Path;

/// More than any argument has.
const LONG: usize = 4000;

fn numbers<T: Native + Real>(dice: &mut ChaCha8Rng) -> Vec<T> {
    (0..LONG).map(|_| T::constant(dice.random_range(-2.0..2.0))).collect()
}

/// Compares all kernels of a mechanism; returns how many there are, and how many have loops.
pub fn check<T: Native + Real>(name: &str, model: &Model, scheduled: &Scheduled) -> [usize; 2] {
    let compiled: Compiled<T> = compile_scheduled(model, scheduled.clone(), None).unwrap();
    let interpreted = compiled.interpreted::<T>();
    let mut dice = ChaCha8Rng::seed_from_u64(1);
    for &kernel in scheduled.kernels.keys() {
        let (state, given, own, before) =
            (numbers::<T>(&mut dice), numbers(&mut dice), numbers(&mut dice), numbers(&mut dice));
        let t = T::constant(dice.random_range(0.0..3.0));
        let [mut ours, mut theirs] = [before.clone(), before];
        let arguments = |out| Arguments { t, state: &state, given: &given, own: &own, out };
        compiled.engine().compute(scheduled, kernel, arguments(&mut ours));
        interpreted.engine().compute(scheduled, kernel, arguments(&mut theirs));
        let bits = |numbers: &[T]| -> Vec<u64> { numbers.iter().map(|x| bits(x.to_f64())).collect() };
        assert_eq!(bits(&ours), bits(&theirs), "{name}, {}", kernel.name());
    }
    let with_loops = |kernel: &&Kernel| !scheduled.kernels[kernel].tape.loops.is_empty();
    [scheduled.kernels.len(), scheduled.kernels.keys().filter(with_loops).count()]
}

/// Compares both lanes of all kernels with a mechanism in `f64`.
pub fn check_pairs(name: &str, model: &Model, scheduled: &Scheduled) {
    let single: Compiled<f64> = compile_scheduled(model, scheduled.clone(), None).unwrap();
    let pairs = single.compiled::<f64x2>().unwrap();
    let mut dice = ChaCha8Rng::seed_from_u64(2);
    for &kernel in scheduled.kernels.keys() {
        let [state, given, own, before] =
            [(); 4].map(|()| [numbers::<f64>(&mut dice), numbers::<f64>(&mut dice)]);
        let together = |[a, b]: &[Vec<f64>; 2]| -> Vec<f64x2> {
            a.iter().zip(b).map(|(&a, &b)| f64x2::new([a, b])).collect()
        };
        let times = [(); 2].map(|()| dice.random_range(0.0..3.0));
        let mut ours = together(&before);
        let (x, with, of) = (together(&state), together(&given), together(&own));
        let arguments = Arguments { t: f64x2::new(times), state: &x, given: &with, own: &of, out: &mut ours };
        pairs.engine().compute(scheduled, kernel, arguments);
        for (lane, mut theirs) in before.into_iter().enumerate() {
            let arguments = Arguments {
                t: times[lane],
                state: &state[lane],
                given: &given[lane],
                own: &own[lane],
                out: &mut theirs,
            };
            single.engine().compute(scheduled, kernel, arguments);
            let same = ours.iter().zip(&theirs).all(|(ours, &theirs)| bits(ours.lane(lane)) == bits(theirs));
            assert!(same, "{name}, {}, lane {lane}", kernel.name());
        }
    }
}

/// What is not a number is alike.
fn bits(x: f64) -> u64 {
    if x.is_nan() { f64::NAN.to_bits() } else { x.to_bits() }
}

fn of_model<T: Native + Real>(name: &str, model: &Model) -> [usize; 2] {
    let scheduled = gyro_codegen::schedule(model, &Functions::all(), Effort::Full).unwrap();
    if T::BITS == 64 {
        check_pairs(name, model, &scheduled);
    }
    check::<T>(name, model, &scheduled)
}

#[test]
fn kernels_of_shipped_model_files_have_the_bits_of_their_tapes() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models");
    let mut n = 0;
    for name in ["gyroscope-parameters", "four-bar", "driven-gyroscope", "torsion"] {
        let text = fs::read_to_string(folder.join(format!("{name}.toml"))).unwrap();
        let model = gyro_model::read(name, &text).unwrap_or_else(|error| panic!("{error}"));
        n += of_model::<f64>(name, &model)[0] + of_model::<f32>(name, &model)[0];
    }
    assert!(n > 100, "{n}");
}

#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn kernels_of_random_model_files_have_the_bits_of_their_tapes() {
    for seed in 0..4 {
        let name = format!("page {seed}");
        let model = gyro_model::read_with(&name, &gyro_pages::page(seed), &mut gyro_pages::load);
        let model = model.unwrap_or_else(|error| panic!("{error}"));
        of_model::<f64>(&name, &model);
    }
}

/// A chain of so many bodies.
pub fn chain(n: usize) -> String {
    let mut page = "format = 1\nname = \"chain\"\n[[body]]\nname = \"b0\"\nfixed = true\n".to_owned();
    for k in 1..=n {
        page += &format!(
            "[[body]]\nname = \"b{k}\"\nmass = {}\ninertia = [0.2, 0.3, 0.25]\n\
             [[joint]]\nname = \"j{k}\"\nkind = \"revolute\"\naxis = [0, {}, {}]\nzero = [1, 0, 0]\n\
             first = {{ body = \"b{}\", point = [0.1, 0, 0.3] }}\nsecond = {{ body = \"b{k}\", point = [0, 0.2, 0] }}\n",
            1.0 + k as f64 / 7.0,
            k % 2,
            (k + 1) % 2,
            k - 1,
        );
    }
    page
}

/// A chain whose kernels have loops over tables of constants.
#[test]
fn kernels_with_loops_have_the_bits_of_their_tapes() {
    let model = gyro_model::read("chain", &chain(24)).unwrap_or_else(|error| panic!("{error}"));
    let scheduled =
        gyro_codegen::schedule(&model, &Functions::named(["joint"]).unwrap(), Effort::Full).unwrap();
    let [_, with_loops] = check::<f64>("chain", &model, &scheduled);
    assert!(with_loops > 0);
    check_pairs("chain", &model, &scheduled);
}
