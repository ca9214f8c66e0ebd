//! The arm of an excavator on its cylinders, against the same equations of three absolute angles and six pressures.

use crate::laws::{example, joint, step};
use crate::states::{integrated, output};
use std::array::from_fn;

/// Of boom, stick and bucket: mass, inertia about the mass centre, and the distances along each from its first joint to
/// its mass centre and to the next joint.
const LINKS: [[f64; 4]; 3] = [[1400.0, 3200.0, 2.6, 5.4], [650.0, 520.0, 0.9, 2.5], [900.0, 210.0, 0.6, 0.0]];

/// A cylinder from a point of a body to one of the next, each from that body's first joint: the carriage has none, and
/// its point is meant from the boom's.
struct Ram {
    body: usize,
    points: [[f64; 2]; 2],
    closed: f64,
    stroke: f64,
    areas: [f64; 2],
    hoses: f64,
    opening: fn(f64) -> f64,
}

fn rise(t: f64, from: f64, to: f64) -> f64 {
    step(t, [from, 0.0], [to, 1.0])
}

const RAMS: [Ram; 3] = [
    Ram {
        body: 0,
        points: [[0.6, -0.5], [2.4, -0.25]],
        closed: 1.55,
        stroke: 1.3,
        areas: [0.0226, 0.0148],
        hoses: 4e4,
        opening: |t| 0.2 * (1.0 - rise(t, 2.0, 3.0)),
    },
    Ram {
        body: 1,
        points: [[3.1, 0.55], [-0.5, 0.35]],
        closed: 1.5,
        stroke: 1.4,
        areas: [0.0154, 0.0098],
        hoses: 3e4,
        opening: |t| -0.2 * (rise(t, 0.5, 1.0) - rise(t, 2.5, 3.5)),
    },
    Ram {
        body: 2,
        points: [[0.3, 0.4], [-0.15, 0.45]],
        closed: 1.5,
        stroke: 1.3,
        areas: [0.0113, 0.0066],
        hoses: 2e4,
        opening: |t| 0.05 * (rise(t, 1.0, 1.5) - rise(t, 2.5, 3.5)),
    },
];

/// A point of a body by what it is along and across it, and how the point moves with each angle; the carriage is body
/// "−1", which does not turn.
fn point(body: Option<usize>, [along, across]: [f64; 2], angles: [f64; 3]) -> ([f64; 2], [[f64; 2]; 3]) {
    let (mut place, mut moves) = ([0.0; 2], [[0.0; 2]; 3]);
    let Some(body) = body else { return ([along, across], moves) };
    for k in 0..=body {
        let (sin, cos) = angles[k].sin_cos();
        let [x, z] = if k < body { [LINKS[k][3], 0.0] } else { [along, across] };
        let offset = [x * cos - z * sin, x * sin + z * cos];
        place = [place[0] + offset[0], place[1] + offset[1]];
        moves[k] = [-offset[1], offset[0]];
    }
    (place, moves)
}

/// The length of a cylinder and its slopes by the angles.
fn length(ram: &Ram, angles: [f64; 3]) -> (f64, [f64; 3]) {
    let (from, from_moves) = point(ram.body.checked_sub(1), ram.points[0], angles);
    let (to, to_moves) = point(Some(ram.body), ram.points[1], angles);
    let [x, z] = [to[0] - from[0], to[1] - from[1]];
    let length = x.hypot(z);
    let slope = |k: usize| {
        (x * (to_moves[k][0] - from_moves[k][0]) + z * (to_moves[k][1] - from_moves[k][1])) / length
    };
    (length, from_fn(slope))
}

/// Solves for three unknowns by Cramer's rule.
fn solved(m: [[f64; 3]; 3], b: [f64; 3]) -> [f64; 3] {
    let det = |m: [[f64; 3]; 3]| {
        m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
            + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
    };
    let all = det(m);
    from_fn(|k| det(from_fn(|i| from_fn(|j| if j == k { b[i] } else { m[i][j] }))) / all)
}

