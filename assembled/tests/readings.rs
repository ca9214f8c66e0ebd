//! What the joints of a start show is what the page asked for.

mod support;

use gyro_assembled::Careful;
use gyro_sim::{JointCoordinate, Mechanism, Ode, Turns};
use support::{assert_close, models};

/// Rounding of a few products, at rates of up to 100 rad/s.
const ROUNDING: f64 = 1e-13;

#[test]
fn joints_start_where_the_page_puts_them() {
    for model in models() {
        let mechanism = Careful::<f64>::new(&model).expect("it has a start");
        let start = model.assemble().expect("it has a start");
        let nearest: Vec<f64> =
            start.joints.iter().map(|joint| joint.position.first().map_or(0.0, |x| *x)).collect();
        let turns = Turns::new(&mechanism, &mechanism.start(), &nearest);
        for (joint, expected) in start.joints.iter().enumerate() {
            let (position, rate) = match turns.joint(&mechanism, joint) {
                JointCoordinate::Angle { position, rate } => (vec![position], vec![rate]),
                JointCoordinate::Orientation { position, rate } => (position.to_vec(), rate.to_vec()),
                JointCoordinate::None => (vec![], vec![]),
            };
            let what = format!("{} {}", model.name, mechanism.joint(joint).name);
            assert_close(&what, &position, &expected.position, 1.0, ROUNDING);
            assert_close(&what, &rate, &expected.rate, 1.0, ROUNDING);
        }
    }
}
