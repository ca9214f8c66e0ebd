//! Projection onto the constraints in the metric of the masses.

use super::{Correction, FARTHEST, MAX_ITERATIONS, check_finite, reach};
use crate::euler_parameters::normalise;
use crate::pivoting::{self, is_met, silence};
use crate::violation::CONVERGED_EPSILONS;
use crate::violation::{Violation, constraint_violation, violation};
use crate::{
    ByDuals, Clearance, Dynamics, Error, Exact, Kinematics, Mechanism, Ode, Owner, Partition, Projection,
    Real, Scalar, refer_turns,
};

/// The nearest state that satisfies the constraints: of all changes that lead there the smallest in the metric of the
/// masses, δᵀ M δ, first of the positions, then of the velocities. What is integrated accurately, because it moves much
/// mass, is changed least.
///
/// A change of the positions keeps the rates ṙ and ṗ of the coordinates, and so turns w' by `−½ δπ' × w'`.
///
/// # The equations that it admits
/// Errors are as small as this correction can make them only where the accelerations are exact off the constraints too:
/// it admits [`Exact`] equations, with a Jacobian by [`ByDuals`] or without. [`Corrected`](crate::Corrected) ones do
/// not compile:
/// ```compile_fail,E0277
/// # use gyro_sim::{Corrected, CorrectedDynamics, Error, Kinematics, Kutta4, MassWeighted, Partition, Projection, Solver};
/// fn step<M>(mechanism: &M, y: &M::State) -> Result<(), Error>
/// where
///     M: Partition<Scalar = f64> + Kinematics + Projection + CorrectedDynamics,
/// {
///     let (method, correction) = (Kutta4::new(y), MassWeighted::new(mechanism));
///     Solver::with_correction(Corrected, method, correction, 0.0, y).step(mechanism, 1e-4)
/// }
/// ```
/// With `Exact` in the place of `Corrected` they do:
/// ```
/// # use gyro_sim::{Dynamics, Error, Exact, Kinematics, Kutta4, MassWeighted, Partition, Projection, Solver};
/// fn step<M>(mechanism: &M, y: &M::State) -> Result<(), Error>
/// where
///     M: Partition<Scalar = f64> + Kinematics + Projection + Dynamics,
/// {
///     let (method, correction) = (Kutta4::new(y), MassWeighted::new(mechanism));
///     Solver::with_correction(Exact, method, correction, 0.0, y).step(mechanism, 1e-4)
/// }
/// ```
#[derive(Clone, Debug)]
pub struct MassWeighted<M: Mechanism> {
    /// Near singular poses the residual of the iteration is amplified, so it takes one more step.
    has_poses: bool,
    phi: M::Constraints,
    rows: M::Rows,
    change: M::Velocities,
}

impl<M: Partition<Scalar: Real> + Kinematics + Projection> MassWeighted<M> {
    /// Work space for a mechanism.
    pub fn new(mechanism: &M) -> Self {
        let has_poses = mechanism.clearance(M::Scalar::constant(0.0), &mechanism.start()).is_some();
        Self {
            has_poses,
            phi: mechanism.buffers().constraints,
            rows: mechanism.buffers().rows,
            change: mechanism.buffers().velocities,
        }
    }

    /// Corrects positions and velocities.
    ///
    /// # Errors
    /// [`Error`], with `y` as it was when the failure was noticed.
    pub fn correct(&mut self, mechanism: &M, t: M::Scalar, y: &mut M::State) -> Result<(), Error> {
        self.correct_positions(mechanism, t, y)?;
        refer_turns(mechanism, t, y);
        mechanism.velocity_residual(t, y, &mut self.rows);
        if self.is_noise(mechanism, t, y) {
            return check_finite(t, y.as_ref());
        }
        negate(self.rows.as_mut());
        mechanism.project(t, y, &self.rows, &mut self.change);
        let velocities = y.as_mut().iter_mut().skip(7 * mechanism.description().bodies.len());
        for (velocity, change) in velocities.zip(self.change.as_ref()) {
            *velocity = *velocity + *change;
        }
        check_finite(t, y.as_ref())
    }

    /// Whether a singular pose is so near that the rows' rates are nothing but rounding.
    fn is_noise(&self, mechanism: &M, t: M::Scalar, y: &M::State) -> bool {
        if !self.has_poses {
            return false;
        }
        let rate = violation(mechanism, self.rows.as_ref()).value;
        let speed = pivoting::fastest(mechanism, y);
        mechanism.clearance(t, y).is_some_and(|clearance| pivoting::is_noise(rate, clearance.pivot, speed))
    }

