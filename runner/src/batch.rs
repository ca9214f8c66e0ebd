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
    fn set<M: JointSpace>(self, mechanism: &mut M, pack: Pack)
    where
        M::Scalar: Lanes<Lane = f64>,
    {
        let n = mechanism.description().inputs.len();
        for index in 0..n {
            let value = M::Scalar::from_lanes(|lane| match self {
                Self::Same(values) => values[index],
                Self::Own(values) => values[pack.row(lane) * n + index],
            });
            mechanism.set_input(index, value);
        }
    }
}

/// Rows whose states are the lanes of one pack.
#[derive(Clone, Copy)]
struct Pack {
    first: usize,
    /// The batch's last row.
    last: usize,
}

impl Pack {
    const FIRST: Self = Self { first: 0, last: 0 };

    /// The packs of so many rows.
    fn of<T: Lanes>(n_rows: usize) -> impl Iterator<Item = Self> {
        (0..n_rows).step_by(T::COUNT).map(move |first| Self { first, last: n_rows - 1 })
    }

    /// The row of a lane.
    #[inline(always)]
    fn row(self, lane: usize) -> usize {
        (self.first + lane).min(self.last)
    }
}

/// Reads the rows of a pack. Each row is found once, not each of its numbers: that would cost as much as a short
/// kernel.
fn gather<T: Lanes<Lane = f64>>(to: &mut [T], pack: Pack, numbers: &[f64]) {
    let n = to.len();
    let rows: [&[f64]; 8] = std::array::from_fn(|lane| match lane < T::COUNT {
        true => &numbers[pack.row(lane) * n..][..n],
        false => &[],
    });
    for (place, to) in to.iter_mut().enumerate() {
        *to = T::from_lanes(|lane| rows[lane][place]);
    }
}

/// Writes them; of a pack that is not full its own rows alone.
fn scatter<T: Lanes<Lane = f64>>(from: &[T], pack: Pack, numbers: &mut [f64]) {
    let n = from.len();
    for lane in 0..T::COUNT.min(pack.last + 1 - pack.first) {
        for (to, from) in numbers[pack.row(lane) * n..][..n].iter_mut().zip(from) {
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
        inputs.set(mechanism, Pack::FIRST);
    }
    for pack in Pack::of::<M::Scalar>(out.len() / n_u.max(1)) {
        if matches!(inputs, Inputs::Own(_)) {
            inputs.set(mechanism, pack);
        }
        let (of_x, of_u) = state.as_mut().split_at_mut(n_x);
        gather(of_x, pack, x);
        gather(&mut of_u[..n_u], pack, u);
        mechanism.joint_accelerations(M::Scalar::constant(t), &state, &mut rates);
        scatter(rates.as_ref(), pack, out);
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
        inputs.set(mechanism, Pack::FIRST);
    }
    for pack in Pack::of::<M::Scalar>(states.len() / n.max(1)) {
        if matches!(inputs, Inputs::Own(_)) {
            inputs.set(mechanism, pack);
        }
        let (own, work) = state.as_mut().split_at_mut(n);
        gather(own, pack, states);
        work.fill(M::Scalar::constant(0.0));
        for step in steps.clone() {
            #[expect(clippy::cast_precision_loss, reason = "step numbers stay below 2⁵³")]
            let t = M::Scalar::constant(from + step as f64 * h);
            method.step(&Joint, mechanism, t, M::Scalar::constant(h), &mut state);
        }
        scatter(&state.as_ref()[..n], pack, states);
    }
}
