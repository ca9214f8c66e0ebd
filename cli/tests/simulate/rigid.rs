//! Rigid `[[contact]]` between shapes of bodies, with impacts and friction that holds: against closed forms.

use crate::rolling_bodies::{EXACT, near, told};
use crate::support::{Folder, refused, simulate};
use crate::touching::run;
use serde_json::Value;
use std::fs;

const G: f64 = 9.81;

fn ground(gravity: [f64; 3]) -> String {
    format!(
        "format = 1\nname = \"rigid\"\ngravity = {gravity:?}\n[[body]]\nname = \"ground\"\nfixed = true\n[[body.shape]]\n\
         name = \"top\"\nplane = [2, 2]\n"
    )
}

fn body(name: &str, [position, velocity, spin]: [[f64; 3]; 3], inertia: [f64; 3], shape: &str) -> String {
    format!(
        "[[body]]\nname = \"{name}\"\nfree = true\nmass = 1\ninertia = {inertia:?}\nposition = {position:?}\n\
         velocity = {velocity:?}\nangular_velocity = {spin:?}\n{shape}\n[[output]]\nname = \"{name}_at\"\nkind = \"pose\"\n\
         body = \"{name}\"\n[[output]]\nname = \"{name}_moves\"\nkind = \"velocity\"\nbody = \"{name}\"\n"
    )
}

fn between(name: &str, one: &str, other: &str, law: &str) -> String {
    format!("[[contact]]\nname = \"{name}\"\nbetween = [{{ {one} }}, {{ {other} }}]\n{law}\n")
}

fn moves(run: &Value, name: &str) -> [f64; 6] {
    told(run, &format!("{name}_moves"))
}

/// How the ball moves, by the axes of the ground.
fn seen(run: &Value) -> [f64; 6] {
    let seen: [f64; 18] = told(run, "bounces_seen");
    std::array::from_fn(|k| seen[12 + k])
}

/// What an impact leaves of a ball that spins: friction μ times the push, until nothing slips. A unit impulse changes
/// the slip of a full ball by 7/2.
fn struck(v: [f64; 3], w: [f64; 3], [r, e, mu]: [f64; 3]) -> ([f64; 3], [f64; 3]) {
    let slip = [v[0] - r * w[1], v[1] + r * w[0]];
    let speed = slip[0].hypot(slip[1]);
    let impulse = (mu * (1.0 + e) * v[2].abs()).min(speed / 3.5);
    let [along, across] = slip.map(|slip| if speed > 0.0 { -impulse * slip / speed } else { 0.0 });
    let turn = 2.5 / r;
    ([v[0] + along, v[1] + across, -e * v[2]], [w[0] + turn * across, w[1] - turn * along, w[2]])
}

