//! M, J', applied forces and energy: the rest of eq. (17).

use crate::constraints::dot1;
use crate::graph::{ExprId, Graph};
use crate::kinematics::Matrix;
use crate::linear::{Mat3, Vec3, ZERO3};
use crate::system::{JointFrames, System};
use gyro_model::{Attachment, JointKind};

/// The terms of eq. (17) that do not come from Φ.
#[derive(Debug)]
pub struct Dynamics {
    /// diag(m, m, m, J') of each slot, by rows.
    pub mass_matrix: Matrix,
    /// (f, n' − w̃'J'w') of each slot.
    pub applied_force: Vec<ExprId>,
    /// ½ Σ (sᵀ m s + w'ᵀ J' w').
    pub kinetic: ExprId,
    /// −Σ m gᵀ r.
    pub potential: ExprId,
    /// Power of the non-conservative forces.
    pub power: ExprId,
}

impl Dynamics {
    pub fn derive(system: &mut System) -> Self {
        let n_slots = system.slots.len();
        let (torques, power) = friction(system);
        let mut dynamics = Self {
            mass_matrix: vec![vec![Graph::ZERO; 6 * n_slots]; 6 * n_slots],
            applied_force: Vec::new(),
            kinetic: Graph::ZERO,
            potential: Graph::ZERO,
            power,
        };
        for (slot, torque) in torques.iter().enumerate() {
            dynamics.add_body(system, slot, torque);
        }
        dynamics
    }

    fn add_body(&mut self, system: &mut System, slot: usize, torque: &Vec3) {
        let (mass, inertia) = (system.mass(slot), system.inertia(slot));
        let gravity = system.numbers(&system.model.gravity);
        let pose = system.poses[system.slots[slot]];
        let graph = &mut system.graph;
        for (row, inertia_row) in inertia.iter().enumerate() {
            self.mass_matrix[6 * slot + row][6 * slot + row] = mass;
            let start = 6 * slot + 3;
            self.mass_matrix[start + row][start..start + 3].copy_from_slice(inertia_row);
        }
        let weight = graph.scale_vec(mass, &gravity);
        let momentum = graph.mat_vec(&inertia, &pose.w);
        let gyroscopic = gyroscopic_torque(graph, &inertia, &pose.w);
        let torque = graph.sub_vec(torque, &gyroscopic);
        self.applied_force.extend(weight.into_iter().chain(torque));

        let (square, spin) = (graph.dot(&pose.s, &pose.s), graph.dot(&pose.w, &momentum));
        let translation = graph.mul(mass, square);
        let twice = graph.add(translation, spin);
        let half = graph.fraction(1, 2);
        let kinetic = graph.mul(half, twice);
        self.kinetic = graph.add(self.kinetic, kinetic);
        let height = graph.dot(&weight, &pose.r);
        self.potential = graph.sub(self.potential, height);
    }
}

/// `w̃'J'w'`, collected in products of components so that equal moments of inertia cancel exactly.
fn gyroscopic_torque(graph: &mut Graph, inertia: &Mat3, w: &Vec3) -> Vec3 {
    // Component i of w × (J w) is Σ_k w_j w_k J_lk − w_l w_k J_jk with (i, j, l) cyclic.
    std::array::from_fn(|i| {
        let (j, l) = ((i + 1) % 3, (i + 2) % 3);
        let difference = graph.sub(inertia[l][l], inertia[j][j]);
        let product = graph.mul(w[j], w[l]);
        let diagonal = graph.mul(difference, product);
        let (square_j, square_l) = (graph.mul(w[j], w[j]), graph.mul(w[l], w[l]));
        let squares = graph.sub(square_j, square_l);
        let skew = graph.mul(inertia[j][l], squares);
        let (from_j, from_l) = (graph.mul(w[j], inertia[l][i]), graph.mul(w[l], inertia[j][i]));
        let mixed = graph.sub(from_j, from_l);
        let mixed = graph.mul(w[i], mixed);
        let sum = graph.add(diagonal, skew);
        graph.add(sum, mixed)
    })
}

