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
use gyro_program::{Counts, Given, Kernel, Outcome, Signature, Space, State};
use matching::{Hole, Matched};
use proc_macro2::{TokenStream, TokenTree};
use skeleton::Has;
pub(crate) use skeleton::{n_state, type_name};
use std::collections::BTreeMap;
use syn::Block;
pub use tables::is_of_curve;

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

/// How a function gives its results.
fn form(signature: &Signature) -> Form {
    match signature.result {
        Outcome::Fills(..) | Outcome::Derived => Form::Filling,
        Outcome::FillsTwo(_) => Form::Jacobian,
        Outcome::Renews(..) => Form::Joints,
        Outcome::Overwrites if signature.state == State::Maximal => Form::Stores,
        Outcome::Overwrites => Form::JointStores,
        Outcome::Energies => Form::Energy,
        Outcome::Vectors => Form::Vectors,
    }
}

/// What a function has another one compute first.
fn before(signature: &Signature) -> Option<Before> {
    let (Given::First(buffer, first) | Given::HandedOn(buffer, first)) = signature.given else { return None };
    let (of, function, state) = (first.group().trait_name(), first.function(), signature.state.argument()?.0);
    let call = format!("gyro_sim :: {of} :: {function} (self , t , {state} , & mut {buffer}) ;");
    Some(Before { buffer, state, call })
}

/// The signature of a function by its name.
fn signature(function: &str) -> Option<&'static Signature> {
    Kernel::named(function).map(Kernel::signature)
}

/// Whether a function is made for states that satisfy the constraints.
pub fn is_on_constraints(function: &str) -> bool {
    signature(function).is_some_and(Signature::is_on_constraints)
}

/// The function that gives the accelerations, or rates, that another one reads.
pub fn source_of_accelerations(function: &str) -> &'static str {
    signature(function).map_or(Kernel::Accelerations, Signature::accelerations).function()
}

/// Whether a function is told accelerations that need not be those of the equations of motion.
pub fn takes_any_accelerations(function: &str) -> bool {
    signature(function).is_some_and(Signature::takes_any_accelerations)
}

/// How many things of each kind a mechanism has, but for what formulas decide.
pub(crate) fn counts(model: &Model, joints: Option<&JointLayout>) -> Counts {
    Counts {
        bodies: model.coordinate_bodies().len(),
        rows: model.rows().len(),
        work: usize::from(model.has_work()),
        states: model.states.len(),
        turns: model.turn_references().len(),
        readings: skeleton::n_readings(model),
        outputs: model.outputs.iter().map(|output| output.kind.columns().len()).sum(),
        frames: frames(model).count(),
        inputs: model.inputs.len(),
        parameters: model.parameters.len(),
        coordinates: joints.map_or(0, |joints| joints.n_coordinates),
        rates: joints.map_or(0, |joints| joints.n_rates),
        closure: joints.map_or(0, |joints| joints.closure_rows.len()),
        ..Counts::default()
    }
}

/// How many numbers a joint state has; none of a mechanism without one.
fn joint_numbers(joints: Option<&JointLayout>, counts: &Counts) -> usize {
    joints.map_or(0, |_| Space::Joints.len(counts))
}

/// The outputs that are frames.
pub(crate) fn frames(model: &Model) -> impl Iterator<Item = &Output> {
    model.outputs.iter().filter(|output| matches!(output.kind, OutputKind::Velocity(_)))
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
        let n_charts = number("charts");
        let counts = Counts {
            phi_q: number("phi_q").unwrap_or(0),
            phi_pi: number("phi_pi").unwrap_or(0),
            accelerations: number("accelerations").unwrap_or(0),
            ..counts(model, joints.as_ref())
        };
        let n_accelerations = counts.accelerations;
        let sizes = Sizes {
            state: Space::State.len(&counts),
            accelerations: n_accelerations,
            rows: counts.rows,
            joints: joint_numbers(joints.as_ref(), &counts),
            charts: n_charts.unwrap_or(0),
            tables: tables.len(),
            derived: number("derived").unwrap_or(0),
        };
        let mut occurrences = Vec::new();
        let mut read = |kernel: Kernel| {
            let (name, signature) = (kernel.function(), kernel.signature());
            let Some(hole) = matched.holes.get(name) else { return Ok(None) };
            let accelerations = signature.accelerations().signature().n_results(&counts).unwrap_or(0);
            // What is set up does not read what is set up.
            let derived = if kernel == Kernel::ParameterSetup { 0 } else { sizes.derived };
            let (sizes, before) = (Sizes { accelerations, derived, ..sizes }, before(signature));
            let mut reader = Reader::new(model, &mut occurrences, sizes, before);
            if hole.arguments.is_empty() {
                ["t"]
                    .into_iter()
                    .chain(signature.state.argument().map(|(state, _)| state))
                    .for_each(|argument| reader.argument(argument));
            }
            hole.arguments.iter().for_each(|argument| reader.argument(argument));
            let targets = signature.written().into_iter().filter(|(name, _)| *name != "out");
            match form(signature) {
                Form::Joints | Form::JointStores => reader.buffer(),
                Form::Stores => {}
                _ => targets.for_each(|(target, _)| reader.target(target)),
            }
            reader.body(&block(hole)?, form(signature)).map(|program| Some((name.to_owned(), program)))
        };
        let mut written = BTreeMap::new();
        for kernel in Kernel::all() {
            written.extend(read(kernel)?);
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
        module.sizes_agree(&counts, matched).map(|()| module)
    }

    /// Whether it implements a trait of the run time, of those that it may leave out.
    pub fn implements(&self, name: &str) -> bool {
        self.has.implements(name)
    }

    /// Each function gives as many numbers as its type says.
    fn sizes_agree(&self, counts: &Counts, matched: &Matched) -> Result<(), Refusal> {
        let number = |name: &str| matched.numbers.get(name).copied().unwrap_or(0);
        let expected = Kernel::all().filter_map(|kernel| {
            let n = match kernel {
                Kernel::ParameterSetup => number("derived"),
                Kernel::ChartVectors => 4 * number("charts"),
                kernel => kernel.signature().n_results(counts)?,
            };
            Some((kernel.function(), n))
        });
        // What is not written was not to be there.
        let of_function = |(name, size)| Some((name, self.written.get(name)?.results.len(), size));
        let patterns = [
            ("phi_q_pattern", self.phi_q_pattern.len(), counts.phi_q),
            ("phi_pi_pattern", self.phi_pi_pattern.len(), counts.phi_pi),
            ("start", self.start.len(), Space::State.len(counts)),
            ("joint_start", self.joint_start.len(), joint_numbers(self.joints.as_ref(), counts)),
        ];
        let sizes = expected.filter_map(of_function).chain(patterns);
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
