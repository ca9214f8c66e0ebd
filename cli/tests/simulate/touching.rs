//! `[[contact]]` between shapes of bodies: their gaps against what support functions say, their laws against closed
//! forms and what is conserved.

use crate::rolling::kutta;
use crate::rolling_bodies::{EXACT, FORMS, near, number, told};
use crate::support::{Folder, json, model, refused, simulate};
use serde_json::Value;
use std::f64::consts::PI;
use std::fs;

pub(super) type V = [f64; 3];

/// A shape, with its size as model files have it.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Form {
    Sphere(f64),
    Capsule(f64, f64),
    Cylinder(f64, f64),
    Box(V),
    Torus(f64, f64),
    Ellipsoid(V),
    Plane,
    Corners,
}

const CORNERS: [V; 4] = [[0.1, 0.0, -0.05], [-0.06, 0.08, -0.05], [-0.05, -0.07, -0.04], [0.0, 0.01, 0.12]];

impl Form {
    fn page(self) -> String {
        match self {
            Self::Sphere(r) => format!("sphere = {r}"),
            Self::Capsule(r, l) => format!("capsule = [{r}, {l}]"),
            Self::Cylinder(r, l) => format!("cylinder = [{r}, {l}]"),
            Self::Box(edges) => format!("box = {edges:?}"),
            Self::Torus(r, rim) => format!("torus = [{r}, {rim}]"),
            Self::Ellipsoid(axes) => format!("ellipsoid = {axes:?}"),
            Self::Plane => "plane = [1, 1]".to_owned(),
            Self::Corners => format!("vertices = {CORNERS:?}"),
        }
    }

    /// How far it reaches along a direction, in its own frame; of a plane only along z.
    fn reach(self, [x, y, z]: V) -> f64 {
        let (level, length) = (x.hypot(y), x.hypot(y).hypot(z));
        match self {
            Self::Sphere(r) => r * length,
            Self::Capsule(r, l) => l / 2.0 * z.abs() + r * length,
            Self::Cylinder(r, l) => l / 2.0 * z.abs() + r * level,
            Self::Box([a, b, c]) => (a * x.abs() + b * y.abs() + c * z.abs()) / 2.0,
            Self::Torus(r, rim) => r * level + rim * length,
            Self::Ellipsoid([a, b, c]) => (a * x).hypot(b * y).hypot(c * z),
            Self::Corners => {
                CORNERS.iter().map(|[a, b, c]| a * x + b * y + c * z).fold(f64::NEG_INFINITY, f64::max)
            }
            Self::Plane => unreachable!("planes are asked along z"),
        }
    }
}

/// A small generator of random numbers (xorshift).
struct Dice(u64);

impl Dice {
    fn roll(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self) -> V {
        std::array::from_fn(|_| self.roll())
    }

    fn turn(&mut self) -> [f64; 4] {
        loop {
            let p: [f64; 4] = std::array::from_fn(|_| self.roll());
            let length = p.iter().map(|x| x * x).sum::<f64>().sqrt();
            if length > 0.3 {
                return p.map(|x| x / length);
            }
        }
    }
}

pub(super) fn dot(a: V, b: V) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Columns of the rotation matrix of Euler parameters.
fn axes([e0, e1, e2, e3]: [f64; 4]) -> [V; 3] {
    [
        [1.0 - 2.0 * (e2 * e2 + e3 * e3), 2.0 * (e1 * e2 + e0 * e3), 2.0 * (e1 * e3 - e0 * e2)],
        [2.0 * (e1 * e2 - e0 * e3), 1.0 - 2.0 * (e1 * e1 + e3 * e3), 2.0 * (e2 * e3 + e0 * e1)],
        [2.0 * (e1 * e3 + e0 * e2), 2.0 * (e2 * e3 - e0 * e1), 1.0 - 2.0 * (e1 * e1 + e2 * e2)],
    ]
}

/// A form with its place and its axes.
type Placed = (Form, V, [f64; 4]);

fn reach((form, place, turn): Placed, n: V) -> f64 {
    dot(place, n) + form.reach(axes(turn).map(|axis| dot(axis, n)))
}

