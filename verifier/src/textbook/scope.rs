//! Numbers of the model file and functions over jets.

use super::jet::Jet;
use super::linear::Vector;
use crate::atoms::Atoms;
use crate::field::Field;
use crate::point::Point;
use gyro_model::{Number, Rational, Spline};
use std::ops::{Add, Mul, Sub};

/// Where the textbook is evaluated, and with which functions.
#[derive(Clone)]
pub struct Scope<'a, F: Field> {
    pub point: &'a Point<F>,
    pub atoms: &'a dyn Atoms<F>,
    pub zero: Jet<F>,
    pub one: Jet<F>,
    pub half: Jet<F>,
}

impl<'a, F: Field> Scope<'a, F> {
    pub fn new(point: &'a Point<F>, atoms: &'a dyn Atoms<F>) -> Self {
        let number = |value: Rational| Jet::constant(F::from_rational(point.context, &value));
        Self {
            point,
            atoms,
            zero: number(Rational::from_integer(0.into())),
            one: number(Rational::from_integer(1.into())),
            half: number(Rational::new(1.into(), 2.into())),
        }
    }

    /// A number of the model file.
    pub fn number(&self, number: &Number) -> Jet<F> {
        Jet::constant(self.point.number(number))
    }

    pub fn numbers<const N: usize>(&self, numbers: &[Number; N]) -> [Jet<F>; N] {
        numbers.each_ref().map(|number| self.number(number))
    }

    pub fn vector(&self, numbers: &[Number; 3]) -> Vector<F> {
        Vector(self.numbers(numbers))
    }

    pub fn no_vector(&self) -> Vector<F> {
        Vector([&self.zero; 3].map(Jet::clone))
    }

    pub fn sin(&self, x: &Jet<F>) -> Jet<F> {
        let (sin, cos) = (self.atoms.sin(&x.value), self.atoms.cos(&x.value));
        x.chain([sin.clone(), cos, sin.neg()])
    }

    pub fn cos(&self, x: &Jet<F>) -> Jet<F> {
        let (sin, cos) = (self.atoms.sin(&x.value), self.atoms.cos(&x.value));
        x.chain([cos.clone(), sin.neg(), cos.neg()])
    }

    pub fn tanh(&self, x: &Jet<F>) -> Jet<F> {
        let tanh = self.atoms.tanh(&x.value);
        let slope = self.one.value.sub(&tanh.mul(&tanh));
        let bend = tanh.add(&tanh).mul(&slope).neg();
        x.chain([tanh, slope, bend])
    }

    /// `√x` with `(√x)' = 1 / (2 √x)` and `(√x)'' = −2 ((√x)')³`; `None` at zero.
    pub fn sqrt(&self, x: &Jet<F>) -> Option<Jet<F>> {
        let root = self.atoms.sqrt(&x.value);
        let slope = root.add(&root).inv()?;
        let cube = slope.mul(&slope).mul(&slope);
        Some(x.chain([root, slope, cube.add(&cube).neg()]))
    }

    /// The angle θ of the point (x, y), with `θ' = (x y' − y x') / (x² + y²)` and its derivative by the quotient rule.
    pub fn atan2(&self, y: &Jet<F>, x: &Jet<F>) -> Option<Jet<F>> {
        let zero = &self.zero.value;
        // Correct up to their first derivative, which is all that is used.
        let (dx, dy) = (x.derivative(zero), y.derivative(zero));
        let rate = (x * dy - y * dx) * (x * x + y * y).reciprocal()?;
        Some(Jet { value: self.atoms.atan2(&y.value, &x.value), rate: Some(rate.value), second: rate.rate })
    }

    pub fn spline(&self, table: &Spline, t: &Jet<F>) -> Jet<F> {
        let [value, slope, bend, _] = self.atoms.spline(table, &t.value);
        t.chain([value, slope, bend])
    }

    /// The numbers divided by the root of the sum of their squares; `None` if they are all zero.
    pub fn unit<const N: usize>(&self, numbers: &[Number; N]) -> Option<[Jet<F>; N]> {
        let exact = exact(numbers).map(|values| values.iter().map(|x| x * x).sum());
        self.divided_by_length(self.numbers(numbers), exact)
    }

