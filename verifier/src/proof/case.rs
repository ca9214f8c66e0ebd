//! A module and the textbook on one tape.

use super::point::{self, DRAWS};
use crate::atoms::Elementary;
use crate::field::{Field, Precision, Real};
use crate::joints::JointLayout;
use crate::module::{Module, n_state};
use crate::point::Point;
use crate::program::Source;
use crate::rates::rates;
use crate::seed::Seed;
use crate::tape::{Tape, Term, Written};
use crate::textbook::{Evaluation, Textbook};
use gyro_model::{JointCoordinate, Model};

/// What claims are made of: both sides at a point that is not chosen yet.
pub(super) struct Case<'a> {
    /// The description.
    pub model: &'a Model,
    /// The emitted module.
    pub module: &'a Module,
    /// Where, with |p| = 1.
    pub point: Point<Term<'a>>,
    /// A factor for each body, by which Euler parameters are made longer where that must not matter.
    pub factors: Vec<Term<'a>>,
    /// By how much each row is asked to change.
    pub changes: Vec<Term<'a>>,
    /// (δr, δπ') of any motion.
    pub motion: Vec<Term<'a>>,
    /// A vector for each chart.
    pub charts: Vec<[Term<'a>; 4]>,
    /// A joint state, with Euler parameters of length one.
    pub joints: Vec<Term<'a>>,
    /// Another one.
    pub before: Vec<Term<'a>>,
    textbook: &'a Textbook<'a>,
    tape: &'a Tape,
}

/// What a function is given.
#[derive(Clone, Copy)]
pub(super) struct Arguments<'s, 'a> {
    /// Where.
    pub point: &'s Point<Term<'a>>,
    /// What it reads of other functions' accelerations or rates.
    pub accelerations: &'s [Term<'a>],
    /// By how much the rows are asked to change.
    pub changes: &'s [Term<'a>],
    /// A joint state.
    pub joints: &'s [Term<'a>],
}

impl<'a> Case<'a> {
    /// Writes on a tape.
    pub fn new(model: &'a Model, textbook: &'a Textbook<'a>, module: &'a Module, tape: &'a Tape) -> Self {
        let read = |source| tape.read(source);
        let charts = 0..module.n_charts.unwrap_or(0);
        let joints = 0..module.joints.as_ref().map_or(0, JointLayout::n_state);
        Self {
            model,
            module,
            point: point(model, tape),
            factors: (0..model.coordinate_bodies().len())
                .map(|moving_body| read(Source::Factor(moving_body)))
                .collect(),
            changes: (0..model.rows().len()).map(|row| read(Source::Change(row))).collect(),
            motion: (0..6 * model.coordinate_bodies().len()).map(|k| read(Source::Motion(k))).collect(),
            charts: charts.map(|chart| [0, 1, 2, 3].map(|k| read(Source::Chart(chart, k)))).collect(),
            joints: joints.clone().map(|k| read(Source::Joint(k))).collect(),
            before: joints.map(|k| read(Source::Before(k))).collect(),
            textbook,
            tape,
        }
    }

    /// The place of an angle among those that have turn references.
    pub fn turn(&self, on: JointCoordinate) -> Option<usize> {
        self.model.turn_references().iter().position(|turn| *turn == on)
    }

