//! The functions that are asked for, a group at a time.

use gyro_program::Group;
use std::collections::BTreeSet;

/// What a mechanism makes of groups.
#[derive(Clone, Copy, Debug)]
pub struct Facts {
    /// Whether its partition goes through joint coordinates.
    pub joint_partition: bool,
    /// Whether an output tells accelerations or multipliers.
    pub outputs_of_motion: bool,
    /// Whether an output tells multipliers.
    pub outputs_of_multipliers: bool,
    /// Whether work is counted that multipliers of loops do.
    pub work_of_loops: bool,
}

/// The functions that are asked for, a group at a time. What is not asked for is neither derived nor written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Functions(BTreeSet<Group>);

impl Functions {
    /// All that the generator knows of.
    pub fn all() -> Self {
        Self(Group::all().collect())
    }

    /// What a module has unless something else is asked for: Φ, Φ_q and γ, what direct integration and coordinate
    /// partitioning call, and joint coordinates.
    pub fn usual() -> Self {
        Self::of(Group::all().filter(|group| group.is_usual()))
    }

    /// What solvers, their corrections and linearisations call.
    pub fn of_solvers() -> Self {
        Self::of(Group::all().filter(|&group| Group::on_request().all(|other| other != group)))
    }

    /// Some groups, each with what it needs. What solvers and observers of every mechanism need is always there.
    pub fn of(groups: impl IntoIterator<Item = Group>) -> Self {
        let groups = groups.into_iter().chain([Group::Mechanism]);
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

    /// What is written of these for a mechanism: where work of loops is counted accelerations at corrected states are
    /// those at any state, which outputs may need too; and a partition that goes through joint coordinates needs them.
    pub(crate) fn of_mechanism(mut self, facts: Facts) -> Self {
        if facts.outputs_of_motion || self.has(Group::Corrected) && facts.work_of_loops {
            self.0.insert(Group::Maximal);
        }
        if facts.outputs_of_multipliers && self.has(Group::JointOutputs) {
            // They are proved for these multipliers.
            self.0.extend(Group::Reactions.with_needs());
        }
        if self.has(Group::Partition) && facts.joint_partition {
            self.0.insert(Group::Joint);
        }
        self
    }
}
