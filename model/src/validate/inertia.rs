//! Masses and inertia tensors, decided exactly.

use num_traits::Signed;

use super::{Place, Problem, rounded, shown};
use crate::number::{SIZE_EXPONENT, in_range};
use crate::{Body, Model, Number, Rational, Support};

/// A folded body may leave its mass and inertia out.
pub(super) fn is_left_out(body: &Body, numbers: &[Number]) -> bool {
    matches!(body.support, Support::Fixed | Support::Driven) && numbers.iter().all(Number::is_zero)
}

/// What point masses make of a body: what is written was checked as it was read.
pub(super) fn size(model: &Model, index: usize, body: &Body) -> Option<Problem> {
    let numbers = std::iter::once(&body.mass).chain(&body.inertia);
    let mut numbers = numbers.chain(&body.frame).chain(&body.position).chain(&body.velocity);
    let is_wide = numbers.any(|number| !in_range(&model.exact(number)));
    is_wide.then(|| {
        Problem::new(
            Place::body(index, "point_mass"),
            format!("body `{}` with its point masses is too large or too small to compute with", body.name),
            "make a moment of inertia or a place of such a size",
            format!("a number is 0, or its size is between 1e-{SIZE_EXPONENT} and 1e{SIZE_EXPONENT}"),
        )
    })
}

/// Whether tensor elements xx, yy, zz, xy, xz, yz are those of a rigid body: positive definite, and no principal moment
/// above the sum of the others by more than a billionth of all three: moments of plates and rods that a program summed
/// up are off by their last digits.
pub fn is_inertia(elements: [Rational; 6]) -> bool {
    let tensor = Tensor(elements);
    tensor.is_positive() && tensor.of_mass().is_semidefinite()
}

/// The inertia tensor of a body.
pub(super) fn inertia(model: &Model, index: usize, body: &Body) -> Option<Problem> {
    if is_left_out(body, &body.inertia) {
        return None;
    }
    let tensor = Tensor(body.inertia.each_ref().map(|x| model.exact(x)));
    let problem = |message: String, label: &str, help: &str| {
        Problem::new(Place::body(index, "inertia"), message, label.to_owned(), help.to_owned())
    };
    if !tensor.is_positive() {
        let message = format!("the inertia of body `{}` is not positive definite", body.name);
        let help = "every moment of inertia about an axis through the mass centre must be greater than 0; a thin \
                    rod needs a small one about its own axis";
        return Some(problem(message, "turning about some axis would cost no energy", help));
    }
    if !body.as_written && !tensor.of_mass().is_semidefinite() {
        let message = format!("the inertia of body `{}` breaks the triangle inequality", body.name);
        let help = "no principal moment of inertia may exceed the sum of the other two; check the unit (kg.m2) and \
                    that products of inertia are entered as elements of the tensor, xy = -(integral of x y dm); to \
                    compute with the numbers as they are, write as_written = true";
        return Some(problem(message, &tensor.triangle_label(), help));
    }
    None
}

/// A symmetric matrix: `[xx, yy, zz, xy, xz, yz]`.
struct Tensor([Rational; 6]);

impl Tensor {
    /// The tensor of second moments of mass, ∫ ρ ρᵀ dm = ½ tr(J) I − J. It is positive semidefinite exactly if no
    /// principal moment exceeds the sum of the others, and singular for a lamina; half of what rounding may have taken
    /// is added to each moment.
    fn of_mass(&self) -> Self {
        let [xx, yy, zz, xy, xz, yz] = &self.0;
        let half = (xx + yy + zz) * (Rational::from_integer(1.into()) + rounded())
            / Rational::from_integer(2.into());
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
        check([1_000_000_000, 1_000_000_000, 2_000_000_001, 0, 0, 0], true, true);
        check([1_000_000_000, 1_000_000_000, 2_000_000_005, 0, 0, 0], true, false);
        check([0, 1, 1, 0, 0, 0], false, true);
        check([2, 2, 2, 2, 0, 0], false, false);
        check([2, 2, 2, 1, 0, 0], true, true);
        // Principal moments 1, 3 and 4: a lamina that is turned about z; then a little more than a lamina allows.
        check([2, 2, 4, 1, 0, 0], true, true);
        check([20, 20, 41, 10, 0, 0], true, false);
        check([-1, -1, 1, 0, 0, 0], false, false);
    }
}
