//! What parameters must satisfy, for code that sets them without this crate.

use super::inertia::is_left_out;
use super::ranges::Ranged;
use crate::{JointKind, Model, Number};

/// What must hold of numbers of which at least one is a parameter: what [`Model::with_parameters`] decides exactly.
#[derive(Clone, Debug, PartialEq)]
pub enum ParameterRule<'m> {
    /// Greater than 0.
    Positive(&'m Number),
    /// 0 or more.
    NotNegative(&'m Number),
    /// Not all 0.
    NotZero(&'m [Number]),
    /// An axis and a zero direction.
    NotParallel(&'m [Number; 3], &'m [Number; 3]),
    /// An inertia tensor, `[xx, yy, zz, xy, xz, yz]`.
    Inertia(&'m [Number; 6]),
}

impl ParameterRule<'_> {
    /// The numbers of the rule.
    pub fn numbers(&self) -> Vec<&Number> {
        match self {
            Self::Positive(number) | Self::NotNegative(number) => vec![number],
            Self::NotZero(numbers) => numbers.iter().collect(),
            Self::NotParallel(a, b) => a.iter().chain(*b).collect(),
            Self::Inertia(elements) => elements.iter().collect(),
        }
    }

    /// The place of the first parameter that decides it.
    pub fn first_parameter(&self) -> usize {
        fn first(number: &Number) -> Option<usize> {
            match number {
                Number::Parameter { index, .. } => Some(*index),
                Number::Computed(computation) => computation.operands().into_iter().find_map(first),
                Number::Formula(formula) => formula.numbers().find_map(first),
                Number::Exact(_) | Number::Input { .. } => None,
            }
        }
        self.numbers().into_iter().find_map(first).unwrap_or(0)
    }
}

impl Model {
    /// The rules that the values of parameters can break, in the order of the model file.
    pub fn parameter_rules(&self) -> Vec<ParameterRule<'_>> {
        use ParameterRule::{Inertia, NotParallel, NotZero};
        let mut rules = Vec::new();
        rules.extend(self.attraction.iter().flat_map(|attraction| Ranged::of_attraction(attraction).rules()));
        for body in &self.bodies {
            rules.extend(Ranged::of_body(0, body).rules());
            if !is_left_out(body, &body.inertia) {
                rules.push(Inertia(&body.inertia));
            }
            rules.push(NotZero(&body.orientation));
            rules.extend(
                body.motion.iter().flat_map(|motion| &motion.rotations).map(|(axis, _)| NotZero(axis)),
            );
        }
        for joint in &self.joints {
            rules.extend(Ranged::of_joint(0, joint).rules());
            rules.extend(joint.start.orientation.iter().map(|p| NotZero(p)));
            let ends = [&joint.first, &joint.second];
            if !matches!(joint.kind, JointKind::Rod | JointKind::Spherical) {
                rules.extend(ends.map(|end| NotParallel(&end.axis, &end.zero)));
            }
        }
        let frames =
            self.outputs.iter().flat_map(|output| output.kind.frames()).chain(self.frames_of_forces());
        rules.extend(frames.filter_map(|frame| frame.orientation.as_ref()).map(|p| NotZero(p)));
        rules.extend(self.couplers.iter().flat_map(|coupler| Ranged::of_coupler(0, coupler).rules()));
        rules.extend(self.forces.iter().flat_map(|force| Ranged::of_force(0, force).rules()));
        rules.extend(self.elements.iter().flat_map(|element| Ranged::of_element(0, element).rules()));
        for divisor in self.numbers().into_iter().flat_map(Number::divisors) {
            let rule = NotZero(std::slice::from_ref(divisor));
            if !rules.contains(&rule) {
                rules.push(rule);
            }
        }
        rules.retain(|rule| rule.numbers().iter().any(|number| number.has_parameters()));
        rules
    }
}
