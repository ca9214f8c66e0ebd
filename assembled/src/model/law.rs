//! Laws of force along a coordinate: [`gyro_model::ForceKind`].

use crate::model::amount::{Amount, Read};
use crate::number::{Number, number, sqrt, tanh};
use gyro_model::{ForceKind, Number as PageNumber, Seen, StopSide};

/// A force as a function of a coordinate x and its rate.
#[derive(Clone, Debug)]
pub(crate) enum Law<T> {
    /// `−stiffness (x − free)`, with the potential `½ stiffness (x − free)²`.
    Spring { stiffness: Amount<T>, free: Amount<T> },
    /// `−damping ẋ`.
    Damper { damping: Amount<T> },
    /// `−level tanh(ẋ / rate)`.
    Coulomb { level: Amount<T>, rate: Amount<T> },
    /// With z the depth beyond the limit: `∓stiffness ρ(z) − damping σ(z) ẋ`, where `ρ(z) = ½ (z + √(z² + softness²))`
    /// and `σ(z) = ½ (1 + z / √(z² + softness²))`.
    Stop { limit: Amount<T>, side: StopSide, stiffness: Amount<T>, damping: Amount<T>, softness: Amount<T> },
    /// Given.
    Motor { value: Amount<T> },
    /// Minus what is given.
    Pull { tension: Amount<T> },
    /// Minus the slope of an energy by the coordinate; one law of each energy tells how much it is.
    Descent { energy: Amount<T>, by: Seen, tells: bool },
    /// Minus half the slope of a power by the rate.
    Loss { power: Amount<T>, by: Seen },
}

impl<T: Number> Law<T> {
    /// The law of a force along a joint coordinate; `None` of others.
    pub(crate) fn of(kind: &ForceKind, amount: impl Fn(&PageNumber) -> Amount<T>) -> Option<Self> {
        Some(match kind {
            ForceKind::Spring { on: _, stiffness, free } => {
                Self::Spring { stiffness: amount(stiffness), free: amount(free) }
            }
            ForceKind::Damper { on: _, damping } => Self::Damper { damping: amount(damping) },
            ForceKind::Coulomb { on: _, level, rate } => {
                Self::Coulomb { level: amount(level), rate: amount(rate) }
            }
            ForceKind::Stop { on: _, limit, side, stiffness, damping, softness } => {
                let [limit, stiffness, damping, softness] =
                    [limit, stiffness, damping, softness].map(&amount);
                Self::Stop { limit, side: *side, stiffness, damping, softness }
            }
            ForceKind::Motor { on: _, value } => Self::Motor { value: amount(value) },
            ForceKind::Link { .. }
            | ForceKind::Bushing(_)
            | ForceKind::Load { .. }
            | ForceKind::Potential { .. }
            | ForceKind::Dissipation { .. } => return None,
        })
    }

    /// Whether the force is minus the slope of [`Law::potential`].
    pub(crate) fn is_conservative(&self) -> bool {
        matches!(self, Self::Spring { .. } | Self::Descent { .. })
    }

    /// The force at a coordinate, which only some laws ask for, and a rate, with the values of amounts.
    pub(crate) fn force(&self, read: &impl Read<T>, x: impl FnOnce() -> T, rate: T) -> T {
        let value = |amount: &Amount<T>| read.value(amount);
        match self {
            Self::Spring { stiffness, free } => -value(stiffness) * (x() - value(free)),
            Self::Damper { damping } => -value(damping) * rate,
            Self::Coulomb { level, rate: width } => -value(level) * tanh(rate / value(width)),
            Self::Stop { limit, side, stiffness, damping, softness } => {
                let outward = if *side == StopSide::Upper { T::one() } else { -T::one() };
                let (z, half) = ((x() - value(limit)) * outward, number::<T>(0.5));
                let root = sqrt(z * z + value(softness) * value(softness));
                let (ramp, slope) = (half * (z + root), half * (T::one() + z / root));
                -outward * value(stiffness) * ramp - value(damping) * slope * rate
            }
            Self::Motor { value: amount } => value(amount),
            Self::Pull { tension } => -value(tension),
            Self::Descent { energy, by, tells: _ } => -read.slope(energy, *by),
            Self::Loss { power, by } => -read.slope(power, *by) * number(0.5),
        }
    }

    /// The energy that a conservative force holds; zero of all others.
    pub(crate) fn potential(&self, read: &impl Read<T>, x: impl FnOnce() -> T) -> T {
        let value = |amount: &Amount<T>| read.value(amount);
        match self {
            Self::Spring { stiffness, free } => {
                let stretch = x() - value(free);
                value(stiffness) * stretch * stretch * number(0.5)
            }
            Self::Descent { energy, tells: true, .. } => value(energy),
            _ => T::zero(),
        }
    }
}

#[cfg(test)]
mod tests;
