//! Where the variables of a module come from: the state and other arguments.

use super::writer::ModuleWriter;
use crate::emit::names::{ident, index};
use crate::emit::results::kept_name;
use crate::emit::tokens::Variables;
use crate::equations::Argument;
use crate::expr::symbol::Symbol;
use proc_macro2::TokenStream;
use quote::quote;

/// `y`, the buffers of the partition, and `self`.
impl Variables for ModuleWriter<'_> {
    fn variable(&self, symbol: Symbol) -> (TokenStream, Option<TokenStream>) {
        const AXES: [&str; 3] = ["x", "y", "z"];
        let body = |moving_body: usize| &self.model().bodies[self.moving_bodies()[moving_body]].name;
        let bound = |name: String| {
            let (buffer, at) = self.element(symbol).expect("it is an element of an argument");
            let (name, buffer, at) = (ident(&name), ident(buffer), index(at));
            (quote! { #name }, Some(quote! { #buffer[#at] }))
        };
        match symbol {
            Symbol::Time => (quote! { t }, None),
            Symbol::Position { moving_body, k } => bound(format!("{}_r{}", body(moving_body), AXES[k])),
            Symbol::Euler { moving_body, k } => bound(format!("{}_e{k}", body(moving_body))),
            Symbol::Velocity { moving_body, k } => bound(format!("{}_s{}", body(moving_body), AXES[k])),
            Symbol::Spin { moving_body, k } => bound(format!("{}_w{}", body(moving_body), AXES[k])),
            Symbol::Chart { chart, k } => {
                let (name, chart, k) = (ident(&format!("chart{chart}_{k}")), index(chart), index(k));
                (quote! { #name }, Some(quote! { charts[#chart][#k] }))
            }
            Symbol::Parameter(parameter) => {
                let name = ident(&self.model().parameters[parameter].name);
                (quote! { self.parameters.#name }, None)
            }
            Symbol::ParameterSetup(place) => {
                let place = index(place);
                (quote! { self.derived[#place] }, None)
            }
            Symbol::Input(input) => {
                let name = ident(&self.model().inputs[input].name);
                (quote! { self.#name }, None)
            }
            Symbol::State(state) => bound(format!("state{state}")),
            Symbol::Turn(turn) => bound(format!("turn{turn}")),
            Symbol::Table { table, order } => {
                let (name, order) = (ident(&format!("table{table}")), index(order));
                (quote! { #name[#order] }, None)
            }
            Symbol::Acceleration { moving_body, k } => {
                let kind = if k < 3 { "ds" } else { "dw" };
                bound(format!("{}_{kind}{}", body(moving_body), AXES[k % 3]))
            }
            Symbol::RateOfRate(place) => bound(format!("a{place}")),
            Symbol::LoopMultiplier(row) => bound(format!("closing{row}")),
            Symbol::Change(row) => bound(format!("row{row}")),
            Symbol::Coordinate(place) => bound(format!("x{place}")),
            Symbol::Rate(place) => bound(format!("u{place}")),
            Symbol::Entry { array, row, column } => {
                let (array, row, column) = (kept_name(array), index(row), index(column));
                (quote! { #array[#row][#column] }, None)
            }
            Symbol::Local(_) => unreachable!("loops know what these are"),
            Symbol::Sine(_)
            | Symbol::Cosine(_)
            | Symbol::Unit(_)
            | Symbol::Angle(_)
            | Symbol::Rotation { .. }
            | Symbol::Relative { .. }
            | Symbol::RotationRate { .. }
            | Symbol::RelativeRate { .. } => {
                unreachable!("angles and rotations are expanded before they are written")
            }
        }
    }

    fn element(&self, symbol: Symbol) -> Option<(&'static str, usize)> {
        let name = |argument| match argument {
            Argument::State => "y",
            Argument::Joints => "x",
            Argument::Accelerations => "accelerations",
            Argument::Rows => "rows",
        };
        self.computed.equations.element(symbol).map(|(argument, place)| (name(argument), place))
    }
}
