//! Scenarios under error control: a lane that has ended one takes up the next.

use super::{LANES, Packs, set_lane};
use crate::child::{Blocks, Common, Job, Tell, note};
use crate::record::Block;
use gyro_runner::describe_in;
use gyro_sim::integrate::Embedded;
use gyro_sim::lanes::{Adaptive, Lanes, Outcome, f64x8};
use gyro_sim::{Control, Error, Joint, JointSpace, Scalar, When};
use std::collections::VecDeque;
use std::io;
use std::ops::Range;

/// A scenario under way.
#[derive(Clone, Copy)]
struct Lane {
    place: Place,
    /// The next sample.
    sample: usize,
    failure: Option<Error>,
}

/// Which block of a unit, and which of its rows.
type Place = (usize, u32);

/// The blocks of a unit: rows are taken up in their order and end in any; a block is told of once it and those before
/// it have ended.
struct Open<'a> {
    coming: Blocks<'a>,
    /// Those under way, each with the number of its rows that have not ended.
    blocks: VecDeque<(Block, u32)>,
    /// Place of the first of them.
    first: usize,
    /// What follows in the last of them.
    rows: Range<u32>,
    /// Numbers of a row.
    width: usize,
}

impl<'a> Open<'a> {
    fn new(coming: Blocks<'a>, width: usize) -> Self {
        Self { coming, blocks: VecDeque::new(), first: 0, rows: 0..0, width }
    }

    /// The next row, with the number of its scenario.
    fn next(&mut self) -> Option<(Place, u64)> {
        while self.rows.is_empty() {
            let mut block = self.coming.next()?;
            block.numbers.resize(self.width * block.count as usize, f64::NAN);
            self.rows = 0..block.count;
            self.blocks.push_back((block, self.rows.end));
        }
        let (last, row) = (self.blocks.len() - 1, self.rows.next()?);
        Some(((self.first + last, row), self.blocks[last].0.first + u64::from(row)))
    }

    /// Notes what a row has come to.
    fn end(&mut self, (place, row): Place, numbers: &[f64], error: Option<&str>) {
        let (block, left) = &mut self.blocks[place - self.first];
        block.numbers[self.width * row as usize..][..numbers.len()].copy_from_slice(numbers);
        if let Some(words) = error {
            note(block, row, words);
        }
        *left -= 1;
    }

    /// Tells of the blocks that have ended.
    fn tell(&mut self, tell: &mut Tell<'_>) -> io::Result<()> {
        while let Some((mut block, _)) = self.blocks.pop_front_if(|(_, left)| *left == 0) {
            self.first += 1;
            block.errors.sort_by_key(|(row, _)| *row);
            tell(block)?;
        }
        Ok(())
    }
}

type Solvers<M, P, A, B> =
    Adaptive<Joint, <P as JointSpace>::Joints, f64x8, A, Joint, <M as JointSpace>::Joints, B>;

impl<M: JointSpace<Scalar = f64>, P: JointSpace<Scalar = f64x8>> Packs<M, P> {
    /// Runs blocks with the method that `method` makes for packs; the other is the same for one scenario.
    pub(super) fn run_lanes<A, B>(
        &mut self,
        blocks: Blocks<'_>,
        tell: &mut Tell<'_>,
        method: impl Fn(&P::Joints) -> A,
        _: impl Fn(&M::Joints) -> B,
    ) -> io::Result<()>
    where
        A: Embedded<Joint, P>,
        B: Embedded<Joint, M>,
    {
        let job = self.common.job;
        let mut open = Open::new(blocks, job.keep.width(self.times.len()));
        let mut parameters: Vec<f64x8> = job.parameters.iter().map(|value| f64x8::constant(*value)).collect();
        let mut inputs = Vec::new();
        let mut all = (self.many)(&parameters);
        let mut out = all.joint_start();
        let mut solvers: Solvers<M, P, A, B> = Adaptive::new(Joint, method(&out), &out);
        let mut mechanisms: [M; LANES] = core::array::from_fn(|_| (self.one)(&job.parameters));
        let mut start = mechanisms[0].joint_start();
        let mut lanes = [None; LANES];
        let mut numbers = Vec::with_capacity(open.width);
        loop {
            let mut has_changed = false;
            for (index, entry) in lanes.iter_mut().enumerate() {
                while entry.is_none()
                    && let Some((place, scenario)) = open.next()
                {
                    if let Err(refused) = self.begin(scenario, index, &mut mechanisms[index]) {
                        open.end(place, &[], Some(&refused));
                        continue;
                    }
                    let common = &self.common;
                    let varied = parameters.iter_mut().zip(&common.parameters);
                    varied.for_each(|(pack, value)| set_lane(pack, index, *value));
                    write_inputs(common, index, &mut inputs);
                    start.as_mut().copy_from_slice(&self.x);
                    solvers.begin(index, Joint, &start, control(job));
                    *entry = Some(Lane { place, sample: 1, failure: None });
                    has_changed = true;
                }
            }
            if lanes.iter().all(Option::is_none) {
                return open.tell(tell);
            }
            if has_changed {
                all = (self.many)(&parameters);
                for (index, value) in &inputs {
                    all.set_input(*index, *value);
                }
            }
            self.attempt(&mut solvers, &mut lanes, &mechanisms, &all, &mut out);
            let n_samples = self.times.len();
            let has_ended = |lane: &mut Lane| lane.failure.is_some() || lane.sample == n_samples;
            for (index, entry) in lanes.iter_mut().enumerate() {
                let Some(Lane { place, failure, .. }) = entry.take_if(has_ended) else { continue };
                solvers.end(index);
                numbers.clear();
                self.keepers[index].finish(failure.is_none(), &mut numbers);
                let mechanism = &mechanisms[index];
                let words = |error| describe_in(mechanism, Some(mechanism.joint_layout()), error);
                open.end(place, &numbers, failure.map(words).as_deref());
            }
            open.tell(tell)?;
        }
    }

