//! The schema from the table of keys.

use gyro_model::keys::{FILE, Key, MOTION, Range, Table, Value};
use serde_json::{Map, Value as Json, json};

/// The schema as the text of `model.schema.json`.
pub fn schema() -> String {
    let mut definitions = Map::new();
    let mut schema = table(&FILE, &mut definitions);
    let motion = table(&MOTION, &mut definitions);
    definitions.insert("Motion".to_owned(), json!({ "anyOf": [reference("Number"), motion] }));
    for (name, description, schema) in [
        ("Number", "A number, the name of a parameter or an input, or an expression.", numeric()),
        ("Plain", "A number, or an expression without parameters.", numeric()),
        (
            "Name",
            "A lowercase letter, then lowercase letters, digits and underscores.",
            json!({ "type": "string", "pattern": "^[a-z][a-z0-9_]*$", "maxLength": 100 }),
        ),
    ] {
        definitions.insert(name.to_owned(), described(schema, description));
    }
    schema["$schema"] = json!("https://json-schema.org/draft/2020-12/schema");
    schema["title"] = json!("Model");
    schema["$defs"] = Json::Object(definitions);
    serde_json::to_string_pretty(&schema).expect("a schema is a value of JSON") + "\n"
}

fn numeric() -> Json {
    json!({ "type": ["number", "string"] })
}

fn reference(name: &str) -> Json {
    json!({ "$ref": format!("#/$defs/{name}") })
}

fn described(mut schema: Json, description: &str) -> Json {
    schema["description"] = json!(description);
    schema
}

/// A table whose keys are those of all its kinds: which go together is the reader's to say.
fn table(of: &'static Table, definitions: &mut Map<String, Json>) -> Json {
    let mut properties = Map::new();
    for key in of.all() {
        let mut schema = values(of, key, definitions);
        let description = description(of, key);
        if !description.is_empty() {
            schema = described(schema, &description);
        }
        if !key.former.is_empty() {
            let former = format!("The former name of `{}`.", key.name);
            properties.insert(key.former.to_owned(), described(schema.clone(), &former));
        }
        properties.insert(key.name.to_owned(), schema);
    }
    let required: Vec<&str> = of.keys.iter().filter(|key| key.is_required).map(|key| key.name).collect();
    json!({
        "type": "object",
        "description": of.meaning,
        "properties": properties,
        "required": required,
        "additionalProperties": false,
    })
}

/// What may stand under a key: in different kinds it may be different things.
fn values(of: &'static Table, key: &Key, definitions: &mut Map<String, Json>) -> Json {
    let mut schemas = vec![value(of, key.value, key.is_required, definitions)];
    for own in of.kinds.iter().filter_map(|kind| kind.key(key.name)) {
        let schema = value(of, own.value, own.is_required, definitions);
        if !schemas.contains(&schema) {
            schemas.push(schema);
        }
    }
    if schemas.len() > 1 { json!({ "anyOf": schemas }) } else { schemas.remove(0) }
}

