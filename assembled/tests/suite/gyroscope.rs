//! The paper's section 7, its first hundredth of a second, against the project's reference solution.

use crate::support::model;
use gyro_assembled::{Careful, Dense};
use gyro_sim::{CorrectedDynamics, JointCoordinate, Partition, Partitioned, Turns};

/// The reference angles at 0.01 s, rad.
const ALPHA: f64 = 3.126_943_474_878_552e-4;
const BETA: f64 = -6.982_394_046_843_141e-4;

const TOLERANCE: f64 = 1e-10;

fn check<M: Partition<Scalar = f64, State = Vec<f64>> + CorrectedDynamics>(what: &str, mechanism: &M) {
    let mut y = mechanism.start();
    let mut turns = Turns::new(mechanism, 0.0, &y, &[]);
    let mut solver = Partitioned::new(mechanism, &y);
    for interval in 0..20 {
        solver.advance(mechanism, f64::from(interval) * 5e-4, 1e-4, 5, &mut y).expect("it runs");
        turns.update(mechanism, f64::from(interval + 1) * 5e-4, 5e-4, &y);
    }
    for (joint, expected) in [ALPHA, BETA].into_iter().enumerate() {
        let Some(JointCoordinate::Angle { position, .. }) = turns.coordinate(mechanism, joint, 0) else {
            panic!("{what}: joint {joint} has an angle");
        };
        let error = (position - expected).abs();
        assert!(error <= TOLERANCE, "{what} joint {joint}: {position:e}, off by {error:e}");
    }
}

#[test]
fn the_first_hundredth_of_a_second_of_section_7() {
    for name in ["gyroscope", "gyroscope-maximal"] {
        let model = model(name);
        check(name, &Dense::<f64>::new(&model).expect("it has a start"));
        check(name, &Careful::<f64>::new(&model).expect("it has a start"));
    }
}