/// A ball with spin bounces, slides and rolls: each flight is a parabola, each impact in closed form, and in the end it
/// rolls with what its angular momentum about the ground has left: 5/7 of the velocity and 2/7 of the spin.
#[test]
fn a_ball_with_spin_bounces_and_comes_to_roll() {
    let (r, e) = (0.1, 0.8);
    let (start, spin) = ([1.0, -0.5, 0.0], [30.0, -80.0, 7.0]);
    for (mu, law) in [(0.02, "newton"), (0.3, "poisson")] {
        let page = ground([0.0, 0.0, -G])
            + &body(
                "ball",
                [[0.0, 0.0, 1.0 + r], start, spin],
                [0.4 * r * r; 3],
                "[[body.shape]]\nsphere = 0.1",
            )
            + &between(
                "bounces",
                "body = \"ground\"",
                "body = \"ball\"",
                &format!("restitution = {e}\nimpact_law = \"{law}\"\nfriction_coefficient = {mu}"),
            );
        let (mut t, mut at, mut v, mut w) = (0.0, [0.0, 0.0, 1.0_f64], start, spin);
        for bounce in 0..6 {
            let flight = if bounce == 0 { (2.0 / G).sqrt() } else { 2.0 * v[2] / G };
            t += flight;
            v[2] -= G * flight;
            at = [at[0] + v[0] * flight, at[1] + v[1] * flight, 0.0];
            (v, w) = struck(v, w, [r, e, mu]);
            // In the middle of the flight after it.
            let half = v[2] / G;
            let run = run(
                "rigid-ball",
                &page,
                &[&["--t-end", &format!("{:?}", t + half)], &EXACT[..]].concat(),
                &[],
            );
            near(seen(&run), [v[0], v[1], 0.0, w[0], w[1], w[2]], 1e-9);
            let place: [f64; 7] = told(&run, "ball_at");
            near([place[0], place[1]], [at[0] + v[0] * half, at[1] + v[1] * half], 1e-9);
            near([place[2] - r], [0.5 * v[2] * half], 1e-9);
        }
        let run = run("rigid-rolls", &page, &[&["--t-end", "20"], &EXACT[..]].concat(), &[]);
        let rolls = [0, 1].map(|k| 5.0 / 7.0 * start[k] + 2.0 / 7.0 * r * [spin[1], -spin[0]][k]);
        near(seen(&run), [rolls[0], rolls[1], 0.0, -rolls[1] / r, rolls[0] / r, spin[2]], 1e-8);
        assert!(told::<7>(&run, "ball_at")[2] - r < 1e-15);
    }
}

/// Three crates upon each other on a slope: below the angle of friction nothing moves, above it all slide as one, at
/// which each is just held by the one below.
#[test]
fn a_stack_rests_or_slides_as_one() {
    let mu = 0.3;
    for slope in [0.29, 0.36_f64] {
        let gravity = [G * slope.atan().sin(), 0.0, -G * slope.atan().cos()];
        let mut page = ground(gravity);
        for k in 0..3 {
            let shape = "[[body.shape]]\nname = \"box\"\nbox = [0.4, 0.3, 0.2]\n[[body.shape]]\nname = \"top\"\nplane = [0.4, 0.3]\n\
                 position = [0, 0, 0.1]";
            let at = [0.01 * f64::from(k), 0.02 * f64::from(k), 0.1 + 0.2 * f64::from(k)];
            page += &body(&format!("crate{k}"), [at, [0.0; 3], [0.0; 3]], [0.01, 0.012, 0.02], shape);
            let below = if k == 0 { "ground".to_owned() } else { format!("crate{}", k - 1) };
            page += &between(
                &format!("on{k}"),
                &format!("body = \"{below}\", shape = \"top\""),
                &format!("body = \"crate{k}\", shape = \"box\""),
                &format!("restitution = 0\nfriction_coefficient = {mu}"),
            );
        }
        let run = run("rigid-stack", &page, &["--t-end", "0.3"], &[]);
        let slides = (gravity[0] + mu * gravity[2]).max(0.0) * 0.3;
        for k in 0..3 {
            near(moves(&run, &format!("crate{k}")), [slides, 0.0, 0.0, 0.0, 0.0, 0.0], 1e-9);
            let at: [f64; 7] = told(&run, &format!("crate{k}_at"));
            near([at[2]], [0.1 + 0.2 * f64::from(k)], 1e-14);
        }
    }
}

/// Balls in a row. One after another they hand on what the first had; where they touch, and all is resolved at one
/// time, Newton's law gives −1/3, 2/3, 2/3 of it: both keep energy and momentum.
#[test]
fn balls_in_a_row_hand_on_what_they_have() {
    for (apart, expected) in [(1e-3, [0.0, 0.0, 1.0]), (0.0, [-1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0])] {
        let mut page = ground([0.0; 3]);
        for k in 0..3 {
            let x = if k == 0 { -0.1 } else { 0.2 + (0.2 + apart) * f64::from(k - 1) };
            let v = if k == 0 { 1.0 } else { 0.0 };
            page += &body(
                &format!("ball{k}"),
                [[x, 0.0, 0.0], [v, 0.0, 0.0], [0.0; 3]],
                [0.004; 3],
                "[[body.shape]]\nsphere = 0.1",
            );
        }
        for k in 0..2 {
            let [one, other] = [k, k + 1].map(|k| format!("body = \"ball{k}\""));
            page += &between(&format!("hits{k}"), &one, &other, "restitution = 1");
        }
        let run = run("rigid-row", &page, &[&["--t-end", "0.5"], &EXACT[..]].concat(), &[]);
        near([0, 1, 2].map(|k| moves(&run, &format!("ball{k}"))[0]), expected, 1e-12);
    }
}

