//! A generated mechanism as a library of two functions that a program loads: accelerations of many states, and steps of
//! many states. Numbers are handed over as C has them, as two compilers may have made program and library.

use crate::failure::Failure;
use crate::nested;
use gyro_codegen::{Functions, Module};
use gyro_model::Model;
use std::path::PathBuf;

/// Generates, proves and compiles the library of a model with these functions, for this very processor if that is asked
/// for; returns where it is.
pub(crate) fn compiled(
    file: &str,
    page: &Model,
    functions: &Functions,
    is_native: bool,
) -> Result<PathBuf, Failure> {
    let module = gyro_codegen::generate_functions(file, page, functions);
    let module = module.map_err(|error| Failure::Usage(error.to_string()))?;
    nested::loadable(page, &module, root(&module, page, is_native), is_native)
}

/// The text of the library.
fn root(module: &Module, page: &Model, is_native: bool) -> String {
    let type_name = &module.type_name;
    let parameters = page.parameters.iter().enumerate();
    let fields: Vec<String> = parameters.map(|(k, one)| format!("{}: value({k})", one.name)).collect();
    let built = match &fields[..] {
        [] => "::default()".to_owned(),
        fields => format!("::new(mechanism::Parameters {{ {} }})", fields.join(", ")),
    };
    let (n_parameters, n_inputs) = (page.parameters.len(), page.inputs.len());
    let processor = if is_native { "// With all instructions of this processor.\n" } else { "" };
    format!(
        "{processor}#[allow(warnings, clippy::all)]
mod mechanism;

use gyro_runner::batch::{{self, Inputs}};
use gyro_sim::lanes::f64x8;
use gyro_sim::{{JointSpace, Scalar}};
use std::slice;

fn build(parameters: &[f64]) -> mechanism::{type_name}<f64x8> {{
    let value = |k: usize| f64x8::constant(parameters[k]);
    mechanism::{type_name}{built}
}}

unsafe fn inputs<'a>(inputs: *const f64, are_own: u8, rows: usize) -> Inputs<'a> {{
    match are_own {{
        0 => Inputs::Same(unsafe {{ slice::from_raw_parts(inputs, {n_inputs}) }}),
        _ => Inputs::Own(unsafe {{ slice::from_raw_parts(inputs, rows * {n_inputs}) }}),
    }}
}}

/// # Safety
/// The addresses are those of {n_parameters} parameters, of a row of {n_inputs} inputs or one for each state, and of \
         rows of x, u and results.
#[unsafe(no_mangle)]
pub unsafe extern \"C\" fn gyro_accelerations(
    t: f64,
    rows: usize,
    are_own: u8,
    [parameters, given, x, u]: &[*const f64; 4],
    out: *mut f64,
) {{
    let mut mechanism = build(unsafe {{ slice::from_raw_parts(*parameters, {n_parameters}) }});
    let given = unsafe {{ inputs(*given, are_own, rows) }};
    let (n_x, n_u) = (mechanism.joint_layout().n_coordinates(), mechanism.joint_layout().n_rates());
    let x = unsafe {{ slice::from_raw_parts(*x, rows * n_x) }};
    let u = unsafe {{ slice::from_raw_parts(*u, rows * n_u) }};
    let out = unsafe {{ slice::from_raw_parts_mut(out, rows * n_u) }};
    batch::accelerations(&mut mechanism, t, given, (x, u), out);
}}

/// # Safety
/// The addresses are those of the time from which steps are counted and of their length, of the first step and the one \
         after the last, of {n_parameters} parameters, of a row of {n_inputs} inputs or one for each state, and of rows \
         of states.
#[unsafe(no_mangle)]
pub unsafe extern \"C\" fn gyro_advance(
    [from, h]: &[f64; 2],
    [first, end]: &[u64; 2],
    rows: usize,
    are_own: u8,
    [parameters, given]: &[*const f64; 2],
    states: *mut f64,
) {{
    let mut mechanism = build(unsafe {{ slice::from_raw_parts(*parameters, {n_parameters}) }});
    let given = unsafe {{ inputs(*given, are_own, rows) }};
    let n = mechanism.joint_layout().n_coordinates() + mechanism.joint_layout().n_rates();
    let states = unsafe {{ slice::from_raw_parts_mut(states, rows * n) }};
    batch::advance(&mut mechanism, (*from, *h), &(*first..*end), given, states);
}}
"
    )
}
