//! Motions prescribed in time, in numbers: evaluated in `f64`, whatever the scalar, as the joint frames are.

use crate::model::curves::{polynomial, table};
use crate::model::motion::Motion as Moving;
use crate::model::textbook::{product, rotation};
use crate::model::tracked::Tracked;
use gyro_model::{Model, Motion, Spline};
use nalgebra::{Vector3, Vector4};

/// A function of time.
#[derive(Clone, Debug)]
pub(crate) enum Course {
    /// Coefficients of the powers of time.
    Polynomial(Vec<f64>),
    Sinusoid {
        amplitude: f64,
        angular_frequency: f64,
        phase: f64,
    },
    Sum(Vec<Course>),
    Product(Vec<Course>),
    Table(Spline),
    /// `[t0, x, v, a]` of `x + v (t − t0) + ½ a (t − t0)²`, and the inputs that these are.
    Line([f64; 4], [usize; 4]),
    /// A formula of time.
    Formula(Tracked<f64>),
    /// Value, rate and acceleration, and the inputs that these are.
    Input([f64; 3], [usize; 3]),
}

/// A body's whole motion.
#[derive(Clone, Debug)]
pub(crate) struct DrivenBody {
    r0: Vector3<f64>,
    p0: Vector4<f64>,
    translation: [Course; 3],
    /// Unit axes in the frame that the rotations before have turned, and angles.
    rotations: Vec<(Vector3<f64>, Course)>,
}

impl Course {
    pub(crate) fn new(model: &Model, motion: &Motion) -> Self {
        let all = |motions: &[Motion]| motions.iter().map(|motion| Self::new(model, motion)).collect();
        match motion {
            Motion::Polynomial(coefficients) => {
                Self::Polynomial(coefficients.iter().map(|c| model.value(c)).collect())
            }
            Motion::Sinusoid { amplitude, angular_frequency, phase } => Self::Sinusoid {
                amplitude: model.value(amplitude),
                angular_frequency: model.value(angular_frequency),
                phase: model.value(phase),
            },
            Motion::Sum(motions) => Self::Sum(all(motions)),
            Motion::Product(motions) => Self::Product(all(motions)),
            Motion::Table(spline) => Self::Table(spline.clone()),
            Motion::Formula(formula) => Self::Formula(Tracked::of_time(model, formula)),
            Motion::Input(inputs) => {
                Self::Input(inputs.map(|index| gyro_model::to_f64(&model.inputs[index].value)), *inputs)
            }
            Motion::Lines(lines) => {
                let value = |index: usize| gyro_model::to_f64(&model.inputs[index].value);
                Self::Line(lines.inputs.map(value), lines.inputs)
            }
        }
    }

    /// Always the same.
    pub(crate) fn constant(value: f64) -> Self {
        Self::Polynomial(vec![value])
    }

    /// Value, first and second derivative.
    pub(crate) fn jet(&self, t: f64) -> [f64; 3] {
        match self {
            Self::Polynomial(coefficients) => polynomial(coefficients, t),
            Self::Sinusoid { amplitude, angular_frequency: rate, phase } => {
                let (sin, cos) = (rate * t + phase).sin_cos();
                [amplitude * sin, amplitude * rate * cos, -(amplitude * rate * rate * sin)]
            }
            Self::Sum(terms) => terms.iter().fold([0.0; 3], |sum, term| {
                let term = term.jet(t);
                [0, 1, 2].map(|k| sum[k] + term[k])
            }),
            // (u v)'' = u'' v + 2 u' v' + u v''.
            Self::Product(factors) => factors.iter().fold([1.0, 0.0, 0.0], |[u, du, ddu], factor| {
                let [v, dv, ddv] = factor.jet(t);
                [u * v, du * v + u * dv, ddu * v + 2.0 * du * dv + u * ddv]
            }),
            Self::Table(spline) => table(&spline.knots, &spline.pieces, t),
            Self::Formula(formula) => formula.jet(&[], t),
            Self::Input(numbers, _) => *numbers,
            Self::Line([from, place, rate, acceleration], _) => {
                polynomial(&[*place, *rate, 0.5 * acceleration], t - from)
            }
        }
    }

