//! The correction of loops in joint coordinates.

use super::{Correction, FARTHEST, MAX_ITERATIONS, check_finite, reach};
use crate::pivoting::is_resolvable;
use crate::violation::CONVERGED_EPSILONS;
use crate::violation::{Violation, closure_violation};
use crate::{
    ByDuals, Clearance, Coordinate, Error, Joint, JointLayout, JointPlace, JointSpace, Mechanism, Ode, Owner,
    Real, Scalar,
};

/// Closes the loops of a mechanism in joint coordinates: positions by Newton's iteration
/// ([`JointSpace::close_positions`]), then velocities. Trees, which have no loops, are left as they are.
///
/// Positions are corrected at least once, as near a singular pose even a rounding of a row changes them, and until no
/// row exceeds a few roundings: of one, or of the largest coordinate of a mass centre in units of the mechanism's size,
/// times the largest angle, of which no more digits are known. A change by more than half a radian or half the
/// mechanism's size in one iteration may lead to another way to assemble the mechanism and is refused.
///
/// # Example
/// ```
/// # fn main() -> Result<(), gyro_sim::Error> {
/// use gyro_mechanisms::four_bar::FourBar;
/// use gyro_sim::{CloseLoops, Dop853, Joint, JointSpace, Mechanism, Solver};
///
/// let linkage = FourBar::<f64>::default();
/// // Three angles and their rates: crank, rocker and elbow. The joint at the knee is cut; two of its rows close the loop.
/// assert_eq!(linkage.joint_layout().places.len(), 3);
/// assert_eq!(linkage.joint_layout().closure_rows.len(), 2);
///
/// // Another start: the crank is turned, and closing the loop changes all angles a little.
/// let mut x = linkage.joint_start();
/// x[0] += 0.1;
/// let mut loops = CloseLoops::new(&linkage);
/// loops.correct(&linkage, 0.0, &mut x)?;
///
/// // Ten seconds; after each step the loop is closed.
/// let mut solver = Solver::with_correction(Joint, Dop853::new(&x), loops, 0.0, &x);
/// solver.advance_to(&linkage, 10.0)?;
/// let mut closure = linkage.joint_buffers().closure;
/// linkage.loop_closure(10.0, solver.state(), &mut closure);
/// assert!(closure.iter().all(|row| row.abs() < 1e-12));
///
/// // Where the bodies are.
/// let mut y = linkage.start();
/// linkage.to_maximal(10.0, solver.state(), &mut y);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct CloseLoops<M: JointSpace> {
    closure: M::Closure,
    before: M::Joints,
    maximal: M::State,
}

impl<M: JointSpace<Scalar: Real>> CloseLoops<M> {
    /// Work space for a mechanism.
    pub fn new(mechanism: &M) -> Self {
        Self {
            closure: mechanism.joint_buffers().closure,
            before: mechanism.joint_start(),
            maximal: mechanism.start(),
        }
    }

    /// Closes positions and velocities.
    ///
    /// # Errors
    /// [`Error`], with `x` as it was when the failure was noticed.
    pub fn correct(&mut self, mechanism: &M, t: M::Scalar, x: &mut M::Joints) -> Result<(), Error> {
        if mechanism.joint_layout().closure_rows.is_empty() {
            return Ok(());
        }
        self.close_positions(mechanism, t, x)?;
        mechanism.close_velocities(t, x);
        check_finite(t, x.as_ref())
    }

    fn close_positions(&mut self, mechanism: &M, t: M::Scalar, x: &mut M::Joints) -> Result<(), Error> {
        let tolerance = M::Scalar::EPSILON * M::Scalar::constant(CONVERGED_EPSILONS);
        mechanism.joint_layout().normalise(x.as_mut());
        check_finite(t, x.as_ref())?;
        let mut worst = self.worst(mechanism, t, x);
        for _ in 0..MAX_ITERATIONS {
            self.close_once(mechanism, t, (x, worst.owner))?;
            worst = self.worst(mechanism, t, x);
            if worst.value <= tolerance || worst.value <= tolerance * self.magnitude(mechanism, t, x) {
                return Ok(());
            }
        }
        let owner = worst.owner.unwrap_or(Owner::Body(0));
        Err(Error::NoConvergence { t: t.to_f64(), violation: worst.value.to_f64(), owner })
    }

