//! A Stewart platform in the pose of its plate: position, Euler parameters, velocity, angular velocity.
//!
//! Where a leg's cylinder and piston are follows from where its joint on the plate is: u = s/L along the leg, and
//! across it, as the base's universal joint has it, the second axis y ∝ (0, u_z, −u_y) for a first axis along global x.
//! The bodies' velocities and accelerations are those of [`Jet`]s in time. With v_k and w_k the velocities of a body
//! when only the k-th of the plate's six is one, the equations are Kane's:
//!
//! ```text
//! M_kj = Σ m v_k·v_j + w_k·J w_j
//! M u̇ = −Σ (m v_k·(b − g) + w_k·(J e + w×J w)) + Σ f L_k
//! ```
//!
//! with b and e the accelerations of the bodies where the plate's are zero, and f the force along a leg, which
//! lengthens by L_k.

use crate::chain::solve;
use crate::extrapolation::{Scheme, State};
use crate::jet::{Arrow, Jet, Moving, along, fixed, inner, minus, outer, plus, unit};
use crate::one_freedom::Heft;
use crate::rotation::{ORIGIN, Precise, Rotation, euler_parameter_rates, tensor_times};
use crate::slider_crank::body_state;
use crate::trajectory::{decimal, decimals, rounded, trajectory};
use crate::vector::{add, cross, dot, scale, sub};
use crate::{BodyState, DoubleDouble};

/// A plate moves slowly: a step covers a small part of a radian.
const SCHEME: Scheme = Scheme { step: 0.05, columns: 14, tolerance: 1e-26 };

/// The Euler parameters follow their rates, the velocities the forces.
type Plate = State<13>;

/// Cylinder or piston: slender, its mass centre and the leg on its z axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LegPart {
    /// Mass, kg.
    pub mass: f64,
    /// Moments of inertia across and along the leg through the mass centre, kg·m².
    pub inertia: [f64; 2],
    /// From the leg's end to the mass centre: of the cylinder that on the base, of the piston that on the plate, m.
    pub centre: f64,
}

/// A Stewart platform and its start. Numbers are the decimals they print as.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StewartPlatform {
    /// Joints on the base, global frame, m.
    pub base: [[f64; 3]; 6],
    /// Joints on the plate, in its frame, m.
    pub joints: [[f64; 3]; 6],
    /// The plate's mass, kg.
    pub mass: f64,
    /// The plate's moments of inertia, kg·m².
    pub inertia: [f64; 3],
    /// The lower part of each leg.
    pub cylinder: LegPart,
    /// The upper part.
    pub piston: LegPart,
    /// Forces that lengthen the legs, N.
    pub forces: [f64; 6],
    /// Acceleration of gravity, m/s².
    pub gravity: [f64; 3],
    /// Lengths of the legs at time zero, m.
    pub lengths: [f64; 6],
    /// How they change then, m/s.
    pub rates: [f64; 6],
    /// Near where the plate starts unturned, m.
    pub near: [f64; 3],
}

/// A [`StewartPlatform`] at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StewartSample {
    /// Time, s.
    pub t: f64,
    /// The plate.
    pub plate: BodyState,
    /// Its Euler parameters.
    pub euler_parameters: [f64; 4],
    /// Lengths of the legs, m, and how they change, m/s.
    pub lengths: [[f64; 2]; 6],
    /// The angles of the universal joints, about global x and then about the leg's own y, rad, and their rates, rad/s.
    pub hinges: [[[f64; 2]; 2]; 6],
    /// The pistons.
    pub pistons: [BodyState; 6],
    /// Kinetic energy and −Σ m g·r, J.
    pub energy: f64,
    /// What the forces have done since time zero, J.
    pub work: f64,
}

struct Precisely {
    base: [Precise; 6],
    joints: [Precise; 6],
    plate: Heft,
    /// Of cylinder and piston.
    hefts: [Heft; 2],
    centres: [DoubleDouble; 2],
    forces: [DoubleDouble; 6],
    gravity: Precise,
}

/// Where the plate is, and how it moves: velocities and accelerations, linear in the global frame, angular in its own.
struct Motion {
    position: Precise,
    rotation: Rotation,
    velocity: [Precise; 2],
    acceleration: [Precise; 2],
}

