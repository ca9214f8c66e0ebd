//! The traits of the run time's contract that a module implements, each as the tables of `gyro_program` have it: types,
//! buffers, functions. What a trait has beside these (layouts, patterns, names) comes from the file of its subject.

use super::patterns::{joint_layout, joint_start};
use super::writer::ModuleWriter;
use crate::emit::names::{ident, index};
use crate::scheduled::Origin;
use gyro_program::{Buffer, Group, Kernel, Space};
use proc_macro2::TokenStream;
use quote::quote;

impl ModuleWriter<'_> {
    /// All traits that the module has.
    pub fn contract(&self) -> TokenStream {
        self.scheduled.groups.iter().map(|&group| self.implementation(group)).collect()
    }

    fn implementation(&self, group: Group) -> TokenStream {
        if group == Group::Partition {
            return self.partition();
        }
        let (name, of) = (ident(self.type_name), ident(group.trait_name()));
        let scalar = (group == Group::Mechanism).then(|| quote! { type Scalar = T; });
        let types = Space::of(group).map(|space| self.associated(space));
        let [before, after, last] = self.beside(group);
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
    fn beside(&self, group: Group) -> [Option<TokenStream>; 3] {
        match group {
            Group::Mechanism => [Some(self.description()), Some(self.start()), Some(self.set_input())],
            Group::Kinematics => [None, Some(self.patterns()), None],
            Group::Joint => {
                let joint = self.scheduled.joint.as_ref();
                [joint.map(joint_layout), joint.map(joint_start), None]
            }
            Group::Frames => {
                let space = self.computed.equations.joint_space.as_ref();
                let names = space.and_then(|space| Some(&space.frames.as_ref()?.names));
                let function =
                    |names: &Vec<String>| quote! { fn frame_names(&self) -> &[&str] { &[#(#names),*] } };
                [names.map(function), None, None]
            }
            Group::MassMatrix => {
                let order = self.scheduled.mass_order.iter().copied().map(index);
                [None, Some(quote! { fn mass_order(&self) -> &[u16] { &[#(#order),*] } }), None]
            }
            _ => [None, None, None],
        }
    }

    fn associated(&self, space: Space) -> TokenStream {
        let (name, n) = (ident(space.name()), index(space.len(self.counts())));
        let doc = (space == Space::Accelerations).then(|| {
            let doc = match self.counts().accelerations.saturating_sub(6 * self.counts().bodies) {
                0 => " (s̈, ẇ') of each body.".to_owned(),
                n => format!(" (s̈, ẇ') of each body, then {n} multipliers of the rows that close loops."),
            };
            quote! { #[doc = #doc] }
        });
        quote! { #doc type #name = [T; #n]; }
    }

    fn buffer(&self, buffer: &Buffer) -> TokenStream {
        let function = ident(buffer.function);
        let zeros = buffer.fields.iter().map(|(_, space)| match space.len(self.counts()) {
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
        // The constructor calls it, and it is no function of a trait.
        let kernel = (kernel != Kernel::ParameterSetup).then_some(kernel)?;
        Some(match *self.scheduled.origins.get(&kernel)? {
            Origin::Kernel => self.written(kernel),
            Origin::Idle => self.idle(kernel),
            Origin::Other(other) => self.of_other(kernel, other),
        })
    }

    /// The first results of another function: all, or without the multipliers that come with accelerations.
    fn of_other(&self, kernel: Kernel, other: Kernel) -> TokenStream {
        let [(out, space), ..] = kernel.signature().written()[..] else { return quote! {} };
        let n = space.len(self.counts());
        let n_solved = other.signature().n_results(self.counts()).unwrap_or(n);
        let (name, out, space) = (ident(kernel.name()), ident(out), ident(space.name()));
        let (of, other) = (ident(other.group().trait_name()), ident(other.name()));
        let statements = if n == n_solved {
            quote! { gyro_sim::#of::#other(self, t, y, #out); }
        } else {
            let [n, n_solved] = [n, n_solved].map(index);
            quote! {
                let mut solved = [T::constant(0.0); #n_solved];
                gyro_sim::#of::#other(self, t, y, &mut solved);
                #out.copy_from_slice(&solved[..#n]);
            }
        };
        quote! { fn #name(&self, t: T, y: &Self::State, #out: &mut Self::#space) { #statements } }
    }
}
