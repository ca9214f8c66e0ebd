//! What is taken of all that joint coordinates give.

use super::candidates::Candidates;
use super::coordinates::Coordinates;
use super::jacobian::{Jacobian, JointForm, ParameterJacobian};
use super::layout::Layout;
use super::observed::{self, Frames, OutputDerivatives};
use super::on_request::OnRequest;
use super::{forces, maps, motions, multipliers};
use crate::derive::system::System;
use crate::derive::{Observed, Textbook};
use crate::expr::definitions::{Expansion, Values};
use crate::expr::graph::ExprId;
use crate::expr::symbol::Symbol;
use crate::groups::Functions;
use crate::simplify::cheapest::{Chosen, FinalPasses};
use gyro_model::Start;
use gyro_program::Group;

/// What is generated of a tree in joint coordinates, as final expressions. What belongs to functions that are not asked
/// for is empty.
#[derive(Debug)]
pub struct JointSpace {
    pub layout: Layout,
    /// u̇ in terms of joint coordinates and rates.
    pub accelerations: Chosen,
    /// ẋ, then the power of non-conservative forces and drivers if the state carries their work.
    pub derivative: Vec<ExprId>,
    /// u̇ in terms of a maximal state that satisfies the constraints.
    pub accelerations_at: Chosen,
    /// (s̈, ẇ') of each moving body at such a state.
    pub corrected: Chosen,
    /// λ at such a state, in terms of [`Symbol::Acceleration`].
    pub multipliers: Vec<ExprId>,
    /// (s̈, ẇ') of each moving body at such a state, then λ.
    pub solution: Vec<ExprId>,
    /// Maximal positions, velocities and turn references in terms of joint coordinates and rates.
    pub maximal: Vec<ExprId>,
    /// x and u in terms of a maximal state.
    pub reduced: Vec<ExprId>,
    /// The joint state at the start.
    pub start: Vec<f64>,
    /// The derivatives of the joint form, unless the mechanism is too large.
    pub jacobian: Option<Jacobian>,
    /// Those by parameters, likewise.
    pub parameter_jacobian: Option<ParameterJacobian>,
    /// The numbers of the outputs, in terms of [`Symbol::RateOfRate`] too.
    pub outputs: Option<Chosen>,
    /// Their derivatives, unless a third derivative of a table would be needed.
    pub output_derivatives: Option<OutputDerivatives>,
    pub frames: Option<Frames>,
    /// What is there only where it is asked for.
    pub on_request: OnRequest,
    /// Bodies that are described in a frame that does not turn with them.
    pub invariant: Vec<usize>,
    /// The rows of the joints that close loops, by their places among all rows.
    pub closure_rows: Vec<usize>,
    /// Φ of these rows, in terms of joint coordinates.
    pub closure: Vec<ExprId>,
    /// The square of the distance of each row of their Jacobian from the span of those before it.
    pub distances: Vec<ExprId>,
    /// x, one Newton step nearer to closed loops.
    pub closer_coordinates: Vec<ExprId>,
    /// u that keep loops closed.
    pub closing_rates: Vec<ExprId>,
}

