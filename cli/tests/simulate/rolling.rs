//! Constraints of one's own: knife edges, wheels, and a circle, against closed forms and the same equations integrated
//! here.

use crate::laws::{RUNS, integrated_one, run};
use crate::support::{Folder, json};
use serde_json::Value;
use std::array::from_fn;
use std::fs;

/// A body on a plane, at a point of it.
fn on_plane(at: &str, start: &str) -> String {
    format!(
        "format = 1\nname = \"plane\"\ngravity = [0, 0, -9.81]\n[[body]]\nname = \"ground\"\nfixed = true\n\
         [[body]]\nname = \"sled\"\nmass = 2\ninertia = [0.1, 0.2, 0.25]\n[[joint]]\nname = \"ice\"\n\
         kind = \"planar\"\naxis = [0, 0, 1]\nzero = [1, 0, 0]\nfirst = {{ body = \"ground\" }}\n\
         second = {{ body = \"sled\", point = {at} }}\n{start}\n"
    )
}

/// A wheel on an axle across the sled.
fn wheel(name: &str, y: f64, more: &str) -> String {
    format!(
        "[[body]]\nname = \"{name}_wheel\"\nmass = 0.5\ninertia = [0.02, 0.03, 0.02]\n[[joint]]\nname = \"{name}\"\n\
         kind = \"revolute\"\naxis = [0, 1, 0]\nzero = [0, 0, 1]\nfirst = {{ body = \"sled\", point = [0, {y:?}, 0] }}\n\
         second = {{ body = \"{name}_wheel\" }}\n{more}\n"
    )
}

const KNIFE: &str = "[[constraint]]\nname = \"knife\"\nrate = \"cos(ice.angle)*(ice.y rate) - sin(ice.angle)*(ice.x rate)\"\n\
     [[output]]\nname = \"side\"\nkind = \"constraint\"\nconstraint = \"knife\"\n";

/// Where a run ends, or how fast: a joint's coordinate.
fn last(run: &Value, joint: &str, what: &str, coordinate: usize) -> f64 {
    let of = &run["joints"][joint][what];
    of.as_f64().or_else(|| of[coordinate].as_f64()).unwrap_or_else(|| panic!("{joint} in {run}"))
}

fn is_near(run: &Value, expected: &[(&str, &str, usize, f64)], options: &[&str]) {
    for (joint, what, coordinate, expected) in expected {
        let found = last(run, joint, what, *coordinate);
        assert!((found - expected).abs() < 2e-9, "{options:?} {joint} {what}: {found}, not {expected}");
    }
    let violation = run["velocity_violation"].as_f64().unwrap();
    assert!(violation < 1e-9, "{options:?}: {violation}");
}

