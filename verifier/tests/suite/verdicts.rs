//! What is wrong, what is only flawed, and what many square roots must not hide.

use crate::support::generate_text;
use gyro_model::Model;
use gyro_program::Kernel;
use gyro_verifier::field::Prime;
use gyro_verifier::module::Module;
use gyro_verifier::program::{Node, Program};
use gyro_verifier::proof::{Claim, Decider, Verdict, prime};
use gyro_verifier::{Depth, Finding, Report, verify};
use std::fmt::Write;

/// A chain of revolute joints, each between two end stops.
fn stopped_chain(bodies: usize) -> Model {
    let mut page =
        "format = 1\nname = \"chain\"\ngravity = [0, -9.81, 0]\n[[body]]\nname = \"wall\"\nfixed = true\n"
            .to_owned();
    let axes = [("[0, 1, 0]", "[0, 0, 1]"), ("[1, 0, 0]", "[0, 1, 0]"), ("[0, 0, 1]", "[1, 0, 0]")];
    let mut before = "wall".to_owned();
    for body in 0..bodies {
        let (axis, zero) = axes[body % 3];
        let _ = write!(
            page,
            "[[body]]\nname = \"b{body}\"\nmass = 1\ninertia = [0.1, 0.2, 0.15]\n\
             [[joint]]\nname = \"j{body}\"\nkind = \"revolute\"\naxis = {axis}\nzero = {zero}\n\
             first = {{ body = \"{before}\", point = [0.1, 0.2, 0] }}\nsecond = {{ body = \"b{body}\", point = [-0.3, 0, 0] }}\n"
        );
        for (side, limit) in [("lower", -1), ("upper", 1)] {
            let _ = write!(
                page,
                "[[force]]\nname = \"{side}{body}\"\nkind = \"stop\"\njoint = \"j{body}\"\nside = \"{side}\"\nlimit = {limit}\n\
                 stiffness = 100\ndamping = 1\nsoftness = 0.01\n"
            );
        }
        before = format!("b{body}");
    }
    gyro_model::read("chain.toml", &page).expect("a good model file")
}

/// No point has all of sixteen square roots; the module is proved all the same, and a fault in it found.
#[test]
fn many_roots_hide_neither_proof_nor_fault() {
    let model = stopped_chain(8);
    let module = gyro_codegen::generate_functions("chain.toml", &model, &gyro_codegen::Functions::all())
        .expect("a module");
    let report = verify(&model, &module.code, &module.constants, Depth::Quick);
    assert!(report.is_proved(), "{report}");
    let mut module = Module::read(&model, &module.code, &module.constants).expect("the emitted subset");
    let prime: Prime<9> = prime(&model, &module, 1).expect("room for all roots");
    let decider = Decider::new(&model, prime);
    let decide = |module: &Module| decider.decide(module, Claim(Kernel::AppliedForce), 1, 1);
    assert!(matches!(decide(&module), Verdict::Proved { .. }));
    module.programs.get_mut("applied_force").expect("a function").results.swap(3, 4);
    assert!(matches!(decide(&module), Verdict::Refuted { .. }));
}

/// Without the work the state is shorter, and nothing else is missing.
#[test]
fn a_module_without_the_work_is_proved() {
    let counted = gyro_model::read("chain.toml", &page_with_work("")).expect("a good model file");
    let left_out =
        gyro_model::read("chain.toml", &page_with_work("count_work = false\n")).expect("a good model file");
    assert!(counted.has_work() && !left_out.has_work());
    for (model, joint_state) in [(&counted, "[T; 3]"), (&left_out, "[T; 2]")] {
        let module = gyro_codegen::generate_functions("chain.toml", model, &gyro_codegen::Functions::all())
            .expect("a module");
        assert!(module.code.contains(&format!("type Joints = {joint_state}")), "{}", module.code);
        let report = verify(model, &module.code, &module.constants, Depth::Quick);
        assert!(report.is_proved(), "{report}");
    }
}

