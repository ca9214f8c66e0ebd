//! What a message says to write is written, and then the model file is read again: the mistake is gone, and what was
//! written is no mistake itself. Of cures that offer several ways each is tried.

use std::ops::Range;
use std::path::Path;

use gyro_model::{Diagnostic, Diagnostics, Model, read_with};

/// A model file in which something was written: the text, and where.
struct Cured {
    text: String,
    written: Range<usize>,
    /// Whether something has to be filled in that the message cannot know, so that it may be wrong.
    is_example: bool,
}

fn read_beside(path: &Path, text: &str) -> Result<Model, Diagnostics> {
    let folder = path.parent().expect("a folder");
    read_with("page.toml", text, &mut |table| {
        std::fs::read_to_string(folder.join(table)).map_err(|_| "there is no such file".to_owned())
    })
}

/// The model file with each of the cures that a message offers; none where its words are for a human.
fn cures(text: &str, mistake: &Diagnostic) -> Vec<Cured> {
    let (help, span) = (mistake.help.as_str(), mistake.span.clone());
    let replaced = |span: Range<usize>, with: &str| replaced(text, span, with);
    if let Some(rest) = help.strip_prefix("remove it") {
        let _ = rest;
        return vec![without(text, span.start)];
    }
    if let Some(names) = help.strip_prefix("remove `") {
        let names: Vec<&str> = names.split('`').step_by(2).take(2).collect();
        let found = names.iter().filter_map(|name| value_of(text, span.start, name));
        return if help.contains("` or `") {
            found.map(|value| without(text, value.start)).collect()
        } else {
            vec![]
        };
    }
    // A table lies in a file of its own, and which number stands behind a name the model file says elsewhere.
    if mistake.message.starts_with("table `") || help.starts_with("write the number itself") {
        return Vec::new();
    }
    let such_as = help.find("such as ").map(|at| &help[at + "such as ".len()..]);
    let Some(rest) = such_as.or_else(|| help.strip_prefix("write ")) else { return Vec::new() };
    if let Some((name, _)) = rest.strip_prefix('`').and_then(|rest| rest.split_once('`')) {
        let quoted = format!("{name:?}");
        let is_text = text[span.clone()].starts_with(['"', '\'']);
        return vec![replaced(span, if is_text { &quoted } else { name })];
    }
    if let Some((value, _)) = rest.split_once(" in place of ").or_else(|| rest.split_once(" without quotes"))
    {
        let mut cures = vec![replaced(span.clone(), value)];
        if let Some((_, other)) = rest.split_once(", or ") {
            cures.extend(assignments(other).into_iter().map(|(key, value)| {
                let line = text[..span.start].rfind('\n').map_or(0, |at| at + 1);
                replaced(line..span.end, &format!("{key} = {value}"))
            }));
        }
        return cures;
    }
    // In a list of tables the message does not say which.
    if text[span.clone()].starts_with("[{") {
        return Vec::new();
    }
    let end = ["first", "second"].into_iter().find(|end| rest.contains(&format!(" in `{end}`")));
    let place = end.and_then(|end| value_of(text, span.start, end)).unwrap_or(span);
    assignments(rest).into_iter().map(|(key, value)| assigned(text, &place, key, &value)).collect()
}

/// All that looks like `key = value` at the start of some words, and after each "or".
fn assignments(words: &str) -> Vec<(&str, String)> {
    let mut found = Vec::new();
    let mut rest = words;
    while let Some((before, after)) = rest.split_once(" = ") {
        let key = before.rsplit(|c: char| !(c.is_ascii_lowercase() || c == '_')).next().unwrap_or("");
        let end = end_of_value(after);
        // "second = ratio * first" in an explanation is nothing to write.
        let introduction = &before[..before.len() - key.len()];
        if !key.is_empty()
            && (introduction.is_empty() || introduction.ends_with("or ") || introduction.ends_with(", "))
        {
            found.push((key, after[..end].to_owned()));
        }
        rest = &after[end..];
    }
    found
}

fn end_of_value(text: &str) -> usize {
    let mut depth = 0;
    for (at, c) in text.char_indices() {
        match c {
            '[' | '{' => depth += 1,
            ']' | '}' => depth -= 1,
            ' ' | ',' | ':' | ';' if depth == 0 => return at,
            _ => {}
        }
    }
    text.len()
}

