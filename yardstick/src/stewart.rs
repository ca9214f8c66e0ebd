//! The Stewart platform of `models/stewart-platform.toml`, derived by hand in the pose of its plate.
//!
//! Everything is resolved in the plate's frame. For a leg, s leads from its joint on the base to that on the plate, at
//! b = (X, Y, 0) from the mass centre; L = |s| and u = s/L. Cylinder and piston, slender and each with its mass centre
//! on the leg, need at the plate's joint the force
//!
//! ```text
//! F = M s̈ + h                      M = j 1 + (m − j) u uᵀ + J w wᵀ          j = I/L²    I = I₀ + m e²    e = L − c
//! h = k ṡ + (m c |u̇|² − γ u_z − f − k L̇) u + (γ + m g) z + J (ẇ·ṡ w − ω/L³ s×ṡ)
//! k = 2 L̇ (m e − I/L) / L²         γ = g (m' a − m c) / L
//! ```
//!
//! with the piston's mass m, its mass centre c below the plate's joint, the cylinder's mass m' and its mass centre a
//! above the base's joint, I₀ the moments of inertia across the leg with the cylinder's about its joint, and f the
//! actuator's force. z is the global vertical. J is the moment of inertia about the leg, at which the universal joint
//! with its first axis along global x has it turn at ω = w·ṡ: with R² = s·s − (x·s)²,
//!
//! ```text
//! φ̇ = x·(s×ṡ)/R²     w = (x·u) x×s/R²     ω = (x·u) φ̇     ẇ·ṡ = φ̇ ((x·ṡ − L̇ x·u)/L − 2 (x·u) (s·ṡ − x·s x·ṡ)/R²)
//! ```
//!
//! and w, as a field, has the curl −s/L³: that of cos θ dφ on the sphere, which the last term of h comes from.
//!
//! The joints' accelerations s̈ = a + X S₁ + Y S₂ have S₁ and S₂ the first two columns of ω̇× + ω×ω×. So of the legs'
//! mass matrices and forces only sums are needed, with weights 1, X, Y, X², XY and Y². As a pair of legs has the same X
//! and opposite Y, sums and differences of two legs come first.

use crate::Number;
use gyro_sim::Ode;

type Vector<T> = [T; 3];

/// A symmetric matrix: xx, yy, zz, xy, xz, yz.
type Symmetric<T> = [T; 6];

/// Two legs whose joints have the same x and opposite y, on the base and on the plate.
#[derive(Clone, Copy, Debug)]
struct Pair<T> {
    base: [T; 2],
    plate: [T; 2],
    /// X², XY, Y².
    products: [T; 3],
}

/// The platform's constants, and the forces of its legs.
#[derive(Clone, Copy, Debug)]
pub struct Stewart<T> {
    pairs: [Pair<T>; 3],
    /// Of the legs, in the order of the model file.
    pub forces: [T; 6],
    plate: T,
    /// About x and y, about z, and the second less the first.
    inertia: [T; 3],
    /// The plate's mass times gravity.
    plate_weight: T,
    piston: T,
    /// m c, m g and g (m' a − m c).
    piston_moment: T,
    piston_weight: T,
    gamma: T,
    /// c, I₀ and J.
    below: T,
    across: T,
    along: T,
}

/// The legs of each pair, that with the positive Y first.
const PAIRS: [[usize; 2]; 3] = [[1, 0], [2, 5], [3, 4]];

/// From the reference of the model file, which solves for it.
const START: [f64; 13] = [
    0.0021987880365393953,
    -0.0010884382974478445,
    0.8526675530053688,
    0.9996129074786185,
    -0.004413796574761637,
    -0.00833714603343464,
    0.026173375746291416,
    -0.000798091168632821,
    -0.13813935434367386,
    0.018467219689317266,
    -0.0646524987040451,
    -0.002898782942019952,
    0.03550021357723781,
];

/// Euler parameters' rotation: global x, y and z in the plate's frame.
type Rows<T> = [Vector<T>; 3];

/// Where a leg's joint on the plate is from that on the base, and how it moves.
#[derive(Clone, Copy, Debug)]
struct Joint<T> {
    s: Vector<T>,
    rate: Vector<T>,
    /// x·s, x·ṡ and z·s.
    out: T,
    out_rate: T,
    high: T,
}

/// What a leg adds at its joint on the plate: M and h.
#[derive(Clone, Copy, Debug)]
struct Leg<T> {
    mass: Symmetric<T>,
    force: Vector<T>,
}

