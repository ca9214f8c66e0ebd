//! From an expression to the formula that it denotes: what moves, time, parameters and inputs, and functions of these.

use super::build::Build;
use super::computed::{Fault, MOST_EXPONENT, here as fault, size, syntax};
use super::expression::{self, Kind, Term};
use super::functions;
use super::names;
use super::seen::Known;
use super::units::pi;
use crate::number::in_range;
use crate::{Curve, Formula, Kink, Levels, Model, Number, Operation, Seen, parse_decimal};

/// What names in formulas mean, and which of them a place allows.
pub(super) struct Named<'m> {
    /// Numbers of the mechanism.
    pub(super) columns: &'m Known,
    /// Parameters, and inputs where they may stand.
    pub(super) number: &'m dyn Fn(&str) -> Option<Number>,
    /// The names of all of these, for messages.
    pub(super) numbers: &'m [&'m str],
    /// Whether inputs may stand here.
    pub(super) inputs: Inputs,
    /// Inputs that may not.
    pub(super) refused_inputs: &'m [String],
    /// Formulas that have a name.
    pub(super) formulas: &'m [(String, Formula)],
    /// Curves, in the order of the model.
    pub(super) curves: &'m [Curve],
    /// What may not stand here: message, label and help.
    pub(super) refuse: &'m dyn Fn(&str, Seen) -> Option<[String; 3]>,
}

/// Whether a formula may name inputs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Inputs {
    Known,
    Unknown,
}

/// Nothing is refused.
pub(super) fn any(_: &str, _: Seen) -> Option<[String; 3]> {
    None
}

impl Named<'_> {
    /// The formula that a text denotes; a text that is a column's name denotes that column.
    pub(super) fn formula(&self, text: &str) -> Result<Formula, Fault> {
        if let Some(seen) = self.column(text.trim()) {
            return match (self.refuse)(text.trim(), seen) {
                Some(words) => Err(Fault { span: 0..text.len(), words }),
                None => Ok(Formula::seen(text, seen)),
            };
        }
        let is_known = |name: &str| self.column(name).is_some() || (self.number)(name).is_some();
        let term = expression::parse(text).map_err(|at| syntax(text, at, &is_known))?;
        let mut reading =
            Reading { named: self, text, build: Build::default(), names: Vec::new(), kinks: Vec::new() };
        let last = reading.of(&term)?;
        let Reading { build, names, mut kinks, .. } = reading;
        kinks.sort_by_key(|(start, _)| *start);
        let (operations, places) = build.up_to(last);
        let names = names.into_iter().map(|(name, place)| (name, places[place])).collect();
        let moved = |(_, kink): (usize, Kink)| places[kink.of].map(|of| Kink { of, ..kink });
        let is_number = |kink: &Kink| matches!(operations[kink.of], Operation::Number(_));
        let kinks = kinks.into_iter().filter_map(moved).filter(|kink| !is_number(kink)).collect();
        Ok(Formula { text: text.to_owned(), operations, names, kinks })
    }

    /// The same, which must not be a constant.
    pub(super) fn varying(&self, text: &str) -> Result<Formula, Fault> {
        let formula = self.formula(text)?;
        if formula.sees().next().is_some() { Ok(formula) } else { Err(constant(text)) }
    }

    fn column(&self, name: &str) -> Option<Seen> {
        let place = names::column(name, self.columns.iter().map(|(known, _)| known.as_str()))?;
        Some(self.columns[place].1)
    }
}

/// A text that becomes a formula.
struct Reading<'b, 'm> {
    named: &'b Named<'m>,
    text: &'b str,
    build: Build,
    /// Names, each once, and the places of their values.
    names: Vec<(String, usize)>,
    /// Kinks, each once, and where the text comes to them.
    kinks: Vec<(usize, Kink)>,
}