/// The value of a key set, where the mistake is or else in its table.
fn assigned(text: &str, span: &Range<usize>, key: &str, value: &str) -> Cured {
    let is_example =
        value.contains("..") || value.contains("motion") || value.contains("c0") || value.contains("xx");
    let is_inline = text[span.clone()].starts_with('{');
    let value = value
        .replace("\"...\"", "\"some_name\"")
        .replace("...", "1")
        .replace("..", "1")
        .replace("motion", "0")
        .replace("c0, c1, c2", "0, 1, 2")
        .replace("c0, c1", "0, 1");
    let own = value_of(text, span.start, key).filter(|own| !is_inline || span.contains(&own.start));
    let mut cured = match own {
        Some(own) => replaced(text, own, &value),
        None if is_inline => replaced(text, span.start + 1..span.start + 1, &format!(" {key} = {value}, ")),
        None => {
            let line = text[span.start..].find('\n').map_or(text.len(), |at| span.start + at + 1);
            // What is missing of the model file as a whole belongs before its first table.
            let line = if span.is_empty() { 0 } else { line };
            replaced(text, line..line, &format!("{key} = {value}\n"))
        }
    };
    cured.is_example = is_example;
    cured
}

/// The value of a key in the table around a place.
fn value_of(text: &str, at: usize, key: &str) -> Option<Range<usize>> {
    let start =
        if text[at..].starts_with("[[") { at } else { text[..at].rfind("\n[").map_or(0, |at| at + 1) };
    let end = text[at..].find("\n[").map_or(text.len(), |end| at + end);
    // Nearest to the place first: an inline table may have a key of the same name.
    let mut found: Vec<Range<usize>> = Vec::new();
    for (place, _) in text[start..end].match_indices(key) {
        let place = start + place;
        let is_whole = !text[..place].ends_with(|c: char| c.is_ascii_alphanumeric() || c == '_');
        let after = text[place + key.len()..].trim_start_matches(' ');
        if let (true, Some(value)) = (is_whole, after.strip_prefix('=')) {
            let value = value.trim_start_matches(' ');
            let from = text.len()
                - (text[place + key.len()..].len() - (text[place + key.len()..].len() - value.len()));
            let mut depth = 0;
            let ends = |c: char| {
                depth += i32::from(matches!(c, '[' | '{')) - i32::from(matches!(c, ']' | '}'));
                depth < 0 || depth == 0 && matches!(c, '\n' | ',' | '#')
            };
            let length = value.find(ends).unwrap_or(value.len());
            found.push(from..from + value[..length].trim_end().len());
        }
    }
    found.into_iter().min_by_key(|value| value.start.abs_diff(at))
}

fn replaced(text: &str, span: Range<usize>, with: &str) -> Cured {
    let written = span.start..span.start + with.len();
    Cured { text: format!("{}{with}{}", &text[..span.start], &text[span.end..]), written, is_example: false }
}

/// Without the key of a value: its line, or its part of an inline table.
fn without(text: &str, at: usize) -> Cured {
    let line = text[..at].rfind('\n').map_or(0, |at| at + 1)
        ..text[at..].find('\n').map_or(text.len(), |end| at + end + 1);
    let (open, close) = (text[line.start..at].rfind('{'), text[at..line.end].find('}'));
    let span = match (open, close) {
        (Some(open), Some(close)) => {
            let (open, close) = (line.start + open + 1, at + close);
            let comma = text[open..at].rfind(',').map(|comma| open + comma);
            match comma {
                Some(comma) => {
                    // A value in brackets has commas of its own.
                    let value = &text[at..close];
                    let end = value.find(']').filter(|_| value.starts_with('[')).map_or(0, |end| end + 1);
                    let end = value[end..].find(',').map_or(close, |next| at + end + next);
                    comma..end
                }
                None => open..text[at..close].find(',').map_or(close, |next| at + next + 1),
            }
        }
        _ => line,
    };
    replaced(text, span, "")
}

/// How many cures of a model file were tried, and which of them are none.
fn failures(path: &Path, text: &str) -> (usize, Vec<String>) {
    let mistakes = read_beside(path, text).expect_err("a model file with mistakes");
    let (mut tried, mut failures) = (0, Vec::new());
    for mistake in mistakes.mistakes() {
        for cured in cures(text, mistake) {
            tried += 1;
            let left = read_beside(path, &cured.text).err();
            let left = left.iter().flat_map(|left| left.mistakes());
            let is_of_it = |span: &Range<usize>| {
                cured.written.start <= span.start && span.end <= cured.written.end && !span.is_empty()
            };
            let is_same = |other: &Diagnostic| {
                let grown = cured.text.len() as isize - text.len() as isize;
                let moved = other.span.start as isize - mistake.span.start as isize;
                other.message == mistake.message && (moved == 0 || moved == grown)
            };
            let bad = left.filter(|other| is_same(other) || !cured.is_example && is_of_it(&other.span));
            failures.extend(bad.map(|other| {
                format!(
                    "{}: {}\n  = {}\nleaves: {}\n{}",
                    path.display(),
                    mistake.message,
                    mistake.help,
                    other.message,
                    cured.text
                )
            }));
        }
    }
    (tried, failures)
}

