//! Runs cases in child processes, and finds those that do not come back.

use crate::case::REFUTED;
use std::collections::BTreeMap;
use std::env;
use std::fs;
use std::io::{BufRead, BufReader};
use std::process::{Child, Command, ExitCode, Stdio};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::thread;
use std::time::{Duration, Instant};

/// How long one case may take of a processor, or of time where that is not known. All but a few take milliseconds, good
/// model files seconds.
pub const PATIENCE: Duration = Duration::from_secs(40);

/// How long one case may take on a machine that is busy with other things.
const LONGEST: Duration = Duration::from_secs(600);

/// Ticks of a second in which Linux counts what a process takes of a processor.
const TICKS: u64 = 100;

/// Memory that a child may take, kB.
pub const MEMORY_KB: u64 = 2_000_000;

/// What was found, and how much was tried.
#[derive(Default)]
struct Tally {
    outcomes: BTreeMap<String, u64>,
    /// Case and what is wrong with it.
    findings: Vec<(u64, String)>,
    /// Good model files whose modules are called wrong. Which of them are is not for this program to say.
    refuted: Vec<u64>,
}

/// Runs cases for so long on all processors; says what was tried and found, and fails if anything was.
pub fn supervise(seed: u64, budget: Duration) -> ExitCode {
    let end = Instant::now() + budget;
    let n = thread::available_parallelism().map_or(1, |n| n.get() as u64);
    let tallies: Vec<Tally> = thread::scope(|scope| {
        let threads: Vec<_> = (0..n).map(|k| scope.spawn(move || one(seed, k, n, end))).collect();
        threads.into_iter().filter_map(|thread| thread.join().ok()).collect()
    });
    let mut all = Tally::default();
    for tally in tallies {
        tally.outcomes.into_iter().for_each(|(what, count)| *all.outcomes.entry(what).or_default() += count);
        all.findings.extend(tally.findings);
        all.refuted.extend(tally.refuted);
    }
    report(seed, &all)
}

fn report(seed: u64, all: &Tally) -> ExitCode {
    let inputs: u64 = all.outcomes.values().sum::<u64>() + all.findings.len() as u64;
    let outcomes = all.outcomes.iter().map(|(what, count)| format!("{count} {what}"));
    println!("{inputs} inputs: {}", outcomes.collect::<Vec<_>>().join(", "));
    for (case, words) in &all.findings {
        println!("case {case}: {words}\n    cargo run --package gyro-fuzz -- --seed {seed} --case {case}");
    }
    if !all.refuted.is_empty() {
        println!("{REFUTED}: cases {:?}", all.refuted);
    }
    println!("{} found", all.findings.len());
    // A minute in which nothing was tried finds nothing either.
    if all.findings.is_empty() && inputs > 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// One processor's share.
fn one(seed: u64, first: u64, stride: u64, end: Instant) -> Tally {
    let (mut tally, mut next) = (Tally::default(), first);
    while Instant::now() < end {
        let Some(mut child) = child(seed, next, stride) else {
            tally.findings.push((next, "no process can be started".to_owned()));
            return tally;
        };
        let lines = lines(&mut child);
        let (mut current, mut begun) = (next, Clock::now(&child));
        let finding = loop {
            match lines.recv_timeout(Duration::from_millis(200)) {
                Ok(line) => match line.split_once(' ') {
                    Some(("begin", number)) => {
                        (current, begun) = (number.parse().unwrap_or(current), Clock::now(&child));
                    }
                    Some(("panic", words)) => tally.findings.push((current, words.to_owned())),
                    Some(("end", what)) => {
                        if what == REFUTED {
                            tally.refuted.push(current);
                        }
                        *tally.outcomes.entry(what.to_owned()).or_default() += 1;
                    }
                    _ => {}
                },
                Err(RecvTimeoutError::Timeout) if begun.is_over(&child) => break Some("takes too long"),
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => {
                    break Some("ended the process: too much memory or stack");
                }
            }
            if Instant::now() >= end {
                break None;
            }
        };
        // It may have ended by itself.
        let _ = child.kill();
        let _ = child.wait();
        if let Some(words) = finding {
            tally.findings.push((current, words.to_owned()));
        }
        next = current + stride;
    }
    tally
}

/// When a case began.
struct Clock {
    time: Instant,
    processor: Option<Duration>,
}

impl Clock {
    fn now(child: &Child) -> Self {
        Self { time: Instant::now(), processor: taken(child) }
    }

    fn is_over(&self, child: &Child) -> bool {
        let elapsed = self.time.elapsed();
        let taken = taken(child).zip(self.processor).map_or(elapsed, |(now, then)| now.saturating_sub(then));
        taken > PATIENCE || elapsed > LONGEST
    }
}

/// What a child has taken of a processor, where Linux counts it.
fn taken(child: &Child) -> Option<Duration> {
    let stat = fs::read_to_string(format!("/proc/{}/stat", child.id())).ok()?;
    // After the name in brackets; the name may hold anything.
    let fields: Vec<&str> = stat.rsplit_once(')')?.1.split_whitespace().collect();
    let ticks = |index: usize| fields.get(index)?.parse::<u64>().ok();
    Some(Duration::from_millis((ticks(11)? + ticks(12)?) * 1000 / TICKS))
}

fn child(seed: u64, first: u64, stride: u64) -> Option<Child> {
    let program = env::current_exe().ok()?;
    let mut command = if cfg!(unix) {
        let mut shell = Command::new("sh");
        shell.args(["-c", &format!("ulimit -v {MEMORY_KB}; exec \"$0\" \"$@\"")]).arg(program);
        shell
    } else {
        Command::new(program)
    };
    command.args(["--seed", &seed.to_string(), "--child", &first.to_string(), &stride.to_string()]);
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::null()).spawn().ok()
}

fn lines(child: &mut Child) -> Receiver<String> {
    let (sender, receiver) = mpsc::channel();
    if let Some(stdout) = child.stdout.take() {
        thread::spawn(move || {
            for line in BufReader::new(stdout).lines().map_while(Result::ok) {
                if sender.send(line).is_err() {
                    return;
                }
            }
        });
    }
    receiver
}
