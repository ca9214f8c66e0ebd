//! Bodies that only guesses place.

use crate::closing::{TOLERANCE, assembled, check, number};
use gyro_model::{RowOwner, read};

const HUNG: &str = r#"
format = 1
name = "hung"
[[body]]
name = "ground"
fixed = true
[[body]]
name = "plate"
mass = 1
inertia = [0.1, 0.1, 0.1]
position = [0, 0, -1]
[[joint]]
name = "left"
kind = "rod"
length = 1.25
first = { body = "ground", point = [-1, 0, 0] }
second = { body = "plate", point = [-1, 0, 0] }
[[joint]]
name = "right"
kind = "rod"
length = 1.5
first = { body = "ground", point = [1, 0, 0] }
second = { body = "plate", point = [1, 0, 0] }
"#;

#[test]
fn a_body_on_rods_moves_from_its_guess() {
    let model = read("hung", HUNG).unwrap_or_else(|mistakes| panic!("{mistakes}"));
    assert_eq!(gyro_model::Tree::of(&model).floating, [1]);
    let start = assembled(&model);
    let moved: Vec<_> = start.moved.iter().map(|m| (m.owner, m.coordinate)).collect();
    assert!(moved.contains(&(RowOwner::Body(1), "position")), "{moved:?}");
    assert!(moved.contains(&(RowOwner::Body(1), "orientation")), "{moved:?}");
    // Downwards, and turned about y only: nothing else had to move.
    assert!(start.q[2] < -1.0 && start.q[1].abs() <= TOLERANCE);
    assert!(start.q[4].abs() + start.q[6].abs() <= TOLERANCE);
}

/// A guess in which every bar lies on one line has no slope towards the pose that closes.
#[test]
fn a_symmetric_guess_is_left() {
    let mut model = read("hung", HUNG).unwrap_or_else(|mistakes| panic!("{mistakes}"));
    for body_point in [0.0, 0.2] {
        model.bodies[1].position = [0.0, 0.0, body_point].map(number);
        let _ = assembled(&model);
    }
}

/// A bead on a wire that a joint ties to an arm, of which joint nothing is told.
const BEAD: &str = r#"
format = 1
name = "bead"
[[body]]
name = "ground"
fixed = true
[[body]]
name = "arm"
mass = 1
inertia = [1, 1, 1]
[[body]]
name = "bead"
mass = 1
inertia = [1, 1, 1]
[[joint]]
name = "hinge"
kind = "revolute"
first = { body = "ground", point = [0, -1.2, 0], axis = [3, 1, 2], zero = [1, 0, 0] }
second = { body = "arm", axis = [3, 1, 2], zero = [1, 0, 0] }
[[joint]]
name = "wire"
kind = "point_on_line"
first = { body = "ground", axis = [0, 1, 0], zero = [1, 2, 2] }
second = { body = "bead", point = [1, 0, 0] }
[[joint]]
name = "tie"
kind = "spherical"
first = { body = "arm", point = [-0.29, -0.72, 0.99] }
second = { body = "bead", point = [1.7327185555934046, -2.1215155037235207, -0.44332008152834645] }
[[coupler]]
name = "coupler"
first = { joint = "wire", coordinate = "displacement" }
second = { joint = "hinge", coordinate = "angle" }
ratio = 0.5
offset = 1.57
"#;

/// Nothing tells how the bead is turned: the zero of the tie is as good a guess as the bead's own orientation, and
/// where one is on the wrong branch the other is taken.
#[test]
fn a_guess_from_which_it_does_not_close_gives_way_to_the_other() {
    let model = read("bead", BEAD).unwrap_or_else(|mistakes| panic!("{mistakes}"));
    check(&model, &assembled(&model));
}