impl JointSpace {
    /// `exact` are the accelerations at any state.
    pub fn choose(
        system: &mut System,
        (textbook, observed): (&Textbook, &Observed),
        coordinates: Coordinates,
        mut candidates: Candidates,
        exact: &[ExprId],
        (functions, start): (&Functions, &Start),
    ) -> Self {
        let passes = FinalPasses::of(false);
        let reduced = maps::reduced(system, &coordinates.layout, &coordinates.of_joints);
        let reduced = Expansion::new(&system.definitions).all(&mut system.graph, &reduced);
        let start = maps::joint_start(system, &coordinates.layout, &reduced, start);
        candidates.retain_accurate(system, &coordinates, &start);
        let n_rates = coordinates.layout.n_rates;
        let of_state = |forms: &[(String, Vec<ExprId>)]| -> Vec<_> {
            forms.iter().map(|(name, rates)| (name.clone(), rates[..n_rates].to_vec())).collect()
        };
        let on_rates = candidates.on_rates(system, &coordinates);
        let accelerations = Chosen {
            reductions: candidates.reductions.clone(),
            ..passes.cheapest(&mut system.graph, of_state(&on_rates))
        };
        let (has_corrected, has_reactions) =
            (functions.has(Group::Corrected), functions.has(Group::Reactions));
        let definitions = system.definitions.clone();
        let mut of_joints = Expansion::at(&definitions, &coordinates.of_joints);
        let mut at = Vec::new();
        if has_corrected {
            at = candidates.all(&mut system.graph, &mut of_joints);
        }
        let mut accelerations_at = Chosen::default();
        if has_reactions {
            accelerations_at = passes.cheapest(&mut system.graph, of_state(&at));
        }
        let mut corrected = Chosen::default();
        if has_corrected {
            let forms = corrected_forms(system, (&coordinates, &mut of_joints), &at, exact);
            corrected = passes.cheapest(&mut system.graph, forms);
        }
        let lambda = multipliers::of(system, textbook, &coordinates);
        let (mut multipliers, mut solution) = (Vec::new(), Vec::new());
        if has_reactions {
            multipliers = of_joints.all(&mut system.graph, &lambda);
            let known = motions::accelerations_by_symbol(&corrected.roots);
            let solved = system.expanded(&known, &multipliers);
            solution = corrected.roots.iter().copied().chain(solved).collect();
        }
        let symbols: Vec<_> = (0..n_rates).map(|u| system.graph.symbol(Symbol::Rate(u))).collect();
        let mut rates = maps::coordinate_rates(system, &coordinates.layout, &symbols);
        for (x, rate) in maps::other_rates(system, &coordinates.layout, &coordinates.in_joints) {
            rates[x] = rate;
        }
        let along = forces::power(system, &coordinates.layout, &coordinates.angles);
        let along = system.expanded(&coordinates.in_joints, &[along])[0];
        let power = Power { along, others: observed.power_but_along_coordinates, multipliers: &lambda };
        let of_accelerations = power.at(system, &coordinates, &accelerations.roots);
        let derivative = rates.iter().copied().chain(of_accelerations).collect();
        let rates_of_rates: Vec<_> =
            (0..n_rates).map(|rate| system.graph.symbol(Symbol::RateOfRate(rate))).collect();
        let differentiated: Vec<_> = candidates.shortest.iter().map(|form| &form[..n_rates]).collect();
        let form = JointForm {
            coordinates: &coordinates,
            rates: &rates,
            accelerations: &differentiated,
            power: power.at(system, &coordinates, &rates_of_rates),
            balance: &candidates.balance,
            passes,
        };
        let jacobian = functions.has(Group::Jacobian).then(|| Jacobian::derive(system, &form)).flatten();
        let has_parameters = functions.has(Group::ParameterJacobian);
        let parameter_jacobian = has_parameters.then(|| ParameterJacobian::derive(system, &form)).flatten();
        let outputs =
            functions.has(Group::JointOutputs).then(|| observed::outputs(system, textbook, &coordinates));
        let output_derivatives = outputs
            .as_ref()
            .filter(|_| functions.has(Group::OutputDerivatives))
            .and_then(|outputs| OutputDerivatives::derive(system, &coordinates, &outputs.roots));
        let frames = functions.has(Group::Frames).then(|| Frames::derive(system, &coordinates)).flatten();
        let on_request = OnRequest::derive(system, &coordinates, &candidates.balance, functions);
        let [closure, distances, closer_coordinates, closing_rates] = coordinates.closing(system);
        Self {
            invariant: coordinates.invariant_bodies(),
            closure_rows: coordinates.closure.rows.clone(),
            closure,
            distances,
            closer_coordinates,
            closing_rates,
            accelerations,
            multipliers,
            solution,
            derivative,
            accelerations_at,
            corrected,
            jacobian,
            parameter_jacobian,
            outputs,
            output_derivatives,
            frames,
            on_request,
            maximal: maps::state(system, &coordinates.maximal, &coordinates.in_joints),
            start,
            reduced,
            layout: coordinates.layout,
        }
    }
}

/// The forms of the bodies' accelerations at a corrected state: by each form of the rates' rates, or by `exact`, which
/// hold at any state.
fn corrected_forms(
    system: &mut System,
    (coordinates, of_joints): (&Coordinates, &mut Expansion),
    forms_of_rates: &[(String, Vec<ExprId>)],
    exact: &[ExprId],
) -> Vec<(String, Vec<ExprId>)> {
    let mut forms = Vec::new();
    for (name, rates) in forms_of_rates {
        let [own, global] = motions::outward(system, coordinates, of_joints, rates);
        forms.push((format!("{name} in the bodies' frames"), own));
        forms.push((format!("{name} in the global frame"), global));
    }
    // Multipliers that are found with them are left out.
    let exact = system.expanded(&Values::default(), &exact[..6 * system.moving_bodies.len()]);
    forms.push(("elimination in maximal coordinates".to_owned(), exact));
    forms
}

/// Power of non-conservative forces and drivers.
struct Power<'c> {
    /// Of forces along joint coordinates.
    along: ExprId,
    /// Of all others, in maximal coordinates.
    others: ExprId,
    /// λ, in terms of [`Symbol::Acceleration`].
    multipliers: &'c [ExprId],
}

impl Power<'_> {
    /// In joint coordinates, these rates' rates being known; none unless the state carries the work.
    fn at(
        &self,
        system: &mut System,
        coordinates: &Coordinates,
        rates_of_rates: &[ExprId],
    ) -> Option<ExprId> {
        system.model.has_work().then(|| {
            let rates_of_rates = coordinates.of_tree(system, rates_of_rates);
            let motions =
                motions::motions(system, &coordinates.links, (&rates_of_rates, motions::Part::All), true);
            let motions = system.expanded(&coordinates.in_joints, &motions);
            let mut values = coordinates.in_joints.clone();
            values.extend(motions::accelerations_by_symbol(&motions));
            let beside: Vec<_> =
                system.loop_closure_rows().iter().map(|&row| self.multipliers[row]).collect();
            let beside = system.expanded(&values, &beside);
            values.extend(
                beside.into_iter().enumerate().map(|(place, value)| (Symbol::LoopMultiplier(place), value)),
            );
            let others = system.expanded(&values, &[self.others])[0];
            system.graph.add(self.along, others)
        })
    }
}
