//! `--linearize` with controllers: poles and margins.

use crate::controllers::smooth;
use crate::plants::{Law, Plant, WHEEL, exact};
use crate::support::{Folder, json};
use serde_json::Value;
use std::fs;

/// The linearisation of a plant at its start.
fn linearised(folder: &Folder, file: &str) -> Value {
    json(folder, &[file, "--engine", "jit", "--linearize", "0"])["linearization"]["closed_loop"].clone()
}

fn complex(value: &Value) -> [f64; 2] {
    [0, 1].map(|k| value[k].as_f64().unwrap())
}

/// Free motions at multiples of the period satisfy the recurrence whose roots are the poles, as the exact motion does
/// that knows no map over a period.
#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn poles_of_closed_loops_are_those_of_exact_motions() {
    let folder = Folder::new("poles-of-loops");
    let (mut plant, mut loops) = smooth();
    for case in 0..4 {
        match case {
            0 => {}
            1 => loops[1].tenths = 0,
            2 => loops[0].law = Law::TransferFunction(vec![2.0, -0.5, 0.25], vec![1.25, -0.6, 0.1, 0.05]),
            _ => (loops[0].tenths, loops[1].period) = (0, [3, 100]),
        }
        fs::write(folder.0.join("plant.toml"), plant.text(&loops, 0.2)).unwrap();
        let closed = linearised(&folder, "plant.toml");
        let thousandths = if case == 3 { 30 } else { 60 };
        assert!((closed["period"].as_f64().unwrap() - thousandths as f64 / 1e3).abs() < 1e-15, "{closed}");
        let poles: Vec<[f64; 2]> = closed["poles"].as_array().unwrap().iter().map(complex).collect();
        assert!(poles.len() >= 8 && poles.len() < 16, "{poles:?}");
        // Π (z − p), the highest power last.
        let mut polynomial = vec![[1.0, 0.0]];
        for [re, im] in &poles {
            let mut next = vec![[0.0; 2]; polynomial.len() + 1];
            for (k, [a, b]) in polynomial.iter().enumerate() {
                next[k + 1] = [next[k + 1][0] + a, next[k + 1][1] + b];
                next[k] = [next[k][0] - (a * re - b * im), next[k][1] - (a * im + b * re)];
            }
            polynomial = next;
        }
        // The difference of two motions is free.
        let state = |plant: &Plant, k: usize| exact(plant, &loops, thousandths * k as u64).0;
        let mut free = Vec::new();
        for k in 0..poles.len() + 6 {
            let one = state(&plant, k);
            let start = plant.start.clone();
            plant.start.iter_mut().enumerate().for_each(|(k, x)| *x += 1.0 / (1.0 + k as f64));
            free.push(state(&plant, k) - one);
            plant.start = start;
        }
        for first in 2..6 {
            let later = &free[first..];
            for element in 0..2 * plant.n() {
                let terms = polynomial.iter().zip(later).map(|([c, _], state)| c * state[element]);
                let size: f64 = terms.clone().map(f64::abs).sum();
                let sum: f64 = terms.sum();
                assert!(sum.abs() < 1e-9 * size, "case {case}: {sum:e} of {size:e}: {poles:?}");
            }
        }
    }
}

/// L(z) = k ((T − d) + d/z) / (z − 1), with k the gain over the inertia, by hand.
#[test]
fn margins_of_an_integrator_are_those_of_its_formula() {
    let folder = Folder::new("margins");
    let (inertia, period) = (0.5, 0.05);
    for (kp, delay) in [(3.0, 0.0), (3.0, 0.02), (8.0, 0.05), (15.0, 0.01)] {
        let text = WHEEL.replace("kp = 3\n", &format!("kp = {kp:?}\n")) + &format!("delay = {delay:?}\n");
        fs::write(folder.0.join("wheel.toml"), &text).unwrap();
        let margins = linearised(&folder, "wheel.toml")["margins"]["hold"].clone();
        let number = |name: &str| margins[name].as_f64().unwrap();
        let k = kp / inertia;
        let l = |angle: f64| {
            // Over e^{iθ} − 1 = 2 i sin(θ/2) e^{iθ/2}.
            let (re, im) = ((period - delay) + delay * angle.cos(), -delay * angle.sin());
            let size = k * re.hypot(im) / (2.0 * (angle / 2.0).sin());
            (size, im.atan2(re) - (std::f64::consts::PI + angle) / 2.0)
        };
        let (size, turned) = l(number("phase_frequency") * period);
        assert!((size - 1.0).abs() < 1e-9, "{kp} {delay}: {size}");
        let phase = (turned + std::f64::consts::PI).to_degrees();
        assert!(
            (number("phase_deg") - phase).abs() < 1e-7,
            "{kp} {delay}: {} for {phase}",
            number("phase_deg")
        );
        let (size, turned) = l(number("gain_frequency") * period);
        assert!((number("gain") * size - 1.0).abs() < 1e-9, "{kp} {delay}: {margins}");
        assert!((turned + std::f64::consts::PI).abs() < 1e-9, "{kp} {delay}: {turned}");
        // With this gain the loop oscillates: a pole is on the unit circle.
        fs::write(
            folder.0.join("wheel.toml"),
            text.replace("kp = \"kp\"", &format!("kp = \"kp * {:?}\"", number("gain"))),
        )
        .unwrap();
        let poles = linearised(&folder, "wheel.toml")["poles"].clone();
        let [re, im] = complex(&poles[0]);
        assert!((re.hypot(im) - 1.0).abs() < 1e-9, "{kp} {delay}: {poles}");
    }
}
