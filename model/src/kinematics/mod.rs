//! The kinematics of any model in `f64`: Φ written once, plainly, its derivatives by dual numbers.
//!
//! This is what assembles the start and counts degrees of freedom. It is not fast and shares no derivation with the
//! generator or the runtime-assembled model.

mod equation;
mod exact;
mod geometry;
mod joint;
mod pair;
mod size;

pub(crate) use equation::Equation;
pub(crate) use exact::{cross, exact};
pub(crate) use geometry::{Pose, dot};
pub(crate) use joint::JointGeometry;
use pair::Pair;

use nalgebra::{DMatrix, DVector};
use num_dual::Dual64;

use crate::scalar::Scalar;
use crate::sight::Sight;
use crate::{
    CoordinateKind, Coupling, JointCoordinate, Model, OutputKind, Quaternion, Relative, Row, RowOwner, Seen,
    Support,
};

/// Φ, its derivatives and the joints' coordinates of a model at one instant.
///
/// `q` and `v` are laid out as in [`crate::Start`]; all rows of [`Model::all_rows`] are here, redundant ones included.
/// Angles are continuous: wherever `near` is asked for, it holds for each joint a value near each of its coordinates
/// (what [`Kinematics::coordinates`] gave before), and angles are taken within half a turn of it.
///
/// ```
/// let page = r#"
///     format = 1
///     name = "pendulum"
///     [[body]]
///     name = "ground"
///     fixed = true
///     [[body]]
///     name = "bob"
///     mass = 1
///     inertia = [1, 1, 1]
///     [[joint]]
///     name = "pivot"
///     kind = "revolute"
///     axis = [0, 0, 1]
///     zero = [1, 0, 0]
///     first = { body = "ground" }
///     second = { body = "bob", point = [0, 1, 0] }
///     angle = 7
/// "#;
/// let model = gyro_model::read("pendulum.toml", page).expect("a good model file");
/// let start = model.assemble().expect("a start");
/// let kinematics = gyro_model::Kinematics::at(&model, 0.0);
/// let near: Vec<Vec<f64>> = start.joints.iter().map(|joint| joint.position.clone()).collect();
/// assert!((kinematics.coordinates(&start.q, &near)[0][0] - 7.0).abs() < 1e-14);
/// assert_eq!(kinematics.jacobian(&start.q, &near).shape(), (5, 6));
/// ```
#[derive(Clone, Debug)]
pub struct Kinematics {
    rows: Vec<Row>,
    joints: Vec<JointGeometry>,
    couplers: Vec<CouplerNumbers>,
    drivers: Vec<DriverNumbers>,
    places: Vec<Place>,
    n_moving_bodies: usize,
}

/// Where a body's pose comes from.
#[derive(Clone, Copy, Debug)]
enum Place {
    /// From this moving body of the coordinates. A constrained body is held at the pose.
    Slot { moving_body: usize, held: Option<Pose<f64>> },
    /// Fixed or driven: the pose with its derivative in time.
    Folded(Pose<Dual64>),
}

#[derive(Clone, Debug)]
struct CouplerNumbers {
    second: Option<JointCoordinate>,
    by: Numbers,
    /// The outputs that it sees, by their indices.
    pairs: Vec<(usize, Pair)>,
}

/// What a coupler's second coordinate is to be, or what a constraint has to be zero.
#[derive(Clone, Debug)]
enum Numbers {
    Linear { first: JointCoordinate, ratio: f64, offset: f64 },
    Formula(Sight),
    Rate(Sight),
}

/// A driver's prescribed value with its derivative in time.
#[derive(Clone, Copy, Debug)]
struct DriverNumbers {
    coordinate: JointCoordinate,
    value: Dual64,
}

