//! The solve of eq. (17) for the trees of a mechanism, through the null space of the joints: `Bᵀ M B` is never formed but factored body by body
//! from the leaves to the roots (articulated bodies: Featherstone, *Rigid Body Dynamics Algorithms* (2008), section 7.3),
//! here in maximal coordinates and for any state, also off the constraint manifold.
//!
//! A body's acceleration is that of its parent's joint point carried over, plus its free twists, plus what its rows force
//! upon it (γ times their right inverse). Its free twists are eliminated one by one; what is left of its inertia and
//! force acts on the parent. No pivot can vanish: each is the inertia that resists a twist.

use crate::closing;
use crate::dynamics::Dynamics;
use crate::freedom::{Freedom, Twist};
use crate::graph::{ExprId, Graph};
use crate::kinematics::Kinematics;
use crate::linear::{Mat3, Vec3, ZERO3};
use crate::multipliers;
use crate::system::System;

/// Accelerations and what follows from them.
#[derive(Debug)]
pub struct Solution {
    /// (s̈, ẇ') of each slot.
    pub accelerations: Vec<ExprId>,
    /// Multipliers of the rows that close loops or couple joints, those that no joint of the tree owns.
    pub closing: Vec<ExprId>,
    /// The multiplier of each row, in terms of [`Symbol::Acceleration`] and [`Symbol::Closing`].
    pub lambda: Vec<ExprId>,
}

/// Solves eq. (17); the result is expressed in symbols that are yet to be expanded.
pub fn solve(system: &mut System, kinematics: &Kinematics, dynamics: &Dynamics) -> Solution {
    let tree = EliminatedTree::new(system, kinematics, dynamics);
    let free = tree.accelerations(system, kinematics);
    let (motions, closing) = closing::close(system, kinematics, &tree, free);
    let accelerations = motions.iter().flat_map(|motion| motion.t.into_iter().chain(motion.rho)).collect();
    let lambda = multipliers::of(system, kinematics, dynamics, &tree);
    Solution { accelerations, closing, lambda }
}

/// The trees with the free twists of all joints eliminated.
#[derive(Debug)]
pub struct EliminatedTree {
    /// Root first.
    pub joints: Vec<EliminatedJoint>,
    /// Minus the applied force on each slot.
    bias: Vec<Twist>,
}

impl EliminatedTree {
    fn new(system: &mut System, kinematics: &Kinematics, dynamics: &Dynamics) -> Self {
        let links = system.tree.links.clone();
        let freedoms: Vec<_> = links.iter().map(|&link| Freedom::of(system, kinematics, link)).collect();
        let n_slots = system.slots.len();
        let mut bodies: Vec<_> = (0..n_slots).map(|slot| Inertia::rigid(system, slot)).collect();
        let mut joints = Vec::new();
        for freedom in freedoms.into_iter().rev() {
            let parent = freedom.parent;
            let joint = EliminatedJoint::new(system, freedom, &bodies);
            if let Some(parent) = parent {
                let load = joint.on_parent(&mut system.graph, &parent.relative);
                let arm = Arm::new(system, parent.slot, &parent.point, Outwards::Yes);
                let load = load.seen_through(&mut system.graph, &arm);
                bodies[parent.slot].add(&mut system.graph, &load);
            }
            joints.push(joint);
        }
        joints.reverse();
        let bias = (0..n_slots).map(|slot| minus_applied_force(system, dynamics, slot)).collect();
        Self { joints, bias }
    }

    /// The accelerations that the applied forces and the rows of the tree's own joints bring about.
    fn accelerations(&self, system: &mut System, kinematics: &Kinematics) -> Vec<Twist> {
        let forced: Vec<_> = self
            .joints
            .iter()
            .map(|joint| {
                let gamma = &kinematics.gamma[joint.freedom.rows.clone()];
                let parts: Vec<_> = (gamma.iter().zip(&joint.freedom.forced))
                    .map(|(&gamma, twist)| twist.scaled(&mut system.graph, gamma))
                    .collect();
                parts.iter().fold(Twist::ZERO, |sum, part| sum.plus(&mut system.graph, part))
            })
            .collect();
        self.respond(system, self.bias.clone(), &forced)
    }

    /// The accelerations of the mass centres for a bias on each slot and an acceleration forced upon each joint.
    pub fn respond(&self, system: &mut System, mut bias: Vec<Twist>, forced: &[Twist]) -> Vec<Twist> {
        let mut loads = Vec::new();
        for (joint, forced) in self.joints.iter().zip(forced).rev() {
            let (own, on_parent) = joint.yield_to(system, &bias[joint.freedom.slot], forced);
            loads.push(own);
            if let Some(parent) = joint.freedom.parent {
                bias[parent.slot] = bias[parent.slot].plus(&mut system.graph, &on_parent);
            }
        }
        let mut motions = vec![Twist::ZERO; bias.len()];
        for ((joint, forced), loads) in self.joints.iter().zip(forced).zip(loads.iter().rev()) {
            motions[joint.freedom.slot] = joint.motion(system, forced, loads, &motions);
        }
        motions
    }
}

