//! What of a mechanism is known before it moves: where the numbers of sparse matrices and of joint states stand.

use super::writer::ModuleWriter;
use crate::emit::literals::float;
use crate::emit::names::index;
use crate::scheduled::{JointForm, JointPlace};
use proc_macro2::TokenStream;
use quote::quote;

impl ModuleWriter<'_> {
    /// Rows and columns of the non-zeros of Φ_q and (Φ_r, Φ_π').
    pub fn patterns(&self) -> TokenStream {
        let (phi_q, phi_pi) = (&self.scheduled.phi_q_pattern, &self.scheduled.phi_pi_pattern);
        let [phi_q, phi_pi] = [phi_q, phi_pi].map(|pattern| pattern.iter().map(pair));
        quote! {
            fn phi_q_pattern(&self) -> &[(u16, u16)] {
                &[#(#phi_q),*]
            }
            fn phi_pi_pattern(&self) -> &[(u16, u16)] {
                &[#(#phi_pi),*]
            }
        }
    }
}

fn pair(&(row, column): &(usize, usize)) -> TokenStream {
    let (row, column) = (index(row), index(column));
    quote! { (#row, #column) }
}

/// Numbers of a start.
pub fn without_signs_of_zeros(start: &[f64]) -> impl Iterator<Item = TokenStream> {
    start.iter().map(|x| float(x + 0.0))
}

/// The joint state at the start, without work so far.
pub fn joint_start(joint: &JointForm) -> TokenStream {
    let start = without_signs_of_zeros(&joint.start);
    quote! {
        fn joint_start(&self) -> Self::Joints {
            let k = T::constant;
            [#(k(#start)),*]
        }
    }
}

/// What stands where in a joint state.
pub fn joint_layout(joint: &JointForm) -> TokenStream {
    let places = joint.places.iter().map(|place| match *place {
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
        JointPlace::State { state } => {
            let state = index(state);
            quote! { gyro_sim::JointPlace::State { state: #state } }
        }
        JointPlace::Body { body } => {
            let body = index(body);
            quote! { gyro_sim::JointPlace::Body { body: #body } }
        }
    });
    let closure_rows = joint.closure_rows.iter().copied().map(index);
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
