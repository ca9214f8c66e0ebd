//! Units of FMI: their description, and that they give the bits of the functions and of the solver that they hold.
//! What importers that others wrote make of them: `.ci/fmu`.

use crate::program::{compiled, of_text, own};
use gyro_export::fmu::{Fmu, Settings, fmu};
use roxmltree::{Document, Node};
use std::fs;
use std::path::Path;
use std::process::Command;

const TOKEN: &str = "{a token}";

fn unit(page: &str) -> Fmu {
    unit_of((page, &fs::read_to_string(Path::new("../..").join(page)).expect("a model file")))
}

fn unit_of(page: (&str, &str)) -> Fmu {
    let mut functions = vec!["solvers"];
    let (model, _) = of_text(page, None);
    if !model.outputs.is_empty() {
        functions.extend(["joint_outputs", "output_derivatives"]);
    }
    let (model, module) = of_text(page, Some(&functions));
    let n_outputs: usize = model.outputs.iter().map(|output| output.kind.columns().len()).sum();
    let settings = Settings {
        token: TOKEN.to_owned(),
        method: "dop853",
        tolerance: 1e-9,
        input_units: vec!["N*m".to_owned(); model.inputs.len()],
        outputs: (0..n_outputs).map(|n| (format!("output {n}"), "m/s^2".to_owned())).collect(),
    };
    fmu(&model, &module.scheduled, &settings).expect("a unit")
}

fn attribute<'a>(node: Node<'a, '_>, name: &str) -> &'a str {
    node.attribute(name).unwrap_or_else(|| panic!("{node:?} without {name}"))
}

/// Value references count up from zero, and all that is referred to is there, once.
fn is_described(unit: &Fmu) {
    let (path, text) = &unit.files[0];
    assert_eq!(path, "modelDescription.xml");
    let document = Document::parse(text).expect("XML");
    let part = |name: &str| {
        let found = document.descendants().find(|node| node.has_tag_name(name));
        found.unwrap_or_else(|| panic!("no {name}"))
    };
    assert_eq!(attribute(document.root_element(), "instantiationToken"), TOKEN);
    let units: Vec<&str> = part("UnitDefinitions")
        .children()
        .filter(Node::is_element)
        .map(|unit| attribute(unit, "name"))
        .collect();
    let variables: Vec<Node<'_, '_>> = part("ModelVariables").children().filter(Node::is_element).collect();
    let mut names = Vec::new();
    for (n, variable) in variables.iter().enumerate() {
        assert_eq!(attribute(*variable, "valueReference"), n.to_string());
        assert!(variable.attribute("unit").is_none_or(|unit| units.contains(&unit)), "{variable:?}");
        names.push(attribute(*variable, "name"));
        if let Some(of) = variable.attribute("derivative") {
            let state = variables[of.parse::<usize>().expect("a number")];
            assert_eq!(attribute(*variable, "name"), format!("der({})", attribute(state, "name")));
        }
    }
    names.sort_unstable();
    let n_names = names.len();
    names.dedup();
    assert_eq!(names.len(), n_names, "names that two variables have");
    let of_kind =
        |kind: &str| part("ModelStructure").children().filter(|node| node.has_tag_name(kind)).count();
    let having =
        |name: &str, value: &str| variables.iter().filter(|of| of.attribute(name) == Some(value)).count();
    assert_eq!(of_kind("Output"), having("causality", "output"));
    assert_eq!(of_kind("InitialUnknown"), having("initial", "calculated"));
    assert_eq!(
        of_kind("ContinuousStateDerivative"),
        variables.iter().filter(|of| of.attribute("derivative").is_some()).count()
    );
}

fn check(page: &str) {
    let unit = unit(page);
    is_described(&unit);
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{}_unit", unit.identifier));
    for (path, text) in &unit.files {
        let path = folder.join(path);
        fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        fs::write(path, text).expect("a file");
    }
    let main = own(&unit.identifier, include_str!("unit.c"));
    fs::write(folder.join("sources/unit.c"), main).expect("a file");
    let sources: Vec<&str> = unit.sources.iter().map(String::as_str).chain(["sources/unit.c"]).collect();
    let Some(program) = compiled(&folder, (page, "unit"), &sources, &["-fsanitize=address,undefined"]) else {
        return;
    };
    let output = Command::new(program).arg(TOKEN).output().expect("the program starts");
    let words = String::from_utf8_lossy(&output.stderr);
    assert_eq!(String::from_utf8_lossy(&output.stdout), "the same bits\n", "{page}: {words}");
}

#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn of_a_loop() {
    check("models/four-bar.toml");
}

#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn with_parameters() {
    check("models/gyroscope-parameters.toml");
}

#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn with_inputs_and_outputs() {
    check("examples/arm/arm.toml");
}

#[test]
fn without_degrees_of_freedom() {
    check("tests/models/cam.toml");
}

/// Two carts on a rail: a motor pushes one, a spring holds the other.
const CARTS: &str = r#"
format = 1
name = "carts"
inputs = { push = 0 }
parameters = { stiffness = 5 }
body = [
    { name = "rail", fixed = true },
    { name = "one", mass = 2, inertia = [1, 1, 1] },
    { name = "other", mass = 2, inertia = [1, 1, 1] },
]
joint = [
    { name = "pushed", kind = "prismatic", axis = [1, 0, 0], zero = [0, 1, 0], first = { body = "rail" }, second = { body = "one" } },
    { name = "held", kind = "prismatic", axis = [1, 0, 0], zero = [0, 1, 0], first = { body = "rail" }, second = { body = "other" } },
]
force = [
    { name = "motor", kind = "motor", joint = "pushed", value = "push" },
    { name = "spring", kind = "spring", joint = "held", stiffness = "stiffness" },
]
output = [
    { name = "sensor", kind = "acceleration", body = "one" },
    { name = "place", kind = "pose", body = "other" },
]
"#;

#[test]
fn what_depends_on_what_is_told() {
    let unit = unit_of(("carts.toml", CARTS));
    let document = Document::parse(&unit.files[0].1).expect("XML");
    let variables: Vec<&str> = document
        .descendants()
        .filter(|node| node.has_tag_name("Float64"))
        .map(|node| attribute(node, "name"))
        .collect();
    let name = |reference: &str| variables[reference.parse::<usize>().expect("a number")];
    let depends = |kind: &str, unknown: &str| -> Vec<&str> {
        let is_it = |node: &Node<'_, '_>| {
            node.has_tag_name(kind) && name(attribute(*node, "valueReference")) == unknown
        };
        let found = document.descendants().find(is_it).unwrap_or_else(|| panic!("no {kind} {unknown}"));
        attribute(found, "dependencies").split_whitespace().map(name).collect()
    };
    // Of the outputs the first six are accelerations, then come a place and an orientation.
    let expected: [(&str, &str, &[&str]); 10] = [
        ("Output", "pushed", &["pushed"]),
        ("Output", "held rate", &["held rate"]),
        ("ContinuousStateDerivative", "der(pushed)", &["pushed rate"]),
        ("ContinuousStateDerivative", "der(pushed rate)", &["push"]),
        ("ContinuousStateDerivative", "der(held rate)", &["held", "stiffness"]),
        ("InitialUnknown", "der(held rate)", &["held", "stiffness"]),
        ("Output", "output 0", &["push"]),
        ("Output", "output 1", &[]),
        ("Output", "output 6", &["held"]),
        ("InitialUnknown", "output 7", &[]),
    ];
    for (kind, unknown, knowns) in expected {
        assert_eq!(depends(kind, unknown), knowns, "{kind} {unknown}");
    }
}
