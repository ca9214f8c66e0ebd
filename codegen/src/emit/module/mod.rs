//! The text of a generated module: the mechanism's type and its implementation of the run-time contract.

mod contract;
mod definition;
mod functions;
mod indices;
mod mechanism;
mod partition;
mod patterns;
mod tables;
mod variables;
mod writer;

use self::writer::ModuleWriter;
use crate::emit::data_sheet::DataSheet;
use crate::emit::literals::Literals;
use crate::equations::Equations;
use crate::kernels::Kernels;
use crate::scheduled::ExactKernel;
use gyro_model::Start;
use gyro_program::Kernel;
use proc_macro2::TokenStream;
use quote::quote;
use std::collections::BTreeMap;

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
    (equations, kernels, exact): (Equations<'_>, Kernels, BTreeMap<Kernel, ExactKernel>),
    start: &Start,
) -> Text {
    let literals = Literals::default();
    let counts = equations.counts();
    let module = ModuleWriter { equations: &equations, counts, type_name, kernels, literals, exact };
    let tokens = module.tokens(start);
    let data_sheet = DataSheet::of(&equations, &module.kernels, &module.exact);
    let (tokens, constants) = module.literals.write(tokens);
    let file = syn::parse2(tokens).expect("the emitted tokens are Rust");
    let text = tables::with_numbers(prettyplease::unparse(&file), &equations.tables);
    let code = format!("{}\n{text}", data_sheet.head(file_name));
    Text { code, constants, data_sheet }
}

impl ModuleWriter<'_> {
    fn tokens(&self, start: &Start) -> TokenStream {
        let (tables, definition) = (self.tables_of_motions(), self.definition());
        let (contract, indices) = (self.contract(start), self.indices());
        quote! {
            #tables
            #definition
            #contract
            #indices
        }
    }
}
