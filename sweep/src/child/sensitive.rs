//! Scenarios with sensitivities: each is run as without them, and then once more with its variational equations.

use super::joint::{Layout, flat, joint_start, write_start};
use super::variational::{Closing, Number, Part, Parts, Variational};
use super::watch::Watch;
use super::{Common, Job, Making, Outsets, Runs, Scenarios, StartSlopes, note, packs, serve, whole};
use crate::Keep;
use crate::plan::Target;
use crate::record::Block;
use crate::slopes::Slopes;
use gyro_runner::motion::{COLUMNS, MotionBuilder};
use gyro_runner::{Input, Schedule, Start, describe_in, scheduled};
use gyro_sim::integrate::Method;
use gyro_sim::lanes::f64x8;
use gyro_sim::{Control, Dual, Error, JointSpace, Partition, Solver, When, by_method};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;
use std::rc::Rc;

/// As [`whole`](super::whole), with the derivatives of what is kept; `duals` makes the mechanism in dual numbers.
pub fn whole_sensitive<M, D, K>(
    build: impl Fn(&[f64]) -> (M, K) + Clone + 'static,
    duals: impl Fn(&[Number]) -> D + 'static,
) -> ExitCode
where
    M: Partition<Scalar = f64> + JointSpace + Clone + 'static,
    K: MotionBuilder<M> + 'static,
    D: JointSpace<Scalar = Number> + 'static,
{
    serve(|job| {
        let inner = whole::begin(plain(job), whole::by(build.clone()));
        let one = move |parameters: &[f64]| build(parameters).0;
        Scenarios::new(job, Sensitive::new(job, inner, one, duals))
    })
}

/// As [`packs`](super::packs), likewise.
pub fn packs_sensitive<M, P, D>(
    one: impl Fn(&[f64]) -> M + Clone + 'static,
    many: impl Fn(&[f64x8]) -> P + 'static,
    check: impl Fn(&[f64]) -> Result<(), String> + 'static,
    duals: impl Fn(&[Number]) -> D + 'static,
) -> ExitCode
where
    M: JointSpace<Scalar = f64> + 'static,
    P: JointSpace<Scalar = f64x8> + 'static,
    D: JointSpace<Scalar = Number> + 'static,
{
    serve(|job| {
        let inner = packs::begin(plain(job), one.clone(), many, check);
        Scenarios::new(job, Sensitive::new(job, inner, one, duals))
    })
}

/// The same job without sensitivities.
pub(crate) fn plain(job: &Job) -> &'static Job {
    let keep = Keep { by: Vec::new(), ..job.keep.clone() };
    Box::leak(Box::new(Job { keep, ..job.clone() }))
}

pub(crate) struct Sensitive<R, M, D> {
    inner: R,
    common: Common,
    times: Vec<f64>,
    kept: Slopes<'static>,
    /// Where the numbers stand, once a scenario has asked.
    layout: Option<Layout>,
    /// Of each direction: equations have derivatives times this, which are of the state's size.
    scales: Vec<f64>,
    one: Making<f64, M>,
    duals: Making<Number, D>,
}

impl<R, M, D> Sensitive<R, M, D> {
    pub(crate) fn new(
        job: &'static Job,
        inner: R,
        one: impl Fn(&[f64]) -> M + 'static,
        duals: impl Fn(&[Number]) -> D + 'static,
    ) -> Self {
        let scales = job.keep.by.iter().map(|target| job.plan.scale(*target)).collect();
        let (common, times) = (Common::new(job), job.times());
        let kept = Slopes::new(&job.keep, times.len());
        let (one, duals) = (Box::new(one), Box::new(duals));
        Self { inner, common, times, kept, layout: None, scales, one, duals }
    }
}

impl<R: Runs, M: JointSpace<Scalar = f64>, D: JointSpace<Scalar = Number>> Runs for Sensitive<R, M, D> {
    fn run(&mut self, block: &mut Block, from: Outsets<'_>) {
        let keep = &self.common.job.keep;
        self.inner.run(block, from);
        let rows = std::mem::take(&mut block.numbers);
        let width = keep.numbers() + keep.series.len() * self.times.len();
        for (row, numbers) in (0..block.count).zip(rows.chunks_exact(width)) {
            let (numbers, series) = numbers.split_at(keep.numbers());
            block.numbers.extend(numbers);
            let has_failed = block.errors.iter().any(|(failed, _)| *failed == row);
            let mut is_whole = false;
            if !has_failed {
                self.common.draw(block.first + u64::from(row));
                let start = from.starts.get(row as usize).and_then(|start| start.as_ref().ok());
                let start = start.zip(from.slopes.get(row as usize));
                let outcome = catch_unwind(AssertUnwindSafe(|| self.scenario(start)));
                let panicked = |_| Err("the program panicked: this is a mistake in gyro-sim".to_owned());
                match outcome.unwrap_or_else(panicked) {
                    Ok(()) => is_whole = true,
                    Err(words) => note(block, row, &format!("its sensitivities: {words}")),
                }
            }
            self.kept.finish(is_whole, &self.scales, &mut block.numbers);
            block.numbers.extend(series);
        }
        block.errors.sort_by_key(|(row, _)| *row);
    }
}

