//! Between joint coordinates and maximal ones, both ways.

use super::closure::held_at_zero;
use super::dynamics;
use super::layout::{Layout, LinkCoordinates, Place, Scalar};
use super::link_kinematics::LinkKinematics;
use super::whole_angles::{Sum, WholeAngles};
use super::zero_orientation::orientation_at_zero;
use crate::derive::frames::{JointFrames, sine_and_cosine};
use crate::derive::joint_coordinate::{self, relative_spin};
use crate::derive::readings::{raw_angle, relative_euler};
use crate::derive::state_rates;
use crate::derive::system::System;
use crate::expr::definitions::{Expansion, Values};
use crate::expr::evaluate::evaluate;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::symbol::Symbol;
use crate::expr::vector::{Mat3, UNIT3, Vec3, Vec4, ZERO3};
use gyro_model::{Attachment, CoordinateKind, JointCoordinate, Start};
use std::array::from_fn;

/// Maximal positions and velocities in terms of joint coordinates and rates.
pub fn of_bodies(system: &mut System, layout: &Layout, links: &[LinkKinematics]) -> Values {
    let mut values = Values::default();
    let spins = dynamics::spins(system, links);
    for (link, link_kinematics) in layout.links.iter().zip(links) {
        let moving_body = link_kinematics.moving_body;
        let carrier = Carrier::of(system, link_kinematics.parent, &values);
        let p = orientation(system, link, &carrier);
        let a = system.graph.rotation(&p);
        let own = spins[moving_body];
        let parent_spin = dynamics::spin_of(system, link_kinematics.parent, &spins);
        let graph = &mut system.graph;
        let (arm, own_arm) = (
            graph.mat_vec(&carrier.a, &link_kinematics.on_parent),
            graph.mat_vec(&a, &link_kinematics.on_body),
        );
        let point = graph.add_vec(&carrier.r, &arm);
        let r = graph.sub_vec(&point, &own_arm);
        let slid = link_kinematics.sliding_velocity(graph);
        let turned = graph.cross(&parent_spin, &link_kinematics.on_parent);
        let on_parent = graph.add_vec(&turned, &slid.on_parent);
        let turned = graph.cross(&own, &link_kinematics.on_body);
        let on_body = graph.sub_vec(&slid.on_body, &turned);
        let (on_parent, on_body) = (graph.mat_vec(&carrier.a, &on_parent), graph.mat_vec(&a, &on_body));
        let point = graph.add_vec(&carrier.s, &on_parent);
        let s = graph.add_vec(&point, &on_body);
        for k in 0..3 {
            values.insert(Symbol::Position { moving_body, k }, r[k]);
            values.insert(Symbol::Velocity { moving_body, k }, s[k]);
            values.insert(Symbol::Spin { moving_body, k }, own[k]);
            for (column, &entry) in a[k].iter().enumerate() {
                values.insert(Symbol::Rotation { moving_body, row: k, column }, entry);
            }
        }
        for (k, &e) in p.iter().enumerate() {
            values.insert(Symbol::Euler { moving_body, k }, e);
        }
    }
    in_half_angles(system, layout, values)
}

/// Sines and cosines by those of half the angle, which the orientations need anyhow.
fn in_half_angles(system: &mut System, layout: &Layout, values: Values) -> Values {
    let mut of_angles = unit_vectors(&mut system.graph, layout);
    for scalar in layout.links.iter().flat_map(|link| &link.scalars).filter(|s| s.kind.is_angle()) {
        let x = scalar.place.x;
        let (sine, cosine) = whole(&mut system.graph, x);
        of_angles.insert(Symbol::Sine(x), sine);
        of_angles.insert(Symbol::Cosine(x), cosine);
    }
    expanded(system, of_angles, values)
}

/// Euler parameters over their length.
fn unit_vectors(graph: &mut Graph, layout: &Layout) -> Values {
    let mut values = Values::default();
    for place in layout.orientations() {
        let p: Vec4 = from_fn(|k| graph.symbol(Symbol::Coordinate(place.x + k)));
        let unit = graph.normalise(&p);
        values.extend((0..4).map(|k| (Symbol::Unit(place.x + k), unit[k])));
    }
    values
}

