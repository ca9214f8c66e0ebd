//! The strongest frequency of evenly spaced samples, as a first guess for the fit.

use nalgebra::Complex;
use std::f64::consts::{PI, TAU};

/// The angular frequency, in radians per sample, at which the Hann-windowed spectrum is largest.
///
/// Good to a quarter of the frequency that turns once over the samples; constant and slope are to be taken out before.
pub(crate) fn strongest(values: &[f64]) -> f64 {
    // Twice the samples, zeros behind them: the peak is seen at half steps.
    let n = (2 * values.len()).next_power_of_two();
    let mut spectrum = vec![Complex::new(0.0, 0.0); n];
    for (k, (bin, value)) in spectrum.iter_mut().zip(values).enumerate() {
        let window = 1.0 - (TAU * (k as f64 + 0.5) / values.len() as f64).cos();
        *bin = Complex::new(value * window, 0.0);
    }
    transform(&mut spectrum);
    let power = |k: &usize| spectrum[*k].norm_sqr();
    let peak = (1..n / 2).max_by(|a, b| power(a).total_cmp(&power(b))).unwrap_or(1);
    TAU * peak as f64 / n as f64
}

/// The fast Fourier transform of Cooley and Tukey, radix two: bits reversed, then butterflies.
fn transform(values: &mut [Complex<f64>]) {
    let n = values.len();
    let bits = n.trailing_zeros();
    for k in 0..n {
        let reversed = k.reverse_bits() >> (usize::BITS - bits);
        if k < reversed {
            values.swap(k, reversed);
        }
    }
    let mut half = 1;
    while half < n {
        let twiddles: Vec<_> =
            (0..half).map(|k| Complex::from_polar(1.0, -PI * k as f64 / half as f64)).collect();
        for block in values.chunks_exact_mut(2 * half) {
            let (low, high) = block.split_at_mut(half);
            for ((low, high), twiddle) in low.iter_mut().zip(high).zip(&twiddles) {
                let turned = *high * twiddle;
                (*low, *high) = (*low + turned, *low - turned);
            }
        }
        half *= 2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_planted_frequency_is_found() {
        for n in [40, 1000, 1001] {
            for cycles in [3.0, 7.3, 0.31 * n as f64] {
                let omega = TAU * cycles / n as f64;
                let values: Vec<f64> = (0..n).map(|k| (omega * k as f64 + 0.4).sin()).collect();
                let found = strongest(&values);
                assert!((found - omega).abs() < 0.3 * TAU / n as f64, "{n} {cycles}: {found} for {omega}");
            }
        }
    }

    #[test]
    fn the_transform_is_the_sum_that_defines_it() {
        let values: Vec<_> = (0..8).map(|k| Complex::new(f64::from(k * k % 5), f64::from(k % 3))).collect();
        let mut fast = values.clone();
        transform(&mut fast);
        for (j, found) in fast.iter().enumerate() {
            let terms = values.iter().enumerate();
            let sum: Complex<f64> =
                terms.map(|(k, v)| v * Complex::from_polar(1.0, -TAU * (j * k) as f64 / 8.0)).sum();
            assert!((sum - found).norm() < 1e-13, "{found} for {sum}");
        }
    }
}
