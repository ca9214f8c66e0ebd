//! Every term of the equations of motion of every model: what the generator derived against what the twin has typed by
//! hand, on random states that violate the joints.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
#![allow(clippy::print_stdout, reason = "the measured figures, for runs with --nocapture")]

use gyro_assembled::{Careful, Dense};
use gyro_model::Model;
use gyro_sim_suite::{
    Check, Engine, Matrix, Random, difference, for_each_generated, model, phi_pi, phi_q, state, state_of,
};

const STATES: usize = 1000;

/// Angular velocities, rad/s: the paper's rotor turns at 100.
const RATE: f64 = 100.0;

/// Two ways of adding up a few dozen products, relative to the largest number of a kind.
const AGREEMENT: f64 = 1e-12;

/// The same where a linear system has been solved in between.
const AGREEMENT_OF_SOLUTIONS: f64 = 1e-10;

/// One kind of numbers of one state: they have a unit, and so a scale, in common.
struct Kind {
    name: &'static str,
    values: Vec<f64>,
    /// A scale that the values may cancel below.
    scale: f64,
    agreement: f64,
}

fn kind(name: &'static str, values: Vec<f64>) -> Kind {
    Kind { name, values, scale: 0.0, agreement: AGREEMENT }
}

/// Everything that a mechanism says of a state, kind by kind.
fn terms<M: Engine<f64>>(mechanism: &M, model: &Model, values: &[f64]) -> Vec<Kind> {
    let (t, y) = (0.0, state_of(mechanism, values));
    let mut kinds = Vec::new();
    let mut constraints = mechanism.constraints();
    mechanism.phi(t, &y, &mut constraints);
    let n_rows = mechanism.rows().as_ref().len();
    let (rows, normalisations) = constraints.as_ref().split_at(n_rows);
    kinds.extend(by_unit(mechanism, ["Φ, lengths", "Φ, pure"], rows));
    // |p| = 1 to rounding: what is left is rounding, of the scale of one.
    kinds.push(Kind { scale: 1.0, ..kind("normalisations", normalisations.to_vec()) });
    let mut out = mechanism.rows();
    mechanism.nu(t, &y, &mut out);
    kinds.push(kind("ν", out.as_ref().to_vec()));
    mechanism.gamma(t, &y, &mut out);
    kinds.extend(by_unit(mechanism, ["γ, lengths", "γ, pure"], out.as_ref()));
    mechanism.velocity_residual(t, &y, &mut out);
    kinds.extend(by_unit(mechanism, ["velocity, lengths", "velocity, pure"], out.as_ref()));
    kinds.extend(by_block(["Φ_r of Φ_q", "Φ_p"], 7, &phi_q(mechanism, &y)));
    kinds.extend(by_block(["Φ_r", "Φ_π'"], 6, &phi_pi(mechanism, &y)));
    let mut force = mechanism.velocities();
    mechanism.applied_force(t, &y, &mut force);
    kinds.extend(halves(["f", "n' − w̃'J'w'"], 6, force.as_ref()));
    kinds.extend(readings_and_energy(mechanism, model, &y));
    kinds
}

/// Readings: sines and cosines, Euler parameters and rates all have values up to 2π or 2 · [`RATE`].
fn readings_and_energy<M: Engine<f64>>(mechanism: &M, model: &Model, y: &M::State) -> Vec<Kind> {
    let mut readings = mechanism.readings();
    mechanism.read_joints(y, &mut readings);
    let energy = mechanism.energy(y);
    let weight: f64 = model.values(&model.gravity).map(f64::abs).iter().sum::<f64>();
    let masses = model.coordinate_bodies().into_iter().map(|body| model.value(&model.bodies[body].mass));
    vec![
        kind("readings", readings.as_ref().to_vec()),
        kind("kinetic energy", vec![energy.kinetic]),
        Kind {
            scale: weight * masses.sum::<f64>() * mechanism.size(),
            ..kind("potential", vec![energy.potential])
        },
    ]
}

/// What follows from eq. (17).
fn solutions<M: Engine<f64>>(mechanism: &M, _: &Model, values: &[f64]) -> Vec<Kind> {
    let y = &state_of(mechanism, values);
    let (mut accelerations, mut lambda) = (mechanism.velocities(), mechanism.rows());
    mechanism.accelerations(0.0, y, &mut accelerations, &mut lambda);
    let mut kinds = halves(["s̈", "ẇ'"], 6, accelerations.as_ref());
    kinds.extend(by_unit(mechanism, ["λ, forces", "λ, torques"], lambda.as_ref()));
    let mut dy = mechanism.start();
    mechanism.derivative(0.0, y, &mut dy);
    let (q_dot, rest) = dy.as_ref().split_at(7 * mechanism.n_bodies());
    let (v_dot, power) = rest.split_at(6 * mechanism.n_bodies());
    kinds.extend(halves(["ṙ", "ṗ"], 7, q_dot));
    kinds.extend(halves(["s̈ of ẏ", "ẇ' of ẏ"], 6, v_dot));
    kinds.push(kind("power", power.to_vec()));
    kinds.into_iter().map(|kind| Kind { agreement: AGREEMENT_OF_SOLUTIONS, ..kind }).collect()
}