impl Reading<'_, '_> {
    /// The place of what a term denotes.
    fn of(&mut self, term: &Term) -> Result<usize, Fault> {
        Ok(match &term.kind {
            Kind::Number(text) => match parse_decimal(text).filter(in_range) {
                Some(value) => self.build.exact(value),
                None => {
                    return Err(fault(
                        term,
                        "a number is too large or too small",
                        "write one of moderate size",
                    ));
                }
            },
            Kind::Name(name) => self.name(term, name)?,
            Kind::Call(name, operands) => self.call(term, name, operands)?,
            Kind::Negative(a) => {
                let a = self.of(a)?;
                self.build.negative(a)
            }
            Kind::Sum(a, b) => self.two(a, b, Build::sum)?,
            Kind::Difference(a, b) => self.two(a, b, Build::difference)?,
            Kind::Product(a, b) => self.two(a, b, Build::product)?,
            Kind::Quotient(a, b) => {
                let (a, divisor) = (self.of(a)?, self.of(b)?);
                if self.build.is_zero(divisor) {
                    return Err(fault(b, "a formula divides by zero", "divide by something that is not 0"));
                }
                self.build.quotient(a, divisor)
            }
            Kind::Power(a, exponent) => {
                let base = self.of(a)?;
                self.power(term, base, exponent)?
            }
            Kind::In(a, unit) => {
                let (a, unit) = (self.of(a)?, self.build.exact(size(*unit)));
                self.build.product(a, unit)
            }
            Kind::Greater(..) | Kind::AtLeast(..) | Kind::And(..) | Kind::Or(..) => {
                let help = "write if(condition, a, b), which is a where it holds and b elsewhere";
                return Err(fault(term, "a condition stands in place of a number", help));
            }
        })
    }

    /// A call of a function.
    fn call(&mut self, term: &Term, name: &str, operands: &[Term]) -> Result<usize, Fault> {
        functions::check(term, name, operands.len(), self.named.curves)?;
        match (name, operands) {
            ("if", [condition, a, b]) => {
                let chosen = [self.of(a)?, self.of(b)?];
                self.choice(condition, chosen)
            }
            ("not", _) => {
                let help = "write if(condition, a, b), which is a where it holds and b elsewhere";
                Err(fault(term, "a condition stands in place of a number", help))
            }
            _ => {
                let places =
                    operands.iter().map(|operand| self.of(operand)).collect::<Result<Vec<_>, _>>()?;
                if name == "sqrt" && self.build.is_negative(places[0]) {
                    let help = "write a number of 0 or more";
                    return Err(fault(&operands[0], "a negative number has no square root", help));
                }
                let divisor = match name {
                    "mod" if self.build.is_zero(places[1]) => Some(&operands[1]),
                    "step" if places[1] == places[3] => Some(&operands[3]),
                    _ => None,
                };
                if let Some(divisor) = divisor {
                    let help = match name {
                        "mod" => "write a divisor other than 0",
                        _ => "write another place for the end of the step than for its beginning",
                    };
                    return Err(fault(divisor, "a formula divides by zero", help));
                }
                self.note_kinks(name, operands, &places);
                let mut curves = self.named.curves.iter().enumerate();
                Ok(match curves.find(|(_, curve)| curve.name == name) {
                    Some((index, curve)) => self.build.curve((index, curve), places[0]),
                    None => self.build.function(name, &places),
                })
            }
        }
    }

    fn two(&mut self, a: &Term, b: &Term, of: fn(&mut Build, usize, usize) -> usize) -> Result<usize, Fault> {
        let (a, b) = (self.of(a)?, self.of(b)?);
        Ok(of(&mut self.build, a, b))
    }

    fn name(&mut self, term: &Term, name: &str) -> Result<usize, Fault> {
        let place = self.meant(term, name)?;
        if self.names.iter().all(|(known, _)| known != name) {
            self.names.push((name.to_owned(), place));
        }
        Ok(place)
    }

