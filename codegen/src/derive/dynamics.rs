//! M, J', applied forces and energy: the rest of eq. (17).

use crate::derive::armature::Rotor;
use crate::derive::forces::Forces;
use crate::derive::joint_coordinate::Load;
use crate::derive::kinematics::Matrix;
use crate::derive::system::System;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::spatial_vector::SpatialVector;
use crate::expr::vector::{Mat3, Vec3};

/// The terms of eq. (17) that do not come from Φ.
#[derive(Debug)]
pub struct Dynamics {
    /// diag(m, m, m, J') of each moving body, by rows, and what armatures add.
    pub mass_matrix: Matrix,
    /// (f, n' − w̃'J'w') of each moving body, and what armatures take while no body accelerates.
    pub applied_force: Vec<ExprId>,
    /// Of joints.
    pub rotors: Vec<Rotor>,
    /// What acts on each body besides a uniform gravity and forces along joint coordinates.
    pub other_loads: Vec<Load>,
    /// ½ Σ (sᵀ m s + w'ᵀ J' w').
    pub kinetic: ExprId,
    /// −Σ m gᵀ r, or −Σ m μ/|r|, and what springs store.
    pub potential: ExprId,
    /// Power of the non-conservative forces.
    pub power: ExprId,
    /// The part of it that links and loads have.
    pub power_at_points: ExprId,
    /// Power fed in where forces (not constraints) act on bodies whose motion is prescribed.
    pub power_of_driven_bodies: ExprId,
}

impl Dynamics {
    /// Minus (f, n' − w̃'J'w') of a moving body.
    pub fn minus_applied_force(&self, graph: &mut Graph, moving_body: usize) -> SpatialVector {
        let force = |k: usize| self.applied_force[6 * moving_body + k];
        let applied =
            SpatialVector { t: [force(0), force(1), force(2)], rho: [force(3), force(4), force(5)] };
        applied.negated(graph)
    }

    pub fn derive(system: &mut System) -> Self {
        let n_moving_bodies = system.moving_bodies.len();
        let forces = Forces::of(system);
        let mut dynamics = Self {
            mass_matrix: vec![vec![Graph::ZERO; 6 * n_moving_bodies]; 6 * n_moving_bodies],
            applied_force: Vec::new(),
            rotors: Rotor::all(system),
            other_loads: forces.other_loads.clone(),
            kinetic: Graph::ZERO,
            potential: forces.potential,
            power: forces.power,
            power_at_points: forces.power_at_points,
            power_of_driven_bodies: forces.power_of_driven_bodies(system),
        };
        for moving_body in 0..n_moving_bodies {
            dynamics.add_body(system, moving_body, &forces.loads[system.moving_bodies[moving_body]]);
        }
        for rotor in dynamics.rotors.clone() {
            dynamics.add_rotor(system, &rotor);
        }
        dynamics
    }

    fn add_rotor(&mut self, system: &mut System, rotor: &Rotor) {
        let n_moving_bodies = system.moving_bodies.len();
        let along = (0..n_moving_bodies).flat_map(|moving_body| {
            let on = rotor.on(system, moving_body);
            on.t.into_iter().chain(on.rho)
        });
        let along: Vec<_> = along.collect();
        let graph = &mut system.graph;
        for (row, &entry) in along.iter().enumerate().filter(|(_, entry)| **entry != Graph::ZERO) {
            let scaled = graph.mul(rotor.inertia, entry);
            for (whole, &other) in self.mass_matrix[row].iter_mut().zip(&along) {
                let added = graph.mul(scaled, other);
                *whole = graph.add(*whole, added);
            }
            let taken = graph.mul(scaled, rotor.bias);
            self.applied_force[row] = graph.sub(self.applied_force[row], taken);
        }
        let (half, square) = (graph.fraction(1, 2), graph.mul(rotor.rate, rotor.rate));
        let twice = graph.mul(rotor.inertia, square);
        let own = graph.mul(half, twice);
        self.kinetic = graph.add(self.kinetic, own);
        for (&body, load) in rotor.bodies.iter().zip(&rotor.along) {
            if system.model.bodies[body].motion.is_some() {
                let (pose, acceleration) = (system.poses[body], rotor.acceleration(system));
                let graph = &mut system.graph;
                let (pushed, turned) = (graph.dot(&load.force, &pose.s), graph.dot(&load.torque, &pose.w));
                let speed = graph.add(pushed, turned);
                let taken = graph.mul(rotor.inertia, acceleration);
                let power = graph.mul(taken, speed);
                self.power_of_driven_bodies = graph.add(self.power_of_driven_bodies, power);
            }
        }
    }

    fn add_body(&mut self, system: &mut System, moving_body: usize, load: &Load) {
        let (mass, inertia) = (system.mass(moving_body), system.inertia(moving_body));
        let gravity = system.numbers(&system.model.gravity);
        let pose = system.poses[system.moving_bodies[moving_body]];
        let graph = &mut system.graph;
        for (row, inertia_row) in inertia.iter().enumerate() {
            self.mass_matrix[6 * moving_body + row][6 * moving_body + row] = mass;
            let start = 6 * moving_body + 3;
            self.mass_matrix[start + row][start..start + 3].copy_from_slice(inertia_row);
        }
        let weight = graph.scale_vec(mass, &gravity);
        let momentum = graph.mat_vec(&inertia, &pose.w);
        let gyroscopic = gyroscopic_torque(graph, &inertia, &pose.w);
        let (force, torque) = (graph.add_vec(&weight, &load.force), graph.sub_vec(&load.torque, &gyroscopic));
        self.applied_force.extend(force.into_iter().chain(torque));

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
pub fn gyroscopic_torque(graph: &mut Graph, inertia: &Mat3, w: &Vec3) -> Vec3 {
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
