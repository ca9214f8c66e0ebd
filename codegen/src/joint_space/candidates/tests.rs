//! Forms against each other.

use super::*;
use crate::derive::Textbook;
use crate::expr::evaluate::{evaluate, sample};
use crate::expr::schedule::Operations;
use gyro_model::Model;

/// Recursions over a dozen bodies, pivots of order one.
const ROUNDING: f64 = 1e-9;

fn read(page: &str) -> Model {
    gyro_model::read("page.toml", page).unwrap_or_else(|error| panic!("{error}\n{page}"))
}

/// All forms of a mechanism's accelerations in terms of joint coordinates.
fn solved(model: &Model) -> (System<'_>, Coordinates, Vec<(String, Vec<ExprId>)>) {
    let mut system = System::new(model);
    let textbook = Textbook::derive(&mut system);
    let coordinates = Coordinates::derive(&mut system, &textbook);
    let candidates = Candidates::solve(&mut system, &coordinates);
    let forms = candidates.on_rates(&mut system, &coordinates);
    (system, coordinates, forms)
}

/// All forms in the frames of joints against the recursion in the bodies' frames; how many were compared.
fn check(page: &str) -> usize {
    let model = read(page);
    let (system, coordinates, forms) = solved(&model);
    let (expected, others) = forms.split_first().expect("there is a recursion");
    for seed in 0..5 {
        let value = |symbol| match symbol {
            Symbol::Coordinate(x) => {
                let links = coordinates.layout.links.iter();
                let p = links.filter_map(|link| link.orientation).find(|p| (p.x..p.x + 4).contains(&x));
                let square = p.map_or(1.0, |p| {
                    (p.x..p.x + 4).map(|k| sample(seed)(Symbol::Coordinate(k)).powi(2)).sum()
                });
                sample(seed)(symbol) / f64::sqrt(square)
            }
            Symbol::Parameter(_) => 1.0 + sample(seed)(symbol).abs(),
            _ => sample(seed)(symbol),
        };
        let expected = evaluate(&system.graph, &expected.1, value);
        let largest = expected.iter().fold(1.0_f64, |largest, x| largest.max(x.abs()));
        for (name, roots) in others {
            let found = evaluate(&system.graph, roots, value);
            for (x, y) in found.iter().zip(&expected) {
                assert!(
                    (x - y).abs() <= ROUNDING * largest,
                    "{name}, seed {seed}: {x} instead of {y}\n{page}"
                );
            }
        }
    }
    others.iter().filter(|(name, _)| name.contains("joint frames")).count()
}

/// Roots of all these directions, and of the angles between them, are unlike each other.
#[test]
fn frames_along_rough_directions_are_as_short_as_others() {
    let operations = |axes: [[&str; 2]; 2]| {
        let mut page = "format = 1\nname = \"chain\"\n[[body]]\nname = \"b0\"\nfixed = true\n".to_owned();
        for link in 1..=5 {
            let ends = [(link - 1, "0.13, 0.21, -0.34"), (link, "-0.18, 0.05, 0.29")];
            let ends = ends.iter().zip(["first", "second"]).zip(axes).map(|((end, key), [axis, zero])| {
                let (body, point) = end;
                format!(
                    "{key} = {{ body = \"b{body}\", point = [{point}], axis = [{axis}], zero = [{zero}] }}\n"
                )
            });
            page += &format!(
                "[[body]]\nname = \"b{link}\"\nmass = 1.{link}\ninertia = [0.2, 0.3, 0.4{link}]\n\
                 [[joint]]\nname = \"j{link}\"\nkind = \"revolute\"\n{}",
                ends.collect::<String>()
            );
        }
        check(&page);
        let model = read(&page);
        let (system, _, forms) = solved(&model);
        let forms = forms.iter().filter(|(name, _)| name.contains("joint frames"));
        forms.map(|(_, roots)| Operations::count(&system.graph, roots).total()).collect::<Vec<_>>()
    };
    let [fine, rough] = [["1, 2, 2", "2, 1, -2"], ["0.471823, 0.839127, 0.293517", "0.839127, -0.471823, 0"]];
    let other = ["0.917235, -0.318273, 0.662719", "0.318273, 0.917235, 0"];
    let expected = operations([fine, ["2, -3, 6", "3, 2, 0"]]);
    assert_eq!(operations([rough, rough]), operations([fine, fine]));
    // Roots of the two ends are unlike, and their sums are worked out at run time.
    for (found, expected) in operations([rough, other]).into_iter().zip(expected) {
        assert!(4 * found < 5 * expected, "{found} for {expected}");
    }
}