    /// The place of what a name denotes.
    fn meant(&mut self, term: &Term, name: &str) -> Result<usize, Fault> {
        let named = self.named;
        let formula = named.formulas.iter().find(|(known, _)| known == name);
        match (named.column(name), (named.number)(name), formula) {
            (Some(_), Some(_), _) => Err(fault(
                term,
                &format!("`{name}` names a column of a run's table, and a parameter or an input"),
                "give the parameter, the input or the joint another name",
            )),
            (Some(seen), None, _) => self.seen(term, name, seen),
            (None, Some(number), _) => Ok(self.build.push(Operation::Number(number))),
            (None, None, Some((_, formula))) => self.spliced(term, name, formula),
            (None, None, None) if name == "t" => self.seen(term, name, Seen::Time),
            (None, None, None) if name == "pi" => Ok(self.build.exact(pi())),
            (None, None, None) if named.refused_inputs.iter().any(|input| input == name) => {
                let words = [
                    format!("`{name}` is an input"),
                    "may not stand here".to_owned(),
                    "write a formula without inputs".to_owned(),
                ];
                Err(Fault { span: term.span.clone(), words })
            }
            (None, None, None) => {
                let columns = named.columns.iter().map(|(name, _)| name.as_str());
                let formulas = named.formulas.iter().map(|(name, _)| name.as_str());
                let known: Vec<&str> = columns.chain(formulas).chain(named.numbers.iter().copied()).collect();
                let message = format!("`{name}` names nothing that moves and no parameter");
                Err(fault(term, &message, &names::instead(name, &known)))
            }
        }
    }

    fn seen(&mut self, term: &Term, name: &str, seen: Seen) -> Result<usize, Fault> {
        match (self.named.refuse)(name, seen) {
            Some(words) => Err(Fault { span: term.span.clone(), words }),
            None => Ok(self.build.push(Operation::Seen(seen))),
        }
    }

    /// The operations of another formula.
    fn spliced(&mut self, term: &Term, name: &str, formula: &Formula) -> Result<usize, Fault> {
        let mut places: Vec<usize> = Vec::new();
        for operation in &formula.operations {
            let place = match operation {
                Operation::Seen(seen) => self.seen(term, name, *seen)?,
                Operation::Number(Number::Input { .. }) if self.named.inputs == Inputs::Unknown => {
                    let message = format!("the formula `{name}` depends on an input");
                    return Err(fault(term, &message, "write a formula without inputs here"));
                }
                other => self.build.push(other.moved(|place| places[place])),
            };
            places.push(place);
        }
        for kink in &formula.kinks {
            let within =
                if kink.words.contains(WITHIN) { String::new() } else { format!("{WITHIN}`{name}`") };
            self.note(term, format!("{}{within}", kink.words), places[kink.of], kink.at);
        }
        Ok(places[places.len() - 1])
    }

    /// The first where the condition holds, the second elsewhere; neither is of any matter where it is not taken.
    fn choice(&mut self, condition: &Term, [a, b]: [usize; 2]) -> Result<usize, Fault> {
        Ok(match &condition.kind {
            Kind::Greater(x, y) => {
                let margin = self.two(x, y, Build::difference)?;
                self.note_equal([x, y], margin);
                self.build.where_positive(margin, [a, b])
            }
            Kind::AtLeast(x, y) => {
                let margin = self.two(y, x, Build::difference)?;
                self.note_equal([x, y], margin);
                self.build.where_positive(margin, [b, a])
            }
            Kind::And(p, q) => {
                let inner = self.choice(q, [a, b])?;
                self.choice(p, [inner, b])?
            }
            Kind::Or(p, q) => {
                let inner = self.choice(q, [a, b])?;
                self.choice(p, [a, inner])?
            }
            Kind::Call(name, operands) if name == "not" && operands.len() == 1 => {
                self.choice(&operands[0], [b, a])?
            }
            _ => {
                let help = "compare two numbers: a > b, a >= b, a < b or a <= b, with and, or, not(...)";
                return Err(fault(condition, "a number stands in place of a condition", help));
            }
        })
    }

    /// A power: whole exponents by products, halves by a root, all others by logarithm and exponential function.
    fn power(&mut self, term: &Term, base: usize, exponent: &Term) -> Result<usize, Fault> {
        let by = self.of(exponent)?;
        let Some(Number::Exact(value)) = self.build.number(by) else {
            return Ok(self.build.general_power(base, by));
        };
        let double = &value + &value;
        let Some(halves) = double.is_integer().then(|| i32::try_from(double.to_integer()).ok()).flatten()
        else {
            return Ok(self.build.general_power(base, by));
        };
        let (whole, has_root) = (halves.div_euclid(2), halves.rem_euclid(2) == 1);
        if whole.abs() > MOST_EXPONENT {
            let help = format!("write one from -{MOST_EXPONENT} to {MOST_EXPONENT}");
            return Err(fault(term, "the exponent of a power is too large", &help));
        }
        let power = self.build.whole_power(base, whole);
        if !has_root {
            return Ok(power);
        }
        if self.build.is_negative(base) {
            return Err(fault(term, "a negative number has no square root", "write a whole exponent"));
        }
        let root = self.build.root(base);
        Ok(self.build.product(power, root))
    }
}

