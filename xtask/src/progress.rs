//! A progress bar on standard error, for long runs and for terminals only.

use gyro_runner::{Forecast, duration_words};
use indicatif::{ProgressBar, ProgressStyle};
use std::io::Write as _;
use std::time::{Duration, Instant};

/// Shows how far a run is once it has taken a while.
#[derive(Debug)]
pub(crate) struct Progress {
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
    pub(crate) fn new(t_end: f64) -> Self {
        Self { began: Instant::now(), t_end, bar: None }
    }

    /// Says how long the run will take, if that is long.
    pub(crate) fn foretold(&self, forecast: &Forecast) {
        if forecast.seconds > LONG {
            let words = duration_words(forecast.seconds);
            // Nobody is left to be told if standard error is closed.
            let _ = writeln!(std::io::stderr(), "{:.3e} steps will take {words}", forecast.steps);
        }
    }

    /// The run has reached this time.
    pub(crate) fn reached(&mut self, t: f64) {
        if self.bar.is_none() && self.began.elapsed() < PATIENCE {
            return;
        }
        let bar = self.bar.get_or_insert_with(bar);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 1000")]
        bar.set_position((t / self.t_end * DIVISIONS as f64) as u64);
        bar.set_message(format!("t = {t:.3} s of {} s", self.t_end));
    }

    /// Takes the bar away.
    pub(crate) fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// A bar that draws on standard error, and nowhere if that is no terminal.
fn bar() -> ProgressBar {
    let style = ProgressStyle::with_template("{bar:40} {percent:>3} % {msg}, {eta} left");
    ProgressBar::new(DIVISIONS).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}

/// Says what is under way until it is dropped.
#[derive(Debug)]
pub(crate) struct Spinner(ProgressBar);

impl Spinner {
    pub(crate) fn new(message: String) -> Self {
        let spinner = ProgressBar::new_spinner().with_message(message);
        spinner.enable_steady_tick(Duration::from_millis(100));
        Self(spinner)
    }
}

impl Drop for Spinner {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}

/// Shows how much of a list is done, one list after the other.
#[derive(Debug)]
pub(crate) struct Count {
    bar: ProgressBar,
    prefix: String,
}

impl Count {
    pub(crate) fn new(prefix: String) -> Self {
        let style = ProgressStyle::with_template("{prefix} {bar:30} {pos}/{len} {msg} ({elapsed})");
        let bar = ProgressBar::new(1).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        bar.enable_steady_tick(Duration::from_millis(200));
        Self { bar, prefix }
    }

    /// A new list of so many.
    pub(crate) fn begin(&self, what: &str, length: u64) {
        self.bar.set_prefix(format!("{} {what}", self.prefix));
        self.bar.set_length(length);
        self.bar.set_position(0);
        self.bar.set_message("");
    }

    /// One of them is done.
    pub(crate) fn advance(&self, what: &str) {
        self.bar.inc(1);
        self.bar.set_message(what.to_owned());
    }
}

impl Drop for Count {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
