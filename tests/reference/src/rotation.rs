//! Rotation matrices and inertia tensors in double-double arithmetic.

use crate::DoubleDouble;
use crate::vector::{Vector, add, cross, dot, scale};

/// Three numbers of 31 digits.
pub(crate) type Precise = Vector<DoubleDouble>;

/// The zero vector.
pub(crate) const ORIGIN: Precise = [DoubleDouble::ZERO; 3];

/// A rotation matrix by its columns: the turned axes in the frame they were turned from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rotation(pub(crate) [Precise; 3]);

impl Rotation {
    /// No rotation.
    pub(crate) const IDENTITY: Rotation = {
        let (o, i) = (DoubleDouble::ZERO, DoubleDouble::new(1.0));
        Rotation([[i, o, o], [o, i, o], [o, o, i]])
    };

    /// By `angle` about the unit vector `axis`: Rodrigues' formula, v cos + a×v sin + a (a·v)(1 − cos).
    pub(crate) fn about(axis: Precise, angle: DoubleDouble) -> Self {
        let (sin, cos) = angle.sin_cos();
        let rest = DoubleDouble::new(1.0) - cos;
        Rotation(Rotation::IDENTITY.0.map(|v| {
            let along = scale(rest * dot(axis, v), axis);
            add(scale(cos, v), add(scale(sin, cross(axis, v)), along))
        }))
    }

    /// By Euler parameters (e0, e1, e2, e3) of unit length: 2 (e·v) e + (e0² − e·e) v + 2 e0 e×v.
    pub(crate) fn from_euler_parameters(p: [DoubleDouble; 4]) -> Self {
        let e = [p[1], p[2], p[3]];
        let share = p[0] * p[0] - dot(e, e);
        Rotation(Rotation::IDENTITY.0.map(|v| {
            let along = scale(dot(e, v).times(2.0), e);
            add(along, add(scale(share, v), scale(p[0].times(2.0), cross(e, v))))
        }))
    }

    /// A v.
    pub(crate) fn times(&self, v: Precise) -> Precise {
        let [x, y, z] = self.0;
        add(scale(v[0], x), add(scale(v[1], y), scale(v[2], z)))
    }

    /// Aᵀ v.
    pub(crate) fn transposed_times(&self, v: Precise) -> Precise {
        self.0.map(|column| dot(column, v))
    }

    /// A B: `other` seen from the frame that `self` turns.
    pub(crate) fn then(&self, other: &Rotation) -> Rotation {
        Rotation(other.0.map(|column| self.times(column)))
    }

    /// The matrix by rows, rounded.
    pub(crate) fn rounded(&self) -> [[f64; 3]; 3] {
        core::array::from_fn(|row| self.0.map(|column| column[row].to_f64()))
    }
}

/// A symmetric tensor `[xx, yy, zz, xy, xz, yz]` times a vector.
pub(crate) fn tensor_times(j: [DoubleDouble; 6], v: Precise) -> Precise {
    let [xx, yy, zz, xy, xz, yz] = j;
    [dot([xx, xy, xz], v), dot([xy, yy, yz], v), dot([xz, yz, zz], v)]
}

/// The tensor about a point at `offset` from the mass centre (or the other way round): Steiner's theorem.
pub(crate) fn moved_tensor(j: [DoubleDouble; 6], mass: DoubleDouble, offset: Precise) -> [DoubleDouble; 6] {
    let [x, y, z] = offset;
    let shares = [y * y + z * z, x * x + z * z, x * x + y * y, -(x * y), -(x * z), -(y * z)];
    core::array::from_fn(|k| j[k] + mass * shares[k])
}

/// ṗ = ½ Gᵀ w' of Euler parameters for the angular velocity w' in the body's frame, that is ½ p ∘ (0, w').
pub(crate) fn euler_parameter_rates(p: [DoubleDouble; 4], w: Precise) -> [DoubleDouble; 4] {
    let e = [p[1], p[2], p[3]];
    let vector = add(scale(p[0], w), cross(e, w));
    [-dot(e, w), vector[0], vector[1], vector[2]].map(|x| x.times(0.5))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trajectory::decimals;
    use crate::vector::sub;

    fn error(a: Precise, b: Precise) -> f64 {
        sub(a, b).iter().map(|x| x.to_f64().abs()).fold(0.0, f64::max)
    }

    #[test]
    fn euler_parameters_and_rodrigues_agree_and_undo_themselves() {
        // (1, 2, 2)/3 by 2 atan2(0.6, 0.8): Euler parameters 0.8 and 0.6 (1, 2, 2)/3.
        let axis = decimals([1.0, 2.0, 2.0]).map(|x| x.divided_by(3.0));
        let angle = decimals([0.6])[0].atan2(decimals([0.8])[0]).times(2.0);
        let by_angle = Rotation::about(axis, angle);
        let by_parameters = Rotation::from_euler_parameters(decimals([0.8, 0.2, 0.4, 0.4]));
        let v = decimals([0.3, -1.7, 2.2]);
        assert!(error(by_angle.times(v), by_parameters.times(v)) < 1e-29);
        assert!(error(by_angle.transposed_times(by_angle.times(v)), v) < 1e-29);
        let opposite = Rotation::about(axis, -angle);
        assert!(error(by_angle.then(&opposite).times(v), v) < 1e-29);
    }

    #[test]
    fn a_quarter_turn_is_right_handed() {
        let quarter = DoubleDouble::new(1.0).atan2(DoubleDouble::ZERO);
        let z = Rotation::IDENTITY.0[2];
        assert!(
            error(Rotation::about(z, quarter).times(Rotation::IDENTITY.0[0]), Rotation::IDENTITY.0[1])
                < 1e-30
        );
    }

    #[test]
    fn a_moved_tensor_is_that_of_the_point_mass() {
        // m (|c|² w − c (c·w)) for J = 0.
        let (c, w, mass) = (decimals([0.3, -0.2, 0.7]), decimals([1.0, 5.0, -2.0]), DoubleDouble::new(2.0));
        let tensor = moved_tensor([DoubleDouble::ZERO; 6], mass, c);
        let expected = scale(mass, sub(scale(dot(c, c), w), scale(dot(c, w), c)));
        assert!(error(tensor_times(tensor, w), expected) < 1e-30);
    }

    #[test]
    fn euler_parameters_turn_at_the_angular_velocity() {
        // d(A v)/dt = A (w × v), by central differences.
        const STEP: f64 = 1e-9;
        let (p, w, v) =
            (decimals([0.8, 0.2, 0.4, 0.4]), decimals([0.5, -2.0, 3.0]), decimals([1.0, -0.3, 0.2]));
        let rates = euler_parameter_rates(p, w);
        let at = |sign: f64| {
            let moved: [DoubleDouble; 4] = core::array::from_fn(|k| p[k] + rates[k].times(sign * STEP));
            Rotation::from_euler_parameters(moved).times(v)
        };
        let slope = sub(at(1.0), at(-1.0)).map(|x| x.divided_by(2.0 * STEP));
        let expected = Rotation::from_euler_parameters(p).times(cross(w, v));
        assert!(error(slope, expected) < 1e-15);
    }
}
