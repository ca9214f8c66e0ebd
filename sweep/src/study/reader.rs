//! Tables and values of a study file, and the mistakes in them.

use super::Span;
use gyro_model::Diagnostic;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Mistakes so far.
#[derive(Debug, Default)]
pub(super) struct Reader {
    pub(super) mistakes: Vec<Diagnostic>,
}

impl Reader {
    pub(super) fn wrong(&mut self, span: Span, words: [&str; 3]) {
        let [message, label, help] = words.map(str::to_owned);
        self.mistakes.push(Diagnostic { span, message, label, help, related: Vec::new() });
    }
}

/// A table with the keys that it may have.
#[derive(Clone, Debug)]
pub(super) struct Section<'t> {
    table: &'t DeTable<'t>,
    span: Span,
    title: &'static str,
}

/// The value of a key.
#[derive(Clone, Copy, Debug)]
pub(super) struct Item<'t> {
    pub(super) key: &'t str,
    value: &'t Spanned<DeValue<'t>>,
}

impl<'t> Section<'t> {
    /// Reports the unknown keys.
    pub(super) fn open(
        reader: &mut Reader,
        table: &'t DeTable<'t>,
        span: Span,
        title: &'static str,
        known: &[&str],
    ) -> Self {
        for (key, _) in table {
            let written = key.get_ref().as_ref();
            if !known.contains(&written) {
                let message = format!("unknown key `{written}` in {title}");
                reader.wrong(
                    key.span(),
                    [&message, "not a valid key", &instead(written, known, "its keys are")],
                );
            }
        }
        Self { table, span, title }
    }

    pub(super) fn get(&self, key: &'t str) -> Option<Item<'t>> {
        self.table.get(key).map(|value| Item { key, value })
    }

    /// The value of a key that must be there.
    pub(super) fn require(&self, reader: &mut Reader, key: &'t str, example: &str) -> Option<Item<'t>> {
        let item = self.get(key);
        if item.is_none() {
            let message = format!("{} has no `{key}`", self.title);
            let label = format!("needs `{key}`");
            reader.wrong(self.span.clone(), [&message, &label, &format!("write {example}")]);
        }
        item
    }

    /// A mistake at a key, or at the table if the key is not there.
    pub(super) fn wrong(&self, reader: &mut Reader, key: &str, words: [&str; 3]) {
        let span = self.table.get(key).map_or(self.span.clone(), Spanned::span);
        reader.wrong(span, words);
    }

    pub(super) fn span(&self) -> Span {
        self.span.clone()
    }
}

impl<'t> Item<'t> {
    pub(super) fn span(&self) -> Span {
        self.value.span()
    }

    fn wrong_type(&self, reader: &mut Reader, expected: &str) {
        let found = match self.value.get_ref() {
            DeValue::String(text) => format!("the string {text:?}"),
            DeValue::Integer(number) => format!("the number {number}"),
            DeValue::Float(number) => format!("the number {number}"),
            DeValue::Boolean(value) => format!("the boolean {value}"),
            DeValue::Datetime(_) => "a date or time".to_owned(),
            DeValue::Array(elements) => format!("an array of {}", elements.len()),
            DeValue::Table(_) => "a table".to_owned(),
        };
        let message = format!("`{}` must be {expected}", self.key);
        reader.wrong(self.span(), [&message, &format!("found {found}"), &format!("write {expected}")]);
    }

    pub(super) fn text(&self, reader: &mut Reader) -> Option<String> {
        let text = self.value.get_ref().as_str().map(str::to_owned);
        if text.is_none() {
            self.wrong_type(reader, "a string");
        }
        text
    }

    pub(super) fn flag(&self, reader: &mut Reader) -> Option<bool> {
        let flag = self.value.get_ref().as_bool();
        if flag.is_none() {
            self.wrong_type(reader, "true or false");
        }
        flag
    }

    /// A number that is finite.
    pub(super) fn number(&self, reader: &mut Reader) -> Option<f64> {
        let number = number(self.value.get_ref());
        if number.is_none() {
            self.wrong_type(reader, "a finite number");
        }
        number
    }

    /// A whole number.
    pub(super) fn whole(&self, reader: &mut Reader) -> Option<u64> {
        let number = match self.value.get_ref() {
            DeValue::Integer(integer) => integer.as_str().replace('_', "").parse().ok(),
            _ => None,
        };
        if number.is_none() {
            self.wrong_type(reader, "a whole number, not negative");
        }
        number
    }

    /// A whole number of one or more.
    pub(super) fn positive(&self, reader: &mut Reader) -> Option<u64> {
        let number = self.whole(reader)?;
        if number == 0 {
            self.wrong_type(reader, "a whole number above zero");
        }
        (number > 0).then_some(number)
    }

    /// So many numbers.
    pub(super) fn numbers<const N: usize>(&self, reader: &mut Reader, expected: &str) -> Option<[f64; N]> {
        let found: Option<Vec<f64>> =
            self.elements().and_then(|all| all.iter().map(|e| number(e.value.get_ref())).collect());
        let found = found.and_then(|found| <[f64; N]>::try_from(found).ok());
        if found.is_none() {
            self.wrong_type(reader, expected);
        }
        found
    }

    /// Rows of `n` numbers; of one number also a number each.
    pub(super) fn rows(&self, reader: &mut Reader, n: usize) -> Option<Vec<Vec<f64>>> {
        let row = |element: &Item<'t>| match number(element.value.get_ref()) {
            Some(number) if n == 1 => Some(vec![number]),
            _ => {
                let row: Option<Vec<f64>> =
                    element.elements()?.iter().map(|e| number(e.value.get_ref())).collect();
                row.filter(|row| row.len() == n)
            }
        };
        let rows: Option<Vec<_>> = self.elements().and_then(|all| all.iter().map(row).collect());
        let rows = rows.filter(|rows| !rows.is_empty());
        if rows.is_none() {
            let expected = match n {
                1 => "an array of numbers".to_owned(),
                _ => format!("an array of rows of {n} numbers"),
            };
            self.wrong_type(reader, &expected);
        }
        rows
    }

    /// The elements of an array.
    pub(super) fn elements(&self) -> Option<Vec<Item<'t>>> {
        let elements = self.value.get_ref().as_array()?;
        Some(elements.iter().map(|value| Item { key: self.key, value }).collect())
    }

