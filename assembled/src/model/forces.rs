//! Applied forces, paper, eqs. (21) and (22): gravity, damping in the joints, and the forces of the model file.

use crate::model::amount::{Amount, Now};
use crate::model::bushing::{Bushing, Part};
use crate::model::joint::Joint;
use crate::model::law::Law;
use crate::model::measure::Coordinate;
use crate::model::motion::Motion;
use crate::model::path::{Path, Wrench};
use crate::model::place::{Moment, Place, Places, vector};
use crate::model::scene::Scene;
use crate::number::Number;
use gyro_model::{ForceKind, JointKind, LoadFrame, Model};
use nalgebra::Vector3;

/// One thing that exerts forces.
#[derive(Clone, Debug)]
pub(crate) enum Element<T> {
    /// A force along a coordinate, between two bodies.
    Along { path: Path<T>, law: Law<T> },
    /// What acts between two frames.
    Between(Box<Bushing<T>>, Part),
    /// Viscous damping of a spherical joint: minus this times the relative angular velocity.
    Ball { joint: usize, damping: T },
    /// Force and torque on one body.
    Load {
        place: Place<T>,
        point: Vector3<T>,
        force: [Amount<T>; 3],
        torque: [Amount<T>; 3],
        frame: LoadFrame,
    },
    /// What a central body attracts a body with.
    Attraction { place: Place<T>, mass: T },
}

impl<T: Number> Element<T> {
    /// Friction of the joints, the forces of the model file, the attraction of a central body.
    pub(crate) fn all(model: &Model, places: &Places<T>, joints: &[Joint<T>]) -> Vec<Self> {
        let own = (0..joints.len()).filter_map(|joint| Self::damping(model, joints, joint));
        let forces = model.forces.iter().flat_map(|force| Self::new(model, places, joints, &force.kind));
        let bodies = model.coordinate_bodies().into_iter().filter(|_| model.attraction.is_some());
        let mass = |body: usize| crate::number::number(model.value(&model.bodies[body].mass));
        let attracted = bodies.map(|body| Self::Attraction { place: places.of(body), mass: mass(body) });
        own.chain(forces).chain(attracted).collect()
    }

    /// A joint's own viscous damping.
    fn damping(model: &Model, joints: &[Joint<T>], joint: usize) -> Option<Self> {
        let damping = &model.joints[joint].damping;
        if damping.is_zero() {
            return None;
        }
        if joints[joint].kind == JointKind::Spherical {
            return Some(Self::Ball { joint, damping: crate::number::number(model.value(damping)) });
        }
        let described = &joints[joint];
        described.references.first()?;
        let coordinate = Coordinate::of(described, 0);
        let law = Law::Damper { damping: Amount::Constant(crate::number::number(model.value(damping))) };
        Some(Self::Along { path: Path::Coordinate(coordinate), law })
    }

    fn new(model: &Model, places: &Places<T>, joints: &[Joint<T>], kind: &ForceKind) -> Vec<Self> {
        let amount = |number: &_| Amount::new(model, (places, joints), number);
        match kind {
            ForceKind::Link { first, second, stiffness, damping, free_length, tension } => {
                let end = |(body, point): &(usize, _)| (places.of(*body), vector(model.values(point)));
                let path = Path::Line([end(first), end(second)]);
                let spring = Law::Spring { stiffness: amount(stiffness), free: amount(free_length) };
                let damper = Law::Damper { damping: amount(damping) };
                let pull = Law::Pull { tension: amount(tension) };
                let wanted = [(stiffness, spring), (damping, damper), (tension, pull)];
                let wanted = wanted.into_iter().filter(|(strength, _)| !strength.is_zero());
                wanted.map(|(_, law)| Self::Along { path, law }).collect()
            }
            ForceKind::Bushing(bushing) => {
                let bushing = Bushing::new(model, (places, joints), bushing);
                let parts = bushing.parts().into_iter();
                parts.map(|part| Self::Between(Box::new(bushing.clone()), part)).collect()
            }
            ForceKind::Load { body, point, force, torque, frame } => vec![Self::Load {
                place: places.of(*body),
                point: vector(model.values(point)),
                force: force.each_ref().map(amount),
                torque: torque.each_ref().map(amount),
                frame: *frame,
            }],
            ForceKind::Potential { energy: number } | ForceKind::Dissipation { power: number } => {
                let along = kind.slopes().map(|(_, along)| along).unwrap_or_default();
                let one = |(index, (on, by)): (usize, (gyro_model::JointCoordinate, _))| {
                    let path = Path::Coordinate(Coordinate::of(&joints[on.joint], on.coordinate));
                    let law = match kind {
                        ForceKind::Potential { .. } => {
                            Law::Descent { energy: amount(number), by, tells: index == 0 }
                        }
                        _ => Law::Loss { power: amount(number), by },
                    };
                    Self::Along { path, law }
                };
                along.into_iter().enumerate().map(one).collect()
            }
            kind => {
                let along = kind.parts().on.zip(Law::of(kind, amount)).map(|((on, _), law)| {
                    let path = Path::Coordinate(Coordinate::of(&joints[on.joint], on.coordinate));
                    Self::Along { path, law }
                });
                along.into_iter().collect()
            }
        }
    }

