//! Messages for failures, with names instead of indices.

use crate::advice::{Advice, try_words};
use gyro_sim::{Error, JointLayout, JointPlace, Mechanism, Owner, Passage, contact};
use std::iter::repeat_n;
use std::{fmt, io};

/// Why a run has ended early.
#[derive(Debug)]
pub enum Failure {
    /// The run cannot be made as requested: the reason. No step was taken.
    Refused(String),
    /// The run itself.
    Run {
        /// Time, joint or body, and number.
        words: String,
        /// What to try.
        advice: Vec<Advice>,
    },
    /// The run itself, of which a program that linearises can tell more: time, joint or body, and number.
    Unexplained(String),
    /// The request could not be read.
    Input(io::Error),
    /// The samples could not be handed on.
    Output(io::Error),
}

impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Self {
        Self::Output(error)
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Refused(words) | Self::Unexplained(words) => f.write_str(words),
            Self::Run { words, advice } => write!(f, "{words}{}", try_words(advice)),
            Self::Input(error) => write!(f, "the request cannot be read: {error}"),
            Self::Output(error) => write!(f, "samples cannot be written: {error}"),
        }
    }
}

impl std::error::Error for Failure {}

impl Failure {
    /// A failure about which nothing can be done by other options.
    pub(crate) fn run(words: String) -> Self {
        Self::Run { words, advice: Vec::new() }
    }
}

/// The message of an error: when, which part and how much.
pub fn describe<M: Mechanism>(mechanism: &M, error: impl Into<contact::Error>) -> String {
    describe_in(mechanism, None, error)
}

/// What an error says besides where steps of fixed length had passed a singular pose before.
pub(crate) fn behind<M: Mechanism>(mechanism: &M, passage: &Passage) -> String {
    let whose = passage.owner.map_or(String::new(), |owner| {
        format!(", where the constraints of {} depend on others", name(mechanism, owner))
    });
    format!("; before, at t = {} s, the steps had passed a singular pose{whose}", passage.t)
}

/// The same for a motion in joint coordinates, if a layout is given.
pub fn describe_in<M: Mechanism>(
    mechanism: &M,
    layout: Option<&JointLayout<'_>>,
    error: impl Into<contact::Error>,
) -> String {
    let element = |index: &u16| match layout {
        None => element(mechanism, usize::from(*index)),
        Some(layout) => joint_element(mechanism, layout, usize::from(*index)),
    };
    match error.into() {
        contact::Error::Solver(error) => solver_error(mechanism, element, &error),
        contact::Error::Jammed { t, index, gain } if gain < 1.0 => format!(
            "at t = {t} s no motion is consistent with stops and friction, among them those on {}",
            element(&index).trim_start_matches("the position of ")
        ),
        contact::Error::Jammed { t, index, gain } => format!(
            "at t = {t} s friction on {} may jam: a unit of it adds up to {gain:.4e} to itself by way of the reactions \
             that it grows with, and from 1 on there may be no motion, or several; lower its coefficient or radius",
            element(&index).trim_start_matches("the position of ")
        ),
    }
}

/// The message of an error that has nothing to do with contacts; `element` names an element of the state.
fn solver_error<M: Mechanism>(mechanism: &M, element: impl Fn(&u16) -> String, error: &Error) -> String {
    match error {
        Error::NotFinite { t, index } => format!("at t = {t} s {} is no longer finite", element(index)),
        Error::StepTooShort { t, step, index } => format!(
            "at t = {t} s {} would need steps as short as {step:e} s for this tolerance",
            element(index)
        ),
        Error::Setting { setting, value } => format!("{setting} = {value} s is not a valid step length"),
        Error::InvalidEndTime { t, t_end } => format!(
            "cannot go from t = {t} s to t = {t_end} s: the time is not finite or lies outside the last step"
        ),
        Error::TooManySteps { t, steps } => format!("at t = {t} s the budget of {steps} steps is used up"),
        Error::Stiff { t, rate, step } => format!(
            "at t = {t} s a rate of {rate:.4e}/s allows this method steps of no more than {step:.3e} s, too many for its budget"
        ),
        Error::Tolerance { relative, smallest, .. } => format!(
            "a tolerance of {relative:e} cannot be met: at least {smallest:.1e} in this precision, and finite"
        ),
        Error::NoConvergence { t, violation, owner } => format!(
            "at t = {t} s the constraints of {} cannot be met: {violation:e} remains after Newton's iterations",
            name(mechanism, *owner)
        ),
        Error::Singular { t, pivot, owner } => {
            let whose = owner.map_or(String::new(), |owner| {
                format!(", where the constraints of {} depend on others", name(mechanism, owner))
            });
            format!(
                "at t = {t} s the dependent coordinates cannot be solved for: a pivot is {pivot:e}; the mechanism is in \
                 a singular pose{whose}, or the step is too large"
            )
        }
        Error::Jump { t, change, limit, owner } => format!(
            "at t = {t} s the constraints of {} can be met only by a change of {change:e} where {limit:e} is safe: the \
             mechanism is near a singular pose and might go on in another way than it came, or the step is too large",
            name(mechanism, *owner)
        ),
    }
}

fn name<M: Mechanism>(mechanism: &M, owner: Owner) -> String {
    match owner {
        Owner::Body(body) => format!("body `{}`", mechanism.description().bodies[usize::from(body)]),
        Owner::Joint(joint) => format!("joint `{}`", mechanism.description().joints[usize::from(joint)].name),
        Owner::Coupler(coupler) => {
            format!("coupler or constraint `{}`", mechanism.description().couplers[usize::from(coupler)])
        }
        Owner::Driver(driver) => format!("driver `{}`", mechanism.description().drivers[usize::from(driver)]),
    }
}

/// What an element of the state is: `(r, p)` of each body, `(s, w')` of each body, work, turn references.
fn element<M: Mechanism>(mechanism: &M, index: usize) -> String {
    let positions = 7 * mechanism.description().bodies.len();
    let velocities = positions + 6 * mechanism.description().bodies.len();
    let (body, what) = if index < positions {
        (index / 7, if index % 7 < 3 { "position" } else { "orientation" })
    } else if index < velocities {
        let k = index - positions;
        (k / 6, if k % 6 < 3 { "velocity" } else { "angular velocity" })
    } else {
        return "the work done, a state of the model file's own, the count of a joint's turns or the formula of an event".to_owned();
    };
    format!("the {what} of body `{}`", mechanism.description().bodies[body])
}

/// What an element of the joint state is: coordinates, then their rates, then the work.
fn joint_element<M: Mechanism>(mechanism: &M, layout: &JointLayout<'_>, index: usize) -> String {
    let places = layout.places.iter();
    let positions = places.clone().flat_map(|place| repeat_n((place, "position"), place.n_coordinates()));
    let rates = places.flat_map(|place| repeat_n((place, "rate"), place.n_rates()));
    match positions.chain(rates).nth(index) {
        Some((
            JointPlace::Scalar { joint, .. }
            | JointPlace::Orientation { joint }
            | JointPlace::Turn { joint, .. },
            what,
        )) => {
            format!("the {what} of {}", name(mechanism, Owner::Joint(*joint)))
        }
        Some((JointPlace::Body { body }, what)) => {
            format!("the {what} of {}", name(mechanism, Owner::Body(*body)))
        }
        Some((JointPlace::State { .. }, _)) => "a state of the model file's own".to_owned(),
        None => "the work done".to_owned(),
    }
}

#[cfg(test)]
mod tests;
