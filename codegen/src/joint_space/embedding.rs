//! How all rates of the tree accelerate in terms of fewer unknowns: `u̇ = B z + b` (constraint embedding: A. Jain,
//! *Multibody graph transformations and analysis, Part II*, Nonlinear Dynamics 67 (2012)).
//!
//! A rate of an open tree is an unknown of its own. One that a coupler or a driver determines follows others or time;
//! those of a loop follow a null space of its rows.

use super::determined::place_of;
use super::layout::Layout;
use super::relation::{Relation, linear};
use crate::derive::system::System;
use crate::expr::definitions::Values;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::symbol::Symbol;
use crate::solve::gram_schmidt::Armature;

/// `B` and `b`, row by row.
#[derive(Clone, Debug)]
pub struct Embedding {
    /// Of each rate of the tree.
    pub rates: Vec<RateMotion>,
    pub n_unknowns: usize,
}

/// How a rate accelerates.
#[derive(Clone, Debug)]
pub struct RateMotion {
    /// Unknowns with their factors.
    pub columns: Vec<(usize, ExprId)>,
    /// The acceleration if all unknowns are zero.
    pub bias: ExprId,
}

impl Embedding {
    /// Every rate is an unknown.
    pub fn identity(n_rates: usize) -> Self {
        let rate = |unknown| RateMotion { columns: vec![(unknown, Graph::ONE)], bias: Graph::ZERO };
        Self { rates: (0..n_rates).map(rate).collect(), n_unknowns: n_rates }
    }

    /// A new unknown.
    pub fn unknown(&mut self) -> usize {
        self.n_unknowns += 1;
        self.n_unknowns - 1
    }

    /// The same with the rates that are determined, behind those of the state.
    pub fn with_determined(mut self, system: &mut System, layout: &Layout, values: &Values) -> Self {
        let embedding = &mut self;
        for known in &layout.determined {
            let place = place_of(layout, known.coordinate);
            let motion = match known.by {
                Relation::Driver(_) | Relation::Held(_) => {
                    RateMotion { columns: Vec::new(), bias: values[&Symbol::RateOfRate(place.u)] }
                }
                Relation::Forward(coupler) | Relation::Backward(coupler) => {
                    let source = known.by.source(system.model).expect("a coupler has two coordinates");
                    let ratio = system.number(linear(system.model, coupler).1);
                    let graph = &mut system.graph;
                    let ratio =
                        if matches!(known.by, Relation::Forward(_)) { ratio } else { graph.recip(ratio) };
                    embedding.rates[place_of(layout, source).u].scaled(graph, ratio)
                }
            };
            debug_assert_eq!(embedding.rates.len(), place.u, "determined rates come in their order");
            embedding.rates.push(motion);
        }
        self
    }

    /// The accelerations of all rates of the tree if all unknowns are zero.
    pub fn biases(&self) -> Vec<ExprId> {
        self.rates.iter().map(|motion| motion.bias).collect()
    }

    /// The accelerations of all rates of the tree.
    pub fn rates_of_rates(&self, graph: &mut Graph, unknowns: &[ExprId]) -> Vec<ExprId> {
        let rate = |motion: &RateMotion| {
            motion.columns.iter().fold(motion.bias, |sum, &(unknown, factor)| {
                let part = graph.mul(factor, unknowns[unknown]);
                graph.add(part, sum)
            })
        };
        self.rates.iter().map(rate).collect()
    }

    /// The inertias that turn with rates of the tree, with the unknowns that turn them.
    pub fn armatures(&self, along: &[ExprId]) -> Vec<Armature> {
        let with = along.iter().zip(&self.rates).filter(|(inertia, _)| **inertia != Graph::ZERO);
        with.map(|(&inertia, motion)| (inertia, motion.columns.clone())).collect()
    }

    /// The force along each unknown, from those along the rates of the tree.
    pub fn projected(&self, graph: &mut Graph, forces: &[ExprId]) -> Vec<ExprId> {
        let mut along = vec![Graph::ZERO; self.n_unknowns];
        for (motion, &force) in self.rates.iter().zip(forces) {
            for &(unknown, factor) in &motion.columns {
                let part = graph.mul(factor, force);
                along[unknown] = graph.add(along[unknown], part);
            }
        }
        along
    }
}

impl RateMotion {
    fn scaled(&self, graph: &mut Graph, by: ExprId) -> Self {
        let columns = self.columns.iter().map(|&(unknown, factor)| (unknown, graph.mul(by, factor)));
        Self { columns: columns.collect(), bias: graph.mul(by, self.bias) }
    }
}
