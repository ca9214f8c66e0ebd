//! What is recorded at a sample time.

use gyro_sim::{JointCoordinate, Mechanism, Real, Scalar, Turns, violation};
use nanoserde::{DeBin, SerBin};

/// The mechanism at one time, in `f64` whatever the run's precision.
#[derive(Clone, Debug, Default, PartialEq, SerBin, DeBin)]
pub struct Sample {
    /// Time, s.
    pub t: f64,
    /// Every coordinate of every joint, in the order of the model file.
    pub coordinates: Vec<JointSample>,
    /// Every number of every output, in the order of the model file.
    pub outputs: Vec<f64>,
    /// The inputs that controllers set, controller after controller, and the forces of contacts.
    pub controlled: Vec<f64>,
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

/// A joint's coordinate and rate: continuous angles in rad, displacements in m, orientations as Euler parameters with
/// the relative angular velocity in the second body's frame.
pub type JointSample = JointCoordinate<f64>;

/// Pose and velocity of a body: `(r, p)` and `(s, w')`.
#[derive(Clone, Copy, Debug, PartialEq, SerBin, DeBin)]
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
    observed_bodies: &'a [usize],
    phi: M::Constraints,
    residual: M::Rows,
    outputs: M::Outputs,
}

impl<'a, M: Mechanism<Scalar: Real>> Observer<'a, M> {
    pub(crate) fn new(mechanism: &M, observed_bodies: &'a [usize]) -> Self {
        let (phi, residual) = (mechanism.buffers().constraints, mechanism.buffers().rows);
        Self { observed_bodies, phi, residual, outputs: mechanism.buffers().outputs }
    }

    pub(crate) fn sample(
        &mut self,
        mechanism: &M,
        t: f64,
        y: &M::State,
        turns: &Turns<M>,
        chart_switches: u64,
    ) -> Sample {
        let time = Scalar::constant(t);
        let energy = mechanism.energy(time, y);
        let [position_violation, velocity_violation, norm_violation] = self.violations(mechanism, time, y);
        mechanism.outputs(time, y, &mut self.outputs);
        Sample {
            t,
            coordinates: coordinates(mechanism, turns),
            outputs: self.outputs.as_ref().iter().map(|x| x.to_f64()).collect(),
            controlled: Vec::new(),
            bodies: self.observed_bodies.iter().map(|&moving_body| body(mechanism, moving_body, y)).collect(),
            kinetic: energy.kinetic.to_f64(),
            potential: energy.potential.to_f64(),
            work: mechanism.work(y).to_f64(),
            position_violation,
            velocity_violation,
            norm_violation,
            chart_switches,
        }
    }

    /// The numbers of all outputs.
    pub(crate) fn outputs(&mut self, mechanism: &M, t: M::Scalar, y: &M::State) -> &[M::Scalar] {
        mechanism.outputs(t, y, &mut self.outputs);
        self.outputs.as_ref()
    }

    /// Of the joint rows of Φ, of the velocity residual, and of the normalisations.
    fn violations(&mut self, mechanism: &M, t: M::Scalar, y: &M::State) -> [f64; 3] {
        mechanism.phi(t, y, &mut self.phi);
        mechanism.velocity_residual(t, y, &mut self.residual);
        let phi = self.phi.as_ref();
        let (joint_rows, norms) = phi.split_at(phi.len() - mechanism.description().bodies.len());
        let worst = |rows| violation(mechanism, rows).value.to_f64();
        let worst_norm = norms.iter().map(|norm| norm.abs().to_f64()).fold(0.0, f64::max);
        [worst(joint_rows), worst(self.residual.as_ref()), worst_norm]
    }
}

/// All coordinates of all joints at the last reading.
fn coordinates<M: Mechanism<Scalar: Real>>(mechanism: &M, turns: &Turns<M>) -> Vec<JointSample> {
    let all = (0..mechanism.description().joints.len()).flat_map(|joint| {
        (0..mechanism.description().joints[joint].coordinates.len()).map(move |index| (joint, index))
    });
    all.filter_map(|(joint, index)| turns.coordinate(mechanism, joint, index)).map(in_f64).collect()
}

fn in_f64<T: Real>(coordinate: JointCoordinate<T>) -> JointSample {
    match coordinate {
        JointCoordinate::Angle { position, rate } => {
            JointSample::Angle { position: position.to_f64(), rate: rate.to_f64() }
        }
        JointCoordinate::Length { position, rate } => {
            JointSample::Length { position: position.to_f64(), rate: rate.to_f64() }
        }
        JointCoordinate::Orientation { position, rate } => {
            JointSample::Orientation { position: position.map(Real::to_f64), rate: rate.map(Real::to_f64) }
        }
    }
}

fn body<M: Mechanism<Scalar: Real>>(mechanism: &M, moving_body: usize, y: &M::State) -> BodySample {
    let (y, velocities) = (y.as_ref(), 7 * mechanism.description().bodies.len());
    BodySample {
        pose: std::array::from_fn(|k| y[7 * moving_body + k].to_f64()),
        velocity: std::array::from_fn(|k| y[velocities + 6 * moving_body + k].to_f64()),
    }
}

/// The work of all applied forces over the mechanism's size and of all moments over a radian, J: what energies
/// are rounded against.
pub(crate) fn work_scale<M: Mechanism<Scalar: Real>>(mechanism: &M, t: f64, y: &M::State) -> f64 {
    let mut forces = mechanism.buffers().velocities;
    mechanism.applied_force(Scalar::constant(t), y, &mut forces);
    let size = mechanism.size().to_f64();
    let work = |(k, force): (usize, &M::Scalar)| {
        let force = force.abs().to_f64();
        if k % 6 < 3 { force * size } else { force }
    };
    forces.as_ref().iter().enumerate().map(work).sum()
}
