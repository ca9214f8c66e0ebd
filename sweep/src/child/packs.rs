//! Scenarios of open trees in joint coordinates, eight at a time in the lanes of a pack.
//!
//! Steps of fixed length are the same in all lanes. Under error control each lane has its own.

mod adaptive;

use super::joint::Layout;
use super::{Blocks, Common, Job, Making, Outsets, Runs, Scenarios, Tell, Unit, note, serve};
use crate::Keeper;
use crate::record::Block;
use gyro_runner::{Approach, Schedule, describe_in, scheduled};
use gyro_sim::lanes::{Direct, Lanes, f64x8};
use gyro_sim::{Error, Joint, JointSpace, Scalar, by_method};
use std::io;
use std::process::ExitCode;

/// Scenarios in a pack.
const LANES: usize = f64x8::COUNT;

/// Runs scenarios with the mechanism that `one` makes of parameters and `many` of packs of them; `check` says why
/// it cannot have parameters.
pub fn packs<M, P>(
    one: impl Fn(&[f64]) -> M + 'static,
    many: impl Fn(&[f64x8]) -> P + 'static,
    check: impl Fn(&[f64]) -> Result<(), String> + 'static,
) -> ExitCode
where
    M: JointSpace<Scalar = f64> + 'static,
    P: JointSpace<Scalar = f64x8> + 'static,
{
    serve(|job| Scenarios::new(job, begin(job, one, many, check)))
}

pub(crate) fn begin<M: JointSpace<Scalar = f64>, P: JointSpace<Scalar = f64x8>>(
    job: &'static Job,
    one: impl Fn(&[f64]) -> M + 'static,
    many: impl Fn(&[f64x8]) -> P + 'static,
    check: impl Fn(&[f64]) -> Result<(), String> + 'static,
) -> impl Runs {
    let layout = Layout::new(&one(&job.parameters), job);
    let (common, times) = (Common::new(job), job.times());
    let keepers = vec![Keeper::new(&job.keep, times.len()); LANES];
    Packs {
        common,
        layout,
        times,
        x: Vec::new(),
        samples: Vec::new(),
        keepers,
        one: Box::new(one),
        many: Box::new(many),
        check: Box::new(check),
    }
}

struct Packs<M, P> {
    common: Common,
    layout: Layout,
    times: Vec<f64>,
    /// A joint state.
    x: Vec<f64>,
    /// The kept quantities, sample after sample.
    samples: Vec<f64x8>,
    /// For scenarios under error control, one for each lane.
    keepers: Vec<Keeper<'static>>,
    one: Making<f64, M>,
    many: Making<f64x8, P>,
    check: Making<f64, Result<(), String>>,
}

impl<M: JointSpace<Scalar = f64>, P: JointSpace<Scalar = f64x8>> Runs for Packs<M, P> {
    fn run(&mut self, block: &mut Block, _: Outsets<'_>) {
        let own = std::mem::take(block);
        let tell = &mut |done| {
            *block = done;
            Ok(())
        };
        self.run_blocks(&mut std::iter::once(own), &Unit::default(), tell).expect("it is only put back");
    }

    fn run_blocks(&mut self, blocks: Blocks<'_>, _: &Unit, tell: &mut Tell<'_>) -> io::Result<()> {
        let Approach { tolerance, integrator, .. } = self.common.job.approach;
        if tolerance.is_some() {
            return by_method!(
                integrator,
                fixed A => unreachable!("{integrator} has no error estimate"),
                adaptive A => self.run_lanes(blocks, tell, A::new, A::new),
                implicit => unreachable!("{integrator} is not explicit"),
            );
        }
        for mut block in blocks {
            let lanes = LANES as u32;
            for row in (0..block.count).step_by(LANES) {
                let count = (block.count - row).min(lanes);
                self.run_pack(&mut block, row, count);
            }
            tell(block)?;
        }
        Ok(())
    }
}

