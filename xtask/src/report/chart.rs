//! Charts with panels side by side on logarithmic axes, as SVG written directly: points where they belong, text that stays text.

use std::fmt::Write as _;

/// Panels that share their axes, and one legend below them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Chart {
    pub(crate) title: String,
    pub(crate) x: Axis,
    pub(crate) y: Axis,
    pub(crate) n_columns: usize,
    pub(crate) panels: Vec<Panel>,
    pub(crate) legend: Vec<(String, Style)>,
}

/// A logarithmic axis: quantity with its unit, and the range that is shown at most.
#[derive(Clone, Debug, Default)]
pub(crate) struct Axis {
    pub(crate) label: String,
    pub(crate) limits: (f64, f64),
}

#[derive(Clone, Debug, Default)]
pub(crate) struct Panel {
    pub(crate) title: String,
    pub(crate) lines: Vec<Line>,
}

/// Points, joined where the style says so.
#[derive(Clone, Debug)]
pub(crate) struct Line {
    pub(crate) points: Vec<(f64, f64)>,
    pub(crate) style: Style,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Style {
    pub(crate) colour: &'static str,
    pub(crate) stroke: Stroke,
    pub(crate) marker: Marker,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stroke {
    Solid,
    Dashed,
    Dotted,
    None,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Marker {
    Disc,
    Ring,
    Cross,
    None,
}

/// Okabe and Ito's colours, told apart by most people.
pub(crate) const BLUE: &str = "#0072b2";
pub(crate) const VERMILION: &str = "#d55e00";
pub(crate) const GREEN: &str = "#009e73";
pub(crate) const PURPLE: &str = "#cc79a7";
pub(crate) const SKY: &str = "#56b4e9";
pub(crate) const ORANGE: &str = "#e69f00";
pub(crate) const BLACK: &str = "#222222";
pub(crate) const GREY: &str = "#888888";

const PLOT_WIDTH: f64 = 300.0;
const PLOT_HEIGHT: f64 = 230.0;
/// One panel is drawn larger.
const LARGE: f64 = 1.75;
const LEFT: f64 = 62.0;
const GAP: f64 = 34.0;
const TITLE: f64 = 34.0;
const PANEL_TITLE: f64 = 24.0;
const TICKS: f64 = 22.0;
const LABEL: f64 = 24.0;
const LEGEND_ROW: f64 = 22.0;
const CHARACTER: f64 = 7.2;

/// A range in decades, and where values are on it.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Decades {
    low: f64,
    high: f64,
}

impl Decades {
    /// Of all values within limits.
    fn of(values: impl Iterator<Item = f64>, (least, most): (f64, f64)) -> Self {
        let shown = values.filter(|v| v.is_finite() && *v >= least && *v <= most).map(f64::log10);
        let (low, high) = shown.fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(v), h.max(v)));
        if low > high {
            return Self { low: 0.0, high: 1.0 };
        }
        // Whole decades where there are several, else what there is with a margin.
        if high - low > 1.5 {
            return Self { low: low.floor(), high: high.ceil() };
        }
        let margin = (0.08 * (high - low)).max(0.05);
        Self { low: low - margin, high: high + margin }
    }

    fn part(self, value: f64) -> f64 {
        (value.log10() - self.low) / (self.high - self.low)
    }

    /// Values with their texts. Decades, at most eight; on short axes 1, 2, 5 within them.
    fn ticks(self) -> Vec<(f64, String)> {
        if self.high - self.low >= 2.5 {
            let stride = ((self.high - self.low) / 8.0).ceil().max(1.0);
            let first = (self.low / stride).ceil() * stride;
            let n = ((self.high - first) / stride).floor() as usize + 1;
            let power = |k: usize| (first + k as f64 * stride) as i32;
            return (0..n).map(|k| (10f64.powi(power(k)), format!("1e{}", power(k)))).collect();
        }
        let mantissas: &[f64] = if self.high - self.low < 0.5 { &MANY } else { &FEW };
        let powers = self.low.floor() as i32..=self.high.ceil() as i32;
        let all = powers.flat_map(|p| mantissas.iter().map(move |m| m * 10f64.powi(p)));
        all.filter(|v| (-1e-9..=1.0 + 1e-9).contains(&self.part(*v)))
            .map(|v| (v, crate::words::number(v, 2)))
            .collect()
    }
}

const FEW: [f64; 3] = [1.0, 2.0, 5.0];
const MANY: [f64; 9] = [1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 6.0, 8.0];

