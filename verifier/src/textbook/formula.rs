//! Formulas of the model file, read anew from their text: the grammar and the meaning of each function are typed here a
//! second time.

mod conditions;
mod constants;

use super::jet::Jet;
use super::scope::Scope;
use crate::field::Field;
use conditions::Condition;
use constants::{UNITS, of_constants};
use gyro_model::{Beyond, Curve, Model, Number, Rational, Seen, column, parse_decimal, pi, root};
use num_traits::{Signed, Zero};

/// What a formula may see of the mechanism.
pub(super) type See<'s, F> = &'s dyn Fn(Seen) -> Option<Jet<F>>;

/// A text that is being read, from the left.
struct Text<'t, 's, F: Field> {
    model: &'t Model,
    scope: &'t Scope<'t, F>,
    see: See<'s, F>,
    rest: &'t str,
}

/// A number, with its exact value where it is a constant.
#[derive(Clone)]
struct Value<F> {
    jet: Jet<F>,
    exact: Option<Rational>,
}

/// What stands between parentheses or commas.
enum Term<F> {
    Number(Value<F>),
    Condition(Condition<F>),
}

/// The value of a formula; `None` where it is not defined.
pub(super) fn value<F: Field>(
    model: &Model,
    scope: &Scope<'_, F>,
    see: See<'_, F>,
    text: &str,
) -> Option<Jet<F>> {
    let mut text = Text { model, scope, see, rest: text.trim_start() };
    let value = text.term()?.number()?;
    text.rest.is_empty().then_some(value.jet)
}

