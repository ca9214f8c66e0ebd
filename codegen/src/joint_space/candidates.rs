//! Everything that joint coordinates give, in the forms that were compared and chosen.

use super::dynamics::{MAX_FACTORED, NORMAL_FORM, Reduced};
use super::jacobian::{self, Jacobian};
use super::layout::{self, Layout};
use super::link_kinematics::Carriage;
use super::{dynamics, link_kinematics, maps, multipliers};
use crate::derive::dynamics::Dynamics;
use crate::derive::kinematics::Kinematics;
use crate::derive::system::System;
use crate::expr::definitions::{Expansion, Values};
use crate::expr::evaluate::evaluate;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::spatial_vector::SpatialVector;
use crate::expr::symbol::Symbol;
use crate::expr::vector::{UNIT3, Vec3, ZERO3, transposed};
use crate::simplify::cheapest::Finish;
use crate::simplify::cheapest::Form;
use crate::simplify::normal_form::Reduction;
use crate::solve::articulated_body::Arm;
use crate::solve::cancellation::{self, Trials};
use crate::solve::gram_schmidt;
use crate::solve::motion_subspace::{Freedom, Parent};
use gyro_model::{JointCoordinate, Start};
use std::array::from_fn;

/// What `gyro_sim::JointSpace` asks of a generated tree, as final expressions.
#[derive(Debug)]
pub struct JointSpace {
    pub layout: Layout,
    /// u̇ in terms of joint coordinates and rates.
    pub accelerations: Vec<ExprId>,
    /// ẋ, then the power of non-conservative forces and drivers if the state carries their work.
    pub derivative: Vec<ExprId>,
    /// u̇ in terms of a maximal state that satisfies the constraints.
    pub accelerations_at: Vec<ExprId>,
    /// (s̈, ẇ') of each slot at such a state.
    pub corrected: Vec<ExprId>,
    /// λ at such a state, in terms of [`Symbol::Acceleration`].
    pub multipliers: Vec<ExprId>,
    /// (s̈, ẇ') of each slot at such a state, then λ.
    pub solution: Vec<ExprId>,
    /// Maximal positions, velocities and turn references in terms of joint coordinates and rates.
    pub maximal: Vec<ExprId>,
    /// x and u in terms of a maximal state.
    pub reduced: Vec<ExprId>,
    /// The joint state at the start.
    pub start: Vec<f64>,
    /// The derivatives of the joint form, unless the mechanism is too large.
    pub jacobian: Option<Jacobian>,
    /// Bodies that are described in a frame that does not turn with them.
    pub invariant: Vec<usize>,
    /// What was compared for accelerations, accelerations_at and corrected.
    forms: [Vec<Form>; 3],
    /// What the normal form made of the accelerations' parts.
    reductions: Vec<Reduction>,
}

impl JointSpace {
    /// Whether joint coordinates describe the mechanism.
    pub fn covers(system: &System) -> bool {
        system.tree.is_open() && system.closing_rows().is_empty()
    }

    /// The forms of a function that were compared, and what the normal form did for it.
    pub fn choice(&self, function: &str) -> (Vec<Form>, Vec<Reduction>) {
        let [accelerations, at, corrected] = &self.forms;
        match function {
            "joint_accelerations" => (accelerations.clone(), self.reductions.clone()),
            "joint_accelerations_at" => (at.clone(), Vec::new()),
            "corrected_accelerations" => (corrected.clone(), Vec::new()),
            "joint_jacobian" | "joint_input_jacobian" => {
                let place = usize::from(function == "joint_input_jacobian");
                let forms = self.jacobian.as_ref().map(|jacobian| jacobian.forms[place].clone());
                (forms.unwrap_or_default(), Vec::new())
            }
            _ => Default::default(),
        }
    }

