//! An emitted module, read back: each function as a program.

mod block;
mod expression;
mod matching;
mod skeleton;
mod tables;

use crate::constants::Constants;
use crate::program::Program;
use crate::refusal::Refusal;
use block::{Form, Reader, Sizes};
use gyro_model::{Model, Spline};
use matching::{Hole, Matched};
use proc_macro2::{TokenStream, TokenTree};
use skeleton::Choice;
pub(crate) use skeleton::n_state;
use std::collections::BTreeMap;
use syn::Block;

/// What a module says, after everything around its formulas was found to be as the model determines it.
#[derive(Clone, Debug)]
pub struct Module {
    /// The text's documentation: the data sheet, a line each.
    pub sheet: Vec<String>,
    /// The functions that compute something, by name.
    pub programs: BTreeMap<String, Program>,
    /// What each function's documentation says of it.
    pub docs: BTreeMap<String, String>,
    /// Row and column of each value that `phi_q` gives.
    pub phi_q_pattern: Vec<(usize, usize)>,
    /// Row and column of each value that `phi_pi` gives.
    pub phi_pi_pattern: Vec<(usize, usize)>,
    /// The start.
    pub start: Vec<f64>,
    /// Number of accelerations and multipliers that `accelerations` gives.
    pub n_accelerations: usize,
    /// Number of charts, if the coordinate partition goes by charts.
    pub n_charts: Option<usize>,
    /// Tables of prescribed motions.
    pub tables: Vec<Spline>,
    /// The exact numbers behind the literals.
    pub constants: Constants,
}

/// Functions that are straight-line programs, and how they give their results.
const FUNCTIONS: [(&str, Form); 15] = [
    ("derivative", Form::Filling),
    ("phi", Form::Filling),
    ("velocity_residual", Form::Filling),
    ("energy", Form::Energy),
    ("read_joints", Form::Filling),
    ("phi_q", Form::Filling),
    ("phi_pi", Form::Filling),
    ("nu", Form::Filling),
    ("gamma", Form::Filling),
    ("applied_force", Form::Filling),
    ("accelerations", Form::Filling),
    ("multipliers", Form::Filling),
    ("outputs", Form::Filling),
    ("newton_step", Form::Stores),
    ("solve_velocities", Form::Stores),
];

impl Module {
    /// Reads a module's text and the text of its exact constants.
    ///
    /// # Errors
    /// The first thing that is not as the generator writes it for this model, by its line.
    pub fn read(model: &Model, text: &str, constants: &str) -> Result<Self, Refusal> {
        let constants = Constants::read(constants).map_err(|refusal| Refusal {
            message: format!("of the constants: {}", refusal.message),
            ..refusal
        })?;
        let tokens: TokenStream =
            text.parse().map_err(|error: proc_macro2::LexError| Refusal::at(error.span(), "not Rust"))?;
        let tables = tables::read(model, tokens.clone())?;
        let choice = if text.contains("gyro_sim::charts") { Choice::Charts } else { Choice::Pivoting };
        let expected = skeleton::text(model, &skeleton::type_name(&model.name), &tables, choice);
        let expected = expected.parse().expect("the expected text consists of tokens");
        let mut matched = Matched::default();
        matched.walk(expected, tokens, text.lines().count())?;
        Self::assemble(model, text, constants, tables, &matched)
    }

