//! What a module must look like around its formulas: everything that the description alone determines.
//!
//! Function bodies are left open as `{ HOLE_name }`, counts that depend on formulas as `INT_name`, and arguments that a
//! body may leave unread as `ANY_name`.

mod contract;
mod definition;
mod indices;
mod mechanism;
mod partition;
mod pieces;

pub use mechanism::{n_readings, n_state};
pub use partition::Choice;

use crate::joints::JointLayout;
use contract::contract;
use definition::{constants, definition};
use gyro_model::{Model, Spline};
use gyro_program::Group;
use indices::indices;
use std::collections::BTreeSet;

/// What the description leaves to choice.
#[derive(Clone, Debug)]
pub struct Has {
    /// The traits that the module implements, of those that it may leave out.
    pub traits: BTreeSet<&'static str>,
    /// How the coordinate partition is chosen.
    pub choice: Choice,
    /// How accelerations at corrected states are found.
    pub corrected: Corrected,
    /// Whether there is a function of what depends on parameters alone.
    pub parameter_setup: bool,
}

/// How accelerations, and what goes with them, are found at states that satisfy the constraints.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Corrected {
    /// Whether the derivative of the state goes on from these accelerations; it is that at any state otherwise.
    pub has_derivative: bool,
    /// Whether accelerations at any state come with multipliers that are cut off.
    pub is_cut: bool,
}

impl Has {
    /// What a module's text is to be compared with.
    pub fn of(text: &str) -> Self {
        // A long name stands on a line of its own.
        let is_there = |name: &&str| {
            let of = format!("gyro_sim::{name}");
            text.match_indices(&of).any(|(at, _)| text[at + of.len()..].trim_start().starts_with("for "))
        };
        Self {
            traits: Group::all().map(Group::trait_name).filter(is_there).collect(),
            choice: if text.contains("gyro_sim::charts") { Choice::Charts } else { Choice::Joints },
            corrected: Corrected {
                has_derivative: !text.contains("gyro_sim::Dynamics::derivative(self"),
                is_cut: text.contains("out.copy_from_slice("),
            },
            parameter_setup: text.contains("fn parameter_setup("),
        }
    }

    /// Whether the module implements a trait.
    pub fn implements(&self, name: &str) -> bool {
        self.traits.contains(name)
    }
}

/// The expected text.
pub fn text(
    model: &Model,
    type_name: &str,
    tables: &[Spline],
    has: &Has,
    joints: Option<&JointLayout>,
) -> String {
    [
        constants(tables),
        definition(model, type_name, has.parameter_setup),
        contract(model, type_name, has, joints),
        indices(model, joints),
    ]
    .concat()
}

/// `gyroscope_maximal` to `GyroscopeMaximal`; a name that Rust or the module needs otherwise gets an underscore.
pub fn type_name(name: &str) -> String {
    let words = name.split('_').filter(|word| !word.is_empty());
    let name: String = words.map(|word| word[..1].to_uppercase() + &word[1..]).collect();
    if ["Self", "T", "Parameters"].contains(&name.as_str()) { name + "_" } else { name }
}