struct Equations {
    mass: [[DoubleDouble; 6]; 6],
    force: [DoubleDouble; 6],
    slopes: [[DoubleDouble; 6]; 6],
    bias: [DoubleDouble; 6],
}

/// A leg.
struct Leg {
    length: Jet,
    u: Arrow,
    cylinder: Moving,
    piston: Moving,
}

impl StewartPlatform {
    /// Of `models/stewart-platform.toml`.
    #[must_use]
    pub fn plate_of_ten_kilograms() -> Self {
        let (base, plate) = (
            [[0.591, 0.104], [-0.205, 0.564], [-0.386, 0.46]],
            [[0.225, 0.268], [0.12, 0.329], [-0.345, 0.061]],
        );
        let around = |[[a, b], [c, d], [e, f]]: [[f64; 2]; 3]| {
            [[a, -b, 0.0], [a, b, 0.0], [c, d, 0.0], [e, f, 0.0], [e, -f, 0.0], [c, -d, 0.0]]
        };
        StewartPlatform {
            base: around(base),
            joints: around(plate),
            mass: 10.0,
            inertia: [0.3, 0.3, 0.55],
            cylinder: LegPart { mass: 1.2, inertia: [0.03, 8e-4], centre: 0.3 },
            piston: LegPart { mass: 0.6, inertia: [0.015, 1e-4], centre: 0.3 },
            forces: [26.0, 25.0, 24.0, 26.0, 23.0, 25.0],
            gravity: [0.0, 0.0, -9.81],
            lengths: [0.94, 0.95, 0.935, 0.945, 0.93, 0.955],
            rates: [0.05, -0.02, 0.03, 0.08, -0.04, 0.01],
            near: [0.0, 0.0, 0.85],
        }
    }

    /// The motion at `times` (s, ascending from zero; each the decimal it prints as), correctly rounded.
    ///
    /// # Panics
    /// If the times do not ascend, a number is not finite, or no pose near by has these lengths.
    #[must_use]
    pub fn solve(&self, times: &[f64]) -> Vec<StewartSample> {
        let platform = self.precisely();
        let start = self.start(&platform);
        let motion = match trajectory(|_, state| platform.derivative(state), &SCHEME, start, times) {
            Ok(motion) => motion,
            Err(error) => panic!("{error}"),
        };
        let lengths = decimals(self.lengths);
        motion.iter().map(|(t, state)| platform.sample(*t, state, &lengths)).collect()
    }

    /// What has to act along the legs, N, beside the forces given, so that they have these accelerations (m/s²) at the
    /// lengths and rates of the start.
    ///
    /// # Panics
    /// As [`solve`](Self::solve).
    #[must_use]
    pub fn driver_forces(&self, accelerations: [f64; 6]) -> [f64; 6] {
        let platform = self.precisely();
        let Equations { mass, force, slopes, bias } = platform.equations(&Motion::of(&self.start(&platform)));
        let wanted = decimals(accelerations);
        let plate = least_squares(&slopes, core::array::from_fn(|leg| wanted[leg] - bias[leg]));
        let missing = core::array::from_fn(|k| {
            let needed = (0..6).fold(DoubleDouble::ZERO, |sum, j| sum + mass[k][j] * plate[j]);
            needed - force[k]
        });
        let transposed = core::array::from_fn(|k| slopes.map(|row| row[k]));
        rounded(least_squares(&transposed, missing))
    }

    fn precisely(&self) -> Precisely {
        let parts = [self.cylinder, self.piston];
        Precisely {
            base: self.base.map(decimals),
            joints: self.joints.map(decimals),
            plate: Heft::diagonal(self.mass, self.inertia),
            hefts: parts.map(|part| {
                let [across, along] = part.inertia;
                Heft::diagonal(part.mass, [across, across, along])
            }),
            centres: parts.map(|part| decimal(part.centre)),
            forces: decimals(self.forces),
            gravity: decimals(self.gravity),
        }
    }