/// A crank with a motor, friction and an output of the power.
fn page_with_work(key: &str) -> String {
    format!(
        "format = 1\nname = \"crank\"\n{key}[inputs]\nu = 0\n[[body]]\nname = \"wall\"\nfixed = true\n\
         [[body]]\nname = \"arm\"\nmass = 1\ninertia = [0.1, 0.2, 0.15]\n\
         [[joint]]\nname = \"hinge\"\nkind = \"revolute\"\naxis = [0, 0, 1]\nzero = [1, 0, 0]\ndamping = 0.1\n\
         first = {{ body = \"wall\" }}\nsecond = {{ body = \"arm\", point = [0.5, 0, 0] }}\n\
         [[force]]\nname = \"winding\"\nkind = \"motor\"\njoint = \"hinge\"\nvalue = \"u\"\n\
         [[output]]\nname = \"spent\"\nkind = \"power\"\n"
    )
}

/// A chain of revolute joints, each number of whose frames is a parameter.
fn free_frames(joints: usize) -> Model {
    let (mut parameters, mut parts) = (String::new(), "[[body]]\nname = \"b0\"\nfixed = true\n".to_owned());
    let mut vector = |name: &str, values: [f64; 3]| {
        let names = ["x", "y", "z"].map(|k| format!("{name}_{k}"));
        for (name, value) in names.iter().zip(values) {
            let _ = writeln!(parameters, "{name} = {value}");
        }
        format!("{names:?}")
    };
    for joint in 0..joints {
        let mut frame = |side: &str| {
            let axis = vector(&format!("axis{joint}_{side}"), [1.0, joint as f64, 2.0]);
            let zero = vector(&format!("zero{joint}_{side}"), [0.0, 1.0, 0.5]);
            format!("axis = {axis}, zero = {zero}")
        };
        let (first, second, next) = (frame("first"), frame("second"), joint + 1);
        let _ = write!(
            parts,
            "[[body]]\nname = \"b{next}\"\nmass = 1\ninertia = [0.1, 0.2, 0.15]\n\
             [[joint]]\nname = \"j{joint}\"\nkind = \"revolute\"\n\
             first = {{ body = \"b{joint}\", {first} }}\nsecond = {{ body = \"b{next}\", {second} }}\n"
        );
    }
    let page = format!("format = 1\nname = \"frames\"\n[parameters]\n{parameters}{parts}");
    gyro_model::read("frames.toml", &page).expect("a good model file")
}

/// An arm on a joint whose frame's numbers are given.
fn arm(axis: &str, zero: &str) -> Model {
    let frame = format!("axis = {axis}, zero = {zero}");
    let page = format!(
        "format = 1\nname = \"arm\"\n[parameters]\np = 3\n[[body]]\nname = \"wall\"\nfixed = true\n\
         [[body]]\nname = \"arm\"\nmass = 1\ninertia = [0.1, 0.2, 0.15]\n\
         [[joint]]\nname = \"hinge\"\nkind = \"prismatic\"\n\
         first = {{ body = \"wall\", {frame} }}\nsecond = {{ body = \"arm\", point = [0.5, 0, 0.1], {frame} }}\n"
    );
    gyro_model::read("arm.toml", &page).unwrap_or_else(|problems| panic!("{page}\n{problems}"))
}

/// The axis is as long as the root of 26 + p², its zero direction across it as that of 26 (26 + p²): of a number that
/// is not a square modulo a prime, times 26 or not, one root is always missing, unless 26 is a square.
#[test]
fn roots_of_parameters_do_not_exclude_each_other() {
    for (axis, zero) in
        [("[5, 1, \"p\"]", "[0, 0, 1]"), ("[1, \"p\", 6]", "[0, 1, 0]"), ("[\"p\", 3, 7]", "[1, 0, 0]")]
    {
        let model = arm(axis, zero);
        let module = gyro_codegen::generate_functions("arm.toml", &model, &gyro_codegen::Functions::all())
            .expect("a module");
        let report = verify(&model, &module.code, &module.constants, Depth::Quick);
        assert!(report.is_proved(), "{axis}: {report}");
    }
}

