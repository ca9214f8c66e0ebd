//! Cranelift's text of a function, run as it is read.

use crate::nodes::Nodes;
use crate::program::{Function, Id, Node, Source};
use crate::refusal::Refusal;
use std::collections::HashMap;

/// What the addresses are that a function is given.
pub(super) struct Arrays<'a> {
    pub(super) parameters: usize,
    pub(super) derived: usize,
    pub(super) inputs: usize,
    pub(super) curves: usize,
    pub(super) tables: &'a [f64],
    /// What an element of the state is that is read, and one of what is given with it.
    pub(super) state: fn(usize) -> Source,
    pub(super) given: fn(usize) -> Source,
    /// What stands where the results are stored before they are, if it may be read.
    pub(super) before: Option<fn(usize) -> Source>,
}

/// The arrays in the order of the arguments after the time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Array {
    State,
    Given,
    Own,
    Tables,
    Work,
    Out,
}

const ARRAYS: [Array; 6] = [Array::State, Array::Given, Array::Own, Array::Tables, Array::Work, Array::Out];

/// What a value is.
#[derive(Clone, Copy, Debug)]
enum Held {
    Number(Id),
    Whole(i64),
    Truth(bool),
    /// So many bytes after the beginning of an array.
    Address(Array, i64),
}

/// An instruction, in words: `v3`, `=`, `fadd`, `v1`, `v2`.
#[derive(Clone, Debug)]
struct Line<'t> {
    words: Vec<&'t str>,
    number: usize,
}

/// A block: its parameters and its instructions.
#[derive(Clone, Debug, Default)]
struct Block<'t> {
    parameters: Vec<&'t str>,
    lines: Vec<Line<'t>>,
}

/// How many functions a curve has: its value and three derivatives.
const N_ORDERS: usize = Function::LAST_ORDER as usize + 1;

/// A function may run for so many instructions.
const LONGEST: usize = 50_000_000;

/// Runs a function; gives what it has stored in its last argument: of each place the number, and the line.
pub(super) fn run(
    nodes: &mut Nodes,
    arrays: &Arrays<'_>,
    text: &str,
) -> Result<HashMap<usize, (Id, usize)>, Refusal> {
    let (blocks, functions) = blocks(text)?;
    let mut reader = Reader { nodes, arrays, functions, held: HashMap::new(), stored: HashMap::new() };
    let entry = blocks.get("block0").ok_or_else(|| Refusal::new(1, "a function without a first block"))?;
    let time = reader.nodes.push(Node::Read(Source::Time));
    let given = ARRAYS.map(|array| Held::Address(array, 0));
    let arguments: Vec<Held> = [Held::Number(time)].into_iter().chain(given).collect();
    let mut next = Some(("block0", arguments));
    let mut n_done = entry.lines.len();
    while let Some((name, arguments)) = next.take() {
        let block = blocks.get(name).ok_or_else(|| Refusal::new(1, format!("there is no {name}")))?;
        if block.parameters.len() != arguments.len() {
            return Err(Refusal::new(1, format!("{name} is given {} values", arguments.len())));
        }
        block.parameters.iter().zip(arguments).for_each(|(name, value)| {
            reader.held.insert((*name).to_owned(), value);
        });
        n_done += block.lines.len();
        if n_done > LONGEST {
            return Err(Refusal::new(1, "a function without an end"));
        }
        let mut is_over = false;
        for line in &block.lines {
            if is_over {
                return Err(refused(line));
            }
            match reader.instruction(line)? {
                Then::Next => {}
                Then::Block(name, arguments) => (next, is_over) = (Some((name, arguments)), true),
                Then::End => is_over = true,
            }
        }
        if !is_over {
            return Err(Refusal::new(1, format!("{name} does not end")));
        }
    }
    let results = reader.stored.into_iter().filter(|((array, _), _)| *array == Array::Out);
    Ok(results.map(|((_, place), value)| (place, value)).collect())
}

fn refused(line: &Line<'_>) -> Refusal {
    Refusal::new(line.number, format!("`{}` is not of the subset that is written", line.words.join(" ")))
}

/// What a name of a function stands for.
type Functions = HashMap<String, usize>;

