//! The C text is read back and found to be what was proved, and a changed one is not.

use gyro_codegen::tape::Operation;
use gyro_codegen::{Functions, Scheduled};
use gyro_export::{Exported, Precision};
use gyro_model::Model;
use gyro_program::elementary::Function;
use gyro_verifier::same_in_c;
use std::fs;
use std::path::Path;

struct Case {
    model: Model,
    module: gyro_codegen::Module,
    exported: Exported,
}

impl Case {
    fn of(page: &str, functions: &Functions, precision: Precision) -> Self {
        let path = Path::new("../..").join(page);
        let text = fs::read_to_string(&path).expect("a model file");
        let mut load =
            |table: &str| fs::read_to_string(path.with_file_name(table)).map_err(|e| e.to_string());
        let model = gyro_model::read_with(page, &text, &mut load).expect("no mistakes");
        let module = gyro_codegen::generate_functions(page, &model, functions).expect("a module");
        let exported = gyro_export::c(page, &model, &module.scheduled, precision);
        Self { model, module, exported }
    }

    fn read_back(&self, source: &str) -> Result<usize, String> {
        let module = (self.module.code.as_str(), self.module.constants.as_str());
        same_in_c(&self.model, module, (&self.exported.header, source)).map_err(|refusal| refusal.to_string())
    }
}

#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn the_text_is_what_was_proved() {
    let pages = [
        ("models/four-bar.toml", Functions::all(), Precision::F64),
        ("models/driven-gyroscope.toml", Functions::of_solvers(), Precision::F32),
        ("tests/models/cam.toml", Functions::of_solvers(), Precision::F64),
        ("tests/models/curves.toml", Functions::all(), Precision::F64),
        ("tests/models/electric.toml", Functions::all(), Precision::F64),
        ("tests/models/stops.toml", Functions::of_solvers(), Precision::F64),
        ("examples/arm/arm.toml", Functions::all(), Precision::F64),
        // Loops over tables of constants.
        ("models/stewart-platform.toml", Functions::named(["joint"]).expect("a group"), Precision::F64),
    ];
    for (page, functions, precision) in pages {
        let case = Case::of(page, &functions, precision);
        let n = case.read_back(&case.exported.source).unwrap_or_else(|words| panic!("{page}: {words}"));
        assert!(n > 8, "{page}: {n} functions");
    }
}

/// The kernels with this function in the place of the hyperbolic tangent.
fn replaced(scheduled: &Scheduled, function: Function) -> Scheduled {
    let mut scheduled = scheduled.clone();
    for operation in scheduled.kernels.values_mut().flat_map(|kernel| &mut kernel.tape.outside.operations) {
        if let Operation::Call(called @ Function::Tanh, _) = operation {
            *called = function;
        }
    }
    scheduled
}

/// In the place of the hyperbolic tangent, whether model files reach the function or not.
#[test]
fn every_function_of_one_operand_is_read_back() {
    let mut case = Case::of("tests/models/friction.toml", &Functions::of_solvers(), Precision::F64);
    let code = case.module.code.clone();
    for (function, precision) in
        Function::ALL.into_iter().flat_map(|of| [(of, Precision::F64), (of, Precision::F32)])
    {
        if function.arity() == 1 {
            case.module.code = code.replace(".tanh()", &format!(".{}()", function.name()));
            let scheduled = replaced(&case.module.scheduled, function);
            case.exported = gyro_export::c("friction.toml", &case.model, &scheduled, precision);
            let name = function.properties().in_c[precision as usize];
            assert!(
                case.exported.source.matches(&format!("{name}(")).count() > 1,
                "{name} is brought and called"
            );
            let n = case.read_back(&case.exported.source).unwrap_or_else(|words| panic!("{name}: {words}"));
            assert!(n > 8, "{name}: {n} functions");
        }
    }
}

/// Each of these changes what is computed, or where it goes.
#[test]
fn a_changed_text_is_noticed() {
    let case = Case::of("models/four-bar.toml", &Functions::of_solvers(), Precision::F64);
    let source = &case.exported.source;
    let start = source.find("void four_bar_joint_accelerations(").expect("the function");
    let end = start + source[start..].find("\n}\n").expect("it ends");
    let body = &source[start..end];
    let changes = [
        (" + ", " - "),
        (" * ", " / "),
        ("x[1]", "x[2]"),
        ("out[1]", "out[0]"),
        ("0.", "1."),
        ("cos", "sin"),
    ];
    for (from, to) in changes {
        let changed = body.replacen(from, to, 1);
        assert_ne!(changed, body, "`{from}` is in it");
        let text = format!("{}{changed}{}", &source[..start], &source[end..]);
        let words = case.read_back(&text).expect_err(from);
        assert!(words.contains("joint_accelerations"), "{from} to {to}: {words}");
    }
    let renamed = source.replace("four_bar_to_maximal(", "four_bar_elsewhere(");
    assert!(case.read_back(&renamed).expect_err("a function is missing").contains("four_bar_to_maximal"));
    let foreign = source.replacen(
        "const four_bar_real t0 = ",
        "if (t > 1.0) return;\n    const four_bar_real t0 = ",
        1,
    );
    assert!(case.read_back(&foreign).is_err(), "a branch is no statement of the subset");
}
