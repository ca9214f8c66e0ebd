//! A table of the model file with its known keys; every other key is reported.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeString, DeTable, DeValue};

use super::reader::Reader;
use super::{names, synonyms};
use crate::validate::{Owner, Place};

/// A table with the keys that it may have.
#[derive(Clone, Copy)]
pub(super) struct Section<'t> {
    pub(super) owner: Owner,
    table: &'t DeTable<'t>,
}

/// What the words are, and the words with their meanings, the commonest first.
pub(super) type Choice<'c, T> = (&'c str, &'c [(&'static str, T)]);

/// The value of a key.
#[derive(Clone, Copy)]
pub(super) struct Item<'t> {
    pub(super) place: Place,
    pub(super) value: &'t Spanned<DeValue<'t>>,
}

impl<'t> Section<'t> {
    /// Marks the places of all known keys and reports the unknown ones. `title` says what the table is.
    pub(super) fn open(
        reader: &mut Reader<'_>,
        owner: Owner,
        title: &str,
        table: &'t DeTable<'t>,
        known: &[&'static str],
    ) -> Self {
        for (key, value) in table {
            let written = key.get_ref().as_ref();
            let former_of = |name: &&&'static str| former(owner, name) == Some(written);
            match known.iter().find(|name| **name == written).or_else(|| known.iter().find(former_of)) {
                Some(name) => reader.mark(Place { owner, key: name }, value.span()),
                None => unknown_key(reader, (owner, title), key, known, table),
            }
            if let Some(name) = known.iter().find(former_of) {
                former_key(reader, (Place { owner, key: name }, title), key, table);
            }
        }
        Self { owner, table }
    }

    /// What the section is, with its article.
    fn noun(&self) -> &'static str {
        match self.owner {
            Owner::Force(_) => "a force",
            Owner::Output(_) => "an output",
            Owner::Controller(_) => "a controller",
            Owner::Event(_) => "an event",
            Owner::Contact(_) => "a contact",
            _ => "something",
        }
    }

    pub(super) fn place(&self, key: &'static str) -> Place {
        Place { owner: self.owner, key }
    }

    pub(super) fn get(&self, key: &'static str) -> Option<Item<'t>> {
        let value = self.table.get(key).or_else(|| self.table.get(former(self.owner, key)?));
        value.map(|value| Item { place: self.place(key), value })
    }

    pub(super) fn has(&self, key: &'static str) -> bool {
        self.get(key).is_some()
    }

    /// The value of a key that must be there; `title` says what should have it and `example` what to write.
    pub(super) fn require(
        &self,
        reader: &mut Reader<'_>,
        key: &'static str,
        title: &str,
        example: &str,
    ) -> Option<Item<'t>> {
        let item = self.get(key);
        if item.is_none() && !reader.is_doubted(self.place(key)) {
            let words =
                [format!("{title} has no `{key}`"), format!("needs `{key}`"), format!("write {example}")];
            reader.missing(self.place(key), words);
        }
        item
    }

    /// The same of a table inside a value, such as one of several motions: what is missing is reported there.
    pub(super) fn require_within(
        &self,
        reader: &mut Reader<'_>,
        whole: Item<'_>,
        key: &'static str,
        (title, example): (&str, &str),
    ) -> Option<Item<'t>> {
        let item = self.get(key);
        if item.is_none() && !reader.is_doubted(self.place(key)) {
            let words =
                [format!("{title} has no `{key}`"), format!("needs `{key}`"), format!("write {example}")];
            reader.missing_at(whole.place, whole.span(), words);
        }
        item
    }

    /// One of some words under a key that must be there; see [`Item::choice`].
    pub(super) fn require_choice<T: Copy>(
        &self,
        reader: &mut Reader<'_>,
        key: &'static str,
        title: &str,
        choice: Choice<'_, T>,
    ) -> Option<T> {
        let item = self.require(reader, key, title, &choice_example(key, choice.1))?;
        item.choice(reader, choice)
    }

    /// Refuses a key that is known but out of place here.
    pub(super) fn refuse(&self, reader: &mut Reader<'_>, key: &'static str, message: &str, help: &str) {
        if let Some(item) = self.get(key) {
            item.wrong(reader, [message.to_owned(), "not allowed here".to_owned(), help.to_owned()]);
        }
    }
}

impl<'t> Item<'t> {
    pub(super) fn span(&self) -> Range<usize> {
        self.value.span()
    }