/// A block that rocks (Housner 1963): when it comes from one edge to the other, without rebound, 1 − 3/2 sin² a of its
/// angular velocity is left, a being the angle of its diagonal.
#[test]
fn a_rocking_block_loses_what_housner_says() {
    let (b, h): (f64, f64) = (0.1, 0.4);
    let (radius, alpha) = (b.hypot(h), (b / h).atan());
    let about = (b * b + h * h) / 3.0;
    let left = 1.0 - 1.5 * alpha.sin().powi(2);
    let tilt: f64 = 0.1;
    // Its energy about the edge, from where it is let go to where it lies flat.
    let height = |tilt: f64| radius * (alpha - tilt).cos();
    let edge = about + radius * radius;
    let falls = (2.0 * G * (height(tilt) - height(0.0)) / edge).sqrt();
    // Turned about the edge at x = b.
    let (sine, cosine) = tilt.sin_cos();
    let at = [b - (b * cosine - h * sine), 0.0, b * sine + h * cosine];
    let shape = format!("[[body.shape]]\nbox = [{:?}, 0.4, {:?}]", 2.0 * b, 2.0 * h);
    let turned = format!("orientation = [{:?}, 0, {:?}, 0]\n", (tilt / 2.0).cos(), (tilt / 2.0).sin());
    let page = ground([0.0, 0.0, -G])
        + &body("block", [at, [0.0; 3], [0.0; 3]], [about, about, about], &(turned + &shape))
        + &between(
            "rocks",
            "body = \"ground\"",
            "body = \"block\"",
            "restitution = 0\nfriction_coefficient = 2",
        );
    let folder = Folder::new("rigid-block");
    fs::write(folder.0.join("page.toml"), &page).unwrap();
    let events = run("rigid-block", &page, &[&["--t-end", "2"], &EXACT[..]].concat(), &[]);
    let hits = events["events"].as_array().unwrap().iter().filter(|event| event["what"] == "hits lower");
    let first = hits.map(|event| event["t"].as_f64().unwrap()).next().expect("it falls");
    let at = |t: f64| {
        moves(
            &run("rigid-block", &page, &[&["--t-end", &format!("{t:?}")], &EXACT[..]].concat(), &[]),
            "block",
        )
    };
    near([at(first - 1e-9)[4], at(first + 1e-9)[4]], [-falls, -falls * left], 1e-7);
}

/// A crate that falls flat and obliquely, so slowly turned by its friction that it stays flat: all four corners have
/// friction in the direction of one slip, and what they have together is that of a point.
#[test]
fn a_crate_that_lands_flat_slides_on_straight() {
    let (mu, height, fast) = (0.3, 0.2, [2.0, -1.5]);
    let page = ground([0.0, 0.0, -G])
        + &body(
            "crate",
            [[0.0, 0.0, 0.1 + height], [fast[0], fast[1], 0.0], [0.0; 3]],
            [0.01, 0.012, 0.02],
            "[[body.shape]]\nbox = [0.4, 0.3, 0.2]",
        )
        + &between(
            "lands",
            "body = \"ground\"",
            "body = \"crate\"",
            &format!("restitution = 0\nfriction_coefficient = {mu}"),
        );
    let lands = (2.0 * height / G).sqrt();
    let after = 2.5 - mu * G * lands;
    for t in [lands + 1e-6, lands + 0.1, lands + 2.0] {
        let run = run("rigid-lands", &page, &[&["--t-end", &format!("{t:?}")], &EXACT[..]].concat(), &[]);
        let speed = (after - mu * G * (t - lands)).max(0.0) / 2.5;
        near(moves(&run, "crate"), [fast[0] * speed, fast[1] * speed, 0.0, 0.0, 0.0, 0.0], 1e-9);
    }
}

