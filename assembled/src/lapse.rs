//! Where a formula of a model has no value: each is computed operation by operation, at a moment and soon after it.

use crate::Dense;
use crate::model::amount::{Amount, Now, Written};
use crate::model::between::Frames;
use crate::model::path::Path;
use crate::model::place::{Moment, Places, vector};
use gyro_model::{ForceKind, Formula, Model, Number, Operation, Site};
use gyro_program::elementary::Function;
use gyro_sim::Mechanism;
use std::convert::Infallible;

/// A formula that has no value.
#[derive(Clone, Debug, PartialEq)]
pub struct Lapse {
    /// Where it stands, such as ``the tension of force `wire` ``.
    pub place: String,
    /// Its text.
    pub text: String,
    /// Formulas that it names, each named by the one before, down to the one that has no value by itself: names and
    /// texts.
    pub within: Vec<(String, String)>,
    /// The names in the last of these texts, with their values.
    pub names: Vec<(String, f64)>,
}

/// What the motion is extrapolated over, in steps.
const SOON: [f64; 11] = [0.0, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 0.5, 1.5];

/// The formula that has no value at a time and state, or that is the first to have none within a step of length h from
/// there; inputs are set to these values. `None` as well if the model has no start, or the state is not one of it.
pub fn lapse(model: &Model, inputs: &[(usize, f64)], (t, y): (f64, Option<&[f64]>), h: f64) -> Option<Lapse> {
    // An output without a value ends no run.
    let mut sites = model.sites();
    sites.retain(|site| !site.owner.starts_with("output"));
    if sites.is_empty() {
        return None;
    }
    let mut mechanism = Dense::<f64>::new(model).ok()?;
    inputs.iter().for_each(|(index, value)| _ = mechanism.set_input(*index, *value));
    let y = y.map_or_else(|| mechanism.start(), <[f64]>::to_vec);
    if y.len() != mechanism.start().len() {
        return None;
    }
    let mut rates = vec![0.0; y.len()];
    mechanism.write_derivative(t, &y, &mut rates);
    let view = View { model, places: Places::new(model), mechanism };
    let now = view.all(&sites, (t, &y), None);
    SOON.iter().find_map(|part| {
        let later: Vec<f64> = y.iter().zip(&rates).map(|(y, rate)| y + part * h * rate).collect();
        if part > &0.0 && later.iter().any(|number| !number.is_finite()) {
            return None;
        }
        let at = (t + part * h, later.as_slice());
        let before = (*part > 0.0).then_some(now.as_slice());
        let all = view.all(&sites, at, before);
        let ends = |(site, values): (&Site<'_>, &Vec<f64>)| match before {
            None => lapses(values),
            Some(_) => is_beyond(site.formula, values),
        };
        let place = sites.iter().zip(&all).position(ends)?;
        Some(view.told(&sites[place], (at, before.map(|_| (t, y.as_slice())), &all[place])))
    })
}

/// A model in numbers, to look at its formulas.
struct View<'m> {
    model: &'m Model,
    places: Places<f64>,
    mechanism: Dense<f64>,
}

type At<'a> = (f64, &'a [f64]);