    pub(super) fn key(&self) -> &'static str {
        self.place.key
    }

    pub(super) fn wrong(&self, reader: &mut Reader<'_>, words: [String; 3]) {
        reader.wrong(self.place, self.span(), words);
    }

    /// Reports that something of another type was expected.
    pub(super) fn wrong_type(&self, reader: &mut Reader<'_>, expected: &str, example: &str) {
        self.wrong_type_with(reader, expected, format!("write {example}"));
    }

    /// The same with another cure.
    pub(super) fn wrong_type_with(&self, reader: &mut Reader<'_>, expected: &str, help: String) {
        let words = [
            format!("`{}` must be {expected}", self.key()),
            format!("found {}", found(self.value.get_ref())),
            help,
        ];
        self.wrong(reader, words);
    }

    pub(super) fn text(&self, reader: &mut Reader<'_>, example: &str) -> Option<&'t str> {
        let text = self.value.get_ref().as_str();
        if text.is_none() {
            self.wrong_type(reader, "a string", example);
        }
        text
    }

    pub(super) fn table(&self, reader: &mut Reader<'_>, example: &str) -> Option<&'t DeTable<'t>> {
        let table = self.value.get_ref().as_table();
        if table.is_none() {
            self.wrong_type(reader, "a table", example);
        }
        table
    }

    /// One of some words.
    pub(super) fn choice<T: Copy>(&self, reader: &mut Reader<'_>, (what, known): Choice<'_, T>) -> Option<T> {
        let written = self.text(reader, &choice_example(self.key(), known))?;
        let found = known.iter().find(|(name, _)| *name == written).map(|(_, value)| *value);
        if found.is_none() {
            let known: Vec<&str> = known.iter().map(|(name, _)| *name).collect();
            let list = names::list(&known);
            let key = self.key();
            let help = match (synonyms::no_kind(written, what), names::meant(written, &known)) {
                (Some(help), _) => help.to_owned(),
                (None, Some(name)) => format!("write `{name}`; the {key}s are {list}"),
                (None, None) => format!("the {key}s are {list}"),
            };
            self.wrong(reader, [format!("unknown {what} `{written}`"), format!("not a {key}"), help]);
        }
        found
    }

    /// A boolean.
    pub(super) fn flag(&self, reader: &mut Reader<'_>) -> Option<bool> {
        let flag = self.value.get_ref().as_bool();
        if flag.is_none() {
            self.wrong_type(reader, "true or false", &format!("{} = true", self.key()));
        }
        flag
    }

    /// A name in `snake_case`.
    pub(super) fn name(&self, reader: &mut Reader<'_>) -> Option<&'t str> {
        let name = self.text(reader, &format!("{} = \"some_name\"", self.key()))?;
        if let Some(words) = unfit(name) {
            reader.wrong(self.place, self.span(), words);
        }
        Some(name)
    }
}

/// Why a text cannot be a name, if it cannot.
pub(super) fn unfit(name: &str) -> Option<[String; 3]> {
    if !names::is_snake_case(name) {
        return Some(not_a_name(name));
    }
    (name.len() > names::MOST_CHARACTERS).then(|| {
        let (length, most) = (name.len(), names::MOST_CHARACTERS);
        [
            format!("a name of {length} characters is too long"),
            format!("a name has at most {most} characters: it is used in file names"),
            format!("write `{}`, or something clearer", name[..most / 4].trim_end_matches('_')),
        ]
    })
}

fn not_a_name(name: &str) -> [String; 3] {
    [
        format!("`{name}` is not a valid name"),
        "a name starts with a lowercase letter, followed by lowercase letters, digits and `_`".to_owned(),
        format!("write `{}`", names::snake_case(name)),
    ]
}

/// The message for a name that is a keyword of Rust.
pub(super) fn keyword(name: &str) -> [String; 3] {
    [
        format!("`{name}` is a keyword of Rust"),
        "cannot be the name of a module or a field".to_owned(),
        format!("choose another name, such as `{name}_0`"),
    ]
}

/// A key with the first of some words, and the others.
fn choice_example<T>(key: &str, known: &[(&'static str, T)]) -> String {
    let names: Vec<&str> = known.iter().map(|(name, _)| *name).collect();
    match names.as_slice() {
        [] => format!("{key} = \"...\""),
        [one] => format!("{key} = {one:?}"),
        [one, other] => format!("{key} = {one:?} (or `{other}`)"),
        [one, others @ ..] => format!("{key} = {one:?} (or one of {})", names::list(others)),
    }
}

/// What a value is, with its article.
pub(super) fn found(value: &DeValue<'_>) -> String {
    match value {
        DeValue::String(text) => format!("the string {text:?}"),
        DeValue::Integer(number) => format!("the number {number}"),
        DeValue::Float(number) => format!("the number {number}"),
        DeValue::Boolean(value) => format!("the boolean {value}"),
        DeValue::Datetime(_) => "a date or time".to_owned(),
        DeValue::Array(elements) => format!("an array of {}", elements.len()),
        DeValue::Table(_) => "a table".to_owned(),
    }
}

/// The kinds of a section, each with its own keys. `name` and `kind` belong to all.
pub(super) type Kinds<'k> = &'k [(&'static str, &'static [&'static str])];

/// Refuses the keys that belong to other kinds of the same section.
///
/// Where another kind has all the keys that are there it is the kind that was meant, and nothing is asked of the one
/// that is written.
pub(super) fn refuse_others(
    reader: &mut Reader<'_>,
    section: &Section<'_>,
    all: &[&'static str],
    (kind, kinds): (&str, Kinds<'_>),
) {
    let own = kinds.iter().find(|(name, _)| *name == kind).map_or(&[][..], |(_, keys)| keys);
    let is_kind_s = |key: &str, keys: &[&str]| matches!(key, "name" | "kind") || keys.contains(&key);
    let written: Vec<&str> = all.iter().copied().filter(|key| section.has(key)).collect();
    let fits = |keys: &[&str]| written.iter().all(|key| is_kind_s(key, keys));
    if fits(own) {
        return;
    }
    let other = kinds.iter().find(|(_, keys)| fits(keys)).map(|(name, _)| *name);
    for key in all.iter().filter(|key| !is_kind_s(key, own) && section.has(key)) {
        let help = match (other, own) {
            (Some(other), _) => format!("write kind = {other:?}, which has these keys"),
            (None, []) => "remove it: it has no keys of its own".to_owned(),
            (None, own) => format!("remove it: its keys are {}", names::list(own)),
        };
        section.refuse(
            reader,
            key,
            &format!("{} of kind \"{kind}\" takes no `{key}`", section.noun()),
            &help,
        );
    }
    if other.is_some() {
        own.iter().for_each(|key| reader.doubt(section.place(key)));
    }
}

/// The name that a key had before, under which it is still read.
fn former(owner: Owner, key: &str) -> Option<&'static str> {
    (matches!(owner, Owner::Joint(_)) && key == "damping").then_some("friction")
}

/// Remarks on a key that is written by its former name, or refuses it beside the present one.
fn former_key(
    reader: &mut Reader<'_>,
    (place, title): (Place, &str),
    key: &Spanned<DeString<'_>>,
    table: &DeTable<'_>,
) {
    let (written, name) = (key.get_ref(), place.key);
    if table.contains_key(name) {
        let message = format!("`{written}` is the former name of `{name}`, which {title} has, too");
        reader.wrong(place, key.span(), [message, "given twice".to_owned(), "remove it".to_owned()]);
    } else {
        reader.remarks.push(format!("`{written}` of {title} is `{name}` now: write {name} = ..."));
    }
}

fn unknown_key(
    reader: &mut Reader<'_>,
    (owner, title): (Owner, &str),
    key: &Spanned<DeString<'_>>,
    known: &[&'static str],
    table: &DeTable<'_>,
) {
    let written = key.get_ref();
    let elsewhere = synonyms::elsewhere(written, known);
    let meant = names::meant(written, known).filter(|_| elsewhere.is_none());
    let nearest = meant.and_then(|name| known.iter().find(|k| **k == name));
    let help = match (elsewhere, nearest) {
        (Some(help), _) => help.to_owned(),
        (None, Some(name)) if table.contains_key(*name) => format!("remove it: there is `{name}` already"),
        (None, Some(name)) => format!("write `{name}`"),
        (None, None) => format!("its keys are {}", names::list(known)),
    };
    if let Some(key) = nearest {
        // The key that was meant is not reported as missing, too.
        reader.doubt(Place { owner, key });
    }
    let words = [format!("unknown key `{written}` in {title}"), "not a valid key".to_owned(), help];
    reader.unknown(key.span(), words);
}
