//! What is read otherwise on request.

use super::*;

/// A mass without inertia is a point; inertias that no body has, and numbers near round ones, are kept on request.
#[test]
fn numbers_are_taken_as_they_are_written_on_request() {
    let rest = link("b", (1.0, [1.0, 1.0, 3.0]), "revolute", "arm")
        .replace("<axis xyz=\"0 0 0\"/>", "<axis xyz=\"1e-9 0 1\"/>")
        .replace("xyz=\"0 0 2\"", "xyz=\"0 0 2\" rpy=\"1.5708 0 0\"")
        + r#"<link name="point"><inertial><origin xyz="0 0 1"/><mass value="1"/></inertial></link>
<joint name="p" type="revolute"><parent link="b"/><child link="point"/></joint>"#;
    let text = robot(&format!("{JOINT}{rest}"));
    let refused = convert("r.urdf", "r.urdf", &text, PLAIN).unwrap_err();
    assert!(refused.contains("--as-written") && refused.contains("--density"), "{refused}");
    let (page, remarks) = convert("r.urdf", "r.urdf", &text, Wishes { as_written: true, ..PLAIN }).unwrap();
    assert!(page.contains("as_written = true\nmass = 1.0\ninertia = [1.0, 1.0, 3.0]\n"), "{page}");
    assert!(page.contains("axis = [1e-9, "), "{page}");
    assert!(!page.contains("axis = [0.0, -1.0, 0.0]"), "{page}");
    for words in
        ["<inertial> of link `point`: a mass without <inertia> is taken for a point", "a millimetre thick"]
    {
        assert!(remarks.iter().any(|remark| remark.contains(words)), "{words} is missing in {remarks:#?}");
    }
    gyro_model::read("r.toml", &page).unwrap_or_else(|mistakes| panic!("{mistakes}"));
    let broken = page.replace("as_written = true\n", "");
    let said = gyro_model::read("r.toml", &broken).unwrap_err().to_string();
    assert!(said.contains("breaks the triangle inequality") && said.contains("as_written = true"), "{said}");
}

/// Solids of 1000 kg/m3: a box of 0.1 × 0.2 × 0.3 m without inertial; a sphere whose inertia no body has keeps its
/// mass.
#[test]
fn shapes_are_weighed_on_request() {
    let rest = link("b", (2.0, [1.0, 1.0, 3.0]), "revolute", "arm").replace("0 0 0\"", "0 0 1\"").replace(
        "</inertial>",
        r#"</inertial><collision><origin xyz="0 0 5"/><geometry><sphere radius="0.5"/></geometry></collision>"#,
    ) + r#"<link name="box"><visual><origin xyz="1 0 0" rpy="0 0 1.5707963267948966"/><geometry><box size="0.1 0.2 0.3"/></geometry></visual></link>
<joint name="p" type="prismatic"><parent link="b"/><child link="box"/></joint>"#;
    let text = robot(&format!("{JOINT}{rest}"));
    let (page, remarks) =
        convert("r.urdf", "r.urdf", &text, Wishes { density: Some(1000.0), ..PLAIN }).unwrap();
    // 2/5 m r² = 0.2; m (b² + c²) / 12 with the sides x and y exchanged by the turn.
    assert!(page.contains("mass = 2.0\ninertia = [0.2, 0.2, 0.2]\n"), "{page}");
    assert!(page.contains("mass = 6.0\ninertia = [0.05, 0.065, 0.025]\n"), "{page}");
    for words in [
        "mass and inertia are those of the shapes at 1000 kg/m3: `box`",
        "inertias are those of the shapes, scaled to the masses of the file: `b`",
    ] {
        assert!(remarks.iter().any(|remark| remark == words), "{words} is missing in {remarks:#?}");
    }
}

/// The outputs of a tool that is turned on its arm are by its own axes, and shapes keep their colours.
#[test]
fn frames_of_links_are_outputs_and_colours_are_kept() {
    let rest = r#"<material name="red"><color rgba="1 0 0.2 1"/></material>
<link name="tool"><visual><geometry><sphere radius="0.5"/></geometry><material name="red"/></visual></link>
<joint name="f" type="fixed"><origin xyz="0.5 0 0" rpy="0 0 0.3"/><parent link="arm"/><child link="tool"/></joint>"#;
    let text = robot(&format!("{JOINT}{rest}"));
    let frames = |names: &[&str]| {
        let frames: Vec<String> = names.iter().map(|&name| name.to_owned()).collect();
        convert("r.urdf", "r.urdf", &text, Wishes { frames: &frames, ..PLAIN })
    };
    let (page, _) = frames(&["tool"]).unwrap();
    let half = "[0.988771077936042, 0.0, 0.0, 0.149438132473599]";
    let output = |kind: &str| {
        format!(
            "name = \"tool_{kind}\"\nkind = \"{kind}\"\nbody = \"arm\"\npoint = [0.5, 0.0, 0.0]\norientation = {half}\n"
        )
    };
    assert!(["pose", "velocity"].iter().all(|kind| page.contains(&output(kind))), "{page}");
    assert!(page.contains("color = \"#ff0033\"\n"), "{page}");
    let (page, remarks) = frames(&["all"]).unwrap();
    assert_eq!(page.matches("[[output]]").count(), 4, "{page}");
    assert!(
        remarks.iter().all(|remark| !remark.contains("--frames") && !remark.contains("<material>")),
        "{remarks:#?}"
    );
    let said = frames(&["base"]).err().unwrap();
    assert!(said.contains("--frames base: this link is fixed"), "{said}");
}
