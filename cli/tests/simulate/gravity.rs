//! Central gravity, against Kepler's equation and against equations that are integrated here.

use crate::laws::{RUNS, end, integrated, run};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// A stiff method, which takes derivatives.
const BY_DERIVATIVES: &[&str] = &["--integrator", "rodas4", "--tolerance", "1e-10"];

fn near(found: f64, expected: f64, tolerance: f64, what: &[&str]) {
    assert!((found - expected).abs() < tolerance, "{what:?}: {found:?} and not {expected:?}");
}

fn numbers(run: &Value, output: &str) -> Vec<f64> {
    run["outputs"][output].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
}

/// `E − e sin E = n t`, and the place `a (cos E − e, √(1 − e²) sin E)`.
#[test]
fn a_satellite_obeys_keplers_equation() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/laws/satellite.toml");
    let page = fs::read_to_string(path).unwrap();
    let (mu, a, e, t) = (3.986_004_418e14_f64, 8.75e6_f64, 0.2_f64, 3000.0);
    let mean = t * (mu / a.powi(3)).sqrt();
    let eccentric = (0..100).fold(mean, |eccentric: f64, _| mean + e * eccentric.sin());
    let place = [a * (eccentric.cos() - e), a * (1.0 - e * e).sqrt() * eccentric.sin()];
    for options in RUNS {
        let run = run(&page, options, "3000");
        let at = numbers(&run, "at");
        near(at[0] / a, place[0] / a, 1e-9, options);
        near(at[1] / a, place[1] / a, 1e-9, options);
        near(run["energy_drift"].as_f64().unwrap() / (mu * 500.0 / a), 0.0, 1e-9, options);
    }
}

const PENDULUM: &str = "format = 1\nname = \"tower\"\ngravity = { mu = \"2*half\", centre = [0.3, -2, 0.4] }\n\
    [parameters]\nhalf = 12.5\n[[body]]\nname = \"ground\"\nfixed = true\n[[body]]\nname = \"bob\"\nmass = 2\n\
    inertia = [0.1, 0.1, 0.2]\n[[joint]]\nname = \"turn\"\nkind = \"revolute\"\naxis = [0, 0, 1]\nzero = [1, 0, 0]\n\
    first = { body = \"ground\" }\nsecond = { body = \"bob\", point = [-0.5, 0, 0] }\nangle = 0.4\nrate = -1.5\n";

/// A pendulum of 2 kg, its mass centre 0.5 m from a pivot that is not where the field is centred.
#[test]
fn a_pendulum_swings_in_a_central_field() {
    let moment = |x: f64| {
        let r = [0.5 * x.cos(), 0.5 * x.sin(), 0.0];
        let d = [r[0] - 0.3, r[1] + 2.0, -0.4];
        let cube = d.iter().map(|d| d * d).sum::<f64>().powf(1.5);
        -2.0 * 25.0 / cube * (r[0] * d[1] - r[1] * d[0])
    };
    let [[x], [v]] = integrated([[0.4], [-1.5]], 1.5, |[x], _, _| [moment(x) / (0.2 + 2.0 * 0.25)]);
    for options in RUNS.into_iter().chain([BY_DERIVATIVES]) {
        let [angle, rate, drift] = end(&run(PENDULUM, options, "1.5"));
        near(angle, x, 1e-8, options);
        near(rate, v, 1e-8, options);
        near(drift, 0.0, 1e-8, options);
    }
}

fn dumbbell() -> String {
    let mut page = "format = 1\nname = \"dumbbell\"\ngravity = { mu = 60, centre = [0.1, 0.2, 0] }\n[[body]]\nname = \"hub\"\n\
        free = true\nmass = 1.5\ninertia = [0.1, 0.1, 0.2]\nposition = [3, 0, 0]\nvelocity = [0.4, 3, 0]\n\
        angular_velocity = [0, 0, 2]\n"
        .to_owned();
    for (name, x) in [("left", -0.8), ("right", 0.8)] {
        page += &format!(
            "[[body]]\nname = \"{name}\"\nmass = 2\ninertia = [0.02, 0.03, 0.05]\n[[joint]]\nname = \"{name}\"\n\
             kind = \"fixed\"\naxis = [0, 0, 1]\nzero = [1, 0, 0]\n\
             first = {{ body = \"hub\", point = [{x}, 0, 0] }}\nsecond = {{ body = \"{name}\" }}\n"
        );
    }
    for (name, kind, keys) in [("at", "pose", ""), ("felt", "inertial", "point = [0.3, -0.1, 0.2]\n")] {
        page += &format!("[[output]]\nname = \"{name}\"\nkind = \"{kind}\"\nbody = \"hub\"\n{keys}");
    }
    page
}

/// The acceleration of what falls, 60 m³/s² from the centre.
fn field(place: [f64; 3]) -> [f64; 3] {
    let d = [place[0] - 0.1, place[1] - 0.2, place[2]];
    let cube = d.iter().map(|d| d * d).sum::<f64>().powf(1.5);
    d.map(|d| -60.0 * d / cube)
}

/// Each of three bodies is pulled where its own mass centre is, which turns what they are together; an accelerometer
/// feels the acceleration of its place less that of the field there.
#[test]
fn a_dumbbell_is_turned_by_what_its_ends_feel() {
    let inertia = 0.2 + 2.0 * (0.05 + 2.0 * 0.64);
    let fall = |[x, y, angle]: [f64; 3]| {
        let mut sum = field([x, y, 0.0]).map(|a| 1.5 * a);
        sum[2] = 0.0;
        for side in [-0.8, 0.8] {
            let arm = [side * angle.cos(), side * angle.sin()];
            let force = field([x + arm[0], y + arm[1], 0.0]).map(|a| 2.0 * a);
            sum = [sum[0] + force[0], sum[1] + force[1], sum[2] + arm[0] * force[1] - arm[1] * force[0]];
        }
        [sum[0] / 5.5, sum[1] / 5.5, sum[2] / inertia]
    };
    let start = [[3.0, 0.0, 0.0], [0.4, 3.0, 2.0]];
    let [place, rates] = integrated(start, 2.0, |x, _, _| fall(x));
    let [x, y, angle] = place;
    let accelerations = fall(place);
    let turned = |[u, v]: [f64; 2]| [u * angle.cos() - v * angle.sin(), u * angle.sin() + v * angle.cos()];
    let point = turned([0.3, -0.1]);
    let local = field([x + point[0], y + point[1], 0.2]);
    let (w, w_dot) = (rates[2], accelerations[2]);
    let felt = [
        accelerations[0] - w_dot * point[1] - w * w * point[0] - local[0],
        accelerations[1] + w_dot * point[0] - w * w * point[1] - local[1],
    ];
    let felt = [felt[0] * angle.cos() + felt[1] * angle.sin(), felt[1] * angle.cos() - felt[0] * angle.sin()];
    for options in RUNS.into_iter().chain([BY_DERIVATIVES]) {
        let run = run(&dumbbell(), options, "2");
        let (at, told) = (numbers(&run, "at"), numbers(&run, "felt"));
        near(at[0], x, 1e-8, options);
        near(at[1], y, 1e-8, options);
        near((at[6] * at[3]).mul_add(2.0, -angle.sin()), 0.0, 1e-8, options);
        [(told[0], felt[0]), (told[1], felt[1]), (told[2], -local[2]), (told[5], w)]
            .into_iter()
            .for_each(|(found, expected)| near(found, expected, 1e-7, options));
        near(run["energy_drift"].as_f64().unwrap(), 0.0, 1e-7, options);
    }
}
