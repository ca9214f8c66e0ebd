//! The four-bar linkage of `models/four-bar.toml` in joint coordinates that are typed by hand: crank, rocker and elbow
//! are a tree, the knee closes the loop. For the tests of this crate.

use gyro_mechanisms::four_bar::FourBar;
use gyro_sim::{
    Buffers, Clearance, CorrectedDynamics, Description, Dynamics, Energy, Error, JointBuffers, JointLayout,
    JointPlace, JointSpace, Kinematics, Mechanism, Partition, Projection, Real, Scalar, Terms,
};

/// In maximal coordinates it is the generated one.
#[derive(Clone, Debug)]
pub(crate) struct Linkage<T> {
    generated: FourBar<T>,
    /// Between the pivots of crank and rocker.
    pub(crate) ground: T,
}

impl<T: Scalar> Default for Linkage<T> {
    fn default() -> Self {
        Self { generated: FourBar::default(), ground: T::constant(0.5) }
    }
}

/// Of crank, coupler and rocker, along their x axes, from end to end.
const LENGTHS: [f64; 3] = [0.2, 0.5, 0.4];
const MASSES: [f64; 3] = [0.4, 1.0, 0.8];
const INERTIAS: [f64; 3] = [1.35e-3, 2.1e-2, 1.08e-2];
const GRAVITY: f64 = 9.81;

/// Angles of crank, coupler and rocker against the ground, and their rates.
struct Planar<T> {
    cos: [T; 3],
    sin: [T; 3],
    rates: [T; 3],
}

impl<T: Scalar> Planar<T> {
    fn of([crank, rocker, elbow, u_crank, u_rocker, u_elbow]: &[T; 6]) -> Self {
        let angles = [*crank, *crank + *elbow, *rocker];
        let rates = [*u_crank, *u_crank + *u_elbow, *u_rocker];
        Self { cos: angles.map(T::cos), sin: angles.map(T::sin), rates }
    }

    /// The derivatives of the closure by the angles.
    fn jacobian(&self) -> [[T; 3]; 2] {
        let [a, b, c] = LENGTHS.map(T::constant);
        let ([c1, c2, c3], [s1, s2, s3]) = (self.cos, self.sin);
        [[-a * s1, -b * s2, c * s3], [a * c1, b * c2, -c * c3]]
    }

    /// The least change of the angles that changes the closure, or with rates its rate, by minus so much.
    fn least(&self, by: [T; 2]) -> [T; 3] {
        let j = self.jacobian();
        let identity = core::array::from_fn(|k| core::array::from_fn(|l| T::constant(f64::from(k == l))));
        let lambda = multipliers(&j, &identity, by);
        core::array::from_fn(|k| -(j[0][k] * lambda[0] + j[1][k] * lambda[1]))
    }

    fn accelerations(&self) -> [T; 3] {
        let k = T::constant;
        let ([a, b, _], [m1, m2, m3], [i1, i2, i3]) = (LENGTHS, MASSES, INERTIAS);
        let ([c1, c2, c3], [s1, s2, _], [w1, w2, w3]) = (self.cos, self.sin, self.rates);
        let coupled = k(m2 * a * b / 2.0);
        let (cosine, sine) = (c1 * c2 + s1 * s2, s1 * c2 - c1 * s2);
        let own =
            [i1 + (m1 / 4.0 + m2) * a * a, i2 + m2 * b * b / 4.0, i3 + m3 * LENGTHS[2] * LENGTHS[2] / 4.0]
                .map(k);
        let forces = [
            k(-GRAVITY * (m1 / 2.0 + m2) * a) * c1 - coupled * sine * w2 * w2,
            k(-GRAVITY * m2 * b / 2.0) * c2 + coupled * sine * w1 * w1,
            k(-GRAVITY * m3 * LENGTHS[2] / 2.0) * c3,
        ];
        let m12 = coupled * cosine;
        let determinant = own[0] * own[1] - m12 * m12;
        let zero = k(0.0);
        let inverse = [
            [own[1] / determinant, -m12 / determinant, zero],
            [-m12 / determinant, own[0] / determinant, zero],
            [zero, zero, k(1.0) / own[2]],
        ];
        let j = self.jacobian();
        let free = product(&inverse, forces);
        let squares = [w1 * w1, w2 * w2, w3 * w3];
        // J φ̈ = γ.
        let gamma = [dot(&[j[1][0], j[1][1], j[1][2]], &squares), -dot(&j[0], &squares)];
        let by = [dot(&j[0], &free) - gamma[0], dot(&j[1], &free) - gamma[1]];
        let lambda = multipliers(&j, &inverse, by);
        let pulled = product(&inverse, core::array::from_fn(|k| j[0][k] * lambda[0] + j[1][k] * lambda[1]));
        core::array::from_fn(|k| free[k] - pulled[k])
    }
}

