//! Outputs of two frames, rows among their numbers, and rates of formulas of these.

use crate::dice::Dice;
use crate::laws::Words;
use crate::page::Page;

impl Page {
    /// One or two, in a third of the model files that have two bodies of which one moves; of some a row.
    pub fn pairs(&mut self, seed: u64) {
        let Some((mut dice, count)) = Dice::of_a_third(seed, 23) else { return };
        for index in 0..count {
            let Some(ends) = self.two_frames(&mut dice) else { continue };
            self.elements += &format!("\n[[output]]\nname = \"p{index}\"\nkind = \"relative\"\n{ends}");
            let number = dice.pick(&["x", "yz", "vy", "wx", "wz"]);
            self.early.push(format!("p{index}.{number}"));
            if !dice.once_in(4) {
                self.row_of_pair(&mut dice, index);
            }
        }
    }

    /// One or two rates of formulas, in a third of the model files.
    pub fn rates(&mut self, seed: u64) {
        let Some((mut dice, count)) = Dice::of_a_third(seed, 47) else { return };
        let places = self.coordinates().into_iter().map(|on| self.shown(on));
        let mut names: Vec<_> = places.flat_map(|place| [format!("{place} rate"), place]).collect();
        for pair in ["p0", "p1"] {
            if self.elements.contains(&format!("\"{pair}\"\nkind = \"relative\"")) {
                names.extend(["x", "z", "xy", "zz", "vx", "vz", "wx", "wy"].map(|of| format!("{pair}.{of}")));
            }
        }
        names.push("t".to_owned());
        names.extend(self.inputs.iter().map(|(name, _)| name.clone()));
        let mut words = Words { dice: &mut dice, names };
        for index in 0..count {
            let of = words.of_names();
            self.elements += &format!("\n[[output]]\nname = \"rate{index}\"\nkind = \"rate\"\nof = {of:?}\n");
        }
    }

    /// A row of positions or of velocities, if one more leaves something to move.
    fn row_of_pair(&mut self, dice: &mut Dice, index: usize) {
        let Some(own) = self.free_coordinate() else { return };
        let root = self.joints[own.0].root;
        if self.freedoms[&root] < 2 {
            return;
        }
        let without = self.clone();
        *self.freedoms_of(root) -= 1;
        let of_positions = dice.once_in(3);
        let joint = &mut self.joints[own.0];
        joint.taken.push(own.1);
        let lost: &[&str] = if of_positions {
            &["angle", "angles", "displacement", "position", "rate", "rates"]
        } else {
            &["rate", "rates"]
        };
        joint.starts.retain(|(key, _)| !lost.contains(key));
        let places = ["x", "y", "z", "xx", "xy", "yz", "zy", "zz"];
        let rates = ["vx", "vy", "vz", "wx", "wy", "wz"];
        let number = |dice: &mut Dice, of: &[&'static str]| format!("p{index}.{}", dice.pick(of));
        let own = self.shown(own);
        let text = if of_positions {
            let [a, b, c] = [(); 3].map(|()| number(dice, &places));
            format!("zero = \"{own} + 0.3*sin({a}) - 0.2*{b}*{c}\"")
        } else {
            let mut text = format!("{own} rate");
            for _ in 0..1 + dice.below(4) {
                let ([a, b], rate) = ([(); 2].map(|()| number(dice, &places)), number(dice, &rates));
                text += &match dice.below(4) {
                    0 => format!(" - {}*{rate}", dice.number()),
                    1 => format!(" + {a}*{rate}"),
                    2 => format!(" - {a}*{rate}/sqrt(1 + {b}^2)"),
                    _ => format!(" + cos({a})*{b}*{rate}"),
                };
            }
            format!("rate = \"{text}\"")
        };
        self.elements += &format!("\n[[constraint]]\nname = \"w{index}\"\n{text}\n");
        if dice.once_in(2) {
            self.elements += &format!(
                "\n[[output]]\nname = \"of_w{index}\"\nkind = \"constraint\"\nconstraint = \"w{index}\"\n"
            );
        }
        if gyro_model::read_with("page.toml", &self.text(), &mut crate::load).is_err() {
            *self = without;
        }
    }
}
