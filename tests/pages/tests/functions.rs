//! Modules with some functions are modules with all of them, less what was not asked for.

use gyro_codegen::{Functions, Group, Kernel, Module};
use gyro_verifier::{Depth, verify};
use rand::seq::IndexedRandom;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Seeds of model files; any will do.
const SEEDS: std::ops::Range<u64> = 3010..3014;

/// Selections of each model file.
const SELECTIONS: usize = 4;

/// Up to three names of functions or groups.
fn names(random: &mut ChaCha8Rng) -> Vec<&'static str> {
    let all: Vec<_> = Kernel::all().map(Kernel::name).chain(Group::all().map(Group::name)).collect();
    (0..random.random_range(0..4)).filter_map(|_| all.choose(random).copied()).collect()
}

/// What is wrong with a selection.
fn problems(seed: u64) -> Vec<String> {
    let text = gyro_pages::page(seed);
    let model = gyro_model::read_with("page.toml", &text, &mut gyro_pages::load).expect("a model file");
    let generate = |functions: &Functions| {
        gyro_codegen::generate_functions("page.toml", &model, functions).expect("a module")
    };
    let (full, mut random) = (generate(&Functions::all()), ChaCha8Rng::seed_from_u64(seed));
    let mut problems = Vec::new();
    for _ in 0..SELECTIONS {
        let names = names(&mut random);
        let functions = Functions::named(names.iter().copied()).expect("known names");
        let module = generate(&functions);
        let report = verify(&model, &module.code, &module.constants, Depth::Quick);
        let unproved = (!report.is_proved()).then(|| report.to_string());
        let found =
            unproved.into_iter().chain(differences(&full, &module)).chain(traits(&full, &module, &functions));
        problems.extend(found.map(|words| format!("model file {seed}, {names:?}: {words}")));
    }
    problems
}

/// Functions that are there though the others are not, but take more operations than among all, or are missing.
fn differences(full: &Module, module: &Module) -> Vec<String> {
    let kernels = Kernel::all().filter(|&kernel| kernel != Kernel::ParameterSetup);
    let differs = |kernel: Kernel| {
        let [all, some] = [full, module].map(|module| module.data_sheet.function(kernel));
        let is_there = module.code.contains(&format!("fn {}(", kernel.name()));
        let operations = [all, some].map(|function| function.map(|function| function.operations.total()));
        let is_fine = match operations {
            [Some(all), Some(some)] => some <= all,
            [_, some] => some.is_none(),
        };
        let is_missing = is_there && some.is_none() && all.is_some();
        (is_missing || !is_fine).then(|| format!("`{}`: operations {operations:?}", kernel.name()))
    };
    kernels.filter_map(differs).collect()
}

/// Traits that are missing or too much. Without joint coordinates, or for outputs, others call eq. (17), and what
/// outputs of a joint state tell of reactions is proved for multipliers that are there.
fn traits(full: &Module, module: &Module, functions: &Functions) -> Vec<String> {
    let differs = |group: Group| {
        let name = group.trait_name();
        let has = |module: &Module| module.implements(name);
        let is_called = module.code.contains(&format!("gyro_sim::{name}::"));
        let expected = (functions.has(group) || is_called) && has(full);
        let is_told = functions.has(Group::JointOutputs) && Functions::of([Group::Reactions]).has(group);
        (has(module) != expected && !is_told).then(|| format!("`{name}` is there: {}", has(module)))
    };
    Group::all().filter_map(differs).collect()
}

#[test]
fn what_is_not_asked_for_is_left_out_and_nothing_else_changes() {
    let found: Vec<String> = SEEDS.flat_map(problems).collect();
    assert!(found.is_empty(), "{}", found.join("\n"));
}

/// What is there on request is right whatever the mechanism; of some there is nothing.
#[test]
fn what_is_asked_for_is_proved_where_it_can_be() {
    let mut n_there = 0;
    for seed in SEEDS {
        let text = gyro_pages::page(seed);
        let model = gyro_model::read_with("page.toml", &text, &mut gyro_pages::load).expect("a model file");
        let functions = Functions::named(["inverse", "mass_matrix", "derivatives", "regressor"]);
        let functions = functions.expect("known names");
        let module = gyro_codegen::generate_functions("page.toml", &model, &functions).expect("a module");
        let report = verify(&model, &module.code, &module.constants, Depth::Quick);
        assert!(report.is_proved(), "model file {seed}: {report}");
        let is_there = module.implements("DynamicsDerivatives");
        assert_eq!(is_there, module.data_sheet.unavailable().next().is_none(), "model file {seed}");
        n_there += usize::from(is_there);
    }
    assert!((1..SEEDS.count()).contains(&n_there), "{n_there} of {} have them", SEEDS.count());
}
