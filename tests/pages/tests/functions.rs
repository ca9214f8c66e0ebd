//! Modules with some functions are modules with all of them, less what was not asked for.

use gyro_codegen::{Functions, Group, Kernel, Module};
use gyro_verifier::{Depth, verify};

/// Seeds of model files; any will do.
const SEEDS: std::ops::Range<u64> = 3000..3005;

/// Names of functions that stand for a selection, and the groups that they bring besides what is always there.
const SELECTIONS: [(&[&str], &[Group]); 4] = [
    (&[], &[]),
    (&["gamma", "maximal"], &[]),
    (&["to_maximal"], &[Group::Joint]),
    (&["outputs", "joint_jacobian"], &[Group::Joint, Group::Jacobian]),
];

/// What is wrong with a selection.
fn problems(seed: u64) -> Vec<String> {
    let text = gyro_pages::page(seed);
    let model = gyro_model::read_with("page.toml", &text, &mut gyro_pages::load).expect("a model file");
    let generate = |functions: &Functions| {
        gyro_codegen::generate_functions("page.toml", &model, functions).expect("a module")
    };
    let full = generate(&Functions::usual());
    let mut problems = Vec::new();
    for (names, groups) in SELECTIONS {
        let functions = Functions::named(names.iter().copied()).expect("known names");
        let module = generate(&functions);
        let report = verify(&model, &module.code, &module.constants, Depth::Quick);
        if !report.is_proved() {
            problems.push(format!("model file {seed}, {names:?}: {report}"));
        }
        let is_asked = |kernel: Kernel| kernel.group() == Group::Maximal || groups.contains(&kernel.group());
        problems
            .extend(differences(&full, &module, is_asked).map(|words| format!("{seed} {names:?}: {words}")));
        let has = |text: &str| module.code.contains(text);
        let could = |text: &str| full.code.contains(text);
        for (group, text) in
            [(Group::Joint, "gyro_sim::JointSpace for"), (Group::Jacobian, "fn joint_jacobian(")]
        {
            if has(text) != (could(text) && groups.contains(&group)) {
                problems.push(format!("{seed} {names:?}: `{text}` is there: {}", has(text)));
            }
        }
        let says = |what: &str| has(&format!("left out: {what} (functions = "));
        let is_left_out = could("gyro_sim::JointSpace for") && !groups.contains(&Group::Joint);
        if is_left_out && !says("joint coordinates") {
            problems.push(format!("{seed} {names:?}: the data sheet does not say what was left out"));
        }
    }
    problems
}

/// Functions that are missing or too much, or that take more operations than among all.
fn differences<'m>(
    full: &'m Module,
    module: &'m Module,
    is_asked: impl Fn(Kernel) -> bool + 'm,
) -> impl Iterator<Item = String> + 'm {
    Kernel::all().filter(|&kernel| kernel != Kernel::ParameterSetup).filter_map(move |kernel| {
        let expected = full.data_sheet.function(kernel).filter(|_| is_asked(kernel));
        let found = module.data_sheet.function(kernel);
        match (expected, found) {
            (None, None) => None,
            (Some(all), Some(one))
                if one.operations.total() <= all.operations.total()
                    && one.operations.functions <= all.operations.functions =>
            {
                None
            }
            (all, one) => {
                let operations = [all, one].map(|f| f.map(|f| f.operations.total()));
                Some(format!("{}: operations {operations:?}", kernel.name()))
            }
        }
    })
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
        let is_there = module.code.contains("gyro_sim::DynamicsDerivatives for");
        assert_eq!(is_there, module.data_sheet.unavailable().next().is_none(), "model file {seed}");
        n_there += usize::from(is_there);
    }
    assert!((1..SEEDS.count()).contains(&n_there), "{n_there} of {} have them", SEEDS.count());
}
