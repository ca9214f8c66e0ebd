//! Parts of long functions.

/// Calls a part of a long generated function, which becomes a function of its own: compilers take a time that grows
/// with the square of a function's length.
#[inline(never)]
pub fn apart<R>(part: impl FnOnce() -> R) -> R {
    part()
}
