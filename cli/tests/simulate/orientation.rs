//! Which of the two that stand for an orientation tables show: the one that is continuous from the start.

use crate::laws::{RUNS, integrated_one, run};
use crate::support::{Folder, simulate};
use chacha20::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use std::fmt::Write as _;
use std::fs;

/// A pendulum that starts at 270 degrees, with a controller that sees the first of its Euler parameters.
const CONTROLLED: &str = r#"
format = 1
name = "controlled"
gravity = [0, -9.81, 0]
[inputs]
u = 0
[simulation]
t_end = 1
step = 1e-3
sample_every = 0.05
[[body]]
name = "wall"
fixed = true
[[body]]
name = "rod"
mass = 1
inertia = [0.0833, 1e-4, 0.0833]
[[joint]]
name = "hinge"
kind = "revolute"
axis = [0, 0, 1]
zero = [0, -1, 0]
first = { body = "wall" }
second = { body = "rod", point = [0, 0.5, 0] }
angle_deg = 270
[[output]]
name = "po"
kind = "pose"
body = "rod"
[[force]]
name = "m"
kind = "motor"
joint = "hinge"
value = "u"
[[controller]]
name = "c"
kind = "pid"
outputs = ["po.e0"]
inputs = ["u"]
frequency_hz = 100
setpoint = 0.5
kp = 8
"#;

/// The rows of the table of a run.
fn table(folder: &Folder, name: &str, args: &[&str]) -> (Vec<String>, Vec<Vec<f64>>) {
    let out = format!("of-{}", args.join(""));
    let file = format!("{name}.toml");
    let run = simulate(folder, &[&[&*file, "--quiet", "--out", &out], args].concat());
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let text = fs::read_to_string(folder.0.join(out).join(format!("{name}.csv"))).unwrap();
    let mut lines = text.lines().map(|line| line.split(','));
    let head = lines.next().unwrap().map(str::to_owned).collect();
    (head, lines.map(|line| line.map(|number| number.parse().unwrap()).collect()).collect())
}

#[test]
fn a_controller_drives_the_same_motion_in_all_coordinates() {
    let folder = Folder::new("controlled-orientation");
    fs::write(folder.0.join("controlled.toml"), CONTROLLED).unwrap();
    let runs: [&[&str]; 3] = [
        &["--engine", "jit", "--coordinates", "joint"],
        &["--engine", "jit", "--coordinates", "maximal"],
        &["--engine", "assembled"],
    ];
    let last = runs.map(|args| {
        let (head, rows) = table(&folder, "controlled", args);
        let column = head.iter().position(|name| name == "hinge [rad]").unwrap();
        rows.last().unwrap()[column]
    });
    println!("{last:?}");
    assert!(last.iter().all(|angle| (angle - last[1]).abs() < 1e-6), "{last:?}");
}

/// A chain of hinges, a ball in a socket and a free body, all of which turn fast from anywhere.
fn turning(dice: &mut ChaCha8Rng) -> String {
    let mut text = "format = 1\nname = \"turning\"\n[simulation]\nt_end = 0.5\nsample_every = 0.005\n\
        method = \"dop853\"\ntolerance = 1e-9\n[[body]]\nname = \"wall\"\nfixed = true\n"
        .to_owned();
    let body = |dice: &mut ChaCha8Rng, name: &str| {
        let [a, b, c] = [(); 3].map(|()| dice.random_range(0.1..0.15));
        format!(
            "[[output]]\nname = \"{name}_pose\"\nkind = \"pose\"\nbody = \"{name}\"\n\
             [[body]]\nname = \"{name}\"\nmass = 1\ninertia = [{a:?}, {b:?}, {c:?}]\n"
        )
    };
    let list = |dice: &mut ChaCha8Rng, n: usize, most: f64| -> Vec<f64> {
        (0..n).map(|_| dice.random_range(-most..most)).collect()
    };
    text += &body(dice, "free");
    let (orientation, rate) = (list(dice, 4, 1.0), list(dice, 3, 40.0));
    let _ = writeln!(text, "free = true\norientation = {orientation:?}\nangular_velocity = {rate:?}");
    text += &body(dice, "ball");
    let (orientation, rate) = (list(dice, 4, 1.0), list(dice, 3, 40.0));
    let _ = writeln!(
        text,
        "[[joint]]\nname = \"socket\"\nkind = \"spherical\"\nfirst = {{ body = \"wall\" }}\n\
         second = {{ body = \"ball\", point = [0, 0, 0.1] }}\norientation = {orientation:?}\nrate = {rate:?}"
    );
    for k in 0..3 {
        let parent = if k == 0 { "wall".to_owned() } else { format!("link{}", k - 1) };
        text += &body(dice, &format!("link{k}"));
        let axis = dice.random_range(0..3);
        let along = |place: usize| [0, 1, 2].map(|k| u8::from(k == place % 3));
        let (angle, rate) = (dice.random_range(-1000.0..1000.0), dice.random_range(-40.0..40.0));
        let _ = writeln!(
            text,
            "[[joint]]\nname = \"hinge{k}\"\nkind = \"revolute\"\naxis = {:?}\nzero = {:?}\n\
             first = {{ body = \"{parent}\" }}\nsecond = {{ body = \"link{k}\" }}\n\
             angle_deg = {angle:?}\nrate = {rate:?}",
            along(axis),
            along(axis + 1)
        );
    }
    text
}

