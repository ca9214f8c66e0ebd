//! What acts between and on bodies besides joints: drivers, forces; and outputs.

use crate::{BodyFrame, Bushing, CoordinateUse, Formula, JointCoordinate, Motion, Number, Relative, Seen};
use std::slice::from_ref;

/// A joint coordinate prescribed in time: one row `coordinate − motion(t)`.
#[derive(Clone, Debug)]
pub struct Driver {
    /// Name, an identifier.
    pub name: String,
    /// What is driven.
    pub coordinate: JointCoordinate,
    /// How.
    pub motion: Motion,
}

/// A force besides gravity and the joints' own viscous friction.
#[derive(Clone, Debug)]
pub struct Force {
    /// Name, an identifier.
    pub name: String,
    /// What it is.
    pub kind: ForceKind,
}

/// A ready element, which stands for forces, states, outputs and formulas of the model.
#[derive(Clone, Debug)]
pub struct Element {
    /// Name, an identifier, with which the names of its parts begin.
    pub name: String,
    /// The word of its kind.
    pub kind: &'static str,
    /// The table of the model file that it is in: `element`, `rolling` or `contact`.
    pub table: &'static str,
    /// What it was told, by its keys: of a vector each number.
    pub numbers: Vec<(&'static str, Number)>,
}

/// The kinds of force. A force `F(x, ẋ)` *along a joint coordinate* x acts on the second body and as `−F` on the first:
/// of an angle it is the torque `F h_j` on the second body and `−F h_i` on the first, each body's own joint axis
/// (universal: both about `h_i` for the first angle and about `h_j` for the second); of a displacement along u (h_i,
/// f_i or g_i) the force `F u` at the second body's joint point, and `−F u` on the first body *at the same point of
/// space*.
#[derive(Clone, Debug)]
pub enum ForceKind {
    /// `F = −stiffness (x − free)`: linear spring, conservative. Acts on the continuous angle.
    Spring {
        /// Where it acts.
        on: JointCoordinate,
        /// N·m/rad or N/m.
        stiffness: Number,
        /// Coordinate at which the spring is relaxed, rad or m.
        free: Number,
    },
    /// `F = −damping ẋ`.
    Damper {
        /// Where it acts.
        on: JointCoordinate,
        /// N·m·s/rad or N·s/m.
        damping: Number,
    },
    /// `F = −level tanh(ẋ / rate)`: Coulomb friction, regularised.
    Coulomb {
        /// Where it acts.
        on: JointCoordinate,
        /// Torque or force of sliding, N·m or N.
        level: Number,
        /// Rate at which friction reaches tanh(1) of its level, rad/s or m/s.
        rate: Number,
    },
    /// An end stop: `F = −stiffness ρ(x − limit) − damping σ(x − limit) ẋ` for an upper limit, and mirrored for a lower
    /// one, with the smooth ramp `ρ(z) = ½ (z + √(z² + softness²))` and its slope `σ(z) = ½ (1 + z / √(z² +
    /// softness²))`. A lower limit has `F = stiffness ρ(limit − x) − damping σ(limit − x) ẋ`. Counted as
    /// non-conservative.
    Stop {
        /// Where it acts.
        on: JointCoordinate,
        /// The limit, rad or m.
        limit: Number,
        /// Which side is blocked.
        side: StopSide,
        /// N·m/rad or N/m.
        stiffness: Number,
        /// N·m·s/rad or N·s/m.
        damping: Number,
        /// Distance over which the force of the stop builds up, rad or m; greater than zero.
        softness: Number,
    },
    /// `F = value`: a motor. Usually an input.
    Motor {
        /// Where it acts.
        on: JointCoordinate,
        /// N·m or N.
        value: Number,
    },
    /// Between two points of two bodies: the force `−stiffness (l − free_length) − damping l̇ − tension` along the line
    /// from the first point to the second, on the second body; l the distance, which must not vanish. The spring is
    /// conservative.
    Link {
        /// Index of the first body, and the point in its frame, m.
        first: (usize, [Number; 3]),
        /// Index of the second body, and the point in its frame, m.
        second: (usize, [Number; 3]),
        /// N/m.
        stiffness: Number,
        /// N·s/m.
        damping: Number,
        /// m.
        free_length: Number,
        /// What it pulls besides, N; a formula of it may name the distance and its rate.
        tension: Number,
    },
    /// Between two frames of two bodies.
    Bushing(Box<Bushing>),
    /// A force at a point of a body and a torque on it. Counted as non-conservative.
    Load {
        /// Index of the body.
        body: usize,
        /// Point in the body's frame, m.
        point: [Number; 3],
        /// N, in the given frame.
        force: [Number; 3],
        /// N·m, in the given frame.
        torque: [Number; 3],
        /// Frame of force and torque.
        frame: LoadFrame,
    },
    /// `−∂V/∂x` along each joint coordinate x that occurs in the energy V, which is conservative.
    Potential {
        /// V, J: a formula.
        energy: Number,
    },
    /// `−½ ∂P/∂ẋ` along each joint coordinate whose rate occurs in P.
    Dissipation {
        /// P, W: a formula.
        power: Number,
    },
}

/// What can be said of a force whatever its kind is.
#[derive(Clone, Debug)]
pub struct ForceParts<'f> {
    /// The kind's word in the model file.
    pub word: &'static str,
    /// The coordinate along which it acts, and what it asks of it; `None` of what acts on points of bodies.
    pub on: Option<(JointCoordinate, CoordinateUse)>,
    /// Its numbers by their keys; of an end of a link those of its point, of an end of a bushing those of its frame.
    pub numbers: Vec<(&'static str, &'f [Number])>,
}

