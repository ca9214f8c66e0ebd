//! Panels in rows and columns, as SVG.

use super::axis::{Axis, Scale};
use super::decimate;
use plotters::coord::Shift;
use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint, Ranged};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// A plot file.
#[derive(Debug)]
pub(crate) struct Page {
    pub(crate) title: String,
    /// Rows of panels.
    pub(crate) rows: Vec<Vec<Panel>>,
}

/// Some quantities of one unit over time.
#[derive(Debug)]
pub(crate) struct Panel {
    pub(crate) title: String,
    /// Empty for a pure number.
    pub(crate) unit: &'static str,
    pub(crate) scale: Scale,
    pub(crate) times: Vec<f64>,
    pub(crate) series: Vec<Series>,
}

/// One quantity; named only among several.
#[derive(Debug)]
pub(crate) struct Series {
    pub(crate) name: &'static str,
    pub(crate) values: Vec<f64>,
}

/// Okabe and Ito's colours, told apart by most people.
const COLOURS: [RGBColor; 4] =
    [RGBColor(0, 114, 178), RGBColor(213, 94, 0), RGBColor(0, 158, 115), RGBColor(204, 121, 167)];

/// Plotters places points on whole pixels: it draws larger, and the picture is shown smaller.
const FINE: u32 = 8;

const PANEL_WIDTH: u32 = 560 * FINE;
const PANEL_HEIGHT: u32 = 260 * FINE;
const TITLE_HEIGHT: u32 = 40 * FINE;

/// Draws a page.
pub(crate) fn svg(page: &Page) -> Result<String, String> {
    let mut text = String::new();
    let n_columns = page.rows.iter().map(Vec::len).max().unwrap_or(1) as u32;
    // A single column is drawn wider.
    let width = if n_columns == 1 { PANEL_WIDTH * 3 / 2 } else { PANEL_WIDTH * n_columns };
    let height = TITLE_HEIGHT + PANEL_HEIGHT * page.rows.len() as u32;
    draw(page, SVGBackend::with_string(&mut text, (width, height)).into_drawing_area())
        .map_err(|e| format!("the plot `{}` cannot be drawn: {e}", page.title))?;
    let size = |fine: u32| format!("width=\"{}\" height=\"{}\"", width / fine, height / fine);
    Ok(text.replacen(&size(1), &size(FINE), 1))
}

/// An axis with its own ticks, for plotters.
struct Ticked<'a>(&'a Axis);

impl Ranged for Ticked<'_> {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        let (low, high) = self.0.range;
        let part = (value - low) / (high - low);
        #[expect(clippy::cast_possible_truncation, reason = "a pixel of the panel")]
        let pixel = (f64::from(limit.0) + part * f64::from(limit.1 - limit.0)).round() as i32;
        pixel
    }

    fn key_points<Hint: KeyPointHint>(&self, _: Hint) -> Vec<f64> {
        self.0.ticks.clone()
    }

    fn range(&self) -> std::ops::Range<f64> {
        self.0.range.0..self.0.range.1
    }
}

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Outcome = Result<(), Box<dyn std::error::Error>>;

fn draw(page: &Page, area: Area<'_>) -> Outcome {
    area.fill(&WHITE).map_err(|e| e.to_string())?;
    let (title, rest) = area.split_vertically(TITLE_HEIGHT);
    let at = (pixels(16), pixels(14));
    title.draw(&Text::new(page.title.clone(), at, font(20).color(&BLACK))).map_err(|e| e.to_string())?;
    for (row, panels) in rest.split_evenly((page.rows.len(), 1)).iter().zip(&page.rows) {
        for (area, panel) in row.split_evenly((1, panels.len())).iter().zip(panels) {
            draw_panel(panel, area)?;
        }
    }
    area.present().map_err(|e| e.to_string().into())
}

fn draw_panel(panel: &Panel, area: &Area<'_>) -> Outcome {
    let values = panel.series.iter().flat_map(|s| &s.values);
    let (time, axis) =
        (Axis::time(panel.times.last().copied().unwrap_or(1.0)), Axis::of(panel.scale, panel.unit, values));
    let mut chart = ChartBuilder::on(area)
        .margin(pixels(8))
        .margin_top(pixels(34))
        .margin_right(pixels(24))
        .x_label_area_size(pixels(38))
        .y_label_area_size(pixels(64))
        .build_cartesian_2d(Ticked(&time), Ticked(&axis))?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(BLACK.mix(0.12).stroke_width(FINE))
        .axis_style(BLACK.mix(0.5).stroke_width(FINE))
        .set_all_tick_mark_size(pixels(4))
        .label_style(font(13))
        .x_desc(format!("t {}", time.unit))
        .x_label_formatter(&|t| time.label(*t))
        .y_label_formatter(&|v| axis.label(*v))
        .draw()?;
    for (series, colour) in panel.series.iter().zip(COLOURS.iter().cycle()) {
        let points = decimate::indices(&series.values).into_iter();
        let points: Vec<(f64, f64)> =
            points.map(|k| (time.coordinate(panel.times[k]), axis.coordinate(series.values[k]))).collect();
        chart.draw_series([PathElement::new(points, colour.stroke_width(FINE * 5 / 4))])?;
    }
    draw_title(&format!("{} {}", panel.title, axis.unit), panel, area)?;
    draw_legend(panel, area)
}

/// The title in the middle above the panel; where a legend needs the room, at its left end.
fn draw_title(title: &str, panel: &Panel, area: &Area<'_>) -> Outcome {
    let (x, anchor) = if panel.series.iter().all(|series| series.name.is_empty()) {
        ((area.dim_in_pixel().0 / 2) as i32 + pixels(20), HPos::Center)
    } else {
        (pixels(72), HPos::Left)
    };
    let style = TextStyle::from(font(15)).pos(Pos::new(anchor, VPos::Top));
    area.draw(&Text::new(title.to_owned(), (x, pixels(11)), style)).map_err(|e| e.to_string().into())
}

/// The names of several series, each in its colour, from the right end of the title's line.
fn draw_legend(panel: &Panel, area: &Area<'_>) -> Outcome {
    let width = |name: &str| 8 * name.chars().count() as i32 + 30;
    let mut right = (area.dim_in_pixel().0 / FINE) as i32 - 16;
    let coloured: Vec<_> = panel.series.iter().zip(COLOURS.iter().cycle()).collect();
    for (series, colour) in coloured.into_iter().rev().filter(|(series, _)| !series.name.is_empty()) {
        right -= width(series.name);
        let (dash, text) = ([(right, 18), (right + 16, 18)], (pixels(right + 20), pixels(11)));
        let dash = dash.map(|(x, y)| (pixels(x), pixels(y)));
        area.draw(&PathElement::new(dash, colour.stroke_width(2 * FINE))).map_err(|e| e.to_string())?;
        area.draw(&Text::new(series.name, text, font(13))).map_err(|e| e.to_string())?;
    }
    Ok(())
}

fn pixels(shown: i32) -> i32 {
    shown * FINE as i32
}

fn font(size: i32) -> FontDesc<'static> {
    ("sans-serif", pixels(size)).into_font()
}
