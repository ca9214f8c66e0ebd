//! Changes to a model file as TOML: what comes out has no error of syntax.

use chacha20::ChaCha8Rng;
use rand::RngExt;
use toml::Value;

#[expect(clippy::approx_constant, reason = "people write it so")]
/// Numbers that people, programs and mischief write.
const NUMBERS: [f64; 22] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    0.5,
    1e-3,
    1e-9,
    1e-76,
    1e-100,
    1e-300,
    1e9,
    1e76,
    1e100,
    1e300,
    1.5708,
    std::f64::consts::PI,
    std::f64::consts::FRAC_PI_2,
    0.083_333_333_333_333_33,
    0.1,
    1.000_000_000_000_000_2,
    f64::NAN,
    f64::INFINITY,
];

/// One to four changes, mostly one; none if the text is not TOML.
pub fn changed(random: &mut ChaCha8Rng, text: &str) -> Option<String> {
    let mut page = Value::Table(text.parse().ok()?);
    for _ in 0..[1, 1, 1, 2, 4][random.random_range(0..5)] {
        let mut places = Vec::new();
        walk(&page, &mut Vec::new(), &mut places);
        let from = places[random.random_range(0..places.len())].clone();
        let to = places[random.random_range(0..places.len())].clone();
        let found = at(&mut page, &from)?.clone();
        change(random, at(&mut page, &to)?, found);
    }
    toml::to_string(&page).ok()
}

/// The way to a value: indices into tables and arrays.
type Way = Vec<usize>;

fn walk(value: &Value, way: &mut Way, ways: &mut Vec<Way>) {
    let children: Vec<&Value> = match value {
        Value::Table(table) => table.iter().map(|(_, child)| child).collect(),
        Value::Array(array) => array.iter().collect(),
        _ => Vec::new(),
    };
    for (index, child) in children.into_iter().enumerate() {
        way.push(index);
        ways.push(way.clone());
        walk(child, way, ways);
        way.pop();
    }
    if way.is_empty() && ways.is_empty() {
        ways.push(Vec::new());
    }
}

fn at<'v>(value: &'v mut Value, way: &[usize]) -> Option<&'v mut Value> {
    let Some((&first, rest)) = way.split_first() else { return Some(value) };
    let child = match value {
        Value::Table(table) => table.iter_mut().nth(first).map(|(_, child)| child),
        Value::Array(array) => array.get_mut(first),
        _ => None,
    };
    child.and_then(|child| at(child, rest))
}

fn change(random: &mut ChaCha8Rng, value: &mut Value, other: Value) {
    let number = Value::Float(NUMBERS[random.random_range(0..NUMBERS.len())]);
    match (random.random_range(0..6), &mut *value) {
        (0, Value::Table(table)) => {
            let key = table.keys().nth(random.random_range(0..table.len().max(1))).cloned();
            key.map(|key| table.remove(&key));
        }
        (1, Value::Table(table)) => {
            // A value under a key that may be known: those of the model file.
            let key = table.keys().nth(random.random_range(0..table.len().max(1))).cloned();
            table.insert(key.unwrap_or_else(|| "mass".to_owned()), other);
        }
        (0, Value::Array(array)) => drop(array.pop()),
        (1, Value::Array(array)) if array.len() < 50 => array.extend(array.clone()),
        (2, Value::Array(array)) if array.len() > 1 => array.reverse(),
        (3, Value::Array(array)) => array.push(other),
        (2 | 3, _) => *value = other,
        (4, Value::Float(x)) => *x *= 1.0 + 1e-16 * f64::from(random.random_range(-9..9)),
        _ => *value = number,
    }
}
