//! Names: what may be one, and which one may have been meant.

use super::synonyms;

/// Keywords of Rust, which cannot be the name of a module or a field.
const KEYWORDS: [&str; 51] = [
    "abstract", "as", "async", "await", "become", "box", "break", "const", "continue", "crate", "do", "dyn",
    "else", "enum", "extern", "false", "final", "fn", "for", "gen", "if", "impl", "in", "let", "loop",
    "macro", "match", "mod", "move", "mut", "override", "priv", "pub", "ref", "return", "self", "static",
    "struct", "super", "trait", "true", "try", "type", "typeof", "unsafe", "unsized", "use", "virtual",
    "where", "while", "yield",
];

/// Files and types are named by names, and a file's name must not be longer than some 255 characters, of which tools
/// want some.
pub(super) const MOST_CHARACTERS: usize = 100;

/// Whether a name is in `snake_case`: a lowercase letter, then lowercase letters, digits and underscores.
pub(super) fn is_snake_case(name: &str) -> bool {
    name.starts_with(|c: char| c.is_ascii_lowercase())
        && name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_')
}

/// Whether a name is a word of Rust, which a mechanism or an input cannot be called.
pub fn is_keyword(name: &str) -> bool {
    KEYWORDS.contains(&name)
}

/// A name in `snake_case` made of what was written.
pub(super) fn snake_case(written: &str) -> String {
    let mut name = String::new();
    for c in written.chars() {
        if c.is_ascii_uppercase()
            && !name.is_empty()
            && !name.ends_with('_')
            && !name.ends_with(char::is_numeric)
        {
            name.push('_');
        }
        match c.to_ascii_lowercase() {
            c if c.is_ascii_alphanumeric() => name.push(c),
            _ if name.is_empty() || name.ends_with('_') => {}
            _ => name.push('_'),
        }
    }
    let name = name.trim_end_matches('_');
    if is_snake_case(name) { name.to_owned() } else { format!("a{name}") }
}

/// The known name that was meant: what the word of another program stands for, or else the nearest in letters.
#[must_use]
pub fn meant<'n>(written: &str, known: &[&'n str]) -> Option<&'n str> {
    synonyms::meant(written, known).or_else(|| nearest(written, known))
}

/// The place of a column of a run's table among the names of all: `hinge rate` is also `hinge_rate`, as it is called
/// among the states of a linearisation, wherever no other column has that name.
pub fn column<'n>(written: &str, mut names: impl Iterator<Item = &'n str> + Clone) -> Option<usize> {
    let plain = |c: char| if matches!(c, ' ' | '.') { '_' } else { c };
    let is_it = |name: &str| written.chars().map(plain).eq(name.chars().map(plain));
    names.clone().position(|name| name == written).or_else(|| names.position(is_it))
}

/// Longer names, and more of them, are not searched for what may have been meant.
const LONGEST: usize = 100;
const MOST: usize = 1000;

/// The known name that differs least from what was written, if it is near enough to have been meant.
pub(super) fn nearest<'n>(written: &str, known: &[&'n str]) -> Option<&'n str> {
    // The search takes as long as lengths and numbers of names multiplied.
    let is_near =
        |name: &&&str| name.len().abs_diff(written.len()) <= name.len().max(written.len()).div_ceil(3);
    let known: Vec<&str> = known.iter().filter(is_near).copied().collect();
    if written.len() > LONGEST || known.len() > MOST {
        return None;
    }
    let written = written.to_lowercase();
    let distance = |name: &str| strsim::damerau_levenshtein(&written, &name.to_lowercase());
    let letters = |name: &str| {
        let mut letters: Vec<char> = name.chars().collect();
        letters.sort_unstable();
        letters
    };
    // Of equally near names, one of the same letters.
    let best = known.iter().min_by_key(|name| (distance(name), letters(name) != letters(&written)))?;
    let length = written.chars().count().max(best.chars().count());
    // Of a single letter nothing would be left.
    let most = length.div_ceil(3).min(length.saturating_sub(1));
    (distance(best) <= most).then_some(best)
}

/// What to write instead of an unknown name.
pub(super) fn instead(written: &str, known: &[&str]) -> String {
    let only = known.first().copied().filter(|_| known.len() == 1);
    match meant(written, known).or(only) {
        Some(name) => format!("write `{name}`"),
        None => format!("write one of {}", list(known)),
    }
}

/// Names in backquotes, separated by commas.
pub(super) fn list(names: &[&str]) -> String {
    let shown: Vec<String> = names.iter().take(LISTED).map(|name| format!("`{name}`")).collect();
    let more = names.len().saturating_sub(LISTED);
    if more == 0 { shown.join(", ") } else { format!("{} and {more} more", shown.join(", ")) }
}

/// Names of a list that are written out.
const LISTED: usize = 40;

#[cfg(test)]
mod tests;
