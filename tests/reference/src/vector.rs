//! The few vector operations the equations need, over any [`Real`].

use crate::Real;

pub(crate) type Vector<T> = [T; 3];

pub(crate) fn add<T: Real>(a: Vector<T>, b: Vector<T>) -> Vector<T> {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub(crate) fn sub<T: Real>(a: Vector<T>, b: Vector<T>) -> Vector<T> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(crate) fn scale<T: Real>(factor: T, a: Vector<T>) -> Vector<T> {
    [factor * a[0], factor * a[1], factor * a[2]]
}

pub(crate) fn dot<T: Real>(a: Vector<T>, b: Vector<T>) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross<T: Real>(a: Vector<T>, b: Vector<T>) -> Vector<T> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The product of each component of `a` with its namesake in `b`: a diagonal matrix times a vector.
pub(crate) fn diagonal<T: Real>(a: Vector<T>, b: Vector<T>) -> Vector<T> {
    [a[0] * b[0], a[1] * b[1], a[2] * b[2]]
}

/// A rotation about one axis, kept as the sine and cosine of its angle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Turn<T> {
    pub(crate) sin: T,
    pub(crate) cos: T,
}

impl<T: Real> Turn<T> {
    pub(crate) fn new(angle: T) -> Self {
        let (sin, cos) = angle.sin_cos();
        Turn { sin, cos }
    }

    /// The rotation by the opposite angle.
    pub(crate) fn inverse(self) -> Self {
        Turn { sin: -self.sin, cos: self.cos }
    }

    /// Rx times `a`.
    pub(crate) fn about_x(self, a: Vector<T>) -> Vector<T> {
        [a[0], self.cos * a[1] - self.sin * a[2], self.sin * a[1] + self.cos * a[2]]
    }

    /// Ry times `a`.
    pub(crate) fn about_y(self, a: Vector<T>) -> Vector<T> {
        [self.cos * a[0] + self.sin * a[2], a[1], self.cos * a[2] - self.sin * a[0]]
    }

    /// Rz times `a`.
    pub(crate) fn about_z(self, a: Vector<T>) -> Vector<T> {
        [self.cos * a[0] - self.sin * a[1], self.sin * a[0] + self.cos * a[1], a[2]]
    }
}

/// The solution x of A x = b for a symmetric positive definite A, by A = L D Lᵀ. Only the lower triangle is read.
pub(crate) fn solve_symmetric<T: Real>(a: [Vector<T>; 3], b: Vector<T>) -> Vector<T> {
    let d0 = a[0][0];
    let (l10, l20) = (a[1][0] / d0, a[2][0] / d0);
    let d1 = a[1][1] - l10 * a[1][0];
    let e21 = a[2][1] - l20 * a[1][0];
    let l21 = e21 / d1;
    let d2 = a[2][2] - l20 * a[2][0] - l21 * e21;

    let y1 = b[1] - l10 * b[0];
    let x2 = (b[2] - l20 * b[0] - l21 * y1) / d2;
    let x1 = y1 / d1 - l21 * x2;
    [b[0] / d0 - l10 * x1 - l20 * x2, x1, x2]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn symmetric_solve_recovers_a_planted_solution() {
        let a = [[4.0, 1.0, -2.0], [1.0, 3.0, 0.5], [-2.0, 0.5, 5.0]];
        let planted = [0.3, -1.7, 2.9];
        let found = solve_symmetric(a, [dot(a[0], planted), dot(a[1], planted), dot(a[2], planted)]);
        for (x, p) in found.iter().zip(planted) {
            assert!((x - p).abs() < 1e-14, "{found:?}");
        }
    }

    #[test]
    fn turns_follow_the_right_hand_rule_and_undo_themselves() {
        let quarter = Turn { sin: 1.0, cos: 0.0 };
        assert_eq!(quarter.about_x([0.0, 1.0, 0.0]), [0.0, 0.0, 1.0]);
        assert_eq!(quarter.about_y([0.0, 0.0, 1.0]), [1.0, 0.0, 0.0]);
        assert_eq!(quarter.about_z([1.0, 0.0, 0.0]), [0.0, 1.0, 0.0]);
        let a = [0.25, -3.0, 7.0];
        assert_eq!(quarter.inverse().about_y(quarter.about_y(a)), a);
    }
}
