//! Frames of links as outputs: place, orientation and velocities.

use super::element::settled;
use super::merge::{Merged, Place};
use super::names::{Names, snake_case};
use super::numbers::{euler_parameters, vector};
use super::robot::{Link, Robot};
use nalgebra::Rotation3;
use std::fmt::Write as _;

/// All links that move.
pub(super) const ALL: &str = "all";

/// The frame of a link that moves.
pub(super) struct Frame {
    pose: String,
    velocity: String,
    pub(super) place: Place,
}

/// One for each link that is wanted.
pub(super) fn of(robot: &Robot, merged: &Merged, wanted: &[String], names: &mut Names) -> Vec<Frame> {
    let links = robot.links.iter().zip(&merged.places);
    let moving = links.filter(|(_, place)| merged.bodies[place.body].inertial.is_some());
    let is_wanted = |link: &Link| wanted.contains(&link.name) || wanted == [ALL];
    moving
        .filter(|(link, _)| is_wanted(link))
        .map(|(link, place)| {
            let name = snake_case(&link.name);
            let [pose, velocity] = ["pose", "velocity"].map(|what| names.made(&format!("{name}_{what}")));
            Frame { pose, velocity, place: *place }
        })
        .collect()
}

impl Frame {
    /// The outputs; those of a frame with the axes of its body have no orientation of their own.
    pub(super) fn outputs(&self, text: &mut String, body: &str) {
        let pose = settled(&self.place.pose);
        let is_turned = pose.rotation != Rotation3::identity();
        for (name, kind) in [(&self.pose, "pose"), (&self.velocity, "velocity")] {
            let point = vector(&pose.translation.vector);
            let _ = write!(
                text,
                "\n[[output]]\nname = \"{name}\"\nkind = \"{kind}\"\nbody = \"{body}\"\npoint = {point}\n"
            );
            if is_turned {
                let _ = writeln!(text, "orientation = {}", euler_parameters(&pose));
            }
        }
    }
}