/// The distance of two convex bodies: the widest slab between them, over all directions.
fn slab(one: Placed, other: Placed) -> f64 {
    let width = |n: V| -reach(one, n) - reach(other, n.map(|x| -x));
    let at = |i: i32, k: i32| {
        let [polar, turn] = [i, k].map(|angle| PI * f64::from(angle) / 60.0);
        [polar.sin() * turn.cos(), polar.sin() * turn.sin(), polar.cos()]
    };
    let all = (1..60).flat_map(|i| (0..120).map(move |k| at(i, k)));
    let mut n = all.max_by(|a, b| width(*a).total_cmp(&width(*b))).unwrap();
    let mut step = PI / 60.0;
    // Rounding may lead around a flat top for ever.
    let mut left = 2000;
    while step > 1e-13 && left > 0 {
        left -= 1;
        let first = unit(cross(n, if n[0].abs() < 0.7 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] }));
        let second = cross(n, first);
        let around = (0..16).map(|k| {
            let (s, c) = (PI * f64::from(k) / 8.0).sin_cos();
            std::array::from_fn(|i| c * first[i] + s * second[i])
        });
        // Edges are ridges, along which a turn about an axis of the body leads, and onto which one towards it.
        let along = [one, other].into_iter().flat_map(|(.., turn)| axes(turn)).flat_map(|axis| {
            let (way, up) = (cross(axis, n), dot(axis, n));
            let toward: V = std::array::from_fn(|i| axis[i] - up * n[i]);
            [way, way.map(|x| -x), toward, toward.map(|x| -x)]
        });
        let moves = around.chain(along).map(|way: V| unit(std::array::from_fn(|i| n[i] + step * way[i])));
        let next = moves.max_by(|a, b| width(*a).total_cmp(&width(*b))).unwrap();
        if width(next) > width(n) + 1e-16 {
            n = next;
        } else {
            step *= 0.5;
        }
    }
    width(n)
}