    fn assemble(
        model: &Model,
        text: &str,
        constants: Constants,
        tables: Vec<Spline>,
        matched: &Matched,
    ) -> Result<Self, Refusal> {
        let number = |name: &str| matched.numbers.get(name).copied();
        let n_accelerations = number("accelerations").unwrap_or(0);
        let n_charts = number("charts");
        let sizes = Sizes {
            state: n_state(model),
            accelerations: n_accelerations,
            charts: n_charts.unwrap_or(0),
            tables: tables.len(),
        };
        let mut used = vec![false; constants.values.len()];
        let mut read = |name: &str, form| {
            let Some(hole) = matched.holes.get(name) else { return Ok(None) };
            let mut reader = Reader::new(model, &constants, &mut used, sizes);
            hole.arguments
                .iter()
                .map(String::as_str)
                .chain(["dy", "lambda"])
                .for_each(|a| reader.argument(a));
            reader.body(&block(hole)?, form).map(|program| Some((name.to_owned(), program)))
        };
        let mut programs = BTreeMap::new();
        for (name, form) in FUNCTIONS.into_iter().chain([("chart_vectors", Form::Vectors)]) {
            programs.extend(read(name, form)?);
        }
        let pattern = |name: &str| block::pattern(&block(&matched.holes[name])?);
        let module = Self {
            sheet: text
                .lines()
                .filter_map(|line| line.strip_prefix("//!"))
                .map(|line| line.trim().to_owned())
                .collect(),
            docs: matched.holes.iter().map(|(name, hole)| (name.clone(), hole.doc.clone())).collect(),
            phi_q_pattern: pattern("phi_q_pattern")?,
            phi_pi_pattern: pattern("phi_pi_pattern")?,
            start: block::start(&block(&matched.holes["start"])?)?,
            programs,
            n_accelerations,
            n_charts,
            tables,
            constants,
        };
        if n_accelerations < 6 * model.coordinate_bodies().len() {
            return Err(Refusal::new(1, format!("{n_accelerations} accelerations are too few")));
        }
        module.sizes_agree(model, matched)?;
        module.uses_all_constants(&used).map(|()| module)
    }

    /// Each function gives as many numbers as its type says.
    fn sizes_agree(&self, model: &Model, matched: &Matched) -> Result<(), Refusal> {
        let (n, rows) = (model.coordinate_bodies().len(), model.rows().len());
        let number = |name: &str| matched.numbers.get(name).copied().unwrap_or(0);
        let outputs = model.outputs.iter().map(|output| output.kind.columns().len()).sum();
        let expected = [
            ("derivative", n_state(model)),
            ("phi", rows + n),
            ("velocity_residual", rows),
            ("energy", 2),
            ("read_joints", skeleton::n_readings(model)),
            ("phi_q", number("phi_q")),
            ("phi_pi", number("phi_pi")),
            ("nu", rows),
            ("gamma", rows),
            ("applied_force", 6 * n),
            ("accelerations", self.n_accelerations),
            ("multipliers", rows),
            ("outputs", outputs),
            ("chart_vectors", 4 * number("charts")),
        ];
        let found = |name: &str| self.programs.get(name).map_or(0, |program| program.results.len());
        let patterns = [
            ("phi_q_pattern", self.phi_q_pattern.len(), number("phi_q")),
            ("phi_pi_pattern", self.phi_pi_pattern.len(), number("phi_pi")),
            ("start", self.start.len(), n_state(model)),
        ];
        let sizes = expected.map(|(name, size)| (name, found(name), size)).into_iter().chain(patterns);
        for (name, found, expected) in sizes {
            if found != expected {
                let line = matched.holes.get(name).map_or(0, |hole| hole.body.span_open().start().line);
                return Err(Refusal::new(
                    line,
                    format!("`{name}` gives {found} numbers instead of {expected}"),
                ));
            }
        }
        Ok(())
    }

    fn uses_all_constants(&self, used: &[bool]) -> Result<(), Refusal> {
        match used.iter().position(|used| !used) {
            Some(place) => {
                let literal = self.constants.literal(place);
                Err(Refusal::new(
                    self.constants.lines[place],
                    format!("of the constants: the literal {literal} does not occur"),
                ))
            }
            None => Ok(()),
        }
    }
}

fn block(hole: &Hole) -> Result<Block, Refusal> {
    Ok(syn::parse2(TokenTree::Group(hole.body.clone()).into())?)
}
