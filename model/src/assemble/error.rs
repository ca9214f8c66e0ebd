//! Why a model has no consistent start, or cannot move.

use std::fmt;

use crate::validate::{Owner, Place};
use crate::{RowOwner, RowUnit};

/// Why a model has no consistent start, or cannot be simulated from it.
#[derive(Clone, Debug, PartialEq)]
pub enum AssemblyError {
    /// No rate of its joint gives a body the angular velocity that the model file asks for.
    AngularVelocity {
        /// Index into [`crate::Model::bodies`].
        body: usize,
        /// Name of the body.
        name: String,
        /// Name of the joint that holds it.
        joint: String,
        /// Absolute angular velocity in the body's frame, as asked for, rad/s.
        wanted: [f64; 3],
        /// The nearest one that the joint allows, rad/s.
        nearest: [f64; 3],
    },
    /// A body is neither fixed nor free, and no joint leads to it.
    Unconnected {
        /// Index into [`crate::Model::bodies`].
        body: usize,
        /// Name of the body.
        name: String,
    },
    /// A position or velocity of a body is infinite or not a number, or so large that its square would be.
    NotFinite {
        /// Index into [`crate::Model::bodies`].
        body: usize,
        /// Name of the body.
        name: String,
    },
    /// No pose near the guess satisfies all constraints.
    Impossible {
        /// The owner of the row that remains violated most.
        owner: RowOwner,
        /// Kind and name of the owner: ``joint `x` ``.
        name: String,
        /// The smallest violation that was reached.
        residual: f64,
        /// Unit of the residual.
        unit: RowUnit,
    },
    /// The mechanism closes, but not with a joint's coordinate where the model file holds it.
    Held {
        /// Index into [`crate::Model::joints`].
        joint: usize,
        /// Name of the joint.
        name: String,
        /// Which of its coordinates; "orientation" of a spherical joint.
        coordinate: &'static str,
        /// By how much it would have to change: rad or m.
        off_by: f64,
        /// Where the mechanism closes; `None` for an orientation.
        nearest: Option<f64>,
        /// Unit of both.
        unit: &'static str,
    },
    /// The constraints are satisfied on the wrong side: two axes or zero directions point in opposite directions.
    Flipped {
        /// Index into [`crate::Model::joints`].
        joint: usize,
        /// Name of the joint.
        name: String,
        /// Which direction is reversed: `"axis"` or `"zero"`.
        direction: &'static str,
    },
    /// The mechanism closes only far from its guess.
    Jump {
        /// Index into [`crate::Model::bodies`].
        body: usize,
        /// Name of the body.
        name: String,
        /// Angle by which the body would be turned, rad.
        turned: f64,
        /// Joint coordinates where it would close, as text for a message.
        coordinates: String,
    },
    /// The mechanism closes, but only beyond a pose in which the branch of its guess meets another one.
    OtherBranch {
        /// Index into [`crate::Model::bodies`]: the body that is turned most.
        body: usize,
        /// Name of the body.
        name: String,
        /// Angle by which the body would be turned, rad.
        turned: f64,
        /// Joint coordinates where it would close, as text for a message.
        coordinates: String,
    },
    /// No velocities satisfy the constraints together with the rates of the drivers and of the model file.
    Rate {
        /// The owner of the rate with the largest error.
        owner: RowOwner,
        /// Kind and name of the owner: ``joint `x` ``.
        name: String,
        /// The smallest error that was reached, m/s or rad/s.
        residual: f64,
        /// Unit of the row: the residual is in this per second.
        unit: RowUnit,
        /// Whether a rate that the model file gives is at fault, rather than the constraints themselves.
        is_given: bool,
    },
    /// The two ends of a link coincide, so that its force has no direction.
    Link {
        /// Index into [`crate::Model::forces`].
        force: usize,
        /// Name of the force.
        name: String,
    },
    /// The mass centre of a body is where the central body of gravity is, whose attraction has no direction there.
    Attracted {
        /// Index into [`crate::Model::bodies`].
        body: usize,
        /// Name of the body.
        name: String,
    },
    /// No value near zero gives a state the rate zero.
    Restless {
        /// Index into [`crate::Model::states`].
        state: usize,
        /// Name of the state.
        name: String,
        /// The smallest rate that was reached.
        rate: f64,
    },
    /// A joint starts beyond a rigid stop.
    BeyondStop {
        /// Index into [`crate::Model::contacts`].
        contact: usize,
        /// Name of the contact.
        name: String,
        /// Name of the joint.
        joint: String,
        /// Which stop: `"lower"` or `"upper"`.
        key: &'static str,
        /// Where the joint starts.
        value: f64,
        /// Where the stop is.
        stop: f64,
        /// Unit of both: `"rad"` or `"m"`.
        unit: &'static str,
    },
    /// Nothing is left to move, and nothing drives it.
    OverConstrained {
        /// The last of what closes its loops.
        owner: RowOwner,
        /// All that closes its loops, each with its name: ``joint `x` ``.
        closing: Vec<String>,
    },
    /// A driver prescribes what is fixed without it.
    Driver {
        /// Index into [`crate::Model::drivers`].
        driver: usize,
        /// Name of the driver.
        name: String,
        /// What fixes its coordinate, each with its name.
        with: Vec<String>,
    },
    /// Rows that depend on others at the start contradict them as time goes on: driven bodies are tied together.
    Contradiction {
        /// The owner of the row that is violated most.
        owner: RowOwner,
        /// Kind and name of the owner: ``joint `x` ``.
        name: String,
        /// The time, s.
        time: f64,
        /// By how much.
        residual: f64,
        /// Unit of the residual.
        unit: RowUnit,
    },
}

