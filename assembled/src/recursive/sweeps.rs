//! The three sweeps of the recursion: out to the leaves, in to the roots, and out again.

use crate::model::lowered::Lowered;
use crate::model::motion::Motion;
use crate::model::place::Moment;
use crate::model::scene::Body;
use crate::number::{Number, number};
use crate::recursive::limbs::{Hinge, Limb, Limbs};
use crate::recursive::screws::{End, Inertia6, Screw, Six, angular, apply, carried, dot, linear, plus, six};
use nalgebra::{Matrix3, Matrix6, Vector3, Vector4, Vector6};

/// What one evaluation needs.
#[derive(Clone, Debug)]
pub(crate) struct Space<T> {
    /// The global frame, driven bodies, constrained and fixed bodies; then the limbs.
    pub(crate) nodes: Vec<Node<T>>,
    /// What is known of each screw.
    pub(crate) turning: Vec<Free<T>>,
    /// What the model file's forces exert, body after body: `(f, n')`.
    pub(crate) forces: Vec<T>,
    /// Of each row its derivative with respect to the child's and to the parent's `(r, π')`.
    pub(crate) gradients: Vec<[Six<T>; 2]>,
}

/// One body's quantities, in global axes and about the common point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node<T> {
    /// A(p).
    a: Matrix3<T>,
    /// The mass centre, seen from the common point.
    centre: Vector3<T>,
    centre_velocity: Vector3<T>,
    velocity: Six<T>,
    /// The acceleration that the body would have at constant joint rates.
    coasting: Six<T>,
    /// Of its mass centre, the same.
    centre_coasting: Vector3<T>,
    /// The body's inertia with its descendants'.
    inertia: Inertia6<T>,
    /// The force with its descendants', less what coasting takes.
    force: Six<T>,
    /// The acceleration less [`Node::coasting`].
    rest: Six<T>,
}

/// A freedom of a joint, solved for: `q̈ = drive − load · (what the parent has beyond coasting)`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Free<T> {
    motion: Six<T>,
    drive: T,
    load: Six<T>,
}

impl<T: Number> Node<T> {
    pub(crate) fn new() -> Self {
        let (zero, none) = (Vector3::zeros(), [number(0.0); 6]);
        Self {
            a: Matrix3::zeros(),
            centre: zero,
            centre_velocity: zero,
            velocity: none,
            coasting: none,
            centre_coasting: zero,
            inertia: [none; 6],
            force: none,
            rest: none,
        }
    }

    /// A body whose motion is known.
    fn known(motion: &Motion<T>, origin: &Vector3<T>) -> Self {
        let (centre, omega, omega_dot) = (motion.r - origin, motion.omega(), motion.a * motion.w_dot);
        let at_origin = motion.s_dot - omega_dot.cross(&centre) - omega.cross(&motion.s);
        Self {
            a: motion.a,
            centre,
            centre_velocity: motion.s,
            velocity: six(&(motion.s - omega.cross(&centre)), &omega),
            coasting: six(&at_origin, &omega_dot),
            ..Self::new()
        }
    }
}

impl<T: Number> Free<T> {
    pub(crate) fn new() -> Self {
        let none = [number(0.0); 6];
        Self { motion: none, drive: number(0.0), load: none }
    }
}

