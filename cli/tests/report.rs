//! `cargo xtask report` from the outside.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn report(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_gyro")).arg("report").args(args).output().unwrap()
}

/// An empty folder of its own, removed at the end.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("xtask-report-{}-{name}", std::process::id()));
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    fn text(&self, file: &str) -> String {
        fs::read_to_string(self.0.join(file)).unwrap()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn shown(path: &Path) -> String {
    path.display().to_string()
}

const PENDULUM: &str = r#"format = 1
name = "my_pendulum"
gravity = [0, -9.81, 0]

[simulation]
t_end = 1
step = 1e-3
correct_every = 5e-3

[[body]]
name = "wall"
fixed = true

[[body]]
name = "rod"
mass = 1
inertia = [1e-4, 0.08, 0.08]

[[joint]]
name = "hinge"
kind = "revolute"
axis = [0, 0, 1]
zero = [0, -1, 0]
first = { body = "wall" }
second = { body = "rod", point = [0, 0.5, 0] }
angle_deg = 90
"#;

/// Of the smallest error in joint coordinates, rad: a smooth motion, by a method of order 8.
const FINE: f64 = 1e-10;

#[test]
#[ignore = "compiles four optimised programs; `.ci/run` runs it after `cargo xtask report --quick`, which needs them too"]
fn a_page_without_a_reference_is_reported_whole() {
    let folder = Folder::new("whole");
    let page = folder.0.join("my-pendulum.toml");
    fs::write(&page, PENDULUM).unwrap();
    let out = folder.0.join("out");
    let output = report(&["--quick", &shown(&page), "--out", &shown(&out)]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let markdown = folder.text("out/my-pendulum.md");
    assert!(markdown.contains("because this model file has no reference solution"), "{markdown}");
    let html = folder.text("out/my-pendulum.html");
    // Figures inside, nothing from elsewhere but the page beside it in which the pendulum moves.
    assert!(html.matches("<svg").count() >= 6 && !html.contains("<link"));
    assert!(html.matches("src=").count() == 1 && html.contains("<iframe src=\"my-pendulum-moving.html\""));
    assert!(folder.text("out/my-pendulum-moving.html").contains("written by gyro show"));
    for figure in ["overview", "time", "evaluations", "time-f32", "order", "drift", "stability"] {
        let svg = folder.text(&format!("out/images/my-pendulum-{figure}.svg"));
        assert!(svg.contains("<polyline"), "nothing is drawn in {figure}");
    }
    let text = folder.text("out/my-pendulum.csv");
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let errors =
        reader.records().map(Result::unwrap).filter(|row| &row[0] == "generated" && &row[3] == "joint");
    let smallest = errors.filter_map(|row| row[7].parse::<f64>().ok()).fold(f64::INFINITY, f64::min);
    assert!(smallest < FINE, "{smallest:e}");
    assert!(folder.text("out/index.md").contains("[my-pendulum](my-pendulum.md)"));
}

#[test]
fn a_mistake_in_any_page_is_known_before_anything_is_compiled() {
    let folder = Folder::new("mistake");
    let page = folder.0.join("good.toml");
    fs::write(&page, PENDULUM).unwrap();
    let output = report(&["--quick", &shown(&page), "nowhere.toml", "--out", &shown(&folder.0.join("out"))]);
    let words = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{words}");
    assert!(words.contains("nowhere.toml cannot be read") && !folder.0.join("out").exists(), "{words}");
}

/// A mass on a spring that dry friction brings to rest, half a swing shorter each time.
const RUBBING: &str = r#"format = 1
name = "rubbing"

[simulation]
t_end = 14
step = 1e-3

[[body]]
name = "ground"
fixed = true

[[body]]
name = "mass"
mass = 1
inertia = [1, 1, 1]

[[joint]]
name = "slide"
kind = "prismatic"
axis = [1, 0, 0]
zero = [0, 1, 0]
first = { body = "ground" }
second = { body = "mass" }
displacement = 1

[[force]]
name = "spring"
kind = "spring"
joint = "slide"
stiffness = 4

[[contact]]
name = "bearing"
joint = "slide"
friction = 0.3
"#;

/// Rigid friction is as fine as a smooth motion; what is smooth is off by its width, whatever the tolerance.
#[test]
#[ignore = "compiles four optimised programs; `.ci/run` runs it after `cargo xtask report --quick`"]
fn a_page_of_contacts_has_smooth_ones_beside_them() {
    let folder = Folder::new("rubbing");
    let page = folder.0.join("rubbing.toml");
    fs::write(&page, RUBBING).unwrap();
    let out = folder.0.join("out");
    let output = report(&["--quick", &shown(&page), "--out", &shown(&out)]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let markdown = folder.text("out/rubbing.md");
    for words in [
        "## Rigid and smooth stops and friction",
        "nothing else follows rigid stops",
        "of motions from event to event",
    ] {
        assert!(markdown.contains(words), "{words} in {markdown}");
    }
    assert!(folder.text("out/images/rubbing-smooth.svg").contains("<polyline"));
    let errors = |file: &str, column: usize, keep: &dyn Fn(&csv::StringRecord) -> bool| -> Vec<f64> {
        let text = folder.text(file);
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let rows = reader.records().map(Result::unwrap).filter(|row| keep(row));
        rows.filter_map(|row| row[column].parse().ok()).collect()
    };
    let least = |errors: Vec<f64>| errors.into_iter().fold(f64::INFINITY, f64::min);
    let rigid = least(errors("out/rubbing.csv", 7, &|row| &row[3] == "joint"));
    assert!(rigid < FINE, "{rigid:e}");
    let by_width = |width: &str| least(errors("out/rubbing-smooth.csv", 3, &|row| &row[0] == width));
    let [wide, narrow] = ["1e-2", "1e-4"].map(by_width);
    assert!(wide > 1e-4 && narrow < 0.1 * wide && narrow > 1e3 * rigid, "{wide:e} {narrow:e} {rigid:e}");
}
