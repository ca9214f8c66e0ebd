//! `docs/model-format.md` keeps up with the reader: its example is good, and its tables come from the table of keys.

use gyro_model::keys::{self, Key, Kind, Range, Table, Value};
use gyro_model::{Diagnostics, JointKind, Model, OutputKind, Support, read_with};

const PATH: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/model-format.md");

fn page() -> String {
    std::fs::read_to_string(PATH).expect("docs/model-format.md")
}

/// The text between the document's first fences of a kind.
fn fenced<'p>(page: &'p str, kind: &str) -> &'p str {
    let (_, rest) = page.split_once(&format!("```{kind}\n")).expect("an example");
    rest.split_once("```").expect("its end").0
}

/// Reads a model file with the table that the document of the format shows.
fn read(text: &str) -> Result<Model, Diagnostics> {
    let page = page();
    read_with("page.toml", text, &mut |table| match table {
        "lift.csv" => Ok(fenced(&page, "csv").to_owned()),
        _ => Err("no such table".to_owned()),
    })
}

/// All tables of keys that the document shows.
const TABLES: [&Table; 23] = [
    &keys::FILE,
    &keys::ATTRACTION,
    &keys::SIMULATION,
    &keys::BODY,
    &keys::DRIVEN,
    &keys::SHAPE,
    &keys::JOINT,
    &keys::JOINT_END,
    &keys::COUPLER,
    &keys::CONSTRAINT,
    &keys::DRIVER,
    &keys::MOTION,
    &keys::SINUSOID,
    &keys::FORCE,
    &keys::ELEMENT,
    &keys::ROLLING,
    &keys::FORMULA,
    &keys::STATE,
    &keys::OUTPUT,
    &keys::CONTROLLER,
    &keys::EVENT,
    &keys::CONTACT,
    &keys::CONTACT_SIDE,
];

/// A table of Markdown, without columns that are empty.
fn markdown(head: &[&str], rows: &[Vec<String>]) -> String {
    let is_shown = |column: &usize| rows.iter().any(|row| !row[*column].is_empty());
    let shown: Vec<usize> = (0..head.len()).filter(is_shown).collect();
    let line = |cells: Vec<&str>| {
        let cells: Vec<String> = shown.iter().map(|&column| format!(" {} |", cells[column])).collect();
        format!("|{}\n", cells.concat()).replace("|  |", "| |").replace("|  |", "| |")
    };
    let rows: String = rows.iter().map(|row| line(row.iter().map(String::as_str).collect())).collect();
    format!("{}|{}\n{rows}", line(head.to_vec()), "---|".repeat(shown.len()))
}

fn unit(key: &Key) -> String {
    let unit = key.unit().unwrap_or_default();
    unit.replace('.', "·").replace("s2", "s²").replace("m2", "m²").replace("m3", "m³")
}

/// A default: code where the model file would have it so, words otherwise.
fn default(key: &Key) -> String {
    let is_code = key.default.starts_with(['[', '"']) || matches!(key.default, "true" | "false");
    if is_code { format!("`{}`", key.default) } else { key.default.to_owned() }
}

/// The meaning of a key, with its words.
fn meaning(key: &Key) -> String {
    let Value::Word(words) = key.value else { return key.meaning.to_owned() };
    let words = words.iter().map(|(word, meaning)| match *meaning {
        "" => format!("`{word:?}`"),
        meaning => format!("`{word:?}` ({meaning})"),
    });
    let words = words.collect::<Vec<_>>().join(", ");
    if key.meaning.is_empty() { words } else { format!("{}: {words}", key.meaning) }
}

/// The keys of a table. Those of joints' kinds are among them, with the kinds that have them unless most do.
fn keys_table(table: &'static Table) -> String {
    let all = if table.name == "joint" { table.all() } else { table.keys.iter().collect() };
    let row = |key: &&Key| {
        let kinds = table.kinds.iter().filter(|kind| kind.key(key.name).is_some()).map(|kind| kind.word);
        let kinds: Vec<&str> = kinds.collect();
        let of = if matches!(kinds.len(), 1..=5) { format!("{}: ", kinds.join(", ")) } else { String::new() };
        let range = match range(key) {
            "" => String::new(),
            range => format!(",{range}"),
        };
        vec![format!("`{}`", key.name), format!("{of}{}{range}", meaning(key)), unit(key), default(key)]
    };
    markdown(&["key", "meaning", "unit", "default"], &all.iter().map(row).collect::<Vec<_>>())
}

fn range(key: &Key) -> &'static str {
    match key.range {
        Range::Any => "",
        Range::Positive(_) => " > 0",
        Range::NotNegative(_) => " ≥ 0",
        Range::NotZero(_) => " ≠ 0",
    }
}

