//! What resists the acceleration of a body with all that hangs on it, in its frame and about the origin.

use super::mass_moments::MassMoments;
use super::screw_moves::{Move, symmetric};
use crate::expr::graph::{ExprId, Graph};
use crate::expr::spatial_vector::SpatialVector;
use crate::expr::vector::{Mat3, UNIT3, Vec3, ZERO3, transposed};

#[derive(Clone, Copy, Debug)]
pub struct ArticulatedInertia {
    /// The part of the linear inertia that is the same in all directions.
    mass: ExprId,
    /// The rest of it.
    linear: Mat3,
    /// Forces (rows) due to turns (columns).
    coupling: Mat3,
    angular: Mat3,
}

impl ArticulatedInertia {
    pub fn rigid(graph: &mut Graph, moments: &MassMoments) -> Self {
        let tilde = graph.tilde(&moments.first);
        Self {
            mass: moments.mass,
            linear: [ZERO3; 3],
            coupling: transposed(&tilde),
            angular: moments.inertia(graph),
        }
    }

    pub fn plus(&self, graph: &mut Graph, other: &Self) -> Self {
        let mut sum = |a: &Mat3, b: &Mat3| std::array::from_fn(|row| graph.add_vec(&a[row], &b[row]));
        Self {
            linear: sum(&self.linear, &other.linear),
            coupling: sum(&self.coupling, &other.coupling),
            angular: sum(&self.angular, &other.angular),
            mass: graph.add(self.mass, other.mass),
        }
    }

    /// In the frame that a move leads to.
    pub fn moved(&self, graph: &mut Graph, by: &Move) -> Self {
        let Move::Shift(arm) = by else {
            return Self {
                mass: self.mass,
                linear: by.turned_symmetric(graph, &self.linear),
                coupling: by.turned_matrix(graph, &self.coupling),
                angular: by.turned_symmetric(graph, &self.angular),
            };
        };
        // A turn about the new origin moves the old one by −r̃ ω.
        let lever = transposed(&graph.tilde(arm));
        let mut linear = self.linear;
        (0..3).for_each(|k| linear[k][k] = graph.add(linear[k][k], self.mass));
        let pulled = graph.mat_mul(&linear, &lever);
        let coupling: Mat3 = std::array::from_fn(|row| graph.add_vec(&self.coupling[row], &pulled[row]));
        let back = transposed(&lever);
        let (old, new) = (graph.mat_mul(&back, &self.coupling), graph.mat_mul(&back, &coupling));
        let angular = std::array::from_fn(|row| {
            std::array::from_fn(|column| {
                if column < row {
                    return Graph::ZERO;
                }
                let both = graph.add(new[row][column], old[column][row]);
                graph.add(self.angular[row][column], both)
            })
        });
        Self { coupling, angular: symmetric(&angular), ..*self }
    }

    /// The wrench that an acceleration takes.
    pub fn times(&self, graph: &mut Graph, acceleration: &SpatialVector) -> SpatialVector {
        let SpatialVector { t, rho } = acceleration;
        let (even, rest) = (graph.scale_vec(self.mass, t), graph.mat_vec(&self.linear, t));
        let (force, turned) = (graph.add_vec(&even, &rest), graph.mat_vec(&self.coupling, rho));
        let (moment, torque) = (graph.transposed_vec(&self.coupling, t), graph.mat_vec(&self.angular, rho));
        SpatialVector { t: graph.add_vec(&force, &turned), rho: graph.add_vec(&torque, &moment) }
    }

    /// What a unit acceleration takes.
    pub fn column(&self, graph: &mut Graph, component: usize) -> SpatialVector {
        if component < 3 {
            let even = graph.scale_vec(self.mass, &UNIT3[component]);
            let t = graph.add_vec(&even, &self.linear[component]);
            return SpatialVector { t, rho: self.coupling[component] };
        }
        let k = component - 3;
        SpatialVector { t: self.coupling.map(|row| row[k]), rho: self.angular[k] }
    }

