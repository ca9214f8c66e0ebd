//! The start: positions and velocities that satisfy every constraint, assembled from the root of each tree to its
//! leaves.

use std::fmt;

use crate::validate::Place;
use crate::{
    Attachment, Joint, JointEnd, JointKind, Link, Model, Number, Quaternion, Rational, Support, Tree, Vector,
};

/// Consistent positions and velocities at time zero.
#[derive(Clone, Debug, PartialEq)]
pub struct Start {
    /// For each body of [`Model::coordinate_bodies`] seven numbers: position of the mass centre (m, global) and unit
    /// Euler parameters. A child's Euler parameters are the ones nearer to its parent's.
    pub q: Vec<f64>,
    /// For each of them six numbers: velocity of the mass centre (m/s, global) and w' (rad/s, body frame).
    pub v: Vec<f64>,
    /// The joints' own coordinates, in the order of [`Model::joints`].
    pub joints: Vec<JointStart>,
}

/// Coordinates and rates of one joint at time zero, from its first body to its second.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct JointStart {
    /// Revolute: the angle in rad, turns included. Spherical: Euler parameters of the second body in the first body's
    /// frame. Fixed: empty.
    pub position: Vec<f64>,
    /// Revolute: the rate in rad/s. Spherical: relative angular velocity in the second body's frame. Fixed: empty.
    pub rate: Vec<f64>,
}

/// Why a model has no consistent start.
#[derive(Clone, Debug, PartialEq)]
pub enum AssemblyError {
    /// No rate of its joint gives a body the angular velocity that the page asks for.
    AngularVelocity {
        /// Index into [`Model::bodies`].
        body: usize,
        /// Name of the body.
        name: String,
        /// Name of the joint that holds it.
        joint: String,
        /// Absolute angular velocity in the body's frame, as asked for, rad/s.
        wanted: [f64; 3],
        /// The nearest one that the joint allows, rad/s.
        nearest: [f64; 3],
    },
    /// A joint closes a loop.
    Loop {
        /// Name of the joint.
        joint: String,
    },
    /// A body is neither fixed nor free, and no joint leads to it.
    Unconnected {
        /// Name of the body.
        name: String,
    },
    /// A position or velocity of a body is infinite or not a number, or so large that its square would be.
    NotFinite {
        /// Index into [`Model::bodies`].
        body: usize,
        /// Name of the body.
        name: String,
    },
}

impl AssemblyError {
    /// The number of the page that is at fault, where it is one.
    pub(crate) fn place(&self) -> Option<Place> {
        match self {
            Self::AngularVelocity { body, .. } => Some(Place::body(*body, "angular_velocity")),
            Self::NotFinite { body, .. } => Some(Place::body(*body, "")),
            Self::Loop { .. } | Self::Unconnected { .. } => None,
        }
    }

    /// What to write instead.
    pub(crate) fn help(&self) -> String {
        match self {
            Self::AngularVelocity { joint, nearest, .. } => {
                format!(
                    "write angular_velocity = {nearest:?}, or leave it out and give joint `{joint}` a `rate`"
                )
            }
            _ => "give the joints that lead to it moderate lengths and rates".to_owned(),
        }
    }
}

impl fmt::Display for AssemblyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::AngularVelocity { name, joint, wanted, nearest, .. } => write!(
                f,
                "body `{name}` cannot start with angular velocity {wanted:?} rad/s: joint `{joint}` allows \
                 {nearest:?} at best"
            ),
            Self::Loop { joint } => {
                write!(f, "joint `{joint}` closes a loop: mechanisms with closed loops are not supported yet")
            }
            Self::Unconnected { name } => write!(f, "body `{name}` is connected to nothing"),
            Self::NotFinite { name, .. } => {
                write!(f, "the start of body `{name}` is too large to compute with")
            }
        }
    }
}

impl std::error::Error for AssemblyError {}

impl Model {
    /// Positions and velocities that satisfy Φ = 0 and Φ_q q̇ = ν to rounding, with the parameters as they are.
    ///
    /// Walks [`Tree`] from the roots: a joint's angle and rate (or the child's absolute angular velocity) place the
    /// child on its parent. Joint frames are exact up to one rounding.
    ///
    /// # Errors
    /// A loop, an unconnected body, an angular velocity that the joint does not allow, or a start beyond `f64`.
    pub fn assemble(&self) -> Result<Start, AssemblyError> {
        let tree = Tree::of(self);
        if let Some(&joint) = tree.loop_joints.first() {
            return Err(AssemblyError::Loop { joint: self.joints[joint].name.clone() });
        }
        if let Some(&body) = tree.unreached.first() {
            return Err(AssemblyError::Unconnected { name: self.bodies[body].name.clone() });
        }
        let mut assembly = Assembly::of_roots(self);
        for link in &tree.links {
            if let Attachment::Joint { joint, parent, reversed } = link.attachment {
                assembly.place(Hanging { body: link.body, joint, parent, reversed })?;
            }
        }
        assembly.finish(&tree.links)
    }
}

