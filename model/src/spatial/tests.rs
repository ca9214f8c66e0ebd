use super::*;

/// Rounding of a dozen operations on numbers of order one.
const TOLERANCE: f64 = 4e-16;

fn samples() -> Vec<Quaternion> {
    let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.3, -0.5, 0.8]];
    let turn = |axis: [f64; 3], half: f64| {
        let [x, y, z] = (Vector::from(axis).normalize() * half.sin()).into();
        Quaternion([half.cos(), x, y, z])
    };
    axes.iter().flat_map(|&axis| (-6..=6).map(move |k| turn(axis, 0.25 * f64::from(k)))).collect()
}

#[test]
fn a_frame_gives_back_its_quaternion() {
    for p in samples() {
        let columns = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|e| p.rotate(Vector::from(e)));
        let back = Quaternion::from_frame(columns[0], columns[1], columns[2]).nearest(p);
        for k in 0..4 {
            assert!((back.0[k] - p.0[k]).abs() <= TOLERANCE, "{p:?} came back as {back:?}");
        }
    }
}

#[test]
fn a_product_turns_as_its_factors_do() {
    let v = Vector::from([0.2, -0.7, 0.4]);
    for p in samples() {
        for q in samples() {
            let difference = (p * q).rotate(v) - p.rotate(q.rotate(v));
            assert!(difference.norm() <= 4.0 * TOLERANCE, "{p:?} {q:?}");
        }
    }
}

#[test]
fn the_matrix_of_a_quarter_turn_about_z_takes_x_to_y() {
    let p = Quaternion::about_z(std::f64::consts::FRAC_PI_2);
    assert!((p.rotate(Vector::from([1.0, 0.0, 0.0])) - Vector::from([0.0, 1.0, 0.0])).norm() <= TOLERANCE);
}
