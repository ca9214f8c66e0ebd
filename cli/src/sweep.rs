//! `gyro sweep`: a study's scenarios, on all cores.

mod loaded;
mod merge;
mod only;
mod program;
#[cfg(feature = "mpi")]
mod ranks;
mod results;
mod starts;
mod store;
mod vocabulary;
mod workers;

use crate::args::{Shard, SweepArgs, SweepCommand, SweepEngine};
use crate::failure::Failure;
use crate::folder::Folder;
use crate::progress::Count;
use crate::proof::Proof;
use crate::remarks::say;
use crate::words::{count, number};
use crate::write::{Known, digest, write};
use crate::{files, programs, remarks};
use gyro_runner::{Settings, duration_words, protocol};
use gyro_sweep::child::Job;
use gyro_sweep::record::{self, Block};
use loaded::Loaded;
use program::{Program, Way};
use std::num::NonZeroUsize;
use std::ops::Range;
use std::path::Path;
use std::process::Command;
use std::sync::Mutex;
use std::time::Instant;
use store::{Head, Store};
use workers::{Records, Workers};

/// Runs a study, or puts parts of one together.
pub(crate) fn sweep(args: &SweepArgs) -> Result<(), Failure> {
    if let Some(SweepCommand::Merge(parts)) = &args.command {
        return merge::merge(parts);
    }
    let study = args.study.as_deref().unwrap_or(Path::new(""));
    let loaded = Loaded::new(study)?;
    let folder = args.out.clone().unwrap_or_else(|| Path::new("out").join(&loaded.name));
    if let Some(k) = args.only {
        return only::only(&loaded, k, &folder);
    }
    #[cfg(feature = "mpi")]
    if args.mpi {
        return ranks::sweep(loaded, args, &folder);
    }
    let (sweep, proof) = Sweep::new(loaded, args)?;
    if args.estimate {
        return sweep.estimate();
    }
    sweep.fill(proof, (&folder, args.resume), |places, keep| sweep.on_cores(places, keep))
}

/// Takes records, in their order.
type Keep<'a> = dyn FnMut(Records) -> Result<(), Failure> + 'a;

/// A sweep that can be made.
struct Sweep {
    loaded: Loaded,
    way: Way,
    program: Program,
    /// Whether a long sweep is run by a program that is compiled for it.
    compiles_if_long: bool,
    job: &'static Job,
    head: Head,
    threads: NonZeroUsize,
}

impl Sweep {
    /// A sweep, and the proof of what runs in this process, which has begun.
    fn new(loaded: Loaded, args: &SweepArgs) -> Result<(Self, Option<Proof>), Failure> {
        let way = Way::of(&loaded);
        let (program, proof, digest) = match args.engine() {
            Some(SweepEngine::Generated) => {
                let digest = program::digest_of(&program::scheduled(&loaded)?, way, args.native);
                (Program::Compiled(program::compiled(&loaded, way, args.native)?), None, digest)
            }
            Some(SweepEngine::InProcess) | None => {
                let (program, proof) = program::in_process(&loaded, way)?;
                let digest = program::digest_of(program.mechanism.scheduled(), way, false);
                (Program::InProcess(Mutex::new(Box::new(program))), Some(proof), digest)
            }
        };
        // One job for the life of this process.
        let job = &*Box::leak(Box::new(job(&loaded)));
        let head = head(&loaded, job, digest).with(args.shard.unwrap_or(Shard::WHOLE));
        let cores = std::thread::available_parallelism().unwrap_or(NonZeroUsize::MIN);
        let threads = args.threads.unwrap_or(cores);
        let compiles_if_long = args.engine().is_none();
        Ok((Self { loaded, way, program, compiles_if_long, job, head, threads }, proof))
    }

    fn workers<'a>(&'a self, program: &'a Program) -> Workers<'a> {
        let assembled = (self.way == Way::Whole).then_some(&self.loaded.scene.page);
        Workers { program, job: self.job, assembled, threads: self.threads }
    }

