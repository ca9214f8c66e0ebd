//! The balancing robot, in `f32`.
#![no_std]
#![no_main]

use cortex_m_rt::entry;
use embedded_scenes::balancer::{self, Balancer};

#[entry]
fn main() -> ! {
    firmware::device::run::<f32, Balancer<f32>, _>(balancer::NAME, balancer::run)
}
