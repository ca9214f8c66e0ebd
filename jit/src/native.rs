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
    /// `clif::FUNCTIONS`, as a module that rustc compiles calls them. The last one only where it is called.
    fn functions() -> Vec<*const u8>;
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

/// Sine and cosine, which come back in two registers.
#[repr(C)]
struct Both(f64, f64);

/// The bits are those of one and of the other; what is subtracted from a large argument is subtracted once.
extern "C-unwind" fn sin_cos(x: f64) -> Both {
    let (sine, cosine) = libm::sincos(x);
    Both(sine, cosine)
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
    fn functions() -> Vec<*const u8> {
        vec![
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
    fn functions() -> Vec<*const u8> {
        vec![
            sin::<Self> as *const u8,
            cos::<Self> as *const u8,
            tanh::<Self> as *const u8,
            atan2::<Self> as *const u8,
            sin_cos as *const u8,
        ]
    }
}

impl Native for f32 {
    const BITS: u32 = 32;
    type Time = Self;
    fn time(&self) -> Self {
        *self
    }
    fn functions() -> Vec<*const u8> {
        vec![
            sin::<Self> as *const u8,
            cos::<Self> as *const u8,
            tanh::<Self> as *const u8,
            atan2::<Self> as *const u8,
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use chacha20::ChaCha8Rng;
    use rand::{RngExt, SeedableRng};

    #[test]
    fn sine_and_cosine_of_one_call_have_the_bits_of_two() {
        let mut dice = ChaCha8Rng::seed_from_u64(23);
        // All magnitudes there are, both signs, and the neighbours of quarters of turns.
        let of_bits = (0..400_000).map(|_| f64::from_bits(dice.random()));
        let mut arguments: Vec<f64> = of_bits.collect();
        arguments.extend((0..400_000).map(|_| dice.random_range(-10.0..10.0)));
        let quarters = (-4000..4000).map(|n| f64::from(n) * std::f64::consts::FRAC_PI_4);
        arguments.extend(quarters.flat_map(|x| [x.next_down(), x, x.next_up()]));
        arguments.extend([0.0, -0.0, f64::INFINITY, f64::MIN_POSITIVE, 5e-324]);
        let bits = |x: f64| if x.is_nan() { f64::NAN.to_bits() } else { x.to_bits() };
        for x in arguments {
            let Both(sine, cosine) = sin_cos(x);
            assert_eq!([bits(sine), bits(cosine)], [bits(Scalar::sin(x)), bits(Scalar::cos(x))], "{x:e}");
        }
    }
}
