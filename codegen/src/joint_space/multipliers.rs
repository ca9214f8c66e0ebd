//! λ at a state that satisfies the constraints: the balance of forces of `multipliers`, with what each row forces upon
//! its body in polynomial normal form. There the gradients of a joint's rows are perpendicular unit vectors, and
//! divisions vanish.

use super::coordinates::Coordinates;
use super::determined::place_of;
use super::layout::LinkCoordinates;
use super::link_kinematics::LinkKinematics;
use super::relation::{Relation, linear};
use crate::derive::Textbook;
use crate::derive::kinematics::Kinematics;
use crate::derive::system::System;
use crate::expr::definitions::Values;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::spatial_vector::SpatialVector;
use crate::expr::symbol::Symbol;
use crate::expr::vector::{Vec3, transposed};
use crate::simplify::normal_form::normal_form;
use crate::solve::articulated_body::Arm;
use crate::solve::loop_closure::gradient;
use crate::solve::motion_subspace::{MotionSubspace, Parent};
use crate::solve::multipliers::imbalance;
use gyro_model::Attachment;
use std::array::from_fn;

/// The multiplier of each row, in terms of [`Symbol::Acceleration`], the maximal state and joint coordinates.
pub fn of(
    system: &mut System,
    Textbook { kinematics, dynamics }: &Textbook,
    coordinates: &Coordinates,
) -> Vec<ExprId> {
    let n_bodies = system.moving_bodies.len();
    let lacking: Vec<_> = (0..n_bodies).map(|moving_body| imbalance(system, dynamics, moving_body)).collect();
    let mut lambda = vec![Graph::ZERO; kinematics.phi.len()];
    let joints: Vec<_> = (coordinates.layout.links.iter().zip(&coordinates.links))
        .map(|(link, link_kinematics)| Held::of(system, kinematics, link, link_kinematics))
        .collect();
    let left = left_over(&mut system.graph, coordinates, &joints, lacking.clone());
    beside_joints(system, coordinates, left, &mut lambda);
    // What couplers and drivers supply is at right angles to what each row forces upon its body.
    let mut lacking = lacking;
    for row in coordinates.closure.rows.iter().chain(&coordinates.closure.holding) {
        for (lacking, taken) in lacking.iter_mut().zip(gradient(kinematics, *row)) {
            let taken = taken.scaled(&mut system.graph, lambda[*row]);
            *lacking = lacking.plus(&mut system.graph, &taken);
        }
    }
    for joint in joints.iter().rev() {
        let forced = on_manifold(system, &joint.subspace.forced, joint, &coordinates.unit);
        let graph = &mut system.graph;
        let at_joint = joint.pass_on(graph, &mut lacking);
        let turned = graph.mat_vec(&joint.link_kinematics.rotation, &at_joint.rho);
        for (row, forced) in joint.subspace.rows.clone().zip(forced) {
            let (force, torque) =
                (graph.dot(&forced.t, &at_joint.t), forced.rotation.dot(graph, &at_joint.rho, &turned));
            // M v̇ + Φᵀλ = f.
            let supplied = graph.add(force, torque);
            lambda[row] = graph.neg(supplied);
        }
    }
    lambda
}

/// A body as its joint holds it.
struct Held<'a> {
    subspace: MotionSubspace,
    link_kinematics: &'a LinkKinematics,
    /// Rotations by joint coordinates.
    rotations: Values,
}

impl<'a> Held<'a> {
    fn of(
        system: &mut System,
        kinematics: &Kinematics,
        link: &LinkCoordinates,
        link_kinematics: &'a LinkKinematics,
    ) -> Self {
        let subspace = MotionSubspace::of(system, kinematics, link.link);
        let rotations = rotations(system, link.link.attachment, link_kinematics);
        let subspace = MotionSubspace {
            point: link_kinematics.on_body,
            parent: subspace.parent.map(|parent| Parent {
                point: link_kinematics.on_parent,
                relative: link_kinematics.rotation,
                ..parent
            }),
            ..subspace
        };
        Self { subspace, link_kinematics, rotations }
    }

    /// What the body lacks at the joint point, carried on to its parent.
    fn pass_on(&self, graph: &mut Graph, lacking: &mut [SpatialVector]) -> SpatialVector {
        let at_joint = Arm::on_body(graph, &self.subspace).wrench(graph, &lacking[self.subspace.moving_body]);
        if let Some(parent) = self.subspace.parent {
            let carried = parent.wrench(graph, &at_joint);
            lacking[parent.moving_body] = lacking[parent.moving_body].plus(graph, &carried);
        }
        at_joint
    }
}