    /// Fills a folder with results: `run` runs the blocks at places that it does not have yet.
    fn fill(
        &self,
        proof: Option<Proof>,
        (folder, is_resumed): (&Path, bool),
        run: impl FnOnce(Range<u64>, &mut Keep<'_>) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let opened = Folder::open(folder)?;
        let folder = opened.path();
        let store =
            if is_resumed { Store::resume(folder, &self.head) } else { Store::create(folder, &self.head) };
        let mut store = store?;
        let place = self.loaded.place.to_string_lossy();
        write(&folder.join(store::PLACE), place.as_bytes(), Known::Place).map_err(store::stays)?;
        self.run(&mut store, run)?;
        if let Some(proof) = proof {
            let (standing, _) = proof.settle()?;
            remarks::note(&format!("engine in-process, {}", standing.words()));
        }
        let is_part = self.head.shard[1] > 1;
        if is_part {
            return say(&format!(
                "wrote {}: `sweep merge` puts the parts together\n",
                folder.join(store::NAME).display()
            ));
        }
        results::write(folder, &self.loaded).map_err(store::stays)
    }

    fn run(
        &self,
        store: &mut Store,
        run: impl FnOnce(Range<u64>, &mut Keep<'_>) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let (first, end) = (store.written, self.head.blocks());
        if first >= end {
            return Ok(());
        }
        let block = u64::from(self.head.block);
        let mut progress = Count::new(self.head.name.clone());
        progress.begin("scenarios", self.head.scenarios.min(end * block) - first * block);
        let (mut done, mut failed) = (0, 0);
        let nonsense = |error| Failure::Run(format!("the program answers nonsense: {error}"));
        let mut keep = |records: Records| {
            let (mut rest, before) = (&records.bytes[..], done);
            while let Some(bytes) = record::next(&mut rest).map_err(nonsense)? {
                let block = Block::decode(&bytes, self.head.width).map_err(nonsense)?;
                done += u64::from(block.count);
                failed += block.errors.len() as u64;
            }
            progress
                .advance(done - before, &if failed > 0 { format!("{failed} failed") } else { String::new() });
            store.append(&records.bytes, records.count)
        };
        let began = Instant::now();
        run(first..end, &mut keep)?;
        drop(progress);
        #[expect(clippy::cast_precision_loss, reason = "for people to read")]
        let rate = done as f64 / began.elapsed().as_secs_f64();
        let failures = if failed > 0 { format!(", {failed} of them failed") } else { String::new() };
        say(&format!("{}{failures}; {} a second\n", count(done, "scenario"), number(rate, 3)))
    }

    /// Runs blocks on the cores of this machine, and says first what they will cost.
    fn on_cores(&self, places: Range<u64>, keep: &mut Keep<'_>) -> Result<(), Failure> {
        let (mut next, mut left) = (places.start, 0.0);
        let tell = |each: f64, run: Range<u64>| {
            next = run.end;
            left = each * blocks(places.end - next) / self.cores();
            remarks::note(&self.cost(each, places.end - next));
        };
        self.probe(places.clone(), tell, &mut *keep)?;
        let mut program = &self.program;
        let compiled;
        if self.compiles_if_long && left > LONG {
            remarks::note("that is long enough to have rustc compile the mechanism first");
            compiled = Program::Compiled(program::compiled(&self.loaded, self.way, false)?);
            program = &compiled;
        }
        match next < places.end {
            true => self.workers(program).run(next..places.end, |n| self.head.block(n), keep),
            false => Ok(()),
        }
    }

    #[expect(clippy::cast_precision_loss, reason = "a number of cores")]
    fn cores(&self) -> f64 {
        self.threads.get() as f64
    }

    /// Runs the first of some blocks, and more where it is over at once, which is mostly the start of a program; tells
    /// how long a block takes, s, and which were run.
    fn probe(
        &self,
        places: Range<u64>,
        tell: impl FnOnce(f64, Range<u64>),
        mut keep: impl FnMut(Records) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let mut run = |places: Range<u64>| {
            let began = Instant::now();
            let cores = (self.threads.get() as u64).min(places.end - places.start);
            self.workers(&self.program).run(places.clone(), |n| self.head.block(n), &mut keep)?;
            let each = began.elapsed().as_secs_f64() / blocks(places.end - places.start);
            Ok::<f64, Failure>(each * blocks(cores))
        };
        let mut end = places.start + 1;
        let mut each = run(places.start..end)?;
        if each < QUICK && end < places.end {
            let more = end..(end + PROBE).min(places.end);
            end = more.end;
            each = run(more)?;
        }
        tell(each, places.start..end);
        Ok(())
    }

    /// Says what so many blocks will cost, from what one of them takes on one core, s.
    fn cost(&self, one: f64, rest: u64) -> String {
        #[expect(clippy::cast_precision_loss, reason = "for people to read")]
        let bytes = self.head.scenarios as f64 * 8.0 * self.head.width as f64;
        format!(
            "{} in blocks of {}; a block takes {} s, the rest {} on {}, and all {} MB of disk",
            count(self.head.scenarios, "scenario"),
            self.head.block,
            number(one, 2),
            duration_words(one * blocks(rest) / self.cores()),
            count(self.threads.get() as u64, "core"),
            number(bytes / 1e6, 2),
        )
    }

    fn estimate(&self) -> Result<(), Failure> {
        let mut words = String::new();
        let tell = |seconds, _| words = self.cost(seconds, self.head.blocks()) + "\n";
        self.probe(0..self.head.blocks(), tell, |_| Ok(()))?;
        say(&words)
    }
}

/// A block that takes less than this, s, and how many more of them tell what one takes.
const QUICK: f64 = 0.05;
const PROBE: u64 = 64;

/// A sweep of which more than this is left, s, is run by a program that rustc compiles: that takes ten seconds and
/// more, and runs scenarios up to several times as fast.
const LONG: f64 = 30.0;

#[expect(clippy::cast_precision_loss, reason = "a number of blocks")]
fn blocks(number: u64) -> f64 {
    number as f64
}

fn job(loaded: &Loaded) -> Job {
    let Loaded { study, scene, .. } = loaded;
    // Samples that nothing is kept of take as long as the rest of a run. Under error control none changes a step.
    let is_read_at_its_end = study.keep.reads_the_end_alone()
        && scene.approach.tolerance.is_some()
        && !scene.page.has_rigid_contacts()
        && scene.page.lines().is_empty()
        && Way::of(loaded) == Way::Whole;
    let sample_every = if is_read_at_its_end { scene.settings.t_end } else { scene.settings.sample_every };
    Job {
        plan: study.plan.clone(),
        keep: study.keep.clone(),
        settings: Settings { sample_every, ..scene.settings },
        approach: scene.approach,
        parameters: scene.parameters(),
        start: scene.start.clone(),
        block: study.block,
        measure: study.keep.estimate.then(|| (scene.model.size(), scene.is_balanced)),
    }
}

fn head(loaded: &Loaded, job: &Job, program: String) -> Head {
    let mut bytes = Vec::new();
    protocol::write(&mut bytes, job).expect("memory takes every write");
    Head {
        format: 1,
        name: loaded.name.clone(),
        study: loaded.text.clone(),
        path: loaded.path.clone(),
        program,
        job: digest(&bytes),
        commit: commit(),
        seed: job.plan.seed,
        scenarios: job.plan.scenarios(),
        block: job.block,
        width: job.keep.width(job.times().len()),
        shard: [0, 1],
    }
}

/// The commit that the tool was built from, as far as the workspace tells.
fn commit() -> String {
    let mut git = Command::new("git");
    let version = env!("CARGO_PKG_VERSION").to_owned();
    git.arg("-C").arg(files::root()).args(["describe", "--always", "--dirty", "--abbrev=12", "--exclude=*"]);
    programs::output(&mut git).map_or(version, |words| words.trim().to_owned())
}
