//! Operations whose results are known without them are found.

use gyro_verifier::field::Prime;
use gyro_verifier::module::Module;
use gyro_verifier::program::Node;
use gyro_verifier::proof::{Decider, Needless, prime};

#[test]
fn planted_operations_are_found() {
    let page = crate::support::page("pendulum");
    let mut module = Module::read(&page.model, &page.code, &page.constants).expect("the emitted subset");
    let prime: Prime<9> = prime(&page.model, &module, 1).expect("room for all roots");
    let decider = Decider::new(&page.model, prime);
    let before = decider.needless(&module, "energy", 1).expect("a point");
    let program = module.programs.get_mut("energy").expect("a function");
    let is_product = |node: &Node| matches!(node, Node::Mul(..));
    let product = program.nodes.iter().position(is_product).expect("kinetic energy has products");
    let Node::Mul(a, b) = program.nodes[product] else { unreachable!("a product was looked for") };
    let minus = program.push(Node::Neg(b), 9001);
    program.push(Node::Mul(minus, a), 9002);
    program.push(Node::Sub(a, a), 9003);
    let same_as = Some(program.lines[product]);
    let planted = [Needless { line: 9002, same_as }, Needless { line: 9003, same_as: None }];
    let after = decider.needless(&module, "energy", 1).expect("a point");
    assert_eq!(after[before.len()..], planted);
}
