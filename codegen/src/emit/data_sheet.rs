//! The data sheet of a generated module: sizes, what each function costs pass by pass, what was left out; and the head
//! of the file, which shows of it what the verifier can see for itself.

use crate::equations::{Equations, PartitionForm};
use crate::expr::graph::{ExprId, Graph};
use crate::expr::rounding::LIKE as ROUNDING;
use crate::expr::schedule::{Operations, Passes};
use crate::joint_space::obstacle;
use crate::kernels::Kernels;
use crate::repeat::Repetition;
use crate::scheduled;
use crate::simplify::cheapest::{Chosen, Form};
use crate::simplify::normal_form::Reduction;
use gyro_model::{Model, RowOwner, Support};
use gyro_program::Group;
use gyro_program::Kernel;
use rustc_hash::FxHashMap as HashMap;
use std::fmt::Write;

/// What was generated and what was left out.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DataSheet {
    /// Name of the mechanism.
    pub mechanism: String,
    /// Names of the bodies with coordinates.
    pub bodies: Vec<String>,
    /// Rows of joints, couplers and drivers.
    pub rows: usize,
    /// How many of these depend on the others.
    pub dependent: usize,
    /// Entries of Φ_q that are not zero, normalisations among them.
    pub phi_q: usize,
    /// Entries of (Φ_r, Φ_π') that are not zero.
    pub phi_pi: usize,
    /// What other mechanisms have and this one does not, so that no instruction is spent on it.
    pub left_out: Vec<String>,
    /// The same, where only the derivation knows of it: the module does not state what the verifier cannot check.
    pub spared: Vec<String>,
    /// The functions that compute something.
    pub functions: Vec<Function>,
}

/// One function of a module.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Function {
    /// Which one, with its name and what it computes.
    pub kernel: Kernel,
    /// What is emitted.
    pub operations: Operations,
    /// What is left after each pass.
    pub passes: Passes,
    /// How many numbers it computes.
    pub results: usize,
    /// How many of them are zero whatever the state.
    pub zeros: usize,
    /// The ways of computing it that were compared; none if there is a single one.
    pub forms: Vec<Form>,
    /// What the polynomial normal form made of the parts of the form of this name.
    pub reductions: Vec<Reduction>,
    /// How it is written if it has loops; none if it is straight-line code.
    pub repetition: Option<Repetition>,
}

/// How it is said of functions that they were asked for and cannot be.
const UNAVAILABLE: &str = "the functions of";

impl DataSheet {
    pub(crate) fn of(
        equations: &Equations,
        kernels: &Kernels,
        repetitions: &HashMap<Vec<ExprId>, Repetition>,
    ) -> Self {
        let model = equations.model;
        let bodies = model.coordinate_bodies().into_iter().map(|body| model.bodies[body].name.clone());
        Self {
            mechanism: model.name.clone(),
            bodies: bodies.collect(),
            rows: equations.n_rows,
            dependent: model.redundant.len() - model.dropped().count(),
            phi_q: equations.phi_q.len(),
            phi_pi: equations.phi_pi.len(),
            left_out: left_out(equations),
            spared: spared(equations),
            functions: (kernels.iter())
                .map(|kernel| {
                    let written = || repetitions.get(&scheduled::written(equations, kernels, kernel.0).1);
                    let repetition = repetitions.get(&kernel.1.roots).or_else(written).copied();
                    let function = Function::of(&equations.graph, kernel);
                    let operations = repetition.map_or(function.operations, |written| written.operations);
                    Function { repetition, operations, ..function }
                })
                .collect(),
        }
    }

    /// Coordinates (r, p) of all bodies.
    pub fn coordinates(&self) -> usize {
        7 * self.bodies.len()
    }

    /// Rows of Φ: one normalisation for each body after the rows of joints, couplers and drivers.
    pub fn constraints(&self) -> usize {
        self.rows + self.bodies.len()
    }

    /// What was asked for and cannot be: which functions, and why.
    pub fn unavailable(&self) -> impl Iterator<Item = &str> {
        self.left_out.iter().map(String::as_str).filter(|what| what.starts_with(UNAVAILABLE))
    }

    /// Degrees of freedom.
    pub fn degrees_of_freedom(&self) -> usize {
        (6 * self.bodies.len() + self.dependent).saturating_sub(self.rows)
    }

