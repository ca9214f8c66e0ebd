//! Forces besides a uniform gravity: what each does to the bodies, what energy it stores, what power it has.

use crate::derive::attraction::{self, Field};
use crate::derive::bushings::Held;
use crate::derive::joint_coordinate::{self, Load, relative_spin};
use crate::derive::laws::{self, Line, OfBodies, Own, Readings};
use crate::derive::points::PointOfBody;
use crate::derive::system::System;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::vector::{Vec3, ZERO3};
use gyro_model::{Force, ForceKind, JointCoordinate, JointKind, LoadFrame, Number, StopSide};

/// All forces together.
#[derive(Debug)]
pub struct Forces {
    /// On each body of the model.
    pub loads: Vec<Load>,
    /// The part of them that does not act along joint coordinates.
    pub other_loads: Vec<Load>,
    /// Energy stored in springs, and that of bodies near a central one.
    pub potential: ExprId,
    /// Power of the forces that store none.
    pub power: ExprId,
    /// The part of it that links, bushings and loads have: those that act between points of bodies, not along a joint's
    /// coordinates.
    pub power_at_points: ExprId,
}

/// A force along a joint coordinate.
pub struct Along {
    pub on: JointCoordinate,
    pub force: ExprId,
    /// Stored energy; a force that stores none has power.
    pub potential: Option<ExprId>,
}

/// All forces that act along joint coordinates.
pub fn along_coordinates(system: &mut System, readings: &impl Readings) -> Vec<Along> {
    let (joints, forces) = (&system.model.joints, &system.model.forces);
    let mut all = Vec::new();
    for (index, joint) in joints.iter().enumerate() {
        if !joint.damping.is_zero() && joint.kind != JointKind::Spherical {
            let on = JointCoordinate { joint: index, coordinate: 0 };
            all.push(damper(system, readings, on, &joint.damping));
        }
    }
    for force in forces {
        all.extend(along(system, readings, force));
        all.extend(along_slopes(system, readings, &force.kind));
    }
    all
}

/// `−∂V/∂x` along each coordinate of a potential, `−½ ∂P/∂ẋ` along each of a dissipation.
fn along_slopes(system: &mut System, readings: &impl Readings, kind: &ForceKind) -> Vec<Along> {
    let Some((formula, along)) = kind.slopes() else { return Vec::new() };
    let stores = matches!(kind, ForceKind::Potential { .. });
    let one = |(index, (on, by))| {
        let (value, slope) = laws::with_slope(system, formula, readings, by);
        let half = system.graph.fraction(1, 2);
        let pull = if stores { slope } else { system.graph.mul(half, slope) };
        // The energy is stored once.
        let potential = stores.then_some(if index == 0 { value } else { Graph::ZERO });
        Along { on, force: system.graph.neg(pull), potential }
    };
    along.into_iter().enumerate().map(one).collect()
}

fn along(system: &mut System, readings: &impl Readings, force: &Force) -> Option<Along> {
    match &force.kind {
        ForceKind::Spring { on, stiffness, free } => {
            let (x, [stiffness, free]) = (readings.value(system, *on), numbers(system, [stiffness, free]));
            let (force, stored) = spring(&mut system.graph, stiffness, x, free);
            Some(Along { on: *on, force, potential: Some(stored) })
        }
        ForceKind::Damper { on, damping } => Some(damper(system, readings, *on, damping)),
        ForceKind::Coulomb { on, level, rate } => {
            let (speed, rate) = (readings.rate(system, *on), system.number(rate));
            let level = laws::strength(system, readings, level);
            let ratio = system.graph.div(speed, rate);
            let sliding = system.graph.tanh(ratio);
            let drag = system.graph.mul(level, sliding);
            Some(Along { on: *on, force: system.graph.neg(drag), potential: None })
        }
        ForceKind::Stop { on, limit, side, stiffness, damping, softness } => {
            let [limit, stiffness, softness] = numbers(system, [limit, stiffness, softness]);
            let damping = laws::strength(system, readings, damping);
            let numbers = [limit, stiffness, damping, softness];
            let (x, rate) = (readings.value(system, *on), readings.rate(system, *on));
            let force = stop(&mut system.graph, *side, (x, rate), numbers);
            Some(Along { on: *on, force, potential: None })
        }
        ForceKind::Motor { on, value } => {
            Some(Along { on: *on, force: laws::strength(system, readings, value), potential: None })
        }
        ForceKind::Link { .. }
        | ForceKind::Bushing(_)
        | ForceKind::Load { .. }
        | ForceKind::Potential { .. }
        | ForceKind::Dissipation { .. } => None,
    }
}

