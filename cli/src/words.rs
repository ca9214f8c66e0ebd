//! Numbers as people read them.

/// A number with so many significant digits at most, plain where that is short.
pub(crate) fn number(value: f64, digits: usize) -> String {
    if value == 0.0 {
        // Nor a negative zero.
        return "0".to_owned();
    }
    if !value.is_finite() {
        return format!("{value}");
    }
    let scientific = format!("{value:.*e}", digits.saturating_sub(1));
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    if !(-4..6).contains(&exponent) {
        return format!("{}e{exponent}", trimmed(mantissa));
    }
    let decimals = usize::try_from(digits as i32 - 1 - exponent).unwrap_or(0);
    trimmed(&format!("{value:.decimals$}")).to_owned()
}

/// Without the zeros that end a decimal fraction.
fn trimmed(text: &str) -> &str {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { text }
}

/// A count with its noun: `1 step`, `2 steps`, `10 000 steps`.
pub(crate) fn count(number: u64, noun: &str) -> String {
    let digits = number.to_string();
    let mut grouped = String::new();
    for (k, digit) in digits.chars().enumerate() {
        if k > 0 && (digits.len() - k).is_multiple_of(3) && digits.len() > 4 {
            grouped.push(' ');
        }
        grouped.push(digit);
    }
    format!("{grouped} {noun}{}", if number == 1 { "" } else { "s" })
}

/// Names of a list that are written out.
const LISTED: usize = 40;

/// What to write in place of an unknown name.
pub(crate) fn instead(written: &str, known: &[&str]) -> String {
    let list = listed(&known.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>());
    let only = known.first().copied().filter(|_| known.len() == 1);
    match gyro_model::meant(written, known).or(only) {
        Some(meant) => format!("write `{meant}`; there are {list}"),
        None => format!("write one of {list}"),
    }
}

/// Names one after the other, as many as are written out.
pub(crate) fn listed(names: &[String]) -> String {
    let more = names.len().saturating_sub(LISTED);
    let list = names[..names.len() - more].join(", ");
    if more == 0 { list } else { format!("{list} and {more} more") }
}

/// Lines of a list that are shown, and characters of each.
const LINES: usize = 30;
const LINE: usize = 800;

/// The first lines of a list, none of them too long, and how many more there are.
pub(crate) fn capped(lines: &[String]) -> String {
    let cut = |line: &String| match line.char_indices().nth(LINE) {
        None => line.clone(),
        Some((end, _)) => format!("{}...", &line[..end]),
    };
    let mut shown: Vec<String> = lines.iter().take(LINES).map(cut).collect();
    let more = lines.len().saturating_sub(LINES);
    if more > 0 {
        shown.push(format!("and {more} more"));
    }
    shown.join("\n")
}

/// Columns side by side: the first to the left, the others to the right, two spaces apart and two before.
pub(crate) fn table(rows: &[Vec<String>]) -> String {
    let n_columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |column: usize| rows.iter().filter_map(|r| r.get(column)).map(|c| c.chars().count()).max();
    let widths: Vec<usize> = (0..n_columns).map(|c| width(c).unwrap_or(0)).collect();
    let mut text = String::new();
    for row in rows {
        let mut line = String::new();
        for (column, (cell, &width)) in row.iter().zip(&widths).enumerate() {
            line += &if column == 0 { format!("  {cell:<width$}") } else { format!("  {cell:>width$}") };
        }
        text += line.trim_end();
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests;
