//! How far rounding takes expressions from their values: what is compared before a form is taken.
//!
//! To first order an error is the sum of what becomes of each operation's rounding. If roundings are independent, of
//! one unit each, its mean square is the sum of squares of the operations' values times the root's derivatives by them.
//! One sweep from the root back to its operands gives all of these (S. Linnainmaa, BIT 16 (1976), whose purpose it
//! was), with all correlations: what cancels again downstream does not count. Nothing is drawn, so an error depends on
//! the root alone, not on what else has been derived before it.

use crate::expr::by_expr::ByExpr;
use crate::expr::calls;
use crate::expr::domains::POINTS;
use crate::expr::graph::{ExprId, Graph, Node};
use gyro_program::elementary::Function;

/// Of long functions fewer points are tried: so many operations altogether, and no fewer points than this.
const LONG: usize = 40_000;
const FEWEST: u32 = 6;

/// An error that is larger than another by no more than this factor counts as equal.
pub const LIKE: f64 = 10.0;

/// The errors of some roots at all points of the graph's domains, in terms of the unit of rounding.
#[derive(Clone, Debug)]
struct Errors(Vec<Vec<f64>>);

impl Errors {
    /// Of each form as it is written. An error is at least a rounding of the result.
    fn of(graph: &Graph, forms: &[&[ExprId]]) -> Vec<Self> {
        // Together: forms have much in common, whole roots among it.
        let roots = forms.concat();
        let computed = Computed::of(graph, &roots);
        let mut known = ByExpr::default();
        for root in roots {
            if !known.contains(root) {
                known.insert(root, computed.errors(root));
            }
        }
        let at = |form: &[ExprId], point: usize| form.iter().map(|&root| known[root][point]).collect();
        let of = |form: &&[ExprId]| Self((0..computed.at.len()).map(|point| at(form, point)).collect());
        forms.iter().map(of).collect()
    }

    /// The least of two errors, everywhere.
    fn least(mut self, other: &Self) -> Self {
        let all = self.0.iter_mut().flatten().zip(other.0.iter().flatten());
        all.for_each(|(error, other)| *error = error.min(*other));
        self
    }

    /// The largest quotient of errors and those of `least`. What is small beside the function's largest error at a
    /// point counts as that.
    fn growth(&self, least: &Self) -> f64 {
        let mut growth = 1.0_f64;
        for (errors, least) in self.0.iter().zip(&least.0) {
            let known = || errors.iter().zip(least).filter(|(_, least)| least.is_finite());
            let allowed = known().map(|(_, &least)| least).fold(0.0, f64::max);
            for (error, _) in known().filter(|_| allowed > 0.0) {
                growth = growth.max(error / allowed);
            }
        }
        growth
    }
}

/// How many points are tried of so many operations.
fn n_points(n_operations: usize) -> u32 {
    let n = LONG / n_operations.max(1);
    u32::try_from(n).map_or(POINTS, |n| n.clamp(FEWEST, POINTS))
}

/// Which form is taken: the cheapest of those that round nearly as well as the best one does, at every point; if there
/// is none, the one that comes nearest to that.
pub fn choose<C: Ord>(graph: &Graph, forms: &[&[ExprId]], cost: impl Fn(usize) -> C) -> usize {
    if forms.len() == 1 {
        return 0;
    }
    let errors = Errors::of(graph, forms);
    let least = errors[1..].iter().fold(errors[0].clone(), Errors::least);
    let growths: Vec<_> = errors.iter().map(|errors| errors.growth(&least)).collect();
    let best = growths.iter().copied().fold(f64::INFINITY, f64::min);
    let admitted = (0..forms.len()).filter(|&form| growths[form] <= best.max(LIKE));
    admitted.min_by_key(|&form| cost(form)).expect("the best is admitted")
}

/// Whether a form rounds nearly as well as the better of it and another one.
pub fn rounds_well(graph: &Graph, form: &[ExprId], other: &[ExprId]) -> bool {
    choose(graph, &[form, other], |place| place) == 0
}

/// An operation with the places of its operands.
struct Step<'g> {
    node: &'g Node,
    operands: [Option<usize>; 2],
    constant: f64,
    /// Whether the result is not rounded.
    is_exact: bool,
}

