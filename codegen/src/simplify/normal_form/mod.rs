//! A cheaper form of some expressions: as polynomials, reduced by `sin² + cos² = 1` and its like, then factored.
//!
//! What is built by a recursion over bodies carries terms that cancel or repeat. Written out as polynomials over sines,
//! cosines, rates and parameters (`expand`), equal things are equal and opposite ones vanish; common factors, sums and
//! terms are then found among all roots together (`factor`), and constant factors put where they cost least
//! (`rescale`).

mod expand;
mod factor;
mod polynomial;
mod rescale;
mod sums;

use crate::expr::evaluate::{evaluate, sample};
use crate::expr::graph::{ExprId, Graph, Node};
use crate::expr::rounding::rounds_well;
use crate::expr::schedule::Operations;
use crate::expr::symbol::Symbol;
use expand::Expansion;
use factor::factor;
use gyro_program::elementary::Function;
use polynomial::Polynomial;
use rescale::{rescale, rescale_pairs};
use std::collections::{HashMap, HashSet};
use std::rc::Rc;
use sums::Sums;

/// What the polynomial normal form, factored, made of some expressions: operations before and after.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reduction {
    /// Which expressions.
    pub what: &'static str,
    /// Operations before.
    pub before: usize,
    /// Operations after.
    pub after: usize,
}

/// Bounds the time of expansion: terms that are worked out.
const MAX_TERMS: usize = 80_000;

/// Bounds the time of factoring: comparisons of terms.
const MAX_STEPS: usize = 100_000;

/// Ways of factoring that are tried to choose between identities, and after that choice.
const FEW: u64 = 2;
const MANY: u64 = 40;

/// The cheapest form found of the roots: equal to them wherever the identities hold, and the roots themselves if
/// nothing is cheaper or if they are too large.
///
/// `unit` names points of unit circles and spheres, such as the four Euler parameters: the squares of each add up to
/// one. The sine and cosine of one operand need no mention.
pub fn normal_form(graph: &mut Graph, unit: &[Vec<ExprId>], roots: &[ExprId]) -> Vec<ExprId> {
    normal_form_of(graph, unit, roots, &[])
}

/// The same; the last argument says which of the roots something will be divided by, so that they are better sums of
/// what cannot be negative.
pub fn normal_form_of(
    graph: &mut Graph,
    unit: &[Vec<ExprId>],
    roots: &[ExprId],
    divisors: &[bool],
) -> Vec<ExprId> {
    if loses_digits(graph, roots) {
        return roots.to_vec();
    }
    let relations = relations(graph, unit, roots);
    let cost = Operations::recurring(graph, roots).total();
    match search(graph, &relations, (roots, divisors)) {
        Some(form) if form.cost < cost => {
            let built = form.system.build(graph);
            if rounds_well(graph, &built, roots) { built } else { roots.to_vec() }
        }
        _ => roots.to_vec(),
    }
}

/// Whether a root is taken of something that changes from step to step, such as the depth of a stop or the length of a
/// link. It is small where a difference vanishes; as a polynomial, whose terms are not, it would have no digits left
/// there.
fn loses_digits(graph: &Graph, roots: &[ExprId]) -> bool {
    let is_changing_root =
        |id: ExprId| matches!(graph.node(id), Node::Call(Function::Sqrt, _)) && graph.is_changing(id);
    graph.reachable(roots).into_iter().any(is_changing_root)
}

/// Whether an expression is zero wherever the identities hold; not, if it is too large to be sure.
pub fn vanishes(graph: &mut Graph, unit: &[Vec<ExprId>], root: ExprId) -> bool {
    if is_clearly_something(graph, unit, root) {
        return false;
    }
    let relations = relations(graph, unit, &[root]);
    let (first, mut terms) = (vec![0; relations.len()], MAX_TERMS);
    let expanded = expand(graph, &relations, &first, (&[root], &[]), &mut terms);
    expanded.is_some_and(|expanded| expanded.system.sums.iter().all(Vec::is_empty))
}

/// Whether an expression is zero but for rounding at points where the identities hold: for what the proof looks at
/// again.
pub fn is_zero_at_points(graph: &Graph, unit: &[Vec<ExprId>], root: ExprId) -> bool {
    (0..3).all(|point| size(graph, unit, root, point).is_some_and(|size| size < ROUNDED))
}

/// Whether an expression has, somewhere where the identities hold, a value far beyond what rounding makes of zero.
fn is_clearly_something(graph: &Graph, unit: &[Vec<ExprId>], root: ExprId) -> bool {
    size(graph, unit, root, 0).is_some_and(|size| size > CLEAR)
}

/// The size of an expression at a point, as a part of the largest value on the way.
fn size(graph: &Graph, unit: &[Vec<ExprId>], root: ExprId, point: u64) -> Option<f64> {
    let draw = sample(point);
    let reachable = graph.reachable(&[root]);
    let known: HashSet<ExprId> = reachable.iter().copied().collect();
    let symbol = |id: &ExprId| if let Node::Symbol(symbol) = graph.node(*id) { Some(*symbol) } else { None };
    let mut on_sphere: HashMap<Symbol, f64> = HashMap::new();
    for point in unit.iter().filter(|point| point.iter().any(|id| known.contains(id))) {
        let symbols = point.iter().map(symbol).collect::<Option<Vec<_>>>()?;
        let norm = symbols.iter().map(|&symbol| draw(symbol).powi(2)).sum::<f64>().sqrt();
        on_sphere.extend(symbols.into_iter().map(|symbol| (symbol, draw(symbol) / norm)));
    }
    let value = |symbol| on_sphere.get(&symbol).copied().unwrap_or_else(|| draw(symbol));
    let values: Vec<f64> = evaluate(graph, &reachable, value);
    let largest = values.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
    // The root is reached last.
    values.last().map(|value| value.abs() / largest)
}

