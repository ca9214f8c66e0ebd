//! The equations of motion of planar mechanisms, as planar mechanics writes them: in the angles of the bodies, not of
//! the joints, and in the positions of points of mass.
//!
//! A bar between two pins moves like two masses at the pins and a moment of inertia (dynamically equivalent masses:
//! Wittenbauer, *Graphische Dynamik* (1923)). The mass at a pin belongs to either of the bodies that meet there: where
//! the pin closes a loop, to change sides changes the equations by multiples of the loop's rows and of their second
//! derivatives, and so no acceleration. The reduced mass matrix is then mostly constant.

use super::coordinates::Coordinates;
use super::layout::{Place, Scalar};
use crate::derive::system::System;
use crate::expr::definitions::Definitions;
use crate::expr::differentiate::{Derivative, Direction};
use crate::expr::graph::{ExprId, Graph, Node};
use crate::expr::spatial_vector::SpatialVector;
use crate::expr::symbol::Symbol;
use crate::expr::vector::{Vec3, ZERO3};
use crate::simplify::normal_form::normal_form;
use crate::solve::ldl::Elimination;
use gyro_model::JointKind;
use std::collections::BTreeMap;

/// As the data sheet calls it.
pub const PLANAR: &str = "planar mechanics";

/// A variable: the angle of some bodies, or a displacement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Variable {
    place: Place,
    is_angle: bool,
}

/// A mass where a point is.
struct PointMass {
    mass: ExprId,
    position: Vec3,
}

/// A planar mechanism.
struct Planar<'a> {
    coordinates: &'a Coordinates,
    variables: Vec<Variable>,
    /// Of each rate of the state its factors by the rates of the variables.
    rates: Vec<Vec<i64>>,
    points: Vec<PointMass>,
    /// Of each variable the moment of inertia that turns with it.
    moments: Vec<ExprId>,
}

/// The accelerations of the rates, if all bodies turn about one direction only, no joint has an armature and no forces
/// but gravity and those along joint coordinates act.
pub fn accelerations(system: &mut System, coordinates: &Coordinates) -> Option<Vec<ExprId>> {
    let is_unloaded = |load: &SpatialVector| load.t == ZERO3 && load.rho == ZERO3;
    let has_armature = coordinates.armature.iter().any(|&inertia| inertia != Graph::ZERO)
        || !coordinates.cut_armatures.is_empty();
    if coordinates.closure.rows.is_empty()
        || coordinates.closure.n_of_velocities > 0
        || has_armature
        || !coordinates.loads.iter().all(is_unloaded)
    {
        return None;
    }
    let planar = Planar::of(system, coordinates)?;
    planar.is_in_variables(system).then(|| planar.solve(system))
}

impl<'a> Planar<'a> {
    fn of(system: &mut System, coordinates: &'a Coordinates) -> Option<Self> {
        let layout = &coordinates.layout;
        if layout.links.iter().any(|link| link.orientation.is_some() || link.position.is_some()) {
            return None;
        }
        if !all_parallel(&mut system.graph, coordinates) {
            return None;
        }
        let mut planar = Self {
            coordinates,
            variables: Vec::new(),
            rates: vec![Vec::new(); layout.n_rates],
            points: Vec::new(),
            moments: Vec::new(),
        };
        for (link, kinematics) in layout.links.iter().zip(&coordinates.links) {
            for scalar in link.scalars.iter().filter(|scalar| scalar.place.x < layout.n_coordinates) {
                planar.add_variable(scalar, kinematics.moving_body)?;
            }
        }
        for rates in &mut planar.rates {
            rates.resize(planar.variables.len(), 0);
        }
        if planar.variables.len() != layout.n_rates {
            return None;
        }
        planar.moments = vec![Graph::ZERO; planar.variables.len()];
        for moving_body in 0..system.moving_bodies.len() {
            planar.add_body(system, moving_body);
        }
        Some(planar)
    }

    /// The variable that a joint coordinate adds, and its rate by the variables.
    fn add_variable(&mut self, scalar: &Scalar, moving_body: usize) -> Option<()> {
        let n = self.variables.len();
        if !scalar.kind.is_angle() {
            self.variables.push(Variable { place: scalar.place, is_angle: false });
            self.rates[scalar.place.u] = unit(n);
            return Some(());
        }
        let (place, ..) = self.coordinates.angles.bodies[moving_body].turn?;
        let parts = self.coordinates.angles.parts(place);
        let (_, is_negative) = parts.iter().find(|(part, _)| *part == scalar.place)?;
        // The angle of the body less those of other joints.
        let mut rate = unit(n);
        for (part, sign) in parts.iter().filter(|(part, _)| *part != scalar.place) {
            let known = self.rates.get(part.u).filter(|known| !known.is_empty())?;
            for (rate, &factor) in rate.iter_mut().zip(known) {
                *rate -= if *sign { -factor } else { factor };
            }
        }
        rate.iter_mut().for_each(|factor| *factor *= if *is_negative { -1 } else { 1 });
        self.variables.push(Variable { place, is_angle: true });
        self.rates[scalar.place.u] = rate;
        Some(())
    }

