//! The outputs that the model file asks for, in terms of the state, of [`Symbol::Acceleration`] and of the multipliers.

use crate::derive::attraction;
use crate::derive::between;
use crate::derive::bushings;
use crate::derive::dynamics::Dynamics;
use crate::derive::forces;
use crate::derive::in_time::in_time;
use crate::derive::joint_coordinate::Load;
use crate::derive::kinematics::Kinematics;
use crate::derive::laws::{self, OfBodies, Own};
use crate::derive::points::{self, by_axes};
use crate::derive::system::System;
use crate::expr::differentiate::Derivative;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::symbol::Symbol;
use crate::expr::vector::{Vec3, ZERO3};
use gyro_model::{BodyFrame, Formula, OutputKind, RowOwner, Seen};
use std::array::from_fn;

/// What outputs are made of besides the state.
pub struct Sources<'a> {
    pub kinematics: &'a Kinematics,
    pub dynamics: &'a Dynamics,
    /// λ of each row.
    pub lambda: &'a [ExprId],
}

/// The numbers of all outputs, one after another.
pub fn derive(system: &mut System, sources: &Sources) -> Vec<ExprId> {
    let outputs = &system.model.outputs;
    outputs.iter().flat_map(|output| numbers(system, sources, &output.kind)).collect()
}

/// Power of the drivers: `−λᵀν`, and what it takes to move bodies as prescribed against forces.
pub fn drivers_power(system: &mut System, sources: &Sources) -> ExprId {
    let mut power = sources.dynamics.power_of_driven_bodies;
    for (&lambda, &nu) in sources.lambda.iter().zip(&sources.kinematics.nu) {
        let product = system.graph.mul(lambda, nu);
        power = system.graph.sub(power, product);
    }
    power
}

/// Acceleration of a frame's origin, global, and the frame's ẇ'.
pub fn acceleration(system: &mut System, frame: &BodyFrame) -> Vec<ExprId> {
    let (linear, angular) = linear_and_angular(system, frame);
    let angular = by_axes(system, frame, angular);
    linear.into_iter().chain(angular).collect()
}

fn numbers(system: &mut System, sources: &Sources, kind: &OutputKind) -> Vec<ExprId> {
    match kind {
        OutputKind::Pose(frame) => points::pose(system, frame),
        OutputKind::Velocity(frame) => points::velocity(system, frame),
        OutputKind::Acceleration(frame) => acceleration(system, frame),
        OutputKind::Relative(relative) => between::Seen::new(system, relative.frames.each_ref()).numbers(),
        OutputKind::Inertial(frame) => {
            let (linear, _) = linear_and_angular(system, frame);
            let pose = system.poses[frame.body];
            let gravity = attraction::gravity_at(system, frame.body, &frame.point);
            let felt = system.graph.sub_vec(&linear, &gravity);
            let felt = system.graph.transposed_vec(&pose.a, &felt);
            [felt, pose.w].into_iter().flat_map(|vector| by_axes(system, frame, vector)).collect()
        }
        OutputKind::Reaction { joint } => reaction(system, sources, *joint),
        OutputKind::Driver { driver } => system
            .model
            .rows_of(RowOwner::Driver(*driver))
            .map(|row| system.graph.neg(sources.lambda[row]))
            .collect(),
        OutputKind::Coupler { coupler } => {
            // A row that was dropped has no multiplier.
            let rows = system.model.rows_of(RowOwner::Coupler(*coupler));
            vec![rows.fold(Graph::ZERO, |sum, row| system.graph.sub(sum, sources.lambda[row]))]
        }
        OutputKind::Spring { force } | OutputKind::Link { force } => forces::elastic(system, *force),
        OutputKind::State { state } => vec![system.graph.symbol(Symbol::State(*state))],
        OutputKind::Bushing { force } => bushings::told(system, *force),
        OutputKind::Formula(formula) => vec![formula_value(system, sources, formula)],
        OutputKind::Rate(formula) => vec![formula_rate(system, formula)],
        OutputKind::Energy => vec![sources.dynamics.kinetic, sources.dynamics.potential],
        OutputKind::Power => vec![sources.dynamics.power, drivers_power(system, sources)],
    }
}

/// The value of a formula, which may see other outputs.
fn formula_value(system: &mut System, sources: &Sources, formula: &Formula) -> ExprId {
    laws::value(system, formula, |system, seen| match seen {
        Seen::Output { output, number } => {
            let kind = &system.model.outputs[output].kind;
            numbers(system, sources, kind)[number]
        }
        seen => laws::see(system, &OfBodies, Own::Nothing, seen),
    })
}

