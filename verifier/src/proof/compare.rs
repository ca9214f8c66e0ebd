//! What modules are like, besides their claims: whether two compute the same, and what one need not compute.

use super::decide::{Decider, Verdict};
use super::point::{self, Draw, FAR_FROM_ZERO};
use crate::atoms::{Atoms, Elementary};
use crate::field::{Field, Precision};
use crate::interpreter::{self, DivisionByZero, Given};
use crate::joints::JointLayout;
use crate::module::{Module, is_on_constraints, source_of_accelerations, takes_any_accelerations};
use crate::program::{Function, Node};
use crate::seed::Seed;
use std::collections::HashMap;

/// An operation whose result is known without it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Needless {
    /// Its line.
    pub line: usize,
    /// Line of the value that it has, up to its sign; `None` of zero.
    pub same_as: Option<usize>,
}

impl<const L: usize> Decider<'_, L> {
    /// Whether a function of one module gives the same numbers as that of another one at a random point; `None` if one
    /// of them exists at no point. Functions that read accelerations are given those of the first module.
    pub fn agree(&self, modules: [&Module; 2], function: &str, seed: impl Into<Seed>) -> Option<bool> {
        let same_places = modules[0].programs[function].places == modules[1].programs[function].places;
        let seed = seed.into();
        let of_any_length = self.of_any_length(modules[0], function);
        let agree = self.at_point(modules[0], seed, |draw, atoms| {
            let [a, b] = both(modules, function, draw, atoms)?;
            let [longer_a, longer_b] = both(modules, function, &longer(modules[0], draw), atoms)?;
            Ok(a == b && of_any_length.iter().all(|&k| longer_a.get(k) == longer_b.get(k)))
        });
        agree.map(|agree| same_places && (agree || self.agree_in_floats(modules, function, seed)))
    }

    /// Which results of a function are claimed for Euler parameters of any length.
    fn of_any_length(&self, module: &Module, function: &str) -> Vec<usize> {
        let (rows, n) = (self.model.rows().len(), self.model.coordinate_bodies().len());
        let n_coordinates = module.joints.as_ref().map_or(0, |layout| layout.n_coordinates);
        match function {
            "phi" => (rows..rows + n).collect(),
            "phi_q" => {
                (0..module.phi_q_pattern.len()).filter(|&k| module.phi_q_pattern[k].0 >= rows).collect()
            }
            "derivative" | "corrected_derivative" => (0..7 * n).collect(),
            "joint_derivative" => (0..n_coordinates).collect(),
            _ => Vec::new(),
        }
    }

    /// The same in 384 bits, where the angle of a point is known to be that of any positive multiple of it.
    fn agree_in_floats(&self, modules: [&Module; 2], function: &str, seed: Seed) -> bool {
        let turns = |module: &Module| {
            module.programs[function].nodes.iter().any(|node| matches!(node, Node::Call(Function::Atan2, _)))
        };
        let (precision, mut random) = (Precision::new(), seed.numbers(0));
        let draw = point::real(self.model, modules[0], &precision, &mut random);
        let Some(draw) = draw.filter(|_| modules.into_iter().all(turns)) else { return false };
        let Ok([a, b]) = both(modules, function, &draw, &Elementary) else { return false };
        let largest = a.iter().map(|x| x.to_f64().abs()).fold(1.0, f64::max);
        a.iter().zip(&b).all(|(a, b)| a.sub(b).to_f64().abs() <= FAR_FROM_ZERO * largest)
    }

    /// Operations whose value, up to its sign, is zero or one that is known before, wherever |p| = 1: what a cleverer
    /// generator could leave out. They are no fault. `None` if the function exists at no point.
    pub fn needless(&self, module: &Module, function: &str, seed: impl Into<Seed>) -> Option<Vec<Needless>> {
        self.at_point(module, seed.into(), |draw, atoms| {
            let (draw, accelerations) = suited(module, function, draw, atoms)?;
            let constants = interpreter::constants(self.prime(), module);
            let program = &module.programs[function];
            let values =
                interpreter::values(module, program, &constants, atoms, &given(&draw, &accelerations))?;
            let (mut known, mut needless) = (HashMap::new(), Vec::new());
            for ((node, value), &line) in program.nodes.iter().zip(&values).zip(&program.lines) {
                let is_operation =
                    matches!(node, Node::Add(..) | Node::Sub(..) | Node::Mul(..) | Node::Div(..));
                let keys = [value.key(), value.neg().key()];
                let same_as = keys.iter().find_map(|key| known.get(key).copied());
                if is_operation && (value.is_zero() || same_as.is_some()) {
                    needless.push(Needless { line, same_as: same_as.filter(|_| !value.is_zero()) });
                }
                known.entry(keys[0]).or_insert(line);
            }
            Ok(needless)
        })
    }

    /// What is wrong with the patterns: zeros that are stored, places out of order. (That no place is missing is part
    /// of the claims.)
    ///
    /// A number that is zero at a random point is zero identically, with the probability of its claim; so it is if any
    /// number may stand for a root.
    ///
    /// # Errors
    /// [`Verdict::Undecided`] if something is divided by zero everywhere.
    pub fn sparsity(&self, module: &Module, seed: impl Into<Seed>) -> Result<Vec<String>, Verdict> {
        let seed = seed.into();
        let patterns = [("phi_q", &module.phi_q_pattern), ("phi_pi", &module.phi_pi_pattern)];
        let mut problems = Vec::new();
        for (matrix, pattern) in patterns {
            if !module.programs.contains_key(matrix) {
                continue;
            }
            let is_zero = self.at_any_point(module, seed, |draw, atoms| {
                let values = run(module, matrix, draw, &[], atoms)?;
                Ok(values.iter().map(Field::is_zero).collect::<Vec<_>>())
            });
            let is_zero = is_zero.ok_or(Verdict::Undecided)?;
            let zeros = pattern.iter().zip(is_zero).filter(|(_, zero)| *zero);
            problems.extend(zeros.map(|(place, _)| format!("`{matrix}` stores the zero at {place:?}")));
            let unsorted = pattern.windows(2).find(|pair| pair[0] >= pair[1]);
            problems.extend(unsorted.map(|pair| format!("`{matrix}` has {:?} after {:?}", pair[1], pair[0])));
        }
        Ok(problems)
    }
}