fn damper(system: &mut System, readings: &impl Readings, on: JointCoordinate, damping: &Number) -> Along {
    let (speed, damping) = (readings.rate(system, on), laws::strength(system, readings, damping));
    let drag = system.graph.mul(damping, speed);
    Along { on, force: system.graph.neg(drag), potential: None }
}

impl Forces {
    pub fn of(system: &mut System) -> Self {
        let none = Load { force: ZERO3, torque: ZERO3 };
        let loads = vec![none; system.model.bodies.len()];
        let mut forces = Self {
            other_loads: loads.clone(),
            loads,
            potential: Graph::ZERO,
            power: Graph::ZERO,
            power_at_points: Graph::ZERO,
        };
        for joint in 0..system.joints.len() {
            forces.add_damping(system, joint);
        }
        let power_of_damping = std::mem::replace(&mut forces.power, Graph::ZERO);
        for force in &system.model.forces {
            forces.add_link(system, &force.kind);
            forces.add_bushing(system, &force.kind);
            forces.add_load(system, &force.kind);
        }
        forces.add_attraction(system);
        forces.power_at_points = forces.power;
        forces.power = system.graph.add(power_of_damping, forces.power);
        forces.other_loads = forces.loads.clone();
        for along in along_coordinates(system, &OfBodies) {
            forces.add_along(system, &along);
        }
        forces
    }

    /// The viscous damping of a spherical joint.
    fn add_damping(&mut self, system: &mut System, index: usize) {
        let damping = &system.model.joints[index].damping;
        let joint = system.joints[index];
        if damping.is_zero() || joint.kind != JointKind::Spherical {
            return;
        }
        let (coefficient, spin) = (system.number(damping), relative_spin(system, &joint));
        let graph = &mut system.graph;
        let drag = graph.scale_vec(coefficient, &spin);
        let (on_first, on_second) = (graph.mat_vec(&joint.relative, &drag), graph.neg_vec(&drag));
        let loss = graph.dot(&drag, &spin);
        self.power = graph.sub(self.power, loss);
        self.push(system, joint.first.body, &Load { force: ZERO3, torque: on_first });
        self.push(system, joint.second.body, &Load { force: ZERO3, torque: on_second });
    }

    fn add_along(&mut self, system: &mut System, along: &Along) {
        let on = along.on;
        let bodies = [system.joints[on.joint].first.body, system.joints[on.joint].second.body];
        for (body, load) in bodies.into_iter().zip(joint_coordinate::unit_loads(system, on)) {
            let load = load.scaled(&mut system.graph, along.force);
            self.push(system, body, &load);
        }
        if let Some(potential) = along.potential {
            self.potential = system.graph.add(self.potential, potential);
        } else {
            let rate = joint_coordinate::rate(system, on);
            let power = system.graph.mul(along.force, rate);
            self.power = system.graph.add(self.power, power);
        }
    }

    /// Between two points: along the line from the first to the second.
    fn add_link(&mut self, system: &mut System, kind: &ForceKind) {
        let Some(Pull { ends, unit, rate, drag, stored, force, .. }) = Pull::of(system, kind) else { return };
        let graph = &mut system.graph;
        let on_second = graph.scale_vec(force, &unit);
        let on_first = graph.neg_vec(&on_second);
        let loss = graph.mul(drag, rate);
        self.power = graph.sub(self.power, loss);
        self.potential = graph.add(self.potential, stored);
        for (end, force) in ends.iter().zip([on_first, on_second]) {
            let load = load_at(system, end, &force);
            self.push(system, end.body, &load);
        }
    }

