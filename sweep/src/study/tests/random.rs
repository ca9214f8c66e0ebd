//! Random studies: what is written is what is drawn and kept, and what is broken is told of, never a panic.

use super::{Bench, HEAD, KEEP, read, study};
use crate::study::Unreadable;
use crate::{Keeper, Quantity, Source};
use proptest::prelude::*;

/// How a name of the model varies, as the study says it.
#[derive(Clone, Debug)]
enum How {
    Values(Vec<f64>),
    Grid([f64; 2], u64),
    LogGrid([f64; 2], u64),
    Uniform([f64; 2]),
    LogUniform([f64; 2]),
    Within(f64),
    Normal([f64; 2]),
    Truncated([f64; 2], [f64; 2]),
}

impl How {
    fn text(&self) -> String {
        match self {
            Self::Values(values) => format!("values = {values:?}"),
            Self::Grid([from, to], n) => format!("grid = [{from:?}, {to:?}, {n}]"),
            Self::LogGrid([from, to], n) => format!("log_grid = [{from:?}, {to:?}, {n}]"),
            Self::Uniform(range) => format!("uniform = {range:?}"),
            Self::LogUniform(range) => format!("log_uniform = {range:?}"),
            Self::Within(size) => format!("within = {size:?}"),
            Self::Normal(normal) => format!("normal = {normal:?}"),
            Self::Truncated(normal, range) => format!("normal = {normal:?}\ntruncated = {range:?}"),
        }
    }

    /// What it takes, if it is a list.
    fn list(&self) -> Option<Vec<f64>> {
        let parts = |n: u64| (0..n).map(move |k| k as f64 / (n - 1) as f64);
        match self {
            Self::Values(values) => Some(values.clone()),
            Self::Grid([from, to], n) => {
                Some(parts(*n).map(|part| from * (1.0 - part) + to * part).collect())
            }
            Self::LogGrid([from, to], n) => {
                Some(parts(*n).map(|part| from * (to / from).powf(part)).collect())
            }
            _ => None,
        }
    }

    /// Between which numbers it is drawn, about a value of the model.
    fn range(&self, nominal: f64) -> [f64; 2] {
        match self {
            Self::Uniform(range) | Self::LogUniform(range) | Self::Truncated(_, range) => *range,
            Self::Within(size) => [nominal - size, nominal + size],
            // Beyond ten standard deviations no number of 52 bits reaches.
            Self::Normal([mean, deviation]) => [mean - 10.0 * deviation, mean + 10.0 * deviation],
            _ => unreachable!("lists have no range"),
        }
    }
}

fn hows() -> impl Strategy<Value = How> {
    let size = || (-3.0..3.0_f64).prop_map(|power| 10f64.powf(power));
    let any = || (size(), prop::bool::ANY).prop_map(|(size, is_below)| if is_below { -size } else { size });
    let range = || (any(), size()).prop_map(|(from, length)| [from, from + length]);
    let positive = || (size(), size()).prop_map(|(from, length)| [from, from + length]);
    prop_oneof![
        prop::collection::vec(any(), 1..5).prop_map(How::Values),
        (any(), any(), 2..5u64).prop_map(|(from, to, n)| How::Grid([from, to], n)),
        (size(), size(), 2..5u64).prop_map(|(from, to, n)| How::LogGrid([from, to], n)),
        range().prop_map(How::Uniform),
        positive().prop_map(How::LogUniform),
        size().prop_map(How::Within),
        (any(), size()).prop_map(|(mean, deviation)| How::Normal([mean, deviation])),
        (any(), size(), range()).prop_map(|(mean, deviation, [from, to])| {
            // Where the distribution has something: within some deviations of its mean.
            let near = |x: f64| mean + deviation * (x / (1.0 + x.abs()));
            How::Truncated([mean, deviation], [near(from), near(to) + deviation * 1e-3])
        }),
    ]
}

/// What can vary, with its value in the model.
const NAMES: [(&str, &str, f64); 4] = [
    ("parameter", "mass", 2.0),
    ("parameter", "length", 0.5),
    ("input", "motor", 0.0),
    ("start", "hinge", f64::NAN),
];

/// A study: how each name varies, how often, by which points, and with which seed.
#[derive(Clone, Debug)]
struct Written {
    varied: Vec<(usize, How)>,
    scenarios: u64,
    sampling: &'static str,
    seed: u64,
}

