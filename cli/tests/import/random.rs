//! Random robots, as people and programs write them: what is imported has the mass, the mass centre and, at any rates,
//! the kinetic energy that a plain recursion over the links finds, and so the same equations of motion.

use super::pose::{Pose, add, cross, dot, rotation, scale, turned, turned_back};
use super::{Folder, xtask};
use chacha20::ChaCha8Rng;
use gyro_model::{Model, Number, Rational, Support};
use rand::seq::{IndexedRandom, SliceRandom};
use rand::{RngExt, SeedableRng};
use std::f64::consts::PI;
use std::fmt::Write as _;
use std::fs;

type Vector = [f64; 3];

/// About the mass centre, in axes that are turned against the link's.
#[derive(Clone, Copy)]
struct Inertial {
    mass: f64,
    at: Pose,
    inertia: [Vector; 3],
}

struct Link {
    name: String,
    inertial: Option<Inertial>,
    /// What its shape weighs, should it be asked for.
    solid: Option<Inertial>,
    text: String,
}

struct Joint {
    name: String,
    kind: &'static str,
    parent: usize,
    child: usize,
    origin: Pose,
    axis: Vector,
    mimic: Option<(usize, f64, f64)>,
    text: String,
}

/// How a robot is to be taken.
#[derive(Clone, Copy, Default)]
struct Taken {
    /// By its numbers, whatever they are.
    as_written: bool,
    /// With masses of shapes.
    weighed: bool,
}

/// Of shapes that are weighed, kg/m3.
const DENSITY: f64 = 500.0;

/// Links with the root first and each child behind its parent; joint k carries link k + 1.
struct Robot {
    links: Vec<Link>,
    joints: Vec<Joint>,
    text: String,
    /// Which joint of the file is which.
    order: Vec<usize>,
}

const NAMES: [&str; 10] =
    ["link", "Arm Upper", "a.b/c", "LINK", "2nd", "fn", "Gr\u{f6}\u{df}e", "x&y", "l\"q", "_"];

const ANGLES: [(&str, f64); 8] = [
    ("0", 0.0),
    ("1.5708", PI / 2.0),
    ("-1.57079632679", -PI / 2.0),
    ("3.14159", PI),
    ("0.7854", PI / 4.0),
    ("-0.5235988", -PI / 6.0),
    ("2.0944", 2.0 * PI / 3.0),
    ("1.57", 1.57),
];

fn escaped(name: &str) -> String {
    name.replace('&', "&amp;").replace('"', "&quot;")
}

fn decimal(rng: &mut ChaCha8Rng, most: f64) -> f64 {
    (rng.random_range(-most..most) * 1e4_f64).round() / 1e4
}

/// An `<origin>` and its pose.
fn origin(rng: &mut ChaCha8Rng, taken: Taken) -> (String, Pose) {
    if rng.random_bool(0.2) {
        return (String::new(), Pose::shift([0.0; 3]));
    }
    let xyz = std::array::from_fn(|_| if rng.random_bool(0.3) { 0.0 } else { decimal(rng, 0.5) });
    let rpy: [(String, f64); 3] = std::array::from_fn(|_| {
        if rng.random_bool(0.6) {
            let (text, angle) = ANGLES[rng.random_range(0..ANGLES.len())];
            (text.to_owned(), if taken.as_written { text.parse().unwrap() } else { angle })
        } else {
            // Three decimals, which are meant.
            let angle = (rng.random_range(-3.0..3.0) * 1e3_f64).round() / 1e3;
            (format!("{angle:?}"), angle)
        }
    });
    let [x, y, z] = xyz;
    let [roll, pitch, yaw] = rpy.each_ref().map(|angle| angle.0.as_str());
    let text = format!("<origin xyz=\"{x:?} {y:?} {z:?}\" rpy=\"{roll} {pitch} {yaw}\"/>");
    (text, Pose::origin(xyz, rpy.map(|angle| angle.1)))
}

