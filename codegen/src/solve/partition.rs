//! The coordinate partition of a tree, unrolled: charts, one Newton step of the dependent positions, and the solve of
//! eq. (19) for the dependent velocities.
//!
//! Both solves are block-triangular from root to leaf: once a body's parent is corrected, the body's own joint rows
//! determine its dependent coordinates. The Jacobian of a block is the body's part of Φ_π', derived once and evaluated
//! at the corrected parent and the body's own unit p by expansion. Of a revolute joint one Euler parameter is
//! independent, so a third row holds it; of a spherical joint or a free body three are, so the fourth follows from the
//! normalisation. The independent velocity of a revolute joint is the rate about its axis: holding a component of ṗ
//! instead would let the parent's drift leak into a spin.

use crate::derive::kinematics::Kinematics;
use crate::derive::system::System;
use crate::expr::definitions::{Expansion, Values};
use crate::expr::graph::{ExprId, Graph};
use crate::expr::symbol::Symbol;
use crate::expr::vector::{Mat3, Vec3, Vec4, ZERO3};
use crate::solve::motion_subspace::{MotionSubspace, right_inverse};
use gyro_model::{Attachment, JointKind, Link};
use std::array::from_fn;

/// What `gyro_sim::Partition` asks of a generated tree.
#[derive(Debug)]
pub struct Partition {
    /// For each chart the vector whose largest component is the special Euler parameter: see `gyro_sim::charts`.
    pub chart_vectors: Vec<Vec4>,
    /// Positions (r, p) of each moving body after one Newton step.
    pub positions: Vec<ExprId>,
    /// Velocities (s, w') of each moving body that satisfy eq. (19).
    pub velocities: Vec<ExprId>,
}

impl Partition {
    /// None where charts do not cover the mechanism.
    pub fn of(system: &mut System, kinematics: &Kinematics) -> Option<Self> {
        Self::covers(system).then(|| Self::derive(system, kinematics))
    }

    /// Whether charts cover the mechanism: trees of revolute, spherical and fixed joints, and nothing that closes a
    /// loop.
    pub fn covers(system: &System) -> bool {
        let covered = |attachment: Attachment| match attachment {
            Attachment::Free | Attachment::Constrained => true,
            Attachment::Joint { joint, .. } => {
                matches!(
                    system.joints[joint].kind,
                    JointKind::Revolute | JointKind::Spherical | JointKind::Fixed
                )
            }
        };
        system.tree.links.iter().all(|link| covered(link.attachment)) && system.loop_closure_rows().is_empty()
    }

    fn derive(system: &mut System, kinematics: &Kinematics) -> Self {
        let links = system.tree.links.clone();
        let mut blocks = Vec::new();
        for link in links {
            blocks.push(Block::new(system, kinematics, link, blocks.len()));
        }
        let n_moving_bodies = system.moving_bodies.len();
        let (mut positions, mut velocities) = (Values::default(), Values::default());
        for block in &blocks {
            block.correct_positions(system, kinematics, &mut positions);
            block.solve_velocities(system, kinematics, &mut velocities);
        }
        let position = |moving_body, k| {
            if k < 3 { Symbol::Position { moving_body, k } } else { Symbol::Euler { moving_body, k: k - 3 } }
        };
        let velocity = |moving_body, k| {
            if k < 3 { Symbol::Velocity { moving_body, k } } else { Symbol::Spin { moving_body, k: k - 3 } }
        };
        let charted = blocks.iter().filter(|block| block.chart.is_some());
        Self {
            chart_vectors: charted.map(|block| block.chart_vector(system)).collect(),
            positions: (0..7 * n_moving_bodies).map(|k| positions[&position(k / 7, k % 7)]).collect(),
            velocities: (0..6 * n_moving_bodies).map(|k| velocities[&velocity(k / 6, k % 6)]).collect(),
        }
    }
}

/// One body with what holds it.
#[derive(Debug)]
struct Block {
    moving_body: usize,
    attachment: Attachment,
    subspace: MotionSubspace,
    /// The chart, as symbols.
    chart: Option<Vec4>,
}

impl Block {
    fn new(system: &mut System, kinematics: &Kinematics, link: Link, index: usize) -> Self {
        let subspace = MotionSubspace::of(system, kinematics, link);
        let earlier = &system.tree.links[..index];
        let chart = earlier.iter().filter(|l| needs_chart(system, l.attachment)).count();
        let graph = &mut system.graph;
        let symbols = from_fn(|k| graph.symbol(Symbol::Chart { chart, k }));
        Self {
            moving_body: subspace.moving_body,
            attachment: link.attachment,
            subspace,
            chart: needs_chart(system, link.attachment).then_some(symbols),
        }
    }

