//! Ready elements, against closed forms and their equations integrated here.

use crate::laws::{integrated_one, joint};
use crate::states::{RUNS, integrated, number, output, run};
use crate::support::{Folder, simulate};
use std::fs;

/// A wheel of 0.5 kg.m2 about the vertical, and what acts on it.
fn wheel(element: &str) -> String {
    format!(
        "format = 1\nname = \"wheel\"\n[inputs]\nu = 12\n[[body]]\nname = \"ground\"\nfixed = true\n[[body]]\n\
         name = \"wheel\"\nmass = 1\ninertia = [1, 1, 0.5]\n[[joint]]\nname = \"turn\"\nkind = \"revolute\"\n\
         axis = [0, 0, 1]\nzero = [1, 0, 0]\nfirst = {{ body = \"ground\" }}\nsecond = {{ body = \"wheel\" }}\n{element}"
    )
}

/// A cart of 2 kg on a rail, from 0.1 m at 0.3 m/s.
fn cart(element: &str) -> String {
    format!(
        "format = 1\nname = \"cart\"\n[[body]]\nname = \"ground\"\nfixed = true\n[[body]]\nname = \"cart\"\nmass = 2\n\
         inertia = [1, 1, 1]\n[[joint]]\nname = \"rail\"\nkind = \"prismatic\"\naxis = [1, 0, 0]\nzero = [0, 1, 0]\n\
         first = {{ body = \"ground\" }}\nsecond = {{ body = \"cart\" }}\ndisplacement = 0.1\nrate = 0.3\n{element}"
    )
}

fn near(found: &[f64], expected: &[f64], tolerance: f64, what: &str) {
    for (found, expected) in found.iter().zip(expected) {
        assert!(
            (found - expected).abs() < tolerance * expected.abs().max(1.0),
            "{what}: {found} for {expected}"
        );
    }
}

/// In every way of running it, the rail's place and rate after a time, and how the energy drifts.
fn carts(element: &str, t_end: &str, expected: [f64; 2], tolerance: f64) {
    for options in RUNS {
        let run = run(&cart(element), options, t_end);
        near(&joint(&run, "rail"), &expected, tolerance, &format!("{options:?}"));
        assert!(number(&run["energy_drift"]).abs() < 1e-7, "{options:?}: {}", run["energy_drift"]);
    }
}

/// Under a voltage that turns the current against the motion and back, where the loss jumps, the reference is of first
/// order; under a constant one it is not.
#[test]
fn a_motor_turns_a_wheel_through_a_gear_that_loses() {
    for (voltage, frequency, tolerance) in [("u", 0.0, 1e-9), ("u*cos(6*t)", 6.0, 1e-5)] {
        let element = format!(
            "damping = 2\n[[element]]\nname = \"m\"\nkind = \"dc_motor\"\njoint = \"turn\"\nvoltage = {voltage:?}\n\
             resistance = 1.5\ninductance = 0.05\nconstant = 0.1\nratio = 8\nefficiency = 0.7\n"
        );
        let expected = integrated([0.0; 3], 1.0, |[_, v, i], t| {
            let torque = 0.8 * i * if i * v >= 0.0 { 0.7 } else { 1.0 / 0.7 };
            [v, (torque - 2.0 * v) / 0.5, (12.0 * (frequency * t).cos() - 1.5 * i - 0.8 * v) / 0.05]
        });
        for options in RUNS {
            let run = run(&wheel(&element), options, "1");
            let [angle, rate] = joint(&run, "turn");
            near(&[angle, rate, output(&run, "m_current")], &expected, tolerance, &format!("{options:?}"));
        }
    }
}

