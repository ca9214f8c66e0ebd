//! Masses, inertias, directions and coefficients, decided exactly.

use num_traits::{Signed, Zero};

use super::{Place, Problem, Side, shown};
use crate::assemble::cross;
use crate::number::{SIZE_EXPONENT, in_range};
use crate::{Body, Joint, JointEnd, JointKind, Model, Number, Rational, Support};

/// Every unphysical number, in the order of the page.
pub(crate) fn problems(model: &Model) -> Vec<Problem> {
    let mut found: Vec<Problem> = parameter_sizes(model).collect();
    for (index, body) in model.bodies.iter().enumerate() {
        found.extend(mass(model, index, body));
        found.extend(inertia(model, index, body));
        found.extend(orientation(model, index, body));
    }
    for (index, joint) in model.joints.iter().enumerate() {
        found.extend(friction(model, index, joint));
        found.extend(joint_orientation(model, index, joint));
        if joint.kind != JointKind::Spherical {
            found.extend(joint_directions(model, index));
        }
    }
    found
}

/// Parameters can be set from outside; the numbers of the page were checked as they were read.
fn parameter_sizes(model: &Model) -> impl Iterator<Item = Problem> {
    model.parameters.iter().enumerate().filter(|(_, p)| !in_range(&p.value)).map(|(index, p)| Problem {
        place: Place { owner: super::Owner::Parameter(index), key: "" },
        also: None,
        message: format!("parameter `{}` is too large or too small to compute with", p.name),
        label: format!("{} here", shown(&p.value)),
        help: format!("a number is 0, or its size is between 1e-{SIZE_EXPONENT} and 1e{SIZE_EXPONENT}"),
    })
}

/// A folded body may leave its mass and inertia out.
fn is_left_out(body: &Body, numbers: &[Number]) -> bool {
    body.support == Support::Fixed && numbers.iter().all(Number::is_zero)
}

fn mass(model: &Model, index: usize, body: &Body) -> Option<Problem> {
    let value = model.exact(&body.mass);
    if value.is_positive() || is_left_out(body, std::slice::from_ref(&body.mass)) {
        return None;
    }
    Some(Problem {
        place: Place::body(index, "mass"),
        also: None,
        message: format!("the mass of body `{}` is not positive", body.name),
        label: format!("{} kg", shown(&value)),
        help: "write a mass greater than 0, in kg".to_owned(),
    })
}

fn inertia(model: &Model, index: usize, body: &Body) -> Option<Problem> {
    if is_left_out(body, &body.inertia) {
        return None;
    }
    let tensor = Tensor(body.inertia.each_ref().map(|x| model.exact(x)));
    let problem = |message: String, label: &str, help: &str| Problem {
        place: Place::body(index, "inertia"),
        also: None,
        message,
        label: label.to_owned(),
        help: help.to_owned(),
    };
    if !tensor.is_positive() {
        let message = format!("the inertia of body `{}` is not positive definite", body.name);
        let help = "every moment of inertia about an axis through the mass centre must be greater than 0; a thin \
                    rod needs a small one about its own axis";
        return Some(problem(message, "turning about some axis would cost no energy", help));
    }
    if !tensor.of_mass().is_semidefinite() {
        let message = format!("the inertia of body `{}` breaks the triangle inequality", body.name);
        let help = "no principal moment of inertia may exceed the sum of the other two; check the unit (kg.m2) and \
                    that products of inertia are entered as elements of the tensor, xy = -(integral of x y dm)";
        return Some(problem(message, &tensor.triangle_label(), help));
    }
    None
}

fn orientation(model: &Model, index: usize, body: &Body) -> Option<Problem> {
    zero_parameters(
        model,
        &body.orientation,
        Place::body(index, "orientation"),
        &format!("body `{}`", body.name),
    )
}

fn joint_orientation(model: &Model, index: usize, joint: &Joint) -> Option<Problem> {
    let parameters = joint.start.orientation.as_ref()?;
    zero_parameters(model, parameters, Place::joint(index, "orientation"), &format!("joint `{}`", joint.name))
}

fn zero_parameters(model: &Model, parameters: &[Number; 4], place: Place, of: &str) -> Option<Problem> {
    parameters.iter().all(|x| model.exact(x).is_zero()).then(|| Problem {
        place,
        also: None,
        message: format!("the Euler parameters of {of} are all zero"),
        label: "no direction to normalise".to_owned(),
        help: "write [1, 0, 0, 0] for no rotation: (cos(angle/2), axis * sin(angle/2))".to_owned(),
    })
}

fn friction(model: &Model, index: usize, joint: &Joint) -> Option<Problem> {
    let value = model.exact(&joint.friction);
    value.is_negative().then(|| Problem {
        place: Place::joint(index, "friction"),
        also: None,
        message: format!("the friction of joint `{}` is negative", joint.name),
        label: format!("{} N.m.s/rad would drive the joint", shown(&value)),
        help: "write a coefficient of 0 or more".to_owned(),
    })
}

/// The directions of both ends; once where they are the same.
fn joint_directions(model: &Model, index: usize) -> Vec<Problem> {
    let Joint { name, first, second, .. } = &model.joints[index];
    if (&first.axis, &first.zero) == (&second.axis, &second.zero) {
        return directions(model, index, Side::First, &format!("joint `{name}`")).into_iter().collect();
    }
    let of = |side: Side| format!("joint `{name}` on its {} body", side.key());
    Side::BOTH.into_iter().filter_map(|side| directions(model, index, side, &of(side))).collect()
}

