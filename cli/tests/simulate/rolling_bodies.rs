//! `[[rolling]]`: discs, wheels, balls, rollers and skates on surfaces, against closed forms, published numbers and the
//! same equations integrated here.

use crate::rolling::kutta;
use crate::support::{Folder, json, model, simulate};
use serde_json::Value;
use std::f64::consts::PI;
use std::fs;

/// In joint coordinates and in maximal ones, generated and assembled.
pub(super) const FORMS: [&[&str]; 4] = [
    &[],
    &["--coordinates", "maximal"],
    &["--engine", "assembled"],
    &["--engine", "assembled", "--coordinates", "maximal"],
];

pub(super) const EXACT: [&str; 4] = ["--integrator", "dop853", "--tolerance", "1e-12"];

fn example(name: &str, options: &[&str]) -> Value {
    let folder = Folder::new(&format!("rolling-{name}-{}", options.concat().replace(['-', '/'], "")));
    let path = model(&format!("../examples/rolling/{name}.toml"));
    json(&folder, &[&[path.as_str()], options].concat())
}

/// Numbers of an output where a run ends.
pub(super) fn told<const N: usize>(run: &Value, output: &str) -> [f64; N] {
    let all = run["outputs"][output].as_array().unwrap_or_else(|| panic!("{output} in {run}"));
    std::array::from_fn(|k| all[k].as_f64().unwrap())
}

pub(super) fn number(run: &Value, output: &str) -> f64 {
    run["outputs"][output].as_f64().unwrap_or_else(|| panic!("{output} in {run}"))
}

#[track_caller]
pub(super) fn near<const N: usize>(found: [f64; N], expected: [f64; N], tolerance: f64) {
    for (found, expected) in found.iter().zip(&expected) {
        assert!((found - expected).abs() < tolerance, "{found}, not {expected}");
    }
}

/// After once around its centre is where it was.
#[test]
fn a_leaning_disc_rolls_around_a_circle() {
    let (k, r): (f64, f64) = (0.2, 0.3);
    let height = r * (1.0 - k * k) / (1.0 + k * k);
    for form in FORMS {
        let run = example("disc", &[&EXACT[..], form, &["--t-end", &format!("{PI:?}")]].concat());
        near(told(&run, "at"), [0.0, 0.0, height], 1e-9);
        near([number(&run, "rim_normal"), number(&run, "rim_along")], [2.0 * 9.81, 0.0], 1e-9);
        // What keeps its mass centre on the circle, of which the rim has the part across its axis.
        let spin = run_spin(k, r);
        near([number(&run, "rim_across").abs()], [2.0 * 2.0 * (r * spin).abs()], 1e-9);
        assert!(run["energy_drift"].as_f64().unwrap().abs() < 1e-10);
    }
}

/// ω along the axis of the disc of the example.
fn run_spin(k: f64, r: f64) -> f64 {
    let (sine, cosine, turn, m) = (2.0 * k / (1.0 + k * k), (1.0 - k * k) / (1.0 + k * k), 2.0_f64, 2.0);
    let (across, about) = (m * r * r / 4.0, m * r * r / 2.0);
    (across * turn.powi(2) * cosine * sine - m * 9.81 * r * sine) / (turn * cosine * (about + m * r * r))
}

