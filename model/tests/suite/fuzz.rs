//! No text makes the reader panic, and what it accepts has a finite start.

use gyro_model::{ForceKind, JointCoordinate, Model, OutputKind, Rational, RowOwner, read, read_with};
use proptest::prelude::*;
use proptest::sample::Index;

/// Words that model files are made of, and numbers at the ends of what can be read.
const TOKENS: [&str; 110] = [
    "format",
    "name",
    "gravity",
    "body",
    "joint",
    "parameters",
    "simulation",
    "mass",
    "inertia",
    "fixed",
    "free",
    "position",
    "orientation",
    "velocity",
    "angular_velocity",
    "kind",
    "first",
    "second",
    "point",
    "axis",
    "zero",
    "damping",
    "angle",
    "angle_deg",
    "rate",
    "xx",
    "yy",
    "zz",
    "xy",
    "t_end",
    "step",
    "inputs",
    "coupler",
    "driver",
    "force",
    "output",
    "driven",
    "translation",
    "rotations",
    "assembly_weight",
    "motion",
    "polynomial",
    "sinusoid",
    "sum",
    "product",
    "table",
    "columns",
    "amplitude",
    "frequency_hz",
    "ratio",
    "coordinate",
    "lead",
    "pitch",
    "length",
    "rough",
    "displacement",
    "stiffness",
    "damping",
    "softness",
    "limit",
    "value",
    "level",
    "\"universal\"",
    "\"screw\"",
    "\"planar\"",
    "\"rod\"",
    "\"point_on_line\"",
    "\"spring\"",
    "\"stop\"",
    "\"link\"",
    "\"motor\"",
    "\"30 deg\"",
    "\"table.csv\"",
    "\"revolute\"",
    "\"spherical\"",
    "\"fixed\"",
    "\"constrained\"",
    "\"base\"",
    "\"rotor\"",
    "\"-rotor_mass\"",
    "true",
    "false",
    "nan",
    "-inf",
    "0",
    "-0.0",
    "1",
    "-2.5e-7",
    "1e-9223372036854775808",
    "1e99999999999999999999",
    "1e100",
    "0x7fffffffffffffff",
    "9999999999999999999999999",
    "1_000",
    "1979-05-27",
    "[",
    "]",
    "[[",
    "]]",
    "{",
    "}",
    "=",
    ",",
    ".",
    "\n",
    "\"",
    "\"\"\"",
    "#",
    "é",
    "\u{feff}",
];

