//! Motions prescribed in time.

use num_dual::Dual2_64;

use crate::scalar::{Scalar, product};
use crate::sight::Sight;
use crate::{Body, Formula, Lines, Model, Number, Quaternion, Seen, Spline, Vector, to_f64, unit_vector};

/// A function of time with values in rad or m.
#[derive(Clone, Debug)]
pub enum Motion {
    /// `c0 + c1 t + c2 t² + …`; a constant has one coefficient.
    Polynomial(Vec<Number>),
    /// `amplitude · sin(angular_frequency · t + phase)`.
    Sinusoid {
        /// Amplitude, rad or m.
        amplitude: Number,
        /// Angular frequency, rad/s.
        angular_frequency: Number,
        /// Phase, rad.
        phase: Number,
    },
    /// The sum of some motions.
    Sum(Vec<Motion>),
    /// The product of some motions.
    Product(Vec<Motion>),
    /// A smooth curve through the rows of a table.
    Table(Spline),
    /// Straight lines through the rows of a table.
    Lines(Lines),
    /// A formula of time.
    Formula(Formula),
    /// An input: the indices of its value, of its rate and of its acceleration among [`Model::inputs`].
    Input([usize; 3]),
}

/// A body's whole motion, prescribed: it has no coordinates, its pose is folded into the formulas as a function of
/// time.
///
/// With the body's own `position` and `orientation` as `r0` and `A0`: `r(t) = r0 + translation(t)` in the global frame
/// and `A(t) = A0 · R(axis_1, angle_1(t)) · R(axis_2, angle_2(t)) ⋯`, each rotation about an axis of the frame that the
/// ones before it have turned (intrinsic).
#[derive(Clone, Debug)]
pub struct BodyMotion {
    /// Displacement of the mass centre, m, global frame.
    pub translation: [Motion; 3],
    /// Successive rotations: direction of the axis, of any length but zero, and angle, rad.
    pub rotations: Vec<([Number; 3], Motion)>,
}

/// Pose, velocity and acceleration of a driven body at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prescribed {
    /// Position of the mass centre, m, global.
    pub r: Vector,
    /// Euler parameters.
    pub p: Quaternion,
    /// Velocity of the mass centre, m/s, global.
    pub s: Vector,
    /// Angular velocity w', rad/s, body frame.
    pub w: Vector,
    /// Acceleration of the mass centre, m/s², global.
    pub ds: Vector,
    /// Derivative of w', rad/s², body frame.
    pub dw: Vector,
}

impl Motion {
    /// Value, first and second derivative at a time, with the model's parameters as they are.
    pub fn value(&self, model: &Model, t: f64) -> [f64; 3] {
        let x = self.at(model, Dual2_64::from_re(t).derivative());
        [x.re, x.v1, x.v2]
    }

    /// The knots of its smooth tables, and of curves of the time itself.
    fn add_knots(&self, model: &Model, knots: &mut Vec<f64>) {
        match self {
            Self::Polynomial(_) | Self::Sinusoid { .. } | Self::Lines(_) | Self::Input(_) => {}
            Self::Formula(formula) => {
                let of_time = formula.curves_of(Seen::Time).map(|curve| &model.curves[curve].spline);
                of_time.for_each(|spline| knots.extend(&spline.knots));
            }
            Self::Sum(parts) | Self::Product(parts) => {
                parts.iter().for_each(|part| part.add_knots(model, knots));
            }
            Self::Table(spline) => knots.extend(&spline.knots),
        }
    }

    /// The motion over any scalar.
    pub(crate) fn at<D: Scalar>(&self, model: &Model, t: D) -> D {
        match self {
            Self::Polynomial(coefficients) => {
                coefficients.iter().rev().fold(D::zero(), |sum, c| sum * t + model.value(c))
            }
            Self::Sinusoid { amplitude, angular_frequency, phase } => {
                (t * model.value(angular_frequency) + model.value(phase)).sin() * model.value(amplitude)
            }
            Self::Sum(terms) => terms.iter().fold(D::zero(), |sum, term| sum + term.at(model, t)),
            Self::Product(factors) => {
                factors.iter().fold(D::one(), |product, factor| product * factor.at(model, t))
            }
            Self::Table(spline) => spline.at(t),
            Self::Lines(lines) => lines.at(t),
            Self::Formula(formula) => Sight::new(model, formula).value(|_| D::zero(), t),
            Self::Input(inputs) => {
                let [place, rate, acceleration] = inputs.map(|index| to_f64(&model.inputs[index].value));
                (t * (0.5 * acceleration) + rate) * t + place
            }
        }
    }
}

impl Model {
    /// The times at which prescribed motions are not smooth though their velocities are continuous: the knots of all
    /// smooth tables. Kinks are told by [`Model::lines`].
    pub fn knots(&self) -> Vec<f64> {
        let mut knots = Vec::new();
        self.drivers.iter().for_each(|driver| driver.motion.add_knots(self, &mut knots));
        for motion in self.bodies.iter().filter_map(|body| body.motion.as_ref()) {
            let angles = motion.rotations.iter().map(|(_, angle)| angle);
            motion.translation.iter().chain(angles).for_each(|motion| motion.add_knots(self, &mut knots));
        }
        knots
    }
}

