//! Mechanisms with loops, rods or couplers: the guess is projected onto the constraints.

use super::error::AssemblyError;
use super::guess::{Guess, Source, Told, guesses};
use super::projection::{Configuration, Scales, System, rotation_vector, scattered};
use super::velocity::{given_velocity, velocities};
use super::walk::{State, Walk, check_finite, relative, roots};
use super::{JointStart, Move, Start, branch, side};
use crate::kinematics::{Equation, Kinematics};
use crate::{JointCoordinate, JointKind, Model, Quaternion, Row, RowOwner, Tree, Vector};

/// Starts that are tried around a guess from which the mechanism does not close: a guess may be so symmetric that no
/// step leads away from it.
const ATTEMPTS: usize = 6;

/// How far the first of them is from the guess, rad or parts of the size; the next ones are farther by as much.
const SCATTER: f64 = 0.05;

/// Moves below this (rad or parts of the size) are not reported.
const MOVED: f64 = 1e-9;

/// The start of a mechanism whose trees alone do not place it, from the first guess from which it closes.
pub(super) fn assemble(model: &Model) -> Result<Start, AssemblyError> {
    let guesses = guesses(model);
    let [first, second] = trees(model, &guesses);
    let start = assembled(model, &guesses, &first);
    if start.is_ok() || second.links == first.links {
        return start;
    }
    assembled(model, &guesses, &second).or(start)
}

/// The trees along which bodies may be guessed. What the model file says of joints is taken into account as far as
/// possible: joints without a start close the loops, and joints with some of their coordinates given are preferred to
/// them. For a body that only joints without a start and points on lines hold, the better guess may be the joint's zero
/// or the body's own orientation: both are tried.
fn trees(model: &Model, guesses: &[Guess]) -> [Tree; 2] {
    let ranked = |untold_turns: u8, untold_lines: u8| {
        Tree::along(model, |joint| match (model.joints[joint].kind.turns(), guesses[joint].told()) {
            (true, Told::All) => 0,
            (true, Told::Part) => 1,
            (true, Told::Nothing) => untold_turns,
            (false, Told::All | Told::Part) => 3,
            (false, Told::Nothing) => untold_lines,
        })
    };
    [ranked(2, 3), ranked(5, 4)]
}

fn assembled(model: &Model, guesses: &[Guess], tree: &Tree) -> Result<Start, AssemblyError> {
    let (kinematics, scales) = (Kinematics::at(model, 0.0), Scales::of(model));
    let guessed = Walk::of(model, tree, kinematics.joints(), guesses, roots(model, tree));
    check_finite(model, &tree.links, &guessed.states)?;
    let guess = configuration(&kinematics, tree, guesses, &guessed);
    let chooses = chooses_branch(tree, guesses);
    let closing = Closing { model, kinematics: &kinematics, scales: &scales, chooses };
    let closed = closing.positions(guesses, &guess)?;
    branch::check(model, &kinematics, &guess, &closed)?;

    let (placed, states) = settled(model, tree, guesses, &guessed.states, &closed);
    let walk = Walk::of(model, tree, kinematics.joints(), &placed, states);
    let (q, from) = walk.layout();
    let at = Configuration { near: kinematics.coordinates(&q, &closed.near), q };
    let v = velocities(model, &kinematics, &scales, &placed, &at, &from)?;
    let states = states_of(model, &walk.states, &at.q, &v);
    check_finite(model, &tree.links, &states)?;
    let joints = joint_starts(&kinematics, &states, &at, &v);
    let moved = moves(model, tree, &scales, [&guessed.states, &states], [&guess, &at]);
    Ok(Start { q: at.q, v, joints, states: Vec::new(), moved })
}

/// Whether the model file gives every coordinate that places a body on another: a pose that nobody wrote chooses
/// nothing.
fn chooses_branch(tree: &Tree, guesses: &[Guess]) -> bool {
    tree.links.iter().all(|link| match link.attachment {
        crate::Attachment::Joint { joint, .. } => guesses[joint].told() == Told::All,
        _ => true,
    })
}

