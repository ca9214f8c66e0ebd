//! Many states at once, in the lanes of packs: what a generated mechanism does that is compiled as a library.
//!
//! States and inputs are row after row, as callers have them. A pack that is not full repeats its last row.

use gyro_sim::{Joint, JointSpace, Lanes, Rk4, Scalar};
use std::ops::Range;

/// How many states the functions of a library take at most: their arguments are arrays of so many rows.
pub const BLOCK: usize = 64;

/// The inputs of many states: the same for all, or a row for each.
#[derive(Clone, Copy, Debug)]
pub enum Inputs<'a> {
    /// One row.
    Same(&'a [f64]),
    /// As many rows as there are states.
    Own(&'a [f64]),
}

impl Inputs<'_> {
    /// Those of some of the states, of `n` inputs each.
    ///
    /// # Panics
    /// There are not so many rows.
    #[must_use]
    pub fn of(self, rows: Range<usize>, n: usize) -> Self {
        match self {
            Self::Same(values) => Self::Same(values),
            Self::Own(values) => Self::Own(&values[rows.start * n..rows.end * n]),
        }
    }

    /// Sets those of the rows of a pack.
    fn set<M: JointSpace>(self, mechanism: &mut M, rows: &[usize; 8])
    where
        M::Scalar: Lanes<Lane = f64>,
    {
        let n = mechanism.description().inputs.len();
        for index in 0..n {
            let value = M::Scalar::from_lanes(|lane| match self {
                Self::Same(values) => values[index],
                Self::Own(values) => values[rows[lane] * n + index],
            });
            mechanism.set_input(index, value);
        }
    }
}

/// The rows of each pack, and how many of them are to be stored.
fn packs<T: Lanes>(n_rows: usize) -> impl Iterator<Item = ([usize; 8], usize)> {
    (0..n_rows).step_by(T::COUNT).map(move |first| {
        (std::array::from_fn(|lane| (first + lane).min(n_rows - 1)), T::COUNT.min(n_rows - first))
    })
}

fn gather<T: Lanes<Lane = f64>>(to: &mut [T], rows: &[usize; 8], numbers: &[f64]) {
    let n = to.len();
    for (place, to) in to.iter_mut().enumerate() {
        *to = T::from_lanes(|lane| numbers[rows[lane] * n + place]);
    }
}

fn scatter<T: Lanes<Lane = f64>>(from: &[T], (first, count): (usize, usize), numbers: &mut [f64]) {
    for (lane, to) in numbers.chunks_exact_mut(from.len()).skip(first).take(count).enumerate() {
        for (to, from) in to.iter_mut().zip(from) {
            *to = from.lane(lane);
        }
    }
}

/// Writes the joint accelerations u̇ of states, of which `x` has the positions and `u` the rates, at a time, s.
///
/// # Panics
/// An array has no whole number of rows, or not as many as the others.
pub fn accelerations<M: JointSpace>(
    mechanism: &mut M,
    t: f64,
    inputs: Inputs<'_>,
    (x, u): (&[f64], &[f64]),
    out: &mut [f64],
) where
    M::Scalar: Lanes<Lane = f64>,
{
    let (n_x, n_u) = (mechanism.joint_layout().n_coordinates(), mechanism.joint_layout().n_rates());
    let (mut state, mut rates) = (mechanism.joint_start(), mechanism.joint_buffers().rates);
    if matches!(inputs, Inputs::Same(_)) {
        inputs.set(mechanism, &[0; 8]);
    }
    for (rows, count) in packs::<M::Scalar>(out.len() / n_u.max(1)) {
        if matches!(inputs, Inputs::Own(_)) {
            inputs.set(mechanism, &rows);
        }
        let (of_x, of_u) = state.as_mut().split_at_mut(n_x);
        gather(of_x, &rows, x);
        gather(&mut of_u[..n_u], &rows, u);
        mechanism.joint_accelerations(M::Scalar::constant(t), &state, &mut rates);
        scatter(rates.as_ref(), (rows[0], count), out);
    }
}

/// Advances joint states (x, u) of a tree by Kutta's method of order 4: these steps, each `h` s long, counted from a
/// time.
///
/// # Panics
/// As [`accelerations`].
pub fn advance<M: JointSpace>(
    mechanism: &mut M,
    (from, h): (f64, f64),
    steps: &Range<u64>,
    inputs: Inputs<'_>,
    states: &mut [f64],
) where
    M::Scalar: Lanes<Lane = f64>,
{
    let n = mechanism.joint_layout().n_coordinates() + mechanism.joint_layout().n_rates();
    let mut state = mechanism.joint_start();
    let mut method = Rk4::new(&state);
    if matches!(inputs, Inputs::Same(_)) {
        inputs.set(mechanism, &[0; 8]);
    }
    for (rows, count) in packs::<M::Scalar>(states.len() / n.max(1)) {
        if matches!(inputs, Inputs::Own(_)) {
            inputs.set(mechanism, &rows);
        }
        let (own, work) = state.as_mut().split_at_mut(n);
        gather(own, &rows, states);
        work.fill(M::Scalar::constant(0.0));
        for step in steps.clone() {
            #[expect(clippy::cast_precision_loss, reason = "step numbers stay below 2⁵³")]
            let t = M::Scalar::constant(from + step as f64 * h);
            method.step(&Joint, mechanism, t, M::Scalar::constant(h), &mut state);
        }
        scatter(&state.as_ref()[..n], (rows[0], count), states);
    }
}