fn dot<T: Scalar>(a: &[T; 3], b: &[T; 3]) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn product<T: Scalar>(m: &[[T; 3]; 3], v: [T; 3]) -> [T; 3] {
    core::array::from_fn(|k| dot(&m[k], &v))
}

/// Solves `J M⁻¹ Jᵀ λ = by`.
fn multipliers<T: Scalar>(j: &[[T; 3]; 2], inverse: &[[T; 3]; 3], by: [T; 2]) -> [T; 2] {
    let s = |k: usize, l: usize| dot(&j[k], &product(inverse, j[l]));
    let determinant = s(0, 0) * s(1, 1) - s(0, 1) * s(1, 0);
    [(s(1, 1) * by[0] - s(0, 1) * by[1]) / determinant, (s(0, 0) * by[1] - s(1, 0) * by[0]) / determinant]
}

impl<T: Scalar> JointSpace for Linkage<T> {
    type Joints = [T; 6];
    type Rates = [T; 3];
    type Closure = [T; 2];

    fn joint_layout(&self) -> &JointLayout<'_> {
        const LAYOUT: JointLayout<'static> = JointLayout {
            places: &[
                JointPlace::Scalar { joint: 0, coordinate: 0 },
                JointPlace::Scalar { joint: 1, coordinate: 0 },
                JointPlace::Scalar { joint: 2, coordinate: 0 },
            ],
            closure_rows: &[14, 15],
        };
        &LAYOUT
    }
    fn joint_buffers(&self) -> JointBuffers<Self> {
        let zero = T::constant(0.0);
        JointBuffers { rates: [zero; 3], closure: [zero; 2] }
    }
    fn joint_start(&self) -> [T; 6] {
        let mut x = [1.0, 1.4, -0.6, 0.0, 0.0, 0.0].map(T::constant);
        self.to_joints(T::constant(0.0), &self.start(), &mut x);
        x
    }
    fn joint_accelerations(&self, _: T, x: &[T; 6], out: &mut [T; 3]) {
        let [crank, coupler, rocker] = Planar::of(x).accelerations();
        *out = [crank, rocker, coupler - crank];
    }
    fn joint_derivative(&self, t: T, x: &[T; 6], dx: &mut [T; 6]) {
        let mut rates = [T::constant(0.0); 3];
        self.joint_accelerations(t, x, &mut rates);
        *dx = [x[3], x[4], x[5], rates[0], rates[1], rates[2]];
    }
    fn to_maximal(&self, _: T, x: &[T; 6], y: &mut [T; 39]) {
        let Planar { cos, sin, rates } = Planar::of(x);
        let (zero, half, [a, ..]) = (T::constant(0.0), T::constant(0.5), LENGTHS.map(T::constant));
        let angles = [x[0], x[0] + x[2], x[1]];
        let begins = [[zero, zero], [a * cos[0], a * sin[0]], [self.ground, zero]];
        let moves = [[zero, zero], [-a * sin[0] * rates[0], a * cos[0] * rates[0]], [zero, zero]];
        for body in 0..3 {
            let (arm, angle) = (T::constant(LENGTHS[body] / 2.0), half * angles[body]);
            let [rx, ry] = [begins[body][0] + arm * cos[body], begins[body][1] + arm * sin[body]];
            y[7 * body..7 * body + 7].copy_from_slice(&[rx, ry, zero, angle.cos(), zero, zero, angle.sin()]);
            let speed = arm * rates[body];
            let [sx, sy] = [moves[body][0] - speed * sin[body], moves[body][1] + speed * cos[body]];
            y[21 + 6 * body..27 + 6 * body].copy_from_slice(&[sx, sy, zero, zero, zero, rates[body]]);
        }
    }
    fn to_joints(&self, t: T, y: &[T; 39], x: &mut [T; 6]) {
        let mut readings = self.buffers().readings;
        self.read_joints(t, y, &mut readings);
        for joint in 0..3 {
            let (sine, cosine) = (readings[3 * joint], readings[3 * joint + 1]);
            let (sin, cos) = (x[joint].sin(), x[joint].cos());
            x[joint] = x[joint] + (sine * cos - cosine * sin).atan2(cosine * cos + sine * sin);
            x[3 + joint] = readings[3 * joint + 2];
        }
    }
    fn loop_closure(&self, _: T, x: &[T; 6], out: &mut [T; 2]) {
        let ([a, b, c], planar) = (LENGTHS.map(T::constant), Planar::of(x));
        let ([c1, c2, c3], [s1, s2, s3]) = (planar.cos, planar.sin);
        *out = [a * c1 + b * c2 - self.ground - c * c3, a * s1 + b * s2 - c * s3];
    }
    fn closure_distances(&self, _: T, x: &[T; 6], out: &mut [T; 2]) {
        // By the angles of bars, which the rates of crank, rocker and elbow turn.
        let by_rates = |[crank, coupler, rocker]: [T; 3]| [crank + coupler, rocker, coupler];
        let [first, second] = Planar::of(x).jacobian().map(by_rates);
        let along = dot(&first, &second);
        let square = dot(&first, &first);
        *out = [square, dot(&second, &second) - along * along / square];
    }
    fn close_positions(&self, t: T, x: &mut [T; 6]) {
        let mut closure = [T::constant(0.0); 2];
        self.loop_closure(t, x, &mut closure);
        let [crank, coupler, rocker] = Planar::of(x).least(closure);
        (x[0], x[1], x[2]) = (x[0] + crank, x[1] + rocker, x[2] + coupler - crank);
    }
    fn close_velocities(&self, _: T, x: &mut [T; 6]) {
        let planar = Planar::of(x);
        let [crank, coupler, rocker] = planar.least(planar.jacobian().map(|row| dot(&row, &planar.rates)));
        (x[3], x[4], x[5]) = (x[3] + crank, x[4] + rocker, x[5] + coupler - crank);
    }
}

