//! What a mechanism's functions in joint coordinates must satisfy.
//!
//! `y = to_maximal(x)` satisfies all rows but those that close loops, and the joint coordinates that the textbook
//! reads off it are those that it was made of. So its velocities v depend on u through a matrix `B = ∂v/∂u` of full
//! column rank, whose columns are all that these velocity rows leave free. Then the accelerations of eq. (17) are
//! the v̇ that satisfy the second derivative of all rows, `Φ_r s̈ + Φ_π' ẇ' = γ`, and leave to the constraints only
//! what does no work on any free motion that keeps loops closed: with J of [`closure`], whose rows must be
//! independent or yield ([`dependence`]), `Bᵀ (M v̇ − f) = −Jᵀ λ` for some λ, the multipliers of the rows that
//! close loops. Of trees, which have no such rows, nothing is left and multipliers are not needed. B and v̇ are
//! derivatives of `to_maximal` by dual numbers.

use super::case::{Arguments, Case};
use super::closure::{self, of_closure};
use super::dependence;
use super::elimination::Eliminated;
use super::partition::{dot, turning};
use super::residuals::{differences, position_rates};
use crate::atoms::Atoms;
use crate::field::Field;
use crate::joints::{Freedom, JointLayout};
use crate::point::{Point, first_state};
use crate::program::Source;
use crate::tape::{Term, Written};
use crate::textbook::Reading;
use gyro_model::{JointCoordinate, RowOwner};

/// A joint state on its way.
pub(super) struct Motion<'c, 'a> {
    case: &'c Case<'a>,
    layout: &'a JointLayout,
    /// Its maximal state.
    pub maximal: Point<Term<'a>>,
    /// u̇.
    pub rates_of_rates: Vec<Term<'a>>,
    /// `(ẋ, u̇ [, power])`.
    derivative: Vec<Term<'a>>,
    /// How the maximal state changes along it.
    maximal_rates: Vec<Term<'a>>,
}

impl<'c, 'a> Motion<'c, 'a> {
    pub fn new(case: &'c Case<'a>) -> Option<Self> {
        Self::with(case, case.run("joint_accelerations", &case.point))
    }

    /// The same at other accelerations of the joints.
    pub(super) fn with(case: &'c Case<'a>, rates_of_rates: Vec<Term<'a>>) -> Option<Self> {
        let layout = case.module.joints.as_ref()?;
        let derivative = case.run_with("joint_derivative", &case.point, &rates_of_rates);
        let one = Term::one(case.point.context);
        let [state, maximal_rates] =
            case.run_along("to_maximal", case.given(&case.point), &|source| match source {
                Source::Joint(k) => derivative.get(k).copied(),
                Source::Time => Some(one),
                Source::Input(k) => case.rate_of_input(k),
                _ => None,
            })?;
        let maximal = Point { state, ..case.point.clone() };
        Some(Self { case, layout, maximal, rates_of_rates, derivative, maximal_rates })
    }

    /// (s̈, ẇ') body after body.
    pub fn accelerations(&self) -> &[Term<'a>] {
        velocities(self.case, &self.maximal_rates)
    }

    /// What is left of `Bᵀ (M v̇ − f) = −Jᵀ λ` for any λ, with numbers that exist where the rows of J are independent;
    /// and λ.
    pub(super) fn balance(&self) -> Option<[Vec<Term<'a>>; 2]> {
        let (case, context) = (self.case, self.case.point.context);
        let imbalance = case.textbook(&self.maximal)?.imbalance(self.accelerations())?;
        let along = |column: Vec<Term<'a>>| dot(&column, &imbalance);
        let mut taken: Vec<_> = free_motions(case)?.into_iter().map(along).collect();
        if self.layout.closure_rows.is_empty() {
            return Some([taken, Vec::new()]);
        }
        let mut jacobian = closure::jacobian(case, self.layout)?;
        let yielding = dependence::yielding(case, self.layout, &jacobian)?;
        if !yielding.is_empty() {
            // `J u̇ − γ = Q λ` beside it.
            jacobian = dependence::beside(&jacobian, &yielding, &dependence::lightness(case));
            let missed = case.textbook(&self.maximal)?.residual_of_rows(self.accelerations())?;
            taken.extend(of_closure(self.layout, &missed).iter().map(Field::neg));
        }
        let Some(jacobian) = Eliminated::of(case, &jacobian) else {
            return Some([
                vec![Term::one(context)],
                vec![Term::zero(context); self.layout.closure_rows.len()],
            ]);
        };
        let (rest, factors) = jacobian.split(context, &taken);
        let lambda = factors.iter().map(Field::neg).collect();
        Some([[rest, jacobian.independence(context)].concat(), lambda])
    }

