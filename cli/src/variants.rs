//! A model without one of its elements, or with more of its numbers tunable: what an element costs is the difference.

use gyro_model::{
    Between, Coupler, ForceKind, Formula, Joint, JointEnd, Model, Number, Operation, OutputKind, Parameter,
    Rational, Seen, Support, analyse,
};

/// A model with one thing changed.
#[derive(Debug)]
pub(crate) struct Variant {
    /// What is different, in words.
    pub(crate) what: String,
    /// The model; why there is none, if it cannot be assembled.
    pub(crate) model: Result<Model, String>,
}

/// All variants of a model, one element at a time.
pub(crate) fn variants(model: &Model) -> Vec<Variant> {
    let mut changes = Changes { model, variants: Vec::new() };
    changes.without_elements();
    changes.without_offsets();
    changes.with_bodies_at_rest();
    changes.with_inputs();
    changes.with_free_numbers();
    changes.variants
}

struct Changes<'a> {
    model: &'a Model,
    variants: Vec<Variant>,
}

impl Changes<'_> {
    fn add(&mut self, what: String, change: impl FnOnce(&mut Model)) {
        let mut model = self.model.clone();
        change(&mut model);
        // Other rows may depend on each other now.
        let model = analyse(&model).map_err(|error| error.to_string()).map(|analysis| {
            model.redundant = analysis.redundant;
            model
        });
        self.variants.push(Variant { what, model });
    }

    /// Gravity, friction, forces, outputs.
    fn without_elements(&mut self) {
        let model = self.model;
        if !are_zero(&model.gravity) || model.attraction.is_some() {
            self.add("without gravity".to_owned(), |model| {
                (model.gravity, model.attraction) = (zeros(), None);
            });
        }
        for (index, joint) in model.joints.iter().enumerate().filter(|(_, joint)| !joint.damping.is_zero()) {
            self.add(format!("without the friction of `{}`", joint.name), |model| {
                model.joints[index].damping = Number::integer(0);
            });
        }
        for (index, force) in model.forces.iter().enumerate() {
            let told =
                model.outputs.iter().enumerate().filter(|(_, output)| of_force(&output.kind) == Some(index));
            let told: Vec<usize> = told.map(|(output, _)| output).collect();
            if told.iter().any(|output| is_seen(model, *output)) {
                continue;
            }
            self.add(format!("without force `{}`", force.name), |model| {
                told.into_iter().for_each(|output| model.outputs[output].kind = nothing());
                model.forces.remove(index);
                let others = model.outputs.iter_mut().filter_map(|output| of_force_mut(&mut output.kind));
                others.filter(|force| **force > index).for_each(|force| *force -= 1);
            });
        }
        for (index, output) in model.outputs.iter().enumerate() {
            if is_seen(model, index) || matches!(output.kind, OutputKind::State { .. }) {
                continue;
            }
            self.add(format!("without output `{}`", output.name), |model| {
                model.outputs[index].kind = nothing();
            });
        }
    }

    /// Each joint point at its body's mass centre.
    fn without_offsets(&mut self) {
        let ends: [fn(&mut Joint) -> &mut JointEnd; 2] =
            [|joint| &mut joint.first, |joint| &mut joint.second];
        for (index, joint) in self.model.joints.iter().enumerate() {
            for (end, of) in [&joint.first, &joint.second].into_iter().zip(ends) {
                if !are_zero(&end.point) {
                    let body = &self.model.bodies[end.body].name;
                    self.add(format!("without the offset of `{}` on `{body}`", joint.name), |model| {
                        of(&mut model.joints[index]).point = zeros();
                    });
                }
            }
        }
    }

    /// What is driven or constrained, fixed and folded.
    fn with_bodies_at_rest(&mut self) {
        for (index, body) in self.model.bodies.iter().enumerate() {
            if matches!(body.support, Support::Driven | Support::Constrained) {
                self.add(format!("with `{}` fixed", body.name), |model| {
                    let body = &mut model.bodies[index];
                    (body.support, body.motion) = (Support::Fixed, None);
                });
            }
        }
    }

    /// Formulas of strengths and rates become inputs: what is left is mechanics alone.
    fn with_inputs(&mut self) {
        if laws(&mut self.model.clone()).next().is_none() {
            return;
        }
        self.add("with an input in place of each formula".to_owned(), |model| {
            let first = model.inputs.len();
            let mut known: Vec<String> = Vec::new();
            for law in laws(model) {
                let text = law.formula().map_or_else(String::new, |formula| formula.text.clone());
                let place = known.iter().position(|other| *other == text).unwrap_or(known.len());
                if place == known.len() {
                    known.push(text);
                }
                *law = Number::Input { index: first + place, negated: false };
            }
            let input = |place| Parameter { name: format!("law_{place}"), value: Rational::default() };
            model.inputs.extend((first..first + known.len()).map(input));
            model.between.resize(model.inputs.len(), Between::default());
        });
    }

    /// Numbers become parameters: those that are not zero, so that what the model is built like stays; of the geometry
    /// all, too.
    fn with_free_numbers(&mut self) {
        self.add("with free masses and inertias".to_owned(), |model| {
            let bodies = model.bodies.iter_mut().filter(|body| body.support.has_coordinates());
            let numbers = bodies.flat_map(|body| [&mut body.mass].into_iter().chain(&mut body.inertia));
            free(numbers.filter(|number| !number.is_zero()), &mut model.parameters);
        });
        self.add("with free joint points".to_owned(), |model| {
            let ends = model.joints.iter_mut().flat_map(|joint| [&mut joint.first, &mut joint.second]);
            let numbers = ends.flat_map(|end| &mut end.point);
            free(numbers.filter(|number| !number.is_zero()), &mut model.parameters);
        });
        self.add("with a free geometry".to_owned(), |model| {
            free(geometry(&mut model.joints).filter(|number| !number.is_zero()), &mut model.parameters);
        });
        self.add("with a free geometry, zeros too".to_owned(), |model| {
            free(geometry(&mut model.joints), &mut model.parameters);
        });
    }
}

