//! The keys of model files, as plain data: what each table may have, of which kind, in which range, with which default
//! and meaning. The reader, the checks of ranges, the JSON schema and the reference in `docs/model-format.md` come from
//! these tables; what a key does is in the code that asks for it.

use crate::Seen;

mod bodies;
mod elements;
mod file;
mod forces;
mod joints;
mod observed;

pub use bodies::{BODY, DRIVEN, ELEMENTS, POINT_MASS, ROTATION, SHAPE};
pub(crate) use elements::SURFACES;
pub(crate) use elements::lacking;
pub use elements::{ELEMENT, ROLLING};
pub use file::{ATTRACTION, FILE, GENERATE, INPUT, MOTION, SIMULATION, SINUSOID};
pub use forces::{BUSHING_END, FORCE, FORCE_END};
pub use joints::{CONSTRAINT, COUPLER, COUPLER_END, DRIVER, JOINT, JOINT_END};
pub use observed::{CONTACT, CONTACT_SIDE, CONTROLLER, CURVE, EVENT, FORMULA, OUTPUT, STATE};

/// A table of the model file.
#[derive(Debug)]
pub struct Table {
    /// What one of it is called, without an article.
    pub name: &'static str,
    /// What it is, in a sentence.
    pub meaning: &'static str,
    /// The keys that it may have whatever its kind.
    pub keys: &'static [Key],
    /// Its kinds, of which `kind` names one; none of most tables.
    pub kinds: &'static [Kind],
}

/// A kind of joint, of force and the like.
#[derive(Debug)]
pub struct Kind {
    /// The word under `kind`.
    pub word: &'static str,
    /// What it is, or its law.
    pub meaning: &'static str,
    /// The keys that it has besides those of all kinds.
    pub keys: &'static [Key],
}

/// A key of a table.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    /// The key.
    pub name: &'static str,
    /// What stands there.
    pub value: Value,
    /// Whether it must be there.
    pub is_required: bool,
    /// What holds where it is not there: a number, a list of numbers or a word as the model file would have it, or
    /// words for people.
    pub default: &'static str,
    /// What must hold of the number.
    pub range: Range,
    /// What to write, in messages; empty where it follows from the rest.
    pub example: &'static str,
    /// What formulas under it may name besides what all formulas may.
    pub own: &'static [(&'static str, Seen)],
    /// The name that the key had before, under which it is still read; empty for none.
    pub former: &'static str,
    /// What it means, in Markdown.
    pub meaning: &'static str,
}

