//! The solve of eq. (17) for small trees through their reduced mass matrix `Bᵀ M B`, in the global frame: with few
//! rates it is shorter than to eliminate body by body.

use crate::derive::dynamics::Dynamics;
use crate::derive::system::System;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::spatial_vector::SpatialVector;
use crate::expr::vector::{Mat3, UNIT3, Vec3, ZERO3};
use crate::solve::ldl::Elimination;
use crate::solve::motion_subspace::MotionSubspace;
use std::collections::BTreeMap;

/// A body alone. What its inertia has in all directions alike need not be turned.
#[derive(Debug)]
struct Body {
    mass: ExprId,
    even: ExprId,
    /// The rest, in the body's frame.
    rest: Mat3,
    /// From the body's frame to the global one.
    a: Mat3,
    /// Angular velocity, in the body's frame.
    w: Vec3,
}

/// A joint point from the mass centres of the two bodies that meet there, global frame; nothing of a body at rest.
#[derive(Clone, Copy, Debug)]
struct HeldPoint {
    on_body: Vec3,
    on_parent: Option<Vec3>,
}

/// A tree with all that is needed for any right-hand side.
#[derive(Debug)]
pub struct ReducedTree {
    /// In the global frame, root first.
    subspaces: Vec<MotionSubspace>,
    /// Of those of them that hold a joint point to a body at rest or with coordinates.
    held: Vec<Option<HeldPoint>>,
    /// Of each moving body.
    bodies: Vec<Body>,
    /// Of each moving body how it moves at unit rates of those free twists that move it.
    columns: Vec<Vec<(usize, SpatialVector)>>,
    /// Lower triangle.
    matrix: BTreeMap<(usize, usize), ExprId>,
    n_rates: usize,
}

impl ReducedTree {
    /// `own` are the same subspaces with rotations in the bodies' own frames.
    pub fn new(system: &mut System, subspaces: Vec<MotionSubspace>, own: &[MotionSubspace]) -> Self {
        let bodies: Vec<_> =
            (0..system.moving_bodies.len()).map(|moving_body| Body::of(system, moving_body)).collect();
        let graph = &mut system.graph;
        let mut columns: Vec<Vec<(usize, SpatialVector)>> = vec![Vec::new(); bodies.len()];
        let mut axes = Vec::new();
        for (subspace, own) in subspaces.iter().zip(own) {
            let carried = subspace.parent.map_or_else(Vec::new, |parent| {
                let of_parent = columns[parent.moving_body].iter();
                of_parent.map(|(rate, twist)| (*rate, parent.twist(graph, twist))).collect()
            });
            let first = axes.len();
            let free = subspace.free.iter().enumerate().map(|(k, twist)| (first + k, *twist));
            columns[subspace.moving_body] = carried.into_iter().chain(free).collect();
            axes.extend(own.free.iter().map(|twist| twist.rho));
        }
        let held = own.iter().map(|own| HeldPoint::of(graph, &bodies, own)).collect();
        let mut tree =
            Self { subspaces, held, bodies, columns, matrix: BTreeMap::new(), n_rates: axes.len() };
        tree.matrix = tree.mass_matrix(graph, &axes);
        let armatures = own.iter().flat_map(|own| own.free.iter().zip(0..).map(|(_, k)| own.armature.get(k)));
        for (rate, &armature) in armatures.enumerate().filter_map(|(rate, of)| Some((rate, of?))) {
            let entry = tree.matrix.entry((rate, rate)).or_insert(Graph::ZERO);
            *entry = graph.add(*entry, armature);
        }
        tree
    }