    /// Between two frames.
    fn add_bushing(&mut self, system: &mut System, kind: &ForceKind) {
        let ForceKind::Bushing(bushing) = kind else { return };
        let Held { loads, stored, power, .. } = Held::of(system, bushing);
        self.potential = system.graph.add(self.potential, stored);
        self.power = system.graph.add(self.power, power);
        for (frame, load) in bushing.ends().into_iter().zip(&loads) {
            self.push(system, frame.body, load);
        }
    }

    /// Of a central body on each body with coordinates.
    fn add_attraction(&mut self, system: &mut System) {
        for moving_body in 0..system.moving_bodies.len() {
            let body = system.moving_bodies[moving_body];
            let r = system.poses[body].r;
            let Some(field) = Field::at(system, &r) else { return };
            let mass = system.mass(moving_body);
            let force = system.graph.scale_vec(mass, &field.acceleration);
            self.push(system, body, &Load { force, torque: ZERO3 });
        }
        let stored = attraction::potential(system);
        self.potential = system.graph.add(self.potential, stored);
    }

    fn add_load(&mut self, system: &mut System, kind: &ForceKind) {
        let ForceKind::Load { body, point, force, torque, frame } = kind else { return };
        let end = &PointOfBody::new(system, *body, point);
        let [given_force, given_torque] =
            [force, torque].map(|v| v.each_ref().map(|x| laws::strength(system, &OfBodies, x)));
        let pose = system.poses[*body];
        let graph = &mut system.graph;
        let (force, torque) = match frame {
            LoadFrame::Global => (given_force, graph.transposed_vec(&pose.a, &given_torque)),
            LoadFrame::Body => (graph.mat_vec(&pose.a, &given_force), given_torque),
        };
        let (pushing, turning) = (graph.dot(&force, &end.velocity), graph.dot(&torque, &pose.w));
        let power = graph.add(pushing, turning);
        self.power = graph.add(self.power, power);
        let load = load_at(system, end, &force);
        let torque = system.graph.add_vec(&load.torque, &torque);
        self.push(system, *body, &Load { force: load.force, torque });
    }

    fn push(&mut self, system: &mut System, body: usize, load: &Load) {
        self.loads[body] = self.loads[body].plus(&mut system.graph, load);
    }

    /// The power that has to be fed in to move bodies as prescribed against these forces.
    pub fn power_of_driven_bodies(&self, system: &mut System) -> ExprId {
        let mut power = Graph::ZERO;
        for (body, load) in self.loads.iter().enumerate() {
            if system.model.bodies[body].motion.is_some() {
                let pose = system.poses[body];
                let graph = &mut system.graph;
                let (pushed, turned) = (graph.dot(&load.force, &pose.s), graph.dot(&load.torque, &pose.w));
                let done = graph.add(pushed, turned);
                power = graph.sub(power, done);
            }
        }
        power
    }
}

/// What a link does along its line.
struct Pull {
    ends: [PointOfBody; 2],
    /// From the first end to the second.
    unit: Vec3,
    length: ExprId,
    rate: ExprId,
    drag: ExprId,
    stored: ExprId,
    force: ExprId,
}

