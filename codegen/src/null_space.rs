//! The solve of eq. (17) for trees, through the null space of the joints: `Bᵀ M B` is never formed but factored body by body
//! from the leaves to the roots (articulated bodies: Featherstone, *Rigid Body Dynamics Algorithms* (2008), section 7.3),
//! here in maximal coordinates and for any state, also off the constraint manifold.
//!
//! A body's acceleration is that of its parent's joint point carried over, plus its free twists, plus what its rows force
//! upon it (γ times their right inverse). Its free twists are eliminated one by one; what is left of its inertia and
//! force acts on the parent. No pivot can vanish: each is the inertia that resists a twist.

use crate::dynamics::Dynamics;
use crate::freedom::{Freedom, Twist};
use crate::graph::{ExprId, Graph};
use crate::kinematics::Kinematics;
use crate::linear::{Mat3, Vec3, ZERO3};
use crate::system::System;

/// Accelerations (s̈, ẇ') of each slot and the multiplier of each row.
#[derive(Debug)]
pub struct Solution {
    pub accelerations: Vec<ExprId>,
    pub lambda: Vec<ExprId>,
}

/// Solves eq. (17); the result is expressed in symbols that are yet to be expanded.
pub fn solve(system: &mut System, kinematics: &Kinematics, dynamics: &Dynamics) -> Solution {
    let links = system.tree.links.clone();
    let freedoms: Vec<_> = links.iter().map(|&link| Freedom::of(system, kinematics, link)).collect();
    let mut bodies: Vec<_> =
        (0..system.slots.len()).map(|slot| ArticulatedBody::rigid(system, dynamics, slot)).collect();
    let mut eliminated = Vec::new();
    for freedom in freedoms.iter().rev() {
        let joint = EliminatedJoint::new(system, kinematics, freedom, &bodies[freedom.slot]);
        if let Some(parent) = freedom.parent {
            let load = joint.on_parent(&mut system.graph, &parent.relative);
            let arm = Arm::new(system, parent.slot, &parent.point, Outwards::Yes);
            let load = load.seen_through(&mut system.graph, &arm);
            bodies[parent.slot].add(&mut system.graph, &load);
        }
        eliminated.push(joint);
    }
    let mut motions = vec![Twist::ZERO; bodies.len()];
    for (freedom, joint) in freedoms.iter().zip(eliminated.iter().rev()) {
        motions[freedom.slot] = joint.motion(system, freedom, &motions);
    }
    let lambda = multipliers(system, dynamics, &freedoms, &motions);
    let accelerations = motions.iter().flat_map(|motion| motion.t.into_iter().chain(motion.rho)).collect();
    Solution { accelerations, lambda }
}

/// λ from the balance of forces, leaf to root: what a body and all that hangs on it lack, its joint supplies.
fn multipliers(
    system: &mut System,
    dynamics: &Dynamics,
    freedoms: &[Freedom],
    motions: &[Twist],
) -> Vec<ExprId> {
    let mut lambda = vec![Graph::ZERO; system.model.rows().len()];
    let mut lacking: Vec<_> = (0..motions.len())
        .map(|slot| {
            let body = ArticulatedBody::rigid(system, dynamics, slot);
            body.wrench(&mut system.graph, &motions[slot])
        })
        .collect();
    for freedom in freedoms.iter().rev() {
        let arm = Arm::new(system, freedom.slot, &freedom.point, Outwards::No);
        let graph = &mut system.graph;
        let at_joint = arm.wrench(graph, &lacking[freedom.slot]);
        for (row, forced) in freedom.rows.clone().zip(&freedom.forced) {
            // M v̇ + Φᵀλ = f.
            let supplied = forced.dot(graph, &at_joint);
            lambda[row] = graph.neg(supplied);
        }
        if let Some(parent) = freedom.parent {
            let turned = Twist { t: at_joint.t, rho: graph.mat_vec(&parent.relative, &at_joint.rho) };
            let arm = Arm::new(system, parent.slot, &parent.point, Outwards::Yes);
            let carried = arm.wrench(&mut system.graph, &turned);
            lacking[parent.slot] = lacking[parent.slot].plus(&mut system.graph, &carried);
        }
    }
    lambda
}

