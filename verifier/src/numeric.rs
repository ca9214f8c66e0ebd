//! What only numbers can show: the start, and that angles are read with the right sign.

use crate::atoms::Elementary;
use crate::field::{Field, Precision, Real};
use crate::interpreter::{self, Given};
use crate::joints::{Freedom, JointLayout};
use crate::module::Module;
use crate::point::Point;
use crate::program::{Id, Source};
use crate::proof::point_of_terms;
use crate::seed::Seed;
use crate::states::{places, point, random_state};
use crate::tape::{Tape, Term, Written};
use crate::textbook::{Reading, Textbook};
use gyro_model::{JointCoordinate, Model, START_TOLERANCE, Start};
use rand::RngExt;

/// Sine and cosine of an angle that is none.
const VANISHING: f64 = 1e-6;

/// States at which the signs of angles are compared.
const STATES: usize = 16;

/// All that is wrong with the start and the readings.
pub fn problems(model: &Model, module: &Module, seed: Seed) -> Vec<String> {
    let mut problems: Vec<String> = start_differs(model, module).into_iter().collect();
    problems.extend(start_violates(model, module));
    problems.extend(wrong_signs(model, module, seed));
    problems.extend(joint_start_differs(model, module));
    problems
}

/// The start must be the one that the model assembles.
fn start_differs(model: &Model, module: &Module) -> Option<String> {
    let start = match model.assemble() {
        Ok(start) => start,
        Err(error) => return Some(format!("the start cannot be assembled: {error}")),
    };
    let turns = model.turn_references();
    let turns = turns.iter().map(|turn| start.joints[turn.joint].position[turn.coordinate]);
    let work = model.has_work().then_some(0.0);
    let moving = start.q.iter().chain(&start.v).copied().chain(work);
    let expected = moving.chain(start.states.iter().copied()).chain(turns);
    let place = expected.zip(&module.start).position(|(expected, found)| expected != *found);
    place.map(|place| format!("element {place} of the start is not what the model assembles"))
}

/// The start must satisfy the textbook's rows, at time zero.
fn start_violates(model: &Model, module: &Module) -> Option<String> {
    let (tape, textbook) = (Tape::new(), Textbook::new(model));
    let [phi, rates] = {
        let point = point_of_terms(model, &tape);
        let evaluation = textbook.at(&point, &Written);
        let rows = evaluation.and_then(|e| Some([e.phi()?, e.velocity_residual()?]));
        let Some(rows) = rows else { return Some("the textbook divides by zero".to_owned()) };
        rows.map(|rows| rows.into_iter().map(Term::id).collect::<Vec<Id>>())
    };
    let formulas = tape.finish();
    let precision = Precision::new();
    let point = point(model, &precision, &module.start, 0.0, |x| Real::new(&precision, x));
    let reach = formulas.reach(phi.iter().chain(&rates).copied());
    let values = formulas.evaluate(&reach, &precision, &Elementary, &|source| read(&point, source));
    let start = model.assemble().ok()?;
    let tolerances = model.start_tolerances(&start);
    let rows = model.rows();
    // Normalisations follow the rows.
    let of_normalisation = std::iter::repeat(&START_TOLERANCE);
    let violated = |ids: &[Id], tolerances: &[f64], what: &str| {
        let mut tolerated = ids.iter().zip(tolerances.iter().chain(of_normalisation.clone())).enumerate();
        tolerated.find_map(|(row, (id, tolerance))| {
            let value = values[*id].as_ref().map_or(f64::NAN, Real::to_f64);
            let name = rows.get(row).map_or_else(
                || format!("the normalisation of coordinate body {}", row + 1 - rows.len()),
                |row| model.row_named(*row),
            );
            // Beyond any tolerance are also numbers that are none.
            (value.is_nan() || value.abs() > *tolerance).then(|| {
                format!("the start violates {name}{what} by {value:e} where {tolerance:e} is rounding")
            })
        })
    };
    violated(&phi, &tolerances.phi, "").or_else(|| violated(&rates, &tolerances.rates, ", its rate,"))
}