/// Minus (f, n' − w̃'J'w').
pub fn minus_applied_force(system: &mut System, dynamics: &Dynamics, slot: usize) -> Twist {
    let force = |k: usize| dynamics.applied_force[6 * slot + k];
    let applied = Twist { t: [force(0), force(1), force(2)], rho: [force(3), force(4), force(5)] };
    applied.negated(&mut system.graph)
}

impl Twist {
    pub const ZERO: Self = Self { t: ZERO3, rho: ZERO3 };

    pub fn dot(&self, graph: &mut Graph, wrench: &Self) -> ExprId {
        let (force, torque) = (graph.dot(&self.t, &wrench.t), graph.dot(&self.rho, &wrench.rho));
        graph.add(force, torque)
    }

    pub fn plus(&self, graph: &mut Graph, other: &Self) -> Self {
        Self { t: graph.add_vec(&self.t, &other.t), rho: graph.add_vec(&self.rho, &other.rho) }
    }

    pub fn scaled(&self, graph: &mut Graph, factor: ExprId) -> Self {
        Self { t: graph.scale_vec(factor, &self.t), rho: graph.scale_vec(factor, &self.rho) }
    }

    pub fn negated(&self, graph: &mut Graph) -> Self {
        Self { t: graph.neg_vec(&self.t), rho: graph.neg_vec(&self.rho) }
    }
}

/// Which of the two points the twist is known at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outwards {
    /// At the mass centre; wanted at the joint point.
    Yes,
    /// At the joint point; wanted at the mass centre.
    No,
}

/// The change of the reference point of a body's twist: `t_wanted = t_known + K ρ` with `K = ∓A s̃'`.
#[derive(Clone, Copy, Debug)]
pub struct Arm {
    k: Mat3,
    /// `KᵀK = s̃'ᵀ s̃'`: A is orthogonal.
    square: Mat3,
}

impl Arm {
    pub fn new(system: &mut System, slot: usize, point: &Vec3, outwards: Outwards) -> Self {
        let a = system.poses[system.slots[slot]].a;
        let graph = &mut system.graph;
        let known_to_wanted = if outwards == Outwards::Yes { graph.neg_vec(point) } else { *point };
        let tilde = graph.tilde(&known_to_wanted);
        let k = graph.mat_mul(&a, &tilde);
        let square = graph.mat_mul(&transposed(&tilde), &tilde);
        Self { k, square }
    }

    pub fn twist(&self, graph: &mut Graph, known: &Twist) -> Twist {
        let turned = graph.mat_vec(&self.k, &known.rho);
        Twist { t: graph.add_vec(&known.t, &turned), rho: known.rho }
    }

    /// A wrench at the wanted point as one at the known point.
    pub fn wrench(&self, graph: &mut Graph, wanted: &Twist) -> Twist {
        let moment = graph.transposed_vec(&self.k, &wanted.t);
        Twist { t: wanted.t, rho: graph.add_vec(&wanted.rho, &moment) }
    }
}

/// What resists the acceleration of a body with all that hangs on it.
#[derive(Clone, Copy, Debug)]
pub struct Inertia {
    /// The part of the linear inertia that is the same in all directions.
    mass: ExprId,
    /// The rest of the linear inertia, global frame.
    linear: Mat3,
    /// Forces (rows, global frame) due to rotations (columns, body frame).
    coupling: Mat3,
    /// Body frame.
    angular: Mat3,
}

impl Inertia {
    /// The body alone, at its mass centre.
    pub fn rigid(system: &mut System, slot: usize) -> Self {
        let (mass, angular) = (system.mass(slot), system.inertia(slot));
        Self { mass, linear: [ZERO3; 3], coupling: [ZERO3; 3], angular }
    }

    fn add(&mut self, graph: &mut Graph, other: &Self) {
        self.mass = graph.add(self.mass, other.mass);
        self.linear = sum(graph, &self.linear, &other.linear);
        self.coupling = sum(graph, &self.coupling, &other.coupling);
        self.angular = sum(graph, &self.angular, &other.angular);
    }

    /// The wrench that an acceleration takes.
    pub fn times(&self, graph: &mut Graph, acceleration: &Twist) -> Twist {
        let Twist { t, rho } = acceleration;
        let (even, rest) = (graph.scale_vec(self.mass, t), graph.mat_vec(&self.linear, t));
        let (force, turned) = (graph.add_vec(&even, &rest), graph.mat_vec(&self.coupling, rho));
        let (moment, torque) = (graph.transposed_vec(&self.coupling, t), graph.mat_vec(&self.angular, rho));
        Twist { t: graph.add_vec(&force, &turned), rho: graph.add_vec(&torque, &moment) }
    }

