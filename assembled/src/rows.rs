//! The constraint rows: values, Jacobian blocks and γ, typed from the paper's section 4 and Haug (1989), chapter 11.
//!
//! One walk over the rows serves Φ_q and (Φ_r, Φ_π'): it calls a sink with row, column and value of each entry that is
//! not zero by structure, row by row.

use crate::lowered::{Constrained, End, Joint, Lowered, Motion};
use crate::number::{Number, number};
use crate::textbook::{g_matrix, relative_matrix, rotated_gradient, tilde};
use nalgebra::{Matrix3, SMatrix, Vector3};

/// One body's columns in the rows of a joint: `3 + N` for (r, p) with N = 4 or (r, π') with N = 3.
struct EndBlock<T, const N: usize> {
    slot: Option<usize>,
    /// The diagonal of the point rows' r block: −1 on the first body, 1 on the second.
    sign: T,
    point: SMatrix<T, 3, N>,
    dots: SMatrix<T, 3, N>,
}

impl<T: Number, const N: usize> EndBlock<T, N> {
    /// Blocks of a joint's first and second body, still empty but for the r part.
    fn pair(joint: &Joint<T>) -> [Self; 2] {
        let (point, dots) = (SMatrix::zeros(), SMatrix::zeros());
        let block = |end: &End<T>, sign| Self { slot: end.place.slot(), sign, point, dots };
        [block(&joint.first, -T::one()), block(&joint.second, T::one())]
    }
}

impl<T: Number> Lowered<T> {
    /// Writes Φ: joint rows, then normalisations.
    pub(crate) fn phi(&self, y: &[T], out: &mut [T]) {
        for body in &self.constrained {
            let relative = relative_matrix(&body.p0) * self.p(y, body.slot);
            write(out, body.first_row, &(self.r(y, body.slot) - body.r0)); // eq. (5)
            write(out, body.first_row + 3, &relative.fixed_rows::<3>(1).into_owned()); // eq. (6)
        }
        for joint in &self.joints {
            let (i, j) = self.motions(y, joint);
            write(out, joint.first_row, &(tip(&j, &joint.second) - tip(&i, &joint.first))); // eq. (7)
            for (row, dot) in (joint.first_row + 3..).zip(&joint.dots) {
                out[row] = (i.a * dot.a).dot(&(j.a * dot.b)); // eqs. (9), (10)
            }
        }
        for (slot, out) in out[self.n_rows()..].iter_mut().enumerate() {
            *out = self.p(y, slot).norm_squared() - T::one(); // eq. (12)
        }
    }

    /// Φ_q, joint rows and normalisations, columns (r, p) body after body.
    pub(crate) fn phi_q(&self, y: &[T], mut sink: impl FnMut(usize, usize, T)) {
        for body in &self.constrained {
            // The orientation rows are linear in p: rows e1 to e3 of p̄₀ ∘ p, which are G(p₀) p.
            walk_constrained(body, &g_matrix(&body.p0), &mut sink);
        }
        for joint in &self.joints {
            let (i, j) = self.motions(y, joint);
            let mut blocks = EndBlock::pair(joint);
            blocks[0].point = -rotated_gradient(&i.p, &joint.first.point);
            blocks[1].point = rotated_gradient(&j.p, &joint.second.point);
            for (k, dot) in joint.dots.iter().enumerate() {
                blocks[0].dots.set_row(k, &((j.a * dot.b).transpose() * rotated_gradient(&i.p, &dot.a)));
                blocks[1].dots.set_row(k, &((i.a * dot.a).transpose() * rotated_gradient(&j.p, &dot.b)));
            }
            walk_joint(joint, &blocks, &mut sink);
        }
        for slot in 0..self.n_bodies() {
            let p = self.p(y, slot);
            (0..4).for_each(|k| sink(self.n_rows() + slot, 7 * slot + 3 + k, number::<T>(2.0) * p[k]));
        }
    }

    /// (Φ_r, Φ_π'), joint rows, columns (r, π') body after body.
    pub(crate) fn phi_pi(&self, y: &[T], mut sink: impl FnMut(usize, usize, T)) {
        for body in &self.constrained {
            walk_constrained(body, &orientation_block(&self.relative_orientation(y, body)), &mut sink);
        }
        for joint in &self.joints {
            let (i, j) = self.motions(y, joint);
            let mut blocks = EndBlock::pair(joint);
            // A ã' is the derivative of −A a' with respect to π'.
            blocks[0].point = i.a * tilde(&joint.first.point);
            blocks[1].point = -(j.a * tilde(&joint.second.point));
            for (k, dot) in joint.dots.iter().enumerate() {
                blocks[0].dots.set_row(k, &-((j.a * dot.b).transpose() * i.a * tilde(&dot.a)));
                blocks[1].dots.set_row(k, &-((i.a * dot.a).transpose() * j.a * tilde(&dot.b)));
            }
            walk_joint(joint, &blocks, &mut sink);
        }
    }

