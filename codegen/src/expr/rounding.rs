//! How far rounding takes expressions from their values: what is compared before a form is taken.
//!
//! Each operation is given a random sign times one unit of rounding, and what that makes of the roots is followed to
//! first order, in several lanes at once. The root of the mean square over the lanes is the error that independent
//! roundings make, with all correlations: what cancels again downstream does not count. (Monte Carlo arithmetic, of
//! D. S. Parker (1997), but linearised: no rounding mode is set, and no error is so large that it hides another.)

use crate::expr::by_expr::ByExpr;
use crate::expr::domains::{POINTS, mix};
use crate::expr::elementary;
use crate::expr::graph::{ExprId, Graph, Node};
use gyro_program::elementary::Function;

/// How many samples an error is made of.
const LANES: usize = 8;

/// Of long functions fewer points are tried: so many operations altogether, and no fewer points than this.
const LONG: usize = 40_000;
const FEWEST: u32 = 6;

/// An error that is larger than another by no more than this factor counts as equal.
pub const LIKE: f64 = 10.0;

/// The errors of some roots at all points of the graph's domains, in terms of the unit of rounding.
#[derive(Clone, Debug)]
struct Errors(Vec<Vec<f64>>);

/// A value with what rounding makes of it.
#[derive(Clone, Copy)]
struct Rounded {
    value: f64,
    errors: [f64; LANES],
}

impl Errors {
    /// Of each form as it is written. An error is at least a rounding of the result.
    fn of(graph: &Graph, forms: &[&[ExprId]]) -> Vec<Self> {
        // Together: forms have much in common.
        let order = graph.reachable(&forms.concat());
        let places: ByExpr<usize> = order.iter().enumerate().map(|(place, &id)| (id, place)).collect();
        let steps: Vec<_> = order.iter().map(|&id| Step::of(graph, id, &places)).collect();
        let mut found = vec![Self(Vec::new()); forms.len()];
        let mut values = Vec::with_capacity(steps.len());
        for point in 0..n_points(steps.len()) {
            values.clear();
            for step in &steps {
                let next = step.rounded(graph, point, &values);
                values.push(next);
            }
            for (form, errors) in forms.iter().zip(&mut found) {
                errors.0.push(form.iter().map(|root| values[places[*root]].error()).collect());
            }
        }
        found
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
    operands: [usize; 2],
    constant: f64,
    /// A sign for each lane, if the result is rounded.
    signs: Option<[f64; LANES]>,
}

impl<'g> Step<'g> {
    fn of(graph: &'g Graph, id: ExprId, places: &ByExpr<usize>) -> Self {
        let node = graph.node(id);
        let mut operands = node.operands().map(|operand| places[operand]);
        let first = operands.next().unwrap_or(0);
        let scales = |operand| graph.as_constant(operand).is_some_and(|constant| constant.is_power_of_two());
        let is_exact = match node {
            Node::Constant(constant) => constant.is_double(),
            Node::Symbol(_) | Node::Neg(_) => true,
            Node::Mul(a, b) => scales(*a) || scales(*b),
            Node::Call(Function::Abs | Function::Floor, _) => true,
            _ => false,
        };
        let bits = mix(id.place() as u64);
        let sign = |lane: usize| if bits >> lane & 1 == 1 { 1.0 } else { -1.0 };
        Self {
            node,
            operands: [first, operands.next().unwrap_or(0)],
            constant: if let Node::Constant(constant) = node { constant.to_f64() } else { 0.0 },
            signs: (!is_exact).then(|| std::array::from_fn(sign)),
        }
    }

    fn rounded(&self, graph: &Graph, point: u32, values: &[Rounded]) -> Rounded {
        let none = Rounded { value: 0.0, errors: [0.0; LANES] };
        let [a, b] = self.operands.map(|place| values.get(place).unwrap_or(&none));
        let (x, y) = (a.value, b.value);
        // What is not taken may be infinite, and its error, too.
        if let Node::Call(function @ (Function::When | Function::Unless), _) = *self.node {
            let taken = |of| elementary::value(function, [x, of]);
            return Rounded { value: taken(y), errors: b.errors.map(taken) };
        }
        // The value, and its derivatives by both operands.
        let (value, [by_a, by_b]) = match self.node {
            Node::Constant(_) => (self.constant, [0.0, 0.0]),
            Node::Symbol(symbol) => (graph.domains.value(*symbol, point), [0.0, 0.0]),
            Node::Add(..) => (x + y, [1.0, 1.0]),
            Node::Mul(..) => (x * y, [y, x]),
            Node::Neg(_) => (-x, [-1.0, 0.0]),
            Node::Recip(_) => (x.recip(), [-x.recip().powi(2), 0.0]),
            Node::Call(function, _) => {
                let value = elementary::value(*function, [x, y]);
                (value, elementary::slopes_at(*function, [x, y], value))
            }
        };
        let errors = std::array::from_fn(|lane| {
            let own = self.signs.map_or(0.0, |signs| signs[lane] * value);
            by_a * a.errors[lane] + by_b * b.errors[lane] + own
        });
        Rounded { value, errors }
    }
}

impl Rounded {
    fn error(&self) -> f64 {
        let square = self.errors.iter().map(|error| error * error).sum::<f64>();
        #[expect(clippy::cast_precision_loss, reason = "a small number")]
        let mean = square / LANES as f64;
        let error = mean.sqrt();
        if error.is_finite() { error.max(self.value.abs()) } else { f64::INFINITY }
    }
}