    /// The pose with these lengths by Newton's method, and the velocities with these rates.
    fn start(&self, platform: &Precisely) -> Plate {
        let (lengths, rates) = (decimals(self.lengths), decimals(self.rates));
        let [zero, one] = [0.0, 1.0].map(DoubleDouble::new);
        let (mut r, mut p) = (decimals(self.near), [one, zero, zero, zero]);
        for _ in 0..20 {
            let (found, jacobian) = platform.lengths(r, p);
            let missing = core::array::from_fn(|leg| lengths[leg] - found[leg]);
            let [x, y, z, a, b, c] = least_squares(&jacobian, missing);
            r = add(r, [x, y, z]);
            let turned = euler_parameter_rates(p, [a, b, c]);
            p = normalised(core::array::from_fn(|k| p[k] + turned[k]));
        }
        let (found, jacobian) = platform.lengths(r, p);
        for (found, length) in found.iter().zip(lengths) {
            assert!((*found - length).to_f64().abs() < 1e-29, "no pose has these lengths: {found:?}");
        }
        let [vx, vy, vz, wx, wy, wz] = least_squares(&jacobian, rates);
        [r[0], r[1], r[2], p[0], p[1], p[2], p[3], vx, vy, vz, wx, wy, wz]
    }
}

fn normalised(p: [DoubleDouble; 4]) -> [DoubleDouble; 4] {
    let length = p.iter().fold(DoubleDouble::ZERO, |sum, x| sum + *x * *x).sqrt();
    p.map(|x| x / length)
}

/// x of A x = b, by AᵀA x = Aᵀb.
fn least_squares(a: &[[DoubleDouble; 6]; 6], b: [DoubleDouble; 6]) -> [DoubleDouble; 6] {
    let sum = |of: &dyn Fn(usize) -> DoubleDouble| (0..6).fold(DoubleDouble::ZERO, |sum, i| sum + of(i));
    let squares = core::array::from_fn(|j| core::array::from_fn(|k| sum(&|i| a[i][j] * a[i][k])));
    solve(squares, core::array::from_fn(|j| sum(&|i| a[i][j] * b[i])))
}

/// The k-th of the plate's velocities is one.
fn unit_velocity(k: usize) -> [Precise; 2] {
    let mut velocity = [ORIGIN; 2];
    velocity[k / 3][k % 3] = DoubleDouble::new(1.0);
    velocity
}

impl Motion {
    fn new(r: Precise, p: [DoubleDouble; 4], velocity: [Precise; 2]) -> Self {
        let rotation = Rotation::from_euler_parameters(p);
        Motion { position: r, rotation, velocity, acceleration: [ORIGIN; 2] }
    }

    fn of(state: &Plate) -> Self {
        let [rx, ry, rz, e0, e1, e2, e3, vx, vy, vz, wx, wy, wz] = *state;
        Motion::new([rx, ry, rz], normalised([e0, e1, e2, e3]), [[vx, vy, vz], [wx, wy, wz]])
    }

    fn moving_at(&self, velocity: [Precise; 2]) -> Self {
        Motion { position: self.position, rotation: self.rotation, velocity, acceleration: [ORIGIN; 2] }
    }

    /// A vector fixed in the plate.
    fn carried(&self, arm: Precise) -> Arrow {
        let [w, e] = [self.velocity[1], self.acceleration[1]];
        let turned = [arm, cross(w, arm), add(cross(e, arm), cross(w, cross(w, arm)))];
        let [x, first, second] = turned.map(|part| self.rotation.times(part));
        core::array::from_fn(|k| Jet([x[k], first[k], second[k]]))
    }

    /// A point fixed in the plate.
    fn point(&self, arm: Precise) -> Arrow {
        let centre =
            core::array::from_fn(|k| Jet([self.position[k], self.velocity[0][k], self.acceleration[0][k]]));
        plus(centre, self.carried(arm))
    }

    fn plate(&self) -> Moving {
        Moving { centre: self.point(ORIGIN), axes: Rotation::IDENTITY.0.map(|axis| self.carried(axis)) }
    }
}

impl Precisely {
    fn legs(&self, motion: &Motion) -> [Leg; 6] {
        core::array::from_fn(|k| {
            let (foot, head) = (fixed(self.base[k]), motion.point(self.joints[k]));
            let s = minus(head, foot);
            let length = inner(s, s).sqrt();
            let u = s.map(|x| x / length);
            let y = unit([Jet::constant(DoubleDouble::ZERO), u[2], -u[1]]);
            let axes = [outer(y, u), y, u];
            let [low, high] = self.centres.map(Jet::constant);
            Leg {
                length,
                u,
                cylinder: Moving { centre: plus(foot, along(low, u)), axes },
                piston: Moving { centre: minus(head, along(high, u)), axes },
            }
        })
    }

