//! Figures as SVG: bands of quantiles, maps over a grid, indices of sensitivity.

use super::column;
use gyro_sweep::{IndicesOf, QUANTILES};
use plotters::coord::Shift;
use plotters::prelude::*;
use std::error::Error;

/// A drawing, or why there is none.
pub(super) type Drawn = Result<String, Box<dyn Error>>;

type Panel<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Okabe and Ito's blue and vermillion.
const BLUE: RGBColor = RGBColor(0, 114, 178);
const VERMILLION: RGBColor = RGBColor(213, 94, 0);

fn drawn(size: (u32, u32), draw: impl FnOnce(&Panel<'_>) -> Result<(), Box<dyn Error>>) -> Drawn {
    let mut text = String::new();
    {
        let area = SVGBackend::with_string(&mut text, size).into_drawing_area();
        area.fill(&WHITE)?;
        draw(&area)?;
        area.present()?;
    }
    Ok(text)
}

/// The interval of some numbers with a margin; one about zero if there are none.
fn range(numbers: impl Iterator<Item = f64>, margin: f64) -> std::ops::Range<f64> {
    let finite = numbers.filter(|number| number.is_finite());
    let [low, high] =
        finite.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)]);
    if low > high {
        return -1.0..1.0;
    }
    let spare = margin * (high - low);
    let spare = if spare > 0.0 { spare } else { (0.1 * low.abs()).max(1e-12) };
    low - spare..high + spare
}

fn axis(value: &f64) -> String {
    format!("{value:.1e}")
}

/// Bands of quantiles over time, series below series.
pub(super) fn bands(
    times: &[f64],
    names: &[(String, String)],
    rows: &[Vec<[f64; QUANTILES.len()]>],
) -> Drawn {
    let height = 300 * u32::try_from(names.len()).unwrap_or(1);
    drawn((840, height), |area| {
        for ((panel, name), rows) in area.split_evenly((names.len(), 1)).iter().zip(names).zip(rows) {
            band(panel, times, name, rows)?;
        }
        Ok(())
    })
}

fn band(
    panel: &Panel<'_>,
    times: &[f64],
    name: &(String, String),
    rows: &[[f64; QUANTILES.len()]],
) -> Result<(), Box<dyn Error>> {
    let y = range(rows.iter().flatten().copied(), 0.05);
    let mut chart = ChartBuilder::on(panel)
        .caption(format!("{}: 5, 25, 50, 75, 95 % of the scenarios", name.0), ("sans-serif", 16))
        .margin(8)
        .x_label_area_size(44)
        .y_label_area_size(72)
        .build_cartesian_2d(range(times.iter().copied(), 0.0), y)?;
    let mut mesh = chart.configure_mesh();
    mesh.x_desc("t, s").y_desc(&name.1).y_label_formatter(&axis).light_line_style(WHITE).draw()?;
    let points = |quantile: usize| {
        let points = times.iter().zip(rows).map(move |(t, row)| (*t, row[quantile]));
        points.filter(|(_, value)| value.is_finite()).collect::<Vec<_>>()
    };
    for (lower, upper) in [(0, 4), (1, 3)] {
        let outline: Vec<_> = points(lower).into_iter().chain(points(upper).into_iter().rev()).collect();
        chart.draw_series(std::iter::once(Polygon::new(outline, BLUE.mix(0.25))))?;
    }
    chart.draw_series(std::iter::once(PathElement::new(points(2), BLUE.stroke_width(2))))?;
    Ok(())
}

/// Kept numbers over a grid.
pub(super) struct Map<'a> {
    /// Name and values of the axis that changes seldom, and of the other.
    pub(super) slow: ((String, String), Vec<f64>),
    pub(super) fast: ((String, String), Vec<f64>),
    pub(super) numbers: &'a [(String, String)],
    /// For each point its numbers.
    pub(super) cells: &'a [Vec<f64>],
}

/// A map for each number, from violet (small) to yellow (large); grey where a scenario failed.
pub(super) fn maps(map: &Map<'_>) -> Drawn {
    let height = 420 * u32::try_from(map.numbers.len()).unwrap_or(1);
    drawn((640, height), |area| {
        for (number, panel) in area.split_evenly((map.numbers.len(), 1)).iter().enumerate() {
            draw_map(panel, map, number)?;
        }
        Ok(())
    })
}

