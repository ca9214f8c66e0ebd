//! The gimbal under rate control, in `f32`.
#![no_std]
#![no_main]

use cortex_m_rt::entry;
use embedded_scenes::Simulator;

#[entry]
fn main() -> ! {
    firmware::control::run(&mut Simulator::<f32>::new())
}
