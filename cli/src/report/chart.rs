//! Charts with panels side by side on logarithmic axes, as SVG written directly: points where they belong, text that
//! stays text.

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

/// What is drawn stays away so far from the border, in decades.
const BORDER: f64 = 0.04;

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
        // Whole decades where there are several, with nothing on the border; else what there is with a margin.
        if high - low > 1.5 {
            return Self { low: (low - BORDER).floor(), high: (high + BORDER).ceil() };
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

/// Where everything goes.
#[derive(Clone, Copy)]
struct Layout {
    n_columns: usize,
    n_rows: usize,
    plot: (f64, f64),
}

impl Layout {
    fn of(chart: &Chart) -> Self {
        let n_panels = chart.panels.len();
        let scale = if n_panels == 1 { LARGE } else { 1.0 };
        let n_columns = chart.n_columns.clamp(1, n_panels.max(1));
        let plot = (PLOT_WIDTH * scale, PLOT_HEIGHT * scale.sqrt());
        Self { n_columns, n_rows: n_panels.div_ceil(n_columns), plot }
    }

    fn panels_width(self) -> f64 {
        self.n_columns as f64 * (self.plot.0 + GAP)
    }

    fn cell_height(self) -> f64 {
        PANEL_TITLE + self.plot.1 + TICKS
    }

    /// Below the panels.
    fn below(self) -> f64 {
        TITLE + self.n_rows as f64 * self.cell_height()
    }

    /// Where a panel has its upper left corner.
    fn origin(self, index: usize) -> (f64, f64) {
        let (row, column) = (index / self.n_columns, index % self.n_columns);
        let top = TITLE + row as f64 * self.cell_height() + PANEL_TITLE;
        (LEFT + column as f64 * (self.plot.0 + GAP), top)
    }
}

/// SVG as it is written.
struct Canvas(String);

impl Canvas {
    fn new((width, height): (f64, f64)) -> Self {
        Self(format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.0}\" height=\"{height:.0}\" viewBox=\"0 0 {width:.0} {height:.0}\" \
             font-family=\"sans-serif\" font-size=\"12\" fill=\"#222\">\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n"
        ))
    }

    fn text(&mut self, (x, y): (f64, f64), attributes: &str, words: &str) {
        let _ = writeln!(self.0, "<text x=\"{x:.1}\" y=\"{y:.1}\"{attributes}>{}</text>", escaped(words));
    }
}

/// Attributes of text.
const BOLD: &str = " font-weight=\"bold\"";
const HEADING: &str = " font-size=\"15\" font-weight=\"bold\"";
const CENTRED: &str = " text-anchor=\"middle\"";
const TICK_BELOW: &str = " text-anchor=\"middle\" font-size=\"11\"";
const TICK_BESIDE: &str = " text-anchor=\"end\" font-size=\"11\"";

impl Chart {
    /// The SVG text.
    pub(crate) fn svg(&self) -> String {
        let layout = Layout::of(self);
        let entries = self.legend_rows(layout.panels_width());
        let legend = LABEL + entries.len() as f64 * LEGEND_ROW + 12.0;
        let mut canvas = Canvas::new((LEFT + layout.panels_width() + 8.0, layout.below() + legend));
        canvas.text((LEFT, 20.0), HEADING, &self.title);
        self.draw_panels(layout, &mut canvas);
        self.draw_labels(layout, &mut canvas);
        for (row, entries) in entries.iter().enumerate() {
            draw_legend(entries, layout.below() + LABEL + row as f64 * LEGEND_ROW + 12.0, &mut canvas);
        }
        canvas.0 + "</svg>\n"
    }

    fn draw_panels(&self, layout: Layout, canvas: &mut Canvas) {
        let points = || self.panels.iter().flat_map(|p| &p.lines).flat_map(|l| &l.points);
        let x = Decades::of(points().map(|p| p.0), self.x.limits);
        let y = Decades::of(points().map(|p| p.1), self.y.limits);
        for (index, panel) in self.panels.iter().enumerate() {
            let frame = Frame { x, y, origin: layout.origin(index), size: layout.plot };
            frame.draw_grid(canvas);
            if index % layout.n_columns == 0 {
                frame.label_y(canvas);
            }
            if index + layout.n_columns >= self.panels.len() {
                frame.label_x(canvas);
            }
            frame.draw(panel, canvas);
        }
    }

