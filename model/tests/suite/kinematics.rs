//! Derivatives against finite differences: of Φ in (r, π') and in time, of prescribed motions.

use gyro_model::{
    BodyMotion, Kinematics, Model, Motion, Number, Rational, Spline, Support, parse_decimal, read,
};

/// Step of central differences: their truncation is about its square, their rounding 1e-16 divided by it.
const STEP: f64 = 1e-5;

/// A hundred times that, for third derivatives of the motions here.
const TOLERANCE: f64 = 1e-8;

fn model(stem: &str) -> Model {
    let folders = ["models", "tests/models"];
    let paths = folders.map(|folder| format!("{}/../{folder}/{stem}.toml", env!("CARGO_MANIFEST_DIR")));
    let text = paths.iter().find_map(|path| std::fs::read_to_string(path).ok()).expect("a model file");
    read(stem, &text).unwrap_or_else(|mistakes| panic!("{mistakes}"))
}

/// The start, and poses off the constraints around it.
fn poses(model: &Model) -> Vec<(Vec<f64>, Vec<Vec<f64>>)> {
    let start = model.assemble().expect("a start");
    let near: Vec<Vec<f64>> = start.joints.iter().map(|joint| joint.position.clone()).collect();
    let n = start.v.len();
    let pose = |series: usize| {
        let mut q = start.q.clone();
        for k in 0..n {
            let change = 0.3 * series as f64 * (1.7 * k as f64 + series as f64).sin();
            q = varied(&q, k, change);
        }
        (q, near.clone())
    };
    (0..3).map(pose).collect()
}

/// q moved along one of the directions (r, π') body after body: `p ∘ exp(½ π')`.
fn varied(q: &[f64], direction: usize, by: f64) -> Vec<f64> {
    let (moving_body, k) = (direction / 6, direction % 6);
    let mut q = q.to_vec();
    if k < 3 {
        q[7 * moving_body + k] += by;
        return q;
    }
    let (sin, cos) = (0.5 * by).sin_cos();
    let mut turn = [cos, 0.0, 0.0, 0.0];
    turn[k - 2] = sin;
    let ([a, b, c, d], [w, x, y, z]) = (std::array::from_fn(|e| q[7 * moving_body + 3 + e]), turn);
    let p = [
        a * w - b * x - c * y - d * z,
        a * x + b * w + c * z - d * y,
        a * y - b * z + c * w + d * x,
        a * z + b * y - c * x + d * w,
    ];
    q[7 * moving_body + 3..7 * moving_body + 7].copy_from_slice(&p);
    q
}

#[test]
fn the_jacobian_is_the_derivative_of_phi() {
    for stem in ["all-joints", "four-bar", "gyroscope-maximal", "pitching-gyroscope"] {
        let model = model(stem);
        let kinematics = Kinematics::at(&model, 0.1);
        for (q, near) in poses(&model) {
            let jacobian = kinematics.jacobian(&q, &near);
            for (direction, column) in jacobian.column_iter().enumerate() {
                let [before, after] =
                    [-STEP, STEP].map(|by| kinematics.phi(&varied(&q, direction, by), &near));
                let error = ((after - before) / (2.0 * STEP) - column).amax();
                assert!(error <= TOLERANCE, "{stem}, direction {direction}: {error}");
            }
        }
    }
}

#[test]
fn nu_is_minus_the_derivative_of_phi_in_time() {
    for stem in ["all-joints", "pitching-gyroscope"] {
        let model = model(stem);
        for (q, near) in poses(&model) {
            for t in [0.0, 0.13, 0.4] {
                let [before, after] = [t - STEP, t + STEP].map(|t| Kinematics::at(&model, t).phi(&q, &near));
                let nu = Kinematics::at(&model, t).nu(&q, &near);
                let error = ((after - before) / (2.0 * STEP) + &nu).amax();
                assert!(error <= 100.0 * TOLERANCE, "{stem} at {t}: {error}");
                assert!(nu.amax() > 1e-3, "{stem}: nothing moves");
            }
        }
    }
}

