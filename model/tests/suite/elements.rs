//! What the model file says of motions, couplers, drivers, forces, outputs and inputs is what the model holds.

use std::f64::consts::{PI, TAU};

use gyro_model::{
    CoordinateKind, Diagnostics, ForceKind, JointCoordinate, Model, Motion, Number, OutputKind, StopSide,
    read, read_with,
};

/// Two bodies on ground: a slide that turns on its rail, and a nut on the slide.
const PAGE: &str = r#"
format = 1
name = "elements"
[parameters]
stiff = 3
[inputs]
first = 1
second = 2
[[body]]
name = "ground"
fixed = true
[[body]]
name = "slide"
mass = 1
inertia = [1, 1, 1]
[[body]]
name = "nut"
mass = 1
inertia = [1, 1, 1]
[[joint]]
name = "rail"
kind = "cylindrical"
axis = [0, 0, 1]
zero = [1, 0, 0]
first = { body = "ground" }
second = { body = "slide" }
[[joint]]
name = "thread"
kind = "screw"
axis = [0, 0, 1]
zero = [1, 0, 0]
pitch = 0.02
angle_deg = 450
first = { body = "slide" }
second = { body = "nut" }
"#;

fn with(text: &str) -> Result<Model, Diagnostics> {
    read_with("page.toml", &format!("{PAGE}{text}"), &mut |path| match path {
        "ramp.csv" => Ok("t, x, y\n0, 0, 5\n1, 2, 5\n".to_owned()),
        _ => Err("there is no such file".to_owned()),
    })
}

fn good(text: &str) -> Model {
    with(text).unwrap_or_else(|mistakes| panic!("{mistakes}"))
}

/// The model with the screw's angle driven.
fn driven(motion: &str) -> Model {
    let text = format!("[[driver]]\nname = \"drive\"\njoint = \"thread\"\nmotion = {motion}\n");
    let page = PAGE.replace("angle_deg = 450\n", "");
    let load = &mut |_: &str| Ok("t, x, y\n0, 0, 5\n1, 2, 5\n".to_owned());
    read_with("page.toml", &format!("{page}{text}"), load).unwrap_or_else(|mistakes| panic!("{mistakes}"))
}

#[test]
fn degrees_turns_and_hertz_are_rounded_once() {
    let model = good("");
    // 0.02 / 2π to the last digit; 0.02 / TAU would be rounded three times.
    assert_eq!(model.value(&model.joints[1].lead), 0.003_183_098_861_837_906_7);
    let angle = model.joints[1].start.position[0].as_ref().expect("an angle");
    assert_eq!(model.value(angle), 2.5 * PI);
    let model = driven("{ sinusoid = { amplitude = 0.1, frequency_hz = 2, phase_deg = 90 } }");
    let Motion::Sinusoid { amplitude, angular_frequency, phase } = &model.drivers[0].motion else {
        panic!("{:?}", model.drivers[0].motion)
    };
    let values = [amplitude, angular_frequency, phase].map(|x| model.value(x));
    assert_eq!(values, [0.1, 2.0 * TAU, 0.5 * PI]);
}

/// Checks a motion's value and rate at a time.
fn check_motion(motion: &str, t: f64, expected: [f64; 2]) {
    let model = driven(motion);
    let [value, rate, _] = model.drivers[0].motion.value(&model, t);
    assert!(
        (value - expected[0]).abs() <= 1e-15 && (rate - expected[1]).abs() <= 1e-15,
        "{motion}: {value} {rate}"
    );
}

#[test]
fn motions_have_the_values_that_they_are_written_for() {
    check_motion("0.25", 2.0, [0.25, 0.0]);
    check_motion("\"-stiff\"", 2.0, [-3.0, 0.0]);
    check_motion("{ polynomial = [1, 0.5, 0.25] }", 2.0, [3.0, 1.5]);
    check_motion(
        "{ sinusoid = { amplitude = 2, angular_frequency = 3, phase = 0.5 } }",
        0.0,
        [2.0 * 0.5_f64.sin(), 6.0 * 0.5_f64.cos()],
    );
    check_motion("{ sum = [1, { polynomial = [0, 2] }] }", 1.5, [4.0, 2.0]);
    check_motion("{ product = [3, { polynomial = [0, 2] }, { polynomial = [1, 1] }] }", 1.0, [12.0, 18.0]);
    check_motion("{ table = \"ramp.csv\", columns = [\"t\", \"x\"] }", 0.5, [1.0, 2.0]);
    check_motion("{ table = \"ramp.csv\", columns = [\"t\", \"y\"] }", 0.5, [5.0, 0.0]);
}