    /// `exact` are the accelerations at any state, `other_power` that of the maximal form of all but what acts along joint coordinates.
    pub fn derive(
        system: &mut System,
        kinematics: &Kinematics,
        dynamics: &Dynamics,
        exact: &[ExprId],
        other_power: ExprId,
        start: &Start,
    ) -> Self {
        let (layout, finish) = (Layout::of(system), Finish::of(!system.closing_rows().is_empty()));
        let carriages = carriages_of(system, &layout, &|_| true);
        let maximal = maps::of_bodies(system, &layout, &carriages);
        let in_joints = in_joints(system, &layout, &maximal);
        let of_joints = maps::of_joints(system, &layout);

        let invariant = invariant_angles(system, &layout, &carriages, dynamics);
        let carriages_of_dynamics = carriages_of(system, &layout, &|x| !invariant.contains(&x));
        let along = dynamics::forces_along(system, &layout);
        let reduced = |system: &mut System, spins: &[Vec3]| {
            let (carriages, loads) = (&carriages_of_dynamics, &dynamics.other_loads);
            Reduced::new(system, &layout, carriages, spins, loads, &along)
        };
        let spins = dynamics::spins(system, &carriages_of_dynamics);
        let from_rates = reduced(system, &spins);
        let mut candidates = vec![("recursion", from_rates.recursion(system))];
        let mut reductions = Vec::new();
        let unit = unit_atoms(system, &layout);
        if layout.n_rates <= MAX_FACTORED {
            candidates.push((NORMAL_FORM, from_rates.factored(system, &unit, &mut reductions)));
        }
        let in_terms_of = |system: &mut System, values: &Values, candidates: &[(&str, Vec<ExprId>)]| {
            let expanded =
                |(name, roots): &(&str, Vec<ExprId>)| ((*name).to_owned(), system.expanded(values, roots));
            candidates.iter().map(expanded).collect::<Vec<_>>()
        };
        let of_balance = in_terms_of(system, &in_joints, &candidates);
        let (of_balance, _) = finish.cheapest(&mut system.graph, of_balance);
        // A maximal state has the angular velocities at hand.
        let spins = spins_at_hand(system, &layout, &carriages_of_dynamics, &invariant);
        let from_spins = reduced(system, &spins);
        let mut candidates_at = candidates.clone();
        candidates_at.push(("recursion on the bodies' spins", from_spins.recursion(system)));
        if (2..=gram_schmidt::MAX_RATES).contains(&layout.n_rates) {
            let motions = from_rates.orthogonal(system);
            if cancellation::are_at_stake(system) {
                let keeping = system.expanded(&in_joints, &motions);
                let of_rates = in_terms_of(system, &in_joints, &candidates_at);
                let losing = losing_digits(system, &layout, &of_rates, &keeping);
                candidates.retain(|(name, _)| losing.iter().all(|losing| losing != name));
                candidates_at.retain(|(name, _)| losing.iter().all(|losing| losing != name));
            }
            candidates.push(("orthogonal motions", motions.clone()));
            candidates_at.push(("orthogonal motions", motions));
            candidates_at.push(("orthogonal motions on the bodies' spins", from_spins.orthogonal(system)));
        }
        let of_rates = in_terms_of(system, &in_joints, &candidates);
        let (accelerations, forms) = finish.cheapest(&mut system.graph, of_rates);
        let at = in_terms_of(system, &of_joints, &candidates_at);
        let (accelerations_at, forms_at) = finish.cheapest(&mut system.graph, at.clone());
        let corrected = at.iter().flat_map(|(name, rates)| {
            let frames = ["the bodies' frames", "the global frame"].map(|frame| format!("{name} in {frame}"));
            frames.into_iter().zip(outward(system, &carriages, &of_joints, rates))
        });
        let mut corrected: Vec<_> = corrected.collect();
        corrected.push((
            "elimination in maximal coordinates".to_owned(),
            system.expanded(&Values::default(), exact),
        ));
        let (corrected, forms_corrected) = finish.cheapest(&mut system.graph, corrected);

        let tree = (&layout, &carriages[..]);
        let multipliers = multipliers::of(system, kinematics, dynamics, tree, &unit);
        let multipliers = system.expanded(&of_joints, &multipliers);
        let known = accelerations_by_symbol(&corrected);
        let solved = system.expanded(&known, &multipliers);
        let solution = corrected.iter().copied().chain(solved).collect();

        let coordinates = coordinate_rates(system, &layout);
        let mut derivative = coordinates.clone();
        let power_along = dynamics::power_along(system, &layout);
        let power_at = |system: &mut System, accelerations: &[ExprId]| {
            system.model.has_work().then(|| {
                let others = power_in_joints(system, &carriages, &in_joints, accelerations, other_power);
                system.graph.add(power_along, others)
            })
        };
        derivative.extend(power_at(system, &accelerations));
        let reduced = maps::reduced(system, &layout);
        let reduced = Expansion::new(&system.definitions).all(&mut system.graph, &reduced);
        let rates_of_rates: Vec<_> =
            (0..layout.n_rates).map(|rate| system.graph.symbol(Symbol::RateOfRate(rate))).collect();
        // Off the unit sphere of Euler parameters two forms of u̇ may differ: there the derivative is that of the form which is emitted.
        let has_orientation = layout.links.iter().any(|link| link.orientation.is_some());
        let form = jacobian::JointForm {
            layout: &layout,
            in_joints: &in_joints,
            coordinates: &coordinates,
            accelerations: if has_orientation { &accelerations } else { &of_balance },
            power: power_at(system, &rates_of_rates),
            reduced: &from_rates,
            unit: &unit,
            finish,
        };
        let jacobian = Jacobian::derive(system, &form);
        let is_invariant = |link: &&layout::LinkCoordinates| {
            link.scalars.iter().any(|scalar| invariant.contains(&scalar.place.x))
        };
        Self {
            invariant: layout.links.iter().filter(is_invariant).map(|link| link.link.body).collect(),
            forms: [forms, forms_at, forms_corrected],
            reductions,
            accelerations,
            multipliers,
            solution,
            derivative,
            accelerations_at,
            corrected,
            jacobian,
            maximal: listed(system, &layout, &maximal),
            start: joint_start(system, &layout, &reduced, start),
            reduced,
            layout,
        }
    }
}

