//! Where the variables of a module come from: the state and other arguments.

use super::writer::ModuleWriter;
use crate::emit::tokens::{Variables, ident, index};
use crate::expr::symbol::Symbol;
use proc_macro2::TokenStream;
use quote::quote;

/// `y`, the buffers of the partition, and `self`.
impl Variables for ModuleWriter<'_> {
    fn variable(&self, symbol: Symbol) -> (TokenStream, Option<TokenStream>) {
        const AXES: [&str; 3] = ["x", "y", "z"];
        let positions = 7 * self.equations.n_slots();
        let body = |slot: usize| &self.equations.model.bodies[self.slots()[slot]].name;
        let bound = |name: String, buffer: &str, at: usize| {
            let (name, buffer, at) = (ident(&name), ident(buffer), index(at));
            (quote! { #name }, Some(quote! { #buffer[#at] }))
        };
        let velocity = |slot: usize, k: usize| positions + 6 * slot + k;
        match symbol {
            Symbol::Time => (quote! { t }, None),
            Symbol::Position { slot, k } => bound(format!("{}_r{}", body(slot), AXES[k]), "y", 7 * slot + k),
            Symbol::Euler { slot, k } => bound(format!("{}_e{k}", body(slot)), "y", 7 * slot + 3 + k),
            Symbol::Velocity { slot, k } => {
                bound(format!("{}_s{}", body(slot), AXES[k]), "y", velocity(slot, k))
            }
            Symbol::Spin { slot, k } => {
                bound(format!("{}_w{}", body(slot), AXES[k]), "y", velocity(slot, k + 3))
            }
            Symbol::Chart { chart, k } => {
                let (name, chart, k) = (ident(&format!("chart{chart}_{k}")), index(chart), index(k));
                (quote! { #name }, Some(quote! { charts[#chart][#k] }))
            }
            Symbol::Parameter(parameter) => {
                let name = ident(&self.equations.model.parameters[parameter].name);
                (quote! { self.parameters.#name }, None)
            }
            Symbol::SetUp(place) => {
                let place = index(place);
                (quote! { self.derived[#place] }, None)
            }
            Symbol::Input(input) => {
                let name = ident(&self.equations.model.inputs[input].name);
                (quote! { self.#name }, None)
            }
            Symbol::Turn(turn) => {
                let work = usize::from(self.equations.power.is_some());
                bound(format!("turn{turn}"), "y", 13 * self.equations.n_slots() + work + turn)
            }
            Symbol::Table { table, order } => {
                let (name, order) = (ident(&format!("table{table}")), index(order));
                (quote! { #name[#order] }, None)
            }
            Symbol::Acceleration { slot, k } => {
                let kind = if k < 3 { "ds" } else { "dw" };
                bound(format!("{}_{kind}{}", body(slot), AXES[k % 3]), "accelerations", 6 * slot + k)
            }
            Symbol::Closing(row) => {
                bound(format!("closing{row}"), "accelerations", self.equations.n_velocities() + row)
            }
            Symbol::Change(row) => bound(format!("row{row}"), "rows", row),
            Symbol::Coordinate(place) => bound(format!("x{place}"), "x", place),
            Symbol::Rate(place) => {
                let first = self.equations.joint_space.as_ref().map_or(0, |space| space.layout.n_coordinates);
                bound(format!("u{place}"), "x", first + place)
            }
            Symbol::Sine(_)
            | Symbol::Cosine(_)
            | Symbol::Angle(_)
            | Symbol::RateOfRate(_)
            | Symbol::Rotation { .. }
            | Symbol::Relative { .. }
            | Symbol::RotationRate { .. }
            | Symbol::RelativeRate { .. } => {
                unreachable!("angles, rotations and rates' rates are expanded before they are written")
            }
        }
    }
}
