//! The runs whose bits are compared, in `f32`.
#![no_std]
#![no_main]

use cortex_m_rt::entry;

#[entry]
fn main() -> ! {
    firmware::runs::run::<f32>()
}
