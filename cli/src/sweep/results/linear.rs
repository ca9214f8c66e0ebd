//! The local tolerance analysis: what is drawn, propagated by one scenario's derivatives, beside all scenarios.

use super::super::loaded::Loaded;
use super::column;
use crate::words::number;

/// Means and deviations of the kept numbers, by one scenario and by all.
#[derive(Debug)]
pub(super) struct Linear {
    means: Vec<f64>,
    covariance: Vec<f64>,
    nearest: Option<Nearest>,
    /// Of each number over all scenarios that have it: how many, their mean, the sum of squares about it.
    all: Vec<(f64, f64, f64)>,
}

/// The scenario whose draws are nearest to their means, in standard deviations.
#[derive(Debug)]
struct Nearest {
    k: u64,
    distance: f64,
    values: Vec<f64>,
    numbers: Vec<f64>,
    slopes: Vec<f64>,
}

impl Linear {
    /// For studies with sensitivities in which all that varies is drawn.
    pub(super) fn new(loaded: &Loaded) -> Option<Self> {
        let plan = &loaded.study.plan;
        let is_drawn = plan.axes.is_empty() && !plan.draws.is_empty();
        (is_drawn && !loaded.study.slopes.is_empty()).then(|| {
            let [means, covariance] = plan.moments();
            let numbers = loaded.study.keep.sloped_numbers();
            Self { means, covariance, nearest: None, all: vec![(0.0, 0.0, 0.0); numbers] }
        })
    }

    /// Takes a scenario; what it lacks is left out.
    pub(super) fn add(&mut self, k: u64, values: &[f64], numbers: &[f64], slopes: &[f64]) {
        for ((n, mean, squares), number) in self.all.iter_mut().zip(numbers) {
            if number.is_finite() {
                *n += 1.0;
                let from = number - *mean;
                *mean += from / *n;
                *squares += from * (number - *mean);
            }
        }
        let variances = self.covariance.iter().step_by(self.means.len() + 1);
        let distance: f64 = values
            .iter()
            .zip(&self.means)
            .zip(variances)
            .map(|((value, mean), variance)| (value - mean) * (value - mean) / variance)
            .sum();
        let is_nearer = self.nearest.as_ref().is_none_or(|nearest| distance < nearest.distance);
        if is_nearer && slopes.iter().any(|slope| slope.is_finite()) {
            let [values, numbers, slopes] = [values, numbers, slopes].map(<[f64]>::to_vec);
            self.nearest = Some(Nearest { k, distance, values, numbers, slopes });
        }
    }

    /// The title, and rows with a head: of each number the means and the deviations.
    pub(super) fn rows(&self, loaded: &Loaded) -> Option<(String, Vec<Vec<String>>)> {
        let nearest = self.nearest.as_ref()?;
        let n = self.means.len();
        let title =
            format!("linear, by the derivatives of scenario {} alone, and of all scenarios", nearest.k);
        let head = ["", "linear mean", "mean", "linear deviation", "deviation"].map(str::to_owned).to_vec();
        let mut rows = vec![head];
        let slopes = nearest.slopes.chunks_exact(n);
        for (((name, slope), at), (count, mean, squares)) in
            loaded.study.numbers.iter().zip(slopes).zip(&nearest.numbers).zip(&self.all)
        {
            let moved = slope.iter().zip(self.means.iter().zip(&nearest.values));
            let linear = moved.fold(*at, |sum, (slope, (mean, value))| sum + slope * (mean - value));
            let product = |row: &[f64]| row.iter().zip(slope).map(|(c, slope)| c * slope).sum::<f64>();
            let products = self.covariance.chunks_exact(n).map(product);
            let variance: f64 = slope.iter().zip(products).map(|(slope, product)| slope * product).sum();
            let deviation = (squares / (count - 1.0)).sqrt();
            let shown = |x: f64, digits| if x.is_finite() { number(x, digits) } else { String::new() };
            rows.push(vec![
                column(name),
                shown(linear, 8),
                shown(*mean, 8),
                shown(variance.sqrt(), 4),
                shown(deviation, 4),
            ]);
        }
        Some((title, rows))
    }
}