    /// Power of non-conservative forces and drivers; nothing where the state carries no work. Drivers do `−λᵀν`, where
    /// eq. (18) is not satisfied for the rows that close loops.
    fn power(&self) -> Option<Vec<Term<'a>>> {
        if !self.layout.has_work {
            return Some(Vec::new());
        }
        let textbook = self.case.textbook(&self.maximal)?;
        let [forces, drivers] = textbook.power_of_motion(self.accelerations())?;
        let mut power = forces.add(&drivers);
        if !self.layout.closure_rows.is_empty() {
            let [_, lambda] = self.balance()?;
            power = power.add(&dot(&lambda, &of_closure(self.layout, &textbook.velocity_residual()?)));
        }
        Some(vec![power])
    }
}

/// B by columns.
pub(super) fn free_motions<'a>(case: &Case<'a>) -> Option<Vec<Vec<Term<'a>>>> {
    let layout = case.module.joints.as_ref()?;
    let one = Term::one(case.point.context);
    let column = |rate: usize| {
        let only = |source| (source == Source::Joint(layout.n_coordinates + rate)).then_some(one);
        let [_, rates] = case.run_along("to_maximal", case.given(&case.point), &only)?;
        Some(velocities(case, &rates).to_vec())
    };
    (0..layout.n_rates).map(column).collect()
}

/// The velocities of a state.
pub(super) fn velocities<'s, F>(case: &Case<'_>, state: &'s [F]) -> &'s [F] {
    let n = case.n_bodies();
    &state[7 * n..13 * n]
}

/// The joint state with Euler parameters of length one: it is of the same motion.
fn normalised<'a>(case: &Case<'a>, layout: &JointLayout) -> Option<Vec<Term<'a>>> {
    let mut joints = case.joints.clone();
    for start in layout.euler() {
        let p = &mut joints[start..start + 4];
        let scale = Written.sqrt(&dot(p, p)).inv()?;
        p.iter_mut().for_each(|e| *e = e.mul(&scale));
    }
    Some(joints)
}

/// The state satisfies the constraints but those that close loops; Euler parameters being normalised, the coordinates,
/// rates and work that it has are those given, and its turn references the continuous angles.
pub fn to_maximal<'a>(case: &Case<'a>) -> Option<Vec<Term<'a>>> {
    let layout = case.module.joints.as_ref()?;
    let (maximal, joints) = (case.maximal(&case.joints), normalised(case, layout)?);
    let textbook = case.textbook(&maximal)?;
    let satisfied = |rows: Vec<Term<'a>>| {
        let rows = rows.into_iter().enumerate();
        rows.filter(|(row, _)| !layout.closure_rows.contains(row)).map(|(_, residual)| residual)
    };
    let mut residuals: Vec<_> = satisfied(textbook.phi()?).collect();
    residuals.extend(satisfied(textbook.velocity_residual()?));
    for place in &layout.places {
        let (coordinates, rates) = place.of.sizes();
        let x = &joints[place.x..place.x + coordinates];
        let u = &joints[layout.n_coordinates + place.u..][..rates];
        let (found, expected) = match place.of {
            Freedom::Scalar(on) => match textbook.reading(on)? {
                Reading::Angle { sine, cosine, rate } => {
                    (vec![sine, cosine, rate], vec![Written.sin(&x[0]), Written.cos(&x[0]), u[0]])
                }
                Reading::Length(numbers) => (numbers.to_vec(), [x, u].concat()),
                Reading::Orientation(numbers) => (numbers.to_vec(), [x, u].concat()),
            },
            Freedom::Orientation { joint } => match textbook.orientation(joint) {
                Reading::Orientation(numbers) => (numbers.to_vec(), [x, u].concat()),
                _ => return None,
            },
            Freedom::Turn(_) => continue,
            Freedom::State(state) => (vec![*maximal.own_state(case.model, state)], x.to_vec()),
            Freedom::Body { moving_body } => {
                let found = [maximal.position(moving_body), maximal.velocity(case.model, moving_body)];
                (found.concat(), [x, u].concat())
            }
        };
        residuals.extend(differences(&found, &expected));
    }
    let work = &maximal.state[13 * case.n_bodies()..first_state(case.model)];
    residuals.extend(differences(work, &case.joints[layout.n_motion()..]));
    for (place, turn) in case.model.turn_references().into_iter().enumerate() {
        let found = maximal.turn_reference(case.model, place);
        let Some(place) = layout.scalar(turn).or_else(|| layout.turn(turn)) else {
            residuals.extend(angle_differs(case, layout, textbook.reading(turn)?, turn, found));
            continue;
        };
        residuals.push(found.sub(&case.joints[place]));
    }
    Some(residuals)
}

