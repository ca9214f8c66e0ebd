//! What is kept of each scenario.

use super::reader::{Item, Reader, Section, instead};
use super::{Named, RunOptions, SetterKind, Vocabulary};
use crate::{Keep, Passage, Quantity, Target};
use gyro_runner::{Coordinates, Integrator};

/// What a study keeps, with names and units.
#[derive(Debug, Default)]
pub(super) struct Kept {
    pub(super) keep: Keep,
    pub(super) numbers: Vec<(String, String)>,
    pub(super) series: Vec<(String, String)>,
    /// How many of the series are for quantiles.
    pub(super) quantiles: usize,
    /// The columns of the series that are kept for themselves, with the places of their names.
    tracks: Vec<(usize, usize)>,
    /// Names of the derivatives.
    pub(super) slopes: Vec<(String, String)>,
    /// Of each sample's.
    pub(super) series_slopes: Vec<(String, String)>,
}

const KEYS: [&str; 7] = ["final", "extremes", "passages", "quantiles", "series", "estimate", "sensitivities"];

/// Reads `[keep]`; `None` after a mistake.
pub(super) fn read(reader: &mut Reader, whole: &Section<'_>, vocabulary: &Vocabulary) -> Option<Kept> {
    let example = "keep = { final = [\"alpha\"] }, with the names of simulate's columns";
    let section = whole.require(reader, "keep", example)?.section(reader, "[keep]", &KEYS)?;
    let before = reader.mistakes.len();
    let mut kept = Kept::default();
    let columns = &vocabulary.columns;
    for (place, named) in kept.named(reader, section.get("final"), columns) {
        kept.keep.finals.push(place);
        kept.numbers.push((format!("{} final", named.name), named.unit.clone()));
    }
    for (place, named) in kept.named(reader, section.get("extremes"), columns) {
        kept.keep.extremes.push(place);
        kept.numbers.extend(["min", "max"].map(|end| (format!("{} {end}", named.name), named.unit.clone())));
    }
    for passage in section.get("passages").and_then(|item| list(reader, item)).into_iter().flatten() {
        kept.passage(reader, passage, columns);
    }
    if section.get("estimate").and_then(|item| item.flag(reader)) == Some(true) {
        kept.keep.estimate = true;
        kept.numbers.push(("estimated error".to_owned(), "1".to_owned()));
    }
    let quantiles = kept.named(reader, section.get("quantiles"), columns);
    kept.quantiles = quantiles.len();
    let series = kept.named(reader, section.get("series"), columns);
    for (k, (column, named)) in quantiles.into_iter().chain(series).enumerate() {
        let place = kept.keep.series.iter().position(|other| *other == column).unwrap_or_else(|| {
            kept.keep.series.push(column);
            kept.series.push((named.name.clone(), named.unit.clone()));
            kept.series.len() - 1
        });
        if k >= kept.quantiles {
            kept.tracks.push((column, place));
        }
    }
    if reader.mistakes.len() == before && kept.numbers.is_empty() && kept.series.is_empty() {
        whole.wrong(reader, "keep", ["nothing is kept", "empty", &format!("write {example}")]);
    }
    (reader.mistakes.len() == before).then_some(kept)
}

impl Kept {
    /// Whether there are series that are kept for themselves, not for quantiles alone.
    pub(super) fn has_series(&self) -> bool {
        !self.tracks.is_empty()
    }

    /// Has kept how far assemblies move what they may, save for what varies: that stays where it is set.
    pub(super) fn moves(&mut self, targets: &[Target], rough: Vec<Named<(usize, usize)>>) {
        for Named { name, unit, of: (joint, k) } in rough {
            if !targets.contains(&Target::Start(joint, k)) {
                self.keep.moved.push((joint, k));
                self.numbers.push((format!("{name} moved at start"), unit));
            }
        }
    }

