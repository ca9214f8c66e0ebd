//! The states that the last steps have led to, and the polynomial through them.

use crate::Real;
use crate::contract::Storage;

/// So many states are kept. Steps that shrink towards a pose leave them at distances that grow geometrically, where
/// polynomials through many of them neither swing nor enlarge rounding.
const NODES: usize = 10;

/// Fewer states say nothing about how well a polynomial fits.
const FEWEST: usize = 4;

/// The last states with their times and pivots, in a ring.
#[derive(Clone, Debug)]
pub(super) struct Past<S, T> {
    nodes: [Node<S, T>; NODES],
    newest: usize,
    len: usize,
}

/// A state that a step has led to.
#[derive(Clone, Debug)]
pub(super) struct Node<S, T> {
    pub(super) t: T,
    /// How clear it is of singular poses.
    pub(super) pivot: T,
    y: S,
}

impl<S: Storage<T>, T: Real> Past<S, T> {
    /// Nothing is known yet.
    pub(super) fn new(t: T, y: &S) -> Self {
        Self { nodes: core::array::from_fn(|_| Node { t, pivot: t, y: y.clone() }), newest: 0, len: 0 }
    }

    /// What was before says nothing about what comes.
    pub(super) fn forget(&mut self) {
        self.len = 0;
    }

    /// How many states are known.
    pub(super) fn len(&self) -> usize {
        self.len
    }

    pub(super) fn push(&mut self, t: T, pivot: T, y: &S) {
        self.newest = (self.newest + 1) % NODES;
        let node = &mut self.nodes[self.newest];
        (node.t, node.pivot) = (t, pivot);
        node.y.as_mut().copy_from_slice(y.as_ref());
        self.len = (self.len + 1).min(NODES);
    }

    /// The newest node and the one before it.
    pub(super) fn last_two(&self) -> Option<[&Node<S, T>; 2]> {
        (self.len > 1).then(|| [self.node(0), self.node(1)])
    }

    fn node(&self, age: usize) -> &Node<S, T> {
        &self.nodes[(self.newest + NODES - age % NODES) % NODES]
    }

    /// The polynomial that fits best at a time, by its degree, and the size of its last term there, the root mean
    /// square over the elements in units of the weights: how far the polynomial of one degree less is off. So much of
    /// each element is rounding and does not count.
    pub(super) fn best_fit(&self, t: T, weights: &S, rounding: T) -> Option<(usize, f64)> {
        let (mut sums, mut n, spans) = ([0.0; NODES], 0.0, self.inverse_spans());
        for (i, weight) in weights.as_ref().iter().enumerate() {
            let mut term = |degree: usize, term: T| {
                let term = term.abs() - rounding;
                let term = if term > T::constant(0.0) { (term / *weight).to_f64() } else { 0.0 };
                sums[degree] += term * term;
            };
            self.each_term((i, &spans), t, &mut term);
            n += 1.0;
        }
        let largest = |terms: &[f64]| terms.iter().copied().fold(0.0, f64::max);
        let sizes = (2..).zip(sums[..self.len].windows(3).map(largest)).skip(FEWEST - 3);
        let (degree, size) = sizes.min_by(|a, b| a.1.total_cmp(&b.1))?;
        Some((degree, libm::sqrt(size / n)))
    }

    /// Writes the polynomial of this degree, through the newest states, at a time.
    pub(super) fn at(&self, t: T, degree: usize, out: &mut S) {
        let spans = self.inverse_spans();
        for (i, out) in out.as_mut().iter_mut().enumerate() {
            let mut sum = T::constant(0.0);
            self.each_term((i, &spans), t, &mut |k, term| {
                if k <= degree {
                    sum = sum + term
                }
            });
            *out = sum;
        }
    }

    /// One over the time between each node and the one that so many are before it, by this number, from 1 on.
    fn inverse_spans(&self) -> [[T; NODES]; NODES] {
        let mut spans = [[T::constant(0.0); NODES]; NODES];
        for (degree, spans) in spans.iter_mut().enumerate().take(self.len) {
            for (k, span) in spans.iter_mut().enumerate().take(self.len - degree - 1) {
                *span = T::constant(1.0) / (self.node(k).t - self.node(k + degree + 1).t);
            }
        }
        spans
    }

    /// Newton's form of the polynomial through all nodes, of one element, term by term: divided differences times
    /// products of distances.
    fn each_term(&self, (i, spans): (usize, &[[T; NODES]; NODES]), t: T, tell: &mut impl FnMut(usize, T)) {
        let mut differences: [T; NODES] = core::array::from_fn(|age| self.node(age).y.as_ref()[i]);
        let mut product = T::constant(1.0);
        for (degree, spans) in spans.iter().enumerate().take(self.len) {
            tell(degree, product * differences[0]);
            product = product * (t - self.node(degree).t);
            for k in 0..self.len - degree - 1 {
                differences[k] = (differences[k] - differences[k + 1]) * spans[k];
            }
        }
    }
}
