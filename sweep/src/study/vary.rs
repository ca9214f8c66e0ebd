//! What varies.

use super::reader::{Item, Reader, Section, instead};
use super::{Files, Setter, SetterKind, Span, Vocabulary};
use crate::draw::{Distribution, Draw, cholesky};
use crate::plan::{Axis, Target};

/// What a study varies.
#[derive(Debug, Default)]
pub(super) struct Varied {
    pub(super) targets: Vec<Target>,
    /// Names and units.
    pub(super) names: Vec<(String, String)>,
    pub(super) axes: Vec<Axis>,
    pub(super) draws: Vec<Draw>,
}

/// What may vary, and how.
const WHAT: [&str; 3] = ["parameter", "input", "start"];
const HOW: [&str; 9] =
    ["values", "grid", "log_grid", "uniform", "within", "log_uniform", "normal", "covariance", "tables"];
/// What belongs to `normal` and to `covariance`.
const BESIDES: [&str; 2] = ["truncated", "mean"];

/// Targets of one entry: their indices and their values in the model file.
struct Entry<'t> {
    section: Section<'t>,
    targets: Vec<usize>,
    nominal: Vec<Option<f64>>,
}

/// Reads `[[vary]]`.
pub(super) fn read<F: Files>(
    reader: &mut Reader,
    whole: &Section<'_>,
    vocabulary: &Vocabulary,
    files: &mut F,
) -> Varied {
    let mut varied = Varied::default();
    let example = "[[vary]] with parameter = \"stiffness\" and grid = [100, 1000, 10]";
    let Some(item) = whole.require(reader, "vary", example) else { return varied };
    let Some(entries) = item.elements() else {
        let help = format!("write {example}");
        reader.wrong(item.span(), ["`vary` must be an array of tables", "not an array", &help]);
        return varied;
    };
    let keys = [&WHAT[..], &HOW, &BESIDES].concat();
    for item in entries {
        let Some(section) = item.section(reader, "an entry of `vary`", &keys) else { continue };
        let before = reader.mistakes.len();
        let (targets, nominal) = varied.targets(reader, &section, vocabulary);
        if reader.mistakes.len() == before {
            varied.how(reader, &Entry { section, targets, nominal }, files);
        }
    }
    varied
}

impl Varied {
    /// What an entry varies.
    fn targets(
        &mut self,
        reader: &mut Reader,
        section: &Section<'_>,
        vocabulary: &Vocabulary,
    ) -> (Vec<usize>, Vec<Option<f64>>) {
        let Some((key, item)) = one_of(reader, section, &WHAT) else { return Default::default() };
        let (mut targets, mut nominal) = (Vec::new(), Vec::new());
        for (name, span) in item.texts(reader).unwrap_or_default() {
            let Some((target, unit, value)) = find(reader, vocabulary, key, (&name, span.clone())) else {
                continue;
            };
            let name = if key == "start" { format!("{name} start") } else { name };
            if self.names.iter().any(|(other, _)| *other == name) {
                reader.wrong(span, ["this varies already", "again", "vary each thing once"]);
            }
            targets.push(self.targets.len());
            nominal.push(value);
            self.targets.push(target);
            self.names.push((name, unit));
        }
        (targets, nominal)
    }

    /// How an entry varies it.
    fn how<F: Files>(&mut self, reader: &mut Reader, entry: &Entry<'_>, files: &mut F) {
        let Some((key, item)) = one_of(reader, &entry.section, &HOW) else { return };
        for (besides, of) in BESIDES.into_iter().zip(["normal", "covariance"]) {
            if key != of && entry.section.get(besides).is_some() {
                let help = format!("remove it, or write {of} = ...");
                entry.section.wrong(
                    reader,
                    besides,
                    [&format!("`{besides}` belongs to `{of}`"), "not here", &help],
                );
            }
        }
        match key {
            "values" => {
                if let Some(rows) = item.rows(reader, entry.targets.len()) {
                    self.axes.push(Axis { targets: entry.targets.clone(), rows });
                }
            }
            "grid" | "log_grid" => self.grid(reader, entry, item, key == "log_grid"),
            "covariance" => self.together(reader, entry, item),
            "tables" => self.tables(reader, entry, item, files),
            _ => self.alone(reader, entry, item),
        }
    }

