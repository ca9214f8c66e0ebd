//! The mechanism as WebAssembly, for a page in which it runs.

use super::describe;
use super::meshes::Meshes;
use crate::export::wasm::compiled;
use crate::failure::Failure;
use crate::progress;
use crate::scene::Scene;
use crate::verify::proved;
use crate::{columns, left_out, paths, remarks};
use gyro_export::Precision;
use gyro_model::{Model, parse_decimal, to_f64};
use gyro_runner::{Integrator, Sample, any_varies};
use gyro_show::{Live, Setting, Slope};
use serde_json::Value;

/// The tolerance where none is asked for.
const TOLERANCE: f64 = 1e-9;

/// The module of a scene, proved, compiled, and what the page has to know to run it.
pub(super) fn live(scene: &Scene) -> Result<Live, Failure> {
    let model = Model { functions: Some(vec!["solvers".to_owned()]), ..scene.page.clone() };
    let spinner = progress::deriving(&model);
    let module = gyro_codegen::generate_model(&scene.page_name, &model)
        .map_err(|e| Failure::Usage(format!("{}: {e}", scene.page_name)))?;
    drop(spinner);
    let module = proved(&model, module)?;
    let broken = |e: String| Failure::Run(format!("{}: {e}: please report it", scene.page_name));
    let exported = gyro_export::wasm::wasm(&scene.page_name, &model, &module.scheduled, Precision::F64);
    let texts = (module.code.as_str(), module.constants.as_str());
    gyro_verifier::same_in_c(&model, texts, (&exported.c.header, &exported.c.source))
        .map_err(|e| broken(format!("the C text is not what was proved: {e}")))?;
    let mut without = left_out::left_out(&scene.model);
    if any_varies(&scene.start.inputs) {
        without.push("how inputs vary: they stay at their first values until they are set there".to_owned());
    }
    without.iter().for_each(|words| remarks::warn(&format!("--live: the page computes without {words}")));
    paths::refuse(&scene.model, "--live")?;
    Ok(Live {
        about: serde_json::from_str(&exported.about).map_err(|e| broken(e.to_string()))?,
        module: compiled(&module.name, &exported)?,
        method: Some(scene.approach.integrator)
            .filter(|method| method.is_adaptive())
            .unwrap_or(Integrator::Dop853)
            .name(),
        tolerance: scene.approach.tolerance.unwrap_or(TOLERANCE),
        parameters: settings(&scene.model.parameters, |_| ""),
        inputs: inputs(scene),
        slopes: slopes(scene),
        without,
    })
}

fn settings(of: &[gyro_model::Parameter], unit: impl Fn(usize) -> &'static str) -> Vec<Setting> {
    let one = |(n, of): (usize, &gyro_model::Parameter)| Setting {
        name: of.name.clone(),
        value: to_f64(&of.value),
        unit: unit(n).to_owned(),
    };
    of.iter().enumerate().map(one).collect()
}

fn inputs(scene: &Scene) -> Vec<Setting> {
    let model = &scene.model;
    let values = columns::inputs_at(model, &scene.start, &Sample::default());
    let mut settings = settings(&model.inputs, |n| columns::input_unit(model, n));
    settings.iter_mut().zip(values).for_each(|(setting, value)| setting.value = value);
    settings
}

/// Numbers of the drawing that change with a parameter, by the difference that a hundredth of it makes.
fn slopes(scene: &Scene) -> Vec<Slope> {
    let base = numbers(&scene.model);
    let mut slopes = Vec::new();
    for (parameter, of) in scene.model.parameters.iter().enumerate() {
        let value = &of.value;
        let hundredth = parse_decimal("0.01").expect("a decimal number");
        let step = if to_f64(value) == 0.0 { hundredth } else { value * hundredth };
        let Ok(changed) = scene.model.with_parameters(&[(of.name.clone(), value + &step)]) else { continue };
        for ((path, base), (_, changed)) in base.iter().zip(numbers(&changed)) {
            let slope = (changed - base) / to_f64(&step);
            if slope != 0.0 && slope.is_finite() {
                slopes.push(Slope { path: path.clone(), base: *base, parameter, slope });
            }
        }
    }
    slopes
}

/// All numbers of a drawing, each with its path.
fn numbers(model: &Model) -> Vec<(String, f64)> {
    fn collect(path: &str, value: &Value, found: &mut Vec<(String, f64)>) {
        match value {
            Value::Number(number) => found.extend(number.as_f64().map(|number| (path.to_owned(), number))),
            Value::Array(values) => {
                values
                    .iter()
                    .enumerate()
                    .for_each(|(n, value)| collect(&format!("{path}/{n}"), value, found));
            }
            Value::Object(values) => {
                values.iter().for_each(|(key, value)| collect(&format!("{path}/{key}"), value, found));
            }
            _ => {}
        }
    }
    let mut found = Vec::new();
    let drawn = serde_json::to_value(describe::mechanism(model, Meshes::default())).unwrap_or_default();
    collect("", &drawn, &mut found);
    found
}
