//! The Gragg–Bulirsch–Stoer method in double-double arithmetic.
//!
//! Hairer, Nørsett and Wanner, *Solving Ordinary Differential Equations I* (1993), section II.9, followed literally but
//! for two things: the sequence is 2, 4, 6, … and the smoothing step is left out, as that section recommends for it.

use core::fmt;

use crate::DoubleDouble;

/// A state of the integration, such as three angles (rad) and their rates (rad/s).
pub(crate) type State<const N: usize> = [DoubleDouble; N];

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

/// The state at `to`, from `state` at `from`, for the derivative `rhs` of time and state.
pub(crate) fn advance<const N: usize>(
    rhs: impl Fn(DoubleDouble, &State<N>) -> State<N>,
    scheme: &Scheme,
    mut state: State<N>,
    from: DoubleDouble,
    to: DoubleDouble,
) -> Result<State<N>, NotConverged> {
    /// From the default step this leads to 40 µs; where that is too long, waiting will not help either.
    const HALVINGS: u32 = 8;
    let span = to - from;
    let mut count = (span.to_f64() / scheme.step).ceil().max(1.0);
    let (mut done, mut halvings) = (0.0, 0);
    while done < count {
        let step = span.divided_by(count);
        let start = from + step.times(done);
        match extrapolated(&rhs, scheme, (start, &state), step) {
            Ok(next) => {
                state = next;
                done += 1.0;
            }
            Err(_) if halvings < HALVINGS => {
                (done, count, halvings) = (2.0 * done, 2.0 * count, halvings + 1);
            }
            Err(difference) => {
                return Err(NotConverged { time: start.to_f64(), difference });
            }
        }
    }
    Ok(state)
}

/// One basic step by Aitken–Neville extrapolation in h²; where that does not converge, the last difference.
fn extrapolated<const N: usize>(
    rhs: &impl Fn(DoubleDouble, &State<N>) -> State<N>,
    scheme: &Scheme,
    start: (DoubleDouble, &State<N>),
    step: DoubleDouble,
) -> Result<State<N>, f64> {
    let slope = rhs(start.0, start.1);
    let mut row: Vec<State<N>> = Vec::with_capacity(scheme.columns);
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
fn improved<const N: usize>(value: &State<N>, previous: &State<N>, j: usize, k: usize) -> State<N> {
    let (whole, part) = ((j * j) as f64, ((j - k) * (j - k)) as f64);
    core::array::from_fn(|i| value[i] + (value[i] - previous[i]).times(part).divided_by(whole - part))
}

/// Gragg's modified midpoint rule over `step` in `count` substeps. Hairer et al., eq. (II.9.13), unsmoothed.
fn midpoint<const N: usize>(
    rhs: &impl Fn(DoubleDouble, &State<N>) -> State<N>,
    (time, start): (DoubleDouble, &State<N>),
    slope: &State<N>,
    step: DoubleDouble,
    count: usize,
) -> State<N> {
    let substep = step.divided_by(count as f64);
    let mut before = *start;
    let mut here = moved(start, slope, substep);
    for done in 1..count {
        let now = time + substep.times(done as f64);
        let next = moved(&before, &rhs(now, &here), substep.times(2.0));
        before = core::mem::replace(&mut here, next);
    }
    here
}

/// `state` + `step` · `slope`.
fn moved<const N: usize>(state: &State<N>, slope: &State<N>, step: DoubleDouble) -> State<N> {
    core::array::from_fn(|i| state[i] + step * slope[i])
}

/// The largest component of a − b, each relative to 1 + |a|; NaN if any component is.
fn distance<const N: usize>(a: &State<N>, b: &State<N>) -> f64 {
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
    fn oscillators(_: DoubleDouble, state: &State<6>) -> State<6> {
        let [x, y, z, u, v, w] = *state;
        [u, v, w, x.times(-1e4), y.times(-1e2), -z]
    }

    fn at_rest() -> State<6> {
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
    fn time_enters_at_every_substep() {
        let start = DoubleDouble::new(-3.0);
        let slope = |t: DoubleDouble, _: &State<1>| [t.sin_cos().1];
        let end =
            advance(slope, &Scheme { step: 0.3, ..Scheme::default() }, [ZERO], start, DoubleDouble::new(2.0));
        let area = DoubleDouble::new(2.0).sin_cos().0 - start.sin_cos().0;
        assert!((end.unwrap()[0] - area).to_f64().abs() < OSCILLATION);
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
        let pole = |_, state: &State<1>| state.map(|x| x * x);
        let start = [DoubleDouble::new(1.0)];
        let failure = advance(pole, &Scheme::default(), start, ZERO, DoubleDouble::new(2.0)).unwrap_err();
        assert!((failure.time - 1.0).abs() < 1e-3, "{failure}");
    }
}