impl BodyMotion {
    /// Pose of a body that moves so, and its first two derivatives, with the model's parameters as they are.
    ///
    /// By `w' = 2 G ṗ` and `ẇ' = 2 G p̈`, paper eq. (14) solved for w' and differentiated: `Ġ ṗ = 0`.
    pub fn state(&self, model: &Model, body: &Body, t: f64) -> Prescribed {
        let (r, p) = self.pose(model, body, Dual2_64::from_re(t).derivative());
        let unit = Quaternion(p.map(|e| e.re));
        let turning = |rate: [f64; 4]| {
            let [_, x, y, z] = (unit.conjugate() * Quaternion(rate)).0;
            Vector::from([2.0 * x, 2.0 * y, 2.0 * z])
        };
        Prescribed {
            r: Vector::from(r.map(|x| x.re)),
            p: unit,
            s: Vector::from(r.map(|x| x.v1)),
            w: turning(p.map(|e| e.v1)),
            ds: Vector::from(r.map(|x| x.v2)),
            dw: turning(p.map(|e| e.v2)),
        }
    }

    /// Position and unit Euler parameters over any scalar.
    pub(crate) fn pose<D: Scalar>(&self, model: &Model, body: &Body, t: D) -> ([D; 3], [D; 4]) {
        let r0 = model.values(&body.position);
        let r = std::array::from_fn(|k| self.translation[k].at(model, t) + r0[k]);
        let p0 = body.unit_orientation(model).0.map(D::from);
        let p = self.rotations.iter().fold(p0, |p, (axis, angle)| {
            let exact = axis.each_ref().map(|x| model.exact(x));
            let axis = unit_vector(&exact).unwrap_or(Vector::from([0.0, 0.0, 1.0]));
            let half = angle.at(model, t) * 0.5;
            let [x, y, z] = axis.map(|x| half.sin() * x).into();
            product(p, [half.cos(), x, y, z])
        });
        (r, p)
    }
}

impl Body {
    /// The model file's orientation at unit length, the identity where it has none.
    pub(crate) fn given_orientation(&self, model: &Model) -> Quaternion {
        let exact = self.orientation.each_ref().map(|e| model.exact(e));
        Quaternion::unit(&exact).unwrap_or(Quaternion::IDENTITY)
    }

    /// The same with the sign of the two that is nearer to the identity.
    pub(crate) fn unit_orientation(&self, model: &Model) -> Quaternion {
        self.given_orientation(model).nearest(Quaternion::IDENTITY)
    }
}

impl Motion {
    /// All formulas that are part of it.
    pub(crate) fn formulas(&self) -> Vec<&Formula> {
        let parts = self.parts().into_iter();
        parts
            .filter_map(|part| if let Self::Formula(formula) = part { Some(formula) } else { None })
            .collect()
    }

    /// It, or the motions that it is a sum or a product of.
    fn parts(&self) -> Vec<&Self> {
        match self {
            Self::Sum(parts) | Self::Product(parts) => parts.iter().flat_map(Self::parts).collect(),
            other => vec![other],
        }
    }

    fn parts_mut(&mut self) -> Vec<&mut Self> {
        match self {
            Self::Sum(parts) | Self::Product(parts) => parts.iter_mut().flat_map(Self::parts_mut).collect(),
            other => vec![other],
        }
    }

    /// All straight lines that are part of it.
    pub(crate) fn lines(&self) -> Vec<&Lines> {
        let parts = self.parts().into_iter();
        parts.filter_map(|part| if let Self::Lines(lines) = part { Some(lines) } else { None }).collect()
    }

    pub(crate) fn lines_mut(&mut self) -> Vec<&mut Lines> {
        let parts = self.parts_mut().into_iter();
        parts.filter_map(|part| if let Self::Lines(lines) = part { Some(lines) } else { None }).collect()
    }

    /// All inputs that are part of it.
    pub(crate) fn inputs(&self) -> Vec<[usize; 3]> {
        let parts = self.parts().into_iter();
        parts.filter_map(|part| if let Self::Input(inputs) = part { Some(*inputs) } else { None }).collect()
    }

    pub(crate) fn inputs_mut(&mut self) -> Vec<&mut [usize; 3]> {
        let parts = self.parts_mut().into_iter();
        parts.filter_map(|part| if let Self::Input(inputs) = part { Some(inputs) } else { None }).collect()
    }
}

impl BodyMotion {
    pub(crate) fn parts(&self) -> impl Iterator<Item = &Motion> {
        self.translation.iter().chain(self.rotations.iter().map(|(_, angle)| angle))
    }

    pub(crate) fn parts_mut(&mut self) -> impl Iterator<Item = &mut Motion> {
        self.translation.iter_mut().chain(self.rotations.iter_mut().map(|(_, angle)| angle))
    }
}