/// Values in which nothing is left to be expanded.
pub fn expanded(system: &mut System, by: Values, values: Values) -> Values {
    let mut expansion = Expansion::with_values(&system.definitions, by);
    let mut values: Vec<_> = values.into_iter().collect();
    values.sort_unstable();
    let graph = &mut system.graph;
    values.into_iter().map(|(symbol, value)| (symbol, expansion.of(graph, value))).collect()
}

/// Where a carrier is, in terms of joint coordinates.
struct Carrier {
    r: Vec3,
    p: Vec4,
    a: Mat3,
    s: Vec3,
}

impl Carrier {
    fn of(system: &mut System, body: Option<usize>, values: &Values) -> Self {
        let Some(body) = body else {
            let p = [Graph::ONE, Graph::ZERO, Graph::ZERO, Graph::ZERO];
            return Self { r: ZERO3, p, a: UNIT3, s: ZERO3 };
        };
        let pose = system.poses[body];
        let Some(moving_body) = system.moving_body_of(body) else {
            return Self { r: pose.r, p: pose.p, a: pose.a, s: pose.s };
        };
        Self {
            r: from_fn(|k| values[&Symbol::Position { moving_body, k }]),
            p: from_fn(|k| values[&Symbol::Euler { moving_body, k }]),
            a: from_fn(|row| from_fn(|column| values[&Symbol::Rotation { moving_body, row, column }])),
            s: from_fn(|k| values[&Symbol::Velocity { moving_body, k }]),
        }
    }
}

/// Euler parameters of a body.
fn orientation(system: &mut System, link: &LinkCoordinates, carrier: &Carrier) -> Vec4 {
    let own = link.orientation.map(|place| from_fn(|k| system.graph.symbol(Symbol::Unit(place.x + k))));
    let (joint, reversed) = match link.link.attachment {
        Attachment::Free => return own.expect("a free body has an orientation"),
        Attachment::Constrained => return system.fixed_pose(link.link.body).p,
        Attachment::Joint { joint, reversed, .. } => (joint, reversed),
    };
    let frames = system.joints[joint];
    let relative = match own {
        Some(p) => p,
        None => relative_orientation(system, &frames, &link.scalars),
    };
    let graph = &mut system.graph;
    if reversed {
        let [e0, e1, e2, e3] = relative;
        let [e1, e2, e3] = graph.neg_vec(&[e1, e2, e3]);
        graph.compose(&carrier.p, &[e0, e1, e2, e3])
    } else {
        graph.compose(&carrier.p, &relative)
    }
}

/// Euler parameters of the second body in the first's frame.
fn relative_orientation(system: &mut System, joint: &JointFrames, scalars: &[Scalar]) -> Vec4 {
    let at_zero = orientation_at_zero(system, joint);
    let graph = &mut system.graph;
    let square = graph.dot(&at_zero, &at_zero);
    let norm = graph.sqrt(square);
    let inverse = graph.recip(norm);
    let mut p = graph.scale_vec(inverse, &at_zero);
    for scalar in scalars.iter().filter(|scalar| scalar.kind.is_angle()) {
        let (sine, cosine) = half(graph, scalar.place.x);
        let about = |graph: &mut Graph, axis: &Vec3| {
            let [x, y, z] = graph.scale_vec(sine, axis);
            [cosine, x, y, z]
        };
        p = if scalar.kind == CoordinateKind::FirstAngle {
            let turn = about(graph, &joint.first.h);
            graph.compose(&turn, &p)
        } else {
            let turn = about(graph, &joint.second.h);
            graph.compose(&p, &turn)
        };
    }
    p
}

/// Sine and cosine of half a joint coordinate.
fn half(graph: &mut Graph, x: usize) -> (ExprId, ExprId) {
    let (x, half) = (graph.symbol(Symbol::Coordinate(x)), graph.fraction(1, 2));
    let x = graph.mul(half, x);
    (graph.sin(x), graph.cos(x))
}

/// Sine and cosine of a joint coordinate from those of its half.
fn whole(graph: &mut Graph, x: usize) -> (ExprId, ExprId) {
    let half = half(graph, x);
    doubled(graph, half, Graph::ONE)
}

/// `2 s c / square` and `(c² − s²) / square`: near a right angle, where it vanishes, a cosine in factors keeps its
/// digits.
fn doubled(graph: &mut Graph, (sine, cosine): (ExprId, ExprId), square: ExprId) -> (ExprId, ExprId) {
    let two = graph.integer(2);
    let factor = graph.div(two, square);
    let twice = graph.mul(factor, sine);
    let (difference, sum) = (graph.sub(cosine, sine), graph.add(cosine, sine));
    let product = graph.mul(difference, sum);
    (graph.mul(twice, cosine), graph.div(product, square))
}

