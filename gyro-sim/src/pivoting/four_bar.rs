//! A planar four-bar linkage of uniform rods of 1 kg, in the plane z = 0, as a hand-written mechanism for the tests.
//!
//! Bodies 0 (crank), 1 (coupler), 2 (rocker) have their x axes along the rods. Pins 0 to 3: ground and crank at the
//! origin, crank and coupler, coupler and rocker, ground and rocker at `(ground, 0)`. Directions are `(e0² − e3², 2 e0
//! e3)`, whatever e1 and e2. Pin 0 shows the crank's angle, pin 1 the coupler's x coordinate and its angle against the
//! crank.

use crate::{
    Buffers, Coordinate, CorrectedDynamics, Description, Dynamics, Energy, Error, JointInfo, Kinematics,
    Mechanism, Owner, Partition, RowInfo, Terms,
};
use crate::{pivoting, pivoting::Pivots};

pub(super) const NC: usize = 20;
pub(super) const NQ: usize = 21;
const JOINT_ROWS: usize = 17;
const NON_ZEROS: usize = 57;
pub(super) type State = [f64; 39];

/// For each pin the two rods that it joins, with the sign of the end on the rod's x axis.
const PINS: [[Option<(usize, f64)>; 2]; 4] = [
    [None, Some((0, -1.0))],
    [Some((0, 1.0)), Some((1, -1.0))],
    [Some((1, 1.0)), Some((2, 1.0))],
    [None, Some((2, -1.0))],
];

#[derive(Clone, Debug)]
pub(super) struct FourBar {
    pub(super) ground: f64,
    /// Lengths of crank, coupler and rocker.
    pub(super) rods: [f64; 3],
    /// Along −y.
    pub(super) gravity: f64,
    /// Row and column of each non-zero of Φ_q.
    pattern: [(u16, u16); NON_ZEROS],
}

impl FourBar {
    pub(super) fn new(ground: f64, rods: [f64; 3], gravity: f64) -> Self {
        let mut bar = Self { ground, rods, gravity, pattern: [(0, 0); NON_ZEROS] };
        let (mut at, mut pattern) = (0, [(0, 0); NON_ZEROS]);
        bar.each_phi_q(&[0.0; 39], |row, column, _| {
            pattern[at] = (row as u16, column as u16);
            at += 1;
        });
        assert_eq!(at, NON_ZEROS);
        bar.pattern = pattern;
        bar
    }

    /// Directions of the rods (cosine and sine) at a crank angle, with the pin of coupler and rocker on the left (+1)
    /// or the right (−1) of the line from the crank's end to the rocker's ground pin.
    pub(super) fn directions(&self, crank: f64, side: f64) -> [[f64; 2]; 3] {
        let [a, b, c] = self.rods;
        let (cos, sin) = (libm::cos(crank), libm::sin(crank));
        let (dx, dy) = (self.ground - a * cos, -a * sin);
        let distance = libm::hypot(dx, dy);
        let along = (distance * distance + b * b - c * c) / (2.0 * distance);
        let across = side * libm::sqrt((b * b - along * along).max(0.0));
        let (ux, uy) = (dx / distance, dy / distance);
        let pin = [along * ux - across * uy, along * uy + across * ux];
        [[cos, sin], [pin[0] / b, pin[1] / b], [(pin[0] - dx) / c, (pin[1] - dy) / c]]
    }

    /// The state at a crank angle and crank rate.
    pub(super) fn state(&self, crank: f64, side: f64, rate: f64) -> State {
        let directions = self.directions(crank, side);
        let [[c1, s1], [c2, s2], [c3, s3]] = directions;
        let [a, b, c] = self.rods;
        // a ω1 n1 + b ω2 n2 = c ω3 n3, with n the normals.
        let determinant = b * c * (c2 * s3 - s2 * c3);
        let rates = [
            rate,
            a * rate * c * (s1 * c3 - c1 * s3) / determinant,
            -a * rate * b * (c1 * s2 - s1 * c2) / determinant,
        ];
        let mut y = [0.0; 39];
        let ends = [[0.0, 0.0], [a * c1, a * s1], [self.ground, 0.0]];
        let end_rates = [[0.0, 0.0], [-a * rate * s1, a * rate * c1], [0.0, 0.0]];
        for body in 0..3 {
            let ([cos, sin], half) = (directions[body], 0.5 * self.rods[body]);
            let half_angle = 0.5 * libm::atan2(sin, cos);
            y[7 * body] = ends[body][0] + half * cos;
            y[7 * body + 1] = ends[body][1] + half * sin;
            (y[7 * body + 3], y[7 * body + 6]) = (libm::cos(half_angle), libm::sin(half_angle));
            y[21 + 6 * body] = end_rates[body][0] - half * rates[body] * sin;
            y[21 + 6 * body + 1] = end_rates[body][1] + half * rates[body] * cos;
            y[21 + 6 * body + 5] = rates[body];
        }
        y
    }

