//! Kinks of laws that steps of fixed length go over.

use super::Run;
use super::watch::seen;
use crate::control::Seen;
use crate::formula::Operation;
use crate::kink::Kink;
use gyro_sim::{Partition, Real, Scalar};

/// Where laws were at the end of the last step, each between its kinks.
#[derive(Clone, Debug)]
pub(super) struct Laws {
    kinks: Vec<Kink>,
    sees_outputs: bool,
    places: Vec<Option<f64>>,
}

impl Laws {
    pub(super) fn new(kinks: &[Kink]) -> Self {
        let is_output = |operation: &Operation| matches!(operation, Operation::Seen(Seen::Output(_)));
        Self {
            kinks: kinks.to_vec(),
            sees_outputs: kinks.iter().any(|kink| kink.of.0.iter().any(is_output)),
            places: vec![None; kinks.len()],
        }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.kinks.is_empty()
    }

    /// How many kinks have been crossed since the last values.
    fn pass(&mut self, values: &[f64]) -> u64 {
        let mut passed = 0;
        for ((kink, place), value) in self.kinks.iter().zip(&mut self.places).zip(values) {
            let Some(now) = kink.at.place(*value) else { continue };
            passed += u64::from(place.replace(now).is_some_and(|before| before != now));
        }
        passed
    }
}

impl<M: Partition<Scalar: Real> + Clone> Run<'_, M> {
    /// Counts the kinks between the state that was last looked at and the one before it.
    pub(super) fn count_kinks(&mut self) {
        if self.laws.is_empty() {
            return;
        }
        let t = M::Scalar::constant(self.read_at);
        let Self { mechanism, laws, turns, observer, y, inputs, controllers, paths, read_at, .. } = self;
        let outputs = if laws.sees_outputs { observer.outputs(mechanism, t, y) } else { &[] };
        let given = |index: usize| {
            let held = controllers.held().chain(paths.inputs()).find(|(input, _)| *input == index);
            held.map(|(_, value)| value)
                .or_else(|| inputs.iter().find(|input| input.index == index).map(|input| input.at(*read_at)))
        };
        let see = |what: Seen| match what {
            Seen::Input(index, default, sign) => sign * given(index).unwrap_or(default),
            Seen::Distance(line) => line.distance(&**mechanism, y.as_ref())[0],
            Seen::DistanceRate(line) => line.distance(&**mechanism, y.as_ref())[1],
            other => seen(&**mechanism, outputs, turns, t, other).to_f64(),
        };
        let values: Vec<f64> = laws.kinks.iter().map(|kink| kink.of.value(&see)).collect();
        self.summary.kinks_crossed += laws.pass(&values);
    }
}