impl<'g> Step<'g> {
    fn of(graph: &'g Graph, id: ExprId, places: &ByExpr<usize>) -> Self {
        let node = graph.node(id);
        let mut operands = node.operands().map(|operand| places[operand]);
        let scales = |operand| graph.as_constant(operand).is_some_and(|constant| constant.is_power_of_two());
        let is_exact = match node {
            Node::Constant(constant) => constant.is_double(),
            Node::Symbol(_) | Node::Neg(_) => true,
            Node::Mul(a, b) => scales(*a) || scales(*b),
            Node::Call(Function::Abs | Function::Floor | Function::When | Function::Unless, _) => true,
            _ => false,
        };
        Self {
            node,
            operands: [operands.next(), operands.next()],
            constant: if let Node::Constant(constant) = node { constant.to_f64() } else { 0.0 },
            is_exact,
        }
    }

    fn evaluated(&self, graph: &Graph, point: u32, before: &[Evaluated]) -> Evaluated {
        let [x, y] = self.operands.map(|place| place.map_or(0.0, |place| before[place].value));
        let (value, slopes) = match self.node {
            Node::Constant(_) => (self.constant, [0.0, 0.0]),
            Node::Symbol(symbol) => (graph.domains.value(*symbol, point), [0.0, 0.0]),
            Node::Add(..) => (x + y, [1.0, 1.0]),
            Node::Mul(..) => (x * y, [y, x]),
            Node::Neg(_) => (-x, [-1.0, 0.0]),
            Node::Recip(_) => (x.recip(), [-x.recip().powi(2), 0.0]),
            Node::Call(function, _) => {
                let value = calls::value(&graph.domains, *function, [x, y]);
                (value, calls::slopes(&graph.domains, *function, [x, y], value))
            }
        };
        Evaluated { value, slopes }
    }
}

/// The value of an operation, and its derivatives by both operands.
#[derive(Clone, Copy)]
struct Evaluated {
    value: f64,
    slopes: [f64; 2],
}

/// Operations, evaluated at all points.
struct Computed<'g> {
    places: ByExpr<usize>,
    /// Operands first.
    steps: Vec<Step<'g>>,
    at: Vec<Vec<Evaluated>>,
}

impl<'g> Computed<'g> {
    fn of(graph: &'g Graph, roots: &[ExprId]) -> Self {
        let order = graph.reachable(roots);
        let places: ByExpr<usize> = order.iter().enumerate().map(|(place, &id)| (id, place)).collect();
        let steps: Vec<_> = order.iter().map(|&id| Step::of(graph, id, &places)).collect();
        let at = |point| {
            let mut all = Vec::with_capacity(steps.len());
            for step in &steps {
                all.push(step.evaluated(graph, point, &all));
            }
            all
        };
        let at = (0..n_points(steps.len())).map(at).collect();
        Self { places, steps, at }
    }

    /// The errors of a root, at all points.
    fn errors(&self, root: ExprId) -> Vec<f64> {
        let way = self.way(self.places[root]);
        let mut slopes = vec![0.0; way[0] + 1];
        let error = |all: &Vec<Evaluated>| {
            let error = self.mean_square(&way, all, &mut slopes).sqrt();
            if error.is_finite() { error.max(all[way[0]].value.abs()) } else { f64::INFINITY }
        };
        self.at.iter().map(error).collect()
    }

    /// A place, then those of all that it depends on, backwards.
    fn way(&self, from: usize) -> Vec<usize> {
        let mut is_needed = vec![false; from + 1];
        is_needed[from] = true;
        let mut way = Vec::new();
        for place in (0..=from).rev() {
            if is_needed[place] {
                way.push(place);
                for operand in self.steps[place].operands.into_iter().flatten() {
                    is_needed[operand] = true;
                }
            }
        }
        way
    }

    /// The mean square of the error of the first of these operations; in `slopes` its derivatives by them are made.
    fn mean_square(&self, way: &[usize], all: &[Evaluated], slopes: &mut [f64]) -> f64 {
        way.iter().for_each(|&place| slopes[place] = 0.0);
        slopes[way[0]] = 1.0;
        let mut square = 0.0;
        for &place in way {
            let (step, slope) = (&self.steps[place], slopes[place]);
            // What is not taken may be infinite.
            if slope == 0.0 {
                continue;
            }
            if !step.is_exact {
                square += (slope * all[place].value).powi(2);
            }
            for (operand, by_operand) in step.operands.into_iter().zip(all[place].slopes) {
                if let Some(operand) = operand {
                    slopes[operand] += slope * by_operand;
                }
            }
        }
        square
    }
}

#[cfg(test)]
mod tests;
