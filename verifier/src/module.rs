//! An emitted module, read back: each function as a program.

mod arrays;
mod block;
mod expression;
mod layout;
mod lists;
mod loops;
mod matching;
mod plain;
mod results;
mod skeleton;
mod syntax;
mod tables;

use crate::constants::Constants;
use crate::joints::JointLayout;
use crate::program::Program;
use crate::refusal::Refusal;
use block::{Before, Form, Reader, Sizes};
use gyro_model::{Model, Output, OutputKind, Spline};
use matching::{Hole, Matched};
use proc_macro2::{TokenStream, TokenTree};
use skeleton::Has;
pub(crate) use skeleton::{n_state, type_name};
use std::collections::BTreeMap;
use syn::Block;

/// What a module says, after everything around its formulas was found to be as the model determines it.
#[derive(Clone, Debug)]
pub struct Module {
    /// The text's documentation: the data sheet, a line each.
    pub data_sheet: Vec<String>,
    /// The functions that compute something, by name, as they are written.
    pub written: BTreeMap<String, Program>,
    /// What each of them computes from parameters, time and state: `parameter_setup` is part of those that read what it
    /// computes.
    pub programs: BTreeMap<String, Program>,
    /// What each function's documentation says of it.
    pub docs: BTreeMap<String, String>,
    /// All documentation but the data sheet, with its line.
    pub all_docs: Vec<(usize, String)>,
    /// Row and column of each value that `phi_q` gives, if the module has it.
    pub phi_q_pattern: Vec<(usize, usize)>,
    /// Row and column of each value that `phi_pi` gives.
    pub phi_pi_pattern: Vec<(usize, usize)>,
    /// The start.
    pub start: Vec<f64>,
    /// The start in joint coordinates; nothing of mechanisms that have none.
    pub joint_start: Vec<f64>,
    /// What it has of what the description leaves to choice.
    has: Has,
    /// The order of the rates in which the factor of the mass matrix is triangular; nothing of modules without it.
    pub mass_order: Vec<usize>,
    /// Where joint coordinates stand, if the module has them.
    pub joints: Option<JointLayout>,
    /// Number of accelerations and multipliers that `accelerations` gives, if the module has it.
    pub n_accelerations: usize,
    /// Number of charts, if the coordinate partition goes by charts.
    pub n_charts: Option<usize>,
    /// Tables of prescribed motions.
    pub tables: Vec<Spline>,
    /// The exact numbers behind the literals.
    pub constants: Constants,
}

/// The function that computes what depends on parameters alone.
pub(crate) const PARAMETER_SETUP: &str = "parameter_setup";

/// Functions that are straight-line programs, and how they give their results.
const FUNCTIONS: [(&str, Form); 49] = [
    (PARAMETER_SETUP, Form::Filling),
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
    ("project", Form::Filling),
    ("outputs", Form::Filling),
    ("newton_step", Form::Stores),
    ("solve_velocities", Form::Stores),
    ("chart_vectors", Form::Vectors),
    ("corrected_derivative", Form::Filling),
    ("joint_accelerations", Form::Filling),
    ("joint_derivative", Form::Filling),
    ("to_maximal", Form::Filling),
    ("to_joints", Form::Joints),
    ("joint_accelerations_at", Form::Filling),
    ("corrected_accelerations", Form::Filling),
    ("corrected_multipliers", Form::Filling),
    ("corrected_solution", Form::Filling),
    ("loop_closure", Form::Filling),
    ("closure_distances", Form::Filling),
    ("close_positions", Form::JointStores),
    ("close_velocities", Form::JointStores),
    ("joint_jacobian", Form::Jacobian),
    ("joint_input_jacobian", Form::Filling),
    ("joint_parameter_jacobian", Form::Filling),
    ("joint_outputs", Form::Filling),
    ("outputs_by_state", Form::Filling),
    ("outputs_by_accelerations", Form::Filling),
    ("outputs_by_inputs", Form::Filling),
    ("outputs_by_parameters", Form::Filling),
    ("frame_jacobians", Form::Filling),
    ("frame_biases", Form::Filling),
    ("inverse_dynamics", Form::Filling),
    ("bias_forces", Form::Filling),
    ("gravity_forces", Form::Filling),
    ("mass_matrix", Form::Filling),
    ("mass_factor", Form::Filling),
    ("inverse_derivatives", Form::Filling),
    ("forward_derivatives", Form::Filling),
    ("regressor", Form::Filling),
];