    /// How fast an input changes that a motion follows.
    pub fn rate_of_input(&self, index: usize) -> Option<Term<'a>> {
        let followed = self.model.followed_inputs().into_iter();
        let mut next =
            followed.flat_map(|(_, [place, rate, acceleration])| [(place, rate), (rate, acceleration)]);
        next.find(|(of, _)| *of == index).map(|(_, by)| self.point.inputs[by])
    }

    /// Number of bodies that have coordinates.
    pub fn n_bodies(&self) -> usize {
        self.model.coordinate_bodies().len()
    }

    /// The textbook's formulas at a point.
    pub fn textbook<'s>(&'s self, point: &'s Point<Term<'a>>) -> Option<Evaluation<'s, Term<'a>>> {
        self.textbook.at(point, &Written)
    }

    /// A point, the case's own joint state and changes of rows.
    pub fn given<'s>(&'s self, point: &'s Point<Term<'a>>) -> Arguments<'s, 'a> {
        Arguments { point, accelerations: &[], changes: &self.changes, joints: &self.joints }
    }

    /// What a function of the module gives at a point.
    pub fn run(&self, function: &str, point: &Point<Term<'a>>) -> Vec<Term<'a>> {
        self.results(function, self.given(point))
    }

    /// The same for one that reads accelerations.
    pub fn run_with(
        &self,
        function: &str,
        point: &Point<Term<'a>>,
        accelerations: &[Term<'a>],
    ) -> Vec<Term<'a>> {
        self.results(function, Arguments { accelerations, ..self.given(point) })
    }

    /// What a function gives.
    pub fn results(&self, function: &str, arguments: Arguments<'_, 'a>) -> Vec<Term<'a>> {
        let nodes = self.nodes(function, arguments);
        self.module.programs[function].results.iter().map(|&id| nodes[id]).collect()
    }

    /// All nodes of a function.
    fn nodes(&self, function: &str, arguments: Arguments<'_, 'a>) -> Vec<Term<'a>> {
        let Arguments { point, accelerations, changes, joints } = arguments;
        let read = |source| match source {
            Source::Acceleration(k) => accelerations[k],
            Source::Change(row) => changes[row],
            Source::Joint(k) => joints[k],
            Source::Chart(chart, k) => self.charts[chart][k],
            Source::Factor(moving_body) => self.factors[moving_body],
            Source::Motion(k) => self.motion[k],
            Source::Before(k) => self.before[k],
            source => *point.given(source).expect("the rest is the point's"),
        };
        let Module { programs, constants, tables, .. } = self.module;
        self.tape.copy(&programs[function], &constants.values, tables, &read)
    }

    /// What a function gives, and how fast that changes if what it reads changes at these rates.
    pub fn run_along(
        &self,
        function: &str,
        arguments: Arguments<'_, 'a>,
        rate: &dyn Fn(Source) -> Option<Term<'a>>,
    ) -> Option<[Vec<Term<'a>>; 2]> {
        let nodes = self.nodes(function, arguments);
        let program = &self.module.programs[function];
        let rates = rates(program, &nodes, &self.module.tables, &Written, rate)?;
        let zero = Term::zero(self.tape);
        let results = || program.results.iter();
        Some([
            results().map(|&id| nodes[id]).collect(),
            results().map(|&id| rates[id].unwrap_or(zero)).collect(),
        ])
    }

    /// Accelerations (with the multipliers that they come with) and all multipliers.
    pub fn motion(&self) -> (Vec<Term<'a>>, Vec<Term<'a>>) {
        let accelerations = self.run("accelerations", &self.point);
        let multipliers = self.run_with("multipliers", &self.point, &accelerations);
        (accelerations, multipliers)
    }

    /// The same, or any numbers if the module does not solve for them: nothing that it has depends on them then.
    pub fn motion_at_hand(&self) -> (Vec<Term<'a>>, Vec<Term<'a>>) {
        if self.module.implements("Dynamics") {
            self.motion()
        } else {
            (self.motion.clone(), self.changes.clone())
        }
    }

    /// A point whose state is changed by a function of the partition.
    pub fn moved(&self, function: &str, point: &Point<Term<'a>>) -> Point<Term<'a>> {
        let values = self.run(function, point);
        let mut moved = point.clone();
        for (&place, value) in self.module.programs[function].places.iter().zip(values) {
            moved.state[place] = value;
        }
        moved
    }
}

impl<'a> Case<'a> {
    /// The maximal state of a joint state.
    pub fn maximal(&self, joints: &[Term<'a>]) -> Point<Term<'a>> {
        let state = self.results("to_maximal", Arguments { joints, ..self.given(&self.point) });
        Point { state, ..self.point.clone() }
    }

    /// A joint state changed by a function that closes loops.
    pub fn closed(&self, function: &str, joints: &[Term<'a>]) -> Vec<Term<'a>> {
        let values = self.results(function, Arguments { joints, ..self.given(&self.point) });
        let mut closed = joints.to_vec();
        for (&place, value) in self.module.programs[function].places.iter().zip(values) {
            closed[place] = value;
        }
        closed
    }

    /// What some formulas are at a point at which all of them exist; `None` if there is none.
    pub fn numbers<'c>(&self, precision: &'c Precision, terms: &[Term<'a>]) -> Option<Vec<Real<'c>>> {
        (0..DRAWS).find_map(|number| {
            let mut random = Seed::FIXED.numbers(number);
            let draw = point::real(self.model, self.module, precision, &mut random)?;
            let numbers = self.tape.evaluate(terms, precision, &Elementary, &|source| draw.read(source));
            let exists = |number: &Option<Real<'c>>| number.as_ref().is_some_and(|x| !x.to_f64().is_nan());
            numbers.iter().all(exists).then(|| numbers.into_iter().flatten().collect())
        })
    }
}

/// The point of which everything is read.
pub(crate) fn point<'t>(model: &Model, tape: &'t Tape) -> Point<Term<'t>> {
    let read = |source| tape.read(source);
    Point {
        context: tape,
        t: read(Source::Time),
        state: (0..n_state(model)).map(|k| read(Source::State(k))).collect(),
        parameters: (0..model.parameters.len()).map(|k| read(Source::Parameter(k))).collect(),
        inputs: (0..model.inputs.len()).map(|k| read(Source::Input(k))).collect(),
    }
}
