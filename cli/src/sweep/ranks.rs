//! `gyro sweep --mpi`: the first rank hands out blocks and writes them in their order, the others run them.
//!
//! The first rank compiles the program and broadcasts it; study and model are read by every rank.

use super::loaded::Loaded;
use super::program::{Program, Way};
use super::workers::{Answer, Queue, Records, Workers, in_order, lock};
use super::{Keep, Sweep, job};
use crate::args::{Shard, SweepArgs};
use crate::failure::Failure;
use crate::write::digest;
use gyro_runner::protocol;
use gyro_sweep::child::Job;
use mpi::topology::SimpleCommunicator;
use mpi::traits::{Communicator, Destination, Root, Source};
use std::collections::VecDeque;
use std::fs::{self, OpenOptions};
use std::io::Write;
use std::num::NonZeroUsize;
use std::ops::Range;
use std::os::unix::fs::OpenOptionsExt;
use std::path::{Path, PathBuf};
use std::sync::{Condvar, Mutex};

/// A rank asks for so many places: a u64. It is answered with a range, two u64; an empty one ends it.
const ASK: i32 = 1;
const GIVE: i32 = 2;
/// The first of some places that follow each other and how many they are, two u64, and the records of their blocks.
const RECORDS: i32 = 3;

/// Runs a study on all ranks; a failure of one ends the job.
pub(super) fn sweep(loaded: Loaded, args: &SweepArgs, folder: &Path) -> Result<(), Failure> {
    let universe = mpi::initialize()
        .ok_or_else(|| Failure::Usage("MPI does not start: has it been started before?".to_owned()))?;
    let world = universe.world();
    let outcome = match world.rank() {
        0 => lead(&world, loaded, args, folder),
        _ => follow(&world, &loaded, args),
    };
    if let Err(failure) = outcome {
        failure.report();
        world.abort(1);
    }
    Ok(())
}

fn lead(world: &SimpleCommunicator, loaded: Loaded, args: &SweepArgs, folder: &Path) -> Result<(), Failure> {
    let (sweep, _) = Sweep::new(loaded, args)?;
    let Program::Compiled(program) = &sweep.program else { unreachable!("ranks run what rustc compiles") };
    if world.size() == 1 {
        return sweep.fill(None, (folder, args.resume), |places, keep| sweep.on_cores(places, keep));
    }
    let read = |error| Failure::Run(format!("{}: {error}", program.display()));
    broadcast(world, digest_of(sweep.job).into_bytes());
    broadcast(world, fs::read(program).map_err(read)?);
    let mut idle = VecDeque::new();
    sweep.fill(None, (folder, args.resume), |places, keep| hand_out(world, &mut idle, &places, keep))?;
    for _ in idle.len()..ranks(world) {
        let (_, status) = world.any_process().receive_vec_with_tag::<u8>(ASK);
        idle.push_back((status.source_rank(), 0));
    }
    serve(world, &mut idle, |_| Some(0..0));
    Ok(())
}

/// How many ranks run blocks.
fn ranks(world: &SimpleCommunicator) -> usize {
    world.size().unsigned_abs() as usize - 1
}

/// Ranks that have asked for blocks, and for how many.
type Idle = VecDeque<(i32, u64)>;

/// Hands out places and takes their records.
fn hand_out(
    world: &SimpleCommunicator,
    idle: &mut Idle,
    places: &Range<u64>,
    keep: &mut Keep<'_>,
) -> Result<(), Failure> {
    let shared = (Mutex::new(Queue::new(places, ranks(world) as u64)), Condvar::new());
    let mut missing = places.end - places.start;
    let answers = std::iter::from_fn(|| {
        while missing > 0 {
            serve(world, idle, |at_once| lock(&shared.0).give(at_once));
            let (message, status) = world.any_process().receive_vec::<u8>();
            if status.tag() == ASK {
                idle.push_back((status.source_rank(), word(&message, 0)));
            } else {
                let [first, count] = [0, 8].map(|at| word(&message, at));
                missing -= count;
                return Some(Answer::Ok(Records { first, count, bytes: message[16..].to_vec() }));
            }
        }
        None
    });
    in_order(&shared, answers, keep)
}

/// Gives those who wait what there is.
fn serve(world: &SimpleCommunicator, idle: &mut Idle, mut give: impl FnMut(u64) -> Option<Range<u64>>) {
    while let Some((rank, at_once)) = idle.front() {
        let Some(places) = give(*at_once) else { return };
        world.process_at_rank(*rank).send_with_tag(&[places.start, places.end], GIVE);
        idle.pop_front();
    }
}

fn follow(world: &SimpleCommunicator, loaded: &Loaded, args: &SweepArgs) -> Result<(), Failure> {
    // One job for the life of this process.
    let job: &'static Job = Box::leak(Box::new(job(loaded)));
    let expected = broadcast(world, Vec::new());
    let program = OnDisk::new(world.rank(), &broadcast(world, Vec::new()))?;
    let (compiled, mut program) = (Program::Compiled(program.0.clone()), Some(program));
    if digest_of(job).as_bytes() != expected {
        let (rank, path) = (world.rank(), &loaded.path);
        return Err(Failure::Run(format!("rank {rank} reads another {path}, or another model")));
    }
    let way = Way::of(loaded);
    let workers = Workers {
        program: &compiled,
        job,
        assembled: (way == Way::Whole).then_some(&loaded.scene.page),
        threads: NonZeroUsize::MIN,
    };
    let first = world.process_at_rank(0);
    let take = |at_once: u64| {
        // It runs: nothing is left behind, whatever ends this rank.
        drop(program.take());
        first.send_with_tag(&at_once.to_le_bytes()[..], ASK);
        let (places, _) = first.receive_vec_with_tag::<u64>(GIVE);
        (places[0] < places[1]).then(|| places[0]..places[1])
    };
    let shard = args.shard.unwrap_or(Shard::WHOLE);
    let block = |place| shard.number - 1 + place * shard.of;
    let send = |records: Records| {
        let [place, count] = [records.first, records.count].map(u64::to_le_bytes);
        first.send_with_tag(&[&place[..], &count, &records.bytes].concat()[..], RECORDS);
        true
    };
    workers.work(take, block, send)
}

fn digest_of(job: &Job) -> String {
    let mut bytes = Vec::new();
    protocol::write(&mut bytes, job).expect("memory takes every write");
    digest(&bytes)
}

/// What the first rank has.
fn broadcast(world: &SimpleCommunicator, mut bytes: Vec<u8>) -> Vec<u8> {
    let first = world.process_at_rank(0);
    let mut length = bytes.len() as u64;
    first.broadcast_into(&mut length);
    bytes.resize(usize::try_from(length).expect("it fits into memory"), 0);
    first.broadcast_into(&mut bytes[..]);
    bytes
}

fn word(message: &[u8], at: usize) -> u64 {
    u64::from_le_bytes(message[at..at + 8].try_into().expect("eight bytes"))
}

/// A rank's own copy of the program: the folder that it was compiled in may be of another machine.
struct OnDisk(PathBuf);

impl OnDisk {
    fn new(rank: i32, program: &[u8]) -> Result<Self, Failure> {
        let path = std::env::temp_dir().join(format!("gyro-sweep-{}-{rank}", std::process::id()));
        let mut options = OpenOptions::new();
        let file = options.write(true).create_new(true).mode(0o700).open(&path);
        let written = file.and_then(|mut file| file.write_all(program));
        written.map_err(|error| Failure::Run(format!("{}: {error}", path.display())))?;
        Ok(Self(path))
    }
}

impl Drop for OnDisk {
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.0);
    }
}