    /// One iteration, towards rows of which the worst has this owner.
    fn close_once(
        &mut self,
        mechanism: &M,
        t: M::Scalar,
        (x, owner): (&mut M::Joints, Option<Owner>),
    ) -> Result<(), Error> {
        self.before.as_mut().copy_from_slice(x.as_ref());
        mechanism.close_positions(t, x);
        self.refuse_jump(mechanism, t, (x, owner))?;
        mechanism.joint_layout().normalise(x.as_mut());
        check_finite(t, x.as_ref())
    }

    /// One Newton step of the positions, unless rows depend on each other or the change is a jump.
    pub(crate) fn newton_step(
        &mut self,
        mechanism: &M,
        t: M::Scalar,
        x: &mut M::Joints,
    ) -> Result<(), Error> {
        mechanism.joint_layout().normalise(x.as_mut());
        if mechanism.joint_layout().closure_rows.is_empty() {
            return Ok(());
        }
        check_finite(t, x.as_ref())?;
        if let Some(Clearance { pivot, owner }) = self.clearance(mechanism, t, x)
            && !is_resolvable(pivot)
        {
            return Err(Error::Singular { t: t.to_f64(), pivot: pivot.to_f64(), owner });
        }
        let owner = self.worst(mechanism, t, x).owner;
        self.close_once(mechanism, t, (x, owner))
    }

    fn worst(&mut self, mechanism: &M, t: M::Scalar, x: &M::Joints) -> Violation<M::Scalar> {
        mechanism.loop_closure(t, x, &mut self.closure);
        closure_violation(mechanism, mechanism.joint_layout().closure_rows, self.closure.as_ref())
    }

    /// How near the rows of J are to depending on each other: about the least distance of one of them from the span of
    /// those before it, lengths in units of the mechanism's size, as smooth as J where several are as near
    /// (`(Σd⁻⁸)^(-1/8)`: forty loops that come into line at once are nearly as clear of that pose as one). None for
    /// trees.
    pub fn clearance(&self, mechanism: &M, t: M::Scalar, x: &M::Joints) -> Option<Clearance<M::Scalar>> {
        let rows = mechanism.joint_layout().closure_rows;
        let mut inverses = self.closure.clone();
        mechanism.closure_distances(t, x, &mut inverses);
        let (zero, one, size) = (M::Scalar::constant(0.0), M::Scalar::constant(1.0), mechanism.size());
        let mut nearest = None;
        for (&row, square) in rows.iter().zip(inverses.as_mut()) {
            let row = mechanism.description().rows.get(usize::from(row));
            let owner = row.map(|row| row.owner);
            let unit = if row.is_some_and(|row| row.is_length) { size * size } else { one };
            let inverse = unit / *square;
            if !(*square > zero && inverse.is_finite()) {
                return Some(Clearance { pivot: zero, owner });
            }
            *square = inverse;
            if nearest.is_none_or(|(largest, _)| inverse > largest) {
                nearest = Some((inverse, owner));
            }
        }
        nearest.map(|(largest, owner)| {
            let fourth_powers = inverses.as_ref().iter().take(rows.len()).map(|&inverse| {
                let square = (inverse / largest) * (inverse / largest);
                square * square
            });
            let sum = fourth_powers.fold(zero, |sum, power| sum + power);
            Clearance { pivot: one / (largest * sum.sqrt().sqrt()).sqrt(), owner }
        })
    }

    /// How large the numbers are that a row subtracts, at least one: mass centres in units of the mechanism's size,
    /// times angles.
    fn magnitude(&mut self, mechanism: &M, t: M::Scalar, x: &M::Joints) -> M::Scalar {
        mechanism.to_maximal(t, x, &mut self.maximal);
        let one = M::Scalar::constant(1.0);
        let reach = reach(mechanism, &self.maximal);
        let mut largest = one;
        for (place, x) in positions(mechanism.joint_layout(), x.as_ref()) {
            if let ([angle], true) = (x, is_angle(mechanism, place)) {
                largest = if angle.abs() > largest { angle.abs() } else { largest };
            }
        }
        if reach > one { largest * reach } else { largest }
    }