/// The start in joint coordinates must be the assembled one too: as turned, and leading to the same state but for the
/// sign of Euler parameters.
fn joint_start_differs(model: &Model, module: &Module) -> Option<String> {
    let (layout, assembled) = (module.joints.as_ref()?, model.assemble().ok()?);
    let precision = Precision::new();
    let number = |x: f64| Real::new(&precision, x);
    let joints: Vec<_> = module.joint_start.iter().map(|&x| number(x)).collect();
    let point = point(model, &precision, &module.start, 0.0, number);
    let constants = interpreter::constants(&precision, module);
    let given = Given { point: &point, accelerations: &[], charts: &[], changes: &[], joints: &joints };
    let program = &module.programs["to_maximal"];
    let Ok(state) = interpreter::run(module, program, &constants, &Elementary, &given) else {
        return Some("the start in joint coordinates leads nowhere".to_owned());
    };
    let state: Vec<f64> = state.iter().map(Real::to_f64).collect();
    let largest = |numbers: &[f64]| numbers.iter().fold(1.0, |a: f64, b| a.max(b.abs()));
    let is_near = |a: f64, b: f64, scale: f64| (a - b).abs() <= START_TOLERANCE * scale;
    let turned = layout.places.iter().all(|place| match place.of {
        Freedom::Scalar(on) | Freedom::Turn(on) => {
            let expected = assembled.joints[on.joint].position[on.coordinate];
            is_near(module.joint_start[place.x], expected, largest(&[expected]))
        }
        Freedom::State(state) => module.joint_start[place.x] == assembled.states[state],
        Freedom::Orientation { .. } | Freedom::Body { .. } => true,
    });
    // An angle that others determine is assembled in `f64`: after many turns it is known less well.
    let determined = largest(&positions_elsewhere(model, layout, &assembled));
    let n = model.coordinate_bodies().len();
    let (found, expected) = (state[..7 * n].chunks(7), module.start[..7 * n].chunks(7));
    let reach = largest(&module.start[..7 * n]);
    let placed = found.zip(expected).all(|(found, expected)| {
        let euler = found[3..].iter().zip(&expected[3..]);
        let is_same = |sign: f64| euler.clone().all(|(a, b)| is_near(sign * a, *b, determined));
        found[..3].iter().zip(&expected[..3]).all(|(a, b)| is_near(*a, *b, reach))
            && (is_same(1.0) || is_same(-1.0))
    });
    let (found, expected) = (&state[7 * n..], &module.start[7 * n..]);
    let fastest = largest(expected);
    let moves = found.iter().zip(expected).all(|(a, b)| is_near(*a, *b, fastest));
    (!(turned && placed && moves))
        .then(|| "the start in joint coordinates is not what the model assembles".to_owned())
}

/// The coordinates of joints that are not in the joint state.
fn positions_elsewhere(model: &Model, layout: &JointLayout, start: &Start) -> Vec<f64> {
    let of_joint = |joint: usize| {
        let coordinates = 0..model.joints[joint].kind.coordinates().len();
        let elsewhere = coordinates
            .filter(move |&coordinate| layout.scalar(JointCoordinate { joint, coordinate }).is_none());
        elsewhere.map(move |coordinate| start.joints[joint].position[coordinate])
    };
    (0..model.joints.len()).flat_map(of_joint).collect()
}

/// Angles are proved up to a factor: here it must be positive.
fn wrong_signs(model: &Model, module: &Module, seed: Seed) -> Option<String> {
    let (tape, textbook) = (Tape::new(), Textbook::new(model));
    let angles = angles(model, &textbook, &tape)?;
    let formulas = tape.finish();
    let reach = formulas.reach(angles.iter().flat_map(|(_, ids)| *ids));
    let constants: Vec<f64> = interpreter::constants((), module);
    let mut random = seed.numbers(0);
    let places = places(model, module, seed).into_iter().map(|place| place.state);
    let states: Vec<_> = (0..STATES).map(|_| random_state(model, &mut random)).chain(places).collect();
    for state in states {
        let point = point(model, (), &state, random.random_range(-1.0..1.0), |x| x);
        let given = Given { point: &point, accelerations: &[], charts: &[], changes: &[], joints: &[] };
        let program = &module.programs["read_joints"];
        let Ok(found) = interpreter::run(module, program, &constants, &Elementary, &given) else { continue };
        let values = formulas.evaluate(&reach, (), &Elementary, &|source| read(&point, source));
        for (place, ids) in &angles {
            let [Some(sine), Some(cosine)] = ids.map(|id| values[id]) else { continue };
            // Off the constraints a reading may vanish.
            let vanishes = sine.abs() + cosine.abs() < VANISHING;
            if !vanishes && sine * found[*place] + cosine * found[place + 1] <= 0.0 {
                return Some("an angle is read with the wrong sign".to_owned());
            }
        }
    }
    None
}

/// Of each angle where its reading starts, and its sine and cosine.
fn angles(model: &Model, textbook: &Textbook, tape: &Tape) -> Option<Vec<(usize, [Id; 2])>> {
    let point = point_of_terms(model, tape);
    let (mut angles, mut place) = (Vec::new(), 0);
    for reading in textbook.at(&point, &Written)?.readings()? {
        place += match reading {
            Reading::Angle { sine, cosine, .. } => {
                angles.push((place, [sine.id(), cosine.id()]));
                3
            }
            Reading::Length(numbers) => numbers.len(),
            Reading::Orientation(numbers) => numbers.len(),
        };
    }
    Some(angles)
}

fn read<F: Field>(point: &Point<F>, source: Source) -> F {
    point.given(source).cloned().expect("the textbook reads what the model says there is")
}
