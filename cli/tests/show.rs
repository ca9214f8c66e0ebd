//! `cargo xtask show`: pages are written whole, from disk alone, and never over what somebody else wrote.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// An empty folder of its own, removed at the end.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("gyro-show-{}-{name}", std::process::id()));
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn show(model: &str, page: &Path, options: &[&str]) -> Output {
    let model = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(model);
    let mut command = Command::new(env!("CARGO_BIN_EXE_gyro"));
    command.arg("show").arg(model).arg("--out").arg(page).args(options).output().unwrap()
}

/// What the page tells its program.
fn head(page: &Path) -> Value {
    let html = fs::read_to_string(page).unwrap();
    assert!(html.starts_with("<!doctype html>"), "{}", &html[..80]);
    let (_, rest) = html.split_once("id=\"head\">").unwrap();
    serde_json::from_str(rest.split_once("</script>").unwrap().0).unwrap()
}

#[test]
fn a_run_of_another_model_file_is_shown_over_the_first() {
    let folder = Folder::new("other");
    let page = folder.0.join("pendulum.html");
    let other = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models/compound-pendulum.toml");
    let other = other.to_str().unwrap();
    let options = ["--t-end", "0.1", "--set", "length=0.3", "--compare", other];
    let output = show("examples/pendulum.toml", &page, &options);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let head = head(&page);
    let scenes = head["scenes"].as_array().unwrap();
    let names: Vec<&str> = scenes.iter().map(|s| s["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["pendulum", "compound-pendulum"]);
    assert_eq!(scenes[0]["mechanism"]["joints"][0]["ends"][1]["point"][1], 0.3);
    assert_eq!(scenes[1]["mechanism"]["name"], "compound_pendulum");
}

#[test]
fn what_formulas_of_forces_give_is_told() {
    let folder = Folder::new("laws");
    let head = |name: &str| {
        let page = folder.0.join(format!("{name}.html"));
        let output = show(&format!("examples/laws/{name}.toml"), &page, &["--t-end", "0.1"]);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        head(&page)["scenes"][0].clone()
    };
    let has = |scene: &Value, title: &str, name: &str| {
        let columns = scene["columns"].as_array().unwrap().iter();
        columns.filter(|column| column["title"] == title && column["name"] == name).count() == 1
    };
    // What the model file tells itself is not told again.
    let crane = head("crane");
    assert_eq!(crane["mechanism"]["links"][0]["force"], json!({ "output": "wire", "part": "force" }));
    assert!(has(&crane, "wire", "force") && !has(&crane, "wire_force", "force"));
    let car = head("quarter_car");
    let values: Vec<&Value> =
        car["mechanism"]["efforts"].as_array().unwrap().iter().map(|of| &of["numbers"]["value"]).collect();
    assert_eq!(
        values,
        ["damper_value", "tyre_value"].map(|name| json!({ "output": name, "part": "" })).each_ref()
    );
    assert!(has(&car, "damper_value", ""));
    let quadrotor = head("quadrotor");
    assert!(has(&quadrotor, "front_force_z", "") || has(&quadrotor, "resistance_force_z", ""), "{quadrotor}");
}

#[test]
fn two_runs_are_on_one_page() {
    let folder = Folder::new("two");
    let page = folder.0.join("deep/pendulum.html");
    let options = ["--t-end", "0.1", "--every", "0.01", "--compare", "length=0.4,assembled", "--reactions"];
    let output = show("examples/pendulum.toml", &page, &options);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(String::from_utf8_lossy(&output.stdout).contains("22 samples"), "two runs of eleven");
    let head = head(&page);
    let names: Vec<&str> =
        head["scenes"].as_array().unwrap().iter().map(|s| s["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["length = 0.5, in-process", "length = 0.4, assembled"]);
    for (scene, length) in head["scenes"].as_array().unwrap().iter().zip([0.5, 0.4]) {
        assert_eq!(scene["n"], 11);
        assert_eq!(scene["mechanism"]["joints"][0]["kind"], "Revolute");
        assert_eq!(scene["mechanism"]["joints"][0]["ends"][1]["point"][1], length);
        assert_eq!(scene["reactions"][0]["joint"], 0);
        let column = scene["reactions"][0]["column"].as_u64().unwrap() as usize;
        assert_eq!(scene["columns"][column]["title"], "reaction_of_hinge");
        assert_eq!(scene["columns"][column]["name"], "force_f");
    }
}

#[test]
fn a_run_that_fails_is_shown_up_to_there() {
    let folder = Folder::new("fails");
    let page = folder.0.join("x.html");
    let options = ["--integrator", "dop853", "--tolerance", "1e-9", "--budget", "4", "--every", "0.001"];
    let output = show("examples/pendulum.toml", &page, &options);
    let words = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{words}");
    assert!(words.contains("The page shows the run up to there"), "{words}");
    assert!(head(&page)["scenes"][0]["n"].as_u64().unwrap() > 1);
}

/// Contacts are known in joint coordinates alone, which nobody needs to say.
#[test]
fn a_model_with_rigid_stops_is_shown_without_options() {
    let folder = Folder::new("contacts");
    let page = folder.0.join("gimbal.html");
    let output = show("models/stabilised-gimbal.toml", &page, &["--engine", "jit", "--t-end", "0.05"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(head(&page)["scenes"][0]["mechanism"]["name"], "stabilised_gimbal");
}

#[test]
fn mistakes_are_found_before_the_run() {
    let folder = Folder::new("mistakes");
    let page = folder.0.join("mine.html");
    for (options, words) in [
        (&["--json"][..], "--json is an option of simulate"),
        (&["--linearize", "0"], "--linearize is an option of simulate"),
        (&["--compare", "steam"], "PARAMETER=VALUE, an engine or a model file was expected"),
        (&["--compare", "mass=1"], "mass"),
        (&["--coordinates", "joint", "--engine", "assembled"], "--coordinates joint"),
    ] {
        let output = show("examples/pendulum.toml", &page, options);
        let found = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{options:?}: {found}");
        assert!(found.contains(words), "{options:?}: {found}");
        assert!(!page.exists());
    }
    fs::write(&page, "mine").unwrap();
    let output = show("examples/pendulum.toml", &page, &["--t-end", "0.1"]);
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(fs::read_to_string(&page).unwrap(), "mine");
}

/// A tetrahedron with its right angle at the origin and edges of 2, as each format has it: with a hundred times its
/// size and centimetres as its unit in COLLADA.
const CORNERS: [[f32; 3]; 4] = [[0.0; 3], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0]];
const FACES: [[usize; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

fn binary_stl() -> Vec<u8> {
    // What begins as text does need not be text.
    let mut bytes = vec![b' '; 80];
    bytes[..6].copy_from_slice(b"solid ");
    bytes.extend(4_u32.to_le_bytes());
    for face in FACES {
        let floats = [0.0_f32; 3].into_iter().chain(face.into_iter().flat_map(|k| CORNERS[k]));
        bytes.extend(floats.flat_map(f32::to_le_bytes));
        bytes.extend([0, 0]);
    }
    bytes
}

fn text_stl() -> String {
    let facet = |face: [usize; 3]| {
        let corners = face.map(|k| format!("vertex {} {} {}", CORNERS[k][0], CORNERS[k][1], CORNERS[k][2]));
        format!("facet normal 0 0 0\nouter loop\n{}\nendloop\nendfacet\n", corners.join("\n"))
    };
    format!("solid wedge\n{}endsolid wedge\n", FACES.map(facet).concat())
}

fn obj() -> String {
    let vertices = CORNERS.map(|[x, y, z]| format!("v {x} {y} {z}\n")).concat();
    // One face has four corners: two triangles.
    let faces = ["f 1 3 2", "f 1 2 4", "f 1 4 3", "f 2 3 4"].join("\n");
    format!("mtllib missing.mtl\no wedge\n{vertices}{faces}\n")
}

fn collada() -> String {
    let points: Vec<String> = CORNERS.iter().flatten().map(|x| (100.0 * x).to_string()).collect();
    let corners: Vec<String> = FACES.iter().flatten().map(ToString::to_string).collect();
    format!(
        r##"<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="centimeter" meter="0.01"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g" name="g"><mesh>
<source id="p"><float_array id="pa" count="12">{}</float_array><technique_common>
<accessor source="#pa" count="4" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor>
</technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="4"><input semantic="VERTEX" source="#v" offset="0"/><p>{}</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene>
</COLLADA>"##,
        points.join(" "),
        corners.join(" ")
    )
}

fn gyro(folder: &Path, args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_gyro")).current_dir(folder).args(args).output().unwrap()
}

#[test]
fn a_robot_with_meshes_looks_like_them() {
    let folder = Folder::new("meshes");
    let root = &folder.0;
    let package = root.join("wedge_description");
    fs::create_dir_all(package.join("meshes")).unwrap();
    fs::create_dir_all(package.join("urdf")).unwrap();
    fs::write(package.join("meshes/a.STL"), binary_stl()).unwrap();
    fs::write(package.join("meshes/b.stl"), text_stl()).unwrap();
    fs::write(package.join("meshes/c.obj"), obj()).unwrap();
    fs::write(package.join("meshes/d \"d\".dae"), collada()).unwrap();
    let visual = |file: &str, scale: &str| {
        format!(
            r#"<visual><origin xyz="0 0 0.5"/><geometry><mesh filename="{file}"{scale}/></geometry></visual>"#
        )
    };
    let visuals = [
        visual("package://wedge_description/meshes/a.STL", r#" scale="0.5 -0.5 0.5""#),
        visual("../meshes/b.stl", ""),
        visual("package://wedge_description/meshes/c.obj", ""),
        visual("package://wedge_description/meshes/d &quot;d&quot;.dae", ""),
        visual("package://elsewhere/meshes/e.stl", ""),
    ];
    let urdf = format!(
        r#"<robot name="wedge"><link name="base"/><link name="arm"><inertial><mass value="1"/>
<inertia ixx="1" iyy="1" izz="1"/></inertial>{}</link>
<joint name="hinge" type="continuous"><parent link="base"/><child link="arm"/><axis xyz="1 0 0"/></joint></robot>"#,
        visuals.concat()
    );
    fs::write(package.join("urdf/wedge.urdf"), urdf).unwrap();
    let output = gyro(root, &["import", "wedge_description/urdf/wedge.urdf", "--out", "wedge.toml"]);
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(said.contains("1 <visual> and 0 <collision>") && said.contains("ROS_PACKAGE_PATH"), "{said}");
    let model = fs::read_to_string(root.join("wedge.toml")).unwrap();
    assert!(
        model.contains("mesh = \"wedge_description/meshes/a.STL\"\nscale = [0.5, -0.5, 0.5]\n"),
        "{model}"
    );

    let output =
        gyro(root, &["show", "wedge.toml", "--t-end", "0.1", "--compare", "assembled", "--out", "page.html"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let head = head(&root.join("page.html"));
    // All four are the same surface, and both runs have it: it is on the page once.
    let meshes = head["meshes"].as_array().unwrap();
    assert_eq!(meshes.len(), 1, "{meshes:?}");
    assert_eq!(meshes[0]["n"], serde_json::json!([4, 4]));
    for scene in head["scenes"].as_array().unwrap() {
        assert_eq!(scene["meshes"], serde_json::json!([0, 0, 0, 0]));
        let shapes = scene["mechanism"]["bodies"][1]["shapes"].as_array().unwrap();
        let places: Vec<_> = shapes.iter().map(|shape| shape["mesh"].as_u64().unwrap()).collect();
        assert_eq!(places, [0, 1, 2, 3]);
        assert_eq!(shapes[0]["size"], serde_json::json!([0.5, -0.5, 0.5]));
    }

    // What cannot be drawn is told before the run, all of it, and no page is written.
    fs::write(package.join("meshes/a.STL"), b"").unwrap();
    fs::write(package.join("meshes/b.stl"), b"solid x\nendsolid x\n").unwrap();
    fs::remove_file(package.join("meshes/c.obj")).unwrap();
    let broken = collada().replace("#g", "#nothing").replace(" 200", "");
    fs::write(package.join("meshes/d \"d\".dae"), broken).unwrap();
    for command in [&["show", "wedge.toml", "--out", "other.html"][..], &["check", "wedge.toml"]] {
        let output = gyro(root, command);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{said}");
        for file in ["a.STL", "b.stl", "c.obj", "d \"d\".dae"] {
            let line =
                said.lines().find(|line| line.contains(file)).unwrap_or_else(|| panic!("{file}: {said}"));
            assert!(line.contains("wedge.toml: body `arm`: mesh `"), "{line}");
        }
        assert!(!said.contains("panicked") && said.contains("or remove these shapes"), "{said}");
    }
    assert!(!root.join("other.html").exists());
}

/// The names of the files of a folder that end so.
fn names(folder: &str, ending: &str) -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(folder);
    let files = fs::read_dir(&folder).unwrap().map(|file| file.unwrap().file_name().into_string().unwrap());
    files.filter_map(|name| name.strip_suffix(ending).map(str::to_owned)).collect()
}

#[test]
fn the_gallery_has_all_model_files() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/show.md");
    let page = fs::read_to_string(page).unwrap();
    let (_, gallery) = page.split_once("## Gallery").unwrap();
    for name in names("models", ".toml") {
        assert!(gallery.contains(&format!("](../models/{name}.toml)")), "{name}: docs/show.md");
    }
    for name in names("docs/images/show", ".webp") {
        assert!(
            gallery.contains(&format!("](images/show/{name}.webp)")),
            "{name}: nothing shows its picture"
        );
    }
    let pictures = names("docs/images/show", ".webp").len();
    assert_eq!(gallery.matches("](images/show/").count(), pictures, "a picture of the gallery is not there");
}
