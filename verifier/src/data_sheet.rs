//! What the text of a module must say: its data sheet, line by line, and the documentation of its parts.
//!
//! All of it is made anew from the model and from the formulas that were read; nothing is said that is not known here.

use crate::module::{Module, counts, frames, is_of_curve, type_name};
use crate::program::{Node, Operations, Program};
use crate::refusal::Refusal;
use gyro_model::{Model, Number, Parameter, RowOwner, Support, to_f64};
use gyro_program::Kernel;
use std::collections::BTreeSet;

/// What every sheet says of rounding. The forms that were compared are known to the generator alone.
const ROUNDING: &str = "* rounding: at most 10 times that of the best form compared";

/// Where the section on the proof begins.
pub const PROOF: &str = "# Proof";

/// All statements of a module's text that are not true; the section on the proof is left to the caller.
pub fn problems(model: &Model, module: &Module) -> Vec<Refusal> {
    let mut problems = undocumented(module);
    problems.extend(unfounded(model, module));
    let (head, rows, other) = lines(module);
    let expected = expected_head(model, module);
    if let Some(place) = (0..expected.len().max(head.len())).find(|&k| expected.get(k) != head.get(k)) {
        let [expected, found] = [&expected, &head].map(|lines| lines.get(place).map_or("", String::as_str));
        problems.push(Refusal::new(1, format!("the data sheet says `{found}` instead of `{expected}`")));
    }
    let expected: Vec<String> =
        module.written.iter().filter_map(|(name, program)| row(model, module, name, program)).collect();
    for row in &expected {
        let found = rows.iter().filter(|line| *line == row).count();
        if found != 1 {
            problems.push(Refusal::new(1, format!("the data sheet has {found} rows `{row}`")));
        }
    }
    if rows.len() != expected.len() {
        let (found, expected) = (rows.len(), expected.len());
        let words = format!("the data sheet has {found} functions instead of {expected}");
        problems.push(Refusal::new(1, words));
    }
    if let Some(line) = other.first().filter(|line| *line != PROOF) {
        problems.push(Refusal::new(
            1,
            format!("the data sheet says `{line}`, which is not a line of a data sheet"),
        ));
    }
    problems
}

/// The section on the proof, if there is one.
pub fn proof(module: &Module) -> Option<Vec<String>> {
    let (_, _, other) = lines(module);
    (!other.is_empty()).then_some(other)
}

/// The lines before the rows of functions, these rows, and the lines after them.
fn lines(module: &Module) -> (Vec<String>, Vec<String>, Vec<String>) {
    let is_row = |line: &&String| line.starts_with('|');
    let sheet = &module.data_sheet;
    // Two rows are the table's head.
    let first = sheet.iter().position(|line| is_row(&line)).map_or(sheet.len(), |first| first + 2);
    let (head, rest) = sheet.split_at(first.min(sheet.len()));
    let n_rows = rest.iter().take_while(is_row).count();
    let other = rest[n_rows..].iter().skip_while(|line| line.is_empty());
    (head.to_vec(), rest[..n_rows].to_vec(), other.cloned().collect())
}