pub(super) fn cross(a: V, b: V) -> V {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(v: V) -> V {
    let length = dot(v, v).sqrt();
    v.map(|x| x / length)
}

const PAIRS: [(Form, Form); 13] = [
    (Form::Plane, Form::Ellipsoid([0.1, 0.25, 0.06])),
    (Form::Plane, Form::Sphere(0.11)),
    (Form::Plane, Form::Capsule(0.05, 0.3)),
    (Form::Plane, Form::Cylinder(0.07, 0.25)),
    (Form::Plane, Form::Box([0.1, 0.2, 0.3])),
    (Form::Plane, Form::Torus(0.2, 0.03)),
    (Form::Plane, Form::Corners),
    (Form::Sphere(0.12), Form::Sphere(0.11)),
    (Form::Capsule(0.05, 0.3), Form::Sphere(0.11)),
    (Form::Cylinder(0.07, 0.25), Form::Sphere(0.11)),
    (Form::Box([0.1, 0.2, 0.3]), Form::Sphere(0.11)),
    (Form::Capsule(0.05, 0.3), Form::Capsule(0.04, 0.4)),
    (Form::Sphere(0.12), Form::Capsule(0.05, 0.3)),
];

/// Two bodies of these forms, each with its shape at a place of its own.
fn bodies(k: usize, placed: [Placed; 2], motion: &str) -> String {
    let body = |side: usize, (form, place, turn): Placed| {
        // The body's frame is turned against the shape's, and away from it.
        let inner: [V; 3] = [[0.05, -0.02, 0.03], [-0.04, 0.06, 0.01], [0.0; 3]];
        let own = if side == 0 { [0.5, -0.5, 0.5, 0.5] } else { [0.5, 0.5, 0.5, 0.5] };
        let turned = times(turn, [own[0], -own[1], -own[2], -own[3]]);
        let at = axes(turned);
        let from: V =
            std::array::from_fn(|i| place[i] - (0..3).map(|j| at[j][i] * inner[side][j]).sum::<f64>());
        format!(
            "[[body]]\nname = \"b{k}_{side}\"\nfree = true\nmass = 1.3\ninertia = [2e-2, 3e-2, 4e-2]\nposition = {from:?}\n\
             orientation = {turned:?}\n{}[[body.shape]]\n{}\nposition = {:?}\norientation = {own:?}\n",
            if side == 1 { motion } else { "" },
            form.page(),
            inner[side],
        )
    };
    body(0, placed[0]) + &body(1, placed[1])
}

/// The product of two quaternions.
fn times([a, b, c, d]: [f64; 4], [e, f, g, h]: [f64; 4]) -> [f64; 4] {
    [
        a * e - b * f - c * g - d * h,
        a * f + b * e + c * h - d * g,
        a * g - b * h + c * e + d * f,
        a * h + b * g - c * f + d * e,
    ]
}

fn contact(k: usize, law: &str) -> String {
    format!(
        "[[contact]]\nname = \"c{k}\"\nbetween = [{{ body = \"b{k}_0\" }}, {{ body = \"b{k}_1\" }}]\n{law}\n"
    )
}

fn gap(placed: [Placed; 2]) -> f64 {
    match placed {
        [(Form::Plane, at, turn), (form, place, own)] => {
            let normal = axes(turn)[2];
            dot(normal, std::array::from_fn(|i| place[i] - at[i]))
                - form.reach(axes(own).map(|axis| -dot(axis, normal)))
        }
        [one, other] => slab(one, other),
    }
}

fn random(dice: &mut Dice, (one, other): (Form, Form)) -> [Placed; 2] {
    loop {
        let away = dice.vector().map(|x| 0.6 * x);
        let placed = [(one, [0.0; 3], dice.turn()), (other, away, dice.turn())];
        // Balls may be within the other by less than their radius; a plane may be anywhere.
        let form = placed[0].0;
        if form == Form::Plane
            || slab(placed[0], (Form::Sphere(0.0), placed[1].1, placed[1].2)) > 0.02 && gap(placed) > -0.01
        {
            return placed;
        }
    }
}

#[test]
fn gaps_are_distances() {
    let mut dice = Dice(0x9E37_79B9_7F4A_7C15);
    let all: Vec<[Placed; 2]> = (0..2).flat_map(|_| PAIRS).map(|pair| random(&mut dice, pair)).collect();
    for (part, placed) in all.chunks(PAIRS.len()).enumerate() {
        let mut page = "format = 1\nname = \"gaps\"\n".to_owned();
        for (k, placed) in placed.iter().enumerate() {
            page += &(bodies(k, *placed, "") + &contact(k, "stiffness = 1"));
        }
        let folder = Folder::new(&format!("touching-gaps-{part}"));
        fs::write(folder.0.join("page.toml"), &page).unwrap();
        for form in [&FORMS[0], &FORMS[3]] {
            let run = json(&folder, &[&["page.toml", "--t-end", "1e-9", "--no-prove"], *form].concat());
            for (k, placed) in placed.iter().enumerate() {
                let (found, expected) = (number(&run, &format!("c{k}_gap")), gap(*placed));
                // Rims are smooth within 1e-6 of upright; two axes are searched to rounding.
                assert!((found - expected).abs() < 1e-11, "{placed:?}: {found}, not {expected}");
            }
        }
    }
}

/// Without damping and friction what two bodies have before they meet they have afterwards, and the force of a contact
/// has the power that its energy loses: its direction is that in which the gap grows.
#[test]
fn elastic_contacts_keep_energy() {
    let mut dice = Dice(0x2545_F491_4F6C_DD1D);
    let mut page = "format = 1\nname = \"elastic\"\n".to_owned();
    let mut energy = 0.0;
    for (k, pair) in PAIRS.into_iter().enumerate() {
        let mut placed = random(&mut dice, pair);
        placed[1].1 = match pair.0 {
            Form::Plane => axes(placed[0].2)[2].map(|x| 0.6 * x),
            _ => unit(placed[1].1).map(|x| 0.7 * x),
        };
        let velocity = placed[1].1.map(|x| -3.0 * x);
        let spin = dice.vector();
        let motion = format!("velocity = {velocity:?}\nangular_velocity = {spin:?}\n");
        energy += 0.65 * dot(velocity, velocity) + dot([1e-2, 1.5e-2, 2e-2], spin.map(|w| w * w));
        page += &(bodies(k, placed, &motion) + &contact(k, "stiffness = 2e4\nexponent = 1"));
    }
    page += "[[output]]\nname = \"energy\"\nkind = \"energy\"\n";
    for form in &FORMS[..2] {
        let folder = Folder::new("touching-elastic");
        fs::write(folder.0.join("page.toml"), &page).unwrap();
        let run =
            json(&folder, &[&["page.toml", "--t-end", "0.6", "--no-prove"], &EXACT[..], *form].concat());
        for k in 0..PAIRS.len() {
            let [push, gap] = ["normal", "gap"].map(|what| number(&run, &format!("c{k}_{what}")));
            assert!(push == 0.0 && gap > 1e-3, "{k}: {push} at {gap}");
        }
        near([told::<2>(&run, "energy").iter().sum()], [energy], 1e-8);
    }
}

const GROUND: &str = "format = 1\nname = \"touches\"\n[[body]]\nname = \"ground\"\nfixed = true\n[[body.shape]]\nplane = [2, 1]\n";

pub(super) fn run(name: &str, page: &str, options: &[&str], form: &[&str]) -> Value {
    let folder = Folder::new(&format!("touching-{name}"));
    fs::write(folder.0.join("page.toml"), page).unwrap();
    json(&folder, &[&["page.toml", "--no-prove"], options, form].concat())
}

/// A ball that slides until it rolls: whatever friction does, what it has about the line along which it moves stays.
/// A hollow one keeps 3/5 of its velocity, a full one 5/7.
#[test]
fn a_ball_that_slides_comes_to_roll() {
    for (part, left) in [(0.4, 5.0 / 7.0), (2.0 / 3.0, 0.6)] {
        let (m, r, k) = (0.5, 0.1, 1e5);
        let depth = m * 9.81 / k;
        let page = format!(
            "{GROUND}[[body]]\nname = \"ball\"\nfree = true\nmass = {m}\ninertia = [{i:?}, {i:?}, {i:?}]\nposition = [0, 0, {:?}]\n\
             velocity = [3, 1, 0]\n[[body.shape]]\nsphere = {r}\n[[contact]]\nname = \"rolls\"\n\
             between = [{{ body = \"ball\" }}, {{ body = \"ground\" }}]\nstiffness = {k}\nexponent = 1\nfriction_coefficient = 0.3\n",
            r - depth,
            i = part * m * r * r,
        )
        .replace("name = \"touches\"\n", "name = \"touches\"\ngravity = [0, 0, -9.81]\n");
        for form in [&FORMS[0], &FORMS[3]] {
            let run = run("slides", &page, &["--t-end", "0.5"], form);
            let seen: [f64; 18] = told(&run, "rolls_seen");
            near([seen[12], seen[13]], [3.0 * left, left], 1e-8);
            near([seen[15], seen[16]], [-left / r, 3.0 * left / r], 1e-6);
            near([number(&run, "rolls_normal")], [m * 9.81], 1e-4);
        }
    }
}

/// A box on a slope creeps below the angle of friction and slides above it, by the law along the slope: its velocity
/// has `v̇ = g (sin a − μ cos a v/√(v² + rate²))`, with a coefficient that falls as it slides.
#[test]
fn a_box_on_a_slope_slides_as_its_law_says() {
    let (mu, rate, g, m): (f64, f64, f64, f64) = (0.5, 0.001, 9.81, 2.0);
    let (more, stribeck) = (0.15, 0.3);
    for slope in [0.3, 0.6] {
        let page = format!(
            "{GROUND}[[body]]\nname = \"crate\"\nfree = true\nmass = {m}\ninertia = [0.02, 0.02, 0.02]\n\
             position = [0, 0, {:?}]\n[[body.shape]]\nbox = [0.4, 0.3, 0.02]\nposition = [0, 0, 0.01]\n\
             [[contact]]\nname = \"lies\"\nbetween = [{{ body = \"crate\" }}, {{ body = \"ground\" }}]\nstiffness = 1e6\n\
             exponent = 1\ndamping = 10\nfriction_coefficient = {mu}\nrate = {rate}\n\
             static_friction_coefficient = {}\nstribeck_rate = {stribeck}\n",
            -m * g * f64::cos(slope) / 4e6,
            mu + more,
        )
        .replace(
            "name = \"touches\"\n",
            &format!("name = \"touches\"\ngravity = [{:?}, 0, {:?}]\n", g * slope.sin(), -g * slope.cos()),
        );
        let level = |v: f64| mu + more * (-(v / stribeck).powi(2)).exp();
        let law = |[_, v]: [f64; 2]| [v, g * (slope.sin() - level(v) * slope.cos() * v / v.hypot(rate))];
        let [way, speed] = kutta([0.0, 0.0], 0.4, law);
        let run = run("slope", &page, &["--t-end", "0.4", "--tolerance", "1e-10"], &[]);
        let seen: [f64; 18] = told(&run, "lies_seen");
        // Its mass centre is in its sole, about which friction has no moment.
        near([seen[12]], [speed], 1e-8);
        near([seen[0]], [way], 1e-8);
        near([number(&run, "lies_normal")], [m * g * slope.cos()], 1e-4);
    }
}

/// Three crates, one on the other: each creeps on the one below it at the rate at which the one body of
/// [`a_box_on_a_slope_slides_as_its_law_says`] does.
#[test]
fn crates_creep_alike() {
    let folder = Folder::new("touching-crates");
    let run =
        json(&folder, &[&model("../examples/contact/crates.toml"), "--no-prove", "--tolerance", "1e-10"]);
    let k = f64::tan(2.0 * f64::atan(0.15)) / 0.5;
    let cosine = f64::cos(2.0 * f64::atan(0.15));
    for (on, mass) in [("first", 6.0), ("second", 3.0), ("third", 1.0)] {
        near([told::<18>(&run, &format!("{on}_seen"))[12]], [0.001 * k / (1.0 - k * k).sqrt()], 2e-7);
        near([number(&run, &format!("{on}_normal"))], [mass * 9.81 * cosine], 1e-3);
    }
}

/// Contacts are asked of the shapes of both bodies; what is wrong with one is said.
#[test]
fn what_cannot_touch_is_refused() {
    let ball = "[[body]]\nname = \"ball\"\nfree = true\nmass = 1\ninertia = [1, 1, 1]\nposition = [0, 0, 1]\n[[body.shape]]\nname = \"round\"\nsphere = 0.1\n";
    let between = |one: &str, other: &str| {
        format!("{GROUND}{ball}[[contact]]\nname = \"c\"\nstiffness = 1\nbetween = [{one}, {other}]\n")
    };
    let cases = [
        (between("{ body = \"ball\" }", "{ body = \"ball\" }"), "does not touch itself"),
        (between("{ body = \"ball\" }", "{ body = \"ground\", shape = \"top\" }"), "has no shape `top`"),
        (between("{ body = \"ball\" }", "{ body = \"nobody\" }"), "nobody"),
        (
            between("{ body = \"ball\" }", "{ body = \"ground\" }").replace("stiffness = 1\n", ""),
            "has no `stiffness`",
        ),
        (
            between("{ body = \"ball\" }", "{ body = \"ground\" }")
                .replace("stiffness", "lower = 0\nstiffness"),
            "is between bodies",
        ),
        (
            between("{ body = \"ball\" }", "{ body = \"ground\" }").replace("sphere = 0.1", "plane = [1, 1]"),
            "how a plane touches a plane",
        ),
        (format!("{GROUND}{ball}[[contact]]\nname = \"c\"\nstiffness = 1\n"), "has no `joint`"),
    ];
    for (page, words) in cases {
        let folder = Folder::new("touching-refused");
        fs::write(folder.0.join("page.toml"), &page).unwrap();
        refused(&simulate(&folder, &["page.toml"]), words);
    }
}

/// Of all shapes of two bodies those touch that can; what is left out is told.
#[test]
fn what_passes_through_is_told() {
    let page = format!(
        "{GROUND}[[body.shape]]\nbox = [0.1, 0.1, 0.1]\n[[body]]\nname = \"crate\"\nfree = true\nmass = 1\n\
         inertia = [1, 1, 1]\nposition = [0, 0, 1]\n[[body.shape]]\nbox = [0.2, 0.2, 0.2]\n[[contact]]\nname = \"c\"\n\
         stiffness = 1\nbetween = [{{ body = \"ground\" }}, {{ body = \"crate\" }}]\n"
    );
    let folder = Folder::new("touching-told");
    fs::write(folder.0.join("page.toml"), &page).unwrap();
    let output = simulate(&folder, &["page.toml", "--no-prove", "--t-end", "0.01"]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && said.contains("how a box touches a box"), "{said}");
}