/// A box and what it weighs, from the integrals of its squares.
fn solid(rng: &mut ChaCha8Rng, taken: Taken) -> (String, Inertial) {
    let (pose, at) = origin(rng, taken);
    let [x, y, z]: Vector = std::array::from_fn(|_| decimal(rng, 0.2).abs() + 0.02);
    let mass = DENSITY * x * y * z;
    let about = |a: f64, b: f64| mass / 12.0 * (a * a + b * b);
    let inertia = [[about(y, z), 0.0, 0.0], [0.0, about(x, z), 0.0], [0.0, 0.0, about(x, y)]];
    let text = format!("<collision>{pose}<geometry><box size=\"{x:?} {y:?} {z:?}\"/></geometry></collision>");
    (text, Inertial { mass, at, inertia })
}

fn link(rng: &mut ChaCha8Rng, index: usize, taken: Taken) -> Link {
    let name = format!("{}{index}", NAMES.choose(rng).unwrap());
    let shown = escaped(&name);
    if rng.random_bool(0.3) {
        let frames = ["", "<inertial><mass value=\"0\"/></inertial>", "<visual/><collision name=\"c\"/>"];
        let frame = frames.choose(rng).unwrap();
        let (shape, solid) = solid(rng, taken);
        let text =
            format!("<link name=\"{shown}\">{frame}{}</link>\n", if taken.weighed { &shape } else { "" });
        return Link { name, inertial: None, solid: taken.weighed.then_some(solid), text };
    }
    let (pose, at) = origin(rng, taken);
    let mass = decimal(rng, 2.0).abs() + 0.01;
    // Of three rods.
    let rods: [Vector; 3] = std::array::from_fn(|_| std::array::from_fn(|_| rng.random_range(-0.2..0.2)));
    let squares: f64 = rods.iter().map(|rod| dot(*rod, *rod)).sum();
    // And, where any numbers will do, far more about one axis than a body can have.
    let excess = if taken.as_written && rng.random_bool(0.5) { 8.0 } else { 0.0 };
    let inertia: [Vector; 3] = std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let products: f64 = rods.iter().map(|rod| rod[i] * rod[j]).sum();
            mass * (if i == j { squares } else { 0.0 } - products + excess * rods[0][i] * rods[0][j])
        })
    });
    let [[xx, xy, xz], [_, yy, yz], [_, _, zz]] = inertia;
    let text = format!(
        "<link name=\"{shown}\"><inertial>{pose}<mass value=\"{mass:?}\"/><inertia ixx=\"{xx:?}\" ixy=\"{xy:?}\" \
         ixz=\"{xz:?}\" iyy=\"{yy:?}\" iyz=\"{yz:?}\" izz=\"{zz:?}\"/></inertial></link>\n"
    );
    if !taken.weighed && rng.random_bool(0.1) {
        let text =
            format!("<link name=\"{shown}\"><inertial>{pose}<mass value=\"{mass:?}\"/></inertial></link>\n");
        return Link {
            name,
            inertial: Some(Inertial { mass, at, inertia: [[0.0; 3]; 3] }),
            solid: None,
            text,
        };
    }
    Link { name, inertial: Some(Inertial { mass, at, inertia }), solid: None, text }
}

