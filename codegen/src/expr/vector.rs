//! Vectors and matrices of expressions.

use crate::expr::graph::{ExprId, Graph};

pub type Vec3 = [ExprId; 3];
pub type Vec4 = [ExprId; 4];
/// Rows of columns: `m[row][column]`.
pub type Mat3 = [Vec3; 3];

pub const ZERO3: Vec3 = [Graph::ZERO; 3];

/// The unit vectors.
pub const UNIT3: Mat3 = [
    [Graph::ONE, Graph::ZERO, Graph::ZERO],
    [Graph::ZERO, Graph::ONE, Graph::ZERO],
    [Graph::ZERO, Graph::ZERO, Graph::ONE],
];

pub fn transposed(m: &Mat3) -> Mat3 {
    std::array::from_fn(|row| std::array::from_fn(|column| m[column][row]))
}

impl Graph {
    pub fn dot<const N: usize>(&mut self, a: &[ExprId; N], b: &[ExprId; N]) -> ExprId {
        let mut sum = Self::ZERO;
        for (&a, &b) in a.iter().zip(b) {
            let product = self.mul(a, b);
            sum = self.add(sum, product);
        }
        sum
    }

    /// Of as many numbers as both have.
    pub fn dot_slices(&mut self, a: &[ExprId], b: &[ExprId]) -> ExprId {
        a.iter().zip(b).fold(Self::ZERO, |sum, (&a, &b)| {
            let product = self.mul(a, b);
            self.add(sum, product)
        })
    }

    pub fn cross(&mut self, a: &Vec3, b: &Vec3) -> Vec3 {
        std::array::from_fn(|k| {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            let (plus, minus) = (self.mul(a[i], b[j]), self.mul(a[j], b[i]));
            self.sub(plus, minus)
        })
    }

    /// `w × (w × s)`.
    pub fn centripetal(&mut self, w: &Vec3, s: &Vec3) -> Vec3 {
        let speed = self.cross(w, s);
        self.cross(w, &speed)
    }

    /// `w̃w̃ + ẇ̃`.
    pub fn relative_acceleration(&mut self, w: &Vec3, w_dot: &Vec3) -> Mat3 {
        let squares = w.map(|w| self.mul(w, w));
        let turning = self.tilde(w_dot);
        std::array::from_fn(|row| {
            std::array::from_fn(|column| {
                if row == column {
                    let sum = self.add(squares[(row + 1) % 3], squares[(row + 2) % 3]);
                    return self.neg(sum);
                }
                let product = self.mul(w[row], w[column]);
                self.add(product, turning[row][column])
            })
        })
    }

    pub fn add_vec<const N: usize>(&mut self, a: &[ExprId; N], b: &[ExprId; N]) -> [ExprId; N] {
        std::array::from_fn(|k| self.add(a[k], b[k]))
    }

    pub fn sub_vec<const N: usize>(&mut self, a: &[ExprId; N], b: &[ExprId; N]) -> [ExprId; N] {
        std::array::from_fn(|k| self.sub(a[k], b[k]))
    }

    pub fn scale_vec<const N: usize>(&mut self, factor: ExprId, a: &[ExprId; N]) -> [ExprId; N] {
        a.map(|x| self.mul(factor, x))
    }

    pub fn neg_vec<const N: usize>(&mut self, a: &[ExprId; N]) -> [ExprId; N] {
        a.map(|x| self.neg(x))
    }

    /// `a / |a|`.
    pub fn normalise<const N: usize>(&mut self, a: &[ExprId; N]) -> [ExprId; N] {
        let square = self.dot(a, a);
        let norm = self.sqrt(square);
        let inverse = self.recip(norm);
        self.scale_vec(inverse, a)
    }

    pub fn mat_vec(&mut self, m: &Mat3, v: &Vec3) -> Vec3 {
        std::array::from_fn(|row| self.dot(&m[row], v))
    }

    /// `mᵀ v`.
    pub fn transposed_vec(&mut self, m: &Mat3, v: &Vec3) -> Vec3 {
        std::array::from_fn(|column| self.dot(&[m[0][column], m[1][column], m[2][column]], v))
    }

    pub fn mat_mul(&mut self, a: &Mat3, b: &Mat3) -> Mat3 {
        std::array::from_fn(|row| self.transposed_vec(b, &a[row]))
    }

    pub fn sub_mat(&mut self, a: &Mat3, b: &Mat3) -> Mat3 {
        std::array::from_fn(|row| self.sub_vec(&a[row], &b[row]))
    }

    /// ã, with `ã b = a × b`.
    pub fn tilde(&mut self, a: &Vec3) -> Mat3 {
        let [x, y, z] = *a;
        let [nx, ny, nz] = self.neg_vec(a);
        [[Self::ZERO, nz, y], [z, Self::ZERO, nx], [ny, x, Self::ZERO]]
    }