/// By Kutta's method.
pub(crate) fn kutta<const N: usize>(
    mut at: [f64; N],
    t_end: f64,
    slope: impl Fn([f64; N]) -> [f64; N],
) -> [f64; N] {
    let n = 20_000;
    let h = t_end / f64::from(n);
    for _ in 0..n {
        let ahead = |part: f64, k: [f64; N]| from_fn(|i| at[i] + part * h * k[i]);
        let a = slope(at);
        let b = slope(ahead(0.5, a));
        let c = slope(ahead(0.5, b));
        let d = slope(ahead(1.0, c));
        at = from_fn(|i| at[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
    }
    at
}

#[test]
fn a_sleigh_on_a_knife_moves_as_chaplygin_says() {
    let page =
        on_plane("[-0.3, 0, 0]", "angle = 0.4\nrate = [0.921060994002885, 0.389418342308651, 0.7]") + KNIFE;
    // v' = a w^2, w' = -m a v w / (J + m a^2), with the knife a behind the mass centre.
    let (a, m, j) = (0.3, 2.0, 0.25);
    let [v, w, angle, x, y] = kutta([1.0, 0.7, 0.4, 0.0, 0.0], 2.0, |[v, w, angle, ..]| {
        let turned = -m * a * v * w / (j + m * a * a);
        [a * w * w, turned, w, v * f64::cos(angle), v * f64::sin(angle)]
    });
    // The knife holds the mass centre across its way.
    let side = m * (v * w - a * m * a * v * w / (j + m * a * a));
    for options in RUNS {
        let run = run(&page, options, "2");
        let positions = [x, y, angle].into_iter().enumerate();
        let mut expected: Vec<_> = positions.map(|(k, value)| ("ice", "position", k, value)).collect();
        expected.push(("ice", "rate", 2, w));
        is_near(&run, &expected, options);
        let found = run["outputs"]["side"].as_f64().unwrap();
        assert!((found.abs() - side.abs()).abs() < 1e-8, "{options:?}: {found}, not {side}");
        assert_eq!(run["degrees_of_freedom"], 2);
    }
    // Once more: the second knife says what the first does.
    let twice = format!("{page}{}", KNIFE.split("[[output]]").next().unwrap().replace("knife", "again"));
    let run = run(&twice, RUNS[0], "2");
    is_near(&run, &[("ice", "position", 0, x), ("ice", "position", 1, y)], RUNS[0]);
    assert_eq!(run["redundant"].as_array().unwrap().len(), 1, "{}", run["redundant"]);
}

/// About a straight way the sleigh turns by itself or turns back: w' = -m a v w / (J + m a^2); nothing else changes.
#[test]
fn linearised_there_are_fewer_rates_than_coordinates() {
    let page = on_plane("[-0.3, 0, 0]", "rate = [1.5, 0, 0]") + KNIFE;
    let folder = Folder::new("straight");
    fs::write(folder.0.join("page.toml"), page).unwrap();
    let run = json(&folder, &["page.toml", "--linearize", "0"]);
    let mut eigenvalues: Vec<f64> = run["linearization"]["eigenvalues"]
        .as_array()
        .unwrap_or_else(|| panic!("{run}"))
        .iter()
        .map(|of| of[0].as_f64().unwrap())
        .collect();
    eigenvalues.sort_by(f64::total_cmp);
    assert_eq!(eigenvalues.len(), 5, "three coordinates, two rates");
    assert!((eigenvalues[0] + 2.0 * 0.3 * 1.5 / (0.25 + 2.0 * 0.09)).abs() < 1e-12, "{eigenvalues:?}");
    assert!(eigenvalues[1..].iter().all(|value| value.abs() < 1e-7), "{eigenvalues:?}");
}

/// It rolls on a circle, at constant rates.
#[test]
fn an_upright_wheel_rolls_on_a_circle() {
    let start = "angle = 0.4\nrate = [0.8289548946026, 0.3504765080777, 0.7]";
    let page = on_plane("[0, 0, 0]", start)
        + &wheel("roll", 0.0, "rate = 3")
        + "[[constraint]]\nname = \"along\"\nrate = \"ice.x rate - 0.3*cos(ice.angle)*(roll rate)\"\n\
           [[constraint]]\nname = \"across\"\nrate = \"ice.y rate - 0.3*sin(ice.angle)*(roll rate)\"\n";
    let (radius, angle) = (0.3 * 3.0 / 0.7, 0.4 + 0.7 * 2.0);
    let (x, y) = (radius * (f64::sin(angle) - f64::sin(0.4)), radius * (f64::cos(0.4) - f64::cos(angle)));
    for options in RUNS {
        let run = run(&page, options, "2");
        is_near(
            &run,
            &[("ice", "position", 0, x), ("ice", "position", 1, y), ("roll", "position", 0, 6.0)],
            options,
        );
    }
}

#[test]
fn two_driven_wheels_speed_up_and_turn() {
    let motor = |name: &str, value: f64| {
        format!(
            "[[force]]\nname = \"{name}_motor\"\nkind = \"motor\"\njoint = \"{name}\"\nvalue = {value:?}\n"
        )
    };
    let rolls = |name: &str, sign: char| {
        format!(
            "[[constraint]]\nname = \"of_{name}\"\nrate = \"cos(ice.angle)*(ice.x rate) + sin(ice.angle)*(ice.y rate) {sign} \
             d*(ice.angle rate) - r*({name} rate)\"\n"
        )
    };
    let page = on_plane("[0, 0, 0]", "").replacen("[[body]]", "[parameters]\nd = 0.2\nr = 0.1\n[[body]]", 1)
        + &wheel("left", 0.2, "")
        + &wheel("right", -0.2, "")
        + KNIFE
        + &rolls("left", '-')
        + &rolls("right", '+')
        + &motor("left", 0.05)
        + &motor("right", 0.08);
    let (d, r, axle, t): (f64, f64, f64, f64) = (0.2, 0.1, 0.03, 1.5);
    let forward = (0.05 + 0.08) / r / (2.0 + 2.0 * 0.5 + 2.0 * axle / (r * r));
    let turning = d * (0.08 - 0.05) / r / (0.25 + 2.0 * (0.5 * d * d + 0.02) + 2.0 * axle * d * d / (r * r));
    let part = 0.5 * t * t;
    for options in RUNS {
        let run = run(&page, options, "1.5");
        let expected = [
            ("ice", "position", 2, turning * part),
            ("left", "position", 0, (forward - d * turning) / r * part),
            ("right", "position", 0, (forward + d * turning) / r * part),
        ];
        is_near(&run, &expected, options);
        assert_eq!(run["degrees_of_freedom"], 2);
    }
}

/// A bead on two slides that a circle holds: A a'' + A' a'^2 / 2 + m g sin(a) = 0 with A = M cos^2 a + m sin^2 a.
#[test]
fn a_formula_that_is_zero_holds_a_bead_on_a_circle() {
    let slide = |name: &str, axis: &str, zero: &str, [first, second]: [&str; 2], start: &str| {
        format!(
            "[[joint]]\nname = \"{name}\"\nkind = \"prismatic\"\naxis = {axis}\nzero = {zero}\nfirst = {{ body = \
             \"{first}\" }}\nsecond = {{ body = \"{second}\" }}\ndisplacement = {start}\n"
        )
    };
    let body = |name: &str, mass: &str| format!("[[body]]\nname = \"{name}\"\n{mass}\n");
    let page = "format = 1\nname = \"bead\"\ngravity = [0, -9.81, 0]\n".to_owned()
        + &body("ground", "fixed = true")
        + &body("cart", "mass = 1\ninertia = [1, 1, 1]")
        + &body("bead", "mass = 2\ninertia = [1, 1, 1]")
        + &slide("x", "[1, 0, 0]", "[0, 1, 0]", ["ground", "cart"], "0.55\nrough = true")
        + &slide("y", "[0, 1, 0]", "[0, 0, 1]", ["cart", "bead"], "-0.8")
        + "[[constraint]]\nname = \"circle\"\nzero = \"x^2 + y^2 - 1\"\n";
    let [angle, _] = integrated_one([0.6_f64.asin(), 0.0], 1.3, |a, rate, _| {
        let (sine, cosine) = a.sin_cos();
        (sine * cosine * rate * rate - 2.0 * 9.81 * sine) / (3.0 * cosine * cosine + 2.0 * sine * sine)
    });
    for options in RUNS {
        let run = run(&page, options, "1.3");
        is_near(&run, &[("x", "position", 0, angle.sin()), ("y", "position", 0, -angle.cos())], options);
        assert!(run["constraint_violation"].as_f64().unwrap() < 1e-12);
    }
}

/// Every joint of a spatial loop has coordinates that a row names: whichever is cut, all engines have its rate.
#[test]
fn a_row_names_the_rates_of_a_cut_joint() {
    let end = |body: &str, point: &str| format!("{{ body = \"{body}\", point = {point} }}");
    let slide = |name: &str, ends: [String; 2], axis: &str| {
        let [first, second] = ends;
        format!(
            "[[joint]]\nname = \"{name}\"\nkind = \"cylindrical\"\naxis = {axis}\nzero = [1, 0, 0]\nfirst = {first}\n\
             second = {second}\n"
        )
    };
    let hooke = |name: &str, [first, second]: [&str; 2], y: f64| {
        format!(
            "[[joint]]\nname = \"{name}\"\nkind = \"universal\"\nfirst = {{ body = \"{first}\", point = [0.5, {y:?}, 0], \
             axis = [0, 0, 1], zero = [0, 1, 0] }}\nsecond = {{ body = \"{second}\", point = [-0.5, 0, 0.1], \
             axis = [0, 1, 0], zero = [0, 0, 1] }}\n"
        )
    };
    let bodies = ["a", "b", "c", "d"]
        .map(|name| format!("[[body]]\nname = \"{name}\"\nmass = 1\ninertia = [0.1, 0.2, 0.3]\n"));
    let page = "format = 1\nname = \"cut\"\ngravity = [1, -9, 2]\n[[body]]\nname = \"ground\"\nfixed = true\n"
        .to_owned()
        + &bodies.concat()
        + &slide("p", [end("ground", "[0.5, 0, 0]"), end("a", "[-0.5, 0, 0]")], "[0, 0, 1]")
        + &hooke("q", ["a", "b"], 0.3)
        + &hooke("r", ["b", "c"], -0.2)
        + &hooke("t", ["c", "d"], 0.4)
        + &slide("z", [end("d", "[0.5, 0, 0]"), end("ground", "[2.5, 0.7, 0.3]")], "[0, 1, 0]")
        + "[[constraint]]\nname = \"turns\"\nrate = \"p.angle rate - 0.3*(q.first_angle rate) + 0.2*(r.second_angle rate) \
           + 0.5*(z.angle rate) + 0.4*(t.first_angle rate) + 0.2*(r.first_angle rate)\"\n\
           [[constraint]]\nname = \"slides\"\nrate = \"p.displacement rate - 0.4*(z.displacement rate) + 0.1*sin(t.second_angle)*\
           (q.second_angle rate)\"\n";
    let ends = RUNS.map(|options| run(&page, options, "0.1"));
    for (found, options) in ends.iter().zip(RUNS) {
        let expected = [("p", 0), ("q", 1), ("r", 0), ("z", 1)]
            .map(|(joint, k)| (joint, "position", k, last(&ends[3], joint, "position", k)));
        is_near(found, &expected, options);
        assert_eq!(found["degrees_of_freedom"], 2);
    }
}