    fn correct_positions(&mut self, mechanism: &M, t: M::Scalar, y: &mut M::State) -> Result<(), Error> {
        let tolerance = M::Scalar::EPSILON * M::Scalar::constant(CONVERGED_EPSILONS);
        let mut worst = Violation { value: tolerance, owner: None };
        for iteration in 0..=MAX_ITERATIONS {
            let positions = &mut y.as_mut()[..7 * mechanism.description().bodies.len()];
            positions.chunks_exact_mut(7).for_each(|body| normalise(&mut body[3..]));
            mechanism.phi(t, y, &mut self.phi);
            worst = constraint_violation(mechanism, self.phi.as_ref(), |x| x);
            let is_small = worst.value <= tolerance || worst.value <= tolerance * reach(mechanism, y);
            if is_small && !(self.has_poses && iteration == 0) {
                return Ok(());
            }
            if iteration > 0 && is_met(mechanism, t, y, &self.phi) {
                return Ok(());
            }
            silence(mechanism, t, y, &mut self.phi);
            self.rows.as_mut().iter_mut().zip(self.phi.as_ref()).for_each(|(row, phi)| *row = -*phi);
            mechanism.project(t, y, &self.rows, &mut self.change);
            self.refuse_jump(mechanism, t, worst.owner)?;
            let (positions, velocities) = y.as_mut().split_at_mut(7 * mechanism.description().bodies.len());
            let bodies = positions.chunks_exact_mut(7).zip(velocities.chunks_exact_mut(6));
            for ((position, velocity), change) in bodies.zip(self.change.as_ref().chunks_exact(6)) {
                displace(position, change);
                turn(velocity, change);
            }
        }
        let owner = worst.owner.unwrap_or(Owner::Body(0));
        Err(Error::NoConvergence { t: t.to_f64(), violation: worst.value.to_f64(), owner })
    }

    /// What is not finite is left to be noticed later.
    fn refuse_jump(&self, mechanism: &M, t: M::Scalar, owner: Option<Owner>) -> Result<(), Error> {
        let limit = M::Scalar::constant(FARTHEST);
        for (index, change) in self.change.as_ref().iter().enumerate() {
            let change = if index % 6 < 3 { *change / mechanism.size() } else { *change }.abs();
            if change > limit {
                let owner = owner.unwrap_or(Owner::Body(0));
                return Err(Error::Jump { t: t.to_f64(), change: change.to_f64(), limit: FARTHEST, owner });
            }
        }
        Ok(())
    }
}

impl<M> Correction<Exact, M> for MassWeighted<M>
where
    M: Partition<Scalar: Real> + Kinematics + Projection + Dynamics,
{
    fn correct(&mut self, mechanism: &M, t: M::Scalar, y: &mut M::State) -> Result<(), Error> {
        self.correct(mechanism, t, y)
    }
    fn violation(&mut self, mechanism: &M, t: M::Scalar, y: &M::State) -> M::Scalar {
        mechanism.phi(t, y, &mut self.phi);
        constraint_violation(mechanism, self.phi.as_ref(), |x| x).value
    }
    fn clearance(&self, mechanism: &M, t: M::Scalar, y: &M::State) -> Option<Clearance<M::Scalar>> {
        mechanism.clearance(t, y)
    }
}

/// Exact equations are exact with a Jacobian too.
impl<M, Dualled, S, J, const N: usize> Correction<ByDuals<Exact, Dualled, S, J, N>, M> for MassWeighted<M>
where
    M: Partition<Scalar: Real> + Kinematics + Projection + Dynamics,
    ByDuals<Exact, Dualled, S, J, N>: Ode<M, Scalar = M::Scalar, State = M::State>,
{
    fn correct(&mut self, mechanism: &M, t: M::Scalar, y: &mut M::State) -> Result<(), Error> {
        self.correct(mechanism, t, y)
    }
    fn violation(&mut self, mechanism: &M, t: M::Scalar, y: &M::State) -> M::Scalar {
        Correction::<Exact, M>::violation(self, mechanism, t, y)
    }
    fn clearance(&self, mechanism: &M, t: M::Scalar, y: &M::State) -> Option<Clearance<M::Scalar>> {
        mechanism.clearance(t, y)
    }
}

fn negate<T: Scalar>(numbers: &mut [T]) {
    numbers.iter_mut().for_each(|x| *x = -*x);
}

/// `r + δr` and `p + ½ G(p)ᵀ δπ'` of one body.
fn displace<T: Scalar>(position: &mut [T], change: &[T]) {
    let [r0, r1, r2, e0, e1, e2, e3] = position else { return };
    let [d0, d1, d2, x, y, z] = change else { return };
    (*r0, *r1, *r2) = (*r0 + *d0, *r1 + *d1, *r2 + *d2);
    let half = T::constant(0.5);
    let (x, y, z) = (half * *x, half * *y, half * *z);
    let p = [*e0, *e1, *e2, *e3];
    *e0 = p[0] - p[1] * x - p[2] * y - p[3] * z;
    *e1 = p[1] + p[0] * x - p[3] * y + p[2] * z;
    *e2 = p[2] + p[3] * x + p[0] * y - p[1] * z;
    *e3 = p[3] - p[2] * x + p[1] * y + p[0] * z;
}

/// `w' − ½ δπ' × w'` of one body: the angular velocity that belongs to the same ṗ.
fn turn<T: Scalar>(velocity: &mut [T], change: &[T]) {
    let [_, _, _, wx, wy, wz] = velocity else { return };
    let [_, _, _, x, y, z] = change else { return };
    let half = T::constant(0.5);
    let w = [*wx, *wy, *wz];
    *wx = w[0] - half * (*y * w[2] - *z * w[1]);
    *wy = w[1] - half * (*z * w[0] - *x * w[2]);
    *wz = w[2] - half * (*x * w[1] - *y * w[0]);
}