impl Written {
    fn text(&self) -> String {
        let Self { varied, scenarios, sampling, seed } = self;
        let mut text = format!(
            "format = 1\nmodel = \"m.toml\"\nscenarios = {scenarios}\nseed = {seed}\nsampling = {sampling:?}\n\
             run = {{ t_end = 1, tolerance = 1e-6, integrator = \"dop853\" }}\n\
             [keep]\nfinal = [\"hinge\"]\nextremes = \"hinge rate\"\npassages = [{{ of = \"hinge\", above = 0.5 }}]\n"
        );
        for (place, how) in varied {
            let (kind, name, _) = NAMES[*place];
            text += &format!("[[vary]]\n{kind} = {name:?}\n{}\n", how.text());
        }
        text
    }
}

fn written() -> impl Strategy<Value = Written> {
    let one = |place: usize| {
        hows().prop_map(move |how| match how {
            // A start has no value in the model file that it could be within something of.
            How::Within(size) if NAMES[place].0 == "start" => (place, How::Uniform([-size, size])),
            how => (place, how),
        })
    };
    let places = prop::sample::subsequence(vec![0, 1, 2, 3], 1..=4).prop_shuffle();
    let varied = places.prop_flat_map(move |places| places.into_iter().map(one).collect::<Vec<_>>());
    let sampling = prop::sample::select(vec!["random", "sobol", "saltelli"]);
    (varied, 1..40u64, sampling, 0..i64::MAX as u64).prop_map(|(varied, scenarios, sampling, seed)| {
        let has_lists = varied.iter().any(|(_, how)| how.list().is_some());
        let sampling = if has_lists && sampling == "saltelli" { "sobol" } else { sampling };
        Written { varied, scenarios, sampling, seed }
    })
}

proptest! {
    #[test]
    fn values_are_those_that_are_written(written in written(), order in any::<u64>()) {
        let study = study(&written.text());
        let lists: Vec<_> = written.varied.iter().map(|(_, how)| how.list()).collect();
        let points: u64 = lists.iter().flatten().map(|list| list.len() as u64).product();
        let draws = lists.iter().filter(|list| list.is_none()).count() as u64;
        let group = if written.sampling == "saltelli" { draws + 2 } else { 1 };
        let n = points * written.scenarios * group;
        prop_assert_eq!(study.plan.scenarios(), n);
        let mut source = Source::new(&study.plan);
        let mut value = |k: u64| {
            let mut values = vec![f64::NAN; written.varied.len()];
            source.write(k, &mut values);
            values
        };
        let rows: Vec<Vec<f64>> = (0..n).map(&mut value).collect();
        // Scenario k depends on k alone.
        let bits = |row: &[f64]| row.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        for k in (0..n).map(|k| (k.wrapping_mul(7) ^ order) % n) {
            prop_assert_eq!(bits(&value(k)), bits(&rows[k as usize]));
        }
        // The last list changes fastest.
        let mut period = points;
        for (target, (place, how)) in written.varied.iter().enumerate() {
            let column = rows.iter().map(|row| row[target]);
            if let Some(list) = &lists[target] {
                period /= list.len() as u64;
                for (k, found) in (0..n).zip(column) {
                    let expected = list[(k / period) as usize % list.len()];
                    prop_assert!((found - expected).abs() <= 1e-12 * (found.abs() + 1.0), "{} {}", found, expected);
                }
            } else {
                let [low, high] = how.range(NAMES[*place].2);
                for found in column.clone() {
                    prop_assert!((low..=high).contains(&found), "{} in {}..{}", found, low, high);
                }
            }
        }
    }

    /// First, last, smallest and largest of a series, and where lines first pass a level, by other means.
    #[test]
    fn what_is_kept_is_what_a_series_has(series in prop::collection::vec((-2.0..2.0f64, -2.0..2.0f64), 1..20)) {
        let study = study(&written_keep());
        let mut keeper = Keeper::new(&study.keep, series.len());
        for (k, (hinge, rate)) in series.iter().enumerate() {
            let value = |of| if of == Quantity::Position(0) { *hinge } else { *rate };
            keeper.take(k as f64, value);
        }
        let mut kept = Vec::new();
        keeper.finish(true, &mut kept);
        let mut rates: Vec<f64> = series.iter().map(|(_, rate)| *rate).collect();
        rates.sort_by(f64::total_cmp);
        prop_assert_eq!(&kept[..3], &[series[series.len() - 1].0, rates[0], rates[rates.len() - 1]][..]);
        // The earliest time, on a fine grid, at which the line through the samples is above the level.
        let line = |t: f64| {
            let k = (t.floor() as usize).min(series.len() - 1);
            let next = series.get(k + 1).unwrap_or(&series[k]).0;
            series[k].0 + (t - k as f64) * (next - series[k].0)
        };
        let times = (0..=(series.len() - 1) * 1000).map(|k| k as f64 / 1000.0);
        match times.into_iter().find(|t| line(*t) >= 0.5) {
            Some(t) => prop_assert!((kept[3] - t).abs() <= 1.001e-3, "{} {}", kept[3], t),
            None => prop_assert!(kept[3].is_nan(), "{}", kept[3]),
        }
    }
}