    /// All bodies, and the lengths of the legs.
    fn bodies(&self, motion: &Motion) -> (Vec<(Heft, Moving)>, [Jet; 6]) {
        let legs = self.legs(motion);
        let [cylinder, piston] = self.hefts;
        let parts = legs.iter().flat_map(|leg| [(cylinder, leg.cylinder), (piston, leg.piston)]);
        let bodies = core::iter::once((self.plate, motion.plate())).chain(parts).collect();
        (bodies, legs.map(|leg| leg.length))
    }

    /// The legs' lengths at a pose, and their derivatives by the plate's velocities.
    fn lengths(&self, r: Precise, p: [DoubleDouble; 4]) -> ([DoubleDouble; 6], [[DoubleDouble; 6]; 6]) {
        let by = |k| self.legs(&Motion::new(r, p, unit_velocity(k))).map(|leg| leg.length.0);
        let columns: [_; 6] = core::array::from_fn(by);
        let slopes = core::array::from_fn(|leg| columns.map(|column| column[leg][1]));
        (columns[0].map(|[length, ..]| length), slopes)
    }

    /// M, the right-hand side, and the legs' L_k and their accelerations where the plate's are zero.
    fn equations(&self, motion: &Motion) -> Equations {
        let partials: [_; 6] = core::array::from_fn(|k| self.bodies(&motion.moving_at(unit_velocity(k))));
        let (bodies, lengths) = self.bodies(motion);
        let mut mass = [[DoubleDouble::ZERO; 6]; 6];
        let mut force: [DoubleDouble; 6] = core::array::from_fn(|k| {
            let (_, lengths) = &partials[k];
            lengths.iter().zip(self.forces).fold(DoubleDouble::ZERO, |sum, (l, f)| sum + f * l.0[1])
        });
        for (index, (heft, body)) in bodies.iter().enumerate() {
            let [w, e] = body.turning();
            let inertial = scale(heft.mass, sub(body.centre_derivative(2), self.gravity));
            let turning = add(tensor_times(heft.inertia, e), cross(w, tensor_times(heft.inertia, w)));
            let of = partials.each_ref().map(|(bodies, _)| {
                let body = &bodies[index].1;
                (body.centre_derivative(1), body.turning()[0])
            });
            for (k, (v, w)) in of.iter().enumerate() {
                force[k] = force[k] - dot(*v, inertial) - dot(*w, turning);
                let (momentum, spin) = (scale(heft.mass, *v), tensor_times(heft.inertia, *w));
                for (j, (other, turned)) in of.iter().enumerate() {
                    mass[k][j] = mass[k][j] + dot(momentum, *other) + dot(spin, *turned);
                }
            }
        }
        let slopes = core::array::from_fn(|leg| partials.each_ref().map(|(_, lengths)| lengths[leg].0[1]));
        Equations { mass, force, slopes, bias: lengths.map(|length| length.0[2]) }
    }

    /// Accelerations of the plate's six velocities.
    fn accelerations(&self, motion: &Motion) -> [DoubleDouble; 6] {
        let Equations { mass, force, .. } = self.equations(motion);
        solve(mass, force)
    }

    fn derivative(&self, state: &Plate) -> Plate {
        let motion = Motion::of(state);
        let [v, w] = motion.velocity;
        let [_, _, _, e0, e1, e2, e3, ..] = *state;
        let [p0, p1, p2, p3] = euler_parameter_rates([e0, e1, e2, e3], w);
        let [ax, ay, az, bx, by, bz] = self.accelerations(&motion);
        [v[0], v[1], v[2], p0, p1, p2, p3, ax, ay, az, bx, by, bz]
    }

    fn energy(&self, motion: &Motion) -> DoubleDouble {
        let (bodies, _) = self.bodies(motion);
        bodies.iter().fold(DoubleDouble::ZERO, |sum, (heft, body)| {
            let (v, [w, _]) = (body.centre_derivative(1), body.turning());
            let kinetic = (heft.mass * dot(v, v) + dot(w, tensor_times(heft.inertia, w))).times(0.5);
            sum + kinetic - heft.mass * dot(self.gravity, body.centre_derivative(0))
        })
    }

