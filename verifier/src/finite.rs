//! What identities do not show: `x w / w` is x, and not a number where w is zero.
//!
//! Every function is run in `f64` where a mechanism starts, rests, is stretched out and folded, spins fast or is torn
//! apart. What is not finite there is a mistake, unless the textbook's is not either: where eq. (17) has no solution,
//! where a link has zero length.

use crate::atoms::Elementary;
use crate::interpreter::{self, Given};
use crate::module::{Module, is_on_constraints, source_of_accelerations};
use crate::point::Point;
use crate::program::{Id, Node, Program, Source};
use crate::proof::point_of_terms;
use crate::seed::Seed;
use crate::states::{self, Place, places};
use crate::tape::{Formulas, Tape, Term, Written};
use crate::textbook::{Sparse, Textbook};
use gyro_model::{Model, Row, RowOwner, RowUnit};
use gyro_program::{Kernel, State};

/// Axes of a joint that is whole are off by less, as the dot-1 rows have it: by more than any that are torn by
/// [`TORN`]. A loop that is closed is off by less of the mechanism's size.
const WHOLE: f64 = 0.2;

/// Eq. (17), its rows and columns brought to size one, can be solved if no pivot is smaller than this.
const REGULAR: f64 = 1e-9;

/// A divisor of the textbook's is zero but for rounding if it is smaller: a length, m, or the square of a sine.
const VANISHING: f64 = 1e-12;

/// Functions of a joint state that solve for what the rows of loops demand.
const IN_JOINTS: [&str; 7] = [
    "joint_accelerations",
    "closure_distances",
    "close_positions",
    "close_velocities",
    "joint_jacobian",
    "joint_input_jacobian",
    "joint_outputs",
];

/// All that is not finite and should be.
pub fn problems(model: &Model, module: &Module, seed: Seed) -> Vec<String> {
    let textbook = Dense::new(model);
    let constants: Vec<f64> = interpreter::constants((), module);
    let (places, mut problems) = (places(model, module, seed), Vec::new());
    // Many functions ask it of one place: as it is, and of joints that are whole.
    let mut regular = vec![[None; 2]; places.len()];
    for function in module.programs.keys() {
        let broken = places.iter().zip(&mut regular).find_map(|(place, regular)| {
            let line = not_finite(model, module, &constants, function, place)?;
            let must_be_finite = match function.as_str() {
                // Every joint state has its maximal state, and is as far from closed loops as that is.
                "to_maximal" | "loop_closure" => true,
                function => {
                    let module = is_solve(module, function).then_some(module);
                    *regular[usize::from(module.is_some())]
                        .get_or_insert_with(|| textbook.is_regular(model, &place.state, module))
                }
            };
            must_be_finite.then_some((place.what, line))
        });
        problems.extend(broken.map(|(what, line)| {
            format!("`{function}` is not finite {what}: line {line} is the first that is not")
        }));
    }
    problems
}

/// Whether a function solves for what the rows ask. Which unknown is taken from which row is decided for joints that
/// are whole: where axes are torn a right angle apart, the solve of a tree divides by their cosine, though eq. (17) has
/// a solution there. What is made of accelerations may have multipliers in it, which are solved for too: reactions, and
/// the power of what is driven. In joint coordinates only loops have rows to solve for.
fn is_solve(module: &Module, function: &str) -> bool {
    let has_loops = module.joints.as_ref().is_some_and(|joints| !joints.closure_rows.is_empty());
    if has_loops && (IN_JOINTS.contains(&function) || is_on_constraints(function)) {
        return true;
    }
    let is_acceleration = |node: &Node| matches!(node, Node::Read(Source::Acceleration(_)));
    ["accelerations", "project", "newton_step", "solve_velocities"].contains(&function)
        || module.programs[function].nodes.iter().any(is_acceleration)
}