    fn joint_kind(&self, system: &System) -> Option<JointKind> {
        match self.attachment {
            Attachment::Joint { joint, .. } => Some(system.joints[joint].kind),
            Attachment::Free | Attachment::Constrained => None,
        }
    }

    /// Revolute: the tangent G(p)ᵀ h'; otherwise the normal p.
    fn chart_vector(&self, system: &mut System) -> Vec4 {
        let p = system.poses[system.moving_bodies[self.moving_body]].p;
        match (self.attachment, self.joint_kind(system)) {
            (Attachment::Joint { joint, reversed, .. }, Some(JointKind::Revolute)) => {
                let frames = system.joints[joint];
                let axis = if reversed { frames.first.h } else { frames.second.h };
                let g = system.graph.g_matrix(&p);
                from_fn(|k| system.graph.dot(&[g[0][k], g[1][k], g[2][k]], &axis))
            }
            _ => p,
        }
    }

    /// One Newton step: adds this body's corrected r and p to those of the bodies nearer to the root.
    fn correct_positions(&self, system: &mut System, kinematics: &Kinematics, corrected: &mut Values) {
        let moving_body = self.moving_body;
        let pose = system.poses[system.moving_bodies[moving_body]];
        let (r, p) = match (self.attachment, self.joint_kind(system)) {
            (Attachment::Constrained, _) => {
                let given = system.fixed_pose(system.moving_bodies[moving_body]);
                (given.r, given.p)
            }
            (_, Some(JointKind::Revolute | JointKind::Fixed)) => {
                (ZERO3, self.correct_rotation(system, kinematics, corrected))
            }
            _ => {
                let chart = self.chart.expect("free and spherical orientations have a chart");
                let r = if self.subspace.rows.is_empty() { pose.r } else { ZERO3 };
                (r, normalise_along(&mut system.graph, &pose.p, &chart))
            }
        };
        corrected.extend((0..4).map(|k| (Symbol::Euler { moving_body, k }, p[k])));
        corrected.extend((0..3).map(|k| (Symbol::Position { moving_body, k }, r[k])));
        if !self.subspace.rows.is_empty() {
            // The point rows are r plus or minus a rotation's arm: with p corrected they give r in closed form.
            let residual = self.point_rows(system, &kinematics.phi, corrected);
            let r = system.graph.sub_vec(&r, &residual);
            corrected.extend((0..3).map(|k| (Symbol::Position { moving_body, k }, r[k])));
        }
    }

    /// The body's corrected p from its dot-1 rows and its chart.
    fn correct_rotation(&self, system: &mut System, kinematics: &Kinematics, corrected: &Values) -> Vec4 {
        let p = system.poses[system.moving_bodies[self.moving_body]].p;
        let unit = unit_step(&mut system.graph, &p);
        let mut values = corrected.clone();
        values.extend((0..4).map(|k| (Symbol::Euler { moving_body: self.moving_body, k }, unit[k])));
        let (mut jacobian, mut residuals) = (Vec::new(), Vec::new());
        let mut expansion = Expansion::with_values(&system.definitions, values);
        for row in self.subspace.rows.clone().skip(3) {
            jacobian
                .push(kinematics.rotation(row, self.moving_body).map(|e| expansion.of(&mut system.graph, e)));
            residuals.push(expansion.of(&mut system.graph, kinematics.phi[row]));
        }
        let graph = &mut system.graph;
        let mut rhs: Vec<_> = residuals.iter().map(|&phi| graph.neg(phi)).collect();
        if let Some(chart) = self.chart {
            // The special Euler parameter keeps the value that it has in p, not in the unit p.
            jacobian.push(chart_row(graph, &unit, &chart));
            let gained = graph.sub_vec(&p, &unit);
            rhs.push(graph.dot(&chart, &gained));
        }
        let rotation = graph.solve3(&as_mat3(&jacobian), &as_vec3(&rhs));
        let change = graph.euler_rate(&unit, &rotation);
        graph.add_vec(&unit, &change)
    }

    /// Adds this body's s and w' to those of the bodies nearer to the root.
    fn solve_velocities(&self, system: &mut System, kinematics: &Kinematics, solved: &mut Values) {
        let moving_body = self.moving_body;
        let w = self.solve_spin(system, kinematics, solved);
        solved.extend((0..3).map(|k| (Symbol::Spin { moving_body, k }, w[k])));
        let s = match self.attachment {
            Attachment::Free => system.poses[system.moving_bodies[moving_body]].s,
            Attachment::Constrained | Attachment::Joint { .. } => ZERO3,
        };
        solved.extend((0..3).map(|k| (Symbol::Velocity { moving_body, k }, s[k])));
        if !self.subspace.rows.is_empty() {
            let residual = self.point_rows(system, &kinematics.velocity_residual, solved);
            let s = system.graph.sub_vec(&s, &residual);
            solved.extend((0..3).map(|k| (Symbol::Velocity { moving_body, k }, s[k])));
        }
    }

