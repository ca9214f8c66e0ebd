//! The traits of the run time's contract, each as the tables of `gyro_program` have it: types, buffers, functions. What
//! a trait has beside these is written out here and in the files of its subject.

use super::mechanism::{description, set_input};
use super::partition::partition;
use super::pieces::{lines, list};
use super::{Corrected, Has};
use crate::joints::{Freedom, JointLayout};
use crate::module::{counts, frames};
use gyro_model::Model;
use gyro_program::{Buffer, Counts, Given, Group, Kernel, Outcome, Signature, Space};

/// What the traits of one module are written from.
struct Writer<'a> {
    model: &'a Model,
    has: &'a Has,
    joints: Option<&'a JointLayout>,
    counts: Counts,
}

/// All traits that a module has.
pub(super) fn contract(model: &Model, name: &str, has: &Has, joints: Option<&JointLayout>) -> String {
    let writer = Writer { model, has, joints, counts: counts(model, joints) };
    let is_there = |group: &Group| match group {
        Group::Mechanism => true,
        Group::Joint => joints.is_some(),
        // Without joint coordinates what needs them would be refused.
        group => has.implements(group.trait_name()) && (joints.is_some() || !needs_joints(*group)),
    };
    let text = |group| match group {
        Group::Partition => partition(model, name, has.choice, joints),
        group => writer.implementation(group, name),
    };
    lines(Group::in_text().filter(is_there).map(text))
}

fn needs_joints(group: Group) -> bool {
    group != Group::Corrected && group.with_needs().contains(&Group::Joint)
}

/// How many numbers a type holds; what formulas decide is left open.
fn size(space: Space, counts: &Counts) -> String {
    match space {
        Space::PhiQ => "INT_phi_q".to_owned(),
        Space::PhiPi => "INT_phi_pi".to_owned(),
        Space::Accelerations => "INT_accelerations".to_owned(),
        space => space.len(counts).to_string(),
    }
}

impl Writer<'_> {
    fn implementation(&self, group: Group, name: &str) -> String {
        let types = lines(
            Space::of(group)
                .map(|space| format!("type {} = [T; {}];", space.name(), size(space, &self.counts))),
        );
        let scalar = if group == Group::Mechanism { "type Scalar = T;" } else { "" };
        let [before, after, last] = self.beside(group);
        let buffers = lines(Buffer::of(group).map(|buffer| self.buffer(buffer)));
        let functions = lines(Kernel::of(group).map(|kernel| self.function(kernel)));
        format!(
            "impl<T: gyro_sim::Scalar> gyro_sim::{} for {name}<T> {{
                {scalar} {types} {before} {buffers} {after} {functions} {last}
            }}",
            group.trait_name()
        )
    }

    /// What a trait has before and after its buffers, and at its end.
    fn beside(&self, group: Group) -> [String; 3] {
        let [before, after, last] = match group {
            Group::Mechanism => {
                let description = format!(
                    "fn description(&self) -> &gyro_sim::Description<'_> {{
                        const DESCRIPTION: gyro_sim::Description<'static> = {};
                        &DESCRIPTION
                    }}",
                    description(self.model)
                );
                [&description, "fn start(&self) -> Self::State { HOLE_start }", &set_input(self.model)]
                    .map(str::to_owned)
            }
            Group::Kinematics => {
                let patterns = lines(["phi_q", "phi_pi"].map(|matrix| {
                    format!("fn {matrix}_pattern(&self) -> &[(u16, u16)] {{ HOLE_{matrix}_pattern }}")
                }));
                ["", &patterns, ""].map(str::to_owned)
            }
            Group::Joint => {
                let layout = format!(
                    "fn joint_layout(&self) -> &gyro_sim::JointLayout<'_> {{
                        const LAYOUT: gyro_sim::JointLayout<'static> = {};
                        &LAYOUT
                    }}",
                    self.joints.map(layout).unwrap_or_default()
                );
                [&layout, "fn joint_start(&self) -> Self::Joints { HOLE_joint_start }", ""].map(str::to_owned)
            }
            Group::Frames => {
                let names = list(frames(self.model).map(|frame| format!("{:?}", frame.name)));
                [&format!("fn frame_names(&self) -> &[&str] {{ &[{names}] }}"), "", ""].map(str::to_owned)
            }
            Group::MassMatrix => {
                ["", "fn mass_order(&self) -> &[u16] { HOLE_mass_order }", ""].map(str::to_owned)
            }
            _ => Default::default(),
        };
        [before, after, last]
    }

    fn buffer(&self, buffer: &Buffer) -> String {
        let zeros = |space: Space| match space.len(&self.counts) {
            0 if space.is_bare_if_empty() => "[]".to_owned(),
            _ => format!("[T::constant(0.0); {}]", size(space, &self.counts)),
        };
        let (function, fields) = (buffer.function, buffer.fields);
        match buffer.returns {
            None => {
                let space = fields[0].1;
                format!("fn {function}(&self) -> Self::{} {{ {} }}", space.name(), zeros(space))
            }
            Some(of) => {
                let fields = list(fields.iter().map(|(field, space)| format!("{field}: {}", zeros(*space))));
                format!("fn {function}(&self) -> gyro_sim::{of}<Self> {{ gyro_sim::{of} {{ {fields} }} }}")
            }
        }
    }

    /// A function; nothing where the trait's own does.
    fn function(&self, kernel: Kernel) -> String {
        let corrected = self.has.corrected;
        let is_of_loops = matches!(
            kernel,
            Kernel::LoopClosure | Kernel::ClosureDistances | Kernel::ClosePositions | Kernel::CloseVelocities
        );
        match kernel {
            Kernel::ParameterSetup => String::new(),
            _ if is_of_loops && self.counts.closure == 0 => String::new(),
            Kernel::CorrectedAccelerations if self.joints.is_none() => self.cut_accelerations(corrected),
            Kernel::CorrectedDerivative if self.joints.is_none() || !corrected.has_derivative => {
                "fn corrected_derivative(&self, t: T, y: &Self::State, dy: &mut Self::State) {
                    gyro_sim::Dynamics::derivative(self, t, y, dy);
                }"
                .to_owned()
            }
            _ => hole(kernel.signature()),
        }
    }

    /// What is not found by way of joint coordinates is what it is at any state.
    fn cut_accelerations(&self, corrected: Corrected) -> String {
        let cut = if corrected.is_cut {
            format!(
                "let mut solved = [T::constant(0.0); INT_accelerations];
                gyro_sim::Dynamics::accelerations(self, t, y, &mut solved);
                out.copy_from_slice(&solved[..{}]);",
                Space::Velocities.len(&self.counts)
            )
        } else {
            "gyro_sim::Dynamics::accelerations(self, t, y, out);".to_owned()
        };
        format!(
            "fn corrected_accelerations(&self, t: T, y: &Self::State, out: &mut Self::Velocities) {{ {cut} }}"
        )
    }
}