impl AssemblyError {
    /// The part of the model file that is wrong, if there is one.
    pub(crate) fn place(&self) -> Option<Place> {
        match self {
            Self::AngularVelocity { body, .. } => Some(Place::body(*body, "angular_velocity")),
            Self::NotFinite { body, .. }
            | Self::Jump { body, .. }
            | Self::OtherBranch { body, .. }
            | Self::Attracted { body, .. }
            | Self::Unconnected { body, .. } => Some(Place::body(*body, "")),
            Self::Held { joint, .. } => Some(Place::joint(*joint, "")),
            Self::Link { force, .. } => Some(Place::force(*force, "")),
            Self::Restless { state, .. } => Some(Place { owner: Owner::State(*state), key: "start" }),
            Self::BeyondStop { contact, key, .. } => Some(Place { owner: Owner::Contact(*contact), key }),
            Self::Flipped { joint, direction, .. } => Some(Place::joint(*joint, direction)),
            Self::Impossible { owner, .. }
            | Self::Contradiction { owner, .. }
            | Self::OverConstrained { owner, .. } => Some(of_owner(*owner, "")),
            Self::Rate { owner, is_given, .. } => Some(of_owner(*owner, if *is_given { "rate" } else { "" })),
            Self::Driver { driver, .. } => Some(of_owner(RowOwner::Driver(*driver), "")),
        }
    }

    /// What to write instead.
    pub fn help(&self) -> String {
        match self {
            Self::AngularVelocity { joint, nearest, .. } => {
                format!(
                    "write angular_velocity = {nearest:?}, or leave it out and give joint `{joint}` a `rate`"
                )
            }
            Self::Unconnected { .. } => "add a [[joint]] that leads to it".to_owned(),
            Self::NotFinite { .. } => "give the joints that lead to it moderate lengths and rates".to_owned(),
            Self::Impossible { .. } => {
                "check lengths, points and axes; if the mechanism can close, start its joints closer to that pose"
                    .to_owned()
            }
            Self::Held { .. } => "correct it, leave it out, or write rough = true to make it an initial guess".to_owned(),
            Self::Flipped { direction: "axis", .. } => {
                "reverse the axis of one end, or start the joints near the intended pose".to_owned()
            }
            Self::Flipped { .. } => {
                "reverse the zero direction of one end, or start the joints near the intended pose".to_owned()
            }
            Self::Jump { .. } | Self::OtherBranch { .. } => {
                "start the joints near the intended pose; rough = true makes their values initial guesses".to_owned()
            }
            Self::Rate { is_given: true, .. } => "correct the rate, or leave it out".to_owned(),
            Self::Rate { .. } => "choose another start: from this pose no velocities are possible".to_owned(),
            Self::Link { .. } => "start the mechanism where the ends are apart, or move one of them; if they never separate, write a \
                                  force along the joint's coordinate (\"spring\" or \"damper\") instead"
                .to_owned(),
            Self::Attracted { .. } => {
                "start the body elsewhere, move the `centre` of gravity, or write fixed = true if nothing is to move it"
                    .to_owned()
            }
            Self::Restless { .. } => "write start = ..., a number".to_owned(),
            Self::BeyondStop { joint, key, stop, unit, .. } => {
                let side = if *key == "lower" { "or more" } else { "or less" };
                format!("start joint `{joint}` at {stop} {unit} {side}, or move the stop")
            }
            Self::OverConstrained { .. } => {
                "use joints with more degrees of freedom, or check that axes and lengths agree exactly".to_owned()
            }
            Self::Driver { .. } => "remove the driver, or whatever else fixes its coordinate".to_owned(),
            Self::Contradiction { .. } => "let the driven bodies move independently: use joints with more degrees of freedom".to_owned(),
        }
    }
}

