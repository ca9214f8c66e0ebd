//! All scenarios, on all cores.

use crate::scenario::Scenario;
use gyro_mechanisms::gyroscope_misalignments::GyroscopeMisalignments;
use gyro_sim::lanes::{Lanes, f64x8};
use gyro_sim::{Joint, JointSpace, Rk4, Scalar};
use indicatif::ProgressBar;
use rayon::prelude::*;

/// The paper's step, s.
pub(crate) const STEP: f64 = 1e-4;

/// Steps from one sample to the next: 22 samples to each of the nutation's periods of 43 ms, whose peaks a line through
/// them then misses by a hundredth.
pub(crate) const STRIDE: u32 = 20;

/// Samples of a second, its start included.
pub(crate) const SAMPLES: usize = 501;

/// Scenarios in a pack.
const LANES: usize = f64x8::COUNT;

/// α and β at each sample, rad.
pub(crate) type Track = [[f64; 2]; SAMPLES];

/// The tracks of all scenarios, in their order.
#[derive(Debug)]
pub(crate) struct Ensemble {
    pub(crate) tracks: Vec<Track>,
}

impl Ensemble {
    /// Eight at a time. Which thread runs which pack has no influence: a track depends on its scenario alone.
    pub(crate) fn in_packs(scenarios: &[Scenario], bar: &ProgressBar) -> Self {
        let packs = scenarios.par_chunks(LANES).map(|pack| {
            let tracks = of_pack(pack);
            bar.inc(pack.len() as u64);
            tracks[..pack.len()].to_vec()
        });
        let packs: Vec<_> = packs.collect();
        Self { tracks: packs.concat() }
    }

    /// Each alone.
    pub(crate) fn one_by_one(scenarios: &[Scenario], bar: &ProgressBar) -> Self {
        let tracks = scenarios.par_iter().map(|scenario| {
            let mut track = [[0.0; 2]; SAMPLES];
            run(&scenario.0, |sample, angles| track[sample] = angles);
            bar.inc(1);
            track
        });
        Self { tracks: tracks.collect() }
    }

    /// How many scenarios did not come to numbers.
    pub(crate) fn failed(&self) -> usize {
        self.tracks.iter().filter(|track| !is_finite(track)).count()
    }
}

/// Whether a run came to its end.
pub(crate) fn is_finite(track: &Track) -> bool {
    track.as_flattened().iter().all(|angle| angle.is_finite())
}

/// The tracks of a pack; lanes that no scenario fills repeat the last one.
fn of_pack(pack: &[Scenario]) -> [Track; LANES] {
    let of_lane = |lane: usize| pack[lane.min(pack.len() - 1)];
    let parameters = std::array::from_fn(|k| f64x8::from_lanes(|lane| of_lane(lane).0[k]));
    let mut tracks = [[[0.0; 2]; SAMPLES]; LANES];
    run(&parameters, |sample, angles| {
        for (lane, track) in tracks.iter_mut().enumerate() {
            track[sample] = angles.map(|angle| angle.lane(lane));
        }
    });
    tracks
}

/// One second in joint coordinates, of a scenario or of a pack of them.
fn run<T: Scalar>(parameters: &[T; Scenario::SIZE], mut sample: impl FnMut(usize, [T; 2])) {
    let mut gyroscope = GyroscopeMisalignments::<T>::default();
    for (index, &value) in parameters.iter().enumerate() {
        gyroscope.set_parameter(index, value);
    }
    let mut x = gyroscope.joint_start();
    let mut rk4 = Rk4::new(&x);
    let h = T::constant(STEP);
    sample(0, [x[0], x[1]]);
    for index in 1..SAMPLES {
        for step in 0..STRIDE {
            let t = T::constant(f64::from(step) * STEP + (index - 1) as f64 * f64::from(STRIDE) * STEP);
            rk4.step(&Joint, &gyroscope, t, h, &mut x);
        }
        sample(index, [x[0], x[1]]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two packs, the second not full.
    const COUNT: u64 = 11;

    fn bits(ensemble: &Ensemble) -> Vec<u64> {
        ensemble.tracks.iter().flat_map(|track| track.as_flattened()).map(|angle| angle.to_bits()).collect()
    }

    #[test]
    fn neither_threads_nor_lanes_change_a_bit() {
        let scenarios: Vec<_> = (0..COUNT).map(|index| Scenario::drawn(7, index)).collect();
        let on = |threads: usize, run: fn(&[Scenario], &ProgressBar) -> Ensemble| {
            let pool =
                rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads can be had");
            bits(&pool.install(|| run(&scenarios, &ProgressBar::hidden())))
        };
        let one = on(1, Ensemble::in_packs);
        assert_eq!(one, on(2, Ensemble::in_packs));
        assert_eq!(one, on(2, Ensemble::one_by_one));
        assert_ne!(one[..2 * SAMPLES], one[2 * SAMPLES..4 * SAMPLES]);
    }

    /// Every scenario nutates with β between zero and twice its mean; sampled too seldom, peaks are lost.
    #[test]
    fn samples_resolve_the_nutation() {
        const NUTATION: f64 = 144.3;
        let period = std::f64::consts::TAU / NUTATION;
        assert!(period / (f64::from(STRIDE) * STEP) > 20.0);
        assert!((f64::from(STRIDE) * STEP * (SAMPLES - 1) as f64 - 1.0).abs() < 1e-12);
        let mut finest = 0.0_f64;
        let (mut gyroscope, scenario) = (GyroscopeMisalignments::<f64>::default(), Scenario::drawn(7, 0));
        scenario
            .0
            .iter()
            .enumerate()
            .for_each(|(index, &value)| assert!(gyroscope.set_parameter(index, value)));
        let mut x = gyroscope.joint_start();
        let mut rk4 = Rk4::new(&x);
        for step in 0..10_000 {
            rk4.step(&Joint, &gyroscope, f64::from(step) * STEP, STEP, &mut x);
            finest = finest.max(x[1].abs());
        }
        let sampled = Ensemble::one_by_one(&[scenario], &ProgressBar::hidden());
        let peak = sampled.tracks[0].iter().map(|angles| angles[1].abs()).fold(0.0, f64::max);
        assert!(peak > 0.99 * finest, "{peak} of {finest}");
    }

    #[test]
    fn a_scenario_does_not_depend_on_the_others() {
        let [few, many] =
            [3, COUNT].map(|n| (0..n).map(|index| Scenario::drawn(7, index)).collect::<Vec<_>>());
        assert_eq!(few[..], many[..3]);
        assert_ne!(Scenario::drawn(8, 0), few[0]);
    }
}
