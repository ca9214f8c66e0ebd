//! λ at a state that satisfies the constraints: the balance of forces of `multipliers`, with what each row forces upon its body
//! in polynomial normal form. There the gradients of a joint's rows are perpendicular unit vectors, and divisions vanish.

use super::coordinates::Coordinates;
use super::link_kinematics::Carriage;
use crate::derive::Textbook;
use crate::derive::system::System;
use crate::expr::definitions::Values;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::spatial_vector::SpatialVector;
use crate::expr::symbol::Symbol;
use crate::expr::vector::{Vec3, transposed};
use crate::simplify::normal_form::normal_form;
use crate::solve::articulated_body::Arm;
use crate::solve::motion_subspace::{Freedom, Parent};
use crate::solve::multipliers::imbalance;
use gyro_model::Attachment;
use std::array::from_fn;

/// The multiplier of each row, in terms of [`Symbol::Acceleration`], the maximal state and joint coordinates.
pub fn of(
    system: &mut System,
    Textbook { kinematics, dynamics }: &Textbook,
    Coordinates { layout, carriages, unit, .. }: &Coordinates,
) -> Vec<ExprId> {
    let mut lambda = vec![Graph::ZERO; kinematics.phi.len()];
    let mut lacking: Vec<_> = (0..system.slots.len()).map(|slot| imbalance(system, dynamics, slot)).collect();
    for (link, carriage) in layout.links.iter().zip(carriages).rev() {
        let freedom = Freedom::of(system, kinematics, link.link);
        let values = rotations(system, link.link.attachment, carriage);
        let freedom = Freedom {
            point: carriage.on_body,
            parent: freedom.parent.map(|parent| Parent {
                point: carriage.on_parent,
                relative: carriage.rotation,
                ..parent
            }),
            ..freedom
        };
        let forced = on_manifold(system, &freedom.forced, carriage, &values, unit);
        let graph = &mut system.graph;
        let at_joint = Arm::on_body(graph, &freedom).wrench(graph, &lacking[freedom.slot]);
        let turned = graph.mat_vec(&carriage.rotation, &at_joint.rho);
        for (row, forced) in freedom.rows.clone().zip(forced) {
            let (force, torque) =
                (graph.dot(&forced.t, &at_joint.t), forced.rotation.dot(graph, &at_joint.rho, &turned));
            // M v̇ + Φᵀλ = f.
            let supplied = graph.add(force, torque);
            lambda[row] = graph.neg(supplied);
        }
        if let Some(parent) = freedom.parent {
            let carried = parent.wrench(graph, &at_joint);
            lacking[parent.slot] = lacking[parent.slot].plus(graph, &carried);
        }
    }
    lambda
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
    carriage: &Carriage,
    values: &Values,
    unit: &[Vec<ExprId>],
) -> Vec<Forced> {
    let rotations: Vec<_> = forced.iter().flat_map(|twist| twist.rho).collect();
    let on_body = system.expanded(values, &rotations);
    let graph = &mut system.graph;
    let on_body = normal_form(graph, unit, &on_body);
    let (on_body, _) = on_body.as_chunks::<3>();
    let on_parent: Vec<_> = on_body.iter().flat_map(|rho| graph.mat_vec(&carriage.rotation, rho)).collect();
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
fn rotations(system: &mut System, attachment: Attachment, carriage: &Carriage) -> Values {
    let slot = carriage.slot;
    let Attachment::Joint { joint, parent, reversed } = attachment else {
        return matrix(&carriage.rotation, |row, column| Symbol::Rotation { slot, row, column });
    };
    if system.slot_of(parent).is_some() {
        let relative = if reversed { transposed(&carriage.rotation) } else { carriage.rotation };
        return matrix(&relative, |row, column| Symbol::Relative { joint, row, column });
    }
    let a = system.poses[parent].a;
    let a = system.graph.mat_mul(&a, &carriage.rotation);
    matrix(&a, |row, column| Symbol::Rotation { slot, row, column })
}

fn matrix(m: &[Vec3; 3], symbol: impl Fn(usize, usize) -> Symbol) -> Values {
    let entries: [_; 9] = from_fn(|k| (symbol(k / 3, k % 3), m[k / 3][k % 3]));
    entries.into_iter().collect()
}