/// Where a body is and how it moves.
#[derive(Clone, Copy, Debug)]
struct Motion {
    /// Position of the mass centre, global.
    r: Vector,
    /// Euler parameters.
    p: Quaternion,
    /// Velocity of the mass centre, global.
    s: Vector,
    /// Angular velocity w', body frame: kept there, so that what the page gives stays as it is.
    w: Vector,
}

/// A body that hangs on its parent by a joint.
#[derive(Clone, Copy, Debug)]
struct Hanging {
    body: usize,
    joint: usize,
    parent: usize,
    reversed: bool,
}

/// The work in progress.
struct Assembly<'m> {
    model: &'m Model,
    motions: Vec<Motion>,
    joints: Vec<JointStart>,
}

/// Largest part of an angular velocity that may be lost because the joint does not allow it: far above rounding, far
/// below what one writes on purpose.
const RATE_TOLERANCE: f64 = 1e-9;

impl<'m> Assembly<'m> {
    /// Every body as the page places it; only fixed and free ones mean it.
    fn of_roots(model: &'m Model) -> Self {
        let motions = model.bodies.iter().map(|body| {
            let free = body.support == Support::Free;
            let p = Quaternion::unit(&exact(model, &body.orientation)).unwrap_or(Quaternion::IDENTITY);
            let p = p.nearest(Quaternion::IDENTITY);
            let w =
                body.angular_velocity.as_ref().filter(|_| free).map_or(Vector::ZERO, |w| vector(model, w));
            let s = if free { vector(model, &body.velocity) } else { Vector::ZERO };
            Motion { r: vector(model, &body.position), p, s, w }
        });
        Self { model, motions: motions.collect(), joints: vec![JointStart::default(); model.joints.len()] }
    }

    /// Places a body on its parent.
    fn place(&mut self, hanging: Hanging) -> Result<(), AssemblyError> {
        let joint = &self.model.joints[hanging.joint];
        let parent = self.motions[hanging.parent];
        let relative = self.relative_orientation(joint);
        let step = if hanging.reversed { relative.conjugate() } else { relative };
        let p = (parent.p * step).normalised().nearest(parent.p);
        let w = self.angular_velocity(hanging, step)?;
        let (near, far) =
            if hanging.reversed { (&joint.second, &joint.first) } else { (&joint.first, &joint.second) };
        let (near, far) = (vector(self.model, &near.point), vector(self.model, &far.point));
        // Paper, eq. (7), and its derivative.
        let r = parent.r + (parent.p.rotate(near) - p.rotate(far));
        let s = parent.s + (parent.p.rotate(parent.w.cross(near)) - p.rotate(w.cross(far)));
        self.motions[hanging.body] = Motion { r, p, s, w };
        self.joints[hanging.joint].position = self.position(joint);
        Ok(())
    }

    /// Euler parameters of the second body in the first body's frame.
    fn relative_orientation(&self, joint: &Joint) -> Quaternion {
        if joint.kind == JointKind::Spherical {
            let given = joint.start.orientation.as_ref();
            return given
                .and_then(|p| Quaternion::unit(&exact(self.model, p)))
                .unwrap_or(Quaternion::IDENTITY);
        }
        let turn = Quaternion::about_z(self.angle(joint));
        let [first, second] = [&joint.first, &joint.second].map(|end| joint_frame(self.model, end));
        first * turn * second.conjugate()
    }

    /// Angle of a revolute joint; a fixed one is a revolute one that stays at zero.
    fn angle(&self, joint: &Joint) -> f64 {
        joint.start.angle.as_ref().map_or(0.0, |angle| self.model.value(angle))
    }

    fn position(&self, joint: &Joint) -> Vec<f64> {
        match joint.kind {
            JointKind::Revolute => vec![self.angle(joint)],
            JointKind::Spherical => {
                let [first, second] = [&joint.first, &joint.second].map(|end| self.motions[end.body].p);
                (first.conjugate() * second).normalised().0.to_vec()
            }
            JointKind::Fixed => Vec::new(),
        }
    }

    /// The child's w', from the joint's rate or from what the page wants of the child; leaves the rate with the joint.
    /// `step` is the child's orientation in its parent's frame.
    fn angular_velocity(&mut self, hanging: Hanging, step: Quaternion) -> Result<Vector, AssemblyError> {
        let carried = step.rotate_back(self.motions[hanging.parent].w);
        let wanted = self.model.bodies[hanging.body].angular_velocity.as_ref().map(|w| vector(self.model, w));
        let sought = wanted.map(|wanted| wanted - carried);
        let (rate, own) = self.own_motion(hanging, step, sought);
        self.joints[hanging.joint].rate = rate;
        let reached = carried + own;
        match wanted {
            Some(wanted) => self.check_reached(hanging, wanted, reached).map(|()| reached),
            None => Ok(reached),
        }
    }

