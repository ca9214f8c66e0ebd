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
use crate::scheduled::{Computed, Scheduled};
use proc_macro2::TokenStream;
use quote::quote;

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
pub fn write(file_name: &str, type_name: &str, computed: &Computed, scheduled: &Scheduled) -> Text {
    let literals = Literals::default();
    let module = ModuleWriter { computed, type_name, literals, scheduled };
    let tokens = module.tokens();
    let data_sheet = DataSheet::of(computed);
    let (tokens, constants) = module.literals.write(tokens);
    let file = syn::parse2(tokens).expect("the emitted tokens are Rust");
    let text = tables::with_numbers(prettyplease::unparse(&file), &scheduled.curves);
    let code = format!("{}\n{text}", data_sheet.head(file_name));
    Text { code, constants, data_sheet }
}

impl ModuleWriter<'_> {
    fn tokens(&self) -> TokenStream {
        let (tables, definition) = (self.tables_of_motions(), self.definition());
        let (contract, indices) = (self.contract(), self.indices());
        quote! {
            #tables
            #definition
            #contract
            #indices
        }
    }
}
