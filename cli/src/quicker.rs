//! Whether the engine that compiles in the process would have been quicker than rustc.

use gyro_codegen::DataSheet;
use gyro_runner::duration_words;

/// What a run of generated code has taken.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Took {
    /// Operations of all functions, as they are written.
    pub(crate) operations: usize,
    /// Proving and compiling, if the program was not there. s
    pub(crate) compiling: f64,
    /// s
    pub(crate) running: f64,
}

/// Operations of all functions of a module, as they are written.
pub(crate) fn operations(sheet: &DataSheet) -> usize {
    sheet.functions.iter().map(|function| function.operations.total()).sum()
}

/// What compiling in the process takes for each operation, s, at most: 6e-6 to 12e-6 for each operation of a tape were
/// measured (gyroscope, arm of 7 joints, humanoid; `examples/first_step` of gyro-jit), and about half of those are
/// counted here.
const COMPILING: f64 = 3e-5;

/// The time of functions that were compiled in the process over those of rustc's, of mechanisms whose runs take long:
/// 0.7 to 1.2 (`examples/beside_rustc` of gyro-jit).
const RUNNING: f64 = 1.2;

/// What is worth a sentence: to have taken so many times as long, and so much longer, s.
const WORTH: (f64, f64) = (1.5, 3.0);

/// What to say of a run that would have been much shorter.
pub(crate) fn words(took: Took) -> Option<String> {
    let Took { operations, compiling, running } = took;
    #[expect(clippy::cast_precision_loss, reason = "an estimate")]
    let estimated = COMPILING * operations as f64 + RUNNING * running;
    let ours = compiling + running;
    let is_worth_it = cfg!(feature = "jit") && ours > WORTH.0 * estimated && ours > WORTH.1 + estimated;
    is_worth_it.then(|| {
        format!(
            "proving, compiling and running took {}; --engine jit has the same results and would have taken {}",
            duration_words(ours),
            duration_words(estimated)
        )
    })
}

#[cfg(all(test, feature = "jit"))]
mod tests {
    use super::*;

    #[test]
    fn a_sentence_is_for_those_who_would_have_waited_much_less() {
        let words = |operations, compiling, running| words(Took { operations, compiling, running });
        let said = words(20_000, 40.0, 1.0).unwrap();
        assert!(said.contains("took about 41 seconds") && said.ends_with("about 2 seconds"), "{said}");
        // It was compiled before; it is over soon anyway; the run is what takes long.
        assert_eq!(words(20_000, 0.3, 10.0), None);
        assert_eq!(words(1000, 2.0, 0.1), None);
        assert_eq!(words(20_000, 40.0, 600.0), None);
        assert_eq!(words(100, 10.0, 20.0), None);
        assert_eq!(words(0, 0.0, 0.0), None);
    }
}
