//! A model lowered to floating-point numbers: joint frames normalised, fixed bodies folded to constant poses.

use crate::course::Carriage;
use crate::forces::Element;
use crate::joint::Joint;
use crate::motion::Motion;
use crate::number::{Number, number};
use crate::outputs::Output;
use crate::rows::Row;
use crate::textbook::rotation;
use gyro_model::{AssemblyError, JointCoordinate, Model, RowOwner, RowUnit, Support};
use gyro_sim::{Owner, RowInfo};
use nalgebra::{Matrix3, Vector3, Vector4};

/// A model in numbers. It holds no state but the values of the inputs.
#[derive(Clone, Debug)]
pub struct Lowered<T: Number> {
    pub(crate) gravity: Vector3<T>,
    /// Bodies with coordinates, by slot.
    pub(crate) bodies: Vec<Body<T>>,
    pub(crate) constrained: Vec<Constrained<T>>,
    /// Bodies whose whole motion is prescribed.
    pub(crate) driven: Vec<Carriage>,
    pub(crate) joints: Vec<Joint<T>>,
    pub(crate) rows: Vec<Row<T>>,
    pub(crate) row_infos: Vec<RowInfo>,
    pub(crate) coupler_names: Vec<String>,
    pub(crate) driver_names: Vec<String>,
    pub(crate) elements: Vec<Element<T>>,
    /// Names and values.
    pub(crate) inputs: Vec<(String, T)>,
    pub(crate) outputs: Vec<Output<T>>,
    pub(crate) size: T,
    /// Whether time enters the constraints.
    pub(crate) is_driven: bool,
    /// Where the work is in the state.
    pub(crate) work: Option<usize>,
    /// The angles whose turn references follow in the state: joint and coordinate.
    pub(crate) turns: Vec<JointCoordinate>,
    /// Where these angles are among the readings.
    pub(crate) turn_readings: Vec<u16>,
    pub(crate) start: Vec<T>,
}

/// A time and a state.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moment<'a, T> {
    pub(crate) t: T,
    pub(crate) y: &'a [T],
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
    pub(crate) r0: Vector3<T>,
    pub(crate) p0: Vector4<T>,
}

/// Where a body is found.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Place<T> {
    /// In the state.
    Slot(usize),
    /// Folded: fixed in the global frame.
    Ground(Motion<T>),
    /// Folded: one of [`Lowered::driven`].
    Driven(usize),
}

/// Where each body of the model is found.
#[derive(Debug)]
pub(crate) struct Places<T>(Vec<Place<T>>);

impl<T> Place<T> {
    pub(crate) fn slot(&self) -> Option<usize> {
        match self {
            Self::Slot(slot) => Some(*slot),
            Self::Ground(_) | Self::Driven(_) => None,
        }
    }
}

impl<T: Number> Places<T> {
    fn new(model: &Model) -> Self {
        let (mut slots, mut driven) = (0.., 0..);
        let next = |range: &mut std::ops::RangeFrom<usize>| range.next().expect("it has no end");
        let place = |body: usize| match model.bodies[body].support {
            Support::Fixed => Place::Ground(resting(model, body)),
            Support::Driven => Place::Driven(next(&mut driven)),
            Support::Moving | Support::Free | Support::Constrained => Place::Slot(next(&mut slots)),
        };
        Self((0..model.bodies.len()).map(place).collect())
    }

    /// Where a body of the model is found.
    pub(crate) fn of(&self, body: usize) -> Place<T> {
        self.0[body]
    }
}

