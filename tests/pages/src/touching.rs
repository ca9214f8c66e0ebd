//! Bodies that touch. Other dice than those of the rest decide on them.

use crate::dice::Dice;
use crate::page::{Page, list};

/// Pairs of shapes that can touch, in either order.
const PAIRS: [[&str; 2]; 11] = [
    ["plane", "sphere"],
    ["plane", "capsule"],
    ["plane", "cylinder"],
    ["plane", "box"],
    ["plane", "torus"],
    ["plane", "vertices"],
    ["sphere", "sphere"],
    ["sphere", "capsule"],
    ["cylinder", "sphere"],
    ["sphere", "box"],
    ["capsule", "capsule"],
];

impl Page {
    /// One or two contacts, in a third of the model files that have two bodies of which one moves.
    pub fn touching(&mut self, seed: u64) {
        let Some((mut dice, count)) = Dice::of_a_third(seed, 37) else { return };
        for index in 0..count {
            let bodies = [(); 2].map(|()| dice.below(self.bodies.len()));
            let [first, second] = bodies;
            if first == second || !bodies.iter().any(|body| self.bodies[*body].0.moves()) {
                continue;
            }
            let forms = dice.pick(&PAIRS);
            for (body, form) in bodies.into_iter().zip(forms) {
                let shape = shape(&mut dice, form);
                self.bodies[body].1 += &format!("\n[[body.shape]]\nname = \"s{index}\"\n{shape}");
            }
            let sides = if dice.once_in(2) { [second, first] } else { bodies };
            let sides = sides.map(|body| format!("{{ body = \"b{body}\", shape = \"s{index}\" }}"));
            self.elements += &format!(
                "\n[[contact]]\nname = \"t{index}\"\nbetween = {}\n{}",
                list(&sides),
                law(&mut dice)
            );
        }
    }
}

fn shape(dice: &mut Dice, form: &str) -> String {
    let size = |dice: &mut Dice| dice.pick(&["0.1", "0.25", "0.4", "\"0.3/2\"", "1"]).to_owned();
    let mut text = match form {
        "sphere" => format!("sphere = {}\n", size(dice)),
        "box" => format!("box = {}\n", list(&[(); 3].map(|()| size(dice)))),
        "vertices" => {
            let corners = (0..1 + dice.below(3)).map(|_| list(&dice.point())).collect::<Vec<_>>();
            format!("vertices = {}\n", list(&corners))
        }
        _ => format!("{form} = {}\n", list(&[(); 2].map(|()| size(dice)))),
    };
    if dice.once_in(2) {
        text += &format!("position = {}\n", list(&dice.point()));
    }
    if dice.once_in(2) {
        let p = [(); 4].map(|()| dice.pick(&["-2", "-1", "0.5", "1", "3"]).to_owned());
        text += &format!("orientation = {}\n", list(&p));
    }
    text
}

fn law(dice: &mut Dice) -> String {
    let mut law = format!("stiffness = {}\n", dice.number());
    for (key, values) in [
        ("exponent", ["1", "1.5", "2"]),
        ("damping", ["0", "0.2", "1"]),
        ("friction_coefficient", ["0.1", "0.5", "1"]),
        ("static_friction_coefficient", ["1", "1.2", "1.5"]),
        ("stribeck_rate", ["0.01", "0.1", "1"]),
        ("rate", ["0.1", "0.5", "1"]),
    ] {
        let is_of_friction = !matches!(key, "exponent" | "damping" | "friction_coefficient");
        if dice.once_in(2) && (!is_of_friction || law.contains("friction")) {
            law += &format!("{key} = {}\n", dice.pick(&values));
        }
    }
    law
}
