//! Groups of functions that a module has together or not at all.

use std::collections::BTreeSet;

/// Functions that a module has together or not at all.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Group {
    /// What every module has: `Mechanism`, `Partition` and `Equations`.
    Maximal,
    /// `JointSpace`.
    Joint,
    /// The Jacobians of `JointSpace`, whose types are `()` in modules without them.
    Jacobian,
    /// `InverseDynamics`.
    Inverse,
    /// `MassMatrix`.
    MassMatrix,
    /// `DynamicsDerivatives`.
    Derivatives,
    /// `Regressor`.
    Regressor,
}

impl Group {
    /// All groups.
    pub fn all() -> impl Iterator<Item = Self> {
        Self::usual().chain(Self::on_request())
    }

    /// Those of which modules consist unless something else is asked for.
    fn usual() -> impl Iterator<Item = Self> {
        [Self::Maximal, Self::Joint, Self::Jacobian].into_iter()
    }

    /// Those that are there where they are asked for.
    pub(crate) fn on_request() -> impl Iterator<Item = Self> {
        [Self::Inverse, Self::MassMatrix, Self::Derivatives, Self::Regressor].into_iter()
    }

    /// Its name on the command line and in model files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Maximal => "maximal",
            Self::Joint => "joint",
            Self::Jacobian => "jacobian",
            Self::Inverse => "inverse",
            Self::MassMatrix => "mass_matrix",
            Self::Derivatives => "derivatives",
            Self::Regressor => "regressor",
        }
    }

    /// What it is, in words.
    pub const fn what(self) -> &'static str {
        match self {
            Self::Maximal => "what every module has (traits Mechanism, Partition, Equations)",
            Self::Joint => "joint coordinates (trait JointSpace)",
            Self::Jacobian => "derivatives of the joint form, with `joint` (JointSpace::Jacobian)",
            Self::Inverse => "forces for given accelerations, on request (trait InverseDynamics)",
            Self::MassMatrix => "M and its factor, on request (trait MassMatrix)",
            Self::Regressor => "forces as a product with inertial parameters, on request (trait Regressor)",
            Self::Derivatives => {
                "derivatives of forces and accelerations, on request (trait DynamicsDerivatives)"
            }
        }
    }

    /// Itself with the groups without which it cannot be.
    pub fn with_needs(self) -> Vec<Self> {
        match self {
            Self::Maximal => vec![self],
            Self::Joint => vec![Self::Maximal, self],
            Self::Jacobian | Self::Inverse | Self::MassMatrix | Self::Regressor => {
                vec![Self::Maximal, Self::Joint, self]
            }
            Self::Derivatives => vec![Self::Maximal, Self::Joint, Self::Inverse, self],
        }
    }
}

/// The functions that are asked for, a group at a time: a group is what a trait of the run time's contract consists of,
/// or a part of it that can be absent. What is not asked for is neither derived nor written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Functions(BTreeSet<Group>);

impl Functions {
    /// All that the generator knows of.
    pub fn all() -> Self {
        Self(Group::all().collect())
    }

    /// What a module has unless something else is asked for.
    pub fn usual() -> Self {
        Self(Group::usual().collect())
    }

    /// Some groups, each with what it needs. What solvers and observers of every mechanism need is always there.
    pub(crate) fn of(groups: impl IntoIterator<Item = Group>) -> Self {
        let groups = groups.into_iter().chain([Group::Maximal]);
        Self(groups.flat_map(Group::with_needs).collect())
    }

    /// The same without one of the groups and those that need it.
    #[must_use]
    pub fn without(mut self, group: Group) -> Self {
        self.0.retain(|other| !other.with_needs().contains(&group));
        self
    }

    /// Whether a group is asked for.
    pub fn has(&self, group: Group) -> bool {
        self.0.contains(&group)
    }
}
