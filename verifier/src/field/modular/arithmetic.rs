//! Arithmetic of limbs, least significant first, of numbers below a prime of at most `64 L − 1` bits.

/// Sum modulo the prime.
pub fn add<const L: usize>(a: &[u64; L], b: &[u64; L], prime: &[u64; L]) -> [u64; L] {
    let mut carry = false;
    let sum = std::array::from_fn(|k| {
        let limb;
        (limb, carry) = a[k].carrying(b[k], carry);
        limb
    });
    reduced(sum, prime)
}

/// Difference modulo the prime.
pub fn sub<const L: usize>(a: &[u64; L], b: &[u64; L], prime: &[u64; L]) -> [u64; L] {
    let (difference, borrow) = subtract(a, b);
    if !borrow {
        return difference;
    }
    let mut carry = false;
    std::array::from_fn(|k| {
        let limb;
        (limb, carry) = difference[k].carrying(prime[k], carry);
        limb
    })
}

/// Montgomery's product `a b / 2^(64 L)` modulo the prime; `inverse` is `−1 / prime` modulo 2^64. Coarsely integrated
/// operand scanning: Koç, Acar, Kaliski, *Analyzing and Comparing Montgomery Multiplication Algorithms* (1996).
pub fn mul<const L: usize>(a: &[u64; L], b: &[u64; L], prime: &[u64; L], inverse: u64) -> [u64; L] {
    // The number so far has one limb more than the array, since all that is added stays below 2^(64 L + 64).
    let (mut sum, mut top) = ([0; L], 0);
    for &factor in b {
        let carry = multiply_add(&mut sum, a, factor);
        let (high, overflow) = add_wide(top, carry);
        let reduction = sum[0].wrapping_mul(inverse);
        let carry = multiply_add(&mut sum, prime, reduction);
        let (high, more) = add_wide(high, carry);
        sum.rotate_left(1);
        sum[L - 1] = high;
        top = overflow + more;
    }
    reduced(sum, prime)
}

/// Adds `a · factor`, returns what carries out.
fn multiply_add<const L: usize>(sum: &mut [u64; L], a: &[u64; L], factor: u64) -> u64 {
    let mut carry = 0;
    for (limb, &a) in sum.iter_mut().zip(a) {
        let wide = u128::from(a) * u128::from(factor) + u128::from(*limb) + u128::from(carry);
        (*limb, carry) = halves(wide);
    }
    carry
}

#[expect(clippy::cast_possible_truncation, reason = "the halves are what is meant")]
fn halves(wide: u128) -> (u64, u64) {
    (wide as u64, (wide >> 64) as u64)
}

fn add_wide(a: u64, b: u64) -> (u64, u64) {
    let (sum, overflow) = a.overflowing_add(b);
    (sum, u64::from(overflow))
}

/// Brings a number below twice the prime below the prime.
fn reduced<const L: usize>(value: [u64; L], prime: &[u64; L]) -> [u64; L] {
    let (difference, borrow) = subtract(&value, prime);
    if borrow { value } else { difference }
}

fn subtract<const L: usize>(a: &[u64; L], b: &[u64; L]) -> ([u64; L], bool) {
    let mut borrow = false;
    let difference = std::array::from_fn(|k| {
        let limb;
        (limb, borrow) = a[k].borrowing(b[k], borrow);
        limb
    });
    (difference, borrow)
}

/// Sums with a carry in and out.
trait Carry: Sized {
    fn carrying(self, other: Self, carry: bool) -> (Self, bool);
    fn borrowing(self, other: Self, borrow: bool) -> (Self, bool);
}

impl Carry for u64 {
    fn carrying(self, other: Self, carry: bool) -> (Self, bool) {
        let (sum, first) = self.overflowing_add(other);
        let (sum, second) = sum.overflowing_add(Self::from(carry));
        (sum, first || second)
    }

    fn borrowing(self, other: Self, borrow: bool) -> (Self, bool) {
        let (difference, first) = self.overflowing_sub(other);
        let (difference, second) = difference.overflowing_sub(Self::from(borrow));
        (difference, first || second)
    }
}