    /// Where the rods point: cosine and sine.
    pub(super) fn direction(y: &State, body: usize) -> [f64; 2] {
        let (e0, e3) = (y[7 * body + 3], y[7 * body + 6]);
        [e0 * e0 - e3 * e3, 2.0 * e0 * e3]
    }

    /// Calls `f` with row, column and value of each non-zero of Φ_q, row by row.
    fn each_phi_q(&self, y: &State, mut f: impl FnMut(usize, usize, f64)) {
        for (pin, ends) in PINS.iter().enumerate() {
            for axis in 0..2 {
                for (end, sign) in ends.iter().zip([-1.0, 1.0]) {
                    let Some((body, along)) = *end else { continue };
                    let (e0, e3) = (y[7 * body + 3], y[7 * body + 6]);
                    let arm = sign * along * self.rods[body];
                    let slopes = [[e0, -e3], [e3, e0]][axis];
                    f(2 * pin + axis, 7 * body + axis, sign);
                    f(2 * pin + axis, 7 * body + 3, arm * slopes[0]);
                    f(2 * pin + axis, 7 * body + 6, arm * slopes[1]);
                }
            }
        }
        for body in 0..3 {
            (0..3).for_each(|k| f(8 + 3 * body + k, 7 * body + [2, 4, 5][k], 1.0));
        }
        for body in 0..3 {
            (3..7).for_each(|k| f(JOINT_ROWS + body, 7 * body + k, 2.0 * y[7 * body + k]));
        }
    }

    fn q_dot(y: &State) -> [f64; NQ] {
        let mut q_dot = [0.0; NQ];
        for body in 0..3 {
            let [_, _, _, e0, e1, e2, e3] = y[7 * body..7 * body + 7] else { return q_dot };
            let [sx, sy, sz, wx, wy, wz] = y[21 + 6 * body..27 + 6 * body] else { return q_dot };
            q_dot[7 * body..7 * body + 7].copy_from_slice(&[
                sx,
                sy,
                sz,
                -0.5 * (e1 * wx + e2 * wy + e3 * wz),
                0.5 * (e0 * wx - e3 * wy + e2 * wz),
                0.5 * (e3 * wx + e0 * wy - e1 * wz),
                0.5 * (e1 * wy - e2 * wx + e0 * wz),
            ]);
        }
        q_dot
    }

    /// `(ẍ, ÿ, ω̇)` of each rod and the forces in the pins, from eq. (17) in the plane.
    fn solve(&self, y: &State) -> [f64; 17] {
        let mut matrix = [[0.0; 18]; 17];
        for body in 0..3 {
            matrix[3 * body][3 * body] = 1.0;
            matrix[3 * body + 1][3 * body + 1] = 1.0;
            matrix[3 * body + 1][17] = -self.gravity;
            matrix[3 * body + 2][3 * body + 2] = self.rods[body] * self.rods[body] / 12.0;
        }
        for (pin, ends) in PINS.iter().enumerate() {
            for (end, sign) in ends.iter().zip([-1.0, 1.0]) {
                let Some((body, along)) = *end else { continue };
                let ([cos, sin], rate) = (Self::direction(y, body), y[21 + 6 * body + 5]);
                let arm = 0.5 * along * self.rods[body];
                for axis in 0..2 {
                    let row = 9 + 2 * pin + axis;
                    let slope = sign * arm * [-sin, cos][axis];
                    (matrix[row][3 * body + axis], matrix[3 * body + axis][row]) = (sign, sign);
                    (matrix[row][3 * body + 2], matrix[3 * body + 2][row]) = (slope, slope);
                    matrix[row][17] += sign * arm * rate * rate * [cos, sin][axis];
                }
            }
        }
        gauss(matrix)
    }
}

