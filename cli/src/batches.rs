//! A generated mechanism as a library of two functions that a program loads: accelerations of many states, and steps of
//! many states. Numbers are handed over as C has them, as two compilers may have made program and library.

use crate::failure::Failure;
use crate::nested;
use gyro_codegen::{Functions, Module};
use gyro_jit::{Library, Sizes};
use gyro_model::Model;

/// Generates, proves, compiles and loads the library of a model with these functions, for this very processor if that
/// is asked for.
pub(crate) fn compiled(
    file: &str,
    page: &Model,
    functions: &Functions,
    sizes: Sizes,
    is_native: bool,
) -> Result<Library, Failure> {
    let module = gyro_codegen::generate_functions(file, page, functions);
    let module = module.map_err(|error| Failure::Usage(error.to_string()))?;
    let path = nested::loadable(page, &module, root(&module, page, sizes, is_native), is_native)?;
    Library::load(&path, sizes).map_err(|error| Failure::Run(format!("{}: {error}", path.display())))
}

/// The text of the library. Its arguments are arrays of fixed lengths, so that it is safe Rust.
fn root(module: &Module, page: &Model, sizes: Sizes, is_native: bool) -> String {
    let type_name = &module.type_name;
    let parameters = page.parameters.iter().enumerate();
    let fields: Vec<String> = parameters.map(|(k, one)| format!("{}: value({k})", one.name)).collect();
    let built = match &fields[..] {
        [] => "::default()".to_owned(),
        fields => format!("::new(mechanism::Parameters {{ {} }})", fields.join(", ")),
    };
    let Sizes { x: n_x, u: n_u, parameters: n_parameters, inputs: n_inputs } = sizes;
    let processor = if is_native { "// With all instructions of this processor.\n" } else { "" };
    format!(
        "{processor}#[allow(warnings, clippy::all)]
mod mechanism;

use gyro_runner::batch::{{self, BLOCK, Inputs}};
use gyro_sim::lanes::f64x8;
use gyro_sim::{{JointSpace, Scalar}};

/// Numbers of parameters, inputs, coordinates, rates and both.
const P: usize = {n_parameters};
const I: usize = {n_inputs};
const X: usize = {n_x};
const U: usize = {n_u};
const N: usize = X + U;

fn build(parameters: &[f64; P]) -> mechanism::{type_name}<f64x8> {{
    let value = |k: usize| f64x8::constant(parameters[k]);
    mechanism::{type_name}{built}
}}

#[unsafe(no_mangle)]
pub extern \"C\" fn gyro_accelerations(
    t: f64,
    rows: usize,
    parameters: &[f64; P],
    inputs: &[[f64; I]; BLOCK],
    x: &[[f64; X]; BLOCK],
    u: &[[f64; U]; BLOCK],
    out: &mut [[f64; U]; BLOCK],
) {{
    let mut mechanism = build(parameters);
    let inputs = Inputs::Own(inputs[..rows].as_flattened());
    let (x, u) = (x[..rows].as_flattened(), u[..rows].as_flattened());
    batch::accelerations(&mut mechanism, t, inputs, (x, u), out[..rows].as_flattened_mut());
}}

#[unsafe(no_mangle)]
pub extern \"C\" fn gyro_advance(
    from: f64,
    h: f64,
    first: u64,
    end: u64,
    rows: usize,
    parameters: &[f64; P],
    inputs: &[[f64; I]; BLOCK],
    states: &mut [[f64; N]; BLOCK],
) {{
    let mut mechanism = build(parameters);
    let inputs = Inputs::Own(inputs[..rows].as_flattened());
    batch::advance(&mut mechanism, (from, h), &(first..end), inputs, states[..rows].as_flattened_mut());
}}
"
    )
}