#[test]
fn every_cure_cures() {
    let (mut tried, mut all) = (0, Vec::new());
    for (path, text) in crate::support::pages("tests/bad-models") {
        // Where the syntax is broken no place is certain.
        if text.parse::<toml::Table>().is_err() {
            continue;
        }
        let (more, failures) = failures(&path, &text);
        tried += more;
        all.extend(failures);
    }
    assert!(all.is_empty(), "{} of {tried}:\n{}", all.len(), all.join("\n\n"));
    assert!(tried > 120, "{tried} cures");
}

/// A model file without mistakes, to be written as a stranger would.
const STRANGER_S: &str = r#"format = 1
name = "crank"
gravity = [0, 0, -9.81]

[simulation]
t_end = 1
step = 1e-3

[parameters]
length = 0.5

[[body]]
name = "wall"
fixed = true

[[body]]
name = "arm"
mass = 1
inertia = [0.1, 0.1, 0.1]

[[joint]]
name = "shoulder"
kind = "revolute"
axis = [0, 0, 1]
zero = [1, 0, 0]
first = { body = "wall" }
second = { body = "arm", point = ["length", 0, 0] }
damping = 0.1

[[force]]
name = "coil"
kind = "spring"
joint = "shoulder"
stiffness = 2
free = 0.1

[[output]]
name = "felt"
kind = "pose"
body = "arm"
"#;

/// What strangers write in place of what: each is a mistake with a cure, and the cure cures.
#[test]
fn the_words_of_others_are_understood() {
    let kind = |word: &str| ("kind = \"revolute\"".to_owned(), format!("kind = {word:?}"));
    let joints = [
        "hinge",
        "continuous",
        "pin",
        "Revolute",
        "slide",
        "slider",
        "ball",
        "weld",
        "rigid",
        "hooke",
        "helical",
    ];
    let mut changes: Vec<(String, String)> = joints.map(kind).into();
    let mut change = |from: &str, to: &str| changes.push((from.to_owned(), to.to_owned()));
    for word in ["torsion_spring", "tsda", "viscous", "dry_friction", "hard_stop", "actuator", "wrench"] {
        change("kind = \"spring\"", &format!("kind = {word:?}"));
    }
    for word in ["imu", "frame", "accel", "pos", "position", "location", "speed"] {
        change("kind = \"pose\"", &format!("kind = {word:?}"));
    }
    for (ours, theirs) in [
        ("mass = 1", "m = 1"),
        ("inertia = [", "I = ["),
        ("fixed = true", "static = true"),
        ("inertia = [0.1, 0.1, 0.1]", "inertia = [0.1, 0.1, 0.1]\ncom = [0, 0, 0]"),
        ("mass = 1", "mass = 1\ndensity = 3\nquat = [1, 0, 0, 0]"),
        ("kind = \"revolute\"", "type = \"revolute\""),
        ("kind = \"revolute\"", "kind = \"revolute\"\ntype = \"hinge\""),
        ("first = { body", "parent = { body"),
        ("second = { body", "child = { body"),
        ("point = [\"l", "origin = [\"l"),
        ("damping = 0.1", "viscosity = 0.1"),
        ("stiffness = 2", "k = 2"),
        ("free = 0.1", "springref = 0.1"),
        ("t_end = 1", "duration = 1"),
        ("step = 1e-3", "dt = 1e-3"),
        ("gravity = [0, 0, -9.81]", "g = [0, 0, -9.81]"),
        ("gravity = [0, 0, -9.81]", "gravity = -9.81"),
        ("gravity = [0, 0, -9.81]", "gravity = 9.81"),
        ("axis = [0, 0, 1]", "axis = \"z\""),
        ("axis = [0, 0, 1]", "axis = 1"),
        ("axis = [0, 0, 1]\nzero = [1, 0, 0]", "axis = [1, 0, 0]"),
        ("axis = [0, 0, 1]\nzero = [1, 0, 0]", "axis = [-1.0, 0, 0.0]"),
        ("axis = [0, 0, 1]\nzero = [1, 0, 0]", "axis = [\"length\", 0, 0]"),
        ("axis = [0, 0, 1]\nzero = [1, 0, 0]", "zero = [0, 0, 1]"),
        ("axis = [0, 0, 1]\nzero = [1, 0, 0]", "axis = [1, 0, 0]\nzero = [2, 0, 0]"),
        ("axis = [0, 0, 1]\nzero = [1, 0, 0]", "axis = [0, 0, 0]\nzero = [0, 0, 2]"),
        ("axis = [0, 0, 1]\nzero = [1, 0, 0]", "axis = [0, 0, 1]\nzero = [0, 0, 0]"),
        ("joint = \"shoulder\"", "first = { body = \"wall\" }\nsecond = { body = \"arm\" }"),
        ("joint = \"shoulder\"\nstiffness = 2\nfree = 0.1", "body = \"arm\"\nforce = [0, 0, 1]"),
        ("joint = \"shoulder\"\nstiffness = 2\nfree = 0.1", "joint = \"shoulder\"\nvalue = 1"),
    ] {
        change(ours, theirs);
    }
    let mut all = Vec::new();
    for (ours, theirs) in &changes {
        assert!(STRANGER_S.contains(ours.as_str()), "{ours}");
        let page = STRANGER_S.replacen(ours.as_str(), theirs, 1);
        let (tried, failures) = failures(Path::new("page.toml"), &page);
        all.extend((tried == 0).then(|| {
            format!("no cure of {theirs}: {}", read_beside(Path::new("a/b"), &page).expect_err("a mistake"))
        }));
        all.extend(failures);
    }
    assert!(all.is_empty(), "{} of {}:\n{}", all.len(), changes.len(), all.join("\n\n"));
}

