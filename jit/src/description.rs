//! Names, rows and sizes of a model, built once.

use gyro_codegen::JointForm;
use gyro_model::{JointKind, Model, Output, OutputKind, RowOwner, RowUnit};
use gyro_sim::{Coordinate, Description, JointInfo, JointLayout, JointPlace, OutputInfo, Owner, RowInfo};
use self_cell::self_cell;

self_cell!(
    struct Described {
        owner: Lists,
        #[covariant]
        dependent: Description,
    }

    impl { Debug }
);

self_cell!(
    struct Lists {
        owner: Owned,
        #[covariant]
        dependent: Borrowed,
    }

    impl { Debug }
);

/// A description with all that it refers to.
#[derive(Debug)]
pub(crate) struct OwnedDescription(Described);

self_cell!(
    struct Placed {
        owner: Places,
        #[covariant]
        dependent: JointLayout,
    }

    impl { Debug }
);

/// A layout of joint states with all that it refers to.
#[derive(Debug)]
pub(crate) struct OwnedLayout(Placed);

#[derive(Debug)]
struct Places {
    places: Vec<JointPlace>,
    closure_rows: Vec<u16>,
}

impl OwnedLayout {
    pub(crate) fn new(joint: &JointForm) -> Self {
        let place = |place: &gyro_codegen::JointPlace| match *place {
            gyro_codegen::JointPlace::Scalar { joint, coordinate } => {
                JointPlace::Scalar { joint: narrow(joint), coordinate: narrow(coordinate) }
            }
            gyro_codegen::JointPlace::Orientation { joint } => {
                JointPlace::Orientation { joint: narrow(joint) }
            }
            gyro_codegen::JointPlace::Turn { joint, coordinate } => {
                JointPlace::Turn { joint: narrow(joint), coordinate: narrow(coordinate) }
            }
            gyro_codegen::JointPlace::State { state } => JointPlace::State { state: narrow(state) },
            gyro_codegen::JointPlace::Body { body } => JointPlace::Body { body: narrow(body) },
        };
        let places = Places {
            places: joint.places.iter().map(place).collect(),
            closure_rows: joint.closure_rows.iter().copied().map(narrow).collect(),
        };
        Self(Placed::new(places, |p| JointLayout { places: &p.places, closure_rows: &p.closure_rows }))
    }

    pub(crate) fn get(&self) -> &JointLayout<'_> {
        self.0.borrow_dependent()
    }
}

/// The model, and of it what a [`Description`] has in a form of its own.
#[derive(Debug)]
struct Owned {
    model: Model,
    /// Of each joint.
    coordinates: Vec<Vec<Coordinate>>,
    rows: Vec<RowInfo>,
    turn_references: Vec<u16>,
}

/// What the model says in the form of a [`Description`].
#[derive(Debug)]
struct Borrowed<'a> {
    bodies: Vec<&'a str>,
    joints: Vec<JointInfo<'a>>,
    couplers: Vec<&'a str>,
    drivers: Vec<&'a str>,
    inputs: Vec<&'a str>,
    outputs: Vec<OutputInfo<'a>>,
    frames: Vec<&'a str>,
}

impl OwnedDescription {
    pub(crate) fn new(model: &Model) -> Self {
        let lists = Lists::new(owned(model), |owned| Borrowed::of(owned));
        Self(Described::new(lists, |lists| lists.describe()))
    }

    pub(crate) fn get(&self) -> &Description<'_> {
        self.0.borrow_dependent()
    }

    /// The outputs that are frames.
    pub(crate) fn frame_names(&self) -> &[&str] {
        &self.0.borrow_owner().borrow_dependent().frames
    }
}

/// A place or an index, as descriptions have them.
pub(crate) fn narrow(index: usize) -> u16 {
    u16::try_from(index).expect("descriptions hold up to 65536 of a kind")
}

fn owned(model: &Model) -> Owned {
    let moving = model.coordinate_bodies();
    let owner = |owner: RowOwner| match owner {
        RowOwner::Body(body) => {
            let moving_body = moving.iter().position(|&other| other == body);
            Owner::Body(narrow(moving_body.expect("a held body has coordinates")))
        }
        RowOwner::Joint(joint) => Owner::Joint(narrow(joint)),
        RowOwner::Coupler(coupler) => Owner::Coupler(narrow(coupler)),
        RowOwner::Driver(driver) => Owner::Driver(narrow(driver)),
    };
    let rows = model.rows().into_iter();
    Owned {
        model: model.clone(),
        coordinates: model.joints.iter().map(|joint| readings(joint.kind)).collect(),
        rows: rows
            .map(|row| RowInfo { owner: owner(row.owner), is_length: row.unit == RowUnit::Length })
            .collect(),
        turn_references: turn_references(model),
    }
}

/// What the readings of a joint are.
fn readings(kind: JointKind) -> Vec<Coordinate> {
    if kind == JointKind::Spherical {
        return vec![Coordinate::Orientation];
    }
    let coordinates = kind.coordinates().iter();
    coordinates.map(|c| if c.is_angle() { Coordinate::Angle } else { Coordinate::Length }).collect()
}

/// Where the angles of the turn references are among the readings.
fn turn_references(model: &Model) -> Vec<u16> {
    let place = |joint: usize, coordinate: usize| -> usize {
        let before = model.joints[..joint].iter().flat_map(|joint| readings(joint.kind));
        let own = readings(model.joints[joint].kind).into_iter().take(coordinate);
        before.chain(own).map(Coordinate::n_readings).sum()
    };
    model.turn_references().iter().map(|turn| narrow(place(turn.joint, turn.coordinate))).collect()
}

impl<'a> Borrowed<'a> {
    fn of(Owned { model, coordinates, .. }: &'a Owned) -> Self {
        let joints = model.joints.iter().zip(coordinates);
        let outputs = model.outputs.iter().flat_map(|Output { name, kind }| {
            kind.columns().iter().map(move |(suffix, unit)| OutputInfo { name, suffix, unit })
        });
        let frames = model.outputs.iter().filter(|output| matches!(output.kind, OutputKind::Velocity(_)));
        Self {
            bodies: model.coordinate_bodies().iter().map(|body| &*model.bodies[*body].name).collect(),
            joints: joints.map(|(joint, coordinates)| JointInfo { name: &joint.name, coordinates }).collect(),
            couplers: model.couplers.iter().map(|coupler| &*coupler.name).collect(),
            drivers: model.drivers.iter().map(|driver| &*driver.name).collect(),
            inputs: model.inputs.iter().map(|input| &*input.name).collect(),
            outputs: outputs.collect(),
            frames: frames.map(|output| &*output.name).collect(),
        }
    }
}

impl Lists {
    fn describe(&self) -> Description<'_> {
        let (owned, lists) = (self.borrow_owner(), self.borrow_dependent());
        Description {
            size: owned.model.size(),
            bodies: &lists.bodies,
            joints: &lists.joints,
            couplers: &lists.couplers,
            drivers: &lists.drivers,
            rows: &owned.rows,
            has_work: owned.model.has_work(),
            turn_references: &owned.turn_references,
            inputs: &lists.inputs,
            outputs: &lists.outputs,
        }
    }
}
