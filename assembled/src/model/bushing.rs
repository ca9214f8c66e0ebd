//! What acts between two frames: [`gyro_model::Bushing`].

use crate::model::amount::{Amount, Now};
use crate::model::between::{Frames, Readings};
use crate::model::joint::Joint;
use crate::model::motion::Motion;
use crate::model::path::Wrench;
use crate::model::place::{Moment, Place, Places};
use crate::model::scene::Scene;
use crate::number::{Number, number};
use gyro_model::Model;

/// Two frames with the strengths along each of their six readings; along some of them there is nothing.
#[derive(Clone, Debug)]
pub(crate) struct Bushing<T> {
    frames: Frames<T>,
    stiffness: [Option<Amount<T>>; 6],
    damping: [Option<Amount<T>>; 6],
    load: [Option<Amount<T>>; 6],
    moment: [Option<Amount<T>>; 3],
}

/// What of it acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Part {
    /// The springs, which store energy.
    Springs,
    /// Dampers, and what is added.
    Rest,
}

impl<T: Number> Bushing<T> {
    pub(crate) fn new(
        model: &Model,
        parts: (&Places<T>, &[Joint<T>]),
        bushing: &gyro_model::Bushing,
    ) -> Self {
        let amount = |number: &gyro_model::Number| {
            let number = Some(number).filter(|number| !number.is_zero());
            number.map(|number| Amount::new(model, parts, number))
        };
        let amounts = |which: usize| bushing.strengths().map(|of| amount(of[which]));
        Self {
            frames: Frames::new(model, parts.0, bushing.ends()),
            stiffness: amounts(0),
            damping: amounts(1),
            load: amounts(2),
            moment: bushing.moment.each_ref().map(amount),
        }
    }

    /// The parts that it has.
    pub(crate) fn parts(&self) -> Vec<Part> {
        let has = |strengths: &[Option<_>]| strengths.iter().any(Option::is_some);
        let springs = has(&self.stiffness).then_some(Part::Springs);
        let rest = [&self.damping[..], &self.load, &self.moment].into_iter().any(has).then_some(Part::Rest);
        springs.into_iter().chain(rest).collect()
    }

    /// Energy of the springs.
    pub(crate) fn potential(&self, scene: &Scene<T>, at: Moment<'_, T>) -> T {
        let now = Now::new(scene, at);
        let [places, _] = self.frames.readings(scene, at).seen;
        self.stiffness.iter().zip(places).fold(T::zero(), |sum, (stiffness, place)| {
            sum + times(stiffness.as_ref(), &now, place * place * number(0.5))
        })
    }

    /// The force of a part along each reading.
    fn forces(&self, part: Part, scene: &Scene<T>, at: Moment<'_, T>, seen: &[[T; 6]; 2]) -> [T; 6] {
        let now = Now { frames: Some(seen), ..Now::new(scene, at) };
        let [places, rates] = seen;
        std::array::from_fn(|k| match part {
            Part::Springs => -times(self.stiffness[k].as_ref(), &now, places[k]),
            Part::Rest => {
                let drag = times(self.damping[k].as_ref(), &now, rates[k]);
                times(self.load[k].as_ref(), &now, T::one()) - drag
            }
        })
    }

    /// The readings, and the force along each.
    pub(crate) fn told(&self, scene: &Scene<T>, at: Moment<'_, T>) -> [[T; 6]; 2] {
        let seen = self.frames.readings(scene, at).seen;
        let [springs, rest] = [Part::Springs, Part::Rest].map(|part| self.forces(part, scene, at, &seen));
        [seen[0], std::array::from_fn(|k| springs[k] + rest[k])]
    }

    /// Calls the sink with what a part exerts on each body, and that body's motion.
    pub(crate) fn exert(
        &self,
        part: Part,
        scene: &Scene<T>,
        at: Moment<'_, T>,
        mut sink: impl FnMut(&Place<T>, &Motion<T>, Wrench<T>),
    ) {
        let readings = self.frames.readings(scene, at);
        let Readings { motions, seen, .. } = &readings;
        let moment = match part {
            Part::Springs => [T::zero(); 3],
            Part::Rest => {
                let now = Now { frames: Some(seen), ..Now::new(scene, at) };
                self.moment.each_ref().map(|moment| times(moment.as_ref(), &now, T::one()))
            }
        };
        let wrenches = readings.wrenches(self.forces(part, scene, at, seen), moment);
        for ((spot, motion), wrench) in self.frames.0.iter().zip(motions).zip(wrenches) {
            sink(&spot.place, motion, wrench);
        }
    }
}

/// A strength times a factor, which need not be a number where there is no strength.
fn times<T: Number>(strength: Option<&Amount<T>>, now: &Now<'_, T>, factor: T) -> T {
    strength.map_or(T::zero(), |strength| strength.value(now) * factor)
}
