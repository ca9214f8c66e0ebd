//! The stabilised gimbal, in `f64`.
#![no_std]
#![no_main]

use cortex_m_rt::entry;

#[entry]
fn main() -> ! {
    firmware::stabilised::run::<f64>()
}