    fn solve_spin(&self, system: &mut System, kinematics: &Kinematics, solved: &Values) -> Vec3 {
        match (self.attachment, self.joint_kind(system)) {
            (Attachment::Constrained, _) => ZERO3,
            (_, Some(JointKind::Revolute | JointKind::Fixed)) => {
                self.constrained_spin(system, kinematics, solved)
            }
            // Three components of ṗ are independent, and pᵀṗ = 0 holds for every w': it keeps its integrated value.
            _ => system.poses[system.moving_bodies[self.moving_body]].w,
        }
    }

    /// w' changed so that the body's dot-1 rows hold. What is solved for is the change, across the free axis: the rate
    /// about that axis is the independent velocity, and a large spin takes no part in the rounding.
    fn constrained_spin(&self, system: &mut System, kinematics: &Kinematics, solved: &Values) -> Vec3 {
        let directions = self.directions(system, kinematics);
        let mut expansion = Expansion::at(&system.definitions, solved);
        let mut w = system.poses[system.moving_bodies[self.moving_body]].w;
        for (row, direction) in self.subspace.rows.clone().skip(3).zip(directions) {
            let residual = expansion.of(&mut system.graph, kinematics.velocity_residual[row]);
            let direction = direction.map(|e| expansion.of(&mut system.graph, e));
            let change = system.graph.scale_vec(residual, &direction);
            w = system.graph.sub_vec(&w, &change);
        }
        w
    }

    /// For each dot-1 row the rotation that changes it alone and is across the body's own axis. That of the null space
    /// is across the second body's: off the constraints another one, if it is the first body that hangs on the joint.
    fn directions(&self, system: &mut System, kinematics: &Kinematics) -> Vec<Vec3> {
        match (self.attachment, self.joint_kind(system)) {
            (Attachment::Joint { joint, reversed: true, .. }, Some(JointKind::Revolute)) => {
                let rows = self.subspace.rows.clone().skip(3);
                let gradients: Vec<_> = rows.map(|row| kinematics.rotation(row, self.moving_body)).collect();
                right_inverse(&mut system.graph, &gradients, &[system.joints[joint].first.h])
            }
            _ => self.subspace.forced.iter().skip(3).map(|forced| forced.rho).collect(),
        }
    }

    /// The joint's point rows of Φ or Φ̇ at the given values, with the sign that this body's own r or s has in them.
    fn point_rows(&self, system: &mut System, rows: &[ExprId], values: &Values) -> Vec3 {
        let mut expansion = Expansion::at(&system.definitions, values);
        let rows = from_fn(|k| expansion.of(&mut system.graph, rows[self.subspace.rows.start + k]));
        let reversed = matches!(self.attachment, Attachment::Joint { reversed: true, .. });
        if reversed { system.graph.neg_vec(&rows) } else { rows }
    }
}

/// One Newton step of pᵀp = 1 along p itself, to first order: `p (3 − pᵀp) / 2`.
fn unit_step(graph: &mut Graph, p: &Vec4) -> Vec4 {
    let square = graph.dot(p, p);
    let (three, half) = (graph.integer(3), graph.fraction(1, 2));
    let difference = graph.sub(three, square);
    let factor = graph.mul(half, difference);
    graph.scale_vec(factor, p)
}

/// One Newton step of pᵀp = 1 in the special Euler parameter alone.
fn normalise_along(graph: &mut Graph, p: &Vec4, chart: &Vec4) -> Vec4 {
    let (square, special) = (graph.dot(p, p), graph.dot(p, chart));
    let (residual, two) = (graph.sub(Graph::ONE, square), graph.integer(2));
    let slope = graph.mul(two, special);
    let step = graph.div(residual, slope);
    let change = graph.scale_vec(step, chart);
    graph.add_vec(p, &change)
}

/// The special component of `½ Gᵀ π'` as a row in π'.
fn chart_row(graph: &mut Graph, p: &Vec4, chart: &Vec4) -> Vec3 {
    let (g, half) = (graph.g_matrix(p), graph.fraction(1, 2));
    g.map(|row| {
        let component = graph.dot(&row, chart);
        graph.mul(half, component)
    })
}

fn as_mat3(rows: &[Vec3]) -> Mat3 {
    rows.try_into().expect("dot-1 rows and chart make three rows")
}

fn as_vec3(rows: &[ExprId]) -> Vec3 {
    rows.try_into().expect("dot-1 rows and chart make three rows")
}

/// Whether a moving body's attachment leaves its orientation partly free, so that it needs a chart.
fn needs_chart(system: &System, attachment: Attachment) -> bool {
    match attachment {
        Attachment::Free => true,
        Attachment::Constrained => false,
        Attachment::Joint { joint, .. } => system.joints[joint].kind != JointKind::Fixed,
    }
}
