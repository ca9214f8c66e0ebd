//! The start: positions and velocities that satisfy every constraint.
//!
//! Open trees are placed from their roots to their leaves, exactly. Everything else starts from there as a guess and is
//! projected onto the constraints with the least change.

mod branch;
mod closing;
mod error;
mod guess;
mod links;
pub(crate) mod projection;
mod side;
mod states;
mod stops;
mod tolerance;
mod velocity;
mod walk;

pub use error::AssemblyError;
pub use tolerance::{START_TOLERANCE, StartTolerances};

use crate::{JointCoordinate, Model, Quaternion, RowOwner, Tree, kinematics::Kinematics};
use guess::guesses;
use walk::{Walk, roots};

/// Consistent positions and velocities at time zero.
#[derive(Clone, Debug, PartialEq)]
pub struct Start {
    /// For each body of [`Model::coordinate_bodies`] seven numbers: position of the mass centre (m, global) and unit
    /// Euler parameters. A child's Euler parameters are the ones nearer to its parent's.
    pub q: Vec<f64>,
    /// For each of them six numbers: velocity of the mass centre (m/s, global) and w' (rad/s, body frame).
    pub v: Vec<f64>,
    /// The joints' own coordinates, in the order of [`Model::joints`].
    pub joints: Vec<JointStart>,
    /// The states, in the order of [`Model::states`].
    pub states: Vec<f64>,
    /// What the assembly had to move to close the mechanism, farthest first; nothing for open trees.
    pub moved: Vec<Move>,
}

/// Coordinates and rates of one joint at time zero, from its first body to its second.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct JointStart {
    /// The joint's scalar coordinates in the order of [`crate::JointKind::coordinates`]: angles in rad, turns included,
    /// displacements in m. Spherical: Euler parameters of the second body in the first body's frame. Fixed, rod: empty.
    pub position: Vec<f64>,
    /// Their rates, rad/s or m/s. Spherical: relative angular velocity in the second body's frame.
    pub rate: Vec<f64>,
}

impl Start {
    /// How far a coordinate of a joint starts from where the model file has it, with its sign, rad or m; how far the
    /// orientation of a spherical joint is turned from it, rad. NaN where the model file does not say.
    pub fn moved_from_given(&self, model: &Model, of: JointCoordinate) -> f64 {
        let (given, now) = (&model.joints[of.joint].start, &self.joints[of.joint].position);
        if let Some(orientation) = &given.orientation {
            let given = Quaternion::unit(&crate::kinematics::exact(model, orientation));
            let (Some(given), &[a, b, c, d]) = (given, &now[..]) else { return f64::NAN };
            let turn = projection::rotation_vector(given.conjugate() * Quaternion([a, b, c, d]));
            return turn.iter().map(|x| x * x).sum::<f64>().sqrt();
        }
        let given = given.position.get(of.coordinate).and_then(Option::as_ref);
        given.map_or(f64::NAN, |given| now[of.coordinate] - model.value(given))
    }
}

/// How far the assembly moved a joint or a body from where the model file placed it or guessed it to be.
#[derive(Clone, Debug, PartialEq)]
pub struct Move {
    /// A joint or a body.
    pub owner: RowOwner,
    /// Its name.
    pub name: String,
    /// The joint's coordinate, or `"orientation"`, `"position"`, `"velocity"` or `"angular velocity"`.
    pub coordinate: &'static str,
    /// How far: with its sign for a scalar coordinate, a distance or an angle otherwise.
    pub amount: f64,
    /// Its unit: `"rad"`, `"m"`, `"m/s"` or `"rad/s"`.
    pub unit: &'static str,
}

impl Model {
    /// Positions and velocities that satisfy Φ = 0 and Φ_q q̇ = ν at t = 0 to rounding, with the parameters as they
    /// are.
    ///
    /// Walks [`Tree`] from the roots: a joint's coordinates and rates (or the child's absolute angular velocity) place
    /// the child on its parent; driven coordinates start where their drivers are. Joint frames are exact up to one
    /// rounding. If the joints make open trees without couplers, this is all.
    ///
    /// Otherwise that pose is a guess. It is moved by the least change (rotations in rad, lengths by [`Model::size`],
    /// both by the root of [`crate::Body::assembly_weight`]) that satisfies all rows, redundant ones too, and keeps the
    /// coordinates that the model file gives and does not call rough. The same holds for the velocities, with all rates
    /// that the model file gives.
    ///
    /// # Errors
    /// An unconnected body; rows or given coordinates and rates that cannot be met, with the one that misses most; a
    /// pose on another branch than the guess (opposite axes, or beyond a pose where branches meet, if the guess tells
    /// all coordinates of the tree) or a quarter turn away from it; a link whose ends coincide; a joint beyond a rigid
    /// stop; a state that does not come to rest; a start beyond `f64`.
    pub fn assemble(&self) -> Result<Start, AssemblyError> {
        let tree = Tree::of(self);
        if let Some(&body) = tree.unreached.first() {
            return Err(AssemblyError::Unconnected { body, name: self.bodies[body].name.clone() });
        }
        let start = if self.is_open(&tree) { self.walked(&tree)? } else { closing::assemble(self)? };
        links::check(self, &start)?;
        stops::check(self, &start)?;
        let states = states::at(self, &start)?;
        Ok(Start { states, ..start })
    }

    /// Whether joint coordinates place every body, so that the assembly moves nothing.
    pub fn is_placed_by_trees(&self) -> bool {
        self.is_open(&Tree::of(self))
    }

    /// The start of open trees.
    fn walked(&self, tree: &Tree) -> Result<Start, AssemblyError> {
        let kinematics = Kinematics::at(self, 0.0);
        let guesses = guesses(self);
        let walk = Walk::of(self, tree, kinematics.joints(), &guesses, roots(self, tree));
        walk.finish(&tree.links)
    }

    /// Whether joint coordinates, each chosen freely or by one driver, place every body: then the rows are independent.
    pub(crate) fn is_open(&self, tree: &Tree) -> bool {
        let mut driven: Vec<_> =
            self.drivers.iter().map(|d| (d.coordinate.joint, d.coordinate.coordinate)).collect();
        driven.sort_unstable();
        tree.is_open() && self.couplers.is_empty() && driven.windows(2).all(|pair| pair[0] != pair[1])
    }

    /// An owner of rows as messages name it: ``joint `x` ``.
    pub(crate) fn named(&self, owner: RowOwner) -> String {
        let (kind, name) = match owner {
            RowOwner::Body(body) => ("body", &self.bodies[body].name),
            RowOwner::Joint(joint) => ("joint", &self.joints[joint].name),
            RowOwner::Coupler(coupler) => (self.couplers[coupler].word(), &self.couplers[coupler].name),
            RowOwner::Driver(driver) => ("driver", &self.drivers[driver].name),
        };
        format!("{kind} `{name}`")
    }
}
