//! Accelerations from the leaves to the root and back, without λ.

use crate::careful::{Hinge, Hold, Link, Side};
use crate::lowered::{Joint, Lowered, Place};
use crate::number::{Number, number};
use crate::spatial::{Inertia, Spatial, inverse};
use crate::textbook::rotation;
use gyro_model::JointKind;
use nalgebra::{Matrix3, Vector3};

/// One body's quantities, all in global axes and about its mass centre.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node<T> {
    /// A(p).
    pub(crate) a: Matrix3<T>,
    /// ω = A w'.
    omega: Vector3<T>,
    /// `(f, A(n' − w̃'J'w'))`.
    pub(crate) applied: Spatial<T>,
    /// The body's inertia with its descendants'.
    inertia: Inertia<T>,
    /// The force with its descendants'.
    force: Spatial<T>,
    /// How the body follows its parent.
    follower: Follower<T>,
    pub(crate) acceleration: Spatial<T>,
}

/// The acceleration of a child once its parent's is known.
#[derive(Clone, Copy, Debug)]
struct Follower<T> {
    /// From the parent's mass centre to the joint's point on the parent.
    parent_arm: Vector3<T>,
    /// From the child's mass centre to the joint's point on the child.
    child_arm: Vector3<T>,
    /// What γ adds to the acceleration that the child would have as part of its parent.
    bias: Spatial<T>,
    freedom: Freedom<T>,
}

/// The rotation that the joint leaves free, solved for.
#[derive(Clone, Copy, Debug)]
enum Freedom<T> {
    /// None.
    None,
    /// About an axis: `θ̈ = torque − load · (acceleration of the parent at the joint)`.
    Axis { axis: Vector3<T>, torque: T, load: Spatial<T> },
    /// All: `ω̇ = spin − gain (acceleration of the parent at the joint)`.
    All { spin: Vector3<T>, gain: Matrix3<T> },
}

impl<T: Number> Node<T> {
    pub(crate) fn new() -> Self {
        let zero = Vector3::zeros();
        Self {
            a: Matrix3::zeros(),
            omega: zero,
            applied: Spatial::zero(),
            inertia: Inertia::zero(),
            force: Spatial::zero(),
            follower: Follower {
                parent_arm: zero,
                child_arm: zero,
                bias: Spatial::zero(),
                freedom: Freedom::None,
            },
            acceleration: Spatial::zero(),
        }
    }
}

/// Writes `(s̈, ẇ')` of every body to `out`, and leaves what [`crate::reactions`] needs in the nodes.
pub(crate) fn accelerations<T: Number>(
    lowered: &Lowered<T>,
    links: &[Link],
    y: &[T],
    nodes: &mut [Node<T>],
    out: &mut [T],
) {
    lowered.applied_force(y, out);
    for (slot, (node, force)) in nodes.iter_mut().zip(out.as_chunks::<6>().0).enumerate() {
        place(lowered, y, slot, force, node);
    }
    for link in links.iter().rev() {
        if let Hold::Joint(hinge) = &link.hold {
            fold(&lowered.joints[hinge.joint], hinge, link.slot, nodes);
        }
    }
    for link in links {
        nodes[link.slot].acceleration = acceleration(lowered, y, link, nodes);
    }
    for (node, out) in nodes.iter().zip(out.as_chunks_mut::<6>().0) {
        out[..3].copy_from_slice(node.acceleration.linear.as_slice());
        out[3..].copy_from_slice(node.a.tr_mul(&node.acceleration.angular).as_slice());
    }
}

/// A body by itself.
fn place<T: Number>(lowered: &Lowered<T>, y: &[T], slot: usize, force: &[T; 6], node: &mut Node<T>) {
    let body = &lowered.bodies[slot];
    let a = rotation(&lowered.p(y, slot));
    let [fx, fy, fz, nx, ny, nz] = *force;
    node.a = a;
    node.omega = a * lowered.w(y, slot);
    node.applied = Spatial { linear: Vector3::new(fx, fy, fz), angular: a * Vector3::new(nx, ny, nz) };
    node.force = node.applied;
    node.inertia = Inertia {
        linear: Matrix3::from_diagonal_element(body.mass),
        coupling: Matrix3::zeros(),
        angular: a * body.inertia * a.transpose(),
    };
}

