//! A body with point masses is the body that they make together, with everything where it was.

use gyro_model::{Model, Number, read};

/// A free bar of 2 kg that stands upright and turns, held to a second body, with a load, a link and a sensor; `BAR` is
/// what it weighs, `MOVED` takes x or y of a point of it.
const PAGE: &str = r#"
format = 1
name = "bar"
[parameters]
extra = 1
[[body]]
name = "bar"
free = true
BAR
orientation = [2, 0, 0, 2]            # 90 degrees about z: its x points along y
position = [START]
velocity = [SPEED]
angular_velocity = [0, 0, 2]
MASSES
[[body]]
name = "wheel"
mass = 1
inertia = [1, 1, 1]
[[joint]]
name = "axle"
kind = "revolute"
axis = [0, 0, 1]
zero = [1, 0, 0]
first = { body = "bar", point = [JOINT] }
second = { body = "wheel", point = [0, 0.5, 0] }
[[force]]
name = "push"
kind = "load"
body = "bar"
point = [ORIGIN]
force = [1, 0, 0]
[[force]]
name = "string"
kind = "link"
first = { body = "wheel", point = [0, 0, 1] }
second = { body = "bar", point = [JOINT] }
damping = 1
[[output]]
name = "sensor"
kind = "pose"
body = "bar"
point = [ORIGIN]
"#;

fn model(values: [(&str, &str); 6]) -> Model {
    let page = values.iter().fold(PAGE.to_owned(), |page, (key, value)| page.replace(key, value));
    read("bar.toml", &page).unwrap_or_else(|mistakes| panic!("{mistakes}"))
}

fn with_masses(masses: &str) -> Model {
    model([
        ("BAR", "mass = 2\ninertia = [0.1, 0.2, 0.3]"),
        ("START", "1, 0, 0"),
        ("SPEED", "0, 3, 0"),
        ("JOINT", "0.4, 0, 0.1"),
        ("ORIGIN", "0, 0, 0"),
        ("MASSES", masses),
    ])
}

/// By hand: 1 kg at (0.6, 0, 0.3) moves the mass centre by a third of that, (0.2, 0, 0.1), and adds ⅔ kg (0.45, 0.36,
/// −0.18) m² by the parallel-axis theorem. The bar's x is the global y, so that its mass centre is at (1, 0.2, 0.1); it
/// turns at 2 rad/s about z, so that this goes at (−0.4, 0, 0) m/s more.
#[test]
fn points_and_the_start_stay_where_they_are() {
    let found = with_masses("[[body.point_mass]]\nmass = \"extra\"\nat = [0.6, 0, \"3/10\"]");
    let expected = model([
        ("BAR", "mass = 3\ninertia = { xx = 0.16, yy = 0.5, zz = 0.54, xz = -0.12 }"),
        ("START", "1, 0.2, 0.1"),
        ("SPEED", "-0.4, 3, 0"),
        ("JOINT", "0.2, 0, 0"),
        ("ORIGIN", "-0.2, 0, -0.1"),
        ("MASSES", ""),
    ]);
    let (ours, theirs) = (found.numbers(), expected.numbers());
    assert_eq!(ours.len(), theirs.len());
    let values = |model: &Model, numbers: &[&Number]| -> Vec<_> {
        numbers.iter().map(|number| model.exact(number)).collect()
    };
    assert_eq!(values(&found, &ours), values(&expected, &theirs));
    assert_eq!(found.values(&found.bodies[0].frame), [-0.2, 0.0, -0.1]);
    let starts = [&found, &expected].map(|model| model.assemble().expect("a start"));
    assert_eq!((&starts[0].q, &starts[0].v), (&starts[1].q, &starts[1].v));
}

/// The mass may be a parameter: then the mass centre moves with it.
#[test]
fn a_point_mass_may_be_a_parameter() {
    let model = with_masses("[[body.point_mass]]\nmass = \"extra\"\nat = [0.6, 0, 0.3]");
    let heavy =
        model.with_parameters(&[("extra".to_owned(), gyro_model::parse_decimal("4").expect("a number"))]);
    let heavy = heavy.expect("a good mass");
    assert_eq!(heavy.values(&heavy.bodies[0].frame), [-0.4, 0.0, -0.2]);
    assert_eq!(heavy.value(&heavy.bodies[0].mass), 6.0);
    let nothing =
        model.with_parameters(&[("extra".to_owned(), gyro_model::parse_decimal("-2").expect("a number"))]);
    assert!(nothing.expect_err("no mass is left").contains("divides by zero"));
}

/// Three masses of 1 kg at the corners of a right triangle are a body of their own.
#[test]
fn a_body_may_consist_of_point_masses() {
    let masses = "point_mass = [{ mass = 1, at = [0, 0, 0] }, { mass = 1, at = [3, 0, 0] }, { mass = 1, at = [0, 3, 0] }]";
    let model = model([
        ("BAR", ""),
        ("START", "0, 0, 0"),
        ("SPEED", "0, 0, 0"),
        ("JOINT", "0, 0, 0"),
        ("ORIGIN", "0, 0, 0"),
        ("MASSES", masses),
    ]);
    let bar = &model.bodies[0];
    assert_eq!(model.values(&bar.inertia), [6.0, 6.0, 12.0, 3.0, 0.0, 0.0]);
    assert_eq!(model.values(&bar.frame), [-1.0, -1.0, 0.0]);
}
