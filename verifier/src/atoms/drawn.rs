//! Atoms drawn at random, one for each argument.

use super::Atoms;
use super::elementary::{CURVES, Symmetry, symmetry};
use crate::field::{Field, Modular, Prime};
use crate::program::Function;
use chacha20::ChaCha8Rng;
use gyro_model::{Rational, Spline};
use num_traits::Signed;
use std::cell::{Cell, RefCell};
use std::collections::HashMap;
use std::hash::Hash;

/// Atoms over integers modulo a prime. What the functions are known to satisfy, the values do: `sin² + cos² = 1`, the
/// double angle, sine, tanh and atan2 (in its first argument) are odd and cosine even, `√x² = x` and `√x √y = √(x y)`.
/// Also `atan2(0, x) = 0`, which holds if x is positive: that it is must be seen elsewhere. `exp(0) = 1` and
/// `exp(x) exp(−x) = 1`; absolute values are even. A condition is a number that is drawn for it and that `when`
/// multiplies by, and `unless` by what it lacks of one: an identity that holds for all numbers holds for zero and one.
/// Of small fractions absolute values, whole numbers and conditions are what they are.
#[derive(Debug)]
pub struct Drawn<'p, const L: usize> {
    prime: &'p Prime<L>,
    random: RefCell<ChaCha8Rng>,
    /// Cosine and sine of each argument that was met, and of its halves.
    circle: Table<[u64; L], (Modular<'p, L>, Modular<'p, L>)>,
    /// Of other functions the value at one operand or two.
    others: Table<Call<L>, Modular<'p, L>>,
    splines: Table<(Vec<u64>, [u64; L]), [Modular<'p, L>; 4]>,
    /// What stands for roots that do not exist.
    roots: Table<[u64; L], Modular<'p, L>>,
    missed: Cell<bool>,
}

/// How often an argument is halved when it is new, until one is met that is known: what is met later may be a half, a
/// quarter of it. A point of the circle is drawn for the last one, and doubled.
pub(crate) const HALVINGS: u32 = 8;

/// A function with the keys of its operands.
type Call<const L: usize> = (Function, [u64; L], Option<[u64; L]>);

type Table<K, V> = RefCell<HashMap<K, V>>;

impl<'p, const L: usize> Drawn<'p, L> {
    /// Nothing drawn yet.
    pub fn new(prime: &'p Prime<L>, random: ChaCha8Rng) -> Self {
        Self {
            prime,
            random: RefCell::new(random),
            circle: RefCell::default(),
            others: RefCell::default(),
            splines: RefCell::default(),
            roots: RefCell::default(),
            missed: Cell::new(false),
        }
    }

    /// Whether a root was asked for that does not exist.
    pub fn missed_root(&self) -> bool {
        self.missed.get()
    }