/// Folds a child into its parent: `θ̈` is eliminated, and the rest loads the parent.
fn fold<T: Number>(joint: &Joint<T>, hinge: &Hinge, child: usize, nodes: &mut [Node<T>]) {
    let (parent_end, child_end) = hinge.ends(joint);
    let (parent_a, parent_omega) = orientation(&parent_end.place, nodes);
    let node = &nodes[child];
    let (parent_arm, child_arm) = (parent_a * parent_end.point, node.a * child_end.point);
    let bias = Spatial {
        linear: centripetal(&parent_omega, &parent_arm) - centripetal(&node.omega, &child_arm),
        angular: rotation_bias(joint, hinge, nodes),
    };
    let mut inertia = node.inertia.about(&child_arm);
    let mut force = node.force.about(&child_arm);
    force -= inertia.apply(&bias);
    let freedom = match joint.kind {
        JointKind::Fixed => Freedom::None,
        JointKind::Spherical => eliminate_rotation(&mut inertia, &mut force),
        JointKind::Revolute => eliminate_axis(axis(joint, nodes), &mut inertia, &mut force),
    };
    nodes[child].follower = Follower { parent_arm, child_arm, bias, freedom };
    if let Some(parent) = hinge.loads {
        nodes[parent].inertia += inertia.about(&-parent_arm);
        nodes[parent].force += force.about(&-parent_arm);
    }
}

fn acceleration<T: Number>(lowered: &Lowered<T>, y: &[T], link: &Link, nodes: &[Node<T>]) -> Spatial<T> {
    let node = &nodes[link.slot];
    match &link.hold {
        Hold::Free => node.inertia.solve(&node.force),
        Hold::Constrained(index) => {
            let body = &lowered.constrained[*index];
            let (q0, q) = lowered.relative_orientation(y, body);
            // ½ (q₀ I + q̃) ẇ' = ¼ |w'|² q is solved by a multiple of q.
            let angular = node.a * q * (node.omega.norm_squared() * number(0.5) / q0);
            Spatial { linear: Vector3::zeros(), angular }
        }
        Hold::Joint(hinge) => {
            let (parent_end, _) = hinge.ends(&lowered.joints[hinge.joint]);
            let parent = parent_end.place.slot().map_or_else(Spatial::zero, |slot| nodes[slot].acceleration);
            node.follower.acceleration(&parent)
        }
    }
}

impl<T: Number> Follower<T> {
    /// The child's acceleration.
    fn acceleration(&self, parent: &Spatial<T>) -> Spatial<T> {
        let carried = Spatial {
            linear: parent.linear + parent.angular.cross(&self.parent_arm),
            angular: parent.angular,
        };
        let linear = carried.linear + self.bias.linear;
        let angular = match &self.freedom {
            Freedom::None => carried.angular + self.bias.angular,
            Freedom::Axis { axis, torque, load } => {
                let carried_load = load.linear.dot(&carried.linear) + load.angular.dot(&carried.angular);
                carried.angular + self.bias.angular + axis * (*torque - carried_load)
            }
            Freedom::All { spin, gain } => spin - gain * carried.linear,
        };
        Spatial { linear: linear - angular.cross(&self.child_arm), angular }
    }
}

