//! Charts of packs: for each lane a unit vector.

use crate::{Lanes, charts::HYSTERESIS};

/// The largest component and, as a unit vector, which one it is.
pub(super) fn largest<T: Lanes>(vector: &[T; 4]) -> (T, [T; 4]) {
    let [zero, one] = [0.0, 1.0].map(T::constant);
    let mut size = vector[0].absolute();
    let mut unit = [one, zero, zero, zero];
    for k in 1..4 {
        let is_larger = vector[k].absolute().greater(size);
        size = T::select(is_larger, vector[k].absolute(), size);
        unit = unit.map(|x| T::select(is_larger, zero, x));
        unit[k] = T::select(is_larger, one, unit[k]);
    }
    (size, unit)
}

/// Leaves a chart that has become poor; returns the number of lanes.
pub(super) fn follow<T: Lanes>(vector: &[T; 4], chart: &mut [T; 4]) -> u32 {
    let (size, best) = largest(vector);
    let [a, b, c, d] = core::array::from_fn(|k| vector[k].absolute() * chart[k]);
    let is_poor = size.greater((a + b + c + d) * T::constant(HYSTERESIS));
    *chart = core::array::from_fn(|k| T::select(is_poor, best[k], chart[k]));
    T::bits(is_poor).count_ones()
}
