//! The numbers of tables. As tokens those of a long table would take most of the time of a generation, so they are
//! written into the text.

use crate::emit::names::{knots_name, pieces_name};
use gyro_model::Spline;

/// Fills the arrays of a module's text, which are empty, laid out as the rest of it is.
pub fn with_numbers(text: String, tables: &[Spline]) -> String {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::emit::literals::float;
    use quote::quote;

    /// Lists of few and many numbers, and pieces of all lengths about that of a line.
    #[test]
    fn numbers_are_laid_out_as_the_rest_of_a_module_is() {
        for n in [2, 3, 9, 40] {
            let knots: Vec<f64> = (0..n).map(f64::from).collect();
            let digits = |k: i32| (0..k % 22).fold(0.0, |x, _| (x + 3.0) / 10.0);
            let pieces = (1..n).map(|k| [digits(k), -digits(k + 1), 1.0 + digits(k / 2), 1e-7 / 3.0]);
            let spline = Spline { source: String::new(), knots, pieces: pieces.collect() };
            let times = spline.knots.iter().map(|&t| float(t));
            let pieces = spline.pieces.iter().map(|piece| piece.map(float)).map(|c| quote! { [#(#c),*] });
            let text = |times, pieces| {
                let tokens = quote! {
                    const KNOTS_0: [f64; 1] = [#times];
                    /// Polynomials.
                    const PIECES_0: [[f64; 4]; 1] = [#pieces];
                };
                // The head of a module comes first.
                format!("//!\n{}", prettyplease::unparse(&syn::parse2(tokens).expect("constants")))
            };
            let expected = text(quote! { #(#times),* }, quote! { #(#pieces),* });
            assert_eq!(with_numbers(text(quote! {}, quote! {}), std::slice::from_ref(&spline)), expected);
        }
    }
}
