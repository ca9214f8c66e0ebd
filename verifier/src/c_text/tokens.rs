//! Words of a C text.

use crate::refusal::Refusal;

/// A word: a name, a number or a mark.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Token {
    pub(super) text: String,
    pub(super) line: usize,
}

/// Marks of two letters.
const PAIRS: [&str; 10] = ["->", "++", "--", "<=", ">=", "==", "!=", "+=", "-=", "*="];

/// All words but comments and the preprocessor's lines.
pub(super) fn tokens(text: &str) -> Result<Vec<Token>, Refusal> {
    let mut tokens = Vec::new();
    let (mut rest, mut line) = (text, 1);
    while let Some(first) = rest.chars().next() {
        let length = if first == '\n' {
            line += 1;
            1
        } else if first.is_whitespace() {
            first.len_utf8()
        } else if rest.starts_with("/*") {
            let end = rest.find("*/").ok_or_else(|| Refusal::new(line, "a comment that does not end"))?;
            line += rest[..end].matches('\n').count();
            end + 2
        } else if first == '#' {
            rest.find('\n').unwrap_or(rest.len())
        } else {
            let length = word(rest);
            tokens.push(Token { text: rest[..length].to_owned(), line });
            length
        };
        rest = &rest[length..];
    }
    Ok(tokens)
}

/// The length of the word that a text begins with.
fn word(text: &str) -> usize {
    let is_letter = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let first = text.chars().next().unwrap_or(' ');
    if first.is_ascii_digit() {
        let mut before = ' ';
        let is_of_number = |c: char| {
            let is_exponent = matches!(before, 'e' | 'E') && matches!(c, '+' | '-');
            before = c;
            is_letter(c) || c == '.' || is_exponent
        };
        let mut is_of_number = is_of_number;
        return text.find(|c: char| !is_of_number(c)).unwrap_or(text.len());
    }
    if is_letter(first) {
        return text.find(|c: char| !is_letter(c)).unwrap_or(text.len());
    }
    if first == '"' {
        return text[1..].find('"').map_or(text.len(), |end| end + 2);
    }
    if PAIRS.iter().any(|pair| text.starts_with(pair)) { 2 } else { first.len_utf8() }
}