/// One change to a text.
#[derive(Clone, Debug)]
enum Edit {
    FlipBit(Index, u8),
    Delete(Index, usize),
    SwapLines(Index, Index),
    DropLine(Index),
    Insert(Index, &'static str),
    Replace(Index, &'static str),
}

/// What expressions are made of.
const PARTS: [&str; 24] = [
    "1", "0.5", "2e3", "1e99", "1e-99", "m", "n", "d", "pi", "+", "-", "*", "/", "^", "^2", "^99", "^-3",
    "(", ")", "sqrt(", " deg", " rpm", " ", "é",
];

fn edit() -> impl Strategy<Value = Edit> {
    let token = || prop::sample::select(TOKENS.to_vec());
    prop_oneof![
        (any::<Index>(), 0..8_u8).prop_map(|(at, bit)| Edit::FlipBit(at, bit)),
        (any::<Index>(), 1..40_usize).prop_map(|(at, length)| Edit::Delete(at, length)),
        (any::<Index>(), any::<Index>()).prop_map(|(a, b)| Edit::SwapLines(a, b)),
        any::<Index>().prop_map(Edit::DropLine),
        (any::<Index>(), token()).prop_map(|(at, token)| Edit::Insert(at, token)),
        (any::<Index>(), token()).prop_map(|(at, token)| Edit::Replace(at, token)),
    ]
}

impl Edit {
    fn apply(&self, text: &str) -> String {
        let mut bytes = text.as_bytes().to_vec();
        let mut lines: Vec<&str> = text.lines().collect();
        match self {
            Self::FlipBit(at, bit) => {
                let at = at.index(bytes.len().max(1));
                bytes.iter_mut().skip(at).take(1).for_each(|b| *b ^= 1 << bit);
            }
            Self::Delete(at, length) => {
                let at = at.index(bytes.len().max(1));
                bytes = bytes.iter().take(at).chain(bytes.iter().skip(at + length)).copied().collect();
            }
            Self::SwapLines(a, b) if !lines.is_empty() => {
                let n = lines.len();
                lines.swap(a.index(n), b.index(n));
                return lines.join("\n");
            }
            Self::DropLine(at) if !lines.is_empty() => {
                lines.remove(at.index(lines.len()));
                return lines.join("\n");
            }
            Self::Insert(at, token) => {
                let at = at.index(bytes.len() + 1);
                bytes.splice(at..at, token.bytes());
            }
            Self::Replace(at, token) => return replace_word(text, *at, token),
            Self::SwapLines(..) | Self::DropLine(_) => {}
        }
        String::from_utf8_lossy(&bytes).into_owned()
    }
}

/// Puts a token in place of one word or number.
fn replace_word(text: &str, at: Index, token: &str) -> String {
    let of_word = |c: char| c.is_alphanumeric() || "_.-\"".contains(c);
    let mut words: Vec<std::ops::Range<usize>> = Vec::new();
    for (at, c) in text.char_indices().filter(|(_, c)| of_word(*c)) {
        match words.last_mut().filter(|word| word.end == at) {
            Some(word) => word.end = at + c.len_utf8(),
            None => words.push(at..at + c.len_utf8()),
        }
    }
    let Some(word) = words.get(at.index(words.len().max(1))) else { return text.to_owned() };
    format!("{}{token}{}", &text[..word.start], &text[word.end..])
}

/// Reads, and uses everything that comes of it.
fn check(text: &str) {
    check_with(text, "t,x\n0,0\n1,0.5\n2,1\n");
}

/// The same with a table under every name.
fn check_with(text: &str, table: &str) {
    match read_with("fuzz.toml", text, &mut |_| Ok(table.to_owned())) {
        Ok(model) => {
            let start = model.assemble().expect("an accepted model file has a start");
            let joints = start.joints.iter().flat_map(|j| j.position.iter().chain(&j.rate));
            assert!(start.q.iter().chain(&start.v).chain(joints).all(|x| x.is_finite()), "{text}");
            assert!(model.size().is_finite() && model.size() > 0.0, "{text}");
            let simulation = [model.simulation.t_end, model.simulation.step, model.simulation.sample_every];
            assert!(simulation.iter().all(|x| x.is_finite() && *x > 0.0), "{text}");
            check_references(&model);
        }
        Err(mistakes) => {
            assert!(!mistakes.mistakes().is_empty());
            assert!(mistakes.render().contains("fuzz.toml:"));
        }
    }
}

/// What refers to joints, bodies and drivers refers to some that are there.
fn check_references(model: &Model) {
    let rows = model.rows();
    let dropped = model.redundant.iter().filter(|row| !row.stays).count();
    assert_eq!(rows.len() + dropped, model.all_rows().len());
    for index in 0..model.drivers.len() {
        assert_eq!(model.rows_of(RowOwner::Driver(index)).len(), 1, "a driver's row is never dropped");
    }
    for JointCoordinate { joint, coordinate } in model.turn_references() {
        assert!(model.joints[joint].kind.coordinates()[coordinate].is_angle());
    }
    for output in &model.outputs {
        match output.kind {
            OutputKind::Pose(ref frame)
            | OutputKind::Velocity(ref frame)
            | OutputKind::Acceleration(ref frame)
            | OutputKind::Inertial(ref frame) => assert!(frame.body < model.bodies.len()),
            OutputKind::Relative(ref relative) => {
                assert!(relative.frames.iter().all(|frame| frame.body < model.bodies.len()));
            }
            OutputKind::Reaction { joint } => assert!(joint < model.joints.len()),
            OutputKind::Driver { driver } => assert!(driver < model.drivers.len()),
            OutputKind::Coupler { coupler } => assert!(coupler < model.couplers.len()),
            OutputKind::Spring { force } | OutputKind::Link { force } | OutputKind::Bushing { force } => {
                assert!(force < model.forces.len());
            }
            OutputKind::State { state } => assert!(state < model.states.len()),
            OutputKind::Formula(_) | OutputKind::Rate(_) | OutputKind::Energy | OutputKind::Power => {}
        }
    }
    for force in &model.forces {
        match &force.kind {
            ForceKind::Link { first, second, .. } => assert!(first.0.max(second.0) < model.bodies.len()),
            ForceKind::Bushing(bushing) => {
                bushing.ends().iter().for_each(|frame| assert!(frame.body < model.bodies.len()));
            }
            ForceKind::Load { body, .. } => assert!(*body < model.bodies.len()),
            kind => {
                let slopes = kind.slopes().into_iter().flat_map(|(_, along)| along);
                let on = kind.parts().on.into_iter().map(|(on, _)| on).chain(slopes.map(|(on, _)| on));
                let mut all = on.peekable();
                assert!(all.peek().is_some(), "it acts along a coordinate");
                all.for_each(|on| assert!(on.coordinate < model.joints[on.joint].kind.coordinates().len()));
            }
        }
    }
}

proptest! {
    // Fewer of these: one in seven is good, and is assembled and searched for redundant rows.
    #![proptest_config(ProptestConfig::with_cases(150))]

    #[test]
    #[ignore = "takes long: `.ci/steps` runs it"]
    fn random_pages_are_read_or_refused(page in crate::support::random_page::page(), table in crate::support::random_page::table()) {
        check_with(&page, &table);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]

    #[test]
    #[ignore = "takes long: `.ci/steps` runs it"]
    fn edited_pages_are_read_or_refused(page in any::<Index>(), edits in prop::collection::vec(edit(), 1..6)) {
        let pages = [crate::support::pages("models"), crate::support::pages("tests/models")].concat();
        let (_, text) = page.get(&pages);
        check(&edits.iter().fold(text.clone(), |text, edit| edit.apply(&text)));
    }

    #[test]
    fn token_soup_is_refused(tokens in prop::collection::vec(prop::sample::select(TOKENS.to_vec()), 0..60), spaced: bool) {
        check(&tokens.join(if spaced { " " } else { "" }));
    }

    #[test]
    fn any_expression_is_a_number_or_refused(parts in prop::collection::vec(prop::sample::select(PARTS.to_vec()), 0..25)) {
        let expression = parts.concat();
        check(&format!(
            "format = 1\nname = \"x\"\n[parameters]\nm = 2\nn = 0\nd = {expression:?}\n[[body]]\nname = \"b\"\nfree = true\n\
             mass = {expression:?}\ninertia = [1, 1, \"d\"]\npoint_mass = [{{ mass = \"m\", at = [0, {expression:?}, 0] }}]\n"
        ));
    }

    #[test]
    fn any_text_is_refused(text in ".{0,80}") {
        check(&text);
    }

    #[test]
    #[ignore = "takes long: `.ci/steps` runs it"]
    fn parameters_of_any_value_give_a_start_or_a_message(numerator: i64, exponent in -250..250_i32, which in 0..5_usize) {
        let pages = crate::support::pages("models");
        let (_, text) = pages.iter().find(|(p, _)| p.ends_with("gyroscope-parameters.toml")).expect("a model file");
        let model = read("gyroscope-parameters.toml", text).unwrap_or_else(|mistakes| panic!("{mistakes}"));
        let power = Rational::from_integer(10.into()).pow(exponent);
        let setting = (model.parameters[which].name.clone(), Rational::from_integer(numerator.into()) * power);
        if let Ok(model) = model.with_parameters(&[setting])
            && let Ok(start) = model.assemble()
        {
            prop_assert!(start.q.iter().chain(&start.v).all(|x| x.is_finite()));
        }
    }
}

#[test]
fn texts_that_once_were_suspect_are_refused() {
    let deep = "[".repeat(100_000);
    let long = format!("format = {}", "9".repeat(1_000_000));
    let huge = "format = 1e-9223372036854775808";
    let dotted = format!("a{} = 1", ".a".repeat(20_000));
    for text in
        [deep.as_str(), &format!("x = {deep}"), &long, huge, &dotted, "\u{feff}", "\r\n\r", "\0", "é = \"é"]
    {
        check(text);
    }
}