fn expected_head(model: &Model, module: &Module) -> Vec<String> {
    let moving_bodies = model.coordinate_bodies();
    let bodies: Vec<&str> = moving_bodies.iter().map(|&body| model.bodies[body].name.as_str()).collect();
    let (n, rows) = (moving_bodies.len(), model.rows().len());
    let dependent = model.redundant.len() - model.dropped().count();
    let mut lines = vec![
        format!("The mechanism `{}`.", model.name),
        String::new(),
        format!("* bodies with coordinates: {}", bodies.join(", ")),
        format!(
            "* coordinates: {}, constraint equations: {} ({rows} joint rows, {n} normalisations)",
            7 * n,
            rows + n
        ),
        format!("* degrees of freedom: {}", (6 * n + dependent).saturating_sub(rows)),
        format!("* unknowns of eq. (17): {}", 6 * n + rows),
    ];
    if module.implements("Kinematics") {
        lines.push(format!(
            "* non-zeros: Φ_q {} of {}, (Φ_r, Φ_π') {} of {}",
            module.phi_q_pattern.len(),
            (rows + n) * 7 * n,
            module.phi_pi_pattern.len(),
            rows * 6 * n
        ));
    }
    lines.extend(left_out(model, module).into_iter().map(|what| format!("* left out: {what}")));
    lines.extend(model.kinks_in_words().into_iter().map(|place| format!("* not smooth: {place}")));
    lines.push(ROUNDING.to_owned());
    let table =
        ["", "| function | computes | + − | × | ÷ | total | zeros |", "|---|---|---|---|---|---|---|"];
    lines.extend(table.map(str::to_owned));
    lines.into_iter().map(|line| line.trim_end().to_owned()).collect()
}

/// What the mechanism could have had and has not.
fn left_out(model: &Model, module: &Module) -> Vec<String> {
    let mut left_out = Vec::new();
    for body in &model.bodies {
        let why = match body.support {
            Support::Fixed => "fixed: folded into constants",
            Support::Driven => "driven: a function of time",
            Support::Moving | Support::Free | Support::Constrained => continue,
        };
        left_out.push(format!("coordinates of `{}` ({why})", body.name));
    }
    for redundant in model.dropped() {
        let (kind, name) = match redundant.row.owner {
            RowOwner::Body(body) => ("body", &model.bodies[body].name),
            RowOwner::Joint(joint) => ("joint", &model.joints[joint].name),
            RowOwner::Coupler(coupler) => (model.couplers[coupler].word(), &model.couplers[coupler].name),
            RowOwner::Driver(driver) => ("driver", &model.drivers[driver].name),
        };
        left_out.push(format!("row {} of {kind} `{name}` (redundant)", redundant.row.index + 1));
    }
    let has_joints = module.joints.is_some();
    let lacks = |name: &str| !module.implements(name);
    // What was not asked for is known to the sheet alone.
    let said = |what: &'static str, unasked: &'static str| {
        let says_so = module.data_sheet.iter().any(|line| line.strip_prefix("* left out: ") == Some(unasked));
        if says_so { unasked } else { what }
    };
    let says =
        |what: &str| module.data_sheet.iter().any(|line| line.strip_prefix("* left out: ") == Some(what));
    let missing = [
        (!has_joints, said("joint coordinates", "joint coordinates (functions = [\"joint\"] asks for them)")),
        (
            has_joints && lacks("JointJacobian"),
            said(
                "the Jacobian of the joint form (too many rates, or third derivatives of tables)",
                "the Jacobian of the joint form (functions = [\"jacobian\"] asks for it)",
            ),
        ),
        (lacks("Kinematics"), "derivatives of the constraints (functions = [\"kinematics\"] asks for it)"),
        (lacks("Dynamics"), "eq. (17) at any state (functions = [\"maximal\"] asks for it)"),
        (
            lacks("CorrectedDynamics"),
            "accelerations at corrected states (functions = [\"corrected\"] asks for it)",
        ),
        (
            has_joints && lacks("CorrectedSolution"),
            "multipliers at corrected states (functions = [\"reactions\"] asks for it)",
        ),
        (
            lacks("Projection"),
            "the projection that the masses weigh (functions = [\"projection\"] asks for it)",
        ),
        (lacks("Partition"), "the coordinate partition (functions = [\"partition\"] asks for it)"),
        (
            module.implements("Partition") && module.n_charts.is_none() && !has_joints,
            "charts (for trees of revolute, spherical and fixed joints: the run time pivots)",
        ),
        (
            module.implements("Partition") && module.n_charts.is_none() && has_joints,
            "charts (for trees of revolute, spherical and fixed joints: the partition goes through joint coordinates)",
        ),
        (model.attraction.is_none() && model.gravity.iter().all(Number::is_zero), "gravity"),
        (!model.is_worked_on(), "the work of non-conservative forces (there are none)"),
        (
            model.is_worked_on() && !model.has_work(),
            "the work of non-conservative forces (count_work = false)",
        ),
        (model.parameters.is_empty(), "parameters (all numbers are folded)"),
        (model.outputs.is_empty(), "outputs (the model file asks for none)"),
    ];
    left_out.extend(unavailable(model, module).into_iter().filter(|what| says(what)));
    left_out
        .extend(missing.into_iter().filter(|(is_missing, _)| *is_missing).map(|(_, what)| what.to_owned()));
    left_out
}