fn joint(rng: &mut ChaCha8Rng, earlier: &[Joint], links: &[Link], child: usize, taken: Taken) -> Joint {
    let kinds = ["fixed", "fixed", "fixed", "revolute", "revolute", "continuous", "prismatic", "planar"];
    // The model file tells free bodies apart by name alone: one is enough.
    let is_first = earlier.iter().all(|joint| joint.kind != "floating");
    let kind =
        if is_first && rng.random_bool(0.05) { "floating" } else { kinds[rng.random_range(0..kinds.len())] };
    let parent = rng.random_range(0..child);
    let name = format!("{}{child}", NAMES.choose(rng).unwrap());
    let (pose, origin) = origin(rng, taken);
    let axes: [Vector; 5] =
        [[0.0, 0.0, 1.0], [0.0, -1.0, 0.0], [2.0, 0.0, 0.0], [0.0, 1.0, 1.0], [0.3, -0.5, 0.7]];
    let axis = *axes.choose(rng).unwrap();
    let shown = if kind == "fixed" { [0.0; 3] } else { axis };
    let is_single = |kind| ["revolute", "continuous", "prismatic"].contains(&kind);
    let others: Vec<usize> = (0..earlier.len()).filter(|k| is_single(earlier[*k].kind)).collect();
    let mimic = others.choose(rng).filter(|_| is_single(kind) && rng.random_bool(0.2));
    let mimic = mimic.map(|other| (*other, decimal(rng, 1.0) + 1.5, decimal(rng, 0.1)));
    let [x, y, z] = shown;
    let mut text = format!(
        "<joint name=\"{}\" type=\"{kind}\">{pose}<parent link=\"{}\"/><child link=\"{}\"/><axis xyz=\"{x:?} {y:?} {z:?}\"/>",
        escaped(&name),
        escaped(&links[parent].name),
        escaped(&links[child].name)
    );
    if let Some((other, multiplier, offset)) = mimic {
        let other = escaped(&earlier[other].name);
        let _ =
            write!(text, "<mimic joint=\"{other}\" multiplier=\"{multiplier:?}\" offset=\"{offset:?}\"/>");
    }
    text += "<limit lower=\"-1\" upper=\"2\" effort=\"5\" velocity=\"1\"/><safety_controller k_velocity=\"1\"/></joint>\n";
    let norm = dot(axis, axis).sqrt();
    Joint { name, kind, parent, child, origin, axis: scale(1.0 / norm, axis), mimic, text }
}

fn robot(rng: &mut ChaCha8Rng, taken: Taken) -> Robot {
    let n_links = rng.random_range(2..10);
    let links: Vec<Link> = (0..n_links).map(|index| link(rng, index, taken)).collect();
    let mut joints: Vec<Joint> = Vec::new();
    for child in 1..n_links {
        joints.push(joint(rng, &joints, &links, child, taken));
    }
    let mut order: Vec<usize> = (0..joints.len()).collect();
    order.shuffle(rng);
    let mut parts: Vec<&str> = links.iter().map(|link| link.text.as_str()).collect();
    parts.extend(["<transmission name=\"t\"><type>x</type></transmission>\n", "<gazebo/>\n", "<!-- - -->\n"]);
    let odd = [
        "<!-- a -- b -->\n",
        "<drake:note a=\"&b;\" a=\"<\"/>\n",
        "<?other?>\n",
        "<![CDATA[<joint>]]>\n",
        "a & b\n",
        "<?xml version=\"1.0\"?>\n",
    ];
    parts.extend(odd.sample(rng, 2));
    parts.shuffle(rng);
    let joints_text: String = order.iter().map(|index| joints[*index].text.as_str()).collect();
    let heads = [
        "",
        "<?xml version=\"1.0\"?>\n",
        "\n <!-- -- -->\n<?xml version=\"1.0\"?>\n",
        "\u{feff}",
        "<!DOCTYPE robot>\n",
    ];
    let head = heads.choose(rng).unwrap();
    let text = format!("{head}<robot name=\"match\">\n{}{joints_text}</robot>\n", parts.concat());
    let mut robot = Robot { links, joints, text, order };
    let bare: Vec<usize> = (0..n_links).filter(|link| robot.lump(robot.first(*link).0).0 == 0.0).collect();
    for link in bare {
        robot.links[link].inertial = robot.links[link].solid;
    }
    robot
}

impl Robot {
    /// The first link of what a link is fixed to, and the link's frame in that one's.
    fn first(&self, link: usize) -> (usize, Pose) {
        match link.checked_sub(1).map(|joint| &self.joints[joint]) {
            Some(joint) if joint.kind == "fixed" => {
                let (first, pose) = self.first(joint.parent);
                (first, pose * joint.origin)
            }
            _ => (link, Pose::shift([0.0; 3])),
        }
    }

