//! From the roots of the trees to their leaves: joint coordinates and rates place each body on its parent.

use super::error::AssemblyError;
use super::guess::Guess;
use super::{JointStart, Start};
use crate::kinematics::JointGeometry;
use crate::{Attachment, CoordinateKind, JointKind, Link, Model, Number, Quaternion, Support, Tree, Vector};

/// Where a body is and how it moves.
#[derive(Clone, Copy, Debug)]
pub(super) struct State {
    /// Position of the mass centre, global.
    pub(super) r: Vector,
    /// Euler parameters.
    pub(super) p: Quaternion,
    /// Velocity of the mass centre, global.
    pub(super) s: Vector,
    /// Angular velocity w', body frame: kept there, so that what the model file gives stays as it is.
    pub(super) w: Vector,
}

/// All bodies placed by the trees.
pub(super) struct Walk<'m> {
    model: &'m Model,
    geometry: &'m [JointGeometry],
    guesses: &'m [Guess],
    pub(super) states: Vec<State>,
    /// The joints of the trees.
    pub(super) joints: Vec<JointStart>,
    /// The first body whose joint does not allow the angular velocity that the model file gives.
    pub(super) missed: Option<AssemblyError>,
}

/// A body that hangs on its parent by a joint.
#[derive(Clone, Copy, Debug)]
struct Hanging {
    body: usize,
    joint: usize,
    parent: usize,
    reversed: bool,
}

/// Largest part of an angular velocity that may be lost because the joint does not allow it: far above rounding, far
/// below what one writes on purpose.
const RATE_TOLERANCE: f64 = 1e-9;

/// Orientation of a universal joint's second frame in its first at zero angles: `f_j = h_i`, `g_j = −g_i`, `h_j = f_i`.
const CROSSED: Quaternion =
    Quaternion([0.0, std::f64::consts::FRAC_1_SQRT_2, 0.0, std::f64::consts::FRAC_1_SQRT_2]);

/// Every body as the model file places it; this counts only for fixed, driven and free ones and for those that only
/// rods hold.
pub(super) fn roots(model: &Model, tree: &Tree) -> Vec<State> {
    let state = |(index, body): (usize, &crate::Body)| {
        if let Some(motion) = &body.motion {
            let now = motion.state(model, body, 0.0);
            return State { r: now.r, p: now.p, s: now.s, w: now.w };
        }
        let floats = body.support == Support::Free || tree.floating.contains(&index);
        let of = |numbers: &[Number; 3]| if floats { vector(model, numbers) } else { Vector::zeros() };
        State {
            r: vector(model, &body.position),
            // A motion counts from its own side; what the file gives of a body that floats keeps its sign.
            p: if floats { body.given_orientation(model) } else { body.unit_orientation(model) },
            s: of(&body.velocity),
            w: body.angular_velocity.as_ref().map_or(Vector::zeros(), of),
        }
    };
    model.bodies.iter().enumerate().map(state).collect()
}

impl<'m> Walk<'m> {
    /// Places every body that hangs on another, from roots that stay as they are.
    pub(super) fn of(
        model: &'m Model,
        tree: &Tree,
        geometry: &'m [JointGeometry],
        guesses: &'m [Guess],
        roots: Vec<State>,
    ) -> Self {
        let joints = vec![JointStart::default(); model.joints.len()];
        let mut walk = Self { model, geometry, guesses, states: roots, joints, missed: None };
        for link in &tree.links {
            if let Attachment::Joint { joint, parent, reversed } = link.attachment {
                walk.place(Hanging { body: link.body, joint, parent, reversed });
            }
        }
        walk
    }

    /// Places a body on its parent.
    fn place(&mut self, hanging: Hanging) {
        let (joint, parent) = (&self.geometry[hanging.joint], self.states[hanging.parent]);
        let relative = self.relative_orientation(hanging);
        let step = if hanging.reversed { relative.conjugate() } else { relative };
        let p = (parent.p * step).normalised();
        let is_given = match joint.kind {
            JointKind::Spherical => self.guesses[hanging.joint].orientation.is_some(),
            JointKind::PointOnLine => true,
            _ => false,
        };
        let p = if is_given { p } else { p.positive() };
        let w = self.angular_velocity(hanging, step);
        let (near, far) = if hanging.reversed {
            (joint.second.point, joint.first.point)
        } else {
            (joint.first.point, joint.second.point)
        };
        let (d, rate) = self.displacement(hanging.joint);
        let (first, back) = if hanging.reversed { (p, -1.0) } else { (parent.p, 1.0) };
        let w_first = if hanging.reversed { w } else { parent.w };
        // Paper, eq. (7) with the displacement, and its derivative.
        let r = parent.r + (parent.p.rotate(near) - p.rotate(far)) + first.rotate(d) * back;
        let s = parent.s
            + (parent.p.rotate(parent.w.cross(&near)) - p.rotate(w.cross(&far)))
            + first.rotate(w_first.cross(&d) + rate) * back;
        self.states[hanging.body] = State { r, p, s, w };
        self.joints[hanging.joint].position = self.position(hanging.joint);
    }

