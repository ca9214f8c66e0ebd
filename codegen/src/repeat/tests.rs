//! Loops against straight-line code, bit for bit.

use super::orbits::Orbits;
use super::shift::{OPERATIONS_A_COPY, Shift, Way};
use super::terms::Terms;
use super::{At, Direction, LEAST_PARTS, Local, Repeat, Rolled, WAYS, rolled_by};
use crate::Elimination;
use crate::equations::Argument;
use crate::expr::evaluate::{evaluate, sample};
use crate::expr::graph::{ExprId, Graph};
use crate::expr::schedule::Operations;
use crate::expr::symbol::Symbol;
use crate::groups::Functions;
use crate::kernels::Kernels;
use gyro_program::Kernel;
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
            let mut computed = evaluate(&repeat.graph, &repeat.values(), |symbol| match symbol {
                Symbol::Local(place) => local(repeat, place, part, &fixed, &arrays.borrow(), value),
                symbol => value(symbol),
            });
            for row in &repeat.rows {
                let at = if let At::Part(offset) = row.at { offset + part } else { 0 };
                let rest = computed.split_off(row.values.len());
                arrays.borrow_mut()[row.array][at] = std::mem::replace(&mut computed, rest);
            }
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
        Local::Carried { array, column } => arrays[array][0][column],
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
fn element(symbol: Symbol) -> Option<(Argument, usize)> {
    match symbol {
        Symbol::Coordinate(x) => Some((Argument::Joints, x)),
        Symbol::Rate(u) => Some((Argument::Rows, u)),
        _ => None,
    }
}

/// Both ways of all kernels that have loops agree, and take the same operations but for copies; the operations of the
/// longest texts, with and without loops.
fn check(page: &str, wanted: &[Kernel]) -> Vec<(usize, usize)> {
    let model = gyro_model::read("page.toml", page).unwrap_or_else(|error| panic!("{error}\n{page}"));
    let start = model.assemble().expect("a start");
    let mut equations =
        crate::equations(&model, (Elimination::NullSpace, &Functions::all(), crate::Effort::Full), &start);
    let mut kernels = Kernels::of(&equations);
    kernels.finish(&mut equations.graph, equations.passes);
    let graph = &equations.graph;
    let sizes = wanted.iter().map(|&kernel| {
        let roots = kernels.roots(kernel);
        let straight = Operations::count(graph, roots).total();
        let is_long = straight >= 500;
        let found =
            is_long.then(|| rolled_by(&WAYS, (straight, straight.div_ceil(2)), (graph, roots), &element));
        let Some(rolled) = found.flatten() else {
            return (straight, straight);
        };
        let more = rolled.executed().total().checked_sub(straight);
        assert!(
            more.is_some_and(|more| OPERATIONS_A_COPY * more <= straight),
            "{kernel:?}: {more:?} of {straight}"
        );
        for seed in 0..3 {
            let expected = evaluate(graph, roots, sample(seed));
            assert_eq!(run(&rolled, &sample(seed)), expected, "{kernel:?}, seed {seed}");
            #[expect(clippy::cast_possible_truncation, reason = "single precision is what is tried")]
            let single = |symbol| sample(seed)(symbol) as f32;
            let expected = evaluate(graph, roots, single);
            assert_eq!(run(&rolled, &single), expected, "{kernel:?}, seed {seed}, single precision");
        }
        let (n_executed, n_written) = (rolled.executed().total(), rolled.n_written());
        let hastened = rolled.hastened();
        assert!(hastened.executed().total() <= n_executed, "{kernel:?}");
        let expected = evaluate(graph, roots, sample(0));
        let largest = expected.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
        for (found, expected) in run(&hastened, &sample(0)).into_iter().zip(expected) {
            assert!((found - expected).abs() <= 1e-10 * largest, "{kernel:?}: {found} for {expected}");
        }
        (straight, n_written)
    });
    sizes.collect()
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

/// One link carries the next one at its centre of mass.
#[test]
fn links_on_both_sides_of_another_are_loops() {
    let page = page(24, false, None).replacen(
        "body = \"b11\", point = [0.1, 0.10, -0.2]",
        "body = \"b11\", point = [0, 0, 0]",
        1,
    );
    assert!(page.contains("[0, 0, 0]"), "{page}");
    let sizes = check(&page, &[Kernel::Accelerations, Kernel::SolveVelocities, Kernel::ToMaximal]);
    assert!(sizes.iter().all(|(straight, written)| 5 * written < 2 * straight), "{sizes:?}");
}

const PARTS: usize = 8;

/// Lengths of the orbits of parts that compute these of x and y.
fn orbits(copies: bool, part: impl Fn(&mut Graph, [ExprId; 2], usize) -> Vec<ExprId>) -> Vec<usize> {
    let mut graph = Graph::new();
    let mut roots = Vec::new();
    for k in 0..PARTS {
        let of = [Symbol::Coordinate(k), Symbol::Rate(k)].map(|symbol| graph.symbol(symbol));
        roots.extend(part(&mut graph, of, k));
    }
    // Copies are few among other operations.
    let time = graph.symbol(Symbol::Time);
    let padding = (0..1000).fold(time, |sum, _| graph.sin(sum));
    roots.push(padding);
    let way = Way { n_steps: 2, stride: 1, copies };
    let terms = &Terms::of(&graph, &roots);
    let (terms, shift) = &Shift::find(&graph, terms, way);
    Orbits::of(terms, shift, LEAST_PARTS).members.iter().map(Vec::len).filter(|&n| n <= PARTS).collect()
}

#[test]
fn squares_are_alike() {
    let squares = orbits(false, |graph, [x, y], _| {
        let squares = [x, y].map(|of| graph.mul(of, of));
        vec![graph.add(squares[0], squares[1])]
    });
    assert_eq!(squares, [PARTS; 3]);
}

#[test]
fn what_is_alike_corresponds_in_order() {
    let sums = orbits(false, |graph, [x, y], _| {
        let one = graph.sin(x);
        let products = [2, 3].map(|factor| {
            let factor = graph.integer(factor);
            graph.mul(factor, one)
        });
        products.into_iter().map(|product| graph.mul(product, y)).collect()
    });
    assert_eq!(sums, [PARTS; 5]);
}

#[test]
fn what_serves_two_terms_in_one_part_alone_is_copied() {
    let shared = |copies| {
        orbits(copies, |graph, [x, y], k| {
            // So far away that the variables look alike.
            let far = (0..3).fold(x, |x, _| graph.sin(x));
            let factors = [graph.integer(3), graph.integer(if k == 4 { 3 } else { 5 })];
            let [one, other] = factors.map(|factor| graph.mul(factor, far));
            let (sine, tangent) = (graph.sin(one), graph.tanh(other));
            vec![graph.mul(sine, y), graph.add(tangent, y)]
        })
    };
    assert_eq!(shared(true), [PARTS; 9]);
    assert_ne!(shared(false), [PARTS; 9]);
}