    /// Mass and mass centre of what is fixed to a link.
    fn lump(&self, first: usize) -> (f64, Vector) {
        let (mut mass, mut moment) = (0.0, [0.0; 3]);
        for (index, link) in self.links.iter().enumerate() {
            let (of, pose) = self.first(index);
            if let Some(inertial) = link.inertial.filter(|_| of == first) {
                mass += inertial.mass;
                moment = add(moment, scale(inertial.mass, (pose * inertial.at).translation));
            }
        }
        (mass, scale(1.0 / mass, moment))
    }

    /// Whether there is mass beyond a lump's joints.
    fn carries_mass(&self, first: usize) -> bool {
        let moving =
            self.joints.iter().filter(|joint| joint.kind != "fixed" && self.first(joint.parent).0 == first);
        moving.into_iter().any(|joint| self.lump(joint.child).0 > 0.0 || self.carries_mass(joint.child))
    }

    /// What must be said of the robot, if it cannot be imported, and whether a link borrows mass.
    fn expected(&self, is_floating: bool) -> (Option<String>, bool) {
        let moving =
            (0..self.links.len()).filter(|link| self.first(*link).0 == *link && (*link > 0 || is_floating));
        let (mut problem, mut borrows) = (None, false);
        let mut n_moving = 0;
        for first in moving {
            n_moving += 1;
            if self.lump(first).0 > 0.0 {
                continue;
            }
            let floats = first == 0 || self.joints[first - 1].kind == "floating";
            if floats || !self.carries_mass(first) {
                problem = Some(format!("link `{}` moves and has no mass", self.links[first].name));
            }
            borrows = true;
        }
        if n_moving == 0 {
            problem = Some("--floating lets it move".to_owned());
        }
        (problem, borrows)
    }
}

/// Pose, velocity of the origin and angular velocity of a link, global.
#[derive(Clone, Copy)]
struct Motion(Pose, Vector, Vector);

fn number(value: f64) -> Number {
    Number::Exact(Rational::from_float(value).unwrap())
}

/// A random state of the model, and what the robot's links do in it.
fn moved(rng: &mut ChaCha8Rng, robot: &Robot, model: &mut Model, is_floating: bool) -> Vec<Motion> {
    let mut free: Vec<(usize, Motion)> = Vec::new();
    let floating: Vec<usize> =
        robot.joints.iter().filter(|joint| joint.kind == "floating").map(|joint| joint.child).collect();
    let firsts: Vec<usize> = is_floating.then_some(0).into_iter().chain(floating).collect();
    let bodies = model.bodies.iter_mut().filter(|body| body.support == Support::Free);
    for (body, first) in bodies.zip(firsts) {
        let mut random = || std::array::from_fn(|_| rng.random_range(-1.0..1.0));
        let (r, s, w): (Vector, Vector, Vector) = (random(), random(), random());
        let angle = rng.random_range(-3.0..3.0_f64);
        let p = [(angle / 2.0).cos(), 0.6 * (angle / 2.0).sin(), 0.0, 0.8 * (angle / 2.0).sin()];
        (body.position, body.velocity) = (r.map(number), s.map(number));
        (body.orientation, body.angular_velocity) = (p.map(number), Some(w.map(number)));
        let turn = rotation(p);
        let (centre, w) = (turned(&turn, robot.lump(first).1), turned(&turn, w));
        let pose = Pose { rotation: turn, translation: add(r, scale(-1.0, centre)) };
        free.push((first, Motion(pose, add(s, scale(-1.0, cross(w, centre))), w)));
    }
    let n = robot.joints.len();
    let (mut values, mut rates) = (vec![[0.0; 3]; n], vec![[0.0; 3]; n]);
    for (index, joint) in robot.joints.iter().enumerate() {
        values[index] = std::array::from_fn(|_| rng.random_range(-1.0..1.0));
        rates[index] = std::array::from_fn(|_| rng.random_range(-1.0..1.0));
        if let Some((other, multiplier, offset)) = joint.mimic {
            (values[index][0], rates[index][0]) =
                (multiplier * values[other][0] + offset, multiplier * rates[other][0]);
        }
    }
    let written =
        robot.order.iter().filter(|index| !["fixed", "floating"].contains(&robot.joints[**index].kind));
    for (index, joint) in written.zip(&mut model.joints) {
        let n = joint.kind.coordinates().len();
        joint.start.position = values[*index][..n].iter().map(|x| Some(number(*x))).collect();
        joint.start.rate = Some(rates[*index][..n].iter().map(|x| number(*x)).collect());
    }
    let told = |link: usize| free.iter().find(|(first, _)| *first == link).map(|(_, motion)| *motion);
    let mut motions = vec![told(0).unwrap_or(Motion(Pose::shift([0.0; 3]), [0.0; 3], [0.0; 3]))];
    for (joint, (value, rate)) in robot.joints.iter().zip(values.into_iter().zip(rates)) {
        let of_joint = carried(joint, motions[joint.parent], value, rate);
        motions.push(told(joint.child).unwrap_or(of_joint));
    }
    motions
}

