//! A table of the model file with the keys that it may have: every other key is reported.

use std::ops::Range;

use num_bigint::BigInt;
use toml::Spanned;
use toml::de::{DeString, DeTable, DeValue};

use super::reader::Reader;
use super::{names, synonyms};
use crate::keys::{Key, Kind, Table, Value};
use crate::validate::{Owner, Place};

/// A table of the model file.
pub(super) struct Section<'t> {
    pub(super) owner: Owner,
    /// What it is called in messages.
    pub(super) title: String,
    pub(super) keys: &'static Table,
    /// Its kind, once that is read.
    pub(super) kind: Option<&'static Kind>,
    table: &'t DeTable<'t>,
    /// Where what is missing is reported, of a table inside a value.
    whole: Option<Item<'t>>,
}

/// The value of a key.
#[derive(Clone, Copy)]
pub(super) struct Item<'t> {
    pub(super) place: Place,
    pub(super) key: &'static Key,
    pub(super) value: &'t Spanned<DeValue<'t>>,
}

impl<'t> Section<'t> {
    /// Marks the places of all known keys and reports the unknown ones.
    pub(super) fn open(
        reader: &mut Reader<'_>,
        owner: Owner,
        title: impl Into<String>,
        table: &'t DeTable<'t>,
        keys: &'static Table,
    ) -> Self {
        let section = Self { owner, title: title.into(), keys, kind: None, table, whole: None };
        let known = keys.all();
        for (key, value) in table {
            let written = key.get_ref().as_ref();
            let former = known.iter().find(|known| known.former == written);
            match known.iter().find(|known| known.name == written).or(former) {
                Some(known) => reader.mark(section.place(known.name), value.span()),
                None => section.unknown(reader, key, &known),
            }
            if let Some(known) = former {
                section.former(reader, key, known);
            }
        }
        section
    }

    /// The table of an item. It has its place: what it lacks is reported there.
    pub(super) fn within(
        reader: &mut Reader<'_>,
        item: Item<'t>,
        title: impl Into<String>,
        keys: &'static Table,
    ) -> Option<Self> {
        let table = item.table(reader)?;
        Some(Self { whole: Some(item), ..Self::open(reader, item.place.owner, title, table, keys) })
    }

    /// The table under a key, with a place of its own.
    pub(super) fn inner(
        &self,
        reader: &mut Reader<'_>,
        key: &'static str,
        (owner, title): (Owner, &str),
    ) -> Option<Self> {
        let item = self.find(reader, key)?;
        let Value::Table(keys) = item.key.value else { return None };
        let table = item.table(reader)?;
        reader.mark(Place { owner, key: "" }, item.span());
        Some(Self::open(reader, owner, title, table, keys))
    }