impl<'t, F: Field> Text<'t, '_, F> {
    /// Takes a sign of the grammar and the blanks after it.
    fn take(&mut self, sign: &str) -> bool {
        let Some(rest) = self.rest.strip_prefix(sign) else { return false };
        let is_word = |c: char| c.is_alphanumeric() || c == '_';
        if sign.ends_with(is_word) && rest.starts_with(is_word) {
            return false;
        }
        self.rest = rest.trim_start();
        true
    }

    /// Takes as much as belongs to it.
    fn take_while(&mut self, belongs: impl Fn(char) -> bool) -> &'t str {
        let end = self.rest.find(|c| !belongs(c)).unwrap_or(self.rest.len());
        let (taken, rest) = self.rest.split_at(end);
        self.rest = rest;
        taken
    }

    fn term(&mut self) -> Option<Term<F>> {
        let mut whole = self.conjunction()?;
        while self.take("or") {
            let (a, b) = (whole.condition()?, self.conjunction()?.condition()?);
            whole = Term::Condition(Condition::Or(Box::new(a), Box::new(b)));
        }
        Some(whole)
    }

    fn conjunction(&mut self) -> Option<Term<F>> {
        let mut whole = self.comparison()?;
        while self.take("and") {
            let (a, b) = (whole.condition()?, self.comparison()?.condition()?);
            whole = Term::Condition(Condition::And(Box::new(a), Box::new(b)));
        }
        Some(whole)
    }

    fn comparison(&mut self) -> Option<Term<F>> {
        if self.take("not") {
            let inner = self.within(Self::term)?.condition()?;
            return Some(Term::Condition(Condition::Not(Box::new(inner))));
        }
        let a = match self.sum()? {
            Term::Number(a) => a,
            condition => return Some(condition),
        };
        let not = |condition| Condition::Not(Box::new(condition));
        let condition = if self.take(">=") {
            let b = self.sum()?.number()?;
            not(self.less(&a, &b)?)
        } else if self.take("<=") {
            let b = self.sum()?.number()?;
            not(self.less(&b, &a)?)
        } else if self.take(">") {
            let b = self.sum()?.number()?;
            self.less(&b, &a)?
        } else if self.take("<") {
            let b = self.sum()?.number()?;
            self.less(&a, &b)?
        } else {
            return Some(Term::Number(a));
        };
        Some(Term::Condition(condition))
    }

    fn within<T>(&mut self, inner: impl FnOnce(&mut Self) -> Option<T>) -> Option<T> {
        if !self.take("(") {
            return None;
        }
        let value = inner(self)?;
        self.take(")").then_some(value)
    }

    fn sum(&mut self) -> Option<Term<F>> {
        let mut whole = self.product()?;
        loop {
            let is_sum = self.take("+");
            if !is_sum && !self.take("-") {
                return Some(whole);
            }
            let (a, b) = (whole.number()?, self.product()?.number()?);
            let b = if is_sum { b } else { self.negative(&b) };
            whole = Term::Number(self.of_both(&a, &b, |a, b| a + b, |a, b| Some(a + b))?);
        }
    }

    fn product(&mut self) -> Option<Term<F>> {
        let mut whole = match self.signed()? {
            Term::Number(first) => self.in_unit(first)?,
            condition => return Some(condition),
        };
        loop {
            let product = if self.take("*") {
                let other = self.signed()?.number()?;
                self.times(&whole, &other)?
            } else if self.take("/") {
                let other = self.signed()?.number()?;
                self.over(&whole, &other)?
            } else {
                return Some(Term::Number(whole));
            };
            whole = self.in_unit(product)?;
        }
    }

    fn in_unit(&mut self, value: Value<F>) -> Option<Value<F>> {
        for (name, (a, b), of_half_turns) in UNITS {
            if self.take(name) {
                let size = Rational::new(a.into(), b.into());
                let size = self.constant(if of_half_turns { size * pi() } else { size });
                return self.times(&value, &size);
            }
        }
        Some(value)
    }

    fn signed(&mut self) -> Option<Term<F>> {
        if !self.rest.starts_with(['-', '+']) {
            return self.power();
        }
        let mut is_negative = false;
        while self.rest.starts_with(['-', '+']) {
            is_negative ^= self.rest.starts_with('-');
            self.rest = self.rest[1..].trim_start();
        }
        let value = self.power()?.number()?;
        Some(Term::Number(if is_negative { self.negative(&value) } else { value }))
    }

    fn power(&mut self) -> Option<Term<F>> {
        let base = self.primary()?;
        if !self.take("^") {
            return Some(base);
        }
        let base = base.number()?;
        let is_negative = self.take("-");
        let exponent = self.primary()?.number()?;
        let exponent = if is_negative { self.negative(&exponent) } else { exponent };
        let two = Rational::from_integer(2.into());
        let halves = exponent.exact.as_ref().map(|exact| exact * two).filter(Rational::is_integer);
        let halves = halves.and_then(|halves| i32::try_from(halves.to_integer()).ok());
        let Some(halves) = halves else {
            let logarithm = self.scope.ln(&base.jet)?;
            return Some(Term::Number(moving(self.scope.exp(&(exponent.jet * logarithm)))));
        };
        let (whole, has_root) = (halves.div_euclid(2), halves.rem_euclid(2) == 1);
        let one = self.constant(Rational::from_integer(1.into()));
        let factors =
            (0..whole.unsigned_abs()).try_fold(one.clone(), |power, _| self.times(&power, &base))?;
        let power = if whole < 0 { self.over(&one, &factors)? } else { factors };
        let power = if has_root { self.times(&power, &self.root(&base)?)? } else { power };
        Some(Term::Number(power))
    }

    fn primary(&mut self) -> Option<Term<F>> {
        if self.rest.starts_with('(') { self.within(Self::term) } else { self.leaf().map(Term::Number) }
    }

    fn leaf(&mut self) -> Option<Value<F>> {
        if self.rest.starts_with(|c: char| c.is_ascii_digit() || c == '.') {
            return self.decimal();
        }
        let text = self.rest;
        let word = self.take_while(|c| c.is_alphanumeric() || c == '_');
        if self.rest.starts_with('(') {
            return self.call(word);
        }
        if let Some(rest) = self.rest.strip_prefix('.') {
            self.rest = rest;
            self.take_while(|c| c.is_alphanumeric() || c == '_');
        }
        if let Some(rest) = self.rest.strip_prefix(" rate")
            && !rest.starts_with(|c: char| c.is_alphanumeric() || c == '_')
        {
            self.rest = rest;
        }
        let name = &text[..text.len() - self.rest.len()];
        self.rest = self.rest.trim_start();
        self.named(name)
    }

    fn decimal(&mut self) -> Option<Value<F>> {
        let text = self.rest;
        self.take_while(|c| c.is_ascii_digit() || c == '.' || c == '_');
        if let Some(rest) = self.rest.strip_prefix(['e', 'E']) {
            let digits = rest.strip_prefix(['+', '-']).unwrap_or(rest);
            if digits.starts_with(|c: char| c.is_ascii_digit()) {
                self.rest = digits;
                self.take_while(|c| c.is_ascii_digit());
            }
        }
        let value = parse_decimal(&text[..text.len() - self.rest.len()])?;
        self.rest = self.rest.trim_start();
        Some(self.constant(value))
    }

    /// What the model file calls by a name: of what moves a column, of numbers a parameter or an input.
    fn named(&mut self, name: &str) -> Option<Value<F>> {
        let model = self.model;
        if let Some(seen) = of_own_ends(name)
            && let Some(jet) = (self.see)(seen)
        {
            return Some(moving(jet));
        }
        let visible = model.visible();
        if let Some(place) = column(name, visible.iter().map(|(known, _)| known.as_str())) {
            return Some(moving((self.see)(visible[place].1)?));
        }
        let parameter = model.parameters.iter().position(|parameter| parameter.name == name);
        let input = model.inputs.iter().position(|input| input.name == name);
        let derived = model.derived_parameters.iter().find(|parameter| parameter.name == name);
        if let Some((_, formula)) = model.formulas.iter().find(|(known, _)| known == name) {
            // It is no part of the law that names it, and has no ends.
            let see = |seen| if is_of_own_ends(seen) { None } else { (self.see)(seen) };
            return value(model, self.scope, &see, &formula.text).map(moving);
        }
        match (parameter, input, derived) {
            (Some(index), ..) => self.number(&Number::Parameter { index, negated: false }),
            (_, Some(index), _) => self.number(&Number::Input { index, negated: false }),
            (.., Some(derived)) => self.number(&derived.number),
            _ => match name {
                "t" => Some(moving((self.see)(Seen::Time)?)),
                "pi" => Some(self.constant(pi())),
                _ => None,
            },
        }
    }

    fn number(&self, number: &Number) -> Option<Value<F>> {
        let exact = if let Number::Exact(value) = number { Some(value.clone()) } else { None };
        Some(Value { jet: self.scope.number(number), exact })
    }

    fn call(&mut self, name: &str) -> Option<Value<F>> {
        self.take("(");
        let mut operands = vec![self.term()?];
        while self.take(",") {
            operands.push(self.term()?);
        }
        if !self.take(")") {
            return None;
        }
        if name == "if" {
            let [condition, a, b] = <[Term<F>; 3]>::try_from(operands).ok()?;
            let (condition, a, b) = (condition.condition()?, a.number()?, b.number()?);
            return Some(match condition.takes_first([&a, &b]) {
                Some(true) => a,
                Some(false) => b,
                None => moving(self.choose(&condition, &a.jet, &b.jet)),
            });
        }
        let operands = operands.into_iter().map(Term::number).collect::<Option<Vec<_>>>()?;
        match (name, operands.as_slice()) {
            ("sqrt", [x]) => self.root(x),
            ("hypot", [a, b]) => self.hypot(a, b),
            ("ramp", [z, width]) => {
                let root = self.root(&self.squares(z, width)?)?;
                let half = self.constant(Rational::new(1.into(), 2.into()));
                let double = self.of_both(z, &root, |a, b| a + b, |a, b| Some(a + b))?;
                self.times(&half, &double)
            }
            ("asin" | "acos", [x]) => {
                let one = self.constant(Rational::from_integer(1.into()));
                let square = self.times(x, x)?;
                let other = self.root(&self.of_both(&one, &square, |a, b| a - b, |a, b| Some(a - b))?)?;
                let [opposite, beside] =
                    if name == "asin" { [&x.jet, &other.jet] } else { [&other.jet, &x.jet] };
                self.scope.atan2(opposite, beside).map(moving)
            }
            _ => {
                let exact: Option<Vec<_>> = operands.iter().map(|operand| operand.exact.clone()).collect();
                if let Some(value) = exact.and_then(|exact| of_constants(name, &exact)) {
                    return Some(self.constant(value));
                }
                let operands: Vec<_> = operands.into_iter().map(|operand| operand.jet).collect();
                match (self.model.curve(name), operands.as_slice()) {
                    (Some(curve), [x]) => self.curve(curve, x).map(moving),
                    _ => self.function(name, &operands).map(moving),
                }
            }
        }
    }

    /// A curve; beyond its ends it may have no value, as the root of what is negative there has none.
    fn curve(&self, curve: &Curve, x: &Jet<F>) -> Option<Jet<F>> {
        let value = self.scope.spline(&curve.spline, x);
        if curve.beyond != Beyond::Error {
            return Some(value);
        }
        let [first, last] = curve.ends.map(|end| Rational::from_float(end).map(|end| self.constant(end).jet));
        let within = (x - first?) * (last? - x);
        Some(self.scope.when(&(&self.scope.one + self.scope.sqrt(&within)?), &value))
    }

    fn less(&self, a: &Value<F>, b: &Value<F>) -> Option<Condition<F>> {
        self.of_both(b, a, |b, a| b - a, |b, a| Some(b - a)).map(Condition::Positive)
    }

    fn choose(&self, condition: &Condition<F>, a: &Jet<F>, b: &Jet<F>) -> Jet<F> {
        match condition {
            Condition::Positive(Value { exact: Some(margin), .. }) => {
                if margin.is_positive() {
                    a.clone()
                } else {
                    b.clone()
                }
            }
            Condition::Positive(margin) => {
                self.scope.when(&margin.jet, a) + self.scope.unless(&margin.jet, b)
            }
            Condition::Not(inner) => self.choose(inner, b, a),
            Condition::And(p, q) => self.choose(p, &self.choose(q, a, b), b),
            Condition::Or(p, q) => self.choose(p, a, &self.choose(q, a, b)),
        }
    }

    fn function(&self, name: &str, operands: &[Jet<F>]) -> Option<Jet<F>> {
        let (scope, one) = (self.scope, &self.scope.one);
        let exponentials = |x: &Jet<F>| (scope.exp(x), scope.exp(&-x.clone()));
        let larger = |a: &Jet<F>, b: &Jet<F>| scope.when(&(b - a), b) + scope.unless(&(b - a), a);
        let smaller = |a: &Jet<F>, b: &Jet<F>| scope.when(&(b - a), a) + scope.unless(&(b - a), b);
        Some(match (name, operands) {
            ("sin", [x]) => scope.sin(x),
            ("cos", [x]) => scope.cos(x),
            ("tan", [x]) => scope.sin(x) * scope.cos(x).reciprocal()?,
            ("atan", [x]) => scope.atan2(x, one)?,
            ("atan2", [y, x]) => scope.atan2(y, x)?,
            // tanh · cosh: that tanh is a quotient of exponentials is not known of it here.
            ("sinh", [x]) => {
                let (rising, falling) = exponentials(x);
                scope.tanh(x) * (rising + falling) * &scope.half
            }
            ("cosh", [x]) => {
                let (rising, falling) = exponentials(x);
                (rising + falling) * &scope.half
            }
            ("tanh", [x]) => scope.tanh(x),
            ("exp", [x]) => scope.exp(x),
            ("ln", [x]) => scope.ln(x)?,
            ("log10", [x]) => {
                let ten = parse_decimal("2.302585092994045684017991454684364207601101488")?;
                scope.ln(x)? * self.constant(ten).jet.reciprocal()?
            }
            ("abs", [x]) => scope.abs(x),
            ("sign", [x]) => {
                let opposite = -x.clone();
                scope.when(x, one) - scope.unless(x, &scope.when(&opposite, one))
            }
            ("min", [a, b]) => smaller(a, b),
            ("max", [a, b]) => larger(a, b),
            ("floor", [x]) => scope.floor(x),
            ("mod", [a, b]) => a - b * scope.floor(&(a * b.reciprocal()?)),
            ("step", [x, x0, y0, x1, y1]) => {
                let part = (x - x0) * (x1 - x0).reciprocal()?;
                let capped = scope.when(&(one - &part), &part) + scope.unless(&(one - &part), one);
                let part = scope.when(&part, &capped);
                y0 + (y1 - y0) * (&part * &part) * (one + one + one - &part - &part)
            }
            _ => return None,
        })
    }

    fn squares(&self, a: &Value<F>, b: &Value<F>) -> Option<Value<F>> {
        let squares = [self.times(a, a)?, self.times(b, b)?];
        self.of_both(&squares[0], &squares[1], |a, b| a + b, |a, b| Some(a + b))
    }

    /// √(a² + b²), and zero with zero derivatives where both are zero.
    fn hypot(&self, a: &Value<F>, b: &Value<F>) -> Option<Value<F>> {
        let sum = self.squares(a, b)?;
        if [a, b].iter().any(|x| x.exact.as_ref().is_some_and(|exact| !exact.is_zero())) {
            return self.root(&sum);
        }
        let lift = self.scope.unless(&sum.jet, &self.scope.one);
        Some(moving(self.scope.sqrt(&(&sum.jet + &lift))? - lift))
    }

    /// The square root, of a constant to 42 digits.
    fn root(&self, x: &Value<F>) -> Option<Value<F>> {
        match &x.exact {
            Some(exact) => Some(self.constant(root(exact))),
            None => self.scope.sqrt(&x.jet).map(moving),
        }
    }

    fn constant(&self, value: Rational) -> Value<F> {
        let jet = self.scope.number(&Number::Exact(value.clone()));
        Value { jet, exact: Some(value) }
    }

    fn negative(&self, value: &Value<F>) -> Value<F> {
        match &value.exact {
            Some(exact) => self.constant(-exact),
            None => moving(-value.jet.clone()),
        }
    }

    fn times(&self, a: &Value<F>, b: &Value<F>) -> Option<Value<F>> {
        self.of_both(a, b, |a, b| a * b, |a, b| Some(a * b))
    }

    fn over(&self, a: &Value<F>, b: &Value<F>) -> Option<Value<F>> {
        self.of_both(a, b, |a, b| a / b, |a, b| Some(a * b.reciprocal()?))
    }

    fn of_both(
        &self,
        a: &Value<F>,
        b: &Value<F>,
        exactly: impl FnOnce(&Rational, &Rational) -> Rational,
        of: impl FnOnce(&Jet<F>, &Jet<F>) -> Option<Jet<F>>,
    ) -> Option<Value<F>> {
        match (&a.exact, &b.exact) {
            (Some(a), Some(b)) => Some(self.constant(exactly(a, b))),
            _ => of(&a.jet, &b.jet).map(moving),
        }
    }
}

/// What the laws of links and bushings call what they see of their own ends.
fn of_own_ends(name: &str) -> Option<Seen> {
    let (place, is_rate) = name.strip_suffix(" rate").map_or((name, false), |place| (place, true));
    if place == "length" {
        return Some(if is_rate { Seen::LengthRate } else { Seen::Length });
    }
    let reading =
        ["x", "y", "z", "angle_x", "angle_y", "angle_z"].iter().position(|known| *known == place)?;
    Some(if is_rate { Seen::BetweenRate(reading) } else { Seen::Between(reading) })
}

fn is_of_own_ends(seen: Seen) -> bool {
    matches!(seen, Seen::Length | Seen::LengthRate | Seen::Between(_) | Seen::BetweenRate(_))
}

fn moving<F>(jet: Jet<F>) -> Value<F> {
    Value { jet, exact: None }
}

impl<F> Term<F> {
    fn number(self) -> Option<Value<F>> {
        if let Self::Number(value) = self { Some(value) } else { None }
    }

    fn condition(self) -> Option<Condition<F>> {
        if let Self::Condition(condition) = self { Some(condition) } else { None }
    }
}