/// The time derivative of a formula of positions and velocities: those change as these and the accelerations say.
fn formula_rate(system: &mut System, formula: &Formula) -> ExprId {
    let motion = system.velocities();
    let mut direction = in_time(&mut system.graph, system.model);
    direction.extend(system.direction(&motion));
    for moving_body in 0..motion.len() {
        for k in 0..3 {
            let [linear, angular] =
                [k, 3 + k].map(|k| system.graph.symbol(Symbol::Acceleration { moving_body, k }));
            direction.insert(Symbol::Velocity { moving_body, k }, linear);
            direction.insert(Symbol::Spin { moving_body, k }, angular);
        }
    }
    let change = |system: &mut System, _, number| {
        Derivative::new(&system.definitions, direction.clone()).of(&mut system.graph, number)
    };
    laws::with_derivative(system, formula, &OfBodies, change).1
}

/// Acceleration of a point, global frame, `r̈ = s̈ + A (ẇ' × c + w' × (w' × c))`, and ẇ'.
fn linear_and_angular(system: &mut System, frame: &BodyFrame) -> (Vec3, Vec3) {
    let (body, point) = (frame.body, system.numbers(&frame.point));
    let pose = system.poses[body];
    let (linear, angular) = match system.moving_body_of(body) {
        Some(moving_body) => {
            let mut component = |k| system.graph.symbol(Symbol::Acceleration { moving_body, k });
            (from_fn(&mut component), from_fn(|k| component(3 + k)))
        }
        None => (time_derivative(system, &pose.s), time_derivative(system, &pose.w)),
    };
    let graph = &mut system.graph;
    let (tangential, speed) = (graph.cross(&angular, &point), graph.cross(&pose.w, &point));
    let centripetal = graph.cross(&pose.w, &speed);
    let relative = graph.add_vec(&tangential, &centripetal);
    let relative = graph.mat_vec(&pose.a, &relative);
    (graph.add_vec(&linear, &relative), angular)
}

pub fn time_derivative(system: &mut System, vector: &Vec3) -> Vec3 {
    let time = in_time(&mut system.graph, system.model);
    let mut derivative = Derivative::new(&system.definitions, time);
    vector.map(|x| derivative.of(&mut system.graph, x))
}

/// Force and torque of the joint's rows on its second body, at its joint point, in the first body's joint frame.
fn reaction(system: &mut System, sources: &Sources, index: usize) -> Vec<ExprId> {
    let joint = system.joints[index];
    let (i, j) = (joint.first.body, joint.second.body);
    let (a_i, pose_j) = (system.poses[i].a, system.poses[j]);
    let arm = system.graph.mat_vec(&pose_j.a, &joint.second.point);
    let point = system.graph.add_vec(&pose_j.r, &arm);
    // Without coordinates of the second body: the opposite of what acts on the first.
    let (body, sign) = if system.moving_body_of(j).is_some() { (j, -1) } else { (i, 1) };
    let taken = taken(system, sources, index, body);
    let sign = system.graph.integer(sign);
    let from_point = system.graph.sub_vec(&system.poses[body].r, &point);
    let graph = &mut system.graph;
    let (torque, moment) =
        (graph.mat_vec(&system.poses[body].a, &taken.torque), graph.cross(&from_point, &taken.force));
    let torque = graph.add_vec(&torque, &moment);
    let frame = [joint.first.f, joint.first.g, joint.first.h].map(|u| graph.mat_vec(&a_i, &u));
    let supplied = [taken.force, torque].map(|v| graph.scale_vec(sign, &v));
    supplied.iter().flat_map(|v| frame.map(|u| graph.dot(&u, v))).collect()
}

/// `Φ_rᵀλ` and `Φ_π'ᵀλ` of a joint's rows for one body; nothing of a body without coordinates.
fn taken(system: &mut System, sources: &Sources, joint: usize, body: usize) -> Load {
    let mut taken = Load { force: ZERO3, torque: ZERO3 };
    let Some(moving_body) = system.moving_body_of(body) else { return taken };
    for row in system.model.rows_of(RowOwner::Joint(joint)) {
        let column = |k: usize| sources.kinematics.phi_pi[row][6 * moving_body + k];
        let (by_r, by_pi): (Vec3, Vec3) = (from_fn(column), from_fn(|k| column(3 + k)));
        let graph = &mut system.graph;
        let (force, torque) =
            (graph.scale_vec(sources.lambda[row], &by_r), graph.scale_vec(sources.lambda[row], &by_pi));
        taken.force = graph.add_vec(&taken.force, &force);
        taken.torque = graph.add_vec(&taken.torque, &torque);
    }
    taken
}
