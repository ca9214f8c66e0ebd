//! From one sample to the next.

use super::{Event, Halt, Run, Told};
use crate::input::set;
use crate::{Approach, Occurrence, Segment, Settings, What};
use gyro_sim::{Error, Partition, Real, Scalar, Statistics};
use std::io;
use std::time::Instant;

/// So many steps at the limit of stability tell that a scene is stiff, if they are most of them.
const STIFF_STEPS: u64 = 100;

/// A run that has fewer of them is over before another method could be taken. The shipped scenes whose dampers and
/// bushings are hard have 2600; the same runs take rodas4 from a half to an eighth of these steps.
const STIFF_RUN: f64 = 1000.0;

impl<M: Partition<Scalar: Real> + Clone> Run<'_, M> {
    /// Equal steps, and a correction where the schedule has one.
    pub(super) fn advance<F: FnMut(Event<'_>) -> io::Result<()>>(
        &mut self,
        segment: &Segment,
        told: &mut Told<F>,
    ) -> Result<(), Halt> {
        #[expect(clippy::cast_precision_loss, reason = "step numbers stay below 2⁵³")]
        let h = (segment.to - segment.from) / segment.n_steps as f64;
        let mut done = 0;
        while done < segment.n_steps && self.watches.end.is_none() {
            let n_steps = (segment.n_steps - done).min(self.steps_at_once).min(self.budget);
            if n_steps == 0 {
                let steps = self.motion.statistics().accepted;
                return Err(Error::TooManySteps { t: self.motion.time(), steps }.into());
            }
            self.set_inputs(h);
            let began = Instant::now();
            self.control()?;
            self.resolve(told)?;
            self.look_for_jumps(told)?;
            let from = self.motion.time();
            let mut taken = 0;
            while taken < n_steps && !(taken > 0 && self.controllers.is_due(self.now())) {
                self.motion.step(self.mechanism, h)?;
                taken += 1;
            }
            self.summary.run_time_s += began.elapsed().as_secs_f64();
            (self.budget, done) = (self.budget - taken, done + taken);
            self.look_into_step(from, told)?;
            self.resolve(told)?;
            self.read_turns(self.motion.time())?;
            self.count_kinks(self.read_at);
            told.progress(self.motion.time())?;
        }
        if segment.corrects && self.watches.end.is_none() {
            let began = Instant::now();
            self.motion.correct(self.mechanism)?;
            self.summary.run_time_s += began.elapsed().as_secs_f64();
            if !self.controllers.is_empty() {
                self.read_turns(self.motion.time())?;
            }
        }
        Ok(())
    }

    /// Steps under error control until a time is passed.
    pub(super) fn advance_beyond<F: FnMut(Event<'_>) -> io::Result<()>>(
        &mut self,
        t: f64,
        (settings, approach): (&Settings, &Approach),
        told: &mut Told<F>,
    ) -> Result<(), Halt> {
        // As the motion counts time: in single precision the end may come before this number.
        let t = M::Scalar::constant(t).to_f64();
        while self.motion.time() < t && self.watches.end.is_none() {
            let began = Instant::now();
            self.resolve(told)?;
            self.control()?;
            self.resolve(told)?;
            self.look_for_jumps(told)?;
            let from = self.motion.time();
            let next = M::Scalar::constant(self.controllers.next()).to_f64();
            self.step_towards(settings.t_end.min(next), settings.t_end)?;
            if approach.leaves_stiff {
                self.refuse_stiff(settings.t_end)?;
            }
            self.summary.run_time_s += began.elapsed().as_secs_f64();
            self.look_into_step(from, told)?;
            if self.motion.time() <= t {
                self.read_turns(self.motion.time())?;
            }
            told.progress(self.motion.time())?;
        }
        Ok(())
    }

    /// Fails where stability limits most steps and will limit many more of them.
    fn refuse_stiff(&self, t_end: f64) -> Result<(), Error> {
        let Statistics { accepted, limited_by_stability: limited, fastest_rate: rate, .. } =
            self.motion.statistics();
        if limited < STIFF_STEPS || 2 * limited < accepted {
            return Ok(());
        }
        let t = self.motion.time();
        #[expect(clippy::cast_precision_loss, reason = "numbers of steps")]
        let (all, step) = (limited as f64 * t_end / t, t / accepted as f64);
        if all > STIFF_RUN { Err(Error::Stiff { t, rate, step }) } else { Ok(()) }
    }

    /// Has contacts decide what happens now, and tells of it.
    pub(super) fn resolve<F: FnMut(Event<'_>) -> io::Result<()>>(
        &mut self,
        told: &mut Told<F>,
    ) -> Result<(), Halt> {
        let (t, mut found) = (self.motion.time(), Vec::new());
        // What comes after the end of the run does not happen.
        if self.watches.end.is_some_and(|end| end < t) {
            return Ok(());
        }
        self.pass_kinks(t, |what| found.push(Occurrence { t, what }))?;
        self.motion.resolve(self.mechanism, &mut |what| found.push(Occurrence { t, what }));
        if !found.is_empty() {
            self.read_turns(t)?;
        }
        found.iter().try_for_each(|found| Ok((told.tell)(Event::Occurred(found))?))
    }

    /// Tells of what has happened at once.
    fn look_for_jumps<F: FnMut(Event<'_>) -> io::Result<()>>(
        &mut self,
        told: &mut Told<F>,
    ) -> Result<(), Halt> {
        self.watch_jumps()?.iter().try_for_each(|found| Ok((told.tell)(Event::Occurred(found))?))
    }

    /// Tells of what has happened in the last step, which began at this time.
    fn look_into_step<F: FnMut(Event<'_>) -> io::Result<()>>(
        &mut self,
        from: f64,
        told: &mut Told<F>,
    ) -> Result<(), Halt> {
        self.watch_step(from)?.iter().try_for_each(|found| Ok((told.tell)(Event::Occurred(found))?))
    }

    /// Has the velocities jump of what is driven along straight lines, where one of them has a kink now.
    fn pass_kinks(&mut self, t: f64, mut tell: impl FnMut(What)) -> Result<(), Error> {
        if !self.paths.is_due::<M::Scalar>(t) {
            return Ok(());
        }
        let earlier = self.paths.clone();
        let Some(slopes) = self.paths.pass::<M::Scalar>(t) else { return Ok(()) };
        self.set_by_itself(t)?;
        set(self.mechanism, self.inputs, t);
        let [before, after] = [&earlier, &self.paths].map(|paths| paths.pushed(self.mechanism, t, &slopes));
        self.motion.strike(before.each_ref(), after.each_ref());
        self.paths.set(self.mechanism);
        for (index, value) in self.paths.inputs() {
            self.motion.set_input(index, value);
        }
        for (path, [before, after]) in slopes.into_iter().enumerate().filter(|(_, [a, b])| a != b) {
            tell(What::Kinks { path, before, after });
        }
        Ok(())
    }
}
