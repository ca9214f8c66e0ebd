//! What a compiled program can do: the functions that it asks for, and its own lines.

use crate::args::Precision;
use crate::scene::Scene;
use gyro_codegen::{Functions, Group, Module};
use gyro_runner::{Approach, Coordinates, Correction};

/// What a program can do: the less, the sooner it is compiled.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Runs {
    coordinates: Coordinates,
    correction: Correction,
    /// By implicit methods.
    is_implicit: bool,
    /// Linearised, and looked at for singular poses.
    is_examined: bool,
    /// With rigid stops or friction that sticks.
    touches: bool,
    /// Whether the mechanism has joint coordinates, in which other runs can be made.
    joint_space: bool,
}

impl Runs {
    /// What a scene asks for; `None` for what only a program for all runs can do.
    pub(crate) fn of(scene: &Scene) -> Option<Self> {
        let Approach { integrator, coordinates, correction, examine, .. } = scene.approach;
        let is_implicit = integrator.is_implicit();
        let is_plain = matches!(correction, Correction::Partition | Correction::None);
        let runs = Self {
            is_implicit,
            is_examined: examine,
            touches: scene.offers.touches,
            joint_space: scene.offers.joint_space,
            ..Self::with(coordinates, correction)
        };
        (!is_implicit || is_plain || coordinates == Coordinates::Joint).then_some(runs)
    }

    /// Runs by explicit methods of a mechanism with joint coordinates, not examined.
    pub(crate) fn with(coordinates: Coordinates, correction: Correction) -> Self {
        Self {
            coordinates,
            correction,
            is_implicit: false,
            is_examined: false,
            touches: false,
            joint_space: true,
        }
    }

    /// The same, with rigid stops or friction that sticks.
    pub(crate) fn touching(self) -> Self {
        Self { touches: true, ..self }
    }

    /// The same, linearised and looked at.
    pub(crate) fn examined(self) -> Self {
        Self { is_examined: true, ..self }
    }

    /// Whether they are linearised.
    pub(crate) fn is_examined(self) -> bool {
        self.is_examined
    }

    /// The functions that they call: each run begins with a look for singular poses, which the partition finds.
    pub(crate) fn functions(self) -> Functions {
        let of_runs: &[Group] = match (self.coordinates, self.correction, self.is_implicit) {
            (Coordinates::Joint, _, true) => &[Group::Joint, Group::Jacobian],
            (Coordinates::Joint, _, false) => &[Group::Joint],
            (_, Correction::MassWeighted | Correction::Baumgarte(_), _) => {
                &[Group::Maximal, Group::Projection]
            }
            (_, _, true) | (_, Correction::None, _) => &[Group::Maximal],
            (_, Correction::ClosedForm, _) => &[Group::Corrected, Group::Joint],
            (_, Correction::Partition, _) => &[Group::Corrected],
        };
        let touching: &[Group] = if self.touches { &[Group::Joint] } else { &[] };
        let examined: &[Group] = if self.is_examined { &[Group::Joint, Group::Jacobian] } else { &[] };
        Functions::of([&[Group::Partition], of_runs, touching, examined].concat())
    }

    /// With what motions are begun.
    fn builder(self, module: &Module, precision: &str) -> String {
        let of = "::gyro_runner::motion";
        let has_jacobian = module.implements("JointJacobian");
        let kind = match (self.coordinates, self.correction, self.is_implicit) {
            (Coordinates::Joint, _, true) if has_jacobian => format!("{of}::ImplicitInJoints"),
            (Coordinates::Joint, _, true) => in_duals("ImplicitInJointsByDuals", precision),
            (Coordinates::Joint, _, false) => format!("{of}::InJoints"),
            (_, _, true) => in_duals("Implicit", precision),
            (_, Correction::Partition, _) => format!("{of}::Partitioned"),
            (_, Correction::ClosedForm, _) => format!("{of}::InClosedForm"),
            (_, Correction::MassWeighted, _) => format!("{of}::Projected"),
            (_, Correction::Baumgarte(_), _) => format!("{of}::Stabilised"),
            (_, Correction::None, _) => format!("{of}::Direct"),
        };
        let kind = if self.touches { format!("{of}::Touching({kind})") } else { kind };
        let runs = format!("{of}::Only {{ kind: {kind}, joint_space: {} }}", self.joint_space);
        let linearised = match (self.joint_space, has_jacobian) {
            (false, _) => format!("{of}::Nothing"),
            (_, true) => in_duals("ByJacobian", precision),
            (_, false) => in_duals("ByDuals", precision),
        };
        if self.is_examined {
            format!("{of}::Examined {{ runs: {runs}, linearised: {linearised} }}")
        } else {
            runs
        }
    }
}

/// The builder of a program for all runs.
fn builder_of_all(module: &Module, precision: &str) -> String {
    match (module.implements("JointSpace"), module.implements("JointJacobian")) {
        (true, true) => in_duals("TreeWithJacobian", precision),
        (true, false) => in_duals("Tree", precision),
        (false, _) => in_duals("WithDuals", precision),
    }
}

/// The program's own lines: with what motions are begun is decided by what runs are to be made, and by what the module
/// implements. Nothing is imported: a mechanism may have the name of anything.
pub(crate) fn main(module: &Module, precision: Precision, runs: Option<Runs>) -> String {
    main_by("::gyro_runner::child::main", module, precision, runs, "")
}

/// The same with another function that answers requests, and what that is told besides.
pub(crate) fn main_by(
    answer: &str,
    module: &Module,
    precision: Precision,
    runs: Option<Runs>,
    more: &str,
) -> String {
    let (type_name, precision) = (&module.type_name, precision.name());
    let builder = match runs {
        Some(runs) => runs.builder(module, precision),
        None => builder_of_all(module, precision),
    };
    format!(
        "#[allow(warnings, clippy::all)]
mod mechanism;

fn build<T: ::gyro_sim::Scalar>(parameters: &[f64]) -> mechanism::{type_name}<T> {{
    let mut built = mechanism::{type_name}::<T>::default();
    for (index, value) in parameters.iter().enumerate() {{
        built.set_parameter(index, <T as ::gyro_sim::Scalar>::constant(*value));
    }}
    built
}}

fn main() -> ::std::process::ExitCode {{
    {answer}(|parameters| (build::<{precision}>(parameters), {builder}){more})
}}
"
    )
}

/// A builder with the mechanism in dual numbers.
fn in_duals(builder: &str, precision: &str) -> String {
    let dual = format!("::gyro_sim::Dual<{precision}, {{ ::gyro_runner::motion::COLUMNS }}>");
    format!("::gyro_runner::motion::{builder}(build::<{dual}>(parameters))")
}