/// That a turn reference of which x has no coordinate is the angle that is read. (It moves as the angle does, which is
/// part of the claim about the derivative, and at the start it is the assembled one: so it is as turned.)
fn angle_differs<'a>(
    case: &Case<'a>,
    layout: &JointLayout,
    reading: Reading<Term<'a>>,
    turn: JointCoordinate,
    found: &Term<'a>,
) -> Vec<Term<'a>> {
    let Reading::Angle { sine, cosine, .. } = reading else { return vec![Term::one(case.point.context)] };
    let (sine_found, cosine_found) = (Written.sin(found), Written.cos(found));
    let mut rows = case.model.rows_of(RowOwner::Joint(turn.joint));
    if rows.any(|row| layout.closure_rows.contains(&row)) {
        // Of a joint that is torn sine and cosine are read up to a factor.
        return vec![sine.mul(&cosine_found).sub(&cosine.mul(&sine_found))];
    }
    differences(&[sine, cosine], &[sine_found, cosine_found])
}

/// At any state all but angles are what the textbook reads off it. Angles change as the textbook's do, however the
/// buffer changes, and of the state of (x, u) they are x if the buffer holds x: so the buffer does nothing but choose
/// among the turns.
pub fn to_joints<'a>(case: &Case<'a>) -> Option<Vec<Term<'a>>> {
    let layout = case.module.joints.as_ref()?;
    let maximal = case.maximal(&case.joints);
    let mut residuals = differences(&case.run("to_joints", &maximal), &normalised(case, layout)?);
    let textbook = case.textbook(&case.point)?;
    let (rates, one) = (textbook.position_rates(), Term::one(case.point.context));
    // The buffer changes by its own next elements: as good as any other numbers.
    let next = |k: usize| case.before[(k + 1) % case.before.len()];
    let buffer = Arguments { joints: &case.before, ..case.given(&case.point) };
    // Velocities change as they like: no angle depends on them.
    let any = |k: usize| case.motion.get(k - rates.len()).copied();
    let [found, found_rates] = case.run_along("to_joints", buffer, &|source| match source {
        Source::State(k) => rates.get(k).copied().or_else(|| any(k)),
        Source::Joint(k) => Some(next(k)),
        Source::Time => Some(one),
        Source::Input(k) => case.rate_of_input(k),
        _ => None,
    })?;
    for place in &layout.places {
        let (coordinates, rates) = place.of.sizes();
        let u = &found[layout.n_coordinates + place.u..][..rates];
        let all = [&found[place.x..place.x + coordinates], u].concat();
        let expected = match place.of {
            Freedom::Scalar(on) => match textbook.reading(on)? {
                Reading::Angle { rate, .. } => {
                    residuals.push(found_rates[place.x].sub(&textbook.angle_rate(on)?));
                    vec![all[0], rate]
                }
                Reading::Length(numbers) => numbers.to_vec(),
                Reading::Orientation(numbers) => numbers.to_vec(),
            },
            Freedom::Orientation { joint } => match textbook.orientation(joint) {
                Reading::Orientation(numbers) => numbers.to_vec(),
                _ => return None,
            },
            Freedom::State(state) => vec![*case.point.own_state(case.model, state)],
            Freedom::Turn(on) => vec![*case.point.turn_reference(case.model, case.turn(on)?)],
            Freedom::Body { moving_body } => {
                [case.point.position(moving_body), case.point.velocity(case.model, moving_body)].concat()
            }
        };
        residuals.extend(differences(&all, &expected));
    }
    let work = &case.point.state[13 * case.n_bodies()..][..usize::from(layout.has_work)];
    residuals.extend(differences(&found[layout.n_motion()..], work));
    Some(residuals)
}