    /// A(p), paper eq. (3).
    pub fn rotation(&mut self, p: &Vec4) -> Mat3 {
        let two = self.integer(2);
        let half = self.fraction(1, 2);
        std::array::from_fn(|row| {
            std::array::from_fn(|column| {
                let entry = if row == column {
                    let (scalar, vector) = (self.mul(p[0], p[0]), self.mul(p[row + 1], p[row + 1]));
                    let squares = self.add(scalar, vector);
                    self.sub(squares, half)
                } else {
                    // e_row e_column ± e0 e_other: minus where (row, column, other) is an even permutation.
                    let other = 3 - row - column;
                    let (symmetric, skew) =
                        (self.mul(p[row + 1], p[column + 1]), self.mul(p[0], p[other + 1]));
                    if (column + 3 - row) % 3 == 1 {
                        self.sub(symmetric, skew)
                    } else {
                        self.add(symmetric, skew)
                    }
                };
                self.mul(two, entry)
            })
        })
    }

    /// The same numbers for any p, by way of 2p: all of them take 24 operations instead of 31, few of them may take
    /// more.
    pub fn rotation_by_doubles(&mut self, p: &Vec4) -> Mat3 {
        let two = self.integer(2);
        let doubles = p.map(|e| self.mul(two, e));
        let shared = self.mul(doubles[0], p[0]);
        let shared = self.sub(shared, Self::ONE);
        std::array::from_fn(|row| {
            std::array::from_fn(|column| {
                // As in [`Self::rotation`].
                let (first, second) = (row.min(column) + 1, row.max(column) + 1);
                let symmetric = self.mul(doubles[first], p[second]);
                if row == column {
                    return self.add(shared, symmetric);
                }
                let skew = self.mul(doubles[0], p[4 - row - column]);
                if (column + 3 - row) % 3 == 1 {
                    self.sub(symmetric, skew)
                } else {
                    self.add(symmetric, skew)
                }
            })
        })
    }

    /// `|p|² A(p / |p|)`: eq. (3) with pᵀp for its one.
    pub fn homogeneous_rotation(&mut self, p: &Vec4) -> Mat3 {
        let a = self.rotation(p);
        let square = self.dot(p, p);
        let missing = self.sub(Self::ONE, square);
        std::array::from_fn(|row| {
            std::array::from_fn(|column| {
                if row == column { self.add(a[row][column], missing) } else { a[row][column] }
            })
        })
    }

    /// G(p), paper eq. (15): rows of four.
    pub fn g_matrix(&mut self, p: &Vec4) -> [Vec4; 3] {
        let [e0, e1, e2, e3] = *p;
        let [_, n1, n2, n3] = self.neg_vec(p);
        [[n1, e0, e3, n2], [n2, n3, e0, e1], [n3, e2, n1, e0]]
    }

    /// `p ∘ q`: first the turn q, then p, as A(p) A(q).
    pub fn compose(&mut self, p: &Vec4, q: &Vec4) -> Vec4 {
        // (p0 q0 − p·q, p0 q + q0 p + p × q) = q0 p + Gᵀ(p) q.
        let g = self.g_matrix(p);
        std::array::from_fn(|k| {
            let kept = self.mul(q[0], p[k]);
            let turned = self.dot(&[g[0][k], g[1][k], g[2][k]], &[q[1], q[2], q[3]]);
            self.add(kept, turned)
        })
    }

    /// The angle of the point (cosine, sine) that is nearest to one that is known.
    pub fn continued(&mut self, known: ExprId, sine: ExprId, cosine: ExprId) -> ExprId {
        let (sin, cos) = (self.sin(known), self.cos(known));
        let (minus_sin, point) = (self.neg(sin), [cosine, sine]);
        let (across, along) = (self.dot(&point, &[minus_sin, cos]), self.dot(&point, &[cos, sin]));
        let rest = self.atan2(across, along);
        self.add(known, rest)
    }

    /// `½ G(p)ᵀ w`, paper eq. (14).
    pub fn euler_rate(&mut self, p: &Vec4, w: &Vec3) -> Vec4 {
        let g = self.g_matrix(p);
        let half = self.fraction(1, 2);
        std::array::from_fn(|k| {
            let sum = self.dot(&[g[0][k], g[1][k], g[2][k]], w);
            self.mul(half, sum)
        })
    }

    /// Solves `[a; b; c] x = rhs` for three rows by Cramer's rule in cross products.
    pub fn solve3(&mut self, rows: &Mat3, rhs: &Vec3) -> Vec3 {
        let [a, b, c] = rows;
        let cofactors = [self.cross(b, c), self.cross(c, a), self.cross(a, b)];
        let determinant = self.dot(c, &cofactors[2]);
        let inverse = self.recip(determinant);
        let sum = self.transposed_vec(&cofactors, rhs);
        self.scale_vec(inverse, &sum)
    }
}