/// The names of those ways of writing the rates' rates that lose digits which another keeps.
fn losing_digits(
    system: &System,
    layout: &Layout,
    ways: &[(String, Vec<ExprId>)],
    keeping: &[ExprId],
) -> Vec<String> {
    // What turns freely is not among what is tried.
    let is_tried = layout.links.iter().all(|link| link.orientation.is_none());
    let scalars = layout.links.iter().flat_map(|link| &link.scalars);
    let angles = scalars.filter(|scalar| scalar.kind.is_angle()).map(|scalar| scalar.place.x).collect();
    let all: Vec<_> = ways.iter().flat_map(|(_, roots)| roots).chain(keeping).copied().collect();
    let trials = Trials::draw(system, &all, &angles);
    let loses = |roots: &[ExprId]| !is_tried || !trials.keep_digits(&system.graph, roots, keeping);
    ways.iter().filter(|(_, roots)| loses(roots)).map(|(name, _)| name.clone()).collect()
}

fn carriages_of(system: &mut System, layout: &Layout, turned: link_kinematics::Turned) -> Vec<Carriage> {
    layout.links.iter().map(|link| Carriage::of(system, link, turned)).collect()
}

/// Angles that turn nothing but a body that looks the same whatever the angle is: a leaf with a single axis, its mass centre on
/// the axis and its inertia symmetric about it, that no load acts on. The body is then described in a frame that does
/// not turn with it.
fn invariant_angles(
    system: &mut System,
    layout: &Layout,
    carriages: &[Carriage],
    dynamics: &Dynamics,
) -> Vec<usize> {
    let is_leaf = |body: usize| carriages.iter().all(|carriage| carriage.parent != Some(body));
    let links = layout.links.iter().zip(carriages);
    let invariant = links.filter_map(|(link, carriage)| {
        let angles: Vec<_> = link.scalars.iter().filter(|scalar| scalar.kind.is_angle()).collect();
        let [angle] = angles[..] else { return None };
        let turning = carriage.free.iter().find(|free| free.rate == angle.place.u)?;
        let axis = turning.twist.rho;
        let load = dynamics.other_loads[link.link.body];
        let unloaded = load.force == ZERO3 && load.torque == ZERO3;
        let inertia = system.inertia(carriage.slot);
        let graph = &mut system.graph;
        let tilde = graph.tilde(&axis);
        let (left, right) = (graph.mat_mul(&tilde, &inertia), graph.mat_mul(&inertia, &tilde));
        let on_axis = graph.cross(&axis, &carriage.on_body) == ZERO3;
        let symmetric = graph.sub_mat(&left, &right) == [ZERO3; 3];
        (is_leaf(link.link.body) && unloaded && on_axis && symmetric).then_some(angle.place.x)
    });
    invariant.collect()
}

/// w' of each slot as a maximal state has it, but of bodies whose frame does not turn with them.
fn spins_at_hand(
    system: &mut System,
    layout: &Layout,
    carriages: &[Carriage],
    invariant: &[usize],
) -> Vec<Vec3> {
    let own: Vec<_> = system.slots.iter().map(|&body| system.poses[body].w).collect();
    let mut spins = own.clone();
    for (link, carriage) in layout.links.iter().zip(carriages) {
        if link.scalars.iter().any(|scalar| invariant.contains(&scalar.place.x)) {
            // A leaf: nothing else looks at this frame.
            let of_parent = dynamics::spin_of(system, carriage.parent, &own);
            spins[carriage.slot] = carriage.spin(&mut system.graph, &of_parent);
        }
    }
    spins
}

