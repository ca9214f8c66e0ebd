//! How things of a mechanism are called in C.

use crate::Precision;
use crate::reserved::c_name;
use gyro_codegen::{Argument, Index, Scheduled, Variable};
use gyro_model::Model;
use std::borrow::Cow;

/// Names of one exported mechanism.
#[derive(Debug)]
pub(crate) struct Names<'a> {
    /// The model's name in C, which begins the name of everything that can be seen from elsewhere.
    pub(crate) prefix: Cow<'a, str>,
    pub(crate) precision: Precision,
    indices: &'a [Index],
    /// Of the indices, in their order.
    constants: Vec<String>,
    /// Of those that have coordinates.
    pub(crate) bodies: Vec<&'a str>,
    n_coordinates: usize,
    /// Where in the maximal state the model file's own states begin, and turn references.
    first_state: usize,
    first_turn: usize,
}

impl<'a> Names<'a> {
    /// With the named places; where two names would be put together to the same one, the later gets a number.
    pub(crate) fn new(model: &'a Model, scheduled: &'a Scheduled, precision: Precision) -> Self {
        let bodies = model.coordinate_bodies().into_iter().map(|body| model.bodies[body].name.as_str());
        let counts = &scheduled.counts;
        let mut names = Self {
            prefix: c_name(&model.name),
            precision,
            indices: &scheduled.indices,
            constants: Vec::new(),
            bodies: bodies.collect(),
            n_coordinates: counts.coordinates,
            first_state: 13 * counts.bodies + counts.work,
            first_turn: 13 * counts.bodies + counts.work + counts.states,
        };
        for index in names.indices {
            let first = names.upper(&format!("{}_{}", index.kind, within_kind(index)));
            let is_taken = |name: &String| names.constants.contains(name);
            let numbered = (2..).map(|n: usize| format!("{first}_{n}"));
            let name = std::iter::once(first.clone()).chain(numbered).find(|name| !is_taken(name));
            names.constants.extend(name);
        }
        names
    }

    /// A macro or constant.
    pub(crate) fn upper(&self, name: &str) -> String {
        format!("{}_{}", self.prefix, name).to_uppercase()
    }

    /// A function or type.
    pub(crate) fn own(&self, name: &str) -> String {
        format!("{}_{name}", self.prefix)
    }

    /// The named places of a kind, with their constants.
    pub(crate) fn of_kind(&self, kind: &str) -> impl Iterator<Item = (&Index, &str)> {
        let all = self.indices.iter().zip(self.constants.iter().map(String::as_str));
        all.filter(move |(index, _)| index.kind == kind)
    }

    /// The constant of a place.
    fn constant(&self, kind: &str, place: usize) -> &str {
        let found = self.of_kind(kind).find(|(index, _)| index.place == place);
        found.expect("all parameters and inputs have names").1
    }

    /// A variable outside of loops.
    pub(crate) fn variable(&self, variable: Variable) -> String {
        match variable {
            Variable::Time => "t".to_owned(),
            Variable::Element(argument, place) => self.element(argument, place),
            Variable::Chart(place) => format!("chart{}_{}", place / 4, place % 4),
            Variable::Parameter(place) => format!("m->parameters[{}]", self.constant("parameter", place)),
            Variable::ParameterSetup(place) => format!("m->derived[{place}]"),
            Variable::Input(place) => format!("m->inputs[{}]", self.constant("input", place)),
            Variable::Curve { table, order } => format!("table{table}[{order}]"),
            Variable::Kept { array, row, column } => format!("kept{array}[{row}][{column}]"),
            Variable::Fixed(number) => format!("fixed{number}"),
            Variable::Factor(_) | Variable::Row { .. } | Variable::Strided { .. } => {
                unreachable!("loops know what these are")
            }
        }
    }

    /// An element of an argument.
    fn element(&self, argument: Argument, place: usize) -> String {
        const POSITION: [&str; 7] = ["rx", "ry", "rz", "e0", "e1", "e2", "e3"];
        const VELOCITY: [&str; 6] = ["sx", "sy", "sz", "wx", "wy", "wz"];
        let first_velocity = 7 * self.bodies.len();
        match argument {
            Argument::State if place < first_velocity => {
                format!("{}_{}", self.bodies[place / 7], POSITION[place % 7])
            }
            Argument::State if place < 13 * self.bodies.len() => {
                let place = place - first_velocity;
                format!("{}_{}", self.bodies[place / 6], VELOCITY[place % 6])
            }
            Argument::State if place < self.first_turn => format!("state{}", place - self.first_state),
            Argument::State => format!("turn{}", place - self.first_turn),
            Argument::Joints if place < self.n_coordinates => format!("x{place}"),
            Argument::Joints => format!("u{}", place - self.n_coordinates),
            Argument::Accelerations => format!("a{place}"),
            Argument::Rows => format!("row{place}"),
        }
    }

    /// A text that is written for a mechanism called `gyro`, for this one.
    pub(crate) fn applied(&self, template: &str) -> String {
        // The type itself has no further word.
        let text = template.replace("const gyro *", "const \u{1} *");
        let text = text.replace("GYRO_", &self.upper("")).replace("gyro_", &self.own(""));
        text.replace('\u{1}', &self.prefix)
    }
}

/// The name of a place among those of its kind.
pub(crate) fn within_kind(index: &Index) -> String {
    let name = index.name.to_uppercase();
    index.coordinate.map_or(name.clone(), |coordinate| format!("{coordinate}_{name}"))
}