    fn draw(&self) -> Modular<'p, L> {
        self.prime.draw(&mut *self.random.borrow_mut())
    }

    /// The value at a key, drawn if the key is new; undefined without a key.
    fn value<K: Hash + Eq>(&self, table: &Table<K, Modular<'p, L>>, key: Option<K>) -> Modular<'p, L> {
        let Some(key) = key else { return Modular::undefined(self.prime) };
        *table.borrow_mut().entry(key).or_insert_with(|| self.draw())
    }

    /// Cosine and sine.
    fn point(&self, x: &Modular<'p, L>) -> (Modular<'p, L>, Modular<'p, L>) {
        let undefined = Modular::undefined(self.prime);
        let Some(key) = x.key() else { return (undefined, undefined) };
        if x.is_zero() {
            return (Modular::one(self.prime), *x);
        }
        if let Some(&known) = self.circle.borrow().get(&key) {
            return known;
        }
        let one_half = Modular::integer(self.prime, 2).inv().unwrap_or(undefined);
        let (mut angle, mut known, mut doublings) = (*x, None, 0);
        while known.is_none() && doublings < HALVINGS {
            angle = angle.mul(&one_half);
            known = angle.key().and_then(|key| self.circle.borrow().get(&key).copied());
            doublings += 1;
        }
        let Some(mut point) = known.or_else(|| self.circle_point()) else { return (undefined, undefined) };
        self.learn(&angle, point);
        for _ in 0..doublings {
            (angle, point) = (angle.add(&angle), twice(point));
            self.learn(&angle, point);
        }
        point
    }

    /// A function of which no more is known than what the sign of its first operand does.
    fn other(&self, function: Function, [x, y]: [&Modular<'p, L>; 2]) -> Modular<'p, L> {
        let symmetry = symmetry(function);
        if symmetry == Symmetry::Odd && x.is_zero() {
            return *x;
        }
        let (key, is_negated) = match symmetry {
            Symmetry::Neither => (x.key(), false),
            _ => unsigned(x).map_or((None, false), |(key, negated)| (Some(key), negated)),
        };
        let second = if function.arity() == 2 { y.key().map(Some) } else { Some(None) };
        let value = self.value(&self.others, key.zip(second).map(|(x, y)| (function, x, y)));
        if is_negated && symmetry == Symmetry::Odd { value.neg() } else { value }
    }

    /// One for each argument and its negative, of which one is the reciprocal of the other.
    fn exponential(&self, x: &Modular<'p, L>) -> Modular<'p, L> {
        let undefined = Modular::undefined(self.prime);
        if x.is_zero() {
            return Modular::one(self.prime);
        }
        let Some((key, is_negated)) = unsigned(x) else { return undefined };
        let value = self.value(&self.others, Some((Function::Exp, key, None)));
        if is_negated { value.inv().unwrap_or(undefined) } else { value }
    }

    /// What is known of a small fraction, and otherwise no more than what a sign does.
    fn known_or_other(&self, function: Function, x: &Modular<'p, L>) -> Modular<'p, L> {
        let exact = |x: Rational| if function == Function::Abs { x.abs() } else { x.floor() };
        match x.small_fraction() {
            Some(x) => Modular::from_rational(self.prime, &exact(x)),
            None => self.other(function, [x, x]),
        }
    }

    /// What stands for the truth of `x > 0`.
    fn condition(&self, x: &Modular<'p, L>) -> Modular<'p, L> {
        match x.small_fraction() {
            Some(x) => Modular::integer(self.prime, x.is_positive().into()),
            None => self.value(&self.others, x.key().map(|key| (Function::When, key, None))),
        }
    }

    /// Where there is no root, any number in its place.
    fn root(&self, x: &Modular<'p, L>) -> Modular<'p, L> {
        x.sqrt().unwrap_or_else(|| {
            self.missed.set(true);
            self.value(&self.roots, x.key())
        })
    }

    fn learn(&self, angle: &Modular<'p, L>, (cosine, sine): (Modular<'p, L>, Modular<'p, L>)) {
        let mut circle = self.circle.borrow_mut();
        for (key, sine) in [(angle.key(), sine), (angle.neg().key(), sine.neg())] {
            circle.extend(key.map(|key| (key, (cosine, sine))));
        }
    }

    /// `((1 − u²) / (1 + u²), 2 u / (1 + u²))`; `None` does not happen, as −1 is not a square.
    fn circle_point(&self) -> Option<(Modular<'p, L>, Modular<'p, L>)> {
        let (u, one) = (self.draw(), Modular::one(self.prime));
        let square = u.mul(&u);
        let scale = one.add(&square).inv()?;
        Some((one.sub(&square).mul(&scale), u.add(&u).mul(&scale)))
    }
}

/// The point at twice the angle.
fn twice<F: Field>((cosine, sine): (F, F)) -> (F, F) {
    let product = cosine.mul(&sine);
    (cosine.mul(&cosine).sub(&sine.mul(&sine)), product.add(&product))
}

/// A key for a number and its negative, and whether the number is the negative of the one that the key stands for.
fn unsigned<const L: usize>(x: &Modular<'_, L>) -> Option<([u64; L], bool)> {
    let (key, negated) = x.key().zip(x.neg().key())?;
    Some(if negated < key { (negated, true) } else { (key, false) })
}

impl<'p, const L: usize> Atoms<Modular<'p, L>> for Drawn<'p, L> {
    fn call(&self, function: Function, [x, y]: [&Modular<'p, L>; 2]) -> Modular<'p, L> {
        match function {
            Function::Sin => self.point(x).1,
            Function::Cos => self.point(x).0,
            Function::Sqrt => self.root(x),
            Function::Exp => self.exponential(x),
            Function::Abs | Function::Floor => self.known_or_other(function, x),
            Function::When => self.condition(x).mul(y),
            Function::Unless => Modular::one(self.prime).sub(&self.condition(x)).mul(y),
            Function::Curve { .. } => unreachable!("{CURVES}"),
            Function::Tanh | Function::Atan2 | Function::Ln => self.other(function, [x, y]),
        }
    }

    fn spline(&self, table: &Spline, t: &Modular<'p, L>) -> [Modular<'p, L>; 4] {
        let Some(t) = t.key() else { return [Modular::undefined(self.prime); 4] };
        let bits = table.knots.iter().chain(table.pieces.iter().flatten()).map(|x| x.to_bits()).collect();
        *self.splines.borrow_mut().entry((bits, t)).or_insert_with(|| [(); 4].map(|()| self.draw()))
    }
}

#[cfg(test)]
mod tests;