    /// Unknowns of eq. (17): accelerations and multipliers.
    pub fn unknowns(&self) -> usize {
        6 * self.bodies.len() + self.rows
    }

    /// What is known of a kernel, if the module has it.
    pub fn function(&self, kernel: Kernel) -> Option<&Function> {
        self.functions.iter().find(|function| function.kernel == kernel)
    }

    /// The first lines of the module's file.
    pub(crate) fn head(&self, file_name: &str) -> String {
        let page = printable(file_name.rsplit(['/', '\\']).next().unwrap_or(file_name));
        let mut text = format!("// @generated by cargo xtask generate from {page}. Do not edit.\n\n");
        for line in self.lines() {
            let line = format!("//! {line}");
            writeln!(text, "{}", line.trim_end()).expect("a string takes all text");
        }
        text
    }

    fn lines(&self) -> Vec<String> {
        let (n, rows) = (self.bodies.len(), self.rows);
        let mut lines = vec![
            format!("The mechanism `{}`.", self.mechanism),
            String::new(),
            format!("* bodies with coordinates: {}", self.bodies.join(", ")),
            format!(
                "* coordinates: {}, constraint equations: {} ({rows} joint rows, {n} normalisations)",
                self.coordinates(),
                self.constraints()
            ),
            format!("* degrees of freedom: {}", self.degrees_of_freedom()),
            format!("* unknowns of eq. (17): {}", self.unknowns()),
        ];
        if self.phi_q > 0 {
            lines.push(format!(
                "* non-zeros: Φ_q {} of {}, (Φ_r, Φ_π') {} of {}",
                self.phi_q,
                self.constraints() * self.coordinates(),
                self.phi_pi,
                rows * 6 * n
            ));
        }
        lines.extend(self.left_out.iter().map(|what| format!("* left out: {what}")));
        lines.push(format!("* rounding: at most {ROUNDING} times that of the best form compared"));
        lines.extend(
            ["", "| function | computes | + − | × | ÷ | total | zeros |", "|---|---|---|---|---|---|---|"]
                .map(String::from),
        );
        lines.extend(self.functions.iter().map(Function::row));
        lines
    }
}

impl Function {
    fn of(graph: &Graph, (kernel, chosen): (Kernel, &Chosen)) -> Self {
        let Chosen { roots, forms, reductions, .. } = chosen;
        Self {
            kernel,
            operations: Operations::count(graph, roots),
            passes: Passes::count(graph, roots),
            results: roots.len(),
            zeros: roots.iter().filter(|&&root| root == Graph::ZERO).count(),
            forms: forms.clone(),
            reductions: reductions.clone(),
            repetition: None,
        }
    }

    fn row(&self) -> String {
        let Operations { additions, multiplications, divisions, .. } = self.operations;
        let loops = match self.repetition.map_or(0, |repetition| repetition.loops) {
            0 => String::new(),
            1 => ", in a loop".to_owned(),
            n => format!(", in {n} loops"),
        };
        format!(
            "| {} | {}{loops} | {additions} | {multiplications} | {divisions} | {} | {} of {} |",
            self.kernel.name(),
            self.kernel.computes(),
            self.operations.total(),
            self.zeros,
            self.results,
        )
    }
}

/// A number that may have any size: all its digits, or two.
pub fn large(number: u64) -> String {
    match number {
        0..1_000_000 => number.to_string(),
        u64::MAX => "over 1.8e19".to_owned(),
        _ => format!("{:.1e}", number as f64),
    }
}

/// A name of a file as it can stand in a line of comments: what ends a line, or turns the direction of writing, is
/// escaped.
pub fn printable(name: &str) -> String {
    let plain = |c: char| c.is_ascii_graphic() || c == ' ' || c.is_alphanumeric();
    name.chars().map(|c| if plain(c) { c.to_string() } else { c.escape_default().to_string() }).collect()
}

/// What was saved and only the derivation can tell.
fn spared(equations: &Equations) -> Vec<String> {
    let mut spared = Vec::new();
    if equations.n_vanishing > 0 {
        spared.push(format!("{} entries of Φ_π' (zero for unit Euler parameters)", equations.n_vanishing));
    }
    spared.extend(equations.joint_space.iter().flat_map(|space| &space.invariant).map(|&body| {
        let name = &equations.model.bodies[body].name;
        format!("the rotation of `{name}` about its own axis in u̇ (its inertia is symmetric about it)")
    }));
    spared
}