/// The first line of a function whose value is not finite, if any of its results is not.
fn not_finite(
    model: &Model,
    module: &Module,
    constants: &[f64],
    function: &str,
    place: &Place,
) -> Option<usize> {
    let program = &module.programs[function];
    let reads = |is: fn(Source) -> bool| {
        program.nodes.iter().any(|node| matches!(node, Node::Read(source) if is(*source)))
    };
    // Whether or not it reads any: where all is driven there are none.
    let of_joints = |kernel: Kernel| kernel.signature().state == State::Joint;
    let needs_joints = Kernel::named(function).is_some_and(of_joints);
    if place.joints.is_none() && (is_on_constraints(function) || needs_joints) {
        return None;
    }
    let joints = place.joints.as_ref().unwrap_or(&module.joint_start);
    let point = states::point(model, (), &place.state, 0.0, |x| x);
    let run = |function: &str, accelerations: &[f64], charts: &[[f64; 4]]| {
        let changes = vec![1.0; model.rows().len()];
        let given = Given { point: &point, accelerations, charts, changes: &changes, joints };
        let program = module.programs.get(function)?;
        interpreter::values(module, program, constants, &Elementary, &given)
            .ok()
            .map(|values| (program, values))
    };
    let results = |(program, values): (&Program, Vec<f64>)| -> Vec<f64> {
        program.results.iter().map(|&id| values[id]).collect()
    };
    let accelerations = if reads(|source| matches!(source, Source::Acceleration(_))) {
        let found = run(source_of_accelerations(function), &[], &[]).map(results)?;
        found.into_iter().map(|x| if x.is_finite() { x } else { 0.0 }).collect()
    } else {
        Vec::new()
    };
    let charts = if reads(|source| matches!(source, Source::Chart(..))) {
        run("chart_vectors", &[], &[]).map(results)?.chunks(4).map(largest).collect()
    } else {
        Vec::new()
    };
    let (program, values) = run(function, &accelerations, &charts)?;
    let is_finite = |id: Id| values[id].is_finite();
    let vanishes = |vector: &&[Id]| vector.iter().all(|&id| values[id] == 0.0);
    if function == "chart_vectors"
        && let Some(vector) = program.results.chunks(4).find(vanishes)
    {
        return Some(program.lines[vector[0]]);
    }
    if program.results.iter().all(|&id| is_finite(id)) {
        return None;
    }
    let first = (0..values.len()).find(|&id| !is_finite(id))?;
    Some(program.lines[first])
}

/// The chart that a run takes: one at the largest component, in its direction.
fn largest(vector: &[f64]) -> [f64; 4] {
    let place = (0..4).max_by(|&a, &b| vector[a].abs().total_cmp(&vector[b].abs())).unwrap_or(0);
    [0, 1, 2, 3].map(|k| f64::from(u8::from(k == place)))
}

/// Eq. (17) of the textbook, written out to be run in `f64`.
struct Dense {
    formulas: Formulas,
    /// The matrix `(M, Φ_π'ᵀ; Φ_π', 0)`: rows, columns and what is not zero.
    entries: Vec<(usize, usize, Id)>,
    /// Its rows.
    size: usize,
    /// All else that must be finite, Φ first.
    others: Vec<Id>,
    is_written: bool,
}

