//! The rows of a start and their derivatives, typed by hand.

use gyro_model::{CoordinateKind, Joint, JointEnd, JointKind, JointStart, Model, Start, Support};

pub(crate) type V3 = [f64; 3];

/// Rounding of some dozens of operations on numbers of order one.
pub(crate) const TOLERANCE: f64 = 1e-14;

pub(crate) fn dot(a: V3, b: V3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: V3, b: V3) -> V3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(crate) fn unit(a: V3) -> V3 {
    a.map(|x| x / dot(a, a).sqrt())
}

/// Position, Euler parameters, velocity and w' of one body.
#[derive(Clone, Copy)]
pub(crate) struct State {
    r: V3,
    p: [f64; 4],
    s: V3,
    w: V3,
}

impl State {
    /// A(p) v, paper eq. (3).
    pub(crate) fn to_global(self, v: V3) -> V3 {
        let [e0, e1, e2, e3] = self.p;
        [
            2.0 * ((e0 * e0 + e1 * e1 - 0.5) * v[0]
                + (e1 * e2 - e0 * e3) * v[1]
                + (e1 * e3 + e0 * e2) * v[2]),
            2.0 * ((e1 * e2 + e0 * e3) * v[0]
                + (e0 * e0 + e2 * e2 - 0.5) * v[1]
                + (e2 * e3 - e0 * e1) * v[2]),
            2.0 * ((e1 * e3 - e0 * e2) * v[0]
                + (e2 * e3 + e0 * e1) * v[1]
                + (e0 * e0 + e3 * e3 - 0.5) * v[2]),
        ]
    }

    /// A body-fixed direction in the global frame, and its derivative.
    pub(crate) fn direction(self, v: V3) -> [V3; 2] {
        [self.to_global(v), self.to_global(cross(self.w, v))]
    }
}

/// The state of every body, folded ones included.
pub(crate) fn states(model: &Model, start: &Start) -> Vec<State> {
    let moving_bodies = model.coordinate_bodies();
    let of = |body: usize| match moving_bodies.iter().position(|&b| b == body) {
        Some(moving_body) => {
            let (q, v) = (
                &start.q[7 * moving_body..7 * moving_body + 7],
                &start.v[6 * moving_body..6 * moving_body + 6],
            );
            State {
                r: [q[0], q[1], q[2]],
                p: [q[3], q[4], q[5], q[6]],
                s: [v[0], v[1], v[2]],
                w: [v[3], v[4], v[5]],
            }
        }
        None => placed(model, body),
    };
    (0..model.bodies.len()).map(of).collect()
}

/// A fixed body where the model file puts it.
pub(crate) fn placed(model: &Model, body: usize) -> State {
    let p = model.values(&model.bodies[body].orientation);
    let norm = p.iter().map(|x| x * x).sum::<f64>().sqrt();
    State { r: model.values(&model.bodies[body].position), p: p.map(|x| x / norm), s: [0.0; 3], w: [0.0; 3] }
}

/// The unit joint frame (f, g, h) of an end.
pub(crate) fn frame(model: &Model, end: &JointEnd) -> [V3; 3] {
    let h = unit(model.values(&end.axis));
    let g = unit(cross(h, unit(model.values(&end.zero))));
    [cross(g, h), g, h]
}

/// All rows at position level and their derivatives.
pub(crate) fn residuals(model: &Model, start: &Start) -> [Vec<f64>; 2] {
    let states = states(model, start);
    let (mut phi, mut rate) = (Vec::new(), Vec::new());
    for (index, body) in model.bodies.iter().enumerate() {
        if body.support == Support::Constrained {
            let (fixed, state) = (placed(model, index), states[index]);
            let ([a, b, c, d], [w, x, y, z]) = (fixed.p, state.p);
            phi.extend((0..3).map(|k| state.r[k] - fixed.r[k]));
            phi.extend([
                a * x - b * w - c * z + d * y,
                a * y + b * z - c * w - d * x,
                a * z - b * y + c * x - d * w,
            ]);
            rate.extend(state.s.into_iter().chain(state.w));
        }
    }
    for joint in &model.joints {
        for [value, derivative] in joint_rows(model, joint, &states) {
            phi.push(value);
            rate.push(derivative);
        }
    }
    [phi, rate]
}

/// A scalar product and its derivative.
pub(crate) fn product([a, da]: [V3; 2], [b, db]: [V3; 2]) -> [f64; 2] {
    [dot(a, b), dot(da, b) + dot(a, db)]
}

/// A joint's two frames and the vector between its points, each with its derivative.
pub(crate) fn posed(model: &Model, joint: &Joint, states: &[State]) -> ([[V3; 2]; 3], [[V3; 2]; 3], [V3; 2]) {
    let (i, j) = (states[joint.first.body], states[joint.second.body]);
    let [first, second] = [(&joint.first, i), (&joint.second, j)]
        .map(|(end, state)| frame(model, end).map(|v| state.direction(v)));
    let ([ai, dai], [aj, daj]) =
        (i.direction(model.values(&joint.first.point)), j.direction(model.values(&joint.second.point)));
    let d = std::array::from_fn(|k| j.r[k] + aj[k] - i.r[k] - ai[k]);
    let rate = std::array::from_fn(|k| j.s[k] + daj[k] - i.s[k] - dai[k]);
    (first, second, [d, rate])
}

