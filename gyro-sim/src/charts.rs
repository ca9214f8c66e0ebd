//! Charts: for each joint of a tree, which Euler parameter of its body is the special one.
//!
//! A revolute joint moves its body's p along the tangent `½ p∘h'` (h' the axis in the body's frame): the independent
//! coordinate is the Euler parameter with the largest tangent component, at least half the tangent's length by the
//! pigeonhole of four components. A spherical joint or a free body moves p over the whole sphere, whose normal is p:
//! there the *dependent* coordinate is the largest component of p, again at least a half. One rule serves both: the
//! special parameter is the largest component of a four-vector that the mechanism supplies, and four charts a joint
//! never become singular.

use crate::{Lanes, Real};

/// The special Euler parameter, 0 to 3, of each of `N` joints, in each lane.
pub type Charts<T, const N: usize> = [<T as Lanes>::Chart; N];

/// A chart is left only once another component is larger by this factor, so that rounding cannot make it flicker. Any
/// factor above one works; the special component stays above 1/(2 · 1.25) of the vector's length.
pub(crate) const HYSTERESIS: f64 = 1.25;

/// The chart of the largest component of each vector.
pub fn best<T: Lanes, const N: usize>(vectors: &[[T; 4]; N]) -> Charts<T, N> {
    vectors.map(|vector| T::best_chart(&vector))
}

/// Switches the charts that have become poor; returns the number of switches.
pub fn follow<T: Lanes, const N: usize>(vectors: &[[T; 4]; N], charts: &mut Charts<T, N>) -> u32 {
    vectors.iter().zip(charts).map(|(vector, chart)| T::follow_chart(vector, chart)).sum()
}

/// For each joint the unit four-vector of its special parameter, as the generated solves take it: choosing by
/// multiplication keeps them free of branches.
pub fn one_hot<T: Lanes, const N: usize>(charts: &Charts<T, N>) -> [[T; 4]; N] {
    charts.map(T::one_hot)
}

/// Switches a chart that has become poor; returns the number of switches.
#[inline]
pub(crate) fn follow_largest<T: Real>(vector: &[T; 4], chart: &mut u8) -> u32 {
    let candidate = largest(vector);
    let is_poor = component(vector, candidate) > component(vector, *chart) * T::constant(HYSTERESIS);
    if is_poor {
        *chart = candidate;
    }
    u32::from(is_poor)
}

fn component<T: Real>(vector: &[T; 4], chart: u8) -> T {
    vector[usize::from(chart & 3)].abs()
}

/// The index of the largest component.
#[inline]
pub(crate) fn largest<T: Real>(vector: &[T; 4]) -> u8 {
    (1..4).fold(0, |best, k| if component(vector, k) > component(vector, best) { k } else { best })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_chart_is_kept_until_another_is_clearly_better() {
        let mut charts = best::<f64, 1>(&[[0.9, 0.1, 0.3, 0.2]]);
        assert_eq!(charts, [0]);
        assert_eq!((follow(&[[0.6, 0.7, 0.0, 0.0]], &mut charts), charts), (0, [0]));
        assert_eq!((follow(&[[0.5, -0.7, 0.0, 0.0]], &mut charts), charts), (1, [1]));
    }

    #[test]
    fn a_vector_that_is_not_a_number_leaves_the_chart_alone() {
        let mut charts = [2];
        assert_eq!(follow(&[[f64::NAN; 4]], &mut charts), 0);
        assert_eq!(one_hot::<f64, 1>(&charts), [[0.0, 0.0, 1.0, 0.0]]);
    }
}