#[test]
fn a_driven_body_holds_its_motion_in_order() {
    let text = "[[body]]\nname = \"base\"\n[body.driven]\ntranslation = [0, { polynomial = [0, 1] }, 2]\n\
                rotations = [{ axis = [1, 0, 0], angle = 0.5 }, { axis = [0, 0, 2], angle = 0.25 }]\n";
    let model = good(text);
    let base = model.bodies.last().expect("bodies");
    let motion = base.motion.as_ref().expect("a motion");
    let values: Vec<f64> = motion.translation.iter().map(|m| m.value(&model, 3.0)[0]).collect();
    assert_eq!(values, [0.0, 3.0, 2.0]);
    let turns: Vec<([f64; 3], f64)> = motion
        .rotations
        .iter()
        .map(|(axis, angle)| (model.values(axis), angle.value(&model, 0.0)[0]))
        .collect();
    assert_eq!(turns, [([1.0, 0.0, 0.0], 0.5), ([0.0, 0.0, 2.0], 0.25)]);
}

#[test]
fn couplers_forces_and_outputs_refer_to_what_they_name() {
    let model = good(
        r#"
[[coupler]]
name = "gear"
first = { joint = "rail", coordinate = "displacement" }
second = { joint = "thread" }
ratio = "-stiff"
offset = 0.5
[[force]]
name = "buffer"
kind = "stop"
joint = "rail"
coordinate = "displacement"
limit = -0.1
side = "lower"
stiffness = "stiff"
softness = 0.01
[[force]]
name = "push"
kind = "load"
body = "nut"
torque = [0, "-second", "first"]
[[output]]
name = "bearing"
kind = "reaction"
joint = "thread"
"#,
    );
    let gear = &model.couplers[0];
    let (first, ratio, offset) = gear.linear().expect("a gear");
    assert_eq!(first, JointCoordinate { joint: 0, coordinate: 1 });
    assert_eq!(gear.second, Some(JointCoordinate { joint: 1, coordinate: 0 }));
    assert_eq!(model.coordinate_kind(first), CoordinateKind::Displacement);
    assert_eq!((model.value(ratio), model.value(offset)), (-3.0, 0.5));
    let ForceKind::Stop { side: StopSide::Lower, damping, limit, .. } = &model.forces[0].kind else {
        panic!("{:?}", model.forces[0])
    };
    assert_eq!((model.value(limit), damping.is_zero()), (-0.1, true));
    let ForceKind::Load { body: 2, torque, .. } = &model.forces[1].kind else {
        panic!("{:?}", model.forces[1])
    };
    assert_eq!(torque[1], Number::Input { index: 1, negated: true });
    assert_eq!(torque[2], Number::Input { index: 0, negated: false });
    assert!(matches!(model.outputs[0].kind, OutputKind::Reaction { joint: 1 }));
    assert_eq!(model.value(&torque[1]), -2.0);
}

#[test]
fn a_page_with_tables_is_not_read_without_its_folder() {
    let motion = "{ table = \"ramp.csv\", columns = [\"t\", \"x\"] }";
    let page = PAGE.replace("angle_deg = 450\n", "");
    let text = format!("{page}[[driver]]\nname = \"drive\"\njoint = \"thread\"\nmotion = {motion}\n");
    let mistakes = read("page.toml", &text).expect_err("no folder");
    assert!(mistakes.to_string().contains("table `ramp.csv` cannot be read"), "{mistakes}");
}

#[test]
fn other_parameters_may_not_change_which_rows_are_redundant() {
    let pages = crate::support::pages("models");
    let (_, page) =
        pages.iter().find(|(path, _)| path.ends_with("four-bar-revolute.toml")).expect("a model file");
    let page = page.replacen("[[body]]", "[parameters]\ntilt = 0\n[[body]]", 1).replacen(
        "axis = [0, 0, 1]",
        "axis = [0, \"tilt\", 1]",
        1,
    );
    let model = read("four_bar.toml", &page).unwrap_or_else(|mistakes| panic!("{mistakes}"));
    assert_eq!(model.redundant.len(), 3);
    let set = |value: &str| {
        let value = gyro_model::parse_decimal(value).expect("a decimal");
        model.with_parameters(&[("tilt".to_owned(), value)])
    };
    assert!(set("0").is_ok());
    let refusal = set("0.01").expect_err("axes that are not parallel");
    assert!(!refusal.is_empty(), "{refusal}");
}