fn value(of: &'static Table, value: Value, is_required: bool, definitions: &mut Map<String, Json>) -> Json {
    let array = |items: Json, least: usize, most: usize| {
        let most = if most == usize::MAX { json!({}) } else { json!({ "maxItems": most }) };
        let mut array = json!({ "type": "array", "items": items, "minItems": least });
        array.as_object_mut().expect("an object").extend(most.as_object().expect("an object").clone());
        array
    };
    let words = |words: &[(&str, &str)]| {
        let all = words.iter().map(|(word, meaning)| match *meaning {
            "" => json!({ "const": word }),
            meaning => json!({ "const": word, "description": plain(meaning) }),
        });
        json!({ "oneOf": all.collect::<Vec<_>>() })
    };
    match value {
        Value::Number(_) | Value::Strength(_) => reference("Number"),
        Value::Plain(_) => reference("Plain"),
        Value::Name => reference("Name"),
        Value::Numbers(n, _) => array(reference("Number"), n, n),
        Value::Strengths(_) => array(reference("Number"), 3, 3),
        Value::List(most, _) => array(reference("Number"), 1, most),
        Value::Rows => array(array(reference("Number"), 1, usize::MAX), 1, usize::MAX),
        Value::Flag => json!({ "type": "boolean" }),
        Value::Text | Value::Reference => json!({ "type": "string" }),
        Value::Texts(least, most) => array(json!({ "type": "string" }), least, most),
        Value::Word(all) => words(all),
        Value::Kind => words(&of.kinds.iter().map(|kind| (kind.word, kind.meaning)).collect::<Vec<_>>()),
        Value::Motion(_) => reference("Motion"),
        Value::Motions(0, _) => array(reference("Motion"), 1, usize::MAX),
        Value::Motions(n, _) => array(reference("Motion"), n, n),
        Value::Table(inner) => defined(inner, definitions),
        Value::Tables(inner) => array(defined(inner, definitions), usize::from(is_required), usize::MAX),
        Value::Entries(each) => {
            json!({ "type": "object", "additionalProperties": self::value(of, *each, false, definitions) })
        }
        Value::Either(values) => {
            let values = values.iter().map(|one| self::value(of, *one, false, definitions));
            json!({ "anyOf": values.collect::<Vec<_>>() })
        }
    }
}

/// A reference to a table that is defined once.
fn defined(of: &'static Table, definitions: &mut Map<String, Json>) -> Json {
    let capitalised = |word: &str| word[..1].to_uppercase() + &word[1..];
    let name: String = of.name.split(['_', ' ']).map(capitalised).collect();
    if !definitions.contains_key(&name) {
        let schema = table(of, definitions);
        definitions.insert(name.clone(), schema);
    }
    reference(&name)
}

/// Meaning, unit and default of a key; where only some kinds have it, of each of these.
fn description(of: &'static Table, key: &'static Key) -> String {
    if of.keys.iter().any(|common| common.name == key.name) {
        return said(key);
    }
    let mut groups: Vec<(String, Vec<&str>)> = Vec::new();
    for (own, kind) in of.kinds.iter().filter_map(|kind| Some((kind.key(key.name)?, kind.word))) {
        match groups.iter_mut().find(|(text, _)| *text == said(own)) {
            Some((_, kinds)) => kinds.push(kind),
            None => groups.push((said(own), vec![kind])),
        }
    }
    let text = |(text, kinds): (String, Vec<&str>)| match (text.as_str(), kinds.len()) {
        // What most kinds have is not said to be of some.
        (_, 6..) => text,
        ("", _) => format!("{}.", kinds.join(", ")),
        _ => format!("{}: {text}", kinds.join(", ")),
    };
    groups.into_iter().map(text).collect::<Vec<_>>().join(" ")
}

fn said(key: &Key) -> String {
    if let Value::Kind = key.value {
        return String::new();
    }
    let range = match key.range {
        Range::Any => "",
        Range::Positive(_) => "greater than 0",
        Range::NotNegative(_) => "0 or more",
        Range::NotZero(_) => "not 0",
    };
    let parts = [key.meaning, key.unit().unwrap_or_default(), range];
    let text = parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(", ");
    let default = if key.default.is_empty() || key.is_required {
        String::new()
    } else {
        format!("; default: {}", key.default)
    };
    plain(
        format!("{text}{default}.")
            .replace(", see below", "")
            .trim_start_matches("; ")
            .trim_start_matches('.'),
    )
}

/// Markdown without the targets of links.
fn plain(text: &str) -> String {
    let Some((before, after)) = text.split_once("](") else { return text.to_owned() };
    let (start, word) = before.rsplit_once('[').unwrap_or(("", before));
    let rest = after.split_once(')').map_or("", |(_, rest)| rest);
    format!("{start}{word}{}", plain(rest))
}
