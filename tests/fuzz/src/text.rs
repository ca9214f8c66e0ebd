//! Changes to a text as bytes and as tokens; it is not known of what.

use chacha20::ChaCha8Rng;
use rand::RngExt;

/// Words at the ends of what can be read, and what texts of both kinds are made of.
const TOKENS: [&str; 62] = [
    "0",
    "1",
    "-1",
    "-0.0",
    "1e-76",
    "1e-300",
    "1e300",
    "1e-9223372036854775808",
    "1e99999999999999999999",
    "nan",
    "-inf",
    "0x7fffffffffffffff",
    "99999999999999999999999999",
    "0.1000000000000000000000000000001",
    "1.5707963267948966",
    "true",
    "\"\"",
    "\"30 deg\"",
    "\"2*pi/3\"",
    "\"1/(1 - 1)\"",
    "\"(length^9)^9 / mass\"",
    "\"-sqrt((2))\"",
    "^",
    "/",
    "\"base\"",
    "\"é\\n\"",
    "[",
    "]",
    "[[",
    "]]",
    "{",
    "}",
    "(",
    ")",
    "=",
    ",",
    ".",
    ";",
    "#",
    "#!",
    "\n",
    "'",
    "\"\"\"",
    "é",
    "\u{feff}",
    "\0",
    "\r",
    "body",
    "joint",
    "parameters",
    "free",
    "fixed",
    "driven",
    "let",
    "fn",
    "const",
    "self",
    "T::constant",
    "#[cfg(any())]",
    "as",
    "/*",
    "//",
];

/// One to five changes.
pub fn changed(random: &mut ChaCha8Rng, text: &str) -> String {
    let mut text = text.to_owned();
    for _ in 0..random.random_range(1..=5) {
        text = change(random, &text);
    }
    text
}

fn change(random: &mut ChaCha8Rng, text: &str) -> String {
    let mut bytes = text.as_bytes().to_vec();
    let at = random.random_range(0..=bytes.len());
    let token = TOKENS[random.random_range(0..TOKENS.len())];
    match random.random_range(0..8) {
        0 => bytes.iter_mut().skip(at).take(1).for_each(|byte| *byte ^= 1 << random.random_range(0..8)),
        1 => drop(bytes.splice(at..at, token.bytes())),
        2 => drop(bytes.drain(at..(at + random.random_range(1..60)).min(text.len()))),
        3 => {
            // A part once more, somewhere or many times over.
            let part = bytes[at..(at + random.random_range(1..200)).min(text.len())].to_vec();
            let times = if random.random_bool(0.05) { 2000 } else { 1 };
            let to = random.random_range(0..=bytes.len());
            bytes.splice(to..to, part.repeat(times));
        }
        4 => return swapped(random, text),
        _ => return replaced(random, text, token),
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

/// Two lines in each other's place.
fn swapped(random: &mut ChaCha8Rng, text: &str) -> String {
    let mut lines: Vec<&str> = text.lines().collect();
    if !lines.is_empty() {
        let n = lines.len();
        lines.swap(random.random_range(0..n), random.random_range(0..n));
    }
    lines.join("\n")
}

/// A token, or another word of the text, in place of one word or number.
fn replaced(random: &mut ChaCha8Rng, text: &str, token: &str) -> String {
    let of_word = |c: char| c.is_alphanumeric() || "_.-".contains(c);
    let mut words: Vec<std::ops::Range<usize>> = Vec::new();
    for (at, c) in text.char_indices().filter(|(_, c)| of_word(*c)) {
        match words.last_mut().filter(|word| word.end == at) {
            Some(word) => word.end = at + c.len_utf8(),
            None => words.push(at..at + c.len_utf8()),
        }
    }
    if words.is_empty() {
        return token.to_owned();
    }
    let mut any = || words[random.random_range(0..words.len())].clone();
    let (word, other) = (any(), any());
    let by = if random.random_bool(0.5) { token } else { &text[other] };
    format!("{}{by}{}", &text[..word.start], &text[word.end..])
}
