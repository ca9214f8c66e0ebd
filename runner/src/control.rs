//! Sampled controllers in a run: what they see is read from the motion, what they set is set in the mechanism.

use crate::formula::{Formula, Seen};
use gyro_sim::Real;
use gyro_sim::sampled::{
    Controller as Law, Limited, Period, Pid, Quantised, Sampled, StateFeedback, TransferFunction,
};
use nanoserde::{DeBin, SerBin};

/// A controller of a run.
#[derive(Clone, Debug, Default, PartialEq, SerBin, DeBin)]
pub struct Controller {
    /// The law.
    pub law: Wiring,
    /// What it sees, at most [`Controller::MOST`] numbers.
    pub outputs: Vec<Seen>,
    /// Indices of the inputs that it sets, at most [`Controller::MOST`], and their values until then.
    pub inputs: Vec<(usize, f64)>,
    /// The period: so many seconds over so many, neither zero.
    pub period: [u64; 2],
    /// From a sample to its effect, s; not more than a period.
    pub delay: f64,
    /// What the outputs are to be, as it is at a sample.
    pub setpoints: Vec<Formula>,
    /// The least and the largest value of each input.
    pub limits: Option<[f64; 2]>,
    /// The steps to which outputs are rounded; zero: they are not.
    pub output_steps: Vec<f64>,
    /// The same of the inputs.
    pub input_step: f64,
}

/// A law in numbers, from errors e, set points less outputs, to inputs.
#[derive(Clone, Debug, PartialEq, SerBin, DeBin)]
pub enum Wiring {
    /// kp, ki and kd, of one output to one input.
    Pid([f64; 3]),
    /// A matrix, with a row for each input.
    StateFeedback(Vec<Vec<f64>>),
    /// Numerator and denominator in powers of 1/z, of one output to one input; the first of the denominator is not
    /// zero. Of the order [`Controller::MOST`] at most.
    TransferFunction(Vec<f64>, Vec<f64>),
}

impl Default for Wiring {
    fn default() -> Self {
        Self::Pid([0.0; 3])
    }
}

const MOST: usize = 16;

impl Controller {
    /// Most outputs or inputs, and the highest order.
    pub const MOST: usize = MOST;

    /// Its period, s.
    pub fn period_s(&self) -> f64 {
        self.period().seconds()
    }

    pub(crate) fn period(&self) -> Period {
        let [numerator, denominator] = self.period.map(|number| number.max(1));
        Period::new(numerator, denominator).expect("neither is zero")
    }

    /// Coefficients of a transfer function whose denominator begins with one: b0, then b1 on and a1 on, filled up
    /// with zeros.
    pub(crate) fn normalised(numerator: &[f64], denominator: &[f64]) -> (f64, [[f64; MOST]; 2]) {
        let first = denominator.first().copied().unwrap_or(1.0);
        let rest = |from: &[f64]| {
            std::array::from_fn(|k| from.get(k + 1).map_or(0.0, |coefficient| coefficient / first))
        };
        (numerator.first().map_or(0.0, |b0| b0 / first), [rest(numerator), rest(denominator)])
    }

    fn wired<T: Real>(&self) -> Wired<T> {
        let all = |from: &[f64]| std::array::from_fn(|k| T::constant(from.get(k).copied().unwrap_or(0.0)));
        let zero = T::constant(0.0);
        match &self.law {
            Wiring::Pid(gains) => {
                let limits = self.limits.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
                let law = Pid::new(gains.map(T::constant), T::constant(self.period().seconds()));
                Wired::Pid(law.with_limits(limits.map(T::constant)))
            }
            Wiring::StateFeedback(rows) => {
                let gains = std::array::from_fn(|k| all(rows.get(k).map_or(&[], Vec::as_slice)));
                Wired::StateFeedback(Box::new(StateFeedback { gains, reference: [zero; MOST] }))
            }
            Wiring::TransferFunction(numerator, denominator) => {
                let (direct, [numerator, denominator]) = Self::normalised(numerator, denominator);
                let law = TransferFunction::new(T::constant(direct), all(&numerator), all(&denominator));
                Wired::TransferFunction(Box::new(law))
            }
        }
    }
}

