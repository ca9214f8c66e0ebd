use super::*;
use crate::expr::evaluate::{evaluate, sample};
use crate::expr::symbol::Symbol;

/// A handful of operations on numbers of order one.
const ROUNDING: f64 = 1e-13;

/// (5 x² + 5 x y + 3) / (5 x² + 5 (1 + y)) takes two multiplications by 5, the same in other units none.
#[test]
fn a_common_unit_goes_out_of_sums_products_and_quotients() {
    let mut graph = Graph::new();
    let [x, y] = [0, 1].map(|k| graph.symbol(Symbol::Coordinate(k)));
    let [three, five] = [3, 5].map(|k| graph.integer(k));
    let scaled_x = graph.mul(five, x);
    let (xx, xy) = (graph.mul(scaled_x, x), graph.mul(scaled_x, y));
    let numerator = graph.add(xx, xy);
    let numerator = graph.add(numerator, three);
    let sum = graph.add(Graph::ONE, y);
    let scaled_sum = graph.mul(five, sum);
    let denominator = graph.add(xx, scaled_sum);
    let root = [graph.div(numerator, denominator)];
    let better = scaled(&mut graph, &root);
    let [before, after] = [&root[..], &better].map(|roots| Operations::count(&graph, roots).multiplications);
    assert_eq!((before, after), (4, 2));
    for seed in 0..10 {
        let [a, b] = [&root[..], &better].map(|roots| evaluate(&graph, roots, sample(seed))[0]);
        assert!((a - b).abs() <= ROUNDING * a.abs().max(1.0), "{a} {b}");
    }
}
