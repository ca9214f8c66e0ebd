//! One second of the paper's scene for a caller who has neither an operating system nor a heap.
#![no_std]

#[cfg(feature = "allocate")]
extern crate alloc;

use core::panic::PanicInfo;
use gyro_sim::generated::gyroscope::Gyroscope;
use gyro_sim::{JointCoordinate, Mechanism, Partitioned, Turns};

#[panic_handler]
fn panic(_: &PanicInfo<'_>) -> ! {
    loop {}
}

/// α after `intervals` correction intervals at the paper's settings, rad; NaN if the run fails.
#[unsafe(no_mangle)]
pub extern "C" fn gyroscope_alpha(intervals: u32) -> f64 {
    let gyroscope = Gyroscope::<f64>::default();
    let mut state = gyroscope.start();
    let mut solver = Partitioned::new(&gyroscope, &state);
    let mut turns = Turns::new(&gyroscope, 0.0, &state, &[]);
    for interval in 0..intervals {
        let t = f64::from(interval) * 5e-4;
        if solver.advance(&gyroscope, t, 1e-4, 5, &mut state).is_err() {
            return f64::NAN;
        }
        turns.update(&gyroscope, t + 5e-4, 5e-4, &state);
    }
    match turns.coordinate(&gyroscope, 0, 0) {
        Some(JointCoordinate::Angle { position, .. }) => kept(position),
        _ => f64::NAN,
    }
}

#[cfg(not(feature = "allocate"))]
fn kept(alpha: f64) -> f64 {
    alpha
}

#[cfg(feature = "allocate")]
fn kept(alpha: f64) -> f64 {
    *alloc::boxed::Box::new(alpha)
}
