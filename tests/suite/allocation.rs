//! A whole generated simulation allocates nothing: neither steps nor corrections nor readings.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
#![allow(unsafe_code, reason = "a counting allocator must implement an unsafe trait")]

use gyro_assembled::{Careful, Dense};
use gyro_sim::generated::{gyroscope::Gyroscope, gyroscope_viscous::GyroscopeViscous};
use gyro_sim::{JointCoordinate, Partition, Partitioned, Turns, violation};
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
fn simulation<M: Partition<Scalar = f64>>(mechanism: &M, corrections: u32) -> (f64, f64) {
    let mut y = mechanism.start();
    let mut solver = Partitioned::new(mechanism, &y);
    let mut turns = Turns::new(mechanism, 0.0, &y, &[]);
    let (mut phi, mut worst) = (mechanism.constraints(), 0.0_f64);
    for interval in 0..corrections {
        let t = f64::from(interval) * 5e-4;
        solver.advance(mechanism, t, 1e-4, 5, &mut y).unwrap();
        turns.update(mechanism, t + 5e-4, 5e-4, &y);
        mechanism.phi(t, &y, &mut phi);
        let n_rows = phi.as_ref().len() - mechanism.n_bodies();
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

#[test]
fn the_counter_counts() {
    // The check must be able to fail: the careful twin allocates its buffers, the dense one in every evaluation.
    let page = model("gyroscope");
    let (careful, dense) = (Careful::new(&page).unwrap(), Dense::new(&page).unwrap());
    let of_buffers = allocations(|| simulation(&careful, 2)).0;
    assert!(of_buffers > 0);
    assert!(allocations(|| simulation(&dense, 2)).0 > 2 * 5 * 4);
}