    /// Takes up a scenario in a lane, or says why it cannot be; its start is then in `x`.
    fn begin(&mut self, scenario: u64, lane: usize, mechanism: &mut M) -> Result<(), String> {
        let Self { common, layout, x, keepers, one, check, .. } = self;
        common.draw(scenario);
        check(&common.parameters)?;
        *mechanism = one(&common.parameters);
        for input in common.job.start.inputs.iter().chain(&common.inputs) {
            mechanism.set_input(input.index, input.at(0.0));
        }
        layout.write_start(&common.values, x);
        keepers[lane].take_columns(0.0, |column| x[layout.column(column)]);
        Ok(())
    }

    /// An attempt of a step in all lanes, and the samples that lie in those that were kept.
    fn attempt<A, B>(
        &mut self,
        solvers: &mut Solvers<M, P, A, B>,
        lanes: &mut [Option<Lane>; LANES],
        mechanisms: &[M; LANES],
        all: &P,
        out: &mut P::Joints,
    ) where
        A: Embedded<Joint, P>,
        B: Embedded<Joint, M>,
    {
        let Self { common, times, layout, keepers, .. } = self;
        let mut outcomes = [None; LANES];
        let t_end = common.job.settings.t_end;
        solvers.attempt(
            |index| &mechanisms[index],
            all,
            t_end,
            |index, outcome| outcomes[index] = Some(outcome),
        );
        for (lane, outcome) in lanes.iter_mut().zip(&outcomes) {
            if let (Some(lane), Some(Outcome::Failed(error))) = (lane, outcome) {
                lane.failure = Some(*error);
            }
        }
        loop {
            let due: [Option<f64>; LANES] = core::array::from_fn(|index| {
                let lane = lanes[index].as_ref().filter(|_| outcomes[index] == Some(Outcome::Kept))?;
                let t = *times.get(lane.sample)?;
                solvers.time(index).filter(|now| *now >= t).map(|_| t)
            });
            if due.iter().all(Option::is_none) {
                return;
            }
            solvers.interpolate(all, |index| due[index], out);
            for (index, (lane, t)) in lanes.iter_mut().zip(due).enumerate() {
                let (Some(lane), Some(t)) = (lane, t) else { continue };
                let state = out.as_ref();
                keepers[index].take_columns(t, |column| state[layout.column(column)].lane(index));
                lane.sample += 1;
            }
        }
    }
}

/// What the inputs are in a lane.
fn write_inputs(common: &Common, lane: usize, inputs: &mut Vec<(usize, f64x8)>) {
    for input in common.job.start.inputs.iter().chain(&common.inputs) {
        let value = input.at(0.0);
        match inputs.iter_mut().find(|(index, _)| *index == input.index) {
            Some((_, pack)) => set_lane(pack, lane, value),
            None => inputs.push((input.index, f64x8::constant(value))),
        }
    }
}

fn control(job: &Job) -> Control {
    let control = Control::default().with_tolerance(job.approach.tolerance.unwrap_or_default());
    let budget = job.approach.budget.unwrap_or(control.budget);
    Control { budget, when: When::Steps(u32::MAX), ..control }
}
