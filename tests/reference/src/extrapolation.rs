//! The Gragg–Bulirsch–Stoer method in double-double arithmetic.
//!
//! Hairer, Nørsett and Wanner, *Solving Ordinary Differential Equations I* (1993), section II.9, followed literally but
//! for two things: the sequence is 2, 4, 6, … and the smoothing step is left out, as that section recommends for it.

use core::fmt;

use crate::DoubleDouble;

/// A state of the integration: three angles (rad) and their rates (rad/s).
pub(crate) type State = [DoubleDouble; 6];

/// How to integrate: the largest step, how far to extrapolate, and when a step is good enough.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scheme {
    /// Largest basic step, s.
    pub step: f64,
    /// Columns of the extrapolation table, two or more; the order is twice their number.
    pub columns: usize,
    /// A step is accepted when its last two extrapolations differ by less than this, relative to 1 + |value|. The
    /// accepted value is far better than the difference says.
    pub tolerance: f64,
}

impl Default for Scheme {
    /// Order 28 at 10 ms: at 100 rad/s a step covers one radian, where this order needs the fewest evaluations.
    fn default() -> Self {
        Scheme { step: 0.01, columns: 14, tolerance: 1e-26 }
    }
}

/// Even 1/256 of the scheme's step did not meet the tolerance; also the end of states that are no longer finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NotConverged {
    /// Time at the start of the step that failed, s.
    pub time: f64,
    /// What the last two extrapolations of the shortest step differed by.
    pub difference: f64,
}

impl fmt::Display for NotConverged {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "no convergence at t = {} s: extrapolations differ by {:e}", self.time, self.difference)
    }
}

impl core::error::Error for NotConverged {}

/// The state at `to`, from `state` at `from`, for the derivative `rhs`.
pub(crate) fn advance(
    rhs: impl Fn(&State) -> State,
    scheme: &Scheme,
    mut state: State,
    from: DoubleDouble,
    to: DoubleDouble,
) -> Result<State, NotConverged> {
    /// From the default step this leads to 40 µs; where that is too long, waiting will not help either.
    const HALVINGS: u32 = 8;
    let span = to - from;
    let mut count = (span.to_f64() / scheme.step).ceil().max(1.0);
    let (mut done, mut halvings) = (0.0, 0);
    while done < count {
        match extrapolated(&rhs, scheme, &state, span.divided_by(count)) {
            Ok(next) => {
                state = next;
                done += 1.0;
            }
            Err(_) if halvings < HALVINGS => {
                (done, count, halvings) = (2.0 * done, 2.0 * count, halvings + 1);
            }
            Err(difference) => {
                let time = (from + span.divided_by(count).times(done)).to_f64();
                return Err(NotConverged { time, difference });
            }
        }
    }
    Ok(state)
}

/// One basic step by Aitken–Neville extrapolation in h²; where that does not converge, the last difference.
fn extrapolated(
    rhs: &impl Fn(&State) -> State,
    scheme: &Scheme,
    start: &State,
    step: DoubleDouble,
) -> Result<State, f64> {
    let slope = rhs(start);
    let mut row: Vec<State> = Vec::with_capacity(scheme.columns);
    let mut difference = f64::NAN;
    for j in 1..=scheme.columns {
        let mut value = midpoint(rhs, start, &slope, step, 2 * j);
        for k in 1..j {
            let previous = core::mem::replace(&mut row[k - 1], value);
            value = improved(&value, &previous, j, k);
        }
        if let Some(last) = row.last() {
            difference = distance(&value, last);
            if difference < scheme.tolerance {
                return Ok(value);
            }
        }
        row.push(value);
    }
    Err(difference)
}

/// T(j, k+1) = T(j, k) + (T(j, k) − T(j−1, k)) / ((j / (j−k))² − 1). Hairer et al., eq. (II.9.10).
fn improved(value: &State, previous: &State, j: usize, k: usize) -> State {
    let (whole, part) = ((j * j) as f64, ((j - k) * (j - k)) as f64);
    core::array::from_fn(|i| value[i] + (value[i] - previous[i]).times(part).divided_by(whole - part))
}

/// Gragg's modified midpoint rule over `step` in `count` substeps. Hairer et al., eq. (II.9.13), unsmoothed.
fn midpoint(
    rhs: &impl Fn(&State) -> State,
    start: &State,
    slope: &State,
    step: DoubleDouble,
    count: usize,
) -> State {
    let substep = step.divided_by(count as f64);
    let mut before = *start;
    let mut here = moved(start, slope, substep);
    for _ in 1..count {
        let next = moved(&before, &rhs(&here), substep.times(2.0));
        before = core::mem::replace(&mut here, next);
    }
    here
}

/// `state` + `step` · `slope`.
fn moved(state: &State, slope: &State, step: DoubleDouble) -> State {
    core::array::from_fn(|i| state[i] + step * slope[i])
}

/// The largest component of a − b, each relative to 1 + |a|; NaN if any component is.
fn distance(a: &State, b: &State) -> f64 {
    let relative =
        |(&a, &b): (&DoubleDouble, &DoubleDouble)| (a - b).to_f64().abs() / (1.0 + a.to_f64().abs());
    a.iter()
        .zip(b)
        .map(relative)
        .fold(0.0, |largest: f64, x| if x > largest || x.is_nan() { x } else { largest })
}

#[cfg(test)]
mod tests {
    use super::*;

    const ZERO: DoubleDouble = DoubleDouble::ZERO;

    /// A hundred steps, each good to better than the default tolerance of 1e-26.
    const OSCILLATION: f64 = 1e-25;

    /// Three oscillators of angular frequency 100, 10 and 1 rad/s.
    fn oscillators(state: &State) -> State {
        let [x, y, z, u, v, w] = *state;
        [u, v, w, x.times(-1e4), y.times(-1e2), -z]
    }

    fn at_rest() -> State {
        let one = DoubleDouble::new(1.0);
        [one, one, one, ZERO, ZERO, ZERO]
    }

    #[test]
    fn oscillators_follow_their_cosines() {
        let end = advance(oscillators, &Scheme::default(), at_rest(), ZERO, DoubleDouble::new(1.0)).unwrap();
        for (found, frequency) in end.iter().zip([100.0, 10.0, 1.0]) {
            let (_, cos) = DoubleDouble::new(frequency).sin_cos();
            assert!((*found - cos).to_f64().abs() < OSCILLATION, "{frequency} rad/s: {found:?}");
        }
    }

    #[test]
    fn a_step_too_long_is_shortened() {
        let hopeful = Scheme { step: 1.0, ..Scheme::default() };
        let end = advance(oscillators, &hopeful, at_rest(), ZERO, DoubleDouble::new(1.0)).unwrap();
        let (_, cos) = DoubleDouble::new(100.0).sin_cos();
        assert!((end[0] - cos).to_f64().abs() < OSCILLATION);
    }

    #[test]
    fn what_does_not_converge_is_an_error_with_its_time() {
        // ẋ = x² from 1 has its pole at t = 1.
        let pole = |state: &State| state.map(|x| x * x);
        let start = [DoubleDouble::new(1.0); 6];
        let failure = advance(pole, &Scheme::default(), start, ZERO, DoubleDouble::new(2.0)).unwrap_err();
        assert!((failure.time - 1.0).abs() < 1e-3, "{failure}");
    }
}
