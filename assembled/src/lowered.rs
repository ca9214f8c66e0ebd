//! A model lowered to floating-point numbers: joint frames normalised, fixed bodies folded to constant poses.

use crate::number::{Number, number};
use crate::textbook::rotation;
use gyro_model::{AssemblyError, JointEnd, JointKind, Model, RowOwner, RowUnit, Support};
use gyro_sim::{Coordinate, Owner, RowInfo};
use nalgebra::{Matrix3, Vector3, Vector4};

/// A model in numbers. Constant: it holds no state.
#[derive(Clone, Debug)]
pub struct Lowered<T: Number> {
    pub(crate) gravity: Vector3<T>,
    /// Bodies with coordinates, by slot.
    pub(crate) bodies: Vec<Body<T>>,
    pub(crate) constrained: Vec<Constrained<T>>,
    pub(crate) joints: Vec<Joint<T>>,
    pub(crate) rows: Vec<RowInfo>,
    pub(crate) size: T,
    /// Where the work of friction is in the state.
    pub(crate) work: Option<usize>,
    pub(crate) start: Vec<T>,
}

/// A body with coordinates.
#[derive(Clone, Debug)]
pub(crate) struct Body<T> {
    pub(crate) name: String,
    pub(crate) mass: T,
    /// J', body frame.
    pub(crate) inertia: Matrix3<T>,
}

/// A body that its own six rows hold in place, paper, eqs. (5) and (6).
#[derive(Clone, Debug)]
pub(crate) struct Constrained<T> {
    pub(crate) slot: usize,
    pub(crate) first_row: usize,
    pub(crate) r0: Vector3<T>,
    pub(crate) p0: Vector4<T>,
}

/// A joint between two bodies.
#[derive(Clone, Debug)]
pub(crate) struct Joint<T> {
    pub(crate) name: String,
    pub(crate) kind: JointKind,
    pub(crate) first: End<T>,
    pub(crate) second: End<T>,
    pub(crate) friction: T,
    pub(crate) first_row: usize,
    /// The dot-1 rows that follow the three point rows.
    pub(crate) dots: Vec<Dot<T>>,
}

/// A dot-1 constraint `aᵀ A_iᵀ A_j b = 0`, paper, eqs. (9) and (10).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Dot<T> {
    /// Unit vector on the first body, body frame.
    pub(crate) a: Vector3<T>,
    /// Unit vector on the second body, body frame.
    pub(crate) b: Vector3<T>,
}

/// A joint as one of its bodies sees it; vectors in that body's frame.
#[derive(Clone, Debug)]
pub(crate) struct End<T> {
    pub(crate) place: Place<T>,
    /// s', the joint's point.
    pub(crate) point: Vector3<T>,
    pub(crate) f: Vector3<T>,
    pub(crate) g: Vector3<T>,
    pub(crate) h: Vector3<T>,
}

/// Where a body is found.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Place<T> {
    /// In the state.
    Slot(usize),
    /// Folded: fixed in the global frame.
    Ground(Motion<T>),
}

/// Position and velocity of a body.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Motion<T> {
    pub(crate) r: Vector3<T>,
    pub(crate) p: Vector4<T>,
    /// A(p).
    pub(crate) a: Matrix3<T>,
    pub(crate) s: Vector3<T>,
    /// w', body frame.
    pub(crate) w: Vector3<T>,
}

impl<T> Place<T> {
    pub(crate) fn slot(&self) -> Option<usize> {
        match self {
            Self::Slot(slot) => Some(*slot),
            Self::Ground(_) => None,
        }
    }
}

impl<T: Number> Lowered<T> {
    pub(crate) fn new(model: &Model) -> Result<Self, AssemblyError> {
        let slots = model.coordinate_bodies();
        let rows = model.rows();
        let first_row = |owner| rows.iter().position(|row| row.owner == owner).unwrap_or(rows.len());
        let constrained = |(slot, &body): (usize, &usize)| {
            let first_row = first_row(RowOwner::Body(body));
            (model.bodies[body].support == Support::Constrained)
                .then(|| constrained(model, body, slot, first_row))
        };
        let joint = |joint| lower_joint(model, &slots, joint, first_row(RowOwner::Joint(joint)));
        Ok(Self {
            gravity: vector(model.values(&model.gravity)),
            bodies: slots.iter().map(|&body| lower_body(model, body)).collect(),
            constrained: slots.iter().enumerate().filter_map(constrained).collect(),
            joints: (0..model.joints.len()).map(joint).collect(),
            rows: rows.iter().map(|row| row_info(&slots, row)).collect(),
            size: number(model.size()),
            work: model.has_work().then_some(13 * slots.len()),
            start: start(model)?,
        })
    }

    pub(crate) fn n_bodies(&self) -> usize {
        self.bodies.len()
    }

    /// Number of joint rows, normalisations not counted.
    pub(crate) fn n_rows(&self) -> usize {
        self.rows.len()
    }

    /// Number of positions.
    pub(crate) fn n_q(&self) -> usize {
        7 * self.bodies.len()
    }

