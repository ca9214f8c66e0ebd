//! What acts between two frames: [`gyro_model::Bushing`].
//!
//! The Cardan angles are taken for those of three hinges in a row: about the first frame's x axis, about the normal of
//! that axis and the second frame's z axis, and about the latter.

use crate::model::amount::{Amount, Now};
use crate::model::joint::Joint;
use crate::model::motion::Motion;
use crate::model::path::Wrench;
use crate::model::place::{Moment, Place, Places};
use crate::model::scene::Scene;
use crate::model::spot::Spot;
use crate::number::{Number, atan2, number};
use gyro_model::{Bushing, Model};
use nalgebra::{Matrix3, Vector3};

/// Two frames with what acts between them.
#[derive(Clone, Debug)]
pub(crate) struct Between<T> {
    spots: [Spot<T>; 2],
    law: Law<T>,
}

/// What acts along each of the six readings; along some of them nothing.
#[derive(Clone, Debug)]
enum Law<T> {
    /// Springs of these stiffnesses.
    Springs([Option<Amount<T>>; 6]),
    /// Dampers, and what is added.
    Rest { damping: [Option<Amount<T>>; 6], load: [Option<Amount<T>>; 6] },
}

/// How the frames lie and move.
struct Readings<T: Number> {
    /// The readings and their rates.
    seen: [[T; 6]; 2],
    /// The first frame's axes, global.
    axes: Matrix3<T>,
    /// The axes of the three hinges, global.
    hinges: Matrix3<T>,
    /// The second frame's origin, global.
    origin: Vector3<T>,
}

impl<T: Number> Between<T> {
    /// Its springs, which store energy, and its other strengths, as far as there are any.
    pub(crate) fn all(model: &Model, parts: (&Places<T>, &[Joint<T>]), bushing: &Bushing) -> Vec<Self> {
        let strengths = bushing.strengths();
        let amount = |number: &_| Some(Amount::new(model, parts, number));
        let amounts =
            |which: usize| strengths.map(|of| if of[which].is_zero() { None } else { amount(of[which]) });
        let has = |which: usize| strengths.iter().any(|of| !of[which].is_zero());
        let spots = bushing.ends().map(|frame| Spot::new(model, parts.0, frame));
        let springs = has(0).then(|| Law::Springs(amounts(0)));
        let rest = (has(1) || has(2)).then(|| Law::Rest { damping: amounts(1), load: amounts(2) });
        springs.into_iter().chain(rest).map(|law| Self { spots: spots.clone(), law }).collect()
    }

    /// Whether the energy counts what it does.
    pub(crate) fn is_conservative(&self) -> bool {
        matches!(self.law, Law::Springs(_))
    }

    /// Energy of the springs.
    pub(crate) fn potential(&self, scene: &Scene<T>, at: Moment<'_, T>) -> T {
        let Law::Springs(stiffness) = &self.law else { return T::zero() };
        let (now, motions) = (Now::new(scene, at), self.motions(scene, at));
        let [places, _] = self.readings(&motions).seen;
        stiffness.iter().zip(places).fold(T::zero(), |sum, (stiffness, place)| {
            sum + times(stiffness.as_ref(), &now, place * place * number(0.5))
        })
    }

    /// The six forces.
    fn forces(&self, scene: &Scene<T>, at: Moment<'_, T>, readings: &Readings<T>) -> [T; 6] {
        let now = Now { frames: Some(&readings.seen), ..Now::new(scene, at) };
        let [places, rates] = &readings.seen;
        std::array::from_fn(|k| match &self.law {
            Law::Springs(stiffness) => -times(stiffness[k].as_ref(), &now, places[k]),
            Law::Rest { damping, load } => {
                times(load[k].as_ref(), &now, T::one()) - times(damping[k].as_ref(), &now, rates[k])
            }
        })
    }

    /// Calls the sink with what it exerts on each body, and that body's motion.
    pub(crate) fn exert(
        &self,
        scene: &Scene<T>,
        at: Moment<'_, T>,
        mut sink: impl FnMut(&Place<T>, &Motion<T>, Wrench<T>),
    ) {
        let motions = self.motions(scene, at);
        let readings = self.readings(&motions);
        let [x, y, z, about @ ..] = self.forces(scene, at, &readings);
        let force = readings.axes * Vector3::new(x, y, z);
        let torque = if about == [T::zero(); 3] {
            Vector3::zeros()
        } else {
            // A torque whose products with the hinges' axes are these.
            solved(readings.hinges.transpose(), about.into())
        };
        for ((spot, motion), sign) in self.spots.iter().zip(&motions).zip([-T::one(), T::one()]) {
            let pushed = Wrench::at(motion, &readings.origin, force * sign);
            let turned = Wrench::torque(motion.a.tr_mul(&(torque * sign)));
            sink(&spot.place, motion, pushed.plus(&turned));
        }
    }

    fn motions(&self, scene: &Scene<T>, at: Moment<'_, T>) -> [Motion<T>; 2] {
        self.spots.each_ref().map(|spot| scene.motion(at, &spot.place))
    }

    fn readings(&self, motions: &[Motion<T>; 2]) -> Readings<T> {
        let [first, second] = &self.spots;
        let [i, j] = motions;
        let [axes, others] = [first.axes(i), second.axes(j)];
        let origin = j.tip(&second.point);
        let line = origin - i.tip(&first.point);
        let drift = j.tip_velocity(&second.point) - i.tip_velocity(&first.point) - i.omega().cross(&line);
        let (x, z) = (axes.column(0).into_owned(), others.column(2).into_owned());
        let normal = z.cross(&x).normalize();
        let hinges = Matrix3::from_columns(&[x, normal, z]);
        let on = |vector: &Vector3<T>, k: usize, axes: &Matrix3<T>| vector.dot(&axes.column(k));
        let angles = [
            atan2(on(&normal, 2, &axes), on(&normal, 1, &axes)),
            atan2(x.dot(&z), z.cross(&x).norm()),
            atan2(on(&normal, 0, &others), on(&normal, 1, &others)),
        ];
        let spin = solved(hinges, j.omega() - i.omega());
        let [place, rate] = [line, drift].map(|vector| axes.tr_mul(&vector));
        let six = |linear: Vector3<T>, [a, b, c]: [T; 3]| [linear.x, linear.y, linear.z, a, b, c];
        Readings { seen: [six(place, angles), six(rate, spin.into())], axes, hinges, origin }
    }
}

/// A strength times a factor, which need not be a number where there is no strength.
fn times<T: Number>(strength: Option<&Amount<T>>, now: &Now<'_, T>, factor: T) -> T {
    strength.map_or(T::zero(), |strength| strength.value(now) * factor)
}

/// What the matrix takes to the vector: not a number where two hinges are in line.
fn solved<T: Number>(matrix: Matrix3<T>, vector: Vector3<T>) -> Vector3<T> {
    matrix.lu().solve(&vector).unwrap_or_else(|| Vector3::repeat(number(f64::NAN)))
}