    /// A string, or several.
    pub(super) fn texts(&self, reader: &mut Reader) -> Option<Vec<(String, Span)>> {
        let one = |item: &Item<'t>| Some((item.value.get_ref().as_str()?.to_owned(), item.span()));
        let found = one(self).map(|text| vec![text]);
        let found =
            found.or_else(|| self.elements()?.iter().map(one).collect()).filter(|all| !all.is_empty());
        if found.is_none() {
            self.wrong_type(reader, "a string or an array of strings");
        }
        found
    }

    /// A table inside of a value.
    pub(super) fn section(
        &self,
        reader: &mut Reader,
        title: &'static str,
        known: &[&str],
    ) -> Option<Section<'t>> {
        let Some(table) = self.value.get_ref().as_table() else {
            self.wrong_type(reader, "a table");
            return None;
        };
        Some(Section::open(reader, table, self.span(), title, known))
    }

    /// One of some words.
    pub(super) fn choice<T: Copy>(&self, reader: &mut Reader, known: &[(&str, T)]) -> Option<T> {
        let written = self.text(reader)?;
        let found = known.iter().find(|(name, _)| *name == written);
        if found.is_none() {
            let names: Vec<&str> = known.iter().map(|(name, _)| *name).collect();
            let message = format!("unknown {} `{written}`", self.key);
            reader.wrong(self.span(), [&message, "not known", &instead(&written, &names, "there are")]);
        }
        found.map(|(_, value)| *value)
    }
}

fn number(value: &DeValue<'_>) -> Option<f64> {
    let text = match value {
        DeValue::Integer(number) if number.radix() == 10 => number.as_str(),
        DeValue::Float(number) => number.as_str(),
        _ => return None,
    };
    text.replace('_', "").parse().ok().filter(|number: &f64| number.is_finite())
}

/// Names of a list that are written out.
const LISTED: usize = 40;

/// What to write in place of an unknown name.
pub(super) fn instead(written: &str, known: &[&str], introduction: &str) -> String {
    let list: Vec<String> = known.iter().take(LISTED).map(|name| format!("`{name}`")).collect();
    let more =
        if known.len() > LISTED { format!(" and {} more", known.len() - LISTED) } else { String::new() };
    let list = list.join(", ");
    if known.is_empty() {
        return "there is nothing of that kind".to_owned();
    }
    match gyro_model::meant(written, known) {
        Some(meant) => format!("write `{meant}`; {introduction} {list}{more}"),
        None => format!("{introduction} {list}{more}"),
    }
}