/// Any motion of a disc, by Newton's and Euler's equations in axes that lean with it and do not spin: with ω along
/// them, θ between axis and vertical and κ = ω₂ cot θ,
/// `(A + m r²) ω̇₁ = A κ ω₂ − (C + m r²) ω₂ ω₃ − m g r cos θ`, `A ω̇₂ = (C ω₃ − A κ) ω₁`,
/// `(C + m r²) ω̇₃ = m r² ω₁ ω₂`, `θ̇ = ω₁`.
#[test]
fn a_disc_falls_over_as_its_equations_say() {
    let (m, r, g) = (2.0, 0.3, 9.81);
    let (across, about) = (m * r * r / 4.0, m * r * r / 2.0);
    let slope = |[theta, w1, w2, w3]: [f64; 4]| {
        let kappa = w2 * theta.cos() / theta.sin();
        let first = across * kappa * w2 - (about + m * r * r) * w2 * w3 - m * g * r * theta.cos();
        [
            w1,
            first / (across + m * r * r),
            (about * w3 - across * kappa) * w1 / across,
            m * r * r * w1 * w2 / (about + m * r * r),
        ]
    };
    // Upright, and rolling; the second whirls almost flat, as a coin does before it comes to rest.
    for (k, spin, turn, tip, t_end) in [(0.0, 3.0, 0.4, 0.3, 1.3), (0.9, -0.4, 25.0, 0.1, 0.8)] {
        let phi = 2.0 * f64::atan(k);
        let expected = kutta([PI / 2.0 - phi, tip, turn, spin], t_end, slope);
        let page = format!(
            "format = 1\nname = \"disc\"\ngravity = [0, 0, -9.81]\n[[body]]\nname = \"ground\"\nfixed = true\n\
             [[body]]\nname = \"disc\"\nfree = true\nmass = 2\ninertia = [{across}, {about}, {across}]\n\
             position = [0, 0, {:?}]\norientation = [1, {k}, 0, 0]\nvelocity = [{:?}, {:?}, {:?}]\n\
             angular_velocity = [{:?}, {spin}, {turn}]\n[[rolling]]\nname = \"rim\"\nkind = \"disc\"\n\
             first = {{ body = \"ground\" }}\nsecond = {{ body = \"disc\" }}\nradius = {r}\n",
            r * phi.cos(),
            r * spin,
            r * tip * phi.cos(),
            r * tip * phi.sin(),
            -tip,
        );
        for form in FORMS {
            let folder = Folder::new("rolling-disc-falls");
            fs::write(folder.0.join("page.toml"), &page).unwrap();
            let t_end = format!("{t_end}");
            let run = json(&folder, &[&["page.toml", "--t-end", &t_end], &EXACT[..], form].concat());
            let seen: [f64; 18] = told(&run, "rim_seen");
            // Of the axis the part along z, and the angular velocity along it.
            let spin = seen[15] * seen[4] + seen[16] * seen[7] + seen[17] * seen[10];
            near([seen[10], spin], [expected[0].cos(), expected[3]], 1e-8);
            near([seen[2]], [r * expected[0].sin()], 1e-8);
        }
    }
}

/// Around circles at 2/7 of the table's rate, with the velocity that it has.
#[test]
fn a_ball_on_a_turntable_goes_around_circles() {
    let rate = 2.0 / 7.0 * 3.0;
    for form in FORMS {
        let run = example("turntable", &[&EXACT[..], form].concat());
        let (sine, cosine) = (rate * 10.0_f64).sin_cos();
        near(told(&run, "at"), [0.3 - 0.2 / rate * (1.0 - cosine), 0.2 / rate * sine, 0.05], 1e-9);
    }
}

/// It goes around evenly, and climbs and falls with √(2/7) of that rate about where it never is.
#[test]
fn a_ball_in_a_cylinder_climbs_and_falls() {
    let n = 10.0;
    let lift = (2.0_f64 / 7.0).sqrt() * n;
    let middle = -5.0 / 7.0 * 9.81 / lift.powi(2);
    for form in FORMS {
        let run = example("routh", &[&EXACT[..], form].concat());
        let (sine, cosine) = (n * 2.0_f64).sin_cos();
        near(told(&run, "at"), [0.2 * cosine, 0.2 * sine, middle * (1.0 - (lift * 2.0).cos())], 1e-9);
        near([number(&run, "wall_normal")], [0.2 * n * n * 0.2], 1e-8);
    }
}

/// In a bowl and on a sphere, in the plane: `(7/5) (R ∓ r) θ̈ = ∓ g sin θ`.
#[test]
fn balls_swing_in_bowls_and_roll_off_spheres() {
    for (kind, sign) in [("sphere_in_sphere", -1.0), ("sphere_on_sphere", 1.0)] {
        let arm = 0.5 + sign * 0.05;
        let (theta, rate) = (0.3_f64, 0.4);
        let expected =
            kutta([theta, rate], 0.7, |[angle, rate]| [rate, sign * 5.0 / 7.0 * 9.81 * angle.sin() / arm]);
        let place = |theta: f64| [arm * theta.sin(), 0.0, sign * arm * theta.cos()];
        let [x, _, z] = place(theta);
        let page = format!(
            "format = 1\nname = \"bowl\"\ngravity = [0, 0, -9.81]\n[[body]]\nname = \"ground\"\nfixed = true\n\
             [[body]]\nname = \"ball\"\nfree = true\nmass = 0.3\ninertia = [3e-4, 3e-4, 3e-4]\n\
             position = [{x:?}, 0, {z:?}]\nvelocity = [{:?}, 0, {:?}]\n[[rolling]]\nname = \"on\"\n\
             kind = \"{kind}\"\nfirst = {{ body = \"ground\" }}\nsecond = {{ body = \"ball\" }}\nradius = 0.05\n\
             outer = 0.5\n",
            arm * theta.cos() * rate,
            -sign * arm * theta.sin() * rate,
        );
        for form in FORMS {
            let folder = Folder::new("rolling-bowl");
            fs::write(folder.0.join("page.toml"), &page).unwrap();
            let run = json(&folder, &[&["page.toml", "--t-end", "0.7"], &EXACT[..], form].concat());
            let seen: [f64; 18] = told(&run, "on_seen");
            near([seen[0], seen[1], seen[2]], place(expected[0]), 1e-9);
        }
    }
}