/// Rows apart by what they measure.
fn by_unit<M: Engine<f64>>(mechanism: &M, names: [&'static str; 2], rows: &[f64]) -> Vec<Kind> {
    let of = |is_length: bool| {
        let rows = rows.iter().enumerate().filter(|(row, _)| mechanism.row(*row).is_length == is_length);
        rows.map(|(_, value)| *value).collect()
    };
    vec![kind(names[0], of(true)), kind(names[1], of(false))]
}

/// Of each body's `stride` numbers the first three, and the rest.
fn halves(names: [&'static str; 2], stride: usize, values: &[f64]) -> Vec<Kind> {
    let of = |range: std::ops::Range<usize>| {
        values.chunks_exact(stride).flat_map(|body| body[range.clone()].to_vec()).collect()
    };
    vec![kind(names[0], of(0..3)), kind(names[1], of(3..stride))]
}

/// Of each row of a Jacobian the columns of positions, and those of orientations.
fn by_block(names: [&'static str; 2], stride: usize, matrix: &Matrix) -> Vec<Kind> {
    matrix.rows.iter().flat_map(|row| halves(names, stride, row)).collect()
}

/// The worst differences seen, kind by kind, and whether any value differed at all.
#[derive(Default)]
struct Worst {
    /// Name, difference and what is allowed.
    kinds: Vec<(&'static str, f64, f64)>,
    differ: bool,
}

impl Worst {
    /// Compares one state; `what` says which.
    fn compare(&mut self, what: &str, generated: &[Kind], twin: &[Kind]) {
        assert_eq!(generated.len(), twin.len(), "{what}");
        for (a, b) in generated.iter().zip(twin) {
            let error = difference(&a.values, &b.values, a.scale);
            assert!(
                error <= a.agreement,
                "{what}: {} differs by {error:e}:\n{:?}\n{:?}",
                a.name,
                a.values,
                b.values
            );
            self.differ |= error > 0.0;
            match self.kinds.iter_mut().find(|(name, ..)| *name == a.name) {
                Some((_, worst, _)) => *worst = worst.max(error),
                None => self.kinds.push((a.name, error, a.agreement)),
            }
        }
    }

    /// The worst of what is only added up, and of what is solved for.
    fn summary(&self) -> String {
        let worst = |agreement: f64| {
            let kinds = self.kinds.iter().filter(|(_, _, of)| *of == agreement);
            kinds
                .map(|(name, error, _)| (*error, *name))
                .fold((0.0, "none"), |a, b| if b.0 > a.0 { b } else { a })
        };
        let (terms, solutions) = (worst(AGREEMENT), worst(AGREEMENT_OF_SOLUTIONS));
        format!("{} to {:.1e}, {} to {:.1e}", terms.1, terms.0, solutions.1, solutions.0)
    }
}

/// Compares with both forms of the twin.
struct WithTwins;

impl Check<f64> for WithTwins {
    fn check<M: Engine<f64>>(&mut self, page: &str, mechanism: &M) {
        let model = model(page);
        let (careful, dense) = (Careful::new(&model).unwrap(), Dense::new(&model).unwrap());
        let (mut random, mut to_careful, mut to_dense) = (Random::new(7), Worst::default(), Worst::default());
        for index in 0..STATES {
            let values = state(mechanism, RATE, &mut random);
            let what = format!("{page}, state {index}: {values:?}");
            let generated = terms(mechanism, &model, &values);
            to_careful.compare(&what, &generated, &terms(&careful, &model, &values));
            to_dense.compare(&what, &generated, &terms(&dense, &model, &values));
            let generated = solutions(mechanism, &model, &values);
            to_careful.compare(&what, &generated, &solutions(&careful, &model, &values));
            to_dense.compare(&what, &generated, &solutions(&dense, &model, &values));
        }
        println!("{page}: {}; dense: {}", to_careful.summary(), to_dense.summary());
        assert!(
            to_careful.differ && to_dense.differ,
            "{page}: bit for bit the same: one is compared with itself"
        );
    }
}

#[test]
fn generated_terms_agree_with_the_twins() {
    for_each_generated(&mut WithTwins);
}

#[test]
fn a_wrong_offset_is_noticed() {
    // The check must be able to fail: the twin's rotor is a hundredth of a nanometre off.
    let text = gyro_sim_suite::page("gyroscope").replace("0.000125", "0.00012500001");
    let (right, wrong) = (model("gyroscope"), gyro_model::read("wrong.toml", &text).unwrap());
    let (a, b) = (Careful::<f64>::new(&right).unwrap(), Careful::<f64>::new(&wrong).unwrap());
    let values = state(&a, RATE, &mut Random::new(7));
    let kinds = |mechanism: &Careful<f64>| {
        let mut kinds = terms(mechanism, &right, &values);
        kinds.extend(solutions(mechanism, &right, &values));
        kinds
    };
    let (a, b) = (kinds(&a), kinds(&b));
    let is_off = |(a, b): (&Kind, &Kind)| difference(&a.values, &b.values, a.scale) > 10.0 * a.agreement;
    let off: Vec<&str> = a.iter().zip(&b).filter(|(a, b)| is_off((a, b))).map(|(a, _)| a.name).collect();
    for name in ["Φ_p", "Φ_π'", "velocity, lengths", "s̈"] {
        assert!(off.contains(&name), "{name} is not among {off:?}");
    }
}