/// Writes `(s̈, ẇ')` of every body to `out`.
pub(crate) fn accelerations<T: Number>(
    tree: &Limbs<T>,
    lowered: &Lowered<T>,
    at: Moment<'_, T>,
    space: &mut Space<T>,
    out: &mut [T],
) {
    let Some(first) = tree.limbs.first() else {
        out.fill(number(0.0));
        return;
    };
    let origin = lowered.scene.r(at.y, first.moving_body);
    place_roots(tree, lowered, at, &origin, &mut space.nodes);
    let has_forces = !lowered.elements.is_empty();
    if has_forces {
        space.forces.fill(number(0.0));
        lowered.add_page_force(at, &mut space.forces);
    }
    let n_roots = space.nodes.len() - tree.limbs.len();
    let (nodes, free) = (&mut space.nodes, &mut space.turning);
    for (index, limb) in tree.limbs.iter().enumerate() {
        let (before, node) = nodes.split_at_mut(n_roots + index);
        let node = &mut node[0];
        place(lowered, at, limb.moving_body, &origin, node);
        coast(tree, limb, &before[limb.parent], node, free);
        let force = has_forces.then(|| &space.forces[6 * limb.moving_body..6 * limb.moving_body + 6]);
        load(&lowered.scene.bodies[limb.moving_body], &lowered.scene.gravity, force, node);
    }
    for (index, limb) in tree.limbs.iter().enumerate().rev() {
        let (before, node) = nodes.split_at_mut(n_roots + index);
        let parent = (limb.parent >= n_roots).then(|| &mut before[limb.parent]);
        let armature = limb.hinge.as_ref().map_or(T::zero(), |hinge| lowered.armature(hinge.joint));
        fold((limb, armature), &mut node[0], parent, free);
    }
    for (moving_body, _) in &tree.held {
        out[6 * moving_body..6 * moving_body + 6].fill(number(0.0));
    }
    for (index, limb) in tree.limbs.iter().enumerate() {
        let (before, node) = nodes.split_at_mut(n_roots + index);
        release(limb, &before[limb.parent], &mut node[0], free);
        write(&node[0], &mut out[6 * limb.moving_body..6 * limb.moving_body + 6]);
    }
}

/// The global frame, driven bodies, constrained bodies at rest where the state has them, and fixed ones.
fn place_roots<T: Number>(
    tree: &Limbs<T>,
    lowered: &Lowered<T>,
    at: Moment<'_, T>,
    origin: &Vector3<T>,
    nodes: &mut [Node<T>],
) {
    let zero = Vector3::zeros();
    nodes[0].centre = -origin;
    nodes[0].a = Matrix3::identity();
    let first_held = 1 + lowered.scene.driven.len();
    for (index, node) in nodes[1..first_held].iter_mut().enumerate() {
        *node = Node::known(&lowered.scene.driven_motion(at.t, index), origin);
    }
    let first_fixed = first_held + tree.held.len();
    for (node, motion) in nodes[first_fixed..].iter_mut().zip(&tree.fixed) {
        *node = Node::known(motion, origin);
    }
    for (node, &(moving_body, _)) in nodes[first_held..].iter_mut().zip(&tree.held) {
        let pose =
            Motion::new(lowered.scene.r(at.y, moving_body), lowered.scene.p(at.y, moving_body), zero, zero);
        *node = Node::known(&pose, origin);
    }
}

/// Where a moving body is and how it moves.
#[inline]
fn place<T: Number>(
    lowered: &Lowered<T>,
    at: Moment<'_, T>,
    moving_body: usize,
    origin: &Vector3<T>,
    node: &mut Node<T>,
) {
    node.a = unit_rotation(&lowered.scene.p(at.y, moving_body));
    node.centre = lowered.scene.r(at.y, moving_body) - origin;
    node.centre_velocity = lowered.scene.s(at.y, moving_body);
    let omega = node.a * lowered.scene.w(at.y, moving_body);
    node.velocity = six(&(node.centre_velocity + node.centre.cross(&omega)), &omega);
}

/// Eq. (3) for a unit p, in its cheapest form.
#[inline]
fn unit_rotation<T: Number>(p: &Vector4<T>) -> Matrix3<T> {
    let one = T::one();
    let [e0, e1, e2, e3] = [p[0], p[1], p[2], p[3]];
    let [d1, d2, d3] = [e1 + e1, e2 + e2, e3 + e3];
    let [xx, yy, zz] = [e1 * d1, e2 * d2, e3 * d3];
    let [xy, xz, yz] = [e1 * d2, e1 * d3, e2 * d3];
    let [wx, wy, wz] = [e0 * d1, e0 * d2, e0 * d3];
    Matrix3::new(
        one - (yy + zz),
        xy - wz,
        xz + wy,
        xy + wz,
        one - (xx + zz),
        yz - wx,
        xz - wy,
        yz + wx,
        one - (xx + yy),
    )
}

