//! A closed loop: the dense partition keeps it closed through full turns of the crank, and the energy with it.

use crate::support::{dense, max_norm, model, phi, test_model, velocity_residual};
use gyro_assembled::{Careful, Unsupported};
use gyro_sim::{Mechanism, Partitioned};

#[test]
fn the_dense_partition_keeps_the_loop_closed() {
    let mechanism = dense(&test_model("four-bar"));
    let mut y = mechanism.start();
    let energy = mechanism.energy(0.0, &y).total();
    let mut solver = Partitioned::new(&mechanism, &y);
    for interval in 0..400 {
        let t = f64::from(interval) * 2.5e-3;
        solver.advance(&mechanism, t, 5e-4, 5, &mut y).unwrap_or_else(|error| panic!("{t} s: {error}"));
        let violation = max_norm(&phi(&mechanism, t, &y));
        assert!(violation <= 1e-12, "{t} s: {violation:e}");
        let residual = max_norm(&velocity_residual(&mechanism, t, &y));
        assert!(residual <= 1e-12, "{t} s: {residual:e}");
    }
    let drift = mechanism.energy(1.0, &y).total() - energy;
    assert!(drift.abs() <= 1e-8, "{drift:e}");
}

#[test]
fn the_careful_form_is_for_trees() {
    let loops = test_model("four-bar");
    assert_eq!(Careful::<f64>::supports(&loops), Err(Unsupported::JointKind("loop_pin".to_owned())));
    assert!(Careful::<f64>::new(&loops).is_err());
    assert_eq!(Careful::<f64>::supports(&model("gyroscope")), Ok(()));
    assert_eq!(Careful::<f64>::supports(&test_model("carried")), Ok(()));
}