/// What was called otherwise is still read, with a remark, and not beside its present name.
#[test]
fn keys_are_read_by_their_former_names() {
    let read = |keys: &str| read_beside(Path::new("a/b"), &STRANGER_S.replacen("damping = 0.1", keys, 1));
    let [now, before] = ["damping = 0.1", "friction = 0.1"].map(|keys| read(keys).expect("a model"));
    assert_eq!(now.joints[0].damping, before.joints[0].damping);
    assert!(now.remarks.is_empty() && !now.joints[0].damping.is_zero());
    assert_eq!(before.remarks, ["`friction` of joint `shoulder` is `damping` now: write damping = ..."]);
    let twice = read("damping = 0.1\nfriction = 0.1").expect_err("a mistake").render();
    assert!(twice.contains("`friction` is the former name of `damping`"), "{twice}");
    let misplaced = read("kind = \"fixed\"\nfriction = 0.1").is_err();
    assert!(misplaced);
}

/// Degrees that are written as radians are remarked upon, and radians are not.
#[test]
fn degrees_in_place_of_radians_are_remarked_upon() {
    let remarks = |start: &str| {
        let page = STRANGER_S.replacen("damping = 0.1", start, 1);
        read_beside(Path::new("a/b"), &page).expect("a model").remarks
    };
    for degrees in [7, 30, 45, 60, 180, -90, 360] {
        let found = remarks(&format!("angle = {degrees}"));
        assert!(found.iter().any(|words| words.contains(&format!("angle_deg = {degrees}"))), "{found:?}");
        assert!(remarks(&format!("angle_deg = {degrees}")).is_empty());
    }
    for radians in ["1", "-6", "62.83", "\"20*pi\"", "\"400 deg\""] {
        assert!(remarks(&format!("angle = {radians}")).is_empty(), "{radians}");
    }
}

/// Messages whose cure is no single edit say what to do.
#[test]
fn things_that_are_elsewhere_are_explained() {
    let check = |ours: &str, theirs: &str, words: &str| {
        let page = STRANGER_S.replacen(ours, theirs, 1);
        let mistakes = read_beside(Path::new("a/b"), &page).expect_err("a mistake").render();
        assert!(mistakes.contains(words), "{theirs}: {mistakes}");
    };
    check("mass = 1", "mass = \"2 stone\"", "unknown unit `stone`");
    check("kind = \"revolute\"", "kind = \"floating\"", "free = true");
    check("kind = \"revolute\"", "kind = \"gearbox\"", "[[coupler]]");
    check("damping = 0.1", "stiffness = 0.1", "[[force]] of kind \"spring\"");
    check("damping = 0.1", "range = [0, 1]", "[[force]] of kind \"stop\"");
    check("kind = \"spring\"", "kind = \"mount\"", "write `bushing`");
    check("stiffness = 2", "stiffness = \"10 + 5*shoulder^2\"", "`shoulder` is a joint, which moves");
    check("mass = 1", "mass = 1\ncom = [0, 0, 1]", "origin at the mass centre");
}