    /// Reads which of the table's kinds it is and refuses keys of others: with `cure` it says what to do about a key.
    ///
    /// Where another kind has all the keys that are there it is the kind that was meant, and nothing is asked of the
    /// one that is written.
    pub(super) fn read_kind(
        &mut self,
        reader: &mut Reader<'_>,
        cure: fn(&Kind, &str) -> Option<String>,
    ) -> Option<&'static Kind> {
        let item = self.find(reader, "kind")?;
        let own = item.kind(reader, self.keys)?;
        self.kind = Some(own);
        let is_common = |key: &Key| self.keys.keys.iter().any(|common| common.name == key.name);
        let all = self.keys.all();
        let mut written = all.into_iter().filter(|key| !is_common(key) && self.has(key.name));
        let fits = |kind: &Kind| written.clone().all(|key| kind.key(key.name).is_some());
        if fits(own) {
            return Some(own);
        }
        let other = self.keys.kinds.iter().find(|kind| fits(kind));
        for key in written.by_ref().filter(|key| own.key(key.name).is_none()) {
            let help = match (cure(own, key.name), other, own.keys) {
                (Some(help), ..) => help,
                (None, Some(other), _) => format!("write kind = {:?}, which has these keys", other.word),
                (None, None, []) => "remove it: it has no keys of its own".to_owned(),
                (None, None, own) => format!("remove it: its keys are {}", names::list(&called(own))),
            };
            let message = format!("{} takes no `{}`", self.kind_noun(own), key.name);
            self.refuse(reader, key.name, &message, &help);
        }
        if other.is_some() {
            own.keys.iter().for_each(|key| reader.doubt(self.place(key.name)));
        }
        Some(own)
    }

    /// One of the kind, in words.
    pub(super) fn kind_noun(&self, kind: &Kind) -> String {
        match (self.owner, kind.word) {
            (Owner::Joint(_), "rod") => "a rod".to_owned(),
            (Owner::Joint(_), word) => format!("a {word} joint"),
            (_, word) => format!("{} of kind \"{word}\"", self.keys.noun()),
        }
    }

    /// What is written.
    pub(super) fn table(&self) -> &'t DeTable<'t> {
        self.table
    }

    /// Whether it has no keys but those that it may have.
    pub(super) fn is_known(&self) -> bool {
        let known = self.keys.all();
        self.table.keys().all(|key| known.iter().any(|known| known.name == key.get_ref().as_ref()))
    }

    pub(super) fn place(&self, key: &'static str) -> Place {
        Place { owner: self.owner, key }
    }

    /// The row of a key in the table of keys: the kind's own, or else that of any kind.
    pub(super) fn key(&self, name: &str) -> &'static Key {
        let own = self.keys.keys.iter().chain(self.kind.iter().flat_map(|kind| kind.keys));
        let others = self.keys.kinds.iter().flat_map(|kind| kind.keys);
        own.chain(others).find(|key| key.name == name).expect("what is asked for is in the table of keys")
    }

    pub(super) fn get(&self, name: &'static str) -> Option<Item<'t>> {
        let key = self.key(name);
        let value = self.table.get(name).or_else(|| self.table.get(key.former));
        value.map(|value| Item { place: self.place(name), key, value })
    }

    pub(super) fn has(&self, name: &'static str) -> bool {
        self.get(name).is_some()
    }

    /// The value of a key; reports that it is missing where it is required.
    pub(super) fn find(&self, reader: &mut Reader<'_>, name: &'static str) -> Option<Item<'t>> {
        if self.key(name).is_required { self.require(reader, name) } else { self.get(name) }
    }

    /// The value of a key that must be there.
    pub(super) fn require(&self, reader: &mut Reader<'_>, name: &'static str) -> Option<Item<'t>> {
        let cure = match self.key(name) {
            Key { value: Value::Kind, .. } => {
                let words: Vec<&str> = self.keys.kinds.iter().map(|kind| kind.word).collect();
                choice_example(name, &words)
            }
            key => cure(key),
        };
        self.require_as(reader, name, &cure)
    }

    /// The same with what to write.
    pub(super) fn require_as(
        &self,
        reader: &mut Reader<'_>,
        name: &'static str,
        cure: &str,
    ) -> Option<Item<'t>> {
        let (item, place) = (self.get(name), self.place(name));
        if item.is_none() && !reader.is_doubted(place) {
            let title = &self.title;
            let words =
                [format!("{title} has no `{name}`"), format!("needs `{name}`"), format!("write {cure}")];
            match self.whole {
                Some(whole) => reader.missing_at(whole.place, whole.span(), words),
                None => reader.missing(place, words),
            }
        }
        item
    }

    /// Refuses a key that is known but out of place here.
    pub(super) fn refuse(&self, reader: &mut Reader<'_>, name: &'static str, message: &str, help: &str) {
        if let Some(item) = self.get(name) {
            item.wrong(reader, [message.to_owned(), "not allowed here".to_owned(), help.to_owned()]);
        }
    }

    /// Of two keys that say the same the one that is there; where both are, the second is refused.
    pub(super) fn either(
        &self,
        reader: &mut Reader<'_>,
        [kept, other]: [&'static str; 2],
        message: &str,
    ) -> Option<Item<'t>> {
        if self.has(kept) {
            self.refuse(reader, other, message, &format!("remove `{kept}` or `{other}`"));
        }
        self.get(kept).or_else(|| self.get(other))
    }

    /// A boolean, which has a default.
    pub(super) fn flag(&self, reader: &mut Reader<'_>, name: &'static str) -> bool {
        let default = self.key(name).default == "true";
        self.get(name).and_then(|item| item.flag(reader)).unwrap_or(default)
    }

    /// One of the key's words.
    pub(super) fn word(&self, reader: &mut Reader<'_>, name: &'static str) -> Option<&'static str> {
        let item = self.find(reader, name)?;
        item.word(reader)
    }

    /// Remarks on a key that is written by its former name, or refuses it beside the present one.
    fn former(&self, reader: &mut Reader<'_>, written: &Spanned<DeString<'_>>, key: &'static Key) {
        let (span, written, name, title) = (written.span(), written.get_ref(), key.name, &self.title);
        if self.table.contains_key(name) {
            let message = format!("`{written}` is the former name of `{name}`, which {title} has, too");
            reader.wrong(self.place(name), span, [message, "given twice".to_owned(), "remove it".to_owned()]);
        } else {
            reader.remarks.push(format!("`{written}` of {title} is `{name}` now: write {name} = ..."));
        }
    }

    fn unknown(&self, reader: &mut Reader<'_>, key: &Spanned<DeString<'_>>, known: &[&'static Key]) {
        let (written, title) = (key.get_ref(), &self.title);
        let known = called(known.iter().copied());
        let elsewhere = synonyms::elsewhere(written, &known);
        let meant = names::meant(written, &known).filter(|_| elsewhere.is_none());
        let nearest = meant.and_then(|name| known.iter().copied().find(|known| *known == name));
        let help = match (elsewhere, nearest) {
            (Some(help), _) => help.to_owned(),
            (None, Some(name)) if self.table.contains_key(name) => {
                format!("remove it: there is `{name}` already")
            }
            (None, Some(name)) => format!("write `{name}`"),
            (None, None) => format!("its keys are {}", names::list(&known)),
        };
        if let Some(name) = nearest {
            // The key that was meant is not reported as missing, too.
            reader.doubt(self.place(name));
        }
        let words = [format!("unknown key `{written}` in {title}"), "not a valid key".to_owned(), help];
        reader.unknown(key.span(), words);
    }
}

