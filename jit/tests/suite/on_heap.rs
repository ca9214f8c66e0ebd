//! Room for pivoting, of sizes that are known at run time.

use gyro_sim::Real;
use gyro_sim::pivoting::Extent;

/// Numbers of constraints and coordinates that are known at run time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OnHeap {
    n_constraints: usize,
    n_coordinates: usize,
}

impl Extent for OnHeap {
    type Columns = Vec<u16>;
    type Places = Vec<u16>;
    type Rows<T: Real> = Vec<T>;
    type Line<T: Real> = Vec<T>;
    type Jacobian<T: Real> = Vec<Vec<T>>;

    fn new(n_constraints: usize, n_coordinates: usize) -> Self {
        Self { n_constraints, n_coordinates }
    }
    fn n_constraints(self) -> usize {
        self.n_constraints
    }
    fn n_coordinates(self) -> usize {
        self.n_coordinates
    }
    fn columns(self) -> Vec<u16> {
        (0..self.n_coordinates).map(|column| column as u16).collect()
    }
    fn places(self) -> Vec<u16> {
        vec![0; self.n_constraints]
    }
    fn rows<T: Real>(self) -> Vec<T> {
        vec![T::constant(0.0); self.n_constraints]
    }
    fn line<T: Real>(self) -> Vec<T> {
        vec![T::constant(0.0); self.n_coordinates]
    }
    fn jacobian<T: Real>(self) -> Vec<Vec<T>> {
        vec![self.line(); self.n_constraints]
    }
}
