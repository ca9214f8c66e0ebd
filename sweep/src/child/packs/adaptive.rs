//! Scenarios under error control: a lane that has ended one takes up the next.

use super::{LANES, Packs, set_lane};
use crate::child::{Common, Job, note};
use crate::keep::Keeper;
use crate::record::Block;
use gyro_runner::describe_in;
use gyro_sim::integrate::Embedded;
use gyro_sim::lanes::{Adaptive, Lanes, Outcome, f64x8};
use gyro_sim::{Control, Error, Joint, JointSpace, Scalar, When};

/// A scenario under way.
struct Lane<M> {
    row: u32,
    mechanism: M,
    keeper: Keeper<'static>,
    /// The next sample.
    sample: usize,
    failure: Option<Error>,
}

type Solvers<M, P, A, B> =
    Adaptive<Joint, <P as JointSpace>::Joints, f64x8, A, Joint, <M as JointSpace>::Joints, B>;

impl<M, P, F, G, C> Packs<F, G, C>
where
    M: JointSpace<Scalar = f64>,
    P: JointSpace<Scalar = f64x8>,
    F: Fn(&[f64]) -> M,
    G: Fn(&[f64x8]) -> P,
    C: Fn(&[f64]) -> Result<(), String>,
{
    /// Runs a block with the method that `method` makes for packs; `B` is the same for one scenario.
    pub(super) fn run_lanes<A, B>(&mut self, block: &mut Block, method: impl Fn(&P::Joints) -> A)
    where
        A: Embedded<Joint, P>,
        B: Embedded<Joint, M>,
    {
        let job = self.common.job;
        let width = job.keep.width(self.times.len());
        let first = block.numbers.len();
        block.numbers.resize(first + width * block.count as usize, f64::NAN);
        let mut parameters: Vec<f64x8> = job.parameters.iter().map(|value| f64x8::constant(*value)).collect();
        let mut inputs = Vec::new();
        let mut all = (self.many)(&parameters);
        let mut out = all.joint_start();
        let mut solvers: Solvers<M, P, A, B> = Adaptive::new(Joint, method(&out), &out);
        let mut lanes: [Option<Lane<M>>; LANES] = [const { None }; LANES];
        let mut rows = 0..block.count;
        let mut numbers = Vec::with_capacity(width);
        loop {
            let mut has_changed = false;
            for (index, entry) in lanes.iter_mut().enumerate() {
                while entry.is_none()
                    && let Some(row) = rows.next()
                {
                    let Some(lane) = self.begin(block, row) else { continue };
                    let common = &self.common;
                    let varied = parameters.iter_mut().zip(&common.parameters);
                    varied.for_each(|(pack, value)| set_lane(pack, index, *value));
                    write_inputs(common, index, &mut inputs);
                    let mut start = lane.mechanism.joint_start();
                    start.as_mut().copy_from_slice(&self.x);
                    solvers.begin(index, Joint, &start, control(job));
                    *entry = Some(lane);
                    has_changed = true;
                }
            }
            if lanes.iter().all(Option::is_none) {
                break;
            }
            if has_changed {
                all = (self.many)(&parameters);
                for (index, value) in &inputs {
                    all.set_input(*index, *value);
                }
            }
            self.attempt(&mut solvers, &mut lanes, &all, &mut out);
            for (index, entry) in lanes.iter_mut().enumerate() {
                let Some(lane) =
                    entry.take_if(|lane| lane.failure.is_some() || lane.sample == self.times.len())
                else {
                    continue;
                };
                solvers.end(index);
                numbers.clear();
                let Lane { row, mechanism, mut keeper, failure, .. } = lane;
                keeper.finish(failure.is_none(), &mut numbers);
                block.numbers[first + width * row as usize..][..width].copy_from_slice(&numbers);
                if let Some(error) = failure {
                    note(block, row, &describe_in(&mechanism, Some(mechanism.joint_layout()), &error));
                }
            }
        }
        block.errors.sort_by_key(|(row, _)| *row);
    }

    /// Takes up a scenario, unless it cannot be; its start is then in `x`.
    fn begin(&mut self, block: &mut Block, row: u32) -> Option<Lane<M>> {
        let Self { common, layout, x, one, check, .. } = self;
        common.draw(block.first + u64::from(row));
        if let Err(refused) = check(&common.parameters) {
            note(block, row, &refused);
            return None;
        }
        let mut mechanism = one(&common.parameters);
        for input in common.job.start.inputs.iter().chain(&common.job.plan.inputs(&common.values)) {
            mechanism.set_input(input.index, input.at(0.0));
        }
        layout.write_start(&common.values, x);
        let mut keeper = Keeper::new(&common.job.keep, self.times.len());
        keeper.take_columns(0.0, |column| x[layout.column(column)]);
        Some(Lane { row, mechanism, keeper, sample: 1, failure: None })
    }

    /// An attempt of a step in all lanes, and the samples that lie in those that were kept.
    fn attempt<A, B>(
        &self,
        solvers: &mut Solvers<M, P, A, B>,
        lanes: &mut [Option<Lane<M>>; LANES],
        all: &P,
        out: &mut P::Joints,
    ) where
        A: Embedded<Joint, P>,
        B: Embedded<Joint, M>,
    {
        let (times, layout) = (&self.times, &self.layout);
        let mut outcomes = [None; LANES];
        let one = |index: usize| &lanes[index].as_ref().expect("it asks for lanes with motions").mechanism;
        let t_end = self.common.job.settings.t_end;
        solvers.attempt(one, all, t_end, |index, outcome| outcomes[index] = Some(outcome));
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
                lane.keeper.take_columns(t, |column| state[layout.column(column)].lane(index));
                lane.sample += 1;
            }
        }
    }
}

/// What the inputs are in a lane.
fn write_inputs(common: &Common, lane: usize, inputs: &mut Vec<(usize, f64x8)>) {
    for input in common.job.start.inputs.iter().chain(&common.job.plan.inputs(&common.values)) {
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
