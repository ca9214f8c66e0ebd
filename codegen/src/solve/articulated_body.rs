//! Elimination of the free twists of all joints, the null space of their rows: `Bᵀ M B` is never formed but factored
//! body by body from the leaves to the roots (articulated bodies: Featherstone, *Rigid Body Dynamics Algorithms*
//! (2008), section 7.3), here in maximal coordinates and for any state, also off the constraint manifold.
//!
//! A body's acceleration is that of its parent's joint point carried over, plus its free twists, plus what its rows
//! force upon it (γ times their right inverse). Its free twists are eliminated one by one; what is left of its inertia
//! and force acts on the parent. No pivot can vanish: each is the inertia that resists a twist.

use crate::derive::system::System;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::spatial_vector::SpatialVector;
use crate::expr::vector::{Mat3, UNIT3, Vec3, ZERO3, transposed};
use crate::solve::component::Component;
use crate::solve::motion_subspace::{MotionSubspace, Parent};

/// The frames in which an elimination works.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Basis {
    /// Translations in the global frame, rotations in each body's own: as in eq. (17).
    Mixed,
    /// The global frame: nothing is turned on its way from body to body.
    Global,
    /// Each body's own: axes, arms and inertias are constants.
    Own,
}

impl Basis {
    /// Of each moving body.
    pub fn frames(self, system: &System) -> Vec<Frames> {
        let of = |&body: &usize| match self {
            Self::Mixed => Frames { t: UNIT3, rho: UNIT3 },
            Self::Global => Frames { t: UNIT3, rho: system.poses[body].a },
            Self::Own => Frames { t: transposed(&system.poses[body].a), rho: UNIT3 },
        };
        system.moving_bodies.iter().map(of).collect()
    }
}

/// From the frames of eq. (17) to those of a basis.
#[derive(Clone, Copy, Debug)]
pub struct Frames {
    t: Mat3,
    rho: Mat3,
}

impl Frames {
    pub fn enter(&self, graph: &mut Graph, twist: &SpatialVector) -> SpatialVector {
        SpatialVector { t: graph.mat_vec(&self.t, &twist.t), rho: graph.mat_vec(&self.rho, &twist.rho) }
    }

    pub fn leave(&self, graph: &mut Graph, twist: &SpatialVector) -> SpatialVector {
        SpatialVector {
            t: graph.transposed_vec(&self.t, &twist.t),
            rho: graph.transposed_vec(&self.rho, &twist.rho),
        }
    }
}

/// The trees with the free twists of all joints eliminated.
#[derive(Debug)]
pub struct EliminatedTree {
    /// Root first.
    pub joints: Vec<EliminatedJoint>,
    /// Of each moving body.
    frames: Vec<Frames>,
}

/// What sets a tree in motion.
#[derive(Debug)]
pub struct Excitation {
    /// On the mass centre of each moving body: minus the applied wrench.
    pub bias: Vec<SpatialVector>,
    /// On each joint, root first: the acceleration forced upon it.
    pub forced: Vec<SpatialVector>,
    /// On each joint, root first: the force along each of its free twists; those not listed have none.
    pub along: Vec<Vec<ExprId>>,
}

/// How a tree moves.
#[derive(Debug)]
pub struct Response {
    /// The acceleration of each moving body's mass centre.
    pub motions: Vec<SpatialVector>,
    /// For each joint, root first: how fast each of its free twists accelerates.
    pub rates: Vec<Vec<ExprId>>,
}

impl Excitation {
    /// Of nothing.
    pub fn none(n_moving_bodies: usize, n_joints: usize) -> Self {
        Self {
            bias: vec![SpatialVector::ZERO; n_moving_bodies],
            forced: vec![SpatialVector::ZERO; n_joints],
            along: vec![Vec::new(); n_joints],
        }
    }
}

impl EliminatedTree {
    pub fn n_moving_bodies(&self) -> usize {
        self.frames.len()
    }

    /// The links come root first.
    pub fn new(system: &mut System, subspaces: Vec<MotionSubspace>, basis: Basis) -> Self {
        let frames = basis.frames(system);
        let rigid = |(moving_body, frames): (usize, &Frames)| {
            Inertia::rigid(system, moving_body).turned(&mut system.graph, &frames.rho)
        };
        let mut bodies: Vec<_> = frames.iter().enumerate().map(rigid).collect();
        let mut joints = Vec::new();
        for subspace in subspaces.into_iter().rev() {
            let parent = subspace.parent;
            let joint = EliminatedJoint::new(system, subspace, &bodies);
            if let Some(parent) = parent {
                let graph = &mut system.graph;
                let load = joint.rest.on_parent(graph, &parent);
                let arm = Arm::on_parent(graph, &parent);
                let load = load.seen_through(graph, &arm);
                bodies[parent.moving_body].add(graph, &load);
            }
            joints.push(joint);
        }
        joints.reverse();
        Self { joints, frames }
    }

