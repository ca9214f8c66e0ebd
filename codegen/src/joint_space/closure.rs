//! The joints that close loops, in joint coordinates: their rows, what the rates change them by, and how fast that
//! itself changes.

use super::embedding::Embedding;
use super::layout::{Layout, Place};
use super::relation::Relation;
use super::whole_angles::WholeAngles;
use crate::derive::frames::sine_and_cosine;
use crate::derive::in_time::in_time;
use crate::derive::system::System;
use crate::expr::definitions::{Definitions, Expansion, Values};
use crate::expr::differentiate::{Derivative, Direction};
use crate::expr::graph::{ExprId, Graph, Node};
use crate::expr::symbol::Symbol;
use crate::simplify::normal_form::{normal_form, vanishes};
use gyro_model::{Model, RowOwner};
use std::array::from_fn;
use std::collections::{BTreeMap, BTreeSet};

/// `Φ_c(t, x) = 0`, in terms of joint coordinates and of the sines and cosines of angles.
#[derive(Clone, Debug, Default)]
pub struct Closure {
    /// By their places among all rows.
    pub rows: Vec<usize>,
    pub phi: Vec<ExprId>,
    /// How many of them are of velocities: their Φ counts as zero.
    pub n_of_velocities: usize,
    /// J, by rows: a number for each rate of the state.
    pub jacobian: Vec<Vec<ExprId>>,
    /// `Φ̇ = J u − ν`.
    pub residual: Vec<ExprId>,
    /// `J u̇ = γ`.
    pub gamma: Vec<ExprId>,
    /// The rows that hold coordinates.
    pub holding: Vec<usize>,
    /// Of all rows, then of those that hold coordinates, the derivative by each determined rate, others being what they
    /// are.
    pub by_determined: Vec<Vec<ExprId>>,
}

/// The rows of joints that close loops and of the couplers and drivers `beside` them, those that vanish left out.
pub fn rows(
    system: &mut System,
    (phi, beside): (&[ExprId], &[RowOwner]),
    (layout, angles): (&Layout, &WholeAngles),
    unit: &[Vec<ExprId>],
) -> Vec<(usize, ExprId)> {
    let owners = system.tree.loop_joints.iter().map(|&joint| RowOwner::Joint(joint));
    let owners = owners.chain(beside.iter().copied());
    let mut rows: Vec<_> = owners.flat_map(|owner| system.model.rows_of(owner)).collect();
    rows.sort_unstable();
    let phi: Vec<_> = rows.iter().map(|&row| phi[row]).collect();
    let phi = system.expanded(&angles.poses, &phi);
    let held = all_held(system, layout);
    let phi = system.expanded(&held, &phi);
    let phi = normal_form(&mut system.graph, unit, &phi);
    let graph = &mut system.graph;
    rows.into_iter().zip(phi).filter(|&(_, row)| !vanishes(graph, unit, row)).collect()
}

/// The values of all coordinates that loops hold; angles that x counts stay symbols.
pub fn all_held(system: &mut System, layout: &Layout) -> Values {
    let scalars = layout.links.iter().flat_map(|link| &link.scalars);
    let held = scalars.filter(|scalar| layout.is_held(scalar.place.x));
    let mut values: Values = held.flat_map(|scalar| held_at_zero(scalar.place)).collect();
    for &(on, _) in &layout.turns {
        let angle = Symbol::Angle(system.turn_of(on));
        values.insert(angle, system.graph.symbol(angle));
    }
    values
}

/// The place of the scalar coordinate that a row alone determines, which is zero.
pub fn held_by(graph: &mut Graph, layout: &Layout, row: ExprId) -> Option<Place> {
    let mut places = Vec::new();
    for id in graph.reachable(&[row]) {
        let Node::Symbol(symbol) = *graph.node(id) else { continue };
        match symbol {
            Symbol::Coordinate(x) | Symbol::Sine(x) | Symbol::Cosine(x) => places.push(x),
            Symbol::Parameter(_) => {}
            _ => return None,
        }
    }
    places.dedup();
    let [x] = places[..] else { return None };
    let scalar = layout.scalars().find(|scalar| scalar.place.x == x)?;
    let zero = Values::from_iter(held_at_zero(scalar.place));
    let definitions = Definitions::default();
    let at_zero = Expansion::with_values(&definitions, zero).of(graph, row);
    (at_zero == Graph::ZERO).then_some(scalar.place)
}

/// What a coordinate that is zero gives.
pub fn held_at_zero(place: Place) -> [(Symbol, ExprId); 5] {
    let (x, u) = (place.x, place.u);
    [
        (Symbol::Coordinate(x), Graph::ZERO),
        (Symbol::Rate(u), Graph::ZERO),
        (Symbol::RateOfRate(u), Graph::ZERO),
        (Symbol::Sine(x), Graph::ZERO),
        (Symbol::Cosine(x), Graph::ONE),
    ]
}

