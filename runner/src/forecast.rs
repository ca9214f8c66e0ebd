//! How long a run of fixed steps would take, said before it begins.

use crate::motion::Motion;
use gyro_sim::Mechanism;
use nanoserde::{DeBin, SerBin};
use std::time::{Duration, Instant};

/// Fewer steps than this are done before anyone has read a forecast.
const MANY: f64 = 1e5;

/// Steps are tried for so long.
const TRIAL: Duration = Duration::from_millis(20);

/// Steps between two looks at the clock.
const AT_ONCE: u32 = 16;

/// Steps of a run, and the time that they will take at the pace of the first ones.
#[derive(Clone, Copy, Debug, PartialEq, SerBin, DeBin)]
pub struct Forecast {
    /// Number of steps.
    pub steps: f64,
    /// Time, s.
    pub seconds: f64,
}

/// Tries the first steps of `motion`, which is of no use afterwards; `None` for a run of few steps, and for one that
/// fails at once.
pub(crate) fn forecast<M: Mechanism>(
    mechanism: &M,
    mut motion: Box<dyn Motion<M>>,
    (steps, step): (f64, f64),
) -> Option<Forecast> {
    let began = Instant::now();
    let mut tried = 0_u32;
    while began.elapsed() < TRIAL {
        for _ in 0..AT_ONCE {
            motion.step(mechanism, step).ok()?;
        }
        tried += AT_ONCE;
    }
    Some(Forecast { steps, seconds: began.elapsed().as_secs_f64() / f64::from(tried) * steps })
}

/// Whether a run of so many steps deserves a forecast.
pub(crate) fn is_long(steps: f64) -> bool {
    steps > MANY
}

/// A time as people say it.
pub fn duration_words(seconds: f64) -> String {
    const UNITS: [(f64, &str); 4] =
        [(60.0, "seconds"), (3600.0, "minutes"), (86_400.0, "hours"), (31_557_600.0, "days")];
    let mut unit = 1.0;
    for (limit, name) in UNITS {
        if seconds < 1.5 * limit {
            return format!("about {:.0} {name}", (seconds / unit).max(1.0));
        }
        unit = limit;
    }
    format!("about {:.0} years", seconds / unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_said_in_their_unit() {
        for (seconds, words) in [
            (0.2, "about 1 seconds"),
            (45.0, "about 45 seconds"),
            (600.0, "about 10 minutes"),
            (7200.0, "about 2 hours"),
            (1e6, "about 12 days"),
            (1e9, "about 32 years"),
        ] {
            assert_eq!(duration_words(seconds), words);
        }
    }
}