/// What stands between the place of a kink and the name of the formula whose it is.
const WITHIN: &str = " in formula ";

/// Where formulas are not smooth.
impl Reading<'_, '_> {
    /// A kink, once.
    fn note(&mut self, term: &Term, words: String, of: usize, at: Levels) {
        if self.kinks.iter().all(|(_, kink)| (kink.of, kink.at) != (of, at)) {
            self.kinks.push((term.span.start, Kink { words, of, at }));
        }
    }

    /// A kink where two terms are equal, in the order of the text.
    fn note_equal(&mut self, [x, y]: [&Term; 2], margin: usize) {
        let [first, second] = if x.span.start < y.span.start { [x, y] } else { [y, x] };
        let words = format!("{} = {}", self.written(first), self.written(second));
        self.note(first, words, margin, Levels::Zero);
    }

    /// The kinks of a function of operands at these places.
    fn note_kinks(&mut self, name: &str, operands: &[Term], places: &[usize]) {
        let (operand, first) = (&operands[0], self.written(&operands[0]));
        match (name, operands, places) {
            ("abs" | "sign", _, &[x]) => self.note(operand, format!("{first} = 0"), x, Levels::Zero),
            ("floor", _, &[x]) => self.note(operand, format!("{first} is whole"), x, Levels::Whole),
            ("min" | "max", [a, b], &[x, y]) => {
                let margin = self.build.difference(y, x);
                self.note_equal([a, b], margin);
            }
            ("mod", [_, divisor], &[x, y]) => {
                let quotient = self.build.quotient(x, y);
                let words = format!("{first} is a multiple of {}", self.written(divisor));
                self.note(operand, words, quotient, Levels::Whole);
            }
            (_, _, &[x]) => {
                let curve = self.named.curves.iter().position(|curve| curve.name == name);
                let Some(curve) = curve.filter(|curve| !self.named.curves[*curve].corners().is_empty())
                else {
                    return;
                };
                self.note(operand, format!("{first} is at a corner of `{name}`"), x, Levels::Curve(curve));
            }
            _ => {}
        }
    }

    fn written(&self, term: &Term) -> String {
        let words: Vec<&str> = self.text[term.span.clone()].split_whitespace().collect();
        words.join(" ")
    }
}

fn constant(text: &str) -> Fault {
    let words = [
        format!("{text:?} names nothing that moves"),
        "is a constant".to_owned(),
        "name a column of a run's table: a joint coordinate, a rate (\"joint rate\"), or a number of an output".to_owned(),
    ];
    Fault { span: 0..text.len(), words }
}

/// The formula of a text, of a model that has been read.
pub(crate) fn formula_of(model: &Model, text: &str) -> Result<Formula, String> {
    let number = |name: &str| {
        let index = model.parameters.iter().position(|parameter| parameter.name == name);
        let derived = || {
            let mut derived = model.derived_parameters.iter();
            derived.find(|parameter| parameter.name == name).map(|parameter| parameter.number.clone())
        };
        index.map(|index| Number::Parameter { index, negated: false }).or_else(derived)
    };
    let numbers: Vec<&str> = model.parameters.iter().map(|parameter| parameter.name.as_str()).collect();
    let columns = &model.visible();
    let formulas = &model.formulas;
    let inputs: Vec<String> = model.inputs.iter().map(|input| input.name.clone()).collect();
    let named = Named {
        columns,
        number: &number,
        numbers: &numbers,
        inputs: Inputs::Unknown,
        refused_inputs: &inputs,
        formulas,
        curves: &model.curves,
        refuse: &any,
    };
    named.varying(text).map_err(|Fault { words: [message, _, help], .. }| format!("{message}; {help}"))
}

impl Model {
    /// The formula that a text denotes, in the grammar of the model file's expressions: names are those of parameters
    /// and of columns of a run's table.
    ///
    /// # Errors
    /// Says what is wrong with it and what to write.
    pub fn formula(&self, text: &str) -> Result<Formula, String> {
        formula_of(self, text)
    }
}