/// `Φ_r s̈ + Φ_π' ẇ' = γ`, but for what dependent rows yield, and `Bᵀ (M v̇ − f) = −Jᵀ λ`. (That rows and free
/// motions make up the whole is part of the layout.)
pub fn accelerations<'a>(case: &Case<'a>) -> Option<Vec<Term<'a>>> {
    let motion = Motion::new(case)?;
    let textbook = case.textbook(&motion.maximal)?;
    let mut residuals = textbook.residual_of_rows(motion.accelerations())?;
    if !case.model.dependent_rows().is_empty() {
        let mut row = 0..;
        residuals.retain(|_| !motion.layout.closure_rows.contains(&row.next().expect("endless")));
    }
    let [balance, _] = motion.balance()?;
    residuals.extend(balance);
    Some(residuals)
}

/// The state moves as the textbook says; u̇ are the accelerations just proved.
pub fn derivative<'a>(case: &Case<'a>) -> Option<Vec<Term<'a>>> {
    let motion = Motion::new(case)?;
    let (textbook, n) = (case.textbook(&motion.maximal)?, case.n_bodies());
    let (rates, layout) = (&motion.maximal_rates, motion.layout);
    let mut residuals = differences(&rates[..7 * n], &textbook.position_rates());
    residuals.extend(differences(&rates[first_state(case.model)..], &textbook.other_rates()?));
    let (found, rest) = motion.derivative[layout.n_coordinates..].split_at(layout.n_rates);
    residuals.extend(differences(found, &motion.rates_of_rates));
    residuals.extend(differences(rest, &motion.power()?));
    residuals.extend(coordinate_rates(case, layout, &motion.derivative));
    Some(residuals)
}

/// `ẋ`: of Euler parameters of any length `½ G(p)ᵀ u`.
fn coordinate_rates<'a>(case: &Case<'a>, layout: &JointLayout, found: &[Term<'a>]) -> Vec<Term<'a>> {
    let joints = &case.joints;
    let mut residuals = Vec::new();
    for place in &layout.places {
        let (coordinates, rates) = place.of.sizes();
        let u = &joints[layout.n_coordinates + place.u..][..rates];
        let found = &found[place.x..place.x + coordinates];
        if let Freedom::Turn(_) | Freedom::State(_) = place.of {
            // It moves as that of the maximal state.
            continue;
        }
        let Some(euler) = place.of.euler() else {
            residuals.extend(differences(found, u));
            continue;
        };
        let (shift, spin) = u.split_at(rates - 3);
        let [x, y, z] = [0, 1, 2].map(|k| spin[k]);
        residuals.extend(differences(&found[..euler], shift));
        let twice: Vec<_> = found[euler..].iter().map(|e| e.add(e)).collect();
        residuals.extend(differences(&twice, &turning(&joints[place.x + euler..][..4], &[x, y, z])));
    }
    residuals
}

/// u̇ at the state of (x, u).
pub fn accelerations_at<'a>(case: &Case<'a>) -> Option<Vec<Term<'a>>> {
    let motion = Motion::new(case)?;
    let found = case.run("joint_accelerations_at", &motion.maximal);
    Some(differences(&found, &motion.rates_of_rates))
}

/// v̇ there.
pub fn corrected_accelerations<'a>(case: &Case<'a>) -> Option<Vec<Term<'a>>> {
    let motion = Motion::new(case)?;
    let found = case.run("corrected_accelerations", &motion.maximal);
    Some(differences(&found, motion.accelerations()))
}

