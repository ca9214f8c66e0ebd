use super::*;
use crate::expr::symbol::Symbol;

/// Of a few dozen operations.
const ROUNDING: f64 = 1e-14;

fn coordinates<const N: usize>(graph: &mut Graph) -> [ExprId; N] {
    std::array::from_fn(|k| graph.symbol(Symbol::Coordinate(k)))
}

/// The errors of a root at all points.
fn errors(graph: &Graph, root: ExprId) -> Vec<f64> {
    Errors::of(graph, &[&[root]])[0].0.concat()
}

fn assert_alike(found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), POINTS as usize);
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() <= ROUNDING * expected, "{found} {expected}");
    }
}

fn assert_errors<const N: usize>(graph: &Graph, root: ExprId, expected: impl Fn([f64; N]) -> f64) {
    let value = |point, k| graph.domains.value(Symbol::Coordinate(k), point);
    let expected = (0..POINTS).map(|point| expected(std::array::from_fn(|k| value(point, k))));
    assert_alike(&errors(graph, root), &expected.collect::<Vec<_>>());
}

/// (a + b) (a + c): both sums and the product are rounded.
#[test]
fn independent_roundings_add_up_by_squares() {
    let mut graph = Graph::new();
    let [a, b, c] = coordinates(&mut graph);
    let (one, other) = (graph.add(a, b), graph.add(a, c));
    let product = graph.mul(one, other);
    assert_errors(&graph, product, |[a, b, c]| 3.0_f64.sqrt() * ((a + b) * (a + c)).abs());
}

/// sin s − s with s = a b: of the rounding of s the difference has (cos s − 1) s.
#[test]
fn what_cancels_again_does_not_count() {
    let mut graph = Graph::new();
    let [a, b] = coordinates(&mut graph);
    let product = graph.mul(a, b);
    let sine = graph.sin(product);
    let difference = graph.sub(sine, product);
    assert_errors(&graph, difference, |[a, b]| {
        let s = a * b;
        let parts = [(s.cos() - 1.0) * s, s.sin(), s.sin() - s];
        parts.map(|part| part * part).iter().sum::<f64>().sqrt()
    });
}

/// A form is judged as it is, whatever was derived before it.
#[test]
fn an_error_does_not_depend_on_what_else_the_graph_has() {
    let root_beside = |n_others: usize| {
        let mut graph = Graph::new();
        let [a, b, c, d] = coordinates(&mut graph);
        for k in 0..n_others {
            let other = graph.symbol(Symbol::Rate(k));
            graph.sin(other);
        }
        let (one, other) = (graph.mul(a, b), graph.mul(c, d));
        let sum = graph.add(one, other);
        let sine = graph.sin(sum);
        let root = graph.mul(sine, one);
        errors(&graph, root)
    };
    let alone = root_beside(0);
    (1..20).for_each(|n_others| assert_alike(&root_beside(n_others), &alone));
}
