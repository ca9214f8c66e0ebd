//! `cargo xtask import`: model files of robots stand where an independent forward kinematics puts them, and simulate.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod pose;
mod random;

use gyro_model::{Model, Number, Rational, ShapeKind, Start};
use pose::Pose;
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// Rounding of a few rotations, and of the model file's decimals.
const AGREES: f64 = 1e-13;

/// The pose of a body at the start against the expected one.
fn stands(model: &Model, start: &Start, body: &str, expected: Pose) {
    let moving_body =
        model.coordinate_bodies().into_iter().position(|b| model.bodies[b].name == body).unwrap();
    let [x, y, z, e0, e1, e2, e3] = start.q[7 * moving_body..7 * moving_body + 7] else {
        panic!("seven coordinates")
    };
    let rotation = pose::rotation([e0, e1, e2, e3]);
    let positions = [x, y, z].into_iter().zip(expected.translation);
    let rotations =
        rotation.as_flattened().iter().copied().zip(expected.rotation.as_flattened().iter().copied());
    for (k, (found, expected)) in positions.chain(rotations).enumerate() {
        assert!((found - expected).abs() < AGREES, "{body}, element {k}: {found} for {expected}");
    }
}

/// An empty folder of its own, removed at the end.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("xtask-import-{}-{name}", std::process::id()));
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn xtask(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_gyro")).args(args).output().unwrap()
}

/// Imports one of the robots; its model file's path, its model and what was said.
fn import(folder: &Folder, robot: &str) -> (PathBuf, Model, String) {
    import_with(folder, robot, &[])
}