/// At any state what does not depend on multipliers, there the power too.
pub fn corrected_derivative<'a>(case: &Case<'a>) -> Option<Vec<Term<'a>>> {
    let motion = Motion::new(case)?;
    let mut residuals = Vec::new();
    for (point, power) in [(&case.point, None), (&motion.maximal, Some(motion.power()?))] {
        let accelerations = case.run("corrected_accelerations", point);
        let found = case.run_with("corrected_derivative", point, &accelerations);
        let textbook = case.textbook(point)?;
        let (moved, rest) = found.split_at(13 * case.n_bodies());
        residuals.extend(differences(moved, &[textbook.position_rates(), accelerations].concat()));
        let (work, others) = rest.split_at(usize::from(motion.layout.has_work));
        residuals.extend(power.iter().flat_map(|power| differences(work, power)));
        residuals.extend(differences(others, &textbook.other_rates()?));
    }
    residuals.extend(position_rates(case, "corrected_derivative")?);
    Some(residuals)
}

/// v̇ and λ there.
pub fn corrected_solution<'a>(case: &Case<'a>) -> Option<Vec<Term<'a>>> {
    let motion = Motion::new(case)?;
    let found = case.run("corrected_solution", &motion.maximal);
    let (accelerations, lambda) = found.split_at(6 * case.n_bodies());
    let textbook = case.textbook(&motion.maximal)?;
    let mut residuals = differences(accelerations, motion.accelerations());
    residuals.extend(textbook.residual_of_motion(motion.accelerations(), lambda)?);
    Some(residuals)
}

/// λ there, and at v̇.
pub fn corrected_multipliers<'a>(case: &Case<'a>) -> Option<Vec<Term<'a>>> {
    let motion = Motion::new(case)?;
    let lambda = case.run_with("corrected_multipliers", &motion.maximal, motion.accelerations());
    case.textbook(&motion.maximal)?.residual_of_motion(motion.accelerations(), &lambda)
}

/// ∂f/∂x row by row, then ∂f/∂t.
pub fn jacobian<'a>(case: &Case<'a>) -> Option<Vec<Term<'a>>> {
    let by_state = derivatives(case, (0..case.joints.len()).map(Source::Joint))?;
    let by_time = derivatives(case, [Source::Time].into_iter())?;
    Some(differences(&case.run("joint_jacobian", &case.point), &[by_state, by_time].concat()))
}

/// ∂f/∂(inputs) row by row.
pub fn input_jacobian<'a>(case: &Case<'a>) -> Option<Vec<Term<'a>>> {
    let by_inputs = derivatives(case, (0..case.model.inputs.len()).map(Source::Input))?;
    Some(differences(&case.run("joint_input_jacobian", &case.point), &by_inputs))
}

/// ∂f/∂(parameters) row by row.
pub fn parameter_jacobian<'a>(case: &Case<'a>) -> Option<Vec<Term<'a>>> {
    let by_parameters = derivatives(case, (0..case.model.parameters.len()).map(Source::Parameter))?;
    Some(differences(&case.run("joint_parameter_jacobian", &case.point), &by_parameters))
}

/// The matrix of the derivatives of `joint_derivative`, with the u̇ that it has computed first, by rows.
fn derivatives<'a>(case: &Case<'a>, by: impl Iterator<Item = Source>) -> Option<Vec<Term<'a>>> {
    let one = Term::one(case.point.context);
    let columns = by.map(|source| {
        let only = |read: Source| (read == source).then_some(one);
        let [rates, of_rates] = case.run_along("joint_accelerations", case.given(&case.point), &only)?;
        let given = Arguments { accelerations: &rates, ..case.given(&case.point) };
        let [_, column] = case.run_along("joint_derivative", given, &|read| match read {
            Source::Acceleration(k) => Some(of_rates[k]),
            read => only(read),
        })?;
        Some(column)
    });
    let columns = columns.collect::<Option<Vec<_>>>()?;
    let row = |k: usize| columns.iter().map(move |column| column[k]);
    Some((0..case.joints.len()).flat_map(row).collect())
}
