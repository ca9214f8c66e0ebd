//! Threads that run blocks, each by itself or by a program of its own, and the order that their answers are brought
//! into.

use super::program::Program;
use super::starts;
use crate::failure::Failure;
use gyro_model::Model;
use gyro_runner::protocol::write;
use gyro_sweep::Source;
use gyro_sweep::child::{Job, Scenarios, StartSlopes, Unit};
use gyro_sweep::record;
use std::collections::BTreeMap;
use std::io::{self, BufReader};
use std::num::NonZeroUsize;
use std::ops::Range;
use std::path::Path;
use std::process::{self, ChildStdin, ChildStdout, Command, Stdio};
use std::sync::mpsc;
use std::sync::{Condvar, Mutex, PoisonError};
use std::thread;
use std::time::Instant;

/// Who runs a study.
#[derive(Clone, Copy, Debug)]
pub(super) struct Workers<'a> {
    pub(super) program: &'a Program,
    pub(super) job: &'static Job,
    /// The model that each scenario's start is assembled of; none where all start alike.
    pub(super) assembled: Option<&'a Model>,
    pub(super) threads: NonZeroUsize,
}

/// How long a program is left alone with its blocks, s.
const UNIT: f64 = 0.2;

/// Blocks, for each program, that may be under way or wait for an earlier one.
const AHEAD: u64 = 256;

/// Which blocks are under way.
#[derive(Debug)]
pub(super) struct Queue {
    /// The next to be handed out.
    next: u64,
    end: u64,
    /// The first that is not written yet.
    written: u64,
    is_stopped: bool,
    /// How many programs there are.
    programs: u64,
}

impl Queue {
    pub(super) fn new(places: &Range<u64>, programs: u64) -> Self {
        Self { next: places.start, end: places.end, written: places.start, is_stopped: false, programs }
    }

    /// Whether nothing is handed out any more.
    fn is_over(&self) -> bool {
        self.is_stopped || self.next >= self.end
    }

    /// Whether so much waits for an earlier block that nothing is handed out for now.
    fn is_full(&self) -> bool {
        self.next >= self.written + AHEAD * self.programs
    }

    /// Hands out the next places, if there are any to be handed out now.
    pub(super) fn give(&mut self, at_once: u64) -> Option<Range<u64>> {
        if self.is_over() || self.is_full() {
            return None;
        }
        // Towards the end all have something to do.
        let share = (self.end - self.next).div_ceil(2 * self.programs);
        let first = self.next;
        self.next += at_once.min(share).max(1);
        Some(first..self.next)
    }
}

/// The queue, and who waits for blocks to be written.
pub(super) type Shared = (Mutex<Queue>, Condvar);

/// The records of blocks at places that follow each other.
#[derive(Debug)]
pub(super) struct Records {
    /// The first place.
    pub(super) first: u64,
    /// How many there are.
    pub(super) count: u64,
    /// One after the other.
    pub(super) bytes: Vec<u8>,
}

pub(super) type Answer = Result<Records, Failure>;

impl Workers<'_> {
    /// Runs the blocks at these places of an order, of which `block` says the numbers; hands their records to `keep` in
    /// this order.
    ///
    /// # Errors
    /// Of a program, or of `keep`.
    pub(super) fn run(
        &self,
        places: Range<u64>,
        block: impl Fn(u64) -> u64 + Sync,
        mut keep: impl FnMut(Records) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let threads = (self.threads.get() as u64).min(places.end - places.start);
        let shared = (Mutex::new(Queue::new(&places, threads)), Condvar::new());
        thread::scope(|scope| {
            let (sender, answers) = mpsc::channel();
            for _ in 0..threads {
                let (sender, shared, block) = (sender.clone(), &shared, &block);
                scope.spawn(move || {
                    let send = |records| sender.send(Ok(records)).is_ok();
                    if let Err(failure) = self.work(|at_once| take(shared, at_once), block, send) {
                        // Nobody listens any more after another failure.
                        let _ = sender.send(Err(failure));
                    }
                });
            }
            drop(sender);
            let outcome = in_order(&shared, answers.into_iter(), &mut keep);
            lock(&shared.0).is_stopped = true;
            shared.1.notify_all();
            outcome
        })
    }

    /// Runs the places that `take` gives, which is told how many are wanted at once, until there are no more or nobody
    /// takes their records.
    ///
    /// # Errors
    /// Of the program.
    pub(super) fn work(
        &self,
        mut take: impl FnMut(u64) -> Option<Range<u64>>,
        block: impl Fn(u64) -> u64,
        mut send: impl FnMut(Records) -> bool,
    ) -> Result<(), Failure> {
        let mut worker = Worker::open(self.program, self.job)?;
        let mut source = Source::new(&self.job.plan);
        let mut at_once = 1;
        while let Some(places) = take(at_once) {
            let began = Instant::now();
            let blocks: Vec<u64> = places.clone().map(&block).collect();
            if !worker.run(&self.unit(blocks, &mut source), &places, &mut send)? {
                return Ok(());
            }
            #[expect(clippy::cast_precision_loss, reason = "a number of blocks")]
            let each = began.elapsed().as_secs_f64() / (places.end - places.start) as f64;
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it saturates")]
            let fitting = (UNIT / each) as u64;
            at_once = fitting.clamp(1, AHEAD / 4);
        }
        worker.close()
    }

    /// These blocks with where their scenarios start, unless all start alike; for sensitivities with derivatives.
    fn unit(&self, blocks: Vec<u64>, source: &mut Source<'_>) -> Unit {
        let mut unit = Unit { blocks, ..Unit::default() };
        let Some(model) = self.assembled else { return unit };
        let (plan, keep) = (&self.job.plan, &self.job.keep);
        let ranges = unit.blocks.iter().map(|block| self.job.range(*block));
        let mut values = vec![0.0; plan.targets.len()];
        for k in ranges.flat_map(|(first, count)| first..first + u64::from(count)) {
            source.write(k, &mut values);
            let started = starts::started(model, (&plan.targets, &values), &keep.moved);
            let slopes = match &started {
                Ok(_) => starts::slopes(model, plan, &keep.by, &values),
                Err(words) => Err(words.clone()),
            };
            unit.slopes.push(slopes.map_or_else(StartSlopes::Impossible, StartSlopes::Of));
            let (start, moved) = match started {
                Ok((start, moved)) => (Ok(start), moved),
                Err(words) => (Err(words), Vec::new()),
            };
            unit.starts.push(start);
            unit.moved.push(moved);
        }
        unit
    }
}