/// Sets of atoms of which the squares sum to one.
fn unit_atoms(system: &mut System, layout: &Layout) -> Vec<Vec<ExprId>> {
    let graph = &mut system.graph;
    let mut unit = Vec::new();
    for link in &layout.links {
        for scalar in link.scalars.iter().filter(|scalar| scalar.kind.is_angle()) {
            let x = scalar.place.x;
            unit.push([Symbol::Cosine(x), Symbol::Sine(x)].map(|symbol| graph.symbol(symbol)).to_vec());
        }
        if let Some(place) = link.orientation {
            unit.push((0..4).map(|k| graph.symbol(Symbol::Coordinate(place.x + k))).collect());
        }
    }
    unit
}

/// Everything in terms of joint coordinates and rates.
fn in_joints(system: &mut System, layout: &Layout, maximal: &Values) -> Values {
    let mut values = Values::default();
    for scalar in layout.links.iter().flat_map(|link| &link.scalars) {
        let place = scalar.place.x;
        let x = system.graph.symbol(Symbol::Coordinate(place));
        if scalar.kind.is_angle() {
            values.insert(Symbol::Sine(place), system.graph.sin(x));
            values.insert(Symbol::Cosine(place), system.graph.cos(x));
        }
        let turns = system.model.turn_references();
        if let Some(turn) = turns.iter().position(|&turn| turn == scalar.coordinate) {
            values.insert(Symbol::Angle(turn), x);
        }
    }
    let maximal = maps::expanded(system, values.clone(), maximal.clone());
    values.extend(maximal);
    values
}

/// A power of the maximal form, for which some accelerations may have to be known.
fn power_in_joints(
    system: &mut System,
    carriages: &[Carriage],
    in_joints: &Values,
    accelerations: &[ExprId],
    power: ExprId,
) -> ExprId {
    let motions = motions(system, carriages, accelerations, true);
    let motions = system.expanded(in_joints, &motions);
    let mut values = in_joints.clone();
    values.extend(accelerations_by_symbol(&motions));
    system.expanded(&values, &[power])[0]
}

/// (s̈, ẇ') of each slot by the symbols that stand for them.
fn accelerations_by_symbol(accelerations: &[ExprId]) -> Values {
    let symbol = |index: usize| Symbol::Acceleration { slot: index / 6, k: index % 6 };
    accelerations.iter().enumerate().map(|(index, &value)| (symbol(index), value)).collect()
}

/// (s̈, ẇ') of each slot from the rates' rates: translations in each body's own frame, or in the global one.
fn outward(
    system: &mut System,
    carriages: &[Carriage],
    of_joints: &Values,
    rates: &[ExprId],
) -> [Vec<ExprId>; 2] {
    [false, true].map(|is_global| {
        let motions = motions(system, carriages, rates, is_global);
        system.expanded(of_joints, &motions)
    })
}

fn motions(system: &mut System, carriages: &[Carriage], rates: &[ExprId], is_global: bool) -> Vec<ExprId> {
    let spins: Vec<_> = system.slots.iter().map(|&body| system.poses[body].w).collect();
    let mut motions = vec![SpatialVector::ZERO; spins.len()];
    for carriage in carriages {
        let bias = dynamics::bias(system, carriage, &spins);
        let ground = dynamics::of_ground(system, carriage, &ZERO3);
        let freedom = dynamics::local_freedom(system, carriage);
        let freedom = if is_global { in_global_frame(system, carriage, freedom) } else { freedom };
        let body = system.slots[carriage.slot];
        let parent_frame = match (is_global, carriage.parent) {
            (true, Some(parent)) => system.poses[parent].a,
            (true, None) => UNIT3,
            (false, _) => transposed(&carriage.rotation),
        };
        let own_frame = if is_global { system.poses[body].a } else { UNIT3 };
        let graph = &mut system.graph;
        let (on_parent, on_body) =
            (graph.mat_vec(&parent_frame, &bias.on_parent), graph.mat_vec(&own_frame, &bias.on_body));
        let ground_t = graph.mat_vec(&own_frame, &ground.t);
        let mut motion = SpatialVector { t: graph.add_vec(&on_parent, &on_body), rho: bias.rho };
        motion = motion.plus(graph, &SpatialVector { t: ground_t, rho: ground.rho });
        if let Some(parent) = freedom.parent {
            let carried = parent.twist(graph, &motions[parent.slot]);
            motion = motion.plus(graph, &carried);
        }
        for (free, twist) in carriage.free.iter().zip(&freedom.free).rev() {
            let yielded = twist.scaled(graph, rates[free.rate]);
            motion = motion.plus(graph, &yielded);
        }
        motions[carriage.slot] = Arm::on_body(graph, &freedom).twist(graph, &motion);
    }
    let mut all = Vec::new();
    for (slot, motion) in motions.iter().enumerate() {
        let a = system.poses[system.slots[slot]].a;
        let linear = if is_global { motion.t } else { system.graph.mat_vec(&a, &motion.t) };
        all.extend(linear.into_iter().chain(motion.rho));
    }
    all
}

