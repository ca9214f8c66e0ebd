//! What is read off a joint state: the outputs of the model file, and how its frames move.
//!
//! A frame is what an output of kind `velocity` names: a point of a body, with the velocity `(ṡ, w')`, of the point in
//! the global frame and of the body in its own. That is `J(x) u` and what prescribed motions contribute; its derivative
//! is `J u̇` and the bias that is left at `u̇ = 0`.

use super::coordinates::Coordinates;
use super::jacobian::{forward, has_tables};
use super::{maps, motions, multipliers};
use crate::derive::Textbook;
use crate::derive::outputs::{self, Sources};
use crate::derive::points;
use crate::derive::system::System;
use crate::expr::definitions::Values;
use crate::expr::differentiate::gradient;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::symbol::Symbol;
use crate::simplify::cheapest::{Chosen, FinalPasses};
use gyro_model::{BodyFrame, OutputKind};
use motions::Part;

/// The frames of a model file.
#[derive(Debug)]
pub struct Frames {
    pub names: Vec<String>,
    /// Of each frame six rows, of each row an element for each rate.
    pub jacobians: Chosen,
    /// Six numbers of each frame.
    pub biases: Chosen,
}

/// The derivatives of the outputs as functions of time, joint state, rates' rates, inputs and parameters: of each
/// number a row.
#[derive(Debug)]
pub struct OutputDerivatives {
    /// By (x, u).
    pub by_state: Chosen,
    /// By u̇.
    pub by_accelerations: Chosen,
    pub by_inputs: Chosen,
    pub by_parameters: Chosen,
}

impl OutputDerivatives {
    /// `None` if a third derivative of a table's curve would be needed.
    pub fn derive(system: &mut System, coordinates: &Coordinates, outputs: &[ExprId]) -> Option<Self> {
        let layout = &coordinates.layout;
        let (model, graph) = (system.model, &mut system.graph);
        let state =
            (0..layout.n_coordinates).map(Symbol::Coordinate).chain((0..layout.n_rates).map(Symbol::Rate));
        let by_state = derivatives(graph, outputs, &state.collect::<Vec<_>>());
        let mut by = |symbol: fn(usize) -> Symbol, n: usize| {
            derivatives(graph, outputs, &(0..n).map(symbol).collect::<Vec<_>>())
        };
        let found = Self {
            by_accelerations: by(Symbol::RateOfRate, layout.n_rates),
            by_inputs: by(Symbol::Input, model.inputs.len()),
            by_parameters: by(Symbol::Parameter, model.parameters.len()),
            by_state,
        };
        let all = [&found.by_state, &found.by_accelerations, &found.by_inputs, &found.by_parameters];
        let roots: Vec<_> = all.into_iter().flat_map(|chosen| chosen.roots.iter().copied()).collect();
        has_tables(graph, &roots).then_some(found)
    }
}

/// Row by row, from the outputs or from the variables.
fn derivatives(graph: &mut Graph, outputs: &[ExprId], by: &[Symbol]) -> Chosen {
    let from_outputs = outputs.iter().flat_map(|&output| gradient(graph, output, by)).collect();
    let columns = forward(graph, outputs, by);
    let from_variables = (0..outputs.len()).flat_map(|row| columns.iter().map(move |column| column[row]));
    let forms = [("from the outputs", from_outputs), ("from the variables", from_variables.collect())];
    let forms = forms.map(|(name, roots)| (name.to_owned(), roots)).to_vec();
    FinalPasses::of(false).cheapest(graph, forms)
}

/// The numbers of all outputs, in terms of joint coordinates, rates and [`Symbol::RateOfRate`].
pub fn outputs(system: &mut System, textbook: &Textbook, coordinates: &Coordinates) -> Chosen {
    let lambda = multipliers::of(system, textbook, coordinates);
    let Textbook { kinematics, dynamics } = textbook;
    let numbers = outputs::derive(system, &Sources { kinematics, dynamics, lambda: &lambda });
    let rates_of_rates: Vec<_> =
        (0..coordinates.layout.n_rates).map(|rate| system.graph.symbol(Symbol::RateOfRate(rate))).collect();
    at_accelerations(system, coordinates, &rates_of_rates, &numbers)
}