/// The guessed pose, with the turns of angles as they are guessed; a screw of which nothing is known is on the turn
/// that its displacement tells.
fn configuration(kinematics: &Kinematics, tree: &Tree, guesses: &[Guess], walk: &Walk<'_>) -> Configuration {
    let q = walk.layout().0;
    let mut near: Vec<Vec<f64>> = guesses.iter().map(|guess| guess.position.clone()).collect();
    let poses: Vec<_> = kinematics.poses(&q).iter().map(crate::kinematics::value_of).collect();
    for &joint in &tree.loop_joints {
        let geometry = &kinematics.joints()[joint];
        let is_unknown = guesses[joint].source.first() == Some(&Source::Unknown);
        if geometry.kind == JointKind::Screw && geometry.lead != 0.0 && is_unknown {
            let advance =
                kinematics.posed(joint, &poses).coordinate(crate::CoordinateKind::Displacement, 0.0);
            near[joint][0] = advance / geometry.lead;
        }
    }
    Configuration { near: kinematics.coordinates(&q, &near), q }
}

/// What is to be closed.
struct Closing<'a> {
    model: &'a Model,
    kinematics: &'a Kinematics,
    scales: &'a Scales,
    /// Whether the guess chooses a branch.
    chooses: bool,
}

impl Closing<'_> {
    /// The closed configuration nearest to the guess, with the coordinates held that the model file holds.
    fn positions(&self, guesses: &[Guess], guess: &Configuration) -> Result<Configuration, AssemblyError> {
        let rows = self.kinematics.of_positions();
        let held = held(guesses);
        let all = System::new(self.kinematics, [&rows[..], &held].concat(), self.scales);
        let free = System::new(self.kinematics, rows, self.scales);
        match self.close(&all, guess) {
            Ok(closed) => self.on_branch(&all, guess, all.approach(closed, guess)),
            Err(_) => match self.close(&free, guess) {
                Ok(closed) => Err(self.cannot_hold(&held, &free.approach(closed, guess))),
                Err(best) => Err(self.impossible(&free, &best)),
            },
        }
    }

    /// The closed configuration if it is on the branch of the guess, or another one that is.
    fn on_branch(
        &self,
        system: &System<'_>,
        guess: &Configuration,
        closed: Configuration,
    ) -> Result<Configuration, AssemblyError> {
        let is_good = |at: &Configuration| system.is_met(at) && side::is_same(system, guess, at);
        if !self.chooses || side::is_same(system, guess, &closed) {
            return Ok(closed);
        }
        let gradual = || system.approach(side::close_gradually(system, guess), guess);
        let scattered = (1..=ATTEMPTS).map(|attempt| system.project(&self.near(system, guess, attempt)));
        let mut others = std::iter::once_with(gradual).chain(scattered);
        others.find(is_good).ok_or_else(|| branch::other(self.model, guess, &closed))
    }

    /// A configuration near the guess, for another attempt.
    fn near(&self, system: &System<'_>, guess: &Configuration, attempt: usize) -> Configuration {
        let away = scattered(self.scales.columns.len(), attempt) * (SCATTER * attempt as f64);
        system.moved(guess, &away)
    }

    /// Meets the equations from the guess or from near it; else how near one comes.
    fn close(&self, system: &System<'_>, guess: &Configuration) -> Result<Configuration, Configuration> {
        let mut best: Option<(f64, Configuration)> = None;
        for attempt in 0..=ATTEMPTS {
            let closed = system.project(&self.near(system, guess, attempt));
            if system.is_met(&closed) {
                return Ok(closed);
            }
            let left = system.residual(&closed).norm();
            if best.as_ref().is_none_or(|(least, _)| left < *least) {
                best = Some((left, closed));
            }
        }
        Err(best.map_or_else(|| guess.clone(), |(_, closed)| closed))
    }

    /// Names the row that remains violated most.
    fn impossible(&self, system: &System<'_>, at: &Configuration) -> AssemblyError {
        let equations = self.kinematics.of_positions();
        let (scaled, phi) = (system.residual(at), self.kinematics.values(&equations, &at.q, &at.near));
        let worst = scaled.iamax();
        let is_there = |row: &&Row| equations.contains(&Equation::Rows(row.owner));
        let row = *self.kinematics.rows().iter().filter(is_there).nth(worst).expect("rows of the equations");
        AssemblyError::Impossible {
            owner: row.owner,
            name: self.model.named(row.owner),
            residual: phi[worst],
            unit: row.unit,
        }
    }

    /// Names the coordinate that would have to change most.
    fn cannot_hold(&self, held: &[Equation], closed: &Configuration) -> AssemblyError {
        let left = |equation: &Equation| {
            let system = System::new(self.kinematics, vec![*equation], self.scales);
            let left = system.residual(closed).amax();
            // The vector part of Euler parameters is half the angle.
            if matches!(equation, Equation::Orientation { .. }) { 2.0 * left } else { left }
        };
        let worst = held.iter().max_by(|a, b| left(a).total_cmp(&left(b)));
        let worst = worst.expect("holding them made the difference");
        let (joint, coordinate, nearest, unit) = match *worst {
            Equation::Coordinate { of, .. } => {
                let kind = self.model.coordinate_kind(of);
                let nearest = closed.near[of.joint][of.coordinate];
                (of.joint, kind.name(), Some(nearest), if kind.is_angle() { "rad" } else { "m" })
            }
            Equation::Orientation { joint, .. } => (joint, "orientation", None, "rad"),
            Equation::Rows(_) => unreachable!("only coordinates are held"),
        };
        let size = if unit == "m" { self.scales.size } else { 1.0 };
        let name = self.model.joints[joint].name.clone();
        AssemblyError::Held { joint, name, coordinate, off_by: left(worst) * size, nearest, unit }
    }
}

