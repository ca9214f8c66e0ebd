//! What is listed as having happened: everything that has, and nothing else.

use super::{Random, fine};
use crate::contact::{Change, Contact, Forced, Hybrid, Phase, Stepped};
use crate::{Dop853, Kutta4, Ode, Tsit5};
use core::array::from_fn;
use core::ops::Range;

/// Coordinates of a chain.
const N: usize = 3;
type State = [f64; 2 * N];

/// A chain of masses, each coordinate relative to the mass before, on springs and dampers and under loads that are
/// constant or swing.
#[derive(Clone, Copy)]
struct Chain {
    masses: [f64; N],
    stiffness: [f64; N],
    damping: [f64; N],
    loads: [[f64; 3]; N],
}

impl Chain {
    fn random(random: &mut Random) -> Self {
        let swings = random.between(0.0, 1.0) < 0.5;
        let springs = random.between(0.0, 1.0) < 0.6;
        Self {
            masses: from_fn(|_| libm::exp(random.between(-1.5, 1.5))),
            stiffness: from_fn(|_| if springs { random.between(0.0, 30.0) } else { 0.0 }),
            damping: from_fn(|_| if springs { random.between(0.0, 0.5) } else { 0.0 }),
            loads: from_fn(|_| {
                let swing = if swings { random.between(0.0, 4.0) } else { 0.0 };
                [random.between(-4.0, 4.0), swing, random.between(0.5, 12.0)]
            }),
        }
    }
}

impl Ode for Chain {
    type Scalar = f64;
    type State = State;

    fn derivative(&self, model: &(), t: f64, y: &State, dy: &mut State) {
        self.forced(model, t, y, &[0.0; N], dy);
    }
}

impl Forced for Chain {
    fn rates(&self, _: &()) -> Range<usize> {
        N..2 * N
    }

    fn forced(&self, (): &(), t: f64, y: &State, forces: &[f64], dy: &mut State) {
        // What acts on mass k is its own joint's force less that of the next; coordinates are relative.
        let along: [f64; N] = from_fn(|k| {
            let [constant, swing, rate] = self.loads[k];
            let load = constant + swing * libm::sin(rate * t);
            forces[k] + load - self.stiffness[k] * y[k] - self.damping[k] * y[N + k]
        });
        let mut before = 0.0;
        for k in 0..N {
            let next = along.get(k + 1).copied().unwrap_or(0.0);
            let acceleration = (along[k] - next) / self.masses[k];
            (dy[k], dy[N + k]) = (y[N + k], acceleration - before);
            before = acceleration;
        }
    }
}

/// One stop, two or none, narrow as backlash or wide, with friction or without.
fn contacts(random: &mut Random) -> [Contact<f64>; N] {
    from_fn(|k| {
        let width = libm::exp(random.between(-5.0, 0.0));
        let ends = match random.between(0.0, 4.0) as u8 {
            0 => [-width, f64::INFINITY],
            1 => [f64::NEG_INFINITY, width],
            2 => [-width, width],
            _ => [-width, 0.3 * width],
        };
        let e =
            [0.0, random.between(0.0, 0.9), random.between(0.0, 0.9), 1.0][random.between(0.0, 3.2) as usize];
        let contact = Contact::new(k, N + k).with_stops(ends, e).unwrap();
        let kinetic = if random.between(0.0, 1.0) < 0.4 { random.between(0.0, 1.0) } else { 0.0 };
        contact.with_friction(kinetic, kinetic * random.between(1.0, 1.5)).unwrap()
    })
}

/// Within all stops, of one coordinate now and then on one.
fn start(random: &mut Random, contacts: &[Contact<f64>; N]) -> State {
    let mut y = [0.0; 2 * N];
    for (k, contact) in contacts.iter().enumerate() {
        let [low, high] = contact.ends.map(|end| end.clamp(-1.0, 1.0));
        let part =
            [random.between(0.0, 1.0), random.between(0.0, 1.0), 0.0, 1.0][random.between(0.0, 4.0) as usize];
        y[k] = if part == 1.0 { high } else { low + part * (high - low) };
        y[N + k] = [0.0, random.between(-3.0, 3.0)][random.between(0.0, 2.0) as usize];
    }
    y
}