/// Gaussian elimination with row pivoting.
fn gauss(mut m: [[f64; 18]; 17]) -> [f64; 17] {
    for k in 0..17 {
        let pivot = (k..17).max_by(|a, b| m[*a][k].abs().total_cmp(&m[*b][k].abs())).unwrap_or(k);
        m.swap(k, pivot);
        for row in k + 1..17 {
            let factor = m[row][k] / m[k][k];
            let upper = m[k];
            m[row].iter_mut().zip(upper).skip(k).for_each(|(x, u)| *x -= factor * u);
        }
    }
    let mut x = [0.0; 17];
    for k in (0..17).rev() {
        let known: f64 = (k + 1..17).map(|column| m[k][column] * x[column]).sum();
        x[k] = (m[k][17] - known) / m[k][k];
    }
    x
}

impl Mechanism for FourBar {
    type Scalar = f64;
    type State = State;
    type Rows = [f64; JOINT_ROWS];
    type Constraints = [f64; NC];
    type Velocities = [f64; 18];
    type Readings = [f64; 8];
    type Outputs = [f64; 0];

    fn description(&self) -> &Description<'_> {
        const NONE: &[Coordinate] = &[];
        const JOINTS: [JointInfo<'static>; 4] = [
            JointInfo { name: "a", coordinates: &[Coordinate::Angle] },
            JointInfo { name: "b", coordinates: &[Coordinate::Length, Coordinate::Angle] },
            JointInfo { name: "c", coordinates: NONE },
            JointInfo { name: "d", coordinates: NONE },
        ];
        const ROWS: [RowInfo; JOINT_ROWS] = {
            let mut rows = [RowInfo { owner: Owner::Joint(0), is_length: true }; JOINT_ROWS];
            let mut row = 0;
            while row < JOINT_ROWS {
                rows[row].owner =
                    if row < 8 { Owner::Joint(row as u16 / 2) } else { Owner::Body((row as u16 - 8) / 3) };
                rows[row].is_length = row < 8 || (row - 8) % 3 == 0;
                row += 1;
            }
            rows
        };
        const DESCRIPTION: Description<'static> = Description {
            size: 0.0,
            bodies: &["crank", "coupler", "rocker"],
            joints: &JOINTS,
            couplers: &[],
            drivers: &[],
            rows: &ROWS,
            has_work: false,
            turn_references: &[],
            inputs: &[],
            outputs: &[],
        };
        &DESCRIPTION
    }
    fn buffers(&self) -> Buffers<Self> {
        Buffers {
            rows: [0.0; JOINT_ROWS],
            constraints: [0.0; NC],
            velocities: [0.0; 18],
            readings: [0.0; 8],
            outputs: [],
        }
    }
    /// Of these rods: the description is that of all.
    fn size(&self) -> f64 {
        0.5 * self.rods.into_iter().fold(0.0, f64::max)
    }

    fn start(&self) -> State {
        self.state(1.0, 1.0, 0.0)
    }

    fn phi(&self, _: f64, y: &State, out: &mut Self::Constraints) {
        *out = [0.0; NC];
        for (pin, ends) in PINS.iter().enumerate() {
            for (end, sign) in ends.iter().zip([-1.0, 1.0]) {
                for axis in 0..2 {
                    out[2 * pin + axis] += sign
                        * match *end {
                            Some((body, along)) => {
                                let arm = 0.5 * along * self.rods[body];
                                y[7 * body + axis] + arm * Self::direction(y, body)[axis]
                            }
                            None => [[0.0, 0.0], [self.ground, 0.0]][pin / 2][axis],
                        };
                }
            }
        }
        for body in 0..3 {
            (0..3).for_each(|k| out[8 + 3 * body + k] = y[7 * body + [2, 4, 5][k]]);
            out[JOINT_ROWS + body] = y[7 * body + 3..7 * body + 7].iter().map(|e| e * e).sum::<f64>() - 1.0;
        }
    }
    fn velocity_residual(&self, _: f64, y: &State, out: &mut Self::Rows) {
        *out = [0.0; JOINT_ROWS];
        let q_dot = Self::q_dot(y);
        self.each_phi_q(y, |row, column, value| {
            if let Some(out) = out.get_mut(row) {
                *out += value * q_dot[column];
            }
        });
    }
    fn applied_force(&self, _: f64, _: &State, _: &mut [f64; 18]) {}
    fn energy(&self, _: f64, y: &State) -> Energy<f64> {
        let mut energy = Energy { kinetic: 0.0, potential: 0.0 };
        for body in 0..3 {
            let (v, inertia) = (&y[21 + 6 * body..27 + 6 * body], self.rods[body] * self.rods[body] / 12.0);
            energy.kinetic += 0.5 * (v[0] * v[0] + v[1] * v[1] + inertia * v[5] * v[5]);
            energy.potential += self.gravity * y[7 * body + 1];
        }
        energy
    }
    fn read_joints(&self, _: f64, y: &State, out: &mut [f64; 8]) {
        let ([[c1, s1], [c2, s2]], [v1, v2]) = ([0, 1].map(|body| Self::direction(y, body)), [y[26], y[32]]);
        *out = [s1, c1, v1, y[7], y[27], s2 * c1 - c2 * s1, c2 * c1 + s2 * s1, v2 - v1];
    }
    fn outputs(&self, _: f64, _: &State, _: &mut [f64; 0]) {}
    fn set_input(&mut self, _: usize, _: f64) -> bool {
        false
    }
}