#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn poses_are_continuous_over_many_turns() {
    let folder = Folder::new("turning-orientation");
    let mut dice = ChaCha8Rng::seed_from_u64(41);
    let (mut turned, n_models) = (0, 6);
    for case in 0..n_models {
        let text = turning(&mut dice);
        fs::write(folder.0.join("turning.toml"), &text).unwrap();
        let [joint, maximal] = ["joint", "maximal"]
            .map(|coordinates| table(&folder, "turning", &["--engine", "jit", "--coordinates", coordinates]));
        let (head, rows) = joint;
        let firsts = (0..head.len()).filter(|&k| head[k].ends_with(".e0 [1]"));
        for first in firsts {
            let name = &head[first];
            let along = |a: &[f64], b: &[f64]| -> f64 { (first..first + 4).map(|k| a[k] * b[k]).sum() };
            for (k, row) in rows.iter().enumerate() {
                let other = along(row, &maximal.1[k]);
                assert!(
                    other > 0.999,
                    "case {case}, {name}, row {k}: {other} to maximal coordinates\n{text}"
                );
                let before = along(row, &rows[k.saturating_sub(1)]);
                assert!(before > 0.5, "case {case}, {name}, row {k}: {before} to the row before\n{text}");
            }
            // What the file gives keeps its sign, and where it gives none the first element is positive.
            let start: Vec<f64> = rows[0][first..first + 4].to_vec();
            let body = name.trim_end_matches("_pose.e0 [1]");
            let of =
                text.find(&format!("second = {{ body = \"{body}\"")).or(text.find("free = true")).unwrap();
            let given = text[of..].split_once("orientation = ").filter(|_| !body.starts_with("link"));
            let sign: f64 = match given {
                Some((_, rest)) => {
                    let list = rest[1..].split_once(']').unwrap().0;
                    list.split(", ").zip(&start).map(|(e, own)| e.parse::<f64>().unwrap() * own).sum()
                }
                None => start.iter().copied().find(|e| e.abs() > 1e-12).unwrap(),
            };
            assert!(sign > 0.0, "case {case}, {name} starts at {start:?}\n{text}");
            turned += usize::from(rows.iter().any(|row| along(row, &rows[0]) < -0.5));
        }
    }
    println!("{turned} bodies were seen turned round");
    assert!(turned > 2 * n_models, "{turned}");
}

/// A pendulum of an axis that a negative parameter turns around: the rod's frame is then half a turn about x from the
/// wall's where the angle is zero, and the rod falls towards greater angles.
#[test]
fn a_parameter_of_either_sign_turns_an_axis_around() {
    let page = "format = 1\nname = \"turned\"\ngravity = [0, -9.81, 0]\n[parameters]\np = 2\n[[body]]\nname = \"wall\"\n\
        fixed = true\n[[body]]\nname = \"rod\"\nmass = 1\ninertia = [1e-4, 0.08, 0.08]\n[[joint]]\nname = \"turn\"\n\
        kind = \"revolute\"\nfirst = { body = \"wall\", axis = [0, 0, \"p\"], zero = [1, 0, 0] }\n\
        second = { body = \"rod\", point = [-0.5, 0, 0], axis = [0, 0, 1], zero = [1, 0, 0] }\n";
    let shifted = page.replace("p = 2", "p = 1").replace("\"p\"", "\"p - 2\"");
    for (page, value, sign) in
        [(page, 1.0, 1.0), (page, -1.0, -1.0), (&shifted, 0.5, -1.0), (&shifted, 5.0, 1.0)]
    {
        let [x, v] = integrated_one([0.0, 0.0], 0.3, |x, _, _| -sign * 9.81 * 0.5 * x.cos() / 0.33);
        for options in RUNS {
            let set = format!("p={value}");
            let found = run(page, &[options, &["--set", &set]].concat(), "0.3");
            for (key, expected) in [("position", x), ("rate", v)] {
                let found = found["joints"]["turn"][key].as_f64().unwrap();
                assert!((found - expected).abs() < 1e-9, "{value} {options:?}: {found} for {expected}");
            }
        }
    }
}
