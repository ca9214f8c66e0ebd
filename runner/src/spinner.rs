//! A rotor of 1 kg·m² on an axle along x, turned by a torque and braked by a viscous bearing: the smallest mechanism,
//! and a linear one, for the tests of this crate.

use crate::Start;
use gyro_sim::{
    Buffers, Coordinate, CorrectedDynamics, Description, Dynamics, Energy, Error, JointInfo, Mechanism,
    OutputInfo, Owner, Partition, RowInfo, Scalar, charts,
};

/// State: r, p, s, w'.
#[derive(Clone, Debug, Default)]
pub(crate) struct Spinner<T = f64> {
    /// At the start.
    pub(crate) rate: T,
    /// The only input.
    pub(crate) torque: T,
    /// Of the bearing, N·m·s.
    pub(crate) friction: T,
}

fn zero<T: Scalar>() -> T {
    T::constant(0.0)
}

impl<T: Scalar> Spinner<T> {
    fn moment(&self, y: &[T; 13]) -> T {
        self.torque - self.friction * y[10]
    }

    /// The tangent ½ p∘(1, 0, 0).
    fn tangent([_, _, _, e0, e1, e2, e3, ..]: &[T; 13]) -> [[T; 4]; 1] {
        let [plus, minus] = [0.5, -0.5].map(T::constant);
        [[minus * *e1, plus * *e0, plus * *e3, minus * *e2]]
    }
}

impl Spinner {
    pub(crate) fn initial(&self) -> Start {
        let state = self.start();
        Start {
            positions: state[..7].to_vec(),
            velocities: state[7..].to_vec(),
            states: vec![],
            turn_references: vec![],
            angles: vec![0.0],
            inputs: vec![],
            knots: vec![],
            observed_bodies: vec![0],
            controllers: vec![],
            watches: vec![],
            kinks: vec![],
            contacts: vec![],
            paths: vec![],
        }
    }
}

impl<T: Scalar> Mechanism for Spinner<T> {
    type Scalar = T;
    type State = [T; 13];
    type Rows = [T; 5];
    type Constraints = [T; 6];
    type Velocities = [T; 6];
    type Readings = [T; 3];
    type Outputs = [T; 1];

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
            rows: [zero(); 5],
            constraints: [zero(); 6],
            velocities: [zero(); 6],
            readings: [zero(); 3],
            outputs: [zero()],
        }
    }

    fn start(&self) -> [T; 13] {
        let mut state = [zero(); 13];
        (state[3], state[10]) = (T::constant(1.0), self.rate);
        state
    }

    fn phi(&self, _: T, y: &[T; 13], out: &mut [T; 6]) {
        let norm = y[3..7].iter().fold(T::constant(-1.0), |sum, e| sum + *e * *e);
        *out = [y[0], y[1], y[2], y[5], y[6], norm];
    }
    fn velocity_residual(&self, _: T, y: &[T; 13], out: &mut [T; 5]) {
        *out = [y[7], y[8], y[9], y[11], y[12]];
    }
    fn applied_force(&self, _: T, y: &[T; 13], out: &mut [T; 6]) {
        *out = [zero(), zero(), zero(), self.moment(y), zero(), zero()];
    }
    fn energy(&self, _: T, y: &[T; 13]) -> Energy<T> {
        Energy { kinetic: T::constant(0.5) * y[10] * y[10], potential: zero() }
    }
    fn read_joints(&self, _: T, y: &[T; 13], out: &mut [T; 3]) {
        *out = [T::constant(2.0) * y[3] * y[4], y[3] * y[3] - y[4] * y[4], y[10]];
    }
    /// The torque goes in and comes out.
    fn outputs(&self, _: T, _: &[T; 13], out: &mut [T; 1]) {
        *out = [self.torque];
    }
    fn set_input(&mut self, index: usize, value: T) -> bool {
        if index == 0 {
            self.torque = value;
        }
        index == 0
    }
}

impl<T: Scalar> Dynamics for Spinner<T> {
    type Accelerations = [T; 6];

    fn acceleration_buffer(&self) -> [T; 6] {
        [zero(); 6]
    }
    fn accelerations(&self, _: T, y: &[T; 13], out: &mut [T; 6]) {
        *out = [zero(), zero(), zero(), self.moment(y), zero(), zero()];
    }
    fn multipliers(&self, _: T, _: &[T; 13], _: &[T; 6], lambda: &mut [T; 5]) {
        *lambda = [zero(); 5];
    }
    fn derivative(&self, _: T, y: &[T; 13], dy: &mut [T; 13]) {
        *dy = [zero(); 13];
        for (rate, tangent) in dy[3..7].iter_mut().zip(Self::tangent(y)[0]) {
            *rate = tangent * y[10];
        }
        dy[10] = self.moment(y);
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
