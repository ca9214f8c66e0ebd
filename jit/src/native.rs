//! The number types that there is machine code for, and the elementary functions that it calls.

use gyro_sim::Scalar;
use gyro_sim::lanes::f64x2;

/// A number type that Cranelift compiles for: `f32`, `f64`, and `f64x2`, two lanes with the bits of two runs in `f64`.
pub trait Native: Scalar + Send + Sync + 'static {
    /// Bits of a number.
    const BITS: u32;
    /// How a time is passed: packs by their address.
    type Time;
    /// The time as it is passed.
    fn time(&self) -> Self::Time;
    /// The addresses of sine, cosine, hyperbolic tangent, angle, and sine with cosine, in the order of
    /// [`crate::clif::FUNCTIONS`], as a module that rustc compiles calls them.
    fn functions() -> [*const u8; 5];
}

// They do not unwind. Being allowed to, they are one jump to the function itself.

extern "C-unwind" fn sin<T: Scalar>(x: T) -> T {
    x.sin()
}

extern "C-unwind" fn cos<T: Scalar>(x: T) -> T {
    x.cos()
}

extern "C-unwind" fn tanh<T: Scalar>(x: T) -> T {
    x.tanh()
}

extern "C-unwind" fn atan2<T: Scalar>(y: T, x: T) -> T {
    y.atan2(x)
}

/// Sine and cosine: reduced once, where both are inlined.
#[repr(C)]
struct Both<T>(T, T);

extern "C-unwind" fn sin_cos<T: Scalar>(x: T) -> Both<T> {
    Both(x.sin(), x.cos())
}

/// Both of a pack, which take its place.
extern "C" fn sin_cos_of_pair(packs: &mut [[f64; 2]; 2]) {
    let x = f64x2::new(packs[0]);
    *packs = [Scalar::sin(x), Scalar::cos(x)].map(f64x2::to_array);
}

/// Of a pack, and of a second one after it if the function takes two; the result takes the place of the first.
extern "C" fn of_pair<const FUNCTION: usize>(packs: &mut [[f64; 2]; 2]) {
    let pack = |n: usize| f64x2::new(packs[n]);
    let found = match FUNCTION {
        0 => Scalar::sin(pack(0)),
        1 => Scalar::cos(pack(0)),
        2 => Scalar::tanh(pack(0)),
        _ => Scalar::atan2(pack(0), pack(1)),
    };
    packs[0] = found.to_array();
}

impl Native for f64x2 {
    const BITS: u32 = 128;
    type Time = *const Self;
    fn time(&self) -> *const Self {
        self
    }
    fn functions() -> [*const u8; 5] {
        [
            of_pair::<0> as *const u8,
            of_pair::<1> as *const u8,
            of_pair::<2> as *const u8,
            of_pair::<3> as *const u8,
            sin_cos_of_pair as *const u8,
        ]
    }
}

impl Native for f64 {
    const BITS: u32 = 64;
    type Time = Self;
    fn time(&self) -> Self {
        *self
    }
    fn functions() -> [*const u8; 5] {
        [
            sin::<Self> as *const u8,
            cos::<Self> as *const u8,
            tanh::<Self> as *const u8,
            atan2::<Self> as *const u8,
            sin_cos::<Self> as *const u8,
        ]
    }
}

impl Native for f32 {
    const BITS: u32 = 32;
    type Time = Self;
    fn time(&self) -> Self {
        *self
    }
    fn functions() -> [*const u8; 5] {
        [
            sin::<Self> as *const u8,
            cos::<Self> as *const u8,
            tanh::<Self> as *const u8,
            atan2::<Self> as *const u8,
            sin_cos::<Self> as *const u8,
        ]
    }
}