/// The joint's screws, and the acceleration that the parent's and the velocities make.
///
/// What a joint's screws add to a parent's motion is carried along by the body that they are fixed in: with all of them
/// in one body the acceleration gains `v_parent × v_child`; of a joint with screws in both, the part x of the relative
/// velocity that is fixed in the first body makes `−(v_child − v_parent) × x` besides.
#[inline]
fn coast<T: Number>(
    tree: &Limbs<T>,
    limb: &Limb<T>,
    parent: &Node<T>,
    node: &mut Node<T>,
    free: &mut [Free<T>],
) {
    let Some(hinge) = &limb.hinge else {
        // The mass centre keeps its velocity, and the body its ω.
        node.coasting = six(&node.centre_velocity.cross(&angular(&node.velocity)), &Vector3::zeros());
        return;
    };
    let (first, second) = match hinge.child {
        End::First => (&*node, parent),
        End::Second => (parent, &*node),
    };
    let point = second.centre + second.a * hinge.point;
    for (free, screw) in free[hinge.screws.clone()].iter_mut().zip(&tree.screws[hinge.screws.clone()]) {
        let a = if screw.of == End::First { &first.a } else { &second.a };
        free.motion = screw.motion(&(a * screw.axis), &point);
    }
    let mut gained = carried(&parent.velocity, &node.velocity);
    if hinge.is_mixed {
        let relative = plus(&second.velocity, number(-1.0), &first.velocity);
        let of_first = first_part(tree, hinge, &relative, &point, free);
        let between = plus(&node.velocity, number(-1.0), &parent.velocity);
        gained = plus(&gained, number(-1.0), &carried(&between, &of_first));
    }
    node.coasting = plus(&parent.coasting, number(1.0), &gained);
}

/// The part of a relative velocity that is due to the screw fixed in the first body, which comes first and is
/// orthogonal to those of its kind.
fn first_part<T: Number>(
    tree: &Limbs<T>,
    hinge: &Hinge<T>,
    relative: &Six<T>,
    point: &Vector3<T>,
    free: &[Free<T>],
) -> Six<T> {
    let Screw { turn, .. } = tree.screws[hinge.screws.start];
    let motion = &free[hinge.screws.start].motion;
    let rate = if turn > number(0.0) {
        angular(motion).dot(&angular(relative))
    } else {
        linear(motion).dot(&(linear(relative) + angular(relative).cross(point)))
    };
    motion.map(|x| x * rate)
}

/// Inertia, and the force that is left beyond coasting.
#[inline]
fn load<T: Number>(body: &Body<T>, gravity: &Vector3<T>, page_force: Option<&[T]>, node: &mut Node<T>) {
    let (omega, omega_dot) = (angular(&node.velocity), angular(&node.coasting));
    let turning = node.a * body.inertia * node.a.transpose();
    node.centre_coasting =
        linear(&node.coasting) + omega_dot.cross(&node.centre) + omega.cross(&node.centre_velocity);
    let mut force = (gravity - node.centre_coasting) * body.mass;
    let mut torque = (turning * omega).cross(&omega) - turning * omega_dot;
    if let Some(&[fx, fy, fz, nx, ny, nz]) = page_force.and_then(|force| force.first_chunk::<6>()) {
        force += Vector3::new(fx, fy, fz);
        torque += node.a * Vector3::new(nx, ny, nz);
    }
    node.force = six(&force, &(torque + node.centre.cross(&force)));
    node.inertia = inertia(body.mass, &node.centre, &turning);
}