impl ForceKind {
    /// Its parts.
    pub fn parts(&self) -> ForceParts<'_> {
        use CoordinateUse::{Rate, Value};
        let along = ForceParts::along;
        match self {
            Self::Spring { on, stiffness, free } => {
                along("spring", (*on, Value), &[("stiffness", stiffness), ("free", free)])
            }
            Self::Damper { on, damping } => along("damper", (*on, Rate), &[("damping", damping)]),
            Self::Coulomb { on, level, rate } => {
                along("coulomb", (*on, Rate), &[("level", level), ("rate", rate)])
            }
            Self::Stop { on, limit, side: _, stiffness, damping, softness } => along(
                "stop",
                (*on, Value),
                &[("limit", limit), ("stiffness", stiffness), ("damping", damping), ("softness", softness)],
            ),
            Self::Motor { on, value } => along("motor", (*on, Rate), &[("value", value)]),
            Self::Link { first, second, stiffness, damping, free_length, tension } => ForceParts {
                word: "link",
                on: None,
                numbers: vec![
                    ("first", &first.1[..]),
                    ("second", &second.1),
                    ("stiffness", from_ref(stiffness)),
                    ("damping", from_ref(damping)),
                    ("free_length", from_ref(free_length)),
                    ("tension", from_ref(tension)),
                ],
            },
            Self::Bushing(bushing) => {
                ForceParts { word: "bushing", on: None, numbers: numbers_of_bushing(bushing) }
            }
            Self::Load { body: _, point, force, torque, frame: _ } => ForceParts {
                word: "load",
                on: None,
                numbers: vec![("point", &point[..]), ("force", force), ("torque", torque)],
            },
            Self::Potential { energy } => {
                ForceParts { word: "potential", on: None, numbers: vec![("energy", from_ref(energy))] }
            }
            Self::Dissipation { power } => {
                ForceParts { word: "dissipation", on: None, numbers: vec![("power", from_ref(power))] }
            }
        }
    }

    /// Whether it does work that no potential energy accounts for.
    pub fn does_work(&self) -> bool {
        match self {
            Self::Spring { .. } | Self::Potential { .. } => false,
            Self::Link { damping, tension, .. } => !damping.is_zero() || !tension.is_zero(),
            Self::Bushing(bushing) => {
                let strengths = bushing.strengths();
                let mut others = strengths.iter().flat_map(|[_, others @ ..]| *others).chain(&bushing.moment);
                others.any(|number| !number.is_zero())
            }
            _ => true,
        }
    }

    /// Of a potential or a dissipation its formula, and the coordinates along which it acts, each as the formula sees
    /// it: the coordinate itself, or its rate.
    pub fn slopes(&self) -> Option<(&Formula, Vec<(JointCoordinate, Seen)>)> {
        let (Self::Potential { energy: number } | Self::Dissipation { power: number }) = self else {
            return None;
        };
        let formula = number.formula()?;
        let is_rate = matches!(self, Self::Dissipation { .. });
        let along = formula.sees().filter_map(|seen| match seen {
            Seen::Coordinate(on) if !is_rate => Some((on, seen)),
            Seen::Rate(on) if is_rate => Some((on, seen)),
            _ => None,
        });
        Some((formula, along.collect()))
    }

    /// The kind's word and the two bodies, of what acts between points or frames of two bodies.
    pub(crate) fn between(&self) -> Option<(&'static str, [usize; 2])> {
        match self {
            Self::Link { first, second, .. } => Some(("link", [first.0, second.0])),
            Self::Bushing(bushing) => Some(("bushing", bushing.ends().map(|frame| frame.body))),
            _ => None,
        }
    }

    /// The points of bodies at which it acts, each with the index of its body.
    pub(crate) fn points_mut(&mut self) -> Vec<(usize, &mut [Number; 3])> {
        match self {
            Self::Link { first, second, .. } => vec![(first.0, &mut first.1), (second.0, &mut second.1)],
            Self::Bushing(bushing) => {
                let Bushing { first, second, .. } = &mut **bushing;
                [first, second].map(|frame| (frame.body, &mut frame.point)).into()
            }
            Self::Load { body, point, .. } => vec![(*body, point)],
            _ => Vec::new(),
        }
    }
}