    /// Number of velocities.
    pub(crate) fn n_v(&self) -> usize {
        6 * self.bodies.len()
    }

    /// r of a slot.
    pub(crate) fn r(&self, y: &[T], slot: usize) -> Vector3<T> {
        Vector3::from_column_slice(&y[7 * slot..7 * slot + 3])
    }

    /// p of a slot.
    pub(crate) fn p(&self, y: &[T], slot: usize) -> Vector4<T> {
        Vector4::from_column_slice(&y[7 * slot + 3..7 * slot + 7])
    }

    /// s of a slot.
    pub(crate) fn s(&self, y: &[T], slot: usize) -> Vector3<T> {
        let at = self.n_q() + 6 * slot;
        Vector3::from_column_slice(&y[at..at + 3])
    }

    /// w' of a slot.
    pub(crate) fn w(&self, y: &[T], slot: usize) -> Vector3<T> {
        let at = self.n_q() + 6 * slot + 3;
        Vector3::from_column_slice(&y[at..at + 3])
    }

    /// Position and velocity of a body.
    #[inline]
    pub(crate) fn motion(&self, y: &[T], place: &Place<T>) -> Motion<T> {
        match place {
            Place::Slot(slot) => {
                let p = self.p(y, *slot);
                Motion { r: self.r(y, *slot), p, a: rotation(&p), s: self.s(y, *slot), w: self.w(y, *slot) }
            }
            Place::Ground(motion) => *motion,
        }
    }
}

impl<T> Joint<T> {
    /// What the joint's readings are.
    pub(crate) fn coordinate(&self) -> Coordinate {
        match self.kind {
            JointKind::Revolute => Coordinate::Angle,
            JointKind::Spherical => Coordinate::Orientation,
            JointKind::Fixed => Coordinate::None,
        }
    }
}

fn lower_body<T: Number>(model: &Model, body: usize) -> Body<T> {
    let body = &model.bodies[body];
    let [xx, yy, zz, xy, xz, yz] = model.values(&body.inertia).map(number::<T>);
    let inertia = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
    Body { name: body.name.clone(), mass: number(model.value(&body.mass)), inertia }
}

fn constrained<T: Number>(model: &Model, body: usize, slot: usize, first_row: usize) -> Constrained<T> {
    let Motion { r, p, .. } = resting(model, body);
    Constrained { slot, first_row, r0: r, p0: p }
}

fn lower_joint<T: Number>(model: &Model, slots: &[usize], joint: usize, first_row: usize) -> Joint<T> {
    let joint = &model.joints[joint];
    let (first, second) = (lower_end(model, slots, &joint.first), lower_end(model, slots, &joint.second));
    let dots = [(first.f, second.h), (first.g, second.h), (first.f, second.g)];
    let dots = dots[..joint.kind.n_rotation_rows()].iter().map(|&(a, b)| Dot { a, b }).collect();
    Joint {
        name: joint.name.clone(),
        kind: joint.kind,
        first,
        second,
        friction: number(model.value(&joint.friction)),
        first_row,
        dots,
    }
}

/// The joint frame is normalised in `f64`, whatever the scalar.
fn lower_end<T: Number>(model: &Model, slots: &[usize], end: &JointEnd) -> End<T> {
    let place = match slots.iter().position(|&body| body == end.body) {
        Some(slot) => Place::Slot(slot),
        None => Place::Ground(resting(model, end.body)),
    };
    let h = Vector3::from(model.values(&end.axis)).normalize();
    let zero = Vector3::from(model.values(&end.zero));
    let f = (zero - h * h.dot(&zero)).normalize();
    let [f, g, h] = [f, h.cross(&f), h].map(|v| v.map(number::<T>));
    End { place, point: vector(model.values(&end.point)), f, g, h }
}

/// A body that stays where the page puts it.
fn resting<T: Number>(model: &Model, body: usize) -> Motion<T> {
    let body = &model.bodies[body];
    let p = Vector4::from(model.values(&body.orientation)).normalize();
    Motion {
        r: vector(model.values(&body.position)),
        p: p.map(number),
        a: rotation(&p).map(number),
        s: Vector3::zeros(),
        w: Vector3::zeros(),
    }
}

fn row_info(slots: &[usize], row: &gyro_model::Row) -> RowInfo {
    let index =
        |index: usize| u16::try_from(index).expect("a model page has fewer than 65536 bodies and joints");
    let owner = match row.owner {
        RowOwner::Body(body) => Owner::Body(index(
            slots.iter().position(|&b| b == body).expect("bodies with rows have coordinates"),
        )),
        RowOwner::Joint(joint) => Owner::Joint(index(joint)),
    };
    RowInfo { owner, is_length: row.unit == RowUnit::Length }
}

fn start<T: Number>(model: &Model) -> Result<Vec<T>, AssemblyError> {
    let start = model.assemble()?;
    let work = model.has_work().then_some(0.0);
    Ok(start.q.into_iter().chain(start.v).chain(work).map(number).collect())
}

fn vector<T: Number>(values: [f64; 3]) -> Vector3<T> {
    Vector3::from(values.map(number))
}
