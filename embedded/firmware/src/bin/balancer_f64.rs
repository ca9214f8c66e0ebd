//! The balancing robot, in `f64`.
#![no_std]
#![no_main]

use cortex_m_rt::entry;
use embedded_scenes::balancer::{self, Balancer};

#[entry]
fn main() -> ! {
    firmware::device::run::<f64, Balancer<f64>, _>(balancer::NAME, balancer::run)
}
