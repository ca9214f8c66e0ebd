use super::*;
use crate::expr::evaluate::evaluate;
use crate::expr::schedule::Operations;

/// A body that stores the number that its first symbol carries.
fn recurrence(graph: Graph, value: ExprId) -> Recurrence {
    Recurrence { graph, values: vec![value], carried: vec![(Symbol::Local(0), 0)] }
}

#[test]
fn what_is_carried_is_added_last() {
    let mut graph = Graph::new();
    let symbols: Vec<ExprId> = (0..6).map(|n| graph.symbol(Symbol::Local(n))).collect();
    let sum = symbols[1..].iter().fold(symbols[0], |sum, &symbol| graph.add(sum, symbol));
    let before = recurrence(graph, sum);
    assert_eq!([before.length(), before.reordered().length()], [5 * SUM * PARTS, SUM * PARTS]);
}

/// The graph writes no such sum of itself: the first term of its sums has no sign.
#[test]
fn a_sum_of_negatives_is_negative() {
    let carried = HashMap::default();
    let mut to = Reordering { graph: Graph::new(), arrivals: ByExpr::default(), carried: &carried };
    let terms: Vec<_> = (0..3).map(|n| (true, to.put(Node::Symbol(Symbol::Local(n))))).collect();
    let sum = to.sum(terms);
    let found = evaluate(&to.graph, &[sum], |symbol| match symbol {
        Symbol::Local(n) => [1.0, 2.0, 4.0][n],
        other => unreachable!("{other:?}"),
    });
    assert_eq!(found, [-7.0]);
}

/// Draws of a linear congruence.
struct Dice(u64);

impl Dice {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        usize::try_from(self.0 >> 33).expect("31 bits") % n
    }
}

/// Sums, differences, products and opposites of earlier numbers, some of them used again.
fn random(dice: &mut Dice) -> (Graph, ExprId) {
    let mut graph = Graph::new();
    let mut all: Vec<ExprId> = (0..5).map(|n| graph.symbol(Symbol::Local(n))).collect();
    let mut last = all[0];
    for _ in 0..4 + dice.below(20) {
        let operand = all[dice.below(all.len())];
        last = match dice.below(6) {
            0 => graph.mul(operand, last),
            1 => graph.neg(last),
            2 | 3 => graph.sub(operand, last),
            _ => graph.add(last, operand),
        };
        if dice.below(3) == 0 {
            all.push(last);
        }
    }
    (graph, last)
}

#[test]
fn an_order_changes_neither_numbers_nor_their_count() {
    let mut n_shorter = 0;
    for seed in 0..500 {
        let mut dice = Dice(seed);
        let (graph, value) = random(&mut dice);
        let before = recurrence(graph, value);
        let after = before.reordered();
        // Small integers: no order rounds.
        let numbers = [0; 5].map(|_| f64::from(u8::try_from(dice.below(3)).expect("less than three")) - 1.0);
        let [expected, found] = [&before, &after].map(|of| {
            evaluate(&of.graph, &of.values, |symbol| match symbol {
                Symbol::Local(n) => numbers[n],
                other => unreachable!("{other:?}"),
            })
        });
        assert_eq!(found, expected, "seed {seed}");
        let [expected, found] = [&before, &after].map(|of| Operations::count(&of.graph, &of.values).total());
        assert!(found <= expected, "seed {seed}: {found} operations instead of {expected}");
        n_shorter += usize::from(after.length() < before.length());
    }
    assert!(n_shorter > 50, "{n_shorter}");
}