/// Along an axis of one number the zero direction's component is zero, whatever that number is.
#[test]
fn frames_of_parameters_store_no_zeros() {
    for (axis, zero) in
        [("[0, 0, \"p\"]", "[3, 0, 4]"), ("[\"p\", 0, 0]", "[1, 2, 0.5]"), ("[0, \"p\", \"p\"]", "[3, 1, 1]")]
    {
        let model = arm(axis, zero);
        let module = gyro_codegen::generate_functions("arm.toml", &model, &gyro_codegen::Functions::all())
            .expect("a module");
        let report = verify(&model, &module.code, &module.constants, Depth::Quick);
        assert!(report.is_proved(), "{axis}: {report}");
    }
}

/// Of a cross whose axes lie alike in both frames, what a product has of one component it loses by another.
#[test]
fn crosses_of_parameters_store_no_zeros() {
    let page = "format = 1\nname = \"cross\"\n[parameters]\np = 1\n[[body]]\nname = \"base\"\nfixed = true\n\
         [[body]]\nname = \"arm\"\nmass = 1\ninertia = [0.1, 0.2, 0.15]\n\
         [[joint]]\nname = \"cross\"\nkind = \"universal\"\nsecond_angle = 0.4\n\
         first = { body = \"base\", axis = [1, \"p\", 0], zero = [0, 1, 0] }\n\
         second = { body = \"arm\", axis = [1, \"p\", 0], zero = [0, 1, 0] }\n";
    let page = generate_text("cross.toml", page);
    let report = verify(&page.model, &page.code, &page.constants, Depth::Quick);
    assert!(report.is_proved(), "{report}");
}

/// A body that is turned by two angles, polynomials of time, and an arm on it.
fn turned_twice([first, second]: [&str; 2]) -> Report {
    let page = format!(
        "format = 1\nname = \"turned\"\n[[body]]\nname = \"base\"\n\
         driven = {{ translation = [0, 0, 0], rotations = [{{ axis = [0, 0, 1], angle = {{ polynomial = {first} }} }}, \
         {{ axis = [0, 1, 0], angle = {{ polynomial = {second} }} }}] }}\n\
         [[body]]\nname = \"arm\"\nmass = 1\ninertia = [0.1, 0.2, 0.15]\n\
         [[joint]]\nname = \"hinge\"\nkind = \"revolute\"\naxis = [1, 1, 1]\nzero = [1, 2, 2]\n\
         first = {{ body = \"base\" }}\nsecond = {{ body = \"arm\", point = [0, 0.2, 0] }}\n"
    );
    let page = generate_text("turned.toml", &page);
    verify(&page.model, &page.code, &page.constants, Depth::Quick)
}

/// An angle and its double drive a body: their halves, and they, are of one family. So are angles that are farther from
/// each other.
#[test]
fn angles_and_their_doubles_are_of_one_family() {
    let once = "[0.05, 1]";
    for other in ["[0.1, 2]", "[0.8, 16]", "[3.2, 64]"] {
        for angles in [[once, other], [other, once]] {
            let report = turned_twice(angles);
            assert!(report.is_proved(), "{angles:?}: {report}");
        }
    }
}

/// Sine and cosine of 64 times an angle are polynomials of 64 times the degree in those of the angle.
#[test]
fn degrees_count_multiples_of_angles() {
    let largest_degree = |second| {
        let degree = |finding: &Finding| match finding.verdict {
            Verdict::Proved { degree_log2, .. } => degree_log2,
            _ => f64::INFINITY,
        };
        turned_twice(["[0.05, 1]", second]).findings.iter().map(degree).fold(0.0, f64::max)
    };
    let (apart, of_one_family) = (largest_degree("[0.07, 65]"), largest_degree("[3.2, 64]"));
    assert!((of_one_family - apart - 6.0).abs() < 0.1, "2^{of_one_family} and 2^{apart}");
}

