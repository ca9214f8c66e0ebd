//! Expressions of the C subset.

use super::statements::{Held, Reader};
use crate::program::{Function, Id, Node, Source};
use crate::refusal::Refusal;

impl Reader<'_> {
    /// A sum; all that stands at the end of an assignment.
    pub(super) fn sum(&mut self) -> Result<Id, Refusal> {
        let mut left = self.product()?;
        loop {
            if self.takes("+") {
                let right = self.product()?;
                left = self.nodes.push(Node::Add(left, right));
            } else if self.takes("-") {
                let right = self.product()?;
                left = self.nodes.push(Node::Sub(left, right));
            } else {
                return Ok(left);
            }
        }
    }

    fn product(&mut self) -> Result<Id, Refusal> {
        let mut left = self.signed()?;
        loop {
            if self.takes("*") {
                let right = self.signed()?;
                left = self.nodes.push(Node::Mul(left, right));
            } else if self.takes("/") {
                let right = self.signed()?;
                left = self.nodes.push(Node::Div(left, right));
            } else {
                return Ok(left);
            }
        }
    }

    fn signed(&mut self) -> Result<Id, Refusal> {
        if self.takes("-") {
            let of = self.signed()?;
            return Ok(self.nodes.push(Node::Neg(of)));
        }
        self.single()
    }

    /// A number, a name, an element, a call or a sum in parentheses.
    fn single(&mut self) -> Result<Id, Refusal> {
        if self.takes("(") {
            let inner = self.sum()?;
            self.expect(")")?;
            return Ok(inner);
        }
        let word = self.word()?;
        if word.starts_with(|c: char| c.is_ascii_digit()) {
            let value = word.parse().map_err(|_| self.refused("a number"))?;
            return Ok(self.nodes.literal(value));
        }
        match word.as_str() {
            // What rounds a literal to single precision.
            "K" => {
                self.expect("(")?;
                let inner = self.sum()?;
                self.expect(")")?;
                Ok(inner)
            }
            "m" => self.of_mechanism(),
            _ if self.curve(&word).is_some() => self.called_curve(&word),
            _ => match function(&word) {
                Some(function) => self.called(function),
                None => self.named(&word),
            },
        }
    }

    /// The table of a function that is a curve, `name_curve_0`.
    fn curve(&self, word: &str) -> Option<usize> {
        word.strip_prefix(self.prefix)?.strip_prefix("_curve_")?.parse().ok()
    }

    /// Which derivative, and where.
    fn called_curve(&mut self, word: &str) -> Result<Id, Refusal> {
        let table = self.curve(word).ok_or_else(|| self.refused("a curve"))?;
        self.expect("(")?;
        let order = self.index()?;
        self.expect(",")?;
        let time = self.sum()?;
        self.expect(")")?;
        Ok(self.nodes.push(Node::Curve { table, order, time }))
    }

    fn called(&mut self, function: Function) -> Result<Id, Refusal> {
        self.expect("(")?;
        let mut operands = [self.sum()?; 2];
        for operand in &mut operands[1..function.arity()] {
            self.expect(",")?;
            *operand = self.sum()?;
        }
        self.expect(")")?;
        Ok(self.nodes.push(Node::Call(function, operands)))
    }

    /// `m->parameters[NAME]`.
    fn of_mechanism(&mut self) -> Result<Id, Refusal> {
        self.expect("->")?;
        let field = self.word()?;
        let place = self.indices()?;
        let [place] = place[..] else { return Err(self.refused("a field of the mechanism")) };
        let source = match field.as_str() {
            "parameters" => Source::Parameter(place),
            "inputs" => Source::Input(place),
            "derived" => Source::ParameterSetup(place),
            _ => return Err(self.refused("a field of the mechanism")),
        };
        Ok(self.nodes.push(Node::Read(source)))
    }

    /// A variable or an element of an array.
    fn named(&mut self, name: &str) -> Result<Id, Refusal> {
        let place = self.indices()?;
        match (self.held.get(name).cloned(), &place[..]) {
            (Some(Held::Value(id)), []) => Ok(id),
            (Some(Held::Time), []) => Ok(self.nodes.push(Node::Read(Source::Time))),
            (Some(Held::Array(elements)), place) => {
                elements.get(place).copied().ok_or_else(|| self.refused("an element that was not written"))
            }
            (Some(Held::Curve { table, time }), [order]) => {
                Ok(self.nodes.push(Node::Curve { table, order: *order, time }))
            }
            (Some(Held::Given), place) => {
                // What was stored there before is read again.
                let stored =
                    self.stored.iter().rev().find(|stored| stored.array == name && stored.place == place);
                if let Some(stored) = stored {
                    return Ok(stored.value);
                }
                let source = match (name, place) {
                    ("y", [k]) => Source::State(*k),
                    ("x", [k]) => Source::Joint(*k),
                    ("accelerations" | "rates", [k]) => Source::Acceleration(*k),
                    ("rows", [k]) => Source::Change(*k),
                    ("charts", [chart, k]) => Source::Chart(*chart, *k),
                    _ => return Err(self.refused("an argument")),
                };
                Ok(self.nodes.push(Node::Read(source)))
            }
            _ => Err(self.refused("a name")),
        }
    }

    /// `[3][2 * i + 1]`; nothing if there is none.
    pub(super) fn indices(&mut self) -> Result<Vec<usize>, Refusal> {
        let mut indices = Vec::new();
        while self.takes("[") {
            indices.push(self.index()?);
            self.expect("]")?;
        }
        Ok(indices)
    }

    /// A sum of products of whole numbers, names of places and the round of a loop.
    fn index(&mut self) -> Result<usize, Refusal> {
        let mut sum = 0;
        loop {
            let mut product = 1;
            loop {
                let word = self.word()?;
                product *= match word.parse() {
                    Ok(number) => number,
                    Err(_) if word == "i" => self.round.ok_or_else(|| self.refused("a round of no loop"))?,
                    Err(_) => *self.numbers.get(&word).ok_or_else(|| self.refused("the name of a place"))?,
                };
                if !self.takes("*") {
                    break;
                }
            }
            sum += product;
            if !self.takes("+") {
                return Ok(sum);
            }
        }
    }
}

/// The function that a word names: C's own root, absolute value and whole number, and what a source brings itself, with
/// a last letter for `float`.
fn function(word: &str) -> Option<Function> {
    let brought = ["libm_", "gyro_"].iter().find_map(|prefix| word.strip_prefix(prefix));
    let named = |name: &str| match name {
        "log" => Some(Function::Ln),
        name => Function::named(name),
    };
    let own = |name: &str| match name {
        "sqrt" => Some(Function::Sqrt),
        "fabs" => Some(Function::Abs),
        "floor" => Some(Function::Floor),
        _ => None,
    };
    let of = |name: &str| if brought.is_some() { named(name) } else { own(name) };
    let name = brought.unwrap_or(word);
    of(name).or_else(|| of(name.strip_suffix('f')?))
}