/// Joint coordinates and rates in terms of a maximal state that satisfies the constraints. Of an angle on which nothing
/// acts only the sine and cosine are given.
pub fn of_joints(system: &mut System, layout: &Layout, angles: &WholeAngles) -> Values {
    let mut values = Values::default();
    for link in &layout.links {
        for scalar in &link.scalars {
            scalar_of_joint(system, scalar, &mut values);
        }
        let moving_body = system.moving_body_of(link.link.body).expect("links have coordinates");
        let pose = system.poses[link.link.body];
        if let Some(place) = link.position {
            for k in 0..3 {
                values.insert(Symbol::Coordinate(place.x + k), pose.r[k]);
                values.insert(Symbol::Rate(place.u + k), pose.s[k]);
            }
        }
        if let Some(place) = link.orientation {
            let (p, w) = match link.link.attachment {
                Attachment::Joint { joint, .. } => {
                    let frames = system.joints[joint];
                    (relative_euler(system, &frames), relative_spin(system, &frames))
                }
                _ => (system.poses[system.moving_bodies[moving_body]].p, pose.w),
            };
            values.extend((0..4).map(|k| (Symbol::Coordinate(place.x + k), p[k])));
            values.extend((0..4).map(|k| (Symbol::Unit(place.x + k), p[k])));
            values.extend((0..3).map(|k| (Symbol::Rate(place.u + k), w[k])));
        }
    }
    for scalar in layout.links.iter().flat_map(|link| &link.scalars) {
        if layout.is_held(scalar.place.x) {
            values.extend(held_at_zero(scalar.place));
        }
    }
    for (symbol, reference) in references(system, layout) {
        values.insert(reference, system.graph.symbol(symbol));
    }
    let known = values.clone();
    insert_sums(&mut system.graph, angles, &mut values, |_, place| known[&Symbol::Rate(place.u)]);
    expanded(system, Values::default(), values)
}

fn scalar_of_joint(system: &mut System, scalar: &Scalar, values: &mut Values) {
    let (coordinate, x) = (scalar.coordinate, scalar.place.x);
    let rate = joint_coordinate::rate(system, coordinate);
    values.insert(Symbol::Rate(scalar.place.u), rate);
    if !scalar.kind.is_angle() {
        let value = joint_coordinate::value(system, coordinate);
        values.insert(Symbol::Coordinate(x), value);
        return;
    }
    let joint = system.joints[coordinate.joint];
    let (sine, cosine) = if scalar.kind == CoordinateKind::Angle {
        // p_i* p_j = ± p0 ∘ (cos ½θ, h sin ½θ).
        let (at_zero, relative) = (orientation_at_zero(system, &joint), relative_euler(system, &joint));
        let graph = &mut system.graph;
        let [x, y, z] = joint.second.h;
        let quarter = graph.compose(&at_zero, &[Graph::ZERO, x, y, z]);
        let half = (graph.dot(&quarter, &relative), graph.dot(&at_zero, &relative));
        let square = graph.dot(&at_zero, &at_zero);
        doubled(graph, half, square)
    } else {
        sine_and_cosine(&mut system.graph, scalar.kind, &joint, &joint.relative)
    };
    values.insert(Symbol::Sine(x), sine);
    values.insert(Symbol::Cosine(x), cosine);
    if system.model.turn_references().contains(&coordinate) {
        let angle = joint_coordinate::value(system, coordinate);
        values.insert(Symbol::Coordinate(x), angle);
    }
}

/// x and u from any maximal state: angles continue from the value that x holds before.
pub fn reduced(system: &mut System, layout: &Layout, values: &Values) -> Vec<ExprId> {
    let mut all: Vec<_> = (0..layout.n_coordinates)
        .map(|x| values.get(&Symbol::Coordinate(x)).copied().unwrap_or(Graph::ZERO))
        .collect();
    for scalar in layout.scalars().filter(|s| s.kind.is_angle()) {
        let before = system.graph.symbol(Symbol::Coordinate(scalar.place.x));
        let (sine, cosine) = raw_angle(system, scalar.coordinate, scalar.kind);
        all[scalar.place.x] = system.graph.continued(before, sine, cosine);
    }
    all.extend((0..layout.n_rates).map(|u| values[&Symbol::Rate(u)]));
    all
}

