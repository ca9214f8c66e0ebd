//! What is measured: one line for each kernel.

use crate::data_sheet::DataSheet;
use crate::kernel::Kernel;
use crate::scene::Scene;
use gyro_sim::{
    CorrectedDynamics, CorrectedSolution, Dynamics, Joint, JointSpace, Kinematics, Partition, Partitioned,
    Projection, Rk4,
};
use gyro_yardstick::{FLOPS, STEP};
use std::hint::black_box;

/// The data sheets.
const FOLDED: DataSheet = DataSheet(include_str!("../../gyro-sim/src/generated/gyroscope.rs"));
const MAXIMAL: DataSheet = DataSheet(include_str!("../../mechanisms/src/golden/gyroscope_maximal.rs"));

/// The paper's second: corrections, and steps between them.
pub(crate) const CORRECTIONS: u32 = 2000;
pub(crate) const STEPS_PER_CORRECTION: u32 = 5;

const JOINTS: &str = "joint accelerations in joint coordinates";
const JOINTS_AT: &str = "joint accelerations from a corrected maximal state";
const BODIES: &str = "accelerations of all bodies";
const LOADS: &str = "the same with all multipliers";
const DERIVATIVE: &str = "derivative of the state";
const PHI: &str = "Φ";
const PHI_Q: &str = "Φ_q";
const GAMMA: &str = "γ";
const NEWTON: &str = "Newton step of the positions";
const VELOCITIES: &str = "solve of the velocities";

const GENERATED: &str = "generated";
const CORRECTED: &str = "generated, corrected state";
const GENERATED_MAXIMAL: &str = "generated, paper's form";
const RECURSIVE: &str = "assembled, recursive";
const CAREFUL: &str = "assembled, careful";
const DENSE: &str = "assembled, dense 33×33";
const DENSE_MAXIMAL: &str = "assembled, dense 45×45";

/// Every kernel of the paper's scene; the floor comes first.
pub fn kernels(scene: &Scene) -> Vec<Kernel<'_>> {
    let (maximal, with_base) = (&scene.maximal, &scene.with_base);
    let (on_heap, with_base_on_heap) = (maximal.to_vec(), with_base.to_vec());
    let mut kernels = vec![floor(scene)];
    kernels.extend(generated(GENERATED, &scene.generated, maximal, FOLDED));
    kernels.extend(joint_space(&scene.generated, maximal, FOLDED));
    kernels.extend(solves(RECURSIVE, &scene.recursive, &on_heap, |_| None));
    kernels.extend(solves(CAREFUL, &scene.careful, &on_heap, |_| None));
    kernels.extend(terms(CAREFUL, &scene.careful, &on_heap, |_| None));
    kernels.extend(solves(DENSE, &scene.dense, &on_heap, |_| None));
    kernels.extend(generated(GENERATED_MAXIMAL, &scene.generated_maximal, with_base, MAXIMAL));
    kernels.extend(solves(DENSE_MAXIMAL, &scene.dense_maximal, &with_base_on_heap, |_| None));
    kernels.sort_by_key(|kernel| ORDER.iter().position(|what| *what == kernel.what));
    kernels
}

/// The order of the table.
const ORDER: [&str; 10] =
    [JOINTS, JOINTS_AT, BODIES, LOADS, DERIVATIVE, PHI, PHI_Q, GAMMA, NEWTON, VELOCITIES];

fn floor(scene: &Scene) -> Kernel<'_> {
    let (floor, y) = (&scene.floor, scene.joints);
    Kernel::new(JOINTS, "floor, by hand", Some(FLOPS), move || {
        black_box(floor.accelerations(black_box(&y)));
    })
}

/// All functions of a generated mechanism, with the operations of its data sheet.
fn generated<'a, M>(side: &'static str, mechanism: &'a M, y: &M::State, sheet: DataSheet) -> Vec<Kernel<'a>>
where
    M: Kinematics + Dynamics + CorrectedDynamics + Projection + Partition<Scalar = f64>,
    M::State: 'a,
{
    let flops = move |functions: &[&str]| Some(sheet.flops(functions));
    let mut kernels = solves(side, mechanism, y, flops);
    kernels.extend(terms(side, mechanism, y, flops));
    kernels
}

/// What a tree has besides: joint coordinates, and short ways for states that satisfy the constraints.
fn joint_space<'a, M>(mechanism: &'a M, y: &M::State, sheet: DataSheet) -> Vec<Kernel<'a>>
where
    M: CorrectedSolution + Dynamics + Partition<Scalar = f64>,
    M::State: 'a,
{
    let flops = move |functions: &[&str]| Some(sheet.flops(functions));
    let mut kernels = Vec::new();
    let (mut x, mut out) = (mechanism.joint_start(), mechanism.joint_buffers().rates);
    mechanism.to_joints(0.0, y, &mut x);
    kernels.push(Kernel::new(JOINTS, GENERATED, flops(&["joint_accelerations"]), move || {
        mechanism.joint_accelerations(0.0, black_box(&x), black_box(&mut out));
    }));
    let (state, mut out) = (y.clone(), mechanism.joint_buffers().rates);
    kernels.push(Kernel::new(JOINTS_AT, GENERATED, flops(&["joint_accelerations_at"]), move || {
        mechanism.joint_accelerations_at(0.0, black_box(&state), black_box(&mut out));
    }));
    let (state, mut out) = (y.clone(), mechanism.buffers().velocities);
    kernels.push(Kernel::new(BODIES, CORRECTED, flops(&["corrected_accelerations"]), move || {
        mechanism.corrected_accelerations(0.0, black_box(&state), black_box(&mut out));
    }));
    let (state, mut out) = (y.clone(), mechanism.solution_buffer());
    kernels.push(Kernel::new(LOADS, CORRECTED, flops(&["corrected_solution"]), move || {
        mechanism.corrected_solution(0.0, black_box(&state), black_box(&mut out));
    }));
    let (state, mut dy) = (y.clone(), y.clone());
    let both = flops(&["corrected_accelerations", "derivative"]);
    kernels.push(Kernel::new(DERIVATIVE, CORRECTED, both, move || {
        mechanism.corrected_derivative(0.0, black_box(&state), black_box(&mut dy));
    }));
    kernels
}

