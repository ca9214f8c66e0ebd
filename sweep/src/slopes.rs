//! How what is kept of a scenario changes with what varies.

use crate::Keep;

/// A number with its derivatives.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Sloped {
    /// The number.
    pub(crate) value: f64,
    /// Its derivatives, one for each direction.
    pub(crate) slopes: Vec<f64>,
}

/// Follows a scenario from sample to sample, as [`Keeper`](crate::Keeper) does, and differentiates what that keeps: a
/// last value, an extreme at the sample where it is, and a first passage as the line between its two samples has it,
/// which is the implicit function theorem, `dt/dp = −(∂y/∂p)/ẏ`, for that line.
#[derive(Clone, Debug)]
pub(crate) struct Slopes<'a> {
    keep: &'a Keep,
    t: f64,
    last: Vec<Sloped>,
    /// Smallest and largest.
    extremes: Vec<[Sloped; 2]>,
    /// None before the passage.
    passages: Vec<Option<Vec<f64>>>,
    /// Derivatives of series, sample after sample.
    series: Vec<f64>,
    samples: usize,
}

impl<'a> Slopes<'a> {
    /// For scenarios with so many samples.
    pub(crate) fn new(keep: &'a Keep, samples: usize) -> Self {
        let (last, extremes, passages, series) = Default::default();
        Self { keep, t: f64::NAN, last, extremes, passages, series, samples }
    }

    /// Takes a sample: a number for each column.
    pub(crate) fn take(&mut self, t: f64, now: Vec<Sloped>) {
        let keep = self.keep;
        if self.last.is_empty() {
            let both = |column: &usize| [now[*column].clone(), now[*column].clone()];
            self.extremes = keep.extremes.iter().map(both).collect();
            self.passages = vec![None; keep.passages.len()];
        }
        for ([low, high], column) in self.extremes.iter_mut().zip(&keep.extremes) {
            let now = &now[*column];
            if now.value < low.value {
                low.clone_from(now);
            }
            if now.value > high.value {
                high.clone_from(now);
            }
        }
        for (passed, passage) in self.passages.iter_mut().zip(&keep.passages) {
            let now = &now[passage.column];
            let before = self.last.get(passage.column);
            let value = before.map_or(f64::NAN, |before| before.value);
            if passed.is_some() || passage.between((self.t, value), (t, now.value)).is_nan() {
                continue;
            }
            let slope = |(before, after): (&f64, &f64)| {
                let rise = now.value - value;
                let moved = -before * rise - (passage.level - value) * (after - before);
                (t - self.t) * moved / (rise * rise)
            };
            *passed = Some(match before {
                Some(before) => before.slopes.iter().zip(&now.slopes).map(slope).collect(),
                // It was beyond the level from the start.
                None => vec![0.0; now.slopes.len()],
            });
        }
        self.series.extend(keep.sloped.iter().flat_map(|column| &now[*column].slopes));
        (self.t, self.last) = (t, now);
    }

    /// Appends the derivatives of each kept number by each direction, or NaN for all after a failure; those of series,
    /// as far as there are samples; and forgets the scenario. Slopes that were taken are in units of `1 / scales`, of
    /// which there is one for each direction.
    pub(crate) fn finish(&mut self, is_whole: bool, scales: &[f64], out: &mut Vec<f64>) {
        let keep = self.keep;
        let end = out.len() + keep.slopes();
        if is_whole {
            let mut add =
                |slopes: &[f64]| out.extend(slopes.iter().zip(scales).map(|(slope, scale)| slope / scale));
            keep.finals.iter().for_each(|column| add(&self.last[*column].slopes));
            self.extremes.iter().flatten().for_each(|extreme| add(&extreme.slopes));
            let never = vec![f64::NAN; scales.len()];
            self.passages.iter().for_each(|passage| add(passage.as_ref().unwrap_or(&never)));
        }
        out.resize(end, f64::NAN);
        out.extend(self.series.drain(..).zip(scales.iter().cycle()).map(|(slope, scale)| slope / scale));
        out.resize(end + keep.series_slopes() * self.samples, f64::NAN);
        self.t = f64::NAN;
        self.last.clear();
    }
}

#[cfg(test)]
mod tests;