    /// `axes` are the rotations of the free twists in the frames of their own bodies.
    fn mass_matrix(&self, graph: &mut Graph, axes: &[Vec3]) -> BTreeMap<(usize, usize), ExprId> {
        // What is even in all bodies takes one product of each pair of axes.
        let (mut matrix, mut even) = (BTreeMap::new(), BTreeMap::<_, (ExprId, ExprId)>::new());
        for (body, columns) in self.bodies.iter().zip(&self.columns) {
            let own: Vec<_> =
                columns.iter().map(|(_, twist)| graph.transposed_vec(&body.a, &twist.rho)).collect();
            for (place, (row, twist)) in columns.iter().enumerate() {
                let turned = graph.mat_vec(&body.rest, &own[place]);
                for (other, (column, against)) in columns.iter().enumerate().take(place + 1) {
                    let (linear, angular) =
                        (graph.dot(&against.t, &twist.t), graph.dot(&own[other], &turned));
                    let linear = graph.mul(body.mass, linear);
                    let sum = graph.add(linear, angular);
                    let entry = matrix.entry((*row, *column)).or_insert(Graph::ZERO);
                    *entry = graph.add(*entry, sum);
                    let (inertia, cosine) = even.entry((*row, *column)).or_insert((Graph::ZERO, Graph::ZERO));
                    *inertia = graph.add(*inertia, body.even);
                    *cosine = if row == column {
                        graph.dot(&axes[*row], &axes[*row])
                    } else {
                        graph.dot(&twist.rho, &against.rho)
                    };
                }
            }
        }
        for (place, (inertia, cosine)) in even {
            let product = graph.mul(inertia, cosine);
            let entry = matrix.entry(place).or_insert(Graph::ZERO);
            *entry = graph.add(*entry, product);
        }
        matrix.retain(|_, entry| *entry != Graph::ZERO);
        matrix
    }

    /// The accelerations of eq. (17).
    pub fn accelerations(&self, system: &mut System, dynamics: &Dynamics) -> Vec<SpatialVector> {
        let bias: Vec<_> = (0..self.bodies.len())
            .map(|moving_body| dynamics.minus_applied_force(&mut system.graph, moving_body))
            .collect();
        let motions = self.unforced(&mut system.graph);
        let along =
            self.subspaces.iter().flat_map(|subspace| subspace.free.iter().map(|_| subspace.held_back));
        let along = along.collect();
        self.respond(&mut system.graph, &bias, motions, along)
    }

    /// How each mass centre accelerates while no rate changes. What is fixed to a body at s from its mass centre
    /// accelerates by (w̃w̃ + ẇ̃) s more than that: one matrix serves all joint points of a body.
    fn unforced(&self, graph: &mut Graph) -> Vec<SpatialVector> {
        let mut motions = vec![SpatialVector::ZERO; self.bodies.len()];
        let mut of_points = vec![[ZERO3; 3]; self.bodies.len()];
        for (subspace, held) in self.subspaces.iter().zip(&self.held) {
            let of_parent = subspace.parent.map(|parent| motions[parent.moving_body]);
            let rho = of_parent
                .map_or(subspace.bias.rho, |of_parent| graph.add_vec(&of_parent.rho, &subspace.bias.rho));
            let body = &self.bodies[subspace.moving_body];
            let w = graph.mat_vec(&body.a, &body.w);
            let of_point = graph.relative_acceleration(&w, &rho);
            let t = match held {
                Some(HeldPoint { on_body, on_parent }) => {
                    let centre = graph.mat_vec(&of_point, on_body);
                    let point = subspace.parent.zip(*on_parent).map_or(ZERO3, |(parent, arm)| {
                        let of_arm = graph.mat_vec(&of_points[parent.moving_body], &arm);
                        graph.add_vec(&motions[parent.moving_body].t, &of_arm)
                    });
                    graph.sub_vec(&point, &centre)
                }
                None => subspace.on_parent(graph, &motions, &subspace.bias).t,
            };
            motions[subspace.moving_body] = SpatialVector { t, rho };
            of_points[subspace.moving_body] = of_point;
        }
        motions
    }

    /// The smallest motions that change the rows as given.
    pub fn project(&self, graph: &mut Graph, changes: &[ExprId]) -> Vec<SpatialVector> {
        let mut motions = vec![SpatialVector::ZERO; self.bodies.len()];
        for subspace in &self.subspaces {
            let forced = subspace.forced_by(graph, changes);
            motions[subspace.moving_body] = subspace.on_parent(graph, &motions, &forced);
        }
        let none = vec![Graph::ZERO; self.n_rates];
        self.respond(graph, &vec![SpatialVector::ZERO; self.bodies.len()], motions, none)
    }