impl<T: Number> Lowered<T> {
    pub(crate) fn new(model: &Model) -> Result<Self, AssemblyError> {
        let (slots, places) = (model.coordinate_bodies(), Places::new(model));
        let work = model.has_work().then_some(13 * slots.len());
        let turns = model.turn_references();
        let first_turn = 13 * slots.len() + usize::from(work.is_some());
        let reference = |of| turns.iter().position(|&turn| turn == of).map(|index| first_turn + index);
        let joints: Vec<_> =
            (0..model.joints.len()).map(|joint| Joint::new(model, &places, joint, reference)).collect();
        let constrained = |(slot, &body): (usize, &usize)| {
            let held = model.bodies[body].support == Support::Constrained;
            held.then(|| constrained(model, body, slot))
        };
        let is_driven = |&body: &usize| model.bodies[body].support == Support::Driven;
        let driven = (0..model.bodies.len()).filter(is_driven);
        let rows = model.rows();
        Ok(Self {
            gravity: vector(model.values(&model.gravity)),
            bodies: slots.iter().map(|&body| lower_body(model, body)).collect(),
            constrained: slots.iter().enumerate().filter_map(constrained).collect(),
            driven: driven.map(|body| Carriage::new(model, body)).collect(),
            rows: rows.iter().map(|row| Row::new(model, &slots, &joints, row)).collect(),
            row_infos: rows.iter().map(|row| row_info(&slots, row)).collect(),
            coupler_names: model.couplers.iter().map(|coupler| coupler.name.clone()).collect(),
            driver_names: model.drivers.iter().map(|driver| driver.name.clone()).collect(),
            elements: Element::all(model, &places, &joints),
            inputs: model
                .inputs
                .iter()
                .map(|p| (p.name.clone(), number(gyro_model::to_f64(&p.value))))
                .collect(),
            outputs: model.outputs.iter().map(|output| Output::new(model, &places, output)).collect(),
            size: number(model.size()),
            is_driven: model.is_driven(),
            work,
            start: start(model, &turns)?,
            turn_readings: turns.iter().map(|turn| reading(&joints, turn)).collect(),
            joints,
            turns,
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
    pub(crate) fn motion(&self, at: Moment<'_, T>, place: &Place<T>) -> Motion<T> {
        match place {
            Place::Slot(slot) => {
                let y = at.y;
                Motion::new(self.r(y, *slot), self.p(y, *slot), self.s(y, *slot), self.w(y, *slot))
            }
            Place::Ground(motion) => *motion,
            Place::Driven(index) => self.driven_motion(at.t, *index),
        }
    }

    /// Position, velocity and acceleration of a body that moves by prescription.
    pub(crate) fn driven_motion(&self, t: T, index: usize) -> Motion<T> {
        self.driven[index].motion(gyro_sim::Real::to_f64(t)).rounded()
    }

    /// Position and velocity of a joint's bodies.
    #[inline]
    pub(crate) fn motions(&self, at: Moment<'_, T>, joint: &Joint<T>) -> [Motion<T>; 2] {
        [self.motion(at, &joint.first.place), self.motion(at, &joint.second.place)]
    }
}

fn lower_body<T: Number>(model: &Model, body: usize) -> Body<T> {
    let body = &model.bodies[body];
    let [xx, yy, zz, xy, xz, yz] = model.values(&body.inertia).map(number::<T>);
    let inertia = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
    Body { name: body.name.clone(), mass: number(model.value(&body.mass)), inertia }
}

fn constrained<T: Number>(model: &Model, body: usize, slot: usize) -> Constrained<T> {
    let Motion { r, p, .. } = resting(model, body);
    Constrained { slot, r0: r, p0: p }
}

/// A body that stays where the page puts it.
pub(crate) fn resting<T: Number>(model: &Model, body: usize) -> Motion<T> {
    let body = &model.bodies[body];
    let (p, zero) = (Vector4::from(model.values(&body.orientation)).normalize(), Vector3::zeros());
    Motion {
        r: vector(model.values(&body.position)),
        p: p.map(number),
        a: rotation(&p).map(number),
        s: zero,
        w: zero,
        s_dot: zero,
        w_dot: zero,
    }
}

fn row_info(slots: &[usize], row: &gyro_model::Row) -> RowInfo {
    let index = |index: usize| u16::try_from(index).expect("a model page has fewer than 65536 elements");
    let owner = match row.owner {
        RowOwner::Body(body) => Owner::Body(index(
            slots.iter().position(|&b| b == body).expect("bodies with rows have coordinates"),
        )),
        RowOwner::Joint(joint) => Owner::Joint(index(joint)),
        RowOwner::Coupler(coupler) => Owner::Coupler(index(coupler)),
        RowOwner::Driver(driver) => Owner::Driver(index(driver)),
    };
    RowInfo { owner, is_length: row.unit == RowUnit::Length }
}

/// Positions, velocities, the work where there is any, and the turn references.
/// The place of a coordinate's first reading.
fn reading<T>(joints: &[Joint<T>], of: &JointCoordinate) -> u16 {
    let before = joints[..of.joint].iter().flat_map(|joint| &joint.readings);
    let own = &joints[of.joint].readings[..of.coordinate];
    before.chain(own).map(|reading| reading.n_readings() as u16).sum()
}

fn start<T: Number>(model: &Model, turns: &[JointCoordinate]) -> Result<Vec<T>, AssemblyError> {
    let start = model.assemble()?;
    let work = model.has_work().then_some(0.0);
    let turns = turns.iter().map(|turn| start.joints[turn.joint].position[turn.coordinate]);
    Ok(start.q.into_iter().chain(start.v).chain(work).chain(turns).map(number).collect())
}

pub(crate) fn vector<T: Number>(values: [f64; 3]) -> Vector3<T> {
    Vector3::from(values.map(number))
}
