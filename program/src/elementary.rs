//! The elementary functions that programs call: their names, and what signs and zeros do to them. Their values and
//! derivatives are with whoever computes with them.

/// An elementary function. Orders that depend on functions follow the one of this list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Function {
    /// Square root.
    Sqrt,
    /// Sine.
    Sin,
    /// Cosine.
    Cos,
    /// Hyperbolic tangent.
    Tanh,
    /// The angle of the point (second operand, first operand), in (−π, π].
    Atan2,
    /// The exponential function.
    Exp,
    /// Natural logarithm.
    Ln,
    /// Absolute value.
    Abs,
    /// The largest whole number that is not larger.
    Floor,
    /// The second operand where the first one is greater than zero, and zero where it is not; NaN where that is NaN.
    /// The operand that is not taken may be infinite or NaN.
    When,
    /// The second operand where the first one is at most zero, and zero where it is greater; NaN where that is NaN.
    Unless,
    /// A curve of a list that whoever computes has, or a derivative of it; of a formula the list is the model's, of an
    /// expression that of the module's tables. It is none of [`Function::ALL`].
    Curve {
        /// Which one.
        curve: u16,
        /// Which derivative, from zero to [`Function::LAST_ORDER`]; all further ones are zero.
        order: u8,
    },
}

/// What becomes of a function when the sign of its first operand changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Parity {
    /// Its sign changes.
    Odd,
    /// Nothing.
    Even,
    /// Nothing that is known.
    Neither,
}

/// A row of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Properties {
    /// Its name in Rust.
    pub name: &'static str,
    /// Its names in C, of `double` and of `float`.
    pub in_c: [&'static str; 2],
    /// How many operands it has: one or two.
    pub arity: usize,
    /// What the sign of its first operand does.
    pub parity: Parity,
    /// Its value where its only operand is zero, if that is a whole number.
    pub at_zero: Option<i64>,
}

impl Function {
    /// All functions but curves, in their order.
    pub const ALL: [Self; 11] = [
        Self::Sqrt,
        Self::Sin,
        Self::Cos,
        Self::Tanh,
        Self::Atan2,
        Self::Exp,
        Self::Ln,
        Self::Abs,
        Self::Floor,
        Self::When,
        Self::Unless,
    ];

    /// Its row of the table.
    #[rustfmt::skip]
    pub const fn properties(self) -> Properties {
        use Parity::{Even, Neither, Odd};
        let (name, in_c, arity, parity, at_zero) = match self {
            Self::Sqrt => ("sqrt", ["sqrt", "sqrtf"], 1, Neither, Some(0)),
            Self::Sin => ("sin", ["libm_sin", "gyro_sinf"], 1, Odd, Some(0)),
            Self::Cos => ("cos", ["libm_cos", "gyro_cosf"], 1, Even, Some(1)),
            Self::Tanh => ("tanh", ["libm_tanh", "libm_tanhf"], 1, Odd, Some(0)),
            Self::Atan2 => ("atan2", ["libm_atan2", "libm_atan2f"], 2, Odd, None),
            Self::Exp => ("exp", ["libm_exp", "libm_expf"], 1, Neither, Some(1)),
            Self::Ln => ("ln", ["libm_log", "libm_logf"], 1, Neither, None),
            Self::Abs => ("abs", ["fabs", "fabsf"], 1, Even, Some(0)),
            Self::Floor => ("floor", ["floor", "floorf"], 1, Neither, Some(0)),
            Self::When => ("when", ["gyro_when", "gyro_whenf"], 2, Neither, None),
            Self::Unless => ("unless", ["gyro_unless", "gyro_unlessf"], 2, Neither, None),
            Self::Curve { .. } => ("spline", ["gyro_spline", "gyro_splinef"], 1, Neither, None),
        };
        Properties { name, in_c, arity, parity, at_zero }
    }

    /// Its name in Rust.
    pub const fn name(self) -> &'static str {
        self.properties().name
    }

    /// How many operands it has.
    pub const fn arity(self) -> usize {
        self.properties().arity
    }

    /// The last derivative of a curve that is not zero: its pieces are cubics.
    pub const LAST_ORDER: u8 = 3;

    /// A derivative of a curve, by its place.
    ///
    /// # Panics
    /// There are more curves than a `u16` counts.
    pub fn curve(curve: usize, order: u8) -> Self {
        Self::Curve { curve: u16::try_from(curve).expect("a model has fewer curves"), order }
    }

    /// Its place in [`Function::ALL`]; `None` of curves.
    pub fn place(self) -> Option<usize> {
        Self::ALL.into_iter().position(|function| function == self)
    }

    /// The function of a name in Rust.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|function| function.name() == name)
    }
}

#[cfg(test)]
mod tests;