/// The next places, once there is room for what comes of them.
fn take((queue, written): &Shared, at_once: u64) -> Option<Range<u64>> {
    let mut queue = lock(queue);
    while !queue.is_over() && queue.is_full() {
        queue = written.wait(queue).unwrap_or_else(PoisonError::into_inner);
    }
    queue.give(at_once)
}

pub(super) fn lock(queue: &Mutex<Queue>) -> std::sync::MutexGuard<'_, Queue> {
    queue.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Hands on what comes, in its order.
pub(super) fn in_order(
    (queue, written): &Shared,
    answers: impl Iterator<Item = Answer>,
    mut keep: impl FnMut(Records) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let mut waiting = BTreeMap::new();
    let mut next = lock(queue).written;
    for answer in answers {
        let records = answer?;
        waiting.insert(records.first, records);
        while let Some(records) = waiting.remove(&next) {
            next += records.count;
            keep(records)?;
        }
        lock(queue).written = next;
        written.notify_all();
    }
    Ok(())
}

/// What runs the blocks of a thread.
enum Worker {
    Itself(Scenarios),
    Program(Child),
}

impl Worker {
    fn open(program: &Program, job: &'static Job) -> Result<Self, Failure> {
        match program {
            Program::InProcess(code) => {
                let own = code.lock().unwrap_or_else(PoisonError::into_inner).clone();
                Ok(Self::Itself(own.scenarios(job)))
            }
            Program::Compiled(path) => Child::open(path, job).map(Self::Program),
        }
    }

    /// Runs the blocks of a unit, which are those at some places, and sends their records; says whether anybody takes
    /// them.
    fn run(
        &mut self,
        unit: &Unit,
        places: &Range<u64>,
        send: &mut impl FnMut(Records) -> bool,
    ) -> Result<bool, Failure> {
        let mut first = places.start;
        match self {
            Self::Itself(scenarios) => {
                let told = scenarios.run(unit, &mut |block| {
                    let records = Records { first, count: 1, bytes: block.encode() };
                    first += 1;
                    if send(records) { Ok(()) } else { Err(io::ErrorKind::BrokenPipe.into()) }
                });
                Ok(told.is_ok())
            }
            Self::Program(program) => {
                program.ask(unit)?;
                while first < places.end {
                    let records = program.hear(first, places.end)?;
                    first += records.count;
                    if !send(records) {
                        return Ok(false);
                    }
                }
                Ok(true)
            }
        }
    }

    fn close(self) -> Result<(), Failure> {
        match self {
            Self::Itself(_) => Ok(()),
            Self::Program(program) => program.close(),
        }
    }
}

/// A program under way.
#[derive(Debug)]
struct Child {
    process: process::Child,
    /// None once there is nothing more to ask.
    input: Option<ChildStdin>,
    output: BufReader<ChildStdout>,
}

impl Child {
    fn open(program: &Path, job: &Job) -> Result<Self, Failure> {
        let failed = |error: io::Error| Failure::Run(format!("{}: {error}", program.display()));
        let mut command = Command::new(program);
        let mut process = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().map_err(failed)?;
        let mut input = process.stdin.take().expect("standard input is piped");
        let output =
            BufReader::with_capacity(1 << 16, process.stdout.take().expect("standard output is piped"));
        let written = write(&mut input, job);
        let child = Self { process, input: Some(input), output };
        written.map_err(failed)?;
        Ok(child)
    }

    fn ask(&mut self, unit: &Unit) -> Result<(), Failure> {
        let input = self.input.as_mut().expect("it is taken when the worker is closed");
        write(input, unit).map_err(|error| self.ended(&error.to_string()))
    }

    /// Lets the program end: it does when its input ends.
    fn close(mut self) -> Result<(), Failure> {
        drop(self.input.take());
        self.process.wait().map(|_| ()).map_err(|error| self.ended(&error.to_string()))
    }

    /// The record of a place, and of those before `end` that have come with it: to wake who writes them takes as long
    /// as several scenarios.
    fn hear(&mut self, first: u64, end: u64) -> Result<Records, Failure> {
        let mut records = Records { first, count: 0, bytes: Vec::new() };
        loop {
            match record::next(&mut self.output) {
                Ok(Some(bytes)) => records.bytes.extend(bytes),
                Ok(None) => return Err(self.ended("no answer")),
                Err(error) => return Err(self.ended(&error.to_string())),
            }
            records.count += 1;
            if records.first + records.count == end || self.output.buffer().is_empty() {
                return Ok(records);
            }
        }
    }

    fn ended(&mut self, words: &str) -> Failure {
        let _ = self.process.kill();
        let status = self.process.wait().map_or_else(|e| e.to_string(), |status| status.to_string());
        Failure::Run(format!(
            "the program that runs scenarios has ended: {words} ({status}); --resume goes on"
        ))
    }
}

impl Drop for Child {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}
