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

/// A block on a wire of a swing, which is guessed upright, and a plate that a screw holds on the block. Two more joints
/// of which nothing is told, another wire and another cross, close loops where these guesses put the bodies.
const SWING: &str = r#"
format = 1
name = "swing"
[[body]]
name = "base"
fixed = "constrained"
mass = 2.5
inertia = [0.5, 0.5, 0.5]
position = [0, -0.3333333333333333, 1e-6]
orientation = [3, 0, -1, 0]
[[body]]
name = "swing"
mass = 0.229
inertia = [0.0274, 0.0274, 0.0131]
[[body]]
name = "block"
mass = 1.5
inertia = [0.141, 0.142, 0.0171]
[[body]]
name = "plate"
mass = 0.3333333333333333
inertia = [8.1375e-3, 1.0626e-2, 3.6931e-3]
[[joint]]
name = "cross"
kind = "universal"
first = { body = "base", axis = [1, 2, 3], zero = [3, 0, 4] }
second = { body = "swing", point = [-2.5e-4, -0.958455, 0], axis = [1, 2, 3], zero = [3, 0, 4] }
second_angle_deg = -90
rough = true
[[joint]]
name = "wire"
kind = "point_on_line"
first = { body = "swing", point = [-1.3182611, 0, 0], axis = [0.6, 0, 0.8], zero = [0, 0, 1] }
second = { body = "block", point = [0, 0.5, 1.5] }
displacement = -0.25
rough = true
[[joint]]
name = "thread"
kind = "screw"
lead = 0.75
first = { body = "block", axis = [3, 0, 4], zero = [1, 0, 0] }
second = { body = "plate", axis = [3, 0, 4], zero = [1, 0, 0] }
angle_deg = -76
rough = true
[[joint]]
name = "second_wire"
kind = "point_on_line"
first = { body = "plate", point = [-0.75, -0.73, 0.13], axis = [-0.37, -0.26, -0.76], zero = [0.46, 0.75, -0.7] }
second = { body = "base", point = [-4.0930208923621505, -1.0934109015064357, -0.26481179008462785] }
[[joint]]
name = "second_cross"
kind = "universal"
first = { body = "swing", point = [0.76, -0.98, 0.82], axis = [0.92, 0.65, -0.76], zero = [-0.8, -0.97, 0] }
second = { body = "plate", point = [1.7217081546340551, 0.6330600572978466, 4.205258756861612], axis = [-0.2634821623938024, -0.7384527821914075, -0.6611159040395685], zero = [-0.37736544232385505, -0.7934146812748054, 1.0366235895817353] }
"#;

/// One angle of the cross is told and the other is not: that is more than nothing, and bodies are guessed along it.
#[test]
fn a_joint_that_is_told_in_part_is_followed_before_one_of_which_nothing_is_told() {
    let model = read("swing", SWING).unwrap_or_else(|mistakes| panic!("{mistakes}"));
    let start = assembled(&model);
    check(&model, &start);
    let farthest = start.moved.first().map_or(0.0, |farthest| farthest.amount.abs());
    assert!(farthest < 1e-6, "it closes where it is guessed: {:?}", start.moved);
}