/// From dark violet over green to yellow, which also differ in brightness.
fn ramp(part: f64) -> RGBColor {
    const COLOURS: [[f64; 3]; 3] = [[68.0, 1.0, 84.0], [33.0, 145.0, 140.0], [253.0, 231.0, 37.0]];
    let (from, to, part) = if part < 0.5 { (0, 1, 2.0 * part) } else { (1, 2, 2.0 * part - 1.0) };
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
    let mixed = |k: usize| (COLOURS[from][k] + part * (COLOURS[to][k] - COLOURS[from][k])).round() as u8;
    RGBColor(mixed(0), mixed(1), mixed(2))
}

fn draw_map(panel: &Panel<'_>, map: &Map<'_>, number: usize) -> Result<(), Box<dyn Error>> {
    let (columns, rows) = (map.fast.1.len(), map.slow.1.len());
    let colours = range(map.cells.iter().map(|cell| cell[number]), 0.0);
    let caption =
        format!("{}: {} to {}", column(&map.numbers[number]), axis(&colours.start), axis(&colours.end));
    #[expect(clippy::cast_precision_loss, reason = "a number of points")]
    let mut chart = ChartBuilder::on(panel)
        .caption(caption, ("sans-serif", 14))
        .margin(8)
        .x_label_area_size(44)
        .y_label_area_size(72)
        .build_cartesian_2d(0.0..columns as f64, 0.0..rows as f64)?;
    let at = |values: &[f64], place: f64| {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a place on the axis")]
        let index = (place.max(0.0) as usize).min(values.len() - 1);
        axis(&values[index])
    };
    chart
        .configure_mesh()
        .disable_mesh()
        .x_desc(column(&map.fast.0))
        .y_desc(column(&map.slow.0))
        .x_label_formatter(&|place| at(&map.fast.1, *place))
        .y_label_formatter(&|place| at(&map.slow.1, *place))
        .draw()?;
    let cells = map.cells.iter().take(columns * rows).enumerate().map(|(place, cell)| {
        #[expect(clippy::cast_precision_loss, reason = "a number of points")]
        let (x, y) = ((place % columns) as f64, (place / columns) as f64);
        let part = (cell[number] - colours.start) / (colours.end - colours.start);
        let colour = if part.is_finite() { ramp(part) } else { RGBColor(170, 170, 170) };
        Rectangle::new([(x, y), (x + 1.0, y + 1.0)], colour.filled())
    });
    chart.draw_series(cells)?;
    Ok(())
}

/// Indices of first order (blue) and of all orders (vermillion) as bars, number below number.
pub(super) fn bars(draws: &[String], numbers: &[(String, String)], indices: &[IndicesOf]) -> Drawn {
    let height = 260 * u32::try_from(numbers.len()).unwrap_or(1);
    drawn((840, height), |area| {
        for ((panel, name), of) in area.split_evenly((numbers.len(), 1)).iter().zip(numbers).zip(indices) {
            #[expect(clippy::cast_precision_loss, reason = "a number of draws")]
            let end = draws.len() as f64;
            let mut chart = ChartBuilder::on(panel)
                .caption(format!("{}: parts of its variance, own and in all", name.0), ("sans-serif", 15))
                .margin(8)
                .x_label_area_size(30)
                .y_label_area_size(44)
                .build_cartesian_2d(0.0..end, 0.0..1.05)?;
            let label = |place: &f64| {
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "a place on the axis"
                )]
                let index = place.max(0.0) as usize;
                draws.get(index).filter(|_| place.fract() == 0.0).cloned().unwrap_or_default()
            };
            let mut mesh = chart.configure_mesh();
            mesh.disable_x_mesh()
                .light_line_style(WHITE)
                .x_labels(draws.len() + 1)
                .x_label_formatter(&label)
                .draw()?;
            for (values, left, colour) in [(&of.first, 0.15, BLUE), (&of.total, 0.5, VERMILLION)] {
                let bars = values.iter().enumerate().map(|(k, value)| {
                    #[expect(clippy::cast_precision_loss, reason = "a number of draws")]
                    let x = k as f64 + left;
                    Rectangle::new([(x, 0.0), (x + 0.33, value.clamp(0.0, 1.05))], colour.filled())
                });
                chart.draw_series(bars)?;
            }
        }
        Ok(())
    })
}
