//! Mistakes of robot files, told by line and element.

mod on_request;

use super::*;

const PLAIN: Wishes<'_> = Wishes {
    root: Root::Fixed,
    motors: false,
    armature: None,
    limits: false,
    wrenches: &[],
    frames: &[],
    folder: None,
    as_written: false,
    density: None,
    ignored: &[],
    tool: "gyro import",
};
const FLOATING: Wishes<'_> = Wishes { root: Root::Floating, ..PLAIN };

const LINKS: &str = r#"<robot name="r">
<link name="base"/>
<link name="arm"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial></link>
"#;

/// A robot of two links with these joints and whatever else.
fn robot(rest: &str) -> String {
    format!("{LINKS}{rest}\n</robot>")
}

const JOINT: &str = r#"<joint name="j" type="revolute"><parent link="base"/><child link="arm"/></joint>"#;

#[test]
fn mistakes_are_told_by_line_and_element() {
    for (rest, message) in [
        ("", "r.urdf:3: link `arm` is a second root"),
        ("<joint", "r.urdf:4: not a whole XML file"),
        (r#"<joint type="fixed"/>"#, "r.urdf:4: <joint> of robot `r`: the attribute `name` is missing"),
        (
            r#"<joint name="j" type="hinge"><parent link="base"/><child link="arm"/></joint>"#,
            "r.urdf:4: <joint name=\"j\">: unknown type `hinge`: write `revolute`; there are",
        ),
        (
            r#"<joint name="j" type="fixed"><parent link="bas"/><child link="arm"/></joint>"#,
            "r.urdf:4: <parent> of joint `j`: unknown link `bas`: write `base`",
        ),
        (
            r#"<joint name="j" type="fixed"><child link="arm"/></joint>"#,
            "r.urdf:4: <joint name=\"j\">: <parent link=\"...\"/> is missing",
        ),
        (
            "<joint name=\"j\" type=\"fixed\">\n<origin xyz=\"0 1\"/><parent link=\"base\"/><child link=\"arm\"/></joint>",
            "r.urdf:5: <origin> of joint `j`: xyz=\"0 1\": three numbers were expected",
        ),
        (
            r#"<joint name="j" type="revolute"><axis xyz="0 0 0"/><parent link="base"/><child link="arm"/></joint>"#,
            "r.urdf:4: <axis> of joint `j`: the axis has no direction",
        ),
        (
            r#"<joint name="j" type="revolute"><axis xyz="0 z 0"/><parent link="base"/><child link="arm"/></joint>"#,
            "r.urdf:4: <axis> of joint `j`: xyz=\"z\": a finite number was expected",
        ),
        (
            r#"<joint name="j" type="prismatic"><dynamics damping="-1"/><parent link="base"/><child link="arm"/></joint>"#,
            "r.urdf:4: <dynamics> of joint `j`: damping -1.0 is negative",
        ),
        (
            r#"<joint name="j" type="revolute"><mimic joint="j"/><parent link="base"/><child link="arm"/></joint>"#,
            "r.urdf:4: <joint name=\"j\">: the joint follows itself",
        ),
        (
            r#"<joint name="j" type="revolute"><mimic joint="k"/><parent link="base"/><child link="arm"/></joint>"#,
            "unknown joint `k`: write `j`",
        ),
        (
            r#"<joint name="j" type="revolute"><parent link="arm"/><child link="arm"/></joint>"#,
            "r.urdf:3: link `arm` hangs in a circle of joints",
        ),
        (r#"<link name="base"/>"#, "r.urdf:4: <link name=\"base\">: an earlier one has this name"),
        (
            r#"<joint name="j" type="revolute"><origin xyz="0 0 ${l}"/><parent link="base"/><child link="arm"/></joint>"#,
            "r.urdf:4: <origin> of joint `j`: xyz=\"${l}\": a finite number was expected; this is xacro: expand",
        ),
        (r#"<xacro:leg side="left"/>"#, "this is xacro: expand the file with `xacro` first"),
        (
            r#"<joint name="k" type="revolute"><parent link="base"/><child link="arm"/></joint>
<joint name="j" type="revolute"><mimic joint="k" multiplier="0"/><parent link="base"/><child link="arm"/></joint>"#,
            "r.urdf:5: <joint name=\"j\">: a multiplier of 0 lets the joint follow nothing: make it a fixed joint",
        ),
        (
            r#"<link name="b"><inertial><mass value="-1"/></inertial></link>"#,
            "r.urdf:4: <mass> of link `b`: the mass -1.0 is negative",
        ),
        (
            r#"<link name="b"><inertial><mass value="1"/></inertial><inertial><mass value="2"/></inertial></link>"#,
            "r.urdf:4: <inertial> of link `b`: there is an earlier one",
        ),
        (
            r#"<loop_joint name="l" type="continuous"><link1 link="arm"/><link2 link="base"/></loop_joint>"#,
            "r.urdf:4: <loop_joint name=\"l\">: a model file has nothing for this, and without it the robot may be another \
             mechanism: if it is not, give --ignore loop_joint",
        ),
    ] {
        let found = convert("r.urdf", "r.urdf", &robot(rest), PLAIN).unwrap_err();
        assert!(found.contains(message), "{rest}\n{found}");
    }
    let found = convert("r.urdf", "r.urdf", "<arm/>", PLAIN).unwrap_err();
    assert_eq!(found, "r.urdf:1: <arm>: a URDF file has one <robot>");
}

/// A link of a mass and these moments, on a joint of this kind.
fn link(name: &str, (mass, moments): (f64, [f64; 3]), kind: &str, parent: &str) -> String {
    let [x, y, z] = moments;
    format!(
        r#"<link name="{name}"><inertial><mass value="{mass}"/><inertia ixx="{x}" iyy="{y}" izz="{z}"/></inertial></link>
<joint name="on_{name}" type="{kind}"><origin xyz="0 0 2"/><parent link="{parent}"/><child link="{name}"/><axis xyz="0 0 0"/></joint>
"#
    )
}

/// Inertias are looked at when links that are fixed to one another have become one body.
#[test]
fn an_inertia_that_no_body_has_is_refused_with_a_cure_or_mended() {
    for moments in [[1.0, 1.0, 3.0], [1.0, 1.0, -1.0]] {
        let rest = link("b", (1.0, moments), "revolute", "arm").replace("0 0 0", "0 0 1");
        let found = convert("r.urdf", "r.urdf", &robot(&format!("{JOINT}{rest}")), PLAIN).unwrap_err();
        let words =
            "are no body's, as none may exceed the sum of the others; write those about the mass centre";
        assert!(
            found.starts_with("r.urdf:4: link `b` with what is fixed to it") && found.contains(words),
            "{found}"
        );
    }
    for (moments, inertia, words) in [
        ([1.0, 1.0, 2.1], "[1.0500000000", "is mended by 0.05 kg.m2, 2.4 % of the largest"),
        ([0.0, 1.0, 1.0], "[1.99999999", "taken to be a millimetre thick"),
    ] {
        let rest = link("b", (1.0, moments), "revolute", "arm").replace("0 0 0", "0 0 1");
        let (page, remarks) = convert("r.urdf", "r.urdf", &robot(&format!("{JOINT}{rest}")), PLAIN).unwrap();
        assert!(
            remarks.iter().any(|r| r.starts_with("the body of link `b` has") && r.contains(words)),
            "{remarks:#?}"
        );
        assert!(page.contains(&format!("inertia = {inertia}")), "{page}");
    }
}

/// A point of mass on an arm, and one more on it: together they are a body. What is fixed to the ground may have any
/// inertia, and the axis of a fixed joint is nobody's.
#[test]
fn links_that_are_fixed_to_one_another_become_one_body() {
    let parts = link("tip", (2.0, [0.0; 3]), "fixed", "arm")
        + &link("end", (1.0, [0.0; 3]), "fixed", "tip")
        + &link("foot", (1.0, [0.0, -1.0, 9.0]), "fixed", "base");
    let (page, remarks) = convert("r.urdf", "r.urdf", &robot(&format!("{JOINT}{parts}")), PLAIN).unwrap();
    // Mass 1, 2 and 1 at 0, 2 and 4: the centre is at 2, and Steiner's terms are 4 + 0 + 4.
    assert!(page.contains("mass = 4.0\ninertia = [9.0, 9.0, 1.0]\n"), "{page}");
    assert!(page.contains("body = \"arm\", point = [0.0, 0.0, -2.0]"), "{page}");
    assert!(page.contains("# Link end: its frame is at [0.0, 0.0, 2.0] in the body's"), "{page}");
    assert_eq!(page.matches("[[body]]").count(), 2, "{page}");
    for words in [
        "1 link fixed to `base`, one body with it: `foot`",
        "2 links fixed to `arm`, one body with it: `tip`, `end`",
    ] {
        assert!(remarks.iter().any(|remark| remark == words), "{words} is missing in {remarks:#?}");
    }
}

#[test]
fn a_robot_in_which_nothing_moves_is_told_to_float() {
    let fixed = JOINT.replace("revolute", "fixed");
    let found = convert("r.urdf", "r.urdf", &robot(&fixed), PLAIN).unwrap_err();
    assert_eq!(found, "r.urdf: all links are fixed to the root link `base`: --floating lets it move");
    assert!(convert("r.urdf", "r.urdf", &robot(&fixed), FLOATING).is_ok());
    let found = convert("r.urdf", "r.urdf", "<robot/>", PLAIN).unwrap_err();
    assert_eq!(found, "r.urdf: the robot has no links");
}

#[test]
fn a_moving_link_without_mass_is_refused_and_all_mistakes_come_at_once() {
    let rest = r#"<link name="a"/><link name="b"/>
<joint name="ja" type="revolute"><parent link="arm"/><child link="a"/></joint>
<joint name="jb" type="revolute"><parent link="arm"/><child link="b"/></joint>"#;
    let found = convert("r.urdf", "r.urdf", &robot(&format!("{JOINT}{rest}")), PLAIN).unwrap_err();
    let lines: Vec<&str> = found.lines().collect();
    assert_eq!(lines.len(), 2, "{found}");
    assert!(lines[0].starts_with("r.urdf:4: link `a` moves and has no mass"), "{found}");
    assert!(
        lines[0].ends_with(
            "give it an <inertial>, or its shapes a --density, or make joint `ja` (line 5) a fixed one"
        ),
        "{found}"
    );
}

/// What a joint without mass carries has mass: of that a millionth is taken, and nothing is added.
#[test]
fn a_link_without_mass_between_moving_joints_takes_a_little_of_what_it_carries() {
    let rest = r#"<link name="cross"/><joint name="j" type="revolute"><parent link="base"/><child link="cross"/><axis xyz="0 0 1"/></joint>
<joint name="k" type="revolute"><origin xyz="0.5 0 0"/><parent link="cross"/><child link="arm"/></joint>"#;
    let convert = |wishes| convert("r.urdf", "r.urdf", &robot(rest), wishes).unwrap();
    let (page, remarks) = convert(Wishes { as_written: true, ..PLAIN });
    assert!(page.contains("mass = 1e-12\n"), "{page}");
    let words = "no mass: it takes 1e-12 of that of `arm`";
    assert!(remarks.iter().any(|remark| remark.contains(words)), "{remarks:#?}");
    let (page, remarks) = convert(PLAIN);
    let words = "link `cross` moves and has no mass: it takes a millionth of that of `arm`, which it carries";
    assert!(remarks.iter().any(|remark| remark == words), "{remarks:#?}");
    assert!(page.contains("mass = 1e-6\ninertia = [1e-6, 1e-6, 1e-6]"), "{page}");
    assert!(page.contains("mass = 0.999999\n"), "{page}");
    assert!(page.contains("{ body = \"cross\", point = [-0.5, 0.0, 0.0]"), "{page}");
}

/// What floats is not held by what it carries.
#[test]
fn a_floating_link_without_mass_is_refused() {
    let rest = r#"<link name="trunk"/><joint name="j" type="floating"><parent link="base"/><child link="trunk"/></joint>
<joint name="k" type="revolute"><parent link="trunk"/><child link="arm"/></joint>"#;
    let found = convert("r.urdf", "r.urdf", &robot(rest), PLAIN).unwrap_err();
    let words = "link `trunk` moves and has no mass, nor has anything that is fixed to it: give it an <inertial>, or its shapes a --density";
    assert_eq!(found, format!("r.urdf:4: {words}"));
}

/// 0.1 and 0.2 are not 0.30000000000000004: lengths that were typed cancel in the formulas.
#[test]
fn sums_of_decimals_are_decimals() {
    let parts = r#"<link name="tip"/><joint name="k" type="fixed"><origin xyz="0.1 0.7 0"/><parent link="arm"/><child link="tip"/></joint>"#
        .to_owned()
        + &link("b", (1.0, [1.0; 3]), "revolute", "tip").replace("0 0 2", "0.2 -0.6 0").replace("0 0 0", "0 0 1");
    let (page, _) = convert("r.urdf", "r.urdf", &robot(&format!("{JOINT}{parts}")), PLAIN).unwrap();
    assert!(page.contains("body = \"arm\", point = [0.3, 0.1, 0.0]"), "{page}");
}

#[test]
fn right_angles_are_made_exact() {
    let rest = r#"<joint name="j" type="revolute"><origin rpy="1.5708 0 -3.14159" xyz="0 0 1e-17"/><parent link="base"/><child link="arm"/><axis xyz="1e-9 0 1"/></joint>"#;
    let (page, remarks) = convert("r.urdf", "r.urdf", &robot(rest), PLAIN).unwrap();
    assert!(
        page.contains("point = [0.0, 0.0, 0.0], axis = [0.0, 1.0, 0.0], zero = [-1.0, 0.0, 0.0]"),
        "{page}"
    );
    for words in [
        "1.5708 rad is taken for 90 degrees, a change of 3.7e-6 rad: line 4",
        "-3.14159 rad is taken for -180 degrees, a change of 2.7e-6 rad: line 4",
        "line 4: <axis> of joint `j`: a component of 1.0e-9 of the largest is taken for 0",
    ] {
        assert!(remarks.iter().any(|remark| remark == words), "{words} is missing in {remarks:#?}");
    }
}

/// A motor for each joint that follows none, and stops where there is something between the limits; the start is there
/// too.
#[test]
fn motors_and_stops_are_made_on_request() {
    let rest = r#"<joint name="j" type="revolute"><parent link="base"/><child link="arm"/><limit lower="0.2" upper="1" effort="3"/></joint>
<link name="b"><inertial><mass value="2"/><inertia ixx="1" iyy="1" izz="1"/></inertial></link>
<joint name="k" type="prismatic"><parent link="arm"/><child link="b"/><mimic joint="j" multiplier="2"/><limit lower="-1" upper="1"/></joint>
<link name="c"><inertial><mass value="2"/><inertia ixx="1" iyy="1" izz="1"/></inertial></link>
<joint name="l" type="continuous"><parent link="arm"/><child link="c"/><limit effort="1"/></joint>
<link name="d"><inertial><mass value="2"/><inertia ixx="1" iyy="1" izz="1"/></inertial></link>
<joint name="m" type="revolute"><parent link="arm"/><child link="d"/><limit lower="0" upper="0"/></joint>"#;
    let convert = |wishes| convert("r.urdf", "r.urdf", &robot(rest), wishes).unwrap();
    let (page, remarks) = convert(Wishes { motors: true, limits: true, ..PLAIN });
    assert!(
        page.contains("[inputs]\nj_motor = 0  # N.m\nl_motor = 0  # N.m\nm_motor = 0  # N.m\n\n"),
        "{page}"
    );
    assert_eq!(page.matches("kind = \"motor\"").count(), 3, "{page}");
    let stop = "name = \"j_upper_stop\"\nkind = \"stop\"\njoint = \"j\"\nside = \"upper\"\nlimit = 1.0\nstiffness = 300.0\n\
                damping = 34.6410161513775\nsoftness = 0.001\n";
    assert!(page.contains(stop), "{page}");
    assert!(page.contains("step = 1e-4\n"), "{page}");
    // The weight of 2 kg on a millimetre.
    assert!(
        page.contains("limit = -1.0\nstiffness = 19620.0\ndamping = 198.09088823063\nsoftness = 0.0001\n"),
        "{page}"
    );
    assert_eq!(page.matches("kind = \"stop\"").count(), 4, "{page}");
    assert!(page.contains("angle = 0.2\n") && page.contains("displacement = 0.4\n"), "{page}");
    for words in [
        "joint `m` has no stops: its limits 0.0 and 0.0 leave it nothing",
        "joints that do not start at 0: `j`, `k`",
    ] {
        assert!(remarks.iter().any(|remark| remark == words), "{words} is missing in {remarks:#?}");
    }
    gyro_model::read("r.toml", &page).unwrap_or_else(|mistakes| panic!("{mistakes}"));
    // Transmissions name some of them.
    assert!(remarks.iter().all(|remark| !remark.contains("--motors")), "{remarks:#?}");
    let transmission = r#"<transmission name="t"><joint name="l"><hardwareInterface/></joint><actuator name="a"/></transmission>"#;
    let with_transmission = robot(&format!("{rest}\n{transmission}"));
    let words = "--motors: these have a motor though no <transmission> names them: `j`, `m`";
    for (motors, is_told) in [(true, true), (false, false)] {
        let wishes = Wishes { motors, ..PLAIN };
        let (page, remarks) = super::convert("r.urdf", "r.urdf", &with_transmission, wishes).unwrap();
        assert_eq!(remarks.iter().any(|remark| remark == words), is_told, "{remarks:#?}");
        assert_eq!(page.matches("kind = \"motor\"").count(), if motors { 3 } else { 0 }, "{page}");
    }
    let (page, _) = convert(Wishes { armature: Some(0.02), ..PLAIN });
    let model = gyro_model::read("r.toml", &page).unwrap_or_else(|mistakes| panic!("{mistakes}"));
    let armatures: Vec<f64> = model.joints.iter().map(|joint| model.value(&joint.armature)).collect();
    assert_eq!(armatures, [0.02, 0.0, 0.02, 0.02], "k follows j");
    // A strong drive on a light finger: the stop is as stiff as 1000 rad/s make it.
    let finger = link("f", (0.001, [1e-6; 3]), "revolute", "arm")
        .replace("0 0 0\"/>", "0 0 1\"/><limit upper=\"1\" effort=\"50\"/>");
    let limits = Wishes { limits: true, ..PLAIN };
    let (finger, _) =
        super::convert("r.urdf", "r.urdf", &robot(&format!("{JOINT}{finger}")), limits).unwrap();
    assert!(finger.contains("stiffness = 1.0\ndamping = 0.001\n"), "{finger}");
    let (page, remarks) = convert(PLAIN);
    assert!(!page.contains("[[force]]") && !page.contains("[inputs]"), "{page}");
    assert!(
        remarks.contains(&"3 <limit>s left out: --limits makes stops of them".to_owned()),
        "{remarks:#?}"
    );
}

/// A force and a torque on a link that is lumped into another one's body act where its frame is; links that are not
/// there or do not move are named.
#[test]
fn wrenches_act_on_links_that_move() {
    let rest = r#"<link name="Tool-Tip"/>
<joint name="f" type="fixed"><parent link="arm"/><child link="Tool-Tip"/><origin xyz="0.5 0 0.25"/></joint>"#;
    let robot = robot(&format!("{JOINT}{rest}"));
    let convert = |wrenches: &[&str]| {
        let wrenches: Vec<String> = wrenches.iter().map(|&name| name.to_owned()).collect();
        convert("r.urdf", "r.urdf", &robot, Wishes { wrenches: &wrenches, ..PLAIN })
    };
    let (page, _) = convert(&["Tool-Tip"]).unwrap();
    assert!(page.contains("[inputs]\ntool_tip_force_x = 0  # N\n"), "{page}");
    let model = gyro_model::read("r.toml", &page).unwrap_or_else(|mistakes| panic!("{mistakes}"));
    assert_eq!(model.inputs.len(), 6);
    let gyro_model::ForceKind::Load { point, force, torque, .. } = &model.forces[0].kind else {
        panic!("{page}")
    };
    let inputs = force.iter().chain(torque).enumerate();
    inputs
        .for_each(|(k, number)| assert_eq!(*number, gyro_model::Number::Input { index: k, negated: false }));
    let point = point.each_ref().map(|x| match x {
        gyro_model::Number::Exact(x) => gyro_model::to_f64(x),
        other => panic!("{other:?}"),
    });
    assert_eq!(point, [0.5, 0.0, 0.25], "{page}");
    let said = convert(&["base", "hand"]).unwrap_err();
    assert!(said.contains("--wrenches base: this link is fixed"), "{said}");
    assert!(
        said.contains("--wrenches hand: there is no such link; there are `base`, `arm`, `Tool-Tip`"),
        "{said}"
    );
}

#[test]
fn what_has_no_counterpart_is_listed() {
    let rest = r#"<material name="m"/><link name="frame"><visual/><visual/><sensor/></link>
<joint name="f" type="fixed"><parent link="arm"/><child link="frame"/><calibration rising="0"/><mimic joint="j"/></joint>"#;
    let (page, remarks) = convert("r.urdf", "r.urdf", &robot(&format!("{JOINT}{rest}")), PLAIN).unwrap();
    for words in [
        "1 <material> without counterpart: line 4",
        "1 <sensor> without counterpart: line 4",
        "1 <calibration> without counterpart: line 5",
        "line 5: <mimic> of joint `f`: a fixed joint follows nothing",
        "2 <visual> and 0 <collision>: these shapes have no counterpart",
        "1 link fixed to `arm`, one body with it: `frame`",
        "the root link `base` is fixed",
    ] {
        assert!(remarks.iter().any(|remark| remark.contains(words)), "{words} is missing in {remarks:#?}");
        assert!(page.contains(words), "{words} is missing in\n{page}");
    }
    assert!(page.contains("# Link frame: its frame is at [0.0, 0.0, 0.0] in the body's"), "{page}");
}

/// The advice of earlier versions, to write `free = true` in the model file, was wrong: points on a fixed root are in
/// its link's frame.
#[test]
fn a_root_without_mass_cannot_float_and_a_fixed_one_is_not_called_free() {
    let found = convert("r.urdf", "r.urdf", &robot(JOINT), FLOATING).unwrap_err();
    assert!(found.contains("r.urdf:2: link `base` moves and has no mass"), "{found}");
    let (page, remarks) = convert("r.urdf", "r.urdf", &robot(JOINT), PLAIN).unwrap();
    let said = format!("{page}{}", remarks.join("\n"));
    assert!(said.contains("--floating lets it move") && !said.contains("free = true"), "{said}");
}

/// What other readers of XML take: prefixes that nothing declares, a declaration after a comment, `--` in comments, an
/// entity that is none, `<` in values.
#[test]
fn xml_is_read_forgivingly() {
    let text = format!(
        "<!-- first -- and more -->\n<?xml version=\"1.0\"?>\n{}",
        robot(&format!(
            r#"{JOINT}<link name="a&b <c>"><collision><drake:proximity_properties/></collision><drake:note/></link>
<joint name="k" type="fixed"><parent link="arm"/><child link="a&b <c>"/></joint>"#
        ))
    );
    let (page, remarks) = convert("r.urdf", "r.urdf", &text, PLAIN).unwrap();
    assert!(page.contains("# Link a&b <c>: its frame"), "{page}");
    assert!(remarks.contains(&"1 <drake:note> without counterpart: line 6".to_owned()), "{remarks:#?}");
    for (text, words) in [
        ("", "r.urdf: a URDF file has one <robot>"),
        ("<robot>\n<link>\n", "r.urdf:2: not a whole XML file: <link> is not closed"),
        ("<robot>\n<link></joint></robot>", "r.urdf:2: not a whole XML file"),
    ] {
        let found = convert("r.urdf", "r.urdf", text, PLAIN).unwrap_err();
        assert!(found.contains(words), "{text}\n{found}");
    }
    // Nothing recurs into elements.
    let deep = "<a>".repeat(200_000) + &"</a>".repeat(200_000);
    let found = convert("r.urdf", "r.urdf", &robot(&format!("{JOINT}{deep}")), PLAIN).unwrap();
    assert!(found.1.contains(&"1 <a> without counterpart: line 4".to_owned()), "{:#?}", found.1);
}

#[test]
fn what_is_ignored_is_told_and_what_may_be_another_mechanism_is_refused_inside_of_others() {
    for rest in [
        "<mujoco><equality/></mujoco>",
        r#"<gazebo><joint name="l" type="revolute"/></gazebo>"#,
        r#"<drake:linear_spring_damper name="s"/>"#,
        r#"<link name="frame"/><joint name="f" type="fixed"><parent link="arm"/><child link="frame"/><joint_properties damping="1"/></joint>"#,
    ] {
        let name = ["mujoco", "gazebo", "drake:linear_spring_damper", "joint_properties"]
            .into_iter()
            .find(|name| rest.contains(&format!("<{name}")))
            .unwrap();
        let text = robot(&format!("{JOINT}{rest}"));
        let found = convert("r.urdf", "r.urdf", &text, PLAIN).unwrap_err();
        assert!(found.ends_with(&format!("give --ignore {name}")), "{rest}\n{found}");
        let ignored = [name.to_owned(), "other".to_owned()];
        let (_, remarks) = convert("r.urdf", "r.urdf", &text, Wishes { ignored: &ignored, ..PLAIN }).unwrap();
        for words in [
            format!("1 <{name}> ignored, as is asked for: line 4"),
            "--ignore other: the robot has no such element".to_owned(),
        ] {
            assert!(remarks.contains(&words), "{words} is missing in {remarks:#?}");
        }
    }
    let harmless = r#"<ros2_control name="c"><joint name="j"/></ros2_control><gazebo reference="j"><implicitSpringDamper/></gazebo>"#;
    assert!(convert("r.urdf", "r.urdf", &robot(&format!("{JOINT}{harmless}")), PLAIN).is_ok());
}