/// What stands under a key. Units are written as in messages: `kg.m2`.
#[derive(Clone, Copy, Debug)]
pub enum Value {
    /// A number in a unit, which may name parameters.
    Number(&'static str),
    /// The strength of a force: a number that may be an input, too.
    Strength(&'static str),
    /// A number that must be written out.
    Plain(&'static str),
    /// So many numbers in a unit.
    Numbers(usize, &'static str),
    /// Three numbers that may be inputs, too.
    Strengths(&'static str),
    /// At least one number and at most so many.
    List(usize, &'static str),
    /// Rows of numbers.
    Rows,
    /// `true` or `false`.
    Flag,
    /// A text.
    Text,
    /// A list of so many texts, at least and at most.
    Texts(usize, usize),
    /// The name of what the table describes.
    Name,
    /// The name of something else: of a `[[body]]` under `body`, and so on.
    Reference,
    /// One of some words, each with its meaning.
    Word(&'static [(&'static str, &'static str)]),
    /// One of the table's kinds.
    Kind,
    /// A motion in a unit.
    Motion(&'static str),
    /// So many motions, or at least one where this is 0.
    Motions(usize, &'static str),
    /// A table.
    Table(&'static Table),
    /// A list of tables.
    Tables(&'static Table),
    /// A table of names, each with such a value.
    Entries(&'static Value),
    /// One of several.
    Either(&'static [Value]),
}

/// What must hold of a number, with the reason, which may be empty.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Range {
    /// Nothing.
    Any,
    /// It is greater than 0.
    Positive(&'static str),
    /// It is 0 or more.
    NotNegative(&'static str),
    /// It is not 0.
    NotZero(&'static str),
}

impl Table {
    const fn new(name: &'static str, meaning: &'static str, keys: &'static [Key]) -> Self {
        Self { name, meaning, keys, kinds: &[] }
    }

    const fn of_kinds(self, kinds: &'static [Kind]) -> Self {
        Self { kinds, ..self }
    }

    /// One of it, with its article.
    pub fn noun(&self) -> String {
        let article = if self.name.starts_with(['a', 'e', 'i', 'o']) { "an" } else { "a" };
        format!("{article} {}", self.name)
    }

    /// All keys that any of its kinds may have, each once, with those of all kinds first.
    pub fn all(&self) -> Vec<&'static Key> {
        let mut all: Vec<&Key> = Vec::new();
        for key in self.keys.iter().chain(self.kinds.iter().flat_map(|kind| kind.keys)) {
            if !all.iter().any(|other| other.name == key.name) {
                all.push(key);
            }
        }
        all
    }

    /// The kind of a word.
    pub fn kind(&self, word: &str) -> Option<&'static Kind> {
        self.kinds.iter().find(|kind| kind.word == word)
    }
}

impl Kind {
    /// The kind's own key of a name.
    pub fn key(&self, name: &str) -> Option<&'static Key> {
        self.keys.iter().find(|key| key.name == name)
    }
}

impl Key {
    /// The unit of its numbers; `None` where there is none, or any.
    pub fn unit(&self) -> Option<&'static str> {
        self.value.unit().filter(|unit| !unit.is_empty())
    }

    /// What to write where it is missing.
    pub fn cure(&self) -> String {
        match (self.example, self.unit()) {
            ("", Some(unit)) => format!("{} = ..., in {unit}", self.name),
            ("", None) => format!("{} = ...", self.name),
            (example, _) => example.to_owned(),
        }
    }

    const fn new(name: &'static str, value: Value, meaning: &'static str) -> Self {
        let range = Range::Any;
        Self {
            name,
            value,
            is_required: false,
            default: "",
            range,
            example: "",
            own: &[],
            former: "",
            meaning,
        }
    }

    const fn required(self) -> Self {
        Self { is_required: true, default: "required", ..self }
    }

    const fn or(self, default: &'static str) -> Self {
        Self { default, ..self }
    }

    const fn positive(self, why: &'static str) -> Self {
        Self { range: Range::Positive(why), ..self }
    }

    const fn not_negative(self, why: &'static str) -> Self {
        Self { range: Range::NotNegative(why), ..self }
    }

    const fn not_zero(self, why: &'static str) -> Self {
        Self { range: Range::NotZero(why), ..self }
    }

    const fn eg(self, example: &'static str) -> Self {
        Self { example, ..self }
    }

    const fn naming(self, own: &'static [(&'static str, Seen)]) -> Self {
        Self { own, ..self }
    }

    const fn formerly(self, former: &'static str) -> Self {
        Self { former, ..self }
    }
}

impl Value {
    fn unit(self) -> Option<&'static str> {
        match self {
            Self::Number(unit)
            | Self::Strength(unit)
            | Self::Plain(unit)
            | Self::Numbers(_, unit)
            | Self::Strengths(unit)
            | Self::List(_, unit)
            | Self::Motion(unit)
            | Self::Motions(_, unit) => Some(unit),
            Self::Either(values) => values.first().and_then(|value| value.unit()),
            _ => None,
        }
    }
}

const fn kind(word: &'static str, meaning: &'static str, keys: &'static [Key]) -> Kind {
    Kind { word, meaning, keys }
}

const fn number(name: &'static str, unit: &'static str, meaning: &'static str) -> Key {
    Key::new(name, Value::Number(unit), meaning)
}

const fn strength(name: &'static str, unit: &'static str, meaning: &'static str) -> Key {
    Key::new(name, Value::Strength(unit), meaning)
}

/// Three strengths of a force.
const fn strengths(name: &'static str, unit: &'static str, meaning: &'static str) -> Key {
    Key::new(name, Value::Strengths(unit), meaning)
}

const fn plain(name: &'static str, unit: &'static str, meaning: &'static str) -> Key {
    Key::new(name, Value::Plain(unit), meaning)
}

const fn vector(name: &'static str, unit: &'static str, meaning: &'static str) -> Key {
    Key::new(name, Value::Numbers(3, unit), meaning)
}

/// Euler parameters.
const fn orientation(meaning: &'static str) -> Key {
    Key::new("orientation", Value::Numbers(4, ""), meaning)
}

const fn flag(name: &'static str, meaning: &'static str) -> Key {
    Key::new(name, Value::Flag, meaning).or("false")
}

const fn text(name: &'static str, meaning: &'static str) -> Key {
    Key::new(name, Value::Text, meaning)
}

const fn word(name: &'static str, words: &'static [(&str, &str)], meaning: &'static str) -> Key {
    Key::new(name, Value::Word(words), meaning)
}

const fn name(meaning: &'static str) -> Key {
    Key::new("name", Value::Name, meaning).required()
}

const fn reference(name: &'static str, meaning: &'static str) -> Key {
    Key::new(name, Value::Reference, meaning).required()
}

const fn table(name: &'static str, table: &'static Table, meaning: &'static str) -> Key {
    Key::new(name, Value::Table(table), meaning)
}

const fn tables_of(table: &'static Table, name: &'static str, meaning: &'static str) -> Key {
    Key::new(name, Value::Tables(table), meaning)
}

const fn tables(table: &'static Table, meaning: &'static str) -> Key {
    Key::new(table.name, Value::Tables(table), meaning).or("none")
}

const KIND: Key = Key::new("kind", Value::Kind, "one of the kinds below").required();
/// Of what acts on a joint coordinate.
const ON_JOINT: Key = reference("joint", "name of the joint");
const ON_COORDINATE: Key =
    text("coordinate", "which coordinate, unless the joint has just one").eg("coordinate = \"angle\"");
/// Of what is at a point of a body.
const POINT: Key = vector("point", "m", "").or("[0, 0, 0]");
