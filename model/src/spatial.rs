//! Vectors and Euler parameters in `f64`: just what the assembly of the start needs.

use std::ops::Mul;

use num_traits::{Signed, Zero};

use crate::{Rational, to_f64};

/// A vector of three components.
pub type Vector = nalgebra::Vector3<f64>;

/// Euler parameters `(e0, e1, e2, e3)`, scalar first, paper section 2.
///
/// A unit quaternion `p` turns components in a body's frame into components in the frame that `p` is measured in, by
/// the matrix `A(p)` of paper eq. (3); `A(p) A(q) = A(p q)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quaternion(pub [f64; 4]);

/// The unit vector along an exact direction of any length; `None` if that length is zero.
///
/// The scaling is exact, so no direction is too long or too short for it.
pub fn unit_vector(direction: &[Rational; 3]) -> Option<Vector> {
    scaled(direction).map(|v| Vector::from(v).normalize())
}

/// Elements of a unit quaternion below this are zero but for rounding.
const ROUNDING: f64 = 1e-12;

impl Quaternion {
    /// No rotation.
    pub const IDENTITY: Self = Self([1.0, 0.0, 0.0, 0.0]);

    /// The unit quaternion along exact Euler parameters of any length; `None` if that length is zero.
    pub fn unit(parameters: &[Rational; 4]) -> Option<Self> {
        scaled(parameters).map(|p| Self(p).normalised())
    }

    /// Rotation by an angle (rad) about the frame's own z axis.
    pub fn about_z(angle: f64) -> Self {
        let (sin, cos) = (0.5 * angle).sin_cos();
        Self([cos, 0.0, 0.0, sin])
    }

    /// The orientation of a right-handed frame of unit vectors `(f, g, h)`: `A(p) = [f g h]`.
    ///
    /// The largest of the four parameters comes from the diagonal of `A`, the others from sums and differences of its
    /// off-diagonal elements, so nothing cancels.
    pub fn from_frame(f: Vector, g: Vector, h: Vector) -> Self {
        let ([a00, a10, a20], [a01, a11, a21], [a02, a12, a22]) = (f.into(), g.into(), h.into());
        // Four times the squares of e0 to e3: paper, eq. (3).
        let squares =
            [1.0 + a00 + a11 + a22, 1.0 + a00 - a11 - a22, 1.0 - a00 + a11 - a22, 1.0 - a00 - a11 + a22];
        let largest = (0..4).fold(0, |best, k| if squares[k] > squares[best] { k } else { best });
        let row = match largest {
            0 => [squares[0], a21 - a12, a02 - a20, a10 - a01],
            1 => [a21 - a12, squares[1], a01 + a10, a02 + a20],
            2 => [a02 - a20, a01 + a10, squares[2], a12 + a21],
            _ => [a10 - a01, a02 + a20, a12 + a21, squares[3]],
        };
        Self(row).normalised()
    }

    /// The same rotation backwards.
    pub fn conjugate(self) -> Self {
        let [a, b, c, d] = self.0;
        Self([a, -b, -c, -d])
    }

    /// Scalar product of the four parameters.
    pub fn dot(self, other: Self) -> f64 {
        self.0.iter().zip(other.0).map(|(a, b)| a * b).sum()
    }

    /// The same direction at length one; not a number if the length is zero.
    pub fn normalised(self) -> Self {
        let norm = self.dot(self).sqrt();
        Self(self.0.map(|e| e / norm))
    }

    /// Of the two quaternions of this rotation, the one nearer to another.
    ///
    /// Equally near ones are told apart by their first element that is not zero, which is made positive.
    pub fn nearest(self, other: Self) -> Self {
        let side = self.dot(other);
        let first = self.0.into_iter().find(|&e| e != 0.0).unwrap_or(1.0);
        if side < 0.0 || (side == 0.0 && first < 0.0) { Self(self.0.map(|e| -e)) } else { self }
    }

    /// Of the two quaternions of this rotation, the one whose first element that is not zero, but for rounding, is
    /// positive.
    pub fn positive(self) -> Self {
        let first = self.0.into_iter().find(|e| e.abs() > ROUNDING).unwrap_or(1.0);
        if first < 0.0 { Self(self.0.map(|e| -e)) } else { self }
    }

    /// The matrix `A(p)`, paper eq. (3), by rows.
    pub fn matrix(self) -> [[f64; 3]; 3] {
        let [a, b, c, d] = self.0;
        [
            [2.0 * (a * a + b * b - 0.5), 2.0 * (b * c - a * d), 2.0 * (b * d + a * c)],
            [2.0 * (b * c + a * d), 2.0 * (a * a + c * c - 0.5), 2.0 * (c * d - a * b)],
            [2.0 * (b * d - a * c), 2.0 * (c * d + a * b), 2.0 * (a * a + d * d - 0.5)],
        ]
    }

    /// `A(p) v`: from the body's frame to the frame that `p` is measured in.
    pub fn rotate(self, v: Vector) -> Vector {
        Vector::from(self.matrix().map(|row| Vector::from(row).dot(&v)))
    }

    /// `A(p)ᵀ v`: from the frame that `p` is measured in to the body's frame.
    pub fn rotate_back(self, v: Vector) -> Vector {
        self.conjugate().rotate(v)
    }
}

/// Quaternion product: first the right rotation, then the left one.
impl Mul for Quaternion {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let ([a, b, c, d], [w, x, y, z]) = (self.0, other.0);
        Self([
            a * w - b * x - c * y - d * z,
            a * x + b * w + c * z - d * y,
            a * y - b * z + c * w + d * x,
            a * z + b * y - c * x + d * w,
        ])
    }
}

/// The elements rounded; divided exactly by the largest of them before that if their squares would leave `f64`.
fn scaled<const N: usize>(exact: &[Rational; N]) -> Option<[f64; N]> {
    let largest = exact.iter().map(Signed::abs).max().filter(|m| !m.is_zero())?;
    if (1e-100..=1e100).contains(&to_f64(&largest)) {
        return Some(exact.each_ref().map(to_f64));
    }
    Some(exact.each_ref().map(|x| to_f64(&(x / &largest))))
}

#[cfg(test)]
mod tests;
