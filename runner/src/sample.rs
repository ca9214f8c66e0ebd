//! What is recorded at a sample time.

use gyro_sim::{JointCoordinate, Mechanism, Real, Turns, violation};

/// The mechanism at one time, in `f64` whatever the run's precision.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// Time, s.
    pub t: f64,
    /// Every joint, in the order of the page.
    pub joints: Vec<JointSample>,
    /// The bodies that were asked for.
    pub bodies: Vec<BodySample>,
    /// Kinetic energy, J.
    pub kinetic: f64,
    /// Potential energy, J.
    pub potential: f64,
    /// Work of non-conservative forces and drivers so far, J.
    pub work: f64,
    /// Worst joint row of Φ; lengths divided by the mechanism's size.
    pub position_violation: f64,
    /// Worst joint row of `Φ_r s + Φ_π' w' − ν`, 1/s; lengths divided by the mechanism's size.
    pub velocity_violation: f64,
    /// Worst `|pᵀp − 1|` of all bodies, eq. (12).
    pub norm_violation: f64,
    /// How often independent coordinates have been chosen anew so far.
    pub chart_switches: u64,
}

/// A joint's coordinate and rate: continuous angles in rad, orientations as Euler parameters with the relative angular
/// velocity in the second body's frame.
pub type JointSample = JointCoordinate<f64>;

/// Pose and velocity of a body: `(r, p)` and `(s, w')`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodySample {
    /// Position of the mass centre, m, and Euler parameters.
    pub pose: [f64; 7],
    /// Velocity of the mass centre, m/s, and angular velocity in the body's frame, rad/s.
    pub velocity: [f64; 6],
}

impl Sample {
    /// Total energy, J.
    pub fn energy(&self) -> f64 {
        self.kinetic + self.potential
    }
}

/// Takes samples; holds the buffers that this needs.
#[derive(Debug)]
pub(crate) struct Observer<'a, M: Mechanism> {
    mechanism: &'a M,
    observed_bodies: &'a [usize],
    phi: M::Constraints,
    residual: M::Rows,
}

impl<'a, M: Mechanism<Scalar: Real>> Observer<'a, M> {
    pub(crate) fn new(mechanism: &'a M, observed_bodies: &'a [usize]) -> Self {
        Self { mechanism, observed_bodies, phi: mechanism.constraints(), residual: mechanism.rows() }
    }

    pub(crate) fn sample(&mut self, t: f64, y: &M::State, turns: &Turns<M>, chart_switches: u64) -> Sample {
        let mechanism = self.mechanism;
        let energy = mechanism.energy(y);
        let [position_violation, velocity_violation, norm_violation] = self.violations(t, y);
        Sample {
            t,
            joints: (0..mechanism.n_joints()).map(|j| in_f64(turns.joint(mechanism, j))).collect(),
            bodies: self.observed_bodies.iter().map(|&slot| body(mechanism, slot, y)).collect(),
            kinetic: energy.kinetic.to_f64(),
            potential: energy.potential.to_f64(),
            work: mechanism.work(y).to_f64(),
            position_violation,
            velocity_violation,
            norm_violation,
            chart_switches,
        }
    }

    /// Of the joint rows of Φ, of the velocity residual, and of the normalisations.
    fn violations(&mut self, t: f64, y: &M::State) -> [f64; 3] {
        let (mechanism, t) = (self.mechanism, <M::Scalar as gyro_sim::Scalar>::constant(t));
        mechanism.phi(t, y, &mut self.phi);
        mechanism.velocity_residual(t, y, &mut self.residual);
        let phi = self.phi.as_ref();
        let (joint_rows, norms) = phi.split_at(phi.len() - mechanism.n_bodies());
        let worst = |rows| violation(mechanism, rows).value.to_f64();
        let worst_norm = norms.iter().map(|norm| norm.abs().to_f64()).fold(0.0, f64::max);
        [worst(joint_rows), worst(self.residual.as_ref()), worst_norm]
    }
}

fn in_f64<T: Real>(coordinate: JointCoordinate<T>) -> JointSample {
    match coordinate {
        JointCoordinate::Angle { position, rate } => {
            JointSample::Angle { position: position.to_f64(), rate: rate.to_f64() }
        }
        JointCoordinate::Orientation { position, rate } => {
            JointSample::Orientation { position: position.map(Real::to_f64), rate: rate.map(Real::to_f64) }
        }
        JointCoordinate::None => JointSample::None,
    }
}

fn body<M: Mechanism<Scalar: Real>>(mechanism: &M, slot: usize, y: &M::State) -> BodySample {
    let (y, velocities) = (y.as_ref(), 7 * mechanism.n_bodies());
    BodySample {
        pose: std::array::from_fn(|k| y[7 * slot + k].to_f64()),
        velocity: std::array::from_fn(|k| y[velocities + 6 * slot + k].to_f64()),
    }
}
