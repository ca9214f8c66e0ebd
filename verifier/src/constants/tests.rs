use super::*;

#[test]
fn good_lines_are_read() {
    let text = "0.1 = 1/10\n-0.7071067811865476 = -1/2*sqrt(2)\n0.5 = 1/2\n0.0 = 0\n1.0 = 1\n";
    let constants = Constants::read(text).expect("good lines");
    let all = ["0.1", "-0.7071067811865476", "0.5", "0.0", "0.1", "1.0"];
    assert_eq!(constants.places(&one_a_line(&all)), Ok(vec![0, 1, 2, 3, 0, 4]));
    assert_eq!(constants.values[1].radicand, Some(Rational::from_integer(2.into())));
}

fn one_a_line(literals: &[&str]) -> Vec<Occurrence> {
    let lines = literals.iter().enumerate();
    let at = |line| LineColumn { line, column: 0 };
    lines.map(|(line, literal)| Occurrence { literal: (*literal).to_owned(), at: at(line) }).collect()
}

/// Two numbers that round to one tenth.
const TENTHS: &str = "0.1 = 1/10, 100000000000000000001/1000000000000000000000";

#[test]
fn occurrences_of_a_literal_stand_for_what_the_order_of_the_text_says() {
    let constants = Constants::read(&format!("0.5 = 1/2\n{TENTHS} as 2 1*2 2\n")).expect("good lines");
    let mut text = one_a_line(&["0.1", "0.1", "0.5", "0.1", "0.1"]);
    assert_eq!(constants.places(&text), Ok(vec![2, 1, 0, 1, 2]));
    // Functions are not read in the order of the text.
    text.reverse();
    assert_eq!(constants.places(&text), Ok(vec![2, 1, 0, 1, 2]));
    text.swap(0, 1);
    assert_eq!(constants.places(&text), Ok(vec![1, 2, 0, 1, 2]));
}

#[test]
fn occurrences_are_all_there_and_no_more() {
    let constants = Constants::read(&format!("0.5 = 1/2\n{TENTHS} as 1 2\n")).expect("good lines");
    for (literals, line, word) in [
        (&["0.5", "0.1"][..], 2, "occurs 1 times, and 2 "),
        (&["0.5", "0.1", "0.1", "0.1"], 2, "occurs 3 times, and 2 "),
        (&["0.1", "0.1"], 1, "does not occur"),
        (&["0.5"], 2, "does not occur"),
        (&["0.5", "0.1", "0.1", "0.2"], 3, "no exact constant"),
    ] {
        let refusal = constants.places(&one_a_line(literals)).expect_err(word);
        assert!(refusal.message.contains(word) && refusal.line == line, "{refusal}");
    }
    let endless = Constants::read(&format!("{TENTHS} as 1 2*{} 1*{}\n", usize::MAX, usize::MAX));
    assert!(endless.expect("good lines").places(&one_a_line(&["0.1"])).is_err());
}

#[test]
fn bad_lines_are_refused() {
    for (text, word) in [
        ("0.1 = 1/10\n0.1 = 1/10\n", "second"),
        ("0.1 = 9999999999999999/100000000000000000\n", "round"),
        ("0.7071067811865475 = 1/2*sqrt(2)\n", "round"),
        ("0.7071067811865476 = -1/2*sqrt(2)\n", "round"),
        ("0.10 = 1/10\n", "not"),
        ("0.1 = 1/0\n", "not"),
        ("0.1 = 0.1\n", "not"),
        ("0.1 = +1/10\n", "not"),
        ("1.0 = 1*sqrt(-1)\n", "not"),
        ("0.1: 1/10\n", "not"),
        ("0.1 = 1/10 as 1\n", "not"),
        (TENTHS, "not"),
        (&format!("{TENTHS} as 1 0\n"), "not"),
        (&format!("{TENTHS} as 1 02\n"), "not"),
        (&format!("{TENTHS} as 1 2*0\n"), "not"),
        (&format!("{TENTHS} as 1,2\n"), "not"),
        (&format!("{TENTHS} as 1 1 2\n"), "must"),
        (&format!("{TENTHS} as 1 2 3\n"), "must"),
        (&format!("{TENTHS} as 2*2\n"), "must"),
        (&format!("{TENTHS}, 1/11 as 1 2 3\n"), "round"),
        ("0.1 = 1/10, 1/10 as 1 2\n", "must"),
    ] {
        let refusal = Constants::read(text).expect_err(text);
        assert!(refusal.message.contains(word), "{refusal}");
    }
}

/// Half an ulp above one is a tie, which goes to the even one; a hair more does not.
#[test]
fn ties_go_to_even() {
    let half_ulp = "9007199254740993/9007199254740992";
    assert!(Constants::read(&format!("1.0 = {half_ulp}\n")).is_ok());
    assert!(Constants::read(&format!("1.0000000000000002 = {half_ulp}\n")).is_err());
    assert!(Constants::read("1.0 = 9007199254740993000001/9007199254740992000000\n").is_err());
}
