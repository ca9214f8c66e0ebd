//! How far long work is, on standard error: a line that is written over on terminals, lines of their own elsewhere.

use crate::remarks;
use gyro_model::Model;
use gyro_runner::{Forecast, duration_words};
use std::io::{IsTerminal, Write as _};
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::thread;
use std::time::{Duration, Instant};

/// A line of a terminal that is written over. Nowhere else is it written, nor if nothing is to be said.
#[derive(Debug)]
struct Line {
    is_shown: bool,
    began: Instant,
    /// When it was written last, if it was.
    written: Option<Instant>,
}

/// A line is not written more often.
const EVERY: Duration = Duration::from_millis(100);

/// Longer lines would be broken by narrow terminals, and then no longer be written over.
const COLUMNS: usize = 79;

impl Line {
    fn new() -> Self {
        let is_shown = std::io::stderr().is_terminal() && !remarks::is_quiet();
        Self { is_shown, began: Instant::now(), written: None }
    }

    /// Writes the line, unless it has just been written.
    fn show(&mut self, words: impl FnOnce() -> String) {
        if self.is_shown && self.written.is_none_or(|at| at.elapsed() >= EVERY) {
            let words: String = words().chars().take(COLUMNS).collect();
            // Nobody is left to be told if standard error is closed.
            let _ = write!(std::io::stderr(), "\r\x1b[2K{words}");
            self.written = Some(Instant::now());
        }
    }

    /// A bar for what part is done, and how long the rest takes at the pace so far.
    fn bar(&self, part: f64) -> String {
        const WIDTH: f64 = 30.0;
        let part = part.clamp(0.0, 1.0);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "up to the width of the bar"
        )]
        let [done, all] = [part * WIDTH, WIDTH].map(|columns| columns as usize);
        let left = match part > 0.0 {
            true => {
                format!("{} left", duration_words(self.began.elapsed().as_secs_f64() * (1.0 / part - 1.0)))
            }
            false => String::new(),
        };
        format!("[{}{}] {left}", "=".repeat(done), " ".repeat(all - done))
    }

    /// Takes the line away.
    fn clear(&mut self) {
        if self.written.take().is_some() {
            let _ = write!(std::io::stderr(), "\r\x1b[2K");
        }
    }
}

impl Drop for Line {
    fn drop(&mut self) {
        self.clear();
    }
}

/// Shows how far a run is once it has taken a while.
#[derive(Debug)]
pub struct Progress {
    t_end: f64,
    line: Line,
}

/// A run shorter than this is over before anyone has read the bar.
const PATIENCE: Duration = Duration::from_millis(500);

/// Whoever waits for so long, s, is told beforehand.
const LONG: f64 = 10.0;

impl Progress {
    pub fn new(t_end: f64) -> Self {
        Self { t_end, line: Line::new() }
    }

    /// Says how long the run will take, if that is long.
    pub fn foretold(&self, forecast: &Forecast) {
        if forecast.seconds > LONG && !remarks::is_quiet() {
            let words = duration_words(forecast.seconds);
            // Nobody is left to be told if standard error is closed.
            let _ = writeln!(std::io::stderr(), "{:.3e} steps will take {words}", forecast.steps);
        }
    }

    /// The run has reached this time.
    pub fn reached(&mut self, t: f64) {
        if self.line.began.elapsed() < PATIENCE {
            return;
        }
        let bar = self.line.bar(t / self.t_end);
        self.line.show(|| format!("{bar}, t = {t:.3} s of {} s", self.t_end));
    }

    /// Takes the bar away.
    pub fn finish(&mut self) {
        self.line.clear();
    }
}

/// Says what is under way until it is dropped: at once on a terminal, elsewhere in lines, and only if it takes a while.
#[derive(Debug)]
pub struct Spinner {
    _line: Line,
    /// Dropped at the end, which the thread that writes lines hears.
    _end: Option<Sender<()>>,
}

/// Before the first line that says what is under way, and between later ones.
const FIRST_LINE: Duration = Duration::from_secs(1);
const NEXT_LINES: Duration = Duration::from_secs(30);

impl Spinner {
    pub fn new(message: String) -> Self {
        let mut line = Line::new();
        let is_terminal = std::io::stderr().is_terminal();
        line.show(|| message.clone());
        let end = (!is_terminal).then(|| in_lines(message, remarks::note));
        Self { _line: line, _end: end }
    }
}

/// Says that a model is being derived; and, before that begins, what it takes to derive a large one.
pub fn deriving(model: &Model) -> Spinner {
    let bodies = model.coordinate_bodies().len();
    if bodies > LARGE {
        remarks::note(&format!(
            "`{}` has {bodies} moving bodies: deriving and proving its formulas takes up to {:.1} GB of memory, and a minute for each 200 of them or longer; compiling them \
             takes longer still. `simulate --engine assembled` begins at once",
            model.name,
            GIGABYTES * bodies as f64,
        ));
    }
    Spinner::new(format!("deriving {}", model.name))
}

/// Bodies of a model of which this is said.
const LARGE: usize = 64;

/// What a body takes, measured on chains of revolute joints with skewed axes: 1.2 GB for 100, 2.4 GB for 200; 500 free
/// bodies take 1.7 GB.
const GIGABYTES: f64 = 0.012;

/// Says what is under way, until what is returned is dropped.
fn in_lines(message: String, say: impl Fn(&str) + Send + 'static) -> Sender<()> {
    let (end, ended) = mpsc::channel();
    thread::spawn(move || {
        let began = Instant::now();
        let mut wait = FIRST_LINE;
        while ended.recv_timeout(wait) == Err(RecvTimeoutError::Timeout) {
            let seconds = began.elapsed().as_secs();
            if wait == FIRST_LINE {
                say(&message)
            } else {
                say(&format!("{message} ({seconds} s)"))
            }
            wait = NEXT_LINES;
        }
    });
    end
}

/// Shows how much of a list is done, one list after the other.
#[derive(Debug)]
pub struct Count {
    prefix: String,
    what: String,
    done: u64,
    all: u64,
    line: Line,
}

impl Count {
    pub fn new(prefix: String) -> Self {
        Self { prefix, what: String::new(), done: 0, all: 1, line: Line::new() }
    }

    /// A new list of so many.
    pub fn begin(&mut self, what: &str, all: u64) {
        self.what = what.to_owned();
        (self.done, self.all) = (0, all);
        self.show("");
    }

    /// Some of them are done.
    pub fn advance(&mut self, number: u64, what: &str) {
        self.done += number;
        self.show(what);
    }

    #[expect(clippy::cast_precision_loss, reason = "for people to read")]
    fn show(&mut self, last: &str) {
        let Self { prefix, what, done, all, .. } = self;
        let bar = self.line.bar(*done as f64 / *all as f64);
        self.line.show(|| format!("{prefix} {what} {bar} {done}/{all} {last}"));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_takes_a_while_is_said_and_what_does_not_is_not() {
        let (sender, heard) = mpsc::channel();
        let quick = sender.clone();
        drop(in_lines("quick".to_owned(), move |words| quick.send(words.to_owned()).expect("it is heard")));
        let slow =
            in_lines("slow".to_owned(), move |words| sender.send(words.to_owned()).expect("it is heard"));
        assert_eq!(heard.recv().as_deref(), Ok("slow"));
        drop(slow);
        assert!(heard.recv().is_err(), "nothing more is said at the end");
    }
}
