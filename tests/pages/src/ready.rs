//! Ready elements. Other dice than those of the rest decide on them, so that what was drawn before stays as it was.

use crate::dice::Dice;
use crate::page::{Page, list};

/// Kinds along a joint coordinate, with their keys but the coordinate.
const ALONG: [(&str, &str); 6] = [
    (
        "dc_motor",
        "voltage = \"2*cos(3*t)\"\nresistance = 1.5\ninductance = 0.2\nconstant = 0.3\nratio = 2\nefficiency = 0.8\n",
    ),
    (
        "cylinder",
        "opening = \"0.3*sin(2*t)\"\nsupply = 2e4\nvalve = 1e-4\narea = 1e-3\nrod_area = 6e-4\nstroke = 4\n\
         dead_volume = 0.01\nbulk_modulus = 1e5\nleakage = 1e-8\npressure = 1e3\n",
    ),
    ("impact", "limit = 0.3\nside = \"upper\"\nstiffness = 20\ndamping = 0.4\n"),
    ("impact", "limit = -0.2\nside = \"lower\"\nstiffness = 20\nexponent = 2\n"),
    ("stribeck", "level = 0.2\nstatic_level = 0.3\nstribeck_rate = 0.4\nrate = 0.1\nviscous = 0.05\n"),
    (
        "lugre",
        "level = 0.2\nstatic_level = 0.3\nstribeck_rate = 0.4\nbristle_stiffness = 30\nbristle_damping = 0.5\n",
    ),
];

impl Page {
    /// One or two, in a third of the model files.
    pub fn ready(&mut self, seed: u64) {
        let Some((mut dice, count)) = Dice::of_a_third(seed, 41) else { return };
        for index in 0..count {
            let keys = match dice.below(3) {
                0 => self.ready_along(&mut dice),
                1 => self.ready_between(&mut dice),
                _ => self.ready_on(&mut dice),
            };
            if let Some(keys) = keys {
                self.elements += &format!("\n[[element]]\nname = \"ready{index}\"\n{keys}");
            }
        }
    }

    fn ready_along(&mut self, dice: &mut Dice) -> Option<String> {
        let coordinates = self.coordinates();
        if coordinates.is_empty() {
            return None;
        }
        let on = coordinates[dice.below(coordinates.len())];
        let (kind, keys) = dice.pick(&ALONG);
        Some(format!("kind = \"{kind}\"\n{}{keys}", self.on(on.0, on.1)))
    }

    /// A wire, or a rope by way of a third body.
    fn ready_between(&mut self, dice: &mut Dice) -> Option<String> {
        let [first, second, third] = [(); 3].map(|()| dice.below(self.bodies.len()));
        let moves = self.bodies[first].0.moves() || self.bodies[second].0.moves();
        if first == second || !moves {
            return None;
        }
        let [from, to, by] = [first, second, third]
            .map(|body| format!("{{ body = \"b{body}\", point = {} }}", list(&dice.point())));
        let keys = "stiffness = 3\ndamping = 0.2\nfree_length = \"0.4 + 0.1*sin(t)\"\n";
        Some(if dice.once_in(2) || [first, second].contains(&third) {
            format!("kind = \"wire\"\nfirst = {from}\nsecond = {to}\n{keys}")
        } else {
            format!("kind = \"rope\"\npoints = [{from}, {by}, {to}]\n{keys}")
        })
    }

    fn ready_on(&mut self, dice: &mut Dice) -> Option<String> {
        let body = self.moving()?;
        let at = format!("body = \"b{body}\"\npoint = {}\n", list(&dice.point()));
        Some(if dice.once_in(2) {
            format!("kind = \"drag\"\n{at}area = 0.2\ncoefficient = 1.1\nwind = [\"sin(t)\", 0, 0.5]\n")
        } else {
            let axis = list(&dice.point());
            let axis = if axis.contains(['1', '2', '3', '4', '5']) { axis } else { "[0, 0, 1]".to_owned() };
            format!(
                "kind = \"propeller\"\n{at}axis = {axis}\nspeed = \"20*cos(t)\"\nthrust = -2e-3\ntorque = 1e-4\n"
            )
        })
    }
}