impl Kinematics for FourBar {
    type PhiQ = [f64; NON_ZEROS];
    type PhiPi = [f64; 0];

    fn terms(&self) -> Terms<Self> {
        Terms { phi_q: [0.0; NON_ZEROS], phi_pi: [] }
    }
    fn phi_q_pattern(&self) -> &[(u16, u16)] {
        &self.pattern
    }
    fn phi_pi_pattern(&self) -> &[(u16, u16)] {
        &[]
    }
    fn phi_q(&self, _: f64, y: &State, out: &mut [f64; NON_ZEROS]) {
        let mut values = out.iter_mut();
        self.each_phi_q(y, |_, _, value| values.next().into_iter().for_each(|out| *out = value));
    }
    fn phi_pi(&self, _: f64, _: &State, _: &mut [f64; 0]) {}
    fn nu(&self, _: f64, _: &State, out: &mut Self::Rows) {
        *out = [0.0; JOINT_ROWS];
    }
    fn gamma(&self, _: f64, _: &State, _: &mut Self::Rows) {}
}

impl Dynamics for FourBar {
    type Accelerations = [f64; 18];

    fn acceleration_buffer(&self) -> [f64; 18] {
        [0.0; 18]
    }
    fn accelerations(&self, _: f64, y: &State, out: &mut [f64; 18]) {
        let solution = self.solve(y);
        for body in 0..3 {
            (out[6 * body], out[6 * body + 1]) = (solution[3 * body], solution[3 * body + 1]);
            out[6 * body + 5] = solution[3 * body + 2];
        }
    }
    fn multipliers(&self, _: f64, y: &State, _: &[f64; 18], lambda: &mut Self::Rows) {
        lambda[..8].copy_from_slice(&self.solve(y)[9..]);
    }
    fn derivative(&self, t: f64, y: &State, dy: &mut State) {
        dy[..NQ].copy_from_slice(&Self::q_dot(y));
        let mut accelerations = self.acceleration_buffer();
        self.accelerations(t, y, &mut accelerations);
        dy[NQ..].copy_from_slice(&accelerations);
    }
}

impl CorrectedDynamics for FourBar {
    fn corrected_accelerations(&self, t: f64, y: &State, out: &mut [f64; 18]) {
        self.accelerations(t, y, out);
    }
    fn corrected_derivative(&self, t: f64, y: &State, dy: &mut State) {
        self.derivative(t, y, dy);
    }
}

impl Partition for FourBar {
    type Independent = Pivots<NC, NQ>;

    fn independent(&self, t: f64, y: &State) -> Pivots<NC, NQ> {
        pivoting::independent(self, t, y)
    }
    fn follow(&self, t: f64, y: &State, choice: &mut Pivots<NC, NQ>) -> u32 {
        pivoting::follow(self, t, y, choice)
    }
    fn newton_step(&self, t: f64, choice: &Pivots<NC, NQ>, y: &mut State) -> Result<(), Error> {
        pivoting::newton_step(self, t, choice, y)
    }
    fn solve_velocities(&self, t: f64, choice: &Pivots<NC, NQ>, y: &mut State) -> Result<(), Error> {
        pivoting::solve_velocities(self, t, choice, y)
    }
}
