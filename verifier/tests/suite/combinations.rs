//! Every parameter on every kind of joint, with and without an input: each combination is generated and proved.

use crate::support::generate_text;
use gyro_verifier::{Depth, verify};

/// Kinds of joint with their own keys, and the coordinate that a spring and a motor act on, if there is one.
const KINDS: [(&str, &str, Option<&str>); 10] = [
    ("revolute", "", Some("angle")),
    ("spherical", "", None),
    ("fixed", "", None),
    ("universal", "", Some("second_angle")),
    ("cylindrical", "", Some("displacement")),
    ("prismatic", "", Some("displacement")),
    ("planar", "", Some("x")),
    ("screw", "lead = 0.01\n", Some("angle")),
    ("point_on_line", "", Some("displacement")),
    ("rod", "length = 0.25\n", None),
];
const TUNABLE: [&str; 5] = ["mass", "inertia", "point", "gravity", "stiffness"];

/// A body on one joint, of which some numbers are parameters.
fn page((kind, own, coordinate): (&str, &str, Option<&str>), tuned: &[&str], has_input: bool) -> String {
    let number = |name: &str, value: &str| {
        if tuned.contains(&name) { format!("\"p_{name}\"") } else { value.to_owned() }
    };
    let defaults =
        [("mass", "2"), ("inertia", "0.5"), ("point", "-0.25"), ("gravity", "9.81"), ("stiffness", "3")];
    let parameters = defaults.iter().filter(|(name, _)| tuned.contains(name));
    let parameters: String = parameters.map(|(name, value)| format!("p_{name} = {value}\n")).collect();
    let [mass, moment, point, gravity, stiffness] = defaults.map(|(name, value)| number(name, value));
    let frames = match kind {
        "spherical" | "rod" => [""; 2],
        "point_on_line" => [", axis = [1, 0, 0], zero = [0, 1, 0]", ""],
        "universal" => [", axis = [0, 0, 1], zero = [1, 0, 0]", ", axis = [1, 0, 0], zero = [0, 0, 1]"],
        _ => [", axis = [0, 0, 1], zero = [1, 0, 0]"; 2],
    };
    let spring = match coordinate {
        Some(coordinate) => format!(
            "[[force]]\nname = \"spring\"\nkind = \"spring\"\njoint = \"joint\"\ncoordinate = \"{coordinate}\"\n\
             stiffness = {stiffness}\n"
        ),
        None => format!(
            "[[force]]\nname = \"spring\"\nkind = \"link\"\nfirst = {{ body = \"ground\", point = [1, 2, 3] }}\n\
             second = {{ body = \"part\" }}\nstiffness = {stiffness}\nfree_length = 0.5\n"
        ),
    };
    let drive = match coordinate {
        Some(coordinate) => format!(
            "[[force]]\nname = \"drive\"\nkind = \"motor\"\njoint = \"joint\"\ncoordinate = \"{coordinate}\"\n\
             value = \"drive\"\n"
        ),
        None => "[[force]]\nname = \"drive\"\nkind = \"load\"\nbody = \"part\"\nforce = [\"drive\", 0, 0]\n"
            .to_owned(),
    };
    // Only the body on a rod has a place of its own.
    let place = if kind == "rod" { "position = [0.5, 0, 0]\n" } else { "" };
    let (inputs, drive) = if has_input { ("[inputs]\ndrive = 0.5\n", drive) } else { ("", String::new()) };
    format!(
        "format = 1\nname = \"combined\"\ngravity = [0, {gravity}, 0]\n[parameters]\n{parameters}{inputs}\
         [[body]]\nname = \"ground\"\nfixed = true\n\
         [[body]]\nname = \"part\"\nmass = {mass}\ninertia = [0.5, 0.75, {moment}]\n{place}\
         [[joint]]\nname = \"joint\"\nkind = \"{kind}\"\n{own}first = {{ body = \"ground\"{} }}\n\
         second = {{ body = \"part\", point = [{point}, 0, 0]{} }}\n{spring}{drive}",
        frames[0], frames[1]
    )
}

/// What is refused, of one kind of joint.
fn refused(kind: (&str, &str, Option<&str>)) -> Vec<String> {
    let mut refused = Vec::new();
    // What depends on the parameter alone is a result of its own where there is an input. Without one there are fewer
    // such results, so there all parameters come at once; one by one they were tried once.
    let alone = TUNABLE.iter().map(|tuned| (std::slice::from_ref(tuned), true));
    for (tuned, has_input) in alone.chain([(&TUNABLE[..], false), (&[], false)]) {
        let page = generate_text("combined.toml", &page(kind, tuned, has_input));
        let report = verify(&page.model, &page.code, &page.constants, Depth::Quick);
        if !report.is_proved() {
            refused.push(format!("{}, {tuned:?}, input: {has_input}: {}", kind.0, summary(&report)));
        }
    }
    refused
}

/// What is wrong, without what is right.
fn summary(report: &gyro_verifier::Report) -> String {
    let text = report.to_string();
    text.lines().filter(|line| !line.contains("degree <")).collect::<Vec<_>>().join("\n")
}

#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn every_parameter_on_every_joint_is_proved_with_and_without_an_input() {
    let (left, right) = KINDS.split_at(KINDS.len() / 2);
    let refused: Vec<String> = std::thread::scope(|scope| {
        let threads = [left, right]
            .map(|kinds| scope.spawn(|| kinds.iter().copied().flat_map(refused).collect::<Vec<_>>()));
        threads.into_iter().flat_map(|thread| thread.join().expect("no panic but of the tools")).collect()
    });
    assert!(refused.is_empty(), "{} refused:\n{}", refused.len(), refused.join("\n"));
}

/// A body may be the first of its joint as well as the second; of a point on a line the first has the line.
#[test]
fn every_joint_is_proved_turned_round() {
    for (kind, own, coordinate) in KINDS.into_iter().filter(|(kind, ..)| *kind != "point_on_line") {
        let text = page((kind, own, coordinate), &[], false);
        let turned = text.replace("first = {", "other = {").replace("second = {", "first = {");
        let page = generate_text("combined.toml", &turned.replace("other = {", "second = {"));
        let report = verify(&page.model, &page.code, &page.constants, Depth::Quick);
        assert!(report.is_proved(), "{kind}, the first body hangs on it: {}", summary(&report));
    }
}
