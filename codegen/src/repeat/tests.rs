//! Loops against straight-line code, bit for bit.

use super::{Direction, Local, Repeat, Rolled, rolled_from};
use crate::Elimination;
use crate::expr::evaluate::{evaluate, sample};
use crate::expr::graph::ExprId;
use crate::expr::schedule::Operations;
use crate::expr::symbol::Symbol;
use crate::groups::Functions;
use crate::kernels::{Kernel, Kernels};
use num_traits::Float;
use std::cell::RefCell;

/// A draw of one in so many.
fn die(seed: u64, draw: usize, sides: usize) -> usize {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a die")]
    let face = (f64::midpoint(sample(seed)(Symbol::Coordinate(draw)), 1.0) * sides as f64) as usize;
    face.min(sides - 1)
}

/// Links one after the other, or limbs of three links each on one body, with constants that are equal or made of dice.
fn page(n_links: usize, are_limbs: bool, seed: Option<u64>) -> String {
    let mut text =
        "format = 1\nname = \"links\"\ngravity = [0, 0.5, -9.81]\n[[body]]\nname = \"b0\"\nfixed = true\n"
            .to_owned();
    let number = |link: usize, k: usize| seed.map_or(10 + k, |seed| 10 + die(seed, 10 * link + k, 80));
    let sign = |link: usize, k: usize| if number(link, k).is_multiple_of(2) { "" } else { "-" };
    for link in 1..=n_links {
        let carrier = if are_limbs && link % 3 == 1 { 0 } else { link - 1 };
        let (mass, inertia) = (number(link, 0), [1, 2, 3].map(|k| 200 + number(link, k)));
        let point = [4, 5, 6].map(|k| format!("{}0.{}", sign(link, k), number(link, k)));
        let axes = ["[1, 2, 2]", "[2, -3, 6]", "[-1, 4, 8]", "[4, 4, -7]", "[2, 6, 9]"];
        let axis = |k: usize| axes[seed.map_or(k, |seed| die(seed, 10 * link + 6 + k, axes.len()))];
        let zero = |axis: &str| match axis {
            "[1, 2, 2]" => "[2, 1, -2]",
            "[2, -3, 6]" => "[3, 2, 0]",
            "[-1, 4, 8]" => "[4, 1, 0]",
            "[4, 4, -7]" => "[7, 0, 4]",
            _ => "[9, 0, -2]",
        };
        let (first, second) = (axis(0), axis(1));
        text += &format!(
            "[[body]]\nname = \"b{link}\"\nmass = 1.{mass}\ninertia = [0.{}, 0.{}, 0.{}]\n\
             [[joint]]\nname = \"j{link}\"\nkind = \"revolute\"\n\
             first = {{ body = \"b{carrier}\", point = [0.1, 0.{mass}, -0.2], axis = {first}, zero = {} }}\n\
             second = {{ body = \"b{link}\", point = [{}], axis = {second}, zero = {} }}\n",
            inertia[0],
            inertia[1],
            inertia[2],
            zero(first),
            point.join(", "),
            zero(second),
        );
    }
    text
}

/// What a kernel with loops computes, run as it is written.
fn run<F: Float>(rolled: &Rolled, value: &dyn Fn(Symbol) -> F) -> Vec<F> {
    let zeros = rolled.arrays.iter().map(|shape| vec![vec![F::nan(); shape.columns]; shape.rows]);
    let arrays: RefCell<Vec<Vec<Vec<F>>>> = RefCell::new(zeros.collect());
    let outside = |roots: &[ExprId]| {
        evaluate(&rolled.graph, roots, |symbol| match symbol {
            Symbol::Entry { array, row, column } => arrays.borrow()[array][row][column],
            symbol => value(symbol),
        })
    };
    let mut fixed = Vec::new();
    for (before, repeat) in &rolled.loops {
        fixed.extend(outside(&before.fixed));
        let stored: Vec<ExprId> = before.stores.iter().map(|store| store.1).collect();
        for (([array, row, column], _), value) in before.stores.iter().zip(outside(&stored)) {
            arrays.borrow_mut()[*array][*row][*column] = value;
        }
        let parts: Vec<usize> = match repeat.direction {
            Direction::Forward => (0..repeat.count).collect(),
            Direction::Backward => (0..repeat.count).rev().collect(),
        };
        for part in parts {
            let row = evaluate(&repeat.graph, &repeat.values, |symbol| match symbol {
                Symbol::Local(place) => local(repeat, place, part, &fixed, &arrays.borrow(), value),
                symbol => value(symbol),
            });
            arrays.borrow_mut()[repeat.array][repeat.offset + part] = row;
        }
    }
    outside(&rolled.roots)
}

