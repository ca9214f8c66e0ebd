//! A mechanism whose kernels are data, with what computes them.

use crate::description::{OwnedDescription, OwnedLayout, narrow};
use crate::engine::{Arguments, Engine, Layout, reads_given};
use gyro_codegen::{JointForm, Scheduled};
use gyro_model::Model;
use gyro_program::{Group, Kernel, Space};
use gyro_sim::Scalar;
use std::cell::RefCell;
use std::sync::Arc;

/// A mechanism with its kernels, computed by `E` in numbers `T`.
///
/// It implements all traits of `gyro-sim`'s contract. What was not asked for, or what the mechanism does not have (like
/// joint coordinates, without which [`Scheduled::joint`] is empty), has no numbers: its functions write nothing.
#[derive(Clone, Debug)]
pub struct InProcess<T, E> {
    pub(crate) shared: Arc<Shared>,
    pub(crate) engine: E,
    /// Parameters, what depends on them alone, and inputs.
    own: Vec<T>,
    /// What one kernel gives another. A mechanism is constant to its callers, so it is borrowed inside each call and
    /// never across.
    given: RefCell<Vec<T>>,
}

/// What all instances of a mechanism have in common.
#[derive(Debug)]
pub(crate) struct Shared {
    pub(crate) scheduled: Scheduled,
    pub(crate) description: OwnedDescription,
    pub(crate) phi_q_pattern: Vec<(u16, u16)>,
    pub(crate) phi_pi_pattern: Vec<(u16, u16)>,
    pub(crate) joint: JointForm,
    pub(crate) layout_of_joints: OwnedLayout,
    pub(crate) mass_order: Vec<u16>,
    pub(crate) parameters: Vec<f64>,
    pub(crate) inputs: Vec<f64>,
    pub(crate) layout: Layout,
    /// By kernel.
    pub(crate) reads_given: Vec<bool>,
}

impl Shared {
    /// What a model and its kernels tell.
    pub(crate) fn new(model: &Model, scheduled: Scheduled) -> Arc<Self> {
        let pattern = |pattern: &[(usize, usize)]| {
            pattern.iter().map(|&(row, column)| (narrow(row), narrow(column))).collect()
        };
        let joint = scheduled.joint.clone().unwrap_or(JointForm {
            n_coordinates: 0,
            n_rates: 0,
            places: Vec::new(),
            closure_rows: Vec::new(),
            start: Vec::new(),
        });
        let values = |numbers: &[gyro_model::Parameter]| {
            numbers.iter().map(|p| gyro_model::to_f64(&p.value)).collect()
        };
        Arc::new(Self {
            description: OwnedDescription::new(model),
            phi_q_pattern: pattern(&scheduled.phi_q_pattern),
            phi_pi_pattern: pattern(&scheduled.phi_pi_pattern),
            layout_of_joints: OwnedLayout::new(&joint),
            mass_order: scheduled.mass_order.iter().copied().map(narrow).collect(),
            joint,
            parameters: values(&model.parameters),
            inputs: values(&model.inputs),
            layout: Layout::of(&scheduled, model.parameters.len()),
            reads_given: Kernel::all().map(|kernel| reads_given(&scheduled, kernel)).collect(),
            scheduled,
        })
    }
}

impl<T: Scalar, E: Engine<T>> InProcess<T, E> {
    pub(crate) fn with(shared: Arc<Shared>, engine: E) -> Self {
        let Shared { parameters, inputs, layout, .. } = &*shared;
        let zeros = vec![0.0; layout.first_input - layout.first_derived];
        let own = [&parameters[..], &zeros, inputs].concat().into_iter().map(T::constant).collect();
        let mut mechanism = Self { shared, engine, own, given: RefCell::default() };
        mechanism.set_up();
        mechanism
    }

    /// What computes the kernels.
    pub fn engine(&self) -> &E {
        &self.engine
    }

    /// The kernels as data.
    pub fn scheduled(&self) -> &Scheduled {
        &self.shared.scheduled
    }

    /// Sets a parameter by its place in the model file; returns whether there is one.
    pub fn set_parameter(&mut self, index: usize, value: T) -> bool {
        let parameters = &mut self.own[..self.shared.layout.first_derived];
        let is_there = parameters.get_mut(index).map(|parameter| *parameter = value).is_some();
        if is_there {
            self.set_up();
        }
        is_there
    }

    /// Sets all parameters, in the order of the model file.
    ///
    /// # Panics
    /// If there are not as many.
    pub fn set_parameters(&mut self, values: &[T]) {
        self.own[..self.shared.layout.first_derived].copy_from_slice(values);
        self.set_up();
    }

    /// The parameters, in the order of the model file.
    pub fn parameters(&self) -> &[T] {
        &self.own[..self.shared.layout.first_derived]
    }

    /// Whether it has the derivatives of its joint form.
    pub fn has_jacobian(&self) -> bool {
        self.has(Kernel::JointJacobian)
    }

    pub(crate) fn set_own_input(&mut self, index: usize, value: T) -> bool {
        let inputs = &mut self.own[self.shared.layout.first_input..];
        inputs.get_mut(index).map(|input| *input = value).is_some()
    }

    /// Computes what depends on parameters alone.
    fn set_up(&mut self) {
        let Layout { first_derived, first_input } = self.shared.layout;
        let mut derived = vec![T::constant(0.0); first_input - first_derived];
        self.compute(Kernel::ParameterSetup, T::constant(0.0), (&[], &[]), &mut derived);
        self.own[first_derived..first_input].copy_from_slice(&derived);
    }

    pub(crate) fn has(&self, kernel: Kernel) -> bool {
        self.shared.scheduled.kernels.contains_key(&kernel)
    }

    /// Computes a kernel from a state and what is given with it; nothing if the mechanism has none of this name.
    pub(crate) fn compute(&self, kernel: Kernel, t: T, (state, given): (&[T], &[T]), out: &mut [T]) {
        let arguments = Arguments { t, state, given, own: &self.own, out };
        self.engine.compute(&self.shared.scheduled, kernel, arguments);
    }

    /// The same from a state alone.
    pub(crate) fn fill(&self, kernel: Kernel, t: T, state: &[T], out: &mut [T]) {
        self.compute(kernel, t, (state, &[]), out);
    }

    /// Lends work space of so many numbers.
    pub(crate) fn with_given<R>(&self, len: usize, f: impl FnOnce(&mut [T]) -> R) -> R {
        let mut given = self.given.borrow_mut();
        if given.len() < len {
            given.resize(len, T::constant(0.0));
        }
        f(&mut given[..len])
    }

    pub(crate) fn zeros(&self, len: usize) -> Vec<T> {
        vec![T::constant(0.0); len]
    }

    /// How many numbers an array holds.
    pub(crate) fn len(&self, space: Space) -> usize {
        space.len(&self.shared.scheduled.counts)
    }

    /// An array of zeros; of functions that are not there an empty one.
    pub(crate) fn buffer(&self, space: Space) -> Vec<T> {
        let is_on_request = Group::on_request().chain([Group::Jacobian]).any(|group| group == space.group());
        let is_there = !is_on_request || Kernel::of(space.group()).any(|kernel| self.has(kernel));
        self.zeros(if is_there { self.len(space) } else { 0 })
    }
}
