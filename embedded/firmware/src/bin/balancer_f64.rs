//! The balancing robot, in `f64`.
#![no_std]
#![no_main]

use cortex_m_rt::entry;

#[entry]
fn main() -> ! {
    firmware::balancer::run::<f64>()
}