fn numbers_of_bushing(bushing: &Bushing) -> Vec<(&'static str, &[Number])> {
    let Bushing { first, second, along, about, moment } = bushing;
    let mut numbers = vec![
        ("first", &first.point[..]),
        ("second", &second.point),
        ("stiffness", &along.stiffness),
        ("damping", &along.damping),
        ("force", &along.load),
        ("torsion", &about.stiffness),
        ("torsional_damping", &about.damping),
        ("torque", &about.load),
        ("moment", moment),
    ];
    let orientations = [("first", first), ("second", second)].into_iter();
    numbers.extend(orientations.filter_map(|(key, frame)| Some((key, &frame.orientation.as_ref()?[..]))));
    numbers
}

impl<'f> ForceParts<'f> {
    fn along(
        word: &'static str,
        on: (JointCoordinate, CoordinateUse),
        numbers: &[(&'static str, &'f Number)],
    ) -> Self {
        let numbers = numbers.iter().map(|(key, number)| (*key, from_ref(*number))).collect();
        Self { word, on: Some(on), numbers }
    }
}

/// Which side of a limit is blocked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StopSide {
    /// The coordinate cannot fall below the limit.
    Lower,
    /// The coordinate cannot rise above the limit.
    Upper,
}

/// The frame in which a load is constant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LoadFrame {
    /// The global frame.
    Global,
    /// The body's own frame.
    Body,
}

/// Something that a generated module computes only because the model file asks for it.
#[derive(Clone, Debug)]
pub struct Output {
    /// Name, an identifier.
    pub name: String,
    /// What it is.
    pub kind: OutputKind,
}

/// The kinds of output.
#[derive(Clone, Debug)]
pub enum OutputKind {
    /// Position r of a frame's origin (m, global) and the frame's Euler parameters.
    Pose(BodyFrame),
    /// Velocity of a frame's origin (m/s, global) and its angular velocity (rad/s, by its own axes).
    Velocity(BodyFrame),
    /// Acceleration of a frame's origin (m/s², global) and its angular acceleration (rad/s², by its own axes).
    Acceleration(BodyFrame),
    /// What an inertial sensor reads that is fixed in a frame: specific force `Aᵀ(r̈ − g)` (m/s²) at its origin and
    /// angular rate w' (rad/s), both by its axes.
    Inertial(BodyFrame),
    /// How the second of two frames lies and moves, seen from the first: see [`Relative`].
    Relative(Box<Relative>),
    /// Constraint force (N) and torque about the second body's joint point (N·m) that a joint exerts on its second
    /// body, both in the first body's joint frame (f, g, h). Friction, springs, motors and drivers in the joint are not
    /// part of it.
    Reaction {
        /// Index of the joint.
        joint: usize,
    },
    /// Torque or force `−λ` with which a driver acts along its coordinate, N·m or N.
    Driver {
        /// Index into [`crate::Model::drivers`].
        driver: usize,
    },
    /// Torque or force `−λ` with which a coupler acts along its second coordinate, N·m or N; along the first it acts
    /// with `−ratio` times as much. It loads no bearings: gears that push each other apart do in truth.
    Coupler {
        /// Index into [`crate::Model::couplers`].
        coupler: usize,
    },
    /// Torque or force of a spring along its coordinate (N·m or N), `−stiffness` times its deflection, and that, the
    /// coordinate less its free value (rad or m).
    Spring {
        /// Index into [`crate::Model::forces`], of a spring.
        force: usize,
    },
    /// Force with which a link pushes its ends apart, its spring's and its damper's (N), its length (m) and
    /// the rate of that (m/s).
    Link {
        /// Index into [`crate::Model::forces`], of a link.
        force: usize,
    },
    /// Readings of a bushing (m and rad), and force or torque along each (N and N·m).
    Bushing {
        /// Index into [`crate::Model::forces`], of a bushing.
        force: usize,
    },
    /// The value of a formula.
    Formula(Formula),
    /// The time derivative of a formula along the motion, while inputs stay as they are.
    Rate(Formula),
    /// A state of one's own.
    State {
        /// Index into [`crate::Model::states`].
        state: usize,
    },
    /// Kinetic and potential energy, J.
    Energy,
    /// Power of all non-conservative forces, and of drivers and driven bodies, W.
    Power,
}