impl Chart {
    /// The SVG text.
    pub(crate) fn svg(&self) -> String {
        let scale = if self.panels.len() == 1 { LARGE } else { 1.0 };
        let (plot_w, plot_h) = (PLOT_WIDTH * scale, PLOT_HEIGHT * scale.sqrt());
        let n_columns = self.n_columns.clamp(1, self.panels.len().max(1));
        let n_rows = self.panels.len().div_ceil(n_columns);
        let cell_h = PANEL_TITLE + plot_h + TICKS;
        let width = LEFT + n_columns as f64 * (plot_w + GAP) + 8.0;
        let entries = self.legend_rows(width - LEFT);
        let height = TITLE + n_rows as f64 * cell_h + LABEL + entries.len() as f64 * LEGEND_ROW + 12.0;
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.0}\" height=\"{height:.0}\" viewBox=\"0 0 {width:.0} {height:.0}\" \
             font-family=\"sans-serif\" font-size=\"12\" fill=\"#222\">\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n"
        );
        let _ = writeln!(
            svg,
            "<text x=\"{LEFT}\" y=\"20\" font-size=\"15\" font-weight=\"bold\">{}</text>",
            escaped(&self.title)
        );
        let points = || self.panels.iter().flat_map(|p| &p.lines).flat_map(|l| &l.points);
        let x = Decades::of(points().map(|p| p.0), self.x.limits);
        let y = Decades::of(points().map(|p| p.1), self.y.limits);
        for (index, panel) in self.panels.iter().enumerate() {
            let (row, column) = (index / n_columns, index % n_columns);
            let origin = (LEFT + column as f64 * (plot_w + GAP), TITLE + row as f64 * cell_h + PANEL_TITLE);
            let frame = Frame { x, y, origin, size: (plot_w, plot_h) };
            let is_lowest = index + n_columns >= self.panels.len();
            frame.draw(panel, (column == 0, is_lowest), &mut svg);
        }
        let middle = LEFT + 0.5 * n_columns as f64 * (plot_w + GAP);
        let below = TITLE + n_rows as f64 * cell_h;
        let _ = writeln!(
            svg,
            "<text x=\"{middle:.0}\" y=\"{:.0}\" text-anchor=\"middle\">{}</text>",
            below + 14.0,
            escaped(&self.x.label)
        );
        let half = TITLE + 0.5 * n_rows as f64 * cell_h;
        let _ = writeln!(
            svg,
            "<text x=\"14\" y=\"{half:.0}\" text-anchor=\"middle\" transform=\"rotate(-90 14 {half:.0})\">{}</text>",
            escaped(&self.y.label)
        );
        for (row, entries) in entries.iter().enumerate() {
            let y = below + LABEL + row as f64 * LEGEND_ROW + 12.0;
            let mut x = LEFT;
            for (name, style) in entries {
                style.draw(&[(x, y - 4.0), (x + 13.0, y - 4.0), (x + 26.0, y - 4.0)], &mut svg);
                let _ = writeln!(svg, "<text x=\"{:.0}\" y=\"{y:.0}\">{}</text>", x + 32.0, escaped(name));
                x += entry_width(name);
            }
        }
        svg + "</svg>\n"
    }

    fn legend_rows(&self, width: f64) -> Vec<Vec<&(String, Style)>> {
        let mut rows: Vec<Vec<&(String, Style)>> = Vec::new();
        let mut left = 0.0;
        for entry in &self.legend {
            let wide = entry_width(&entry.0);
            if rows.is_empty() || wide > left {
                rows.push(Vec::new());
                left = width;
            }
            left -= wide;
            if let Some(row) = rows.last_mut() {
                row.push(entry);
            }
        }
        rows
    }
}

fn entry_width(name: &str) -> f64 {
    46.0 + CHARACTER * name.chars().count() as f64
}

/// Where a panel is.
struct Frame {
    x: Decades,
    y: Decades,
    origin: (f64, f64),
    size: (f64, f64),
}

impl Frame {
    fn at(&self, (x, y): (f64, f64)) -> (f64, f64) {
        (self.origin.0 + self.x.part(x) * self.size.0, self.origin.1 + (1.0 - self.y.part(y)) * self.size.1)
    }

    fn draw(&self, panel: &Panel, (has_y_labels, has_x_labels): (bool, bool), svg: &mut String) {
        let ((left, top), (width, height)) = (self.origin, self.size);
        let _ = writeln!(
            svg,
            "<text x=\"{left:.0}\" y=\"{:.0}\" font-weight=\"bold\">{}</text>",
            top - 7.0,
            escaped(&panel.title)
        );
        let mut grid = String::new();
        for (value, text) in self.x.ticks() {
            let (x, _) = self.at((value, 1.0));
            let _ = write!(grid, "M{x:.1} {top:.1}v{height:.1}");
            if has_x_labels {
                let _ = writeln!(
                    svg,
                    "<text x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\" font-size=\"11\">{text}</text>",
                    top + height + 15.0
                );
            }
        }
        for (value, text) in self.y.ticks() {
            let (_, y) = self.at((1.0, value));
            let _ = write!(grid, "M{left:.1} {y:.1}h{width:.1}");
            if has_y_labels {
                let _ = writeln!(
                    svg,
                    "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\" font-size=\"11\">{text}</text>",
                    left - 5.0,
                    y + 4.0
                );
            }
        }
        let _ = writeln!(svg, "<path d=\"{grid}\" stroke=\"#e2e2e2\" fill=\"none\"/>");
        let _ = writeln!(
            svg,
            "<rect x=\"{left:.1}\" y=\"{top:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" fill=\"none\" stroke=\"#999\"/>"
        );
        for line in &panel.lines {
            for run in self.runs(&line.points) {
                line.style.draw(&run, svg);
            }
        }
        if panel.lines.iter().all(|line| self.runs(&line.points).is_empty()) {
            let _ = writeln!(
                svg,
                "<text x=\"{:.0}\" y=\"{:.0}\" text-anchor=\"middle\" fill=\"#888\">no run</text>",
                left + 0.5 * width,
                top + 0.5 * height
            );
        }
    }

