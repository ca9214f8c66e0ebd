//! Detects forms of an expression that lose accuracy by cancellation. Where masses or moments of inertia differ widely,
//! or are parameters that may be set so, a form is evaluated at sample states and masses, extreme ones among them: its
//! error in `f32` against `f64` may not be much larger than that of a form that cancels nothing (see `gram_schmidt`).

use crate::derive::system::System;
use crate::expr::evaluate::Program;
use crate::expr::graph::{ExprId, Graph, Node};
use crate::expr::symbol::Symbol;
use gyro_model::{Number, to_f64};
use rustc_hash::FxHashMap as HashMap;
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::{FRAC_PI_2, PI};

/// How many states are tried.
const STATES: u32 = 200;

/// Masses and moments that are parameters are tried at their values times ten to a power between minus and plus this.
const DECADES: f64 = 3.0;

/// Masses or moments that differ by more than this factor differ widely: their sum loses as many digits of the smaller
/// one.
const UNLIKE: f64 = 1e3;

/// An error that is larger than another by no more than this factor counts as equal.
const LIKE: f64 = 10.0;

/// Whether cancellation may matter: whether masses or moments of inertia are parameters, or differ widely.
pub fn may_matter(system: &mut System) -> bool {
    let (mut masses, mut moments, mut about_joints) = (Vec::new(), Vec::new(), Vec::new());
    for (moving_body, body) in system.moving_bodies.clone().into_iter().enumerate() {
        let (mass, inertia) = (system.mass(moving_body), system.inertia(moving_body));
        let constant = |id: ExprId| system.graph.as_constant(id).map(|constant| constant.to_f64());
        let own: Option<Vec<_>> = (0..3).map(|k| constant(inertia[k][k])).collect();
        let Some((mass, own)) = constant(mass).zip(own) else { return true };
        let ends = system.joints.iter().flat_map(|joint| [joint.first, joint.second]);
        let arms = ends.filter(|end| end.body == body).map(|end| end.point);
        let squares = arms.map(|arm| arm.into_iter().filter_map(constant).map(|x| x * x).sum::<f64>());
        about_joints.extend(squares.map(|square| mass * square));
        masses.push(mass);
        moments.extend(own);
    }
    about_joints.extend(&moments);
    let largest = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
    let least = |values: &[f64]| values.iter().copied().filter(|&x| x > 0.0).fold(f64::INFINITY, f64::min);
    largest(&masses) > UNLIKE * least(&masses) || largest(&about_joints) > UNLIKE * least(&moments)
}

/// Of coordinates, by their places, a value and the largest distance from it.
pub type Near = BTreeMap<usize, (f64, f64)>;

/// States at which expressions are tried.
#[derive(Debug)]
pub struct Trials {
    states: Vec<HashMap<Symbol, f64>>,
}

impl Trials {
    /// For the symbols of these expressions; `angles` are the joint coordinates that are angles, and `orientations`
    /// those that are Euler parameters. Coordinates that are `near` a value are within a distance from it.
    pub fn draw(
        system: &System,
        roots: &[ExprId],
        angles: &BTreeSet<usize>,
        (orientations, near): (&[[Symbol; 4]], &Near),
    ) -> Self {
        let graph = &system.graph;
        let symbols: BTreeSet<_> = (graph.reachable(roots).into_iter())
            .filter_map(|id| if let Node::Symbol(symbol) = graph.node(id) { Some(*symbol) } else { None })
            .collect();
        let inertial = inertial_parameters(system);
        let steps: Vec<_> = irrational().take(symbols.len()).collect();
        let state = |n: u32| {
            let between = steps.iter().map(|step| 2.0 * (f64::from(n + 1) * step).fract() - 1.0);
            let mut values: HashMap<Symbol, f64> = symbols.iter().copied().zip(between).collect();
            // In every other state all is aligned.
            let is_aligned = n.is_multiple_of(2);
            for (&symbol, value) in &mut values {
                match symbol {
                    Symbol::Coordinate(x) if near.contains_key(&x) => {
                        let (middle, distance) = near[&x];
                        *value = middle + distance * *value;
                    }
                    Symbol::Coordinate(x) if angles.contains(&x) && is_aligned => {
                        *value = (2.0 * *value).round() * FRAC_PI_2;
                    }
                    Symbol::Coordinate(x) if angles.contains(&x) => *value *= PI,
                    Symbol::Euler { .. } if is_aligned => *value = (1.2 * *value).round(),
                    Symbol::Parameter(index) => {
                        let factor = 10.0_f64.powf(DECADES * *value);
                        *value = to_f64(&system.model.parameters[index].value);
                        *value *= if inertial.contains(&index) { factor } else { 1.0 };
                    }
                    Symbol::Input(index) => *value = to_f64(&system.model.inputs[index].value),
                    _ => {}
                }
            }
            let bodies = 0..system.moving_bodies.len();
            let of_bodies = bodies.map(|moving_body| [0, 1, 2, 3].map(|k| Symbol::Euler { moving_body, k }));
            of_bodies.chain(orientations.iter().copied()).for_each(|p| to_length_one(&mut values, &p));
            values.values_mut().for_each(|value| *value = f64::from(shortened(*value)));
            values
        };
        Self { states: (0..STATES).map(state).collect() }
    }