/// What functions write, where it is not `out`.
const TARGETS: [(&str, &str); 8] = [
    ("derivative", "dy"),
    ("corrected_derivative", "dy"),
    ("multipliers", "lambda"),
    ("corrected_multipliers", "lambda"),
    ("joint_derivative", "dx"),
    ("joint_jacobian", "dfdx"),
    ("joint_jacobian", "dfdt"),
    ("to_maximal", "y"),
];

/// What functions have others compute first.
const BEFORE: [(&str, Before); 5] = [
    ("derivative", ACCELERATIONS),
    ("outputs", ACCELERATIONS),
    (
        "corrected_derivative",
        Before {
            buffer: "accelerations",
            call: "gyro_sim :: CorrectedDynamics :: corrected_accelerations (self , t , y , & mut accelerations) ;",
        },
    ),
    (
        "joint_derivative",
        Before {
            buffer: "rates",
            call: "gyro_sim :: JointSpace :: joint_accelerations (self , t , x , & mut rates) ;",
        },
    ),
    (
        "joint_outputs",
        Before {
            buffer: "accelerations",
            call: "gyro_sim :: JointSpace :: joint_accelerations (self , t , x , & mut accelerations) ;",
        },
    ),
];

const ACCELERATIONS: Before = Before {
    buffer: "accelerations",
    call: "gyro_sim :: Dynamics :: accelerations (self , t , y , & mut accelerations) ;",
};

/// Functions that are made for states that satisfy the constraints.
const ON_CONSTRAINTS: [&str; 5] = [
    "joint_accelerations_at",
    "corrected_accelerations",
    "corrected_derivative",
    "corrected_multipliers",
    "corrected_solution",
];

/// Whether a function is made for states that satisfy the constraints.
pub fn is_on_constraints(function: &str) -> bool {
    ON_CONSTRAINTS.contains(&function)
}

/// The function that gives the accelerations, or rates, that another one reads.
pub fn source_of_accelerations(function: &str) -> &'static str {
    match function {
        "joint_derivative" | "joint_outputs" | "inverse_dynamics" | "inverse_derivatives" | "regressor" => {
            "joint_accelerations"
        }
        function if function.starts_with("outputs_by_") => "joint_accelerations",
        "corrected_derivative" | "corrected_multipliers" => "corrected_accelerations",
        _ => "accelerations",
    }
}

/// The outputs that are frames.
pub(crate) fn frames(model: &Model) -> impl Iterator<Item = &Output> {
    model.outputs.iter().filter(|output| matches!(output.kind, OutputKind::Velocity(_)))
}

/// Whether a function is told accelerations that need not be those of the equations of motion.
pub fn takes_any_accelerations(function: &str) -> bool {
    ["inverse_dynamics", "inverse_derivatives", "regressor"].contains(&function)
        || function.starts_with("outputs_by_")
}

