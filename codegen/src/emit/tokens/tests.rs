use super::*;
use crate::expr::graph::{ExprId, Graph};
use crate::tape::straight;

struct Coordinates;

impl Variables for Coordinates {
    fn variable(&self, symbol: Symbol) -> (TokenStream, Option<TokenStream>) {
        let Symbol::Coordinate(k) = symbol else { unreachable!("there are no others") };
        let name = ident(&format!("x{k}"));
        (quote! { #name }, None)
    }

    fn element(&self, _: Symbol) -> Option<(&'static str, usize)> {
        None
    }
}

fn written(build: impl FnOnce(&mut Graph, [ExprId; 2]) -> ExprId) -> String {
    let mut graph = Graph::new();
    let [x, y] = [0, 1].map(|k| graph.symbol(Symbol::Coordinate(k)));
    let root = build(&mut graph, [x, y]);
    let body = body(&Coordinates, &Literals::default(), &straight(&graph, &[root]));
    body.values[0].tokens.to_string().replace(' ', "")
}

/// A method binds more strongly than a sign.
#[test]
fn functions_are_of_the_negative_where_the_graph_says_so() {
    let product = |graph: &mut Graph, [x, y]: [ExprId; 2]| {
        let product = graph.mul(x, y);
        graph.neg(product)
    };
    let root = |graph: &mut Graph, of| {
        let negative = product(graph, of);
        graph.sqrt(negative)
    };
    let of_product = "-(x0*x1)";
    assert_eq!(written(root), format!("({of_product}).sqrt()"));
    let opposite = |graph: &mut Graph, of| {
        let root = root(graph, of);
        graph.neg(root)
    };
    assert_eq!(written(opposite), format!("-({of_product}).sqrt()"));
}