impl Closure {
    /// `embedding` says how the determined rates follow those of the state, `own` are the rows of velocities.
    pub fn derive(
        system: &mut System,
        rows: Vec<(usize, ExprId)>,
        (layout, angles): (&Layout, &WholeAngles),
        (embedding, own): (&Embedding, &BTreeMap<usize, ExprId>),
        unit: &[Vec<ExprId>],
    ) -> Self {
        let mut rows = rows;
        rows.extend(own.keys().map(|&row| (row, Graph::ZERO)));
        rows.sort_unstable_by_key(|&(row, _)| row);
        if rows.is_empty() {
            return Self::default();
        }
        let (rows, phi): (Vec<_>, Vec<_>) = rows.into_iter().unzip();
        let definitions = counted_angles(system, layout, angles);
        let directions = Directions { layout, angles, embedding };
        let graph = &mut system.graph;
        let mut jacobian = vec![Vec::new(); rows.len()];
        for rate in 0..layout.n_rates {
            let column = directions.column(graph, &definitions, (&rows, &phi, own), rate);
            jacobian.iter_mut().zip(column).for_each(|(row, entry)| row.push(entry));
        }
        let motion = directions.of_motion(graph, system.model);
        let mut derivative = Derivative::new(&definitions, motion);
        let residual = rows.iter().zip(&phi);
        let residual =
            residual.map(|(row, &phi)| own.get(row).copied().unwrap_or_else(|| derivative.of(graph, phi)));
        let residual: Vec<_> = residual.collect();
        let residual = normal_form(graph, unit, &residual);
        let motion = directions.of_motion(graph, system.model);
        let mut derivative = Derivative::new(&definitions, motion);
        let gamma: Vec<_> = residual
            .iter()
            .map(|&row| {
                let row = derivative.of(graph, row);
                graph.neg(row)
            })
            .collect();
        // Together: what they have in common is found.
        let all = [&jacobian.concat()[..], &gamma].concat();
        let all = normal_form(graph, unit, &all);
        let (entries, gamma) = all.split_at(rows.len() * layout.n_rates);
        let jacobian = entries.chunks(layout.n_rates.max(1)).map(<[_]>::to_vec).collect();
        let n_of_velocities = own.len();
        Self { rows, phi, n_of_velocities, jacobian, residual, gamma: gamma.to_vec(), ..Self::default() }
    }

    /// The rates that change some rows.
    pub fn rates_of(&self, rows: &[usize]) -> BTreeSet<usize> {
        let entries = rows.iter().flat_map(|&row| self.jacobian[row].iter().enumerate());
        entries.filter(|(_, entry)| **entry != Graph::ZERO).map(|(rate, _)| rate).collect()
    }

    /// With the derivatives by the determined rates; `phi` are all rows, `angles` those of which none is held.
    pub fn with_determined(
        mut self,
        system: &mut System,
        phi: &[ExprId],
        (layout, angles): (&Layout, &WholeAngles),
        own: &BTreeMap<usize, ExprId>,
    ) -> Self {
        let held = layout.determined.iter().filter_map(|known| match known.by {
            Relation::Held(row) => Some(row),
            _ => None,
        });
        self.holding = held.collect();
        let rows: Vec<_> = self.rows.iter().chain(&self.holding).copied().collect();
        let phi: Vec<_> = rows.iter().map(|&row| phi[row]).collect();
        let phi = system.expanded(&angles.poses, &phi);
        self.by_determined = vec![Vec::new(); rows.len()];
        let every = Embedding::identity(layout.n_tree_rates());
        let directions = Directions { layout, angles, embedding: &every };
        let definitions = counted_angles(system, layout, angles);
        for rate in layout.n_rates..layout.n_tree_rates() {
            let column = directions.column(&mut system.graph, &definitions, (&rows, &phi, own), rate);
            let held = all_held(system, layout);
            let column = system.expanded(&held, &column);
            self.by_determined.iter_mut().zip(column).for_each(|(row, entry)| row.push(entry));
        }
        self
    }
}

/// The angles of cut joints whose turns x counts, by their sines and cosines.
fn counted_angles(system: &mut System, layout: &Layout, angles: &WholeAngles) -> Definitions {
    let mut definitions = Definitions::default();
    for &(on, _) in &layout.turns {
        let (frames, kind) = (system.joints[on.joint], system.model.coordinate_kind(on));
        let (sine, cosine) = sine_and_cosine(&mut system.graph, kind, &frames, &frames.relative);
        let [sine, cosine] = [sine, cosine].map(|part| system.expanded(&angles.poses, &[part])[0]);
        let turn = system.turn_of(on);
        let angle = system.graph.symbol(Symbol::Angle(turn));
        definitions.insert_angle(turn, angle, (sine, cosine));
    }
    definitions
}