/// The depth of a stop is a small difference: its square, written out as a polynomial, has no digits left.
#[test]
fn hard_stops_keep_their_digits() {
    let page = "format = 1\nname = \"door\"\n[[body]]\nname = \"frame\"\nfixed = true\n\
         [[body]]\nname = \"leaf\"\nmass = 0.5\ninertia = [0.25, 0.25, 0.25]\n\
         [[joint]]\nname = \"hinge\"\nkind = \"revolute\"\naxis = [2.26, 0.51, 1.09]\nzero = [0, 1, 0]\n\
         first = { body = \"frame\" }\nsecond = { body = \"leaf\", point = [0, 1.9, -0.5] }\n\
         [[force]]\nname = \"end\"\nkind = \"stop\"\njoint = \"hinge\"\nside = \"upper\"\n\
         limit = 1.5707963267948966\nstiffness = 1.5\nsoftness = 1e-9\ndamping = 0.7\n";
    let page = generate_text("door.toml", page);
    let report = verify(&page.model, &page.code, &page.constants, Depth::Quick);
    assert!(report.is_proved(), "{report}");
}

/// Where the textbook divides by zero but for rounding, a module may divide by zero itself.
#[test]
fn zero_but_for_rounding_is_zero() {
    let page = "format = 1\nname = \"table\"\n[[body]]\nname = \"base\"\nfixed = true\norientation = [1, 1, 0, 0]\n\
         [[body]]\nname = \"plate\"\nmass = 1\ninertia = [0.1, 0.2, 0.15]\n\
         [[joint]]\nname = \"top\"\nkind = \"planar\"\n\
         first = { body = \"base\", axis = [0, 0, -1], zero = [0.6, 0, 0.8] }\n\
         second = { body = \"plate\", axis = [0, 0, -1], zero = [0, 1, 0] }\n\
         [[driver]]\nname = \"turn\"\njoint = \"top\"\ncoordinate = \"angle\"\nmotion = { polynomial = [0, -1, 0.5] }\n";
    let page = generate_text("table.toml", page);
    let report = verify(&page.model, &page.code, &page.constants, Depth::Quick);
    assert!(report.is_proved(), "{report}");
}

/// A body turned by half a turn away from its joint may have its axis at right angles to the joint's: solves of trees
/// divide by zero there, and may.
#[test]
fn solves_may_need_joints_that_are_whole() {
    let page = "format = 1\nname = \"arm\"\n[[body]]\nname = \"base\"\nfixed = \"constrained\"\nmass = 1\ninertia = [0.1, 0.2, 0.1]\n\
         [[body]]\nname = \"arm\"\nmass = 1\ninertia = [0.1, 0.2, 0.15]\n\
         [[joint]]\nname = \"hinge\"\nkind = \"revolute\"\nangle = -0.5\n\
         first = { body = \"arm\", point = [0, 0.45, 0], axis = [1, 1, 0], zero = [0, 0, -1] }\n\
         second = { body = \"base\", point = [0, 0, -0.05], axis = [1, 0, 0], zero = [1, 1, 0] }\n";
    // With its reaction, and with the power of what drives its base, they are in other functions too.
    let driven = page.replace(
        "fixed = \"constrained\"\nmass = 1\ninertia = [0.1, 0.2, 0.1]",
        "driven = { translation = [0, 0, { polynomial = [0, 1] }], rotations = [] }",
    ) + "[[output]]\nname = \"r\"\nkind = \"reaction\"\njoint = \"hinge\"\n";
    // The multipliers of a joint that is driven are solved for as the accelerations are.
    let turned = r#"format = 1
name = "wheel"
gravity = [0, 0, 0]

[parameters]
p0 = 1.38e-1
p1 = 0.2857142857142857
p2 = 2.333333333333333481

[inputs]
in0 = 0.25
in1 = -1.2062119

[[body]]
name = "b0"
fixed = true
orientation = [1, 1, 0, 0]

[[body]]
name = "b1"
mass = 1.4689047243365352
inertia = ["p0", 1.38e-1, 1.54e-2]

[[body]]
name = "b2"
mass = 1e0
inertia = [9.936243965e-1, 9.936243965e-1, 9.936243965e-1]

[[joint]]
name = "j0"
kind = "revolute"
first = { body = "b0", point = ["p1", 0.16666666666666666, 0], axis = [1, 0, 0], zero = [3, 4, 4] }
second = { body = "b1", point = [0, 2.50, 0], axis = [1, 0, 0], zero = [3, 4, 4] }

[[joint]]
name = "j1"
kind = "fixed"
first = { body = "b0", point = [-0.75, 0.3, -0.1000000000000000055511151231257827], axis = [1, 0, 0], zero = [0, 1, 0] }
second = { body = "b2", point = [0, 0, 0], axis = [1, 0, 0], zero = [0, 1, 0] }

[[driver]]
name = "d0"
joint = "j0"
motion = { product = [{ sinusoid = { amplitude = -0.25, angular_frequency = 5e-1, phase_deg = 83.06864099091769 } }, -0.6836524] }

[[force]]
name = "f0"
kind = "load"
body = "b1"
force = [-1.00000000000000000001, "in0", "in0"]
torque = ["-p2", -0.4754124, "in1"]

[[force]]
name = "f1"
kind = "motor"
joint = "j0"
value = 0.333333333333333
"#;
    for page in [page, &driven, turned] {
        let model = gyro_model::read("arm.toml", page).unwrap_or_else(|problems| panic!("{problems}"));
        let module = gyro_codegen::generate_functions("arm.toml", &model, &gyro_codegen::Functions::all())
            .expect("a module");
        let report = verify(&model, &module.code, &module.constants, Depth::Quick);
        assert!(report.is_proved(), "{report}");
    }
}