    fn grid(&mut self, reader: &mut Reader, entry: &Entry<'_>, item: Item<'_>, is_log: bool) {
        let Some([from, to, n]) = item.numbers(reader, "three numbers: the first, the last and how many")
        else {
            return;
        };
        let is_fit = (2.0..=1e6).contains(&n) && n.fract() == 0.0 && (!is_log || from.min(to) > 0.0);
        if !is_fit {
            let help = "write the first, the last and how many from 2 to 1e6; of log_grid both above zero";
            reader.wrong(item.span(), ["this is no grid", "not fit", help]);
            return;
        }
        let [low, high] = [from, to].map(|end| if is_log { libm::log(end) } else { end });
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "2 to 1e6")]
        let value = |k: usize| match k {
            0 => from,
            k if k + 1 == n as usize => to,
            #[expect(clippy::cast_precision_loss, reason = "less than 1e6")]
            k => {
                let value = low + (high - low) * (k as f64 / (n - 1.0));
                if is_log { libm::exp(value) } else { value }
            }
        };
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "2 to 1e6")]
        let rows: Vec<Vec<f64>> = (0..n as usize).map(|k| vec![value(k)]).collect();
        let axis = |target: &usize| Axis { targets: vec![*target], rows: rows.clone() };
        self.axes.extend(entry.targets.iter().map(axis));
    }

    /// Each target by itself.
    fn alone(&mut self, reader: &mut Reader, entry: &Entry<'_>, item: Item<'_>) {
        for (&target, &nominal) in entry.targets.iter().zip(&entry.nominal) {
            let Some(distribution) = distribution(reader, entry, item, nominal) else { return };
            self.draws.push(Draw::Alone { target, distribution });
        }
    }

    fn together(&mut self, reader: &mut Reader, entry: &Entry<'_>, item: Item<'_>) {
        let n = entry.targets.len();
        let Some(rows) = item.rows(reader, n) else { return };
        let matrix = rows.concat();
        let is_symmetric = rows.len() == n && (0..n * n).all(|k| matrix[k] == matrix[k % n * n + k / n]);
        let factor = if is_symmetric { cholesky(&matrix, n) } else { None };
        let mean = match entry.section.get("mean") {
            None => entry.nominal.iter().copied().collect::<Option<Vec<f64>>>(),
            Some(mean) => mean.rows(reader, 1).map(|rows| rows.concat()).filter(|mean| mean.len() == n),
        };
        match (factor, mean) {
            (None, _) => {
                let help = format!(
                    "write {n} rows of {n} numbers, of a matrix that is symmetric and positive definite"
                );
                reader.wrong(item.span(), ["this is no covariance", "not fit", &help]);
            }
            (_, None) => {
                let help = format!("write mean = [...] with {n} numbers");
                entry.section.wrong(
                    reader,
                    "mean",
                    ["the means are not known", "one for each is needed", &help],
                );
            }
            (Some(factor), Some(mean)) => {
                self.draws.push(Draw::Together { targets: entry.targets.clone(), mean, factor });
            }
        }
    }

    fn tables<F: Files>(&mut self, reader: &mut Reader, entry: &Entry<'_>, item: Item<'_>, files: &mut F) {
        let [target] = entry.targets[..] else {
            let help = "write an entry for each input";
            reader.wrong(item.span(), ["tables are of one input", "of several", help]);
            return;
        };
        let Target::Input(index) = self.targets[target] else {
            reader.wrong(item.span(), ["tables are for inputs", "not of an input", "write input = \"...\""]);
            return;
        };
        let mut tables = Vec::new();
        for (path, span) in item.texts(reader).unwrap_or_default() {
            match files.table(index, &path) {
                Ok(table) => tables.push(table),
                Err(words) => {
                    let help =
                        "write the path of a CSV file, seen from the study, with columns time and value";
                    reader.wrong(span, [&format!("table `{path}` cannot be used"), &words, help]);
                }
            }
        }
        #[expect(clippy::cast_precision_loss, reason = "a number of files")]
        let rows = (0..tables.len()).map(|k| vec![k as f64]).collect();
        self.targets[target] = Target::Table(tables);
        self.axes.push(Axis { targets: vec![target], rows });
    }
}

/// The one of some keys that is there.
fn one_of<'t>(
    reader: &mut Reader,
    section: &Section<'t>,
    keys: &[&'static str],
) -> Option<(&'static str, Item<'t>)> {
    let found: Vec<_> = keys.iter().filter_map(|key| Some((*key, section.get(key)?))).collect();
    if let [one] = found[..] {
        return Some(one);
    }
    let list = keys.iter().map(|key| format!("`{key}`")).collect::<Vec<_>>().join(", ");
    let span = found.get(1).map_or(section.span(), |(_, item)| item.span());
    let message = format!("an entry of `vary` has one of {list}");
    let label = if found.is_empty() { "has none" } else { "a second one" };
    reader.wrong(span, [&message, label, "write exactly one of them"]);
    None
}