impl Kinematics {
    /// The kinematics at a time, with the model's parameters as they are.
    pub fn at(model: &Model, t: f64) -> Self {
        let mut moving_bodies = 0..;
        let places = model.bodies.iter().enumerate().map(|(index, body)| match body.support {
            Support::Fixed | Support::Driven => Place::Folded(folded(model, index, t)),
            support => {
                let given = || Pose::new(model.values(&body.position), body.given_orientation(model).0);
                let held = (support == Support::Constrained).then(given);
                Place::Slot { moving_body: moving_bodies.next().expect("endless"), held }
            }
        });
        let places: Vec<Place> = places.collect();
        let time = Dual64::from_re(t).derivative();
        Self {
            rows: model.all_rows(),
            joints: (0..model.joints.len()).map(|joint| JointGeometry::of(model, joint)).collect(),
            couplers: model.couplers.iter().map(|coupler| CouplerNumbers::of(model, coupler)).collect(),
            drivers: model
                .drivers
                .iter()
                .map(|d| DriverNumbers { coordinate: d.coordinate, value: d.motion.at(model, time) })
                .collect(),
            n_moving_bodies: model.coordinate_bodies().len(),
            places,
        }
    }

    /// The rows of Φ, all of them.
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// Φ(q, t), in m or pure.
    pub fn phi(&self, q: &[f64], near: &[Vec<f64>]) -> DVector<f64> {
        self.values(&self.equations(), q, near)
    }

    /// (Φ_r, Φ_π'): a row for each of [`Kinematics::rows`], columns (r, π') body after body.
    pub fn jacobian(&self, q: &[f64], near: &[Vec<f64>]) -> DMatrix<f64> {
        self.gradients(&self.equations(), q, near)
    }

    /// ν = −Φ_t.
    pub fn nu(&self, q: &[f64], near: &[Vec<f64>]) -> DVector<f64> {
        -self.drift(&self.equations(), q, near)
    }

    /// For each joint its scalar coordinates, rad or m: [`crate::JointKind::coordinates`].
    pub fn coordinates(&self, q: &[f64], near: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let poses: Vec<Pose<f64>> = self.poses(q).iter().map(value_of).collect();
        let of = |(joint, geometry): (usize, &JointGeometry)| {
            let posed = self.posed(joint, &poses);
            let kinds = geometry.kind.coordinates().iter().enumerate();
            kinds.map(|(k, &kind)| posed.coordinate(kind, near[joint][k])).collect()
        };
        self.joints.iter().enumerate().map(of).collect()
    }

    /// For each joint the rates of its scalar coordinates at velocities v, rad/s or m/s: their derivatives in time.
    pub fn rates(&self, q: &[f64], v: &[f64], near: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let of = |(joint, geometry): (usize, &JointGeometry)| {
            let equation =
                |coordinate| Equation::Coordinate { of: JointCoordinate { joint, coordinate }, value: 0.0 };
            let all: Vec<Equation> = (0..geometry.kind.coordinates().len()).map(equation).collect();
            let own = self.gradients(&all, q, near) * DVector::from_column_slice(v);
            (own + self.drift(&all, q, near)).as_slice().to_vec()
        };
        self.joints.iter().enumerate().map(of).collect()
    }

    /// Every owner's rows once, in their order.
    pub(crate) fn equations(&self) -> Vec<Equation> {
        let mut owners: Vec<RowOwner> = self.rows.iter().map(|row| row.owner).collect();
        owners.dedup();
        owners.into_iter().map(Equation::Rows).collect()
    }

    /// Those that say where bodies may be: all but rows of velocities.
    pub(crate) fn of_positions(&self) -> Vec<Equation> {
        let mut equations = self.equations();
        equations.retain(|equation| match equation {
            Equation::Rows(RowOwner::Coupler(k)) => !matches!(self.couplers[*k].by, Numbers::Rate(_)),
            _ => true,
        });
        equations
    }

    pub(crate) fn joints(&self) -> &[JointGeometry] {
        &self.joints
    }

    /// Poses of all bodies; folded ones with their derivative in time, the others still.
    pub(crate) fn poses(&self, q: &[f64]) -> Vec<Pose<Dual64>> {
        let pose = |place: &Place| match *place {
            Place::Folded(pose) => pose,
            Place::Slot { moving_body, .. } => {
                let [x, y, z, a, b, c, d] = std::array::from_fn(|k| q[7 * moving_body + k]);
                Pose::still([x, y, z], [a, b, c, d])
            }
        };
        self.places.iter().map(pose).collect()
    }

    fn coordinate_kind(&self, of: JointCoordinate) -> CoordinateKind {
        self.joints[of.joint].kind.coordinates()[of.coordinate]
    }
}