/// The force that is left over along each rate of the tree.
fn left_over(
    graph: &mut Graph,
    coordinates: &Coordinates,
    joints: &[Held<'_>],
    mut lacking: Vec<SpatialVector>,
) -> Vec<ExprId> {
    let mut left = vec![Graph::ZERO; coordinates.layout.n_tree_rates()];
    for joint in joints.iter().rev() {
        let at_joint = joint.pass_on(graph, &mut lacking);
        for free in &joint.link_kinematics.free {
            let t = graph.mat_vec(&joint.subspace.frame, &free.twist.t);
            let taken = SpatialVector { t, rho: free.twist.rho }.dot(graph, &at_joint);
            left[free.rate] = graph.neg(taken);
        }
    }
    left
}

/// The multipliers of the rows that no joint of the tree owns, from the force that is left over along each rate of the
/// tree: `left = Φ_xᵀ λ`.
fn beside_joints(
    system: &mut System,
    coordinates: &Coordinates,
    mut left: Vec<ExprId>,
    lambda: &mut [ExprId],
) {
    let Coordinates { layout, closure, loops, .. } = coordinates;
    let n_closing = closure.rows.len();
    let on_state = coordinates.by_rates.projected(&mut system.graph, &left);
    let closing = loops.multipliers(&mut system.graph, closure, &on_state);
    take(&mut system.graph, &mut left[layout.n_rates..], &closure.by_determined[..n_closing], &closing);
    closure.rows.iter().zip(&closing).for_each(|(&row, &multiplier)| lambda[row] = multiplier);
    // A row that holds a coordinate changes with no other that is held.
    let is_held = |place: &usize| matches!(layout.determined[*place].by, Relation::Held(_));
    let held = (0..layout.determined.len()).filter(is_held);
    for ((place, by), &row) in held.zip(&closure.by_determined[n_closing..]).zip(&closure.holding) {
        lambda[row] = system.graph.div(left[layout.n_rates + place], by[place]);
        take(&mut system.graph, &mut left[layout.n_rates..], std::slice::from_ref(by), &[lambda[row]]);
    }
    // What a coordinate determines comes after it.
    for known in layout.determined.iter().rev() {
        let Some(owner) = known.by.owner() else { continue };
        let place = place_of(layout, known.coordinate).u;
        let ratio = match known.by {
            Relation::Forward(coupler) | Relation::Backward(coupler) => {
                system.number(linear(system.model, coupler).1)
            }
            Relation::Driver(_) | Relation::Held(_) => Graph::ZERO,
        };
        let graph = &mut system.graph;
        // A coupler's row is `second − ratio · first − offset`.
        let (multiplier, on_source) = if matches!(known.by, Relation::Backward(_)) {
            let quotient = graph.div(left[place], ratio);
            let multiplier = graph.neg(quotient);
            (multiplier, multiplier)
        } else {
            let share = graph.mul(ratio, left[place]);
            (left[place], graph.neg(share))
        };
        lambda[system.model.rows_of(owner).start] = multiplier;
        if let Some(source) = known.by.source(system.model) {
            let at = place_of(layout, source).u;
            left[at] = system.graph.sub(left[at], on_source);
        }
    }
}

/// Takes what rows supply from what is left over along some rates.
fn take(graph: &mut Graph, left: &mut [ExprId], rows: &[Vec<ExprId>], multipliers: &[ExprId]) {
    for (row, &multiplier) in rows.iter().zip(multipliers) {
        for (left, &entry) in left.iter_mut().zip(row) {
            let taken = graph.mul(entry, multiplier);
            *left = graph.sub(*left, taken);
        }
    }
}

/// What a row forces upon its body.
struct Forced {
    t: Vec3,
    rotation: Rotation,
}

/// A rotation vector in the frame in which it is simpler.
enum Rotation {
    OnBody(Vec3),
    OnParent(Vec3),
}

impl Rotation {
    fn dot(&self, graph: &mut Graph, on_body: &Vec3, on_parent: &Vec3) -> ExprId {
        match self {
            Self::OnBody(rho) => graph.dot(rho, on_body),
            Self::OnParent(rho) => graph.dot(rho, on_parent),
        }
    }
}

fn on_manifold(
    system: &mut System,
    forced: &[SpatialVector],
    joint: &Held<'_>,
    unit: &[Vec<ExprId>],
) -> Vec<Forced> {
    let rotations: Vec<_> = forced.iter().flat_map(|twist| twist.rho).collect();
    let on_body = system.expanded(&joint.rotations, &rotations);
    let graph = &mut system.graph;
    let on_body = normal_form(graph, unit, &on_body);
    let (on_body, _) = on_body.as_chunks::<3>();
    let on_parent: Vec<_> =
        on_body.iter().flat_map(|rho| graph.mat_vec(&joint.link_kinematics.rotation, rho)).collect();
    let on_parent = normal_form(graph, unit, &on_parent);
    let (on_parent, _) = on_parent.as_chunks::<3>();
    let size = |graph: &Graph, rho: &Vec3| graph.reachable(rho).len();
    (forced.iter().zip(on_body).zip(on_parent))
        .map(|((twist, on_body), on_parent)| {
            let is_simpler = size(graph, on_parent) < size(graph, on_body);
            let rotation =
                if is_simpler { Rotation::OnParent(*on_parent) } else { Rotation::OnBody(*on_body) };
            Forced { t: twist.t, rotation }
        })
        .collect()
}

/// The body's rotation relative to what carries it, by joint coordinates.
fn rotations(system: &mut System, attachment: Attachment, link_kinematics: &LinkKinematics) -> Values {
    let moving_body = link_kinematics.moving_body;
    let Attachment::Joint { joint, parent, reversed } = attachment else {
        return matrix(&link_kinematics.rotation, |row, column| Symbol::Rotation {
            moving_body,
            row,
            column,
        });
    };
    if system.moving_body_of(parent).is_some() {
        let rotation = link_kinematics.rotation;
        let relative = if reversed { transposed(&rotation) } else { rotation };
        return matrix(&relative, |row, column| Symbol::Relative { joint, row, column });
    }
    let a = system.poses[parent].a;
    let a = system.graph.mat_mul(&a, &link_kinematics.rotation);
    matrix(&a, |row, column| Symbol::Rotation { moving_body, row, column })
}

fn matrix(m: &[Vec3; 3], symbol: impl Fn(usize, usize) -> Symbol) -> Values {
    let entries: [_; 9] = from_fn(|k| (symbol(k / 3, k % 3), m[k / 3][k % 3]));
    entries.into_iter().collect()
}