/// Roots of parameters, a dozen of them: points that have them all are found joint by joint.
#[test]
fn roots_of_parameters_are_never_too_many() {
    let model = free_frames(2);
    let module = gyro_codegen::generate_functions("frames.toml", &model, &gyro_codegen::Functions::all())
        .expect("a module");
    let mut module = Module::read(&model, &module.code, &module.constants).expect("the emitted subset");
    let prime: Prime<9> = prime(&model, &module, 1).expect("room for all roots");
    let decider = Decider::new(&model, prime);
    let decide = |module: &Module| decider.decide(module, Claim(Kernel::ToMaximal), 1, 1);
    assert!(matches!(decide(&module), Verdict::Proved { .. }));
    module.programs.get_mut("to_maximal").expect("a function").results.swap(3, 4);
    assert!(matches!(decide(&module), Verdict::Refuted { .. }));
}

/// A binding that nobody uses is no reason to refuse a module.
#[test]
fn a_flaw_is_neither_proved_nor_refuted() {
    let page = crate::support::page("pendulum");
    let (head, functions) = page.code.split_once("fn derivative").expect("functions after the start");
    let unused = functions.replacen("let k = T::constant;", "let k = T::constant; let unused = k(0.5);", 1);
    let flawed = format!("{head}fn derivative{unused}");
    let report = verify(&page.model, &flawed, &page.constants, Depth::Quick);
    assert!(!report.is_proved() && !report.is_refuted() && !report.flaws.is_empty(), "{report}");
    let wrong = page.code.replacen(" - ", " + ", 1);
    assert!(verify(&page.model, &wrong, &page.constants, Depth::Quick).is_refuted());
}

/// The section for the data sheet names every function that was proved, and what was not.
#[test]
fn the_data_sheet_says_what_was_proved() {
    let page = crate::support::page("pendulum");
    let report = verify(&page.model, &page.code, &page.constants, Depth::Quick);
    let sheet = report.section().join("\n");
    let module = Module::read(&page.model, &page.code, &page.constants).expect("the emitted subset");
    for claim in Claim::all(&module) {
        assert!(claim.functions().iter().all(|function| sheet.contains(function)), "{claim:?}: {sheet}");
    }
    assert!(!sheet.contains("pivoting"), "{sheet}");
    let wrong = page.code.replacen("kinetic:", "potential:", 1);
    assert!(
        !verify(&page.model, &wrong, &page.constants, Depth::Quick).section().join("\n").contains("energy")
    );
    // Stops on all joints: that of the cut one is seen by outputs.
    let linkage = include_str!("../../../models/four-bar-revolute.toml");
    let joints = ["crank_pivot", "rocker_pivot", "elbow", "knee"];
    let stop = "lower = -9\nupper = 9\nrestitution = 0\n";
    let stops = joints.map(|on| format!("[[contact]]\nname = \"{on}_stop\"\njoint = \"{on}\"\n{stop}"));
    let page = generate_text("stopped.toml", &format!("{linkage}\n{}", stops.concat()));
    let report = verify(&page.model, &page.code, &page.constants, Depth::Quick);
    assert!(
        report.is_proved() && page.model.contacts.iter().any(|contact| contact.seen.is_some()),
        "{report}"
    );
}