/// What can be missing though it was asked for: that it was, only the sheet knows.
fn unavailable(model: &Model, module: &Module) -> Vec<String> {
    const NONE: &str = "without joint coordinates there are none";
    const NO_OUTPUTS: &str = "the model file asks for no outputs";
    let has_loops = module.joints.as_ref().is_some_and(|joints| !joints.closure_rows.is_empty());
    let of_outputs = [
        (
            !module.implements("ParameterJacobian"),
            "parameter_jacobian",
            "too many rates, or third derivatives of tables",
        ),
        (model.outputs.is_empty(), "joint_outputs", NO_OUTPUTS),
        (model.outputs.is_empty(), "output_derivatives", NO_OUTPUTS),
        (
            !module.implements("OutputDerivatives") && !model.outputs.is_empty(),
            "output_derivatives",
            "they need third derivatives of tables",
        ),
        (frames(model).next().is_none(), "frames", "no output is of kind `velocity`"),
    ];
    let of_loops = ["inverse", "mass_matrix", "derivatives", "regressor"]
        .map(|group| (has_loops, group, "mechanisms with loops have none"));
    let all: Vec<_> = of_outputs.into_iter().chain(of_loops).collect();
    let lines = all.into_iter().filter_map(|(is_missing, group, why)| match module.joints {
        None => Some((group, NONE)),
        Some(_) => is_missing.then_some((group, why)),
    });
    let mut lines: Vec<_> = lines.map(|(group, why)| format!("the functions of `{group}` ({why})")).collect();
    lines.dedup();
    lines
}

/// `| phi_q | Φ_q, non-zeros in (r, p) | 68 | 137 | 0 | 205 | 0 of 77 |`, with the loops in which it is computed if
/// there are some; what gives no numbers has no row.
fn row(model: &Model, module: &Module, name: &str, program: &Program) -> Option<String> {
    let kernel = Kernel::named(name)?;
    let computes = kernel.computes();
    let operations = Operations::of(program);
    let is_zero = |id: usize| match program.nodes[id] {
        Node::Constant(place) => module.constants.values[place].literal == 0.0,
        _ => false,
    };
    let zeros = program.results.iter().filter(|&&id| is_zero(id)).count();
    let counts = counts(model, module.joints.as_ref());
    let all = program.results.len();
    let results = match kernel {
        Kernel::NewtonStep => 7 * counts.bodies,
        Kernel::SolveVelocities => 6 * counts.bodies,
        Kernel::ClosePositions => counts.coordinates,
        Kernel::CloseVelocities => counts.rates,
        Kernel::Derivative | Kernel::CorrectedDerivative => all - 6 * counts.bodies,
        Kernel::JointDerivative => all - counts.rates,
        // Work goes through.
        Kernel::ToMaximal | Kernel::ToJoints => all - counts.work,
        _ => all,
    };
    let name = kernel.name();
    let Operations { additions, multiplications, divisions, .. } = operations;
    let total = operations.total();
    let loops = match program.loops_that_compute() {
        0 => String::new(),
        1 => ", in a loop".to_owned(),
        n => format!(", in {n} loops"),
    };
    (results > 0).then(|| {
        format!("| {name} | {computes}{loops} | {additions} | {multiplications} | {divisions} | {total} | {zeros} of {results} |")
    })
}

