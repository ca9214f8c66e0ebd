//! The stabilised gimbal, in `f64`.
#![no_std]
#![no_main]

use cortex_m_rt::entry;
use embedded_scenes::stabilised::{self, Stabilised};

#[entry]
fn main() -> ! {
    firmware::device::run::<f64, Stabilised<f64>, _>(stabilised::NAME, stabilised::run)
}