/// Everything in terms of joint coordinates and rates.
pub fn in_joints(
    system: &mut System,
    layout: &Layout,
    maximal: &Values,
    determined: &Values,
    angles: &WholeAngles,
) -> Values {
    let mut values = determined.clone();
    for scalar in layout.links.iter().flat_map(|link| &link.scalars) {
        let place = scalar.place.x;
        let symbol = Symbol::Coordinate(place);
        let x = determined.get(&symbol).copied().unwrap_or_else(|| system.graph.symbol(symbol));
        if scalar.kind.is_angle() {
            values.insert(Symbol::Sine(place), system.graph.sin(x));
            values.insert(Symbol::Cosine(place), system.graph.cos(x));
        }
        let turns = system.model.turn_references();
        if let Some(turn) = turns.iter().position(|&turn| turn == scalar.coordinate) {
            values.insert(Symbol::Angle(turn), x);
        }
    }
    values.extend(unit_vectors(&mut system.graph, layout));
    values.extend(turns_of_loops(system, layout, angles, determined));
    let rate = |graph: &mut Graph, place: Place| {
        let symbol = Symbol::Rate(place.u);
        determined.get(&symbol).copied().unwrap_or_else(|| graph.symbol(symbol))
    };
    insert_sums(&mut system.graph, angles, &mut values, rate);
    for (symbol, x) in references(system, layout) {
        values.insert(symbol, system.graph.symbol(x));
    }
    let maximal = expanded(system, values.clone(), maximal.clone());
    values.extend(maximal);
    values
}

/// The turn references that x has, and the states, with their places there.
fn references(system: &System, layout: &Layout) -> Vec<(Symbol, Symbol)> {
    let turns = layout.turns.iter().map(|&(on, x)| (Symbol::Turn(system.turn_of(on)), x));
    let states = layout.states().enumerate().map(|(state, x)| (Symbol::State(state), x));
    turns.chain(states).map(|(symbol, x)| (symbol, Symbol::Coordinate(x))).collect()
}

/// How fast the angles change whose turns x counts, and the states, with their places there.
pub fn other_rates(system: &mut System, layout: &Layout, in_joints: &Values) -> Vec<(usize, ExprId)> {
    let (turns, places): (Vec<_>, Vec<_>) = layout.turns.iter().copied().unzip();
    let mut rates: Vec<_> = turns.into_iter().map(|on| joint_coordinate::rate(system, on)).collect();
    rates.extend(state_rates(system));
    let rates = system.expanded(in_joints, &rates);
    places.into_iter().chain(layout.states()).zip(rates).collect()
}

/// The turn references of joints that close loops but those that x has.
fn turns_of_loops(system: &mut System, layout: &Layout, angles: &WholeAngles, determined: &Values) -> Values {
    let mut turns: Vec<_> = system.model.turn_references().into_iter().enumerate().collect();
    turns.retain(|(_, on)| layout.turns.iter().all(|(counted, _)| counted != on));
    let turns = turns.into_iter();
    let sums: Vec<_> = turns.filter_map(|(turn, on)| Some((turn, angles.of_loop(on)?))).collect();
    let coordinate = |graph: &mut Graph, place: Place| {
        let symbol = Symbol::Coordinate(place.x);
        determined.get(&symbol).copied().unwrap_or_else(|| graph.symbol(symbol))
    };
    let value = |(turn, sum): (usize, &Sum)| (Symbol::Angle(turn), sum.sum(&mut system.graph, coordinate));
    sums.into_iter().map(value).collect()
}

/// Sines, cosines and rates of sums, from those of the angles.
fn insert_sums(
    graph: &mut Graph,
    angles: &WholeAngles,
    values: &mut Values,
    rate: impl Fn(&mut Graph, Place) -> ExprId,
) {
    for (place, sum) in angles.places() {
        let of = |place: Place| (values[&Symbol::Sine(place.x)], values[&Symbol::Cosine(place.x)]);
        let (sine, cosine) = sum.sine_and_cosine(graph, of);
        values.insert(Symbol::Sine(place.x), sine);
        values.insert(Symbol::Cosine(place.x), cosine);
        values.insert(Symbol::Rate(place.u), sum.sum(graph, &rate));
    }
}

