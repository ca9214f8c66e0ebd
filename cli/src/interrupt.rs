//! Ctrl-C: a run that is under way ends where it is, and what it has computed is kept; anything else ends at once, and
//! so does a run that is interrupted a second time.

use crate::failure::{Failure, INTERRUPTED};
use gyro_runner::Event;
use std::io;
use std::sync::Once;
use std::sync::atomic::{AtomicBool, Ordering};

static RUNS: AtomicBool = AtomicBool::new(false);
static WAS_INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// A run that is under way until this is dropped.
#[derive(Debug)]
pub(crate) struct Run;

impl Run {
    pub(crate) fn begin() -> Self {
        static HANDLER: Once = Once::new();
        HANDLER.call_once(|| {
            // Where there can be no handler, an interrupted run ends as other programs do.
            let _ = ctrlc::set_handler(|| {
                if !RUNS.load(Ordering::SeqCst) || WAS_INTERRUPTED.swap(true, Ordering::SeqCst) {
                    std::process::exit(i32::from(INTERRUPTED));
                }
            });
        });
        RUNS.store(true, Ordering::SeqCst);
        Self
    }
}

impl Drop for Run {
    fn drop(&mut self) {
        RUNS.store(false, Ordering::SeqCst);
    }
}

/// Whether the run is to end.
pub(crate) fn was_interrupted() -> bool {
    WAS_INTERRUPTED.load(Ordering::SeqCst)
}

/// What ends a run at its next event once it was interrupted: after a forecast not before the first
/// sample, so that there is a part to keep.
pub(crate) fn interruptible(tell: &mut dyn FnMut(Event<'_>)) -> impl FnMut(Event<'_>) -> io::Result<()> {
    |event| {
        let is_under_way = !matches!(event, Event::Forecast(_));
        tell(event);
        if is_under_way && was_interrupted() { Err(io::ErrorKind::Interrupted.into()) } else { Ok(()) }
    }
}

/// How it ends.
pub(crate) fn failure() -> Failure {
    Failure::Interrupted("interrupted".to_owned())
}
