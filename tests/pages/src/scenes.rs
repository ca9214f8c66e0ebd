//! Scenes of rigid contact: bodies of all shapes that are thrown upon a ground, and upon each other.

use crate::dice::Dice;
use std::fmt::Write;

/// A model file whose bodies fall, bounce, roll, slide and come to lie.
pub fn scene(seed: u64) -> String {
    let mut dice = Dice::new(seed.rotate_left(17));
    let mut page = format!(
        "format = 1\nname = \"scene_{seed}\"\ngravity = [{:.3}, 0, -9.81]\n\n[[body]]\nname = \"ground\"\nfixed = true\n\n\
         [[body.shape]]\nplane = [4, 4]\n",
        dice.pick(&[0.0, 0.0, 0.5, 3.0])
    );
    let restitution = dice.pick(&["0", "0.3", "0.6"]);
    let law = dice.pick(&["newton", "poisson"]);
    let friction = dice.pick(&["0", "0.2", "0.6"]);
    let count = dice.pick(&[1, 2, 3]);
    let mut bodies = vec![("ground".to_owned(), "plane")];
    for index in 0..count {
        let (kind, size, inertia) = solid(&mut dice);
        let position = [dice.between(-0.1, 0.1), dice.between(-0.1, 0.1), 0.45 + 0.55 * f64::from(index)];
        let turns = dice.once_in(3);
        let p = if turns { [1.0, 0.0, 0.0, 0.0] } else { [(); 4].map(|()| dice.between(-1.0, 1.0)) };
        let velocity = [dice.between(-2.0, 2.0), dice.between(-2.0, 2.0), dice.between(-1.0, 1.0)];
        let spin = [(); 3].map(|()| if turns { 0.0 } else { dice.between(-8.0, 8.0) });
        let name = format!("b{index}");
        let _ = write!(
            page,
            "\n[[body]]\nname = \"{name}\"\nfree = true\nmass = 1\ninertia = {inertia:.5?}\nposition = {position:.3?}\n\
             orientation = {p:.3?}\nvelocity = {velocity:.3?}\nangular_velocity = {spin:.3?}\n\n[[body.shape]]\n{kind} = {size}\n"
        );
        bodies.push((name, kind));
    }
    for (place, (other, kind)) in bodies.iter().enumerate() {
        let touching = |first: &&(String, &str)| match (first.1, *kind) {
            ("plane", _) | ("capsule", "capsule") => true,
            (one, other) => [one, other].contains(&"sphere") && ![one, other].contains(&"torus"),
        };
        for (first, _) in bodies[..place].iter().filter(touching) {
            let _ = write!(
                page,
                "\n[[contact]]\nname = \"{first}_{other}\"\nbetween = [{{ body = \"{first}\" }}, {{ body = \"{other}\" }}]\n\
                 restitution = {restitution}\nimpact_law = \"{law}\"\nfriction_coefficient = {friction}\n"
            );
        }
    }
    page + "\n[simulation]\nt_end = 1.5\ntolerance = 1e-9\n"
}

/// A shape of about 0.2 m, and the moments of inertia of a full body of it with a mass of one.
fn solid(dice: &mut Dice) -> (&'static str, String, [f64; 3]) {
    let [a, b, c] = [(); 3].map(|()| dice.between(0.08, 0.25));
    let round = |across: f64, along: f64| [across, across, along];
    match dice.below(8) {
        0 | 1 => ("sphere", format!("{a:.3}"), [0.4 * a * a; 3]),
        2 | 3 => {
            let squares = [b * b + c * c, a * a + c * c, a * a + b * b];
            ("box", format!("[{a:.3}, {b:.3}, {c:.3}]"), squares.map(|sum| sum / 12.0))
        }
        4 => ("cylinder", format!("[{a:.3}, {b:.3}]"), round(a * a / 4.0 + b * b / 12.0, a * a / 2.0)),
        5 | 6 => {
            ("capsule", format!("[{:.3}, {b:.3}]", a / 2.0), round(a * a / 16.0 + b * b / 12.0, a * a / 8.0))
        }
        _ => {
            let rim = 0.75 * a * a / 16.0;
            ("torus", format!("[{a:.3}, {:.3}]", a / 4.0), round(0.5 * a * a + rim, a * a + rim))
        }
    }
}
