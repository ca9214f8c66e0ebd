//! A table's smooth curve: a natural cubic spline that goes on as a straight line beyond its ends.
//!
//! The curve is given by its knots, ascending, and one cubic `c0 + c1 u + c2 u² + c3 u³` for each interval between
//! them, with `u` from the interval's first knot. It is twice continuously differentiable, at the ends too, because a
//! natural spline has no curvature there.
//!
//! ```
//! use gyro_sim::Scalar;
//!
//! // From 0 at 0 s to 1 at 1 s and back to 0 at 2 s.
//! let (knots, pieces) = ([0.0, 1.0, 2.0], [[0.0, 1.5, 0.0, -0.5], [1.0, 0.0, -1.5, 0.5]]);
//! assert_eq!(1.0.spline(&knots, &pieces), [1.0, 0.0, -3.0]);
//! assert_eq!(4.0.spline(&knots, &pieces), [-3.0, -1.5, 0.0]);
//! ```

/// The cubic that holds at a time, and the knot from which it counts; a straight line beyond the ends, zero for no
/// pieces.
///
/// Number types with more than one lane or with derivatives evaluate their own spline from this.
pub fn piece(knots: &[f64], pieces: &[[f64; 4]], t: f64) -> (f64, [f64; 4]) {
    let n = pieces.len().min(knots.len().saturating_sub(1));
    let (Some(first), Some(last), Some(end)) = (pieces.first(), pieces[..n].last(), knots.get(n)) else {
        return (0.0, [0.0; 4]);
    };
    if t >= *end {
        let [value, slope, _] = cubic(last, end - knots[n - 1]);
        return (*end, [value, slope, 0.0, 0.0]);
    }
    let after = knots[..n].partition_point(|knot| *knot <= t);
    match after.checked_sub(1) {
        Some(index) => (knots[index], pieces[index]),
        None => (knots[0], [first[0], first[1], 0.0, 0.0]),
    }
}

/// Value, first and second derivative at a time.
pub fn evaluate(knots: &[f64], pieces: &[[f64; 4]], t: f64) -> [f64; 3] {
    let (origin, coefficients) = piece(knots, pieces, t);
    cubic(&coefficients, t - origin)
}

/// The third derivative at a time, which jumps at knots: there it is that of the piece that begins.
pub fn third(knots: &[f64], pieces: &[[f64; 4]], t: f64) -> f64 {
    6.0 * piece(knots, pieces, t).1[3]
}

fn cubic([c0, c1, c2, c3]: &[f64; 4], u: f64) -> [f64; 3] {
    [c0 + u * (c1 + u * (c2 + u * c3)), c1 + u * (2.0 * c2 + u * (3.0 * c3)), 2.0 * c2 + u * (6.0 * c3)]
}

#[cfg(test)]
mod tests;