impl View<'_> {
    /// The values of all operations of all formulas. A division by what has changed its sign since an earlier moment
    /// has none.
    fn all(&self, sites: &[Site<'_>], at: At<'_>, before: Option<&[Vec<f64>]>) -> Vec<Vec<f64>> {
        let outputs = self.outputs(at);
        let one = |(place, site): (usize, &Site<'_>)| {
            let before = before.map(|before| before[place].as_slice());
            self.operations((site.formula, site.force), (at, &outputs), before)
        };
        sites.iter().enumerate().map(one).collect()
    }

    fn outputs(&self, (t, y): At<'_>) -> Vec<f64> {
        let mut outputs = self.mechanism.buffers().outputs;
        self.mechanism.outputs(t, &y.to_vec(), &mut outputs);
        outputs
    }

    fn operations(
        &self,
        (formula, force): (&Formula, Option<&ForceKind>),
        ((t, y), outputs): (At<'_>, &[f64]),
        before: Option<&[f64]>,
    ) -> Vec<f64> {
        let (scene, at) = (&self.mechanism.lowered.scene, Moment { t, y });
        let number = Number::Formula(formula.clone().into());
        let Amount::Formula(written) = Amount::new(self.model, (&self.places, &scene.joints), &number) else {
            return Vec::new();
        };
        let mut now = Now { outputs, ..Now::new(scene, at) };
        let seen;
        match force {
            Some(ForceKind::Link { first, second, .. }) => {
                let end =
                    |(body, point): &(usize, _)| (self.places.of(*body), vector(self.model.values(point)));
                let path = Path::Line([end(first), end(second)]);
                let motions = path.places(scene).map(|place| scene.motion(at, place));
                now.line = [path.value(scene, at), path.grip(scene, &motions).rate];
            }
            Some(ForceKind::Bushing(bushing)) => {
                seen = Frames::new(self.model, &self.places, bushing.ends()).readings(scene, at).seen;
                now.frames = Some(&seen);
            }
            _ => {}
        }
        values(&written, &now, before)
    }

    /// A formula with a name, among those that this one names, which has no value.
    fn inner(
        &self,
        formula: &Formula,
        at: At<'_>,
        earlier: Option<At<'_>>,
    ) -> Option<(&str, &Formula, Vec<f64>)> {
        let all = |at: At<'_>, named: &Formula, before: Option<&[f64]>| {
            self.operations((named, None), (at, &self.outputs(at)), before)
        };
        let is_named = |name: &String| formula.names.iter().any(|(known, _)| known == name);
        self.model.formulas.iter().filter(|(name, _)| is_named(name)).find_map(|(name, named)| {
            let before = earlier.map(|earlier| all(earlier, named, None));
            let values = all(at, named, before.as_deref());
            lapses(&values).then_some((name.as_str(), named, values))
        })
    }

    /// What there is to say of a formula that has no value.
    fn told(&self, site: &Site<'_>, (at, earlier, values): (At<'_>, Option<At<'_>>, &[f64])) -> Lapse {
        let (mut formula, mut values, mut within) = (site.formula, values.to_vec(), Vec::new());
        while let Some((name, named, of_named)) = self.inner(formula, at, earlier) {
            within.push((name.to_owned(), named.text.clone()));
            (formula, values) = (named, of_named);
        }
        let value = |(name, place): &(String, Option<usize>)| {
            let value = place.map(|place| values[place]).or_else(|| self.constant(name));
            Some((name.clone(), value?))
        };
        Lapse {
            place: site.words(),
            text: site.formula.text.clone(),
            within,
            names: formula.names.iter().filter_map(value).collect(),
        }
    }

    /// The value of a parameter.
    fn constant(&self, name: &str) -> Option<f64> {
        let mut parameters = self.model.parameters.iter();
        let own = parameters.position(|parameter| parameter.name == name);
        let own = own.map(|index| Number::Parameter { index, negated: false });
        let mut derived = self.model.derived_parameters.iter();
        let number = own.or_else(|| {
            derived.find(|parameter| parameter.name == name).map(|parameter| parameter.number.clone())
        });
        number.map(|number| self.model.value(&number))
    }
}

fn values(written: &Written<f64>, now: &Now<'_, f64>, before: Option<&[f64]>) -> Vec<f64> {
    let mut all = Vec::new();
    let value = written.formula.value(|operation, values: &[f64]| {
        let divisor = match operation {
            Operation::Quotient(_, b) => Some(*b),
            Operation::Power(a, ..0) => Some(*a),
            _ => None,
        };
        let passes = |place: usize| before.is_some_and(|before| before[place] * values[place] < 0.0);
        let value = written.operation(operation, values, now);
        let value = if divisor.is_some_and(passes) { f64::NAN } else { value };
        all.push(value);
        Ok::<_, Infallible>(value)
    });
    let Ok(_) = value;
    all
}

/// Whether a formula has no value.
fn lapses(values: &[f64]) -> bool {
    values.last().is_some_and(|value| !value.is_finite())
}

/// Whether it has none for no other reason than what its roots, logarithms and divisions allow.
fn is_beyond(formula: &Formula, values: &[f64]) -> bool {
    let is_limited = |operation: &Operation| {
        matches!(
            operation,
            Operation::Quotient(..)
                | Operation::Power(..)
                | Operation::Call(Function::Sqrt | Function::Ln, _)
        )
    };
    lapses(values)
        && formula.operations.iter().zip(values).any(|(operation, value)| {
            let is_known = || operation.operands().all(|operand| values[operand].is_finite());
            is_limited(operation) && !value.is_finite() && is_known()
        })
}
