//! Φ along a path, and what follows from it: Φ_q, Φ_π', ν, γ.

use super::Evaluation;
use super::attitude::{compose, conjugate};
use super::jet::Jet;
use super::pose::{Path, Pose};
use crate::field::Field;
use gyro_model::{Coupler, Driver, JointCoordinate, JointKind, Support};

impl<F: Field> Evaluation<'_, F> {
    /// Φ: joint rows, then the normalisations of eq. (12).
    pub fn phi(&self) -> Option<Vec<F>> {
        let rows = self.rows(Path::Rest)?.into_iter().chain(self.normalisations(Path::Rest));
        Some(rows.map(|row| row.value).collect())
    }

    /// Φ_q by rows, normalisations included; columns (r, p) body after body.
    pub fn phi_q(&self) -> Option<Vec<Vec<F>>> {
        let columns = (0..self.textbook.slots.len()).flat_map(|slot| (0..7).map(move |k| (slot, k)));
        let columns = columns.map(|(slot, k)| {
            let path = Path::Coordinate { slot, k };
            Some(self.rates(self.rows(path)?.into_iter().chain(self.normalisations(path))))
        });
        columns.collect::<Option<Vec<_>>>().map(|columns| transposed(&columns))
    }

    /// (Φ_r, Φ_π') by rows, `Φ_π' = ½ Φ_p Gᵀ`; columns (r, π') body after body.
    pub fn phi_pi(&self) -> Option<Vec<Vec<F>>> {
        let columns = (0..self.textbook.slots.len()).flat_map(|slot| (0..6).map(move |k| (slot, k)));
        let columns =
            columns.map(|(slot, k)| Some(self.rates(self.rows(Path::Virtual { slot, k })?.into_iter())));
        columns.collect::<Option<Vec<_>>>().map(|columns| transposed(&columns))
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
        let (model, poses) = (self.textbook.model, self.poses(path));
        let mut rows = Vec::new();
        for (body, description) in model.bodies.iter().enumerate() {
            if description.support == Support::Constrained {
                rows.extend(self.held(&poses[body], body)?);
            }
        }
        for (joint, frames) in self.joints.iter().enumerate() {
            let is_screw = frames.kind == JointKind::Screw;
            let angle = JointCoordinate { joint, coordinate: 0 };
            let angle = if is_screw { Some(self.coordinate(angle, &poses)?) } else { None };
            rows.extend(frames.placed(&poses).rows(&self.scope, frames, angle.as_ref())?);
        }
        for coupler in &model.couplers {
            rows.push(self.coupled(coupler, &poses)?);
        }
        for driver in &model.drivers {
            rows.push(self.driven(driver, path, &poses)?);
        }
        Some(
            rows.into_iter()
                .zip(&self.textbook.is_kept)
                .filter(|(_, kept)| **kept)
                .map(|(row, _)| row)
                .collect(),
        )
    }

    /// `pᵀp − 1`, eq. (12).
    fn normalisations(&self, path: Path) -> Vec<Jet<F>> {
        let poses = self.poses(path);
        let euler = self.textbook.slots.iter().map(|&body| &poses[body].p);
        euler.map(|[e0, e1, e2, e3]| e0 * e0 + e1 * e1 + e2 * e2 + e3 * e3 - &self.scope.one).collect()
    }

    /// `r − r0` and the vector part of `p0* p`, eqs. (5) and (6).
    fn held(&self, pose: &Pose<F>, body: usize) -> Option<Vec<Jet<F>>> {
        let given = self.scope.given(&self.textbook.model.bodies[body])?;
        let [_, orientation @ ..] = compose(&conjugate(&given.p), &pose.p);
        let position = pose.r.clone() - &given.r;
        Some(position.0.into_iter().chain(orientation).collect())
    }

    /// `second − ratio · first − offset`.
    fn coupled(&self, coupler: &Coupler, poses: &[Pose<F>]) -> Option<Jet<F>> {
        let [ratio, offset] = [&coupler.ratio, &coupler.offset].map(|number| self.scope.number(number));
        let (first, second) =
            (self.coordinate(coupler.first, poses)?, self.coordinate(coupler.second, poses)?);
        Some(second - ratio * first - offset)
    }

    /// `coordinate − motion(t)`.
    fn driven(&self, driver: &Driver, path: Path, poses: &[Pose<F>]) -> Option<Jet<F>> {
        let motion = self.scope.prescribed(&driver.motion, &self.time(path));
        Some(self.coordinate(driver.coordinate, poses)? - motion)
    }

    fn rates(&self, rows: impl Iterator<Item = Jet<F>>) -> Vec<F> {
        rows.map(|row| row.rate.unwrap_or_else(|| self.scope.zero.value.clone())).collect()
    }
}

fn transposed<F: Field>(columns: &[Vec<F>]) -> Vec<Vec<F>> {
    let n_rows = columns.first().map_or(0, Vec::len);
    (0..n_rows).map(|row| columns.iter().map(|column| column[row].clone()).collect()).collect()
}
