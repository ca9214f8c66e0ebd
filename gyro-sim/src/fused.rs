//! Multiplication and addition as one operation.
//!
//! Generated kernels write `T::fused(a, b, c)` for `a b + c` where a product feeds one sum and nothing else. With an
//! instruction for it, as x86-64-v3 has, that is faster and rounded once; without one, a fused operation would be a
//! call many times as slow, so the same text is plain arithmetic, rounded twice. Whether there is one is the target's
//! features at compile time: `-C target-cpu=native` or `-C target-feature=+fma`. Targets other than x86 are plain so
//! far.
//!
//! So results differ by roundings between targets with and without. The feature `deterministic` turns fusing off: the
//! same bits everywhere.

/// Whether this build fuses.
pub const IS_FUSED: bool = cfg!(all(
    not(feature = "deterministic"),
    any(target_arch = "x86", target_arch = "x86_64"),
    target_feature = "fma"
));

// `core` has no stable call for it that is safe; `safe_arch` is built for such targets only.
#[cfg(all(
    not(feature = "deterministic"),
    any(target_arch = "x86", target_arch = "x86_64"),
    target_feature = "fma"
))]
mod instruction {
    use safe_arch::{
        fused_mul_add_m128_s, fused_mul_add_m128d_s, get_f32_from_m128_s, get_f64_from_m128d_s, set_m128_s,
        set_m128d_s,
    };

    #[inline(always)]
    pub(crate) fn double(a: f64, b: f64, c: f64) -> f64 {
        let [a, b, c] = [a, b, c].map(set_m128d_s);
        get_f64_from_m128d_s(fused_mul_add_m128d_s(a, b, c))
    }

    #[inline(always)]
    pub(crate) fn single(a: f32, b: f32, c: f32) -> f32 {
        let [a, b, c] = [a, b, c].map(set_m128_s);
        get_f32_from_m128_s(fused_mul_add_m128_s(a, b, c))
    }
}

#[cfg(not(all(
    not(feature = "deterministic"),
    any(target_arch = "x86", target_arch = "x86_64"),
    target_feature = "fma"
)))]
mod instruction {
    #[inline(always)]
    pub(crate) fn double(a: f64, b: f64, c: f64) -> f64 {
        a * b + c
    }

    #[inline(always)]
    pub(crate) fn single(a: f32, b: f32, c: f32) -> f32 {
        a * b + c
    }
}

pub(crate) use instruction::{double, single};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_rounded_once_or_twice_as_this_build_says() {
        // The square is 1 + 2⁻²⁹ + 2⁻⁶⁰ before it is rounded; 1 + 2⁻¹³ + 2⁻²⁸ in single precision.
        let (x, y) = (1.0 + 2f64.powi(-30), 1.0 + 2f32.powi(-14));
        let rests = (double(x, x, -(1.0 + 2f64.powi(-29))), single(y, y, -(1.0 + 2f32.powi(-13))));
        let expected = if IS_FUSED { (2f64.powi(-60), 2f32.powi(-28)) } else { (0.0, 0.0) };
        assert_eq!(rests, expected);
    }
}