/// The published eigenvalues of the upright bicycle at 5 m/s, and those of the published M, C1, K0 and K2 at others:
/// `det(λ² M + λ v C1 + g K0 + v² K2) = 0`.
#[test]
fn the_bicycle_has_its_published_eigenvalues() {
    let eigenvalues = |v: f64, form: &[&str]| -> Vec<[f64; 2]> {
        let speed = format!("v={v:?}");
        let run =
            example("bicycle", &[&["--linearize", "0", "--set", "push=0", "--set", &speed], form].concat());
        serde_json::from_value(run["linearization"]["eigenvalues"].clone()).unwrap()
    };
    let is_near = |all: &[[f64; 2]], re: f64, im: f64| {
        let found = all.iter().any(|[a, b]| (a - re).hypot(b - im) < 1e-13);
        assert!(found, "{re} + {im} i is none of {all:?}");
    };
    for form in [&[][..], &["--coordinates", "maximal"]] {
        let at_five = eigenvalues(5.0, form);
        is_near(&at_five, -14.078_389_692_798_22, 0.0);
        is_near(&at_five, -0.322_866_429_004_09, 0.0);
        is_near(&at_five, -0.775_341_882_195_85, 4.464_867_713_788_23);
    }
    for v in [2.0, 4.0, 7.0, 9.5] {
        for [re, im] in eigenvalues(v, &[]) {
            // Of what only rolls on, nothing grows.
            if re.hypot(im) > 1e-3 {
                let size = determinant(v, [re, im]);
                assert!(size < 2e-12, "at {v} m/s: {re} + {im} i leaves {size}");
            }
        }
    }
}

/// What is left of the characteristic equation, as a part of its largest term.
fn determinant(v: f64, lambda: [f64; 2]) -> f64 {
    let m = [[80.817_22, 2.319_413_322_087_09], [2.319_413_322_087_09, 0.297_841_881_996_86]];
    let c1 = [[0.0, 33.866_413_914_924_94], [-0.850_356_414_569_78, 1.685_403_973_975_60]];
    let k0 = [[-80.95, -2.599_516_852_498_72], [-2.599_516_852_498_72, -0.803_294_884_586_18]];
    let k2 = [[0.0, 76.597_345_895_732_22], [0.0, 2.654_315_237_946_04]];
    let product = |[a, b]: [f64; 2], [c, d]: [f64; 2]| [a * c - b * d, a * d + b * c];
    let square = product(lambda, lambda);
    let entry = |i: usize, j: usize| {
        let still = 9.81 * k0[i][j] + v * v * k2[i][j];
        let [re, im] = [0, 1].map(|k| square[k] * m[i][j] + lambda[k] * v * c1[i][j]);
        [re + still, im]
    };
    let (first, second) = (product(entry(0, 0), entry(1, 1)), product(entry(0, 1), entry(1, 0)));
    let size = first[0].hypot(first[1]).max(second[0].hypot(second[1]));
    (first[0] - second[0]).hypot(first[1] - second[1]) / size
}

/// The bicycle pushed over at 4.6 m/s keeps itself upright, in all forms alike.
#[test]
fn the_bicycle_keeps_upright() {
    let runs = FORMS.map(|form| example("bicycle", &[&["--t-end", "1"], &EXACT[..], form].concat()));
    let to_its_end = example("bicycle", &EXACT);
    let of = |run: &Value| {
        let steer = &run["joints"]["steer"];
        [
            steer["position"].as_f64().unwrap(),
            steer["rate"].as_f64().unwrap(),
            number(run, "front_tyre_normal"),
        ]
    };
    for run in &runs {
        near(of(run), of(&runs[0]), 3e-8);
    }
    for run in runs.iter().chain([&to_its_end]) {
        assert!(run["energy_drift"].as_f64().unwrap().abs() < 1e-9 && run["events"] == serde_json::json!([]));
        assert!(of(run)[0].abs() < 0.05);
    }
}