/// `[inertia](a + axis θ̈) = force` along the axis, which has no linear part.
fn eliminate_axis<T: Number>(
    axis: Vector3<T>,
    inertia: &mut Inertia<T>,
    force: &mut Spatial<T>,
) -> Freedom<T> {
    let u = Spatial { linear: inertia.coupling * axis, angular: inertia.angular * axis };
    let reciprocal = T::one() / axis.dot(&u.angular);
    let load = Spatial { linear: u.linear * reciprocal, angular: u.angular * reciprocal };
    let torque = axis.dot(&force.angular) * reciprocal;
    inertia.linear -= u.linear * load.linear.transpose();
    inertia.coupling -= u.linear * load.angular.transpose();
    inertia.angular -= u.angular * load.angular.transpose();
    *force -= Spatial { linear: u.linear * torque, angular: u.angular * torque };
    Freedom::Axis { axis, torque, load }
}

/// The same for all three rotations: only a mass and a force at the joint's point remain.
fn eliminate_rotation<T: Number>(inertia: &mut Inertia<T>, force: &mut Spatial<T>) -> Freedom<T> {
    let inverse = inverse(&inertia.angular);
    let (spin, gain) = (inverse * force.angular, inverse * inertia.coupling.transpose());
    inertia.linear -= inertia.coupling * gain;
    force.linear -= inertia.coupling * spin;
    inertia.coupling = Matrix3::zeros();
    inertia.angular = Matrix3::zeros();
    force.angular = Vector3::zeros();
    Freedom::All { spin, gain }
}

/// A and ω of a joint's body.
fn orientation<T: Number>(place: &Place<T>, nodes: &[Node<T>]) -> (Matrix3<T>, Vector3<T>) {
    match place {
        Place::Slot(slot) => (nodes[*slot].a, nodes[*slot].omega),
        Place::Ground(motion) => (motion.a, Vector3::zeros()),
    }
}

/// The free axis of a revolute joint, which both of its dot-1 rows have in their null space: the second body's.
fn axis<T: Number>(joint: &Joint<T>, nodes: &[Node<T>]) -> Vector3<T> {
    orientation(&joint.second.place, nodes).0 * joint.second.h
}

/// The part of the child's ω̇ relative to its parent that the dot-1 rows determine; zero along a revolute's axis.
fn rotation_bias<T: Number>(joint: &Joint<T>, hinge: &Hinge, nodes: &[Node<T>]) -> Vector3<T> {
    let (i_a, i_omega) = orientation(&joint.first.place, nodes);
    let (j_a, j_omega) = orientation(&joint.second.place, nodes);
    let dual = dual_directions(joint, &i_a, &j_a);
    let mut bias = Vector3::zeros();
    for (dot, dual) in joint.dots.iter().zip(&dual) {
        let (a, b) = (i_a * dot.a, j_a * dot.b);
        let turning = j_omega.cross(&b).cross(&a) + b.cross(&i_omega.cross(&a));
        bias -= dual * (j_omega - i_omega).dot(&turning);
    }
    match hinge.child {
        Side::First => -bias,
        Side::Second => bias,
    }
}

/// A dot-1 row is `(b × a)ᵀ (ω_j − ω_i)` in global axes. These are the vectors dual to those of a joint's rows, where a
/// revolute's axis stands for the third row: the k-th is orthogonal to all rows but the k-th, and one along that.
pub(crate) fn dual_directions<T: Number>(
    joint: &Joint<T>,
    i_a: &Matrix3<T>,
    j_a: &Matrix3<T>,
) -> [Vector3<T>; 3] {
    let direction = |k: usize| (j_a * joint.dots[k].b).cross(&(i_a * joint.dots[k].a));
    let (u, v, w) = match joint.kind {
        JointKind::Spherical => return [Vector3::zeros(); 3],
        JointKind::Revolute => (direction(0), direction(1), j_a * joint.second.h),
        JointKind::Fixed => (direction(0), direction(1), direction(2)),
    };
    let (vw, wu, uv) = (v.cross(&w), w.cross(&u), u.cross(&v));
    let reciprocal = T::one() / u.dot(&vw);
    [vw * reciprocal, wu * reciprocal, uv * reciprocal]
}

/// `ω × (ω × d)`.
fn centripetal<T: Number>(omega: &Vector3<T>, d: &Vector3<T>) -> Vector3<T> {
    omega.cross(&omega.cross(d))
}
