//! The skeleton of a mechanism at its start: joints as points, bodies as lines from their mass centres to them.

use gyro_model::{JointKind, Model, Quaternion, Start, Vector};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// A picture of ours, which may be written anew.
pub(super) const MARK: &str = "<!-- A sketch by gyro check. -->";

/// Width of the picture, and its margin, in the pixels that plotters draws on: as shown, an eighth of that.
const WIDTH: i32 = 720 * FINE;
const MARGIN: i32 = 90 * FINE;
const FINE: i32 = 8;

/// A flat mechanism is seen from its normal: where its depth is at most so much of its width.
const FLAT: f64 = 0.05;

/// Draws it.
pub(super) fn svg(model: &Model, start: &Start) -> Result<String, String> {
    let places = places(model, start);
    let ends: Vec<[Vector; 2]> = model
        .joints
        .iter()
        .map(|joint| {
            [&joint.first, &joint.second].map(|end| {
                let (r, p) = &places[end.body];
                r + p.rotate(Vector::from(model.values(&end.point)))
            })
        })
        .collect();
    let centres = places.iter().map(|(r, _)| *r);
    let view = View::of(model, &centres.chain(ends.iter().flatten().copied()).collect::<Vec<_>>());
    let mut text = String::new();
    let size = (WIDTH.unsigned_abs(), view.height.unsigned_abs());
    draw(model, &places, &ends, &view, SVGBackend::with_string(&mut text, size).into_drawing_area())
        .map_err(|error| format!("the sketch cannot be drawn: {error}"))?;
    let attributes = |fine: i32| format!("width=\"{}\" height=\"{}\"", WIDTH / fine, view.height / fine);
    Ok(format!("{MARK}\n{}", text.replacen(&attributes(1), &attributes(FINE), 1)))
}

/// Positions of mass centres and orientations of all bodies at the start.
fn places(model: &Model, start: &Start) -> Vec<(Vector, Quaternion)> {
    let moving = model.coordinate_bodies();
    let of = |(index, body): (usize, &gyro_model::Body)| {
        if let Some(place) = moving.iter().position(|&other| other == index) {
            let q = &start.q[7 * place..7 * place + 7];
            return (Vector::new(q[0], q[1], q[2]), Quaternion([q[3], q[4], q[5], q[6]]));
        }
        if let Some(motion) = &body.motion {
            let state = motion.state(model, body, 0.0);
            return (state.r, state.p);
        }
        let orientation = Quaternion::unit(&body.orientation.each_ref().map(|e| model.exact(e)));
        (Vector::from(model.values(&body.position)), orientation.unwrap_or(Quaternion::IDENTITY))
    };
    model.bodies.iter().enumerate().map(of).collect()
}

/// A parallel projection onto the picture.
struct View {
    right: Vector,
    up: Vector,
    /// The point in the lower left corner within the margin, and pixels a metre.
    low: [f64; 2],
    scale: f64,
    height: i32,
}

impl View {
    /// Up is against gravity; a flat mechanism is seen from its normal, any other from a corner.
    fn of(model: &Model, points: &[Vector]) -> Self {
        let gravity = Vector::from(model.values(&model.gravity));
        let above = if gravity.norm() > 0.0 { -gravity.normalize() } else { Vector::z() };
        let spread = [0, 1, 2].map(|k| {
            let along = || points.iter().map(|point| point[k]);
            along().fold(f64::MIN, f64::max) - along().fold(f64::MAX, f64::min)
        });
        let largest = spread.iter().copied().fold(0.0, f64::max);
        let flat = (0..3).filter(|&k| spread[k] <= FLAT * largest && above[k].abs() < 0.5);
        let mut normals = flat.map(|k| [Vector::x(), -Vector::y(), Vector::z()][k]);
        let aside =
            if above.z.abs() > 0.5 { Vector::new(0.5, -0.8, 0.0) } else { Vector::new(0.5, 0.3, 0.8) };
        let from = normals.next_back().unwrap_or_else(|| (aside + above * 0.4).normalize());
        let right = above.cross(&from).try_normalize(1e-9).unwrap_or_else(Vector::x);
        let up = from.cross(&right);
        let flat: Vec<[f64; 2]> = points.iter().map(|point| [right.dot(point), up.dot(point)]).collect();
        let end = |k: usize, of: fn(f64, f64) -> f64| flat.iter().map(|p| p[k]).reduce(of).unwrap_or(0.0);
        let low = [end(0, f64::min), end(1, f64::min)];
        let [wide, high] = [end(0, f64::max) - low[0], end(1, f64::max) - low[1]];
        let room = f64::from(WIDTH - 2 * MARGIN);
        let scale = room / wide.max(high).max(1e-9);
        let height = pixel(high * scale) + 2 * MARGIN;
        // What is higher than wide stands in the middle.
        let low = [low[0] - (room / scale - wide) / 2.0, low[1]];
        Self { right, up, low, scale, height }
    }