#[test]
fn frames_and_base_parameters_leave_accelerations_as_they_are_for_all_kinds_of_joints() {
    for page in [
        include_str!("../../../../tests/models/universal.toml"),
        include_str!("../../../../tests/models/cylindrical.toml"),
        include_str!("../../../../tests/models/planar.toml"),
        include_str!("../../../../tests/models/point-on-line.toml"),
        include_str!("../../../../tests/models/spherical.toml"),
        include_str!("../../../../tests/models/prismatic.toml"),
        include_str!("../../../../tests/models/carried.toml"),
        include_str!("../../../../tests/models/loads.toml"),
        include_str!("../../../../tests/models/weld.toml"),
        include_str!("../../../../models/gyroscope-parameters.toml"),
        include_str!("../../../../models/gyroscope-misalignments.toml"),
        include_str!("../../../../models/pitching-gyroscope.toml"),
    ] {
        assert!(check(page) >= 2, "no form in the frames of joints\n{page}");
    }
}

/// Where joints follow others there is the mass matrix, where loops are closed the rows beside it.
#[test]
fn couplers_drivers_and_rows_of_loops_are_put_into_the_mass_matrix() {
    for (page, n_forms) in [
        (include_str!("../../../../tests/models/gear.toml"), 2),
        (include_str!("../../../../tests/models/armature.toml"), 2),
        (include_str!("../../../../tests/models/differential.toml"), 2),
        (include_str!("../../../../tests/models/driven-shaft.toml"), 3),
        (include_str!("../../../../models/four-bar.toml"), 1),
        (include_str!("../../../../models/stewart-platform.toml"), 1),
        (include_str!("../../../../models/double-wishbone.toml"), 1),
        (include_str!("../../../../models/gyroscope-four-bar.toml"), 1),
        (include_str!("../../../../tests/models/carried-four-bar.toml"), 1),
        (include_str!("../../../../tests/models/spatial-slider-crank.toml"), 1),
        (include_str!("../../../../tests/models/peaucellier.toml"), 1),
        (include_str!("../../../../tests/models/rod.toml"), 1),
        (include_str!("../../../../tests/models/tether.toml"), 3),
        (include_str!("../../../../tests/models/driven-stewart.toml"), 1),
    ] {
        assert_eq!(check(page), n_forms, "{page}");
    }
}

/// Draws of one in so many.
fn dice(seed: u64) -> impl FnMut(usize) -> usize {
    let mut draws = 0..;
    move |sides| {
        let draw = draws.next().expect("without end");
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a die")]
        let face = (f64::midpoint(sample(seed)(Symbol::Coordinate(draw)), 1.0) * sides as f64) as usize;
        face.min(sides - 1)
    }
}

