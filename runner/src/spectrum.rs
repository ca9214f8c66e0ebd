//! The fastest rate of a linearised motion.

use crate::motion::Linear;

/// Squarings of the matrix: its 256th power.
const SQUARINGS: i32 = 8;

/// The largest |λ| of A, 1/s, to a few per cent: the 256th root of the norm of its 256th power (Gelfand's formula).
pub fn fastest_rate(linear: &Linear) -> f64 {
    let n = linear.state.len();
    let (mut matrix, mut logarithm) = (linear.by_state.clone(), 0.0_f64);
    for squaring in 0..=SQUARINGS {
        let norm = matrix.iter().fold(0.0_f64, |norm, x| norm.max(x.abs()));
        if norm == 0.0 || !norm.is_finite() {
            return norm;
        }
        // A^(2^k) = norm · matrix, with all earlier norms taken out.
        logarithm = 2.0 * logarithm + norm.ln();
        matrix.iter_mut().for_each(|x| *x /= norm);
        if squaring < SQUARINGS {
            matrix = square(&matrix, n);
        }
    }
    (logarithm / f64::from(1 << SQUARINGS)).exp()
}

fn square(a: &[f64], n: usize) -> Vec<f64> {
    let entry = |row: usize, column: usize| (0..n).map(|k| a[row * n + k] * a[k * n + column]).sum();
    (0..n * n).map(|place| entry(place / n, place % n)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_an_oscillator_and_of_a_damper() {
        for (by_state, rate) in [
            (vec![0.0, 1.0, -1e10, 0.0], 1e5),
            (vec![0.0, 1.0, 0.0, -300.0], 300.0),
            (vec![0.0, 1.0, 0.0, 0.0], 0.0),
            (vec![2.0, 0.0, 0.0, -1.0], 2.0),
        ] {
            let found = fastest_rate(&Linear { state: vec![0.0; 2], by_state, ..Linear::default() });
            assert!((found - rate).abs() <= 0.1 * rate, "{found} for {rate}");
        }
    }
}