type Found = (Target, String, Option<f64>);

fn find(
    reader: &mut Reader,
    vocabulary: &Vocabulary,
    key: &str,
    (name, span): (&str, Span),
) -> Option<Found> {
    let place = |all: &[(String, f64)]| all.iter().position(|(other, _)| other == name);
    let found = match key {
        "parameter" => place(&vocabulary.parameters)
            .map(|k| (Target::Parameter(k), String::new(), Some(vocabulary.parameters[k].1))),
        "input" => {
            place(&vocabulary.inputs).map(|k| (Target::Input(k), String::new(), Some(vocabulary.inputs[k].1)))
        }
        _ => {
            let starts = vocabulary.starts.iter().map(|start| start.name.as_str());
            let start = gyro_model::column(name, starts).map(|place| &vocabulary.starts[place]);
            start.map(|start| (start.of.clone(), start.unit.clone(), None))
        }
    };
    let set = found.as_ref().and_then(|(target, ..)| {
        let Target::Input(index) = target else { return None };
        vocabulary.setters.iter().find(|setter| setter.inputs.contains(index))
    });
    if let Some(Setter { kind, name, .. }) = set {
        let (what, help) = match kind {
            SetterKind::Controller => {
                ("controller", "vary a parameter that the controller's gains or set points are written with")
            }
            SetterKind::Contact => {
                ("contact", "vary a parameter that the contact's numbers are written with")
            }
            SetterKind::Lines => {
                ("motion of", "vary something else: what a motion goes by is known before it begins")
            }
        };
        let message = format!("the {what} `{name}` sets this input");
        reader.wrong(span, [&message, "set already", help]);
        return None;
    }
    if let Some((_, driver)) = vocabulary.driven.iter().find(|(start, _)| key == "start" && start == name) {
        let message = format!("the driver `{driver}` says where this starts");
        let help = "vary a parameter that the driver's motion is written with";
        reader.wrong(span, [&message, "driven", help]);
        return None;
    }
    if found.is_none() {
        let known: Vec<&str> = match key {
            "parameter" => vocabulary.parameters.iter().map(|(name, _)| name.as_str()).collect(),
            "input" => vocabulary.inputs.iter().map(|(name, _)| name.as_str()).collect(),
            _ => vocabulary.starts.iter().map(|start| start.name.as_str()).collect(),
        };
        let help = instead(name, &known, "there are");
        reader.wrong(span, [&format!("the model has no {key} `{name}`"), "unknown", &help]);
    }
    found
}

fn distribution(
    reader: &mut Reader,
    entry: &Entry<'_>,
    item: Item<'_>,
    nominal: Option<f64>,
) -> Option<Distribution> {
    let span = item.span();
    let ordered = |reader: &mut Reader, item: Item<'_>| {
        let range = item.numbers::<2>(reader, "two numbers, the smaller one first")?;
        if range[0] >= range[1] {
            reader
                .wrong(item.span(), ["this is no interval", "not rising", "write the smaller number first"]);
        }
        (range[0] < range[1]).then_some(range)
    };
    match item.key {
        "uniform" => ordered(reader, item).map(Distribution::Uniform),
        "log_uniform" => {
            let range = ordered(reader, item)?;
            if range[0] <= 0.0 {
                reader.wrong(
                    span,
                    ["a logarithm is of positive numbers", "not positive", "write two above zero"],
                );
            }
            (range[0] > 0.0).then_some(Distribution::LogUniform(range))
        }
        "within" => {
            let size = item.number(reader)?;
            let Some(nominal) = nominal else {
                let help = "write uniform = [from, to]";
                reader.wrong(span, ["`within` is about the model file's value", "a start has none", help]);
                return None;
            };
            if size <= 0.0 {
                reader.wrong(span, ["this must be above zero", "not positive", "write a positive number"]);
            }
            (size > 0.0).then_some(Distribution::Uniform([nominal - size, nominal + size]))
        }
        _ => {
            let normal = item.numbers::<2>(reader, "two numbers, the mean and the standard deviation")?;
            if normal[1] <= 0.0 {
                reader.wrong(
                    span,
                    ["a standard deviation is above zero", "not positive", "write a positive one"],
                );
                return None;
            }
            match entry.section.get("truncated") {
                None => Some(Distribution::Normal(normal)),
                Some(range) => Some(Distribution::Truncated(normal, ordered(reader, range)?)),
            }
        }
    }
}