fn in_global_frame(system: &mut System, carriage: &Carriage, local: Freedom) -> Freedom {
    let frame = system.poses[system.slots[carriage.slot]].a;
    let graph = &mut system.graph;
    let free =
        local.free.iter().map(|twist| SpatialVector { t: graph.mat_vec(&frame, &twist.t), rho: twist.rho });
    let free = free.collect();
    let parent = local.parent.map(|parent| {
        let frame = system.poses[system.slots[parent.slot]].a;
        Parent { frame, carried: UNIT3, ..parent }
    });
    Freedom { frame, free, parent, ..local }
}

/// ẋ: the rates of scalars, `½ Gᵀ w'` of Euler parameters.
fn coordinate_rates(system: &mut System, layout: &Layout) -> Vec<ExprId> {
    let graph = &mut system.graph;
    let mut rates = vec![Graph::ZERO; layout.n_coordinates];
    for link in &layout.links {
        for scalar in &link.scalars {
            rates[scalar.place.x] = graph.symbol(Symbol::Rate(scalar.place.u));
        }
        if let Some(place) = link.position {
            for k in 0..3 {
                rates[place.x + k] = graph.symbol(Symbol::Rate(place.u + k));
            }
        }
        if let Some(place) = link.orientation {
            let p = from_fn(|k| graph.symbol(Symbol::Coordinate(place.x + k)));
            let w = from_fn(|k| graph.symbol(Symbol::Rate(place.u + k)));
            let p_rate = graph.euler_rate(&p, &w);
            rates[place.x..place.x + 4].copy_from_slice(&p_rate);
        }
    }
    rates
}

/// Positions (r, p) of each slot, then velocities (s, w'), then turn references.
fn listed(system: &mut System, layout: &Layout, values: &Values) -> Vec<ExprId> {
    let slots = 0..system.slots.len();
    let position =
        |slot, k| if k < 3 { Symbol::Position { slot, k } } else { Symbol::Euler { slot, k: k - 3 } };
    let velocity =
        |slot, k| if k < 3 { Symbol::Velocity { slot, k } } else { Symbol::Spin { slot, k: k - 3 } };
    let positions = slots.clone().flat_map(|slot| (0..7).map(move |k| position(slot, k)));
    let velocities = slots.flat_map(|slot| (0..6).map(move |k| velocity(slot, k)));
    let state = positions.chain(velocities).map(|symbol| values[&symbol]);
    let turns = system.model.turn_references();
    let turns = turns.into_iter().map(|turn| {
        let scalar = layout.scalar(turn).expect("joints of a tree have their coordinates");
        system.graph.symbol(Symbol::Coordinate(scalar.place.x))
    });
    state.chain(turns).collect()
}

/// The joint state of the assembled start, continuous angles as the assembly has them.
fn joint_start(system: &System, layout: &Layout, reduced: &[ExprId], start: &Start) -> Vec<f64> {
    let scalar_at = |x: usize| {
        let mut scalars = layout.links.iter().flat_map(|link| &link.scalars);
        scalars.find(|scalar| scalar.place.x == x).map(|scalar| scalar.coordinate)
    };
    let assembled = |on: JointCoordinate| start.joints[on.joint].position[on.coordinate];
    let turns = system.model.turn_references();
    let value = |symbol: Symbol| match symbol {
        Symbol::Position { slot, k } => start.q[7 * slot + k],
        Symbol::Euler { slot, k } => start.q[7 * slot + 3 + k],
        Symbol::Velocity { slot, k } => start.v[6 * slot + k],
        Symbol::Spin { slot, k } => start.v[6 * slot + 3 + k],
        Symbol::Turn(turn) => assembled(turns[turn]),
        Symbol::Coordinate(x) => scalar_at(x).map_or(0.0, assembled),
        Symbol::Parameter(index) => gyro_model::to_f64(&system.model.parameters[index].value),
        Symbol::Input(index) => gyro_model::to_f64(&system.model.inputs[index].value),
        Symbol::Table { table, order } => system.tables[table].value(0.0).get(order).copied().unwrap_or(0.0),
        _ => 0.0,
    };
    let mut values = evaluate(&system.graph, reduced, value);
    for (x, value) in values.iter_mut().enumerate().take(layout.n_coordinates) {
        *value = scalar_at(x).map_or(*value, assembled);
    }
    values
}