fn local<F: Float>(
    repeat: &Repeat,
    place: usize,
    part: usize,
    fixed: &[F],
    arrays: &[Vec<Vec<F>>],
    value: &dyn Fn(Symbol) -> F,
) -> F {
    match repeat.locals[place] {
        Local::Factor(column) => {
            F::from(repeat.table[part][column].to_f64()).expect("constants are of order one")
        }
        Local::Row { array, offset, column } => arrays[array][part + offset][column],
        Local::Element { first, stride } => {
            let at = match first {
                Symbol::Coordinate(x) => Symbol::Coordinate(x + stride * part),
                Symbol::Rate(u) => Symbol::Rate(u + stride * part),
                other => unreachable!("{other:?} is not of an argument"),
            };
            value(at)
        }
        Local::Fixed(number) => fixed[number],
    }
}

/// The elements of the test's arguments.
fn element(symbol: Symbol) -> Option<(&'static str, usize)> {
    match symbol {
        Symbol::Coordinate(x) => Some(("x", x)),
        Symbol::Rate(u) => Some(("u", u)),
        _ => None,
    }
}

/// Both ways of all kernels that have loops agree, and take the same operations; the operations of the longest texts,
/// with and without loops.
fn check(page: &str, wanted: &[Kernel]) -> Vec<(usize, usize)> {
    let model = gyro_model::read("page.toml", page).unwrap_or_else(|error| panic!("{error}\n{page}"));
    let start = model.assemble().expect("a start");
    let mut equations = crate::equations(&model, (Elimination::NullSpace, &Functions::all()), &start);
    let mut kernels = Kernels::of(&equations);
    kernels.finish(&mut equations.graph, equations.passes);
    let graph = &equations.graph;
    let sizes = wanted.iter().map(|&kernel| {
        let roots = kernels.roots(kernel);
        let straight = Operations::count(graph, roots).total();
        let Some(rolled) = rolled_from(500, graph, roots, &element) else { return (straight, straight) };
        assert_eq!(executed(&rolled), Operations::count(graph, roots), "{kernel:?}");
        for seed in 0..3 {
            let expected = evaluate(graph, roots, sample(seed));
            assert_eq!(run(&rolled, &sample(seed)), expected, "{kernel:?}, seed {seed}");
            #[expect(clippy::cast_possible_truncation, reason = "single precision is what is tried")]
            let single = |symbol| sample(seed)(symbol) as f32;
            let expected = evaluate(graph, roots, single);
            assert_eq!(run(&rolled, &single), expected, "{kernel:?}, seed {seed}, single precision");
        }
        (straight, rolled.n_written())
    });
    sizes.collect()
}

/// Operations as they are executed.
fn executed(rolled: &Rolled) -> Operations {
    let mut sum = Operations::count(&rolled.graph, &rolled.outside_roots());
    for (_, repeat) in &rolled.loops {
        let body = Operations::count(&repeat.graph, &repeat.values);
        sum.additions += repeat.count * body.additions;
        sum.multiplications += repeat.count * body.multiplications;
        sum.divisions += repeat.count * body.divisions;
        sum.functions += repeat.count * body.functions;
    }
    sum
}

const WANTED: [Kernel; 3] = [Kernel::JointAccelerations, Kernel::Accelerations, Kernel::SolveVelocities];

#[test]
fn links_that_are_alike_are_loops() {
    let sizes = check(&page(16, false, None), &WANTED);
    assert!(2 * sizes[0].1 < sizes[0].0 && 2 * sizes[1].1 < sizes[1].0, "{sizes:?}");
}

/// Whether or not they become loops.
#[test]
fn links_with_different_constants_compute_the_same() {
    check(&page(12, false, Some(1)), &WANTED);
}

#[test]
fn limbs_that_are_alike_are_loops() {
    let sizes = check(&page(18, true, None), &WANTED);
    assert!(sizes.iter().all(|(straight, written)| 2 * written < *straight), "{sizes:?}");
}