/// What a joint makes of its parent's motion; that of a floating one is told elsewhere.
fn carried(joint: &Joint, Motion(parent, v, w): Motion, value: Vector, rate: Vector) -> Motion {
    let (at, axis) = (parent * joint.origin, joint.axis);
    let global = |direction| turned(&at.rotation, direction);
    // The direction of x in a plane: that of the smallest component of the normal, across it.
    let least = (0..3).fold(0, |least, k| if axis[k].abs() < axis[least].abs() { k } else { least });
    let along: Vector = std::array::from_fn(|k| f64::from(u8::from(k == least)) - axis[least] * axis[k]);
    let x = scale(1.0 / dot(along, along).sqrt(), along);
    let y = cross(axis, x);
    let in_plane = |[a, b, _]: Vector| add(scale(a, x), scale(b, y));
    let (shift, slide, turn, spin) = match joint.kind {
        "revolute" | "continuous" => ([0.0; 3], [0.0; 3], value[0], rate[0]),
        "prismatic" => (scale(value[0], axis), scale(rate[0], axis), 0.0, 0.0),
        "planar" => (in_plane(value), in_plane(rate), value[2], rate[2]),
        _ => ([0.0; 3], [0.0; 3], 0.0, 0.0),
    };
    let pose = at * Pose::shift(shift) * Pose::turn(axis, turn);
    let arm = add(pose.translation, scale(-1.0, parent.translation));
    Motion(pose, add(add(v, cross(w, arm)), global(slide)), add(w, scale(spin, global(axis))))
}

/// Mass, first moment and kinetic energy.
fn of_robot(robot: &Robot, motions: &[Motion], is_floating: bool) -> [f64; 5] {
    let mut sums = [0.0; 5];
    for (index, link) in robot.links.iter().enumerate() {
        let Some(inertial) = link.inertial.filter(|_| is_floating || robot.first(index).0 != 0) else {
            continue;
        };
        let Motion(pose, v, w) = motions[index];
        let centre = pose * inertial.at;
        let v = add(v, cross(w, add(centre.translation, scale(-1.0, pose.translation))));
        let w = turned_back(&centre.rotation, w);
        let energy = 0.5 * (inertial.mass * dot(v, v) + dot(w, turned(&inertial.inertia, w)));
        let [x, y, z] = scale(inertial.mass, centre.translation);
        for (sum, part) in sums.iter_mut().zip([inertial.mass, x, y, z, energy]) {
            *sum += part;
        }
    }
    sums
}

fn of_model(model: &Model) -> [f64; 5] {
    let start = model.assemble().unwrap();
    let mut sums = [0.0; 5];
    for (k, index) in model.coordinate_bodies().into_iter().enumerate() {
        let body = &model.bodies[index];
        let mass = model.value(&body.mass);
        let [xx, yy, zz, xy, xz, yz] = model.values(&body.inertia);
        let (r, s) = (&start.q[7 * k..7 * k + 3], &start.v[6 * k..6 * k + 3]);
        let w: Vector = std::array::from_fn(|i| start.v[6 * k + 3 + i]);
        let s = std::array::from_fn(|i| s[i]);
        let energy =
            0.5 * (mass * dot(s, s) + dot(w, turned(&[[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]], w)));
        for (sum, part) in sums.iter_mut().zip([mass, mass * r[0], mass * r[1], mass * r[2], energy]) {
            *sum += part;
        }
    }
    sums
}

