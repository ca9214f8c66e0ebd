//! `simulate --linearize`: the joint form near a state, as a control engineer takes it away.

use crate::verdict::eigenvalues;
use crate::words::{number, table};
use crate::{closed_loop, columns};
use gyro_model::Model;
use gyro_runner::motion::{Element, Linear};
use gyro_sim::JointPlace;
use serde_json::{Value, json};
use std::f64::consts::TAU;
use std::iter;

/// Names of the state's elements.
pub(crate) fn names(model: &Model, linear: &Linear) -> Vec<String> {
    linear.elements.iter().map(|element| name(model, element)).collect()
}

fn name(model: &Model, element: &Element) -> String {
    let (place, component, what) = match *element {
        Element::Position { place, component } => (place, component, ""),
        Element::Turn { place, component } => (place, component, "_turn"),
        Element::Rate { place, component } => (place, component, "_rate"),
    };
    match place {
        JointPlace::Scalar { joint, coordinate } | JointPlace::Turn { joint, coordinate } => {
            let joint = usize::from(joint);
            let shown = columns::coordinates(model).into_iter();
            let mut own = shown.filter(|shown| shown.joint == joint && !shown.is_orientation());
            let shown = own.nth(coordinate.into()).expect("a joint has the coordinates of its states");
            format!("{}{what}", shown.name)
        }
        JointPlace::State { state } => model.states[usize::from(state)].name.clone(),
        JointPlace::Orientation { joint } => {
            format!("{}{what}.{component}", model.joints[usize::from(joint)].name)
        }
        JointPlace::Body { body } => {
            let body = model.coordinate_bodies()[usize::from(body)];
            format!("{}{what}.{component}", model.bodies[body].name)
        }
    }
}

fn outputs(model: &Model) -> Vec<String> {
    columns::outputs(model).into_iter().map(|(name, _)| name).collect()
}

/// The object of `--json`.
pub(crate) fn object(model: &Model, linear: &Linear) -> Value {
    let (n, m) = (linear.state.len(), model.inputs.len());
    let rows = |values: &[f64], n: usize| -> Vec<Vec<f64>> {
        if n == 0 { vec![] } else { values.chunks(n).map(<[f64]>::to_vec).collect() }
    };
    let mut object = json!({
        "t": linear.t,
        "states": names(model, linear),
        "inputs": model.inputs.iter().map(|input| input.name.clone()).collect::<Vec<_>>(),
        "state": linear.state,
        "derivative": linear.slope,
        "A": rows(&linear.by_state, n),
        "B": rows(&linear.by_inputs, m),
        "outputs": outputs(model),
        "output": linear.outputs,
        "C": rows(&linear.outputs_by_state, n),
        "D": rows(&linear.outputs_by_inputs, m),
        "eigenvalues": eigenvalues(linear),
    });
    if let Some(closed) = closed_loop::object(model, linear) {
        object["closed_loop"] = closed;
    }
    object
}

/// The tables of the summary.
pub(crate) fn text(model: &Model, linear: &Linear) -> String {
    let states = names(model, linear);
    let inputs: Vec<String> = model.inputs.iter().map(|input| input.name.clone()).collect();
    let outputs = outputs(model);
    let mut text = format!("\nlinearised about t = {} s: d/dt x = f + A (x - x0) + B (u - u0)\n", linear.t);
    if !outputs.is_empty() {
        text += "outputs: z = h + C (x - x0) + D (u - u0)\n";
    }
    let tables = [
        matrix("A", &states, (&states, &linear.by_state)),
        matrix("B", &inputs, (&states, &linear.by_inputs)),
        matrix("C", &states, (&outputs, &linear.outputs_by_state)),
        matrix("D", &inputs, (&outputs, &linear.outputs_by_inputs)),
    ];
    text += &tables.into_iter().flatten().collect::<Vec<_>>().join("\n");
    text + &format!("\n{}{}", spectrum(linear), closed_loop::text(model, linear))
}

/// A matrix with names of its columns and rows; `None` for one without numbers.
fn matrix(title: &str, columns: &[String], (names, values): (&[String], &[f64])) -> Option<String> {
    if values.is_empty() {
        return None;
    }
    let head = iter::once(title.to_owned()).chain(columns.iter().cloned()).collect();
    let rows = names.iter().zip(values.chunks(columns.len())).map(|(name, values)| {
        iter::once(name.clone()).chain(values.iter().map(|value| number(*value, DIGITS))).collect()
    });
    Some(table(&iter::once(head).chain(rows).collect::<Vec<_>>()))
}

/// Eigenvalues, frequencies and damping ratios.
fn spectrum(linear: &Linear) -> String {
    let titles = ["eigenvalue", "real, 1/s", "imaginary, rad/s", "frequency, Hz", "damping ratio"];
    let mut rows = vec![titles.map(str::to_owned).to_vec()];
    for (index, [re, im]) in eigenvalues(linear).into_iter().enumerate() {
        let size = re.hypot(im);
        let damping = if size > 0.0 { number(-re / size, 4) } else { String::new() };
        // What does not oscillate has no frequency; of what does it is the undamped one.
        let frequency = if im == 0.0 { String::new() } else { number(size / TAU, DIGITS) };
        rows.push(vec![(index + 1).to_string(), number(re, DIGITS), number(im, DIGITS), frequency, damping]);
    }
    table(&rows)
}

const DIGITS: usize = 6;
