//! Kane's equations of any mechanism whose bodies can be placed in closed form.
//!
//! A [`Mechanism`] says where its bodies are, in numbers that move. With v_r and w_r the partial velocities (how a
//! body's centre moves and how it turns where the r-th speed is one and the others are zero), a and e the
//! accelerations where no speed changes, the equations are M u̇ = h:
//!
//! ```text
//! M_rs = Σ m v_r·v_s + w_r·J w_s
//! h_r  = Σ m v_r·(g − a) − w_r·(J e + ω×J ω) + Q_r
//! ```
//!
//! Source: Kane and Levinson, *Dynamics: Theory and Applications* (1985), sections 2.14, 4.11 and 6.1.

use crate::chain::solve;
use crate::extrapolation::State;
use crate::rotation::{ORIGIN, Precise, tensor_times};
use crate::time_jet::Jet;
use crate::vector::{Vector, add, cross, dot, scale, sub};
use crate::{DoubleDouble, JointRow, Orientation};

/// A body: its frame's axes in the global frame and its mass centre.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placed {
    pub(crate) mass: DoubleDouble,
    /// About the mass centre in the body's frame.
    pub(crate) inertia: [DoubleDouble; 6],
    pub(crate) centre: Vector<Jet>,
    pub(crate) axes: [Vector<Jet>; 3],
}

/// A spring and a damper between two points.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Strut {
    pub(crate) ends: [Vector<Jet>; 2],
    pub(crate) stiffness: DoubleDouble,
    pub(crate) damping: DoubleDouble,
    pub(crate) free: DoubleDouble,
}

/// A mechanism at one instant.
#[derive(Clone, Debug, Default)]
pub(crate) struct Scene {
    pub(crate) bodies: Vec<Placed>,
    pub(crate) struts: Vec<Strut>,
    /// Coordinates with a spring that is free at zero, and its stiffness.
    pub(crate) springs: Vec<(Jet, DoubleDouble)>,
    /// Coordinates with viscous friction, and its coefficient.
    pub(crate) friction: Vec<(Jet, DoubleDouble)>,
    /// The joint coordinates in the order of the model file.
    pub(crate) joints: Vec<Jet>,
    /// The frames of the two bodies of each spherical joint, in that order.
    pub(crate) balls: Vec<[[Vector<Jet>; 3]; 2]>,
}

/// A mechanism with `P` positions and `N` speeds.
pub(crate) trait Mechanism<const P: usize, const N: usize> {
    fn gravity(&self) -> Precise;

    /// Rates of the positions.
    fn rates(&self, positions: &[DoubleDouble; P], speeds: [DoubleDouble; N]) -> [DoubleDouble; P];

    /// Where everything is: each thing moves as the speeds, their rates and the time do.
    fn place(
        &self,
        t: Jet,
        positions: &[DoubleDouble; P],
        speeds: [DoubleDouble; N],
        accelerations: [DoubleDouble; N],
    ) -> Scene;
}

/// Derivative of a state (positions, speeds).
pub(crate) fn derivative<const P: usize, const N: usize, const S: usize>(
    mechanism: &impl Mechanism<P, N>,
    t: DoubleDouble,
    state: &State<S>,
) -> State<S> {
    let (positions, speeds) = parts::<P, N, S>(state);
    let rates = mechanism.rates(&positions, speeds);
    let accelerations = accelerations(mechanism, t, &positions, speeds);
    core::array::from_fn(|k| if k < P { rates[k] } else { accelerations[k - P] })
}

/// Positions and speeds of a state.
pub(crate) fn parts<const P: usize, const N: usize, const S: usize>(
    state: &State<S>,
) -> ([DoubleDouble; P], [DoubleDouble; N]) {
    const { assert!(P + N == S, "a state is positions and speeds") };
    (core::array::from_fn(|k| state[k]), core::array::from_fn(|k| state[P + k]))
}

