//! Poses around the start that satisfy the same equations.

use crate::assemble::projection::{Configuration, System, scattered};

/// How many poses are looked for.
const SAMPLES: usize = 3;

/// How far from the start, rad or parts of the size: far enough that a singular start shows, near enough to come back
/// to the constraints on the same branch.
const STEP: f64 = 0.15;

/// A pose that is nearer to the start than this part of the step has not left it.
const RETURNED: f64 = 0.05;

/// Below this, rad or parts of the size, the equations leave no way to go.
const NO_WAY: f64 = 1e-6;

/// What was found.
pub(super) enum Samples {
    /// Poses, perhaps none: nothing is free to move, or no way led back to the equations.
    Poses(Vec<Configuration>),
    /// Velocities are free, but every way leads back to the start: it is rigid, and only its first derivatives do not
    /// say so.
    Stuck,
}

impl Samples {
    /// The poses and one more in front of them.
    pub(super) fn with(self, start: Configuration) -> Vec<Configuration> {
        let poses = match self {
            Self::Poses(poses) => poses,
            Self::Stuck => Vec::new(),
        };
        std::iter::once(start).chain(poses).collect()
    }
}

/// Takes steps along the tangent in directions without a pattern and comes back to the equations from there.
pub(super) fn samples(system: &System<'_>, start: &Configuration) -> Samples {
    let jacobian = system.jacobian(start);
    let (mut poses, mut returned) = (Vec::new(), 0);
    for series in 0..SAMPLES {
        let along = system.tangent(&jacobian, &scattered(jacobian.ncols(), series));
        if along.amax() < NO_WAY {
            continue;
        }
        let step = along.scale(STEP / along.amax());
        let reached = [1.0, 0.5, 0.25].into_iter().find_map(|part| {
            let at = system.project(&system.moved(start, &(&step * part)));
            system.is_met(&at).then_some((at, part))
        });
        let Some((at, part)) = reached else { continue };
        if system.scaled_difference(&at, start).amax() < RETURNED * STEP * part {
            returned += 1;
        } else {
            poses.push(at);
        }
    }
    if poses.is_empty() && returned > 0 { Samples::Stuck } else { Samples::Poses(poses) }
}