/// How often each has been listed: impacts, rests, leavings, stickings, slippings.
type Counts = [u32; 5];

/// Checks what is listed against the state before and after it, gaps to so much; counts it.
fn check(
    contacts: &[Contact<f64>; N],
    changes: &[Change<f64>; N],
    [before, after]: [&State; 2],
    slack: impl Fn(usize) -> f64,
    counts: &mut Counts,
) -> Result<(), &'static str> {
    let must = |holds: bool, words| if holds { Ok(()) } else { Err(words) };
    for k in 0..N {
        let (contact, Change { hit, phases }) = (contacts[k], changes[k]);
        let (x, rate, from) = (after[k], after[N + k], before[N + k]);
        if let Some([approach, rebound]) = hit {
            counts[0] += 1;
            let (end, outward) =
                if approach > 0.0 { (contact.ends[1], -1.0) } else { (contact.ends[0], 1.0) };
            must(approach != 0.0, "an impact at rest")?;
            must(end.is_finite(), "an impact on a stop that there is none of")?;
            must((x - end).abs() <= slack(k), "an impact away from its stop")?;
            must(approach == from && rebound == rate, "rates that it has not had")?;
            must(outward * rebound >= 0.0, "an impact that goes through its stop")?;
        }
        match phases {
            [was, is] if was == is => {}
            [_, is @ (Phase::AtLower | Phase::AtUpper)] => {
                counts[1] += 1;
                let end = contact.ends[usize::from(is == Phase::AtUpper)];
                must(x == end && rate == 0.0, "a rest that is none")?;
            }
            [was @ (Phase::AtLower | Phase::AtUpper), _] => {
                counts[2] += 1;
                let end = contact.ends[usize::from(was == Phase::AtUpper)];
                must(before[k] == end && from == 0.0, "what has not rested leaves")?;
            }
            [_, Phase::Sticks] => {
                counts[3] += 1;
                must(rate == 0.0 && contact.rubs(), "it moves, or nothing holds it")?;
            }
            [Phase::Sticks, _] => {
                counts[4] += 1;
                must(from == 0.0 && contact.rubs(), "what has not stuck slips")?;
            }
            _ => {}
        }
    }
    Ok(())
}

/// Impacts that have to be listed and are not. Friction that has turned a rate round within a step makes it zero.
fn is_missed(contacts: &[Contact<f64>; N], changes: &[Change<f64>; N], before: &State) -> bool {
    (0..N).any(|k| {
        let ([low, high], rate) = (contacts[k].ends, before[N + k]);
        let hits = before[k] < low && rate < 0.0 || before[k] > high && rate > 0.0;
        hits && !contacts[k].rubs() && changes[k].hit.is_none()
    })
}

const CASES: u64 = 140;
/// Impacts of several coordinates may follow each other without end.
const MOST_STEPS: u32 = 4000;
const T_END: f64 = 3.0;

#[test]
fn under_error_control_nothing_is_listed_that_has_not_happened() {
    let mut counts = Counts::default();
    for case in 0..CASES {
        let mut random = Random(1000 + case);
        let (chain, contacts) = (Chain::random(&mut random), contacts(&mut random));
        let y = start(&mut random, &contacts);
        let mut motion = Hybrid::new(chain, contacts, Dop853::new(&y), 0.0, &y).with_control(fine());
        let mut before = y;
        for _ in 0..MOST_STEPS {
            let is_decided = motion.resolve(&());
            let (t, after) = (motion.time(), *motion.state());
            if is_decided {
                let slack = |k: usize| 1e-10 + 1e-9 * before[N + k].abs();
                let found = check(&contacts, motion.changes(), [&before, &after], slack, &mut counts);
                let changes = motion.changes();
                assert_eq!(found, Ok(()), "case {case} at {t}: {changes:?}\n{before:?}\n{after:?}");
            }
            // A jam ends a motion by its name.
            if t >= T_END || motion.move_towards(&(), T_END, |_| None).is_err() {
                break;
            }
            before = *motion.state();
        }
    }
    assert!(counts.iter().all(|count| *count > 50), "{counts:?}");
}