impl<T: Number> Stewart<T> {
    /// Of `models/stewart-platform.toml`.
    pub fn platform() -> Self {
        let gravity = 9.81;
        let (cylinder, piston, half) = (1.2, 0.6, 0.3);
        let pair = |base: [f64; 2], [x, y]: [f64; 2]| Pair {
            base: base.map(T::constant),
            plate: [x, y].map(T::constant),
            products: [x * x, x * y, y * y].map(T::constant),
        };
        Self {
            pairs: [
                pair([0.591, 0.104], [0.225, 0.268]),
                pair([-0.205, 0.564], [0.12, 0.329]),
                pair([-0.386, 0.46], [-0.345, 0.061]),
            ],
            forces: [26.0, 25.0, 24.0, 26.0, 23.0, 25.0].map(T::constant),
            plate: T::constant(10.0),
            inertia: [0.3, 0.55, 0.25].map(T::constant),
            plate_weight: T::constant(10.0 * gravity),
            piston: T::constant(piston),
            piston_moment: T::constant(piston * half),
            piston_weight: T::constant(piston * gravity),
            gamma: T::constant(gravity * half * (cylinder - piston)),
            below: T::constant(half),
            across: T::constant(0.03 + 0.015 + cylinder * half * half),
            along: T::constant(8e-4 + 1e-4),
        }
    }

    /// Where the legs have the lengths and rates of the model file: r, p, and velocity and angular velocity in the
    /// plate's frame.
    pub fn start() -> [T; 13] {
        START.map(T::constant)
    }

    /// M and h of all legs, pair by pair, at the plate's position r and with its velocities v and w in its own frame,
    /// where the velocity of its mass centre along global x is `x_rate`.
    #[inline]
    fn legs(&self, rows: &Rows<T>, r: Vector<T>, x_rate: T, [v, w]: [Vector<T>; 2]) -> [[Leg<T>; 2]; 3] {
        let [x, y, z] = *rows;
        let origin = [0, 1, 2].map(|k| r[0] * x[k] + r[1] * y[k] + r[2] * z[k]);
        // x·(ω×b) = b·(x×ω).
        let x_turn = [x[1] * w[2] - x[2] * w[1], x[2] * w[0] - x[0] * w[2]];
        core::array::from_fn(|k| {
            let ([bx, by], [px, py]) = (self.pairs[k].base, self.pairs[k].plate);
            let (along, beside) = (scaled(bx, x), scaled(by, y));
            let [middle_x, middle_y, middle_z] = sub(origin, along);
            let middle = [middle_x + px, middle_y, middle_z];
            let (near, far) = (sub(middle, beside), add(middle, beside));
            let (turn_x, turn_z) = (w[2] * py, w[0] * py);
            let (rate_y, rate_z) = (v[1] + w[2] * px, v[2] - w[1] * px);
            // Along the global axes x and z.
            let (out, high) = (r[0] - bx + px * x[0], r[2] + px * z[0]);
            let (out_turn, high_turn) = (py * x[1], py * z[1]);
            let (rate, rate_turn) = (x_rate + px * x_turn[0], py * x_turn[1]);
            let legs = [
                Joint {
                    s: [near[0], near[1] + py, near[2]],
                    rate: [v[0] - turn_x, rate_y, rate_z + turn_z],
                    out: out + out_turn,
                    out_rate: rate + rate_turn,
                    high: high + high_turn,
                },
                Joint {
                    s: [far[0], far[1] - py, far[2]],
                    rate: [v[0] + turn_x, rate_y, rate_z - turn_z],
                    out: out - out_turn,
                    out_rate: rate - rate_turn,
                    high: high - high_turn,
                },
            ];
            [0, 1].map(|side| self.leg(rows, &legs[side], self.forces[PAIRS[k][side]]))
        })
    }

    /// M and h of a leg.
    #[inline]
    fn leg(&self, [x, _, z]: &Rows<T>, joint: &Joint<T>, force: T) -> Leg<T> {
        let (one, two) = (T::constant(1.0), T::constant(2.0));
        let Joint { s, rate, out, out_rate, high } = *joint;
        let squared = dot(s, s);
        let length = squared.sqrt();
        let inverse = one / length;
        let inverse_squared = inverse * inverse;
        let u = scaled(inverse, s);
        let speed = dot(u, rate);
        let spin = cross(s, rate);
        let turning = dot(spin, spin) * (inverse_squared * inverse_squared);

        let upper = length - self.below;
        let moment = self.piston * upper;
        let across = self.across + moment * upper;
        let j = across * inverse_squared;
        let k = (speed + speed) * inverse_squared * (moment - across * inverse);
        let gamma = self.gamma * inverse;
        let along = self.piston_moment * turning - gamma * (high * inverse) - force - k * speed;

        let per_radius = one / (squared - out * out);
        let x_u = out * inverse;
        let azimuth = dot(*x, spin) * per_radius;
        let share = x_u * per_radius;
        let about = scaled(share, cross(*x, s));
        let inertia = scaled(self.along, about);
        let change =
            azimuth * ((out_rate - speed * x_u) * inverse - two * share * (length * speed - out * out_rate));
        let curl = self.along * (x_u * azimuth) * (inverse * inverse_squared);

        let vertical = gamma + self.piston_weight;
        let force = core::array::from_fn(|i| {
            k * rate[i] + along * u[i] + vertical * z[i] + (change * inertia[i] - curl * spin[i])
        });
        let d = scaled(self.piston - j, u);
        let entry = |a: usize, b: usize| d[a] * u[b] + inertia[a] * about[b];
        let mass = [j + entry(0, 0), j + entry(1, 1), j + entry(2, 2), entry(0, 1), entry(0, 2), entry(1, 2)];
        Leg { mass, force }
    }

