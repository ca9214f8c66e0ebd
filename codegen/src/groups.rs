//! Groups of functions that a module has together or not at all: a trait of the run time's contract each.

use std::collections::BTreeSet;

/// Functions that a module has together or not at all.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(missing_docs, reason = "`Group::what` says what each of them is")]
pub enum Group {
    Mechanism,
    Kinematics,
    Maximal,
    Corrected,
    Reactions,
    Projection,
    Partition,
    Joint,
    Jacobian,
    ParameterJacobian,
    JointOutputs,
    OutputDerivatives,
    Frames,
    Inverse,
    MassMatrix,
    Derivatives,
    Regressor,
}

/// What is known of a group.
struct Row {
    group: Group,
    /// Its name on the command line and in model files.
    name: &'static str,
    /// The trait of the run time that its functions are.
    trait_name: &'static str,
    /// What it is, in words.
    what: &'static str,
    /// The groups without which it cannot be.
    needs: &'static [Group],
    /// Whether modules have it unless something else is asked for.
    is_usual: bool,
}

/// All groups, a row for each variant of [`Group`] in the same order.
#[rustfmt::skip]
const TABLE: &[Row] = &[
    Row { group: Group::Mechanism, name: "mechanism", trait_name: "Mechanism", needs: &[], is_usual: true, what: "what every module has" },
    Row { group: Group::Kinematics, name: "kinematics", trait_name: "Kinematics", needs: &[], is_usual: true, what: "derivatives of the constraints" },
    Row { group: Group::Maximal, name: "maximal", trait_name: "Dynamics", needs: &[], is_usual: true, what: "eq. (17) at any state" },
    Row { group: Group::Corrected, name: "corrected", trait_name: "CorrectedDynamics", needs: &[Group::Joint], is_usual: true, what: "accelerations at corrected states" },
    Row { group: Group::Reactions, name: "reactions", trait_name: "CorrectedSolution", needs: &[Group::Joint, Group::Corrected], is_usual: false, what: "multipliers at corrected states" },
    Row { group: Group::Projection, name: "projection", trait_name: "Projection", needs: &[Group::Kinematics], is_usual: false, what: "the projection that the masses weigh" },
    Row { group: Group::Partition, name: "partition", trait_name: "Partition", needs: &[Group::Kinematics], is_usual: true, what: "the coordinate partition" },
    Row { group: Group::Joint, name: "joint", trait_name: "JointSpace", needs: &[], is_usual: true, what: "joint coordinates" },
    Row { group: Group::Jacobian, name: "jacobian", trait_name: "JointJacobian", needs: &[Group::Joint], is_usual: false, what: "derivatives of the joint form" },
    Row { group: Group::ParameterJacobian, name: "parameter_jacobian", trait_name: "ParameterJacobian", needs: &[Group::Joint], is_usual: false, what: "derivatives of the joint form by parameters" },
    Row { group: Group::JointOutputs, name: "joint_outputs", trait_name: "JointOutputs", needs: &[Group::Joint], is_usual: false, what: "outputs of a joint state" },
    Row { group: Group::OutputDerivatives, name: "output_derivatives", trait_name: "OutputDerivatives", needs: &[Group::Joint, Group::JointOutputs], is_usual: false, what: "derivatives of the outputs" },
    Row { group: Group::Frames, name: "frames", trait_name: "Frames", needs: &[Group::Joint], is_usual: false, what: "how outputs of kind `velocity` move with a joint state" },
    Row { group: Group::Inverse, name: "inverse", trait_name: "InverseDynamics", needs: &[Group::Joint], is_usual: false, what: "forces for given accelerations" },
    Row { group: Group::MassMatrix, name: "mass_matrix", trait_name: "MassMatrix", needs: &[Group::Joint], is_usual: false, what: "the mass matrix and its factor" },
    Row { group: Group::Derivatives, name: "derivatives", trait_name: "DynamicsDerivatives", needs: &[Group::Joint, Group::Inverse], is_usual: false, what: "derivatives of forces and accelerations" },
    Row { group: Group::Regressor, name: "regressor", trait_name: "Regressor", needs: &[Group::Joint], is_usual: false, what: "forces as a product with inertial parameters" },
];

const _: () = {
    let mut place = 0;
    while place < TABLE.len() {
        assert!(TABLE[place].group as usize == place, "the table has the order of the variants");
        place += 1;
    }
};

impl Group {
    /// All groups.
    pub fn all() -> impl Iterator<Item = Self> {
        TABLE.iter().map(|row| row.group)
    }

    /// Those that only who asks for them calls.
    pub(crate) fn on_request() -> impl Iterator<Item = Self> {
        use Group::*;
        let of_states = [ParameterJacobian, JointOutputs, OutputDerivatives, Frames];
        of_states.into_iter().chain([Inverse, MassMatrix, Derivatives, Regressor])
    }

    /// Its name on the command line and in model files.
    pub fn name(self) -> &'static str {
        self.row().name
    }

    /// The trait of the run time that its functions are.
    pub fn trait_name(self) -> &'static str {
        self.row().trait_name
    }

    /// What it is, in words.
    pub fn what(self) -> &'static str {
        self.row().what
    }

    /// Itself with the groups without which it cannot be.
    pub fn with_needs(self) -> Vec<Self> {
        [&[Self::Mechanism], self.row().needs, &[self]].concat()
    }

    fn row(self) -> &'static Row {
        &TABLE[self as usize]
    }
}

/// What a mechanism makes of groups.
#[derive(Clone, Copy, Debug)]
pub struct Facts {
    /// Whether joint coordinates describe it.
    pub joint_coordinates: bool,
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
        Self::of(Group::all().filter(|group| group.row().is_usual))
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

    /// What is written of these for a mechanism: without joint coordinates accelerations at corrected states are those
    /// at any state, which outputs may need too; and a partition that goes through joint coordinates needs them.
    pub(crate) fn of_mechanism(mut self, facts: Facts) -> Self {
        let has_own = facts.joint_coordinates && !facts.work_of_loops;
        if facts.outputs_of_motion || self.has(Group::Corrected) && !has_own {
            self.0.insert(Group::Maximal);
        }
        if facts.outputs_of_multipliers && self.has(Group::JointOutputs) {
            // They are proved for these multipliers.
            self.0.extend(Group::Reactions.with_needs());
        }
        if self.has(Group::Partition) && facts.joint_partition {
            self.0.insert(Group::Joint);
        }
        if !facts.joint_coordinates {
            [Group::Joint, Group::Jacobian, Group::ParameterJacobian, Group::Reactions].iter().for_each(
                |group| {
                    self.0.remove(group);
                },
            );
        }
        self
    }
}