/// A key of a kind in one phrase.
fn phrase(key: &Key) -> String {
    let range = range(key);
    let default = match default(key) {
        words if key.is_required || words.is_empty() => String::new(),
        words if words.starts_with("required") => words,
        words => format!("{words} unless given"),
    };
    let words = [unit(key), default, meaning(key)];
    let words: Vec<String> = words.into_iter().filter(|words| !words.is_empty()).collect();
    match (key.name, words.as_slice()) {
        _ if matches!(key.value, Value::Reference) || key.name == "coordinate" => format!("`{}`", key.name),
        (_, []) => format!("`{}`{range}", key.name),
        (name, words) => format!("`{name}`{range} ({})", words.join("; ")),
    }
}

fn kinds_table(table: &'static Table) -> String {
    let row = |kind: &Kind| {
        let word = format!("`{:?}`", kind.word);
        match JointKind::named(kind.word).filter(|_| table.name == "joint") {
            Some(joint) => {
                let names = joint.coordinates().iter().map(|of| format!("`{}`", of.name()));
                let names: Vec<String> = names.collect();
                let names = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
                vec![word, kind.meaning.to_owned(), joint.row_units().len().to_string(), names]
            }
            None => {
                let keys: Vec<String> = kind.keys.iter().map(phrase).collect();
                vec![word, kind.meaning.to_owned(), keys.join(", "), String::new()]
            }
        }
    };
    let head = match table.name {
        "joint" => ["kind", "what holds", "rows", "coordinates"],
        _ => ["kind", "what it is", "its keys", ""],
    };
    markdown(&head, &table.kinds.iter().map(row).collect::<Vec<_>>())
}

/// The document with its tables as the table of keys has them.
fn fresh(page: &str) -> String {
    const END: &str = "<!-- end of keys -->";
    let (head, rest) = page.split_once("<!-- keys: ").expect("a table");
    let parts = rest.split("<!-- keys: ").map(|part| {
        let (name, part) = part.split_once(" -->").expect("the end of a mark");
        let (_, after) = part.split_once(END).expect("the end of a table");
        let of = |name: &str| TABLES.into_iter().find(|table| table.name == name).expect("a table of keys");
        let table =
            name.strip_prefix("kinds of ").map_or_else(|| keys_table(of(name)), |name| kinds_table(of(name)));
        format!("<!-- keys: {name} -->\n\n{table}\n{END}{after}")
    });
    format!("{head}{}", parts.collect::<String>())
}

/// `UPDATE_EXPECT=1` writes them anew.
#[test]
fn the_tables_of_keys_are_fresh() {
    let fresh = fresh(&page());
    if std::env::var_os("UPDATE_EXPECT").is_some() {
        std::fs::write(PATH, &fresh).expect("the folder can be written to");
    }
    assert!(
        page() == fresh,
        "UPDATE_EXPECT=1 cargo test -p gyro-model --test suite format_page writes them anew"
    );
    for table in TABLES {
        assert!(fresh.contains(&format!("<!-- keys: {} -->", table.name)), "{}", table.name);
    }
}

#[test]
fn the_example_is_good_and_shows_everything() {
    let page = page();
    let model = read(fenced(&page, "toml")).unwrap_or_else(|mistakes| panic!("{mistakes}"));
    for kind in JointKind::ALL {
        assert!(model.joints.iter().any(|j| j.kind == kind), "{kind:?}");
    }
    for support in [Support::Fixed, Support::Free, Support::Moving, Support::Driven] {
        assert!(model.bodies.iter().any(|b| b.support == support), "{support:?}");
    }
    for kind in keys::FORCE.kinds {
        assert!(model.forces.iter().any(|force| force.kind.parts().word == kind.word), "{}", kind.word);
    }
    assert!(model.outputs.iter().any(|output| matches!(output.kind, OutputKind::Reaction { .. })));
    assert!(!model.inputs.is_empty() && !model.couplers.is_empty() && !model.drivers.is_empty());
}

#[test]
fn names_have_at_most_a_hundred_characters() {
    assert!(page().contains("at most 100 characters"));
    let named = |length: usize| {
        let (text, name) = (page(), "n".repeat(length));
        let example = fenced(&text, "toml");
        let line = example.lines().find(|line| line.starts_with("name = ")).expect("the mechanism's name");
        read(&example.replacen(line, &format!("name = \"{name}\""), 1))
    };
    assert!(named(100).is_ok());
    let said = named(101).expect_err("a name that is too long").render();
    assert!(said.contains("at most 100 characters") && said.contains("write `nnn"), "{said}");
}
