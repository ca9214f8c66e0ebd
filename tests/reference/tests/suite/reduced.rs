//! The gyroscope reduced to one angle against the formulations that keep all three, against closed forms and
//! against itself.

use core::f64::consts::{FRAC_PI_2, PI};
use gyro_reference::{
    AxisForce, Chain, DoubleDouble, Gyroscope, JointRow, Pendulum, ReducedGyroscope, Sample, Start,
    moving_base, scene, tabulated,
};

/// Two formulations, each correctly rounded or nearly so: relative to one and the value.
const ROUNDING: f64 = 1e-15;

/// Rates that follow from others by a small denominator, and angles that add up over many turns.
const ROUNDING_OF_RATES: f64 = 1e-13;

fn assert_near(found: f64, expected: f64, allowed: f64, what: &str) {
    let error = (found - expected).abs() / (1.0 + expected.abs());
    assert!(error <= allowed, "{what}: {found:e} but {expected:e}, off by {error:e}");
}

/// Angles and rates, the latter with what is allowed for rates.
fn assert_alike(found: &Sample, positions: [f64; 3], rates: [f64; 3], what: &str) {
    let at = format!("{what} at {} s", found.t);
    for (found, expected) in [found.alpha, found.beta, found.phi].into_iter().zip(positions) {
        assert_near(found, expected, ROUNDING, &at);
    }
    for (found, expected) in [found.alpha_rate, found.beta_rate, found.phi_rate].into_iter().zip(rates) {
        assert_near(found, expected, ROUNDING_OF_RATES, &at);
    }
}

fn decimal(value: f64) -> DoubleDouble {
    value.to_string().parse().expect("a decimal")
}

/// The same gyroscope by Kane's equations; nothing may act in its bearings.
fn by_kane(reduced: &ReducedGyroscope) -> Gyroscope {
    let zero = DoubleDouble::ZERO;
    let [along, across] = reduced.rotor.map(decimal);
    Gyroscope {
        mass: [decimal(0.01), decimal(0.01), decimal(reduced.mass)],
        inertia: [[zero, decimal(reduced.outer), zero], reduced.inner.map(decimal), [along, across, across]],
        ring_offset: [decimal(reduced.offset), zero, zero],
        rotor_offset: [zero; 3],
        gravity: [zero, -decimal(reduced.gravity), zero],
        friction: [zero; 3],
        start: Start {
            angles: [zero, decimal(reduced.beta), zero],
            ring_rates: reduced.ring_rates.map(decimal),
            spin: decimal(reduced.spin),
        },
    }
}

fn check_by_kane(reduced: &ReducedGyroscope, times: &[f64], what: &str) {
    for (found, expected) in reduced.solve(times).iter().zip(by_kane(reduced).solve(times)) {
        let [_, alpha, beta, phi, alpha_rate, beta_rate, phi_rate, energy] = expected.values();
        assert_alike(found, [alpha, beta, phi], [alpha_rate, beta_rate, phi_rate], what);
        assert_near(found.energy, energy, ROUNDING, what);
    }
}

#[test]
fn it_moves_as_by_kanes_equations() {
    let paper = ReducedGyroscope::paper();
    check_by_kane(&paper, &[0.1, 0.3], "paper");
    check_by_kane(&ReducedGyroscope::free_nutation(), &[0.1, 0.3], "free nutation");
    let swinging = ReducedGyroscope { offset: 0.005, spin: 10.0, ..paper.clone() };
    check_by_kane(&swinging, &[0.1, 0.3], "through gimbal lock");
    let light = ReducedGyroscope { outer: 1e-12, inner: [1e-12, 2e-12, 1e-12], ..paper.clone() };
    check_by_kane(&light, &[0.1], "light rings");
    let heavy = ReducedGyroscope { mass: 1e10, rotor: [1_250_000.0, 625_000.0], ..paper.clone() };
    check_by_kane(&heavy, &[0.1], "heavy rotor");
    let anyhow = ReducedGyroscope { beta: 0.7, ring_rates: [-3.0, 2.0], offset: 0.003, ..paper };
    check_by_kane(&anyhow, &[0.1, 0.3], "tilted");
}

#[test]
fn it_meets_the_tables() {
    for (name, reduced) in
        [("paper", ReducedGyroscope::paper()), ("free-nutation", ReducedGyroscope::free_nutation())]
    {
        let table = tabulated().into_iter().find(|scene| scene.name == name).expect("the table has it");
        let times: Vec<f64> = table.samples.iter().map(|sample| sample.t.to_f64()).collect();
        for (found, expected) in reduced.solve(&times).iter().zip(&table.samples) {
            let found = found.values();
            for (found, expected) in found.into_iter().zip(expected.rounded().values()) {
                assert_near(found, expected, ROUNDING, &format!("{name} at {} s", times[0]));
            }
        }
    }
}