/// A point with longer Euler parameters, of the joint state too.
fn longer<F: Field>(module: &Module, draw: &Draw<F>) -> Draw<F> {
    let mut longer = draw.clone();
    longer.point = point::stretched(&draw.point, &draw.factors);
    let starts = module.joints.iter().flat_map(JointLayout::euler);
    for (start, factor) in starts.zip(&draw.factors) {
        longer.joints[0][start..start + 4].iter_mut().for_each(|e| *e = e.mul(factor));
    }
    longer
}

/// The results of the same function of two modules, with the accelerations of the first.
fn both<F: Field>(
    modules: [&Module; 2],
    function: &str,
    draw: &Draw<F>,
    atoms: &dyn Atoms<F>,
) -> Result<[Vec<F>; 2], DivisionByZero> {
    let (draw, accelerations) = suited(modules[0], function, draw, atoms)?;
    let run = |module| run(module, function, &draw, &accelerations, atoms);
    Ok([run(modules[0])?, run(modules[1])?])
}

/// A point that a function is made for, with the accelerations that it reads.
fn suited<F: Field>(
    module: &Module,
    function: &str,
    draw: &Draw<F>,
    atoms: &dyn Atoms<F>,
) -> Result<(Draw<F>, Vec<F>), DivisionByZero> {
    let mut draw = draw.clone();
    if is_on_constraints(function) {
        draw.point.state = run(module, "to_maximal", &draw, &[], atoms)?;
    }
    let source = source_of_accelerations(function);
    let accelerations = if takes_any_accelerations(function) {
        let n_rates = module.joints.as_ref().map_or(0, |joints| joints.n_rates);
        draw.motion[..n_rates].to_vec()
    } else if module.programs.contains_key(source) {
        run(module, source, &draw, &[], atoms)?
    } else {
        Vec::new()
    };
    Ok((draw, accelerations))
}

fn run<F: Field>(
    module: &Module,
    function: &str,
    draw: &Draw<F>,
    accelerations: &[F],
    atoms: &dyn Atoms<F>,
) -> Result<Vec<F>, DivisionByZero> {
    let constants = interpreter::constants(draw.point.context, module);
    interpreter::run(module, &module.programs[function], &constants, atoms, &given(draw, accelerations))
}

fn given<'d, F: Field>(draw: &'d Draw<F>, accelerations: &'d [F]) -> Given<'d, F> {
    Given {
        point: &draw.point,
        accelerations,
        charts: &draw.charts,
        changes: &draw.changes,
        joints: &draw.joints[0],
    }
}