/// A function whose body is left open, as are the names of arguments that it need not read.
fn hole(signature: &Signature) -> String {
    // What is handed on is a function of time and state in any case.
    let any = if matches!(signature.given, Given::HandedOn(..)) { "" } else { "ANY_" };
    let overwrites = signature.result == Outcome::Overwrites;
    let mut arguments = vec!["&self".to_owned(), format!("{any}t: T")];
    let state = signature.state.argument();
    arguments
        .extend(state.filter(|_| !overwrites).map(|(name, of)| format!("{any}{name}: &Self::{}", of.name())));
    if let Given::Told(name, of) = signature.given {
        arguments.push(format!("ANY_{name}: &Self::{}", of.name()));
    }
    arguments.extend(signature.written().into_iter().map(|(name, of)| {
        let any = if name == "out" { "ANY_" } else { "" };
        format!("{any}{name}: &mut Self::{}", of.name())
    }));
    let returned = if signature.result == Outcome::Energies { "-> gyro_sim::Energy<T>" } else { "" };
    let (name, arguments) = (signature.kernel.function(), list(arguments));
    format!("fn {name}({arguments}) {returned} {{ HOLE_{name} }}")
}

/// Where the numbers of the joint state stand.
fn layout(joints: &JointLayout) -> String {
    let places = list(joints.places.iter().map(|place| {
        let what = match place.of {
            Freedom::Scalar(on) => {
                format!("Scalar {{ joint: {}, coordinate: {} }}", on.joint, on.coordinate)
            }
            Freedom::Turn(on) => format!("Turn {{ joint: {}, coordinate: {} }}", on.joint, on.coordinate),
            Freedom::State(state) => format!("State {{ state: {state} }}"),
            Freedom::Orientation { joint } => format!("Orientation {{ joint: {joint} }}"),
            Freedom::Body { moving_body } => format!("Body {{ body: {moving_body} }}"),
        };
        format!("gyro_sim::JointPlace::{what}")
    }));
    let closure_rows = list(&joints.closure_rows);
    format!("gyro_sim::JointLayout {{ places: &[{places}], closure_rows: &[{closure_rows}] }}")
}
