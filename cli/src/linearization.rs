//! `simulate --linearize`: the joint form near a state, as a control engineer takes it away.

use crate::columns;
use crate::verdict::eigenvalues;
use crate::words::{number, table};
use gyro_model::Model;
use gyro_runner::motion::Linear;
use serde_json::{Value, json};

/// Names of the joint state's elements, as far as joints and free bodies name them: coordinates, then rates.
fn names(model: &Model, n: usize) -> Vec<String> {
    let (mut positions, mut rates) = (Vec::new(), Vec::new());
    let numbered = |name: &str, n: usize| (0..n).map(|k| format!("{name}.{k}")).collect::<Vec<_>>();
    for coordinate in columns::coordinates(model) {
        if coordinate.is_orientation() {
            positions.extend(numbered(&coordinate.name, 4));
            rates.extend(numbered(&format!("{}_rate", coordinate.name), 3));
        } else {
            rates.push(format!("{}_rate", coordinate.name));
            positions.push(coordinate.name);
        }
    }
    for (_, body) in crate::scene::observed(model) {
        positions.extend(numbered(body, 7));
        rates.extend(numbered(&format!("{body}_rate"), 6));
    }
    let mut names = positions;
    names.extend(rates);
    if names.len() == n { names } else { numbered("x", n) }
}

/// The object of `--json`.
pub(crate) fn object(model: &Model, linear: &Linear) -> Value {
    let (n, m) = (linear.state.len(), model.inputs.len());
    let rows = |values: &[f64], n: usize| -> Vec<Vec<f64>> {
        if n == 0 { vec![] } else { values.chunks(n).map(<[f64]>::to_vec).collect() }
    };
    json!({
        "t": linear.t,
        "states": names(model, n),
        "inputs": model.inputs.iter().map(|input| input.name.clone()).collect::<Vec<_>>(),
        "state": linear.state,
        "derivative": linear.slope,
        "A": rows(&linear.by_state, n),
        "B": rows(&linear.by_inputs, m),
        "eigenvalues": eigenvalues(linear),
    })
}

/// The tables of the summary.
pub(crate) fn text(model: &Model, linear: &Linear) -> String {
    let (names, n, m) = (names(model, linear.state.len()), linear.state.len(), model.inputs.len());
    let inputs: Vec<String> = model.inputs.iter().map(|input| input.name.clone()).collect();
    let mut text = format!("\nlinearised about t = {} s: d/dt x = f + A (x - x0) + B (u - u0)\n", linear.t);
    let head = |title: &str, columns: &[String]| {
        let mut row = vec![title.to_owned()];
        row.extend(columns.iter().cloned());
        row
    };
    let mut rows = vec![head("A", &names)];
    for (name, values) in names.iter().zip(linear.by_state.chunks(n)) {
        rows.push(head(name, &values.iter().map(|v| number(*v, DIGITS)).collect::<Vec<_>>()));
    }
    text += &table(&rows);
    if m > 0 {
        let mut rows = vec![head("B", &inputs)];
        for (name, values) in names.iter().zip(linear.by_inputs.chunks(m)) {
            rows.push(head(name, &values.iter().map(|v| number(*v, DIGITS)).collect::<Vec<_>>()));
        }
        text += &format!("\n{}", table(&rows));
    }
    let mut rows = vec![head(
        "eigenvalue",
        &["real, 1/s".to_owned(), "imaginary, rad/s".to_owned(), "damping ratio".to_owned()],
    )];
    for (index, [re, im]) in eigenvalues(linear).into_iter().enumerate() {
        let size = re.hypot(im);
        let damping = if size > 0.0 { number(-re / size, 4) } else { String::new() };
        rows.push(vec![(index + 1).to_string(), number(re, DIGITS), number(im, DIGITS), damping]);
    }
    text + &format!("\n{}", table(&rows))
}

const DIGITS: usize = 6;
