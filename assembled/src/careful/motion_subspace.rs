//! What a joint leaves free and what it determines of a child's rotation; all in the global frame.

use crate::careful::hinges::Bearing;
use crate::careful::spatial::{Inertia, Spatial, inverse};
use crate::model::joint::Joint;
use crate::number::Number;
use nalgebra::{Matrix3, Vector3};

/// How a body is turned and turns.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Attitude<T> {
    /// A(p).
    pub(crate) a: Matrix3<T>,
    /// ω = A w'.
    pub(crate) omega: Vector3<T>,
}

/// The rotation that a joint leaves free, solved for.
#[derive(Clone, Copy, Debug)]
pub(crate) enum MotionSubspace<T> {
    /// None.
    None,
    /// About an axis: `θ̈ = drive − load · (acceleration of the parent at the joint)`, where θ̈'s own inertia is `own`.
    Axis { axis: Vector3<T>, own: T, drive: T, load: Spatial<T> },
    /// All: `ω̇ = spin − gain (acceleration of the parent at the joint)`.
    All { spin: Vector3<T>, gain: Matrix3<T> },
}

impl<T: Number> Attitude<T> {
    /// `ω × (ω × d)`.
    pub(crate) fn centripetal(&self, d: &Vector3<T>) -> Vector3<T> {
        self.omega.cross(&self.omega.cross(d))
    }
}

impl<T: Number> MotionSubspace<T> {
    /// Solves `inertia (a + axis θ̈) = force` along the axis, which has no linear part, an armature taking its share of
    /// θ̈ and `held` of the force.
    pub(crate) fn about(
        axis: Vector3<T>,
        (inertia, armature): (&Inertia<T>, T),
        (force, held): (&Spatial<T>, T),
    ) -> Self {
        let (linear, angular) = (inertia.coupling * axis, inertia.angular * axis);
        let own = axis.dot(&angular) + armature;
        let reciprocal = T::one() / own;
        let load = Spatial { linear: linear * reciprocal, angular: angular * reciprocal };
        Self::Axis { axis, own, drive: (axis.dot(&force.angular) - held) * reciprocal, load }
    }

    /// The same for all three rotations.
    pub(crate) fn all(inertia: &Inertia<T>, force: &Spatial<T>) -> Self {
        let inverse = inverse(&inertia.angular);
        Self::All { spin: inverse * force.angular, gain: inverse * inertia.coupling.transpose() }
    }

    /// Leaves what the parent must carry.
    pub(crate) fn eliminate(&self, inertia: &mut Inertia<T>, force: &mut Spatial<T>) {
        match self {
            Self::None => {}
            Self::Axis { own, drive, load, .. } => {
                let (linear, angular) = (load.linear * *own, load.angular * *own);
                inertia.linear -= linear * load.linear.transpose();
                inertia.coupling -= linear * load.angular.transpose();
                inertia.angular -= angular * load.angular.transpose();
                *force -= Spatial { linear: linear * *drive, angular: angular * *drive };
            }
            Self::All { spin, gain } => {
                force.linear -= inertia.coupling * spin;
                force.angular = Vector3::zeros();
                inertia.linear -= inertia.coupling * gain;
                inertia.coupling = Matrix3::zeros();
                inertia.angular = Matrix3::zeros();
            }
        }
    }

    /// The child's ω̇ from the acceleration that it would have as part of its parent, at the joint.
    pub(crate) fn angular(&self, carried: &Spatial<T>, bias: &Spatial<T>) -> Vector3<T> {
        match self {
            Self::None => carried.angular + bias.angular,
            Self::Axis { axis, drive, load, .. } => {
                let carried_load = load.linear.dot(&carried.linear) + load.angular.dot(&carried.angular);
                carried.angular + bias.angular + axis * (*drive - carried_load)
            }
            Self::All { spin, gain } => spin - gain * carried.linear,
        }
    }
}

/// What the dot-1 rows determine of `ω̇_j − ω̇_i`; along a revolute's axis, where they determine nothing, anything.
///
/// Seen from the first body, a row `a·b = 0` with a fixed there asks `a·(α × b + Ω × (Ω × b)) = 0` of the relative
/// acceleration α, where Ω = ω_j − ω_i, and `ω̇_j − ω̇_i = ω_i × Ω + α`. A revolute has a = f_i, g_i and b = h_j; as
/// f_i, g_i and h_i are orthonormal, with `k = Ω × (Ω × h_j)` both rows hold for `α = k × h_i / (h_i·h_j)`.
pub(crate) fn rotation_bias<T: Number>(
    (bearing, joint): (Bearing, &Joint<T>),
    i: &Attitude<T>,
    j: &Attitude<T>,
) -> Vector3<T> {
    let relative = Attitude { a: j.a, omega: j.omega - i.omega };
    let transport = i.omega.cross(&relative.omega);
    match bearing {
        Bearing::Spherical => Vector3::zeros(),
        Bearing::Revolute => {
            let (h_i, h_j) = (i.a * joint.first.h, j.a * joint.second.h);
            transport + relative.centripetal(&h_j).cross(&h_i) / h_i.dot(&h_j)
        }
        Bearing::Fixed => {
            let dual = dual_directions((bearing, joint), &i.a, &j.a);
            joint.dots.iter().zip(&dual).fold(transport, |bias, (dot, dual)| {
                bias - dual * (i.a * dot.a).dot(&relative.centripetal(&(j.a * dot.b)))
            })
        }
    }
}

/// A dot-1 row is `(b × a)ᵀ (ω_j − ω_i)` in global axes. These are the vectors dual to those of a joint's rows, where a
/// revolute's axis stands for the third row: the k-th is orthogonal to all rows but the k-th, and one along that.
pub(crate) fn dual_directions<T: Number>(
    (bearing, joint): (Bearing, &Joint<T>),
    i_a: &Matrix3<T>,
    j_a: &Matrix3<T>,
) -> [Vector3<T>; 3] {
    let direction = |k: usize| (j_a * joint.dots[k].b).cross(&(i_a * joint.dots[k].a));
    let (u, v, w) = match bearing {
        Bearing::Spherical => return [Vector3::zeros(); 3],
        Bearing::Revolute => (direction(0), direction(1), j_a * joint.second.h),
        Bearing::Fixed => (direction(0), direction(1), direction(2)),
    };
    let (vw, wu, uv) = (v.cross(&w), w.cross(&u), u.cross(&v));
    let reciprocal = T::one() / u.dot(&vw);
    [vw * reciprocal, wu * reciprocal, uv * reciprocal]
}