    fn sample(&self, t: DoubleDouble, state: &Plate, from: &[DoubleDouble; 6]) -> StewartSample {
        let (motion, one) = (Motion::of(state), DoubleDouble::new(1.0));
        let legs = self.legs(&motion);
        let work =
            (0..6).fold(DoubleDouble::ZERO, |sum, k| sum + self.forces[k] * (legs[k].length.0[0] - from[k]));
        let [_, _, _, e0, e1, e2, e3, ..] = *state;
        StewartSample {
            t: t.to_f64(),
            plate: body_state(&motion.plate(), one),
            euler_parameters: rounded(normalised([e0, e1, e2, e3])),
            lengths: legs.each_ref().map(|leg| [leg.length.0[0].to_f64(), leg.length.0[1].to_f64()]),
            hinges: legs.each_ref().map(hinge),
            pistons: legs.each_ref().map(|leg| body_state(&leg.piston, one)),
            energy: self.energy(&motion).to_f64(),
            work: work.to_f64(),
        }
    }
}

/// The angles θ1 and θ2 of u = (sin θ2, −sin θ1 cos θ2, cos θ1 cos θ2), with their rates.
fn hinge(leg: &Leg) -> [[f64; 2]; 2] {
    let [x, y, z] = leg.u;
    let flat = y * y + z * z;
    let across = flat.sqrt();
    let first_rate = (y.0[0] * z.0[1] - z.0[0] * y.0[1]) / flat.0[0];
    [[(-y.0[0]).atan2(z.0[0]), first_rate], [x.0[0].atan2(across.0[0]), x.0[1] / across.0[0]]]
        .map(|angle| angle.map(DoubleDouble::to_f64))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_start_has_the_lengths_and_rates_that_were_asked_for() {
        let platform = StewartPlatform::plate_of_ten_kilograms();
        let [sample] = platform.solve(&[0.0])[..] else { panic!("one sample") };
        for (leg, [length, rate]) in sample.lengths.iter().enumerate() {
            assert!((length - platform.lengths[leg]).abs() < 1e-16, "{length}");
            assert!((rate - platform.rates[leg]).abs() < 1e-16, "{rate}");
        }
    }

    #[test]
    fn the_forces_account_for_the_energy() {
        let samples = StewartPlatform::plate_of_ten_kilograms().solve(&[0.0, 0.3]);
        let [first, last] = samples[..] else { panic!("two samples") };
        assert!((last.energy - last.work - first.energy).abs() < 1e-13, "{first:?} {last:?}");
        assert!(last.work.abs() > 1e-2 && (last.energy - first.energy).abs() > 1e-2, "{last:?}");
    }

    /// Accelerations that the forces have by themselves need no driver.
    #[test]
    fn a_free_platform_needs_no_drivers() {
        const STEP: f64 = 1e-6;
        let platform = StewartPlatform::plate_of_ten_kilograms();
        let [here, after] = platform.solve(&[0.0, STEP])[..] else { panic!("two samples") };
        let slopes = core::array::from_fn(|leg| (after.lengths[leg][1] - here.lengths[leg][1]) / STEP);
        for force in platform.driver_forces(slopes) {
            // A one-sided difference.
            assert!(force.abs() < 1e-4, "{force}");
        }
        let held = platform.driver_forces([0.0; 6]);
        assert!(held.iter().all(|force| force.abs() > 1e-2), "{held:?}");
    }

    /// Cylinder and piston turn alike, and about the axes of the universal joint only.
    #[test]
    fn legs_turn_as_their_hinges_do() {
        let platform = StewartPlatform::plate_of_ten_kilograms();
        let sample = platform.solve(&[0.2])[0];
        for (piston, [[first, first_rate], [_, second_rate]]) in sample.pistons.iter().zip(sample.hinges) {
            let (sin, cos) = first.sin_cos();
            let expected = [first_rate, cos * second_rate, sin * second_rate];
            let w = piston.angular_velocity;
            let found = piston.rotation.map(|row| (0..3).map(|k| row[k] * w[k]).sum::<f64>());
            for (found, expected) in found.iter().zip(expected) {
                assert!((found - expected).abs() < 1e-15, "{found} {expected}");
            }
        }
    }
}