impl Dense {
    fn new(model: &Model) -> Self {
        let (tape, textbook) = (Tape::new(), Textbook::new(model));
        let written = {
            let point = point_of_terms(model, &tape);
            let evaluation = textbook.at(&point, &Written);
            evaluation.and_then(|e| {
                let others =
                    [e.phi()?, e.velocity_residual()?, e.gamma()?, e.applied_force()?, e.energy()?.to_vec()];
                let ids = |row: Vec<Term<'_>>| row.into_iter().map(Term::id).collect::<Vec<Id>>();
                let entries = |matrix: Sparse<Term<'_>>| {
                    let rows = matrix.rows.into_iter().enumerate();
                    let entries = rows.flat_map(|(i, row)| row.into_iter().map(move |(k, x)| (i, k, x.id())));
                    entries.collect::<Vec<_>>()
                };
                let (mass, phi_pi) = (e.mass_matrix(), e.phi_pi()?);
                let (n, size) = (mass.rows.len(), mass.rows.len() + phi_pi.rows.len());
                let mut all = entries(mass);
                let of_rows = entries(phi_pi).into_iter();
                all.extend(of_rows.flat_map(|(i, k, id)| [(n + i, k, id), (k, n + i, id)]));
                Some((all, size, ids(others.concat())))
            })
        };
        let formulas = tape.finish();
        let is_written = written.is_some();
        let (entries, size, others) = written.unwrap_or_default();
        Self { formulas, entries, size, others, is_written }
    }

    /// Whether the textbook has finite numbers at a state, and eq. (17) a solution there; if asked for, whether joints
    /// of a module are whole too, and its loops closed.
    fn is_regular(&self, model: &Model, state: &[f64], must_be_whole: Option<&Module>) -> bool {
        if !self.is_written || state.iter().any(|x| !x.is_finite()) {
            return false;
        }
        let point: Point<f64> = states::point(model, (), state, 0.0, |x| x);
        // A formula may be anything, |x| and √x included.
        if !Textbook::new(model).at(&point, &Elementary).is_some_and(|here| here.has_smooth_formulas()) {
            return false;
        }
        let entries = self.entries.iter().map(|&(.., id)| id);
        let reach = self.formulas.reach(entries.chain(self.others.iter().copied()));
        let read = |source| *point.given(source).expect("the textbook reads what the model says there is");
        let values = self.formulas.evaluate(&reach, (), &Elementary, &read);
        let value = |id: &Id| values[*id].unwrap_or(f64::NAN);
        let mut matrix = vec![vec![0.0; self.size]; self.size];
        self.entries.iter().for_each(|(i, k, id)| matrix[*i][*k] = value(id));
        // What the textbook divides by: where it is zero, rounding may make a small number of it.
        let divides_by = |(id, node): (usize, &Node)| match node {
            Node::Div(_, by) if reach[id] => Some(value(by).abs()),
            _ => None,
        };
        let mut divisors = self.formulas.program.nodes.iter().enumerate().filter_map(divides_by);
        let is_finite = divisors.all(|divisor| divisor > VANISHING)
            && self.others.iter().all(|id| value(id).is_finite())
            && matrix.iter().flatten().all(|x| x.is_finite());
        let is_whole = |module: &Module| {
            let closes =
                |row| module.joints.as_ref().is_some_and(|joints| joints.closure_rows.contains(&row));
            let unit = |row: Row| if row.unit == RowUnit::Length { model.size() } else { 1.0 };
            let mut rows = model.rows().into_iter().zip(&self.others).enumerate();
            rows.all(|(place, (row, id))| {
                !(is_of_directions(row) || closes(place)) || value(id).abs() < WHOLE * unit(row)
            })
        };
        is_finite && must_be_whole.is_none_or(is_whole) && smallest_pivot(matrix) > REGULAR
    }
}

/// Whether a row holds directions of a joint or a body to each other.
fn is_of_directions(row: Row) -> bool {
    row.unit == RowUnit::Pure && matches!(row.owner, RowOwner::Joint(_) | RowOwner::Body(_))
}

/// The smallest pivot of Gaussian elimination with full pivoting, of a symmetric matrix whose rows and columns are
/// first brought to size one.
fn smallest_pivot(mut matrix: Vec<Vec<f64>>) -> f64 {
    let n = matrix.len();
    for _ in 0..4 {
        let scales: Vec<f64> = matrix
            .iter()
            .map(|row| row.iter().fold(0.0, |largest: f64, x| largest.max(x.abs())).sqrt())
            .map(|size| if size > 0.0 { 1.0 / size } else { 1.0 })
            .collect();
        for (row, by) in matrix.iter_mut().zip(&scales) {
            row.iter_mut().zip(&scales).for_each(|(x, also_by)| *x *= by * also_by);
        }
    }
    // Few rows have anything in a column: only these change, and only among them the largest is looked for anew.
    let mut left = vec![true; n];
    let largest = |row: &[f64], left: &[bool]| -> (f64, usize) {
        let sizes = row.iter().zip(left).enumerate().filter(|(_, (_, left))| **left);
        sizes.fold((0.0, 0), |most, (k, (x, _))| if x.abs() >= most.0 { (x.abs(), k) } else { most })
    };
    let mut rows: Vec<_> = matrix.into_iter().map(|row| (largest(&row, &left), row)).collect();
    let mut smallest = f64::INFINITY;
    while let Some(at) = (0..rows.len()).max_by(|&a, &b| rows[a].0.0.total_cmp(&rows[b].0.0)) {
        let ((size, column), pivot) = rows.swap_remove(at);
        smallest = smallest.min(size);
        if smallest <= REGULAR {
            return smallest;
        }
        left[column] = false;
        for (most, row) in rows.iter_mut().filter(|(_, row)| row[column] != 0.0) {
            let factor = row[column] / pivot[column];
            row.iter_mut().zip(&pivot).for_each(|(x, p)| *x -= factor * p);
            *most = largest(row, &left);
        }
    }
    smallest
}