impl<R, M: JointSpace<Scalar = f64>, D: JointSpace<Scalar = Number>> Sensitive<R, M, D> {
    /// Runs one, from an assembled start and its derivatives or from the one that all have.
    fn scenario(&mut self, start: Option<(&Start, &StartSlopes)>) -> Result<(), String> {
        let job = self.common.job;
        let mut mechanism = (self.one)(&self.common.parameters);
        let inputs: Vec<Input> = job.start.inputs.iter().chain(&self.common.inputs).cloned().collect();
        for input in &inputs {
            mechanism.set_input(input.index, input.at(0.0));
        }
        let n_parts = self.scales.len().div_ceil(COLUMNS);
        let parts = Rc::new((0..n_parts).map(|k| self.part(k, &inputs)).collect::<Vec<_>>());
        let (state, angles) = match start {
            Some((_, StartSlopes::Impossible(words))) => return Err(words.clone()),
            Some((start, StartSlopes::Of(slopes))) => {
                (assembled(&mechanism, &parts, start, slopes), start.angles.clone())
            }
            None => self.alike(&mechanism),
        };
        let closing = Closing::new(&mechanism, parts.clone());
        let seen = (&job.start.observed_bodies[..], self.scales.len());
        let mut watch = Watch::new(&mechanism, &parts, (&state, &angles), seen);
        self.take(0.0, &state, &mut watch);
        let n = state.len() / (1 + self.scales.len());
        let equations = Variational(parts);
        let (integrator, control) = (job.approach.integrator, control(&mechanism, job));
        let outcome = by_method!(
            integrator,
            fixed A => {
                let solver = Solver::with_correction(equations, A::new(&state), closing, 0.0, &state);
                self.fixed(solver.with_control(control), &mechanism, &mut watch)
            },
            adaptive A => {
                let solver = Solver::with_correction(equations, A::new(&state), closing, 0.0, &state);
                match job.approach.tolerance {
                    None => self.fixed(solver.with_control(control), &mechanism, &mut watch),
                    Some(_) => self.adaptive(solver.with_control(control), &mechanism, &mut watch),
                }
            },
            implicit => unreachable!("{integrator} is not explicit"),
        );
        outcome.map_err(|error| words(&mechanism, n, &error))
    }

    /// The mechanism in dual numbers for the k-th group of directions.
    fn part(&self, k: usize, inputs: &[Input]) -> Part<D> {
        let (job, common) = (self.common.job, &self.common);
        let mut parameters: Vec<Number> = common.parameters.iter().map(|value| Dual::new(*value)).collect();
        let mut inputs: Vec<(usize, Number)> =
            inputs.iter().map(|input| (input.index, Dual::new(input.at(0.0)))).collect();
        let group = job.keep.by.iter().zip(&self.scales).skip(k * COLUMNS).take(COLUMNS);
        for (column, (target, scale)) in group.enumerate() {
            match job.plan.targets[*target] {
                Target::Parameter(index) => parameters[index].slopes[column] = *scale,
                Target::Input(index) => {
                    let own = inputs.iter_mut().filter(|(other, _)| *other == index);
                    own.for_each(|(_, value)| value.slopes[column] = *scale);
                }
                _ => {}
            }
        }
        let mut mechanism = (self.duals)(&parameters);
        for (index, value) in inputs {
            mechanism.set_input(index, value);
        }
        Part::new(mechanism)
    }

    /// The start that all scenarios have, save for joints' own that vary; it and the angles nearby.
    fn alike(&mut self, mechanism: &M) -> (Vec<f64>, Vec<f64>) {
        let (job, values) = (self.common.job, &self.common.values);
        let one = &self.one;
        let layout = self.layout.get_or_insert_with(|| Layout::new(&one(&job.parameters), job));
        let mut state = Vec::new();
        layout.write_start(values, &mut state);
        let n = state.len();
        state.resize(n * (1 + self.scales.len()), 0.0);
        for (k, (target, scale)) in job.keep.by.iter().zip(&self.scales).enumerate() {
            if let Some(place) = layout.start_of(*target) {
                state[(1 + k) * n + place] = *scale;
            }
        }
        let mut angles = job.start.angles.clone();
        for (target, value) in job.plan.targets.iter().zip(values) {
            if let Target::Start(joint, k) = *target {
                angles[flat(mechanism, joint, k)] = *value;
            }
        }
        (state, angles)
    }

