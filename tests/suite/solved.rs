//! Reference solutions that several tests compare with: each is worked out once.

use gyro_reference::{Chain, ChainSample, moving_base};
use gyro_sim_suite::{Run, times};
use std::sync::{LazyLock, OnceLock};

/// The gyroscope on a base, with its motion at the samples of the first run that is compared with it.
pub struct Solved {
    pub chain: Chain<3>,
    solution: OnceLock<(Vec<f64>, Vec<ChainSample<3>>)>,
}

impl Solved {
    fn of(chain: Chain<3>) -> Self {
        Self { chain, solution: OnceLock::new() }
    }

    /// The motion at each sample of a run; all runs have theirs at the same times.
    pub fn at(&self, run: &Run) -> &[ChainSample<3>] {
        let times = times(run);
        let (solved, samples) = self.solution.get_or_init(|| (times.clone(), self.chain.solve(&times)));
        assert_eq!(*solved, times, "a run with samples at other times");
        samples
    }
}

pub static RESTING: LazyLock<Solved> = LazyLock::new(|| Solved::of(moving_base::resting()));
pub static ROLLING: LazyLock<Solved> = LazyLock::new(|| Solved::of(moving_base::rolling()));
pub static ROLLING_AND_PITCHING: LazyLock<Solved> =
    LazyLock::new(|| Solved::of(moving_base::rolling_and_pitching()));
