//! The coordinate partition through joint coordinates: what is independent are the coordinates and rates of a tree of
//! joints.
//!
//! Where charts do not reach, a mechanism that has joint coordinates is partitioned in them, by the functions of its
//! [`JointSpace`]: unrolled, and of the size of what closes its loops rather than of Φ_q. A step takes the coordinates
//! of the tree from the maximal state, closes loops by the smallest change of these, and places the bodies anew.
//! Nothing else of the tree's coordinates changes; drivers are satisfied by construction, and so are the rows of all
//! joints of the tree. As none of a loop's coordinates is preferred, there is no choice that could become a poor one.
//! Angles of which the state counts the turns are taken from their turn references: who turns such a joint in a state
//! by hand also sets its reference ([`refer_turns`](crate::refer_turns)). A generated mechanism calls these functions
//! from its [`Partition`](crate::Partition), one line each.
//!
//! # Example
//! ```
//! # fn main() -> Result<(), gyro_sim::Error> {
//! use gyro_mechanisms::four_bar::FourBar;
//! use gyro_sim::{Mechanism, Partitioned, violation};
//!
//! let linkage = FourBar::<f64>::default();
//! let mut state = linkage.start();
//! let mut solver = Partitioned::new(&linkage, &state);
//! for interval in 0..100 {
//!     solver.advance(&linkage, f64::from(interval) * 5e-3, 1e-3, 5, &mut state)?;
//! }
//! let mut phi = linkage.buffers().constraints;
//! linkage.phi(0.5, &state, &mut phi);
//! assert!(violation(&linkage, &phi).value < 1e-14);
//! # Ok(())
//! # }
//! ```

use crate::{Clearance, CloseLoops, Error, JointPlace, JointSpace, Real, Scalar};

/// One Newton step of the positions: closed loops and bodies that their joints hold.
///
/// # Errors
/// [`Error::Singular`] where rows that close loops depend on each other, and [`Error::Jump`] if the change is so large
/// that the solution may not be the one nearby: the state is then as it was.
pub fn newton_step<M: JointSpace<Scalar: Real>>(
    mechanism: &M,
    t: M::Scalar,
    y: &mut M::State,
) -> Result<(), Error> {
    let mut x = joints(mechanism, t, y);
    CloseLoops::new(mechanism).newton_step(mechanism, t, &mut x)?;
    let placed = placed(mechanism, t, &x);
    let (old, new) = (y.as_mut().as_chunks_mut::<7>().0, placed.as_ref().as_chunks::<7>().0);
    for (old, new) in old.iter_mut().zip(new).take(mechanism.description().bodies.len()) {
        *old = nearer_sign(old, *new);
    }
    let first = references(mechanism, y);
    let turns = y.as_mut().iter_mut().zip(placed.as_ref()).skip(first);
    turns.for_each(|(old, new)| *old = *new);
    Ok(())
}

/// The velocities that satisfy eq. (19) at these positions: rates of the tree, changed by the smallest change that
/// closes loops.
pub fn solve_velocities<M: JointSpace<Scalar: Real>>(mechanism: &M, t: M::Scalar, y: &mut M::State) {
    let mut x = joints(mechanism, t, y);
    mechanism.close_velocities(t, &mut x);
    let placed = placed(mechanism, t, &x);
    let n_bodies = mechanism.description().bodies.len();
    let velocities = y.as_mut().iter_mut().zip(placed.as_ref()).skip(7 * n_bodies).take(6 * n_bodies);
    velocities.for_each(|(old, new)| *old = *new);
}

/// How clear a state is of singular poses: see [`CloseLoops::clearance`].
pub fn clearance<M: JointSpace<Scalar: Real>>(
    mechanism: &M,
    t: M::Scalar,
    y: &M::State,
) -> Option<Clearance<M::Scalar>> {
    CloseLoops::new(mechanism).clearance(mechanism, t, &joints(mechanism, t, y))
}

/// An angle and its turn reference that differ by so many roundings of the latter are one.
const ROUNDINGS: f64 = 16.0;

/// The joint state of a maximal state. Angles that have a turn reference have its turns, and where the two differ by
/// more than rounding they are what the reference is: it is integrated as angles are in joint coordinates, without the
/// error of phase that a method makes in Euler parameters. All others are read off the poses, of one turn, where they
/// have the most digits.
fn joints<M: JointSpace<Scalar: Real>>(mechanism: &M, t: M::Scalar, y: &M::State) -> M::Joints {
    let mut x = mechanism.joint_start();
    x.as_mut().fill(M::Scalar::constant(0.0));
    for_each_reference(mechanism, y, &mut x, |x, reference| *x = reference);
    mechanism.to_joints(t, y, &mut x);
    let rounding = M::Scalar::EPSILON * M::Scalar::constant(ROUNDINGS);
    for_each_reference(mechanism, y, &mut x, |x, reference| {
        if (*x - reference).abs() > rounding * reference.abs() {
            *x = reference;
        }
    });
    x
}

/// Calls `f` with the angles of the tree that have a turn reference, and with that.
fn for_each_reference<M: JointSpace>(
    mechanism: &M,
    y: &M::State,
    x: &mut M::Joints,
    f: impl Fn(&mut M::Scalar, M::Scalar),
) {
    let description = mechanism.description();
    if description.turn_references.is_empty() {
        return;
    }
    let first = references(mechanism, y);
    let mut place = 0;
    for of in mechanism.joint_layout().places {
        if let JointPlace::Scalar { joint, coordinate } = *of
            && let Some(reading) = description.reading(joint.into(), coordinate.into())
            && let Some(turn) = description.turn_references.iter().position(|of| usize::from(*of) == reading)
            && let (Some(x), Some(reference)) = (x.as_mut().get_mut(place), y.as_ref().get(first + turn))
        {
            f(x, *reference);
        }
        place += of.n_coordinates();
    }
}

/// Where the turn references begin in a state.
fn references<M: JointSpace>(mechanism: &M, y: &M::State) -> usize {
    y.as_ref().len().saturating_sub(mechanism.description().turn_references.len())
}

fn placed<M: JointSpace>(mechanism: &M, t: M::Scalar, x: &M::Joints) -> M::State {
    let mut y = mechanism.start();
    mechanism.to_maximal(t, x, &mut y);
    y
}

/// A body's (r, p) with p of unit length and, of the two that stand for the same orientation, the one nearer to the
/// old.
fn nearer_sign<T: Real>(old: &[T; 7], new: [T; 7]) -> [T; 7] {
    let [_, _, _, a0, a1, a2, a3] = *old;
    let [x, y, z, b0, b1, b2, b3] = new;
    let along = a0 * b0 + a1 * b1 + a2 * b2 + a3 * b3;
    let scale = (b0 * b0 + b1 * b1 + b2 * b2 + b3 * b3).sqrt();
    let scale = if along < T::constant(0.0) { -scale } else { scale };
    [x, y, z, b0 / scale, b1 / scale, b2 / scale, b3 / scale]
}
