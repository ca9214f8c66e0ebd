//! Φ(q, t): the textbook primitives and the joints made of them. Nothing else of a joint is written anywhere: Φ_q, ν
//! and γ are derived from these rows. Rows of velocities, of which Φ counts as zero, are Ψ(q) q̇.

use crate::derive::frames::{JointFrames, dot1, sine_and_cosine};
use crate::derive::joint_coordinate;
use crate::derive::laws::{self, OfBodies, Own, Readings};
use crate::derive::system::System;
use crate::expr::differentiate::{Derivative, Direction, angle_rate};
use crate::expr::graph::{ExprId, Graph};
use crate::expr::vector::Vec3;
use gyro_model::{Coupler, Coupling, Formula, JointCoordinate, JointKind, PointAxes, RowOwner, Support};

/// The rows of `Model::rows`, in their order.
pub fn rows(system: &mut System) -> Vec<ExprId> {
    let mut rows = Vec::new();
    for moving_body in 0..system.moving_bodies.len() {
        if system.model.bodies[system.moving_bodies[moving_body]].support == Support::Constrained {
            rows.extend(held(system, moving_body));
        }
    }
    for joint in 0..system.joints.len() {
        rows.extend(joint_rows(system, joint));
    }
    for coupler in &system.model.couplers {
        rows.push(coupled(system, coupler));
    }
    for driver in &system.model.drivers {
        let (coordinate, motion) =
            (joint_coordinate::value(system, driver.coordinate), system.prescribed(&driver.motion));
        rows.push(system.graph.sub(coordinate, motion));
    }
    let (all, kept) = (system.model.all_rows(), system.model.rows());
    all.iter().zip(rows).filter(|(row, _)| kept.contains(row)).map(|(_, phi)| phi).collect()
}

/// The rows of velocities, by their places among the rows.
pub fn of_velocities(system: &mut System, readings: &impl Readings) -> Vec<(usize, ExprId)> {
    let mut rows = Vec::new();
    for (index, coupler) in system.model.couplers.iter().enumerate() {
        let row = system.model.rows_of(RowOwner::Coupler(index)).next();
        if let (Some(formula), Some(row)) = (coupler.rate(), row) {
            rows.push((row, seen(system, readings, formula)));
        }
    }
    rows
}

/// Joint coordinates of bodies with the derivatives of what they are along a direction, on the constraints and off
/// them.
pub struct Along(pub Direction);

impl Readings for Along {
    fn value(&self, system: &mut System, on: JointCoordinate) -> ExprId {
        joint_coordinate::value(system, on)
    }

    fn rate(&self, system: &mut System, on: JointCoordinate) -> ExprId {
        let (joint, kind) = (system.joints[on.joint], system.model.coordinate_kind(on));
        if !kind.is_angle() {
            let value = joint_coordinate::value(system, on);
            return Derivative::new(&system.definitions, self.0.clone()).of(&mut system.graph, value);
        }
        let (sine, cosine) = sine_and_cosine(&mut system.graph, kind, &joint, &joint.relative);
        let mut derivative = Derivative::new(&system.definitions, self.0.clone());
        let rates = [sine, cosine].map(|part| derivative.of(&mut system.graph, part));
        angle_rate(&mut system.graph, (sine, cosine), rates.into())
    }
}

fn seen(system: &mut System, readings: &impl Readings, formula: &Formula) -> ExprId {
    laws::value(system, formula, |system, seen| laws::see(system, readings, Own::Nothing, seen))
}

/// The rows of a joint, redundant ones included.
fn joint_rows(system: &mut System, index: usize) -> Vec<ExprId> {
    let joint = system.joints[index];
    let (i, j) = (&joint.first, &joint.second);
    let aligned = [(i.f, j.h), (i.g, j.h), (i.f, j.g)];
    let (mut rows, dots) = match joint.kind {
        JointKind::Revolute => (coincident(system, index), &aligned[..2]),
        JointKind::Spherical => (coincident(system, index), &aligned[..0]),
        JointKind::Fixed => (coincident(system, index), &aligned[..]),
        JointKind::Universal => (coincident(system, index), &[(i.h, j.h)][..]),
        JointKind::Cylindrical => (dot2(system, &joint, &[i.f, i.g]), &aligned[..2]),
        JointKind::Prismatic => (dot2(system, &joint, &[i.f, i.g]), &aligned[..]),
        JointKind::Planar => (dot2(system, &joint, &[i.h]), &aligned[..2]),
        JointKind::PointOnLine => (dot2(system, &joint, &[i.f, i.g]), &aligned[..0]),
        JointKind::Screw => (screw(system, index), &aligned[..2]),
        JointKind::Rod => (vec![distance(system, &joint)], &aligned[..0]),
    };
    rows.extend(dots.iter().map(|(a, b)| dot1(&mut system.graph, a, &joint.relative, b)));
    rows
}

