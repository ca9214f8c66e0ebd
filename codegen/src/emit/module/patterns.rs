//! What of a mechanism is known before it moves: where the numbers of sparse matrices and of joint states stand.

use super::writer::ModuleWriter;
use crate::emit::literals::float;
use crate::emit::names::index;
use crate::equations::Sparse;
use crate::joint_space::JointSpace;
use crate::scheduled::{self, JointPlace};
use proc_macro2::TokenStream;
use quote::quote;

impl ModuleWriter<'_> {
    /// Rows and columns of the non-zeros of Φ_q and (Φ_r, Φ_π').
    pub fn patterns(&self) -> TokenStream {
        let (phi_q, phi_pi) = (pattern(&self.equations.phi_q), pattern(&self.equations.phi_pi));
        quote! {
            fn phi_q_pattern(&self) -> &[(u16, u16)] {
                &[#(#phi_q),*]
            }
            fn phi_pi_pattern(&self) -> &[(u16, u16)] {
                &[#(#phi_pi),*]
            }
        }
    }

    /// The joint state at the start, without work so far.
    pub fn joint_start(&self, space: &JointSpace) -> TokenStream {
        let start = space.start.iter().copied().chain((0..self.counts.work).map(|_| 0.0));
        let start = start.map(|x| if x == 0.0 { float(0.0) } else { float(x) });
        quote! {
            fn joint_start(&self) -> Self::Joints {
                let k = T::constant;
                [#(k(#start)),*]
            }
        }
    }

    /// What stands where in a joint state.
    pub fn joint_layout(&self, space: &JointSpace) -> TokenStream {
        let places = scheduled::places(self.equations.model, space).into_iter().map(|place| match place {
            JointPlace::Scalar { joint, coordinate } => {
                let [joint, coordinate] = [joint, coordinate].map(index);
                quote! { gyro_sim::JointPlace::Scalar { joint: #joint, coordinate: #coordinate } }
            }
            JointPlace::Orientation { joint } => {
                let joint = index(joint);
                quote! { gyro_sim::JointPlace::Orientation { joint: #joint } }
            }
            JointPlace::Turn { joint, coordinate } => {
                let [joint, coordinate] = [joint, coordinate].map(index);
                quote! { gyro_sim::JointPlace::Turn { joint: #joint, coordinate: #coordinate } }
            }
            JointPlace::Body { body } => {
                let body = index(body);
                quote! { gyro_sim::JointPlace::Body { body: #body } }
            }
        });
        let closure_rows = space.closure_rows.iter().copied().map(index);
        quote! {
            fn joint_layout(&self) -> &gyro_sim::JointLayout<'_> {
                const LAYOUT: gyro_sim::JointLayout<'static> = gyro_sim::JointLayout {
                    places: &[#(#places),*],
                    closure_rows: &[#(#closure_rows),*],
                };
                &LAYOUT
            }
        }
    }
}

fn pattern(sparse: &Sparse) -> impl Iterator<Item = TokenStream> + '_ {
    sparse.0.iter().map(|&(row, column, _)| {
        let (row, column) = (index(row), index(column));
        quote! { (#row, #column) }
    })
}
