//! The partition of both forms: it restores the constraints, keeps the independent coordinates and follows the motion.

use crate::support::{
    Random, assert_close, careful_models, dense_models, max_norm, model, models, phi, state_near,
    velocity_residual,
};
use gyro_assembled::{Careful, Dense};
use gyro_model::{Attachment, JointKind, Tree};
use gyro_sim::{CorrectedDynamics, Dynamics, Mechanism, Partition, Partitioned};
use nalgebra::Vector3;

/// Sixteen roundings, as the solver asks, with room for lengths that are divided by the mechanism's size.
const RESTORED: f64 = 1e-13;

fn check_restored<M: Partition<Scalar = f64, State = Vec<f64>> + CorrectedDynamics>(
    what: &str,
    mechanism: &M,
    seed: u64,
) {
    let mut random = Random(seed);
    for state in 0..20 {
        let what = format!("{what} state {state}");
        let drifted = state_near(mechanism, 0.02, &mut random);
        let mut y = drifted.clone();
        let mut solver = Partitioned::new(mechanism, &y);
        solver.correct(mechanism, 0.0, &mut y).unwrap_or_else(|error| panic!("{what}: {error}"));
        assert!(
            max_norm(&phi(mechanism, 0.0, &y)) <= RESTORED,
            "{what}: {:e}",
            max_norm(&phi(mechanism, 0.0, &y))
        );
        let scale = max_norm(&y[7 * mechanism.description().bodies.len()..]).max(1.0);
        let residual = max_norm(&velocity_residual(mechanism, 0.0, &y));
        assert!(residual <= RESTORED * scale, "{what}: {residual:e}");
        // A correction is of the order of what it corrects.
        let moved: Vec<f64> = y
            .iter()
            .zip(&drifted)
            .take(7 * mechanism.description().bodies.len())
            .map(|(y, d)| y - d)
            .collect();
        assert!(max_norm(&moved) < 0.5, "{what}: {:e}", max_norm(&moved));
    }
}

#[test]
fn a_correction_restores_positions_and_velocities() {
    for (seed, (name, dense)) in (0..).zip(dense_models()) {
        check_restored(&name, &dense, seed);
    }
    for (seed, model) in (0..).zip(careful_models()) {
        check_restored(&model.name, &Careful::<f64>::new(&model).expect("it has a start"), seed);
    }
}

#[test]
fn the_dense_partition_keeps_independent_positions_and_rates() {
    for model in models() {
        let mechanism = Dense::<f64>::new(&model).expect("it has a start");
        let drifted = state_near(&mechanism, 0.02, &mut Random(7));
        let (mut y, mut solver) = (drifted.clone(), Partitioned::new(&mechanism, &drifted));
        solver.correct(&mechanism, 0.0, &mut y).expect("it can be corrected");
        let n_q = 7 * mechanism.description().bodies.len();
        assert_eq!(solver.independent().len(), n_q - mechanism.buffers().constraints.len(), "{}", model.name);
        let rates = |y: &Vec<f64>| {
            let mut rates = y.clone();
            mechanism.derivative(0.0, y, &mut rates);
            rates
        };
        // The independent ṗ follow from the integrated w' at the corrected p.
        let integrated = [&y[..n_q], &drifted[n_q..]].concat();
        let (before, after) = (rates(&integrated), rates(&y));
        for &column in solver.independent() {
            assert_eq!(drifted[column], y[column], "{}", model.name);
            assert_close(&model.name, &[after[column]], &[before[column]], 10.0, 1e-12);
        }
    }
}

#[test]
fn the_careful_partition_holds_what_the_joint_leaves_free_of_the_angular_velocity() {
    let (mut held, mut free) = (0, 0);
    for (seed, model) in (0..).zip(careful_models()) {
        let mechanism = Careful::<f64>::new(&model).expect("it has a start");
        let drifted = state_near(&mechanism, 0.02, &mut Random(seed));
        let mut y = drifted.clone();
        Partitioned::new(&mechanism, &y).correct(&mechanism, 0.0, &mut y).expect("it can be corrected");
        let (moving_bodies, n_q) = (model.coordinate_bodies(), 7 * mechanism.description().bodies.len());
        for link in Tree::of(&model).links {
            let moving_body =
                moving_bodies.iter().position(|&body| body == link.body).expect("it has coordinates");
            let w = |y: &Vec<f64>| {
                Vector3::from_column_slice(&y[n_q + 6 * moving_body + 3..n_q + 6 * moving_body + 6])
            };
            let (before, after) = (w(&drifted), w(&y));
            let Attachment::Joint { joint, reversed, .. } = link.attachment else {
                let moves = link.attachment == Attachment::Free;
                assert!(!moves || before == after, "{} body {}", model.name, link.body);
                continue;
            };
            let joint = &model.joints[joint];
            let end = if reversed { &joint.first } else { &joint.second };
            let h = Vector3::from(model.values(&end.axis)).normalize();
            let what = format!("{} {}", model.name, joint.name);
            match joint.kind {
                JointKind::Revolute => {
                    assert_close(&what, &[h.dot(&after)], &[h.dot(&before)], 10.0, 1e-14);
                    held += usize::from((after - before).norm() > 1e-3);
                }
                JointKind::Spherical => {
                    assert_eq!(before, after, "{what}");
                    free += 1;
                }
                _ => {}
            }
        }
    }
    assert!(held > 5 && free > 1, "{held} {free}");
}

#[test]
fn a_consistent_state_is_left_alone() {
    for (name, dense) in dense_models() {
        let mut y = dense.start();
        Partitioned::new(&dense, &y).correct(&dense, 0.0, &mut y).expect("it is consistent");
        assert_close(&name, &y, &dense.start(), 1.0, 1e-13);
    }
    for model in careful_models() {
        let careful = Careful::<f64>::new(&model).expect("it has a start");
        let mut y = careful.start();
        Partitioned::new(&careful, &y).correct(&careful, 0.0, &mut y).expect("it is consistent");
        assert_close(&model.name, &y, &careful.start(), 1.0, 1e-13);
    }
}

/// The rotor turns 1.6 times in 0.1 s: the choice must follow it, and no more often than it needs to.
fn check_switches<M: Partition<Scalar = f64, State = Vec<f64>> + CorrectedDynamics>(
    mechanism: &M,
    switches: std::ops::Range<u64>,
) {
    let mut y = mechanism.start();
    let mut solver = Partitioned::new(mechanism, &y);
    for interval in 0..200 {
        solver.advance(mechanism, f64::from(interval) * 5e-4, 1e-4, 5, &mut y).expect("it runs");
    }
    assert!(switches.contains(&solver.switches()), "{} switches", solver.switches());
}

#[test]
fn the_choice_follows_the_rotor_without_flicker() {
    let model = model("gyroscope");
    check_switches(&Dense::<f64>::new(&model).expect("it has a start"), 3..15);
    check_switches(&Careful::<f64>::new(&model).expect("it has a start"), 3..15);
}