/// A fast rotor hardly yields: with H = C ω, α and β obey I_α α̈ = −H β̇ and I_β β̈ = H α̇ − m g d to
/// parts in 1e9, whence β = −A (1 − cos Ω t) and α = (m g d / H) (t − sin(Ω t) / Ω), Ω = H / √(I_α I_β),
/// A = m g d I_α / H².
#[test]
fn a_fast_rotor_precesses_and_nutates_as_linear_theory_says() {
    /// Terms of the order of α and β, relative.
    const LINEAR: f64 = 1e-6;
    let (momentum, torque) = (1e-5 * 1e5, 0.08 * 10.0 * 0.000125);
    let carried = 5e-6 + 0.08 * 0.000125 * 0.000125;
    let (about_y, about_z) = (1e-6 + 2e-6 + carried, 1e-6 + carried);
    let nutation = momentum / f64::sqrt(about_y * about_z);
    let (precession, size) = (torque / momentum, torque * about_y / (momentum * momentum));
    for row in scene("gyroscope-fast").expect("a model file").solve(&[1e-5, 1e-4, 1e-3]) {
        let (sin, cos) = (nutation * row.t).sin_cos();
        let alpha = precession * (row.t - sin / nutation);
        assert!((row.positions[0] - alpha).abs() < LINEAR * precession * row.t, "{row:?} {alpha:e}");
        assert!((row.positions[1] + size * (1.0 - cos)).abs() < LINEAR * size, "{row:?}");
        assert!((row.positions[2] - 1e5 * row.t).abs() < 1e-9, "{row:?}");
    }
}

#[test]
fn at_rest_it_is_a_pendulum() {
    let pendulum = Pendulum {
        mass: 0.08,
        inertia: 6e-6,
        distance: 0.000125,
        gravity: 10.0,
        start: FRAC_PI_2,
        rate: 0.0,
    };
    let times = [0.3, 0.7, 1.1, 4.0];
    let rows = scene("gyroscope-at-rest").expect("a model file").solve(&times);
    for (row, expected) in rows.iter().zip(pendulum.solve(&times)) {
        let JointRow { positions, rates, .. } = row;
        assert_eq!([positions[0], positions[2], rates[0], rates[2]], [0.0; 4]);
        assert_near(positions[1], expected.angle - FRAC_PI_2, ROUNDING, "angle");
        assert_near(rates[1], expected.rate, ROUNDING_OF_RATES, "rate");
    }
}

/// The swing through gimbal lock is symmetric about it: half a period after the start it has come to rest at
/// β = −180°. At β = −90° the rotor's momentum about Y is −C ω, and what the weight has done less what turns about Y
/// is left for β̇.
#[test]
fn it_swings_through_gimbal_lock_to_the_other_side() {
    let swinging = ReducedGyroscope { offset: 0.005, spin: 10.0, step: 0.01, ..ReducedGyroscope::paper() };
    let period = swinging.period();
    let [quarter, half] = [period / 4.0, period / 2.0].map(|t| swinging.solve(&[t])[0]);
    // Times are rounded to 1e-16 s; at −180° the rate changes by 500 rad/s².
    assert_near(half.beta, -PI, ROUNDING, "half a period");
    assert_near(half.beta_rate, 0.0, ROUNDING_OF_RATES, "half a period");
    assert_near(quarter.beta, -FRAC_PI_2, ROUNDING_OF_RATES, "in gimbal lock");
    let about_y = 2e-6;
    let momentum = 10.0 * 1e-5;
    assert_near(quarter.alpha_rate, momentum / about_y, ROUNDING_OF_RATES, "rings in gimbal lock");
    let left = 0.08 * 10.0 * 0.005 - 0.5 * momentum * momentum / about_y;
    let about_z = 1e-6 + 5e-6 + 0.08 * 0.005 * 0.005;
    assert_near(
        quarter.beta_rate,
        -f64::sqrt(2.0 * left / about_z),
        ROUNDING_OF_RATES,
        "through gimbal lock",
    );
}

#[test]
fn a_rotor_too_fast_never_comes_through() {
    let lowest = |spin: f64| {
        let swinging = ReducedGyroscope { offset: 0.005, spin, step: 0.01, ..ReducedGyroscope::paper() };
        let times: Vec<f64> = (1..120).map(|k| f64::from(k) * 0.005).collect();
        swinging.solve(&times).iter().map(|sample| sample.beta).fold(0.0, f64::min)
    };
    // √(2 m g d J) / C = 12.649 rad/s.
    assert!(lowest(12.5) < -3.0 && lowest(12.8) > -FRAC_PI_2);
}

/// Springs and dampers by Newton's and Euler's laws along a chain.
#[test]
fn stiff_bearings_move_as_along_the_chain() {
    let sprung = |damping: f64| -> Chain<3> {
        let mut chain = moving_base::resting();
        (chain.links[1].stiffness, chain.links[1].damping, chain.links[1].start) = (1e3, damping, 0.001);
        chain
    };
    // The chain takes a step from one time to the next.
    for (page, damping, spacing) in [("gyroscope-stiff", 1e-2, 4e-5), ("gyroscope-overdamped", 1.0, 5e-6)] {
        let times: Vec<f64> = (1..=20).map(|k| f64::from(k) * spacing).collect();
        let rows = scene(page).expect("a model file").solve(&times);
        for (row, expected) in rows.iter().zip(sprung(damping).solve(&times)) {
            for k in 0..3 {
                assert_near(row.positions[k], expected.positions[k], ROUNDING, page);
                assert_near(row.rates[k], expected.rates[k], ROUNDING_OF_RATES, page);
            }
        }
    }
}

