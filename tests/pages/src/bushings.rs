//! Bushings. Other dice than those of the rest decide on them, so that what was drawn before stays as it was.

use crate::dice::Dice;
use crate::laws::Words;
use crate::page::{Page, list};

/// What a bushing's own formulas may name.
const READINGS: [&str; 12] = [
    "x",
    "y",
    "z",
    "angle_x",
    "angle_y",
    "angle_z",
    "x rate",
    "y rate",
    "z rate",
    "angle_x rate",
    "angle_y rate",
    "angle_z rate",
];

impl Page {
    /// One or two, in a third of the model files that have two bodies of which one moves.
    pub fn bushings(&mut self, seed: u64) {
        let Some((mut dice, count)) = Dice::of_a_third(seed, 29) else { return };
        for index in 0..count {
            let Some(ends) = self.two_frames(&mut dice) else { continue };
            let strengths = strengths(&mut dice);
            let ends = if has_angles(&strengths) { turned(ends) } else { ends };
            self.elements +=
                &format!("\n[[force]]\nname = \"b{index}\"\nkind = \"bushing\"\n{ends}{strengths}");
            if dice.once_in(2) {
                self.elements +=
                    &format!("\n[[output]]\nname = \"n{index}\"\nkind = \"bushing\"\nforce = \"b{index}\"\n");
            }
        }
    }
}

impl Page {
    /// Frames of two bodies of which one moves, if those that are drawn are such.
    pub fn two_frames(&self, dice: &mut Dice) -> Option<String> {
        let [first, second] = [(); 2].map(|()| dice.below(self.bodies.len()));
        let moves = self.bodies[first].0.moves() || self.bodies[second].0.moves();
        if first == second || !moves {
            return None;
        }
        let ends = [("first", first), ("second", second)]
            .map(|(side, body)| format!("{side} = {{ body = \"b{body}\"{} }}\n", frame(dice)));
        Some(ends.concat())
    }
}

/// Point and orientation of a frame, of which either may be left out.
fn frame(dice: &mut Dice) -> String {
    let mut keys = String::new();
    if dice.once_in(2) {
        let point = dice.point();
        keys += &format!(", point = {}", list(&point));
    }
    if dice.once_in(2) {
        let p = [(); 4].map(|()| dice.pick(&["-2", "-1", "0.5", "1", "3"]).to_owned());
        keys += &format!(", orientation = {}", list(&p));
    }
    keys
}

fn has_angles(strengths: &str) -> bool {
    ["angle", "tors", "torque"].iter().any(|word| strengths.contains(word))
}

/// Two frames that are turned against each other, unless they are: joints along axes may hold them at 90 degrees, where
/// angles between them have no value.
fn turned(ends: String) -> String {
    if ends.contains("orientation") {
        ends
    } else {
        ends.replacen(" }", ", orientation = [3, 1, -2, 0.5] }", 1)
    }
}

/// Some of its keys, at least one.
fn strengths(dice: &mut Dice) -> String {
    let mut keys = String::new();
    while keys.is_empty() {
        for key in ["stiffness", "damping", "force", "torsion", "torsional_damping", "torque"] {
            if dice.once_in(2) {
                let values = [(); 3].map(|()| strength(dice, key));
                keys += &format!("{key} = {}\n", list(&values));
            }
        }
    }
    if dice.once_in(3) {
        let values = [(); 3].map(|()| strength(dice, "moment"));
        keys += &format!("moment = {}\n", list(&values));
    }
    keys
}

fn strength(dice: &mut Dice, key: &str) -> String {
    let is_formula = !matches!(key, "stiffness" | "torsion") && dice.once_in(4);
    match key {
        _ if dice.once_in(3) => "0".to_owned(),
        _ if is_formula => {
            let names = READINGS.iter().map(|name| (*name).to_owned()).chain(["t".to_owned()]).collect();
            let formula = Words { dice, names }.formula(1);
            let is_damping = key.ends_with("damping");
            format!("{:?}", if is_damping { format!("0.1 + ({formula})^2") } else { formula })
        }
        "force" | "torque" | "moment" => dice.signed(),
        _ => dice.number(),
    }
}
