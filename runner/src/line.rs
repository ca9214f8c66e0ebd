//! The distance of two points of bodies.

use gyro_sim::{Mechanism, Real};
use nanoserde::{DeBin, SerBin};

/// Two points of bodies.
#[derive(Clone, Copy, Debug, PartialEq, SerBin, DeBin)]
pub struct Line(pub [End; 2]);

/// A point of a body.
#[derive(Clone, Copy, Debug, PartialEq, SerBin, DeBin)]
pub struct End {
    /// The body's slot in the state; `None` of what rests.
    pub slot: Option<usize>,
    /// The point in the body's frame, of what rests in the global one, m.
    pub point: [f64; 3],
}

impl Line {
    /// The distance of both points and its rate.
    pub(crate) fn distance<M: Mechanism<Scalar: Real>>(&self, mechanism: &M, y: &[M::Scalar]) -> [f64; 2] {
        let n = mechanism.description().bodies.len();
        let numbers = |at: usize| -> [f64; 3] { std::array::from_fn(|k| y[at + k].to_f64()) };
        let end = |end: &End| {
            let Some(slot) = end.slot else { return [end.point, [0.0; 3]] };
            let (r, s, w) = (numbers(7 * slot), numbers(7 * n + 6 * slot), numbers(7 * n + 6 * slot + 3));
            let p: [f64; 4] = std::array::from_fn(|k| y[7 * slot + 3 + k].to_f64());
            let [arm, turning] = [end.point, cross(w, end.point)].map(|vector| rotated(p, vector));
            [plus(r, arm), plus(s, turning)]
        };
        let [[from, from_rate], [to, to_rate]] = self.0.each_ref().map(end);
        let [line, drift] = [minus(to, from), minus(to_rate, from_rate)];
        let distance = dot(line, line).sqrt();
        [distance, dot(line, drift) / distance]
    }
}

/// `v + 2 e0 (e × v) + 2 e × (e × v)`, of Euler parameters of unit length.
fn rotated([e0, e @ ..]: [f64; 4], v: [f64; 3]) -> [f64; 3] {
    let once = cross(e, v);
    let twice = cross(e, once);
    std::array::from_fn(|k| v[k] + 2.0 * (e0 * once[k] + twice[k]))
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn plus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| a[k] + b[k])
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| a[k] - b[k])
}
