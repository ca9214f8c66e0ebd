//! Ready elements and rolling bodies: forces, states, rows and outputs that stand in `prelude.toml`, put into a model
//! file in place of each.

use std::borrow::Cow;
use std::ops::Range;

use toml::Spanned;
use toml::de::{DeArray, DeString, DeTable, DeValue};

use super::surfaces;
use crate::JointKind;
use crate::keys::{self, CONTACT, ELEMENT, Kind, ROLLING, SURFACES, lacking};

/// What each kind stands for.
pub(super) const PRELUDE: &str = include_str!("../prelude.toml");

type Table<'t> = DeTable<'t>;

/// A model file with what its elements stand for in it, behind all of its own; and where the values of elements are.
/// One that cannot be read stands for nothing.
pub(super) fn expanded<'t>(file: &Table<'t>) -> (Table<'t>, Vec<Range<usize>>) {
    let (mut whole, mut places) = (file.clone(), Vec::new());
    let of = |keys: &'static keys::Table| {
        let elements = file.get(keys.name).and_then(|value| value.get_ref().as_array());
        let tables = elements.into_iter().flat_map(|elements| elements.iter());
        tables.filter_map(move |element| Some((keys, element.get_ref().as_table()?)))
    };
    let touching: Vec<(&keys::Table, Table<'t>)> = of(&CONTACT)
        .flat_map(|(_, contact)| {
            places.extend(contact.values().map(Spanned::span).filter(|_| contact.contains_key("between")));
            surfaces::pairs(file, contact).unwrap_or_default().touch
        })
        .map(|pair| (&SURFACES, pair))
        .collect();
    let touching = touching.iter().map(|(keys, table)| (*keys, table));
    let mut elements = of(&ELEMENT).chain(of(&ROLLING)).chain(touching).peekable();
    if elements.peek().is_none() {
        return (whole, places);
    }
    let prelude = DeTable::parse(PRELUDE).expect("the prelude is TOML");
    for (keys, table) in elements {
        places.extend(table.values().map(Spanned::span));
        let Some(element) = Expansion::new(file, keys, table) else { continue };
        if table.contains_key("restitution") {
            element.add_inputs(&mut whole);
        }
        let parts = names_of_parts(keys, element.kind).into_iter();
        let parts = parts
            .filter_map(|name| prelude.get_ref().get(name.as_str()))
            .filter_map(|parts| parts.get_ref().as_table());
        for (what, parts) in parts.flatten() {
            let place = element.place.clone();
            let all = whole
                .entry(Spanned::new(place.clone(), Cow::Owned(what.get_ref().to_string())))
                .or_insert_with(|| Spanned::new(place, DeValue::Array(DeArray::new())));
            let DeValue::Array(all) = all.get_mut() else { continue };
            let parts = parts.get_ref().as_array().into_iter().flat_map(|parts| parts.iter());
            let parts = parts.filter_map(|part| part.get_ref().as_table());
            parts.flat_map(|part| element.parts(part)).for_each(|part| all.push(part));
        }
    }
    (whole, places)
}

/// Under which names the prelude has what all elements of a table have, and those of a kind.
fn names_of_parts(keys: &keys::Table, kind: &Kind) -> [String; 2] {
    let own =
        if keys.name == ELEMENT.name { kind.word.to_owned() } else { format!("{}_{}", keys.name, kind.word) };
    [keys.name.to_owned(), own]
}

/// The key of the prelude that says which key, or which words of one, an element must have for a part to be there.
const GIVEN: &str = "given";

/// The key of the prelude that says of which list each two neighbours have a part.
const EACH: &str = "each";

/// The key of the prelude that says of which list each element has a part: the k-th {it}.
const EVERY: &str = "every";

/// A formula lacks a number of its element, which is told of the element.
struct Incomplete;

/// An element that is being read.
#[derive(Clone)]
struct Expansion<'a, 't> {
    file: &'a Table<'t>,
    table: &'a Table<'t>,
    kind: &'static Kind,
    name: &'a str,
    /// Two neighbours in a list of it, or one element, with how many are before.
    pair: Option<(usize, &'a [Spanned<DeValue<'t>>])>,
    /// Where its name is: the place of what the model file does not have as it stands.
    place: Range<usize>,
}