impl Frames {
    /// `None` if the model file names no frame.
    pub fn derive(system: &mut System, coordinates: &Coordinates) -> Option<Self> {
        let model = system.model;
        let frames: Vec<(&str, &BodyFrame)> = model
            .outputs
            .iter()
            .filter_map(|output| match &output.kind {
                OutputKind::Velocity(frame) => Some((output.name.as_str(), frame)),
                _ => None,
            })
            .collect();
        if frames.is_empty() {
            return None;
        }
        let velocities: Vec<_> =
            frames.iter().flat_map(|(_, frame)| points::velocity(system, frame)).collect();
        let jacobians = jacobian(system, coordinates, &velocities);
        let accelerations: Vec<_> =
            frames.iter().flat_map(|(_, frame)| outputs::acceleration(system, frame)).collect();
        let at_rest = vec![Graph::ZERO; coordinates.layout.n_rates];
        let biases = at_accelerations(system, coordinates, &at_rest, &accelerations);
        Some(Self { names: frames.iter().map(|frame| frame.0.to_owned()).collect(), jacobians, biases })
    }
}

/// The derivatives of velocities by the rates, row by row.
fn jacobian(system: &mut System, coordinates: &Coordinates, velocities: &[ExprId]) -> Chosen {
    let layout = &coordinates.layout;
    let rates: Vec<_> = (0..layout.n_tree_rates())
        .map(|rate| {
            let symbol = Symbol::Rate(rate);
            coordinates.determined.get(&symbol).copied().unwrap_or_else(|| system.graph.symbol(symbol))
        })
        .collect();
    let motions = motions::motions(system, &coordinates.links, (&rates, Part::Linear), true);
    let symbol = |index: usize| match (index / 6, index % 6) {
        (moving_body, k) if k < 3 => Symbol::Velocity { moving_body, k },
        (moving_body, k) => Symbol::Spin { moving_body, k: k - 3 },
    };
    let by_rate: Vec<_> = (0..layout.n_rates).map(Symbol::Rate).collect();
    let mut forms = Vec::new();
    for (name, values) in by_angles(system, coordinates) {
        let motions = system.expanded(&values, &motions);
        let mut values = values;
        values.extend(motions.into_iter().enumerate().map(|(index, value)| (symbol(index), value)));
        let velocities = system.expanded(&values, velocities);
        let graph = &mut system.graph;
        let rows = velocities.iter().flat_map(|&velocity| gradient(graph, velocity, &by_rate));
        forms.push((name, rows.collect()));
    }
    FinalPasses::of(false).cheapest(&mut system.graph, forms)
}

/// Numbers that depend on the accelerations of the bodies, at these rates' rates.
fn at_accelerations(
    system: &mut System,
    coordinates: &Coordinates,
    rates_of_rates: &[ExprId],
    numbers: &[ExprId],
) -> Chosen {
    let of_tree = coordinates.of_tree(system, rates_of_rates);
    let motions = motions::motions(system, &coordinates.links, (&of_tree, Part::All), true);
    let mut forms = Vec::new();
    for (name, mut values) in by_angles(system, coordinates) {
        let motions = system.expanded(&values, &motions);
        values.extend(motions::accelerations_by_symbol(&motions));
        forms.push((name, system.expanded(&values, numbers)));
    }
    FinalPasses::of(false).cheapest(&mut system.graph, forms)
}

/// Everything in joint coordinates, with rotations by the angles or by their halves.
fn by_angles(system: &mut System, coordinates: &Coordinates) -> [(String, Values); 2] {
    let halves = coordinates.in_joints.clone();
    let poses = maps::expanded(system, halves.clone(), coordinates.angles.poses.clone());
    let mut whole = halves.clone();
    whole.extend(poses);
    [("rotations by whole angles".to_owned(), whole), ("rotations by half angles".to_owned(), halves)]
}
