//! Rows of velocities in joint coordinates and rates.

use super::closure::{Directions, all_held};
use super::dynamics;
use super::embedding::Embedding;
use super::forces::OfJoints;
use super::layout::Layout;
use super::link_kinematics::LinkKinematics;
use super::maps;
use super::whole_angles::WholeAngles;
use crate::derive::constraints;
use crate::derive::frames::sine_and_cosine;
use crate::derive::joint_coordinate;
use crate::derive::laws::Readings;
use crate::derive::system::System;
use crate::expr::definitions::{Definitions, Values};
use crate::expr::differentiate::{Derivative, angle_rate};
use crate::expr::graph::{ExprId, Node};
use crate::expr::symbol::Symbol;
use gyro_model::JointCoordinate;
use std::collections::{BTreeMap, BTreeSet};

/// Joint coordinates and rates; the rate of one that a loop's joint has, and that is no sum of the tree's, is the
/// derivative of where the bodies are.
struct OfLoops<'a>(OfJoints<'a>);

impl Readings for OfLoops<'_> {
    fn value(&self, system: &mut System, on: JointCoordinate) -> ExprId {
        self.0.value(system, on)
    }

    fn rate(&self, system: &mut System, on: JointCoordinate) -> ExprId {
        let OfJoints { layout, angles } = self.0;
        if self.0.parts(on).is_some() {
            return self.0.rate(system, on);
        }
        let (frames, kind) = (system.joints[on.joint], system.model.coordinate_kind(on));
        let (poses, embedding) = (&angles.poses, Embedding::identity(layout.n_tree_rates()));
        let motion = Directions { layout, angles, embedding: &embedding };
        let motion = motion.of_motion(&mut system.graph, system.model);
        let definitions = Definitions::default();
        let mut derivative = Derivative::new(&definitions, motion);
        if !kind.is_angle() {
            let value = joint_coordinate::value(system, on);
            let value = system.expanded(poses, &[value])[0];
            return derivative.of(&mut system.graph, value);
        }
        let (sine, cosine) = sine_and_cosine(&mut system.graph, kind, &frames, &frames.relative);
        let [sine, cosine] = [sine, cosine].map(|part| system.expanded(poses, &[part])[0]);
        let rates = [sine, cosine].map(|part| derivative.of(&mut system.graph, part));
        angle_rate(&mut system.graph, (sine, cosine), rates.into())
    }
}

/// The rows of velocities in joint coordinates and rates, by their places among the rows.
pub fn rows(
    system: &mut System,
    (layout, angles): (&Layout, &WholeAngles),
    links: &[LinkKinematics],
) -> BTreeMap<usize, ExprId> {
    let readings = OfLoops(OfJoints { layout, angles });
    let (rows, own): (Vec<_>, Vec<_>) = constraints::of_velocities(system, &readings).into_iter().unzip();
    let velocities = velocities(system, (layout, angles), links, &own);
    let mut values = maps::expanded(system, angles.poses.clone(), velocities);
    values.extend(&angles.poses);
    let own = system.expanded(&values, &own);
    let held = all_held(system, layout);
    rows.into_iter().zip(system.expanded(&held, &own)).collect()
}

/// The velocities (s, w') that some expressions have in them: s as the derivative of where the body is.
fn velocities(
    system: &mut System,
    (layout, angles): (&Layout, &WholeAngles),
    links: &[LinkKinematics],
    within: &[ExprId],
) -> Values {
    let named: BTreeSet<_> = (system.graph.reachable(within).into_iter())
        .filter_map(|id| match *system.graph.node(id) {
            Node::Symbol(symbol @ (Symbol::Velocity { .. } | Symbol::Spin { .. })) => Some(symbol),
            _ => None,
        })
        .collect();
    if named.is_empty() {
        return Values::default();
    }
    let embedding = Embedding::identity(layout.n_tree_rates());
    let motion = Directions { layout, angles, embedding: &embedding };
    let motion = motion.of_motion(&mut system.graph, system.model);
    let definitions = Definitions::default();
    let mut derivative = Derivative::new(&definitions, motion);
    let spins = dynamics::spins(system, links);
    let of = |symbol| match symbol {
        Symbol::Velocity { moving_body, k } => {
            let place = angles.poses[&Symbol::Position { moving_body, k }];
            (symbol, derivative.of(&mut system.graph, place))
        }
        Symbol::Spin { moving_body, k } => (symbol, spins[moving_body][k]),
        _ => unreachable!("no other symbol is taken"),
    };
    named.into_iter().map(of).collect()
}