/// A tree of five or six bodies, made of dice: axes along coordinates, skewed, parallel and through one point.
fn tree(seed: u64) -> String {
    let mut die = dice(seed);
    let axes =
        ["[0, 0, 1]", "[0, 1, 0]", "[1, 0, 0]", "[0, 0, -1]", "[3, 0, 4]", "[1, 2, 2]", "[0.3, -0.1, 0.7]"];
    let points = ["[0, 0, 0]", "[0.3, 0, 0]", "[0, -0.2, 0.1]", "[0, 0, 0.4]", "[0.1, 0.2, -0.3]"];
    let kinds =
        ["revolute", "revolute", "revolute", "prismatic", "cylindrical", "universal", "planar", "spherical"];
    let is_floating = die(3) == 0;
    let mut text =
        String::from("format = 1\nname = \"tree\"\ngravity = [0, -9.81, 1]\n[[body]]\nname = \"b0\"\n");
    text += if is_floating { "free = true\nmass = 3\ninertia = [2, 3, 4]\n" } else { "fixed = true\n" };
    for body in 1..5 + die(2) {
        let (parent, mass) = (die(body.min(2)) + body - body.min(2), 1 + die(4));
        let kind = kinds[die(kinds.len())];
        let reversed = kind != "spherical" && die(3) == 0;
        let mut end = |body: usize| {
            let axis = axes[die(axes.len())];
            let zero = if axis == "[0, 1, 0]" { "[1, 0, 0]" } else { "[0, 1, 0]" };
            let point = points[die(points.len())];
            let frame = format!(", axis = {axis}, zero = {zero}");
            let frame = if kind == "spherical" { "" } else { &frame };
            format!("{{ body = \"b{body}\", point = {point}{frame} }}")
        };
        let (on_parent, own) = (end(parent), end(body));
        let (first, second) = if reversed { (own, on_parent) } else { (on_parent, own) };
        let has_armature = matches!(kind, "revolute" | "prismatic") && body % 2 == 1;
        let armature = if has_armature { "armature = 0.3\n" } else { "" };
        text += &format!(
            "[[body]]\nname = \"b{body}\"\nmass = {mass}\n\
             inertia = {{ xx = 0.5, yy = 0.6, zz = 0.{mass}5, xy = 0.01, xz = -0.02, yz = 0.03 }}\n\
             [[joint]]\nname = \"j{body}\"\nkind = \"{kind}\"\n{armature}first = {first}\nsecond = {second}\n"
        );
    }
    text
}

#[test]
fn frames_and_base_parameters_leave_accelerations_as_they_are_whatever_the_tree() {
    (0..16).for_each(|seed| assert!(check(&tree(seed)) >= 2));
}

/// The same with couplers: each geared joint follows one before it.
fn geared(seed: u64) -> String {
    let mut text = tree(seed);
    let with_one = |text: &String| -> Vec<String> {
        let joints = text.split("[[joint]]").skip(1);
        let joints = joints.filter(|joint| joint.contains("\"revolute\"") || joint.contains("\"prismatic\""));
        joints.map(|joint| joint.split('"').nth(1).expect("a joint has a name").to_owned()).collect()
    };
    let joints = with_one(&text);
    for (place, second) in joints.iter().enumerate().skip(1).filter(|(place, _)| place % 3 != 2) {
        let draw = usize::try_from(seed).expect("a small seed") + place;
        let first = &joints[draw % place];
        let ratio = ["2", "-1.5", "0.5"][draw % 3];
        text += &format!(
            "[[coupler]]\nname = \"c{place}\"\nfirst = {{ joint = \"{first}\" }}\n\
             second = {{ joint = \"{second}\" }}\n\
             ratio = {ratio}\n"
        );
    }
    text
}

#[test]
fn joints_that_follow_others_are_carried_on_to_where_they_meet() {
    let n_geared =
        (0..40).map(geared).filter(|page| page.contains("[[coupler]]") && check(page) == 2).count();
    assert!(n_geared > 10, "{n_geared} trees have gears");
}

