//! Frames of links as outputs: place, orientation and velocities.

use super::merge::Merged;
use super::names::{Names, snake_case};
use super::robot::Robot;
use crate::words::listed;
use nalgebra::{Rotation3, Vector3};
use std::fmt::Write as _;

/// All links that move.
pub(super) const ALL: &str = "all";

/// The frame of a link that moves.
pub(super) struct Frame {
    pose: String,
    velocity: String,
    pub(super) body: usize,
    /// Its origin in the body's frame.
    pub(super) point: Vector3<f64>,
}

/// One for each link that is wanted. A body has the axes of the first of these on it; what others are turned by against
/// them is told.
pub(super) fn of(
    robot: &Robot,
    merged: &Merged,
    wanted: &[String],
    names: &mut Names,
    remarks: &mut Vec<String>,
) -> Vec<Frame> {
    let (mut frames, mut turned) = (Vec::new(), Vec::new());
    for (link, place) in robot.links.iter().zip(&merged.places) {
        let is_wanted = wanted.contains(&link.name) || wanted == [ALL];
        if !is_wanted || merged.bodies[place.body].inertial.is_none() {
            continue;
        }
        if place.pose.rotation != Rotation3::identity() {
            turned.push(format!("`{}`", link.name));
        }
        let name = snake_case(&link.name);
        let [pose, velocity] = ["pose", "velocity"].map(|what| names.made(&format!("{name}_{what}")));
        frames.push(Frame { pose, velocity, body: place.body, point: place.pose.translation.vector });
    }
    if !turned.is_empty() {
        remarks.push(format!(
            "--frames: orientations and angular velocities of these links are given by the axes of their bodies, as a \
             body has those of one link (their turns against it are below; asked for alone, a link gives its body its \
             axes): {}",
            listed(&turned)
        ));
    }
    frames
}

impl Frame {
    pub(super) fn outputs(&self, text: &mut String, body: &str, point: &str) {
        for (name, kind) in [(&self.pose, "pose"), (&self.velocity, "velocity")] {
            let _ = write!(
                text,
                "\n[[output]]\nname = \"{name}\"\nkind = \"{kind}\"\nbody = \"{body}\"\npoint = {point}\n"
            );
        }
    }
}
