//! Quantiles over the ensemble at each sample: how far apart scenarios come.

use crate::ensemble::{Ensemble, SAMPLES, STEP, STRIDE, is_finite};
use plotters::prelude::*;
use std::error::Error;
use std::fmt;
use std::path::Path;

/// The quantiles: bands between the outer and between the inner ones, and the median.
const QUANTILES: [f64; 5] = [0.05, 0.25, 0.5, 0.75, 0.95];

/// What is shown.
const ANGLES: [&str; 2] = ["alpha", "beta"];

/// Okabe and Ito's blue.
const COLOUR: RGBColor = RGBColor(0, 114, 178);

/// The quantiles of α and β at each sample, rad.
#[derive(Debug)]
pub(crate) struct Spread([[[f64; QUANTILES.len()]; SAMPLES]; ANGLES.len()]);

impl Spread {
    /// Of the scenarios that ran to the end; nothing if none did.
    pub(crate) fn of(ensemble: &Ensemble) -> Option<Self> {
        let tracks: Vec<_> = ensemble.tracks.iter().filter(|track| is_finite(track)).collect();
        (!tracks.is_empty()).then(|| {
            Self([0, 1].map(|angle| {
                std::array::from_fn(|sample| {
                    quantiles(tracks.iter().map(|track| track[sample][angle]).collect())
                })
            }))
        })
    }

    pub(crate) fn write_csv(&self, path: &Path) -> Result<(), Box<dyn Error>> {
        let mut table = csv::Writer::from_path(path)?;
        let named = |angle: &&str| QUANTILES.map(|q| format!("{angle} {:.0} % [rad]", 100.0 * q));
        table.write_record(std::iter::once("t [s]".to_owned()).chain(ANGLES.iter().flat_map(named)))?;
        for sample in 0..SAMPLES {
            let values = self.0.iter().flat_map(|angle| angle[sample]);
            table.write_record(std::iter::once(time(sample)).chain(values).map(|x| x.to_string()))?;
        }
        Ok(table.flush()?)
    }

    /// Bands of the quantiles over time, α above β.
    pub(crate) fn svg(&self) -> Result<String, Box<dyn Error>> {
        let mut text = String::new();
        {
            let area = SVGBackend::with_string(&mut text, (840, 600)).into_drawing_area();
            area.fill(&WHITE)?;
            for ((panel, name), rows) in area.split_evenly((2, 1)).iter().zip(ANGLES).zip(&self.0) {
                draw(panel, name, rows)?;
            }
            area.present()?;
        }
        Ok(text)
    }
}

fn draw<B: DrawingBackend<ErrorType: 'static>>(
    panel: &DrawingArea<B, plotters::coord::Shift>,
    name: &str,
    rows: &[[f64; QUANTILES.len()]; SAMPLES],
) -> Result<(), Box<dyn Error>> {
    let low = rows.iter().map(|row| row[0]).fold(f64::INFINITY, f64::min);
    let high = rows.iter().map(|row| row[QUANTILES.len() - 1]).fold(f64::NEG_INFINITY, f64::max);
    let margin = 0.05 * (high - low).max(f64::MIN_POSITIVE);
    let mut chart = ChartBuilder::on(panel)
        .caption(format!("{name}: 5, 25, 50, 75, 95 % of the scenarios"), ("sans-serif", 16))
        .margin(8)
        .x_label_area_size(44)
        .y_label_area_size(72)
        .build_cartesian_2d(0.0..time(SAMPLES - 1), low - margin..high + margin)?;
    let axis = |value: &f64| format!("{value:.1e}");
    chart
        .configure_mesh()
        .x_desc("t, s")
        .y_desc("rad")
        .y_label_formatter(&axis)
        .light_line_style(WHITE)
        .draw()?;
    let points =
        |quantile: usize| rows.iter().enumerate().map(move |(sample, row)| (time(sample), row[quantile]));
    for (lower, upper) in [(0, 4), (1, 3)] {
        let outline: Vec<_> = points(lower).chain(points(upper).rev()).collect();
        chart.draw_series(std::iter::once(Polygon::new(outline, COLOUR.mix(0.25))))?;
    }
    let median = PathElement::new(points(2).collect::<Vec<_>>(), COLOUR.stroke_width(2));
    chart.draw_series(std::iter::once(median))?;
    Ok(())
}

impl fmt::Display for Spread {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (name, rows) in ANGLES.iter().zip(&self.0) {
            let [low, _, median, _, high] = rows[SAMPLES - 1];
            writeln!(
                f,
                "{name} after one second: median {median:.4e} rad, nine of ten from {low:.4e} to {high:.4e} rad"
            )?;
        }
        Ok(())
    }
}

fn time(sample: usize) -> f64 {
    sample as f64 * f64::from(STRIDE) * STEP
}

/// Linear between the order statistics (Hyndman and Fan 1996, type 7).
fn quantiles(mut values: Vec<f64>) -> [f64; QUANTILES.len()] {
    values.sort_by(f64::total_cmp);
    QUANTILES.map(|q| {
        let place = q * (values.len() - 1) as f64;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an index")]
        let (below, part) = (place as usize, place.fract());
        let above = (below + 1).min(values.len() - 1);
        values[below] + part * (values[above] - values[below])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The name of the time axis stands clear below the numbers of its ticks.
    #[test]
    fn no_label_lies_on_another() {
        let svg = Spread([[[0.0, 1.0, 2.0, 3.0, 4.0]; SAMPLES]; ANGLES.len()]).svg().expect("a drawing");
        let attribute = |text: &str, name: &str| {
            let (_, value) = text.split_once(&format!(" {name}=\"")).expect("an attribute");
            value.split('"').next().expect("a value").to_owned()
        };
        // Where the letters stand: plotters shifts them by parts of the font's size.
        let baseline = |text: &str| {
            let [y, size] =
                ["y", "font-size"].map(|name| attribute(text, name).parse::<f64>().expect("a number"));
            let shift = attribute(text, "dy");
            let (number, unit) = shift.split_at(shift.len() - 2);
            y + number.parse::<f64>().expect("a number") * size * if unit == "em" { 1.0 } else { 0.5 }
        };
        let words = |text: &str| {
            text.split_once(">\n").and_then(|(_, words)| words.lines().next().map(str::to_owned))
        };
        let texts = svg.split("<text").skip(1);
        let texts: Vec<(f64, String)> =
            texts.map(|text| (baseline(text), words(text).expect("words"))).collect();
        let names: Vec<f64> = texts.iter().filter(|(_, words)| *words == "t, s").map(|(y, _)| *y).collect();
        assert_eq!(names.len(), ANGLES.len());
        for name in names {
            let near = texts.iter().filter(|(y, words)| (y - name).abs() < 12.0 && *words != "t, s");
            assert_eq!(near.count(), 0, "{texts:?}");
        }
    }

    #[test]
    fn quantiles_are_between_order_statistics() {
        let found = quantiles((0..=20).rev().map(f64::from).collect());
        for (found, expected) in found.iter().zip([1.0, 5.0, 10.0, 15.0, 19.0]) {
            assert!((found - expected).abs() < 1e-12, "{found} {expected}");
        }
        assert_eq!(quantiles(vec![3.0]), [3.0; 5]);
    }
}