    /// Whether a form of some expressions is as accurate as another that is known to cancel nothing: at each state.
    pub fn is_accurate(&self, graph: &Graph, way: &[ExprId], keeping: &[ExprId]) -> bool {
        let [way, keeping] = [way, keeping].map(|roots| Program::of(graph, roots));
        self.states.iter().all(|state| error_at(&way, state) <= allowed(error_at(&keeping, state)))
    }

    /// Of some forms whether each is as accurate as another, which may cancel digits too: in terms of their largest
    /// errors.
    pub fn are_alike<'w>(
        &self,
        graph: &Graph,
        ways: impl Iterator<Item = &'w [ExprId]>,
        known: &[ExprId],
    ) -> Vec<bool> {
        let worst = |roots: &[ExprId]| {
            let program = Program::of(graph, roots);
            self.states.iter().map(|state| error_at(&program, state)).fold(0.0, f64::max)
        };
        let allowed = allowed(worst(known));
        ways.map(|way| worst(way) <= allowed).collect()
    }
}

/// The error that counts as equal to another.
fn allowed(known: f64) -> f64 {
    LIKE * known.max(f64::from(f32::EPSILON))
}

/// The largest error of a form at a state.
fn error_at(form: &Program<'_>, state: &HashMap<Symbol, f64>) -> f64 {
    error(&form.run(|symbol| state[&symbol]), &form.run(|symbol| shortened(state[&symbol])))
}

/// The largest error in terms of the largest number.
fn error(exact: &[f64], computed: &[f32]) -> f64 {
    let largest = exact.iter().fold(f64::MIN_POSITIVE, |largest, x| largest.max(x.abs()));
    let errors = exact.iter().zip(computed).map(|(x, &y)| (x - f64::from(y)).abs());
    errors.fold(0.0, f64::max) / largest
}

#[expect(clippy::cast_possible_truncation, reason = "rounding to the nearest f32 is what is meant")]
fn shortened(x: f64) -> f32 {
    x as f32
}

/// Parameters that are masses or moments of inertia.
fn inertial_parameters(system: &System) -> BTreeSet<usize> {
    let bodies = system.model.bodies.iter();
    let numbers = bodies.flat_map(|body| std::iter::once(&body.mass).chain(&body.inertia));
    let index = |number: &Number| match number {
        Number::Parameter { index, .. } => Some(*index),
        _ => None,
    };
    numbers.filter_map(index).collect()
}

/// Makes Euler parameters a unit vector.
fn to_length_one(values: &mut HashMap<Symbol, f64>, p: &[Symbol; 4]) {
    let square: f64 = p.iter().filter_map(|symbol| values.get(symbol)).map(|x| x * x).sum();
    for symbol in p {
        if let Some(x) = values.get_mut(symbol) {
            *x = if square > 0.0 { *x / square.sqrt() } else { 0.5 };
        }
    }
}

/// Square roots of primes: the fractional parts of their multiples fill the unit cube evenly (a Kronecker sequence).
fn irrational() -> impl Iterator<Item = f64> {
    let is_prime = |n: &u32| (2..*n).all(|d| !n.is_multiple_of(d));
    (2..).filter(is_prime).map(|prime| f64::from(prime).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at_stake(page: &str) -> bool {
        let model = gyro_model::read("page.toml", page).expect("a model file without mistakes");
        may_matter(&mut System::new(&model))
    }

    #[test]
    fn cancellation_may_matter_where_masses_differ_widely_or_may_be_set_so() {
        assert!(!at_stake(include_str!("../../../models/gyroscope.toml")));
        assert!(at_stake(include_str!("../../../models/gyroscope-light-rings.toml")));
        assert!(at_stake(include_str!("../../../models/gyroscope-parameters.toml")));
    }

    #[test]
    fn the_difference_of_large_sums_loses_digits_and_a_product_does_not() {
        let page = include_str!("../../../models/gyroscope-parameters.toml");
        let model = gyro_model::read("page.toml", page).expect("a model file without mistakes");
        let mut system = System::new(&model);
        let inertial: Vec<_> = inertial_parameters(&system).into_iter().collect();
        let graph = &mut system.graph;
        let [mass, moment] = [inertial[0], inertial[1]].map(|index| graph.symbol(Symbol::Parameter(index)));
        // A sine keeps the sum from being taken apart.
        let sine = graph.sin(mass);
        let sum = graph.add(sine, moment);
        let difference = graph.sub(sum, sine);
        let square = graph.mul(moment, moment);
        let product = graph.div(square, moment);
        let trials =
            Trials::draw(&system, &[difference, product, moment], &BTreeSet::new(), (&[], &BTreeMap::new()));
        assert!(!trials.is_accurate(&system.graph, &[difference], &[moment]));
        assert!(trials.is_accurate(&system.graph, &[product], &[moment]));
    }
}