/// The blocks of a text by their names, and what the functions are that it calls.
fn blocks(text: &str) -> Result<(HashMap<&str, Block<'_>>, Functions), Refusal> {
    let (mut blocks, mut functions): (HashMap<&str, Block<'_>>, Functions) = Default::default();
    let mut current = None;
    for (number, line) in (1..).zip(text.lines()) {
        let line = line.split(';').next().unwrap_or_default();
        let separates = |c: char| c.is_whitespace() || "(),:".contains(c);
        let words: Vec<&str> = line.split(separates).filter(|word| !word.is_empty()).collect();
        match words[..] {
            [] | ["}"] | ["function", ..] => {}
            [name, ref parameters @ ..] if name.starts_with("block") => {
                let parameters = parameters.iter().filter(|word| word.starts_with('v')).copied().collect();
                if blocks.insert(name, Block { parameters, lines: Vec::new() }).is_some() {
                    return Err(Refusal::new(number, format!("{name} is there twice")));
                }
                current = Some(name);
            }
            // `fn0 = u0:1 sig0`
            [name, "=", "u0", place, _] if current.is_none() && name.starts_with("fn") => {
                let place = place.parse().map_err(|_| Refusal::new(number, "a function of no number"))?;
                functions.insert(name.to_owned(), place);
            }
            [name, ..] if current.is_none() && name.starts_with("sig") => {}
            _ => {
                let line = Line { words, number };
                let block = current.and_then(|name| blocks.get_mut(name)).ok_or_else(|| refused(&line))?;
                block.lines.push(line);
            }
        }
    }
    Ok((blocks, functions))
}

/// What follows an instruction.
enum Then<'t> {
    Next,
    Block(&'t str, Vec<Held>),
    End,
}

struct Reader<'a> {
    nodes: &'a mut Nodes,
    arrays: &'a Arrays<'a>,
    functions: Functions,
    held: HashMap<String, Held>,
    /// By array and place, with the line.
    stored: HashMap<(Array, usize), (Id, usize)>,
}

