//! The derivatives of the joint form ẋ = f(t, x): of the accelerations as they are solved, or of what they balance.
//!
//! With the force `r(x, u, t, u̇)` that is left along each rate, zero at the solution, and `M = −∂r/∂u̇`,
//!
//! ```text
//! ∂u̇/∂z = M⁻¹ ∂r/∂z     (u̇ held)
//! ```
//!
//! which differentiates no elimination and shares that of the accelerations. For small mechanisms what is solved may be
//! shorter. Both are written out, from within and from without, and the cheapest is taken.

use super::coordinates::Coordinates;
use super::dynamics::{JointDynamics, MAX_FACTORED, NORMAL_FORM};

use crate::derive::system::System;
use crate::expr::definitions::{Definitions, Expansion};
use crate::expr::differentiate::Direction;
use crate::expr::differentiate::{Derivative, gradient};
use crate::expr::graph::{ExprId, Graph, Node};
use crate::expr::symbol::Symbol;
use crate::simplify::cheapest::{Chosen, FinalPasses};
use crate::simplify::normal_form::normal_form;

/// Beyond this many rates expressions are not differentiated: a chain of skewed axes takes 16500 operations for six
/// rates and 29300 for eight. Larger trees go by recursion ([`super::large_jacobian`]); larger mechanisms with loops,
/// or with joints that are not made of turns and displacements, have no Jacobian.
const MAX_RATES: usize = 8;

/// The derivatives of f, row by row.
#[derive(Debug)]
pub struct Jacobian {
    /// By the joint state, then by time.
    pub by_state_and_time: Chosen,
    pub by_inputs: Chosen,
}

/// ∂f/∂(parameters), row by row.
#[derive(Debug)]
pub struct ParameterJacobian(pub Chosen);

/// The joint form, in terms of joint coordinates and rates.
pub struct JointForm<'a> {
    pub coordinates: &'a Coordinates,
    /// ẋ.
    pub rates: &'a [ExprId],
    /// u̇, in one way or several.
    pub accelerations: &'a [&'a [ExprId]],
    /// In terms of [`Symbol::RateOfRate`].
    pub power: Option<ExprId>,
    /// What u̇ is the solution of.
    pub balance: &'a JointDynamics,
    pub passes: FinalPasses,
}

impl JointForm<'_> {
    /// Whether rows depend on each other: what they yield is too long to be differentiated.
    fn is_long(&self) -> bool {
        !self.coordinates.loops.yielding.is_empty()
    }
}

/// The columns of a matrix.
pub type Columns = Vec<Vec<ExprId>>;

impl Jacobian {
    /// `None` if there are too many rates, or if the third derivative of a table's curve would be needed.
    pub fn derive(system: &mut System, form: &JointForm<'_>) -> Option<Self> {
        if form.is_long() {
            return None;
        }
        let layout = &form.coordinates.layout;
        let n_inputs = system.model.inputs.len();
        let state =
            (0..layout.n_coordinates).map(Symbol::Coordinate).chain((0..layout.n_rates).map(Symbol::Rate));
        let variables: Vec<_> = state.chain([Symbol::Time]).chain((0..n_inputs).map(Symbol::Input)).collect();
        let candidates = form.candidates(system, &variables)?;
        let rows = |graph: &mut Graph, of_rates: &Columns| form.rows(graph, &variables, of_rates);
        let graph = &mut system.graph;
        let (mut of_state, mut of_inputs) = (Vec::new(), Vec::new());
        let n = layout.n_coordinates + layout.n_rates;
        for (name, of_rates) in candidates {
            let mut rows = rows(graph, &of_rates);
            // Whole turns choose a branch of an angle: nothing changes with them.
            for row in &mut rows {
                layout.turns.iter().for_each(|&(_, x)| row[x] = Graph::ZERO);
            }
            // Nothing depends on the work that has been done.
            let work = rows.len() - n;
            let zeros = vec![Graph::ZERO; work];
            let by_state = rows.iter().flat_map(|row| row[..n].iter().chain(&zeros));
            let by_time = rows.iter().map(|row| &row[n]);
            of_state.push((name.clone(), by_state.chain(by_time).copied().collect::<Vec<_>>()));
            let by_inputs = rows.iter().flat_map(|row| &row[n + 1..]);
            of_inputs.push((name, by_inputs.copied().collect::<Vec<_>>()));
        }
        let jacobian = Self {
            by_state_and_time: form.choose(graph, of_state),
            by_inputs: form.choose(graph, of_inputs),
        };
        let roots = [&jacobian.by_state_and_time.roots[..], &jacobian.by_inputs.roots].concat();
        has_tables(graph, &roots).then_some(jacobian)
    }
}