#[test]
fn a_cylinder_pushes_by_its_pressures() {
    let element = "[[element]]\nname = \"ram\"\nkind = \"cylinder\"\njoint = \"rail\"\nopening = \"0.4*cos(3*t)\"\nsupply = 2e7\n\
        tank = 1e5\nvalve = 2e-8\narea = 2e-3\nrod_area = 1.2e-3\nstroke = 0.6\ndead_volume = 4e-4\nleakage = 1e-13\n\
        pressure = 5e6\n[[force]]\nname = \"hold\"\nkind = \"damper\"\njoint = \"rail\"\ndamping = 8e3\n";
    let root = |d: f64| d / (d * d + 1e6).sqrt().sqrt();
    let expected = integrated([0.1, 0.3, 5e6, 5e6], 1.0, |[x, v, a, b], t| {
        let u = 2e-8 * 0.4 * (3.0 * t).cos();
        let (into_a, into_b) = if u > 0.0 {
            (u * root(2e7 - a), -u * root(b - 1e5))
        } else {
            (u * root(a - 1e5), -u * root(2e7 - b))
        };
        let leak = 1e-13 * (a - b);
        [
            v,
            (2e-3 * a - 1.2e-3 * b - 8e3 * v) / 2.0,
            1.4e9 * (into_a - leak - 2e-3 * v) / (4e-4 + 2e-3 * x),
            1.4e9 * (into_b + leak + 1.2e-3 * v) / (4e-4 + 1.2e-3 * (0.6 - x)),
        ]
    });
    for options in RUNS {
        let run = run(&cart(element), options, "1");
        let [place, rate] = joint(&run, "rail");
        let pressures = ["ram_pressure_a", "ram_pressure_b"].map(|name| output(&run, name));
        near(&[place, rate, pressures[0], pressures[1]], &expected, 1e-7, &format!("{options:?}"));
    }
}

/// Along and about one axis: `½ a t²` and `½ α t²`.
#[test]
fn a_propeller_pushes_and_turns_back() {
    let page = "format = 1\nname = \"rotor\"\n[inputs]\nspeed = -300\n[[body]]\nname = \"frame\"\nfree = true\nmass = 1.5\n\
        inertia = [0.02, 0.02, 0.02]\n[[element]]\nname = \"p\"\nkind = \"propeller\"\nbody = \"frame\"\naxis = [0, 3, 4]\n\
        speed = \"speed\"\nthrust = -2e-5\ntorque = 3e-7\n[[output]]\nname = \"at\"\nkind = \"pose\"\nbody = \"frame\"\n\
        [[output]]\nname = \"moves\"\nkind = \"velocity\"\nbody = \"frame\"\n";
    let (along, about) = (2e-5 * 9e4 / 1.5, 3e-7 * 9e4 / 0.02);
    for options in RUNS {
        let run = run(page, options, "0.8");
        let numbers =
            |name: &str| run["outputs"][name].as_array().unwrap().iter().map(number).collect::<Vec<_>>();
        let place = [0.0, 0.6, 0.8].map(|part| part * along * 0.32);
        near(&numbers("at")[..3], &place, 1e-9, "place");
        let turns = [0.0, 0.6, 0.8].map(|part| part * about * 0.8);
        near(&numbers("moves")[3..], &turns, 1e-9, "turns");
    }
}

/// Down against the air: `v = v∞ tanh(g t / v∞)`, in a wind that rises at 3 m/s the same as seen from it.
#[test]
fn drag_holds_what_falls() {
    let page = "format = 1\nname = \"fall\"\ngravity = [0, 0, -9.81]\n[[body]]\nname = \"ball\"\nfree = true\nmass = 0.2\n\
        inertia = [1e-4, 1e-4, 1e-4]\nvelocity = [0, 0, 3]\n[[element]]\nname = \"air\"\nkind = \"drag\"\nbody = \"ball\"\n\
        area = 0.01\ncoefficient = 0.5\nwind = [0, 0, 3]\n[[output]]\nname = \"at\"\nkind = \"pose\"\nbody = \"ball\"\n";
    let last: f64 = (0.2 * 9.81 / (0.5 * 1.225 * 0.01 * 0.5_f64)).sqrt();
    let fall = last * last / 9.81 * (9.81 * 2.0 / last).cosh().ln();
    for options in RUNS {
        let run = run(page, options, "2");
        let found = [number(&run["outputs"]["at"][2]), number(&run["outputs"]["air_air"][2])];
        near(&found, &[6.0 - fall, 3.0 - last * (9.81 * 2.0 / last).tanh()], 1e-9, &format!("{options:?}"));
    }
}