impl<T: Scalar> Mechanism for Linkage<T> {
    type Scalar = T;
    type State = [T; 39];
    type Rows = [T; 17];
    type Constraints = [T; 20];
    type Velocities = [T; 18];
    type Readings = [T; 19];
    type Outputs = [T; 0];

    fn description(&self) -> &Description<'_> {
        self.generated.description()
    }
    fn buffers(&self) -> Buffers<Self> {
        let Buffers { rows, constraints, velocities, readings, outputs } = self.generated.buffers();
        Buffers { rows, constraints, velocities, readings, outputs }
    }
    fn start(&self) -> [T; 39] {
        self.generated.start()
    }
    fn phi(&self, t: T, y: &[T; 39], out: &mut [T; 20]) {
        self.generated.phi(t, y, out);
    }
    fn velocity_residual(&self, t: T, y: &[T; 39], out: &mut [T; 17]) {
        self.generated.velocity_residual(t, y, out);
    }
    fn applied_force(&self, t: T, y: &[T; 39], out: &mut [T; 18]) {
        self.generated.applied_force(t, y, out);
    }
    fn energy(&self, t: T, y: &[T; 39]) -> Energy<T> {
        self.generated.energy(t, y)
    }
    fn read_joints(&self, t: T, y: &[T; 39], out: &mut [T; 19]) {
        self.generated.read_joints(t, y, out);
    }
    fn outputs(&self, t: T, y: &[T; 39], out: &mut [T; 0]) {
        self.generated.outputs(t, y, out);
    }
    fn set_input(&mut self, index: usize, value: T) -> bool {
        self.generated.set_input(index, value)
    }
}