#[test]
fn in_steps_of_fixed_length_nothing_is_listed_that_has_not_happened() {
    let mut counts = Counts::default();
    for case in 0..CASES {
        let mut random = Random(2000 + case);
        let (chain, contacts) = (Chain::random(&mut random), contacts(&mut random));
        let y = start(&mut random, &contacts);
        let h = libm::exp(random.between(-8.0, -4.0));
        let mut motion = Hybrid::new(chain, contacts, Kutta4::new(&y), 0.0, &y);
        let mut bare = Stepped::new(chain, contacts, &y);
        let (mut before, mut held, mut steps, mut impacts) = (y, y, 0, 0);
        while motion.time() < T_END {
            if motion.resolve(&()) {
                let (after, changes) = (*motion.state(), motion.changes());
                // Beyond the stop by what a step covers; what came to rest is on it.
                let slack = |k: usize| 4.0 * h * (before[N + k].abs() + 40.0 * h);
                let found = check(&contacts, changes, [&before, &after], slack, &mut counts);
                assert_eq!(
                    found,
                    Ok(()),
                    "case {case} at {}: {changes:?}\n{before:?}\n{after:?}",
                    motion.time()
                );
                assert!(!is_missed(&contacts, changes, &before), "case {case}: {changes:?} {before:?}");
            }
            if motion.move_by(&(), h).is_err() {
                break;
            }
            before = *motion.state();
            // The bare steps list the same.
            if bare.advance(&(), f64::from(steps) * h, h, 1, &mut held).is_err() {
                break;
            }
            steps += 1;
            if bare.record().impacts > impacts {
                impacts = bare.record().impacts;
                for (k, change) in bare.changes().iter().enumerate() {
                    let Some([approach, rebound]) = change.hit else { continue };
                    let end = contacts[k].ends[usize::from(approach > 0.0)];
                    let gap = (held[k] - end).abs();
                    assert!(gap <= 4.0 * h * (approach.abs() + 40.0 * h), "case {case}: {gap:e} {change:?}");
                    assert!(approach * rebound <= 0.0, "case {case}: {change:?}");
                }
            }
        }
    }
    assert!(counts.iter().all(|count| *count > 50), "{counts:?}");
}

#[test]
fn a_series_of_rebounds_ends_without_an_impact_on_the_other_stop() {
    for (e, lower) in [(0.2, f64::NEG_INFINITY), (0.3, -0.1), (0.7, f64::NEG_INFINITY), (0.85, -0.1)] {
        let pushed = Chain {
            masses: [1.0; N],
            stiffness: [0.0; N],
            damping: [0.0; N],
            loads: [[1.0, 0.0, 1.0], [0.0; 3], [0.0; 3]],
        };
        let only = Contact::new(0, N).with_stops([lower, 0.05], e).unwrap();
        let contacts = [only, Contact::new(1, N + 1), Contact::new(2, N + 2)];
        let start = [0.0; 2 * N];
        let mut motion = Hybrid::new(pushed, contacts, Tsit5::new(&start), 0.0, &start).with_control(fine());
        let mut rests = 0;
        while motion.time() < 5.0 {
            motion.resolve(&());
            let change = motion.changes()[0];
            assert!(change.hit.is_none_or(|[before, _]| before > 0.0), "{e}: {change:?} {}", motion.time());
            rests += u32::from(change.phases[0] != Phase::AtUpper && change.phases[1] == Phase::AtUpper);
            motion.move_towards(&(), 5.0, |_| None).unwrap();
        }
        assert!(rests > 0, "{e} {:?} {:?}", motion.record(), motion.phases());
    }
}