    /// The equations of motion of the plate with all that its pairs of legs add.
    #[inline]
    fn solved(&self, legs: &[[Leg<T>; 2]; 3], z: Vector<T>, w: Vector<T>) -> [T; 6] {
        let sums = legs.map(|[one, other]| add(one.mass, other.mass));
        let differences = legs.map(|[one, other]| sub(one.mass, other.mass));
        let [x, y] = [0, 1].map(|k| self.pairs.map(|pair| pair.plate[k]));
        let [xx, xy, yy] = [0, 1, 2].map(|k| self.pairs.map(|pair| pair.products[k]));
        let m = add(add(sums[0], sums[1]), sums[2]);
        let (p1, p2, q12) = (weighted(x, sums), weighted(y, differences), weighted(xy, differences));
        // Without xx, and without yy.
        let q11 = weighted(xx, sums.map(|[_, rest @ ..]| rest));
        let q22 = weighted(yy, sums.map(|[xx, _, zz, xy, xz, yz]| [xx, zz, xy, xz, yz]));

        let pushes = legs.map(|[one, other]| add(one.force, other.force));
        let twists = legs.map(|[one, other]| sub(one.force, other.force));
        let push = add(add(pushes[0], pushes[1]), pushes[2]);
        let [x_hy, x_hz] = weighted(x, pushes.map(|[_, y, z]| [y, z]));
        let [y_hx, y_hz] = weighted(y, twists.map(|[x, _, z]| [x, z]));

        // The first two columns of ω×ω×, and what the legs' masses make of them.
        let squares = [w[0] * w[0], w[1] * w[1], w[2] * w[2]];
        let [wxy, wxz, wyz] = [w[0] * w[1], w[0] * w[2], w[1] * w[2]];
        let c1 = [-(squares[1] + squares[2]), wxy, wxz];
        let c2 = [wxy, -(squares[0] + squares[2]), wyz];
        let [m_xx, m_yy, m_zz, m_xy, m_xz, m_yz] = p1;
        let [n_xx, n_yy, n_zz, n_xy, n_xz, n_yz] = p2;
        let pull = [
            dot([m_xx, m_xy, m_xz], c1) + dot([n_xx, n_xy, n_xz], c2),
            dot([m_xy, m_yy, m_yz], c1) + dot([n_xy, n_yy, n_yz], c2),
            dot([m_xz, m_yz, m_zz], c1) + dot([n_xz, n_yz, n_zz], c2),
        ];
        let [a_yy, a_zz, a_xy, a_xz, a_yz] = q11;
        let [b_xx, b_yy, b_zz, b_xy, b_xz, b_yz] = q12;
        let [d_xx, d_zz, d_xy, d_xz, d_yz] = q22;
        let x_y = dot([a_xy, a_yy, a_yz], c1) + dot([b_xy, b_yy, b_yz], c2);
        let x_z = dot([a_xz, a_yz, a_zz], c1) + dot([b_xz, b_yz, b_zz], c2);
        let y_x = dot([b_xx, b_xy, b_xz], c1) + dot([d_xx, d_xy, d_xz], c2);
        let y_z = dot([b_xz, b_yz, b_zz], c1) + dot([d_xz, d_yz, d_zz], c2);

        let [across, about, difference] = self.inertia;
        let force: Vector<T> = core::array::from_fn(|k| -(self.plate_weight * z[k] + pull[k] + push[k]));
        let right = [
            force[0],
            force[1],
            force[2],
            -(difference * wyz + y_z + y_hz),
            difference * wxz + x_z + x_hz,
            y_x - x_y + y_hx - x_hy,
        ];
        // The lower triangle; forces and moments, by accelerations and angular accelerations.
        let (o, [xx, yy, zz, xy, xz, yz]) = (T::constant(0.0), m);
        let mass = [
            [self.plate + xx, o, o, o, o, o],
            [xy, self.plate + yy, o, o, o, o],
            [xz, yz, self.plate + zz, o, o, o],
            [n_xz, n_yz, n_zz, across + d_zz, o, o],
            [-m_xz, -m_yz, -m_zz, -b_zz, across + a_zz, o],
            [
                m_xy - n_xx,
                m_yy - n_xy,
                m_yz - n_xz,
                b_yz - d_xz,
                b_xz - a_yz,
                about + (a_yy + d_xx - (b_xy + b_xy)),
            ],
        ];
        solve(mass, right)
    }

