//! The variables of the expression graph.

/// A variable. `slot` counts the bodies that have coordinates; `k`, `row` and `column` count from zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Symbol {
    /// t.
    Time,
    /// Component of r.
    Position { slot: usize, k: usize },
    /// Component of p.
    Euler { slot: usize, k: usize },
    /// Component of s = ṙ.
    Velocity { slot: usize, k: usize },
    /// Component of w'.
    Spin { slot: usize, k: usize },
    /// Component of a joint's chart: one for the special Euler parameter, else zero.
    Chart { chart: usize, k: usize },
    /// A tunable number of the model.
    Parameter(usize),
    /// Entry of A(p), defined by eq. (3).
    Rotation { slot: usize, row: usize, column: usize },
    /// Entry of A_iᵀ A_j between a joint's first and second body, eq. (4).
    Relative { joint: usize, row: usize, column: usize },
    /// Entry of Ȧ.
    RotationRate { slot: usize, row: usize, column: usize },
    /// Entry of (A_iᵀ A_j)˙.
    RelativeRate { joint: usize, row: usize, column: usize },
}