/// What its damper pulls with jumps as the wire goes slack: there the reference is of first order.
#[test]
fn a_wire_pulls_and_never_pushes() {
    for (damping, tolerance) in [(0.0, 1e-8), (12.0, 1e-5)] {
        let element = format!(
            "[[element]]\nname = \"w\"\nkind = \"wire\"\nfirst = {{ body = \"ground\", point = [-0.1, 0, 0] }}\n\
             second = {{ body = \"cart\" }}\nstiffness = 400\ndamping = {damping}\n\
             free_length = \"0.25 + 0.02*sin(9*t)\"\n"
        );
        let expected = integrated_one([0.1, 0.3], 0.9, |x, v, t| {
            let over = x + 0.1 - 0.25 - 0.02 * (9.0 * t).sin();
            if over > 0.0 { -(400.0 * over + damping * v).max(0.0) / 2.0 } else { 0.0 }
        });
        carts(&element, "0.9", expected, tolerance);
    }
}

/// Over two pulleys at 0.4 m and 0.8 m, from a cart to another that hangs: the pull is along both ends.
#[test]
fn a_rope_pulls_alike_at_both_ends() {
    let page = "format = 1\nname = \"tackle\"\ngravity = [0, -9.81, 0]\n[[body]]\nname = \"ground\"\nfixed = true\n[[body]]\n\
        name = \"cart\"\nmass = 3\ninertia = [1, 1, 1]\n[[body]]\nname = \"bob\"\nmass = 1\ninertia = [1, 1, 1]\n[[joint]]\n\
        name = \"rail\"\nkind = \"prismatic\"\naxis = [1, 0, 0]\nzero = [0, 1, 0]\nfirst = { body = \"ground\" }\n\
        second = { body = \"cart\" }\ndisplacement = -0.3\n[[joint]]\nname = \"fall\"\nkind = \"prismatic\"\n\
        axis = [0, -1, 0]\nzero = [1, 0, 0]\nfirst = { body = \"ground\", point = [0.8, 0, 0] }\n\
        second = { body = \"bob\" }\ndisplacement = 0.1\n[[element]]\nname = \"rope\"\nkind = \"rope\"\nstiffness = 2e3\n\
        damping = 15\nfree_length = 1.65\npoints = [{ body = \"cart\" }, { body = \"ground\", point = [0.4, 0.5, 0] },\n\
        { body = \"ground\", point = [0.8, 0.2, 0] }, { body = \"bob\" }]\n";
    let pull = |x: f64, y: f64, vx: f64, vy: f64| {
        let near = (x - 0.4).hypot(0.5);
        let over = near + 0.5 + 0.2 + y - 1.65;
        let rate = (x - 0.4) * vx / near + vy;
        (if over > 0.0 { (2e3 * over + 15.0 * rate).max(0.0) } else { 0.0 }, (0.4 - x) / near)
    };
    let expected = integrated([-0.3, 0.1, 0.0, 0.0], 0.6, |[x, y, vx, vy], _| {
        let (pull, along) = pull(x, y, vx, vy);
        [vx, vy, pull * along / 3.0, 9.81 - pull]
    });
    for options in RUNS {
        let run = run(page, options, "0.6");
        let ([x, vx], [y, vy]) = (joint(&run, "rail"), joint(&run, "fall"));
        near(&[x, y, vx, vy], &expected, 1e-7, &format!("{options:?}"));
        let parts = ["rope_1", "rope_2", "rope_3"].map(|name| number(&run["outputs"][name][0]));
        near(&parts, &[-pull(x, y, vx, vy).0; 3], 1e-6, &format!("{options:?}"));
    }
}

/// A rope that does not give at all is a coupler: over three pulleys, the middle one on the load, its length stays.
#[test]
fn a_rope_over_three_pulleys_keeps_its_length() {
    let slide = |name: &str, at: f64, start: f64| {
        format!(
            "[[body]]\nname = \"{name}\"\nmass = 2\ninertia = [1, 1, 1]\n[[joint]]\nname = \"{name}_down\"\n\
             kind = \"prismatic\"\naxis = [0, 0, -1]\nzero = [1, 0, 0]\nfirst = {{ body = \"ground\", point = [{at}, 0, 0] }}\n\
             second = {{ body = \"{name}\" }}\ndisplacement = {start}\n"
        )
    };
    let page = format!(
        "format = 1\nname = \"pulleys\"\ngravity = [0, 0, -9.81]\n[[body]]\nname = \"ground\"\nfixed = true\n{}{}{}\
         [[coupler]]\nname = \"rope\"\nsecond = {{ joint = \"right_down\" }}\n\
         formula = \"3 - left_down - 2*hypot(load_down, 0.2)\"\n[[output]]\nname = \"length\"\nkind = \"formula\"\n\
         of = \"left_down + right_down + 2*hypot(load_down, 0.2)\"\n",
        slide("left", -0.2, 0.8),
        slide("load", 0.0, 0.6),
        slide("right", 0.2, 3.0 - 0.8 - 2.0 * 0.6_f64.hypot(0.2)).replace("mass = 2", "mass = 1.8"),
    );
    for options in RUNS {
        let run = run(&page, options, "0.4");
        near(&[output(&run, "length")], &[3.0], 1e-14, &format!("{options:?}"));
        assert!((number(&run["joints"]["load_down"]["position"]) - 0.6).abs() > 1e-3);
    }
}

