//! Inputs that others have met in public, with what is right.

use super::Folder;
use serde_json::Value;

const BASE: &str = "<link name=\"a\"/>";
const JOINT: &str = "<joint name=\"j\" type=\"revolute\"><axis xyz=\"1 0 0\"/><parent link=\"a\"/><child link=\"b\"/></joint>";

fn robot(
    folder: &Folder,
    before: &str,
    link: &str,
    args: &[&str],
) -> (Option<i32>, String, Option<gyro_model::Model>) {
    let text = format!("{before}<robot name=\"r\">{BASE}<link name=\"b\">{link}</link>{JOINT}</robot>");
    folder.write("r.urdf", text);
    let _ = std::fs::remove_file(folder.0.join("r.toml"));
    let output = folder.gyro(&[&["import", "r.urdf", "--out", "r.toml"], args].concat()).unwrap();
    let said = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap()).concat();
    let text = std::fs::read_to_string(folder.0.join("r.toml"));
    (output.status.code(), said, text.ok().map(|text| gyro_model::read("r.toml", &text).unwrap()))
}

fn inertial(mass: &str, inertia: &str) -> String {
    format!("<inertial><origin xyz=\"0 0 1\"/><mass value=\"{mass}\"/>{inertia}</inertial>")
}

const UNIT: &str = "<inertia ixx=\"1\" iyy=\"1\" izz=\"1\"/>";

#[test]
fn robots_as_other_tools_write_them() {
    let folder = Folder::new("known-robots");
    let mass = |model: &gyro_model::Model| {
        let body = model.bodies.iter().find(|body| body.name == "b").unwrap();
        model.value(&body.mass)
    };
    // A declaration after a comment, and one that begins on the second line.
    for before in ["<!-- a ring -->\n<?xml version=\"1.0\"?>\n", "\n<?xml version=\"1.0\"?>\n"] {
        let (code, said, model) = robot(&folder, before, &inertial("1", UNIT), &[]);
        assert_eq!((code, model.as_ref().map(mass)), (Some(0), Some(1.0)), "{said}");
    }
    // A prefix that nobody declares.
    let drake = "<collision><drake:proximity_properties><drake:mu_dynamic value=\"1\"/></drake:proximity_properties>\
        </collision>";
    let (code, said, model) = robot(&folder, "", &format!("{}{drake}", inertial("1", UNIT)), &[]);
    assert_eq!((code, model.as_ref().map(mass)), (Some(0), Some(1.0)), "{said}");
    assert!(said.contains("1 <collision>: these shapes have no counterpart"), "{said}");
    // A mass without an inertia is a point of mass.
    let (code, said, model) = robot(&folder, "", &inertial("1", ""), &[]);
    assert_eq!((code, model.as_ref().map(mass)), (Some(0), Some(1.0)), "{said}");
    assert!(said.contains("inertia"), "{said}");
    // Moments that no body has: refused with the way round, taken as they are on request.
    let wrist = inertial("0.1", "<inertia ixx=\"2.36e-5\" iyy=\"6.05e-5\" izz=\"1.42e-4\"/>");
    let (code, said, model) = robot(&folder, "", &wrist, &[]);
    assert!(code == Some(2) && model.is_none() && said.contains("--as-written"), "{said}");
    let (code, said, model) = robot(&folder, "", &wrist, &["--as-written"]);
    let model = model.unwrap_or_else(|| panic!("{code:?} {said}"));
    let body = model.bodies.iter().find(|body| body.name == "b").unwrap();
    let found = model.values(&body.inertia);
    assert_eq!(found[..3], [2.36e-5, 6.05e-5, 1.42e-4], "{said}");
}

/// A rod on a wall, with this in the section of its run.
fn rod(simulation: &str, body: &str) -> String {
    format!(
        "format = 1\nname = \"rod\"\ngravity = [0, -9.81, 0]\n[simulation]\nt_end = 1\n{simulation}\n[[body]]\n\
         name = \"wall\"\nfixed = true\n[[body]]\nname = \"rod\"\nmass = 1\n{body}\n[[joint]]\nname = \"hinge\"\n\
         kind = \"revolute\"\naxis = [0, 0, 1]\nzero = [0, -1, 0]\nfirst = {{ body = \"wall\" }}\n\
         second = {{ body = \"rod\", point = [0, 0.5, 0] }}\n"
    )
}

const INERTIA: &str = "inertia = [0.0833, 1e-4, 0.0833]";

#[test]
fn corrections_that_are_never_due_do_not_hang() {
    let folder = Folder::new("known-corrections");
    for (every, code) in [("1e50", 2), ("1e15", 0), ("1e308", 2)] {
        folder.write("rod.toml", rod(&format!("step = 1e-4\ncorrect_every = {every}"), INERTIA));
        for engine in ["assembled", "jit"] {
            let output = folder.gyro(&["simulate", "rod.toml", "--engine", engine, "--quiet", "--json"]);
            let output = output.unwrap_or_else(|| panic!("{engine}, {every}: no answer"));
            assert_eq!(
                output.status.code(),
                Some(code),
                "{every}: {}",
                String::from_utf8_lossy(&output.stderr)
            );
        }
    }
}

#[test]
fn a_plate_whose_moments_sum_up_to_the_last_digit_runs() {
    let folder = Folder::new("known-plate");
    let plate = "inertia = [0.009546518518518518, 0.009546518518518518, 0.019093037037037037]";
    folder.write("rod.toml", rod("", plate));
    let output = folder.gyro(&["simulate", "rod.toml", "--engine", "jit", "--quiet", "--json"]).unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let run: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(run["degrees_of_freedom"], 1);
    // A thousandth more is no plate.
    folder.write("rod.toml", rod("", "inertia = [0.00954, 0.00954, 0.0191]"));
    let output = folder.gyro(&["simulate", "rod.toml", "--engine", "jit", "--quiet", "--json"]).unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.code() == Some(2) && said.contains("triangle inequality"), "{said}");
}

#[test]
fn a_surface_that_is_nested_deeply_or_claims_too_much_is_refused() {
    let folder = Folder::new("known-surfaces");
    let shape = |file: &str| format!("{INERTIA}\n[[body.shape]]\nmesh = \"{file}\"");
    folder
        .write("deep.dae", format!("<COLLADA>{}{}</COLLADA>", "<a>".repeat(200_000), "</a>".repeat(200_000)));
    let mut claims = vec![0_u8; 80];
    claims.extend(u32::MAX.to_le_bytes());
    claims.extend([0; 50]);
    folder.write("claims.stl", &claims);
    for file in ["deep.dae", "claims.stl"] {
        folder.write("rod.toml", rod("", &shape(file)));
        let output = folder.gyro(&["show", "rod.toml", "--out", "page.html"]).unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.code() == Some(2) && said.contains(file), "{file}: {said}");
        assert!(!folder.0.join("page.html").exists());
    }
}
