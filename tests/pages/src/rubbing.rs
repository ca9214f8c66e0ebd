//! Random mechanisms whose joints stop and rub: rigid contacts along joint coordinates, those of loops too.

use crate::dice::Dice;
use crate::{load, page};
use std::fmt::Write;

/// Most contacts of a model file.
const MOST: usize = 6;

/// The model file of a seed with friction that sticks and rigid stops on some of its coordinates.
pub fn rubbing(seed: u64) -> String {
    let mut dice = Dice::new(seed.rotate_left(23));
    let mut text = page(seed);
    let model =
        gyro_model::read_with("page.toml", &text, &mut load).unwrap_or_else(|error| panic!("{error}"));
    let start = model.assemble().unwrap_or_else(|error| panic!("{error}"));
    let driven = |joint: usize, coordinate: usize| {
        model.drivers.iter().any(|d| (d.coordinate.joint, d.coordinate.coordinate) == (joint, coordinate))
    };
    let mut count = 0;
    for (index, (joint, start)) in model.joints.iter().zip(&start.joints).enumerate() {
        let kinds = joint.kind.coordinates();
        for (place, kind) in kinds.iter().enumerate() {
            if driven(index, place) || start.position.len() != kinds.len() || count == MOST || dice.once_in(3)
            {
                continue;
            }
            let _ = write!(text, "\n[[contact]]\nname = \"k{count}\"\njoint = \"{}\"\n", joint.name);
            if kinds.len() > 1 {
                let _ = writeln!(text, "coordinate = \"{}\"", kind.name());
            }
            count += 1;
            let (at, what) = (start.position[place], dice.below(4));
            if what != 1 {
                let level = dice.between(0.02, 0.6);
                let _ = write!(text, "friction = {level:.4}\nstatic_friction = {:.4}\n", 1.3 * level);
            }
            if what < 2 {
                let beyond = dice.between(0.05, 0.5);
                let end = if dice.once_in(2) { ("lower", at - beyond) } else { ("upper", at + beyond) };
                let restitution = dice.pick(&["0", "0.5", "0.9"]);
                let _ = write!(text, "{} = {:.6}\nrestitution = {restitution}\n", end.0, end.1);
            }
        }
    }
    text
}