impl<M: JointSpace<Scalar = f64>, P: JointSpace<Scalar = f64x8>> Packs<M, P> {
    /// Steps of fixed length; lanes that no scenario fills repeat the last one.
    fn run_pack(&mut self, block: &mut Block, row: u32, count: u32) {
        let Self { common, layout, times, x, samples, one, many, check, .. } = self;
        let job = common.job;
        let mut parameters = vec![f64x8::constant(0.0); job.parameters.len()];
        let mut lanes: Vec<Vec<f64>> = Vec::with_capacity(LANES);
        let (mut inputs, mut refused) = (Vec::new(), [const { None }; LANES]);
        for (lane, refused) in refused.iter_mut().enumerate() {
            common.draw(block.first + u64::from(row + (lane as u32).min(count - 1)));
            *refused = check(&common.parameters).err();
            if refused.is_some() {
                // The lane runs all the same, with numbers that it can.
                common.parameters.clone_from(&job.parameters);
            }
            for (pack, value) in parameters.iter_mut().zip(&common.parameters) {
                set_lane(pack, lane, *value);
            }
            layout.write_start(&common.values, x);
            lanes.push(x.clone());
            inputs.push(common.inputs.clone());
        }
        let mut mechanism = many(&parameters);
        for input in &job.start.inputs {
            mechanism.set_input(input.index, f64x8::constant(input.at(0.0)));
        }
        for (k, input) in inputs[0].iter().enumerate() {
            let value = f64x8::from_lanes(|lane| inputs[lane][k].at(0.0));
            mechanism.set_input(input.index, value);
        }
        let mut state = mechanism.joint_start();
        for (element, pack) in state.as_mut().iter_mut().enumerate() {
            *pack = f64x8::from_lanes(|lane| lanes[lane][element]);
        }
        let columns = job.keep.columns.len();
        let mut direct = Direct::new(Joint, &state);
        samples.clear();
        samples.extend((0..columns).map(|column| state.as_ref()[layout.column(column)]));
        for segment in Schedule::new(&scheduled(&job.settings, &job.approach)) {
            #[expect(clippy::cast_precision_loss, reason = "step numbers stay below 2⁵³")]
            let h = (segment.to - segment.from) / segment.n_steps as f64;
            let steps = u32::try_from(segment.n_steps).unwrap_or(u32::MAX);
            let [t, h] = [segment.from, h].map(f64x8::constant);
            direct.advance(&mechanism, t, h, steps, &mut state);
            if segment.samples {
                samples.extend((0..columns).map(|column| state.as_ref()[layout.column(column)]));
            }
        }
        for lane in 0..count {
            if let Some(refused) = &refused[lane as usize] {
                common.keeper.finish(false, &mut block.numbers);
                note(block, row + lane, refused);
                continue;
            }
            let failure = direct.failures().of(lane as usize);
            let is_kept = |t: f64| failure.is_none_or(|error| time(&error).is_none_or(|end| t < end));
            let taken = times.iter().enumerate().filter(|(_, t)| is_kept(**t));
            for (sample, t) in taken {
                let values = &samples[sample * columns..];
                common.keeper.take_columns(*t, |column| values[column].lane(lane as usize));
            }
            common.keeper.finish(failure.is_none(), &mut block.numbers);
            if let Some(error) = failure {
                let mechanism = one(&job.parameters);
                note(block, row + lane, &describe_in(&mechanism, Some(mechanism.joint_layout()), error));
            }
        }
    }
}

fn set_lane(pack: &mut f64x8, lane: usize, value: f64) {
    let before = *pack;
    *pack = f64x8::from_lanes(|other| if other == lane { value } else { before.lane(other) });
}

/// When a run of lanes failed, s.
fn time(error: &Error) -> Option<f64> {
    match error {
        Error::NotFinite { t, .. } | Error::InvalidEndTime { t, .. } => Some(*t),
        _ => None,
    }
}
