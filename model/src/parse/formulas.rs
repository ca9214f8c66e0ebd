//! Formulas of columns of a run's table and of parameters.

use super::computed::{Fault, size, syntax};
use super::expression::{self, Kind, Term};
use super::names;
use super::seen::Known;
use super::units::pi;
use crate::number::in_range;
use crate::{Formula, Model, Number, parse_decimal};

/// Largest exponent of a power.
const MOST_EXPONENT: i32 = 100;

/// What names in formulas mean.
pub(super) struct Named<'m> {
    pub(super) columns: &'m Known,
    pub(super) parameter: &'m dyn Fn(&str) -> Option<Number>,
    /// All parameters, for messages.
    pub(super) parameters: &'m [&'m str],
}

impl Named<'_> {
    /// The formula that a text denotes; a text that is a column's name denotes that column.
    pub(super) fn formula(&self, text: &str) -> Result<Formula, Fault> {
        if let Some(seen) = self.column(text.trim()) {
            return Ok(seen);
        }
        let is_known = |name: &str| self.column(name).is_some() || (self.parameter)(name).is_some();
        let term = expression::parse_formula(text).map_err(|at| syntax(text, at, &is_known))?;
        let formula = self.of(&term)?;
        if has_columns(&formula) { Ok(formula) } else { Err(constant(text)) }
    }

    fn column(&self, name: &str) -> Option<Formula> {
        let place = names::column(name, self.columns.iter().map(|(known, _)| known.as_str()))?;
        Some(Formula::Seen(self.columns[place].1))
    }

    fn of(&self, term: &Term) -> Result<Formula, Fault> {
        let one = |a: &Term| self.of(a).map(Box::new);
        let two = |a: &Term, b: &Term| Ok::<_, Fault>(Box::new([self.of(a)?, self.of(b)?]));
        Ok(match &term.kind {
            Kind::Number(text) => match parse_decimal(text).filter(in_range) {
                Some(value) => Formula::Number(Number::Exact(value)),
                None => {
                    return Err(fault(
                        term,
                        "a number is too large or too small",
                        "write one of moderate size",
                    ));
                }
            },
            Kind::Name(name) => self.name(term, name)?,
            Kind::Root(a) => Formula::Root(one(a)?),
            Kind::Negative(a) => Formula::Negative(one(a)?),
            Kind::Sum(a, b) => Formula::Sum(two(a, b)?),
            Kind::Difference(a, b) => Formula::Difference(two(a, b)?),
            Kind::Product(a, b) => Formula::Product(two(a, b)?),
            Kind::Quotient(a, b) => Formula::Quotient(two(a, b)?),
            Kind::Power(a, exponent) => {
                let exponent = exponent.parse().ok().filter(|n: &i32| n.abs() <= MOST_EXPONENT);
                let help = format!("write a whole number from -{MOST_EXPONENT} to {MOST_EXPONENT}");
                let exponent =
                    exponent.ok_or_else(|| fault(term, "the exponent of a power is too large", &help))?;
                Formula::Power(one(a)?, exponent)
            }
            Kind::In(a, unit) => {
                let unit = Formula::Number(Number::Exact(size(*unit)));
                Formula::Product(Box::new([self.of(a)?, unit]))
            }
        })
    }

    fn name(&self, term: &Term, name: &str) -> Result<Formula, Fault> {
        match (self.column(name), (self.parameter)(name)) {
            (Some(_), Some(_)) => Err(fault(
                term,
                &format!("`{name}` names a column of a run's table, and a parameter"),
                "give the parameter or the joint another name",
            )),
            (Some(column), None) => Ok(column),
            (None, Some(number)) => Ok(Formula::Number(number)),
            (None, None) if name == "pi" => Ok(Formula::Number(Number::Exact(pi()))),
            (None, None) => {
                let columns = self.columns.iter().map(|(name, _)| name.as_str());
                let known: Vec<&str> = columns.chain(self.parameters.iter().copied()).collect();
                let message = format!("`{name}` names no column of a run's table and no parameter");
                Err(fault(term, &message, &names::instead(name, &known)))
            }
        }
    }
}

fn has_columns(formula: &Formula) -> bool {
    match formula {
        Formula::Number(_) => false,
        Formula::Seen(_) => true,
        Formula::Negative(a) | Formula::Root(a) | Formula::Power(a, _) => has_columns(a),
        Formula::Sum(parts)
        | Formula::Difference(parts)
        | Formula::Product(parts)
        | Formula::Quotient(parts) => parts.iter().any(has_columns),
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

fn fault(term: &Term, message: &str, help: &str) -> Fault {
    let words = [message, "here", help].map(str::to_owned);
    Fault { span: term.span.clone(), words }
}

/// The formula of a text, of a model that has been read.
pub(crate) fn formula_of(model: &Model, text: &str) -> Result<Formula, String> {
    let parameter = |name: &str| {
        let index = model.parameters.iter().position(|parameter| parameter.name == name);
        let derived = || {
            let mut derived = model.derived_parameters.iter();
            derived.find(|parameter| parameter.name == name).map(|parameter| parameter.number.clone())
        };
        index.map(|index| Number::Parameter { index, negated: false }).or_else(derived)
    };
    let parameters: Vec<&str> = model.parameters.iter().map(|parameter| parameter.name.as_str()).collect();
    let named = Named { columns: &model.visible(), parameter: &parameter, parameters: &parameters };
    named.formula(text).map_err(|Fault { words: [message, _, help], .. }| format!("{message}; {help}"))
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
