//! From a derivative and a start to states at the times asked for; and the numbers of callers read as
//! decimals.

use core::fmt;

use crate::DoubleDouble;
use crate::extrapolation::{NotConverged, Scheme, State, advance};

/// Why there is no solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SolveError {
    /// The time is negative, not finite, or earlier than the one before it.
    Time(f64),
    /// The integration stopped.
    NotConverged(NotConverged),
}

impl fmt::Display for SolveError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SolveError::Time(t) => write!(f, "times must be finite and ascend from zero: found {t}"),
            SolveError::NotConverged(failure) => failure.fmt(f),
        }
    }
}

impl core::error::Error for SolveError {}

/// Times with the states of `rhs` there, from `start` at time zero. Each time stands for the decimal it
/// prints as.
pub(crate) fn trajectory<const N: usize>(
    rhs: impl Fn(DoubleDouble, &State<N>) -> State<N>,
    scheme: &Scheme,
    start: State<N>,
    times: &[f64],
) -> Result<Vec<(DoubleDouble, State<N>)>, SolveError> {
    let (mut state, mut now) = (start, DoubleDouble::ZERO);
    let mut motion = Vec::with_capacity(times.len());
    for &t in times {
        let next = printed_decimal(t).filter(|next| *next >= now).ok_or(SolveError::Time(t))?;
        state = advance(&rhs, scheme, state, now, next).map_err(SolveError::NotConverged)?;
        now = next;
        motion.push((now, state));
    }
    Ok(motion)
}

/// [`trajectory`] with the default scheme, for callers that have only smooth motions to offer.
///
/// # Panics
/// If the times do not ascend from zero or the integration does not converge.
pub(crate) fn smooth_trajectory<const N: usize>(
    rhs: impl Fn(DoubleDouble, &State<N>) -> State<N>,
    start: State<N>,
    times: &[f64],
) -> Vec<(DoubleDouble, State<N>)> {
    match trajectory(rhs, &Scheme::default(), start, times) {
        Ok(motion) => motion,
        Err(error) => panic!("{error}"),
    }
}

/// The decimal that `value` prints as: the number on a page of decimals that was read as this `f64`.
///
/// # Panics
/// If it is not finite, or of no ordinary size.
pub(crate) fn decimal(value: f64) -> DoubleDouble {
    printed_decimal(value).expect("parameters are finite and between 1e-200 and 1e200 in size")
}

/// [`decimal`] of each.
pub(crate) fn decimals<const N: usize>(values: [f64; N]) -> [DoubleDouble; N] {
    values.map(decimal)
}

/// Each rounded to the nearest `f64`.
pub(crate) fn rounded<const N: usize>(values: [DoubleDouble; N]) -> [f64; N] {
    values.map(DoubleDouble::to_f64)
}

/// The decimal that `value` prints as.
fn printed_decimal(value: f64) -> Option<DoubleDouble> {
    value.to_string().parse().ok()
}