/// Two rotors on a shaft with a gear: `θ̈₂ = −(k z + d ż)/J₂`, `θ̈₁ = r (k z + d ż)/J₁` with `z = θ₂ − r θ₁ − z₀`.
#[test]
fn a_shaft_twists() {
    let page = wheel(
        "rate = 2\n[[body]]\nname = \"fan\"\nmass = 1\ninertia = [1, 1, 0.2]\n[[joint]]\nname = \"fan_turn\"\n\
         kind = \"revolute\"\naxis = [0, 0, 1]\nzero = [1, 0, 0]\nfirst = { body = \"ground\" }\nsecond = { body = \"fan\" }\n\
         [[element]]\nname = \"s\"\nkind = \"shaft\"\nfirst = { joint = \"turn\" }\nsecond = { joint = \"fan_turn\" }\n\
         stiffness = 40\ndamping = 0.3\nratio = -2\nfree = 0.1\n",
    );
    let torque = |a: f64, b: f64, va: f64, vb: f64| 40.0 * (b + 2.0 * a - 0.1) + 0.3 * (vb + 2.0 * va);
    let expected = integrated([0.0, 0.0, 2.0, 0.0], 1.0, |[a, b, va, vb], _| {
        let t = torque(a, b, va, vb);
        [va, vb, -2.0 * t / 0.5, -t / 0.2]
    });
    for options in RUNS {
        let run = run(&page, options, "1");
        let ([a, va], [b, vb]) = (joint(&run, "turn"), joint(&run, "fan_turn"));
        near(&[a, b, va, vb], &expected, 1e-8, &format!("{options:?}"));
        assert!(number(&run["energy_drift"]).abs() < 1e-7, "{options:?}");
    }
}

/// About one axis the Cardan angles are one angle: `J θ̈ = −k (θ − θ₀) − d θ̇`.
#[test]
fn a_ball_joint_springs_back() {
    let page = "format = 1\nname = \"ball\"\n[[body]]\nname = \"ground\"\nfixed = true\n[[body]]\nname = \"stick\"\nmass = 1\n\
        inertia = [0.3, 0.4, 0.5]\nangular_velocity = [0.5, 0, 0]\n[[joint]]\nname = \"ball\"\nkind = \"spherical\"\n\
        first = { body = \"ground\", point = [0, 0, 1] }\nsecond = { body = \"stick\", point = [0.1, 0, 0] }\n\
        [[element]]\nname = \"s\"\nkind = \"ball_spring\"\njoint = \"ball\"\nstiffness = 5\ndamping = 0.2\n\
        orientation = [1, 0.1, 0, 0]\n[[output]]\nname = \"at\"\nkind = \"pose\"\nbody = \"stick\"\n";
    let rest = 2.0 * 0.1_f64.atan();
    let [angle, _] = integrated_one([0.0, 0.5], 1.5, |x, v, _| (-5.0 * (x - rest) - 0.2 * v) / 0.3);
    for options in RUNS {
        let run = run(page, options, "1.5");
        let at: Vec<f64> = run["outputs"]["at"].as_array().unwrap().iter().map(number).collect();
        near(&[2.0 * at[4].atan2(at[3])], &[angle], 1e-9, &format!("{options:?}"));
    }
}

