//! Vectors and matrices of space over jets.

use super::jet::Jet;
use crate::field::Field;
use std::array::from_fn;
use std::borrow::Borrow;
use std::ops::{Add, Neg, Sub};

/// Three components.
#[derive(Clone, Debug, PartialEq)]
pub struct Vector<F>(pub [Jet<F>; 3]);

/// A matrix by rows.
#[derive(Clone, Debug, PartialEq)]
pub struct Matrix<F>(pub [[Jet<F>; 3]; 3]);

impl<F: Field> Vector<F> {
    /// The sum of the products of the components.
    pub fn dot(&self, other: &Self) -> Jet<F> {
        let [[a, b, c], [x, y, z]] = [&self.0, &other.0];
        a * x + b * y + c * z
    }

    /// The vector product.
    pub fn cross(&self, other: &Self) -> Self {
        let [[a, b, c], [x, y, z]] = [&self.0, &other.0];
        Self([b * z - c * y, c * x - a * z, a * y - b * x])
    }

    /// The product with a number.
    pub fn times(&self, factor: &Jet<F>) -> Self {
        Self(self.0.each_ref().map(|x| x * factor))
    }
}

impl<F: Field> Matrix<F> {
    /// The product with a vector.
    pub fn apply(&self, vector: &Vector<F>) -> Vector<F> {
        let [x, y, z] = &vector.0;
        Vector(self.0.each_ref().map(|[a, b, c]| a * x + b * y + c * z))
    }

    /// The transpose.
    pub fn transposed(&self) -> Self {
        Self(from_fn(|row| from_fn(|column| self.0[column][row].clone())))
    }

    /// The product of two matrices.
    pub fn product(&self, other: &Self) -> Self {
        let columns = other.transposed().0.map(|column| self.apply(&Vector(column)));
        Self(columns.map(|column| column.0)).transposed()
    }

    /// The vector a of a skew-symmetric matrix ã.
    pub fn axial(&self) -> Vector<F> {
        let [[_, _, y], [z, ..], [_, x, _]] = &self.0;
        Vector([x.clone(), y.clone(), z.clone()])
    }
}

impl<F: Field, R: Borrow<Vector<F>>> Add<R> for Vector<F> {
    type Output = Self;
    fn add(self, other: R) -> Self {
        Self(from_fn(|k| &self.0[k] + &other.borrow().0[k]))
    }
}

impl<F: Field, R: Borrow<Vector<F>>> Sub<R> for Vector<F> {
    type Output = Self;
    fn sub(self, other: R) -> Self {
        Self(from_fn(|k| &self.0[k] - &other.borrow().0[k]))
    }
}

impl<F: Field> Neg for Vector<F> {
    type Output = Self;
    fn neg(self) -> Self {
        Self(self.0.map(|x| -x))
    }
}
