//! Controllers in the loop.

use super::Run;
use super::watch::seen;
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
        let Self { mechanism, motion, controllers, turns, observer, y, .. } = self;
        let outputs = observer.outputs(mechanism, t, y);
        let mut changed = Vec::new();
        let see = |measured| seen(&**mechanism, outputs, turns, t, measured);
        controllers.act(t, see, |index, value| changed.push((index, value)));
        for (index, value) in changed {
            mechanism.set_input(index, value);
            motion.set_input(index, value.to_f64());
        }
        Ok(())
    }
}