impl Reader<'_> {
    fn instruction<'t>(&mut self, line: &Line<'t>) -> Result<Then<'t>, Refusal> {
        let value = match line.words[..] {
            ["return"] => return Ok(Then::End),
            ["jump", block, ref arguments @ ..] => {
                let arguments =
                    arguments.iter().map(|name| self.value(name, line)).collect::<Result<_, _>>()?;
                return Ok(Then::Block(block, arguments));
            }
            ["brif", condition, then, other] => {
                let Held::Truth(is) = self.value(condition, line)? else { return Err(refused(line)) };
                return Ok(Then::Block(if is { then } else { other }, Vec::new()));
            }
            ["store" | "store.f64", "notrap", "aligned", value, address] => {
                let (array, place) = self.place(address, line)?;
                if !matches!(array, Array::Work | Array::Out) {
                    return Err(refused(line));
                }
                let value = self.number(value, line)?;
                self.stored.insert((array, place), (value, line.number));
                return Ok(Then::Next);
            }
            // Sine and cosine of an angle.
            [sine, cosine, "=", "call", function, angle]
                if self.functions.get(function) == Some(&Function::ALL.len()) =>
            {
                let angle = self.number(angle, line)?;
                for (name, of) in [(sine, Function::Sin), (cosine, Function::Cos)] {
                    let value = self.nodes.push(Node::Call(of, [angle; 2]));
                    self.held.insert(name.to_owned(), Held::Number(value));
                }
                return Ok(Then::Next);
            }
            [_, "=", ref operation @ ..] => self.operation(operation, line)?,
            _ => return Err(refused(line)),
        };
        self.held.insert(line.words[0].to_owned(), value);
        Ok(Then::Next)
    }

    fn operation(&mut self, operation: &[&str], line: &Line<'_>) -> Result<Held, Refusal> {
        // A type is written where operands do not tell it.
        let operation: Vec<&str> = operation.iter().enumerate().map(|(n, word)| bare(n, word)).collect();
        let node = match operation[..] {
            ["f64const", text] => {
                let value = float(text).ok_or_else(|| refused(line))?;
                return Ok(Held::Number(self.nodes.literal(value)));
            }
            ["iconst", text] => return whole(text).map(Held::Whole).ok_or_else(|| refused(line)),
            ["load", "notrap", "aligned", address] => return self.load(address, line).map(Held::Number),
            ["icmp", "eq", a, b] => match (self.value(a, line)?, self.value(b, line)?) {
                (Held::Whole(a), Held::Whole(b)) => return Ok(Held::Truth(a == b)),
                _ => return Err(refused(line)),
            },
            ["iadd", a, b] => match (self.value(a, line)?, self.value(b, line)?) {
                (Held::Whole(a), Held::Whole(b)) => return Ok(Held::Whole(a.wrapping_add(b))),
                (Held::Address(array, at), Held::Whole(by)) => {
                    return Ok(Held::Address(array, at.wrapping_add(by)));
                }
                _ => return Err(refused(line)),
            },
            ["imul", a, b] => match (self.value(a, line)?, self.value(b, line)?) {
                (Held::Whole(a), Held::Whole(b)) => return Ok(Held::Whole(a.wrapping_mul(b))),
                _ => return Err(refused(line)),
            },
            ["call", function, ref arguments @ ..] => self.called(function, arguments, line)?,
            ["fneg", a] => Node::Neg(self.number(a, line)?),
            ["sqrt", a] => Node::Call(Function::Sqrt, [self.number(a, line)?; 2]),
            ["fabs", a] => Node::Call(Function::Abs, [self.number(a, line)?; 2]),
            ["fadd", a, b] => Node::Add(self.number(a, line)?, self.number(b, line)?),
            ["fsub", a, b] => Node::Sub(self.number(a, line)?, self.number(b, line)?),
            ["fmul", a, b] => Node::Mul(self.number(a, line)?, self.number(b, line)?),
            ["fdiv", a, b] => Node::Div(self.number(a, line)?, self.number(b, line)?),
            // Rounded once; the module's text leaves open how often.
            ["fma", a, b, c] => {
                let product = Node::Mul(self.number(a, line)?, self.number(b, line)?);
                Node::Add(self.nodes.push(product), self.number(c, line)?)
            }
            _ => return Err(refused(line)),
        };
        Ok(Held::Number(self.nodes.push(node)))
    }

    fn called(&mut self, function: &str, arguments: &[&str], line: &Line<'_>) -> Result<Node, Refusal> {
        let place = self.functions.get(function).copied().unwrap_or(usize::MAX);
        // Curves come after sine with cosine, value and derivatives of one after those of the other.
        if let (Some(place), [at]) = (place.checked_sub(Function::ALL.len() + 1), arguments)
            && place < N_ORDERS * self.arrays.curves
        {
            let time = self.number(at, line)?;
            return Ok(Node::Curve { table: place / N_ORDERS, order: place % N_ORDERS, time });
        }
        match (Function::ALL.get(place), arguments) {
            (Some(function), [.., last]) if arguments.len() == function.arity() => {
                Ok(Node::Call(*function, [self.number(arguments[0], line)?, self.number(last, line)?]))
            }
            _ => Err(refused(line)),
        }
    }

    fn value(&self, name: &str, line: &Line<'_>) -> Result<Held, Refusal> {
        self.held.get(name).copied().ok_or_else(|| refused(line))
    }

    fn number(&self, name: &str, line: &Line<'_>) -> Result<Id, Refusal> {
        match self.value(name, line)? {
            Held::Number(id) => Ok(id),
            _ => Err(refused(line)),
        }
    }

    /// `v6+8`: array and element.
    fn place(&self, address: &str, line: &Line<'_>) -> Result<(Array, usize), Refusal> {
        let (name, offset) = address.split_once('+').unwrap_or((address, "0"));
        let offset = whole(offset).ok_or_else(|| refused(line))?;
        let Held::Address(array, at) = self.value(name, line)? else { return Err(refused(line)) };
        let at = usize::try_from(at + offset).map_err(|_| refused(line))?;
        if at % 8 == 0 { Ok((array, at / 8)) } else { Err(refused(line)) }
    }

    fn load(&mut self, address: &str, line: &Line<'_>) -> Result<Id, Refusal> {
        let (array, place) = self.place(address, line)?;
        if let Some((value, _)) = self.stored.get(&(array, place)) {
            return Ok(*value);
        }
        let arrays = self.arrays;
        let node = match array {
            Array::State => Node::Read((arrays.state)(place)),
            Array::Out => Node::Read((arrays.before.ok_or_else(|| refused(line))?)(place)),
            Array::Given => Node::Read((arrays.given)(place)),
            Array::Own => Node::Read(self.own(place).ok_or_else(|| refused(line))?),
            Array::Tables => {
                let value = *arrays.tables.get(place).ok_or_else(|| refused(line))?;
                return Ok(self.nodes.literal(value));
            }
            Array::Work if place < 3 * arrays.curves => {
                let time = self.nodes.push(Node::Read(Source::Time));
                Node::Curve { table: place / 3, order: place % 3, time }
            }
            _ => return Err(refused(line)),
        };
        Ok(self.nodes.push(node))
    }

    /// Parameters, what depends on them alone, and inputs.
    fn own(&self, place: usize) -> Option<Source> {
        let Arrays { parameters, derived, inputs, .. } = *self.arrays;
        if place < parameters {
            return Some(Source::Parameter(place));
        }
        let place = place - parameters;
        if place < derived {
            return Some(Source::ParameterSetup(place));
        }
        (place - derived < inputs).then_some(Source::Input(place - derived))
    }
}