    pub fn respond(&self, graph: &mut Graph, excitation: &Excitation) -> Response {
        let Excitation { bias, forced, along } = excitation;
        let mut bias = bias.clone();
        for (bias, frames) in bias.iter_mut().zip(&self.frames) {
            *bias = frames.enter(graph, bias);
        }
        let mut loads = Vec::new();
        for ((joint, forced), along) in self.joints.iter().zip(forced).zip(along).rev() {
            let (own, on_parent) = joint.yield_to(graph, &bias[joint.subspace.moving_body], forced, along);
            loads.push(own);
            if let Some(parent) = joint.subspace.parent {
                bias[parent.moving_body] = bias[parent.moving_body].plus(graph, &on_parent);
            }
        }
        let mut response = Response { motions: vec![SpatialVector::ZERO; bias.len()], rates: Vec::new() };
        for ((joint, forced), loads) in self.joints.iter().zip(forced).zip(loads.iter().rev()) {
            let (motion, rates) = joint.motion(graph, forced, loads, &response.motions);
            response.motions[joint.subspace.moving_body] = motion;
            response.rates.push(rates);
        }
        for (motion, frames) in response.motions.iter_mut().zip(&self.frames) {
            *motion = frames.leave(graph, motion);
        }
        response
    }
}

/// The change of the reference point of a body's twist: `t_wanted = t_known + K ρ` with `K = ∓A s̃'`, A the frame of
/// the translations.
#[derive(Clone, Copy, Debug)]
pub struct Arm {
    k: Mat3,
    /// `KᵀK = s̃'ᵀ s̃'`: A is orthogonal.
    square: Mat3,
}

impl Arm {
    /// Known at the joint point, wanted at the mass centre.
    pub fn on_body(graph: &mut Graph, subspace: &MotionSubspace) -> Self {
        Self::new(graph, &subspace.frame, &subspace.point)
    }

    /// Known at the parent's mass centre, wanted at the joint point.
    pub fn on_parent(graph: &mut Graph, parent: &Parent) -> Self {
        let towards_centre = graph.neg_vec(&parent.point);
        Self::new(graph, &parent.frame, &towards_centre)
    }

    fn new(graph: &mut Graph, frame: &Mat3, known_from_wanted: &Vec3) -> Self {
        let tilde = graph.tilde(known_from_wanted);
        let k = graph.mat_mul(frame, &tilde);
        let square = graph.mat_mul(&transposed(&tilde), &tilde);
        Self { k, square }
    }

    pub fn twist(&self, graph: &mut Graph, known: &SpatialVector) -> SpatialVector {
        let turned = graph.mat_vec(&self.k, &known.rho);
        SpatialVector { t: graph.add_vec(&known.t, &turned), rho: known.rho }
    }

    /// A wrench at the wanted point as one at the known point.
    pub fn wrench(&self, graph: &mut Graph, wanted: &SpatialVector) -> SpatialVector {
        let moment = graph.transposed_vec(&self.k, &wanted.t);
        SpatialVector { t: wanted.t, rho: graph.add_vec(&wanted.rho, &moment) }
    }
}

impl Parent {
    /// The twist of the parent's mass centre as one of the body at the joint point.
    pub fn twist(&self, graph: &mut Graph, of_parent: &SpatialVector) -> SpatialVector {
        let arm = Arm::on_parent(graph, self);
        let at_joint = arm.twist(graph, of_parent);
        SpatialVector {
            t: graph.transposed_vec(&self.carried, &at_joint.t),
            rho: graph.transposed_vec(&self.relative, &at_joint.rho),
        }
    }