/// The axis and the zero direction of one end.
fn directions(model: &Model, index: usize, side: Side, of: &str) -> Option<Problem> {
    let joint = &model.joints[index];
    let end = match side {
        Side::First => &joint.first,
        Side::Second => &joint.second,
    };
    let [axis, zero] = exact_directions(model, end);
    let place = |key| Place::end(index, side, key);
    let problem = |key, message: String, label: &str, help: String| Problem {
        place: place(key),
        also: None,
        message,
        label: label.to_owned(),
        help,
    };
    let vanishes = |v: &[Rational; 3]| v.iter().all(Zero::is_zero);
    for (key, direction) in [("axis", &axis), ("zero", &zero)] {
        if vanishes(direction) {
            let message = format!("the {key} direction of {of} is zero");
            let help = format!("write a direction of any length but 0, such as {key} = [0, 0, 1]");
            return Some(problem(key, message, "has no direction", help));
        }
    }
    vanishes(&cross(&axis, &zero)).then(|| {
        let message = format!("the zero direction of {of} is parallel to its axis");
        let help = format!(
            "angles are measured across the axis: write a direction off it, such as zero = {}",
            off(&axis)
        );
        let also = Some((place("axis"), "the axis".to_owned()));
        Problem { also, ..problem("zero", message, "parallel to the axis", help) }
    })
}

fn exact_directions(model: &Model, end: &JointEnd) -> [[Rational; 3]; 2] {
    [&end.axis, &end.zero].map(|v| v.each_ref().map(|x| model.exact(x)))
}

/// A coordinate direction far from an axis.
fn off(axis: &[Rational; 3]) -> &'static str {
    let smallest = (0..3).min_by_key(|&k| axis[k].abs());
    ["[1, 0, 0]", "[0, 1, 0]", "[0, 0, 1]"][smallest.unwrap_or(0)]
}

/// A symmetric matrix: `[xx, yy, zz, xy, xz, yz]`.
struct Tensor([Rational; 6]);

impl Tensor {
    /// The tensor of second moments of mass, ∫ ρ ρᵀ dm = ½ tr(J) I − J. It is positive semidefinite exactly if no
    /// principal moment exceeds the sum of the others, and singular for a lamina.
    fn of_mass(&self) -> Self {
        let [xx, yy, zz, xy, xz, yz] = &self.0;
        let half = (xx + yy + zz) / Rational::from_integer(2.into());
        Self([&half - xx, &half - yy, &half - zz, -xy, -xz, -yz])
    }

    /// The three principal minors of order two: of xy, xz and yz.
    fn minors(&self) -> [Rational; 3] {
        let [xx, yy, zz, xy, xz, yz] = &self.0;
        [xx * yy - xy * xy, xx * zz - xz * xz, yy * zz - yz * yz]
    }

    fn determinant(&self) -> Rational {
        let [xx, yy, zz, xy, xz, yz] = &self.0;
        xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz)
    }

    /// Positive definite: the leading principal minors are positive (Sylvester).
    fn is_positive(&self) -> bool {
        self.0[0].is_positive() && self.minors()[0].is_positive() && self.determinant().is_positive()
    }

    /// Positive semidefinite: no principal minor is negative.
    fn is_semidefinite(&self) -> bool {
        let minors = self.minors();
        !self.0[..3].iter().chain(&minors).chain([&self.determinant()]).any(Signed::is_negative)
    }

    /// Which moment exceeds the sum of the others, where a diagonal element already does.
    fn triangle_label(&self) -> String {
        let names = ["xx", "yy", "zz"];
        let excess = (0..3).find(|&k| self.of_mass().0[k].is_negative());
        match excess {
            Some(k) => {
                let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                let sum = shown(&(&self.0[i] + &self.0[j]));
                format!(
                    "{} = {} exceeds {} + {} = {sum}",
                    names[k],
                    shown(&self.0[k]),
                    names[i.min(j)],
                    names[i.max(j)]
                )
            }
            None => "a principal moment exceeds the sum of the other two".to_owned(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tensor(elements: [i64; 6]) -> Tensor {
        Tensor(elements.map(|x| Rational::from_integer(x.into())))
    }

    #[test]
    fn inertias_are_decided_on_the_boundary() {
        let check = |elements: [i64; 6], positive: bool, triangle: bool| {
            let tensor = tensor(elements);
            assert_eq!(tensor.is_positive(), positive, "{elements:?}");
            assert_eq!(tensor.of_mass().is_semidefinite(), triangle, "{elements:?}");
        };
        check([1, 1, 1, 0, 0, 0], true, true);
        check([1, 1, 2, 0, 0, 0], true, true);
        check([1_000_000, 1_000_000, 2_000_001, 0, 0, 0], true, false);
        check([0, 1, 1, 0, 0, 0], false, true);
        check([2, 2, 2, 2, 0, 0], false, false);
        check([2, 2, 2, 1, 0, 0], true, true);
        // Principal moments 1, 3 and 4: a lamina that is turned about z; then a little more than a lamina allows.
        check([2, 2, 4, 1, 0, 0], true, true);
        check([20, 20, 41, 10, 0, 0], true, false);
        check([-1, -1, 1, 0, 0, 0], false, false);
    }
}