impl Twist {
    pub const ZERO: Self = Self { t: ZERO3, rho: ZERO3 };

    fn dot(&self, graph: &mut Graph, wrench: &Self) -> ExprId {
        let (force, torque) = (graph.dot(&self.t, &wrench.t), graph.dot(&self.rho, &wrench.rho));
        graph.add(force, torque)
    }

    fn plus(&self, graph: &mut Graph, other: &Self) -> Self {
        Self { t: graph.add_vec(&self.t, &other.t), rho: graph.add_vec(&self.rho, &other.rho) }
    }

    fn scaled(&self, graph: &mut Graph, factor: ExprId) -> Self {
        Self { t: graph.scale_vec(factor, &self.t), rho: graph.scale_vec(factor, &self.rho) }
    }
}

/// Which of the two points the twist is known at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Outwards {
    /// At the mass centre; wanted at the joint point.
    Yes,
    /// At the joint point; wanted at the mass centre.
    No,
}

/// The change of the reference point of a body's twist: `t_wanted = t_known + K ρ` with `K = ∓A s̃'`.
#[derive(Clone, Copy, Debug)]
struct Arm {
    k: Mat3,
    /// `KᵀK = s̃'ᵀ s̃'`: A is orthogonal.
    square: Mat3,
}

impl Arm {
    fn new(system: &mut System, slot: usize, point: &Vec3, outwards: Outwards) -> Self {
        let a = system.poses[system.slots[slot]].a;
        let graph = &mut system.graph;
        let known_to_wanted = if outwards == Outwards::Yes { graph.neg_vec(point) } else { *point };
        let tilde = graph.tilde(&known_to_wanted);
        let k = graph.mat_mul(&a, &tilde);
        let square = graph.mat_mul(&transposed(&tilde), &tilde);
        Self { k, square }
    }

    fn twist(&self, graph: &mut Graph, known: &Twist) -> Twist {
        let turned = graph.mat_vec(&self.k, &known.rho);
        Twist { t: graph.add_vec(&known.t, &turned), rho: known.rho }
    }

    /// A wrench at the wanted point as one at the known point.
    fn wrench(&self, graph: &mut Graph, wanted: &Twist) -> Twist {
        let moment = graph.transposed_vec(&self.k, &wanted.t);
        Twist { t: wanted.t, rho: graph.add_vec(&wanted.rho, &moment) }
    }
}

/// What resists the acceleration of a body with all that hangs on it: `wrench = inertia · acceleration + bias`.
#[derive(Clone, Copy, Debug)]
struct ArticulatedBody {
    /// The part of the linear inertia that is the same in all directions.
    mass: ExprId,
    /// The rest of the linear inertia, global frame.
    linear: Mat3,
    /// Forces (rows, global frame) due to rotations (columns, body frame).
    coupling: Mat3,
    /// Body frame.
    angular: Mat3,
    bias: Twist,
}

impl ArticulatedBody {
    /// The body alone, at its mass centre.
    fn rigid(system: &mut System, dynamics: &Dynamics, slot: usize) -> Self {
        let (mass, angular) = (system.mass(slot), system.inertia(slot));
        let force = |k: usize| dynamics.applied_force[6 * slot + k];
        let bias = Twist { t: [force(0), force(1), force(2)], rho: [force(3), force(4), force(5)] };
        let minus = system.graph.integer(-1);
        let bias = bias.scaled(&mut system.graph, minus);
        Self { mass, linear: [ZERO3; 3], coupling: [ZERO3; 3], angular, bias }
    }

