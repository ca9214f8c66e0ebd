//! How many forms of a function are tried.

/// How long the generator searches for short forms. The same effort always gives the same text and the same kernels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Effort {
    /// Joint accelerations by recursions and mass matrices alone, in the bodies' frames and in those of joints; loops
    /// that are found at the first attempt. As accurate, and seldom much longer.
    Quick,
    /// All forms: what is written unless something else is asked for.
    #[default]
    Full,
}
