//! How exactly a start satisfies the constraints: one tolerance for every use.

use super::Start;
use crate::kinematics::{Equation, Kinematics};
use crate::{Coupling, Model, Row, RowOwner, RowUnit};

/// A row of Φ, or of Φ_q q̇ − ν, of a start is met if it is this part or less of what it adds up: far above the
/// rounding of an assembly in `f64`, which goes on until it gains no more digits, far below any number that one writes
/// on purpose.
pub const START_TOLERANCE: f64 = 1e-12;

/// What a start may violate each of [`Model::rows`] by.
#[derive(Clone, Debug, PartialEq)]
pub struct StartTolerances {
    /// Φ, m or pure.
    pub phi: Vec<f64>,
    /// Φ_q q̇ − ν, m/s or 1/s.
    pub rates: Vec<f64>,
}

impl Model {
    /// What a start may violate each of [`Model::rows`] by: [`START_TOLERANCE`] times the size of what the row adds up.
    /// An angle of ten thousand turns is known less well than one of a few, and so is a joint that is far from the
    /// origin or moves fast.
    ///
    /// Velocities of all bodies are projected together, so that the fastest counts for all rows; slower than 1 rad/s,
    /// or the mechanism's [size](Model::size) a second, counts as that.
    pub fn start_tolerances(&self, start: &Start) -> StartTolerances {
        let kinematics = Kinematics::at(self, 0.0);
        let near: Vec<Vec<f64>> = start.joints.iter().map(|joint| joint.position.clone()).collect();
        let (equations, size) = (kinematics.equations(), self.size());
        let unit = |row: &Row| if row.unit == RowUnit::Length { size } else { 1.0 };
        let units: Vec<f64> = kinematics.rows().iter().map(unit).collect();
        let sizes = kinematics.sizes(&equations, &start.q, &near);
        let phi = units.iter().zip(&sizes).map(|(unit, size)| START_TOLERANCE * (unit + size)).collect();
        let rates = rate_tolerances(&kinematics, start, &near, &units, size);
        let kept = |all: Vec<f64>| {
            let rows = self.rows();
            kinematics.rows().iter().zip(all).filter(|(row, _)| rows.contains(row)).map(|(_, x)| x).collect()
        };
        StartTolerances { phi: kept(phi), rates: kept(rates) }
    }

    /// A row in words: ``row 2 (f_i.h_j) of joint `x` ``, counted from 1 among its owner's.
    pub fn row_named(&self, row: Row) -> String {
        let symbol = self.row_symbols(row.owner).get(row.index).copied().unwrap_or_default();
        format!("row {} ({symbol}) of {}", row.index + 1, self.named(row.owner))
    }

    /// What each row of an owner is: see [`Model::rows`].
    fn row_symbols(&self, owner: RowOwner) -> Vec<&'static str> {
        match owner {
            RowOwner::Body(_) => vec!["r x", "r y", "r z", "p x", "p y", "p z"],
            RowOwner::Coupler(coupler) => vec![match &self.couplers[coupler].by {
                Coupling::Linear { .. } => "second - ratio * first - offset",
                Coupling::Formula(_) => "second - formula",
                Coupling::Zero(_) => "zero",
                Coupling::Rate(_) => "rate",
            }],
            RowOwner::Driver(_) => vec!["coordinate - motion"],
            RowOwner::Joint(index) => self.joints[index].kind.row_symbols(self.point_axes(index)),
        }
    }
}

/// For a row `Σ_j J_j v_j − ν` the size is `(1 + Σ_j |J_j|) · fastest + |ν|`, lengths in units of the size.
fn rate_tolerances(
    kinematics: &Kinematics,
    start: &Start,
    near: &[Vec<f64>],
    units: &[f64],
    size: f64,
) -> Vec<f64> {
    let all: Vec<Equation> = kinematics.equations();
    let jacobian = kinematics.gradients(&all, &start.q, near);
    let nu = kinematics.nu(&start.q, near);
    let column = |k: usize| if k % 6 < 3 { size } else { 1.0 };
    let moving = start.v.iter().enumerate().map(|(k, v)| v.abs() / column(k));
    let prescribed = nu.iter().zip(units).map(|(nu, unit)| nu.abs() / unit);
    let fastest = moving.chain(prescribed).fold(1.0, f64::max);
    let of_row = |(row, unit): (usize, &f64)| {
        let slopes: f64 = (0..jacobian.ncols()).map(|k| jacobian[(row, k)].abs() * column(k)).sum();
        START_TOLERANCE * ((unit + slopes) * fastest + nu[row].abs())
    };
    units.iter().enumerate().map(of_row).collect()
}
