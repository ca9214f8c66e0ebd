//! How large the numbers are that equations add up: what rounding leaves of an equation is a part of that.

use nalgebra::DVector;

use super::{Equation, Kinematics, Numbers};
use crate::{JointCoordinate, JointKind, RowOwner};

impl Kinematics {
    /// For each scalar equation the size of what it adds up: positions and directions, each as far as the equation
    /// changes with it; angles with all their turns; what is prescribed.
    pub(crate) fn sizes(&self, equations: &[Equation], q: &[f64], near: &[Vec<f64>]) -> DVector<f64> {
        let of_body = |pose: &[f64]| [pose[0].abs(), pose[1].abs(), pose[2].abs(), 1.0, 1.0, 1.0];
        let units = DVector::from_iterator(6 * self.n_moving_bodies, q.chunks_exact(7).flat_map(of_body));
        let terms = equations.iter().flat_map(|equation| {
            let mut terms = vec![0.0; self.units_of(equation).len()];
            let (row, size) = self.numbers_in(equation, near);
            terms.iter_mut().skip(row).take(1).for_each(|term| *term = size);
            terms
        });
        let terms: Vec<f64> = terms.collect();
        self.gradients(equations, q, near).abs() * units + DVector::from_vec(terms)
    }

    /// Which row of an equation has numbers of its own, and how large they are.
    fn numbers_in(&self, equation: &Equation, near: &[Vec<f64>]) -> (usize, f64) {
        let coordinate = |of: JointCoordinate| near[of.joint][of.coordinate].abs();
        match *equation {
            Equation::Rows(RowOwner::Coupler(k)) => {
                let coupler = &self.couplers[k];
                let wanted = match &coupler.by {
                    Numbers::Linear { first, ratio, offset } => {
                        ratio.abs() * coordinate(*first) + offset.abs()
                    }
                    Numbers::Formula(formula) => {
                        formula.value(|of: JointCoordinate| near[of.joint][of.coordinate], 0.0).abs()
                    }
                    Numbers::Rate(_) => 0.0,
                };
                (0, coupler.second.map_or(0.0, coordinate) + wanted)
            }
            Equation::Rows(RowOwner::Driver(k)) => (0, 2.0 * self.drivers[k].value.re.abs()),
            Equation::Rows(RowOwner::Joint(joint)) if self.joints[joint].kind == JointKind::Screw => {
                let angle = JointCoordinate { joint, coordinate: 0 };
                (2, self.joints[joint].lead.abs() * coordinate(angle))
            }
            Equation::Coordinate { value, .. } => (0, 2.0 * value.abs()),
            Equation::Rows(_) | Equation::Orientation { .. } => (0, 0.0),
        }
    }
}