/// Functions whose documentation does not say what they compute and with how many operations.
fn undocumented(module: &Module) -> Vec<Refusal> {
    let of_function = |(name, program): (&String, &Program)| {
        let (found, expected) = (module.docs.get(name)?, documentation(name, program)?);
        let is_right = program.results.is_empty() || *found == expected;
        let line = program.lines.first().copied().unwrap_or(0);
        let words =
            format!("the documentation of `{name}` says `{}` instead of `{}`", found.trim(), expected.trim());
        (!is_right).then(|| Refusal::new(line, words))
    };
    module.written.iter().filter_map(of_function).collect()
}

/// ` Writes ν: 3 operations (1 ±, 2 ×, 0 ÷).`
fn documentation(name: &str, program: &Program) -> Option<String> {
    let words = Kernel::named(name)?.signature().does_in_rust();
    let operations = Operations::of(program);
    let Operations { additions, multiplications, divisions, functions } = operations;
    let calls = if functions > 0 { format!(" and {functions} functions") } else { String::new() };
    let total = operations.total();
    Some(format!(" {words}: {total} operations ({additions} ±, {multiplications} ×, {divisions} ÷){calls}."))
}

/// Documentation that nothing in the model is a reason for.
fn unfounded(model: &Model, module: &Module) -> Vec<Refusal> {
    let of_functions = module.written.iter().filter_map(|(name, program)| documentation(name, program));
    let known: BTreeSet<String> = of_functions.chain(of_items(model, module)).collect();
    let unknown = module.all_docs.iter().filter(|(_, text)| !known.contains(text));
    unknown.map(|(line, text)| Refusal::new(*line, format!("`///{text}` is not what is here"))).collect()
}

/// The documentation of items other than functions.
fn of_items(model: &Model, module: &Module) -> Vec<String> {
    let plain = [
        " The model has neither parameters nor inputs.",
        " What depends on parameters alone.",
        " Names of the parameters.",
        " Sets a parameter by its place in [`Self::PARAMETERS`]; returns whether there is one.",
        " The mechanism with these parameters.",
        " The parameters.",
        " Sets all parameters, and computes what depends on them alone.",
        " Whether the mechanism can have these parameters, as the model file's rules decide.",
        " The assembled start, with all parameters at their defaults.",
        " Polynomials between them, from each point's own time.",
        " Where numbers stand, by name; of several numbers the first.",
    ];
    let mut docs: Vec<String> = plain.map(str::to_owned).to_vec();
    if module.n_charts.is_some() {
        docs.push(" The solves of the partition, for the charts that are given as unit vectors.".to_owned());
    }
    let default = |p: &Parameter| to_f64(&p.value);
    docs.push(format!(" The mechanism `{}`.", model.name));
    docs.push(format!(" Parameters of [`{}`].", type_name(&model.name)));
    docs.extend(model.parameters.iter().map(|p| format!(" Default {:?}.", default(p))));
    docs.extend(
        model.inputs.iter().map(|p| format!(" Input, set at every step; until then {:?}.", default(p))),
    );
    docs.extend(module.tables.iter().map(|table| {
        let is_of_curve = is_of_curve(model, table);
        let [of, unit] = if is_of_curve { ["Arguments", ""] } else { ["Times", ", s"] };
        format!(" {of} of the points of `{}`{unit}.", printable(&table.source))
    }));
    docs.extend(module.implements("Dynamics").then(|| {
        match module.n_accelerations - 6 * model.coordinate_bodies().len() {
            0 => " (s̈, ẇ') of each body.".to_owned(),
            n => format!(" (s̈, ẇ') of each body, then {n} multipliers of the rows that close loops."),
        }
    }));
    docs
}

/// The name of a file with what cannot stand in a line of a comment escaped.
fn printable(name: &str) -> String {
    let is_plain = |c: char| c.is_ascii_graphic() || c == ' ' || c.is_alphanumeric();
    name.chars().map(|c| if is_plain(c) { c.to_string() } else { c.escape_default().to_string() }).collect()
}
