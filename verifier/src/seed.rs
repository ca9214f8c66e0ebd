//! Where primes and points come from.

use chacha20::ChaCha8Rng;
use rand::SeedableRng;
use std::fmt;
use std::num::ParseIntError;
use std::str::FromStr;

/// What random numbers are made of. How likely a false proof is, is said of a seed that nobody knew when the module was
/// written: of one that was drawn afterwards.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Seed {
    number: u128,
    /// Which of the points of a claim.
    point: u64,
}

impl Seed {
    /// The same each time, for what must not depend on chance.
    pub const FIXED: Self = Self { number: 0x6779_726f, point: 0 };

    /// A new one, from the operating system.
    pub fn fresh() -> Self {
        Self { number: rand::random(), point: 0 }
    }

    /// The seed of another point.
    pub(crate) fn of_point(self, point: u64) -> Self {
        Self { point, ..self }
    }

    /// Random numbers; `number` makes them other ones.
    pub(crate) fn numbers(self, number: u64) -> ChaCha8Rng {
        let mut key = [0; 32];
        key[..16].copy_from_slice(&self.number.to_le_bytes());
        key[16..24].copy_from_slice(&self.point.to_le_bytes());
        key[24..].copy_from_slice(&number.to_le_bytes());
        ChaCha8Rng::from_seed(key)
    }
}

impl From<u64> for Seed {
    fn from(number: u64) -> Self {
        Self { number: number.into(), point: 0 }
    }
}

/// In hexadecimal digits, as [`FromStr`] reads it.
impl fmt::Display for Seed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:x}", self.number)
    }
}

impl FromStr for Seed {
    type Err = ParseIntError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        u128::from_str_radix(text, 16).map(|number| Self { number, point: 0 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::Rng;

    #[test]
    fn a_seed_is_read_as_it_is_written_and_each_makes_numbers_of_its_own() {
        let fresh = Seed::fresh();
        assert_eq!(fresh.to_string().parse(), Ok(fresh));
        assert_ne!(fresh, Seed::fresh());
        assert!("12x".parse::<Seed>().is_err() && "".parse::<Seed>().is_err());
        let first = |seed: Seed, number| seed.numbers(number).next_u64();
        let others =
            [first(fresh, 1), first(fresh.of_point(1), 0), first(Seed::fresh(), 0), first(7.into(), 0)];
        assert!(others.iter().all(|other| *other != first(fresh, 0)));
        assert_eq!(first(fresh, 1), others[0]);
    }
}