    /// A wrench on the body at the joint point as one on the parent at its mass centre.
    pub fn wrench(&self, graph: &mut Graph, on_body: &SpatialVector) -> SpatialVector {
        let turned = SpatialVector {
            t: graph.mat_vec(&self.carried, &on_body.t),
            rho: graph.mat_vec(&self.relative, &on_body.rho),
        };
        let arm = Arm::on_parent(graph, self);
        arm.wrench(graph, &turned)
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
    pub fn rigid(system: &mut System, moving_body: usize) -> Self {
        let (mass, angular) = (system.mass(moving_body), system.inertia(moving_body));
        Self { mass, linear: [ZERO3; 3], coupling: [ZERO3; 3], angular }
    }

    /// A moment of inertia about the first axis, and nothing else.
    pub fn turning(moment: ExprId) -> Self {
        let mut angular = [ZERO3; 3];
        angular[0][0] = moment;
        Self { mass: Graph::ZERO, linear: [ZERO3; 3], coupling: [ZERO3; 3], angular }
    }

    /// A rigid body in a frame that this one leads to.
    fn turned(self, graph: &mut Graph, frame: &Mat3) -> Self {
        if *frame == UNIT3 {
            return self;
        }
        // What is the same in all directions need not be turned.
        let even = self.angular[0][0];
        let evenly = UNIT3.map(|row| graph.scale_vec(even, &row));
        let rest = graph.sub_mat(&self.angular, &evenly);
        let turned = graph.mat_mul(frame, &rest);
        let turned = symmetric(&graph.mat_mul(&turned, &transposed(frame)));
        Self { angular: sum(graph, &evenly, &turned), ..self }
    }

    pub fn add(&mut self, graph: &mut Graph, other: &Self) {
        self.mass = graph.add(self.mass, other.mass);
        self.linear = sum(graph, &self.linear, &other.linear);
        self.coupling = sum(graph, &self.coupling, &other.coupling);
        self.angular = sum(graph, &self.angular, &other.angular);
    }

    /// The wrench that an acceleration takes.
    pub fn times(&self, graph: &mut Graph, acceleration: &SpatialVector) -> SpatialVector {
        let SpatialVector { t, rho } = acceleration;
        let (even, rest) = (graph.scale_vec(self.mass, t), graph.mat_vec(&self.linear, t));
        let (force, turned) = (graph.add_vec(&even, &rest), graph.mat_vec(&self.coupling, rho));
        let (moment, torque) = (graph.transposed_vec(&self.coupling, t), graph.mat_vec(&self.angular, rho));
        SpatialVector { t: graph.add_vec(&force, &turned), rho: graph.add_vec(&torque, &moment) }
    }

    /// What is left once a wrench yields: `I − u uᵀ / d`.
    pub fn less(&self, graph: &mut Graph, u: &SpatialVector, inverse: ExprId) -> Self {
        let factor = u.scaled(graph, inverse);
        Self {
            mass: self.mass,
            linear: less_product(graph, &self.linear, &factor.t, &u.t, Symmetry::Symmetric),
            coupling: less_product(graph, &self.coupling, &factor.t, &u.rho, Symmetry::None),
            angular: less_product(graph, &self.angular, &factor.rho, &u.rho, Symmetry::Symmetric),
        }
    }

    /// What the parent feels at the joint point, in its own frames.
    pub fn on_parent(&self, graph: &mut Graph, parent: &Parent) -> Self {
        let Parent { relative, carried, .. } = parent;
        let mut turned = |m: &Mat3, left: &Mat3, right: &Mat3| {
            let product = graph.mat_mul(left, m);
            graph.mat_mul(&product, &transposed(right))
        };
        Self {
            mass: self.mass,
            linear: symmetric(&turned(&self.linear, carried, carried)),
            coupling: turned(&self.coupling, carried, relative),
            angular: symmetric(&turned(&self.angular, relative, relative)),
        }
    }

    /// The same inertia in terms of the twist at an arm's known point.
    pub fn seen_through(&self, graph: &mut Graph, arm: &Arm) -> Self {
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
    pub subspace: MotionSubspace,
    /// For each free twist, in the order of elimination.
    steps: Vec<Step>,
    /// What is left, at the joint point.
    rest: Inertia,
}

/// `z = −(U · a + load) / (s · U)` with `U` the inertia times the twist s.
#[derive(Debug)]
struct Step {
    twist: SpatialVector,
    /// Which component the twist is, if it is only one: what becomes zero there is then not computed.
    component: Option<Component>,
    resistance: SpatialVector,
    inverse: ExprId,
}

impl EliminatedJoint {
    fn new(system: &mut System, subspace: MotionSubspace, bodies: &[Inertia]) -> Self {
        let graph = &mut system.graph;
        let arm = Arm::on_body(graph, &subspace);
        let mut rest = bodies[subspace.moving_body].seen_through(graph, &arm);
        let mut steps = Vec::new();
        for (k, twist) in subspace.free.iter().enumerate() {
            let resistance = rest.times(graph, twist);
            let own = twist.dot(graph, &resistance);
            let armature = subspace.armature.get(k).copied().unwrap_or(Graph::ZERO);
            let pivot = graph.add(own, armature);
            // An armature resists the twist still, once nothing else does.
            let component = Component::of(twist).filter(|_| armature == Graph::ZERO);
            let inverse = graph.recip(pivot);
            let step = Step { twist: *twist, component, resistance, inverse };
            rest = step.eliminate(graph, &rest);
            steps.push(step);
        }
        Self { subspace, steps, rest }
    }

    /// The load that each free twist yields to, and the bias that is left for the parent's mass centre.
    fn yield_to(
        &self,
        graph: &mut Graph,
        bias: &SpatialVector,
        forced: &SpatialVector,
        along: &[ExprId],
    ) -> (Vec<ExprId>, SpatialVector) {
        let arm = Arm::on_body(graph, &self.subspace);
        let mut bias = arm.wrench(graph, bias);
        let mut loads = Vec::new();
        for (k, step) in self.steps.iter().enumerate() {
            let load = step.twist.dot(graph, &bias);
            let load = graph.sub(load, along.get(k).copied().unwrap_or(Graph::ZERO));
            let share = graph.mul(load, step.inverse);
            let reaction = step.resistance.scaled(graph, share).negated(graph);
            bias = bias.plus(graph, &reaction);
            if let Some(component) = step.component {
                component.set(&mut bias, along.get(k).copied().unwrap_or(Graph::ZERO));
            }
            loads.push(load);
        }
        let Some(parent) = self.subspace.parent else { return (loads, SpatialVector::ZERO) };
        let inertial = self.rest.times(graph, forced);
        bias = bias.plus(graph, &inertial);
        (loads, parent.wrench(graph, &bias))
    }

    /// The acceleration of the body's mass centre, and that of each free twist.
    fn motion(
        &self,
        graph: &mut Graph,
        forced: &SpatialVector,
        loads: &[ExprId],
        motions: &[SpatialVector],
    ) -> (SpatialVector, Vec<ExprId>) {
        let mut motion = *forced;
        if let Some(parent) = self.subspace.parent {
            let carried = parent.twist(graph, &motions[parent.moving_body]);
            motion = motion.plus(graph, &carried);
        }
        let mut rates = Vec::new();
        for (step, load) in self.steps.iter().zip(loads).rev() {
            rates.push(step.release(graph, &mut motion, *load));
        }
        rates.reverse();
        let arm = Arm::on_body(graph, &self.subspace);
        (arm.twist(graph, &motion), rates)
    }
}

impl Step {
    /// The inertia that remains once the twist yields.
    fn eliminate(&self, graph: &mut Graph, body: &Inertia) -> Inertia {
        let mut rest = body.less(graph, &self.resistance, self.inverse);
        // Nothing resists the twist any more.
        match self.component {
            Some(Component::T(k)) => {
                (0..3).for_each(|other| {
                    (rest.linear[k][other], rest.linear[other][k]) = (Graph::ZERO, Graph::ZERO)
                });
                rest.linear[k][k] = graph.neg(body.mass);
                rest.coupling[k] = ZERO3;
            }
            Some(Component::Rho(k)) => {
                (0..3).for_each(|other| {
                    (rest.angular[k][other], rest.angular[other][k]) = (Graph::ZERO, Graph::ZERO)
                });
                rest.coupling.iter_mut().for_each(|row| row[k] = Graph::ZERO);
            }
            None => {}
        }
        rest
    }

    /// How fast the twist accelerates, yielding to the load and to the acceleration so far, to which its own is added.
    fn release(&self, graph: &mut Graph, motion: &mut SpatialVector, load: ExprId) -> ExprId {
        let own = self.component.map(|component| *component.get(motion));
        if let Some(component) = self.component {
            // It does not matter how fast the body would accelerate along a twist that is free.
            component.set(motion, Graph::ZERO);
        }
        let inertial = self.resistance.dot(graph, motion);
        let resisting = graph.add(inertial, load);
        let resisted = graph.mul(resisting, self.inverse);
        let rate = graph.neg(resisted);
        let yielded = self.twist.scaled(graph, rate);
        *motion = motion.plus(graph, &yielded);
        own.map_or(rate, |own| graph.sub(rate, own))
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

fn sum(graph: &mut Graph, a: &Mat3, b: &Mat3) -> Mat3 {
    std::array::from_fn(|row| graph.add_vec(&a[row], &b[row]))
}