/// The program with both arguments of each angle negated: half a turn away.
fn turned(program: &Program) -> Program {
    let (mut turned, mut places) =
        (Program { places: program.places.clone(), ..Program::default() }, Vec::new());
    for (node, &line) in program.nodes.iter().zip(&program.lines) {
        let node = node.with_operands(|id| places[id]);
        let node = match node {
            Node::Call(function, operands) if function.arity() == 2 => {
                Node::Call(function, operands.map(|id| turned.push(Node::Neg(id), line)))
            }
            node => node,
        };
        places.push(turned.push(node, line));
    }
    turned.results = program.results.iter().map(|&id| places[id]).collect();
    turned
}

/// Half a turn changes neither an angle's derivative nor, modulo a prime, that it is the angle of a point on a line.
#[test]
fn half_a_turn_is_refuted() {
    let page = crate::support::page("torsion");
    let mut module = Module::read(&page.model, &page.code, &page.constants).expect("the emitted subset");
    let prime: Prime<9> = prime(&page.model, &module, 1).expect("room for all roots");
    let decider = Decider::new(&page.model, prime);
    assert!(matches!(decider.decide(&module, Claim(Kernel::ToJoints), 1, 1), Verdict::Proved { .. }));
    let program = module.programs.get_mut("to_joints").expect("a tree has joint coordinates");
    *program = turned(program);
    assert!(matches!(decider.decide(&module, Claim(Kernel::ToJoints), 1, 1), Verdict::Refuted { .. }));
}

/// A start in joint coordinates that is not the assembled one is a mistake.
#[test]
fn a_wrong_start_in_joint_coordinates_is_refuted() {
    let page = crate::support::page("torsion");
    let (head, joints) = page.code.split_once("fn joint_start").expect("a tree has joint coordinates");
    let (_, rest) = joints.split_once("k(").expect("a number");
    let (number, _) = rest.split_once(')').expect("its end");
    let number: f64 = number.parse().expect("a number");
    for other in [number + 1e-9, number + std::f64::consts::TAU] {
        let wrong = joints.replacen(&format!("k({number:?})"), &format!("k({other:?})"), 1);
        let report =
            verify(&page.model, &format!("{head}fn joint_start{wrong}"), &page.constants, Depth::Quick);
        assert!(report.is_refuted() && report.problems.len() == 1, "{report}");
    }
}

/// What a start violates is judged by what its rows subtract: an angle of a million turns is known to 1e-9.
#[test]
fn a_start_after_many_turns_is_proved() {
    let gears = |angle: f64| {
        format!(
            "format = 1\nname = \"gears\"\n[[body]]\nname = \"ground\"\nfixed = true\n\
             [[body]]\nname = \"one\"\nmass = 1\ninertia = [0.1, 0.1, 0.1]\n\
             [[body]]\nname = \"other\"\nmass = 1\ninertia = [0.1, 0.1, 0.1]\n\
             [[joint]]\nname = \"a\"\nkind = \"revolute\"\naxis = [0, 0, 1]\nzero = [1, 0, 0]\n\
             first = {{ body = \"ground\" }}\nsecond = {{ body = \"one\" }}\nangle = {angle:.4}\n\
             [[joint]]\nname = \"b\"\nkind = \"revolute\"\naxis = [0, 0, 1]\nzero = [1, 0, 0]\n\
             first = {{ body = \"ground\", point = [1000, 0, 0] }}\nsecond = {{ body = \"other\" }}\n\
             [[coupler]]\nname = \"teeth\"\nfirst = {{ joint = \"a\" }}\nsecond = {{ joint = \"b\" }}\nratio = -1.7\n"
        )
    };
    for angle in [0.1, 62_831.9, 7_654_321.125] {
        let page = generate_text("gears.toml", &gears(angle));
        let report = verify(&page.model, &page.code, &page.constants, Depth::Quick);
        assert!(report.is_proved(), "from {angle} rad: {report}");
    }
}