    /// An input has changed.
    pub(crate) fn set_input(&mut self, index: usize, value: f64) {
        match self {
            Self::Polynomial(_) | Self::Sinusoid { .. } | Self::Table(_) | Self::Formula(_) => {}
            Self::Sum(parts) | Self::Product(parts) => {
                parts.iter_mut().for_each(|part| part.set_input(index, value));
            }
            Self::Line(numbers, inputs) => set(numbers, inputs, (index, value)),
            Self::Input(numbers, inputs) => set(numbers, inputs, (index, value)),
        }
    }
}

fn set(numbers: &mut [f64], inputs: &[usize], (index, value): (usize, f64)) {
    let own = numbers.iter_mut().zip(inputs).filter(|(_, input)| **input == index);
    own.for_each(|(number, _)| *number = value);
}

impl DrivenBody {
    /// The motion of a driven body; one of which the model file says nothing stays where it is.
    pub(crate) fn new(model: &Model, body: usize) -> Self {
        let body = &model.bodies[body];
        let motion = body.motion.as_ref();
        let rotation = |(axis, angle): &(_, Motion)| {
            (Vector3::from(model.values(axis)).normalize(), Course::new(model, angle))
        };
        Self {
            r0: Vector3::from(model.values(&body.position)),
            p0: nearer_to_identity(Vector4::from(model.values(&body.orientation)).normalize()),
            translation: motion.map_or_else(
                || [0.0; 3].map(Course::constant),
                |motion| motion.translation.each_ref().map(|motion| Course::new(model, motion)),
            ),
            rotations: motion.iter().flat_map(|motion| &motion.rotations).map(rotation).collect(),
        }
    }

    /// An input has changed.
    pub(crate) fn set_input(&mut self, index: usize, value: f64) {
        let angles = self.rotations.iter_mut().map(|(_, angle)| angle);
        self.translation.iter_mut().chain(angles).for_each(|course| course.set_input(index, value));
    }

    /// Where the body is at a time, how it moves and how that changes.
    pub(crate) fn motion(&self, t: f64) -> Moving<f64> {
        let [x, y, z] = self.translation.each_ref().map(|course| course.jet(t));
        let component = |k: usize| Vector3::new(x[k], y[k], z[k]);
        let rest = Moving::new(self.r0 + component(0), self.p0, component(1), Vector3::zeros());
        let start = Moving { s_dot: component(2), ..rest };
        self.rotations.iter().fold(start, |motion, (axis, angle)| turned(&motion, axis, &angle.jet(t)))
    }
}

/// Of the two quaternions of a rotation the one that the start of a model is assembled with.
fn nearer_to_identity(p: Vector4<f64>) -> Vector4<f64> {
    let first = p.iter().copied().find(|&e| e != 0.0).unwrap_or(1.0);
    if first < 0.0 { -p } else { p }
}

