//! Equations among poses: the rows of Φ, and coordinates held at a value. Their values, gradients and drift in time.

use nalgebra::{DMatrix, DVector};
use num_dual::Dual64;

use super::geometry::Pose;
use super::joint::Posed;
use super::{Kinematics, Place};
use crate::scalar::{Scalar, product};
use crate::{JointCoordinate, Quaternion, RowOwner, RowUnit};

/// One or some scalar equations with one meaning.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Equation {
    /// The rows of Φ of one owner.
    Rows(RowOwner),
    /// A joint coordinate at a value.
    Coordinate { of: JointCoordinate, value: f64 },
    /// The second body of a joint at an orientation in the first body's frame: vector part of `p0* p_i* p_j`.
    Orientation { joint: usize, value: Quaternion },
}

impl Kinematics {
    /// What is left of the equations at a pose.
    pub(crate) fn values(&self, equations: &[Equation], q: &[f64], near: &[Vec<f64>]) -> DVector<f64> {
        let poses: Vec<Pose<f64>> = self.poses(q).iter().map(super::value_of).collect();
        let values = equations.iter().flat_map(|equation| self.rows_of(equation, &poses, near));
        DVector::from_vec(values.collect())
    }

    /// Their derivatives with respect to (r, π'), body after body.
    pub(crate) fn gradients(&self, equations: &[Equation], q: &[f64], near: &[Vec<f64>]) -> DMatrix<f64> {
        let still: Vec<Pose<Dual64>> = self.poses(q).iter().map(without_time).collect();
        let n_rows = equations.iter().map(|equation| self.units_of(equation).len()).sum();
        let mut gradients = DMatrix::zeros(n_rows, 6 * self.n_moving_bodies);
        let (mut poses, mut first_row) = (still.clone(), 0);
        for equation in equations {
            for body in self.bodies_of(equation) {
                let Place::Slot { moving_body, .. } = self.places[body] else { continue };
                for direction in 0..6 {
                    poses[body] = still[body].varied(direction);
                    for (row, value) in self.rows_of(equation, &poses, near).into_iter().enumerate() {
                        gradients[(first_row + row, 6 * moving_body + direction)] = value.eps;
                    }
                }
                poses[body] = still[body];
            }
            first_row += self.units_of(equation).len();
        }
        gradients
    }

    /// Their partial derivatives with respect to time: driven bodies move, drivers prescribe.
    pub(crate) fn drift(&self, equations: &[Equation], q: &[f64], near: &[Vec<f64>]) -> DVector<f64> {
        let poses = self.poses(q);
        let of = |equation: &Equation| {
            let prescribed = match *equation {
                Equation::Rows(RowOwner::Driver(k)) => self.drivers[k].value.eps,
                _ => 0.0,
            };
            let rows = self.rows_of(equation, &poses, near);
            rows.into_iter().map(move |row| row.eps - prescribed)
        };
        DVector::from_vec(equations.iter().flat_map(of).collect())
    }

    /// Units of the scalar equations: a length, or pure.
    pub(crate) fn units_of(&self, equation: &Equation) -> Vec<RowUnit> {
        match *equation {
            Equation::Rows(owner) => {
                self.rows.iter().filter(|row| row.owner == owner).map(|row| row.unit).collect()
            }
            Equation::Coordinate { of, .. } if self.coordinate_kind(of).is_angle() => vec![RowUnit::Pure],
            Equation::Coordinate { .. } => vec![RowUnit::Length],
            Equation::Orientation { .. } => vec![RowUnit::Pure; 3],
        }
    }

    /// The bodies that the equations are about, without repetition.
    fn bodies_of(&self, equation: &Equation) -> Vec<usize> {
        let joints = match *equation {
            Equation::Rows(RowOwner::Body(body)) => return vec![body],
            Equation::Rows(RowOwner::Joint(joint)) | Equation::Orientation { joint, .. } => vec![joint],
            Equation::Rows(RowOwner::Coupler(k)) => {
                self.couplers[k].coordinates().into_iter().map(|on| on.joint).collect()
            }
            Equation::Rows(RowOwner::Driver(k)) => vec![self.drivers[k].coordinate.joint],
            Equation::Coordinate { of, .. } => vec![of.joint],
        };
        let ends = |&joint: &usize| [self.joints[joint].first.body, self.joints[joint].second.body];
        let mut bodies: Vec<usize> = joints.iter().flat_map(ends).collect();
        if let Equation::Rows(RowOwner::Coupler(k)) = *equation {
            bodies.extend(self.couplers[k].bodies());
        }
        bodies.sort_unstable();
        bodies.dedup();
        bodies
    }

    /// The equations at poses, and at the prescribed values of this instant.
    fn rows_of<D: Scalar>(&self, equation: &Equation, poses: &[Pose<D>], near: &[Vec<f64>]) -> Vec<D> {
        let coordinate = |of| self.coordinate(of, poses, near);
        match *equation {
            Equation::Rows(RowOwner::Body(body)) => self.body_rows(body, &poses[body]),
            Equation::Rows(RowOwner::Joint(joint)) => {
                self.posed(joint, poses).rows(near[joint].first().copied().unwrap_or(0.0))
            }
            Equation::Rows(RowOwner::Coupler(k)) => {
                let coupler = &self.couplers[k];
                vec![coupler.lag(coordinate, poses)]
            }
            Equation::Rows(RowOwner::Driver(k)) => {
                vec![coordinate(self.drivers[k].coordinate) - self.drivers[k].value.re]
            }
            Equation::Coordinate { of, value } => vec![coordinate(of) - value],
            Equation::Orientation { joint, value } => {
                let [i, j] = [self.joints[joint].first.body, self.joints[joint].second.body];
                let relative = product(conjugate(poses[i].p), poses[j].p);
                let [_, x, y, z] = product(value.conjugate().0.map(D::from), relative);
                vec![x, y, z]
            }
        }
    }

    /// Position against the model file's, and the vector part of `p0* p`: paper eqs. (5) and (6).
    fn body_rows<D: Scalar>(&self, body: usize, pose: &Pose<D>) -> Vec<D> {
        let Place::Slot { held: Some(held), .. } = self.places[body] else { return Vec::new() };
        let [_, x, y, z] = product(Quaternion(held.p).conjugate().0.map(D::from), pose.p);
        let shift = |k: usize| pose.r[k] - held.r[k];
        vec![shift(0), shift(1), shift(2), x, y, z]
    }

    fn coordinate<D: Scalar>(&self, of: JointCoordinate, poses: &[Pose<D>], near: &[Vec<f64>]) -> D {
        self.posed(of.joint, poses).coordinate(self.coordinate_kind(of), near[of.joint][of.coordinate])
    }

    pub(crate) fn posed<D: Scalar>(&self, joint: usize, poses: &[Pose<D>]) -> Posed<'_, D> {
        let geometry = &self.joints[joint];
        geometry.between(&poses[geometry.first.body], &poses[geometry.second.body])
    }
}

fn conjugate<D: Scalar>([a, b, c, d]: [D; 4]) -> [D; 4] {
    [a, -b, -c, -d]
}

fn without_time(pose: &Pose<Dual64>) -> Pose<Dual64> {
    Pose::still(pose.r.map(|x| x.re), pose.p.map(|e| e.re))
}