/// An operation without the type of its numbers.
fn bare(place: usize, word: &str) -> &str {
    let typed = word.strip_suffix(".f64").or_else(|| word.strip_suffix(".i64"));
    typed.filter(|_| place == 0).unwrap_or(word)
}

/// `-8`, `9999`, `0x2710`, `0x0001_2345`: what a whole number looks like.
fn whole(text: &str) -> Option<i64> {
    match text.strip_prefix("0x") {
        Some(digits) => i64::from_str_radix(&digits.replace('_', ""), 16).ok(),
        None => text.parse().ok(),
    }
}

/// `0.0`, `-0x1.8000000000000p3`: what a finite number looks like.
fn float(text: &str) -> Option<f64> {
    let (sign, text) = text.strip_prefix('-').map_or((0, text), |rest| (1 << 63, rest));
    if text == "0.0" {
        return Some(f64::from_bits(sign));
    }
    let (significand, exponent) = text.strip_prefix("0x")?.split_once('p')?;
    let (whole, fraction) = significand.split_once('.')?;
    let bits = u64::from_str_radix(fraction, 16).ok().filter(|_| fraction.len() == 13)?;
    let exponent: i64 = exponent.parse().ok()?;
    let biased = match whole {
        "1" if (-1022..=1023).contains(&exponent) => u64::try_from(exponent + 1023).ok()?,
        "0" if exponent == -1022 => 0,
        _ => return None,
    };
    Some(f64::from_bits(sign | biased << 52 | bits))
}

#[cfg(test)]
mod tests {
    use super::{float, whole};

    #[test]
    fn whole_numbers_are_read_as_they_are_written() {
        let checks = [("-8", -8), ("9999", 9999), ("0x2710", 10_000), ("0x0001_2345", 74_565)];
        for (text, value) in checks {
            assert_eq!(whole(text), Some(value), "{text}");
        }
        assert_eq!(whole("0xfffg"), None);
    }

    #[test]
    fn numbers_are_read_to_the_last_bit() {
        let checks = [
            ("0x1.0000000000000p0", 1.0),
            ("-0x1.8000000000000p1", -3.0),
            ("0x1.999999999999ap-4", 0.1),
            ("0x0.0000000000001p-1022", 5e-324),
            ("0.0", 0.0),
        ];
        for (text, value) in checks {
            assert_eq!(float(text).map(f64::to_bits), Some(f64::to_bits(value)), "{text}");
        }
        assert_eq!(float("-0.0").map(f64::to_bits), Some((-0.0_f64).to_bits()));
        for text in ["+Inf", "+NaN", "1.5", "0x1.8p0", "0x1.0000000000000p9999"] {
            assert_eq!(float(text), None, "{text}");
        }
    }
}
