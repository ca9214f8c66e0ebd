//! What a run costs without being looked at.

use crate::motion::MotionBuilder;
use crate::run::{begin, layout, run_by, scheduled, state};
use crate::{Approach, Failure, Schedule, Settings, Start, describe_in};
use gyro_sim::{Partition, Real, Scalar, Statistics, contact};
use gyro_yardstick::{Measured, beside};
use nanoserde::{DeBin, SerBin};
use std::time::Duration;

/// What a run costs: its steps and corrections alone, no samples; with controllers also what they see.
#[derive(Clone, Copy, Debug, Default, PartialEq, SerBin, DeBin)]
pub struct Timing {
    /// Its time.
    pub measured: Measured,
    /// What the steps have cost and met.
    pub statistics: Statistics,
}

/// Makes a run for its time, for about as long as `budget` but at least once.
///
/// # Errors
/// [`Failure::Run`] as of [`run_by`](crate::run_by).
pub fn time_by<M: Partition<Scalar: Real> + Clone + 'static>(
    mechanism: &M,
    builder: &dyn MotionBuilder<M>,
    (settings, approach): (&Settings, &Approach),
    start: &Start,
    budget: Duration,
) -> Result<Timing, Failure> {
    let settings = Settings { sample_every: settings.t_end, ..scheduled(settings, approach) };
    let ends_at_kinks = approach.tolerance.is_some() && !start.kinks.is_empty();
    if !start.controllers.is_empty() || ends_at_kinks {
        return in_closed_loops(mechanism, builder, (&settings, approach), start, budget);
    }
    let y = state(mechanism, start)?;
    let segments: Vec<_> = Schedule::new(&settings).collect();
    let mut statistics = Statistics::default();
    let once = || -> Result<(), Failure> {
        let mut motion = begin(builder, mechanism, approach, (&y, start))?;
        let layout = layout(mechanism, builder, approach);
        let in_words = |error: contact::Error| Failure::run(describe_in(mechanism, layout, error));
        if approach.tolerance.is_some() {
            // As the motion counts time: in single precision the end may come before this number.
            let t_end = M::Scalar::constant(settings.t_end).to_f64();
            while motion.time() < t_end {
                motion.step_towards(mechanism, t_end, &mut |_| None).map_err(in_words)?;
                motion.resolve(mechanism, &mut |_| ());
            }
        } else {
            for segment in &segments {
                #[expect(clippy::cast_precision_loss, reason = "step numbers stay below 2⁵³")]
                let h = (segment.to - segment.from) / segment.n_steps as f64;
                for _ in 0..segment.n_steps {
                    motion.step(mechanism, h).map_err(in_words)?;
                    motion.resolve(mechanism, &mut |_| ());
                }
                if segment.corrects {
                    motion.correct(mechanism).map_err(|error| in_words(error.into()))?;
                }
            }
        }
        statistics = motion.statistics();
        Ok(())
    };
    let measured = beside(budget, once)?;
    Ok(Timing { measured, statistics })
}

/// The same with controllers: all of the run but for the samples between its ends.
fn in_closed_loops<M: Partition<Scalar: Real> + Clone + 'static>(
    mechanism: &M,
    builder: &dyn MotionBuilder<M>,
    plan: (&Settings, &Approach),
    start: &Start,
    budget: Duration,
) -> Result<Timing, Failure> {
    let mut statistics = Statistics::default();
    let once = || -> Result<(), Failure> {
        statistics = run_by(&mut mechanism.clone(), builder, plan, start, |_| Ok(()))?.statistics;
        Ok(())
    };
    let measured = beside(budget, once)?;
    Ok(Timing { measured, statistics })
}