/// A ball that rolls off a sphere would lift: the run says so, and with a verdict, too.
#[test]
fn what_would_lift_is_told() {
    let page = "format = 1\nname = \"hill\"\ngravity = [0, 0, -9.81]\n[[body]]\nname = \"ground\"\nfixed = true\n\
        [[body]]\nname = \"ball\"\nfree = true\nmass = 1\ninertia = [1e-3, 1e-3, 1e-3]\nposition = [0, 0, 1.05]\n\
        velocity = [0.1, 0, 0]\n[[rolling]]\nname = \"hill\"\nkind = \"sphere_on_sphere\"\n\
        first = { body = \"ground\" }\nsecond = { body = \"ball\" }\nradius = 0.05\nouter = 1\n";
    let folder = Folder::new("rolling-lifts");
    fs::write(folder.0.join("page.toml"), page).unwrap();
    let run =
        json(&folder, &["page.toml", "--t-end", "2.5", "--integrator", "dop853", "--tolerance", "1e-12"]);
    // From rest a solid ball lifts where 17 cos θ = 10; from 0.1 m/s, where 17 cos θ = 10 + 7 v²/(g (R + r)).
    let factor = 1.0 + 1e-3 / 0.05_f64.powi(2);
    let cosine = (2.0 + factor * 0.01 / (9.81 * 1.05)) / (2.0 + factor);
    let (event, warning) = (&run["events"][0], run["warnings"].to_string());
    assert!(event["name"] == "hill_lifts" && warning.contains("`hill` pulls at t = "), "{event} {warning}");
    let judged = simulate(&folder, &["page.toml", "--t-end", "2", "--verify"]);
    let said = String::from_utf8_lossy(&judged.stderr);
    assert!(said.contains("`hill` pulls at t = "), "{said}");
    let t = event["t"].as_f64().unwrap().to_string();
    let then = json(&folder, &["page.toml", "--t-end", &t, "--integrator", "dop853", "--tolerance", "1e-12"]);
    let seen: [f64; 18] = told(&then, "hill_seen");
    near([seen[2] / 1.05], [cosine], 1e-9);
}

fn run_in_forms(name: &str, page: &str, t_end: f64, check: impl Fn(&Value)) {
    for form in FORMS {
        let folder = Folder::new(&format!("rolling-{name}"));
        fs::write(folder.0.join("page.toml"), page).unwrap();
        let t_end = format!("{t_end:?}");
        check(&json(&folder, &[&["page.toml", "--t-end", &t_end], &EXACT[..], form].concat()));
    }
}

const GROUND: &str =
    "format = 1\nname = \"rolls\"\ngravity = [0, 0, -9.81]\n[[body]]\nname = \"ground\"\nfixed = true\n";

/// Down a plane that falls by the angle whose half has the tangent 0.15, with 2/3 of what would slide.
#[test]
fn a_roller_rolls_down_a_slope() {
    let k = 0.15_f64;
    let (sine, cosine) = (2.0 * k / (1.0 + k * k), (1.0 - k * k) / (1.0 + k * k));
    let page = format!(
        "{GROUND}[[body]]\nname = \"roller\"\nfree = true\nmass = 2\ninertia = [0.01, 0.01, 0.01]\n\
         position = [{:?}, 0, {:?}]\norientation = [1, 0, {k}, 0]\n[[rolling]]\nname = \"slope\"\nkind = \"cylinder\"\n\
         first = {{ body = \"ground\", orientation = [1, 0, {k}, 0] }}\nsecond = {{ body = \"roller\" }}\nradius = 0.1\n",
        0.1 * sine,
        0.1 * cosine
    );
    run_in_forms("slope", &page, 1.5, |run| {
        let seen: [f64; 18] = told(run, "slope_seen");
        let acceleration = 9.81 * sine * 2.0 / 3.0;
        near([seen[0], seen[2], seen[12]], [acceleration * 1.125, 0.1, acceleration * 1.5], 1e-9);
        let pushes = [number(run, "slope_normal"), number(run, "slope_along")];
        near(pushes, [2.0 * 9.81 * cosine, -2.0 * 9.81 * sine / 3.0], 1e-8);
    });
}