/// The start moves as its rates say, also where bodies are driven: Φ stays zero along the velocities.
#[test]
fn rates_are_the_derivatives_of_coordinates() {
    for stem in ["all-joints", "four-bar-revolute", "pitching-gyroscope"] {
        let model = model(stem);
        let start = model.assemble().expect("a start");
        let near: Vec<Vec<f64>> = start.joints.iter().map(|joint| joint.position.clone()).collect();
        let at = |t: f64| {
            let moved = (0..start.v.len()).fold(start.q.clone(), |q, k| varied(&q, k, t * start.v[k]));
            let kinematics = Kinematics::at(&model, t);
            (kinematics.phi(&moved, &near), kinematics.coordinates(&moved, &near))
        };
        let ((phi_before, before), (phi_after, after)) = (at(-STEP), at(STEP));
        // Velocities are of order one to 200 rad/s; the difference of rotations in turn is of second order.
        let scale = start.v.iter().fold(1.0_f64, |m, v| m.max(v.abs()));
        let drift = ((phi_after - phi_before) / (2.0 * STEP)).amax();
        assert!(drift <= TOLERANCE * scale.powi(2), "{stem}: {drift}");
        let kinematics = Kinematics::at(&model, 0.0);
        for (joint, rates) in kinematics.rates(&start.q, &start.v, &near).iter().enumerate() {
            for (k, rate) in rates.iter().enumerate() {
                let difference = (after[joint][k] - before[joint][k]) / (2.0 * STEP);
                assert!((difference - rate).abs() <= TOLERANCE * scale.powi(2), "{stem}, joint {joint}");
                assert!((start.joints[joint].rate[k] - rate).abs() <= 1e-12 * scale, "{stem}, joint {joint}");
            }
        }
    }
}

fn number(text: &str) -> Number {
    Number::Exact(parse_decimal(text).expect("a number"))
}

fn sinusoid(amplitude: &str, angular_frequency: &str, phase: &str) -> Motion {
    Motion::Sinusoid {
        amplitude: number(amplitude),
        angular_frequency: number(angular_frequency),
        phase: number(phase),
    }
}

/// A motion of each kind.
fn motions() -> Vec<Motion> {
    let polynomial = || Motion::Polynomial(["0.3", "-1", "0.5", "0.25"].map(number).to_vec());
    let table = Spline::natural("a table".to_owned(), &[(-1.0, 0.2), (0.1, 1.0), (0.5, -0.4), (2.0, 0.0)]);
    vec![
        polynomial(),
        Motion::Polynomial(vec![]),
        sinusoid("0.7", "3", "0.4"),
        Motion::Sum(vec![polynomial(), sinusoid("0.2", "5", "0")]),
        Motion::Product(vec![polynomial(), sinusoid("0.2", "5", "0"), polynomial()]),
        Motion::Table(table.expect("a spline")),
    ]
}

#[test]
fn motions_have_their_values_and_derivatives() {
    let model = model("gyroscope");
    let at = |motion: &Motion, t: f64| motion.value(&model, t);
    let [polynomial, nothing, sine, sum, product, _] = <[Motion; 6]>::try_from(motions()).expect("six");
    let t = 0.8_f64;
    assert_eq!(at(&nothing, t), [0.0; 3]);
    let x = [0.3 - t + 0.5 * t * t + 0.25 * t.powi(3), -1.0 + t + 0.75 * t * t, 1.0 + 1.5 * t];
    let (sin, cos) = (3.0 * t + 0.4).sin_cos();
    let y = [0.7 * sin, 2.1 * cos, -6.3 * sin];
    let z = [0.2 * (5.0 * t).sin(), (5.0 * t).cos(), -5.0 * (5.0 * t).sin()];
    let near = |found: [f64; 3], expected: [f64; 3]| {
        assert!((0..3).all(|k| (found[k] - expected[k]).abs() <= 1e-14), "{found:?} {expected:?}");
    };
    near(at(&polynomial, t), x);
    near(at(&sine, t), y);
    near(at(&sum, t), std::array::from_fn(|k| x[k] + z[k]));
    let square = [x[0] * x[0], 2.0 * x[0] * x[1], 2.0 * (x[1] * x[1] + x[0] * x[2])];
    let second = square[2] * z[0] + 2.0 * square[1] * z[1] + square[0] * z[2];
    near(at(&product, t), [square[0] * z[0], square[1] * z[0] + square[0] * z[1], second]);
}