/// Without damping a ball leaves a wall as fast as it came.
#[test]
fn a_ball_bounces_by_the_law_of_hertz() {
    let element = |side: &str, more: &str| {
        let limit = if side == "upper" { 0.2 } else { 0.05 };
        format!(
            "[[element]]\nname = \"wall\"\nkind = \"impact\"\njoint = \"rail\"\nlimit = {limit}\nside = {side:?}\n\
             stiffness = 1e5\n{more}"
        )
    };
    let law = |d: f64, v: f64, damping: f64| {
        if d > 0.0 { 1e5 * d.powf(1.5) * (1.0 + damping * v).max(0.0) } else { 0.0 }
    };
    let hertz = integrated_one([0.1, 0.3], 0.6, |x, v, _| -law(x - 0.2, v, 0.0) / 2.0);
    near(&hertz[1..], &[-0.3], 1e-8, "as fast");
    carts(&element("upper", ""), "0.6", hertz, 1e-8);
    let both = element("upper", "damping = 1.2\n")
        + &element("lower", "damping = 0.4\nexponent = 1.5\n").replace("wall", "door");
    let lossy =
        integrated_one([0.1, 0.3], 1.5, |x, v, _| (law(0.05 - x, -v, 0.4) - law(x - 0.2, v, 1.2)) / 2.0);
    carts(&both, "1.5", lossy, 1e-7);
}

#[test]
fn friction_falls_with_speed() {
    let element = "[[element]]\nname = \"f\"\nkind = \"stribeck\"\njoint = \"rail\"\nlevel = 2\nstatic_level = 3\n\
        stribeck_rate = 0.05\nrate = 0.01\nviscous = 0.4\n[[force]]\nname = \"s\"\nkind = \"motor\"\njoint = \"rail\"\n\
        value = \"8*sin(5*t)\"\n";
    let expected = integrated_one([0.1, 0.3], 1.0, |_, v, t| {
        let level = 2.0 + (-(v / 0.05_f64).powi(2)).exp();
        (8.0 * (5.0 * t).sin() - level * (v / 0.01).tanh() - 0.4 * v) / 2.0
    });
    carts(element, "1", expected, 1e-8);
}

#[test]
fn bristles_of_an_element_bend_as_their_equations_do() {
    let element = "[[element]]\nname = \"f\"\nkind = \"lugre\"\njoint = \"rail\"\nlevel = 1\nstatic_level = 1.5\n\
        stribeck_rate = 0.01\nbristle_stiffness = 1e3\nbristle_damping = 30\nviscous = 0.4\n[[force]]\nname = \"s\"\n\
        kind = \"motor\"\njoint = \"rail\"\nvalue = \"3*sin(5*t)\"\n";
    let [x, v, _] = integrated([0.1, 0.3, 0.0], 1.0, |[_, v, z], t| {
        let level = 1.0 + 0.5 * (-(v / 0.01).powi(2)).exp();
        let bends = v - v.abs() * z * 1e3 / level;
        [v, (3.0 * (5.0 * t).sin() - 1e3 * z - 30.0 * bends - 0.4 * v) / 2.0, bends]
    });
    carts(element, "1", [x, v], 1e-8);
}

/// What is wrong with an element is said once, at its own place.
#[test]
fn mistakes_in_elements_are_shown_where_they_are() {
    let folder = Folder::new("wrong-elements");
    let shown = |element: &str| {
        fs::write(folder.0.join("page.toml"), wheel(element)).unwrap();
        let output = simulate(&folder, &["page.toml"]);
        assert_eq!(output.status.code(), Some(2));
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    let one = |said: &str, parts: &[&str]| {
        assert!(parts.iter().all(|part| said.contains(part)), "{said}");
        assert_eq!(said.matches("error:").count(), 1, "{said}");
    };
    let motor = "[[element]]\nname = \"m\"\nkind = \"dc_motor\"\njoint = \"turn\"\nvoltage = \"u\"\nresistance = 1\n\
        inductance = 1\nconstant = 1\n";
    one(&shown(&motor.replace("\"u\"", "\"2*uu + 1\"")), &["uu", "page.toml:23:14"]);
    one(&shown(&motor.replace("inductance = 1\n", "")), &["element `m` has no `inductance`"]);
    one(
        &shown(&motor.replace("resistance = 1", "resistance = -1")),
        &["the resistance of element `m` is not positive"],
    );
    one(&shown(&motor.replace("\"turn\"", "\"tern\"")), &["there is no joint `tern`"]);
    one(&shown(&motor.replace("dc_motor", "dc-motor")), &["unknown kind of element"]);
    one(&shown(&motor.replace("constant", "konstant")), &["konstant"]);
}
