//! The careful form: eq. (17) eliminated body by body, with every buffer allocated once.

use crate::articulated::{self, Node};
use crate::assembled::Solver;
use crate::charts;
use crate::lowered::{End, Joint, Lowered};
use crate::number::Number;
use crate::reactions;
use gyro_model::{Attachment, Model, Tree};
use std::cell::RefCell;

/// Eliminates eq. (17) from the leaves to the root in the null space of each joint, in global axes.
///
/// The child's virtual rotation is its parent's, plus one along what the joint leaves free, plus a bias that the joint's
/// γ determines. So each body folds its inertia and its force into its parent's, and accelerations follow from the root
/// to the leaves. It is Featherstone's articulated-body recursion (*Rigid Body Dynamics Algorithms*, chapter 7) on
/// maximal coordinates, exact also where joint rows are violated: no two joint frames are assumed to coincide.
/// Multipliers follow from a balance of forces, only where they are asked for. Bodies held by rows of their own are
/// ground to their children.
///
/// The partition goes from the root to the leaves by charts, as in [`gyro_sim::charts`]: one 4×4 system a body.
#[derive(Clone, Debug)]
pub struct Elimination<T: Number> {
    links: Vec<Link>,
    /// Work space. A mechanism is constant to its callers, so it is borrowed inside each call and never across.
    nodes: RefCell<Vec<Node<T>>>,
}

/// A body with coordinates and what holds it; parents come before children.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Link {
    pub(crate) slot: usize,
    pub(crate) hold: Hold,
}

/// What holds a body.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Hold {
    Free,
    /// Index of the constrained body.
    Constrained(usize),
    Joint(Hinge),
}

/// A joint with its direction in the tree.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hinge {
    pub(crate) joint: usize,
    pub(crate) child: Side,
    /// The parent's slot, if the parent moves under the child's load.
    pub(crate) loads: Option<usize>,
}

/// Which of a joint's bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    First,
    Second,
}

impl Hinge {
    /// The parent's end of the joint and the child's.
    pub(crate) fn ends<'a, T>(&self, joint: &'a Joint<T>) -> (&'a End<T>, &'a End<T>) {
        match self.child {
            Side::First => (&joint.second, &joint.first),
            Side::Second => (&joint.first, &joint.second),
        }
    }
}

impl<T: Number> Solver<T> for Elimination<T> {
    /// For each body, root first, its special Euler parameter.
    type Independent = Vec<u8>;

    fn new(model: &Model, lowered: &Lowered<T>) -> Self {
        let links = Tree::of(model).links.iter().map(|link| lower_link(model, lowered, link)).collect();
        Self { links, nodes: RefCell::new(vec![Node::new(); lowered.n_bodies()]) }
    }

    fn accelerations(&self, lowered: &Lowered<T>, y: &[T], out: &mut [T]) {
        articulated::accelerations(lowered, &self.links, y, &mut self.nodes.borrow_mut(), out);
    }

    fn accelerations_and_multipliers(&self, lowered: &Lowered<T>, y: &[T], out: &mut [T], lambda: &mut [T]) {
        let nodes = &mut self.nodes.borrow_mut();
        articulated::accelerations(lowered, &self.links, y, nodes, out);
        reactions::multipliers(lowered, &self.links, y, nodes, lambda);
    }

    fn independent(&self, lowered: &Lowered<T>, y: &[T]) -> Vec<u8> {
        charts::best(lowered, &self.links, y)
    }

    fn follow(&self, lowered: &Lowered<T>, y: &[T], choice: &mut Vec<u8>) -> u32 {
        charts::follow(lowered, &self.links, y, choice)
    }

    fn newton_step(&self, lowered: &Lowered<T>, choice: &Vec<u8>, y: &mut [T]) -> Result<(), T> {
        charts::newton_step(lowered, &self.links, choice, y)
    }

    fn solve_velocities(&self, lowered: &Lowered<T>, _: &Vec<u8>, y: &mut [T]) -> Result<(), T> {
        charts::solve_velocities(lowered, &self.links, y)
    }
}

fn lower_link<T: Number>(model: &Model, lowered: &Lowered<T>, link: &gyro_model::Link) -> Link {
    let slots = model.coordinate_bodies();
    let slot_of = |body| slots.iter().position(|&b| b == body);
    let slot = slot_of(link.body).expect("bodies of links have coordinates");
    let constrained = |slot| lowered.constrained.iter().position(|body| body.slot == slot);
    let hold = match link.attachment {
        Attachment::Free => Hold::Free,
        Attachment::Constrained => Hold::Constrained(constrained(slot).expect("it was lowered as such")),
        Attachment::Joint { joint, parent, reversed } => Hold::Joint(Hinge {
            joint,
            child: if reversed { Side::First } else { Side::Second },
            loads: slot_of(parent).filter(|&parent| constrained(parent).is_none()),
        }),
    };
    Link { slot, hold }
}