/// What solves something.
fn solves<'a, M>(
    side: &'static str,
    mechanism: &'a M,
    y: &M::State,
    flops: impl Fn(&[&str]) -> Option<u64>,
) -> Vec<Kernel<'a>>
where
    M: Kinematics + Dynamics + CorrectedDynamics + Projection + Partition<Scalar = f64>,
    M::State: 'a,
{
    let mut kernels = Vec::new();
    let (state, mut out) = (y.clone(), mechanism.acceleration_buffer());
    kernels.push(Kernel::new(BODIES, side, flops(&["accelerations"]), move || {
        mechanism.accelerations(0.0, black_box(&state), black_box(&mut out));
    }));
    let (state, mut out, mut lambda) = (y.clone(), mechanism.acceleration_buffer(), mechanism.buffers().rows);
    kernels.push(Kernel::new(LOADS, side, flops(&["accelerations", "multipliers"]), move || {
        mechanism.accelerations(0.0, black_box(&state), black_box(&mut out));
        mechanism.multipliers(0.0, black_box(&state), black_box(&out), black_box(&mut lambda));
    }));
    let (state, mut dy) = (y.clone(), y.clone());
    kernels.push(Kernel::new(DERIVATIVE, side, flops(&["accelerations", "derivative"]), move || {
        mechanism.derivative(0.0, black_box(&state), black_box(&mut dy));
    }));
    let (mut state, choice) = (y.clone(), mechanism.independent(0.0, y));
    kernels.push(Kernel::new(NEWTON, side, flops(&["newton_step"]), move || {
        // The state meets the constraints and stays where it is.
        let _ = black_box(mechanism.newton_step(0.0, black_box(&choice), black_box(&mut state)));
    }));
    let (mut state, choice) = (y.clone(), mechanism.independent(0.0, y));
    kernels.push(Kernel::new(VELOCITIES, side, flops(&["solve_velocities"]), move || {
        let _ = black_box(mechanism.solve_velocities(0.0, black_box(&choice), black_box(&mut state)));
    }));
    kernels
}

/// What is evaluated only; all forms of the runtime-assembled model have these in common.
fn terms<'a, M>(
    side: &'static str,
    mechanism: &'a M,
    y: &M::State,
    flops: impl Fn(&[&str]) -> Option<u64>,
) -> Vec<Kernel<'a>>
where
    M: Kinematics + Dynamics + CorrectedDynamics + Projection + Partition<Scalar = f64>,
    M::State: 'a,
{
    let (state, mut out) = (y.clone(), mechanism.buffers().constraints);
    let phi = Kernel::new(PHI, side, flops(&["phi"]), move || {
        mechanism.phi(0.0, black_box(&state), black_box(&mut out));
    });
    let (state, mut out) = (y.clone(), mechanism.terms().phi_q);
    let phi_q = Kernel::new(PHI_Q, side, flops(&["phi_q"]), move || {
        mechanism.phi_q(0.0, black_box(&state), black_box(&mut out));
    });
    let (state, mut out) = (y.clone(), mechanism.buffers().rows);
    let gamma = Kernel::new(GAMMA, side, flops(&["gamma"]), move || {
        mechanism.gamma(0.0, black_box(&state), black_box(&mut out));
    });
    vec![phi, phi_q, gamma]
}

const SECOND: &str = "the paper's second";

/// Whole runs; the floor comes first.
pub fn runs(scene: &Scene) -> Vec<Kernel<'_>> {
    vec![
        Kernel::new(SECOND, "floor, by hand, RK4", None, || black_box(scene.floor).second()),
        Kernel::new(SECOND, "generated, joint coordinates, RK4", None, || {
            let mut x = scene.generated.joint_start();
            let mut rk4 = Rk4::new(&x);
            for step in 0..CORRECTIONS * STEPS_PER_CORRECTION {
                rk4.step(&Joint, &scene.generated, f64::from(step) * STEP, STEP, &mut x);
            }
            black_box(x);
        }),
        second(GENERATED, &scene.generated),
        second(RECURSIVE, &scene.recursive),
        second(CAREFUL, &scene.careful),
        second(DENSE, &scene.dense),
        second(GENERATED_MAXIMAL, &scene.generated_maximal),
        second(DENSE_MAXIMAL, &scene.dense_maximal),
    ]
}

/// Coordinate partitioning with RK4.
fn second<'a, M: Partition<Scalar = f64> + CorrectedDynamics>(
    side: &'static str,
    mechanism: &'a M,
) -> Kernel<'a> {
    Kernel::new(SECOND, side, None, move || {
        let mut y = mechanism.start();
        let mut solver = Partitioned::new(mechanism, &y);
        for interval in 0..CORRECTIONS {
            let t = f64::from(interval * STEPS_PER_CORRECTION) * STEP;
            let advanced = solver.advance(mechanism, t, STEP, STEPS_PER_CORRECTION, &mut y);
            advanced.expect("the paper's scene runs");
        }
        black_box(&y);
    })
}