    /// Has what is kept differentiated by all that varies, if the study says so.
    pub(super) fn sensitivities(
        &mut self,
        reader: &mut Reader,
        whole: &Section<'_>,
        (targets, names): (&[Target], &[(String, String)]),
        run: &RunOptions,
        vocabulary: &Vocabulary,
    ) {
        let Some(keep) = whole.get("keep").and_then(|item| item.section(reader, "[keep]", &KEYS)) else {
            return;
        };
        if keep.get("sensitivities").and_then(|item| item.flag(reader)) != Some(true) {
            return;
        }
        let n = self.numbers.len() - usize::from(self.keep.estimate);
        let of_violation = |column: &usize| self.keep.columns[*column] == Quantity::Violation;
        let kept = self.keep.finals.iter().chain(&self.keep.extremes);
        // A constraint's violation has none.
        let tracks: Vec<_> = self.tracks.iter().filter(|(column, _)| !of_violation(column)).collect();
        let is_rounding =
            kept.chain(self.keep.passages.iter().map(|passage| &passage.column)).any(of_violation);
        let words = if targets.is_empty() {
            Some(["nothing varies", "by what?", "write vary = [...], or remove this"])
        } else if targets.iter().any(|target| matches!(target, Target::Table(_))) {
            Some(["there is no derivative by the number of a table", "with `tables`", "remove this"])
        } else if n == 0 && tracks.is_empty() {
            let help = "write final, extremes, passages or series; quantiles have no derivatives";
            Some(["nothing is kept that has derivatives", "of what?", help])
        } else if is_rounding {
            let help = "keep `constraint violation` as a series";
            Some(["a constraint's violation is rounding", "it has no derivatives", help])
        } else if let Some(setter) = vocabulary.setters.first() {
            Some(match setter.kind {
                SetterKind::Controller => [
                    "there are no derivatives of loops that sampled controllers close",
                    "of a closed loop",
                    "remove this, or take [[controller]] out of the model file",
                ],
                SetterKind::Contact => [
                    "there are no derivatives of motions with rigid stops or friction that sticks",
                    "of a motion in phases",
                    "remove this, or write [[contact]] as [[force]] of kind \"stop\" or \"coulomb\", which are smooth",
                ],
                SetterKind::Lines => [
                    "there are no derivatives of motions whose drivers jump in velocity",
                    "of a motion along straight lines",
                    "remove this, or take `between` out of the model file's table",
                ],
            })
        } else if run.coordinates == Some(Coordinates::Maximal) {
            let help = "write run = { coordinates = \"joint\" }";
            Some(["sensitivities are computed in joint coordinates", "in maximal ones", help])
        } else if run.integrator.is_some_and(Integrator::is_implicit) {
            let help = "write integrator = \"dop853\", \"tsit5\" or \"rk4\"";
            Some(["sensitivities are computed by explicit methods", "by rodas4", help])
        } else {
            None
        };
        if let Some(words) = words {
            keep.wrong(reader, "sensitivities", words);
            return;
        }
        let derivatives = |(number, _): &(String, String)| {
            let name = |(target, _): &(String, String)| (format!("d {number} / d {target}"), String::new());
            names.iter().map(name).collect::<Vec<_>>()
        };
        self.slopes = self.numbers[..n].iter().flat_map(derivatives).collect();
        self.series_slopes = tracks.iter().flat_map(|(_, place)| derivatives(&self.series[*place])).collect();
        self.keep.sloped = tracks.iter().map(|(column, _)| *column).collect();
        self.keep.by = (0..targets.len()).collect();
    }
}

fn list<'t>(reader: &mut Reader, item: Item<'t>) -> Option<Vec<Item<'t>>> {
    let elements = item.elements();
    if elements.is_none() {
        let help = "write passages = [{ of = \"alpha\", above = 0.1 }]";
        reader.wrong(item.span(), ["`passages` must be an array of tables", "not an array", help]);
    }
    elements
}

impl Kept {
    /// The columns of these names, each with its place among those that are looked at.
    fn named<'v>(
        &mut self,
        reader: &mut Reader,
        item: Option<Item<'_>>,
        columns: &'v [Named<Quantity>],
    ) -> Vec<(usize, &'v Named<Quantity>)> {
        let names = item.and_then(|item| item.texts(reader)).unwrap_or_default();
        let mut found: Vec<(usize, &Named<Quantity>)> = Vec::new();
        for (name, span) in names {
            let place = gyro_model::column(&name, columns.iter().map(|column| column.name.as_str()));
            match place.map(|place| &columns[place]) {
                Some(named) => {
                    let place = self.place(named.of);
                    if found.iter().any(|(other, _)| *other == place) {
                        reader.wrong(span, ["this is named twice", "again", "remove it"]);
                    }
                    found.push((place, named));
                }
                None => {
                    let known: Vec<&str> = columns.iter().map(|column| column.name.as_str()).collect();
                    let help = instead(&name, &known, "the columns are");
                    reader.wrong(span, [&format!("there is no column `{name}`"), "unknown", &help]);
                }
            }
        }
        found
    }

    fn place(&mut self, quantity: Quantity) -> usize {
        let columns = &mut self.keep.columns;
        columns.iter().position(|other| *other == quantity).unwrap_or_else(|| {
            columns.push(quantity);
            columns.len() - 1
        })
    }

    fn passage(&mut self, reader: &mut Reader, item: Item<'_>, columns: &[Named<Quantity>]) {
        let Some(section) = item.section(reader, "a passage", &["of", "above", "below"]) else { return };
        let of = section.require(reader, "of", "of = \"alpha\"");
        let Some(&(column, named)) = self.named(reader, of, columns).first() else { return };
        let (level, word) = match (section.get("above"), section.get("below")) {
            (Some(level), None) => (level, "above"),
            (None, Some(level)) => (level, "below"),
            _ => {
                let help = "write above = 0.1 or below = 0.1";
                reader.wrong(section.span(), ["a passage has one level", "needs `above` or `below`", help]);
                return;
            }
        };
        let Some(level) = level.number(reader) else { return };
        self.keep.passages.push(Passage { column, level, rises: word == "above" });
        self.numbers.push((format!("{} {word} {level:?}", named.name), "s".to_owned()));
    }
}
