//! The quadruped, in `f64`.
#![no_std]
#![no_main]

use cortex_m_rt::entry;
use embedded_scenes::quadruped::{self, Quadruped};

#[entry]
fn main() -> ! {
    firmware::device::run::<f64, Quadruped<f64>, _>(quadruped::NAME, quadruped::run)
}