    /// The body as masses at two pins and a moment of inertia, if its mass centre is on the line between them; as a
    /// mass at the mass centre otherwise.
    fn add_body(&mut self, system: &mut System, moving_body: usize) {
        let (mass, inertia) = (system.mass(moving_body), system.inertia(moving_body));
        let body = &self.coordinates.angles.bodies[moving_body];
        let centre = [0, 1, 2].map(|k| self.coordinates.angles.poses[&Symbol::Position { moving_body, k }]);
        let pins = self.pins(system, moving_body);
        let graph = &mut system.graph;
        let mut moment = body.turn.map_or(Graph::ZERO, |(_, axis, _)| {
            let along = graph.mat_vec(&inertia, &axis);
            graph.dot(&axis, &along)
        });
        let (own_point, own_place) = body.joint_point;
        let shares = pins.into_iter().find_map(|(point, place)| {
            let share = share(graph, &own_point, &point)?;
            Some((point, place, share))
        });
        match shares {
            Some((point, place, share)) => {
                let far = graph.mul(share, mass);
                let near = graph.sub(mass, far);
                for (mass, point, position) in [(near, own_point, own_place), (far, point, place)] {
                    let square = graph.dot(&point, &point);
                    let taken = graph.mul(mass, square);
                    moment = graph.sub(moment, taken);
                    self.points.push(PointMass { mass, position });
                }
            }
            None => self.points.push(PointMass { mass, position: centre }),
        }
        let turned = body.turn.and_then(|(place, ..)| self.variables.iter().position(|v| v.place == place));
        if let Some(variable) = turned {
            self.moments[variable] = graph.add(self.moments[variable], moment);
        }
    }

    /// Other pins of a body, in its frame, and where they are: those that close loops as the other body has them.
    fn pins(&self, system: &mut System, moving_body: usize) -> Vec<(Vec3, Vec3)> {
        let body = system.moving_bodies[moving_body];
        let mut pins = Vec::new();
        for joint in system.tree.loop_joints.clone() {
            let joint = system.joints[joint];
            if !matches!(joint.kind, JointKind::Revolute | JointKind::Spherical | JointKind::Universal) {
                continue;
            }
            for (own, other) in [(joint.first, joint.second), (joint.second, joint.first)] {
                if own.body == body {
                    let pose = system.poses[other.body];
                    let arm = system.graph.mat_vec(&pose.a, &other.point);
                    let place = system.graph.add_vec(&pose.r, &arm);
                    let place = system.expanded(&self.coordinates.angles.poses, &place);
                    pins.push((own.point, [place[0], place[1], place[2]]));
                }
            }
        }
        for link in self.coordinates.links.iter().filter(|link| link.parent == Some(body)) {
            pins.push((link.on_parent, self.coordinates.angles.bodies[link.moving_body].joint_point.1));
        }
        pins
    }

    /// Whether positions and rows depend on the variables alone.
    fn is_in_variables(&self, system: &System) -> bool {
        let positions = self.points.iter().flat_map(|point| point.position);
        let all: Vec<_> = positions.chain(self.coordinates.closure.phi.iter().copied()).collect();
        let has = |x: usize, is_angle: bool| {
            self.variables.iter().any(|variable| variable.place.x == x && variable.is_angle == is_angle)
        };
        system.graph.reachable(&all).into_iter().all(|id| match *system.graph.node(id) {
            Node::Symbol(Symbol::Sine(x) | Symbol::Cosine(x)) => has(x, true),
            Node::Symbol(Symbol::Coordinate(x)) => has(x, false),
            Node::Symbol(Symbol::Parameter(_)) => true,
            Node::Symbol(_) => false,
            _ => true,
        })
    }

    /// What symbols change by if the variables have these rates.
    fn direction(&self, graph: &mut Graph, rates: &[ExprId]) -> Direction {
        let mut direction = Direction::new();
        for (variable, &rate) in self.variables.iter().zip(rates) {
            let x = variable.place.x;
            if variable.is_angle {
                let [sine, cosine] = [Symbol::Sine(x), Symbol::Cosine(x)].map(|symbol| graph.symbol(symbol));
                let (of_sine, of_cosine) = (graph.mul(cosine, rate), graph.mul(sine, rate));
                direction.insert(Symbol::Sine(x), of_sine);
                direction.insert(Symbol::Cosine(x), graph.neg(of_cosine));
            } else {
                direction.insert(Symbol::Coordinate(x), rate);
            }
        }
        direction
    }

