//! The traits of the run time's contract that a module implements, each as the tables of `gyro_program` have it: types,
//! buffers, functions. What a trait has beside these (layouts, patterns, names) comes from the file of its subject.

use super::writer::ModuleWriter;
use crate::emit::names::{ident, index};
use gyro_model::Start;
use gyro_program::{Buffer, Group, Kernel, Space};
use proc_macro2::TokenStream;
use quote::quote;

impl ModuleWriter<'_> {
    /// All traits that the module has.
    pub fn contract(&self, start: &Start) -> TokenStream {
        Group::in_text()
            .filter(|&group| self.has(group))
            .map(|group| self.implementation(group, start))
            .collect()
    }

    /// Whether a trait is implemented: it is asked for, and the mechanism has it.
    fn has(&self, group: Group) -> bool {
        let e = self.equations;
        let Some(space) = &e.joint_space else {
            // Accelerations at corrected states are then those at any state.
            let needs_joints = group.with_needs().contains(&Group::Joint) && group != Group::Corrected;
            return e.functions.has(group) && !needs_joints;
        };
        let has_outputs = !self.kernels.roots(Kernel::JointOutputs).is_empty();
        match group {
            Group::Joint => true,
            Group::Jacobian => space.jacobian.is_some(),
            Group::ParameterJacobian => space.parameter_jacobian.is_some(),
            Group::JointOutputs => has_outputs,
            Group::OutputDerivatives => has_outputs && space.output_derivatives.is_some(),
            Group::Frames => space.frames.is_some(),
            group if Group::on_request().any(|other| other == group) => {
                space.on_request.forms.keys().any(|kernel| kernel.group() == group)
            }
            group => e.functions.has(group),
        }
    }

    fn implementation(&self, group: Group, start: &Start) -> TokenStream {
        if group == Group::Partition {
            return self.partition();
        }
        let (name, of) = (ident(self.type_name), ident(group.trait_name()));
        let scalar = (group == Group::Mechanism).then(|| quote! { type Scalar = T; });
        let types = Space::of(group).map(|space| self.associated(space));
        let [before, after, last] = self.beside(group, start);
        let buffers = Buffer::of(group).map(|buffer| self.buffer(buffer));
        let functions = Kernel::of(group).filter_map(|kernel| self.function_of(kernel));
        quote! {
            impl<T: gyro_sim::Scalar> gyro_sim::#of for #name<T> {
                #scalar
                #(#types)*
                #before
                #(#buffers)*
                #after
                #(#functions)*
                #last
            }
        }
    }

    /// What a trait has beside types, buffers and functions: before and after the buffers, and at its end.
    fn beside(&self, group: Group, start: &Start) -> [Option<TokenStream>; 3] {
        let space = self.equations.joint_space.as_ref();
        match group {
            Group::Mechanism => [Some(self.description()), Some(self.start(start)), Some(self.set_input())],
            Group::Kinematics => [None, Some(self.patterns()), None],
            Group::Joint => [
                space.map(|space| self.joint_layout(space)),
                space.map(|space| self.joint_start(space)),
                None,
            ],
            Group::Frames => {
                let names = space.and_then(|space| Some(&space.frames.as_ref()?.names));
                [
                    names.map(|names| quote! { fn frame_names(&self) -> &[&str] { &[#(#names),*] } }),
                    None,
                    None,
                ]
            }
            Group::MassMatrix => {
                let order = space.map(|space| space.on_request.mass_order.iter().copied().map(index));
                [None, order.map(|order| quote! { fn mass_order(&self) -> &[u16] { &[#(#order),*] } }), None]
            }
            _ => [None, None, None],
        }
    }

    fn associated(&self, space: Space) -> TokenStream {
        let (name, n) = (ident(space.name()), index(space.len(&self.counts)));
        let doc = (space == Space::Accelerations).then(|| {
            let doc = match self.equations.n_loop_multipliers() {
                0 => " (s̈, ẇ') of each body.".to_owned(),
                n => format!(" (s̈, ẇ') of each body, then {n} multipliers of the rows that close loops."),
            };
            quote! { #[doc = #doc] }
        });
        quote! { #doc type #name = [T; #n]; }
    }

    fn buffer(&self, buffer: &Buffer) -> TokenStream {
        let function = ident(buffer.function);
        let zeros = buffer.fields.iter().map(|(_, space)| match space.len(&self.counts) {
            0 if space.is_bare_if_empty() => quote! { [] },
            n => {
                let n = index(n);
                quote! { [T::constant(0.0); #n] }
            }
        });
        let Some(of) = buffer.returns.map(ident) else {
            let ty = ident(buffer.fields[0].1.name());
            return quote! { fn #function(&self) -> Self::#ty { #(#zeros)* } };
        };
        let fields = buffer.fields.iter().map(|(field, _)| ident(field));
        quote! {
            fn #function(&self) -> gyro_sim::#of<Self> {
                gyro_sim::#of { #(#fields: #zeros,)* }
            }
        }
    }

    /// A function of a trait; nothing where the trait's own does.
    fn function_of(&self, kernel: Kernel) -> Option<TokenStream> {
        let e = self.equations;
        let is_empty = self.kernels.roots(kernel).is_empty();
        match kernel {
            Kernel::ParameterSetup => None,
            Kernel::LoopClosure
            | Kernel::ClosureDistances
            | Kernel::ClosePositions
            | Kernel::CloseVelocities
                if self.counts.closure == 0 =>
            {
                None
            }
            Kernel::CorrectedAccelerations if e.joint_space.is_none() => Some(self.cut_accelerations()),
            Kernel::CorrectedDerivative if is_empty => Some(quote! {
                fn corrected_derivative(&self, t: T, y: &Self::State, dy: &mut Self::State) {
                    gyro_sim::Dynamics::derivative(self, t, y, dy);
                }
            }),
            Kernel::Outputs | Kernel::JointInputJacobian | Kernel::JointParameterJacobian if is_empty => {
                Some(self.idle(kernel))
            }
            _ => Some(self.written(kernel)),
        }
    }

    /// The accelerations at any state without the multipliers that come with them.
    fn cut_accelerations(&self) -> TokenStream {
        let e = self.equations;
        let [n_solved, n_velocities] = [e.solved.roots.len(), e.n_velocities()].map(index);
        let solved = if e.n_loop_multipliers() == 0 {
            quote! { gyro_sim::Dynamics::accelerations(self, t, y, out); }
        } else {
            quote! {
                let mut solved = [T::constant(0.0); #n_solved];
                gyro_sim::Dynamics::accelerations(self, t, y, &mut solved);
                out.copy_from_slice(&solved[..#n_velocities]);
            }
        };
        quote! {
            fn corrected_accelerations(&self, t: T, y: &Self::State, out: &mut Self::Velocities) {
                #solved
            }
        }
    }
}
