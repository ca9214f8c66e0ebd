//! Motions with a solution in closed form.

use crate::support::{dense, model};
use gyro_assembled::{Careful, Dense};
use gyro_sim::{CorrectedDynamics, JointCoordinate, Partition, Partitioned, Turns};

/// `models/torsion.toml`: x = x0 exp(−d t) (cos w t + d/w sin w t).
fn torsion(t: f64) -> f64 {
    let (x0, d) = (6.5 * std::f64::consts::PI, 0.25);
    let w = f64::sqrt(0.5 / 0.02 - d * d);
    x0 * f64::exp(-d * t) * ((w * t).cos() + d / w * (w * t).sin())
}

/// The spring unwinds by six turns and a half and winds up again. At 90 rad/s the Euler parameters turn by 0.009 in a
/// step, the fifth power of which makes 1e-9 of a turn in all.
fn check<M: Partition<Scalar = f64, State = Vec<f64>> + CorrectedDynamics>(mechanism: &M) {
    let mut y = mechanism.start();
    let mut turns = Turns::new(mechanism, 0.0, &y, &[torsion(0.0)]);
    let mut solver = Partitioned::new(mechanism, &y);
    for interval in 0..400 {
        let t = f64::from(interval) * 1e-2;
        solver.advance(mechanism, t, 2e-4, 50, &mut y).expect("it runs");
        turns.update(mechanism, t + 1e-2, 1e-2, &y);
        let Some(JointCoordinate::Angle { position, .. }) = turns.coordinate(mechanism, 0, 0) else {
            panic!("the bearing has an angle");
        };
        let error = (position - torsion(t + 1e-2)).abs();
        assert!(error <= 1e-8, "{t} s: {error:e}");
        let reference = y[y.len() - 1];
        assert!((reference - position).abs() <= 1e-7, "{t} s: the turn reference strays to {reference}");
    }
}

#[test]
fn a_torsion_spring_knows_the_turns_it_is_wound_by() {
    let model = model("torsion");
    check::<Careful<f64>>(&Careful::new(&model).expect("it is a tree"));
    check::<Dense<f64>>(&dense(&model));
}