    /// How each mass centre moves under minus these wrenches and these forces along the rates, where with no rate
    /// changing it would move like this.
    fn respond(
        &self,
        graph: &mut Graph,
        bias: &[SpatialVector],
        mut motions: Vec<SpatialVector>,
        mut rhs: Vec<ExprId>,
    ) -> Vec<SpatialVector> {
        let mut taken: Vec<_> = (self.bodies.iter().zip(&motions).zip(bias))
            .map(|((body, motion), bias)| body.taken(graph, motion, bias))
            .collect();
        let mut last = self.n_rates;
        for subspace in self.subspaces.iter().rev() {
            let wrench = taken[subspace.moving_body];
            let first = last - subspace.free.len();
            for (rhs, twist) in rhs[first..last].iter_mut().zip(&subspace.free) {
                let resisted = twist.dot(graph, &wrench);
                *rhs = graph.sub(*rhs, resisted);
            }
            last = first;
            if let Some(parent) = subspace.parent {
                let carried = parent.wrench(graph, &wrench);
                taken[parent.moving_body] = taken[parent.moving_body].plus(graph, &carried);
            }
        }
        let mut elimination = Elimination::new(self.matrix.clone(), rhs);
        (0..self.n_rates).rev().for_each(|rate| elimination.pivot(graph, rate));
        let rates = elimination.substitute_back(graph);
        for (motion, columns) in motions.iter_mut().zip(&self.columns) {
            for (rate, twist) in columns {
                let own = twist.scaled(graph, rates[*rate]);
                *motion = motion.plus(graph, &own);
            }
        }
        let in_own_frame = motions.iter().zip(&self.bodies).map(|(motion, body)| SpatialVector {
            t: motion.t,
            rho: graph.transposed_vec(&body.a, &motion.rho),
        });
        in_own_frame.collect()
    }
}

impl MotionSubspace {
    /// What its parent carries over to it, and what is forced upon it.
    fn on_parent(
        &self,
        graph: &mut Graph,
        motions: &[SpatialVector],
        forced: &SpatialVector,
    ) -> SpatialVector {
        let carried = self.parent.map(|parent| parent.twist(graph, &motions[parent.moving_body]));
        carried.map_or(*forced, |carried| carried.plus(graph, forced))
    }
}

impl HeldPoint {
    /// `own` has its points in the frames of its bodies.
    fn of(graph: &mut Graph, bodies: &[Body], own: &MotionSubspace) -> Option<Self> {
        let axis_bias = own.axis_bias.as_ref().filter(|axis_bias| axis_bias.holds_point)?;
        if own.parent.is_none() && !axis_bias.first_rests {
            return None;
        }
        let on_body = graph.mat_vec(&bodies[own.moving_body].a, &own.point);
        let on_parent = own.parent.map(|parent| graph.mat_vec(&bodies[parent.moving_body].a, &parent.point));
        Some(Self { on_body, on_parent })
    }
}

impl Body {
    fn of(system: &mut System, moving_body: usize) -> Self {
        let (mass, inertia, pose) = (
            system.mass(moving_body),
            system.inertia(moving_body),
            system.poses[system.moving_bodies[moving_body]],
        );
        let often = |k: &usize| (0..3).filter(|&l| inertia[l][l] == inertia[*k][*k]).count();
        let most = (0..3).rev().max_by_key(often).expect("three moments");
        let even = inertia[most][most];
        let evenly = UNIT3.map(|row| system.graph.scale_vec(even, &row));
        Self { mass, even, rest: system.graph.sub_mat(&inertia, &evenly), a: pose.a, w: pose.w }
    }

    /// What a motion takes, and a wrench with a torque in the body's frame; in the global frame.
    fn taken(&self, graph: &mut Graph, motion: &SpatialVector, bias: &SpatialVector) -> SpatialVector {
        let own = graph.transposed_vec(&self.a, &motion.rho);
        let torque = graph.mat_vec(&self.rest, &own);
        let torque = graph.add_vec(&torque, &bias.rho);
        let (torque, even) = (graph.mat_vec(&self.a, &torque), graph.scale_vec(self.even, &motion.rho));
        let force = graph.scale_vec(self.mass, &motion.t);
        SpatialVector { t: graph.add_vec(&force, &bias.t), rho: graph.add_vec(&torque, &even) }
    }
}