/// Any of the laws.
#[derive(Clone, Debug)]
enum Wired<T> {
    Pid(Pid<T>),
    StateFeedback(Box<StateFeedback<T, MOST, MOST>>),
    TransferFunction(Box<TransferFunction<T, MOST>>),
}

impl<T: Real> Wired<T> {
    fn follow(&mut self, setpoints: &[T; MOST]) {
        match self {
            Self::Pid(law) => law.setpoint = setpoints[0],
            Self::StateFeedback(law) => law.reference = *setpoints,
            Self::TransferFunction(law) => law.reference = setpoints[0],
        }
    }
}

impl<T: Real> Law<T> for Wired<T> {
    fn sample(&mut self, t: T, outputs: &[T], inputs: &mut [T]) {
        match self {
            Self::Pid(law) => law.sample(t, outputs, inputs),
            Self::StateFeedback(law) => law.sample(t, outputs, inputs),
            Self::TransferFunction(law) => law.sample(t, outputs, inputs),
        }
    }
}

/// A controller at work: between converters, with its clock.
#[derive(Clone, Debug)]
struct Working<T> {
    sampled: Sampled<Quantised<Limited<Wired<T>, T>, T, MOST>, T, MOST>,
    sees: Vec<Seen>,
    seen: [T; MOST],
    follows: Vec<Formula>,
    sets: Vec<usize>,
    held: [T; MOST],
}

/// All controllers of a run.
#[derive(Clone, Debug)]
pub(crate) struct Controllers<T>(Vec<Working<T>>);

impl<T: Real> Controllers<T> {
    pub(crate) fn new(controllers: &[Controller]) -> Self {
        Self(controllers.iter().map(Working::new).collect())
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Whether one of them has something to do at a time.
    pub(crate) fn is_due(&self, t: T) -> bool {
        self.0.iter().any(|working| working.sampled.is_due(t))
    }

    /// The next time at which one has, s.
    pub(crate) fn next(&self) -> f64 {
        self.0.iter().map(|working| working.sampled.next()).fold(f64::INFINITY, f64::min)
    }

    /// Lets those act that have something to do. All see the same motion, with the inputs as they were before;
    /// `set` is told of inputs that change.
    pub(crate) fn act(&mut self, t: T, see: impl Fn(Seen) -> T, mut set: impl FnMut(usize, T)) {
        for working in &mut self.0 {
            for (seen, measured) in working.seen.iter_mut().zip(&working.sees) {
                *seen = see(*measured);
            }
            let mut setpoints = [T::constant(0.0); MOST];
            for (setpoint, formula) in setpoints.iter_mut().zip(&working.follows) {
                *setpoint = formula.value(&see);
            }
            working.sampled.controller_mut().controller.controller.follow(&setpoints);
        }
        for working in &mut self.0 {
            let before = working.held;
            working.sampled.act(t, &working.seen[..working.sees.len()], &mut working.held);
            for ((index, value), before) in working.sets.iter().zip(working.held).zip(before) {
                if value != before {
                    set(*index, value);
                }
            }
        }
    }

    /// What they set: the index of each input, and its value.
    pub(crate) fn held(&self) -> impl Iterator<Item = (usize, f64)> {
        self.0.iter().flat_map(|working| working.sets.iter().copied().zip(working.held.map(Real::to_f64)))
    }
}

impl<T: Real> Working<T> {
    fn new(controller: &Controller) -> Self {
        let zero = T::constant(0.0);
        let (mut steps, mut held) = ([zero; MOST], [zero; MOST]);
        steps.iter_mut().zip(&controller.output_steps).for_each(|(to, step)| *to = T::constant(*step));
        held.iter_mut().zip(&controller.inputs).for_each(|(to, (_, value))| *to = T::constant(*value));
        let limits = controller.limits.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]).map(T::constant);
        let law = Quantised {
            controller: Limited { controller: controller.wired(), limits },
            outputs: steps,
            inputs: T::constant(controller.input_step),
        };
        let period = controller.period();
        let delay = controller.delay.clamp(0.0, period.seconds());
        let sampled = Sampled::new(law, period).with_delay(delay).expect("it is not longer than the period");
        Self {
            sampled,
            sees: controller.outputs.clone(),
            seen: [zero; MOST],
            follows: controller.setpoints.clone(),
            sets: controller.inputs.iter().map(|(index, _)| *index).collect(),
            held,
        }
    }
}
