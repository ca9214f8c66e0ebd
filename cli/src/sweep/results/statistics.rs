//! What the page says of each kept number: mean, deviation, quantiles, correlations, and its yield within limits.

use super::cloud::{Column, escaped};
use super::column;
use crate::words::number;
use gyro_sweep::{QUANTILES, quantiles};
use std::fmt::Write as _;

/// Digits that are shown, and those of the values that the yield is counted of.
const DIGITS: usize = 5;
const COUNTED: usize = 9;

/// Bytes for the values of all numbers of which the yield is counted, about.
const BYTES: usize = 60_000;

/// A table with a row for each number, and after it the fields in which limits are written.
pub(super) fn table(targets: &[Column<'_>], numbers: &[Column<'_>], every: u64) -> String {
    let mut html =
        "<h2>Statistics</h2>\n<table id=\"numbers\"><tr><th></th><th>mean</th><th>deviation</th>".to_owned();
    for q in QUANTILES {
        let _ = write!(html, "<th>{:.0} %</th>", 100.0 * q);
    }
    for target in targets {
        let _ = write!(html, "<th>correlation with {}</th>", escaped(&target.name.0));
    }
    html += "<th>from</th><th>to</th><th>yield</th></tr>\n";
    for own in numbers {
        let finite = own.values.iter().copied().filter(|value| value.is_finite());
        let [mean, deviation] = moments(finite.clone());
        let _ = write!(html, "<tr><th>{}</th>", escaped(&column(own.name)));
        let correlations = targets.iter().map(|target| correlation(&target.values, &own.values));
        let shown = [mean, deviation].into_iter().chain(quantiles(&mut own.values.clone()));
        for value in shown {
            let _ = write!(html, "<td>{}</td>", or_none(value, DIGITS));
        }
        for value in correlations {
            let _ = write!(html, "<td>{}</td>", or_none(value, 3));
        }
        let _ = writeln!(html, "<td><input size=\"7\"></td><td><input size=\"7\"></td><td></td></tr>");
    }
    html += "</table>\n";
    let of = if every > 1 { format!("every {every}th scenario") } else { "all scenarios".to_owned() };
    let _ = writeln!(
        html,
        "<p>Of {of}. The yield is the part of them within the limits that are written in; failed ones are not.</p>"
    );
    html + &yields(numbers)
}

fn or_none(value: f64, digits: usize) -> String {
    if value.is_finite() { number(value, digits) } else { String::new() }
}

/// Mean and deviation; NaN where there are too few.
fn moments(values: impl Iterator<Item = f64> + Clone) -> [f64; 2] {
    #[expect(clippy::cast_precision_loss, reason = "a number of scenarios")]
    let n = values.clone().count() as f64;
    let mean = values.clone().sum::<f64>() / n;
    let squares: f64 = values.map(|value| (value - mean) * (value - mean)).sum();
    [mean, (squares / (n - 1.0)).sqrt()]
}

/// Pearson's coefficient over the scenarios that have both; NaN where one of them does not vary.
fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let both: Vec<[f64; 2]> =
        a.iter().zip(b).map(|(a, b)| [*a, *b]).filter(|pair| pair.iter().all(|x| x.is_finite())).collect();
    let of = |k: usize| both.iter().map(move |pair| pair[k]);
    let [[a, of_a], [b, of_b]] = [0, 1].map(|k| moments(of(k)));
    let products: f64 = both.iter().map(|pair| (pair[0] - a) * (pair[1] - b)).sum();
    #[expect(clippy::cast_precision_loss, reason = "a number of scenarios")]
    let n = both.len() as f64;
    (products / (n - 1.0)) / (of_a * of_b)
}

/// Counts yields where the page is read: of each number its values in order, or so many quantiles of them that the page
/// stays small, and the part of the scenarios that have it.
fn yields(numbers: &[Column<'_>]) -> String {
    let most = (BYTES / (12 * numbers.len().max(1))).clamp(51, 2001);
    let list = |own: &Column<'_>| {
        let mut values: Vec<f64> = own.values.iter().copied().filter(|value| value.is_finite()).collect();
        #[expect(clippy::cast_precision_loss, reason = "a number of scenarios")]
        let part = values.len() as f64 / own.values.len().max(1) as f64;
        values.sort_by(f64::total_cmp);
        let n = values.len().min(most);
        // The middle ones of parts of the same size.
        let kept = (0..n).map(|k| number(values[(2 * k + 1) * values.len() / (2 * n)], COUNTED));
        format!("[{part},[{}]]", kept.collect::<Vec<_>>().join(","))
    };
    let all: Vec<String> = numbers.iter().map(list).collect();
    format!("<script>const all = [{}];\n{SCRIPT}</script>\n", all.join(",\n"))
}

const SCRIPT: &str = r##"
document.querySelectorAll("#numbers tr:not(:first-child)").forEach((row, k) => {
  const [low, high] = row.querySelectorAll("input"), [part, values] = all[k];
  const limit = (field, open) => field.value.trim() === "" ? open : Number(field.value);
  const show = () => {
    const [from, to] = [limit(low, -Infinity), limit(high, Infinity)];
    const within = values.filter(x => x >= from && x <= to).length / values.length;
    const wrong = Number.isNaN(from) || Number.isNaN(to);
    row.lastElementChild.textContent = wrong ? "no number" : (100 * part * (within || 0)).toFixed(1) + " %";
  };
  [low, high].forEach(field => field.addEventListener("input", show));
  show();
});
"##;

#[cfg(test)]
mod tests;