impl Pull {
    fn of(system: &mut System, kind: &ForceKind) -> Option<Self> {
        let ForceKind::Link { first, second, stiffness, damping, free_length, tension } = kind else {
            return None;
        };
        let ends = [first, second].map(|(body, point)| PointOfBody::new(system, *body, point));
        let [stiffness, free] = numbers(system, [stiffness, free_length]);
        let graph = &mut system.graph;
        let (d, d_dot) = (
            graph.sub_vec(&ends[1].position, &ends[0].position),
            graph.sub_vec(&ends[1].velocity, &ends[0].velocity),
        );
        let square = graph.dot(&d, &d);
        let length = graph.sqrt(square);
        let inverse = graph.recip(length);
        let unit = graph.scale_vec(inverse, &d);
        let rate = graph.dot(&unit, &d_dot);
        let line = Line { length, rate };
        let [damping, tension] =
            [damping, tension].map(|number| laws::own_strength(system, Own::Line(&line), number));
        let graph = &mut system.graph;
        let (elastic, stored) = spring(graph, stiffness, length, free);
        let drag = graph.mul(damping, rate);
        let drag = graph.add(drag, tension);
        let force = graph.sub(elastic, drag);
        Some(Self { ends, unit, length, rate, drag, stored, force })
    }
}

/// Force and deflection of a spring; force, length and its rate of a link.
pub fn elastic(system: &mut System, force: usize) -> Vec<ExprId> {
    let kind = &system.model.forces[force].kind;
    match kind {
        ForceKind::Spring { on, stiffness, free } => {
            let (x, [stiffness, free]) =
                (joint_coordinate::value(system, *on), numbers(system, [stiffness, free]));
            let (force, _) = spring(&mut system.graph, stiffness, x, free);
            vec![force, system.graph.sub(x, free)]
        }
        _ => Pull::of(system, kind).map(|pull| vec![pull.force, pull.length, pull.rate]).unwrap_or_default(),
    }
}

impl Load {
    pub fn plus(&self, graph: &mut Graph, other: &Self) -> Self {
        Self {
            force: graph.add_vec(&self.force, &other.force),
            torque: graph.add_vec(&self.torque, &other.torque),
        }
    }

    pub fn scaled(&self, graph: &mut Graph, factor: ExprId) -> Self {
        Self { force: graph.scale_vec(factor, &self.force), torque: graph.scale_vec(factor, &self.torque) }
    }
}

/// A force at a point, global frame.
fn load_at(system: &mut System, end: &PointOfBody, force: &Vec3) -> Load {
    let a = system.poses[end.body].a;
    let in_body = system.graph.transposed_vec(&a, force);
    Load { force: *force, torque: system.graph.cross(&end.point, &in_body) }
}

/// `−stiffness (x − free)`, and the energy stored: half the stiffness times the square.
fn spring(graph: &mut Graph, stiffness: ExprId, x: ExprId, free: ExprId) -> (ExprId, ExprId) {
    let stretch = graph.sub(x, free);
    let pull = graph.mul(stiffness, stretch);
    let (half, double) = (graph.fraction(1, 2), graph.mul(pull, stretch));
    (graph.neg(pull), graph.mul(half, double))
}

/// The smooth end stop of `ForceKind::Stop`.
fn stop(
    graph: &mut Graph,
    side: StopSide,
    (x, rate): (ExprId, ExprId),
    [limit, stiffness, damping, softness]: [ExprId; 4],
) -> ExprId {
    let beyond = graph.sub(x, limit);
    let depth = if side == StopSide::Upper { beyond } else { graph.neg(beyond) };
    let square = graph.dot(&[depth, softness], &[depth, softness]);
    let (root, half) = (graph.sqrt(square), graph.fraction(1, 2));
    let (sum, quotient) = (graph.add(depth, root), graph.div(depth, root));
    let (ramp, slope) = (graph.mul(half, sum), graph.add(Graph::ONE, quotient));
    let slope = graph.mul(half, slope);
    let push = graph.mul(stiffness, ramp);
    let push = if side == StopSide::Upper { graph.neg(push) } else { push };
    let (resistance, drag) = (graph.mul(damping, slope), rate);
    let drag = graph.mul(resistance, drag);
    graph.sub(push, drag)
}

fn numbers<const N: usize>(system: &mut System, numbers: [&Number; N]) -> [ExprId; N] {
    numbers.map(|number| system.number(number))
}