fn written_keep() -> String {
    Written { varied: vec![(0, How::Within(0.1))], scenarios: 1, sampling: "random", seed: 1 }.text()
}

/// What a mistake puts in the place of a piece of a study.
const PIECES: [&str; 34] = [
    "",
    " ",
    "0",
    "-1",
    "1e400",
    "nan",
    "inf",
    "1e-320",
    "18446744073709551615",
    "99999999999999999999",
    "true",
    "\"\"",
    "\"hinge\"",
    "[]",
    "[[]]",
    "[1]",
    "[1, 2]",
    "[2, 1]",
    "[1, 1]",
    "[1, 2, 3]",
    "[0, 1, 1000000]",
    "{}",
    "[[1, 2], [2, 1]]",
    "1979-05-27",
    "é",
    "\"\\u0000\"",
    "parameter",
    "tables",
    "covariance",
    "saltelli",
    "=",
    "]",
    "\n",
    "sensitivities = true",
];

/// The pieces of a text: words, and what is between them.
fn pieces(text: &str) -> Vec<String> {
    let mut pieces: Vec<String> = Vec::new();
    let kind = |c: char| if c.is_alphanumeric() || "_.-".contains(c) { 0 } else { u32::from(c) };
    let mut last = None;
    for c in text.chars() {
        match pieces.last_mut().filter(|_| last == Some(kind(c)) && kind(c) == 0) {
            Some(piece) => piece.push(c),
            None => pieces.push(c.to_string()),
        }
        last = Some(kind(c));
    }
    pieces
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]

    /// Some pieces are replaced, left out or said twice: the study is read, or each mistake has its line and its cure.
    #[test]
    fn broken_studies_are_told_of(
        written in written(),
        mistakes in prop::collection::vec((any::<prop::sample::Index>(), 0..3u8, any::<prop::sample::Index>()), 1..4),
    ) {
        let mut pieces = pieces(&written.text());
        for (place, how, other) in mistakes {
            let place = place.index(pieces.len());
            match how {
                0 => pieces[place] = PIECES[other.index(PIECES.len())].to_owned(),
                1 => drop(pieces.remove(place)),
                _ => {
                    let other = pieces[other.index(pieces.len())].clone();
                    pieces.insert(place, other);
                }
            }
        }
        let text = pieces.concat();
        match read("s.toml", &text, &mut Bench) {
            Ok(study) => {
                let mut values = vec![0.0; study.plan.targets.len()];
                let last = study.plan.scenarios() - 1;
                let mut source = Source::new(&study.plan);
                for k in [0, last / 2, last] {
                    source.write(k, &mut values);
                    prop_assert!(values.iter().all(|value| !value.is_nan()), "{} {:?}", k, values);
                }
            }
            Err(Unreadable::Model(words)) => prop_assert!(words.starts_with("no ")),
            Err(Unreadable::Study(mistakes)) => {
                let lines = text.lines().count();
                prop_assert!(!mistakes.mistakes().is_empty());
                for mistake in mistakes.mistakes() {
                    let (line, _) = mistakes.place(mistake.span.start);
                    prop_assert!(line >= 1 && line <= lines + 1);
                    prop_assert!(!mistake.message.is_empty() && !mistake.help.is_empty(), "{:?}", mistake);
                }
                prop_assert!(mistakes.render().contains("s.toml:"));
            }
        }
    }
}

/// Grids whose points nobody can count.
#[test]
fn too_many_points_are_too_many() {
    let grids: String = NAMES
        .iter()
        .map(|(kind, name, _)| format!("[[vary]]\n{kind} = {name:?}\ngrid = [0, 1, 100_000]\n"))
        .collect();
    let Err(Unreadable::Study(mistakes)) = read("s.toml", &format!("{HEAD}{KEEP}{grids}"), &mut Bench) else {
        panic!("they are counted")
    };
    assert!(mistakes.render().contains("too many"), "{}", mistakes.render());
}
