//! A model lowered to floating-point numbers: joint frames normalised, fixed bodies folded to constant poses.

use crate::model::amount::Amount;
use crate::model::forces::Element;
use crate::model::joint::Joint;
use crate::model::outputs::{Output, Quantity};
use crate::model::place::{Places, first_state};
use crate::model::rotor::Rotor;
use crate::model::rows::Row;
use crate::model::scene::Scene;
use crate::number::{Number, number};
use gyro_model::{AssemblyError, Coupler, JointCoordinate, Model, OutputKind, RowOwner, RowUnit, Seen};
use gyro_sim::{Owner, RowInfo};

/// A model in numbers. It holds no state but the values of the inputs.
#[derive(Clone, Debug)]
pub struct Lowered<T: Number> {
    pub(crate) scene: Scene<T>,
    pub(crate) rows: Vec<Row<T>>,
    pub(crate) row_infos: Vec<RowInfo>,
    /// How many rows depend on the others, now these, now those.
    pub(crate) n_dependent: usize,
    pub(crate) elements: Vec<Element<T>>,
    pub(crate) rotors: Vec<Rotor<T>>,
    pub(crate) outputs: Vec<Output<T>>,
    pub(crate) size: T,
    /// Whether time enters the constraints.
    pub(crate) is_driven: bool,
    /// Where the work is in the state.
    pub(crate) work: Option<usize>,
    /// The rates of the model file's own states, which follow in the state.
    pub(crate) states: Vec<Amount<T>>,
    /// The angles whose turn references follow in the state: joint and coordinate.
    pub(crate) turns: Vec<JointCoordinate>,
    /// Where these angles are among the readings.
    pub(crate) turn_readings: Vec<u16>,
    pub(crate) start: Vec<T>,
}

impl<T: Number> Lowered<T> {
    pub(crate) fn new(model: &Model) -> Result<Self, AssemblyError> {
        let (moving_bodies, places) = (model.coordinate_bodies(), Places::new(model));
        let work = model.has_work().then_some(13 * moving_bodies.len());
        let turns = model.turn_references();
        let first_turn = first_state(model) + model.states.len();
        let reference = |of| turns.iter().position(|&turn| turn == of).map(|index| first_turn + index);
        let pairs = pairs(model);
        let scene = Scene::new(model, &places, reference, &pairs);
        let rows = model.rows();
        Ok(Self {
            rows: (rows.iter())
                .map(|row| Row::new(model, &moving_bodies, (&scene.joints, &pairs), row))
                .collect(),
            n_dependent: model.redundant.len() - model.dropped().count(),
            row_infos: rows.iter().map(|row| row_info(&moving_bodies, row)).collect(),
            elements: Element::all(model, &places, &scene.joints),
            rotors: Rotor::all(model),
            outputs: model
                .outputs
                .iter()
                .map(|output| Output::new(model, (&places, &scene.joints, &pairs), output))
                .collect(),
            states: model
                .states
                .iter()
                .map(|state| Amount::new(model, (&places, &scene.joints), &state.rate))
                .collect(),
            size: number(model.size()),
            is_driven: model.is_driven(),
            work,
            start: start(model, &turns)?,
            turn_readings: turns.iter().map(|turn| reading(&scene.joints, turn)).collect(),
            scene,
            turns,
        })
    }

    /// Sets an input; returns whether there is one of this index.
    pub(crate) fn set_input(&mut self, index: usize, value: T) -> bool {
        for row in &mut self.rows {
            if let Row::Measured { course: Some(course), .. } = row {
                course.set_input(index, value.to_f64());
            }
        }
        for output in &mut self.outputs {
            if let Quantity::Rate(formula) = &mut output.quantity {
                formula.set_input(index, value);
            }
        }
        self.scene.driven.iter_mut().for_each(|body| body.set_input(index, value.to_f64()));
        self.scene.inputs.get_mut(index).map(|(_, present)| *present = value).is_some()
    }

    /// Number of joint rows, normalisations not counted.
    pub(crate) fn n_rows(&self) -> usize {
        self.rows.len()
    }
}

/// The outputs of two frames that rows, or rates of formulas, see, by their indices.
fn pairs(model: &Model) -> Vec<usize> {
    let mut pairs: Vec<_> = model.couplers.iter().flat_map(Coupler::outputs).collect();
    for output in &model.outputs {
        let OutputKind::Rate(formula) = &output.kind else { continue };
        let of_output = |seen| if let Seen::Output { output, .. } = seen { Some(output) } else { None };
        pairs.extend(formula.sees().filter_map(of_output));
    }
    pairs.sort_unstable();
    pairs.dedup();
    pairs
}

fn row_info(moving_bodies: &[usize], row: &gyro_model::Row) -> RowInfo {
    let index = |index: usize| u16::try_from(index).expect("a model file has fewer than 65536 elements");
    let owner = match row.owner {
        RowOwner::Body(body) => Owner::Body(index(
            moving_bodies.iter().position(|&b| b == body).expect("bodies with rows have coordinates"),
        )),
        RowOwner::Joint(joint) => Owner::Joint(index(joint)),
        RowOwner::Coupler(coupler) => Owner::Coupler(index(coupler)),
        RowOwner::Driver(driver) => Owner::Driver(index(driver)),
    };
    RowInfo { owner, is_length: row.unit == RowUnit::Length }
}

/// The place of a coordinate's first reading.
fn reading<T>(joints: &[Joint<T>], of: &JointCoordinate) -> u16 {
    let before = joints[..of.joint].iter().flat_map(|joint| &joint.readings);
    let own = &joints[of.joint].readings[..of.coordinate];
    before.chain(own).map(|reading| reading.n_readings() as u16).sum()
}

/// Positions, velocities, the work where there is any, the model file's own states, and the turn references.
fn start<T: Number>(model: &Model, turns: &[JointCoordinate]) -> Result<Vec<T>, AssemblyError> {
    let start = model.assemble()?;
    let work = model.has_work().then_some(0.0);
    let turns = turns.iter().map(|turn| start.joints[turn.joint].position[turn.coordinate]);
    let moving = start.q.into_iter().chain(start.v).chain(work);
    Ok(moving.chain(start.states).chain(turns).map(number).collect())
}
