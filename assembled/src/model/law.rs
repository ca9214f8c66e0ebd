//! Laws of force along a coordinate: [`gyro_model::ForceKind`].

use crate::number::{Number, number, sqrt, tanh};
use gyro_model::{ForceKind, Model, Number as PageNumber, StopSide};

/// A number of a force: folded, or an input that the caller sets.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Amount<T> {
    Constant(T),
    /// Index into [`crate::Lowered::inputs`], and a factor of 1 or −1.
    Input(usize, T),
}

/// A force as a function of a coordinate x and its rate.
#[derive(Clone, Copy, Debug)]
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
}

impl<T: Number> Amount<T> {
    pub(crate) fn new(model: &Model, value: &PageNumber) -> Self {
        match value {
            PageNumber::Input { index, negated } => {
                Self::Input(*index, if *negated { -T::one() } else { T::one() })
            }
            PageNumber::Exact(_) | PageNumber::Parameter { .. } | PageNumber::Computed(_) => {
                Self::Constant(number(model.value(value)))
            }
        }
    }

    pub(crate) fn value(&self, inputs: &[(String, T)]) -> T {
        match self {
            Self::Constant(value) => *value,
            Self::Input(index, sign) => inputs[*index].1 * *sign,
        }
    }
}

impl<T: Number> Law<T> {
    /// The law of a force along a joint coordinate; `None` of others.
    pub(crate) fn of(model: &Model, kind: &ForceKind) -> Option<Self> {
        let amount = |number| Amount::new(model, number);
        Some(match kind {
            ForceKind::Spring { on: _, stiffness, free } => {
                Self::Spring { stiffness: amount(stiffness), free: amount(free) }
            }
            ForceKind::Damper { on: _, damping } => Self::Damper { damping: amount(damping) },
            ForceKind::Coulomb { on: _, level, rate } => {
                Self::Coulomb { level: amount(level), rate: amount(rate) }
            }
            ForceKind::Stop { on: _, limit, side, stiffness, damping, softness } => {
                let [limit, stiffness, damping, softness] = [limit, stiffness, damping, softness].map(amount);
                Self::Stop { limit, side: *side, stiffness, damping, softness }
            }
            ForceKind::Motor { on: _, value } => Self::Motor { value: amount(value) },
            ForceKind::Link { .. } | ForceKind::Load { .. } => return None,
        })
    }

    /// Whether the force is minus the slope of [`Law::potential`].
    pub(crate) fn is_conservative(&self) -> bool {
        matches!(self, Self::Spring { .. })
    }

    /// The force at a coordinate, which only some laws ask for, and a rate.
    pub(crate) fn force(&self, inputs: &[(String, T)], x: impl FnOnce() -> T, rate: T) -> T {
        let value = |amount: &Amount<T>| amount.value(inputs);
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
        }
    }

    /// The energy that a conservative force holds; zero of all others.
    pub(crate) fn potential(&self, inputs: &[(String, T)], x: impl FnOnce() -> T) -> T {
        match self {
            Self::Spring { stiffness, free } => {
                let stretch = x() - free.value(inputs);
                stiffness.value(inputs) * stretch * stretch * number(0.5)
            }
            _ => T::zero(),
        }
    }
}

#[cfg(test)]
mod tests;
