//! Short runs by every correction and in all coordinates that a mechanism offers. This file is compiled into the
//! example and into the program that it writes, so that both run the same.

use gyro_sim::{
    Baumgarte, ClosedForm, Corrected, Correction, Error, JointForm, JointSpace, Kutta4, MassWeighted,
    Mechanism, Ode, Partition, Partitioning, Projection, Solver, Storage, Uncorrected,
};

/// Length of a run, s, and its steps.
pub const T_END: f64 = 0.02;
const STEPS: u32 = 100;

/// Rate of the stabilisation, rad/s.
const RATE: f64 = 100.0;

/// What was run, and the state to which it led.
pub type Ends = Vec<(&'static str, Result<Vec<f64>, Error>)>;

fn end<O: Ode<Scalar = f64>>(
    system: &O,
    correction: impl Correction<O>,
    start: &O::State,
) -> Result<O::State, Error> {
    let mut solver = Solver::new(Kutta4::new(start), correction, 0.0, start);
    solver.advance(system, T_END / f64::from(STEPS), STEPS)?;
    Ok(solver.state().clone())
}

/// In maximal coordinates, from a start that may be moved.
pub fn maximal<M: Partition<Scalar = f64> + Projection>(mechanism: &M, start: &M::State) -> Ends {
    let partition = || Partitioning::new(mechanism, 0.0, start);
    let steered = Baumgarte { mechanism, rate: RATE };
    let runs = [
        ("direct", end(mechanism, Uncorrected, start)),
        ("partition", end(&Corrected(mechanism), partition(), start)),
        ("mass-weighted", end(mechanism, MassWeighted::new(mechanism), start)),
        ("baumgarte", end(&steered, Uncorrected, start)),
    ];
    runs.map(|(name, end)| (name, end.map(|y| numbers(&y)))).to_vec()
}

/// What trees offer besides.
#[allow(dead_code, reason = "the assembled forms have no joint coordinates")]
pub fn joint<M: Partition<Scalar = f64> + JointSpace>(mechanism: &M) -> Ends {
    let start = mechanism.start();
    let in_joints = end(&JointForm(mechanism), Uncorrected, &mechanism.joint_start()).map(|x| {
        let mut y = mechanism.start();
        mechanism.to_maximal(T_END, &x, &mut y);
        y
    });
    let runs = [
        ("joint", in_joints),
        ("closed form", end(&Corrected(mechanism), ClosedForm::new(mechanism), &start)),
    ];
    runs.map(|(name, end)| (name, end.map(|y| numbers(&y)))).to_vec()
}

fn numbers(y: &impl Storage<f64>) -> Vec<f64> {
    y.as_ref().to_vec()
}

/// One line for each run.
#[allow(dead_code, reason = "only the written program prints")]
pub fn print<M: Mechanism>(seed: u64, _: &M, ends: Ends) {
    for (name, end) in ends {
        match end {
            Ok(y) => println!("{seed};{name};{y:?}"),
            Err(error) => println!("{seed};{name};{error}"),
        }
    }
}