/// The mechanism as it moves, its speeds changing as they do.
pub(crate) fn moving<const P: usize, const N: usize, const S: usize>(
    mechanism: &impl Mechanism<P, N>,
    t: DoubleDouble,
    state: &State<S>,
) -> Scene {
    let (positions, speeds) = parts::<P, N, S>(state);
    let accelerations = accelerations(mechanism, t, &positions, speeds);
    mechanism.place(now(t), &positions, speeds, accelerations)
}

fn now(t: DoubleDouble) -> Jet {
    Jet::new(t, DoubleDouble::new(1.0), DoubleDouble::ZERO)
}

fn accelerations<const P: usize, const N: usize>(
    mechanism: &impl Mechanism<P, N>,
    t: DoubleDouble,
    positions: &[DoubleDouble; P],
    speeds: [DoubleDouble; N],
) -> [DoubleDouble; N] {
    let zero = [DoubleDouble::ZERO; N];
    let scene = mechanism.place(now(t), positions, speeds, zero);
    let partial: [Scene; N] = core::array::from_fn(|r| {
        let mut one = zero;
        one[r] = DoubleDouble::new(1.0);
        mechanism.place(Jet::constant(t), positions, one, zero)
    });
    let (mut matrix, mut forces) = ([zero; N], zero);
    for r in 0..N {
        forces[r] = applied(&scene, &partial[r]);
        for (k, body) in scene.bodies.iter().enumerate() {
            let of = |s: usize| {
                let partial = &partial[s].bodies[k];
                (rates(partial.centre), in_frame(&body.axes, turning(&partial.axes).0))
            };
            let (v, w) = of(r);
            let (own, acceleration) = turning(&body.axes);
            let (own, acceleration) = (in_frame(&body.axes, own), in_frame(&body.axes, acceleration));
            let momentum = tensor_times(body.inertia, own);
            let change = add(tensor_times(body.inertia, acceleration), cross(own, momentum));
            let inertial = sub(mechanism.gravity(), seconds(body.centre));
            forces[r] = forces[r] + body.mass * dot(v, inertial) - dot(w, change);
            for (s, entry) in matrix[r].iter_mut().enumerate() {
                let (other, turn) = of(s);
                *entry = *entry + body.mass * dot(v, other) + dot(w, tensor_times(body.inertia, turn));
            }
        }
    }
    solve(matrix, forces)
}

/// Q_r: what springs, dampers and friction do along a partial velocity.
fn applied(scene: &Scene, partial: &Scene) -> DoubleDouble {
    let mut sum = DoubleDouble::ZERO;
    for (strut, partial) in scene.struts.iter().zip(&partial.struts) {
        let (length, along) = (strut.length(), partial.length().rate);
        sum = sum - (strut.stiffness * (length.value - strut.free) + strut.damping * length.rate) * along;
    }
    for ((coordinate, stiffness), (partial, _)) in scene.springs.iter().zip(&partial.springs) {
        sum = sum - *stiffness * coordinate.value * partial.rate;
    }
    for ((coordinate, coefficient), (partial, _)) in scene.friction.iter().zip(&partial.friction) {
        sum = sum - *coefficient * coordinate.rate * partial.rate;
    }
    sum
}

impl Strut {
    fn length(&self) -> Jet {
        let way = sub(self.ends[1], self.ends[0]);
        dot(way, way).sqrt()
    }
}

impl Scene {
    /// The joints as a model file counts them, rounded.
    pub(crate) fn row(&self, t: DoubleDouble) -> JointRow {
        let rounded = |of: fn(&Jet) -> DoubleDouble| self.joints.iter().map(|x| of(x).to_f64()).collect();
        let orientation = |[first, second]: &[[Vector<Jet>; 3]; 2]| {
            let relative = sub(turning(second).0, turning(first).0);
            let entry = |i: usize, j: usize| dot(values(first[i]), values(second[j])).to_f64();
            Orientation {
                rotation: core::array::from_fn(|i| core::array::from_fn(|j| entry(i, j))),
                angular_velocity: in_frame(second, relative).map(DoubleDouble::to_f64),
            }
        };
        JointRow {
            t: t.to_f64(),
            positions: rounded(|x| x.value),
            rates: rounded(|x| x.rate),
            orientations: self.balls.iter().map(orientation).collect(),
        }
    }