/// Equations of the coordinates that the model file gives and does not call rough.
fn held(guesses: &[Guess]) -> Vec<Equation> {
    let mut held = Vec::new();
    for (joint, guess) in guesses.iter().enumerate() {
        for (coordinate, &value) in guess.position.iter().enumerate() {
            if guess.source[coordinate] == Source::Held {
                held.push(Equation::Coordinate { of: JointCoordinate { joint, coordinate }, value });
            }
        }
        if let (Some(value), false) = (guess.orientation, guess.is_rough) {
            held.push(Equation::Orientation { joint, value });
        }
    }
    held
}

/// The joints' starts as the closed configuration has them, and the bodies there, to walk the trees once more: that
/// meets the rows of their joints to rounding and gives velocities to begin with.
fn settled(
    model: &Model,
    tree: &Tree,
    guesses: &[Guess],
    guessed: &[State],
    closed: &Configuration,
) -> (Vec<Guess>, Vec<State>) {
    let still = vec![0.0; 6 * model.coordinate_bodies().len()];
    let mut states = states_of(model, guessed, &closed.q, &still);
    for link in &tree.links {
        (states[link.body].s, states[link.body].w) = (guessed[link.body].s, guessed[link.body].w);
    }
    let settled = guesses.iter().enumerate().map(|(joint, guess)| {
        let [i, j] = [&model.joints[joint].first, &model.joints[joint].second].map(|end| states[end.body].p);
        let orientation = Some((i.conjugate() * j).normalised());
        Guess { position: closed.near[joint].clone(), orientation, ..guess.clone() }
    });
    (settled.collect(), states)
}