    fn at(&self, point: &Vector) -> (i32, i32) {
        let [x, y] = [self.right.dot(point) - self.low[0], self.up.dot(point) - self.low[1]];
        (MARGIN + pixel(x * self.scale), self.height - MARGIN - pixel(y * self.scale))
    }
}

#[expect(clippy::cast_possible_truncation, reason = "a pixel of the picture")]
fn pixel(x: f64) -> i32 {
    x.round() as i32
}

/// Okabe and Ito's colours, told apart by most people.
const COLOURS: [RGBColor; 6] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
];

type Area<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;
type Outcome = Result<(), Box<dyn std::error::Error>>;

fn draw(
    model: &Model,
    places: &[(Vector, Quaternion)],
    ends: &[[Vector; 2]],
    view: &View,
    area: Area<'_>,
) -> Outcome {
    let put = |outcome: Result<(), _>| -> Outcome {
        outcome
            .map_err(|error: DrawingAreaErrorKind<_>| Box::<dyn std::error::Error>::from(error.to_string()))
    };
    put(area.fill(&WHITE))?;
    let grey = RGBColor(110, 110, 110);
    let style = |size: i32, colour: RGBColor, across| {
        let font = ("sans-serif", size * FINE).into_font();
        font.color(&colour).pos(Pos::new(across, VPos::Center))
    };
    for (index, body) in model.bodies.iter().enumerate() {
        let has_coordinates = body.support.has_coordinates();
        let colour = if has_coordinates { COLOURS[index % COLOURS.len()] } else { grey };
        let centre = view.at(&places[index].0);
        for (joint, ends) in model.joints.iter().zip(ends) {
            for (end, point) in [&joint.first, &joint.second].into_iter().zip(ends) {
                if end.body == index {
                    let line = PathElement::new(
                        [centre, view.at(point)],
                        colour.stroke_width(4 * FINE.unsigned_abs()),
                    );
                    put(area.draw(&line))?;
                }
            }
        }
        let r = 5 * FINE;
        let (low, high) = ((centre.0 - r, centre.1 - r), (centre.0 + r, centre.1 + r));
        put(area.draw(&Rectangle::new([low, high], colour.filled())))?;
        let name = (centre.0 + 9 * FINE, centre.1 + 11 * FINE);
        put(area.draw(&Text::new(body.name.clone(), name, style(13, colour, HPos::Left))))?;
    }
    for (joint, [first, second]) in model.joints.iter().zip(ends) {
        let [from, to] = [view.at(first), view.at(second)];
        if joint.kind == JointKind::Rod || from != to {
            put(area.draw(&PathElement::new([from, to], BLACK.stroke_width(2 * FINE.unsigned_abs()))))?;
        }
        for at in [from, to] {
            put(area.draw(&Circle::new(at, 5 * FINE, WHITE.filled())))?;
            put(area.draw(&Circle::new(at, 5 * FINE, BLACK.stroke_width(2 * FINE.unsigned_abs()))))?;
        }
        let at = ((from.0 + to.0) / 2 - 9 * FINE, (from.1 + to.1) / 2 - 11 * FINE);
        put(area.draw(&Text::new(joint.name.clone(), at, style(12, BLACK, HPos::Right))))?;
    }
    put(area.present())
}