/// A plate on three to six legs, made of dice: on the ground or on a table that moves, on universal and ball
/// joints, joints named from either end; the plate may carry something. At the start all legs are upright.
fn platform(seed: u64) -> String {
    let mut die = dice(seed);
    let n_legs = 3 + die(4);
    let inertia = "inertia = { xx = 0.5, yy = 0.6, zz = 0.7, xy = 0.01, xz = -0.02, yz = 0.03 }";
    let mut text = String::from(
        "format = 1\nname = \"platform\"\ngravity = [0.5, 1, -9.81]\n[[body]]\nname = \"base\"\n",
    );
    let table = [
        "fixed = true\n".to_owned(),
        format!("mass = 3\n{inertia}\n"),
        format!("free = true\nmass = 3\n{inertia}\n"),
    ];
    let on = die(3);
    text += &table[on];
    if on == 1 {
        let kind = ["revolute", "prismatic", "cylindrical"][die(3)];
        text += &format!(
            "[[body]]\nname = \"ground\"\nfixed = true\n[[joint]]\nname = \"table\"\nkind = \"{kind}\"\n\
             axis = [1, 2, 2]\nzero = [2, 1, -2]\nfirst = {{ body = \"ground\" }}\nsecond = {{ body = \"base\" }}\n"
        );
    }
    text += &format!("[[body]]\nname = \"plate\"\nmass = 5\n{inertia}\n");
    let joint = |name: String, kind: &str, rest: &str, ends: [String; 2], reversed: bool| {
        let [first, second] = if reversed { [&ends[1], &ends[0]] } else { [&ends[0], &ends[1]] };
        format!(
            "[[joint]]\nname = \"{name}\"\nkind = \"{kind}\"\n{rest}first = {{ {first} }}\n\
             second = {{ {second} }}\n"
        )
    };
    for leg in 0..n_legs {
        let (x, y) = ([3, 1, -2, -3, -1, 2][leg], [1, 3, 2, -1, -3, -2][leg]);
        let (x, y) = (f64::from(x) + 0.1 * die(9) as f64, f64::from(y) + 0.1 * die(9) as f64);
        for part in ["cylinder", "piston"] {
            let mass = 1 + die(3);
            text += &format!("[[body]]\nname = \"{part}{leg}\"\nmass = {mass}\n{inertia}\n");
        }
        let (universal, rotated) = (die(3) > 0, die(2) > 0);
        let (a, b) = if rotated { ("[0.6, 0.8, 0]", "[-0.8, 0.6, 0]") } else { ("[1, 0, 0]", "[0, 1, 0]") };
        let frames = |axis: &str, zero: &str| {
            if universal { format!(", axis = {axis}, zero = {zero}") } else { String::new() }
        };
        let ends = [
            format!("body = \"base\", point = [{x}, {y}, 0]{}", frames(a, b)),
            format!("body = \"cylinder{leg}\", point = [0, 0, -0.4]{}", frames(b, a)),
        ];
        let kind = if universal { "universal" } else { "spherical" };
        text += &joint(format!("foot{leg}"), kind, "", ends, false);
        let ends = [format!("body = \"cylinder{leg}\""), format!("body = \"piston{leg}\"")];
        let (displacement, reversed) = if die(2) > 0 { (1.1, false) } else { (-1.1, true) };
        let rest = format!("axis = [0, 0, 1]\nzero = [1, 0, 0]\ndisplacement = {displacement}\n");
        text += &joint(format!("slide{leg}"), "prismatic", &rest, ends, reversed);
        let ends = [
            format!("body = \"piston{leg}\", point = [0, 0, 0.5]"),
            format!("body = \"plate\", point = [{x}, {y}, 0]"),
        ];
        text += &joint(format!("ball{leg}"), "spherical", "", ends, die(2) > 0);
    }
    if die(2) > 0 {
        text += &format!(
            "[[body]]\nname = \"load\"\nmass = 1\n{inertia}\n[[joint]]\nname = \"hinge\"\n\
             kind = \"revolute\"\naxis = [1, 2, 2]\n\
             zero = [2, 1, -2]\nfirst = {{ body = \"plate\" }}\n\
             second = {{ body = \"load\", point = [0.1, 0.2, 0.3] }}\n"
        );
    }
    text
}

#[test]
fn legs_of_platforms_are_eliminated_wherever_they_stand() {
    (0..16).for_each(|seed| assert_eq!(check(&platform(seed)), 1, "{}", platform(seed)));
}