/// The states of all bodies, of which those with coordinates are given.
fn states_of(model: &Model, all: &[State], q: &[f64], v: &[f64]) -> Vec<State> {
    let mut states = all.to_vec();
    for (moving_body, body) in model.coordinate_bodies().into_iter().enumerate() {
        let [x, y, z, a, b, c, d] = std::array::from_fn(|k| q[7 * moving_body + k]);
        let [s, w] = [0, 3].map(|at| Vector::from(std::array::from_fn(|k| v[6 * moving_body + at + k])));
        states[body] = State { r: Vector::from([x, y, z]), p: Quaternion([a, b, c, d]), s, w };
    }
    states
}

fn joint_starts(kinematics: &Kinematics, states: &[State], at: &Configuration, v: &[f64]) -> Vec<JointStart> {
    let rates = kinematics.rates(&at.q, v, &at.near);
    let starts = kinematics.joints().iter().zip(at.near.iter().zip(rates));
    let start = |(joint, (position, rate)): (&crate::kinematics::JointGeometry, (&Vec<f64>, Vec<f64>))| {
        if joint.kind != JointKind::Spherical {
            return JointStart { position: position.clone(), rate };
        }
        let turn = relative(states, joint);
        let [first, second] = [&joint.first, &joint.second].map(|end| states[end.body].w);
        JointStart { position: turn.0.to_vec(), rate: (second - turn.rotate_back(first)).as_slice().to_vec() }
    };
    starts.map(start).collect()
}

/// How far joints of the trees, and bodies that no joint holds, have been moved; the farthest first.
fn moves(
    model: &Model,
    tree: &Tree,
    scales: &Scales,
    states: [&[State]; 2],
    [guess, closed]: [&Configuration; 2],
) -> Vec<Move> {
    let mut moves = Vec::new();
    let mut add = |owner, name: &str, coordinate, amount: f64, is_angle: bool| {
        let unit = if is_angle { "rad" } else { "m" };
        moves.push(Move { owner, name: name.to_owned(), coordinate, amount, unit });
    };
    for (index, joint) in model.joints.iter().enumerate().filter(|(k, _)| !tree.loop_joints.contains(k)) {
        let owner = RowOwner::Joint(index);
        for (k, kind) in joint.kind.coordinates().iter().enumerate() {
            let amount = closed.near[index][k] - guess.near[index][k];
            add(owner, &joint.name, kind.name(), amount, kind.is_angle());
        }
        if matches!(joint.kind, JointKind::Spherical | JointKind::PointOnLine) {
            let turn =
                |states: &[State]| states[joint.first.body].p.conjugate() * states[joint.second.body].p;
            let [before, after] = states.map(turn);
            add(owner, &joint.name, "orientation", angle_between(before, after), true);
        }
    }
    for link in tree.links.iter().filter(|link| link.attachment == crate::Attachment::Free) {
        let (owner, name) = (RowOwner::Body(link.body), &model.bodies[link.body].name);
        let [before, after] = states.map(|states| states[link.body]);
        add(owner, name, "position", (after.r - before.r).norm(), false);
        add(owner, name, "orientation", angle_between(before.p, after.p), true);
    }
    for link in tree.links.iter().filter(|link| link.attachment == crate::Attachment::Free) {
        let body = &model.bodies[link.body];
        let [before, after] = states.map(|states| states[link.body]);
        let mut add = |coordinate, amount, unit| {
            let (owner, name) = (RowOwner::Body(link.body), body.name.clone());
            moves.push(Move { owner, name, coordinate, amount, unit });
        };
        if given_velocity(body) {
            add("velocity", (after.s - before.s).norm(), "m/s");
        }
        if body.angular_velocity.is_some() {
            add("angular velocity", (after.w - before.w).norm(), "rad/s");
        }
    }
    let far = |m: &Move| m.amount.abs() / if m.unit.starts_with("m") { scales.size } else { 1.0 };
    moves.retain(|m| far(m) > MOVED);
    moves.sort_by(|a, b| far(b).total_cmp(&far(a)));
    moves
}

fn angle_between(a: Quaternion, b: Quaternion) -> f64 {
    Vector::from(rotation_vector(a.conjugate() * b)).norm()
}
