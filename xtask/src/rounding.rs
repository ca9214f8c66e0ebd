//! `cargo xtask verify --rounding`: what generated code and both forms of the twin lose by rounding, on the same states.

use crate::failure::Failure;
use gyro_assembled::{Careful, Dense};
use gyro_model::Model;
use gyro_sim::{Equations, Mechanism, Scalar};
use gyro_verifier::field::{Precision, Real};
use gyro_verifier::module::Module;
use gyro_verifier::rounding::{DOUBLE_DIGITS, Reference, Rounding, Spread, error, measure, references};
use std::fmt::Write;

/// States of each kind.
const STATES: usize = 50;

const SEED: u64 = 1;

/// Functions that the twin has too, with a meaning of their own.
const SHARED: [&str; 5] = ["phi", "velocity_residual", "gamma", "applied_force", "accelerations"];

/// A generated solve this many times worse than the pivoted one is pointed out.
const CONSPICUOUS: f64 = 10.0;

/// A table of one module in Markdown, and what is conspicuous in it.
pub(crate) fn table(model: &Model, code: &str, constants: &str) -> Result<String, Failure> {
    let module = Module::read(model, code, constants).map_err(|refusal| Failure::Run(refusal.to_string()))?;
    let precision = Precision::new();
    let references = references(model, &module, &precision, STATES, SEED);
    let careful = Careful::<f64>::supports(model).ok().and_then(|()| Careful::new(model).ok());
    let dense = Dense::<f64>::new(model).map_err(|e| Failure::Usage(e.to_string()))?;
    let mut text =
        format!("{}: errors in units in the last place of the largest result, worst (median)\n", model.name);
    text += "| function | states | f64 | f32 | careful twin | dense twin |\n|---|---|---|---|---|---|\n";
    let mut remarks = String::new();
    for row in measure(model, &module, STATES, SEED) {
        let careful = careful.as_ref().and_then(|twin| of_twin(model, twin, &references, &row));
        let dense = of_twin(model, &dense, &references, &row);
        let [careful_words, dense_words] = [careful, dense].map(|s| s.map_or("".to_owned(), |s| words(&s)));
        let Rounding { function, kind, double, single } = &row;
        let (double_words, single_words) = (words(double), words(single));
        let _ = writeln!(
            text,
            "| {function} | {kind} | {double_words} | {single_words} | {careful_words} | {dense_words} |"
        );
        if let Some(dense) = dense.filter(|dense| double.worst > CONSPICUOUS * dense.worst) {
            let ratio = double.worst / dense.worst;
            let _ = writeln!(
                remarks,
                "{function}, {kind} states: worst {ratio:.0} times that of the pivoted dense twin"
            );
        }
    }
    Ok(format!("{text}{remarks}"))
}

fn words(spread: &Spread) -> String {
    format!("{} ({})", Short(spread.worst), Short(spread.median))
}

/// A number that is short whatever its size.
struct Short(f64);

impl std::fmt::Display for Short {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if self.0 < 1e4 { write!(f, "{:.1}", self.0) } else { write!(f, "{:.1e}", self.0) }
    }
}

/// The errors of a twin in one function on the states of one kind.
fn of_twin<M>(model: &Model, twin: &M, references: &[Reference<'_>], row: &Rounding) -> Option<Spread>
where
    M: Equations<Scalar = f64>,
{
    if !SHARED.contains(&row.function.as_str()) {
        return None;
    }
    let errors =
        references.iter().filter(|reference| reference.sample.kind == row.kind).filter_map(|reference| {
            let computed = computed(twin, &row.function, reference);
            let exact: &[Real<'_>] = reference.of(&row.function)?;
            // What follows the accelerations is each implementation's own.
            let exact = if row.function == "accelerations" {
                exact.get(..6 * model.coordinate_bodies().len())?
            } else {
                exact
            };
            error(exact, &computed, DOUBLE_DIGITS)
        });
    Spread::of(errors.collect())
}

fn computed<M: Equations<Scalar = f64>>(twin: &M, function: &str, reference: &Reference<'_>) -> Vec<f64> {
    let (t, mut y) = (reference.sample.t, twin.start());
    y.as_mut().iter_mut().zip(&reference.sample.state).for_each(|(y, x)| *y = Scalar::constant(*x));
    let rows = |write: &dyn Fn(&mut M::Rows)| {
        let mut out = twin.rows();
        write(&mut out);
        out.as_ref().to_vec()
    };
    match function {
        "velocity_residual" => rows(&|out| twin.velocity_residual(t, &y, out)),
        "gamma" => rows(&|out| twin.gamma(t, &y, out)),
        "phi" => {
            let mut out = Mechanism::constraints(twin);
            twin.phi(t, &y, &mut out);
            out.as_ref().to_vec()
        }
        "applied_force" => {
            let mut out = twin.velocities();
            twin.applied_force(t, &y, &mut out);
            out.as_ref().to_vec()
        }
        _ => {
            let mut out = twin.accelerations_buffer();
            twin.accelerations(t, &y, &mut out);
            out.as_ref().to_vec()
        }
    }
}
