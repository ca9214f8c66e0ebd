//! Groups of functions that a module has together or not at all: a trait of the run time's contract each.

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
    pub fn on_request() -> impl Iterator<Item = Self> {
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

    /// Whether modules have it unless something else is asked for.
    pub fn is_usual(self) -> bool {
        self.row().is_usual
    }

    /// All groups in the order in which a module's text has their traits.
    pub fn in_text() -> impl Iterator<Item = Self> {
        use Group::*;
        let first = [Mechanism, Partition, Kinematics, Maximal, Projection, Corrected, Joint, Reactions];
        first.into_iter().chain(Self::all().filter(move |group| !first.contains(group)))
    }

    /// Itself with the groups without which it cannot be.
    pub fn with_needs(self) -> Vec<Self> {
        [&[Self::Mechanism], self.row().needs, &[self]].concat()
    }

    fn row(self) -> &'static Row {
        &TABLE[self as usize]
    }
}
