//! Numbers that a program computed in floating point and wrote with ten digits or more are taken as what they round,
//! and what is wrong beyond that is refused with numbers that differ to the eye.

use chacha20::ChaCha8Rng;
use rand::{RngExt, SeedableRng};

fn read(body: &str) -> Result<gyro_model::Model, String> {
    let page =
        format!("format = 1\nname = \"plate\"\n[[body]]\nname = \"plate\"\nfree = true\nmass = 1\n{body}\n");
    gyro_model::read("plate.toml", &page).map_err(|mistakes| mistakes.render())
}

/// Moments of a rigid body of three principal second moments of mass, turned, as a program would sum them up.
fn turned(second: [f64; 3], angles: [f64; 3]) -> [f64; 6] {
    let [a, b, c] = angles.map(f64::sin_cos);
    let rotation = [
        [b.1 * c.1, -b.1 * c.0, b.0],
        [a.1 * c.0 + a.0 * b.0 * c.1, a.1 * c.1 - a.0 * b.0 * c.0, -a.0 * b.1],
        [a.0 * c.0 - a.1 * b.0 * c.1, a.0 * c.1 + a.1 * b.0 * c.0, a.1 * b.1],
    ];
    let of_mass =
        |i: usize, j: usize| (0..3).map(|k| rotation[i][k] * second[k] * rotation[j][k]).sum::<f64>();
    let trace: f64 = (0..3).map(|k| of_mass(k, k)).sum();
    let moment = |i: usize| trace - of_mass(i, i);
    [moment(0), moment(1), moment(2), -of_mass(0, 1), -of_mass(0, 2), -of_mass(1, 2)]
}

fn written([xx, yy, zz, xy, xz, yz]: [f64; 6], digits: usize) -> String {
    let digits = digits - 1;
    format!(
        "inertia = {{ xx = {xx:.digits$e}, yy = {yy:.digits$e}, zz = {zz:.digits$e}, xy = {xy:.digits$e}, \
         xz = {xz:.digits$e}, yz = {yz:.digits$e} }}"
    )
}

#[test]
fn plates_and_rods_that_a_program_summed_up_are_bodies() {
    let mut dice = ChaCha8Rng::seed_from_u64(40);
    for case in 0..400 {
        let scale = 10f64.powi(dice.random_range(-8..4));
        let mut second: [f64; 3] = std::array::from_fn(|_| scale * dice.random_range(0.01..1.0));
        // A plate has no second moment across; one that is a thousandth of that is thicker.
        second[dice.random_range(0..3)] = 0.0;
        let angles =
            if case % 3 == 0 { [0.0; 3] } else { std::array::from_fn(|_| dice.random_range(-3.2..3.2)) };
        let moments = turned(second, angles);
        for digits in [17, 15, 12, 11] {
            let text = written(moments, digits);
            assert!(read(&text).is_ok(), "{text}: {}", read(&text).unwrap_err());
        }
        // A negative second moment, a ten-millionth of the largest, is none.
        let thin = second.iter().position(|moment| *moment == 0.0).unwrap();
        second[thin] = -1e-7 * second.iter().copied().fold(0.0, f64::max);
        let text = written(turned(second, angles), 17);
        let refused = read(&text).expect_err(&text);
        assert!(refused.contains("breaks the triangle inequality"), "{text}: {refused}");
    }
}

/// The two numbers of the message differ where a diagonal element is too large.
#[test]
fn what_is_refused_shows_numbers_that_differ() {
    let refused =
        read("inertia = [0.009546518518518518, 0.009546518518518518, 0.019093037237037037]").unwrap_err();
    let sentence = refused.lines().find(|line| line.contains("exceeds")).expect("the label").to_owned();
    let numbers: Vec<f64> = sentence.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    assert!(numbers.len() == 2 && numbers[0] > numbers[1], "{sentence}");
    assert!(read("inertia = [0.009546518518518518, 0.009546518518518518, 0.019093037037037037]").is_ok());
}

/// A zero direction along the axis but for rounding gives no angle to measure.
#[test]
fn directions_that_are_parallel_but_for_rounding_are_refused() {
    let mut dice = ChaCha8Rng::seed_from_u64(41);
    let page = |axis: [f64; 3], zero: [f64; 3]| {
        format!(
            "inertia = [1, 1, 1]\n[[body]]\nname = \"wall\"\nfixed = true\n[[joint]]\nname = \"hinge\"\nkind = \"revolute\"\n\
             first = {{ body = \"wall\" }}\nsecond = {{ body = \"plate\" }}\naxis = {axis:?}\nzero = {zero:?}"
        )
        .replace("free = true\n", "")
    };
    for _ in 0..50 {
        let axis: [f64; 3] = std::array::from_fn(|_| dice.random_range(-1.0..1.0));
        let along = axis.map(|x| x * 0.7 * (1.0 + dice.random_range(-2e-16..2e-16)));
        let across = [along[0] + 1e-3, along[1], along[2] - 1e-3];
        let text = page(axis, along);
        let refused = read(&text).expect_err(&text);
        assert!(refused.contains("parallel to its axis"), "{refused}");
        let refused = read(&page(axis, across)).err().unwrap_or_default();
        assert!(!refused.contains("parallel to its axis"), "{refused}");
    }
}