fn of_owner(owner: RowOwner, key: &'static str) -> Place {
    let owner = match owner {
        RowOwner::Body(body) => {
            return Place::body(body, if key == "rate" { "angular_velocity" } else { key });
        }
        RowOwner::Joint(joint) => Owner::Joint(joint),
        RowOwner::Coupler(coupler) => Owner::Coupler(coupler),
        RowOwner::Driver(driver) => Owner::Driver(driver),
    };
    Place { owner, key }
}

/// A residual as a message shows it.
fn shown(residual: f64, unit: RowUnit) -> String {
    let unit = if unit == RowUnit::Length { " m" } else { "" };
    format!("{:.3e}{unit}", residual.abs())
}

impl fmt::Display for AssemblyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::AngularVelocity { name, joint, wanted, nearest, .. } => write!(
                f,
                "body `{name}` cannot start with angular velocity {wanted:?} rad/s: joint `{joint}` allows \
                 {nearest:?} at best"
            ),
            Self::Unconnected { name, .. } => write!(f, "body `{name}` is not connected"),
            Self::NotFinite { name, .. } => {
                write!(f, "the start of body `{name}` is too large to compute with")
            }
            Self::Impossible { name, residual, unit, .. } => write!(
                f,
                "the mechanism cannot be assembled from this start: {name} remains violated by {}",
                shown(*residual, *unit)
            ),
            Self::Held { name, coordinate, off_by, nearest, unit, .. } => {
                write!(f, "joint `{name}` cannot start with this {coordinate}: the mechanism closes ")?;
                match nearest {
                    Some(nearest) => write!(f, "at {nearest:.9} {unit}, {off_by:.3e} {unit} away"),
                    None => write!(f, "{off_by:.3e} {unit} away"),
                }
            }
            Self::Flipped { name, direction: "axis", .. } => {
                write!(
                    f,
                    "joint `{name}` would be assembled the wrong way round: its axes would point in opposite directions"
                )
            }
            Self::Flipped { name, .. } => write!(
                f,
                "joint `{name}` would be assembled the wrong way round: off by half a turn about its axis"
            ),
            Self::Jump { name, turned, coordinates, .. } => write!(
                f,
                "the mechanism closes only if body `{name}` is turned by {:.1} degrees from its guess{coordinates}",
                turned.to_degrees()
            ),
            Self::OtherBranch { name, turned, coordinates, .. } => write!(
                f,
                "the mechanism closes only on another branch than the one that its guess is on: body `{name}` would be \
                 turned by {:.1} degrees from its guess{coordinates}",
                turned.to_degrees()
            ),
            Self::Rate { name, residual, unit, is_given, .. } => {
                let unit = if *unit == RowUnit::Length { "m/s" } else { "rad/s" };
                let what =
                    if *is_given { "the start does not allow the rate of" } else { "no velocity satisfies" };
                write!(f, "{what} {name}: off by {:.3e} {unit}", residual.abs())
            }
            Self::BeyondStop { name, joint, key, value, stop, unit, .. } => write!(
                f,
                "joint `{joint}` starts at {value} {unit}, beyond the {key} stop of contact `{name}` at {stop} {unit}"
            ),
            Self::Restless { name, rate, .. } => write!(
                f,
                "state `{name}` cannot start at rest: no value was found at which its rate is zero, {rate:.3e} at best"
            ),
            Self::Link { name, .. } => {
                write!(f, "the two ends of link `{name}` coincide at the start: its force has no direction")
            }
            Self::Attracted { name, .. } => write!(
                f,
                "the mass centre of body `{name}` starts where the central body of gravity is: its attraction has no \
                 direction there"
            ),
            Self::OverConstrained { closing, .. } => write!(
                f,
                "the mechanism is over-constrained: nothing can move and nothing drives it; its loops are closed by {}",
                closing.join(", ")
            ),
            Self::Driver { name, with, .. } => write!(
                f,
                "driver `{name}` prescribes a coordinate that is already fixed by {}",
                with.join(", ")
            ),
            Self::Contradiction { name, time, residual, unit, .. } => write!(
                f,
                "the driven motions contradict the joints: at t = {time} s {name} is violated by {}",
                shown(*residual, *unit)
            ),
        }
    }
}

impl std::error::Error for AssemblyError {}