    fn add(&mut self, graph: &mut Graph, other: &Self) {
        self.mass = graph.add(self.mass, other.mass);
        self.linear = sum(graph, &self.linear, &other.linear);
        self.coupling = sum(graph, &self.coupling, &other.coupling);
        self.angular = sum(graph, &self.angular, &other.angular);
        self.bias = self.bias.plus(graph, &other.bias);
    }

    /// Inertia times acceleration, without the bias.
    fn times(&self, graph: &mut Graph, acceleration: &Twist) -> Twist {
        let Twist { t, rho } = acceleration;
        let (even, rest) = (graph.scale_vec(self.mass, t), graph.mat_vec(&self.linear, t));
        let (force, turned) = (graph.add_vec(&even, &rest), graph.mat_vec(&self.coupling, rho));
        let (moment, torque) = (graph.transposed_vec(&self.coupling, t), graph.mat_vec(&self.angular, rho));
        Twist { t: graph.add_vec(&force, &turned), rho: graph.add_vec(&torque, &moment) }
    }

    fn wrench(&self, graph: &mut Graph, acceleration: &Twist) -> Twist {
        let inertial = self.times(graph, acceleration);
        inertial.plus(graph, &self.bias)
    }

    /// The same inertia and bias in terms of the twist at an arm's known point.
    fn seen_through(&self, graph: &mut Graph, arm: &Arm) -> Self {
        let k_transposed = transposed(&arm.k);
        let even = arm.k.map(|row| graph.scale_vec(self.mass, &row));
        let rest = graph.mat_mul(&self.linear, &arm.k);
        let by_linear = sum(graph, &even, &rest);
        let coupling = sum(graph, &self.coupling, &by_linear);
        let (moment, stiff) =
            (graph.mat_mul(&k_transposed, &self.coupling), graph.mat_mul(&k_transposed, &rest));
        let even = arm.square.map(|row| graph.scale_vec(self.mass, &row));
        let both_moments = sum(graph, &moment, &transposed(&moment));
        let angular = sum(graph, &self.angular, &even);
        let added = sum(graph, &symmetric(&stiff), &symmetric(&both_moments));
        let angular = sum(graph, &angular, &added);
        Self { mass: self.mass, linear: self.linear, coupling, angular, bias: arm.wrench(graph, &self.bias) }
    }
}

/// A body's joint after the elimination of its free twists.
#[derive(Debug)]
struct EliminatedJoint {
    /// For each free twist, in the order of elimination.
    steps: Vec<Step>,
    /// What is left, at the joint point.
    rest: ArticulatedBody,
    /// The acceleration that the rows force upon the joint point.
    forced: Twist,
}

/// `z = −(U · a + s · bias) / (s · U)` with `U` the inertia times the twist s.
#[derive(Debug)]
struct Step {
    twist: Twist,
    resistance: Twist,
    inverse: ExprId,
    load: ExprId,
}

impl EliminatedJoint {
    fn new(system: &mut System, kinematics: &Kinematics, freedom: &Freedom, body: &ArticulatedBody) -> Self {
        let arm = Arm::new(system, freedom.slot, &freedom.point, Outwards::No);
        let graph = &mut system.graph;
        let mut rest = body.seen_through(graph, &arm);
        let mut steps = Vec::new();
        for twist in &freedom.free {
            let resistance = rest.times(graph, twist);
            let pivot = twist.dot(graph, &resistance);
            let step = Step {
                twist: *twist,
                resistance,
                inverse: graph.recip(pivot),
                load: twist.dot(graph, &rest.bias),
            };
            rest = step.eliminate(graph, &rest);
            steps.push(step);
        }
        let mut forced = Twist::ZERO;
        for (row, twist) in freedom.rows.clone().zip(&freedom.forced) {
            let part = twist.scaled(graph, kinematics.gamma[row]);
            forced = forced.plus(graph, &part);
        }
        Self { steps, rest, forced }
    }

