//! The variables of the expression graph.

/// A variable. `moving_body` counts the bodies that have coordinates; `k`, `row` and `column` count from zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Symbol {
    /// t.
    Time,
    /// Component of r.
    Position { moving_body: usize, k: usize },
    /// Component of p.
    Euler { moving_body: usize, k: usize },
    /// Component of s = ṙ.
    Velocity { moving_body: usize, k: usize },
    /// Component of w'.
    Spin { moving_body: usize, k: usize },
    /// Component of a joint's chart: one for the special Euler parameter, else zero.
    Chart { chart: usize, k: usize },
    /// A tunable number of the model.
    Parameter(usize),
    /// A number that follows from parameters, by its place among what is set up before all steps.
    ParameterSetup(usize),
    /// A number that the caller sets at every step.
    Input(usize),
    /// The turn reference of an angle, by its place in `Model::turn_references`: part of the state, and constant in all
    /// derivatives (the angle that it serves does not depend on it).
    Turn(usize),
    /// The continuous angle of that place, defined by its reference and the principal angle.
    Angle(usize),
    /// Value (order 0) or a derivative of a table's curve at t.
    Table { table: usize, order: usize },
    /// Component of (s̈, ẇ') of a moving body, where accelerations are known.
    Acceleration { moving_body: usize, k: usize },
    /// Multiplier of a row that closes a loop, where accelerations are known.
    LoopMultiplier(usize),
    /// By how much a row is asked to change.
    Change(usize),
    /// Joint coordinate, by its place in x: see `joint_space::Layout`.
    Coordinate(usize),
    /// Rate, by its place in u.
    Rate(usize),
    /// The rate's rate of that place, where it is known.
    RateOfRate(usize),
    /// Sine of the joint coordinate of that place, an angle.
    Sine(usize),
    /// Its cosine.
    Cosine(usize),
    /// The Euler parameter of that place in x over the length of all four: rotations are read as these say, however
    /// long the four are.
    Unit(usize),
    /// Entry of A(p), defined by eq. (3).
    Rotation { moving_body: usize, row: usize, column: usize },
    /// Entry of A_iᵀ A_j between a joint's first and second body, eq. (4).
    Relative { joint: usize, row: usize, column: usize },
    /// Entry of Ȧ.
    RotationRate { moving_body: usize, row: usize, column: usize },
    /// Entry of (A_iᵀ A_j)˙.
    RelativeRate { joint: usize, row: usize, column: usize },
    /// Element of an array that a loop fills: see `repeat`.
    Entry { array: usize, row: usize, column: usize },
    /// What the body of a loop reads, by its place among that.
    Local(usize),
    /// A state of one's own, by its place in `Model::states`.
    State(usize),
}
