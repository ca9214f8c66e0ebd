//! λ at a state that satisfies the constraints: the balance of forces of `multipliers`, with what each row forces upon
//! its body in polynomial normal form. There the gradients of a joint's rows are perpendicular unit vectors, and
//! divisions vanish.

use super::coordinates::Coordinates;
use super::determined::{Relation, place_of};
use super::layout::Layout;
use super::link_kinematics::LinkKinematics;
use crate::derive::Textbook;
use crate::derive::system::System;
use crate::expr::definitions::Values;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::spatial_vector::SpatialVector;
use crate::expr::symbol::Symbol;
use crate::expr::vector::{Vec3, transposed};
use crate::simplify::normal_form::normal_form;
use crate::solve::articulated_body::Arm;
use crate::solve::motion_subspace::{MotionSubspace, Parent};
use crate::solve::multipliers::imbalance;
use gyro_model::Attachment;
use std::array::from_fn;

/// The multiplier of each row, in terms of [`Symbol::Acceleration`], the maximal state and joint coordinates.
pub fn of(
    system: &mut System,
    Textbook { kinematics, dynamics }: &Textbook,
    Coordinates { layout, links, unit, .. }: &Coordinates,
) -> Vec<ExprId> {
    let mut lambda = vec![Graph::ZERO; kinematics.phi.len()];
    let mut lacking: Vec<_> =
        (0..system.moving_bodies.len()).map(|moving_body| imbalance(system, dynamics, moving_body)).collect();
    let mut left = vec![Graph::ZERO; layout.n_tree_rates()];
    for (link, link_kinematics) in layout.links.iter().zip(links).rev() {
        let subspace = MotionSubspace::of(system, kinematics, link.link);
        let values = rotations(system, link.link.attachment, link_kinematics);
        let subspace = MotionSubspace {
            point: link_kinematics.on_body,
            parent: subspace.parent.map(|parent| Parent {
                point: link_kinematics.on_parent,
                relative: link_kinematics.rotation,
                ..parent
            }),
            ..subspace
        };
        let forced = on_manifold(system, &subspace.forced, link_kinematics, &values, unit);
        let graph = &mut system.graph;
        let at_joint = Arm::on_body(graph, &subspace).wrench(graph, &lacking[subspace.moving_body]);
        let turned = graph.mat_vec(&link_kinematics.rotation, &at_joint.rho);
        for free in &link_kinematics.free {
            let t = graph.mat_vec(&subspace.frame, &free.twist.t);
            let taken = SpatialVector { t, rho: free.twist.rho }.dot(graph, &at_joint);
            left[free.rate] = graph.neg(taken);
        }
        for (row, forced) in subspace.rows.clone().zip(forced) {
            let (force, torque) =
                (graph.dot(&forced.t, &at_joint.t), forced.rotation.dot(graph, &at_joint.rho, &turned));
            // M v̇ + Φᵀλ = f.
            let supplied = graph.add(force, torque);
            lambda[row] = graph.neg(supplied);
        }
        if let Some(parent) = subspace.parent {
            let carried = parent.wrench(graph, &at_joint);
            lacking[parent.moving_body] = lacking[parent.moving_body].plus(graph, &carried);
        }
    }
    let of_closure = beside_joints(system, layout, &left);
    for (row, value) in system.loop_closure_rows().into_iter().zip(of_closure) {
        lambda[row] = value;
    }
    lambda
}

/// The multipliers of the rows that no joint of the tree owns, in their order, from the force that is left over along
/// each rate of the tree: `left = Φ_xᵀ λ`.
pub fn beside_joints(system: &mut System, layout: &Layout, left: &[ExprId]) -> Vec<ExprId> {
    let mut left = left.to_vec();
    let rows = system.model.rows();
    let mut found = Vec::new();
    // What a coordinate determines comes after it.
    for known in layout.determined.iter().rev() {
        let place = place_of(layout, known.coordinate).u;
        let ratio = match known.by {
            Relation::Driver(_) => Graph::ZERO,
            Relation::Forward(coupler) | Relation::Backward(coupler) => {
                system.number(&system.model.couplers[coupler].ratio)
            }
        };
        let graph = &mut system.graph;
        // A coupler's row is `second − ratio · first − offset`.
        let (lambda, on_source) = if matches!(known.by, Relation::Backward(_)) {
            let quotient = graph.div(left[place], ratio);
            let lambda = graph.neg(quotient);
            (lambda, lambda)
        } else {
            let share = graph.mul(ratio, left[place]);
            (left[place], graph.neg(share))
        };
        found.push((known.by.owner(), lambda));
        if let Some(source) = known.by.source(system.model) {
            let at = place_of(layout, source).u;
            left[at] = system.graph.sub(left[at], on_source);
        }
    }
    let of_row = |row: usize| found.iter().find(|(owner, _)| *owner == rows[row].owner);
    let of_row = |row| of_row(row).expect("a row beside the joints determines a coordinate").1;
    system.loop_closure_rows().into_iter().map(of_row).collect()
}

/// The symbols that stand for them.
pub fn by_symbol(multipliers: &[ExprId]) -> impl Iterator<Item = (Symbol, ExprId)> {
    multipliers.iter().enumerate().map(|(place, &value)| (Symbol::LoopMultiplier(place), value))
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
    link_kinematics: &LinkKinematics,
    values: &Values,
    unit: &[Vec<ExprId>],
) -> Vec<Forced> {
    let rotations: Vec<_> = forced.iter().flat_map(|twist| twist.rho).collect();
    let on_body = system.expanded(values, &rotations);
    let graph = &mut system.graph;
    let on_body = normal_form(graph, unit, &on_body);
    let (on_body, _) = on_body.as_chunks::<3>();
    let on_parent: Vec<_> =
        on_body.iter().flat_map(|rho| graph.mat_vec(&link_kinematics.rotation, rho)).collect();
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