/// `[m I, −m c̃; m c̃, J + m (c·c I − c cᵀ)]`.
#[inline]
fn inertia<T: Number>(mass: T, c: &Vector3<T>, turning: &Matrix3<T>) -> Inertia6<T> {
    let (o, h) = (number(0.0), c * mass);
    let [xx, yy, zz] = [h.x * c.x, h.y * c.y, h.z * c.z];
    let (xy, xz, yz) =
        (turning[(0, 1)] - h.x * c.y, turning[(0, 2)] - h.x * c.z, turning[(1, 2)] - h.y * c.z);
    [
        [mass, o, o, o, h.z, -h.y],
        [o, mass, o, -h.z, o, h.x],
        [o, o, mass, h.y, -h.x, o],
        [o, -h.z, h.y, turning[(0, 0)] + yy + zz, xy, xz],
        [h.z, o, -h.x, xy, turning[(1, 1)] + xx + zz, yz],
        [-h.y, h.x, o, xz, yz, turning[(2, 2)] + xx + yy],
    ]
}

/// Eliminates a joint's accelerations, the child's side first, and loads the parent, if that moves, with the rest.
#[inline]
fn fold<T: Number>(
    (limb, armature): (&Limb<T>, T),
    node: &mut Node<T>,
    parent: Option<&mut Node<T>>,
    free: &mut [Free<T>],
) {
    let Some(hinge) = &limb.hinge else { return };
    let mut free = free[hinge.screws.clone()].iter_mut().rev().peekable();
    let one = T::one();
    while let Some(screw) = free.next() {
        let thrust = apply(&node.inertia, &screw.motion);
        let reciprocal = one / (dot(&screw.motion, &thrust) + armature);
        screw.drive = dot(&screw.motion, &node.force) * reciprocal;
        screw.load = thrust.map(|x| x * reciprocal);
        if free.peek().is_some() {
            node.inertia = std::array::from_fn(|k| plus(&node.inertia[k], -screw.load[k], &thrust));
            node.force = plus(&node.force, -screw.drive, &thrust);
        } else if let Some(parent) = parent {
            for (k, column) in parent.inertia.iter_mut().enumerate() {
                *column = plus(&plus(column, one, &node.inertia[k]), -screw.load[k], &thrust);
            }
            parent.force = plus(&plus(&parent.force, one, &node.force), -screw.drive, &thrust);
            return;
        } else {
            return;
        }
    }
    // A fixed joint: all of the child.
    if let Some(parent) = parent {
        parent.inertia = std::array::from_fn(|k| plus(&parent.inertia[k], one, &node.inertia[k]));
        parent.force = plus(&parent.force, one, &node.force);
    }
}

/// The acceleration beyond coasting, from the parent's.
#[inline]
fn release<T: Number>(limb: &Limb<T>, parent: &Node<T>, node: &mut Node<T>, free: &[Free<T>]) {
    let Some(hinge) = &limb.hinge else {
        node.rest = solve(&node.inertia, &node.force);
        return;
    };
    let drive = |rest: Six<T>, free: &Free<T>| plus(&rest, free.drive - dot(&free.load, &rest), &free.motion);
    node.rest = free[hinge.screws.clone()].iter().fold(parent.rest, drive);
}

/// Of a free body; not finite where the inertia is not positive definite.
fn solve<T: Number>(inertia: &Inertia6<T>, force: &Six<T>) -> Six<T> {
    match Matrix6::from(*inertia).cholesky() {
        Some(factor) => factor.solve(&Vector6::from(*force)).into(),
        None => [T::zero() / T::zero(); 6],
    }
}

#[inline]
fn write<T: Number>(node: &Node<T>, out: &mut [T]) {
    let turn = angular(&node.rest);
    let centre = node.centre_coasting + linear(&node.rest) + turn.cross(&node.centre);
    let turn = node.a.tr_mul(&(angular(&node.coasting) + turn));
    out[..3].copy_from_slice(centre.as_slice());
    out[3..].copy_from_slice(turn.as_slice());
}
