//! Gain and phase margin of a loop that was opened: of `L(z) = −H (z − F)⁻¹ G` on the unit circle, where the closed
//! loop has its poles at L = −1.

use super::discrete::Opened;
use crate::eigenvalues;
use nalgebra::{Complex, DMatrix};
use std::f64::consts::PI;

/// Factors, and angles, rad, each with the frequency at which it is, rad/s; `None` where L does not come there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Margins {
    /// The least factor above one that makes the loop unstable, or a stable one of it.
    pub(super) gain: Option<(f64, f64)>,
    /// The largest factor below one that does.
    pub(super) reduction: Option<(f64, f64)>,
    /// How far L may turn, forwards or backwards, where its size is one.
    pub(super) phase: Option<(f64, f64)>,
}

/// Angles at which L is looked at, in equal ratios, and about each pole.
const LOOKS: u32 = 3000;

pub(super) fn margins(opened: &Opened, period: f64) -> Margins {
    let at = |angle: f64| response(opened, Complex::from_polar(1.0, angle));
    let mut found = Margins { gain: None, reduction: None, phase: None };
    let mut crossed = |response: Complex<f64>, angle: f64| {
        if response.re < 0.0 {
            let (factor, at) = (1.0 / response.norm(), angle / period);
            if factor > 1.0 && found.gain.is_none_or(|(gain, _)| factor < gain) {
                found.gain = Some((factor, at));
            } else if factor < 1.0 && found.reduction.is_none_or(|(gain, _)| factor > gain) {
                found.reduction = Some((factor, at));
            }
        }
    };
    let angles = angles(opened);
    let responses: Vec<_> = angles.iter().map(|angle| at(*angle)).collect();
    for (pair, angles) in responses.windows(2).zip(angles.windows(2)) {
        let (Some(from), Some(to)) = (pair[0], pair[1]) else { continue };
        if from.im * to.im < 0.0 {
            let angle = root(|angle| at(angle).map_or(0.0, |l| l.im), [angles[0], angles[1]]);
            at(angle).into_iter().for_each(|l| crossed(l, angle));
        }
    }
    // At half the sampling frequency L is real.
    at(PI).into_iter().for_each(|l| crossed(l, PI));
    for (pair, angles) in responses.windows(2).zip(angles.windows(2)) {
        let (Some(from), Some(to)) = (pair[0], pair[1]) else { continue };
        if (from.norm() - 1.0) * (to.norm() - 1.0) < 0.0 {
            let angle = root(|angle| at(angle).map_or(0.0, |l| l.norm() - 1.0), [angles[0], angles[1]]);
            // L = −exp(iφ)
            let phase = at(angle).map_or(PI, |l| (-l).arg());
            if found.phase.is_none_or(|(least, _)| phase.abs() < least.abs()) {
                found.phase = Some((phase, angle / period));
            }
        }
    }
    found
}

/// L; `None` at a pole of it.
fn response(Opened { f, g, h }: &Opened, z: Complex<f64>) -> Option<Complex<f64>> {
    let complex = |matrix: &DMatrix<f64>| matrix.map(|x| Complex::new(x, 0.0));
    let shifted = DMatrix::identity(f.nrows(), f.nrows()) * z - complex(f);
    let solved = shifted.lu().solve(&complex(g))?;
    let value = -(complex(h) * solved)[(0, 0)];
    (value.re.is_finite() && value.im.is_finite()).then_some(value)
}

/// Where L is looked at: L changes fast near its poles, and where it would if it were closed.
fn angles(Opened { f, g, h }: &Opened) -> Vec<f64> {
    let ratios = |n: u32, from: f64, to: f64| {
        (0..=n).map(move |k| from * (to / from).powf(f64::from(k) / f64::from(n)))
    };
    let mut angles: Vec<f64> = ratios(LOOKS, 1e-6, PI).collect();
    let closed = f + g * h;
    for pole in eigenvalues::of(f).iter().chain(&eigenvalues::of(&closed)) {
        let (centre, width) = (pole.arg().abs(), (1.0 - pole.norm()).abs().max(1e-9));
        let around = ratios(80, width * 1e-2, PI.max(width)).flat_map(|away| [centre - away, centre + away]);
        angles.extend(around.chain([centre]).filter(|angle| *angle > 0.0 && *angle < PI));
    }
    angles.sort_by(f64::total_cmp);
    angles.dedup();
    angles
}

/// A root between two angles with values of different sign, by bisection.
fn root(f: impl Fn(f64) -> f64, [mut low, mut high]: [f64; 2]) -> f64 {
    let sign = f(low).signum();
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        if f(middle).signum() == sign {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}
