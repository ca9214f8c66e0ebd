use super::*;

fn mistake(span: Range<usize>) -> Diagnostic {
    let words = |text: &str| text.to_owned();
    Diagnostic { span, message: words("m"), label: words("l"), help: words("h"), related: Vec::new() }
}

#[test]
fn of_many_mistakes_the_first_are_shown_and_the_rest_is_counted() {
    let text = "x\n".repeat(100);
    let mistakes = |n: usize| (0..n).map(|k| mistake(2 * k..2 * k + 1)).collect();
    let shown = |n: usize| Diagnostics::new("p.toml", &text, mistakes(n)).render();
    assert!(!shown(30).contains("more") && shown(30).contains("p.toml:30:1"));
    assert!(shown(31).ends_with("and 1 more mistake\n"));
    assert!(shown(99).ends_with("and 69 more mistakes\n") && !shown(99).contains("p.toml:31:1"));
}

#[test]
fn control_characters_do_not_reach_the_terminal() {
    let mut red = mistake(9..10);
    red.message = "`\u{1b}[31m\u{7}` is no name".to_owned();
    let shown = Diagnostics::new("p.toml", "a\tb\r\nc \u{1b}[31m\0\n", vec![red]).render();
    assert!(!shown.contains(['\u{1b}', '\u{7}', '\0']), "{shown:?}");
    assert!(shown.contains("`\\u{1b}[31m\\u{7}` is no name") && shown.contains("c ?[31m?"), "{shown:?}");
}

#[test]
fn of_a_long_line_the_part_around_the_place_is_shown() {
    let text = format!("a\n{}here{}\nb\n", "é".repeat(100_000), "ü".repeat(100_000));
    let at = text.find("here").expect("it is there");
    let mut far = mistake(at..at + 4);
    far.related = vec![Related { span: 5..9, label: "far".to_owned() }];
    far.help = "x".repeat(100_000);
    let shown = Diagnostics::new("p.toml", &text, vec![far]).render();
    assert!(shown.contains("p.toml:2:100001") && shown.contains("ééhereüü"), "{shown}");
    assert!(shown.contains("^^^^ l") && !shown.contains("far"), "{shown}");
    assert!(shown.len() < 3000, "{}", shown.len());
}

#[test]
fn places_at_the_ends_of_long_lines_are_shown() {
    let text = "z".repeat(10_000);
    for (span, column) in [(0..0, 1), (0..10_000, 1), (9_999..10_000, 10_000), (10_000..10_000, 10_001)] {
        let shown = Diagnostics::new("p.toml", &text, vec![mistake(span)]).render();
        assert!(shown.contains(&format!("p.toml:1:{column}\n")) && shown.len() < 1000, "{shown}");
    }
}
