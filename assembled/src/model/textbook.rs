//! The matrices of the textbook, as the paper and Haug (1989) print them.

use nalgebra::{Matrix3, Matrix3x4, Matrix4, RealField, Vector3, Vector4};

/// ã, with `ã b = a × b`.
pub(crate) fn tilde<T: RealField + Copy>(a: &Vector3<T>) -> Matrix3<T> {
    let o = T::zero();
    Matrix3::new(
        o, -a.z, a.y, //
        a.z, o, -a.x, //
        -a.y, a.x, o,
    )
}

/// A(p), paper, eq. (3): from body components to global ones.
pub(crate) fn rotation<T: RealField + Copy>(p: &Vector4<T>) -> Matrix3<T> {
    half_rotation(p, nalgebra::convert(0.5)) * nalgebra::convert::<_, T>(2.0)
}

/// A(p / |p|), orthogonal also where a stage of the integrator has left p a little off unit length.
pub(crate) fn direction_rotation<T: RealField + Copy>(p: &Vector4<T>) -> Matrix3<T> {
    let (squares, two) = (p.norm_squared(), nalgebra::convert::<_, T>(2.0));
    half_rotation(p, squares / two) * (two / squares)
}

/// The matrix within eq. (3), with `half` for its 0.5.
fn half_rotation<T: RealField + Copy>(p: &Vector4<T>, half: T) -> Matrix3<T> {
    let [e0, e1, e2, e3] = [p[0], p[1], p[2], p[3]];
    Matrix3::new(
        e0 * e0 + e1 * e1 - half,
        e1 * e2 - e0 * e3,
        e1 * e3 + e0 * e2,
        e1 * e2 + e0 * e3,
        e0 * e0 + e2 * e2 - half,
        e2 * e3 - e0 * e1,
        e1 * e3 - e0 * e2,
        e2 * e3 + e0 * e1,
        e0 * e0 + e3 * e3 - half,
    )
}

/// `∂(A(p) a')/∂p`: eq. (3) times a constant a', differentiated as it stands.
pub(crate) fn rotated_gradient<T: RealField + Copy>(p: &Vector4<T>, a: &Vector3<T>) -> Matrix3x4<T> {
    let [e0, e1, e2, e3] = [p[0], p[1], p[2], p[3]];
    let two = nalgebra::convert::<_, T>(2.0);
    Matrix3x4::from_columns(&[
        Vector3::new(
            two * e0 * a.x - e3 * a.y + e2 * a.z,
            e3 * a.x + two * e0 * a.y - e1 * a.z,
            -e2 * a.x + e1 * a.y + two * e0 * a.z,
        ),
        Vector3::new(two * e1 * a.x + e2 * a.y + e3 * a.z, e2 * a.x - e0 * a.z, e3 * a.x + e0 * a.y),
        Vector3::new(e1 * a.y + e0 * a.z, e1 * a.x + two * e2 * a.y + e3 * a.z, -e0 * a.x + e3 * a.y),
        Vector3::new(-e0 * a.y + e1 * a.z, e0 * a.x + e2 * a.z, e1 * a.x + e2 * a.y + two * e3 * a.z),
    ]) * two
}

/// G(p), paper, eq. (15).
pub(crate) fn g_matrix<T: RealField + Copy>(p: &Vector4<T>) -> Matrix3x4<T> {
    let [e0, e1, e2, e3] = [p[0], p[1], p[2], p[3]];
    Matrix3x4::new(
        -e1, e0, e3, -e2, //
        -e2, -e3, e0, e1, //
        -e3, e2, -e1, e0,
    )
}

/// `ṗ = ½ G(p)ᵀ w'`, paper, eq. (14).
pub(crate) fn p_dot<T: RealField + Copy>(p: &Vector4<T>, w: &Vector3<T>) -> Vector4<T> {
    g_matrix(p).tr_mul(w) * nalgebra::convert::<_, T>(0.5)
}

/// `w' = 2 G(p) ṗ`, the inverse of eq. (14) for a unit p and a ṗ orthogonal to it.
pub(crate) fn angular_velocity<T: RealField + Copy>(p: &Vector4<T>, p_dot: &Vector4<T>) -> Vector3<T> {
    (g_matrix(p) * p_dot) * nalgebra::convert::<_, T>(2.0)
}

/// The matrix that maps p to `p̄₀ ∘ p`, the Euler parameters of p's frame in p₀'s: `[p₀ᵀ; G(p₀)]`.
pub(crate) fn relative_matrix<T: RealField + Copy>(p0: &Vector4<T>) -> Matrix4<T> {
    let mut matrix = Matrix4::zeros();
    matrix.fixed_rows_mut::<1>(0).copy_from(&p0.transpose());
    matrix.fixed_rows_mut::<3>(1).copy_from(&g_matrix(p0));
    matrix
}

/// The product of Euler parameters with `A(p q) = A(p) A(q)`: `p q₀ + G(p)ᵀ (q₁, q₂, q₃)`.
pub(crate) fn product<T: RealField + Copy>(p: &Vector4<T>, q: &Vector4<T>) -> Vector4<T> {
    p * q[0] + g_matrix(p).tr_mul(&q.fixed_rows::<3>(1))
}

/// p̄, the Euler parameters of the inverse rotation.
pub(crate) fn conjugate<T: RealField + Copy>(p: &Vector4<T>) -> Vector4<T> {
    Vector4::new(p[0], -p[1], -p[2], -p[3])
}