    /// What the parent feels at the joint point, in its own frame.
    fn on_parent(&self, graph: &mut Graph, relative: &Mat3) -> ArticulatedBody {
        let bias = self.rest.wrench(graph, &self.forced);
        let back = transposed(relative);
        let turned = graph.mat_mul(relative, &self.rest.angular);
        ArticulatedBody {
            mass: self.rest.mass,
            linear: self.rest.linear,
            coupling: graph.mat_mul(&self.rest.coupling, &back),
            angular: symmetric(&graph.mat_mul(&turned, &back)),
            bias: Twist { t: bias.t, rho: graph.mat_vec(relative, &bias.rho) },
        }
    }

    /// The acceleration of the body's mass centre.
    fn motion(&self, system: &mut System, freedom: &Freedom, motions: &[Twist]) -> Twist {
        let mut motion = self.forced;
        if let Some(parent) = freedom.parent {
            let arm = Arm::new(system, parent.slot, &parent.point, Outwards::Yes);
            let graph = &mut system.graph;
            let at_joint = arm.twist(graph, &motions[parent.slot]);
            let rho = graph.transposed_vec(&parent.relative, &at_joint.rho);
            motion = motion.plus(graph, &Twist { t: at_joint.t, rho });
        }
        for step in self.steps.iter().rev() {
            motion = step.release(&mut system.graph, &motion);
        }
        let arm = Arm::new(system, freedom.slot, &freedom.point, Outwards::No);
        arm.twist(&mut system.graph, &motion)
    }
}

impl Step {
    /// Inertia and bias that remain once the twist yields.
    fn eliminate(&self, graph: &mut Graph, body: &ArticulatedBody) -> ArticulatedBody {
        let u = self.resistance;
        let factor = u.scaled(graph, self.inverse);
        let reaction = factor.scaled(graph, self.load);
        let minus = graph.integer(-1);
        let reaction = reaction.scaled(graph, minus);
        ArticulatedBody {
            mass: body.mass,
            linear: less_product(graph, &body.linear, &factor.t, &u.t, Symmetry::Symmetric),
            coupling: less_product(graph, &body.coupling, &factor.t, &u.rho, Symmetry::None),
            angular: less_product(graph, &body.angular, &factor.rho, &u.rho, Symmetry::Symmetric),
            bias: body.bias.plus(graph, &reaction),
        }
    }

    /// Adds the twist, yielding to the acceleration so far.
    fn release(&self, graph: &mut Graph, motion: &Twist) -> Twist {
        let inertial = self.resistance.dot(graph, motion);
        let resisting = graph.add(inertial, self.load);
        let rate = graph.mul(resisting, self.inverse);
        let rate = graph.neg(rate);
        let yielded = self.twist.scaled(graph, rate);
        motion.plus(graph, &yielded)
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Symmetry {
    Symmetric,
    None,
}

/// `m − u vᵀ`.
fn less_product(graph: &mut Graph, m: &Mat3, u: &Vec3, v: &Vec3, symmetry: Symmetry) -> Mat3 {
    let result = std::array::from_fn(|row| {
        std::array::from_fn(|column| {
            let product = graph.mul(u[row], v[column]);
            graph.sub(m[row][column], product)
        })
    });
    if symmetry == Symmetry::Symmetric { symmetric(&result) } else { result }
}

/// The upper triangle mirrored: entries that are equal become one expression.
fn symmetric(m: &Mat3) -> Mat3 {
    std::array::from_fn(|row| std::array::from_fn(|column| m[row.min(column)][row.max(column)]))
}

fn transposed(m: &Mat3) -> Mat3 {
    std::array::from_fn(|row| std::array::from_fn(|column| m[column][row]))
}

fn sum(graph: &mut Graph, a: &Mat3, b: &Mat3) -> Mat3 {
    std::array::from_fn(|row| graph.add_vec(&a[row], &b[row]))
}