    /// Quantities and units of both axes.
    fn draw_labels(&self, layout: Layout, canvas: &mut Canvas) {
        let (middle, below) = (LEFT + 0.5 * (layout.panels_width() - GAP), layout.below());
        canvas.text((middle, below + 14.0), CENTRED, &self.x.label);
        let half = 0.5 * (TITLE + below);
        let turned = format!("{CENTRED} transform=\"rotate(-90 14 {half:.1})\"");
        canvas.text((14.0, half), &turned, &self.y.label);
    }

    /// The legend in rows that fit.
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

fn draw_legend(entries: &[&(String, Style)], y: f64, canvas: &mut Canvas) {
    let mut x = LEFT;
    for (name, style) in entries {
        style.draw_line(&[(x, y - 4.0), (x + 26.0, y - 4.0)], canvas);
        style.draw_markers(&[(x + 13.0, y - 4.0)], canvas);
        canvas.text((x + 32.0, y), "", name);
        x += entry_width(name);
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

    fn draw_grid(&self, canvas: &mut Canvas) {
        let ((left, top), (width, height)) = (self.origin, self.size);
        let across = self.x.ticks().into_iter().map(|(value, _)| self.at((value, 1.0)).0);
        let mut grid: String = across.map(|x| format!("M{x:.1} {top:.1}v{height:.1}")).collect();
        let along = self.y.ticks().into_iter().map(|(value, _)| self.at((1.0, value)).1);
        grid.extend(along.map(|y| format!("M{left:.1} {y:.1}h{width:.1}")));
        let _ = writeln!(canvas.0, "<path d=\"{grid}\" stroke=\"#e2e2e2\" fill=\"none\"/>");
        let border = format!("x=\"{left:.1}\" y=\"{top:.1}\" width=\"{width:.1}\" height=\"{height:.1}\"");
        let _ = writeln!(canvas.0, "<rect {border} fill=\"none\" stroke=\"#999\"/>");
    }

    fn label_x(&self, canvas: &mut Canvas) {
        for (value, text) in self.x.ticks() {
            let at = (self.at((value, 1.0)).0, self.origin.1 + self.size.1 + 15.0);
            canvas.text(at, TICK_BELOW, &text);
        }
    }

    fn label_y(&self, canvas: &mut Canvas) {
        for (value, text) in self.y.ticks() {
            canvas.text((self.origin.0 - 5.0, self.at((1.0, value)).1 + 4.0), TICK_BESIDE, &text);
        }
    }

    fn draw(&self, panel: &Panel, canvas: &mut Canvas) {
        let ((left, top), (width, height)) = (self.origin, self.size);
        canvas.text((left, top - 7.0), BOLD, &panel.title);
        let mut is_empty = true;
        for line in &panel.lines {
            for run in self.runs(&line.points) {
                is_empty = false;
                line.style.draw_line(&run, canvas);
                line.style.draw_markers(&run, canvas);
            }
        }
        if is_empty {
            canvas.text((left + 0.5 * width, top + 0.5 * height), CENTRED, "no run");
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
    fn draw_line(self, points: &[(f64, f64)], canvas: &mut Canvas) {
        let dash = match self.stroke {
            Stroke::None => return,
            Stroke::Solid => "",
            Stroke::Dashed => " stroke-dasharray=\"7 4\"",
            Stroke::Dotted => " stroke-dasharray=\"2 3\"",
        };
        if points.len() > 1 {
            let list: Vec<String> = points.iter().map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
            let (list, colour) = (list.join(" "), self.colour);
            let line = format!("points=\"{list}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.6\"");
            let _ = writeln!(canvas.0, "<polyline {line}{dash}/>");
        }
    }

    fn draw_markers(self, points: &[(f64, f64)], canvas: &mut Canvas) {
        const ROUND: &str = "a2.6 2.6 0 1 0 5.2 0a2.6 2.6 0 1 0 -5.2 0";
        let (fill, shape): (_, fn(f64, f64) -> String) = match self.marker {
            Marker::None => return,
            Marker::Disc => (self.colour, |x, y| format!("M{:.1} {y:.1}{ROUND}", x - 2.6)),
            Marker::Ring => ("#fff", |x, y| format!("M{:.1} {y:.1}{ROUND}", x - 2.6)),
            Marker::Cross => ("none", |x, y| format!("M{:.1} {:.1}l6 6m0 -6l-6 6", x - 3.0, y - 3.0)),
        };
        let path: String = points.iter().map(|(x, y)| shape(*x, *y)).collect();
        let colour = self.colour;
        let _ = writeln!(
            canvas.0,
            "<path d=\"{path}\" fill=\"{fill}\" stroke=\"{colour}\" stroke-width=\"1.3\"/>"
        );
    }
}

/// Text as it may stand in XML.
pub(crate) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests;
