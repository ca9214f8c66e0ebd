//! The number types that there is machine code for, and the elementary functions that it calls.

use crate::engine;
use gyro_model::Spline;
use gyro_program::elementary::Function;
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
    /// The addresses of the elementary functions in their order, as a module that rustc compiles calls them, and where
    /// it is called that of sine with cosine.
    fn functions() -> Vec<*const u8>;
    /// The address of what computes a derivative of a curve: of a number, or of packs in place, with the curve's
    /// address and the order.
    fn curve() -> *const u8;
}

/// What is called for each elementary function.
macro_rules! functions {
    ([$x:ident, $y:ident] $($function:ident: $method:ident($($operand:ident),+),)+) => {
        /// The value of an elementary function; of one operand the second one is of no matter.
        pub(crate) fn call<T: Scalar>(function: Function, [$x, $y]: [T; 2]) -> T {
            match function {
                $(Function::$function => Scalar::$method($($operand),+),)+
                Function::Curve { .. } => unreachable!("curves are with their tables"),
            }
        }

        /// The addresses of all functions of single numbers, in their order.
        fn addresses<T: Scalar>() -> Vec<*const u8> {
            // They do not unwind. Being allowed to, they are one jump to the function itself.
            $(extern "C-unwind" fn $method<T: Scalar>($($operand: T),+) -> T { Scalar::$method($($operand),+) })+
            let address = |function| match function {
                $(Function::$function => $method::<T> as *const u8,)+
                Function::Curve { .. } => unreachable!("it is none of all"),
            };
            Function::ALL.map(address).to_vec()
        }

        /// Those of functions of packs, of which the result takes the place of the first.
        fn addresses_of_packs() -> Vec<*const u8> {
            $(extern "C" fn $method(packs: &mut [[f64; 2]; 2]) {
                packs[0] = call(Function::$function, packs.map(f64x2::new)).to_array();
            })+
            let address = |function| match function {
                $(Function::$function => $method as *const u8,)+
                Function::Curve { .. } => unreachable!("it is none of all"),
            };
            Function::ALL.map(address).to_vec()
        }
    };
}

functions! {
    [x, y]
    Sqrt: sqrt(x),
    Sin: sin(x),
    Cos: cos(x),
    Tanh: tanh(x),
    Atan2: atan2(x, y),
    Exp: exp(x),
    Ln: ln(x),
    Abs: abs(x),
    Floor: floor(x),
    When: when(x, y),
    Unless: unless(x, y),
}

/// A derivative of a curve by its order.
extern "C-unwind" fn curve<T: Scalar>(x: T, curve: &Spline, order: usize) -> T {
    engine::curve(curve, order, x)
}

/// That of a pack, which takes its place.
extern "C" fn curve_of_pack(packs: &mut [[f64; 2]; 2], curve: &Spline, order: usize) {
    let x = f64x2::new(packs[0]);
    packs[0] = engine::curve(curve, order, x).to_array();
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

impl Native for f64x2 {
    const BITS: u32 = 128;
    type Time = *const Self;
    fn time(&self) -> *const Self {
        self
    }
    fn functions() -> Vec<*const u8> {
        addresses_of_packs().into_iter().chain([sin_cos_of_pair as *const u8]).collect()
    }
    fn curve() -> *const u8 {
        curve_of_pack as *const u8
    }
}

impl Native for f64 {
    const BITS: u32 = 64;
    type Time = Self;
    fn time(&self) -> Self {
        *self
    }
    fn functions() -> Vec<*const u8> {
        addresses::<Self>().into_iter().chain([sin_cos as *const u8]).collect()
    }
    fn curve() -> *const u8 {
        curve::<Self> as *const u8
    }
}

impl Native for f32 {
    const BITS: u32 = 32;
    type Time = Self;
    fn time(&self) -> Self {
        *self
    }
    fn functions() -> Vec<*const u8> {
        addresses::<Self>()
    }
    fn curve() -> *const u8 {
        curve::<Self> as *const u8
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
