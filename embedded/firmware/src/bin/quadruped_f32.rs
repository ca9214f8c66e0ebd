//! The quadruped, in `f32`.
#![no_std]
#![no_main]

use cortex_m_rt::entry;
use embedded_scenes::quadruped::{self, Quadruped};

#[entry]
fn main() -> ! {
    firmware::device::run::<f32, Quadruped<f32>, _>(quadruped::NAME, quadruped::run)
}
