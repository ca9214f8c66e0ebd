//! Curves that have a name: through rows of a table, or through points.

use super::functions;
use super::numbers::plain_number;
use super::reader::Reader;
use super::section::{Item, Section, all};
use super::{table, tables};
use crate::validate::{Owner, Place};
use crate::{Beyond, Curve, Formula, Joined, to_f64};

/// Reads all curves; one that is wrong is zero in formulas.
pub(super) fn read(reader: &mut Reader<'_>, page: &Section<'_>) {
    let sections = tables::each(reader, page, "curve", Owner::Curve).into_iter().enumerate();
    for (index, (section, name)) in sections {
        unlike_others(reader, index, &name);
        let curve = one(reader, &section, &name);
        reader.curves.push(curve.unwrap_or_else(|| none(name)));
    }
}

fn none(name: String) -> Curve {
    let points = [(0.0, 0.0), (1.0, 0.0)];
    Curve::through((name, String::new()), &points, Joined::Smooth, Beyond::Line).expect("two points")
}

fn one(reader: &mut Reader<'_>, section: &Section<'_>, name: &str) -> Option<Curve> {
    let joined = word(reader, section, "between", &Joined::ALL);
    let beyond = word(reader, section, "beyond", &Beyond::ALL);
    if section.has("points") {
        for (key, message) in [("table", "has points and a table"), ("columns", "has points")] {
            let message = format!("{} {message}", section.title);
            section.refuse(reader, key, &message, &format!("remove `{key}`, or `points`"));
        }
        let item = section.get("points")?;
        let points = points(reader, item)?;
        let source = name.to_owned();
        let refused = |reason| {
            let help = "write points [argument, value] with increasing arguments, of moderate size";
            let message = format!("{} has no curve through its points", section.title);
            item.wrong(reader, [message, reason, help.to_owned()]);
        };
        return Curve::through((name.to_owned(), source), &points, joined?, beyond?).map_err(refused).ok();
    }
    let item = section.require(reader, "table")?;
    let columns = section.get("columns");
    let points = table::of_curve(reader, item, columns)?;
    let path = item.text(reader)?.to_owned();
    let refused = |reason: String| {
        let help = "write increasing arguments, and values of moderate size";
        item.wrong(reader, table::refusal(&path, &reason, help));
    };
    Curve::through((name.to_owned(), path.clone()), &points, joined?, beyond?).map_err(refused).ok()
}

/// What a word stands for; the first where there is none.
fn word<T: Copy>(
    reader: &mut Reader<'_>,
    section: &Section<'_>,
    key: &'static str,
    all: &[(&str, T)],
) -> Option<T> {
    if !section.has(key) {
        return Some(all[0].1);
    }
    let word = section.word(reader, key)?;
    all.iter().find(|(known, _)| *known == word).map(|(_, value)| *value)
}

fn points(reader: &mut Reader<'_>, item: Item<'_>) -> Option<Vec<(f64, f64)>> {
    const EXPECTED: &str = "an array of at least two points [argument, value]";
    let rows: Vec<Vec<Item<'_>>> = item.elements().map(|row| row.elements().collect()).collect();
    if rows.len() < 2 || rows.iter().any(|row| row.len() != 2) {
        let help = "write two or more points, each of argument and value: [[0, 0], [1, 2]]";
        item.wrong_type_with(reader, EXPECTED, help.to_owned());
        return None;
    }
    all(rows.iter().map(|row| {
        let [x, y] = [0, 1].map(|k| plain_number(reader, row[k]));
        Some((to_f64(&x?), to_f64(&y?)))
    }))
}

/// In formulas a name has one meaning.
fn unlike_others(reader: &mut Reader<'_>, index: usize, name: &str) {
    let is_derived = reader.derived.iter().any(|(other, _)| other == name);
    let what = if functions::is_function(name) {
        "a function of formulas"
    } else if is_derived || reader.parameters.iter().chain(&reader.inputs).any(|other| other == name) {
        "a parameter or an input"
    } else {
        return;
    };
    let words = [
        format!("`{name}` names a curve, and {what}"),
        "used again".to_owned(),
        "choose another name".to_owned(),
    ];
    let place = Place { owner: Owner::Curve(index), key: "name" };
    let span = reader.span(place);
    reader.wrong(place, span, words);
}

/// Refuses a formula of what must have two continuous derivatives, if it calls a curve that has not.
pub(super) fn refuse_kinks(reader: &mut Reader<'_>, item: Item<'_>, formula: &Formula, what: &str) {
    let kinked = formula.curves().map(|curve| &reader.curves[curve]).find(|curve| !curve.is_smooth());
    let Some(Curve { name, joined, .. }) = kinked else { return };
    let (key, help) = match joined {
        Joined::Smooth => ("beyond", "give the curve beyond = \"line\" or \"error\""),
        _ => ("between", "give the curve between = \"smooth\""),
    };
    let words = [
        format!(
            "{what} cannot follow the curve `{name}`: by its `{key}` the second derivative is not continuous"
        ),
        "not smooth".to_owned(),
        help.to_owned(),
    ];
    item.wrong(reader, words);
}