impl<T: Real> Partition for Linkage<T> {
    type Independent = ();

    fn independent(&self, t: T, y: &[T; 39]) -> Self::Independent {
        self.generated.independent(t, y)
    }
    fn follow(&self, t: T, y: &[T; 39], choice: &mut Self::Independent) -> u32 {
        self.generated.follow(t, y, choice)
    }
    fn newton_step(&self, t: T, choice: &Self::Independent, y: &mut [T; 39]) -> Result<(), Error> {
        self.generated.newton_step(t, choice, y)
    }
    fn is_met(&self, t: T, y: &[T; 39], phi: &[T; 20]) -> bool {
        self.generated.is_met(t, y, phi)
    }
    fn solve_velocities(&self, t: T, choice: &Self::Independent, y: &mut [T; 39]) -> Result<(), Error> {
        self.generated.solve_velocities(t, choice, y)
    }
    fn clearance(&self, t: T, y: &[T; 39]) -> Option<Clearance<T>> {
        self.generated.clearance(t, y)
    }
}

impl<T: Scalar> Kinematics for Linkage<T> {
    type PhiQ = <FourBar<T> as Kinematics>::PhiQ;
    type PhiPi = <FourBar<T> as Kinematics>::PhiPi;

    fn terms(&self) -> Terms<Self> {
        let Terms { phi_q, phi_pi } = self.generated.terms();
        Terms { phi_q, phi_pi }
    }
    fn phi_q_pattern(&self) -> &[(u16, u16)] {
        self.generated.phi_q_pattern()
    }
    fn phi_pi_pattern(&self) -> &[(u16, u16)] {
        self.generated.phi_pi_pattern()
    }
    fn phi_q(&self, t: T, y: &[T; 39], out: &mut Self::PhiQ) {
        self.generated.phi_q(t, y, out);
    }
    fn phi_pi(&self, t: T, y: &[T; 39], out: &mut Self::PhiPi) {
        self.generated.phi_pi(t, y, out);
    }
    fn nu(&self, t: T, y: &[T; 39], out: &mut [T; 17]) {
        self.generated.nu(t, y, out);
    }
    fn gamma(&self, t: T, y: &[T; 39], out: &mut [T; 17]) {
        self.generated.gamma(t, y, out);
    }
}

impl<T: Scalar> Dynamics for Linkage<T> {
    type Accelerations = <FourBar<T> as Dynamics>::Accelerations;

    fn acceleration_buffer(&self) -> Self::Accelerations {
        self.generated.acceleration_buffer()
    }
    fn accelerations(&self, t: T, y: &[T; 39], out: &mut Self::Accelerations) {
        self.generated.accelerations(t, y, out);
    }
    fn multipliers(&self, t: T, y: &[T; 39], accelerations: &Self::Accelerations, lambda: &mut [T; 17]) {
        self.generated.multipliers(t, y, accelerations, lambda);
    }
    fn derivative(&self, t: T, y: &[T; 39], dy: &mut [T; 39]) {
        self.generated.derivative(t, y, dy);
    }
}

impl<T: Scalar> CorrectedDynamics for Linkage<T> {
    fn corrected_accelerations(&self, t: T, y: &[T; 39], out: &mut [T; 18]) {
        self.generated.corrected_accelerations(t, y, out);
    }
    fn corrected_derivative(&self, t: T, y: &[T; 39], dy: &mut [T; 39]) {
        self.derivative(t, y, dy);
    }
}

impl<T: Scalar> Projection for Linkage<T> {
    fn project(&self, t: T, y: &[T; 39], rows: &[T; 17], out: &mut [T; 18]) {
        self.generated.project(t, y, rows, out);
    }
}