impl<'a, 't> Expansion<'a, 't> {
    fn new(file: &'a Table<'t>, keys: &keys::Table, table: &'a Table<'t>) -> Option<Self> {
        let kind = keys.kind(table.get("kind")?.get_ref().as_str()?)?;
        let name = table.get("name")?;
        let expansion =
            Self { file, table, kind, name: name.get_ref().as_str()?, place: name.span(), pair: None };
        let joint = table.get("joint").and_then(|joint| joint.get_ref().as_str());
        let has = |key: &str| table.contains_key(key);
        // Of such an axis it is told that it is zero, and of nothing else.
        let is_zero = |number: &Spanned<DeValue<'_>>| match number.get_ref() {
            DeValue::Integer(number) => number.as_str().parse() == Ok(0.0),
            DeValue::Float(number) => number.as_str().parse() == Ok(0.0),
            _ => false,
        };
        let axis = table.get("axis").and_then(|axis| axis.get_ref().as_array());
        let is_whole = lacking(kind, has).is_none()
            && !axis.is_some_and(|axis| axis.iter().all(is_zero))
            && !(kind.key("closed").is_some() && has("joint") && has("first"))
            && joint.is_none_or(|joint| expansion.joint(joint).is_some());
        is_whole.then_some(expansion)
    }

    /// The forces of surfaces that are rigid are inputs.
    fn add_inputs(&self, whole: &mut Table<'t>) {
        let inputs = whole
            .entry(self.here(Cow::Borrowed("inputs")))
            .or_insert_with(|| self.here(DeValue::Table(DeTable::new())));
        let DeValue::Table(inputs) = inputs.get_mut() else { return };
        let zero = DeValue::parse("0").expect("it is a number").into_inner();
        for name in surfaces::touching(self.table).flat_map(|name| surfaces::forces(&name)) {
            inputs.insert(self.here(Cow::Owned(name)), self.here(zero.clone()));
        }
    }

    /// What it has of a part: none, one, or one for each two neighbours in a list.
    fn parts(&self, part: &Table<'_>) -> Vec<Spanned<DeValue<'t>>> {
        let text = |key: &str| part.get(key).and_then(|value| value.get_ref().as_str());
        let has = |given: &str| {
            if let Some(key) = given.strip_prefix('!') {
                return !self.table.contains_key(key);
            }
            let Some((key, words)) = given.split_once('=') else { return self.table.contains_key(given) };
            let word = match self.table.get(key) {
                Some(value) => value.get_ref().as_str(),
                None => self.kind.key(key).map(|key| key.default.trim_matches('"')),
            };
            word.is_some_and(|word| words.split('|').any(|one| one == word))
        };
        if text(GIVEN).is_some_and(|given| !has(given)) {
            return Vec::new();
        }
        let (list, size) = match (text(EACH), text(EVERY)) {
            (Some(list), _) => (list, 2),
            (None, Some(list)) => (list, 1),
            (None, None) => return self.filled_table(part).into_iter().collect(),
        };
        let elements = self.table.get(list).and_then(|list| list.get_ref().as_array());
        let pairs = elements.into_iter().flat_map(|elements| elements.windows(size)).enumerate();
        let filled =
            |(before, pair)| Self { pair: Some((before, pair)), ..self.clone() }.filled_table(part).ok();
        pairs.filter_map(filled).collect()
    }

    fn filled_table(&self, table: &Table<'_>) -> Result<Spanned<DeValue<'t>>, Incomplete> {
        let mut filled = DeTable::new();
        for (key, value) in
            table.iter().filter(|(key, _)| ![GIVEN, EACH, EVERY].contains(&key.get_ref().as_ref()))
        {
            if let Some(value) = self.filled(value.get_ref())? {
                filled.insert(self.here(DeString::from(key.get_ref().to_string())), value);
            }
        }
        Ok(self.here(DeValue::Table(filled)))
    }

    /// A value of the prelude with what the element has in it; nothing if that is one that the element does not have.
    fn filled(&self, value: &DeValue<'_>) -> Result<Option<Spanned<DeValue<'t>>>, Incomplete> {
        Ok(match value {
            DeValue::String(text) => {
                let whole = text.strip_prefix('{').and_then(|rest| rest.strip_suffix('}'));
                match whole.filter(|path| !path.contains('{')) {
                    Some(path) => self.at(path),
                    None => Some(self.filled_text(text).ok_or(Incomplete)?),
                }
            }
            DeValue::Array(elements) => {
                let mut filled = DeArray::new();
                for element in elements {
                    if let Some(one) = self.filled(element.get_ref())? {
                        filled.push(one);
                    }
                }
                Some(self.here(DeValue::Array(filled)))
            }
            DeValue::Table(table) => Some(self.filled_table(table)?),
            _ => None,
        })
    }

    fn filled_text(&self, text: &str) -> Option<Spanned<DeValue<'t>>> {
        let (mut filled, mut rest, mut place) = (String::new(), text, None);
        while let Some((before, path, after)) = rest
            .split_once('{')
            .and_then(|(before, rest)| rest.split_once('}').map(|(path, after)| (before, path, after)))
        {
            let value = self.at(path)?;
            filled.push_str(before);
            filled.push_str(&in_formula(path, value.get_ref())?);
            // What can be wrong with a formula is wrong with one that the model file has.
            if value.get_ref().is_str() && value.span() != self.place {
                place = place.or(Some(value.span()));
            }
            rest = after;
        }
        filled.push_str(rest);
        let place = place.unwrap_or_else(|| self.place.clone());
        Some(Spanned::new(place, DeValue::String(filled.into())))
    }

    /// What is at a path: the key of the element, then keys and places in it. A joint's name leads to its table.
    fn at(&self, path: &str) -> Option<Spanned<DeValue<'t>>> {
        match path {
            "name" => return Some(self.here(DeValue::String(self.name.to_owned().into()))),
            "on" => return self.coordinate(self.table),
            "from" | "to" => return self.pair.map(|(_, pair)| pair[usize::from(path == "to")].clone()),
            "k" => return self.pair.map(|(before, _)| self.number(before + 1)),
            "before" => return self.pair.map(|(before, _)| self.number(before)),
            "count" => return Some(self.number(self.neighbours())),
            _ => {}
        }
        let mut steps = path.split('.');
        let key = steps.next()?;
        let mut value = match (self.table.get(key), self.pair) {
            (_, Some((_, [it, ..]))) if key == "it" => it.clone(),
            (Some(value), _) => value.clone(),
            (None, _) => self.default(key)?,
        };
        for step in steps {
            value = match (value.get_ref(), step) {
                (DeValue::Table(table), "on") => self.coordinate(table)?,
                (DeValue::Table(table), step) => table.get(step)?.clone(),
                (DeValue::Array(elements), step) => elements.get(step.parse::<usize>().ok()?)?.clone(),
                (DeValue::String(joint), step) => self.joint(joint)?.get(step)?.clone(),
                _ => return None,
            };
        }
        Some(value)
    }

    /// What holds of a key that is not there.
    fn default(&self, key: &str) -> Option<Spanned<DeValue<'t>>> {
        let default = self.kind.key(key)?.default;
        let numbers = default.strip_prefix('[').and_then(|rest| rest.strip_suffix(']'));
        let number = |text: &'static str| {
            let value = DeValue::parse(text).ok()?.into_inner();
            (value.is_integer() || value.is_float()).then(|| self.here(value))
        };
        let Some(numbers) = numbers else { return number(default) };
        let mut elements = DeArray::new();
        numbers.split(", ").filter_map(number).for_each(|one| elements.push(one));
        Some(self.here(DeValue::Array(elements)))
    }

    /// The joint coordinate that a table tells, as formulas name it.
    fn coordinate(&self, table: &Table<'t>) -> Option<Spanned<DeValue<'t>>> {
        let joint = table.get("joint")?.get_ref().as_str()?;
        let kind = JointKind::named(self.joint(joint)?.get("kind")?.get_ref().as_str()?)?;
        let name = match table.get("coordinate").filter(|_| kind.coordinates().len() > 1) {
            Some(coordinate) => format!("{joint}.{}", coordinate.get_ref().as_str()?),
            None => joint.to_owned(),
        };
        Some(self.here(DeValue::String(name.into())))
    }

    /// How many neighbours its one list has.
    fn neighbours(&self) -> usize {
        let lists = self.table.values().filter_map(|value| value.get_ref().as_array());
        lists.map(|list| list.len().saturating_sub(1)).next().unwrap_or(0)
    }

    /// A number that is a part of a name.
    fn number(&self, number: usize) -> Spanned<DeValue<'t>> {
        self.here(DeValue::String(number.to_string().into()))
    }

    fn joint(&self, name: &str) -> Option<&'a Table<'t>> {
        let joints = self.file.get("joint")?.get_ref().as_array()?;
        let mut joints = joints.iter().filter_map(|joint| joint.get_ref().as_table());
        joints.find(|joint| joint.get("name").is_some_and(|other| other.get_ref().as_str() == Some(name)))
    }

    fn here<T>(&self, value: T) -> Spanned<T> {
        Spanned::new(self.place.clone(), value)
    }
}

/// A value as a part of a formula.
fn in_formula(path: &str, value: &DeValue<'_>) -> Option<String> {
    let is_name =
        matches!(path, "name" | "on" | "k" | "before" | "count" | "number") || path.ends_with(".on");
    Some(match value {
        DeValue::String(text) if is_name => text.to_string(),
        DeValue::String(text) => format!("({text})"),
        DeValue::Integer(number) if !number.as_str().starts_with('-') => number.as_str().to_owned(),
        DeValue::Integer(number) => format!("({})", number.as_str()),
        DeValue::Float(number) if !number.as_str().starts_with('-') => number.as_str().to_owned(),
        DeValue::Float(number) => format!("({})", number.as_str()),
        _ => return None,
    })
}

#[cfg(test)]
mod tests;