    /// The unit vector along the part of z across h: `(h·h) z − (h·z) h` divided by its length.
    pub fn unit_across(&self, h: &[Number; 3], z: &[Number; 3]) -> Option<Vector<F>> {
        let rational = exact(h).zip(exact(z)).map(|(h, z)| across(&h, &z));
        let exact = rational.map(|values| values.iter().map(|x| x * x).sum());
        self.divided_by_length(across(&self.numbers(h), &self.numbers(z)), exact).map(Vector)
    }

    /// Where the square of the length is a rational, its root is the one that constants have.
    fn divided_by_length<const N: usize>(
        &self,
        vector: [Jet<F>; N],
        square: Option<Rational>,
    ) -> Option<[Jet<F>; N]> {
        let length = match square {
            Some(square) => Jet::constant(F::sqrt_rational(self.point.context, &square)),
            None => self.sqrt(&vector.iter().fold(self.zero.clone(), |sum, x| sum + x * x))?,
        };
        let inverse = length.reciprocal()?;
        Some(vector.map(|x| x * &inverse))
    }
}

impl<F: Field> Scope<'_, F> {
    /// `eˣ`, which is its own derivative.
    pub fn exp(&self, x: &Jet<F>) -> Jet<F> {
        let exp = self.atoms.exp(&x.value);
        x.chain([exp.clone(), exp.clone(), exp])
    }

    /// The logarithm with `(ln x)' = 1 / x` and `(ln x)'' = −1 / x²`; `None` at zero.
    pub fn ln(&self, x: &Jet<F>) -> Option<Jet<F>> {
        let slope = x.value.inv()?;
        let bend = slope.mul(&slope).neg();
        Some(x.chain([self.atoms.ln(&x.value), slope, bend]))
    }

    /// `|x|` with `|x|' = x'` where x is positive and `−x'` where it is negative.
    pub fn abs(&self, x: &Jet<F>) -> Jet<F> {
        let (opposite, one) = (x.value.neg(), &self.one.value);
        let slope = self.atoms.when(&x.value, one).sub(&self.atoms.when(&opposite, one));
        x.chain([self.atoms.abs(&x.value), slope, self.zero.value.clone()])
    }

    /// `⌊x⌋`, which does not change but where it jumps.
    pub fn floor(&self, x: &Jet<F>) -> Jet<F> {
        Jet::constant(self.atoms.floor(&x.value))
    }

    /// x and its derivatives where the condition is greater than zero, zero where it is not.
    pub fn when(&self, condition: &Jet<F>, x: &Jet<F>) -> Jet<F> {
        x.each(|x| self.atoms.when(&condition.value, x))
    }

    /// x and its derivatives where the condition is at most zero, zero where it is greater.
    pub fn unless(&self, condition: &Jet<F>, x: &Jet<F>) -> Jet<F> {
        x.each(|x| self.atoms.unless(&condition.value, x))
    }
}

/// The rationals, if all numbers are.
fn exact<const N: usize>(numbers: &[Number; N]) -> Option<[Rational; N]> {
    let rational = |number: &Number| match number {
        Number::Exact(value) => Some(value.clone()),
        Number::Parameter { .. } | Number::Input { .. } | Number::Computed(_) | Number::Formula(_) => None,
    };
    numbers.iter().map(rational).collect::<Option<Vec<_>>>()?.try_into().ok()
}

fn across<T: Clone + Add<Output = T> + Sub<Output = T> + Mul<Output = T>>(h: &[T; 3], z: &[T; 3]) -> [T; 3] {
    let dot = |[a, b, c]: [T; 3], [x, y, z]: [T; 3]| a * x + b * y + c * z;
    let (square, along) = (dot(h.clone(), h.clone()), dot(h.clone(), z.clone()));
    std::array::from_fn(|k| square.clone() * z[k].clone() - along.clone() * h[k].clone())
}
