//! Controllers in the loop.

use super::Run;
use crate::control::Seen;
use gyro_sim::{Error, JointCoordinate, Partition, Real, Scalar};

impl<M: Partition<Scalar: Real>> Run<'_, M> {
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
        }
        let Self { mechanism, motion, controllers, turns, observer, y, .. } = self;
        let outputs = observer.outputs(mechanism, t, y);
        let scalar = |joint, k| match turns.coordinate(mechanism, joint, k) {
            Some(JointCoordinate::Angle { position, rate } | JointCoordinate::Length { position, rate }) => {
                [position, rate]
            }
            _ => [Scalar::constant(f64::NAN); 2],
        };
        let mut changed = Vec::new();
        let see = |measured| match measured {
            Seen::Output(index) => outputs[index],
            Seen::Coordinate(joint, k) => scalar(joint, k)[0],
            Seen::Rate(joint, k) => scalar(joint, k)[1],
        };
        controllers.act(t, see, |index, value| changed.push((index, value)));
        for (index, value) in changed {
            mechanism.set_input(index, value);
            motion.set_input(index, value.to_f64());
        }
        Ok(())
    }
}
