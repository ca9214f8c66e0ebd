//! Forces and torques on links, as inputs.

use super::merge::Merged;
use super::names::Names;
use super::robot::Robot;
use crate::words;
use nalgebra::Vector3;
use std::fmt::Write as _;

/// A force and a torque at the origin of a link's frame, in global components.
pub(super) struct Wrench {
    name: String,
    pub(super) body: usize,
    /// The origin in the body's frame.
    pub(super) point: Vector3<f64>,
}

const COMPONENTS: [(&str, &str, &str); 2] = [("force", "N", "x y z"), ("torque", "N.m", "x y z")];

/// Links that are not there, and those that do not move, in words.
pub(super) fn check(
    file: &str,
    robot: &Robot,
    merged: &Merged,
    (option, wanted): (&str, &[String]),
) -> Result<(), Vec<String>> {
    let problem = |name: &String| match robot.links.iter().position(|link| link.name == *name) {
        None => {
            let names: Vec<_> = robot.links.iter().map(|link| format!("`{}`", link.name)).collect();
            Some(format!(
                "{file}: {option} {name}: there is no such link; there are {}",
                words::listed(&names)
            ))
        }
        Some(link) if merged.bodies[merged.places[link].body].inertial.is_none() => {
            Some(format!("{file}: {option} {name}: this link is fixed, and nothing moves it"))
        }
        Some(_) => None,
    };
    let problems: Vec<String> = wanted.iter().filter_map(problem).collect();
    if problems.is_empty() { Ok(()) } else { Err(problems) }
}

/// One for each link that is wanted, once.
pub(super) fn of(robot: &Robot, merged: &Merged, wanted: &[String]) -> Vec<Wrench> {
    let mut names = Names::default();
    let wrench = |(index, link): (usize, &super::robot::Link)| {
        let place = merged.places[index];
        Wrench { name: names.name(&link.name), body: place.body, point: place.pose.translation.vector }
    };
    robot.links.iter().enumerate().filter(|(_, link)| wanted.contains(&link.name)).map(wrench).collect()
}

impl Wrench {
    pub(super) fn inputs(&self, text: &mut String) {
        for (what, unit, axes) in COMPONENTS {
            for axis in axes.split(' ') {
                let _ = writeln!(text, "{}_{what}_{axis} = 0  # {unit}", self.name);
            }
        }
    }

    pub(super) fn load(&self, text: &mut String, body: &str, point: &str) {
        let _ = write!(
            text,
            "\n[[force]]\nname = \"{}_wrench\"\nkind = \"load\"\nbody = \"{body}\"\npoint = {point}\n",
            self.name
        );
        for (what, _, axes) in COMPONENTS {
            let inputs = axes.split(' ').map(|axis| format!("\"{}_{what}_{axis}\"", self.name));
            let _ = writeln!(text, "{what} = [{}]", inputs.collect::<Vec<_>>().join(", "));
        }
    }
}
