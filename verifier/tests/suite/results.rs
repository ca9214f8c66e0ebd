//! What loops hand over: to the next part in the only row of an array, to results each place its own number once, and
//! nothing is computed after them.

use crate::support::Page;
use gyro_codegen::{Functions, Group};
use gyro_verifier::{Depth, Report, verify};
use std::fmt::Write;

/// Pendulums side by side: whatever is computed of them is computed in a loop.
fn pendulums() -> Page {
    let mut text = "format = 1\nname = \"pendulums\"\n[[body]]\nname = \"base\"\nfixed = true\n".to_owned();
    for k in 0..16 {
        let _ = write!(
            text,
            "[[body]]\nname = \"b{k}\"\nmass = 1\ninertia = [3, 2, 4]\n[[joint]]\nname = \"j{k}\"\n\
             kind = \"revolute\"\naxis = [0, 0, 1]\nzero = [1, 0, 0]\nfirst = {{ body = \"base\", point = [{k}, 0, 0] }}\n\
             second = {{ body = \"b{k}\", point = [-1, 0, 0] }}\n"
        );
    }
    let name = "pendulums.toml".to_owned();
    let model = gyro_model::read(&name, &text).unwrap_or_else(|problems| panic!("{text}\n{problems}"));
    let functions = Functions::of([Group::Maximal, Group::Partition]);
    let module = gyro_codegen::generate_functions(&name, &model, &functions).expect("a module");
    Page { name, model, code: module.code, constants: module.constants }
}

/// Links one after the other: each part of a loop begins with what the part before has left.
fn chain() -> Page {
    let mut text = "format = 1\nname = \"chain\"\n[[body]]\nname = \"b0\"\nfixed = true\n".to_owned();
    for link in 1..=16 {
        let carrier = link - 1;
        let _ = write!(
            text,
            "[[body]]\nname = \"b{link}\"\nmass = 1\ninertia = [3, 2, 4]\n[[joint]]\nname = \"j{link}\"\n\
             kind = \"revolute\"\nfirst = {{ body = \"b{carrier}\", axis = [1, 2, 2], zero = [2, 1, -2], \
             point = [1, 0, 2] }}\nsecond = {{ body = \"b{link}\", axis = [2, -1, 2], zero = [2, 2, -1], \
             point = [0, 3, -1] }}\n"
        );
    }
    let name = "chain.toml".to_owned();
    let model = gyro_model::read(&name, &text).unwrap_or_else(|problems| panic!("{text}\n{problems}"));
    let module =
        gyro_codegen::generate_functions(&name, &model, &Functions::of([Group::Joint])).expect("a module");
    Page { name, model, code: module.code, constants: module.constants }
}

#[test]
fn what_a_part_leaves_to_the_next_is_what_that_reads() {
    let page = chain();
    let report = verify(&page.model, &page.code, &page.constants, Depth::Quick);
    assert!(report.is_proved(), "{report:?}");
    let only_row = page.code.find("; 1];\n").expect("an array of one row");
    let start = page.code[..only_row].rfind("let mut kept").expect("its name") + "let mut ".len();
    let name = page.code[start..].split(' ').next().expect("a name").to_owned();
    let replaced = |from: &str, to: &str| {
        let code = page.code.replacen(from, to, 1);
        assert_ne!(code, page.code, "no `{from}`");
        verify(&page.model, &code, &page.constants, Depth::Quick)
    };
    let refused = [
        // Rows that are not there, a number that is stored twice.
        (format!("            {name}[0] = ["), format!("            {name}[i] = [")),
        (format!("        {name}[0][0] = "), format!("        {name}[0][1] = ")),
        (format!("= {name}[0][1];\n"), format!("= {name}[1][1];\n")),
    ];
    for (from, to) in &refused {
        let report = replaced(from, to);
        assert!(!report.refusals.is_empty(), "`{from}` became `{to}`: {report:?}");
    }
    let (from, to) = (format!("= {name}[0][1];\n"), format!("= {name}[0][0];\n"));
    assert!(!replaced(&from, &to).is_proved(), "`{from}` became `{to}`");
}

/// What becomes of the module if the first loop that stores to `target` has these words replaced.
fn replaced(page: &Page, target: &str, from: &str, to: &str) -> Report {
    let first = page.code.find(&format!("\n            {target}[")).expect("results are stored in a loop");
    let start = page.code[..first].rfind("for i in").expect("the loop");
    let at = start + page.code[start..].find(from).unwrap_or_else(|| panic!("no `{from}`"));
    let code = format!("{}{to}{}", &page.code[..at], &page.code[at + from.len()..]);
    verify(&page.model, &code, &page.constants, Depth::Quick)
}

#[test]
fn results_of_loops_are_proved_and_nothing_else_is() {
    let page = pendulums();
    let report = verify(&page.model, &page.code, &page.constants, Depth::Quick);
    assert!(report.is_proved(), "{report:?}");
    let refused = [
        ("out", "out[5 * i + 1] =", "out[5 * i + 2] ="),
        ("out", "out[5 * i + 4] =", "out[5 * i + 5] ="),
        ("out", "for i in 0..16", "for i in 0..15"),
        ("out", "= kept0[i][1];", "= kept0[i + 1][1];"),
        ("out", "out[5 * i] =", "y[5 * i] ="),
        ("y", "= kept0[i][1];", "= y[7 * i + 2];"),
        ("y", "y[7 * i + 1] =", "y[7 * i + 2] ="),
        ("y", "y[7 * i + 1] =", "y[700 * i + 1] ="),
        ("y", "\n        }\n", "\n        }\n        let late = y[2];\n        y[0] = late;\n"),
    ];
    for (target, from, to) in refused {
        let report = replaced(&page, target, from, to);
        assert!(!report.refusals.is_empty(), "`{from}` became `{to}`: {report:?}");
    }
    let refuted = [
        ("out", "= kept0[i][1];", "= kept0[i][2];"),
        ("out", "= kept0[i][1];", "= -kept0[i][1];"),
        ("y", "= kept0[i][1];", "= kept0[i][2];"),
    ];
    for (target, from, to) in refuted {
        assert!(!replaced(&page, target, from, to).is_proved(), "`{from}` became `{to}`");
    }
}
