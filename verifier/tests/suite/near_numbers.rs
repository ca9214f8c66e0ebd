//! Numbers that round to one literal and yet are different: each occurrence of the literal stands for its own.

use crate::mutants::is_equivalent;
use crate::support::{Page, generate_text};
use gyro_verifier::{Depth, verify};

/// A model file with a wall and rods that hang on each other, each with its mass and inertia, and whatever else is
/// `more`.
fn rods(rods: &[(&str, &str)], more: &str) -> Page {
    let mut text =
        "format = 1\nname = \"near\"\ngravity = [0, -9.81, 0]\n[[body]]\nname = \"rod0\"\nfixed = true\n"
            .to_owned();
    for (k, (mass, inertia)) in rods.iter().enumerate() {
        let own = k + 1;
        text += &format!(
            "[[body]]\nname = \"rod{own}\"\nmass = {mass}\ninertia = {inertia}\n\
             [[joint]]\nname = \"hinge{own}\"\nkind = \"revolute\"\naxis = [0, 0, 1]\nzero = [1, 0, 0]\n\
             first = {{ body = \"rod{k}\", point = [{k}, 0, 0] }}\n\
             second = {{ body = \"rod{own}\", point = [-0.5, 0, 0] }}\n"
        );
    }
    generate_text("near.toml", &(text + more))
}

const ROD: (&str, &str) = ("1", "[0.001, 0.08333333333333333, 0.08333333333333333]");
const STOP: &str = "[[force]]\nname = \"end\"\nkind = \"stop\"\njoint = \"hinge1\"\nlimit = 2\nside = \"upper\"\n\
                    stiffness = 100\nsoftness = 1e-9\n";

fn pages() -> [(&'static str, Page); 3] {
    let sixth = "[0.16666666666666666, 0.16666666666666667, 0.1666666666666666667]";
    [
        ("the inertia of a rod, as programs print it", rods(&[ROD], "")),
        ("a sixth in several lengths", rods(&[("1", sixth)], "")),
        (
            "masses that are almost equal",
            rods(&[("1", "[1, 1, 1]"), ("1.00000000000000000001", "[1, 1, 1]")], ""),
        ),
    ]
}

/// Its softness is small beside its limit, and stands apart from it.
#[test]
fn a_hard_stop_is_proved() {
    let page = rods(&[("1", "[1, 1, 1]")], STOP);
    let report = verify(&page.model, &page.code, &page.constants, Depth::Quick);
    assert!(report.is_proved(), "{report}");
}

#[test]
fn numbers_that_round_to_one_literal_are_proved() {
    for (what, page) in pages() {
        let report = verify(&page.model, &page.code, &page.constants, Depth::Quick);
        println!("{what}:\n{}", shared(&page).join("\n"));
        assert!(report.is_proved(), "{what}: {report}");
        assert!(
            !shared(&page).is_empty(),
            "{what}: no literal stands for two numbers, the model file shows nothing"
        );
    }
}

/// Lines with several numbers.
fn shared(page: &Page) -> Vec<&str> {
    page.constants.lines().filter(|line| line.contains(" as ")).collect()
}

/// A line's numbers, and which of them its occurrences stand for.
fn parts(line: &str) -> (&str, Vec<usize>) {
    let (numbers, runs) = line.split_once(" as ").expect("a line with several numbers");
    let occurrences = runs.split(' ').flat_map(|run| {
        let (value, length) = run.split_once('*').unwrap_or((run, "1"));
        let [value, length] = [value, length].map(|text| text.parse().expect("a count"));
        std::iter::repeat_n(value, length)
    });
    (numbers, occurrences.collect())
}

fn line(numbers: &str, occurrences: &[usize]) -> String {
    let run = |run: &[usize]| match run.len() {
        1 => format!(" {}", run[0]),
        length => format!(" {}*{length}", run[0]),
    };
    format!("{numbers} as{}", occurrences.chunk_by(|a, b| a == b).map(run).collect::<String>())
}

/// What can be wrong with such a line, in words.
fn mistakes(numbers: &str, occurrences: &[usize]) -> Vec<(String, String)> {
    let mut mistakes = Vec::new();
    let differ = |&k: &usize| occurrences[k] != occurrences[k + 1];
    let borders: Vec<_> = (0..occurrences.len() - 1).filter(differ).collect();
    for &k in borders.iter().step_by(borders.len().div_ceil(BORDERS)) {
        let mut exchanged = occurrences.to_vec();
        exchanged.swap(k, k + 1);
        mistakes.push((format!("occurrences {k} and {} exchanged", k + 1), line(numbers, &exchanged)));
        let mut other = occurrences.to_vec();
        other[k] = occurrences[k + 1];
        mistakes.push((format!("occurrence {k} as the next"), line(numbers, &other)));
    }
    let last = occurrences[occurrences.len() - 1];
    mistakes.push(("one value too many".to_owned(), line(numbers, &[occurrences, &[last]].concat())));
    mistakes.push(("one value too few".to_owned(), line(numbers, &occurrences[1..])));
    let (literal, first) = numbers.split(", ").next().and_then(|n| n.split_once(" = ")).expect("a number");
    mistakes.push(("one number for all".to_owned(), format!("{literal} = {first}")));
    mistakes
}

/// Neighbours of a line that stand for different numbers, of which so many are exchanged.
const BORDERS: usize = 3;

/// Whoever survives computes the same: a term that is zero in the plane, say, may have any factor.
#[test]
fn no_occurrence_passes_for_another() {
    let (mut count, mut equivalent, mut survivors) = (0, Vec::new(), Vec::new());
    for (what, page) in pages() {
        for found in shared(&page) {
            let (numbers, occurrences) = parts(found);
            assert_eq!(line(numbers, &occurrences), found);
            for (mistake, wrong) in mistakes(numbers, &occurrences) {
                let constants = page.constants.replace(found, &wrong);
                count += 1;
                if verify(&page.model, &page.code, &constants, Depth::Quick).is_proved() {
                    let computes_the_same = is_equivalent(&page, [&page.code, &constants]);
                    let list = if computes_the_same { &mut equivalent } else { &mut survivors };
                    list.push(format!("{what}, {numbers}: {mistake}"));
                }
            }
        }
    }
    println!(
        "{count} lines with a mistake, of which {} compute the same:\n{}",
        equivalent.len(),
        equivalent.join("\n")
    );
    assert!(10 * equivalent.len() < count, "too many to show anything");
    assert!(survivors.is_empty(), "{} survivors:\n{}", survivors.len(), survivors.join("\n"));
}
