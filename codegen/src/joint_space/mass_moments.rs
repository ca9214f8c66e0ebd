//! How mass is distributed over a body, and what of it a joint cannot tell from mass of the body that carries it: base
//! inertial parameters (M. Gautier and W. Khalil, *Direct calculation of minimum set of inertial parameters of serial
//! robots*, IEEE Transactions on Robotics and Automation 6 (1990); W. Khalil and J.-F. Kleinfinger, *Minimum operations
//! and minimum parameters of the dynamic models of tree structure robots*, IEEE Journal of Robotics and Automation 3
//! (1987)).

use super::screw_moves::Move;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::spatial_vector::SpatialVector;
use crate::expr::vector::{Mat3, UNIT3, Vec3, ZERO3};

/// Moments of the mass of a body about the origin of its frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MassMoments {
    pub mass: ExprId,
    /// `∫ r dm`.
    pub first: Vec3,
    /// `∫ r rᵀ dm`.
    pub second: Mat3,
}

impl MassMoments {
    pub const NONE: Self = Self { mass: Graph::ZERO, first: ZERO3, second: [ZERO3; 3] };

    /// About the mass centre.
    pub fn of_body(graph: &mut Graph, mass: ExprId, inertia: &Mat3) -> Self {
        let half = graph.fraction(1, 2);
        let (trace, mut second) = (graph.add(inertia[0][0], inertia[1][1]), *inertia);
        let trace = graph.add(trace, inertia[2][2]);
        let half_trace = graph.mul(half, trace);
        for row in 0..3 {
            for column in 0..3 {
                let diagonal = if row == column { half_trace } else { Graph::ZERO };
                second[row][column] = graph.sub(diagonal, inertia[row][column]);
            }
        }
        Self { mass, first: ZERO3, second }
    }

    /// The moment of inertia: `tr(K) 1 − K`.
    pub fn inertia(&self, graph: &mut Graph) -> Mat3 {
        let k = &self.second;
        std::array::from_fn(|row| {
            std::array::from_fn(|column| {
                if row == column {
                    graph.add(k[(row + 1) % 3][(row + 1) % 3], k[(row + 2) % 3][(row + 2) % 3])
                } else {
                    graph.neg(k[row][column])
                }
            })
        })
    }

    pub fn plus(&self, graph: &mut Graph, other: &Self) -> Self {
        Self {
            mass: graph.add(self.mass, other.mass),
            first: graph.add_vec(&self.first, &other.first),
            second: std::array::from_fn(|row| graph.add_vec(&self.second[row], &other.second[row])),
        }
    }

    /// In the frame that a move leads to.
    pub fn moved(&self, graph: &mut Graph, by: &Move) -> Self {
        let Move::Shift(arm) = by else {
            let (first, second) = (by.turned(graph, &self.first), by.turned_symmetric(graph, &self.second));
            return Self { mass: self.mass, first, second };
        };
        let heavy = graph.scale_vec(self.mass, arm);
        let first = graph.add_vec(&self.first, &heavy);
        let mut second = self.second;
        for row in 0..3 {
            for column in row..3 {
                // r sᵀ + s rᵀ + m r rᵀ with s at the one origin and at the other.
                let (a, b) = (graph.mul(arm[row], self.first[column]), graph.mul(first[row], arm[column]));
                let both = graph.add(a, b);
                second[row][column] = graph.add(second[row][column], both);
                second[column][row] = second[row][column];
            }
        }
        Self { mass: self.mass, first, second }
    }

    /// What it takes to move with this acceleration of the origin and these angular velocity and acceleration: force
    /// and torque about the origin.
    pub fn wrench(&self, graph: &mut Graph, motion: &Motion) -> SpatialVector {
        let (w, k) = (&motion.field, &self.second);
        let (even, turning) = (graph.scale_vec(self.mass, &motion.t), graph.mat_vec(w, &self.first));
        let torque = std::array::from_fn(|i| {
            // The axial part of ∫ r (W r)ᵀ dm.
            let (j, l) = ((i + 1) % 3, (i + 2) % 3);
            let diagonal = if k[j][j] == k[l][l] {
                let both = graph.add(k[j][j], k[l][l]);
                graph.mul(both, motion.rho_dot[i])
            } else {
                let (a, b) = (graph.mul(w[l][j], k[j][j]), graph.mul(w[j][l], k[l][l]));
                graph.sub(a, b)
            };
            let [square_j, square_l] = [j, l].map(|k| graph.mul(motion.rho[k], motion.rho[k]));
            let difference = graph.sub(square_l, square_j);
            let skew = graph.mul(difference, k[j][l]);
            let (a, b) = (graph.mul(w[l][i], k[i][j]), graph.mul(w[j][i], k[i][l]));
            let mixed = graph.sub(a, b);
            let sum = graph.add(diagonal, skew);
            graph.add(sum, mixed)
        });
        let carried = graph.cross(&self.first, &motion.t);
        SpatialVector { t: graph.add_vec(&even, &turning), rho: graph.add_vec(&carried, &torque) }
    }

    /// What a unit acceleration takes.
    pub fn wrench_of(&self, graph: &mut Graph, component: usize) -> SpatialVector {
        let unit: Vec3 = UNIT3[component % 3];
        if component < 3 {
            let (force, torque) = (graph.scale_vec(self.mass, &unit), graph.cross(&self.first, &unit));
            return SpatialVector { t: force, rho: torque };
        }
        let inertia = self.inertia(graph);
        SpatialVector { t: graph.cross(&unit, &self.first), rho: inertia[component - 3] }
    }
}

/// How a frame moves: the acceleration of its origin, in which that of gravity is contained, and its rotation.
#[derive(Clone, Copy, Debug)]
pub struct Motion {
    pub t: Vec3,
    pub rho: Vec3,
    pub rho_dot: Vec3,
    /// `ω̃ω̃ + ω̇̃`: the acceleration of a point by its place.
    pub field: Mat3,
}

impl Motion {
    pub fn new(graph: &mut Graph, t: Vec3, rho: Vec3, rho_dot: Vec3) -> Self {
        Self { t, rho, rho_dot, field: graph.relative_acceleration(&rho, &rho_dot) }
    }

    /// Of the frame from which a move leads to this one.
    pub fn back(&self, graph: &mut Graph, by: &Move) -> Self {
        if let Move::Shift(arm) = by {
            let relative = graph.mat_vec(&self.field, arm);
            return Self { t: graph.add_vec(&self.t, &relative), ..*self };
        }
        let [t, rho, rho_dot] = [self.t, self.rho, self.rho_dot].map(|v| by.turned_back(graph, &v));
        Self::new(graph, t, rho, rho_dot)
    }
}