    /// Whether the energy counts what the element does.
    pub(crate) fn is_conservative(&self) -> bool {
        match self {
            Self::Along { law, .. } => law.is_conservative(),
            Self::Between(_, part) => *part == Part::Springs,
            Self::Attraction { .. } => true,
            Self::Ball { .. } | Self::Load { .. } => false,
        }
    }

    /// Calls the sink with what the element exerts on each of its bodies, and that body's motion.
    pub(crate) fn exert(
        &self,
        scene: &Scene<T>,
        at: Moment<'_, T>,
        mut sink: impl FnMut(&Place<T>, &Motion<T>, Wrench<T>),
    ) {
        match self {
            Self::Along { path, law } => {
                let places = path.places(scene);
                let motions = places.map(|place| scene.motion(at, place));
                let grip = path.grip(scene, &motions);
                let x = || path.value(scene, at);
                let now = Now::new(scene, at);
                let now = if let Path::Line(_) = path { Now { line: [x(), grip.rate], ..now } } else { now };
                let force = law.force(&now, x, grip.rate);
                for ((place, motion), wrench) in places.into_iter().zip(&motions).zip(&grip.wrenches) {
                    sink(place, motion, wrench.times(force));
                }
            }
            Self::Between(bushing, part) => bushing.exert(*part, scene, at, sink),
            Self::Ball { joint, damping } => {
                let joint = &scene.joints[*joint];
                let [i, j] = scene.motions(at, joint);
                let torque = relative_angular_velocity(&i, &j) * -*damping;
                sink(&joint.first.place, &i, Wrench::torque(-i.a.tr_mul(&(j.a * torque))));
                sink(&joint.second.place, &j, Wrench::torque(torque));
            }
            Self::Attraction { place, mass } => {
                let motion = scene.motion(at, place);
                let wrench = Wrench { force: scene.gravity_at(&motion.r) * *mass, torque: Vector3::zeros() };
                sink(place, &motion, wrench);
            }
            Self::Load { place, point, force, torque, frame } => {
                let motion = scene.motion(at, place);
                let now = Now::new(scene, at);
                let [force, torque] =
                    [force, torque].map(|v| Vector3::from(v.each_ref().map(|x| x.value(&now))));
                // Both in the body's frame.
                let (force, torque) = match frame {
                    LoadFrame::Body => (force, torque),
                    LoadFrame::Global => (motion.a.tr_mul(&force), motion.a.tr_mul(&torque)),
                };
                let wrench = Wrench { force: motion.a * force, torque: torque + point.cross(&force) };
                sink(place, &motion, wrench);
            }
        }
    }
}

/// `w'_j − A_jᵀ A_i w'_i`, in the second body's frame.
pub(crate) fn relative_angular_velocity<T: Number>(i: &Motion<T>, j: &Motion<T>) -> Vector3<T> {
    j.w - j.a.tr_mul(&(i.a * i.w))
}