/// A frame turned further about one of its own axes u: `w' = Rᵀ w'₀ + u θ̇` and its derivative, with `Ṙᵀ v = −u × Rᵀ v
/// θ̇`.
fn turned(motion: &Moving<f64>, u: &Vector3<f64>, [angle, rate, second]: &[f64; 3]) -> Moving<f64> {
    let (sin, cos) = (0.5 * angle).sin_cos();
    let turn = Vector4::new(cos, u.x * sin, u.y * sin, u.z * sin);
    let p = product(&motion.p, &turn).normalize();
    let turn = rotation(&turn);
    let carried = turn.tr_mul(&motion.w);
    Moving {
        p,
        a: rotation(&p),
        w: carried + u * *rate,
        w_dot: turn.tr_mul(&motion.w_dot) - u.cross(&carried) * *rate + u * *second,
        ..*motion
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::textbook::g_matrix;

    /// A central difference at this step is good to about 1e-10 of the third derivative, which is of order ten here.
    const STEP: f64 = 1e-5;
    const TOLERANCE: f64 = 1e-8;

    fn courses() -> Vec<Course> {
        let polynomial = Course::Polynomial(vec![0.3, -1.0, 0.5, 0.2]);
        let sinusoid = Course::Sinusoid { amplitude: 0.7, angular_frequency: 2.0, phase: 0.4 };
        // The natural spline through (0, 0), (1, 1), (3, 0).
        let table = Course::Table(Spline {
            source: String::new(),
            knots: vec![0.0, 1.0, 3.0],
            pieces: vec![[0.0, 1.25, 0.0, -0.25], [1.0, 0.5, -0.75, 0.125]],
        });
        let sum = Course::Sum(vec![polynomial.clone(), table.clone()]);
        let product = Course::Product(vec![polynomial.clone(), sinusoid.clone(), table.clone()]);
        vec![polynomial, sinusoid, table, sum, product]
    }

    #[test]
    fn the_derivatives_of_a_course_are_its_difference_quotients() {
        for course in courses() {
            for t in [-1.5, 0.4, 0.9, 2.2, 3.7] {
                let [_, rate, second] = course.jet(t);
                let (before, after) = (course.jet(t - STEP), course.jet(t + STEP));
                let quotient = |k: usize| (after[k] - before[k]) / (2.0 * STEP);
                assert!((rate - quotient(0)).abs() < TOLERANCE, "{course:?} at {t}");
                assert!((second - quotient(1)).abs() < TOLERANCE, "{course:?} at {t}");
            }
        }
    }

    #[test]
    fn a_table_goes_through_its_points_and_on_straight() {
        let course = &courses()[2];
        let values = [-2.0, 0.0, 1.0, 3.0, 5.0].map(|t| course.jet(t)[0]);
        assert_eq!(values, [-2.5, 0.0, 1.0, 0.0, -2.0]);
    }

    #[test]
    fn the_velocities_of_a_driven_body_are_those_of_its_pose() {
        let [a, b, c, d, e] = <[Course; 5]>::try_from(courses()).expect("there are five");
        let body = DrivenBody {
            r0: Vector3::new(0.1, 0.2, 0.3),
            p0: Vector4::new(1.0, 2.0, -1.0, 0.5).normalize(),
            translation: [a.clone(), b.clone(), c],
            rotations: vec![
                (Vector3::new(1.0, 2.0, 2.0) / 3.0, b),
                (Vector3::new(0.0, 0.6, 0.8), d),
                (Vector3::new(0.48, 0.6, -0.64), Course::Sum(vec![a, e])),
            ],
        };
        for t in [0.2, 0.7, 2.1] {
            let [before, now, after] = [t - STEP, t, t + STEP].map(|t| body.motion(t));
            let s = (after.r - before.r) / (2.0 * STEP);
            let s_dot = (after.s - before.s) / (2.0 * STEP);
            // Eq. (14) the other way: w' = 2 G ṗ.
            let w = g_matrix(&now.p) * (after.p - before.p) / STEP;
            let w_dot = (after.w - before.w) / (2.0 * STEP);
            for (value, quotient) in [(now.s, s), (now.s_dot, s_dot), (now.w, w), (now.w_dot, w_dot)] {
                assert!((value - quotient).norm() < TOLERANCE, "{value} and {quotient} at {t}");
            }
        }
    }
    /// The model has an evaluation of its own, by dual numbers.
    #[test]
    fn a_driven_body_moves_as_the_model_says() {
        let page = include_str!("../../tests/models/carried.toml");
        let model = gyro_model::read("carried.toml", page).expect("a model file without mistakes");
        let deck = &model.bodies[0];
        for t in [0.0, 0.3, 1.7] {
            let motion = DrivenBody::new(&model, 0).motion(t);
            let expected = deck.motion.as_ref().expect("it is driven").state(&model, deck, t);
            let vectors = [motion.r, motion.s, motion.w, motion.s_dot, motion.w_dot];
            let expected_vectors = [expected.r, expected.s, expected.w, expected.ds, expected.dw];
            for (vector, expected) in vectors.iter().zip(expected_vectors) {
                assert!((vector - expected).norm() < 1e-13, "{vector} at {t}");
            }
            assert!((motion.p - Vector4::from(expected.p.0)).norm() < 1e-15, "{} at {t}", motion.p);
        }
    }
}
