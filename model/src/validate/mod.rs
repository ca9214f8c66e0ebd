//! What must hold of a model beyond its syntax. Problems name places of the model file; only the parser knows their
//! spans.

mod contacts;
mod controllers;
mod coordinates;
mod directions;
mod inertia;
mod numbers;
mod ranges;
mod rules;
mod topology;

pub(crate) use controllers::settings_problems;
pub(crate) use coordinates::problems as coordinate_problems;
pub use inertia::is_inertia;
pub(crate) use numbers::problems as number_problems;
pub(crate) use ranges::out_of_range;
pub use rules::ParameterRule;
pub(crate) use topology::problems as topology_problems;

use crate::number::in_range;
use crate::{Model, Number, Rational, to_f64};

/// How exactly numbers are taken that people compute in floating point and write with ten digits or more: what must not
/// exceed something may exceed it by one part in so many, and what is as near as that is equal.
const ROUNDED: i64 = 1_000_000_000;

/// One part of [`ROUNDED`].
pub(crate) fn rounded() -> Rational {
    Rational::new(1.into(), ROUNDED.into())
}

/// A place of the model file: a key of something, or the thing itself where the key is empty.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Place {
    pub(crate) owner: Owner,
    pub(crate) key: &'static str,
}

/// What a key belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Owner {
    Page,
    Simulation,
    Parameter(usize),
    DerivedParameter(usize),
    Input(usize),
    Body(usize),
    /// The `driven` table of a body.
    Driven(usize),
    /// A shape of a body, by its index.
    Shape(usize, usize),
    /// A point mass of a body, by its place among them.
    PointMass(usize, usize),
    Joint(usize),
    End(usize, Side),
    Coupler(usize),
    CouplerEnd(usize, Side),
    Driver(usize),
    Force(usize),
    ForceEnd(usize, Side),
    /// A side of an output of two frames.
    OutputEnd(usize, Side),
    Element(usize),
    Output(usize),
    Curve(usize),
    Formula(usize),
    State(usize),
    Controller(usize),
    Event(usize),
    Contact(usize),
}

/// One of the two ends of a joint, a coupler or a link.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Side {
    First,
    Second,
}

/// Something that must not be.
#[derive(Clone, Debug)]
pub(crate) struct Problem {
    pub(crate) place: Place,
    /// Another place that has to do with it, with a few words to print there.
    pub(crate) also: Option<(Place, String)>,
    pub(crate) message: String,
    pub(crate) label: String,
    pub(crate) help: String,
}

impl Problem {
    pub(crate) fn new(
        place: Place,
        message: impl Into<String>,
        label: impl Into<String>,
        help: impl Into<String>,
    ) -> Self {
        Self { place, also: None, message: message.into(), label: label.into(), help: help.into() }
    }

    /// The same with another place, and a few words there.
    pub(crate) fn also(self, place: Place, words: impl Into<String>) -> Self {
        Self { also: Some((place, words.into())), ..self }
    }
}

impl Place {
    pub(crate) fn body(index: usize, key: &'static str) -> Self {
        Self { owner: Owner::Body(index), key }
    }

    pub(crate) fn joint(index: usize, key: &'static str) -> Self {
        Self { owner: Owner::Joint(index), key }
    }

    pub(crate) fn force(index: usize, key: &'static str) -> Self {
        Self { owner: Owner::Force(index), key }
    }

    pub(crate) fn end(joint: usize, side: Side, key: &'static str) -> Self {
        Self { owner: Owner::End(joint, side), key }
    }

    /// Where to look next if the model file does not have this place: the joint for its end, the whole for its key.
    pub(crate) fn fallback(self) -> Option<Self> {
        match (self.owner, self.key) {
            (Owner::Page, "") => None,
            (Owner::End(joint, _), "axis" | "zero" | "point") => Some(Self::joint(joint, self.key)),
            (Owner::End(joint, _), "") => Some(Self::joint(joint, "")),
            (Owner::CouplerEnd(index, _), "") => Some(Self { owner: Owner::Coupler(index), key: "" }),
            (Owner::ForceEnd(index, _), "") => Some(Self { owner: Owner::Force(index), key: "" }),
            (Owner::OutputEnd(index, _), "") => Some(Self { owner: Owner::Output(index), key: "" }),
            (Owner::Shape(body, _), "") => Some(Self::body(body, "shape")),
            (Owner::Driven(body), "") => Some(Self::body(body, "driven")),
            (Owner::PointMass(body, _), "") => Some(Self::body(body, "point_mass")),
            (_, "") => Some(Self { owner: Owner::Page, key: "" }),
            (owner, _) => Some(Self { owner, key: "" }),
        }
    }
}

impl Side {
    pub(crate) const BOTH: [Self; 2] = [Self::First, Self::Second];

    /// The key of this end in a joint.
    pub(crate) fn key(self) -> &'static str {
        match self {
            Self::First => "first",
            Self::Second => "second",
        }
    }
}

/// The first thing that the numbers of a model make unphysical.
pub(crate) fn physical(model: &Model) -> Option<String> {
    let is_fit = |number: &Number| model.defined(number).is_some_and(|value| in_range(&value));
    let computed = |number: &&Number| matches!(number, Number::Computed(_));
    if !model.numbers().into_iter().filter(computed).all(is_fit) {
        return Some(
            "with these parameters an expression divides by zero, or is too large or too small".to_owned(),
        );
    }
    number_problems(model).into_iter().next().map(|p| format!("{} ({}): {}", p.message, p.label, p.help))
}

/// A number as a message shows it.
fn shown(value: &Rational) -> String {
    format!("{:?}", to_f64(value))
}
