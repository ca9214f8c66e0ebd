//! The stabilised gimbal, in `f32`.
#![no_std]
#![no_main]

use cortex_m_rt::entry;
use embedded_scenes::stabilised::{self, Stabilised};

#[entry]
fn main() -> ! {
    firmware::device::run::<f32, Stabilised<f32>, _>(stabilised::NAME, stabilised::run)
}
