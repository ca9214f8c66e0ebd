//! What the joints of a start show is what the model file asked for.

use crate::support::{assert_close, models};
use gyro_assembled::Dense;
use gyro_sim::{JointCoordinate, Mechanism, Turns};

/// Rounding of a few products, at rates of up to 100 rad/s.
const ROUNDING: f64 = 1e-13;

#[test]
fn joints_start_where_the_page_puts_them() {
    for model in models() {
        let mechanism = Dense::<f64>::new(&model).expect("it has a start");
        let start = model.assemble().expect("it has a start");
        let positions = start.joints.iter().zip(&model.joints);
        // Of a spherical joint the position is one coordinate of four numbers.
        let nearest: Vec<f64> = positions
            .flat_map(|(start, joint)| {
                let orientation = joint.kind == gyro_model::JointKind::Spherical;
                if orientation { vec![0.0] } else { start.position.clone() }
            })
            .collect();
        let turns = Turns::new(&mechanism, 0.0, &mechanism.start(), &nearest);
        for (joint, expected) in start.joints.iter().enumerate() {
            let (mut position, mut rate) = (vec![], vec![]);
            for index in 0..mechanism.description().joints[joint].coordinates.len() {
                match turns.coordinate(&mechanism, joint, index).expect("it is there") {
                    JointCoordinate::Angle { position: x, rate: r }
                    | JointCoordinate::Length { position: x, rate: r } => {
                        position.push(x);
                        rate.push(r);
                    }
                    JointCoordinate::Orientation { position: p, rate: r } => {
                        position.extend(p);
                        rate.extend(r);
                    }
                }
            }
            let what = format!("{} {}", model.name, mechanism.description().joints[joint].name);
            assert_close(&what, &position, &expected.position, 1.0, ROUNDING);
            assert_close(&what, &rate, &expected.rate, 1.0, ROUNDING);
        }
    }
}
