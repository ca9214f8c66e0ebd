//! The careful form allocates nothing once it is built: neither in a derivative nor in a corrected step.
#![allow(unsafe_code, reason = "a counting allocator must implement an unsafe trait")]

use crate::support::careful_models;
use gyro_assembled::{Careful, Dense};
use gyro_sim::{CorrectedDynamics, Dynamics, Kinematics, Partition, Partitioned, Projection};
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

/// How often this thread allocates in two corrections with five steps of this length each and one evaluation of every
/// term.
fn allocations<M>(mechanism: &M, step: f64) -> usize
where
    M: Partition<Scalar = f64, State = Vec<f64>> + Kinematics + Dynamics + CorrectedDynamics + Projection,
{
    let mut y = mechanism.start();
    let mut solver = Partitioned::new(mechanism, &y);
    let (mut constraints, mut rows, mut lambda) =
        (mechanism.buffers().constraints, mechanism.buffers().rows, mechanism.buffers().rows);
    let (mut readings, mut accelerations) = (mechanism.buffers().readings, mechanism.acceleration_buffer());
    let (mut phi_q, mut phi_pi) = (mechanism.terms().phi_q, mechanism.terms().phi_pi);
    let mut outputs = mechanism.buffers().outputs;
    let before = ALLOCATIONS.with(Cell::get);
    for interval in 0..2 {
        let advanced = solver.advance(mechanism, f64::from(interval) * 5.0 * step, step, 5, &mut y);
        assert!(advanced.is_ok());
    }
    mechanism.phi(0.0, &y, &mut constraints);
    mechanism.velocity_residual(0.0, &y, &mut rows);
    mechanism.gamma(0.0, &y, &mut rows);
    mechanism.phi_q(0.0, &y, &mut phi_q);
    mechanism.phi_pi(0.0, &y, &mut phi_pi);
    mechanism.read_joints(0.0, &y, &mut readings);
    mechanism.accelerations(0.0, &y, &mut accelerations);
    mechanism.multipliers(0.0, &y, &accelerations, &mut lambda);
    mechanism.outputs(0.0, &y, &mut outputs);
    ALLOCATIONS.with(Cell::get) - before
}

#[test]
fn the_careful_form_does_not_allocate() {
    for model in careful_models() {
        let step = model.simulation.step.min(1e-4);
        let careful = Careful::<f64>::new(&model).expect("it has a start");
        assert_eq!(allocations(&careful, step), 0, "{}", model.name);
        let dense = Dense::<f64>::new(&model).expect("it has a start");
        assert!(allocations(&dense, step) > 0, "{}: the counter counts", model.name);
    }
}