    /// The joint's rate, and the child's angular velocity relative to its parent in the child's frame: the given rate,
    /// or the one that comes nearest to what is sought.
    fn own_motion(&self, hanging: Hanging, step: Quaternion, sought: Option<Vector>) -> (Vec<f64>, Vector) {
        let joint = &self.model.joints[hanging.joint];
        let given = joint.start.rate.as_deref().unwrap_or_default();
        let given: Vec<f64> = given.iter().map(|x| self.model.value(x)).collect();
        match joint.kind {
            JointKind::Revolute => {
                // The first body turns backwards about the axis, seen from the second.
                let axis = if hanging.reversed {
                    -axis(self.model, &joint.first)
                } else {
                    axis(self.model, &joint.second)
                };
                let rate = given.first().copied().or(sought.map(|w| w.dot(axis))).unwrap_or(0.0);
                (vec![rate], axis * rate)
            }
            JointKind::Spherical => {
                let given = <[f64; 3]>::try_from(given).ok().map(Vector);
                let of_second = |w: Vector| if hanging.reversed { -step.rotate(w) } else { w };
                let rate = given.or(sought.map(of_second)).unwrap_or(Vector::ZERO);
                (rate.0.to_vec(), if hanging.reversed { -step.rotate_back(rate) } else { rate })
            }
            JointKind::Fixed => (Vec::new(), Vector::ZERO),
        }
    }

    fn check_reached(&self, hanging: Hanging, wanted: Vector, nearest: Vector) -> Result<(), AssemblyError> {
        let scale = wanted.norm().max(self.motions[hanging.parent].w.norm());
        if (wanted - nearest).norm() <= RATE_TOLERANCE * scale {
            return Ok(());
        }
        Err(AssemblyError::AngularVelocity {
            body: hanging.body,
            name: self.model.bodies[hanging.body].name.clone(),
            joint: self.model.joints[hanging.joint].name.clone(),
            wanted: wanted.0,
            nearest: nearest.0,
        })
    }

    /// Lays the motions out as coordinates.
    fn finish(self, links: &[Link]) -> Result<Start, AssemblyError> {
        let (mut q, mut v) = (Vec::new(), Vec::new());
        for body in self.model.coordinate_bodies() {
            let Motion { r, p, s, w } = self.motions[body];
            q.extend(r.0.iter().chain(&p.0));
            v.extend(s.0.iter().chain(&w.0));
        }
        let finite = |body: usize| {
            let Motion { r, p, s, w } = self.motions[body];
            [r.norm(), p.dot(p), s.norm(), w.norm()].iter().all(|x| x.is_finite())
        };
        match links.iter().find(|link| !finite(link.body)) {
            Some(&Link { body, .. }) => {
                Err(AssemblyError::NotFinite { body, name: self.model.bodies[body].name.clone() })
            }
            None => Ok(Start { q, v, joints: self.joints }),
        }
    }
}

fn exact<const N: usize>(model: &Model, numbers: &[Number; N]) -> [Rational; N] {
    std::array::from_fn(|k| model.exact(&numbers[k]))
}

fn vector(model: &Model, numbers: &[Number; 3]) -> Vector {
    Vector(model.values(numbers))
}

/// The unit axis; z where the page's axis is zero, which validation refuses.
fn axis(model: &Model, end: &JointEnd) -> Vector {
    Vector::unit(&exact(model, &end.axis)).unwrap_or(Vector([0.0, 0.0, 1.0]))
}

/// Orientation of the joint frame (f, g, h) in the body's frame: unit zero direction, g = h × f, unit axis.
///
/// The zero direction loses its part along the axis exactly: `h × zero` and `(h × zero) × h` are formed in rationals.
fn joint_frame(model: &Model, end: &JointEnd) -> Quaternion {
    let (axis, zero) = (exact(model, &end.axis), exact(model, &end.zero));
    let side = cross(&axis, &zero);
    let frame = [Vector::unit(&cross(&side, &axis)), Vector::unit(&side), Vector::unit(&axis)];
    match frame {
        [Some(f), Some(g), Some(h)] => Quaternion::from_frame(f, g, h),
        _ => Quaternion::IDENTITY,
    }
}

/// Vector product of exact vectors.
pub(crate) fn cross(a: &[Rational; 3], b: &[Rational; 3]) -> [Rational; 3] {
    [&a[1] * &b[2] - &a[2] * &b[1], &a[2] * &b[0] - &a[0] * &b[2], &a[0] * &b[1] - &a[1] * &b[0]]
}