    /// What is not finite is left to be noticed later.
    fn refuse_jump(
        &self,
        mechanism: &M,
        t: M::Scalar,
        (x, owner): (&M::Joints, Option<Owner>),
    ) -> Result<(), Error> {
        let layout = mechanism.joint_layout();
        let (one, two) = (M::Scalar::constant(1.0), M::Scalar::constant(2.0));
        let ends = positions(layout, self.before.as_ref()).zip(positions(layout, x.as_ref()));
        for ((place, before), (_, after)) in ends {
            for (index, (before, after)) in before.iter().zip(after).enumerate() {
                // Euler parameters change by half the angle of a turn.
                let scale = match place {
                    _ if is_angle(mechanism, place) => one,
                    JointPlace::Body { .. } if index >= 3 => two,
                    JointPlace::Orientation { .. } => two,
                    JointPlace::Scalar { .. }
                    | JointPlace::Turn { .. }
                    | JointPlace::State { .. }
                    | JointPlace::Body { .. } => one / mechanism.size(),
                };
                let change = ((*after - *before) * scale).abs();
                if change > M::Scalar::constant(FARTHEST) {
                    let (change, owner) = (change.to_f64(), owner.unwrap_or(Owner::Body(0)));
                    return Err(Error::Jump { t: t.to_f64(), change, limit: FARTHEST, owner });
                }
            }
        }
        Ok(())
    }
}

impl<M: JointSpace<Scalar: Real>> Correction<Joint, M> for CloseLoops<M> {
    fn correct(&mut self, mechanism: &M, t: M::Scalar, x: &mut M::Joints) -> Result<(), Error> {
        self.correct(mechanism, t, x)
    }
    fn violation(&mut self, mechanism: &M, t: M::Scalar, x: &M::Joints) -> M::Scalar {
        self.worst(mechanism, t, x).value
    }
    fn clearance(&self, mechanism: &M, t: M::Scalar, x: &M::Joints) -> Option<Clearance<M::Scalar>> {
        self.clearance(mechanism, t, x)
    }
}

/// The same equations with a Jacobian.
impl<M, Dualled, S, J, const N: usize> Correction<ByDuals<Joint, Dualled, S, J, N>, M> for CloseLoops<M>
where
    M: JointSpace<Scalar: Real>,
    ByDuals<Joint, Dualled, S, J, N>: Ode<M, Scalar = M::Scalar, State = M::Joints>,
{
    fn correct(&mut self, mechanism: &M, t: M::Scalar, x: &mut M::Joints) -> Result<(), Error> {
        self.correct(mechanism, t, x)
    }
    fn violation(&mut self, mechanism: &M, t: M::Scalar, x: &M::Joints) -> M::Scalar {
        Correction::<Joint, M>::violation(self, mechanism, t, x)
    }
    fn clearance(&self, mechanism: &M, t: M::Scalar, x: &M::Joints) -> Option<Clearance<M::Scalar>> {
        self.clearance(mechanism, t, x)
    }
}

/// The numbers of each place in x.
fn positions<'a, T>(layout: &JointLayout<'a>, x: &'a [T]) -> impl Iterator<Item = (JointPlace, &'a [T])> {
    let mut rest = x;
    layout.places.iter().map(move |&place| {
        let (own, others) = rest.split_at_checked(place.n_coordinates()).unwrap_or((rest, &[]));
        rest = others;
        (place, own)
    })
}

fn is_angle<M: Mechanism>(mechanism: &M, place: JointPlace) -> bool {
    let (JointPlace::Scalar { joint, coordinate } | JointPlace::Turn { joint, coordinate }) = place else {
        return false;
    };
    let joint = mechanism.description().joints.get(usize::from(joint));
    let kind = joint.and_then(|joint| joint.coordinates.get(usize::from(coordinate)));
    kind == Some(&Coordinate::Angle)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn euler_parameters_are_normalised_where_they_stand() {
        let layout = JointLayout {
            places: &[
                JointPlace::Scalar { joint: 0, coordinate: 0 },
                JointPlace::Body { body: 0 },
                JointPlace::Orientation { joint: 1 },
            ],
            closure_rows: &[],
        };
        let mut x = [7.0, 1.0, 2.0, 3.0, 1.0, -1.0, 1.0, 1.0, 2.0, 0.0, 0.0, 0.0, 9.0];
        layout.normalise(&mut x);
        assert_eq!(x, [7.0, 1.0, 2.0, 3.0, 0.5, -0.5, 0.5, 0.5, 1.0, 0.0, 0.0, 0.0, 9.0]);
    }
}