    /// Euler parameters of the second body in the first body's frame.
    fn relative_orientation(&self, hanging: Hanging) -> Quaternion {
        let (joint, guess) = (&self.geometry[hanging.joint], &self.guesses[hanging.joint]);
        let turn = |coordinate: usize| Quaternion::about_z(guess.position[coordinate]);
        let between = match joint.kind {
            JointKind::Spherical => return guess.orientation.unwrap_or(Quaternion::IDENTITY),
            JointKind::PointOnLine => {
                return guess.orientation.unwrap_or_else(|| {
                    let (parent, child) = (self.states[hanging.parent].p, self.states[hanging.body].p);
                    if hanging.reversed { child.conjugate() * parent } else { parent.conjugate() * child }
                });
            }
            JointKind::Universal => turn(0) * CROSSED * turn(1),
            kind => {
                let angle = kind.coordinates().iter().position(|of| *of == CoordinateKind::Angle);
                angle.map_or(Quaternion::about_z(0.0), turn)
            }
        };
        joint.first.frame() * between * joint.second.frame().conjugate()
    }

    /// From the first body's joint point to the second's in the first body's frame, and its rate there.
    fn displacement(&self, joint: usize) -> (Vector, Vector) {
        let (geometry, guess, rate) = (&self.geometry[joint], &self.guesses[joint], &self.joints[joint].rate);
        let mut sum = (Vector::zeros(), Vector::zeros());
        for (k, kind) in geometry.kind.coordinates().iter().enumerate() {
            let direction = match kind {
                CoordinateKind::Displacement => geometry.first.h,
                CoordinateKind::X => geometry.first.f,
                CoordinateKind::Y => geometry.first.g,
                CoordinateKind::Angle if geometry.kind == JointKind::Screw => {
                    geometry.first.h * geometry.lead
                }
                CoordinateKind::Angle | CoordinateKind::FirstAngle | CoordinateKind::SecondAngle => continue,
            };
            sum = (sum.0 + direction * guess.position[k], sum.1 + direction * rate[k]);
        }
        sum
    }

    fn position(&self, joint: usize) -> Vec<f64> {
        let geometry = &self.geometry[joint];
        if geometry.kind != JointKind::Spherical {
            return self.guesses[joint].position.clone();
        }
        relative(&self.states, geometry).0.to_vec()
    }

    /// The child's w', from the joint's rate or from what the model file gives for the child; leaves the rate with the
    /// joint. `step` is the child's orientation in its parent's frame.
    fn angular_velocity(&mut self, hanging: Hanging, step: Quaternion) -> Vector {
        let carried = step.rotate_back(self.states[hanging.parent].w);
        let wanted = self.model.bodies[hanging.body].angular_velocity.as_ref().map(|w| vector(self.model, w));
        let sought = wanted.map(|wanted| wanted - carried);
        let (rate, own) = self.own_motion(hanging, step, sought);
        self.joints[hanging.joint].rate = rate;
        let reached = carried + own;
        if let Some(wanted) = wanted {
            self.check_reached(hanging, wanted, reached);
        }
        reached
    }

