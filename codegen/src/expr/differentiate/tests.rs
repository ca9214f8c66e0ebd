use super::*;
use crate::expr::evaluate::{evaluate, sample};

/// Central differences with this step leave a truncation error near 1e-10 and a rounding error near 1e-11.
const STEP: f64 = 1e-5;
const TOLERANCE: f64 = 1e-8;

fn check(build: impl Fn(&mut Graph, ExprId, ExprId) -> ExprId) {
    let (mut graph, definitions) = (Graph::new(), Definitions::default());
    let (x, y) = (Symbol::Time, Symbol::Parameter(0));
    let (vx, vy) = (graph.symbol(x), graph.symbol(y));
    let root = build(&mut graph, vx, vy);
    let direction = Direction::from([(x, Graph::ONE), (y, vx)]);
    let derivative = Derivative::new(&definitions, direction).of(&mut graph, root);
    let gradient = gradient(&mut graph, root, &[x, y]);
    for seed in 0..20 {
        let at = |h: f64| {
            let value = sample(seed);
            // Both stay positive: roots and reciprocals are differentiated too.
            let (x0, y0) = (value(x) + 2.0, value(y) + 2.0);
            move |symbol| if symbol == Symbol::Time { x0 + h } else { y0 + h * x0 }
        };
        let difference =
            (evaluate(&graph, &[root], at(STEP))[0] - evaluate(&graph, &[root], at(-STEP))[0]) / (2.0 * STEP);
        let value = evaluate(&graph, &[derivative], at(0.0))[0];
        assert!((value - difference).abs() <= TOLERANCE * value.abs().max(1.0), "{value} {difference}");
        let x0 = sample(seed)(x) + 2.0;
        let [by_x, by_y] = evaluate(&graph, &gradient, at(0.0))[..] else { unreachable!("of two symbols") };
        let along = by_x + x0 * by_y;
        assert!((value - along).abs() <= TOLERANCE * value.abs().max(1.0), "{value} {along}");
    }
}

#[test]
fn every_node_differentiates_like_finite_differences() {
    check(|g, x, y| g.add(x, y));
    check(|g, x, y| g.mul(x, y));
    check(|g, x, _| g.neg(x));
    check(|g, x, _| g.recip(x));
    check(|g, x, y| g.div(x, y));
    for function in Function::ALL {
        check(|g, x, y| g.call(function, if function.arity() == 2 { [x, y] } else { [y, y] }));
    }
}

#[test]
fn products_and_compositions_differentiate() {
    check(|g, x, y| {
        let (product, sine) = (g.mul(x, y), g.sin(x));
        let (root, sum) = (g.sqrt(product), g.add(sine, y));
        g.div(root, sum)
    });
}

/// Points on both sides of where something changes; what is not taken is no number there.
#[test]
fn what_is_chosen_differentiates_by_itself() {
    let centred = |g: &mut Graph, x: ExprId| {
        let two = g.integer(2);
        g.sub(x, two)
    };
    check(|g, x, y| {
        let condition = centred(g, x);
        let (size, whole) = (g.abs(condition), g.floor(condition));
        let product = g.mul(size, y);
        g.add(product, whole)
    });
    check(|g, x, y| {
        let (condition, opposite) = (centred(g, x), centred(g, y));
        // Small arguments would be further from differences.
        let half = g.fraction(1, 2);
        let (above, later) = (g.add(condition, half), g.add(opposite, half));
        let (root, logarithm) = (g.sqrt(above), g.ln(later));
        // Both stand alone, inside of each other, and as factors.
        let within = g.when(opposite, logarithm);
        let product = g.mul(root, within);
        let (chosen, exponential) = (g.when(condition, product), g.exp(opposite));
        let other = g.unless(condition, exponential);
        let sum = g.add(chosen, other);
        let scaled = g.mul(sum, x);
        g.add(scaled, within)
    });
}