/// All of some things, where none is missing; each is asked for, so that all mistakes are found.
pub(super) fn all<T>(things: impl Iterator<Item = Option<T>>) -> Option<Vec<T>> {
    things.collect::<Vec<_>>().into_iter().collect()
}

/// The names of keys.
fn called(keys: impl IntoIterator<Item = &'static Key>) -> Vec<&'static str> {
    keys.into_iter().map(|key| key.name).collect()
}

/// What to write under a key.
pub(super) fn cure(key: &Key) -> String {
    let name = key.name;
    match key.value {
        _ if !key.example.is_empty() => key.example.to_owned(),
        Value::Word(words) => choice_example(name, &words.iter().map(|(word, _)| *word).collect::<Vec<_>>()),
        Value::Reference => format!("{name} = \"...\", the name of a [[{name}]]"),
        Value::Flag => format!("{name} = true"),
        Value::Text => format!("{name} = \"...\""),
        Value::Name => format!("{name} = \"some_name\""),
        Value::Table(table) => format!("{name} = {{ {} = \"...\" }}", table.keys[0].name),
        Value::Tables(_) => format!("[[{name}]] on a line of its own above each {}", name.replace('_', " ")),
        _ => key.cure(),
    }
}

impl<'t> Item<'t> {
    pub(super) fn span(&self) -> Range<usize> {
        self.value.span()
    }

    pub(super) fn wrong(&self, reader: &mut Reader<'_>, words: [String; 3]) {
        reader.wrong(self.place, self.span(), words);
    }

    /// What is written of a number: as a formula has it.
    pub(super) fn written(&self) -> Option<String> {
        match self.value.get_ref() {
            DeValue::String(text) => Some(text.to_string()),
            DeValue::Float(float) => Some(float.as_str().trim_start_matches('+').to_owned()),
            DeValue::Integer(integer) => {
                let value = BigInt::parse_bytes(integer.as_str().as_bytes(), integer.radix())?;
                Some(value.to_string())
            }
            _ => None,
        }
    }

    /// Reports that something of another type was expected.
    pub(super) fn wrong_type(&self, reader: &mut Reader<'_>, expected: &str) {
        self.wrong_type_with(reader, expected, format!("write {}", cure(self.key)));
    }

    /// The same with another cure.
    pub(super) fn wrong_type_with(&self, reader: &mut Reader<'_>, expected: &str, help: String) {
        let words = [
            format!("`{}` must be {expected}", self.key.name),
            format!("found {}", found(self.value.get_ref())),
            help,
        ];
        self.wrong(reader, words);
    }

    pub(super) fn text(&self, reader: &mut Reader<'_>) -> Option<&'t str> {
        let text = self.value.get_ref().as_str();
        if text.is_none() {
            self.wrong_type(reader, "a string");
        }
        text
    }

    /// The elements of an array; none of what is no array.
    pub(super) fn elements(self) -> impl Iterator<Item = Self> + 't {
        let elements = self.value.get_ref().as_array().into_iter().flat_map(|array| array.iter());
        elements.map(move |value| Item { value, ..self })
    }

    /// An array of some texts, each with its place.
    pub(super) fn texts(&self, reader: &mut Reader<'_>, expected: &str) -> Option<Vec<(Self, &'t str)>> {
        let word = |value| Some((Item { value, ..*self }, value.get_ref().as_str()?));
        let elements = self.value.get_ref().as_array();
        let texts = elements.and_then(|elements| elements.iter().map(word).collect::<Option<Vec<_>>>());
        if texts.is_none() {
            self.wrong_type(reader, expected);
        }
        texts
    }

    pub(super) fn table(&self, reader: &mut Reader<'_>) -> Option<&'t DeTable<'t>> {
        let value = self.value.get_ref();
        match (value.as_table(), value.as_str(), self.key.value) {
            (Some(_), ..) => {}
            // A name alone is that of what the table names first.
            (
                None,
                Some(text),
                Value::Table(Table { keys: [Key { name, value: Value::Reference, .. }, ..], .. }),
            ) => {
                let help = format!("write {} = {{ {name} = {text:?} }}", self.key.name);
                self.wrong_type_with(reader, "a table", help);
            }
            _ => self.wrong_type(reader, "a table"),
        }
        value.as_table()
    }

    /// The tables of an array.
    pub(super) fn tables(&self, reader: &mut Reader<'_>) -> Vec<(Self, &'t DeTable<'t>)> {
        if self.value.get_ref().as_array().is_none() {
            self.wrong_type(reader, "an array of tables");
        }
        self.elements().filter_map(|item| Some((item, item.table(reader)?))).collect()
    }

    /// One of the key's words.
    pub(super) fn word(&self, reader: &mut Reader<'_>) -> Option<&'static str> {
        let Value::Word(words) = self.key.value else { return None };
        let known: Vec<&'static str> = words.iter().map(|(word, _)| *word).collect();
        let words = match self.key.name {
            "between" => ("way between rows", "way"),
            "beyond" => ("way beyond the ends", "way"),
            "coordinates" => ("coordinates", "word"),
            name => (name, name),
        };
        self.one_of(reader, &known, words)
    }

    /// One of a table's kinds.
    fn kind(&self, reader: &mut Reader<'_>, table: &'static Table) -> Option<&'static Kind> {
        let known: Vec<&'static str> = table.kinds.iter().map(|kind| kind.word).collect();
        let word = self.one_of(reader, &known, (&format!("kind of {}", table.name), "kind"))?;
        table.kind(word)
    }

    /// One of some words, of which it is said at length and in short what they are.
    fn one_of(
        &self,
        reader: &mut Reader<'_>,
        known: &[&'static str],
        (what, word): (&str, &str),
    ) -> Option<&'static str> {
        let Some(written) = self.value.get_ref().as_str() else {
            let help = format!("write {}", choice_example(self.key.name, known));
            self.wrong_type_with(reader, "a string", help);
            return None;
        };
        let found = known.iter().copied().find(|name| *name == written);
        if found.is_none() {
            let list = names::list(known);
            let help = match (synonyms::no_kind(written, what), names::meant(written, known)) {
                (Some(help), _) => help.to_owned(),
                (None, Some(name)) => format!("write `{name}`; the {word}s are {list}"),
                (None, None) => format!("the {word}s are {list}"),
            };
            self.wrong(reader, [format!("unknown {what} `{written}`"), format!("not a {word}"), help]);
        }
        found
    }

    /// A boolean.
    pub(super) fn flag(&self, reader: &mut Reader<'_>) -> Option<bool> {
        let flag = self.value.get_ref().as_bool();
        if flag.is_none() {
            self.wrong_type(reader, "true or false");
        }
        flag
    }

    /// A name in `snake_case`.
    pub(super) fn name(&self, reader: &mut Reader<'_>) -> Option<&'t str> {
        let name = self.text(reader)?;
        if let Some(words) = unfit(name) {
            self.wrong(reader, words);
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
fn choice_example(key: &str, known: &[&str]) -> String {
    match known {
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