    /// The derivative along rates, which are constant themselves.
    fn along(&self, graph: &mut Graph, rates: &[ExprId], roots: &[ExprId]) -> Vec<ExprId> {
        let definitions = Definitions::default();
        let mut derivative = Derivative::new(&definitions, self.direction(graph, rates));
        roots.iter().map(|&root| derivative.of(graph, root)).collect()
    }

    /// By each variable.
    fn slopes(&self, graph: &mut Graph, roots: &[ExprId]) -> Vec<Vec<ExprId>> {
        let n = self.variables.len();
        let unit =
            |k: usize| (0..n).map(|l| if k == l { Graph::ONE } else { Graph::ZERO }).collect::<Vec<_>>();
        (0..n).map(|k| self.along(graph, &unit(k), roots)).collect()
    }

    fn second_derivative(&self, graph: &mut Graph, roots: &[ExprId]) -> Vec<ExprId> {
        let rates = self.variables.iter().map(|variable| graph.symbol(Symbol::Rate(variable.place.u)));
        let rates: Vec<_> = rates.collect();
        let first = self.along(graph, &rates, roots);
        self.along(graph, &rates, &first)
    }

    fn solve(&self, system: &mut System) -> Vec<ExprId> {
        let Coordinates { closure, unit, along, layout, .. } = self.coordinates;
        let (n, gravity) = (self.variables.len(), system.numbers(&system.model.gravity));
        let graph = &mut system.graph;
        let mut matrix: BTreeMap<_, _> =
            self.moments.iter().enumerate().map(|(k, &moment)| ((k, k), moment)).collect();
        let mut forces: Vec<_> = (0..n)
            .map(|variable| {
                let parts = self.rates.iter().zip(&along[..layout.n_rates]).map(|(rates, &force)| {
                    let factor = graph.integer(rates[variable]);
                    graph.mul(factor, force)
                });
                let parts: Vec<_> = parts.collect();
                parts.into_iter().fold(Graph::ZERO, |sum, part| graph.add(sum, part))
            })
            .collect();
        for PointMass { mass, position } in &self.points {
            let slopes = self.slopes(graph, position);
            let bias = self.second_derivative(graph, position);
            for (k, slope) in slopes.iter().enumerate() {
                let felt = graph.sub_vec(&gravity, &[bias[0], bias[1], bias[2]]);
                let force = graph.dot_slices(&felt, slope);
                let force = graph.mul(*mass, force);
                forces[k] = graph.add(forces[k], force);
                for (l, other) in slopes[..=k].iter().enumerate() {
                    let product = graph.dot_slices(slope, other);
                    let product = graph.mul(*mass, product);
                    let entry = matrix.entry((k, l)).or_insert(Graph::ZERO);
                    *entry = graph.add(*entry, product);
                }
            }
        }
        let by_variable = self.slopes(graph, &closure.phi);
        let jacobian: Vec<Vec<_>> = (0..closure.phi.len())
            .map(|row| by_variable.iter().map(|column| column[row]).collect())
            .collect();
        let bias = self.second_derivative(graph, &closure.phi);
        let gamma: Vec<_> = bias.into_iter().map(|x| graph.neg(x)).collect();
        // Together: what they have in common is found.
        let all: Vec<_> =
            matrix.values().chain(&forces).chain(&gamma).chain(jacobian.iter().flatten()).copied().collect();
        let mut all = normal_form(graph, unit, &all).into_iter();
        matrix.values_mut().chain(&mut forces).zip(&mut all).for_each(|(entry, new)| *entry = new);
        matrix.retain(|_, entry| *entry != Graph::ZERO);
        let gamma: Vec<_> = all.by_ref().take(gamma.len()).collect();
        let rows: Vec<_> = all.collect();
        let rows: Vec<&[ExprId]> = rows.chunks(n).collect();
        let found = match rows[..] {
            [first, second] if n == 3 => {
                single_loop(graph, &matrix, &forces, [first, second], [gamma[0], gamma[1]])
            }
            _ => with_multipliers(graph, matrix, forces, &rows, &gamma),
        };
        let rate = |factors: &Vec<i64>| {
            factors.iter().zip(&found).fold(Graph::ZERO, |sum, (&factor, &value)| {
                let factor = graph.integer(factor);
                let part = graph.mul(factor, value);
                graph.add(sum, part)
            })
        };
        let mut all: Vec<_> = self.rates.iter().map(rate).collect();
        all.resize(layout.n_tree_rates(), Graph::ZERO);
        all
    }
}

