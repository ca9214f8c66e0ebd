//! The arrays and tables of loops.

use crate::program::Id;

/// `let mut kept0 = [[T::constant(0.0); 3]; 12];`: what is stored in it.
#[derive(Debug)]
pub struct Array {
    pub rows: Vec<Vec<Option<Id>>>,
    pub column: Vec<Use>,
}

/// `const PARTS_0: [[f64; 3]; 12] = [...];`: the places of its literals among the module's.
#[derive(Debug)]
pub struct Table {
    pub rows: Vec<Vec<usize>>,
    pub column: Vec<Use>,
}

/// Whether a column is read.
#[derive(Clone, Debug)]
pub struct Use {
    pub name: String,
    pub line: usize,
    pub is_read: bool,
}

/// Columns that are yet to be read.
pub fn uses(name: &str, line: usize, count: usize) -> Vec<Use> {
    (0..count).map(|k| Use { name: format!("{name}[..][{k}]"), line, is_read: false }).collect()
}
