//! Sobol's points, indexed directly.
//!
//! Point k is the exclusive or of the direction numbers of those bits that the Gray code of k has (Antonov and Saleev
//! 1979), so that no point depends on having made the ones before it. The direction numbers are those of Joe and Kuo
//! (*Constructing Sobol sequences with better two-dimensional projections*, SIAM J. Sci. Comput. 30, 2008): the first
//! hundred dimensions of their file `new-joe-kuo-6.21201`, <https://web.maths.unsw.edu.au/~fkuo/sobol>, which may be
//! used freely under its BSD-style licence.

/// The published table: of each dimension but the first d, s, a and m_1 to m_s.
const TABLE: &str = include_str!("new-joe-kuo-6.100.txt");

/// Dimensions that the table has.
#[cfg(any(feature = "study", test))]
pub(crate) const DIMENSIONS: usize = 100;

/// Bits of a point, and so of the index of the last one.
const BITS: usize = 52;

/// The direction numbers of some dimensions.
#[derive(Clone, Debug)]
pub(crate) struct Sobol {
    directions: Vec<[u64; BITS]>,
}

impl Sobol {
    /// The first of these dimensions, at most [`DIMENSIONS`].
    pub(crate) fn new(dimensions: usize) -> Self {
        let first = std::array::from_fn(|bit| 1 << (BITS - 1 - bit));
        let others = TABLE.lines().skip(1).map(directions);
        Self { directions: std::iter::once(first).chain(others).take(dimensions).collect() }
    }

    /// One coordinate of point k, an integer of [`BITS`] bits.
    pub(crate) fn bits(&self, k: u64, dimension: usize) -> u64 {
        let (mut gray, mut bits) = (k ^ (k >> 1), 0);
        let directions = &self.directions[dimension];
        while gray != 0 {
            bits ^= directions.get(gray.trailing_zeros() as usize).copied().unwrap_or(0);
            gray &= gray - 1;
        }
        bits
    }

    /// The middle of the interval that these bits name, within (0, 1).
    pub(crate) fn unit(bits: u64) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "52 bits")]
        let whole = (bits & ((1 << BITS) - 1)) as f64;
        (whole + 0.5) / (1u64 << BITS) as f64
    }
}

/// The direction numbers of a line of the table: `v_k = m_k / 2^k`, continued by the recurrence of the primitive
/// polynomial whose inner coefficients are the bits of a.
fn directions(line: &str) -> [u64; BITS] {
    let numbers: Vec<u64> = line.split_whitespace().filter_map(|number| number.parse().ok()).collect();
    let (s, a, m) = (usize::try_from(numbers[1]).unwrap_or(0), numbers[2], &numbers[3..]);
    let mut v = [0u64; BITS];
    for k in 0..BITS {
        v[k] = if k < s {
            m[k] << (BITS - 1 - k)
        } else {
            let inner = (1..s).filter(|i| a >> (s - 1 - i) & 1 == 1);
            inner.fold(v[k - s] ^ (v[k - s] >> s), |sum, i| sum ^ v[k - i])
        };
    }
    v
}

#[cfg(test)]
mod tests;