/// So much of the largest intermediate value is far beyond its rounding.
const CLEAR: f64 = 1e-6;

/// So much of it, or less, is rounding.
const ROUNDED: f64 = 1e-13;

/// The given points that the roots depend on, and the sines and cosines among what they depend on. No two have an atom
/// in common, or they could replace each other's squares without end.
fn relations(graph: &mut Graph, unit: &[Vec<ExprId>], roots: &[ExprId]) -> Vec<Vec<ExprId>> {
    let reachable: HashSet<ExprId> = graph.reachable(roots).into_iter().collect();
    let mut relations = unit.to_vec();
    for id in graph.reachable(roots) {
        if let Node::Call(Function::Cos, [operand, _]) = *graph.node(id) {
            relations.push(vec![id, graph.sin(operand)]);
        }
    }
    relations.retain(|point| point.iter().all(|x| reachable.contains(x)));
    let mut known: HashSet<ExprId> = HashSet::new();
    relations.retain(|point| {
        let apart = point.iter().all(|x| !known.contains(x));
        known.extend(point.iter().filter(|_| apart));
        apart
    });
    relations
}

/// A factored system and what it costs.
struct Form {
    system: Sums,
    cost: usize,
}

/// First each relation in turn replaces another square than its first, if that loses fewer digits or is cheaper; then
/// more ways of factoring are tried. `None` if the roots are too large.
fn search(graph: &Graph, relations: &[Vec<ExprId>], roots: (&[ExprId], &[bool])) -> Option<Form> {
    let (mut terms, mut steps) = (MAX_TERMS, MAX_STEPS);
    let mut choice = vec![0; relations.len()];
    let Expanded { mut system, used, mut cancellations } =
        expand(graph, relations, &choice, roots, &mut terms)?;
    let mut best = factored(&system, 0..FEW, &mut steps)?;
    for (at, relation) in relations.iter().enumerate() {
        if !used[at] && cancellations == 0 {
            continue;
        }
        for reduced in 1..relation.len() {
            let kept = std::mem::replace(&mut choice[at], reduced);
            let other = expand(graph, relations, &choice, roots, &mut terms);
            let form = other.and_then(|other| Some((factored(&other.system, 0..FEW, &mut steps)?, other)));
            match form {
                // Digits before operations.
                Some((form, other)) if (other.cancellations, form.cost) < (cancellations, best.cost) => {
                    (best, system, cancellations) = (form, other.system, other.cancellations);
                }
                _ => choice[at] = kept,
            }
        }
    }
    if let Some(form) = factored(&system, FEW..MANY, &mut steps).filter(|form| form.cost < best.cost) {
        best = form;
    }
    let mut system = best.system.clone();
    rescale_pairs(&mut system);
    let cost = cost(&system);
    Some(if cost < best.cost { Form { system, cost } } else { best })
}

/// The roots as polynomials.
struct Expanded {
    system: Sums,
    /// Which relations had anything to replace.
    used: Vec<bool>,
    /// See [`Expansion::cancellations`].
    cancellations: usize,
}

/// The roots as a system of polynomials, each relation replacing the chosen square.
fn expand(
    graph: &Graph,
    relations: &[Vec<ExprId>],
    choice: &[usize],
    (roots, divisors): (&[ExprId], &[bool]),
    terms: &mut usize,
) -> Option<Expanded> {
    let mut expansion = Expansion::new(graph, terms);
    for (relation, &reduced) in relations.iter().zip(choice) {
        let others: Vec<_> = relation.iter().copied().filter(|&x| x != relation[reduced]).collect();
        expansion.relate(relation[reduced], &others)?;
    }
    let polynomials: Option<Vec<Rc<Polynomial>>> = roots.iter().map(|&root| expansion.of(root)).collect();
    let polynomials = polynomials?;
    let system = Sums::new(&expansion, &polynomials);
    let divisors = polynomials.iter().zip(divisors).filter(|(_, is_divisor)| **is_divisor);
    let cancellations = expansion.cancellations(divisors.map(|(divisor, _)| &**divisor));
    let pairs = relations.iter().zip(choice);
    let used = pairs.map(|(relation, &reduced)| expansion.was_used(relation[reduced])).collect();
    Some(Expanded { system, used, cancellations })
}

/// The cheapest of several ways of factoring, as far as the steps reach.
fn factored(system: &Sums, seeds: std::ops::Range<u64>, steps: &mut usize) -> Option<Form> {
    let forms = seeds.map_while(|seed| {
        let mut system = factor(system.clone(), seed, steps)?;
        rescale(&mut system);
        let cost = cost(&system);
        Some(Form { system, cost })
    });
    forms.reduce(|best, other| if other.cost < best.cost { other } else { best })
}

fn cost(system: &Sums) -> usize {
    let mut graph = Graph::new();
    let roots = system.build(&mut graph);
    Operations::recurring(&graph, &roots).total()
}

#[cfg(test)]
mod tests;
