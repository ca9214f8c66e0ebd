//! Whether a C text computes what a module computes: the same operations on the same numbers, in the same order.
//!
//! `gyro export c` writes the functions of a module in C. Here the C text is read back, by a reader of its own, and run
//! symbolically: assignments, loops over tables of constants, and the elementary functions are all that there is. What
//! each function stores must then be, operation for operation, what the module's function gives. So what is proved of
//! the module holds of the C text, and both round alike.

mod expression;
mod statements;
mod tokens;

use crate::module::Module;
use crate::nodes::Nodes;
use crate::program::{Id, Program};
use crate::refusal::Refusal;
use gyro_model::Model;
use statements::Reader;
use std::collections::HashMap;
use tokens::{Token, tokens};

/// Compares header and source in C with the text of a module, which they were written from. Returns the number of
/// functions that are the same; the functions that compute nothing of their own (starts, and those that hand on to
/// others) are not among them.
///
/// # Errors
/// The first difference, or what in the C text is not of the subset that is written, with its line in the source.
pub fn same_in_c(
    model: &Model,
    (module, constants): (&str, &str),
    (header, source): (&str, &str),
) -> Result<usize, Refusal> {
    let module = Module::read(model, module, constants)?;
    let header = tokens(header)?;
    let named = named_numbers(&header);
    let prefix = prefix(&header).ok_or_else(|| Refusal::new(1, "the header names no type of numbers"))?;
    let source = tokens(source)?;
    for (name, program) in &module.written {
        let is_of_charts = ["newton_step", "solve_velocities"].contains(&name.as_str());
        let c_name = format!("{prefix}_{name}{}", if is_of_charts { "_on" } else { "" });
        let place = definition(&source, &c_name)
            .ok_or_else(|| Refusal::new(1, format!("the C source has no function `{c_name}`")))?;
        let mut nodes = Nodes::default();
        let expected = nodes.of_program(program, &module);
        let line = source[place].line;
        let stored = Reader::new(&mut nodes, &named, prefix).function(&source[place..])?;
        compare(&c_name, line, (program, &expected), &stored)?;
    }
    Ok(module.written.len())
}

/// Something that is stored: the array, where in it, and what.
#[derive(Clone, Debug)]
struct Stored {
    array: String,
    place: Vec<usize>,
    value: Id,
    line: usize,
}

fn compare(
    name: &str,
    line: usize,
    (program, expected): (&Program, &[Id]),
    stored: &[Stored],
) -> Result<(), Refusal> {
    if stored.len() != expected.len() {
        let (n, of) = (stored.len(), expected.len());
        return Err(Refusal::new(line, format!("`{name}` stores {n} numbers where the module gives {of}")));
    }
    let stored = in_order(stored);
    let (mut array, mut next) = ("", Vec::new());
    for (n, (stored, expected)) in stored.iter().zip(expected).enumerate() {
        if stored.value != *expected {
            let at = format!("{}{:?}", stored.array, stored.place);
            return Err(Refusal::new(stored.line, format!("`{name}`: {at} is not what the module gives")));
        }
        let is_in_place = match program.places.get(n) {
            Some(place) => stored.place == [*place],
            None => stored.place == next || stored.array != array && stored.place.iter().all(|k| *k == 0),
        };
        if !is_in_place {
            return Err(Refusal::new(
                stored.line,
                format!("`{name}` stores {:?} out of order", stored.place),
            ));
        }
        array = &stored.array;
        next = after(&stored.place);
    }
    Ok(())
}

/// What is stored, array for array, by its places: loops store in an order of their own.
fn in_order(stored: &[Stored]) -> Vec<&Stored> {
    let first = |array: &str| stored.iter().position(|other| other.array == array);
    let mut sorted: Vec<_> = stored.iter().map(|stored| (first(&stored.array), stored)).collect();
    sorted.sort_by(|(a, one), (b, other)| (a, &one.place).cmp(&(b, &other.place)));
    sorted.into_iter().map(|(_, stored)| stored).collect()
}

/// The next place of an array; arrays of arrays have four columns.
fn after(place: &[usize]) -> Vec<usize> {
    match place {
        [row, 3] => vec![row + 1, 0],
        [row, column] => vec![*row, column + 1],
        place => place.iter().map(|k| k + 1).collect(),
    }
}

/// Where a function is defined: its name, outside of all braces, with a body behind its arguments.
fn definition(tokens: &[Token], name: &str) -> Option<usize> {
    (0..tokens.len()).find(|&at| {
        let is_head = tokens[at].text == name && tokens.get(at + 1).is_some_and(|next| next.text == "(");
        let is_declared = at > 0 && tokens[at - 1].text == "void";
        let body = tokens[at..].iter().position(|token| token.text == ")").map(|end| at + end + 1);
        is_head && is_declared && body.is_some_and(|body| tokens.get(body).is_some_and(|t| t.text == "{"))
    })
}

/// What names begin with: `typedef double NAME_real` is the header's first type.
fn prefix(tokens: &[Token]) -> Option<&str> {
    let real = tokens.windows(3).find(|words| words[0].text == "typedef")?;
    real[2].text.strip_suffix("_real")
}

/// `NAME = 3` in the header: the places of parameters and inputs.
fn named_numbers(tokens: &[Token]) -> HashMap<String, usize> {
    let triples = tokens.windows(3).filter(|triple| triple[1].text == "=");
    triples.filter_map(|triple| Some((triple[0].text.clone(), triple[2].text.parse().ok()?))).collect()
}