/// ẋ of given rates: those of scalars, `½ Gᵀ w'` of Euler parameters.
pub fn coordinate_rates(system: &mut System, layout: &Layout, rates: &[ExprId]) -> Vec<ExprId> {
    let mut changes = vec![Graph::ZERO; layout.n_coordinates];
    for scalar in layout.scalars() {
        changes[scalar.place.x] = rates[scalar.place.u];
    }
    for link in &layout.links {
        if let Some(place) = link.position {
            changes[place.x..place.x + 3].copy_from_slice(&rates[place.u..place.u + 3]);
        }
        if let Some(place) = link.orientation {
            let p = from_fn(|k| system.graph.symbol(Symbol::Coordinate(place.x + k)));
            let p_rate = system.graph.euler_rate(&p, &from_fn(|k| rates[place.u + k]));
            changes[place.x..place.x + 4].copy_from_slice(&p_rate);
        }
    }
    changes
}

/// Positions (r, p) of each moving_body, then velocities (s, w'), then states, then turn references.
pub fn state(system: &System, values: &Values, in_joints: &Values) -> Vec<ExprId> {
    let moving_bodies = 0..system.moving_bodies.len();
    let position = |moving_body, k| {
        if k < 3 { Symbol::Position { moving_body, k } } else { Symbol::Euler { moving_body, k: k - 3 } }
    };
    let velocity = |moving_body, k| {
        if k < 3 { Symbol::Velocity { moving_body, k } } else { Symbol::Spin { moving_body, k: k - 3 } }
    };
    let positions =
        moving_bodies.clone().flat_map(|moving_body| (0..7).map(move |k| position(moving_body, k)));
    let velocities = moving_bodies.flat_map(|moving_body| (0..6).map(move |k| velocity(moving_body, k)));
    let state = positions.chain(velocities).map(|symbol| values[&symbol]);
    let turn = |turn| in_joints.get(&Symbol::Angle(turn)).unwrap_or_else(|| &in_joints[&Symbol::Turn(turn)]);
    let turns = (0..system.model.turn_references().len()).map(|of| *turn(of));
    let states = (0..system.model.states.len()).map(|state| in_joints[&Symbol::State(state)]);
    state.chain(states).chain(turns).collect()
}

/// The joint state of the assembled start, continuous angles as the assembly has them.
pub fn joint_start(system: &System, layout: &Layout, reduced: &[ExprId], start: &Start) -> Vec<f64> {
    let scalar_at = |x: usize| {
        let mut scalars = layout.links.iter().flat_map(|link| &link.scalars);
        let scalar = scalars.find(|scalar| scalar.place.x == x).map(|scalar| scalar.coordinate);
        scalar.or_else(|| layout.turns.iter().find(|(_, place)| *place == x).map(|(turn, _)| *turn))
    };
    let assembled = |on: JointCoordinate| start.joints[on.joint].position[on.coordinate];
    let value = |symbol: Symbol| match symbol {
        Symbol::Coordinate(x) => scalar_at(x).map_or(0.0, assembled),
        symbol => at_start(system, start, symbol),
    };
    let mut values = evaluate(&system.graph, reduced, value);
    for (x, value) in values.iter_mut().enumerate().take(layout.n_coordinates) {
        *value = scalar_at(x).map_or(*value, assembled);
    }
    values
}

/// The value of a symbol of the maximal state, of parameters, inputs and tables, at the assembled start.
pub fn at_start(system: &System, start: &Start, symbol: Symbol) -> f64 {
    match symbol {
        Symbol::Position { moving_body, k } => start.q[7 * moving_body + k],
        Symbol::Euler { moving_body, k } => start.q[7 * moving_body + 3 + k],
        Symbol::Velocity { moving_body, k } => start.v[6 * moving_body + k],
        Symbol::Spin { moving_body, k } => start.v[6 * moving_body + 3 + k],
        Symbol::State(state) => start.states[state],
        Symbol::Turn(turn) => {
            let on = system.model.turn_references()[turn];
            start.joints[on.joint].position[on.coordinate]
        }
        Symbol::Parameter(index) => gyro_model::to_f64(&system.model.parameters[index].value),
        Symbol::Input(index) => gyro_model::to_f64(&system.model.inputs[index].value),
        Symbol::Table { table, order } => system.tables[table].value(0.0).get(order).copied().unwrap_or(0.0),
        _ => 0.0,
    }
}