/// Rounding of some rotations and of the file's decimals; where a link borrows a millionth of a mass, or a point is
/// taken to be a millimetre thick, some of these.
const AGREES: [f64; 2] = [1e-12, 1e-4];

const ROBOTS: u64 = 150;

#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn random_robots_keep_mass_and_energy() {
    let folder = Folder::new("random");
    let (mut imported, mut refused) = (0, 0);
    for seed in 0..ROBOTS {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let taken = Taken { as_written: seed % 3 == 1, weighed: seed % 3 == 2 };
        let robot = robot(&mut rng, taken);
        let is_floating = rng.random_bool(0.5);
        let (file, out) = (folder.0.join(format!("{seed}.urdf")), folder.0.join(format!("{seed}.toml")));
        fs::write(&file, &robot.text).unwrap();
        let mut options: Vec<&str> =
            if is_floating { vec!["--floating", "--motors"] } else { vec!["--motors", "--limits"] };
        options.extend(taken.as_written.then_some("--as-written"));
        options.extend(if taken.weighed { &["--density", "500"][..] } else { &[] });
        let output = xtask(
            &[&["import", file.to_str().unwrap(), "--out", out.to_str().unwrap()], &options[..]].concat(),
        );
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        let (problem, borrows) = robot.expected(is_floating);
        let is_point = |link: &Link| link.inertial.is_some_and(|inertial| inertial.inertia == [[0.0; 3]; 3]);
        let is_rough = borrows || robot.links.iter().any(is_point);
        if let Some(problem) = problem {
            assert!(output.status.code() == Some(2) && said.contains(&problem), "{seed}: {problem}\n{said}");
            refused += 1;
            continue;
        }
        assert!(output.status.success(), "{seed}: {said}\n{}", robot.text);
        let page = fs::read_to_string(&out).unwrap();
        let mut model =
            gyro_model::read("random.toml", &page).unwrap_or_else(|mistakes| panic!("{mistakes}\n{page}"));
        let motions = moved(&mut rng, &robot, &mut model, is_floating);
        let (found, expected) = (of_model(&model), of_robot(&robot, &motions, is_floating));
        for (found, expected) in found.iter().zip(expected) {
            let most = AGREES[usize::from(is_rough)] * (1.0 + expected.abs());
            assert!(
                (found - expected).abs() < most,
                "{seed}: {found} for {expected}\n{}\n{page}",
                robot.text
            );
        }
        imported += 1;
    }
    assert!(imported > ROBOTS / 3 && refused > ROBOTS / 10, "{imported} imported, {refused} refused");
}

/// A file with a piece cut out, doubled or replaced is imported or refused with words about it.
#[test]
fn broken_robots_are_refused_in_words() {
    let folder = Folder::new("broken");
    let pieces = [
        "",
        "<xacro:leg/>",
        "\"",
        "1e400",
        "nan",
        "${x}",
        "<link/>",
        "</robot>",
        "0",
        "-1",
        "<loop_joint/>",
        "<a:b",
        "&",
        "<!--",
        "<?xml?>",
        "<![CDATA[",
    ];
    for seed in 0..ROBOTS {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut text: Vec<char> = robot(&mut rng, Taken::default()).text.chars().collect();
        let from = rng.random_range(0..text.len());
        let to = (from + rng.random_range(0..20)).min(text.len());
        let piece = pieces.choose(&mut rng).unwrap();
        text.splice(from..to, piece.chars());
        let (file, out) = (folder.0.join(format!("{seed}.urdf")), folder.0.join(format!("{seed}.toml")));
        fs::write(&file, text.into_iter().collect::<String>()).unwrap();
        let output = xtask(&["import", file.to_str().unwrap(), "--out", out.to_str().unwrap(), "--floating"]);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        let is_told = output.status.code() == Some(2) && said.contains(&format!("{seed}.urdf:"));
        assert!(output.status.success() || is_told, "{seed}: {said}");
        assert!(!said.contains("panicked"), "{seed}: {said}");
    }
}