fn import_with(folder: &Folder, robot: &str, options: &[&str]) -> (PathBuf, Model, String) {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/robots").join(format!("{robot}.urdf"));
    let page = folder.0.join(format!("{robot}.toml"));
    let plain = ["import", file.to_str().unwrap(), "--out", page.to_str().unwrap()];
    let output = xtask(&[&plain, options].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = fs::read_to_string(&page).unwrap();
    let model = gyro_model::read(robot, &text).unwrap_or_else(|mistakes| panic!("{mistakes}"));
    (page, model, String::from_utf8(output.stdout).unwrap())
}

/// The start with joint coordinates set.
fn posed(model: &Model, coordinates: &[(&str, f64)]) -> Start {
    let mut model = model.clone();
    for (name, value) in coordinates {
        let joint = model.joints.iter_mut().find(|joint| joint.name == *name).unwrap();
        joint.start.position = vec![Some(Number::Exact(Rational::from_float(*value).unwrap()))];
    }
    model.assemble().unwrap()
}

fn simulate(page: &Path, t_end: &str) -> Value {
    let page = page.to_str().unwrap();
    let output = xtask(&["simulate", page, "--engine", "assembled", "--t-end", t_end, "--json"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

/// RK4 at 1e-3 s over a fifth of a second of slow motion.
const ENERGY_DRIFT: f64 = 1e-6;

#[test]
fn two_links_with_skewed_axes() {
    let folder = Folder::new("two-link");
    let (page, model, said) = import(&folder, "two_link");
    for (pan, bend) in [(0.0, 0.0), (0.7, -1.1), (-2.0, 2.5)] {
        let start = posed(&model, &[("shoulder_pan", pan), ("elbow", bend)]);
        let upper_arm = Pose::origin([0.0, 0.0, 0.1], [0.0, 0.0, 0.3]) * Pose::turn([0.0, 0.0, 1.0], pan);
        let forearm =
            upper_arm * Pose::origin([0.5, 0.0, 0.05], [0.4, -0.5, 0.6]) * Pose::turn([0.0, 1.0, 1.0], bend);
        stands(&model, &start, "upper_arm", upper_arm * Pose::shift([0.25, 0.02, -0.01]));
        stands(&model, &start, "forearm", forearm * Pose::shift([0.15, 0.0, 0.0]));
    }
    for words in [
        "2 moving bodies, 2 joints, 0 couplers, 1 force",
        "names: `upperArm` is `upper_arm`, `shoulder-pan` is `shoulder_pan`",
        "1 <limit> left out: --limits makes stops of them",
        "1 <transmission> without counterpart: line 39",
        "1 <gazebo> without counterpart: line 40",
        "1 <safety_controller> without counterpart: line 37",
        "0 <visual> and 1 <collision>",
    ] {
        assert!(said.contains(words), "{words} is missing in\n{said}");
    }
    // The upper arm's box is seen from the mass centre, where the body's frame is.
    let seen: Vec<_> = model.bodies.iter().flat_map(|b| b.shapes.iter().map(move |s| (b, s))).collect();
    assert_eq!(seen.len(), 2);
    let (body, shape) = seen[1];
    assert!(matches!(shape.kind, ShapeKind::Box(_)) && body.name == "upper_arm", "{shape:?}");
    assert_eq!(model.values(&shape.position), [-0.25, -0.02, 0.01]);
    let run = simulate(&page, "0.2");
    assert_eq!(run["degrees_of_freedom"], 2);
    assert!(run["energy_drift"].as_f64().unwrap() < ENERGY_DRIFT, "{run}");
    assert_ne!(run["joints"]["elbow"]["position"].as_f64().unwrap(), 0.0);
}

#[test]
fn a_lift_with_a_gripper() {
    let folder = Folder::new("lift");
    let (page, model, said) = import(&folder, "lift");
    for (height, turn, grip) in [(0.0, 0.0, 0.0), (0.4, 1.2, 0.01), (-0.1, -3.0, -0.02)] {
        let right = 0.005 - grip;
        let set = [("column", height), ("turn", turn), ("left", grip), ("right", right)];
        let start = posed(&model, &set);
        let carriage = Pose::origin([1.0, 2.0, 0.0], [0.0, 0.0, 0.5])
            * Pose::origin([0.0, 0.0, 0.3], [0.1, 0.0, 0.0])
            * Pose::shift([0.0, 0.0, height]);
        let arm = carriage * Pose::shift([0.1, 0.0, 0.2]) * Pose::turn([0.0, 0.0, -1.0], turn);
        stands(&model, &start, "carriage", carriage * Pose::shift([0.0, 0.05, 0.1]));
        stands(&model, &start, "arm", arm * Pose::shift([0.2, 0.0, 0.0]));
        stands(&model, &start, "left_finger", arm * Pose::shift([0.42, 0.03 + grip, 0.0]));
        stands(&model, &start, "right_finger", arm * Pose::shift([0.42, -0.03 + right, 0.0]));
    }
    assert!(said.contains("4 moving bodies, 4 joints, 1 coupler, 0 forces"), "{said}");
    assert!(said.contains("1 link fixed to `world`, one body with it: `foot`"), "{said}");
    let run = simulate(&page, "0.2");
    assert_eq!(run["degrees_of_freedom"], 3);
    assert!(run["energy_drift"].as_f64().unwrap() < ENERGY_DRIFT, "{run}");
    let finger = |name: &str| run["joints"][name]["position"].as_f64().unwrap();
    assert!((finger("right") - (0.005 - finger("left"))).abs() < AGREES, "{run}");
}

#[test]
fn frames_without_mass() {
    let folder = Folder::new("frames");
    let (page, model, said) = import(&folder, "frames");
    let names: Vec<&str> = model.bodies.iter().map(|body| body.name.as_str()).collect();
    assert_eq!(names, ["floor", "head", "flag", "puck", "ball"]);
    for (yaw, flag) in [(0.0, 0.0), (1.3, -0.8)] {
        let start = posed(&model, &[("yaw", yaw), ("flag_hinge", flag)]);
        let yaw_frame = Pose::shift([0.0, 0.0, 1.0])
            * Pose::origin([0.1, 0.0, 0.0], [0.0, 0.0, 0.2])
            * Pose::turn([0.0, 0.0, 1.0], yaw);
        let neck = Pose::origin([0.0, 0.0, 0.2], [0.3, 0.0, 0.0]);
        let head_to_mount = Pose::origin([0.1, 0.0, 0.2], [0.0, 0.4, 0.0]);
        let mount = yaw_frame * neck * head_to_mount;
        // The mass centre of head, 0.8 kg, and camera, 0.2 kg; the axes of the link that the joint carries.
        let camera = (head_to_mount * Pose::shift([0.02, 0.0, 0.02])).translation;
        let own = [0.03, 0.0, 0.1];
        let centre = std::array::from_fn(|k| 0.8 * own[k] + 0.2 * camera[k]);
        let centre = (neck * Pose::shift(centre)).translation;
        stands(&model, &start, "head", yaw_frame * Pose::shift(centre));
        let hinge = mount * Pose::shift([0.0, 0.05, 0.0]) * Pose::turn([1.0, 0.0, 0.0], flag);
        stands(&model, &start, "flag", hinge * Pose::shift([0.0, 0.1, 0.0]));
        stands(&model, &start, "puck", Pose::origin([0.0, 1.0, 0.1], [0.2, 0.0, 0.0]));
        stands(
            &model,
            &start,
            "ball",
            Pose::origin([3.0, 0.0, 1.0], [0.0, 0.0, 1.0]) * Pose::shift([0.0, 0.0, 0.5]),
        );
    }
    for words in [
        "4 links fixed to `head`, one body with it: `yaw_frame`, `camera_mount`, `camera`, `optical_frame`",
        "1 link fixed to `floor`, one body with it: `pedestal`",
        "-1.5708 rad is taken for -90 degrees",
        "<joint name=\"slide\">: damping and friction are for revolute and prismatic joints only",
    ] {
        assert!(said.contains(words), "{words} is missing in\n{said}");
    }
    let run = simulate(&page, "0.2");
    // Yaw, flag, the puck's three and the ball's six.
    assert_eq!(run["degrees_of_freedom"], 11);
    assert!(run["energy_drift"].as_f64().unwrap() < ENERGY_DRIFT, "{run}");
    assert_eq!(run["joints"]["slide"]["position"].as_array().unwrap().len(), 3);
}

#[test]
fn nothing_is_overwritten_or_written_for_a_bad_robot() {
    let folder = Folder::new("bad");
    let (page, ..) = import(&folder, "two_link");
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/robots/lift.urdf");
    let again = xtask(&["import", file.to_str().unwrap(), "--out", page.to_str().unwrap()]);
    assert_eq!(again.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&again.stderr).contains("exists: choose another place"));
    // What was imported may be imported anew; what somebody wrote, and the robot itself, may not be replaced.
    let force = ["import", file.to_str().unwrap(), "--force", "--out"];
    let forced = |out: &Path| xtask(&[&force[..], &[out.to_str().unwrap()]].concat());
    assert!(forced(&page).status.success());
    let own = folder.0.join("own.toml");
    fs::write(&own, "format = 1\n").unwrap();
    for path in [own.as_path(), &file] {
        let before = fs::read(path).unwrap();
        assert_eq!(forced(path).status.code(), Some(2));
        assert_eq!(fs::read(path).unwrap(), before);
    }
    let robot = folder.0.join("bad.urdf");
    fs::write(&robot, "<robot name='r'><link name='a'/><link name='b'/></robot>").unwrap();
    let bad = xtask(&["import", robot.to_str().unwrap()]);
    let words = String::from_utf8_lossy(&bad.stderr).into_owned();
    assert!(
        bad.status.code() == Some(2) && words.contains("bad.urdf:1: link `b` is a second root"),
        "{words}"
    );
    assert!(!folder.0.join("bad.toml").exists());
}

/// Where all bodies stand as an independent forward kinematics has it, and how they accelerate as Pinocchio 4.1 has it
/// (free-flyer root, ABA).
#[test]
fn a_trunk_that_floats() {
    let folder = Folder::new("walker");
    let (page, model, said) = import_with(&folder, "walker", &["--floating"]);
    assert!(said.contains("the root link's body `trunk` floats"), "{said}");
    let (left, knee, right) = (0.3, -0.5, 0.2);
    let start = posed(&model, &[("left_hip", left), ("left_knee", knee), ("right_hip", right)]);
    let trunk = Pose::origin([0.01, 0.02, 0.3], [0.1, 0.0, 0.4]);
    let thigh = trunk * Pose::origin([0.15, 0.1, -0.02], [0.1, 0.2, 0.0]) * Pose::turn([0.0, 1.0, 0.2], left);
    let shank = thigh * Pose::shift([0.0, 0.04, -0.2]) * Pose::turn([0.0, 1.0, 0.0], knee);
    // This one hangs on the link without mass that the trunk took in.
    let other = Pose::origin([0.16, -0.1, 0.28], [-0.1, 0.2, 0.4]) * Pose::turn([1.0, 0.0, 0.0], right);
    // The mass centre of trunk, 6 kg, and battery, 1.5 kg, in the root's axes.
    let own = (trunk * Pose::shift([0.04, -0.02, 0.03])).translation;
    let battery = trunk * Pose::origin([-0.1, 0.0, 0.05], [0.0, 0.0, 0.5]) * Pose::shift([0.01, 0.0, 0.02]);
    let centre = std::array::from_fn(|k| 0.8 * own[k] + 0.2 * battery.translation[k]);
    stands(&model, &start, "trunk", Pose::shift(centre));
    stands(&model, &start, "left_thigh", thigh * Pose::shift([0.01, 0.03, -0.1]));
    stands(&model, &start, "left_shank", shank * Pose::shift([0.0, 0.01, -0.12]));
    stands(&model, &start, "right_thigh", other * Pose::shift([0.01, -0.03, -0.1]));

    let mut text = fs::read_to_string(&page).unwrap();
    let mut after = |line: &str, more: &str| {
        assert!(text.contains(line), "{line}");
        text = text.replacen(line, &format!("{line}{more}"), 1);
    };
    after("free = true\n", "velocity = [0.3, -0.2, 0.5]\nangular_velocity = [0.4, -0.7, 1.1]\n");
    for (name, angle, rate) in [("left_hip", left, 2.0), ("left_knee", knee, -3.0), ("right_hip", right, 1.5)]
    {
        let joint = format!("name = \"{name}\"\nkind = \"revolute\"\n");
        after(&joint, &format!("angle = {angle:?}\nrate = {rate:?}\n"));
    }
    let in_trunk: [f64; 3] = std::array::from_fn(|k| battery.translation[k] - centre[k]);
    for (name, body, point) in
        [("trunk", "trunk", [0.0; 3]), ("left_shank", "left_shank", [0.0; 3]), ("battery", "trunk", in_trunk)]
    {
        text += &format!(
            "\n[[output]]\nname = \"a_{name}\"\nkind = \"acceleration\"\nbody = \"{body}\"\npoint = {point:?}\n"
        );
    }
    fs::write(&page, text).unwrap();
    let run = simulate(&page, "1e-9");
    for (body, expected) in [
        ("trunk", [0.0141492493471, 0.0427767443059, -9.8787751179776]),
        ("left_shank", [0.2024519818540, -0.1079037088396, -9.3204376333435]),
        ("battery", [0.2481122213378, -0.0199961716562, -9.8912508382647]),
    ] {
        for (found, expected) in run["outputs"][format!("a_{body}")].as_array().unwrap().iter().zip(expected)
        {
            assert!((found.as_f64().unwrap() - expected).abs() < PINOCCHIO_S, "{body}: {run}");
        }
    }
}

/// A jerk of less than a hundred m/s3 over the nanosecond of the run, and the printed digits.
const PINOCCHIO_S: f64 = 1e-7;