    /// Kinetic energy, that of gravity and that of springs.
    pub(crate) fn energy(&self, gravity: Precise) -> DoubleDouble {
        let mut sum = DoubleDouble::ZERO;
        for body in &self.bodies {
            let (v, w) = (rates(body.centre), in_frame(&body.axes, turning(&body.axes).0));
            let doubled = body.mass * dot(v, v) + dot(w, tensor_times(body.inertia, w));
            sum = sum + doubled.times(0.5) - body.mass * dot(gravity, values(body.centre));
        }
        for strut in &self.struts {
            let stretch = strut.length().value - strut.free;
            sum = sum + (strut.stiffness * stretch * stretch).times(0.5);
        }
        for (coordinate, stiffness) in &self.springs {
            sum = sum + (*stiffness * coordinate.value * coordinate.value).times(0.5);
        }
        sum
    }

    /// Angular momentum about the origin.
    pub(crate) fn angular_momentum(&self) -> Precise {
        self.bodies.iter().fold(ORIGIN, |sum, body| {
            let own = tensor_times(body.inertia, in_frame(&body.axes, turning(&body.axes).0));
            let spin = (0..3).fold(ORIGIN, |spin, k| add(spin, scale(own[k], values(body.axes[k]))));
            let orbit = scale(body.mass, cross(values(body.centre), rates(body.centre)));
            add(sum, add(spin, orbit))
        })
    }
}

/// Angular velocity and acceleration, global: half the sums of a × ȧ and a × ä over the three axes.
fn turning(axes: &[Vector<Jet>; 3]) -> (Precise, Precise) {
    let half_sum = |derivative: fn(Vector<Jet>) -> Precise| {
        let sum = axes.iter().fold(ORIGIN, |sum, &axis| add(sum, cross(values(axis), derivative(axis))));
        scale(DoubleDouble::new(0.5), sum)
    };
    (half_sum(rates), half_sum(seconds))
}

fn in_frame(axes: &[Vector<Jet>; 3], v: Precise) -> Precise {
    axes.map(|axis| dot(values(axis), v))
}

fn values(v: Vector<Jet>) -> Precise {
    v.map(|x| x.value)
}

fn rates(v: Vector<Jet>) -> Precise {
    v.map(|x| x.rate)
}

fn seconds(v: Vector<Jet>) -> Precise {
    v.map(|x| x.second)
}

/// The frame turned about a unit vector of its own by an angle: Rodrigues' formula for each axis.
pub(crate) fn turned(axes: [Vector<Jet>; 3], about: Precise, angle: Jet) -> [Vector<Jet>; 3] {
    use crate::Real;
    let (sin, cos) = angle.sin_cos();
    let about = about.map(Jet::constant);
    let rest = Jet::from(1.0) - cos;
    let one =
        |k: usize| -> Vector<Jet> { core::array::from_fn(|i| Jet::from(if i == k { 1.0 } else { 0.0 })) };
    core::array::from_fn(|k| {
        let v = one(k);
        let own = add(scale(cos, v), add(scale(sin, cross(about, v)), scale(rest * dot(about, v), about)));
        carried(&axes, own)
    })
}

/// A vector of a frame in the global frame.
pub(crate) fn carried(axes: &[Vector<Jet>; 3], v: Vector<Jet>) -> Vector<Jet> {
    add(scale(v[0], axes[0]), add(scale(v[1], axes[1]), scale(v[2], axes[2])))
}

/// The global frame.
pub(crate) fn global() -> [Vector<Jet>; 3] {
    core::array::from_fn(|k| core::array::from_fn(|i| Jet::from(if i == k { 1.0 } else { 0.0 })))
}