    /// Writes γ, the right-hand side of `Φ_r r̈ + Φ_π' ẇ' = γ`.
    pub(crate) fn gamma(&self, y: &[T], out: &mut [T]) {
        for body in &self.constrained {
            let w = self.w(y, body.slot);
            // γ_q = 0, and Ġᵀw' = −½|w'|² p leaves ¼|w'|² times the row itself.
            let quarter = w.norm_squared() * number(0.25);
            write(out, body.first_row, &Vector3::zeros());
            write(out, body.first_row + 3, &(self.relative_orientation(y, body).1 * quarter));
        }
        for joint in &self.joints {
            let (i, j) = self.motions(y, joint);
            let point = centripetal(&i, &joint.first.point) - centripetal(&j, &joint.second.point);
            write(out, joint.first_row, &point);
            for (row, dot) in (joint.first_row + 3..).zip(&joint.dots) {
                out[row] = dot_gamma(&i, &dot.a, &j, &dot.b);
            }
        }
    }

    /// Writes `Φ_r s + Φ_π' w' − ν`; ν = 0, as nothing drives a joint.
    pub(crate) fn velocity_residual(&self, y: &[T], out: &mut [T]) {
        for body in &self.constrained {
            let block = orientation_block(&self.relative_orientation(y, body));
            write(out, body.first_row, &self.s(y, body.slot));
            write(out, body.first_row + 3, &(block * self.w(y, body.slot)));
        }
        for joint in &self.joints {
            let (i, j) = self.motions(y, joint);
            write(out, joint.first_row, &(tip_velocity(&j, &joint.second) - tip_velocity(&i, &joint.first)));
            for (row, dot) in (joint.first_row + 3..).zip(&joint.dots) {
                out[row] = (i.a * i.w.cross(&dot.a)).dot(&(j.a * dot.b))
                    + (i.a * dot.a).dot(&(j.a * j.w.cross(&dot.b)));
            }
        }
    }

    /// Position and velocity of a joint's bodies.
    #[inline]
    pub(crate) fn motions(&self, y: &[T], joint: &Joint<T>) -> (Motion<T>, Motion<T>) {
        (self.motion(y, &joint.first.place), self.motion(y, &joint.second.place))
    }

    /// Scalar and vector part of `p̄₀ ∘ p`.
    pub(crate) fn relative_orientation(&self, y: &[T], body: &Constrained<T>) -> (T, Vector3<T>) {
        let relative = relative_matrix(&body.p0) * self.p(y, body.slot);
        (relative[0], relative.fixed_rows::<3>(1).into_owned())
    }
}

/// Global position of a joint's point.
fn tip<T: Number>(motion: &Motion<T>, end: &End<T>) -> Vector3<T> {
    motion.r + motion.a * end.point
}

/// Global velocity of a joint's point.
fn tip_velocity<T: Number>(motion: &Motion<T>, end: &End<T>) -> Vector3<T> {
    motion.s + motion.a * motion.w.cross(&end.point)
}

/// `A w̃' w̃' a'`: the acceleration of a body's vector at constant w'.
fn centripetal<T: Number>(motion: &Motion<T>, a: &Vector3<T>) -> Vector3<T> {
    motion.a * motion.w.cross(&motion.w.cross(a))
}

/// γ of a dot-1 row: `−(äᵀb + 2 ȧᵀḃ + aᵀb̈)` at constant w'. Haug (1989), section 11.2.
fn dot_gamma<T: Number>(i: &Motion<T>, a: &Vector3<T>, j: &Motion<T>, b: &Vector3<T>) -> T {
    let (a_dot, b_dot) = (i.a * i.w.cross(a), j.a * j.w.cross(b));
    let outer = centripetal(i, a).dot(&(j.a * b)) + (i.a * a).dot(&centripetal(j, b));
    -(outer + number::<T>(2.0) * a_dot.dot(&b_dot))
}

/// The derivative of the vector part of q = p̄₀ ∘ p with respect to π': `½ (q₀ I + q̃)`.
fn orientation_block<T: Number>((q0, q): &(T, Vector3<T>)) -> Matrix3<T> {
    (Matrix3::from_diagonal_element(*q0) + tilde(q)) * number::<T>(0.5)
}

fn walk_constrained<T: Number, const N: usize>(
    body: &Constrained<T>,
    orientation: &SMatrix<T, 3, N>,
    sink: &mut impl FnMut(usize, usize, T),
) {
    let first_column = (3 + N) * body.slot;
    (0..3).for_each(|k| sink(body.first_row + k, first_column + k, T::one()));
    for row in 0..3 {
        for column in 0..N {
            sink(body.first_row + 3 + row, first_column + 3 + column, orientation[(row, column)]);
        }
    }
}

fn walk_joint<T: Number, const N: usize>(
    joint: &Joint<T>,
    blocks: &[EndBlock<T, N>; 2],
    sink: &mut impl FnMut(usize, usize, T),
) {
    // Columns ascend, whichever of the bodies comes first in the state.
    let order = if blocks[0].slot > blocks[1].slot { [1, 0] } else { [0, 1] };
    let blocks = order.map(|k| &blocks[k]);
    let with_slot = || blocks.iter().filter_map(|block| block.slot.map(|slot| ((3 + N) * slot, block)));
    for row in 0..3 {
        for (first_column, block) in with_slot() {
            sink(joint.first_row + row, first_column + row, block.sign);
            (0..N).for_each(|k| sink(joint.first_row + row, first_column + 3 + k, block.point[(row, k)]));
        }
    }
    for row in 0..joint.dots.len() {
        for (first_column, block) in with_slot() {
            (0..N).for_each(|k| sink(joint.first_row + 3 + row, first_column + 3 + k, block.dots[(row, k)]));
        }
    }
}

fn write<T: Number>(out: &mut [T], at: usize, value: &Vector3<T>) {
    out[at..at + 3].copy_from_slice(value.as_slice());
}
