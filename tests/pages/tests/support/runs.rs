//! Short runs by every correction and in all coordinates that a mechanism offers. This file is compiled into the
//! example and into the program that it writes, so that both run the same.

use gyro_sim::{
    Baumgarte, ClosedForm, Corrected, CorrectedDynamics, Correction, Dynamics, Error, Exact, Joint,
    JointSpace, Kinematics, Kutta4, MassWeighted, Mechanism, Ode, Partition, Partitioning, Projection,
    Solver, Uncorrected,
};

/// Length of a run, s, and its steps; again with twice as many, to see how much the method is off by.
pub const T_END: f64 = 0.02;
pub const STEPS: [u32; 2] = [100, 200];

/// Rate of the stabilisation, rad/s.
const RATE: f64 = 100.0;

/// What was run, and the state to which it led.
pub type Ends = Vec<(&'static str, Result<Vec<f64>, Error>)>;

fn end<D: Ode<M, Scalar = f64>, M>(
    dynamics: D,
    mechanism: &M,
    correction: impl Correction<D, M>,
    start: &D::State,
    steps: u32,
) -> Result<D::State, Error> {
    let mut solver = Solver::with_correction(dynamics, Kutta4::new(start), correction, 0.0, start);
    solver.advance(mechanism, T_END / f64::from(steps), steps)?;
    Ok(solver.state().clone())
}

/// In maximal coordinates, from a start that may be moved.
pub fn maximal<M: Partition<Scalar = f64> + Kinematics + Dynamics + CorrectedDynamics + Projection>(
    mechanism: &M,
    start: &M::State,
    steps: u32,
) -> Ends {
    let partition = || Partitioning::new(mechanism, 0.0, start);
    let runs = [
        ("direct", end(Exact, mechanism, Uncorrected, start, steps)),
        ("partition", end(Corrected, mechanism, partition(), start, steps)),
        ("mass-weighted", end(Exact, mechanism, MassWeighted::new(mechanism), start, steps)),
        ("baumgarte", end(Baumgarte { rate: RATE }, mechanism, Uncorrected, start, steps)),
    ];
    runs.map(|(name, end)| (name, end.map(|y| numbers(&y)))).to_vec()
}

/// What trees offer besides.
#[allow(dead_code, reason = "the assembled forms have no joint coordinates")]
pub fn joint<M: Partition<Scalar = f64> + JointSpace + CorrectedDynamics>(mechanism: &M, steps: u32) -> Ends {
    let start = mechanism.start();
    let in_joints = end(Joint, mechanism, Uncorrected, &mechanism.joint_start(), steps).map(|x| {
        let mut y = mechanism.start();
        mechanism.to_maximal(T_END, &x, &mut y);
        y
    });
    let runs = [
        ("joint", in_joints),
        ("closed form", end(Corrected, mechanism, ClosedForm::new(mechanism), &start, steps)),
    ];
    runs.map(|(name, end)| (name, end.map(|y| numbers(&y)))).to_vec()
}

fn numbers(y: &impl AsRef<[f64]>) -> Vec<f64> {
    y.as_ref().to_vec()
}

/// One line for each run.
#[allow(dead_code, reason = "only the written program prints")]
pub fn print<M: Mechanism>(seed: u64, _: &M, steps: u32, ends: Ends) {
    for (name, end) in ends {
        match end {
            Ok(y) => println!("{seed};{steps};{name};{y:?}"),
            Err(error) => println!("{seed};{steps};{name};{error}"),
        }
    }
}
