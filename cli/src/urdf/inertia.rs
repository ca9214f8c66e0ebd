//! Mass, mass centre and inertia of bodies: put together of parts, and mended where no body has them.

use crate::words;
use gyro_model::{Rational, parse_decimal};
use nalgebra::{IsometryMatrix3, Matrix3, Point3, Vector3};

/// In the axes of some frame.
#[derive(Clone, Debug)]
pub(super) struct Inertial {
    pub(super) mass: f64,
    /// From the frame's origin.
    pub(super) centre: Vector3<f64>,
    /// About the mass centre.
    pub(super) tensor: Matrix3<f64>,
}

/// Tensor elements xx, yy, zz, xy, xz, yz.
pub(super) type Elements = [f64; 6];

/// Elements below this part of the largest are what rotations leave of a zero, and second moments are kept above this
/// part of the largest, so that rounding leaves them positive.
const ROUNDING: f64 = 1e-12;

/// Changes below this part of an inertia are not worth a remark.
const SLIGHT: f64 = 1e-9;

/// Changes above this part of the largest moment are no mending.
const MOST: f64 = 0.1;

/// Squared radius of gyration, m2, below which a body is a point or a rod.
const NOTHING: f64 = 1e-10;

/// Squared radius of gyration, m2, that a point or a rod is given: a millimetre.
const THIN: f64 = 1e-6;

impl Inertial {
    /// The same with respect to a frame in which this one has a pose.
    pub(super) fn seen(&self, pose: &IsometryMatrix3<f64>) -> Self {
        let turn = pose.rotation.matrix();
        Self {
            mass: self.mass,
            centre: (pose * Point3::from(self.centre)).coords,
            tensor: turn * self.tensor * turn.transpose(),
        }
    }

    /// A part of the same shape.
    pub(super) fn part(&self, part: f64) -> Self {
        Self { mass: self.mass * part, centre: self.centre, tensor: self.tensor * part }
    }

    /// All parts together, in one frame; `None` if they have no mass.
    pub(super) fn sum(parts: &[Self]) -> Option<Self> {
        let mass: f64 = parts.iter().map(|part| part.mass).sum();
        if mass == 0.0 {
            return None;
        }
        let moment: Vector3<f64> = parts.iter().map(|part| part.centre * part.mass).sum();
        let centre = moment / mass;
        let about_centre = |part: &Self| {
            let from = part.centre - centre;
            // Steiner's theorem.
            part.tensor + (Matrix3::identity() * from.norm_squared() - from * from.transpose()) * part.mass
        };
        Some(Self { mass, centre, tensor: parts.iter().map(about_centre).sum() })
    }

    /// The elements to write, and what had to be changed for them to be a rigid body's.
    ///
    /// # Errors
    /// What is wrong, and a cure, where that would be another body.
    pub(super) fn elements(&self, as_written: bool) -> Result<(Elements, Option<String>), String> {
        let eigen = self.tensor.symmetric_eigen();
        let moments = eigen.eigenvalues;
        let written = written(&self.tensor);
        if is_inertia(written) && moments.min() >= self.mass * NOTHING {
            return Ok((written, None));
        }
        if as_written && moments.min() > ROUNDING * moments.max() {
            let words = format!("has principal moments of {}, as written", shown(&moments));
            return Ok((written, Some(words)));
        }
        // Second moments of mass along the principal axes; a body has none below zero.
        let squares = moments.map(|moment| moments.sum() / 2.0 - moment);
        let (largest, shown) = (moments.amax(), shown(&moments));
        let is_thin = moments.min().abs() < self.mass * NOTHING;
        if -squares.min() > MOST * largest.max(self.mass * NOTHING) {
            return Err(format!(
                "its principal moments {shown} kg.m2 are no body's, as none may exceed the sum of the others; write those \
                 about the mass centre, in the axes of the <inertial>, or take them as they are by --as-written (positive \
                 ones), or those of the link's shapes by --density"
            ));
        }
        let least = if is_thin { self.mass * THIN } else { squares.max() * ROUNDING };
        let squares = squares.map(|square| square.max(least));
        let mended = Matrix3::from_diagonal(&squares.map(|square| squares.sum() - square));
        let mended = eigen.eigenvectors * mended * eigen.eigenvectors.transpose();
        let change = (mended - self.tensor).amax();
        let size = words::number(change, 2);
        let remark = if is_thin {
            Some(format!(
                "has principal moments of {shown} kg.m2, a point's or a rod's: it is taken to be a millimetre thick, a \
                 change of {size} kg.m2"
            ))
        } else {
            let part = words::number(100.0 * change / largest, 2);
            (change > SLIGHT * largest).then(|| {
                format!(
                    "has principal moments of {shown} kg.m2, which no body has: its inertia is mended by {size} kg.m2, \
                     {part} % of the largest"
                )
            })
        };
        Ok((self::written(&mended), remark))
    }
}

pub(super) fn tensor([xx, yy, zz, xy, xz, yz]: Elements) -> Matrix3<f64> {
    Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
}

fn shown(moments: &Vector3<f64>) -> String {
    let mut moments: Vec<f64> = moments.iter().copied().collect();
    moments.sort_by(f64::total_cmp);
    let texts: Vec<String> = moments.iter().map(|moment| words::number(*moment, 3)).collect();
    format!("[{}]", texts.join(", "))
}

fn written(tensor: &Matrix3<f64>) -> Elements {
    let elements = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)].map(|at| tensor[at]);
    let least = tensor.amax() * ROUNDING;
    elements.map(|x| if x.abs() < least { 0.0 } else { rounded(x) })
}

/// To the 15 digits that a decimal keeps in an `f64`: what was typed with fewer comes back, sums of it too.
pub(super) fn rounded(value: f64) -> f64 {
    format!("{value:.14e}").parse().unwrap_or(value)
}

/// Whether the decimals as they are written are an inertia, exactly.
pub(super) fn is_inertia(elements: Elements) -> bool {
    let exact: Option<Vec<Rational>> = elements.iter().map(|x| parse_decimal(&format!("{x:?}"))).collect();
    exact
        .and_then(|exact| exact.try_into().ok())
        .is_some_and(|exact: [Rational; 6]| gyro_model::is_inertia(exact))
}

#[cfg(test)]
mod tests;
