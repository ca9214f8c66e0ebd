//! How one frame lies and moves, seen from another: the readings of [`gyro_model::Bushing`], and
//! [`gyro_model::Relative`].
//!
//! The Cardan angles are taken for those of three hinges in a row: about the first frame's x axis, about the normal of
//! that axis and the second frame's z axis, and about the latter.

use crate::model::motion::Motion;
use crate::model::path::Wrench;
use crate::model::place::{Moment, Places};
use crate::model::scene::Scene;
use crate::model::spot::Spot;
use crate::number::{Number, atan2, number};
use gyro_model::{BodyFrame, Model};
use nalgebra::{Matrix3, Vector3};

/// Two frames.
#[derive(Clone, Debug)]
pub(crate) struct Frames<T>(pub(crate) [Spot<T>; 2]);

/// How they lie and move.
pub(crate) struct Readings<T: Number> {
    pub(crate) motions: [Motion<T>; 2],
    /// The readings and their rates.
    pub(crate) seen: [[T; 6]; 2],
    /// The first frame's axes, global.
    axes: Matrix3<T>,
    /// The axes of the three hinges, global.
    hinges: Matrix3<T>,
    /// The second frame's origin, global.
    origin: Vector3<T>,
}

impl<T: Number> Frames<T> {
    pub(crate) fn new(model: &Model, places: &Places<T>, frames: [&BodyFrame; 2]) -> Self {
        Self(frames.map(|frame| Spot::new(model, places, frame)))
    }

    /// The numbers of [`gyro_model::Relative`].
    pub(crate) fn relative(&self, scene: &Scene<T>, at: Moment<'_, T>) -> [T; 18] {
        let [first, second] = &self.0;
        let motions = self.0.each_ref().map(|spot| scene.motion(at, &spot.place));
        let [i, j] = &motions;
        let axes = first.axes(i);
        let line = j.tip(&second.point) - i.tip(&first.point);
        let drift = j.tip_velocity(&second.point) - i.tip_velocity(&first.point) - i.omega().cross(&line);
        let [place, moved, spin] = [line, drift, j.omega() - i.omega()].map(|vector| axes.tr_mul(&vector));
        let turned = axes.tr_mul(&second.axes(j));
        std::array::from_fn(|k| match k {
            0..3 => place[k],
            3..12 => turned[(k / 3 - 1, k % 3)],
            12..15 => moved[k - 12],
            _ => spin[k - 15],
        })
    }

    pub(crate) fn readings(&self, scene: &Scene<T>, at: Moment<'_, T>) -> Readings<T> {
        let [first, second] = &self.0;
        let motions = self.0.each_ref().map(|spot| scene.motion(at, &spot.place));
        let [i, j] = &motions;
        let [axes, others] = [first.axes(i), second.axes(j)];
        let origin = j.tip(&second.point);
        let line = origin - i.tip(&first.point);
        let drift = j.tip_velocity(&second.point) - i.tip_velocity(&first.point) - i.omega().cross(&line);
        let (x, z) = (axes.column(0).into_owned(), others.column(2).into_owned());
        let across = z.cross(&x);
        let normal = across.normalize();
        let hinges = Matrix3::from_columns(&[x, normal, z]);
        let [from, to] = [axes, others].map(|axes| axes.tr_mul(&normal));
        let angles = [twice_half(from.z, from.y), atan2(x.dot(&z), across.norm()), twice_half(to.x, to.y)];
        let spin = solved(hinges, j.omega() - i.omega());
        let [place, rate] = [line, drift].map(|vector| axes.tr_mul(&vector));
        let six = |linear: Vector3<T>, [a, b, c]: [T; 3]| [linear.x, linear.y, linear.z, a, b, c];
        Readings { motions, seen: [six(place, angles), six(rate, spin.into())], axes, hinges, origin }
    }
}

impl<T: Number> Readings<T> {
    /// What forces along the readings, and a torque by the axes of the first frame, do to both bodies.
    pub(crate) fn wrenches(&self, [x, y, z, about @ ..]: [T; 6], moment: [T; 3]) -> [Wrench<T>; 2] {
        let force = self.axes * Vector3::new(x, y, z);
        let torque = if about == [T::zero(); 3] {
            Vector3::zeros()
        } else {
            // A torque whose products with the hinges' axes are these.
            solved(self.hinges.transpose(), about.into())
        };
        let torque = torque + self.axes * Vector3::from(moment);
        let on = |motion: &Motion<T>, sign: T| {
            let turned = Wrench::torque(motion.a.tr_mul(&(torque * sign)));
            Wrench::at(motion, &self.origin, force * sign).plus(&turned)
        };
        let [i, j] = &self.motions;
        [on(i, -T::one()), on(j, T::one())]
    }
}

/// The angle with this sine and cosine, by the tangent of half of it: none at half a turn.
fn twice_half<T: Number>(sine: T, cosine: T) -> T {
    atan2(sine / (T::one() + cosine), T::one()) * number(2.0)
}

/// What the matrix takes to the vector: not a number where two hinges are in line.
fn solved<T: Number>(matrix: Matrix3<T>, vector: Vector3<T>) -> Vector3<T> {
    matrix.lu().solve(&vector).unwrap_or_else(|| Vector3::repeat(number(f64::NAN)))
}