/// Rows and their derivatives, from their definition in the format's description.
pub(crate) fn joint_rows(model: &Model, joint: &Joint, states: &[State]) -> Vec<[f64; 2]> {
    let ([fi, gi, hi], [fj, gj, hj], d) = posed(model, joint, states);
    let point: Vec<[f64; 2]> = (0..3).map(|k| [d[0][k], d[1][k]]).collect();
    let parallel = vec![product(fi, hj), product(gi, hj)];
    let on_axis = vec![product(fi, d), product(gi, d)];
    match joint.kind {
        JointKind::Revolute => [point, parallel].concat(),
        JointKind::Spherical => point,
        JointKind::Fixed => [point, parallel, vec![product(fi, gj)]].concat(),
        JointKind::Universal => [point, vec![product(hi, hj)]].concat(),
        JointKind::Cylindrical => [on_axis, parallel].concat(),
        JointKind::Prismatic => [on_axis, parallel, vec![product(fi, gj)]].concat(),
        JointKind::Planar => [vec![product(hi, d)], parallel].concat(),
        JointKind::Screw => {
            let lead = model.value(&joint.lead);
            let ([sine, ds], [cosine, dc]) = (product(gi, fj), product(fi, fj));
            let [advance, rate] = product(hi, d);
            // Known up to a multiple of the pitch.
            let turns = (advance / lead - sine.atan2(cosine)) / std::f64::consts::TAU;
            let left = lead * (turns - turns.round()) * std::f64::consts::TAU;
            let turning = (cosine * ds - sine * dc) / (sine * sine + cosine * cosine);
            [on_axis, vec![[left, rate - lead * turning]], parallel].concat()
        }
        JointKind::PointOnLine => on_axis,
        JointKind::Rod => {
            let length = model.value(&joint.length);
            let [square, rate] = product(d, d);
            vec![[0.5 * (square / length - length), 0.5 * rate / length]]
        }
    }
}

pub(crate) fn worst(numbers: &[f64]) -> f64 {
    numbers.iter().fold(0.0, |worst, x| if x.abs() > worst || x.is_nan() { x.abs() } else { worst })
}

/// Rows, unit lengths and joint coordinates of a start.
pub(crate) fn check(model: &Model, start: &Start, tolerance: f64) {
    let [phi, rate] = residuals(model, start);
    assert_eq!(phi.len(), model.all_rows().len());
    assert!(worst(&phi) <= tolerance, "rows {phi:?}");
    assert!(worst(&rate) <= tolerance, "velocity rows {rate:?}");
    let states = states(model, start);
    for state in &states {
        assert!((state.p.iter().map(|x| x * x).sum::<f64>() - 1.0).abs() <= 1e-15);
    }
    for (joint, own) in model.joints.iter().zip(&start.joints) {
        check_coordinates(model, joint, own, &states, tolerance);
    }
}

/// A joint's coordinates and their rates, from their definition.
pub(crate) fn check_coordinates(
    model: &Model,
    joint: &Joint,
    own: &JointStart,
    states: &[State],
    tolerance: f64,
) {
    let ([fi, gi, hi], [fj, gj, hj], d) = posed(model, joint, states);
    let (i, j) = (states[joint.first.body], states[joint.second.body]);
    let relative: V3 = std::array::from_fn(|k| j.to_global(j.w)[k] - i.to_global(i.w)[k]);
    if joint.kind == JointKind::Spherical {
        let rate = j.to_global([own.rate[0], own.rate[1], own.rate[2]]);
        assert!((0..3).all(|k| (relative[k] - rate[k]).abs() <= tolerance), "rate");
        let dot: f64 = i.p.iter().zip(j.p).map(|(a, b)| a * b).sum();
        assert!((dot - own.position[0]).abs() <= tolerance, "Euler parameters");
        return;
    }
    let kinds = joint.kind.coordinates();
    assert_eq!([own.position.len(), own.rate.len()], [kinds.len(); 2], "{:?}", joint.kind);
    for (kind, (&position, &rate)) in kinds.iter().zip(own.position.iter().zip(&own.rate)) {
        let angle =
            |sine: f64, cosine: f64, turning: f64| [(0.5 * (sine.atan2(cosine) - position)).sin(), turning];
        let [excess, turning] = match kind {
            CoordinateKind::Angle => angle(dot(gi[0], fj[0]), dot(fi[0], fj[0]), dot(relative, hj[0])),
            CoordinateKind::FirstAngle => angle(dot(gi[0], hj[0]), dot(fi[0], hj[0]), dot(relative, hi[0])),
            CoordinateKind::SecondAngle => angle(-dot(hi[0], gj[0]), dot(hi[0], fj[0]), dot(relative, hj[0])),
            CoordinateKind::Displacement => [product(hi, d)[0] - position, product(hi, d)[1]],
            CoordinateKind::X => [product(fi, d)[0] - position, product(fi, d)[1]],
            CoordinateKind::Y => [product(gi, d)[0] - position, product(gi, d)[1]],
        };
        assert!(excess.abs() <= tolerance, "{kind:?} off by {excess}");
        let rounding = tolerance * rate.abs().max(1.0);
        assert!((turning - rate).abs() <= rounding, "rate of {kind:?}: {turning} {rate}");
    }
}
