//! Names, rows and sizes of a model, built once.

use crate::model::lowered::Lowered;
use crate::number::Number;
use gyro_model::Model;
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
        owner: Names,
        #[covariant]
        dependent: Borrowed,
    }

    impl { Debug }
);

/// What the model says.
#[derive(Debug)]
struct Names {
    size: f64,
    bodies: Vec<String>,
    joints: Vec<(String, Vec<Coordinate>)>,
    couplers: Vec<String>,
    drivers: Vec<String>,
    rows: Vec<RowInfo>,
    has_work: bool,
    turn_references: Vec<u16>,
    inputs: Vec<String>,
    outputs: Vec<(String, &'static str, &'static str)>,
}

/// The same in the form of a [`Description`].
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
        let columns = |output: &gyro_model::Output| {
            let columns = output.kind.columns().iter();
            columns.map(|&(suffix, unit)| (output.name.clone(), suffix, unit)).collect::<Vec<_>>()
        };
        let names = Names {
            size: model.size(),
            bodies: lowered.scene.bodies.iter().map(|body| body.name.clone()).collect(),
            joints: lowered
                .scene
                .joints
                .iter()
                .map(|joint| (joint.name.clone(), joint.readings.to_vec()))
                .collect(),
            couplers: model.couplers.iter().map(|coupler| coupler.name.clone()).collect(),
            drivers: model.drivers.iter().map(|driver| driver.name.clone()).collect(),
            rows: lowered.row_infos.clone(),
            has_work: lowered.work.is_some(),
            turn_references: lowered.turn_readings.clone(),
            inputs: lowered.scene.inputs.iter().map(|(name, _)| name.clone()).collect(),
            outputs: model.outputs.iter().flat_map(columns).collect(),
        };
        Self(Arc::new(Described::new(Lists::new(names, |names| Borrowed::of(names)), |lists| {
            lists.describe()
        })))
    }

    pub(crate) fn get(&self) -> &Description<'_> {
        self.0.borrow_dependent()
    }
}

impl<'a> Borrowed<'a> {
    fn of(names: &'a Names) -> Self {
        let list = |names: &'a [String]| names.iter().map(String::as_str).collect();
        let joint = |(name, coordinates): &'a (String, Vec<Coordinate>)| JointInfo { name, coordinates };
        Self {
            bodies: list(&names.bodies),
            joints: names.joints.iter().map(joint).collect(),
            couplers: list(&names.couplers),
            drivers: list(&names.drivers),
            inputs: list(&names.inputs),
            outputs: names
                .outputs
                .iter()
                .map(|(name, suffix, unit)| OutputInfo { name, suffix, unit })
                .collect(),
        }
    }
}

impl Lists {
    fn describe(&self) -> Description<'_> {
        let (names, lists) = (self.borrow_owner(), self.borrow_dependent());
        Description {
            size: names.size,
            bodies: &lists.bodies,
            joints: &lists.joints,
            couplers: &lists.couplers,
            drivers: &lists.drivers,
            rows: &names.rows,
            has_work: names.has_work,
            turn_references: &names.turn_references,
            inputs: &lists.inputs,
            outputs: &lists.outputs,
        }
    }
}