/// What has a round rim and rocks comes to lie flat on it, and slides there as a block does.
#[test]
fn what_is_round_lies_flat() {
    let (r, mu) = (0.1, 0.3);
    let law = format!("restitution = 0.2\nfriction_coefficient = {mu}");
    for (shape, half) in [("cylinder = [0.1, 0.02]", 0.01), ("torus = [0.1, 0.02]", 0.02)] {
        let shape = format!("[[body.shape]]\n{shape}");
        let page = |gravity, start| {
            ground(gravity)
                + &body("coin", start, [0.0025, 0.0025, 0.005], &shape)
                + &between("lies", "body = \"ground\"", "body = \"coin\"", &law)
        };
        for spin in [[0.0, -2.0, 0.0], [0.0, 1.0, 0.0]] {
            let thrown = page([0.0, 0.0, -G], [[0.0, 0.0, 0.2], [0.0; 3], spin]);
            let run = run("rigid-flat", &thrown, &EXACT, &["--t-end", "2"]);
            assert!(run["energy_drift"].as_f64().unwrap() < 1e-8, "{shape}: {}", run["energy_drift"]);
            near(moves(&run, "coin"), [0.0; 6], 1e-9);
            let [_, _, height, _, x, y, _] = told(&run, "coin_at");
            near([height - half, x * x + y * y], [1e-6 * r, 0.0], 1e-12);
        }
        for slope in [0.29, 0.36_f64] {
            let (sin, cos) = slope.atan().sin_cos();
            let flat = [[0.0, 0.0, half + 1e-6 * r], [0.0; 3], [0.0; 3]];
            let run = run("rigid-slides", &page([G * sin, 0.0, -G * cos], flat), &EXACT, &["--t-end", "1"]);
            let rate = if slope > mu { G * (sin - mu * cos) } else { 0.0 };
            near(moves(&run, "coin"), [rate, 0.0, 0.0, 0.0, 0.0, 0.0], 1e-9);
        }
    }
}

/// Bodies of all shapes that are thrown upon each other: they bounce, slide, roll and come to lie, and no energy
/// is lost but what impacts and friction take.
#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn what_is_thrown_keeps_its_ledger() {
    for (seed, page) in (400..412).map(|seed| (seed, gyro_pages::scene(seed))) {
        let drift = run(&format!("rigid-thrown-{seed}"), &page, &[], &[])["energy_drift"].as_f64().unwrap();
        assert!(drift < 1e-8, "scene {seed}: {drift}");
    }
}

#[test]
fn laws_that_do_not_go_together_are_refused() {
    for (law, words) in [
        ("restitution = 0.5\nstiffness = 1", "is rigid: it has a restitution"),
        ("stiffness = 1\nimpact_law = \"poisson\"", "is not rigid: it has no restitution"),
        ("restitution = 1.5", "is not between 0 and 1"),
        (
            "restitution = 0.5\nfriction_coefficient = 0.3\nstatic_friction_coefficient = 0.2",
            "below the kinetic one",
        ),
    ] {
        let page = ground([0.0; 3])
            + &body("ball", [[0.0, 0.0, 1.0], [0.0; 3], [0.0; 3]], [1.0; 3], "[[body.shape]]\nsphere = 0.1")
            + &between("c", "body = \"ground\"", "body = \"ball\"", law);
        let folder = Folder::new("rigid-refused");
        fs::write(folder.0.join("page.toml"), &page).unwrap();
        refused(&simulate(&folder, &["page.toml"]), words);
    }
}
