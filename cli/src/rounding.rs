//! `gyro verify --rounding`: what generated code and two forms of the runtime-assembled model lose by rounding, at the
//! same states.

use crate::failure::Failure;
use gyro_assembled::{Careful, Dense};
use gyro_model::Model;
use gyro_program::Kernel;
use gyro_sim::{Dynamics, Kinematics, Projection, Scalar};
use gyro_verifier::field::{Precision, Real};
use gyro_verifier::module::Module;
use gyro_verifier::rounding::{DOUBLE_DIGITS, Kind, Reference, Rounding, Spread, error, measure, references};
use std::fmt::Write;

/// States of each kind.
const STATES: usize = 50;

const SEED: u64 = 1;

/// A generated kernel this many times worse than the same of the pivoted dense form is pointed out.
const CONSPICUOUS: f64 = 10.0;

/// How to read the tables.
const HEAD: &str = "# Rounding of generated code

Made by `cargo xtask verify --rounding`. A proof says nothing about rounding; so it is measured here.

Each function runs in `f64` and `f32`, and in `f64` in two forms of the [runtime-assembled
model](glossary.md#runtime-assembled-model), the careful and the dense one, at the same states, and is compared with
384-bit floats. Times are those of the model file's own run, up to its end. A cell has the worst error and in
parentheses the median, in units in the last place (of the precision in question) of the largest result, at states *near
the start* / *random* (rates up to the start's) / *extreme* (speeds and distances from 1e-6 to 1e6). These states do not
satisfy the constraints, except for functions in joint coordinates and those of corrected states
(`joint_accelerations_at` and all that begin with `corrected`), which run at the maximal states of joint states that are
drawn in the same way.

How to read it:

* The state is rounded before anything is computed, and the reference is not told. Where the result is a small
  difference of large numbers (Φ near the start, where it is 1e-7) that alone makes thousands of units, for every
  implementation alike: compare a row's columns, not rows.
* The dense form solves eq. (17) by LU with pivoting: its loss is about what the conditioning of the state costs. The
  generated solve does not pivot; it may be better or worse. Where a kernel is more than ten times worse than the dense
  form, it is listed here first.
* The runtime-assembled model has no u̇: beside `joint_accelerations_at` stands what it loses in v̇, at the same states.
* The worst rows of corrected states are those of bodies that are free along their joint. `planar` and `cylindrical`
  fall freely and spin about a joint point beside the mass centre: their λ, and the s̈ of a fast spin, are small rests
  of large terms (weight less inertia, centripetal less tangential acceleration) that `corrected_multipliers` and
  `corrected_accelerations` compute one by one. The dense form solves for the mass centre's acceleration itself.
* Empty cells: the runtime-assembled model has no such function (it chooses coordinates by pivoting and reads angles
  with another factor), or no careful form for the mechanism; or all results are zero.

";

/// The whole report in Markdown.
pub(crate) fn report(tables: &[Table]) -> String {
    let conspicuous: Vec<&String> = tables.iter().flat_map(|table| &table.conspicuous).collect();
    let mut text = HEAD.to_owned() + "## More than ten times worse than the dense form\n\n";
    let [compared, dense_worse] =
        [|t: &Table| t.compared, |t: &Table| t.dense_worse].map(|of| tables.iter().map(of).sum::<usize>());
    let _ = writeln!(
        text,
        "Of {compared} comparisons of worst errors (a function at one kind of states each) these {}; in {dense_worse} the dense form is more than\n\
         ten times worse than the generated code.\n",
        conspicuous.len()
    );
    conspicuous.iter().for_each(|line| text += &format!("* {line}\n"));
    tables.iter().for_each(|table| text += &table.text);
    text
}

/// The errors of one module.
pub(crate) struct Table {
    text: String,
    conspicuous: Vec<String>,
    /// Functions at one kind of states that the dense form has too.
    compared: usize,
    /// Of these, how many the dense form computes much worse.
    dense_worse: usize,
}

/// A table of one module in Markdown, and what is conspicuous in it.
pub(crate) fn table(model: &Model, code: &str, constants: &str) -> Result<Table, Failure> {
    let module = Module::read(model, code, constants).map_err(|refusal| Failure::Run(refusal.to_string()))?;
    let precision = Precision::new();
    let references = references(model, &module, &precision, STATES, SEED);
    let careful = Careful::<f64>::supports(model).ok().and_then(|()| Careful::new(model).ok());
    let dense = Dense::<f64>::new(model).map_err(|e| Failure::Usage(e.to_string()))?;
    let measured = measure(model, &module, STATES, SEED);
    let mut text =
        format!("\n## {}\n\n| function | f64 | f32 | careful | dense |\n|---|---|---|---|---|\n", model.name);
    let (mut conspicuous, mut compared, mut dense_worse) = (Vec::new(), 0, 0);
    for function in module.programs.keys() {
        let of_function = measured.iter().filter(|row| row.function == *function);
        let of_kind = |kind| of_function.clone().find(|row| row.kind == kind);
        let mut cells = [(); 4].map(|()| Vec::new());
        for row in Kind::ALL.map(of_kind) {
            let careful = careful
                .as_ref()
                .zip(row)
                .and_then(|(careful, row)| of_assembled(&module, careful, &references, row));
            let dense = row.and_then(|row| of_assembled(&module, &dense, &references, row));
            if let Some((row, dense)) =
                row.zip(dense).filter(|(r, dense)| r.double.worst > CONSPICUOUS * dense.worst)
            {
                let ratio = row.double.worst / dense.worst;
                let kind = row.kind;
                conspicuous.push(format!(
                    "{}, {function}, {kind} states: worst {ratio:.0} times that of the dense form",
                    model.name
                ));
            }
            if let Some((row, dense)) = row.zip(dense) {
                compared += 1;
                dense_worse += usize::from(dense.worst > CONSPICUOUS * row.double.worst);
            }
            let row = [row.map(|row| row.double), row.map(|row| row.single), careful, dense];
            cells.iter_mut().zip(row).for_each(|(cell, spread)| cell.push(spread.as_ref().map(words)));
        }
        if cells[0].iter().all(Option::is_none) {
            continue;
        }
        let words = |cell: &Vec<Option<String>>| match cell.iter().all(Option::is_none) {
            true => String::new(),
            false => cell.iter().map(|words| words.as_deref().unwrap_or("0")).collect::<Vec<_>>().join(" / "),
        };
        let _ = writeln!(text, "| {function} | {} |", cells.each_ref().map(words).join(" | "));
    }
    Ok(Table { text, conspicuous, compared, dense_worse })
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

/// The errors of a runtime-assembled model in one function on the states of one kind; `None` if it has no such
/// function.
fn of_assembled<M>(
    module: &Module,
    assembled: &M,
    references: &[Reference<'_>],
    row: &Rounding,
) -> Option<Spread>
where
    M: Kinematics<Scalar = f64> + Dynamics + Projection,
{
    let kernel = Kernel::named(&row.function)?;
    // A runtime-assembled model has no u̇: its v̇ stands beside it.
    let counterpart = match kernel {
        Kernel::JointAccelerationsAt => Kernel::CorrectedAccelerations.name(),
        _ => &row.function,
    };
    let of_kind = references.iter().filter(|reference| reference.sample.kind == row.kind);
    let errors = of_kind.filter_map(|reference| {
        let state = reference.state(&row.function);
        let computed = computed(module, assembled, kernel, state, reference)?;
        let exact: &[Real<'_>] = reference.of(counterpart)?;
        // What follows the accelerations is each implementation's own.
        let of_both = exact.len().min(computed.len());
        error(&exact[..of_both], &computed[..of_both], DOUBLE_DIGITS)
    });
    Spread::of(errors.collect())
}

/// What a runtime-assembled model gives for a kernel at a maximal state; `None` if it has no such function, or its
/// results are not comparable.
fn computed<M>(
    module: &Module,
    assembled: &M,
    kernel: Kernel,
    state: &[f64],
    reference: &Reference<'_>,
) -> Option<Vec<f64>>
where
    M: Kinematics<Scalar = f64> + Dynamics + Projection,
{
    let (t, mut y) = (reference.sample.t, assembled.start());
    y.as_mut().iter_mut().zip(state).for_each(|(y, x)| *y = Scalar::constant(*x));
    let rows = |write: &dyn Fn(&mut M::Rows)| {
        let mut out = assembled.buffers().rows;
        write(&mut out);
        out.as_ref().to_vec()
    };
    let accelerations = || {
        let mut out = assembled.acceleration_buffer();
        assembled.accelerations(t, &y, &mut out);
        out
    };
    Some(match kernel {
        Kernel::VelocityResidual => rows(&|out| assembled.velocity_residual(t, &y, out)),
        Kernel::Gamma => rows(&|out| assembled.gamma(t, &y, out)),
        Kernel::Nu => rows(&|out| assembled.nu(t, &y, out)),
        Kernel::Multipliers | Kernel::CorrectedMultipliers => {
            rows(&|out| assembled.multipliers(t, &y, &accelerations(), out))
        }
        Kernel::Accelerations | Kernel::CorrectedAccelerations | Kernel::JointAccelerationsAt => {
            accelerations().as_ref()[..assembled.buffers().velocities.as_ref().len()].to_vec()
        }
        Kernel::Phi => {
            let mut out = assembled.buffers().constraints;
            assembled.phi(t, &y, &mut out);
            out.as_ref().to_vec()
        }
        Kernel::PhiQ => {
            let mut out = assembled.terms().phi_q;
            assembled.phi_q(t, &y, &mut out);
            at_places(&module.phi_q_pattern, assembled.phi_q_pattern(), out.as_ref())
        }
        Kernel::PhiPi => {
            let mut out = assembled.terms().phi_pi;
            assembled.phi_pi(t, &y, &mut out);
            at_places(&module.phi_pi_pattern, assembled.phi_pi_pattern(), out.as_ref())
        }
        Kernel::AppliedForce => {
            let mut out = assembled.buffers().velocities;
            assembled.applied_force(t, &y, &mut out);
            out.as_ref().to_vec()
        }
        Kernel::Project => {
            let (mut rows, mut out) = (assembled.buffers().rows, assembled.buffers().velocities);
            rows.as_mut().copy_from_slice(&reference.sample.changes);
            assembled.project(t, &y, &rows, &mut out);
            out.as_ref().to_vec()
        }
        Kernel::Derivative | Kernel::CorrectedDerivative => {
            let mut out = assembled.start();
            assembled.derivative(t, &y, &mut out);
            out.as_ref().to_vec()
        }
        Kernel::Energy => {
            let energy = assembled.energy(t, &y);
            vec![energy.kinetic, energy.potential]
        }
        _ => return None,
    })
}

/// The values at some places of a matrix that is given by its own pattern.
fn at_places(places: &[(usize, usize)], pattern: &[(u16, u16)], values: &[f64]) -> Vec<f64> {
    let value = |place: &(usize, usize)| {
        let known = pattern.iter().position(|&(row, column)| (row.into(), column.into()) == *place);
        known.map_or(0.0, |known| values[known])
    };
    places.iter().map(value).collect()
}
