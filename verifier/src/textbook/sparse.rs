//! Matrices of which most entries are zero.

use crate::field::Field;
use std::collections::BTreeMap;

/// A matrix by rows: what may be other than zero, by its column.
#[derive(Clone, Debug)]
pub struct Sparse<F> {
    /// Row after row.
    pub rows: Vec<BTreeMap<usize, F>>,
    /// How wide they are.
    pub n_columns: usize,
}

impl<F: Field> Sparse<F> {
    /// All zero.
    pub fn new(n_rows: usize, n_columns: usize) -> Self {
        Self { rows: vec![BTreeMap::new(); n_rows], n_columns }
    }

    /// The matrix times a vector.
    pub fn product(&self, vector: &[F], zero: &F) -> Vec<F> {
        let row = |row: &BTreeMap<usize, F>| {
            row.iter().fold(zero.clone(), |sum, (&column, entry)| sum.add(&entry.mul(&vector[column])))
        };
        self.rows.iter().map(row).collect()
    }

    /// The transposed matrix times a vector.
    pub fn transposed_product(&self, vector: &[F], zero: &F) -> Vec<F> {
        let mut sums = vec![zero.clone(); self.n_columns];
        for (row, factor) in self.rows.iter().zip(vector) {
            for (&column, entry) in row {
                sums[column] = sums[column].add(&entry.mul(factor));
            }
        }
        sums
    }
}