/// `second − ratio · first − offset`, the second coordinate less a formula of others, or a formula that is zero.
fn coupled(system: &mut System, coupler: &Coupler) -> ExprId {
    let value = |system: &mut System| {
        coupler.second.map_or(Graph::ZERO, |second| joint_coordinate::value(system, second))
    };
    let (first, ratio, offset) = match &coupler.by {
        Coupling::Linear { first, ratio, offset } => (*first, ratio, offset),
        Coupling::Formula(formula) => {
            let second = value(system);
            let wanted = seen(system, &OfBodies, formula);
            return system.graph.sub(second, wanted);
        }
        Coupling::Zero(formula) => return seen(system, &OfBodies, formula),
        Coupling::Rate(_) => return Graph::ZERO,
    };
    let (first, second) = (joint_coordinate::value(system, first), value(system));
    let [ratio, offset] = [ratio, offset].map(|number| system.number(number));
    let driven = system.graph.mul(ratio, first);
    let lag = system.graph.sub(second, driven);
    system.graph.sub(lag, offset)
}

/// `pᵀp − 1` of each moving body, eq. (12).
pub fn normalisations(system: &mut System) -> Vec<ExprId> {
    let one = Graph::ONE;
    let euler: Vec<_> = system.moving_bodies.iter().map(|&body| system.poses[body].p).collect();
    euler
        .iter()
        .map(|p| {
            let square = system.graph.dot(p, p);
            system.graph.sub(square, one)
        })
        .collect()
}

/// A body held where it is given: `r − r0` and the vector part of `p0* p`, eqs. (5) and (6).
fn held(system: &mut System, moving_body: usize) -> Vec<ExprId> {
    let body = system.moving_bodies[moving_body];
    let (pose, given) = (system.poses[body], system.fixed_pose(body));
    let position = system.graph.sub_vec(&pose.r, &given.r);
    // G(p0) p is the vector part of p0* p.
    let g = system.graph.g_matrix(&given.p);
    let orientation = g.map(|row| system.graph.dot(&row, &pose.p));
    position.into_iter().chain(orientation).collect()
}

/// Points that coincide: eq. (7), along global axes or along those of the first body's joint frame.
fn coincident(system: &mut System, index: usize) -> Vec<ExprId> {
    let joint = system.joints[index];
    match system.model.point_axes(index) {
        PointAxes::Global => joint_coordinate::between_points(system, &joint).to_vec(),
        PointAxes::FirstBody => dot2(system, &joint, &[joint.first.f, joint.first.g, joint.first.h]),
    }
}

/// `(A_i u')·d` for directions of the first body: Haug (1989), section 9.4, dot-2.
fn dot2(system: &mut System, joint: &JointFrames, directions: &[Vec3]) -> Vec<ExprId> {
    directions.iter().map(|u| joint_coordinate::displacement(system, joint, u)).collect()
}

/// Across the axis nothing, along it as far as the angle says.
fn screw(system: &mut System, index: usize) -> Vec<ExprId> {
    let joint = system.joints[index];
    let mut rows = dot2(system, &joint, &[joint.first.f, joint.first.g, joint.first.h]);
    let angle = joint_coordinate::value(system, JointCoordinate { joint: index, coordinate: 0 });
    let advance = system.graph.mul(joint.lead, angle);
    rows[2] = system.graph.sub(rows[2], advance);
    rows
}

/// `½ (d·d / length − length)`: a distance, to first order.
fn distance(system: &mut System, joint: &JointFrames) -> ExprId {
    let d = joint_coordinate::between_points(system, joint);
    let graph = &mut system.graph;
    let square = graph.dot(&d, &d);
    let quotient = graph.div(square, joint.length);
    let difference = graph.sub(quotient, joint.length);
    let half = graph.fraction(1, 2);
    graph.mul(half, difference)
}
