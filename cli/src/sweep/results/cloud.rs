//! Histograms, and kept numbers over what varies, as small SVG: one path for all points or bars of a panel.

use crate::plot::axis::{Axis, Scale};
use std::fmt::Write as _;

/// Bars of a histogram.
const BARS: usize = 40;

/// Panels on either side, at most: of more the first ones.
const SIDE: usize = 7;

/// Width and height of a panel's inside, and what is left and below it for ticks and names.
const INSIDE: [f64; 2] = [150.0, 110.0];
const MARGINS: [f64; 2] = [62.0, 40.0];

/// Numbers of one name over all scenarios that are shown, with its unit.
pub(super) struct Column<'a> {
    pub(super) name: &'a (String, String),
    pub(super) values: Vec<f64>,
}

impl Column<'_> {
    fn axis(&self) -> Axis {
        let unit = if self.name.1 == "1" { "" } else { &self.name.1 };
        Axis::of(Scale::Linear, unit, self.values.iter())
    }
}

/// A panel with ticks and names on both axes; `marks` are in its own coordinates, from its lower left corner.
fn panel(svg: &mut String, [left, top]: [f64; 2], axes: [(&str, &Axis); 2], marks: &str) {
    let [width, height] = INSIDE;
    let bottom = top + height;
    let _ = write!(svg, "<path class=\"axes\" d=\"M{left} {top}V{bottom}h{width}\"/>");
    let _ = write!(svg, "<g transform=\"translate({left} {bottom}) scale(1 -1)\">{marks}</g>");
    let [(x_name, x), (y_name, y)] = axes;
    // Every second tick: numbers must not run into each other.
    for tick in x.ticks.iter().step_by(2) {
        let at = left + width * along(x, *tick);
        let _ = write!(svg, "<text x=\"{at:.0}\" y=\"{:.0}\">{}</text>", bottom + 12.0, x.label(*tick));
    }
    for tick in y.ticks.iter().step_by(2) {
        let at = bottom - height * along(y, *tick) + 3.0;
        let _ = write!(
            svg,
            "<text class=\"end\" x=\"{:.0}\" y=\"{at:.0}\">{}</text>",
            left - 4.0,
            y.label(*tick)
        );
    }
    let [x_title, y_title] =
        [(x_name, x), (y_name, y)].map(|(name, axis)| escaped(&format!("{name} {}", axis.unit)));
    let (middle, below) = (left + 0.5 * width, bottom + 26.0);
    let _ = write!(svg, "<text x=\"{middle:.0}\" y=\"{below:.0}\">{x_title}</text>");
    let (x, y) = (left - 48.0, top + 0.5 * height);
    let _ = write!(svg, "<text transform=\"translate({x:.0} {y:.0}) rotate(-90)\">{y_title}</text>");
}

/// Where a value is within the range of an axis.
fn place(axis: &Axis, value: f64) -> f64 {
    along(axis, axis.coordinate(value))
}

/// Where an axis' coordinate is within its range.
fn along(axis: &Axis, coordinate: f64) -> f64 {
    let (low, high) = axis.range;
    ((coordinate - low) / (high - low)).clamp(0.0, 1.0)
}

fn whole(n: [usize; 2], draw: impl FnOnce(&mut String)) -> String {
    #[expect(clippy::cast_precision_loss, reason = "a number of panels")]
    let [width, height] = [0, 1].map(|k| n[k] as f64 * (INSIDE[k] + MARGINS[k]) + 16.0);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"cloud\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 \
         {width} {height}\"><style>.cloud {{ color: #222; background: #fff; font: 10px sans-serif; }} .cloud text {{ fill: \
         currentColor; text-anchor: middle; }} .cloud .end {{ text-anchor: end; }} .cloud path {{ fill: none; stroke: \
         currentColor; }} .cloud .points {{ stroke: #3d8bd4; stroke-width: 2.4; stroke-linecap: round; opacity: 0.6; }} \
         .cloud .bars {{ fill: #3d8bd4; stroke: none; }} @media (prefers-color-scheme: dark) {{ .cloud {{ color: #ddd; \
         background: #181818; }} }}</style>"
    );
    draw(&mut svg);
    svg + "</svg>\n"
}

/// A corner of the panel in this row and column.
fn corner(row: usize, column: usize) -> [f64; 2] {
    #[expect(clippy::cast_precision_loss, reason = "a number of panels")]
    let [x, y] = [column as f64, row as f64];
    [x * (INSIDE[0] + MARGINS[0]) + MARGINS[0], y * (INSIDE[1] + MARGINS[1]) + 8.0]
}

/// How often each number is how large.
pub(super) fn histograms(columns: &[Column<'_>]) -> String {
    let n = columns.len().min(4);
    whole([n.max(1), columns.len().div_ceil(n.max(1))], |svg| {
        for (index, column) in columns.iter().enumerate() {
            let x = column.axis();
            let counts = counts(&x, &column.values);
            let y = Axis::of(Scale::Linear, "", [0.0].iter().chain(&counts));
            let mut path = String::new();
            #[expect(clippy::cast_precision_loss, reason = "a number of bars")]
            let width = INSIDE[0] / BARS as f64;
            for (bar, count) in counts.iter().enumerate().filter(|(_, count)| **count > 0.0) {
                #[expect(clippy::cast_precision_loss, reason = "a number of bars")]
                let left = bar as f64 * width;
                let [base, top] = [0.0, *count].map(|count| INSIDE[1] * place(&y, count));
                let _ = write!(path, "M{left:.2} {base:.1}h{width:.2}V{top:.1}h-{width:.2}z");
            }
            let marks = format!("<path class=\"bars\" d=\"{path}\"/>");
            panel(svg, corner(index / n, index % n), [(&column.name.0, &x), ("scenarios", &y)], &marks);
        }
    })
}

/// How many values each bar has.
fn counts(axis: &Axis, values: &[f64]) -> Vec<f64> {
    let mut counts = vec![0.0; BARS];
    for value in values.iter().filter(|value| value.is_finite()) {
        #[expect(
            clippy::cast_precision_loss,
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "few bars"
        )]
        let bar = (place(axis, *value) * BARS as f64) as usize;
        counts[bar.min(BARS - 1)] += 1.0;
    }
    counts
}

/// Each kept number over each thing that varies.
pub(super) fn scatter(targets: &[Column<'_>], numbers: &[Column<'_>]) -> String {
    let (targets, numbers) = (&targets[..targets.len().min(SIDE)], &numbers[..numbers.len().min(SIDE)]);
    whole([targets.len(), numbers.len()], |svg| {
        for (row, number) in numbers.iter().enumerate() {
            for (column, target) in targets.iter().enumerate() {
                let (x, y) = (target.axis(), number.axis());
                let pairs = target.values.iter().zip(&number.values);
                let mut path = String::new();
                for (a, b) in pairs.filter(|(a, b)| a.is_finite() && b.is_finite()) {
                    let [a, b] = [INSIDE[0] * place(&x, *a), INSIDE[1] * place(&y, *b)];
                    let _ = write!(path, "M{a:.0} {b:.0}h0");
                }
                let marks = format!("<path class=\"points\" d=\"{path}\"/>");
                panel(svg, corner(row, column), [(&target.name.0, &x), (&number.name.0, &y)], &marks);
            }
        }
    })
}

pub(super) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