impl CouplerNumbers {
    fn of(model: &Model, coupler: &crate::Coupler) -> Self {
        let by = match &coupler.by {
            Coupling::Linear { first, ratio, offset } => {
                Numbers::Linear { first: *first, ratio: model.value(ratio), offset: model.value(offset) }
            }
            Coupling::Formula(formula) | Coupling::Zero(formula) => {
                Numbers::Formula(Sight::new(model, formula))
            }
            Coupling::Rate(formula) => Numbers::Rate(Sight::new(model, formula)),
        };
        let pair = |output: usize| match &model.outputs[output].kind {
            OutputKind::Relative(relative) => Some((output, Pair::new(model, relative))),
            _ => None,
        };
        let pairs = coupler.outputs().into_iter().filter_map(pair).collect();
        Self { second: coupler.second, by, pairs }
    }

    /// The second coordinate less what it is to be, or what is to be zero; of a row of velocities what changes at the
    /// rate of the formula, which is zero now.
    fn lag<D: Scalar>(&self, coordinate: impl Fn(JointCoordinate) -> D, poses: &[Pose<D>]) -> D {
        let places: Vec<_> = self.pairs.iter().map(|(output, pair)| (*output, pair.places(poses))).collect();
        let of = |output: usize| places.iter().find(|(known, _)| *known == output).map(|(_, places)| places);
        let second = self.second.map(&coordinate);
        match &self.by {
            Numbers::Linear { first, ratio, offset } => {
                second.unwrap_or_else(D::zero) - coordinate(*first) * *ratio - *offset
            }
            Numbers::Formula(formula) => {
                let value = formula.of(|seen| match seen {
                    Seen::Coordinate(on) => coordinate(on),
                    Seen::Output { output, number } if number < Relative::N_PLACES => {
                        of(output).map_or_else(D::zero, |places| places[number])
                    }
                    _ => D::zero(),
                });
                second.map_or(value, |second| second - value)
            }
            Numbers::Rate(formula) => D::growing(formula.of(|seen| match seen {
                Seen::Coordinate(on) => coordinate(on).re(),
                Seen::Rate(on) => coordinate(on).rate(),
                Seen::Output { output, number } => {
                    of(output).map_or(0.0, |places| Pair::number(places, number))
                }
                _ => 0.0,
            })),
        }
    }

    /// The bodies whose frames it sees.
    fn bodies(&self) -> impl Iterator<Item = usize> {
        self.pairs.iter().flat_map(|(_, pair)| pair.bodies())
    }

    /// All coordinates of its row.
    fn coordinates(&self) -> Vec<JointCoordinate> {
        let mut all: Vec<_> = self.second.into_iter().collect();
        match &self.by {
            Numbers::Linear { first, .. } => all.push(*first),
            Numbers::Formula(formula) | Numbers::Rate(formula) => all.extend(formula.coordinates()),
        }
        all
    }
}

/// The pose that the model file gives a body: constant, or prescribed in time.
fn folded(model: &Model, index: usize, t: f64) -> Pose<Dual64> {
    let body = &model.bodies[index];
    match &body.motion {
        Some(motion) => {
            let (r, p) = motion.pose(model, body, Dual64::from_re(t).derivative());
            Pose::new(r, p)
        }
        None => Pose::still(model.values(&body.position), body.unit_orientation(model).0),
    }
}

/// A pose without its derivative.
pub(crate) fn value_of(pose: &Pose<Dual64>) -> Pose<f64> {
    Pose::new(pose.r.map(|x| x.re), pose.p.map(|e| e.re))
}

/// Turns a body by a small rotation vector π' in its own frame, exactly.
pub(crate) fn turned(p: Quaternion, by: [f64; 3]) -> Quaternion {
    let angle = by.iter().map(|x| x * x).sum::<f64>().sqrt();
    // sin(angle/2)/angle is even in the angle; its series below this is exact to rounding.
    let scale = if angle < 1e-4 { 0.5 - angle * angle / 48.0 } else { (0.5 * angle).sin() / angle };
    let [x, y, z] = by.map(|b| scale * b);
    (p * Quaternion([(0.5 * angle).cos(), x, y, z])).normalised()
}