impl OutputKind {
    /// The frames that it is of.
    pub fn frames(&self) -> &[BodyFrame] {
        match self {
            Self::Pose(frame) | Self::Velocity(frame) | Self::Acceleration(frame) | Self::Inertial(frame) => {
                from_ref(frame)
            }
            Self::Relative(relative) => &relative.frames,
            _ => &[],
        }
    }

    /// The formula, of those that have one.
    pub fn formula(&self) -> Option<&Formula> {
        if let Self::Formula(formula) | Self::Rate(formula) = self { Some(formula) } else { None }
    }

    /// The frames, to be changed.
    pub fn frames_mut(&mut self) -> &mut [BodyFrame] {
        match self {
            Self::Pose(frame) | Self::Velocity(frame) | Self::Acceleration(frame) | Self::Inertial(frame) => {
                std::slice::from_mut(frame)
            }
            Self::Relative(relative) => &mut relative.frames,
            _ => &mut [],
        }
    }

    /// Suffix and unit of each of the output's numbers, in order. An output of one number has no suffix.
    pub fn columns(&self) -> &'static [(&'static str, &'static str)] {
        match self {
            Self::Pose(_) => {
                &[("rx", "m"), ("ry", "m"), ("rz", "m"), ("e0", ""), ("e1", ""), ("e2", ""), ("e3", "")]
            }
            Self::Velocity(_) => &[
                ("vx", "m/s"),
                ("vy", "m/s"),
                ("vz", "m/s"),
                ("wx", "rad/s"),
                ("wy", "rad/s"),
                ("wz", "rad/s"),
            ],
            Self::Acceleration(_) => &[
                ("ax", "m/s2"),
                ("ay", "m/s2"),
                ("az", "m/s2"),
                ("dwx", "rad/s2"),
                ("dwy", "rad/s2"),
                ("dwz", "rad/s2"),
            ],
            Self::Inertial(_) => &[
                ("fx", "m/s2"),
                ("fy", "m/s2"),
                ("fz", "m/s2"),
                ("wx", "rad/s"),
                ("wy", "rad/s"),
                ("wz", "rad/s"),
            ],
            Self::Relative(_) => &Relative::COLUMNS,
            Self::Reaction { .. } => &[
                ("force_f", "N"),
                ("force_g", "N"),
                ("force_h", "N"),
                ("torque_f", "N*m"),
                ("torque_g", "N*m"),
                ("torque_h", "N*m"),
            ],
            Self::Driver { .. } | Self::Coupler { .. } => &[("", "N*m or N")],
            Self::Spring { .. } => &[("force", "N*m or N"), ("deflection", "rad or m")],
            Self::Link { .. } => &[("force", "N"), ("length", "m"), ("rate", "m/s")],
            Self::Bushing { .. } => &[
                ("x", "m"),
                ("y", "m"),
                ("z", "m"),
                ("angle_x", "rad"),
                ("angle_y", "rad"),
                ("angle_z", "rad"),
                ("force_x", "N"),
                ("force_y", "N"),
                ("force_z", "N"),
                ("torque_x", "N*m"),
                ("torque_y", "N*m"),
                ("torque_z", "N*m"),
            ],
            Self::Formula(_) | Self::Rate(_) | Self::State { .. } => &[("", "1")],
            Self::Energy => &[("kinetic", "J"), ("potential", "J")],
            Self::Power => &[("non_conservative", "W"), ("drivers", "W")],
        }
    }
}
