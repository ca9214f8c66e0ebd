use super::*;

#[test]
fn repetitions_are_found_in_any_order_and_sign() {
    let mut program = Program::default();
    let read = |program: &mut Program, k| program.push(Node::Read(Source::State(k)), 1);
    let (a, b) = (read(&mut program, 0), read(&mut program, 1));
    program.push(Node::Sub(a, b), 2);
    program.push(Node::Add(a, b), 3);
    program.push(Node::Sub(b, a), 4);
    let minus = program.push(Node::Neg(b), 5);
    program.push(Node::Mul(a, b), 6);
    program.push(Node::Mul(minus, a), 7);
    program.push(Node::Div(a, b), 8);
    program.push(Node::Div(b, a), 9);
    assert_eq!(repetitions(&program), [(4, 2), (7, 6)]);
}

#[test]
fn loops_may_do_a_few_operations_again() {
    let mut program = Program { loops: vec![(2, 3)], ..Program::default() };
    let x = program.push(Node::Read(Source::State(0)), 1);
    let mut sum = x;
    for _ in 0..OPERATIONS_A_COPY {
        sum = program.push(Node::Add(sum, x), 2);
    }
    program.push(Node::Add(x, x), 3);
    assert_eq!(repetitions(&program), []);
    program.push(Node::Add(x, x), 4);
    assert_eq!(repetitions(&program), [(3, 2), (4, 2)]);
    program.loops.clear();
    assert_eq!(repetitions(&program), [(3, 2), (4, 2)]);
}