    /// The joint's rates, and the child's angular velocity relative to its parent in the child's frame: the given
    /// rates, or those that come nearest to what is sought.
    fn own_motion(&self, hanging: Hanging, step: Quaternion, sought: Option<Vector>) -> (Vec<f64>, Vector) {
        let (joint, given) = (&self.geometry[hanging.joint], &self.guesses[hanging.joint].rate);
        match joint.kind {
            JointKind::Spherical => {
                let given: Option<Vec<f64>> = given.iter().copied().collect();
                let given = given.and_then(|g| <[f64; 3]>::try_from(g).ok()).map(Vector::from);
                let of_second = |w: Vector| if hanging.reversed { -step.rotate(w) } else { w };
                let rate = given.or(sought.map(of_second)).unwrap_or(Vector::zeros());
                (rate.as_slice().to_vec(), if hanging.reversed { -step.rotate_back(rate) } else { rate })
            }
            // Its orientation is free and has no coordinate.
            JointKind::PointOnLine => (vec![given[0].unwrap_or(0.0)], sought.unwrap_or(Vector::zeros())),
            _ => {
                let mut rates = Vec::with_capacity(given.len());
                let mut own = Vector::zeros();
                for (k, &kind) in joint.kind.coordinates().iter().enumerate() {
                    let axis = turning_axis(joint, kind, hanging.reversed, step);
                    let found = || sought.zip(axis).map(|(w, axis)| w.dot(&axis));
                    let rate = given[k].or_else(found).unwrap_or(0.0);
                    own = axis.map_or(own, |axis| own + axis * rate);
                    rates.push(rate);
                }
                (rates, own)
            }
        }
    }

    fn check_reached(&mut self, hanging: Hanging, wanted: Vector, nearest: Vector) {
        let scale = wanted.norm().max(self.states[hanging.parent].w.norm());
        if (wanted - nearest).norm() <= RATE_TOLERANCE * scale {
            return;
        }
        self.missed.get_or_insert_with(|| AssemblyError::AngularVelocity {
            body: hanging.body,
            name: self.model.bodies[hanging.body].name.clone(),
            joint: self.model.joints[hanging.joint].name.clone(),
            wanted: wanted.into(),
            nearest: nearest.into(),
        });
    }

    /// Lays the states out as coordinates.
    pub(super) fn layout(&self) -> (Vec<f64>, Vec<f64>) {
        let (mut q, mut v) = (Vec::new(), Vec::new());
        for body in self.model.coordinate_bodies() {
            let State { r, p, s, w } = self.states[body];
            q.extend(r.iter().chain(&p.0));
            v.extend(s.iter().chain(&w));
        }
        (q, v)
    }

    /// The start of a mechanism that the trees hold completely.
    pub(super) fn finish(self, links: &[Link]) -> Result<Start, AssemblyError> {
        let (q, v) = self.layout();
        if let Some(missed) = self.missed {
            return Err(missed);
        }
        let start = Start { q, v, joints: self.joints, states: Vec::new(), moved: Vec::new() };
        check_finite(self.model, links, &self.states).map(|()| start)
    }
}

/// Refuses states whose squares leave `f64`.
pub(super) fn check_finite(model: &Model, links: &[Link], states: &[State]) -> Result<(), AssemblyError> {
    let finite = |body: usize| {
        let State { r, p, s, w } = states[body];
        [r.norm(), p.dot(p), s.norm(), w.norm()].iter().all(|x| x.is_finite())
    };
    match links.iter().find(|link| !finite(link.body)) {
        Some(&Link { body, .. }) => {
            Err(AssemblyError::NotFinite { body, name: model.bodies[body].name.clone() })
        }
        None => Ok(()),
    }
}

/// Euler parameters of the second body in the first body's frame.
pub(super) fn relative(states: &[State], joint: &JointGeometry) -> Quaternion {
    let [first, second] = [&joint.first, &joint.second].map(|end| states[end.body].p);
    (first.conjugate() * second).normalised()
}

/// The unit vector, in the child's frame, along which an angle's rate adds to the child's angular velocity; nothing for
/// a displacement. The first body turns backwards, seen from the second.
fn turning_axis(
    joint: &JointGeometry,
    kind: CoordinateKind,
    reversed: bool,
    step: Quaternion,
) -> Option<Vector> {
    let [on_first, on_second] = [joint.first.h, joint.second.h];
    match (kind, reversed) {
        (CoordinateKind::Angle | CoordinateKind::SecondAngle, false) => Some(on_second),
        (CoordinateKind::Angle | CoordinateKind::FirstAngle, true) => Some(-on_first),
        (CoordinateKind::FirstAngle, false) => Some(step.rotate_back(on_first)),
        (CoordinateKind::SecondAngle, true) => Some(-step.rotate_back(on_second)),
        (CoordinateKind::Displacement | CoordinateKind::X | CoordinateKind::Y, _) => None,
    }
}

pub(super) fn vector(model: &Model, numbers: &[Number; 3]) -> Vector {
    Vector::from(model.values(numbers))
}