/// Steady: α̇ from the momentum about Y, and β where spring, weight and gyroscopic torque balance.
#[test]
fn stiff_bearings_end_in_steady_precession() {
    for page in ["gyroscope-stiff", "gyroscope-overdamped"] {
        let rows = scene(page).expect("a model file").solve(&[0.1, 0.5, 1000.0]);
        let (first, last) = (&rows[0], &rows[2]);
        let (beta, rate) = (last.positions[1], last.rates[0]);
        let (sin, cos) = beta.sin_cos();
        let carried = 5e-6 + 0.08 * 0.000125 * 0.000125;
        let (level, upright) = (1e-6 + 2e-6 + carried, 2e-6);
        let torque = ((upright - level) * sin * rate + 1e-3) * rate * cos - 1e-4 * cos;
        assert_near(1e3 * beta, torque, ROUNDING, page);
        let about_y = upright * sin * sin + level * cos * cos;
        assert_near(rate, 1e-3 * (0.001f64.sin() - sin) / about_y, ROUNDING_OF_RATES, page);
        assert_eq!([first.rates[0], first.positions[1]], [rate, beta], "{page}: still moving at 0.1 s");
        assert!(last.rates[1].abs() < 1e-24, "{page}: {last:?}");
        assert_near(last.positions[0] - first.positions[0], 999.9 * rate, ROUNDING_OF_RATES, page);
    }
}

/// Without rotor and weight N v̇ = −L tanh(v/r) has sinh(v/r) = sinh(v0/r) exp(−L t / (N r)).
#[test]
fn dry_friction_alone_stops_by_its_closed_form() {
    let rubbing = ReducedGyroscope {
        gravity: 0.0,
        spin: 0.0,
        ring_rates: [0.0, 4e-3],
        forces: vec![AxisForce::Coulomb { level: 1e-6, rate: 1e-3 }],
        step: 1e-3,
        ..ReducedGyroscope::paper()
    };
    let about_z = 6e-6 + 0.08 * 0.000125 * 0.000125;
    for sample in rubbing.solve(&[0.01, 0.02, 0.03]) {
        let decayed = (-1e-6 * sample.t / (about_z * 1e-3)).exp();
        let expected = 1e-3 * (4.0f64.sinh() * decayed).asinh();
        assert!((sample.beta_rate - expected).abs() < 1e-17, "{sample:?} {expected:e}");
    }
}

#[test]
fn what_rubs_takes_the_energy() {
    /// Energies of 0.05 J are given to 1e-17 J.
    const ENERGY: f64 = 3e-17;
    let stiff = ReducedGyroscope {
        beta: 0.01,
        forces: vec![AxisForce::Spring { stiffness: 1e3, free: 0.0 }, AxisForce::Damper(1e-2)],
        step: 7e-5,
        ..ReducedGyroscope::paper()
    };
    let dry = ReducedGyroscope {
        forces: vec![AxisForce::Coulomb { level: 1e-6, rate: 1e-3 }],
        step: 1e-3,
        ..ReducedGyroscope::paper()
    };
    for (what, gyroscope, times) in [("stiff", stiff, [0.0, 1e-3, 4e-3]), ("dry", dry, [0.0, 0.02, 0.06])] {
        let (samples, works) = (gyroscope.solve(&times), gyroscope.works(&times));
        for (sample, work) in samples.iter().zip(&works) {
            let lost = sample.energy - samples[0].energy;
            assert!((lost - work).abs() < ENERGY, "{what} at {} s: {lost:e} {work:e}", sample.t);
        }
        assert!(works[2] < -1e-9, "{what}: nothing rubs");
    }
}

#[test]
fn periods_repeat_the_motion() {
    let free = ReducedGyroscope::free_nutation();
    let times = [0.0, 0.01, 0.1, 0.5, 1.0, 20.0];
    for (found, expected) in free.solve_by_periods(&times).iter().zip(free.solve(&times)) {
        let [_, alpha, beta, phi, alpha_rate, beta_rate, phi_rate, energy] = expected.values();
        assert_alike(found, [alpha, beta, phi], [alpha_rate, beta_rate, phi_rate], "free nutation");
        assert_near(found.energy, energy, ROUNDING, "energy");
    }
}

/// Errors of a period add up: another step makes other errors, and after 23 000 periods they still do not show.
#[test]
fn a_thousand_seconds_are_good_to_the_last_digits() {
    let free = ReducedGyroscope::free_nutation();
    let times = [1.0, 100.0, 999.99, 1000.0];
    let other = ReducedGyroscope { step: 3e-3, ..free.clone() };
    for (found, expected) in free.solve_by_periods(&times).iter().zip(other.solve_by_periods(&times)) {
        assert_eq!(*found, expected);
    }
    let turns = free.solve_by_periods(&[1000.0])[0].phi / core::f64::consts::TAU;
    assert!((turns - 15_915.0).abs() < 50.0, "{turns}");
}