    /// The same inertia in terms of the twist at an arm's known point.
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
        Self { mass: self.mass, linear: self.linear, coupling, angular: sum(graph, &angular, &added) }
    }
}

/// A body's joint after the elimination of its free twists.
#[derive(Debug)]
pub struct EliminatedJoint {
    pub freedom: Freedom,
    /// For each free twist, in the order of elimination.
    steps: Vec<Step>,
    /// What is left, at the joint point.
    rest: Inertia,
}

/// `z = −(U · a + load) / (s · U)` with `U` the inertia times the twist s.
#[derive(Debug)]
struct Step {
    twist: Twist,
    resistance: Twist,
    inverse: ExprId,
}

impl EliminatedJoint {
    fn new(system: &mut System, freedom: Freedom, bodies: &[Inertia]) -> Self {
        let arm = Arm::new(system, freedom.slot, &freedom.point, Outwards::No);
        let graph = &mut system.graph;
        let mut rest = bodies[freedom.slot].seen_through(graph, &arm);
        let mut steps = Vec::new();
        for twist in &freedom.free {
            let resistance = rest.times(graph, twist);
            let pivot = twist.dot(graph, &resistance);
            let step = Step { twist: *twist, resistance, inverse: graph.recip(pivot) };
            rest = step.eliminate(graph, &rest);
            steps.push(step);
        }
        Self { freedom, steps, rest }
    }

    /// The inertia that the parent feels at the joint point, in its own frame.
    fn on_parent(&self, graph: &mut Graph, relative: &Mat3) -> Inertia {
        let back = transposed(relative);
        let turned = graph.mat_mul(relative, &self.rest.angular);
        Inertia {
            mass: self.rest.mass,
            linear: self.rest.linear,
            coupling: graph.mat_mul(&self.rest.coupling, &back),
            angular: symmetric(&graph.mat_mul(&turned, &back)),
        }
    }

    /// The load that each free twist yields to, and the bias that is left for the parent's mass centre.
    fn yield_to(&self, system: &mut System, bias: &Twist, forced: &Twist) -> (Vec<ExprId>, Twist) {
        let arm = Arm::new(system, self.freedom.slot, &self.freedom.point, Outwards::No);
        let graph = &mut system.graph;
        let mut bias = arm.wrench(graph, bias);
        let mut loads = Vec::new();
        for step in &self.steps {
            let load = step.twist.dot(graph, &bias);
            let share = graph.mul(load, step.inverse);
            let reaction = step.resistance.scaled(graph, share).negated(graph);
            bias = bias.plus(graph, &reaction);
            loads.push(load);
        }
        let Some(parent) = self.freedom.parent else { return (loads, Twist::ZERO) };
        let inertial = self.rest.times(graph, forced);
        bias = bias.plus(graph, &inertial);
        let turned = Twist { t: bias.t, rho: graph.mat_vec(&parent.relative, &bias.rho) };
        let arm = Arm::new(system, parent.slot, &parent.point, Outwards::Yes);
        (loads, arm.wrench(&mut system.graph, &turned))
    }

    /// The acceleration of the body's mass centre.
    fn motion(&self, system: &mut System, forced: &Twist, loads: &[ExprId], motions: &[Twist]) -> Twist {
        let mut motion = *forced;
        if let Some(parent) = self.freedom.parent {
            let arm = Arm::new(system, parent.slot, &parent.point, Outwards::Yes);
            let graph = &mut system.graph;
            let at_joint = arm.twist(graph, &motions[parent.slot]);
            let rho = graph.transposed_vec(&parent.relative, &at_joint.rho);
            motion = motion.plus(graph, &Twist { t: at_joint.t, rho });
        }
        for (step, load) in self.steps.iter().zip(loads).rev() {
            motion = step.release(&mut system.graph, &motion, *load);
        }
        let arm = Arm::new(system, self.freedom.slot, &self.freedom.point, Outwards::No);
        arm.twist(&mut system.graph, &motion)
    }
}

impl Step {
    /// The inertia that remains once the twist yields.
    fn eliminate(&self, graph: &mut Graph, body: &Inertia) -> Inertia {
        let u = self.resistance;
        let factor = u.scaled(graph, self.inverse);
        Inertia {
            mass: body.mass,
            linear: less_product(graph, &body.linear, &factor.t, &u.t, Symmetry::Symmetric),
            coupling: less_product(graph, &body.coupling, &factor.t, &u.rho, Symmetry::None),
            angular: less_product(graph, &body.angular, &factor.rho, &u.rho, Symmetry::Symmetric),
        }
    }

    /// Adds the twist, yielding to the load and to the acceleration so far.
    fn release(&self, graph: &mut Graph, motion: &Twist, load: ExprId) -> Twist {
        let inertial = self.resistance.dot(graph, motion);
        let resisting = graph.add(inertial, load);
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
