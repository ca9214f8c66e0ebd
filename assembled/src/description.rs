//! Names, rows and sizes of a model, built once.

use crate::model::lowered::Lowered;
use crate::number::Number;
use gyro_model::{Model, Output};
use gyro_sim::{Coordinate, Description, JointInfo, OutputInfo, RowInfo};
use self_cell::self_cell;
use std::sync::Arc;

/// A description with all that it refers to.
#[derive(Clone, Debug)]
pub(crate) struct OwnedDescription(Arc<Described>);

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
}

impl OwnedDescription {
    pub(crate) fn new<T: Number>(model: &Model, lowered: &Lowered<T>) -> Self {
        let owned = Owned {
            model: model.clone(),
            coordinates: lowered.scene.joints.iter().map(|joint| joint.readings.to_vec()).collect(),
            rows: lowered.row_infos.clone(),
            turn_references: lowered.turn_readings.clone(),
        };
        let lists = Lists::new(owned, |owned| Borrowed::of(owned));
        Self(Arc::new(Described::new(lists, |lists| lists.describe())))
    }

    pub(crate) fn get(&self) -> &Description<'_> {
        self.0.borrow_dependent()
    }
}

impl<'a> Borrowed<'a> {
    fn of(Owned { model, coordinates, .. }: &'a Owned) -> Self {
        let joints = model.joints.iter().zip(coordinates);
        let outputs = model.outputs.iter().flat_map(|Output { name, kind }| {
            kind.columns().iter().map(move |(suffix, unit)| OutputInfo { name, suffix, unit })
        });
        Self {
            bodies: model.coordinate_bodies().iter().map(|body| &*model.bodies[*body].name).collect(),
            joints: joints.map(|(joint, coordinates)| JointInfo { name: &joint.name, coordinates }).collect(),
            couplers: model.couplers.iter().map(|coupler| &*coupler.name).collect(),
            drivers: model.drivers.iter().map(|driver| &*driver.name).collect(),
            inputs: model.inputs.iter().map(|input| &*input.name).collect(),
            outputs: outputs.collect(),
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
