//! Pairs of a linear and an angular vector of a body, and the inertias between them; all in the global frame.

use crate::number::Number;
use nalgebra::{Matrix3, Vector3};
use std::ops::{AddAssign, SubAssign};

/// An acceleration `(s̈, ω̇)` or a force `(f, n)`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spatial<T> {
    pub(crate) linear: Vector3<T>,
    pub(crate) angular: Vector3<T>,
}

/// A symmetric inertia `[linear coupling; couplingᵀ angular]`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Inertia<T> {
    pub(crate) linear: Matrix3<T>,
    pub(crate) coupling: Matrix3<T>,
    pub(crate) angular: Matrix3<T>,
}

impl<T: Number> Spatial<T> {
    pub(crate) fn zero() -> Self {
        Self { linear: Vector3::zeros(), angular: Vector3::zeros() }
    }

    /// The force, taken about a point at `d` from the present one.
    pub(crate) fn about(&self, d: &Vector3<T>) -> Self {
        Self { linear: self.linear, angular: self.angular - d.cross(&self.linear) }
    }
}

impl<T: Number> AddAssign for Spatial<T> {
    fn add_assign(&mut self, other: Self) {
        self.linear += other.linear;
        self.angular += other.angular;
    }
}

impl<T: Number> SubAssign for Spatial<T> {
    fn sub_assign(&mut self, other: Self) {
        self.linear -= other.linear;
        self.angular -= other.angular;
    }
}

impl<T: Number> Inertia<T> {
    pub(crate) fn zero() -> Self {
        Self { linear: Matrix3::zeros(), coupling: Matrix3::zeros(), angular: Matrix3::zeros() }
    }

    /// The force that an acceleration takes.
    pub(crate) fn apply(&self, acceleration: &Spatial<T>) -> Spatial<T> {
        Spatial {
            linear: self.linear * acceleration.linear + self.coupling * acceleration.angular,
            angular: self.coupling.tr_mul(&acceleration.linear) + self.angular * acceleration.angular,
        }
    }

    /// The inertia, taken about a point at `d` from the present one: `TᵀMT` with `T = [I d̃; 0 I]`.
    pub(crate) fn about(&self, d: &Vector3<T>) -> Self {
        // Most joints of a gyroscope are at their bodies' mass centres.
        if *d == Vector3::zeros() {
            return *self;
        }
        let coupling = self.coupling - cross(d, &self.linear).transpose();
        let angular = self.angular - cross(d, &coupling) - cross(d, &self.coupling).transpose();
        Self { linear: self.linear, coupling, angular }
    }

    /// The acceleration that a force causes; not finite where the inertia is not positive definite.
    pub(crate) fn solve(&self, force: &Spatial<T>) -> Spatial<T> {
        let linear_inverse = inverse(&self.linear);
        let reduced = self.angular - self.coupling.tr_mul(&(linear_inverse * self.coupling));
        let right = force.angular - self.coupling.tr_mul(&(linear_inverse * force.linear));
        let angular = inverse(&reduced) * right;
        Spatial { linear: linear_inverse * (force.linear - self.coupling * angular), angular }
    }
}

impl<T: Number> AddAssign for Inertia<T> {
    fn add_assign(&mut self, other: Self) {
        self.linear += other.linear;
        self.coupling += other.coupling;
        self.angular += other.angular;
    }
}

/// Inverse of a symmetric positive definite matrix; not finite if it is not.
pub(crate) fn inverse<T: Number>(matrix: &Matrix3<T>) -> Matrix3<T> {
    match matrix.cholesky() {
        Some(factor) => factor.inverse(),
        None => Matrix3::from_element(T::zero() / T::zero()),
    }
}

/// `d̃ X`, without the zeros of d̃.
fn cross<T: Number>(d: &Vector3<T>, x: &Matrix3<T>) -> Matrix3<T> {
    Matrix3::from_columns(&[d.cross(&x.column(0)), d.cross(&x.column(1)), d.cross(&x.column(2))])
}