    /// What of a line is inside, in pieces; a line is cut where it leaves.
    fn runs(&self, points: &[(f64, f64)]) -> Vec<Vec<(f64, f64)>> {
        let is_inside = |&(x, y): &(f64, f64)| {
            let inside = |part: f64| (-1e-9..=1.0 + 1e-9).contains(&part);
            inside(self.x.part(x)) && inside(self.y.part(y))
        };
        points
            .split(|point| !is_inside(point))
            .filter(|run| !run.is_empty())
            .map(|run| run.iter().map(|point| self.at(*point)).collect())
            .collect()
    }
}

impl Style {
    fn draw(self, points: &[(f64, f64)], svg: &mut String) {
        let Style { colour, stroke, marker } = self;
        let dash = match stroke {
            Stroke::Solid | Stroke::None => "",
            Stroke::Dashed => " stroke-dasharray=\"7 4\"",
            Stroke::Dotted => " stroke-dasharray=\"2 3\"",
        };
        if stroke != Stroke::None && points.len() > 1 {
            let list: Vec<String> = points.iter().map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
            let _ = writeln!(
                svg,
                "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.6\"{dash}/>",
                list.join(" ")
            );
        }
        // In the legend the marker stands in the middle.
        let marked = if points.len() == 3 && points[0].1 == points[2].1 && points[0].0 + 26.0 == points[2].0 {
            &points[1..2]
        } else {
            points
        };
        let shape = |(x, y): &(f64, f64)| match marker {
            Marker::Disc | Marker::Ring => {
                format!("M{:.1} {y:.1}a2.6 2.6 0 1 0 5.2 0a2.6 2.6 0 1 0 -5.2 0", x - 2.6)
            }
            Marker::Cross => format!("M{:.1} {:.1}l6 6m0 -6l-6 6", x - 3.0, y - 3.0),
            Marker::None => String::new(),
        };
        if marker != Marker::None {
            let path: String = marked.iter().map(shape).collect();
            let fill = match marker {
                Marker::Disc => colour,
                Marker::Ring => "#fff",
                _ => "none",
            };
            let _ = writeln!(
                svg,
                "<path d=\"{path}\" fill=\"{fill}\" stroke=\"{colour}\" stroke-width=\"1.3\"/>"
            );
        }
    }
}

/// Text as it may stand in XML.
pub(crate) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_axes_have_decades_and_short_ones_round_numbers() {
        let texts = |values: &[f64]| {
            let decades = Decades::of(values.iter().copied(), (1e-16, 1e16));
            decades.ticks().into_iter().map(|(_, text)| text).collect::<Vec<_>>()
        };
        assert_eq!(texts(&[2e-12, 3e-9]), ["1e-12", "1e-11", "1e-10", "1e-9", "1e-8"]);
        assert_eq!(texts(&[1.0, 40.0]), ["1", "2", "5", "10", "20", "50", "100"]);
        assert_eq!(texts(&[]).len(), 4);
    }

    #[test]
    fn what_is_outside_the_limits_is_not_drawn() {
        let line = Line {
            points: vec![(1.0, 1e-3), (10.0, 1e-5), (100.0, 1e40), (1e3, 1e-6)],
            style: Style { colour: BLUE, stroke: Stroke::Solid, marker: Marker::Disc },
        };
        let chart = Chart {
            x: Axis { label: "x".into(), limits: (0.1, 1e4) },
            y: Axis { label: "a < b".into(), limits: (1e-16, 1e2) },
            n_columns: 1,
            panels: vec![Panel { title: "p".into(), lines: vec![line] }],
            ..Chart::default()
        };
        let svg = chart.svg();
        assert!(roxmltree::Document::parse(&svg).is_ok(), "{svg}");
        // Two points before the gap are joined, the one behind it stands alone.
        assert_eq!(svg.matches("<polyline").count(), 1);
        assert!(svg.contains("a &lt; b") && !svg.contains("NaN") && !svg.contains("inf"), "{svg}");
    }
}