/// Whether a force, a state, a row or another output depends on an output: such a model cannot be without it.
fn is_seen(model: &Model, output: usize) -> bool {
    let sees = |seen: Seen| matches!(seen, Seen::Output { output: of, .. } if of == output);
    let of_rows = model.couplers.iter().flat_map(Coupler::outputs);
    model.laws().flat_map(Formula::sees).any(sees) || of_rows.into_iter().any(|of| of == output)
}

/// The force that an output tells.
fn of_force(kind: &OutputKind) -> Option<usize> {
    of_force_mut(&mut kind.clone()).copied()
}

fn of_force_mut(kind: &mut OutputKind) -> Option<&mut usize> {
    match kind {
        OutputKind::Spring { force } | OutputKind::Link { force } | OutputKind::Bushing { force } => {
            Some(force)
        }
        _ => None,
    }
}

/// An output that takes no operation, in the place of one that others count from.
fn nothing() -> OutputKind {
    let operations = vec![Operation::Number(Number::integer(0))];
    OutputKind::Formula(Formula::smooth("0", operations))
}

fn zeros() -> [Number; 3] {
    [0; 3].map(Number::integer)
}

fn are_zero(numbers: &[Number]) -> bool {
    numbers.iter().all(Number::is_zero)
}

/// The formulas of motors, loads, links and states.
fn laws(model: &mut Model) -> impl Iterator<Item = &mut Number> {
    let of_forces = model.forces.iter_mut().flat_map(|force| match &mut force.kind {
        ForceKind::Motor { value, .. } => vec![value],
        ForceKind::Load { force, torque, .. } => force.iter_mut().chain(torque).collect(),
        ForceKind::Link { free_length, tension, .. } => vec![free_length, tension],
        _ => Vec::new(),
    });
    let of_states = model.states.iter_mut().map(|state| &mut state.rate);
    of_forces.chain(of_states).filter(|number| number.formula().is_some())
}

/// The numbers of all joint points and frames.
fn geometry(joints: &mut [Joint]) -> impl Iterator<Item = &mut Number> {
    let ends = joints.iter_mut().flat_map(|joint| [&mut joint.first, &mut joint.second]);
    ends.flat_map(|end| [&mut end.point, &mut end.axis, &mut end.zero]).flatten()
}

/// Each number that is written out becomes a parameter of its own.
fn free<'a>(numbers: impl Iterator<Item = &'a mut Number>, parameters: &mut Vec<Parameter>) {
    for number in numbers {
        let Number::Exact(value) = number else { continue };
        let (index, value) = (parameters.len(), value.clone());
        parameters.push(Parameter { name: format!("free_{index}"), value });
        *number = Number::Parameter { index, negated: false };
    }
}

#[cfg(test)]
mod tests;