    /// What is left once a component of the twist is free, an armature resisting it besides: `I − u uᵀ / (d + J)`.
    pub fn without(&self, graph: &mut Graph, component: usize, armature: ExprId) -> (Self, Released) {
        let mut column = self.column(graph, component);
        let resisting = graph.add(column.component(component), armature);
        let inverse = graph.recip(resisting);
        let is_free = armature == Graph::ZERO;
        if is_free {
            *column.component_mut(component) = Graph::ZERO;
        }
        let factor = column.scaled(graph, inverse);
        let mut rest = self.less_product(graph, &factor, &column);
        if !is_free {
            // The component is resisted still.
        } else if component < 3 {
            (0..3).for_each(|other| {
                (rest.linear[component][other], rest.linear[other][component]) = (Graph::ZERO, Graph::ZERO);
            });
            rest.linear[component][component] = graph.neg(self.mass);
            rest.coupling[component] = ZERO3;
        } else {
            let k = component - 3;
            (0..3).for_each(|other| {
                (rest.angular[k][other], rest.angular[other][k]) = (Graph::ZERO, Graph::ZERO);
                rest.coupling[other][k] = Graph::ZERO;
            });
        }
        (rest, Released { component, is_free, inverse, factor })
    }

    /// What is left once an unknown is free that takes a wrench: `I − P Pᵀ / d`.
    pub fn less(&self, graph: &mut Graph, wrench: &SpatialVector, inverse: ExprId) -> Self {
        let factor = wrench.scaled(graph, inverse);
        self.less_product(graph, &factor, wrench)
    }

    fn less_product(&self, graph: &mut Graph, factor: &SpatialVector, column: &SpatialVector) -> Self {
        let mut less = |m: &Mat3, u: &Vec3, v: &Vec3| {
            std::array::from_fn(|row| {
                std::array::from_fn(|column| {
                    let product = graph.mul(u[row], v[column]);
                    graph.sub(m[row][column], product)
                })
            })
        };
        Self {
            mass: self.mass,
            linear: symmetric(&less(&self.linear, &factor.t, &column.t)),
            coupling: less(&self.coupling, &factor.t, &column.rho),
            angular: symmetric(&less(&self.angular, &factor.rho, &column.rho)),
        }
    }
}

/// A component of a twist that yields to loads.
#[derive(Clone, Copy, Debug)]
pub struct Released {
    component: usize,
    /// Whether nothing resists it once it has yielded.
    is_free: bool,
    /// Of what resists it.
    pub inverse: ExprId,
    /// How much it yields to an acceleration of each other component.
    factor: SpatialVector,
}

impl Released {
    /// How much it yields to a load, what is left of which acts on all else.
    pub fn yield_to(&self, graph: &mut Graph, load: &mut SpatialVector, along: ExprId) -> ExprId {
        let own = load.component(self.component);
        let driving = graph.add(own, along);
        let taken = self.factor.scaled(graph, driving).negated(graph);
        *load = load.plus(graph, &taken);
        if self.is_free {
            *load.component_mut(self.component) = graph.neg(along);
        }
        graph.mul(driving, self.inverse)
    }

    /// What it takes of a wrench, which is left without what it yields to.
    pub fn take(&self, graph: &mut Graph, wrench: &mut SpatialVector) -> ExprId {
        let own = wrench.component(self.component);
        let taken = self.factor.scaled(graph, own).negated(graph);
        *wrench = wrench.plus(graph, &taken);
        if self.is_free {
            *wrench.component_mut(self.component) = Graph::ZERO;
        }
        own
    }

    /// How fast it accelerates, `share` being what it yields to loads, and all else moving so, to which its own is
    /// added.
    pub fn release(&self, graph: &mut Graph, motion: &mut SpatialVector, share: ExprId) -> ExprId {
        let own = motion.component(self.component);
        if self.is_free {
            *motion.component_mut(self.component) = Graph::ZERO;
        }
        let yielded = self.factor.dot(graph, motion);
        let all = graph.sub(share, yielded);
        if !self.is_free {
            *motion.component_mut(self.component) = graph.add(own, all);
            return all;
        }
        *motion.component_mut(self.component) = all;
        graph.sub(all, own)
    }
}