/// Along which the rows are differentiated.
pub struct Directions<'a> {
    pub layout: &'a Layout,
    pub angles: &'a WholeAngles,
    pub embedding: &'a Embedding,
}

impl Directions<'_> {
    /// The derivatives of some rows by a rate: by where it leads, or of rows of velocities by itself.
    fn column(
        &self,
        graph: &mut Graph,
        definitions: &Definitions,
        (rows, phi, own): (&[usize], &[ExprId], &BTreeMap<usize, ExprId>),
        rate: usize,
    ) -> Vec<ExprId> {
        let (led, alone) = (self.of_rate(graph, rate), self.of_rate_alone(graph, rate));
        let mut by_place = Derivative::new(definitions, led);
        let mut by_rate = Derivative::new(definitions, alone);
        let of = |(row, &phi): (&usize, &ExprId)| match own.get(row) {
            Some(&own) => by_rate.of(graph, own),
            None => by_place.of(graph, phi),
        };
        rows.iter().zip(phi).map(of).collect()
    }

    /// One rate of the state is one, all others are zero, and time stands still.
    fn of_rate(&self, graph: &mut Graph, rate: usize) -> Direction {
        let by_rate = self.by_rate(graph, rate);
        self.along(graph, |_, u| by_rate[u])
    }

    /// The rates alone change, one of the state by one: what is differentiated may have rates of the sums, too, which
    /// are symbols of their own.
    pub fn of_rate_alone(&self, graph: &mut Graph, rate: usize) -> Direction {
        let by_rate = self.by_rate(graph, rate).into_iter().enumerate();
        by_rate.filter(|(_, by)| *by != Graph::ZERO).map(|(u, by)| (Symbol::Rate(u), by)).collect()
    }

    /// The derivatives of the tree's rates, and of the rates of the sums behind them, by a rate of the state.
    fn by_rate(&self, graph: &mut Graph, rate: usize) -> Vec<ExprId> {
        let of = |u: usize| {
            let columns = self.embedding.rates.get(u).map_or(&[][..], |motion| &motion.columns);
            columns.iter().find(|(unknown, _)| *unknown == rate).map_or(Graph::ZERO, |column| column.1)
        };
        let mut all: Vec<_> = (0..self.layout.n_tree_rates()).map(of).collect();
        for (_, sum) in self.angles.places() {
            all.push(sum.sum(graph, |_, place| of(place.u)));
        }
        all
    }

    /// All rates as they are, and constant but for what time changes.
    pub fn of_motion(&self, graph: &mut Graph, model: &Model) -> Direction {
        let mut direction = self.along(graph, |graph, u| graph.symbol(Symbol::Rate(u)));
        direction.extend(in_time(graph, model));
        let rates = &self.embedding.rates;
        direction.extend(rates.iter().enumerate().map(|(u, motion)| (Symbol::Rate(u), motion.bias)));
        for (place, sum) in self.angles.places() {
            let bias = sum.sum(graph, |_, place| rates[place.u].bias);
            direction.insert(Symbol::Rate(place.u), bias);
        }
        direction
    }

    fn along(&self, graph: &mut Graph, rate: impl Fn(&mut Graph, usize) -> ExprId) -> Direction {
        let mut direction = Direction::new();
        let scalars = self.layout.links.iter().flat_map(|link| &link.scalars);
        let angles = scalars.clone().filter(|scalar| scalar.kind.is_angle()).map(|scalar| scalar.place);
        for Place { x, u } in angles.chain(self.angles.places().map(|(place, _)| place)) {
            let rate = rate(graph, u);
            let [sine, cosine] = [Symbol::Sine(x), Symbol::Cosine(x)].map(|symbol| graph.symbol(symbol));
            let (of_sine, of_cosine) = (graph.mul(cosine, rate), graph.mul(sine, rate));
            direction.insert(Symbol::Sine(x), of_sine);
            direction.insert(Symbol::Cosine(x), graph.neg(of_cosine));
        }
        for Place { x, u } in scalars.map(|scalar| scalar.place) {
            direction.insert(Symbol::Coordinate(x), rate(graph, u));
        }
        for link in &self.layout.links {
            if let Some(place) = link.position {
                direction.extend((0..3).map(|k| (Symbol::Coordinate(place.x + k), rate(graph, place.u + k))));
            }
            if let Some(place) = link.orientation {
                let p = from_fn(|k| graph.symbol(Symbol::Unit(place.x + k)));
                let w = from_fn(|k| rate(graph, place.u + k));
                let rates = graph.euler_rate(&p, &w);
                direction.extend((0..4).map(|k| (Symbol::Unit(place.x + k), rates[k])));
            }
        }
        direction
    }
}
