//! The text of a generated module: the mechanism's type and its implementation of the run-time contract.

mod definition;
mod dynamics;
mod indices;
mod joint_space;
mod kinematics;
mod mechanism;
mod observed;
mod on_request;
mod partition;
mod ports;
mod tables;
mod variables;
mod writer;

use self::writer::ModuleWriter;
use crate::emit::data_sheet::DataSheet;
use crate::emit::literals::Literals;
use crate::equations::Equations;
use crate::kernels::Kernels;
use gyro_model::Start;
use proc_macro2::TokenStream;
use quote::quote;
use std::cell::RefCell;

/// `gyroscope_maximal` to `GyroscopeMaximal`; what Rust or the generic parameter already means gets an underscore.
pub fn type_name(module_name: &str) -> String {
    let capital = |word: &str| {
        let mut letters = word.chars();
        letters
            .next()
            .map(|first| first.to_uppercase().chain(letters).collect::<String>())
            .unwrap_or_default()
    };
    let name: String = module_name.split('_').map(capital).collect();
    if ["Self", "T", "Parameters"].contains(&name.as_str()) { format!("{name}_") } else { name }
}

/// The text of a module, the exact constants of its literals and its data sheet.
pub struct Text {
    pub code: String,
    pub constants: String,
    pub data_sheet: DataSheet,
}

/// Writes the files.
pub fn write(
    file_name: &str,
    type_name: &str,
    (equations, kernels): (&Equations, Kernels),
    start: &Start,
) -> Text {
    let literals = Literals::default();
    let module = ModuleWriter { equations, type_name, kernels, literals, repetitions: RefCell::default() };
    let tokens = module.tokens(start);
    let data_sheet = DataSheet::of(equations, &module.kernels, &module.repetitions.borrow());
    let (tokens, constants) = module.literals.write(tokens);
    let file = syn::parse2(tokens).expect("the emitted tokens are Rust");
    let text = tables::with_numbers(prettyplease::unparse(&file), &equations.tables);
    let code = format!("{}\n{text}", data_sheet.head(file_name));
    Text { code, constants, data_sheet }
}

impl ModuleWriter<'_> {
    fn tokens(&self, start: &Start) -> TokenStream {
        let (tables, definition, mechanism) =
            (self.tables_of_motions(), self.definition(), self.mechanism(start));
        let (partition, kinematics, dynamics) = (self.partition(), self.kinematics(), self.dynamics());
        let (projection, joint_space) = (self.projection(), self.joint_space());
        let (corrected_dynamics, corrected_solution) = (self.corrected_dynamics(), self.corrected_solution());
        let (joint_jacobian, parameter_jacobian) = (self.joint_jacobian(), self.parameter_jacobian());
        let (joint_outputs, output_derivatives, frames) =
            (self.joint_outputs(), self.output_derivatives(), self.frames());
        let on_request = self.on_request();
        let indices = self.indices();
        quote! {
            #tables
            #definition
            #mechanism
            #partition
            #kinematics
            #dynamics
            #projection
            #corrected_dynamics
            #joint_space
            #corrected_solution
            #joint_jacobian
            #parameter_jacobian
            #joint_outputs
            #output_derivatives
            #frames
            #on_request
            #indices
        }
    }
}
