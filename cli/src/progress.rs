//! A progress bar on standard error, for long runs and for terminals only.

use crate::remarks;
use gyro_model::Model;
use gyro_runner::{Forecast, duration_words};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::{IsTerminal, Write as _};
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::thread;
use std::time::{Duration, Instant};

/// Shows how far a run is once it has taken a while.
#[derive(Debug)]
pub struct Progress {
    began: Instant,
    t_end: f64,
    bar: Option<ProgressBar>,
}

/// A run shorter than this is over before anyone has read the bar.
const PATIENCE: Duration = Duration::from_millis(500);

/// Whoever waits for so long, s, is told beforehand.
const LONG: f64 = 10.0;

/// Positions of the bar.
const DIVISIONS: u64 = 1000;

impl Progress {
    pub fn new(t_end: f64) -> Self {
        Self { began: Instant::now(), t_end, bar: None }
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
        if remarks::is_quiet() || self.bar.is_none() && self.began.elapsed() < PATIENCE {
            return;
        }
        let bar = self.bar.get_or_insert_with(bar);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 1000")]
        bar.set_position((t / self.t_end * DIVISIONS as f64) as u64);
        bar.set_message(format!("t = {t:.3} s of {} s", self.t_end));
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// A bar that draws on standard error, and nowhere if that is not a terminal.
fn bar() -> ProgressBar {
    let style = ProgressStyle::with_template("{bar:40} {percent:>3} % {msg}, {eta} left");
    ProgressBar::new(DIVISIONS).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}

/// A bar that draws unless nothing is to be said.
fn shown(bar: ProgressBar) -> ProgressBar {
    if remarks::is_quiet() {
        bar.set_draw_target(ProgressDrawTarget::hidden());
    }
    bar
}

/// Says what is under way until it is dropped: at once on a terminal, elsewhere in lines, and only if it takes a while.
#[derive(Debug)]
pub struct Spinner {
    bar: ProgressBar,
    /// Dropped at the end, which the thread that writes lines hears.
    _end: Option<Sender<()>>,
}

/// Before the first line that says what is under way, and between later ones.
const FIRST_LINE: Duration = Duration::from_secs(1);
const NEXT_LINES: Duration = Duration::from_secs(30);

impl Spinner {
    pub fn new(message: String) -> Self {
        let is_terminal = std::io::stderr().is_terminal();
        let end = (!is_terminal).then(|| in_lines(message.clone(), remarks::note));
        let bar = shown(ProgressBar::new_spinner().with_message(message));
        bar.enable_steady_tick(Duration::from_millis(100));
        Self { bar, _end: end }
    }
}

impl Drop for Spinner {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
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
    bar: ProgressBar,
    prefix: String,
}

impl Count {
    pub fn new(prefix: String) -> Self {
        let style = ProgressStyle::with_template("{prefix} {bar:30} {pos}/{len} {msg} ({elapsed})");
        let bar =
            shown(ProgressBar::new(1).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar())));
        bar.enable_steady_tick(Duration::from_millis(200));
        Self { bar, prefix }
    }

    /// A new list of so many.
    pub fn begin(&self, what: &str, length: u64) {
        self.bar.set_prefix(format!("{} {what}", self.prefix));
        self.bar.set_length(length);
        self.bar.set_position(0);
        self.bar.set_message("");
    }

    /// One of them is done.
    pub fn advance(&self, what: &str) {
        self.bar.inc(1);
        self.bar.set_message(what.to_owned());
    }
}

impl Drop for Count {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
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
