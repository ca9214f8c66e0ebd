//! Mistakes of robot files, told by line and element.

use super::*;

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
        ("<joint", "r.urdf: not a whole XML file"),
        (r#"<joint type="fixed"/>"#, "r.urdf:4: <joint> of robot `r`: the attribute `name` is missing"),
        (
            r#"<joint name="j" type="hinge"><parent link="base"/><child link="arm"/></joint>"#,
            "r.urdf:4: <joint name=\"j\">: unknown type `hinge`: write one of `revolute`",
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
            r#"<link name="b"><inertial><mass value="-1"/></inertial></link>"#,
            "r.urdf:4: <mass> of link `b`: the mass -1.0 is negative",
        ),
        (
            r#"<link name="b"><inertial><mass value="1"/></inertial></link>"#,
            "r.urdf:4: <inertial> of link `b`: <inertia ixx=\"...\" .../> is missing",
        ),
    ] {
        let found = convert("r.urdf", "r.urdf", &robot(rest), Root::Fixed).unwrap_err();
        assert!(found.contains(message), "{rest}\n{found}");
    }
    let found = convert("r.urdf", "r.urdf", "<arm/>", Root::Fixed).unwrap_err();
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

#[test]
fn an_inertia_that_no_body_has_is_refused_with_a_cure() {
    for (moments, message) in [
        (
            [1.0, 1.0, 0.0],
            "the principal moments [0.0, 1.0, 1.0] are not all positive: no body has these; write",
        ),
        ([1.0, 1.0, 3.0], "the largest exceeds the sum of the others: no body has these; write"),
    ] {
        let rest = link("b", (1.0, moments), "revolute", "arm").replace("0 0 0", "0 0 1");
        let found = convert("r.urdf", "r.urdf", &robot(&format!("{JOINT}{rest}")), Root::Fixed).unwrap_err();
        assert!(found.starts_with("r.urdf:4: <inertia> of link `b`: ") && found.contains(message), "{found}");
    }
}

/// A point of mass on an arm, and one more on it: together they are a body. What is fixed to the ground may have any
/// inertia, and the axis of a fixed joint is nobody's.
#[test]
fn links_that_are_no_bodies_alone_become_one_with_what_they_are_fixed_to() {
    let parts = link("tip", (2.0, [0.0; 3]), "fixed", "arm")
        + &link("end", (1.0, [0.0; 3]), "fixed", "tip")
        + &link("foot", (1.0, [0.0, -1.0, 9.0]), "fixed", "base");
    let (page, remarks) =
        convert("r.urdf", "r.urdf", &robot(&format!("{JOINT}{parts}")), Root::Fixed).unwrap();
    // Mass 1, 2 and 1 at 0, 2 and 4: the centre is at 2, and Steiner's terms are 4 + 0 + 4.
    assert!(page.contains("mass = 4.0\ninertia = [9.0, 9.0, 1.0]\n"), "{page}");
    assert!(page.contains("body = \"arm\", point = [0.0, 0.0, -2.0]"), "{page}");
    assert!(page.contains("# Link end: its frame is at [0.0, 0.0, 2.0] in the body's"), "{page}");
    assert_eq!(page.matches("[[body]]").count(), 2, "{page}");
    for link in ["`tip` is fixed to `arm`", "`end` is fixed to `arm`", "`foot` is fixed to `base`"] {
        let words = format!("link {link} and became a part of it, its mass with it");
        assert!(remarks.contains(&words), "{words} is missing in {remarks:#?}");
    }
}

#[test]
fn a_robot_in_which_nothing_moves_is_told_to_float() {
    let fixed = JOINT.replace("revolute", "fixed");
    let found = convert("r.urdf", "r.urdf", &robot(&fixed), Root::Fixed).unwrap_err();
    assert_eq!(found, "r.urdf: all links are fixed to the root link `base`: --floating lets it move");
    assert!(convert("r.urdf", "r.urdf", &robot(&fixed), Root::Floating).is_ok());
    let found = convert("r.urdf", "r.urdf", "<robot/>", Root::Fixed).unwrap_err();
    assert_eq!(found, "r.urdf: the robot has no links");
}

#[test]
fn a_moving_link_without_mass_is_refused_and_all_mistakes_come_at_once() {
    let rest = r#"<link name="a"/><link name="b"/>
<joint name="ja" type="revolute"><parent link="arm"/><child link="a"/></joint>
<joint name="jb" type="revolute"><parent link="arm"/><child link="b"/></joint>"#;
    let found = convert("r.urdf", "r.urdf", &robot(&format!("{JOINT}{rest}")), Root::Fixed).unwrap_err();
    let lines: Vec<&str> = found.lines().collect();
    assert_eq!(lines.len(), 2, "{found}");
    assert!(lines[0].starts_with("r.urdf:4: link `a` moves and has no mass"), "{found}");
}

#[test]
fn what_has_no_counterpart_is_listed() {
    let rest = r#"<material name="m"/><link name="frame"><visual/><visual/><sensor/></link>
<joint name="f" type="fixed"><parent link="arm"/><child link="frame"/><calibration rising="0"/><mimic joint="j"/></joint>"#;
    let (page, remarks) =
        convert("r.urdf", "r.urdf", &robot(&format!("{JOINT}{rest}")), Root::Fixed).unwrap();
    for words in [
        "line 4: <material name=\"m\">: has no counterpart",
        "line 4: <sensor> of link `frame`: has no counterpart",
        "line 5: <calibration> of joint `f`: has no counterpart",
        "line 5: <mimic> of joint `f`: a fixed joint follows nothing",
        "2 <visual> and 0 <collision>: shapes have no counterpart",
        "link `frame` is fixed to `arm` and became a part of it",
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
    let found = convert("r.urdf", "r.urdf", &robot(JOINT), Root::Floating).unwrap_err();
    assert!(found.contains("r.urdf:2: link `base` moves and has no mass"), "{found}");
    let (page, remarks) = convert("r.urdf", "r.urdf", &robot(JOINT), Root::Fixed).unwrap();
    let said = format!("{page}{}", remarks.join("\n"));
    assert!(said.contains("--floating lets it move") && !said.contains("free = true"), "{said}");
}
