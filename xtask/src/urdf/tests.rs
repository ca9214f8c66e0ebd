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
        (
            r#"<link name="b"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="0"/></inertial></link>"#,
            "r.urdf:4: <inertia> of link `b`: the principal moments [0.0, 1.0, 1.0] are not all positive",
        ),
        (
            r#"<link name="b"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="3"/></inertial></link>"#,
            "the largest exceeds the sum of the others",
        ),
    ] {
        let found = convert("r.urdf", "r.urdf", &robot(rest), Root::Fixed).unwrap_err();
        assert!(found.contains(message), "{rest}\n{found}");
    }
    let found = convert("r.urdf", "r.urdf", "<arm/>", Root::Fixed).unwrap_err();
    assert_eq!(found, "r.urdf:1: <arm>: a URDF file has one <robot>");
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
<joint name="f" type="fixed"><parent link="arm"/><child link="frame"/><calibration rising="0"/></joint>"#;
    let (page, remarks) =
        convert("r.urdf", "r.urdf", &robot(&format!("{JOINT}{rest}")), Root::Fixed).unwrap();
    for words in [
        "line 4: <material name=\"m\">: has no counterpart",
        "line 4: <sensor> of link `frame`: has no counterpart",
        "line 5: <calibration> of joint `f`: has no counterpart",
        "2 <visual> and 0 <collision>: shapes have no counterpart",
        "link `frame` is fixed to `arm` and became a part of it",
        "the root link `base` is fixed",
    ] {
        assert!(remarks.iter().any(|remark| remark.contains(words)), "{words} is missing in {remarks:#?}");
        assert!(page.contains(words), "{words} is missing in\n{page}");
    }
    assert!(page.contains("# Link frame: its frame is at [0.0, 0.0, 0.0] in the body's"), "{page}");
}

/// The advice of earlier versions, to write `free = true` on the page, was wrong: points on a fixed root are in its link's frame.
#[test]
fn a_root_without_mass_cannot_float_and_a_fixed_one_is_not_called_free() {
    let found = convert("r.urdf", "r.urdf", &robot(JOINT), Root::Floating).unwrap_err();
    assert!(found.contains("r.urdf:2: link `base` moves and has no mass"), "{found}");
    let (page, remarks) = convert("r.urdf", "r.urdf", &robot(JOINT), Root::Fixed).unwrap();
    let said = format!("{page}{}", remarks.join("\n"));
    assert!(said.contains("--floating lets it move") && !said.contains("free = true"), "{said}");
}
