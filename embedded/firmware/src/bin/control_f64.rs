//! The gimbal under rate control, in `f64`.
#![no_std]
#![no_main]

use cortex_m_rt::entry;
use embedded_scenes::Simulator;

#[entry]
fn main() -> ! {
    firmware::control::run(&mut Simulator::<f64>::new())
}