fn of_function<T: Copy>(table: &[(&str, T)], function: &str) -> Option<T> {
    table.iter().find(|(name, _)| *name == function).map(|(_, value)| *value)
}

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
        no_comments(text)?;
        let (tables, text) = tables::read(model, text)?;
        let tokens: TokenStream =
            text.parse().map_err(|error: proc_macro2::LexError| Refusal::at(error.span(), "not Rust"))?;
        let has = Has::of(&text);
        let joints = layout::read(model, &tokens)?;
        let name = type_name(&model.name);
        let expected = skeleton::text(model, &name, &tables, &has, joints.as_ref());
        let expected = expected.parse().expect("the expected text consists of tokens");
        let mut matched = Matched::default();
        matched.walk(expected, tokens, text.lines().count())?;
        Self::assemble(model, constants, tables, (has, joints), &matched)
    }

    fn assemble(
        model: &Model,
        constants: Constants,
        tables: Vec<Spline>,
        (has, joints): (Has, Option<JointLayout>),
        matched: &Matched,
    ) -> Result<Self, Refusal> {
        let number = |name: &str| matched.numbers.get(name).copied();
        let n_accelerations = number("accelerations").unwrap_or(0);
        let n_charts = number("charts");
        let sizes = Sizes {
            state: n_state(model),
            accelerations: n_accelerations,
            rows: model.rows().len(),
            joints: joints.as_ref().map_or(0, JointLayout::n_state),
            charts: n_charts.unwrap_or(0),
            tables: tables.len(),
            derived: number("derived").unwrap_or(0),
        };
        let mut occurrences = Vec::new();
        let mut read = |name: &str, form| {
            let Some(hole) = matched.holes.get(name) else { return Ok(None) };
            let accelerations = match name {
                "corrected_derivative" | "corrected_multipliers" => 6 * model.coordinate_bodies().len(),
                name if source_of_accelerations(name) == "joint_accelerations" => {
                    joints.as_ref().map_or(0, |joints| joints.n_rates)
                }
                _ => n_accelerations,
            };
            // What is set up does not read what is set up.
            let derived = if name == PARAMETER_SETUP { 0 } else { sizes.derived };
            let (sizes, before) = (Sizes { accelerations, derived, ..sizes }, of_function(&BEFORE, name));
            let mut reader = Reader::new(model, &mut occurrences, sizes, before);
            if hole.arguments.is_empty() {
                before.iter().flat_map(Before::arguments).for_each(|argument| reader.argument(argument));
            }
            hole.arguments.iter().for_each(|argument| reader.argument(argument));
            let targets = TARGETS.iter().filter(|(function, _)| *function == name);
            targets.for_each(|(_, target)| reader.target(target));
            if matches!(form, Form::Joints | Form::JointStores) {
                reader.buffer();
            }
            reader.body(&block(hole)?, form).map(|program| Some((name.to_owned(), program)))
        };
        let mut written = BTreeMap::new();
        for (name, form) in FUNCTIONS {
            written.extend(read(name, form)?);
        }
        let places = constants.places(&occurrences)?;
        written.values_mut().for_each(|program| program.name_constants(&places));
        let recurring = written.iter().filter(|(name, _)| *name != PARAMETER_SETUP);
        let programs = match written.get(PARAMETER_SETUP) {
            Some(parameter_setup) => {
                recurring.map(|(name, p)| (name.clone(), p.after(parameter_setup))).collect()
            }
            None => written.clone(),
        };
        let pattern = |name: &str| match matched.holes.get(name) {
            Some(hole) => lists::pattern(&block(hole)?),
            None => Ok(Vec::new()),
        };
        let module = Self {
            data_sheet: matched.data_sheet.clone(),
            all_docs: matched.docs.clone(),
            docs: matched.holes.iter().map(|(name, hole)| (name.clone(), hole.doc.clone())).collect(),
            phi_q_pattern: pattern("phi_q_pattern")?,
            phi_pi_pattern: pattern("phi_pi_pattern")?,
            start: lists::start(&block(&matched.holes["start"])?)?,
            joint_start: match matched.holes.get("joint_start") {
                Some(hole) => lists::start(&block(hole)?)?,
                None => Vec::new(),
            },
            has,
            mass_order: match matched.holes.get("mass_order") {
                Some(hole) => {
                    lists::order(&block(hole)?, joints.as_ref().map_or(0, |joints| joints.n_rates))?
                }
                None => Vec::new(),
            },
            joints,
            written,
            programs,
            n_accelerations,
            n_charts,
            tables,
            constants,
        };
        if module.implements("Dynamics") && n_accelerations < 6 * model.coordinate_bodies().len() {
            return Err(Refusal::new(1, format!("{n_accelerations} accelerations are too few")));
        }
        module.sizes_agree(model, matched).map(|()| module)
    }

    /// Whether it implements a trait of the run time, of those that it may leave out.
    pub fn implements(&self, name: &str) -> bool {
        self.has.implements(name)
    }

    /// Each function gives as many numbers as its type says.
    fn sizes_agree(&self, model: &Model, matched: &Matched) -> Result<(), Refusal> {
        let (n, rows) = (model.coordinate_bodies().len(), model.rows().len());
        let number = |name: &str| matched.numbers.get(name).copied().unwrap_or(0);
        let (n_joints, n_rates) =
            self.joints.as_ref().map_or((0, 0), |joints| (joints.n_state(), joints.n_rates));
        let n_motion = self.joints.as_ref().map_or(0, JointLayout::n_motion);
        let outputs: usize = model.outputs.iter().map(|output| output.kind.columns().len()).sum();
        let expected = [
            (PARAMETER_SETUP, number("derived")),
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
            ("project", 6 * n),
            ("outputs", outputs),
            ("chart_vectors", 4 * number("charts")),
            ("corrected_derivative", n_state(model)),
            ("joint_accelerations", n_rates),
            ("joint_derivative", n_joints),
            ("to_maximal", n_state(model)),
            ("to_joints", n_joints),
            ("joint_accelerations_at", n_rates),
            ("corrected_accelerations", 6 * n),
            ("corrected_multipliers", rows),
            ("corrected_solution", 6 * n + rows),
            ("loop_closure", self.joints.as_ref().map_or(0, |joints| joints.closure_rows.len())),
            ("closure_distances", self.joints.as_ref().map_or(0, |joints| joints.closure_rows.len())),
            ("joint_jacobian", n_joints * (n_joints + 1)),
            ("joint_input_jacobian", n_joints * model.inputs.len()),
            ("joint_parameter_jacobian", n_joints * model.parameters.len()),
            ("joint_outputs", outputs),
            ("outputs_by_state", outputs * n_motion),
            ("outputs_by_accelerations", outputs * n_rates),
            ("outputs_by_inputs", outputs * model.inputs.len()),
            ("outputs_by_parameters", outputs * model.parameters.len()),
            ("frame_jacobians", 6 * frames(model).count() * n_rates),
            ("frame_biases", 6 * frames(model).count()),
            ("inverse_dynamics", n_rates),
            ("bias_forces", n_rates),
            ("gravity_forces", n_rates),
            ("mass_matrix", n_rates * n_rates),
            ("mass_factor", n_rates * n_rates),
            ("inverse_derivatives", 2 * n_rates * n_rates),
            ("forward_derivatives", 3 * n_rates * n_rates),
            ("regressor", 10 * n * n_rates),
        ];
        // What is not written was not to be there.
        let of_function = |(name, size)| Some((name, self.written.get(name)?.results.len(), size));
        let patterns = [
            ("phi_q_pattern", self.phi_q_pattern.len(), number("phi_q")),
            ("phi_pi_pattern", self.phi_pi_pattern.len(), number("phi_pi")),
            ("start", self.start.len(), n_state(model)),
            ("joint_start", self.joint_start.len(), n_joints),
        ];
        let sizes = expected.into_iter().filter_map(of_function).chain(patterns);
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
}

fn block(hole: &Hole) -> Result<Block, Refusal> {
    let block = syn::parse2(TokenTree::Group(hole.body.clone()).into())?;
    plain::check(&block)?;
    Ok(block)
}

/// There is one comment, the first line: what is said of the code elsewhere is documentation, which is read.
fn no_comments(text: &str) -> Result<(), Refusal> {
    let is_documentation = |line: &str| line.starts_with("//!") || line.starts_with("///");
    let has_comment = |line: &str| line.contains("//") || line.contains("/*");
    let comment = text.lines().skip(1).position(|line| {
        let line = line.trim_start();
        has_comment(line) && !is_documentation(line)
    });
    comment.map_or(Ok(()), |line| Err(Refusal::new(line + 2, "a comment that no module has")))
}
