//! A module and the textbook at one point.

use crate::atoms::Atoms;
use crate::field::Field;
use crate::interpreter::{self, DivisionByZero, Given};
use crate::module::Module;
use crate::point::Point;
use crate::textbook::{Evaluation, Textbook};
use gyro_model::Model;
use std::fmt;

/// What both sides are evaluated with.
pub struct Case<'a, F: Field> {
    /// The description.
    pub model: &'a Model,
    /// The textbook.
    pub textbook: &'a Textbook<'a>,
    /// The emitted module.
    pub module: &'a Module,
    /// Its constants as numbers.
    pub constants: Vec<F>,
    /// The functions that are not rational.
    pub atoms: &'a dyn Atoms<F>,
    /// Where, with |p| = 1.
    pub point: Point<F>,
    /// A factor for each body, by which Euler parameters are made longer where that must not matter.
    pub factors: Vec<F>,
    /// A vector for each chart.
    pub charts: Vec<[F; 4]>,
}

/// Why a point decides nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Undecided {
    /// The module divides by zero there, in this line.
    Module(usize),
    /// The textbook does.
    Textbook,
}

impl From<DivisionByZero> for Undecided {
    fn from(DivisionByZero { line }: DivisionByZero) -> Self {
        Self::Module(line)
    }
}

impl<F: Field> fmt::Debug for Case<'_, F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut text = f.debug_struct("Case");
        text.field("model", &self.model.name).field("point", &self.point).finish_non_exhaustive()
    }
}

impl<F: Field> Case<'_, F> {
    /// The same point for another module.
    pub fn of<'b>(&'b self, module: &'b Module) -> Case<'b, F> {
        Case {
            model: self.model,
            textbook: self.textbook,
            module,
            constants: interpreter::constants(self.point.context, module),
            atoms: self.atoms,
            point: self.point.clone(),
            factors: self.factors.clone(),
            charts: self.charts.clone(),
        }
    }

    /// Number of bodies that have coordinates.
    pub fn n_bodies(&self) -> usize {
        self.model.coordinate_bodies().len()
    }

    /// The textbook's formulas at a point.
    pub fn textbook<'s>(&'s self, point: &'s Point<F>) -> Result<Evaluation<'s, F>, Undecided> {
        self.textbook.at(point, self.atoms).ok_or(Undecided::Textbook)
    }

    /// What a function of the module gives at a point.
    pub fn run(&self, function: &str, point: &Point<F>) -> Result<Vec<F>, Undecided> {
        self.run_with(function, point, &[])
    }

    /// The same for one that reads accelerations.
    pub fn run_with(
        &self,
        function: &str,
        point: &Point<F>,
        accelerations: &[F],
    ) -> Result<Vec<F>, Undecided> {
        let program = &self.module.programs[function];
        let given = Given { point, accelerations, charts: &self.charts };
        Ok(interpreter::run(self.module, program, &self.constants, self.atoms, &given)?)
    }

    /// Accelerations (with the multipliers that they come with) and all multipliers.
    pub fn motion(&self) -> Result<(Vec<F>, Vec<F>), Undecided> {
        let accelerations = self.run("accelerations", &self.point)?;
        let multipliers = self.run_with("multipliers", &self.point, &accelerations)?;
        Ok((accelerations, multipliers))
    }

    /// A point whose state is changed by a function of the partition.
    pub fn moved(&self, function: &str, point: &Point<F>) -> Result<Point<F>, Undecided> {
        let values = self.run(function, point)?;
        let mut moved = point.clone();
        for (&place, value) in self.module.programs[function].places.iter().zip(values) {
            moved.state[place] = value;
        }
        Ok(moved)
    }
}