    /// Steps of fixed length.
    fn fixed<A: Method<Variational<D>, M>>(
        &mut self,
        mut solver: Solving<M, D, A>,
        mechanism: &M,
        watch: &mut Watch<'_, M, D>,
    ) -> Result<(), Error> {
        let job = self.common.job;
        let mut budget = job.approach.budget.unwrap_or(u64::MAX);
        for segment in Schedule::new(&scheduled(&job.settings, &job.approach)) {
            #[expect(clippy::cast_precision_loss, reason = "step numbers stay below 2⁵³")]
            let h = (segment.to - segment.from) / segment.n_steps as f64;
            for _ in 0..segment.n_steps {
                let Some(left) = budget.checked_sub(1) else {
                    let steps = solver.statistics().accepted;
                    return Err(Error::TooManySteps { t: solver.time(), steps });
                };
                budget = left;
                solver.step(mechanism, h)?;
                watch.read(solver.time(), solver.state());
            }
            if segment.samples {
                self.take(segment.to, solver.state(), watch);
            }
        }
        Ok(())
    }

    /// Steps under error control, which end where tables of the model do.
    fn adaptive<A: Method<Variational<D>, M>>(
        &mut self,
        mut solver: Solving<M, D, A>,
        mechanism: &M,
        watch: &mut Watch<'_, M, D>,
    ) -> Result<(), Error> {
        let job = self.common.job;
        let mut state = solver.state().clone();
        for index in 1..self.times.len() {
            let t = self.times[index];
            while solver.time() < t {
                let now = solver.time();
                let ahead = job.start.knots.iter().copied().filter(|knot| *knot > now);
                let end = ahead.fold(job.settings.t_end, f64::min);
                solver.step_towards(mechanism, end)?;
                if solver.time() >= end {
                    solver.system_has_changed();
                }
                if solver.time() <= t {
                    watch.read(solver.time(), solver.state());
                }
            }
            solver.interpolate(mechanism, t, &mut state)?;
            self.take(t, &state, watch);
        }
        Ok(())
    }

    fn take(&mut self, t: f64, state: &[f64], watch: &mut Watch<'_, M, D>) {
        self.kept.take(t, watch.columns(t, state, &self.common.job.keep.columns));
    }
}

type Solving<M, D, A> = Solver<Variational<D>, Vec<f64>, f64, A, Closing<M, D>>;

fn control<M: JointSpace>(mechanism: &M, job: &Job) -> Control {
    let mut control = Control::default();
    if let Some(tolerance) = job.approach.tolerance {
        control = control.with_tolerance(tolerance);
    }
    let is_open = mechanism.joint_layout().closure_rows.is_empty();
    let when = When::Steps(if is_open { u32::MAX } else { 1 });
    Control { budget: job.approach.budget.unwrap_or(control.budget), when, ..control }
}

/// An assembled start in joint coordinates, with the derivatives of the maximal one and those of the map.
fn assembled<M, D>(mechanism: &M, parts: &Parts<D>, start: &Start, slopes: &[f64]) -> Vec<f64>
where
    M: JointSpace<Scalar = f64>,
    D: JointSpace<Scalar = Number>,
{
    let x = joint_start(mechanism, start);
    let n = x.as_ref().len();
    let own = start.positions.len() + start.velocities.len() + start.n_others();
    let directions = slopes.len() / own.max(1);
    let mut state = x.as_ref().to_vec();
    state.resize(n * (1 + directions), 0.0);
    for (k, part) in parts.iter().enumerate() {
        let (mut y, mut x) = (part.mechanism.start(), part.joints(k, &state));
        let known =
            start.positions.iter().chain(&start.velocities).copied().chain(start.others()).enumerate();
        let number = |(at, value): (usize, f64)| {
            let slope = |column| slopes.get((k * COLUMNS + column) * own + at).copied().unwrap_or(0.0);
            Dual { value, slopes: core::array::from_fn(slope) }
        };
        write_start(start, known.map(number), y.as_mut());
        part.mechanism.to_joints(Dual::new(0.0), &y, &mut x);
        part.write_slopes(k, &x, &mut state);
    }
    state
}

/// An error in words; of a derivative that of what is differentiated is told.
fn words<M: JointSpace>(mechanism: &M, n: usize, error: &Error) -> String {
    let of_state = |index: u16| u16::try_from(usize::from(index) % n).unwrap_or(index);
    let error = match *error {
        Error::NotFinite { t, index } => Error::NotFinite { t, index: of_state(index) },
        Error::StepTooShort { t, step, index } => Error::StepTooShort { t, step, index: of_state(index) },
        other => other,
    };
    describe_in(mechanism, Some(mechanism.joint_layout()), error)
}
