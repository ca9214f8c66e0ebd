//! Why a model cannot be assembled.

use gyro_model::{AssemblyError, Model, Tree};
use std::fmt;

/// Why there is no mechanism of a model.
#[derive(Clone, Debug, PartialEq)]
pub enum BuildError {
    /// The model has no consistent start.
    Start(AssemblyError),
    /// The chosen form does not support the model.
    Unsupported(Unsupported),
}

/// What keeps a model from the careful form, which does trees of revolute, spherical and fixed joints, or from the
/// recursive one, which does trees of all joints.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Unsupported {
    /// A joint of another kind, by its name.
    JointKind(String),
    /// A joint that closes a loop, by its name.
    Loop(String),
    /// A body that no joint connects to a root, by its name.
    Unconnected(String),
    /// A coupler, by its name.
    Coupler(String),
    /// A driver of a joint coordinate, by its name.
    Driver(String),
    /// Constraint rows that depend on others.
    RedundantRows,
}

impl Unsupported {
    /// What of a model no form along trees does.
    ///
    /// # Errors
    /// The first thing of it.
    pub(crate) fn beyond_trees(model: &Model) -> Result<(), Self> {
        let tree = Tree::of(model);
        let first = |name: Option<&String>, what: fn(String) -> Self| {
            name.map_or(Ok(()), |name| Err(what(name.clone())))
        };
        let looped = tree.loop_joints.first().map(|&joint| &model.joints[joint]);
        let unreached = tree.unreached.first().map(|&body| &model.bodies[body]);
        first(looped.map(|joint| &joint.name), Self::Loop)?;
        first(unreached.map(|body| &body.name), Self::Unconnected)?;
        first(model.couplers.first().map(|coupler| &coupler.name), Self::Coupler)?;
        first(model.drivers.first().map(|driver| &driver.name), Self::Driver)?;
        if model.redundant.is_empty() { Ok(()) } else { Err(Self::RedundantRows) }
    }
}

impl fmt::Display for BuildError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Start(error) => error.fmt(f),
            Self::Unsupported(what) => what.fmt(f),
        }
    }
}

impl fmt::Display for Unsupported {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kinds =
            if matches!(self, Self::JointKind(_)) { " of revolute, spherical and fixed joints" } else { "" };
        write!(f, "elimination along trees{kinds} cannot do ")?;
        match self {
            Self::JointKind(name) => write!(f, "joint `{name}`"),
            Self::Loop(name) => write!(f, "joint `{name}`, which closes a loop"),
            Self::Unconnected(name) => write!(f, "body `{name}`, which hangs on nothing"),
            Self::Coupler(name) => write!(f, "coupler `{name}`"),
            Self::Driver(name) => write!(f, "driver `{name}`"),
            Self::RedundantRows => write!(f, "redundant constraint rows"),
        }
    }
}

impl std::error::Error for BuildError {}
impl std::error::Error for Unsupported {}