#[test]
fn a_driven_body_moves_as_its_derivatives_say() {
    let mut model = model("gyroscope");
    let motions = motions();
    let motion = BodyMotion {
        translation: [motions[2].clone(), motions[3].clone(), motions[5].clone()],
        rotations: vec![
            (["1", "2", "-2"].map(number), motions[4].clone()),
            (["0", "0", "3"].map(number), motions[0].clone()),
            (["1", "0", "1"].map(number), motions[5].clone()),
        ],
    };
    let body = &mut model.bodies[0];
    body.support = Support::Driven;
    body.orientation = ["1", "-2", "0.5", "1"].map(number);
    body.position = ["3", "0", "-1"].map(number);
    let body = body.clone();
    for t in [0.0, 0.3, 1.1] {
        let [before, at, after] = [t - STEP, t, t + STEP].map(|t| motion.state(&model, &body, t));
        let difference = |k: usize, of: fn(&gyro_model::Prescribed) -> [f64; 3]| {
            (of(&after)[k] - of(&before)[k]) / (2.0 * STEP)
        };
        for k in 0..3 {
            assert!((difference(k, |x| x.r.into()) - at.s[k]).abs() <= 100.0 * TOLERANCE, "s at {t}");
            assert!((difference(k, |x| x.s.into()) - at.ds[k]).abs() <= 100.0 * TOLERANCE, "ds at {t}");
            assert!((difference(k, |x| x.w.into()) - at.dw[k]).abs() <= 100.0 * TOLERANCE, "dw at {t}");
        }
        // The columns of A turn with A w'.
        for axis in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(gyro_model::Vector::from) {
            let turned = (after.p.rotate(axis) - before.p.rotate(axis)) * (0.5 / STEP);
            let error = (turned - at.p.rotate(at.w.cross(&axis))).norm();
            assert!(error <= 100.0 * TOLERANCE, "w' at {t}: {error}");
        }
        assert!((at.p.dot(at.p) - 1.0).abs() <= 1e-15);
    }
}

/// The pose of the convention: A0 R(axis_1) R(axis_2), intrinsic; r0 + translation.
#[test]
fn rotations_follow_one_another_in_the_turned_frame() {
    let mut model = model("gyroscope");
    let quarter = || {
        let half_pi = Rational::from_float(std::f64::consts::FRAC_PI_2).expect("finite");
        Motion::Polynomial(vec![Number::Exact(half_pi)])
    };
    let motion = BodyMotion {
        translation: ["1", "2", "3"].map(|x| Motion::Polynomial(vec![number(x)])),
        rotations: vec![(["0", "0", "1"].map(number), quarter()), (["2", "0", "0"].map(number), quarter())],
    };
    model.bodies[0].position = ["10", "0", "0"].map(number);
    let at = motion.state(&model, &model.bodies[0], 0.0);
    assert_eq!(at.r, gyro_model::Vector::new(11.0, 2.0, 3.0));
    // About z: x → y. Then about the new x, which is global y: the body's y, at −x, goes to z.
    for (axis, expected) in [([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]), ([0.0, 1.0, 0.0], [0.0, 0.0, 1.0])] {
        let error = (at.p.rotate(gyro_model::Vector::from(axis)) - gyro_model::Vector::from(expected)).norm();
        assert!(error <= 1e-15, "{axis:?}");
    }
}
