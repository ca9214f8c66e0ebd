//! Controllers in the loop.

use super::Run;
use super::watch::seen;
use crate::Seen;
use gyro_sim::{Error, Partition, Real, Scalar};

impl<M: Partition<Scalar: Real> + Clone> Run<'_, M> {
    /// The time of the motion.
    pub(super) fn now(&self) -> M::Scalar {
        M::Scalar::constant(self.motion.time())
    }

    /// Lets controllers act that have something to do now.
    pub(super) fn control(&mut self) -> Result<(), Error> {
        let t = self.now();
        if !self.controllers.is_due(t) {
            return Ok(());
        }
        if self.motion.time() > self.read_at {
            self.read_turns(self.motion.time())?;
        } else {
            self.set_by_itself(self.motion.time())?;
        }
        let Self { mechanism, motion, controllers, turns, observer, y, inputs, .. } = self;
        let outputs = observer.outputs(mechanism, t, y);
        let mut changed = Vec::new();
        let held: Vec<_> = controllers.held().collect();
        let given = |index: usize| {
            let held = held.iter().find(|(input, _)| *input == index).map(|(_, value)| *value);
            held.or_else(|| {
                inputs.iter().find(|input| input.index == index).map(|input| input.at(t.to_f64()))
            })
        };
        let see = |measured| match measured {
            Seen::Input(index, default, sign) => M::Scalar::constant(sign * given(index).unwrap_or(default)),
            other => seen(&**mechanism, outputs, turns, t, other),
        };
        controllers.act(t, see, |index, value| changed.push((index, value)));
        for (index, value) in changed {
            mechanism.set_input(index, value);
            motion.set_input(index, value.to_f64());
        }
        Ok(())
    }
}