fn left_out(equations: &Equations) -> Vec<String> {
    let model = equations.model;
    let mut left_out: Vec<String> = model
        .bodies
        .iter()
        .filter_map(|body| match body.support {
            Support::Fixed => Some(format!("coordinates of `{}` (fixed: folded into constants)", body.name)),
            Support::Driven => Some(format!("coordinates of `{}` (driven: a function of time)", body.name)),
            _ => None,
        })
        .collect();
    left_out.extend(model.dropped().map(|redundant| {
        let (owner, index) = (owner_name(model, redundant.row.owner), redundant.row.index + 1);
        format!("row {index} of {owner} (redundant)")
    }));
    left_out.extend(Group::on_request().filter_map(|group| unavailable(equations, group)));
    match &equations.joint_space {
        Some(space) => {
            left_out.extend(space.jacobian.is_none().then(|| {
                let why = if equations.functions.has(Group::Jacobian) {
                    "too many rates, or third derivatives of tables"
                } else {
                    "functions = [\"jacobian\"] asks for it"
                };
                format!("the Jacobian of the joint form ({why})")
            }));
        }
        None if obstacle(model).is_some() => left_out.push("joint coordinates".into()),
        None => left_out.push("joint coordinates (functions = [\"joint\"] asks for them)".into()),
    }
    let unasked = Group::all().filter(|&group| !equations.functions.has(group));
    let unasked = unasked.filter(|&group| Group::on_request().all(|other| other != group));
    left_out.extend(unasked.filter_map(|group| {
        let is_possible = match group {
            // Said above.
            Group::Joint | Group::Jacobian => false,
            Group::Reactions => equations.joint_space.is_some(),
            _ => true,
        };
        let (what, name) = (group.what(), group.name());
        is_possible.then(|| format!("{what} (functions = [\"{name}\"] asks for it)"))
    }));
    if equations.functions.has(Group::Partition) && equations.charts.is_none() {
        let instead = match equations.partition_form() {
            PartitionForm::Joints => "the partition goes through joint coordinates",
            PartitionForm::Charts | PartitionForm::Pivoting => "the run time pivots",
        };
        left_out.push(format!("charts (for trees of revolute, spherical and fixed joints: {instead})"));
    }
    if model.gravity.iter().all(gyro_model::Number::is_zero) {
        left_out.push("gravity".into());
    }
    if !model.has_work() {
        let why = if model.is_worked_on() { "count_work = false" } else { "there are none" };
        left_out.push(format!("the work of non-conservative forces ({why})"));
    }
    if model.parameters.is_empty() {
        left_out.push("parameters (all numbers are folded)".into());
    }
    if model.outputs.is_empty() {
        left_out.push("outputs (the model file asks for none)".into());
    }
    left_out
}

/// Of functions that are asked for and that there cannot be: which ones, and why.
fn unavailable(equations: &Equations, group: Group) -> Option<String> {
    if !equations.functions.has(group) {
        return None;
    }
    let why = match &equations.joint_space {
        None => "without joint coordinates there are none",
        Some(space) => match group {
            Group::JointOutputs | Group::OutputDerivatives if equations.model.outputs.is_empty() => {
                "the model file asks for no outputs"
            }
            Group::OutputDerivatives if space.output_derivatives.is_none() => {
                "they need third derivatives of tables"
            }
            Group::ParameterJacobian if space.parameter_jacobian.is_none() => {
                "too many rates, or third derivatives of tables"
            }
            Group::Frames if space.frames.is_none() => "no output is of kind `velocity`",
            Group::Inverse | Group::MassMatrix | Group::Derivatives | Group::Regressor
                if !space.closure_rows.is_empty() =>
            {
                "mechanisms with loops have none"
            }
            _ => return None,
        },
    };
    Some(format!("{UNAVAILABLE} `{}` ({why})", group.name()))
}

fn owner_name(model: &Model, owner: RowOwner) -> String {
    match owner {
        RowOwner::Body(body) => format!("body `{}`", model.bodies[body].name),
        RowOwner::Joint(joint) => format!("joint `{}`", model.joints[joint].name),
        RowOwner::Coupler(coupler) => format!("coupler `{}`", model.couplers[coupler].name),
        RowOwner::Driver(driver) => format!("driver `{}`", model.drivers[driver].name),
    }
}