/// Torque on each slot, in its own frame, and power of the viscous friction in the joints.
fn friction(system: &mut System) -> (Vec<Vec3>, ExprId) {
    let mut torques = vec![ZERO3; system.slots.len()];
    let mut power = Graph::ZERO;
    for index in 0..system.joints.len() {
        let coefficient = system.number(&system.model.joints[index].friction);
        let joint = system.joints[index];
        let (on_first, on_second, rates) = match joint.kind {
            JointKind::Revolute => {
                let rate = revolute_rate(system, &joint);
                let graph = &mut system.graph;
                (graph.scale_vec(rate, &joint.first.h), graph.scale_vec(rate, &joint.second.h), vec![rate])
            }
            JointKind::Spherical => {
                let rate = relative_spin(system, &joint);
                (system.graph.mat_vec(&joint.relative, &rate), rate, rate.to_vec())
            }
            JointKind::Fixed => continue,
        };
        let resistance = system.graph.neg(coefficient);
        apply(system, &mut torques, joint.first.body, coefficient, &on_first);
        apply(system, &mut torques, joint.second.body, resistance, &on_second);
        for rate in rates {
            let square = system.graph.mul(rate, rate);
            let loss = system.graph.mul(resistance, square);
            power = system.graph.add(power, loss);
        }
    }
    (torques, power)
}

fn apply(system: &mut System, torques: &mut [Vec3], body: usize, factor: ExprId, direction: &Vec3) {
    if let Some(slot) = system.slot_of(body) {
        let torque = system.graph.scale_vec(factor, direction);
        torques[slot] = system.graph.add_vec(&torques[slot], &torque);
    }
}

/// Rate of a revolute joint: each body's spin along its own axis.
fn revolute_rate(system: &mut System, joint: &JointFrames) -> ExprId {
    let (w_i, w_j) = (system.poses[joint.first.body].w, system.poses[joint.second.body].w);
    let (rate_i, rate_j) = (system.graph.dot(&joint.first.h, &w_i), system.graph.dot(&joint.second.h, &w_j));
    system.graph.sub(rate_j, rate_i)
}

/// `w'_j − A_jᵀA_i w'_i`: the second body's angular velocity relative to the first, in the second body's frame.
fn relative_spin(system: &mut System, joint: &JointFrames) -> Vec3 {
    let (w_i, w_j) = (system.poses[joint.first.body].w, system.poses[joint.second.body].w);
    let carried = system.graph.transposed_vec(&joint.relative, &w_i);
    system.graph.sub_vec(&w_j, &carried)
}

/// The raw readings of all joints: see `gyro_sim::Coordinate`.
pub fn readings(system: &mut System) -> Vec<ExprId> {
    let mut readings = Vec::new();
    for joint in system.joints.clone() {
        let (i, j) = (&joint.first, &joint.second);
        match joint.kind {
            JointKind::Revolute => {
                let a = &direction_rotation(system, &joint);
                readings.push(dot1(&mut system.graph, &i.g, a, &j.f));
                readings.push(dot1(&mut system.graph, &i.f, a, &j.f));
                readings.push(revolute_rate(system, &joint));
            }
            JointKind::Spherical => {
                readings.extend(relative_euler(system, &joint));
                readings.extend(relative_spin(system, &joint));
            }
            JointKind::Fixed => {}
        }
    }
    readings
}

/// `A_iᵀ A_j` times |p_i|² |p_j|²: a rotation in direction whatever the length of p, which direct integration loses. Only the
/// ratio of an angle's sine and cosine matters.
fn direction_rotation(system: &mut System, joint: &JointFrames) -> Mat3 {
    let homogeneous = |system: &mut System, body: usize| match system.slot_of(body) {
        Some(_) => system.graph.homogeneous_rotation(&system.poses[body].p),
        None => system.poses[body].a,
    };
    let (a_i, a_j) = (homogeneous(system, joint.first.body), homogeneous(system, joint.second.body));
    let columns = |m: Mat3| [0, 1, 2].map(|column| m.map(|row| row[column]));
    let (columns_i, columns_j) = (columns(a_i), columns(a_j));
    columns_i.map(|u| columns_j.map(|v| system.graph.dot(&u, &v)))
}

/// `p_i* p_j`: scalar part p_iᵀp_j, vector part G(p_i) p_j.
fn relative_euler(system: &mut System, joint: &JointFrames) -> Vec<ExprId> {
    let (p_i, p_j) = (system.poses[joint.first.body].p, system.poses[joint.second.body].p);
    let g = system.graph.g_matrix(&p_i);
    let scalar = system.graph.dot(&p_i, &p_j);
    std::iter::once(scalar).chain(g.map(|row| system.graph.dot(&row, &p_j))).collect()
}

/// Whether a slot's attachment leaves its orientation partly free, so that it needs a chart.
pub fn needs_chart(system: &System, attachment: Attachment) -> bool {
    match attachment {
        Attachment::Free => true,
        Attachment::Constrained => false,
        Attachment::Joint { joint, .. } => system.joints[joint].kind != JointKind::Fixed,
    }
}
