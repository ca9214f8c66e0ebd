//! Operations of several texts side by side.

use crate::module::Module;
use crate::program::{Id, Node, Program};
use std::collections::HashMap;

/// Operations, each once: what is computed alike has the same place.
#[derive(Debug, Default)]
pub(crate) struct Nodes {
    pub(crate) nodes: Vec<Node>,
    places: HashMap<Node, Id>,
    /// Bits of literals, which [`Node::Constant`] names by their places.
    literals: Vec<u64>,
}

impl Nodes {
    /// What is the same to the last bit is one operation: operands of sums and products in any order, a sign of a
    /// factor or of the product, of what is added or of the sum's kind.
    pub(crate) fn push(&mut self, node: Node) -> Id {
        match node {
            Node::Neg(of) => match self.opposite(of) {
                Some(opposite) => opposite,
                None if matches!(self.nodes[of], Node::Constant(_)) => self.negated(of),
                None => self.place(node),
            },
            Node::Mul(a, b) => self.product([a, b]),
            Node::Add(a, b) => match (self.opposite(a), self.opposite(b)) {
                (Some(a), Some(b)) => self.negative_sum(a, b),
                (Some(a), None) => self.place(Node::Sub(b, a)),
                (None, Some(b)) => self.place(Node::Sub(a, b)),
                (None, None) => self.place(Node::Add(a.min(b), a.max(b))),
            },
            Node::Sub(a, b) => match (self.opposite(a), self.opposite(b)) {
                (_, Some(b)) => self.push(Node::Add(a, b)),
                (Some(a), None) => self.negative_sum(a, b),
                (None, None) => self.place(node),
            },
            _ => self.place(node),
        }
    }

    /// −a − b.
    fn negative_sum(&mut self, a: Id, b: Id) -> Id {
        let negative = self.push(Node::Neg(a.min(b)));
        self.place(Node::Sub(negative, a.max(b)))
    }

    /// With the signs of both factors before it.
    fn product(&mut self, factors: [Id; 2]) -> Id {
        let opposites = factors.map(|factor| self.opposite(factor));
        let [a, b] = [0, 1].map(|n| opposites[n].unwrap_or(factors[n]));
        let product = self.place(Node::Mul(a.min(b), a.max(b)));
        if opposites[0].is_some() == opposites[1].is_some() {
            product
        } else {
            self.place(Node::Neg(product))
        }
    }

    /// What this is the negative of, if it has a sign.
    fn opposite(&mut self, id: Id) -> Option<Id> {
        match self.nodes[id] {
            Node::Neg(of) => Some(of),
            Node::Constant(place) if f64::from_bits(self.literals[place]).is_sign_negative() => {
                Some(self.negated(id))
            }
            _ => None,
        }
    }

    /// A literal with the other sign.
    fn negated(&mut self, literal: Id) -> Id {
        let Node::Constant(place) = self.nodes[literal] else { return literal };
        self.literal(-f64::from_bits(self.literals[place]))
    }

    fn place(&mut self, node: Node) -> Id {
        let next = self.nodes.len();
        let place = *self.places.entry(node).or_insert(next);
        if place == next {
            self.nodes.push(node);
        }
        place
    }

    pub(crate) fn literal(&mut self, value: f64) -> Id {
        let bits = value.to_bits();
        let place = self.literals.iter().position(|known| *known == bits).unwrap_or(self.literals.len());
        if place == self.literals.len() {
            self.literals.push(bits);
        }
        self.place(Node::Constant(place))
    }

    /// The results of a module's function.
    pub(crate) fn of_program(&mut self, program: &Program, module: &Module) -> Vec<Id> {
        let mut places: Vec<Id> = Vec::with_capacity(program.nodes.len());
        for node in &program.nodes {
            let place = match *node {
                Node::Constant(place) => self.literal(module.constants.rounded(place)),
                node => self.push(node.with_operands(|id| places[id])),
            };
            places.push(place);
        }
        program.results.iter().map(|&id| places[id]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::program::Source;

    #[test]
    fn what_rounds_alike_is_one_operation_and_nothing_else() {
        let mut nodes = Nodes::default();
        let [x, y, z] = [0, 1, 2].map(|place| nodes.push(Node::Read(Source::State(place))));
        let [minus_x, minus_z] = [x, z].map(|id| nodes.push(Node::Neg(id)));
        let product = nodes.push(Node::Mul(x, y));
        let negative = nodes.push(Node::Mul(minus_x, y));
        assert_eq!(product, nodes.push(Node::Mul(y, x)));
        assert_eq!(negative, nodes.push(Node::Neg(product)));
        assert_eq!(nodes.push(Node::Add(negative, z)), nodes.push(Node::Sub(z, product)));
        assert_eq!(nodes.push(Node::Add(product, minus_z)), nodes.push(Node::Sub(product, z)));
        assert_eq!(nodes.push(Node::Sub(product, minus_z)), nodes.push(Node::Add(z, product)));
        assert_eq!(nodes.push(Node::Sub(minus_z, product)), nodes.push(Node::Add(negative, minus_z)));
        assert_eq!(nodes.push(Node::Sub(negative, z)), nodes.push(Node::Add(minus_z, negative)));
        let (half, minus_half) = (nodes.literal(0.5), nodes.literal(-0.5));
        assert_eq!(nodes.push(Node::Neg(half)), minus_half);
        assert_eq!(nodes.push(Node::Add(x, minus_half)), nodes.push(Node::Sub(x, half)));
        // −(x − y) is −0 where y − x is 0.
        let difference = nodes.push(Node::Sub(x, y));
        assert_ne!(nodes.push(Node::Neg(difference)), nodes.push(Node::Sub(y, x)));
        assert_ne!(nodes.push(Node::Div(x, y)), nodes.push(Node::Div(y, x)));
        assert_ne!(product, negative);
    }
}