impl ParameterJacobian {
    /// `None` in the same cases.
    pub fn derive(system: &mut System, form: &JointForm<'_>) -> Option<Self> {
        if form.is_long() {
            return None;
        }
        let variables: Vec<_> = (0..system.model.parameters.len()).map(Symbol::Parameter).collect();
        let candidates = form.candidates(system, &variables)?;
        let graph = &mut system.graph;
        let rows = candidates
            .into_iter()
            .map(|(name, of_rates)| (name, form.rows(graph, &variables, &of_rates).concat()))
            .collect();
        let chosen = form.choose(graph, rows);
        has_tables(graph, &chosen.roots).then_some(Self(chosen))
    }
}

/// Whether the derivatives of tables that expressions take are there: there are two.
pub fn has_tables(graph: &Graph, roots: &[ExprId]) -> bool {
    let is_third = |id| matches!(graph.node(id), Node::Symbol(Symbol::Table { order, .. }) if *order > 2);
    !graph.reachable(roots).into_iter().any(is_third)
}

impl JointForm<'_> {
    /// The cheapest candidate, which may also be the normal form of the cheapest.
    fn choose(&self, graph: &mut Graph, mut candidates: Vec<(String, Vec<ExprId>)>) -> Chosen {
        let cheapest = self.passes.cheapest(graph, candidates.clone()).roots;
        if self.coordinates.layout.n_rates <= MAX_FACTORED {
            let factored = normal_form(graph, &self.coordinates.unit, &cheapest);
            candidates.push((format!("{NORMAL_FORM} of that"), factored));
        }
        self.passes.cheapest(graph, candidates)
    }

    /// ∂u̇ by each variable, in several ways; `None` if the mechanism is too large.
    fn candidates(&self, system: &mut System, variables: &[Symbol]) -> Option<Vec<(String, Columns)>> {
        if self.coordinates.layout.n_rates > MAX_RATES {
            return self.by_recursion(system, variables);
        }
        Some(self.by_differentiation(system, variables))
    }

    fn by_differentiation(&self, system: &mut System, variables: &[Symbol]) -> Vec<(String, Columns)> {
        let graph = &mut system.graph;
        let mut candidates = Vec::new();
        for (form, of) in self.accelerations.iter().zip(["u̇", "u̇ in the bodies' frames"]) {
            candidates
                .push((format!("derivatives of {of}, from its leaves"), forward(graph, form, variables)));
            candidates
                .push((format!("derivatives of {of}, from its roots"), backward(graph, form, variables)));
        }
        // In loops the rates are no unknowns of the balance.
        if !self.coordinates.closure.rows.is_empty() {
            return candidates;
        }
        let rates_of_rates: Vec<_> = (0..self.coordinates.layout.n_rates)
            .map(|rate| system.graph.symbol(Symbol::RateOfRate(rate)))
            .collect();
        let left = self.balance.left_over(system, &rates_of_rates);
        let left = system.expanded(&self.coordinates.in_joints, &left);
        let unit = |k: usize| {
            (0..self.coordinates.layout.n_rates).map(move |l| if k == l { Graph::ONE } else { Graph::ZERO })
        };
        let units: Vec<_> = (0..self.coordinates.layout.n_rates).map(|k| unit(k).collect()).collect();
        let inverse = self.balance.accelerations_of(system, &units);
        let graph = &mut system.graph;
        let unbalanced = [forward(graph, &left, variables), backward(graph, &left, variables)];
        for (way, columns) in ["leaves", "roots"].into_iter().zip(unbalanced) {
            let solved = self.balance.accelerations_of(system, &columns);
            let solved = self.finished(system, &solved);
            candidates.push((format!("derivatives of the balance, from its {way}, recursion"), solved));
            let inverse = self.finished(system, &inverse);
            let columns = self.finished(system, &columns);
            let graph = &mut system.graph;
            let solved = columns.iter().map(|column| weighted(graph, &inverse, column)).collect();
            candidates.push((format!("derivatives of the balance, from its {way}, by M⁻¹"), solved));
            if self.coordinates.layout.n_rates <= MAX_FACTORED {
                let solved = self.balance.factored_accelerations_of(
                    system,
                    (&self.coordinates.in_joints, &self.coordinates.unit),
                    &columns,
                );
                let solved = self.finished(system, &solved);
                candidates
                    .push((format!("derivatives of the balance, from its {way}, {NORMAL_FORM}"), solved));
            }
        }
        candidates
    }

    /// With u̇ for the symbols that stand for it.
    fn at_accelerations(&self, graph: &mut Graph, roots: &[ExprId]) -> Vec<ExprId> {
        let by_rate = |(rate, &value): (usize, &ExprId)| (Symbol::RateOfRate(rate), value);
        let (definitions, values) =
            (Definitions::default(), self.accelerations[0].iter().enumerate().map(by_rate).collect());
        Expansion::with_values(&definitions, values).all(graph, roots)
    }

    /// The same of columns in which the elimination is yet to be expanded.
    fn finished(&self, system: &mut System, columns: &Columns) -> Columns {
        let expand = |column: &Vec<ExprId>| {
            let column = system.expanded(&self.coordinates.in_joints, column);
            self.at_accelerations(&mut system.graph, &column)
        };
        columns.iter().map(expand).collect()
    }

    /// The rows of ∂f, from the columns of ∂u̇.
    fn rows(&self, graph: &mut Graph, variables: &[Symbol], of_rates: &Columns) -> Vec<Vec<ExprId>> {
        let row_of_rate = |rate: usize| of_rates.iter().map(|column| column[rate]).collect::<Vec<_>>();
        let mut rows: Vec<_> = self.rates.iter().map(|&root| gradient(graph, root, variables)).collect();
        rows.extend((0..self.coordinates.layout.n_rates).map(row_of_rate));
        if let Some(power) = self.power {
            rows.push(self.row_of_power(graph, power, variables, of_rates));
        }
        rows
    }

    /// The power may depend on u̇.
    fn row_of_power(
        &self,
        graph: &mut Graph,
        power: ExprId,
        variables: &[Symbol],
        of_rates: &Columns,
    ) -> Vec<ExprId> {
        let rates_of_rates: Vec<_> = (0..self.coordinates.layout.n_rates).map(Symbol::RateOfRate).collect();
        let mut row = gradient(graph, power, variables);
        let by_rates = gradient(graph, power, &rates_of_rates);
        for (entry, column) in row.iter_mut().zip(of_rates) {
            for (&by_rate, &of_rate) in by_rates.iter().zip(column) {
                let product = graph.mul(by_rate, of_rate);
                *entry = graph.add(*entry, product);
            }
        }
        self.at_accelerations(graph, &row)
    }
}

/// The sum of some columns, each with its weight.
fn weighted(graph: &mut Graph, columns: &Columns, weights: &[ExprId]) -> Vec<ExprId> {
    let mut sum = vec![Graph::ZERO; weights.len()];
    for (column, &weight) in columns.iter().zip(weights) {
        for (sum, &entry) in sum.iter_mut().zip(column) {
            let product = graph.mul(entry, weight);
            *sum = graph.add(*sum, product);
        }
    }
    sum
}

/// One variable after the other.
pub fn forward(graph: &mut Graph, roots: &[ExprId], variables: &[Symbol]) -> Vec<Vec<ExprId>> {
    let definitions = Definitions::default();
    let column = |&variable: &Symbol| {
        let mut derivative = Derivative::new(&definitions, Direction::from([(variable, Graph::ONE)]));
        roots.iter().map(|&root| derivative.of(graph, root)).collect()
    };
    variables.iter().map(column).collect()
}

/// One root after the other.
fn backward(graph: &mut Graph, roots: &[ExprId], variables: &[Symbol]) -> Columns {
    let rows: Vec<_> = roots.iter().map(|&root| gradient(graph, root, variables)).collect();
    (0..variables.len()).map(|column| rows.iter().map(|row| row[column]).collect()).collect()
}