/// Three accelerations from two rows and the balance along the motion that they leave, `t = J₁ × J₂`:
/// `z = ((γ₁ J₂ − γ₂ J₁) × M t + (t · f) t) / (t · M t)`.
fn single_loop(
    graph: &mut Graph,
    matrix: &BTreeMap<(usize, usize), ExprId>,
    forces: &[ExprId],
    rows: [&[ExprId]; 2],
    gamma: [ExprId; 2],
) -> Vec<ExprId> {
    let [first, second] = rows.map(|row| [row[0], row[1], row[2]]);
    let motion = graph.cross(&first, &second);
    let entry = |k: usize, l: usize| matrix.get(&(k.max(l), k.min(l))).copied().unwrap_or(Graph::ZERO);
    let taken = [0, 1, 2].map(|k| graph.dot(&[entry(k, 0), entry(k, 1), entry(k, 2)], &motion));
    let resistance = graph.dot(&motion, &taken);
    let driving = graph.dot_slices(forces, &motion);
    let (left, right) = (graph.scale_vec(gamma[0], &second), graph.scale_vec(gamma[1], &first));
    let difference = graph.sub_vec(&left, &right);
    let forced = graph.cross(&difference, &taken);
    let driven = graph.scale_vec(driving, &motion);
    let sum = graph.add_vec(&forced, &driven);
    let inverse = graph.recip(resistance);
    graph.scale_vec(inverse, &sum).to_vec()
}

/// `M z = f + Jᵀ μ`, `J z = γ`.
fn with_multipliers(
    graph: &mut Graph,
    matrix: BTreeMap<(usize, usize), ExprId>,
    forces: Vec<ExprId>,
    rows: &[&[ExprId]],
    gamma: &[ExprId],
) -> Vec<ExprId> {
    let columns = std::iter::once(forces).chain(rows.iter().map(|row| row.to_vec())).collect();
    let mut elimination = Elimination::of_several(matrix, columns);
    (0..rows[0].len()).rev().for_each(|unknown| elimination.pivot(graph, unknown));
    let solutions = elimination.solutions(graph);
    let (free, responses) = solutions.split_first().expect("forces are the first column");
    let mut square = BTreeMap::new();
    for (k, row) in rows.iter().enumerate() {
        for (l, response) in responses[..=k].iter().enumerate() {
            square.insert((k, l), graph.dot_slices(row, response));
        }
    }
    square.retain(|_, entry| *entry != Graph::ZERO);
    let lacking = rows.iter().zip(gamma).map(|(row, &gamma)| {
        let rate = graph.dot_slices(row, free);
        graph.sub(gamma, rate)
    });
    let lacking = lacking.collect();
    let multipliers = Elimination::new(square, lacking).solve_in_order(graph);
    let mut found = free.clone();
    for (response, &multiplier) in responses.iter().zip(&multipliers) {
        for (found, &response) in found.iter_mut().zip(response) {
            let part = graph.mul(response, multiplier);
            *found = graph.add(*found, part);
        }
    }
    found
}

/// Whether all bodies turn about one direction, and in no other way.
fn all_parallel(graph: &mut Graph, coordinates: &Coordinates) -> bool {
    let bodies = &coordinates.angles.bodies;
    let mut axes = bodies.iter().filter_map(|body| body.turn.map(|(_, _, axis)| axis));
    let Some(first) = axes.next() else { return false };
    let opposite = graph.neg_vec(&first);
    bodies.iter().all(|body| body.is_planar) && axes.all(|axis| axis == first || axis == opposite)
}

/// Which share of a mass between two points is at the second, if its centre, the origin, is on their line.
fn share(graph: &mut Graph, first: &Vec3, second: &Vec3) -> Option<ExprId> {
    let across = graph.cross(first, second);
    let arm = graph.sub_vec(second, first);
    let is_constant = first.iter().chain(second).all(|&x| graph.as_constant(x).is_some());
    if across != ZERO3 || arm == ZERO3 || !is_constant {
        return None;
    }
    let (along, square) = (graph.dot(first, &arm), graph.dot(&arm, &arm));
    let quotient = graph.div(along, square);
    Some(graph.neg(quotient))
}

fn unit(k: usize) -> Vec<i64> {
    let mut unit = vec![0; k + 1];
    unit[k] = 1;
    unit
}