/// A wheel with a round rim on its circle: its contact moves to the side as it leans.
#[test]
fn a_round_rim_rolls_on_its_side() {
    let (k, m, r, rim, turn, g) = (0.2, 2.0, 0.3, 0.08, 2.0, 9.81);
    let (across, about) = (0.05, 0.09);
    let (cosine, sine) = (2.0 * k / (1.0 + k * k), (1.0 - k * k) / (1.0 + k * k));
    let speed = |spin: f64| -(r + rim * sine) * spin + rim * sine * cosine * turn;
    // The torque about the mass centre less what turns the angular momentum.
    let left = |spin: f64| {
        let v = speed(spin);
        let force = [m * (v * turn * cosine + g * sine), m * (-v * turn * sine + g * cosine)];
        let torque = -(r + rim * sine) * force[1] + rim * cosine * force[0];
        torque - turn * sine * (about * spin - across * turn * cosine)
    };
    let spin = left(0.0) / (left(0.0) - left(1.0));
    let page = format!(
        "{GROUND}[[body]]\nname = \"wheel\"\nfree = true\nmass = {m}\ninertia = [{across}, {about}, {across}]\n\
         position = [0, 0, {:?}]\norientation = [1, {k}, 0, 0]\nvelocity = [{:?}, 0, 0]\n\
         angular_velocity = [0, {spin:?}, {:?}]\n[[rolling]]\nname = \"tyre\"\nkind = \"torus\"\n\
         first = {{ body = \"ground\" }}\nsecond = {{ body = \"wheel\" }}\nradius = {r}\nrim = {rim}\n",
        r * sine + rim,
        -speed(spin),
        turn * sine
    );
    run_in_forms("torus", &page, PI, |run| {
        let seen: [f64; 18] = told(run, "tyre_seen");
        near([seen[0], seen[1], seen[2]], [0.0, 0.0, r * sine + rim], 1e-9);
    });
}

/// A skate under a sled that is kept level is the knife of Chaplygin's sleigh.
#[test]
fn a_skate_is_a_knife() {
    let sled = |edge: &str| {
        format!(
            "{GROUND}[[body]]\nname = \"sled\"\nmass = 2\ninertia = [0.1, 0.2, 0.25]\n[[joint]]\nname = \"ice\"\n\
             kind = \"planar\"\naxis = [0, 0, 1]\nzero = [1, 0, 0]\nfirst = {{ body = \"ground\" }}\n\
             second = {{ body = \"sled\", point = [-0.3, 0, 0] }}\nrate = [1, 0, 0.7]\n{edge}"
        )
    };
    let knife = sled(
        "[[constraint]]\nname = \"knife\"\nrate = \"cos(ice.angle)*(ice.y rate) - sin(ice.angle)*(ice.x rate)\"\n",
    );
    let skate = sled(
        "[[rolling]]\nname = \"edge\"\nkind = \"skate\"\nfirst = { body = \"ground\" }\n\
         second = { body = \"sled\", point = [-0.3, 0, 0] }\n",
    );
    let folder = Folder::new("rolling-knife");
    fs::write(folder.0.join("page.toml"), &knife).unwrap();
    let expected = json(&folder, &[&["page.toml", "--t-end", "1.3"], &EXACT[..]].concat());
    let place = |run: &Value| -> [f64; 3] {
        serde_json::from_value(run["joints"]["ice"]["position"].clone()).unwrap()
    };
    run_in_forms("skate", &skate, 1.3, |run| near(place(run), place(&expected), 1e-9));
}

/// A ball that grips along alone slips across without friction; one that grips in no direction slides.
#[test]
fn bodies_grip_as_they_are_told() {
    for (grip, x, y) in [
        ("both", 5.0 / 7.0, 5.0 / 7.0),
        ("along", 5.0 / 7.0, 1.0),
        ("across", 1.0, 5.0 / 7.0),
        ("none", 1.0, 1.0),
    ] {
        let page = format!(
            "{GROUND}[[body]]\nname = \"ball\"\nfree = true\nmass = 0.5\ninertia = [2e-3, 2e-3, 2e-3]\n\
             position = [0, 0, 0.1]\n[[rolling]]\nname = \"floor\"\nkind = \"sphere\"\ngrip = \"{grip}\"\n\
             first = {{ body = \"ground\" }}\nsecond = {{ body = \"ball\" }}\nradius = 0.1\n[[force]]\nname = \"push\"\n\
             kind = \"load\"\nbody = \"ball\"\nforce = [0.5, 0.25, 0]\n"
        );
        run_in_forms("grip", &page, 1.0, |run| {
            let seen: [f64; 18] = told(run, "floor_seen");
            near([seen[0], seen[1], seen[2]], [0.5 * x, 0.25 * y, 0.1], 1e-9);
        });
    }
}
