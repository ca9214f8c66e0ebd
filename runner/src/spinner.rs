//! A rotor of 1 kg·m² on an axle along x, turned by a torque: the smallest mechanism, for the tests of this crate.

use crate::Start;
use gyro_sim::{
    Buffers, Coordinate, CorrectedDynamics, Description, Dynamics, Energy, Error, JointInfo, Mechanism,
    OutputInfo, Owner, Partition, RowInfo, charts,
};

/// State: r, p, s, w'.
#[derive(Debug, Default)]
pub(crate) struct Spinner {
    /// At the start.
    pub(crate) rate: f64,
    /// The only input.
    pub(crate) torque: f64,
}

impl Spinner {
    pub(crate) fn initial(&self) -> Start {
        let state = self.start();
        Start {
            positions: state[..7].to_vec(),
            velocities: state[7..].to_vec(),
            turn_references: vec![],
            angles: vec![0.0],
            inputs: vec![],
            observed_bodies: vec![0],
        }
    }

    /// The tangent ½ p∘(1, 0, 0).
    fn tangent([_, _, _, e0, e1, e2, e3, ..]: &[f64; 13]) -> [[f64; 4]; 1] {
        [[-0.5 * e1, 0.5 * e0, 0.5 * e3, -0.5 * e2]]
    }
}

impl Mechanism for Spinner {
    type Scalar = f64;
    type State = [f64; 13];
    type Rows = [f64; 5];
    type Constraints = [f64; 6];
    type Velocities = [f64; 6];
    type Readings = [f64; 3];
    type Outputs = [f64; 1];

    fn description(&self) -> &Description<'_> {
        const ROWS: [RowInfo; 5] = {
            const LENGTH: RowInfo = RowInfo { owner: Owner::Joint(0), is_length: true };
            const NUMBER: RowInfo = RowInfo { owner: Owner::Joint(0), is_length: false };
            [LENGTH, LENGTH, LENGTH, NUMBER, NUMBER]
        };
        const DESCRIPTION: Description<'static> = Description {
            size: 1.0,
            bodies: &["rotor"],
            joints: &[JointInfo { name: "axle", coordinates: &[Coordinate::Angle] }],
            couplers: &["gear"],
            drivers: &["crank"],
            rows: &ROWS,
            has_work: false,
            turn_references: &[],
            inputs: &["torque"],
            outputs: &[OutputInfo { name: "motor", suffix: "", unit: "N*m" }],
        };
        &DESCRIPTION
    }
    fn buffers(&self) -> Buffers<Self> {
        Buffers {
            rows: [0.0; 5],
            constraints: [0.0; 6],
            velocities: [0.0; 6],
            readings: [0.0; 3],
            outputs: [0.0],
        }
    }

    fn start(&self) -> [f64; 13] {
        let mut state = [0.0; 13];
        (state[3], state[10]) = (1.0, self.rate);
        state
    }

    fn phi(&self, _: f64, y: &[f64; 13], out: &mut [f64; 6]) {
        let norm: f64 = y[3..7].iter().map(|e| e * e).sum();
        *out = [y[0], y[1], y[2], y[5], y[6], norm - 1.0];
    }
    fn velocity_residual(&self, _: f64, y: &[f64; 13], out: &mut [f64; 5]) {
        *out = [y[7], y[8], y[9], y[11], y[12]];
    }
    fn applied_force(&self, _: f64, _: &[f64; 13], out: &mut [f64; 6]) {
        *out = [0.0, 0.0, 0.0, self.torque, 0.0, 0.0];
    }
    fn energy(&self, _: f64, y: &[f64; 13]) -> Energy<f64> {
        Energy { kinetic: 0.5 * y[10] * y[10], potential: 0.0 }
    }
    fn read_joints(&self, _: f64, y: &[f64; 13], out: &mut [f64; 3]) {
        *out = [2.0 * y[3] * y[4], y[3] * y[3] - y[4] * y[4], y[10]];
    }
    /// The torque goes in and comes out.
    fn outputs(&self, _: f64, _: &[f64; 13], out: &mut [f64; 1]) {
        *out = [self.torque];
    }
    fn set_input(&mut self, index: usize, value: f64) -> bool {
        if index == 0 {
            self.torque = value;
        }
        index == 0
    }
}

impl Dynamics for Spinner {
    type Accelerations = [f64; 6];

    fn acceleration_buffer(&self) -> [f64; 6] {
        [0.0; 6]
    }
    fn accelerations(&self, _: f64, _: &[f64; 13], out: &mut [f64; 6]) {
        *out = [0.0, 0.0, 0.0, self.torque, 0.0, 0.0];
    }
    fn multipliers(&self, _: f64, _: &[f64; 13], _: &[f64; 6], lambda: &mut [f64; 5]) {
        *lambda = [0.0; 5];
    }
    fn derivative(&self, _: f64, y: &[f64; 13], dy: &mut [f64; 13]) {
        *dy = [0.0; 13];
        for (rate, tangent) in dy[3..7].iter_mut().zip(Self::tangent(y)[0]) {
            *rate = tangent * y[10];
        }
        dy[10] = self.torque;
    }
}

impl CorrectedDynamics for Spinner {
    fn corrected_accelerations(&self, t: f64, y: &[f64; 13], out: &mut [f64; 6]) {
        self.accelerations(t, y, out);
    }
    fn corrected_derivative(&self, t: f64, y: &[f64; 13], dy: &mut [f64; 13]) {
        self.derivative(t, y, dy);
    }
}

impl Partition for Spinner {
    type Independent = charts::Charts<f64, 1>;

    fn independent(&self, _: f64, y: &[f64; 13]) -> Self::Independent {
        charts::best(&Self::tangent(y))
    }
    fn follow(&self, _: f64, y: &[f64; 13], choice: &mut Self::Independent) -> u32 {
        charts::follow(&Self::tangent(y), choice)
    }
    fn newton_step(&self, _: f64, choice: &Self::Independent, y: &mut [f64; 13]) -> Result<(), Error> {
        (y[5], y[6]) = (0.0, 0.0);
        let (independent, dependent) = if choice[0] == 0 { (3, 4) } else { (4, 3) };
        y[dependent] = (1.0 - y[independent] * y[independent]).sqrt().copysign(y[dependent]);
        Ok(())
    }
    fn solve_velocities(&self, _: f64, _: &Self::Independent, y: &mut [f64; 13]) -> Result<(), Error> {
        (y[11], y[12]) = (0.0, 0.0);
        Ok(())
    }
}
