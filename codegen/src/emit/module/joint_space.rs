//! Joint coordinates.

use super::writer::ModuleWriter;
use crate::emit::literals::float;
use crate::emit::names::{ident, index};
use crate::emit::results::{Value, filled, stored};
use crate::emit::tokens::Body;
use crate::joint_space::JointSpace;
use crate::kernels::Kernel;
use crate::scheduled::{self, JointPlace};
use proc_macro2::TokenStream;
use quote::quote;

impl ModuleWriter<'_> {
    /// Nothing unless it is asked for and joint coordinates describe the mechanism.
    pub fn joint_space(&self) -> Option<TokenStream> {
        let space = self.equations.joint_space.as_ref()?;
        let name = ident(self.type_name);
        let (n_x, n_u) = (space.layout.n_coordinates, space.layout.n_rates);
        let n_work = usize::from(self.equations.power.is_some());
        let start: Vec<_> = space.start.iter().copied().chain((0..n_work).map(|_| 0.0)).collect();
        let start = start.iter().map(|&x| if x == 0.0 { float(0.0) } else { float(x) });
        let (n_joints, n_rates) = (index(n_x + n_u + n_work), index(n_u));
        let accelerations = self.of_joints(
            Kernel::JointAccelerations,
            "Writes u̇",
            &quote! { out: &mut Self::Rates },
            |values| filled("out", values),
        );
        let derivative = self.joint_derivative(n_x, n_u);
        let to_maximal = self.to_maximal(n_x + n_u);
        let to_joints = self.to_joints(n_x + n_u);
        let layout = self.joint_layout(space);
        let n_closure = index(space.closure_rows.len());
        let zero_closure = match space.closure_rows.len() {
            0 => quote! { [] },
            _ => quote! { [T::constant(0.0); #n_closure] },
        };
        let closure = self.closure(space);
        Some(quote! {
            impl<T: gyro_sim::Scalar> gyro_sim::JointSpace for #name<T> {
                type Joints = [T; #n_joints];
                type Rates = [T; #n_rates];
                type Closure = [T; #n_closure];

                #layout
                fn joint_buffers(&self) -> gyro_sim::JointBuffers<Self> {
                    gyro_sim::JointBuffers {
                        rates: [T::constant(0.0); #n_rates],
                        closure: #zero_closure,
                    }
                }
                fn joint_start(&self) -> Self::Joints {
                    let k = T::constant;
                    [#(k(#start)),*]
                }

                #accelerations
                #derivative
                #to_maximal
                #to_joints
                #closure
            }
        })
    }

    /// What stands where in a joint state.
    fn joint_layout(&self, space: &JointSpace) -> TokenStream {
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

    /// Nothing for trees.
    fn closure(&self, space: &JointSpace) -> Option<TokenStream> {
        if space.closure_rows.is_empty() {
            return None;
        }
        let rows = self.of_joints(
            Kernel::LoopClosure,
            "Writes Φ of the joints that close loops",
            &quote! { out: &mut Self::Closure },
            |values| filled("out", values),
        );
        let distances = self.of_joints(
            Kernel::ClosureDistances,
            "Writes squares of distances between the rows of the loops' Jacobian",
            &quote! { out: &mut Self::Closure },
            |values| filled("out", values),
        );
        let what = "One Newton step of the joint coordinates towards closed loops";
        let positions = self.closing(Kernel::ClosePositions, what);
        let what = "Changes the rates such that loops stay closed";
        let velocities = self.closing(Kernel::CloseVelocities, what);
        Some(quote! {
            #rows
            #distances
            #positions
            #velocities
        })
    }

    /// A function that overwrites part of the joint state; what keeps its value is not stored again.
    fn closing(&self, kernel: Kernel, what: &str) -> TokenStream {
        let (places, roots) = scheduled::stores(self.equations, kernel, self.kernels.roots(kernel));
        let name = ident(kernel.name());
        self.function(what, &roots, |body, t, _| {
            let (statements, stored) = (&body.statements, stored("x", &places, &body.values));
            quote! {
                fn #name(&self, #t: T, x: &mut Self::Joints) {
                    #statements
                    #stored
                }
            }
        })
    }

    /// Elements of ∂f/∂x.
    fn n_by_state(&self, space: &JointSpace) -> usize {
        let n_joints = space.start.len() + usize::from(self.equations.power.is_some());
        n_joints * n_joints
    }

    /// Nothing unless it is asked for and the mechanism is not too large.
    pub fn joint_jacobian(&self) -> Option<TokenStream> {
        let space = self.equations.joint_space.as_ref()?;
        let by_inputs = space.jacobian.as_ref()?.by_inputs.roots.len();
        let (name, n_by_state) = (ident(self.type_name), self.n_by_state(space));
        let [n, n_by_inputs] = [n_by_state, by_inputs].map(index);
        let out = quote! { dfdx: &mut Self::Jacobian, dfdt: &mut Self::Joints };
        let what = "Writes ∂f/∂x and ∂f/∂t";
        let by_state = self.of_joints(Kernel::JointJacobian, what, &out, |values| {
            let (by_state, by_time) = values.split_at(n_by_state);
            quote! {
                *dfdx = [#(#by_state),*];
                *dfdt = [#(#by_time),*];
            }
        });
        let by_inputs = if self.kernels.roots(Kernel::JointInputJacobian).is_empty() {
            quote! {
                fn joint_input_jacobian(&self, _t: T, _x: &Self::Joints, _out: &mut Self::InputJacobian) {}
            }
        } else {
            let out = quote! { out: &mut Self::InputJacobian };
            let write = |values: &[Value]| filled("out", values);
            self.of_joints(Kernel::JointInputJacobian, "Writes ∂f/∂(inputs)", &out, write)
        };
        Some(quote! {
            impl<T: gyro_sim::Scalar> gyro_sim::JointJacobian for #name<T> {
                type Jacobian = [T; #n];
                type InputJacobian = [T; #n_by_inputs];

                fn jacobian_buffers(&self) -> gyro_sim::JacobianBuffers<Self> {
                    gyro_sim::JacobianBuffers {
                        jacobian: [T::constant(0.0); #n],
                        input_jacobian: [T::constant(0.0); #n_by_inputs],
                    }
                }

                #by_state
                #by_inputs
            }
        })
    }

    /// Nothing unless it is asked for and the mechanism is not too large.
    pub fn parameter_jacobian(&self) -> Option<TokenStream> {
        let space = self.equations.joint_space.as_ref()?;
        let n = index(space.parameter_jacobian.as_ref()?.0.roots.len());
        let name = ident(self.type_name);
        let function = if self.kernels.roots(Kernel::JointParameterJacobian).is_empty() {
            quote! {
                fn joint_parameter_jacobian(&self, _t: T, _x: &Self::Joints, _out: &mut Self::ParameterJacobian) {}
            }
        } else {
            let out = quote! { out: &mut Self::ParameterJacobian };
            let write = |values: &[Value]| filled("out", values);
            self.of_joints(Kernel::JointParameterJacobian, "Writes ∂f/∂(parameters)", &out, write)
        };
        Some(quote! {
            impl<T: gyro_sim::Scalar> gyro_sim::ParameterJacobian for #name<T> {
                type ParameterJacobian = [T; #n];

                fn parameter_buffer(&self) -> Self::ParameterJacobian {
                    [T::constant(0.0); #n]
                }

                #function
            }
        })
    }

    /// A function of time and joint state.
    pub fn of_joints(
        &self,
        kernel: Kernel,
        what: &str,
        out: &TokenStream,
        write: impl Fn(&[Value]) -> TokenStream,
    ) -> TokenStream {
        self.function(what, self.kernels.roots(kernel), |body, t, x| {
            of_joints(kernel, [t, &quote! { #x }, out], body, write(&body.values))
        })
    }

    fn joint_derivative(&self, n_x: usize, n_u: usize) -> TokenStream {
        let what = "Writes the derivative of the joint state; beyond what [`gyro_sim::JointSpace::joint_accelerations`] takes";
        self.function(what, self.kernels.roots(Kernel::JointDerivative), |body, _, _| {
            let (statements, (coordinates, rest)) = (&body.statements, body.values.split_at(n_x));
            let (solved, n_rates) = ((0..n_u).map(|k| Value::of_buffer("rates", k)), index(n_u));
            let values: Vec<Value> =
                coordinates.iter().cloned().chain(solved).chain(rest.iter().cloned()).collect();
            let filled = filled("dx", &values);
            quote! {
                fn joint_derivative(&self, t: T, x: &Self::Joints, dx: &mut Self::Joints) {
                    let mut rates = [T::constant(0.0); #n_rates];
                    gyro_sim::JointSpace::joint_accelerations(self, t, x, &mut rates);
                    #statements
                    #filled
                }
            }
        })
    }

    fn to_maximal(&self, work_at: usize) -> TokenStream {
        let n_state = 13 * self.equations.n_moving_bodies();
        let work = self.equations.power.is_some();
        let out = quote! { y: &mut Self::State };
        let what = "Writes the maximal state of a joint state";
        self.function(what, self.kernels.roots(Kernel::ToMaximal), |body, t, x| {
            let (state, turns) = body.values.split_at(n_state);
            let work_done = work.then(|| Value::of_buffer("x", work_at));
            let values: Vec<Value> =
                state.iter().cloned().chain(work_done).chain(turns.iter().cloned()).collect();
            let x = if work {
                quote! { x }
            } else {
                quote! { #x }
            };
            of_joints(Kernel::ToMaximal, [t, &x, &out], body, filled("y", &values))
        })
    }

    fn to_joints(&self, n: usize) -> TokenStream {
        let work = self.equations.power.is_some().then(|| index(13 * self.equations.n_moving_bodies()));
        let places: Vec<usize> = (0..n).collect();
        let at = index(n);
        let work = work.map(|work| quote! { x[#at] = y[#work]; });
        let what = "Writes the joint state of a maximal state";
        self.function(what, self.kernels.roots(Kernel::ToJoints), |body, t, y| {
            let (statements, stored) = (&body.statements, stored("x", &places, &body.values));
            let y = if work.is_some() {
                quote! { y }
            } else {
                quote! { #y }
            };
            quote! {
                fn to_joints(&self, #t: T, #y: &Self::State, x: &mut Self::Joints) {
                    #statements
                    #stored
                    #work
                }
            }
        })
    }
}

/// A function of time and joint state, with its arguments t and x as they are called where nothing reads them.
fn of_joints(
    kernel: Kernel,
    [t, x, out]: [&TokenStream; 3],
    body: &Body,
    written: TokenStream,
) -> TokenStream {
    let (name, statements) = (ident(kernel.name()), &body.statements);
    quote! {
        fn #name(&self, #t: T, #x: &Self::Joints, #out) {
            #statements
            #written
        }
    }
}
