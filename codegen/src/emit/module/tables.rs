//! The numbers of tables. As tokens those of a long table would take most of the time of a generation, so they are written into the text.

use gyro_model::Spline;

/// Name of the times of a table.
pub fn knots_name(table: usize) -> String {
    format!("KNOTS_{table}")
}

/// Name of its polynomials.
pub fn pieces_name(table: usize) -> String {
    format!("PIECES_{table}")
}

/// Fills the arrays of a module's text, which are empty, laid out as the rest of it is.
pub fn with_numbers(text: String, tables: &[&Spline]) -> String {
    if tables.is_empty() {
        return text;
    }
    let (mut filled, mut rest) = (String::new(), &text[..]);
    for (table, spline) in tables.iter().enumerate() {
        let knots = spline.knots.iter().map(|knot| format!("{knot:?}")).collect();
        let piece = |piece: &[f64; 4]| {
            let row = list(piece.iter().map(|c| format!("{c:?}")).collect(), INDENT.len() + ",".len());
            row.replace('\n', &format!("\n{INDENT}"))
        };
        let pieces = spline.pieces.iter().map(piece).collect();
        for (name, elements) in [(knots_name(table), knots), (pieces_name(table), pieces)] {
            let start = rest.find(&format!("\nconst {name}: ")).expect("the array was written") + 1;
            let end = start + rest[start..].find("[];").expect("and is empty");
            filled += &rest[..end];
            filled += &list(elements, end - start + ";".len());
            rest = &rest[end + "[]".len()..];
        }
    }
    filled + rest
}

const INDENT: &str = "    ";

/// The widest line.
const WIDTH: usize = 89;

/// A list in brackets: on one line if there is room beside so many other characters, else with a line for each element.
fn list(elements: Vec<String>, others: usize) -> String {
    let line: usize = elements.iter().map(|element| element.len() + ", ".len()).sum();
    if line + others <= WIDTH && !elements.iter().any(|element| element.contains('\n')) {
        return format!("[{}]", elements.join(", "));
    }
    let lines: String = elements.iter().map(|element| format!("{INDENT}{element},\n")).collect();
    format!("[\n{lines}]")
}
