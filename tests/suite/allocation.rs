//! A whole generated simulation allocates nothing: neither steps nor corrections nor readings.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
#![allow(unsafe_code, reason = "a counting allocator must implement an unsafe trait")]

use gyro_assembled::{Careful, Dense};
use gyro_mechanisms::{gyroscope::Gyroscope, gyroscope_viscous::GyroscopeViscous};
use gyro_sim::integrate::Method;
use gyro_sim::{
    Baumgarte, ByDuals, ClosedForm, Control, Corrected, CorrectedDynamics, Correction, Dop853, Dual, Exact,
    Joint, JointCoordinate, JointJacobian, JointSpace, Kutta4, MassWeighted, Mechanism, Ode, Partition,
    Partitioned, Partitioning, Rodas4, Solver, Tsit5, Turns, Uncorrected, violation,
};
use gyro_sim_suite::model;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

struct Counting;

thread_local! {
    static ALLOCATIONS: Cell<usize> = const { Cell::new(0) };
}

unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.with(|count| count.set(count.get() + 1));
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// How often this thread allocates in `f`, and what `f` returns.
fn allocations<T>(f: impl FnOnce() -> T) -> (usize, T) {
    let before = ALLOCATIONS.with(Cell::get);
    let result = f();
    (ALLOCATIONS.with(Cell::get) - before, result)
}

/// Corrections in one second at the paper's settings.
const A_SECOND: u32 = 2000;

/// A run at the paper's settings from building the solver to the last reading: the worst violation and α at the end.
fn simulation<M: Partition<Scalar = f64> + CorrectedDynamics>(mechanism: &M, corrections: u32) -> (f64, f64) {
    let mut y = mechanism.start();
    let mut solver = Partitioned::new(mechanism, &y);
    let mut turns = Turns::new(mechanism, 0.0, &y, &[]);
    let (mut phi, mut worst) = (mechanism.buffers().constraints, 0.0_f64);
    for interval in 0..corrections {
        let t = f64::from(interval) * 5e-4;
        solver.advance(mechanism, t, 1e-4, 5, &mut y).unwrap();
        turns.update(mechanism, t + 5e-4, 5e-4, &y);
        mechanism.phi(t, &y, &mut phi);
        let n_rows = phi.as_ref().len() - mechanism.description().bodies.len();
        worst = worst.max(violation(mechanism, &phi.as_ref()[..n_rows]).value);
    }
    match turns.coordinate(mechanism, 0, 0) {
        Some(JointCoordinate::Angle { position, .. }) => (worst, position),
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_generated_simulation_allocates_nothing() {
    let (count, (worst, alpha)) = allocations(|| simulation(&Gyroscope::default(), A_SECOND));
    assert_eq!(count, 0);
    assert!(worst < 1e-12 && (alpha - 0.1).abs() < 1e-3, "it did run: {worst:e}, alpha {alpha}");
    let (count, _) = allocations(|| simulation(&GyroscopeViscous::default(), A_SECOND));
    assert_eq!(count, 0);
}

/// Fixed steps and steps under error control with interpolation, in maximal coordinates with one correction.
macro_rules! count_with {
    ($gyroscope:ident, $dynamics:expr, $correction:expr) => {{
        let y = $gyroscope.start();
        let count = |solve: &dyn Fn() -> f64| {
            let (count, end) = allocations(solve);
            assert!(end >= 0.01, "it did run to {end} s");
            count
        };
        let control = Control::default().with_tolerance(1e-6);
        let duals = GyroscopeViscous::<Dual<f64, 4>>::default();
        let implicit = ByDuals::new($dynamics, duals, duals.start());
        let jacobian = [0.0; 40 * 40];
        count(&|| fixed($dynamics, &$gyroscope, Kutta4::new(&y), $correction, &y))
            + count(&|| adaptive($dynamics, &$gyroscope, Tsit5::new(&y), $correction, control, &y))
            + count(&|| adaptive($dynamics, &$gyroscope, Dop853::new(&y), $correction, control, &y))
            + count(&|| {
                let method = Rodas4::new(&y, jacobian);
                adaptive(implicit.clone(), &$gyroscope, method, $correction, control, &y)
            })
    }};
}

fn fixed<D, M, A, C>(dynamics: D, model: &M, method: A, correction: C, y: &D::State) -> f64
where
    D: Ode<M, Scalar = f64>,
    A: Method<D, M>,
    C: Correction<D, M>,
{
    let mut solver = Solver::with_correction(dynamics, method, correction, 0.0, y);
    solver.advance(model, 1e-3, 20).unwrap();
    solver.time()
}

fn adaptive<D, M, A, C>(
    dynamics: D,
    model: &M,
    method: A,
    correction: C,
    control: Control,
    y: &D::State,
) -> f64
where
    D: Ode<M, Scalar = f64>,
    A: Method<D, M>,
    C: Correction<D, M>,
{
    let mut solver = Solver::with_correction(dynamics, method, correction, 0.0, y).with_control(control);
    let mut within = y.clone();
    while solver.time() < 0.02 {
        let before = solver.time();
        solver.step_towards(model, 0.02).unwrap();
        solver.interpolate(model, 0.5 * (before + solver.time()), &mut within).unwrap();
    }
    solver.time()
}

#[test]
fn every_integrator_with_every_correction_allocates_nothing() {
    let gyroscope = GyroscopeViscous::<f64>::default();
    let start = gyroscope.start();
    assert_eq!(count_with!(gyroscope, Exact, Uncorrected), 0);
    assert_eq!(count_with!(gyroscope, Corrected, Partitioning::new(&gyroscope, 0.0, &start)), 0);
    assert_eq!(count_with!(gyroscope, Corrected, ClosedForm::new(&gyroscope)), 0);
    assert_eq!(count_with!(gyroscope, Exact, MassWeighted::new(&gyroscope)), 0);
    let steered = Baumgarte { rate: 100.0 };
    let steer = || fixed(steered, &gyroscope, Kutta4::new(&start), Uncorrected, &start);
    assert_eq!(allocations(steer).0, 0);
    let x = gyroscope.joint_start();
    let control = Control::default().with_tolerance(1e-6);
    let joint = || {
        adaptive(Joint, &gyroscope, Dop853::new(&x), Uncorrected, control, &x);
        let method = Rodas4::new(&x, gyroscope.jacobian_buffers().jacobian);
        adaptive(Joint, &gyroscope, method, Uncorrected, control, &x)
    };
    assert_eq!(allocations(joint).0, 0);
}

#[test]
fn the_counter_counts() {
    // The check must be able to fail: the careful runtime-assembled model allocates its buffers, the dense one in every
    // evaluation.
    let page = model("gyroscope");
    let (careful, dense) = (Careful::new(&page).unwrap(), Dense::new(&page).unwrap());
    let of_buffers = allocations(|| simulation(&careful, 2)).0;
    assert!(of_buffers > 0);
    assert!(allocations(|| simulation(&dense, 2)).0 > 2 * 5 * 4);
}
