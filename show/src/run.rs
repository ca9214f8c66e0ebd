//! Samples of a run.

use crate::Mechanism;
use serde::Serialize;

/// A run of a mechanism, shown under a name.
#[derive(Clone, Debug)]
pub struct Scene {
    /// What tells it from the other runs of a page.
    pub name: String,
    /// The mechanism, with the parameters of this run.
    pub mechanism: Mechanism,
    /// Its motion.
    pub run: Run,
}

/// The motion of all bodies, and quantities to plot.
#[derive(Clone, Debug, Default)]
pub struct Run {
    /// Times of the samples, s, ascending.
    pub times: Vec<f64>,
    /// Of each body `(r, p)` at each time: position of the mass centre, m, and Euler parameters. A body that stands
    /// still has one pose.
    pub poses: Vec<Vec<[f64; 7]>>,
    /// Of each body `(s, w')` at each time: velocity, m/s, global frame, and angular velocity, rad/s, body frame. Empty
    /// for a body that stands still.
    pub velocities: Vec<Vec<[f64; 6]>>,
    /// What is plotted.
    pub columns: Vec<Column>,
    /// Where the columns have reactions of joints.
    pub reactions: Vec<Reaction>,
    /// What happened, and when, s.
    pub events: Vec<(f64, String)>,
}

/// Six columns with the force (N) and the torque (N·m) that a joint exerts on its second body, in the first body's
/// joint frame (f, g, h).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Reaction {
    /// Index of the joint.
    pub joint: usize,
    /// Index of the first of the columns.
    pub column: usize,
}

/// A quantity that every sample has.
#[derive(Clone, Debug, Default)]
pub struct Column {
    /// Heading under which it is plotted.
    pub group: &'static str,
    /// Title of its plot; columns of one group, title and unit share a plot.
    pub title: String,
    /// Its name in the plot.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// Scale of its plot.
    pub scale: Scale,
    /// A value for each time.
    pub values: Vec<f64>,
}

/// The scale of a plot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scale {
    /// Linear.
    #[default]
    Linear,
    /// Logarithmic: of values that are positive, or zero.
    Log,
}
