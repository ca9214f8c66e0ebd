//! What the graph simplifies, and what it keeps.

use super::*;
use crate::expr::evaluate::{evaluate, sample};

fn symbols(graph: &mut Graph) -> [ExprId; 3] {
    [0, 1, 2].map(|k| graph.symbol(Symbol::Position { moving_body: 0, k }))
}

#[test]
fn equal_expressions_are_one_node() {
    let mut g = Graph::new();
    let [x, y, z] = symbols(&mut g);
    assert_eq!(g.add(x, y), g.add(y, x));
    assert_eq!(g.mul(x, y), g.mul(y, x));
    let (difference, opposite) = (g.sub(x, y), g.sub(y, x));
    assert_eq!(g.neg(difference), opposite);
    let (product, minus_x) = (g.mul(difference, z), g.neg(x));
    let other = g.mul(z, opposite);
    assert_eq!(g.add(product, other), Graph::ZERO);
    assert_eq!(g.add(x, minus_x), Graph::ZERO);
}

#[test]
fn constants_fold_exactly() {
    let mut g = Graph::new();
    let [x, y, _] = symbols(&mut g);
    let (tenth, fifth, three_tenths) = (g.fraction(1, 10), g.fraction(1, 5), g.fraction(3, 10));
    assert_eq!(g.add(tenth, fifth), three_tenths);
    let (a, b) = (g.mul(tenth, x), g.mul(fifth, x));
    assert_eq!(g.add(a, b), g.mul(three_tenths, x));
    let (two, root) = (g.integer(2), g.sqrt(fifth));
    let square = g.mul(root, root);
    assert_eq!(square, fifth);
    let (ax, ay) = (g.mul(two, x), g.mul(two, y));
    let (sum, x_plus_y) = (g.add(ax, ay), g.add(x, y));
    assert_eq!(sum, g.mul(two, x_plus_y));
}

#[test]
fn a_reciprocal_undoes_a_product() {
    let mut g = Graph::new();
    let [x, _, _] = symbols(&mut g);
    let inverse = g.recip(x);
    assert_eq!(g.mul(x, inverse), Graph::ONE);
    assert_eq!(g.recip(inverse), x);
    let minus_two = g.integer(-2);
    let scaled = g.mul(minus_two, x);
    assert_eq!(g.div(scaled, x), minus_two);
    // The reciprocal of zero stays what it is: nothing is decided about it here.
    let undefined = g.recip(Graph::ZERO);
    assert!(matches!(g.node(undefined), Node::Recip(_)));
}

/// Builds random sums, differences and products and compares each with the same arithmetic on numbers.
#[test]
fn simplification_keeps_values() {
    for seed in 0..200u64 {
        let (mut g, value) = (Graph::new(), sample(seed));
        let mut pool: Vec<(ExprId, f64)> =
            symbols(&mut g).map(|x| (x, evaluate(&g, &[x], &value)[0])).to_vec();
        pool.extend([-2, -1, 0, 1, 2].map(|n| (g.integer(n), f64::from(i32::try_from(n).expect("small")))));
        let mut state = seed;
        let mut next = |n: usize| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            usize::try_from(state >> 33).expect("31 bits") % n
        };
        for _ in 0..40 {
            let ((a, va), (b, vb)) = (pool[next(pool.len())], pool[next(pool.len())]);
            let built = match next(4) {
                0 => (g.add(a, b), va + vb),
                1 => (g.sub(a, b), va - vb),
                2 => (g.neg(a), -va),
                _ => (g.mul(a, b), va * vb),
            };
            pool.push(built);
        }
        for (expression, expected) in pool {
            let value = evaluate(&g, &[expression], &value)[0];
            assert!(
                (value - expected).abs() <= 1e-9 * expected.abs().max(1.0),
                "seed {seed}: {value} {expected}"
            );
        }
    }
}

#[test]
fn functions_of_rationals_are_known_where_they_are_exact() {
    let mut g = Graph::new();
    let [x, y, _] = symbols(&mut g);
    let [above, below, two] = [g.fraction(7, 2), g.fraction(-7, 2), g.integer(2)];
    assert_eq!([g.abs(above), g.abs(below), g.abs(Graph::ZERO)], [above, above, Graph::ZERO]);
    let [three, minus_four] = [g.integer(3), g.integer(-4)];
    assert_eq!([g.floor(above), g.floor(below), g.floor(two)], [three, minus_four, two]);
    assert_eq!([g.when(two, x), g.when(Graph::ZERO, x), g.when(below, x)], [x, Graph::ZERO, Graph::ZERO]);
    assert_eq!([g.unless(two, x), g.unless(Graph::ZERO, x), g.unless(below, x)], [Graph::ZERO, x, x]);
    assert_eq!([g.when(x, Graph::ZERO), g.unless(x, Graph::ZERO)], [Graph::ZERO; 2]);
    assert_eq!([g.exp(Graph::ZERO), g.abs(Graph::ZERO)], [Graph::ONE, Graph::ZERO]);
    // An even function takes a sign away; a condition keeps it.
    let minus_x = g.neg(x);
    assert_eq!(g.abs(minus_x), g.abs(x));
    assert_ne!(g.when(minus_x, y), g.when(x, y));
    // Which side of zero a root is on is known, but nobody who checks it knows it.
    let root = g.sqrt(two);
    let (size, logarithm) = (g.abs(root), g.ln(two));
    assert!(matches!(g.node(size), Node::Call(Function::Abs, _)));
    assert!(matches!(g.node(logarithm), Node::Call(Function::Ln, _)));
}
