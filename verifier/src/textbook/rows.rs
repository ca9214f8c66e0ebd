//! Φ along a path, and what follows from it: Φ_q, Φ_π', ν, γ.

use super::attitude::{Euler, compose, conjugate};
use super::formula;
use super::jet::Jet;
use super::pose::{Path, Pose};
use super::sparse::Sparse;
use super::{Block, Evaluation};
use crate::field::Field;
use gyro_model::{
    Coupler, Coupling, Driver, Formula, JointCoordinate, JointKind, OutputKind, RowOwner, Seen,
};
use std::array::from_fn;
use std::collections::BTreeMap;

impl<F: Field> Evaluation<'_, F> {
    /// Φ: joint rows, then the normalisations of eq. (12).
    pub fn phi(&self) -> Option<Vec<F>> {
        let rows = self.rows(Path::Rest)?.into_iter().chain(self.normalisations(Path::Rest));
        Some(rows.map(|row| row.value).collect())
    }

    /// Φ_q, normalisations included; columns (r, p) body after body.
    pub fn phi_q(&self) -> Option<Sparse<F>> {
        let (n_rows, moving_bodies) = (self.textbook.n_rows(), &self.textbook.moving_bodies);
        let mut matrix = self.derivatives(n_rows + moving_bodies.len(), 7, |moving_body, k| {
            Path::Coordinate { moving_body, k }
        })?;
        for (moving_body, &body) in moving_bodies.iter().enumerate() {
            for k in 3..7 {
                let pose = self.pose(body, Path::Coordinate { moving_body, k });
                if let Some(rate) = self.normalisation(&pose).rate {
                    matrix.rows[n_rows + moving_body].insert(7 * moving_body + k, rate);
                }
            }
        }
        let model = self.textbook.model;
        let of_velocities = |row: &usize| match model.rows()[*row].owner {
            RowOwner::Coupler(coupler) => model.couplers[coupler].rate().is_some(),
            _ => false,
        };
        let of_velocities: Vec<_> = (0..n_rows).filter(of_velocities).collect();
        if !of_velocities.is_empty() {
            let phi_pi = self.phi_pi()?;
            for row in of_velocities {
                matrix.rows[row] = self.by_coordinates(&phi_pi.rows[row]);
            }
        }
        Some(matrix)
    }

    /// A row of velocities by (r, p) in place of (r, π'): `w' = 2 p* ṗ`, eq. (14).
    fn by_coordinates(&self, row: &BTreeMap<usize, F>) -> BTreeMap<usize, F> {
        let mut all = BTreeMap::new();
        for (moving_body, &body) in self.textbook.moving_bodies.iter().enumerate() {
            let entry = |k: usize| row.get(&(6 * moving_body + k)).cloned();
            all.extend((0..3).filter_map(|k| Some((7 * moving_body + k, entry(k)?))));
            let conjugate = conjugate(&self.still[body].p);
            for k in 0..4 {
                let unit = from_fn(|j| if j == k { self.scope.one.clone() } else { self.scope.zero.clone() });
                let [_, turn @ ..] = compose(&conjugate, &unit);
                let parts = turn.iter().enumerate().filter_map(|(j, w)| Some(entry(3 + j)?.mul(&w.value)));
                if let Some(half) = parts.reduce(|a, b| a.add(&b)).filter(|half| !half.is_zero()) {
                    all.insert(7 * moving_body + 3 + k, half.add(&half));
                }
            }
        }
        all
    }

    /// (Φ_r, Φ_π'), `Φ_π' = ½ Φ_p Gᵀ`; columns (r, π') body after body.
    pub fn phi_pi(&self) -> Option<Sparse<F>> {
        self.derivatives(self.textbook.n_rows(), 6, |moving_body, k| Path::Virtual { moving_body, k })
    }

    /// The derivatives of the joint rows along some paths of each moving_body. A row in which a body does not occur
    /// does not change with it.
    fn derivatives(
        &self,
        n_rows: usize,
        paths: usize,
        path: impl Fn(usize, usize) -> Path,
    ) -> Option<Sparse<F>> {
        let mut matrix = Sparse::new(n_rows, paths * self.textbook.moving_bodies.len());
        let mut poses = self.still.clone();
        for (moving_body, &body) in self.textbook.moving_bodies.iter().enumerate() {
            for k in 0..paths {
                let path = path(moving_body, k);
                poses[body] = self.pose(body, path);
                for block in &self.textbook.blocks_of_body[body] {
                    let block = &self.textbook.blocks[*block];
                    for (row, jet) in block.rows.clone().zip(self.rows_of(block, path, &poses)?) {
                        if let Some(rate) = jet.rate {
                            matrix.rows[row].insert(paths * moving_body + k, rate);
                        }
                    }
                }
            }
            poses[body] = self.still[body].clone();
        }
        Some(matrix)
    }

    /// Φ of an owner's rows to first order in a change of the Euler parameters of a moving_body from other ones: `Φ +
    /// Φ_p δ`.
    pub fn linearised(&self, owner: RowOwner, moving_body: usize, p: &[F], change: &[F]) -> Option<Vec<F>> {
        let body = self.textbook.moving_bodies[moving_body];
        let mut poses = self.still.clone();
        let p: Euler<F> = from_fn(|k| Jet::moving(p[k].clone(), change[k].clone()));
        poses[body] = Pose { r: poses[body].r.clone(), a: self.scope.rotation(&p), p };
        let block = self.textbook.blocks.iter().find(|block| block.owner == owner)?;
        let rows = self.rows_of(block, Path::Coordinate { moving_body, k: 3 }, &poses)?;
        let sum = |row: Jet<F>| row.rate.map_or_else(|| row.value.clone(), |rate| row.value.add(&rate));
        Some(rows.into_iter().map(sum).collect())
    }

    /// `ν = −Φ_t`.
    pub fn nu(&self) -> Option<Vec<F>> {
        Some(self.rates(self.rows(Path::Time)?.into_iter().map(|row| -row)))
    }

    /// `Φ_r s + Φ_π' w' − ν`: the derivative of Φ along the motion.
    pub fn velocity_residual(&self) -> Option<Vec<F>> {
        Some(self.rates(self.rows(Path::Motion)?.into_iter()))
    }

    /// γ of eq. (17): minus the second derivative of Φ along the motion at `s̈ = ẇ' = 0`.
    pub fn gamma(&self) -> Option<Vec<F>> {
        let zero = &self.scope.zero.value;
        let second = |row: Jet<F>| row.second.map_or_else(|| zero.clone(), |second| second.neg());
        Some(self.rows(Path::Motion)?.into_iter().map(second).collect())
    }

    /// The rows of [`gyro_model::Model::rows`] along a path, eq. (11) and what is driven or coupled.
    fn rows(&self, path: Path) -> Option<Vec<Jet<F>>> {
        let (poses, mut rows) = (self.poses(path), Vec::new());
        for block in &self.textbook.blocks {
            rows.extend(self.rows_of(block, path, &poses)?);
        }
        Some(rows)
    }

    /// The rows of one owner that are kept.
    fn rows_of(&self, block: &Block, path: Path, poses: &[Pose<F>]) -> Option<Vec<Jet<F>>> {
        let model = self.textbook.model;
        let rows = match block.owner {
            RowOwner::Body(body) => self.held(&poses[body], body)?,
            RowOwner::Joint(joint) => {
                let frames = &self.joints[joint];
                let is_screw = frames.kind == JointKind::Screw;
                let angle = JointCoordinate { joint, coordinate: 0 };
                let angle = if is_screw { Some(self.coordinate(angle, poses)?) } else { None };
                frames.placed(poses).rows(&self.scope, frames, angle.as_ref())?
            }
            RowOwner::Coupler(coupler) => vec![self.coupled(&model.couplers[coupler], poses)?],
            RowOwner::Driver(driver) => vec![self.driven(&model.drivers[driver], path, poses)?],
        };
        Some(rows.into_iter().zip(&block.is_kept).filter(|(_, kept)| **kept).map(|(row, _)| row).collect())
    }

    /// `pᵀp − 1` of each moving_body, eq. (12).
    fn normalisations(&self, path: Path) -> Vec<Jet<F>> {
        let bodies = self.textbook.moving_bodies.iter();
        bodies.map(|&body| self.normalisation(&self.pose(body, path))).collect()
    }

    fn normalisation(&self, pose: &Pose<F>) -> Jet<F> {
        let [e0, e1, e2, e3] = &pose.p;
        e0 * e0 + e1 * e1 + e2 * e2 + e3 * e3 - &self.scope.one
    }

    /// `r − r0` and the vector part of `p0* p`, eqs. (5) and (6).
    fn held(&self, pose: &Pose<F>, body: usize) -> Option<Vec<Jet<F>>> {
        let given = self.scope.given(&self.textbook.model.bodies[body])?;
        let [_, orientation @ ..] = compose(&conjugate(&given.p), &pose.p);
        let position = pose.r.clone() - &given.r;
        Some(position.0.into_iter().chain(orientation).collect())
    }

    /// `second − ratio · first − offset`, or the second coordinate less a formula of others.
    fn coupled(&self, coupler: &Coupler, poses: &[Pose<F>]) -> Option<Jet<F>> {
        let zero = &self.scope.zero.value;
        let value = |formula: &Formula| {
            let see = |seen| match seen {
                Seen::Coordinate(on) => self.coordinate(on, poses),
                Seen::Rate(on) => self.change(on, poses),
                Seen::Output { output, number } => match &self.textbook.model.outputs[output].kind {
                    OutputKind::Relative(relative) => {
                        let frames = relative.frames.each_ref();
                        let all = self.relative(frames, frames.map(|frame| &poses[frame.body]))?;
                        all.get(number).cloned()
                    }
                    _ => None,
                },
                _ => None,
            };
            formula::value(self.textbook.model, &self.scope, &see, &formula.text)
        };
        let second = coupler.second.map(|second| self.coordinate(second, poses));
        match &coupler.by {
            Coupling::Linear { first, ratio, offset } => {
                let [ratio, offset] = [ratio, offset].map(|number| self.scope.number(number));
                Some(second?? - ratio * self.coordinate(*first, poses)? - offset)
            }
            Coupling::Formula(formula) => Some(second?? - value(formula)?),
            Coupling::Zero(formula) => value(formula),
            // What changes at this rate, and is zero now.
            Coupling::Rate(formula) => {
                let Jet { value, rate, .. } = value(formula)?;
                Some(Jet { value: zero.clone(), rate: (!value.is_zero()).then_some(value), second: rate })
            }
        }
    }

    /// `coordinate − motion(t)`.
    fn driven(&self, driver: &Driver, path: Path, poses: &[Pose<F>]) -> Option<Jet<F>> {
        let motion = self.scope.prescribed(self.textbook.model, &driver.motion, &self.time(path))?;
        Some(self.coordinate(driver.coordinate, poses)? - motion)
    }

    fn rates(&self, rows: impl Iterator<Item = Jet<F>>) -> Vec<F> {
        rows.map(|row| row.rate.unwrap_or_else(|| self.scope.zero.value.clone())).collect()
    }
}