/// Σ A_jk cos(θ_j − θ_k) θ̈_k + I_j θ̈_j + Σ A_jk sin(θ_j − θ_k) θ̇_k² + g B_j cos θ_j = Q_j.
fn accelerations(angles: [f64; 3], rates: [f64; 3], forces: [f64; 3]) -> [f64; 3] {
    let arm = |body: usize, k: usize| if k < body { LINKS[k][3] } else { LINKS[k][2] };
    let shared = |j: usize, k: usize| -> f64 {
        (j.max(k)..3).map(|body| LINKS[body][0] * arm(body, j) * arm(body, k)).sum()
    };
    let weight = |j: usize| (j..3).map(|body| LINKS[body][0] * arm(body, j)).sum::<f64>() * 9.81;
    let inertia = |j: usize, k: usize| if j == k { LINKS[j][1] } else { 0.0 };
    let matrix = from_fn(|j| from_fn(|k| shared(j, k) * (angles[j] - angles[k]).cos() + inertia(j, k)));
    let right = from_fn(|j| {
        let turning: f64 =
            (0..3).map(|k| shared(j, k) * (angles[j] - angles[k]).sin() * rates[k].powi(2)).sum();
        forces[j] - turning - weight(j) * angles[j].cos()
    });
    solved(matrix, right)
}

/// The rates of the pressures in a cylinder.
fn pressure_rates(ram: &Ram, [a, b]: [f64; 2], [travel, speed]: [f64; 2], t: f64) -> [f64; 2] {
    let root = |d: f64| d / (d * d + 1e6).sqrt().sqrt();
    let flow = 4e-6 * (ram.opening)(t);
    let [into_a, from_b] = if flow > 0.0 { [root(25e6 - a), root(b)] } else { [root(a), root(25e6 - b)] }
        .map(|root| flow * root);
    let (leak, [area, rod_area]) = (2e-12 * (a - b), ram.areas);
    [
        1.2e9 * (into_a - leak - area * speed) / (2e-3 + area * travel),
        1.2e9 * (leak - from_b + rod_area * speed) / (2e-3 + rod_area * (ram.stroke - travel)),
    ]
}

#[test]
fn the_arm_of_the_excavator_moves_as_its_oil_flows() {
    let start = [40.0_f64, -55.0, -115.0].map(f64::to_radians);
    let start: [f64; 12] = from_fn(|k| match k {
        0..3 => start[k],
        3..6 => 0.0,
        _ => 4e6,
    });
    let end = integrated(start, 4.0, |y, t| {
        let (angles, rates): ([f64; 3], [f64; 3]) = (from_fn(|k| y[k]), from_fn(|k| y[3 + k]));
        let (mut forces, mut flows) = ([0.0; 3], [[0.0; 2]; 3]);
        for (k, ram) in RAMS.iter().enumerate() {
            let (length, slopes) = length(ram, angles);
            let speed: f64 = (0..3).map(|j| slopes[j] * rates[j]).sum();
            let pressures = [y[6 + 2 * k], y[7 + 2 * k]];
            let push = ram.areas[0] * pressures[0] - ram.areas[1] * pressures[1] - ram.hoses * speed;
            forces = from_fn(|j| forces[j] + push * slopes[j]);
            flows[k] = pressure_rates(ram, pressures, [length - ram.closed, speed], t);
        }
        let accelerations = accelerations(angles, rates, forces);
        from_fn(|k| match k {
            0..3 => rates[k],
            3..6 => accelerations[k - 3],
            _ => flows[(k - 6) / 2][k % 2],
        })
    });
    let run = example("excavator", "4");
    let near = |found: f64, expected: f64, what: &str| {
        assert!((found - expected).abs() < 1e-9 * expected.abs().max(1.0), "{what}: {found} for {expected}");
    };
    for (k, name) in ["lift", "reach", "curl"].into_iter().enumerate() {
        let before = |j: usize| if k == 0 { 0.0 } else { end[j + k - 1] };
        let [angle, rate] = joint(&run, name);
        near(angle, end[k] - before(0), name);
        near(rate, end[3 + k] - before(3), name);
    }
    for (k, name) in ["boom_ram", "stick_ram", "bucket_ram"].into_iter().enumerate() {
        for (side, letter) in ["a", "b"].into_iter().enumerate() {
            let name = format!("{name}_pressure_{letter}");
            near(output(&run, &name), end[6 + 2 * k + side], &name);
        }
    }
}