    #[inline]
    fn rates(&self, y: &[T; 13]) -> [T; 13] {
        let [rx, ry, rz, e0, e1, e2, e3, vx, vy, vz, wx, wy, wz] = *y;
        let (v, w) = ([vx, vy, vz], [wx, wy, wz]);
        let rows = rotation([e0, e1, e2, e3]);
        let [sx, sy, sz] = rows.map(|row| dot(row, v));
        let legs = self.legs(&rows, [rx, ry, rz], sx, [v, w]);
        let [ax, ay, az, bx, by, bz] = self.solved(&legs, rows[2], w);
        let [cx, cy, cz] = cross(w, v);
        let [hx, hy, hz] = scaled(T::constant(0.5), w);
        let p = [
            -(e1 * hx + e2 * hy + e3 * hz),
            e0 * hx + e2 * hz - e3 * hy,
            e0 * hy + e3 * hx - e1 * hz,
            e0 * hz + e1 * hy - e2 * hx,
        ];
        [sx, sy, sz, p[0], p[1], p[2], p[3], ax - cx, ay - cy, az - cz, bx, by, bz]
    }
}

/// r, p, and velocity and angular velocity in the plate's frame.
impl<T: Number> Ode for Stewart<T> {
    type Scalar = T;
    type State = [T; 13];

    fn derivative(&self, _: &(), _: T, y: &[T; 13], dy: &mut [T; 13]) {
        *dy = self.rates(y);
    }
}

/// The rows of A(p).
#[inline]
fn rotation<T: Number>([e0, e1, e2, e3]: [T; 4]) -> Rows<T> {
    let [t0, t1, t2, t3] = [e0 + e0, e1 + e1, e2 + e2, e3 + e3];
    let share = t0 * e0 - T::constant(1.0);
    let [e01, e02, e03] = [t0 * e1, t0 * e2, t0 * e3];
    let [e12, e13, e23] = [t1 * e2, t1 * e3, t2 * e3];
    [
        [share + t1 * e1, e12 - e03, e13 + e02],
        [e12 + e03, share + t2 * e2, e23 - e01],
        [e13 - e02, e23 + e01, share + t3 * e3],
    ]
}

/// x of A x = b by A = L D Lᵀ, for a symmetric positive definite A of which the lower triangle is given.
#[inline]
fn solve<T: Number, const N: usize>(mut a: [[T; N]; N], mut b: [T; N]) -> [T; N] {
    let one = T::constant(1.0);
    let mut inverse = [one; N];
    for pivot in 0..N {
        inverse[pivot] = one / a[pivot][pivot];
        let below: [T; N] = core::array::from_fn(|row| a[row][pivot]);
        for row in pivot + 1..N {
            let factor = below[row] * inverse[pivot];
            for (entry, across) in a[row].iter_mut().zip(below).take(row + 1).skip(pivot + 1) {
                *entry = *entry - factor * across;
            }
            b[row] = b[row] - factor * b[pivot];
        }
    }
    for row in (0..N).rev() {
        for below in row + 1..N {
            b[row] = b[row] - a[below][row] * b[below];
        }
        b[row] = b[row] * inverse[row];
    }
    b
}

#[inline]
fn weighted<T: Number, const N: usize>(weights: [T; 3], of: [[T; N]; 3]) -> [T; N] {
    core::array::from_fn(|k| weights[0] * of[0][k] + weights[1] * of[1][k] + weights[2] * of[2][k])
}

#[inline]
fn add<T: Number, const N: usize>(a: [T; N], b: [T; N]) -> [T; N] {
    core::array::from_fn(|k| a[k] + b[k])
}

#[inline]
fn sub<T: Number, const N: usize>(a: [T; N], b: [T; N]) -> [T; N] {
    core::array::from_fn(|k| a[k] - b[k])
}

#[inline]
fn scaled<T: Number>(factor: T, a: Vector<T>) -> Vector<T> {
    a.map(|x| factor * x)
}

#[inline]
fn dot<T: Number>(a: Vector<T>, b: Vector<T>) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline]
fn cross<T: Number>(a: Vector<T>, b: Vector<T>) -> Vector<T> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
