//! Products of a constant and two numbers, `k (x y)` and `k (x z)`, share a factor as `(k x) y` and `(k x) z`.

use crate::expr::by_expr::ByExpr;
use crate::expr::graph::{ExprId, Graph, Node};
use crate::expr::schedule::{Operations, Uses};
use rustc_hash::FxHashMap as HashMap;
use std::collections::BTreeMap;

/// The roots, or what is shorter.
pub fn reassociated(graph: &mut Graph, roots: &[ExprId]) -> Vec<ExprId> {
    let better = written(graph, roots);
    if better == roots {
        return better;
    }
    let [now, then] = [roots, &better].map(|roots| Operations::recurring(graph, roots).total());
    if then < now { better } else { roots.to_vec() }
}

fn written(graph: &mut Graph, roots: &[ExprId]) -> Vec<ExprId> {
    let uses = Uses::count(graph, roots);
    let shared = shared_factors(graph, &uses);
    if shared.is_empty() {
        return roots.to_vec();
    }
    let mut memo = ByExpr::default();
    for &id in &uses.order {
        let node = graph.node(id).with_operands(|operand| memo[operand]);
        let value = match shared.get(&id) {
            Some(&(constant, factor, other)) => {
                let scaled = graph.mul(constant, memo[factor]);
                graph.mul(scaled, memo[other])
            }
            None => graph.rebuilt(node),
        };
        memo.insert(id, value);
    }
    roots.iter().map(|root| memo[*root]).collect()
}

/// Of each product that is to be written otherwise its constant, the factor that goes with the constant, and the other.
fn shared_factors(graph: &Graph, uses: &Uses) -> HashMap<ExprId, (ExprId, ExprId, ExprId)> {
    let mut products: BTreeMap<ExprId, (ExprId, [ExprId; 2])> =
        uses.order.iter().filter_map(|&id| Some((id, parts(graph, uses, id)?))).collect();
    let mut shared = HashMap::default();
    loop {
        let mut groups: BTreeMap<(ExprId, ExprId), Vec<ExprId>> = BTreeMap::new();
        for (&id, &(constant, [x, y])) in &products {
            groups.entry((constant, x)).or_default().push(id);
            if x != y {
                groups.entry((constant, y)).or_default().push(id);
            }
        }
        // The largest group first: its members may be in smaller ones too.
        let largest = groups.into_iter().filter(|(_, ids)| ids.len() > 1).max_by_key(|(_, ids)| ids.len());
        let Some(((constant, factor), ids)) = largest else { return shared };
        for id in ids {
            if let Some((_, [x, y])) = products.remove(&id) {
                shared.insert(id, (constant, factor, if x == factor { y } else { x }));
            }
        }
    }
}

/// The constant and the factors of `k (x y)`, where nobody else uses `x y`.
fn parts(graph: &Graph, uses: &Uses, id: ExprId) -> Option<(ExprId, [ExprId; 2])> {
    let Node::Mul(constant, product) = *graph.node(id) else { return None };
    graph.as_constant(constant)?;
    match *graph.node(product) {
        Node::Mul(x, y) if uses.of(product) == 1 && graph.as_constant(x).is_none() => {
            Some((constant, [x, y]))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::symbol::Symbol;

    /// 3 x y, 3 x z and 3 y² z.
    #[test]
    fn products_with_a_constant_share_a_factor() {
        let mut graph = Graph::new();
        let [x, y, z] = [0, 1, 2].map(|k| graph.symbol(Symbol::Coordinate(k)));
        let three = graph.integer(3);
        let mut product = |a, b| {
            let product = graph.mul(a, b);
            graph.mul(three, product)
        };
        let roots = [product(x, y), product(x, z), product(y, y)];
        let better = written(&mut graph, &roots);
        assert_eq!(Operations::count(&graph, &roots).total(), 6);
        assert_eq!(Operations::count(&graph, &better).total(), 5);
        // Once a product is used elsewhere too, there is nothing to be had.
        let used = [graph.mul(x, y), roots[0], roots[1]];
        assert_eq!(written(&mut graph, &used), used);
    }
}
