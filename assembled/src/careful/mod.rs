//! The careful form: eq. (17) eliminated body by body, with every buffer allocated once.

pub(crate) mod articulated;
pub(crate) mod charts;
pub(crate) mod hinges;
pub(crate) mod motion_subspace;
pub(crate) mod reactions;
pub(crate) mod spatial;

use crate::assembled::{Assembled, Refusal, Solver};
use crate::careful::articulated::{Node, Space};
use crate::careful::hinges::{Bearing, Hinge, Hold, Link, Side};
use crate::error::Unsupported;
use crate::model::lowered::Lowered;
use crate::model::place::Moment;
use crate::number::Number;
use gyro_model::{Attachment, Model, RowOwner, Tree};
use std::cell::RefCell;

/// Eliminates eq. (17) from the leaves to the root in the null space of each joint, in global axes.
///
/// The child's virtual rotation is its parent's, plus one along what the joint leaves free, plus a bias that the
/// joint's γ determines. So each body folds its inertia and its force into its parent's, and accelerations follow from
/// the root to the leaves. It is Featherstone's articulated-body recursion (*Rigid Body Dynamics Algorithms*, chapter
/// 7) on maximal coordinates, exact also where joint rows are violated: no two joint frames are assumed to coincide.
/// Multipliers follow from a balance of forces, only where they are asked for. Bodies held by rows of their own are
/// ground to their children, and so are bodies that move by prescription, with an acceleration.
///
/// It does trees of revolute, spherical and fixed joints: see [`Assembled::supports`].
///
/// The partition goes from the root to the leaves by charts, as in [`gyro_sim::charts`]: one 4×4 system a body. At
/// velocity level a revolute joint holds its child's rate about the joint's axis, `h'·w'`, and changes w' only at right
/// angles to it; a free or spherically held body keeps w' whole. Holding a single component of ṗ instead lets what
/// integration has lost at right angles leak into the spin, and so into the energy: 1.3e-10 of it in 100 s of the
/// paper's gyroscope instead of 7e-14.
#[derive(Clone, Debug)]
pub struct Elimination<T: Number> {
    links: Vec<Link>,
    /// Work space. A mechanism is constant to its callers, so it is borrowed inside each call and never across.
    space: RefCell<Space<T>>,
}

impl<T: Number> Assembled<T, Elimination<T>> {
    /// Whether elimination can do a model: a tree of revolute, spherical and fixed joints that hangs on fixed,
    /// constrained, free or driven bodies, with any forces and outputs, but without drivers and couplers of joint
    /// coordinates.
    ///
    /// # Errors
    /// The first thing in the model that it cannot do.
    pub fn supports(model: &Model) -> Result<(), Unsupported> {
        match model.joints.iter().find(|joint| Bearing::of(joint.kind).is_none()) {
            Some(other) => Err(Unsupported::JointKind(other.name.clone())),
            None => Unsupported::beyond_trees(model),
        }
    }
}

impl<T: Number> Solver<T> for Elimination<T> {
    /// For each body, root first, its special Euler parameter.
    type Independent = Vec<u8>;

    fn new(model: &Model, lowered: &Lowered<T>) -> Result<Self, Unsupported> {
        Assembled::<T, Self>::supports(model)?;
        let links = Tree::of(model).links.iter().map(|link| lower_link(model, lowered, link)).collect();
        let driven = (0..lowered.scene.driven.len())
            .map(|index| lowered.scene.driven_motion(T::zero(), index))
            .collect();
        let (nodes, forces) =
            (vec![Node::new(); lowered.scene.n_bodies()], vec![T::zero(); lowered.scene.n_v()]);
        let space = Space { nodes, driven, forces };
        Ok(Self { links, space: RefCell::new(space) })
    }

    fn accelerations_len(&self, lowered: &Lowered<T>) -> usize {
        lowered.scene.n_v()
    }

    fn accelerations(&self, lowered: &Lowered<T>, t: T, y: &[T], out: &mut [T]) {
        let space = &mut self.space.borrow_mut();
        articulated::accelerations(lowered, &self.links, Moment { t, y }, space, out);
    }

    fn multipliers(&self, lowered: &Lowered<T>, t: T, y: &[T], accelerations: &[T], lambda: &mut [T]) {
        let space = &mut self.space.borrow_mut();
        reactions::multipliers(lowered, &self.links, Moment { t, y }, accelerations, space, lambda);
    }

    fn independent(&self, lowered: &Lowered<T>, _: T, y: &[T]) -> Vec<u8> {
        charts::best(lowered, &self.links, y)
    }

    fn follow(&self, lowered: &Lowered<T>, _: T, y: &[T], choice: &mut Vec<u8>) -> u32 {
        charts::follow(lowered, &self.links, y, choice)
    }

    fn newton_step(
        &self,
        lowered: &Lowered<T>,
        t: T,
        choice: &Vec<u8>,
        y: &mut [T],
    ) -> Result<(), Refusal<T>> {
        Ok(charts::newton_step(lowered, &self.links, t, choice, y)?)
    }

    fn solve_velocities(&self, lowered: &Lowered<T>, t: T, _: &Vec<u8>, y: &mut [T]) -> Result<(), T> {
        charts::solve_velocities(lowered, &self.links, t, y)
    }
}

fn lower_link<T: Number>(model: &Model, lowered: &Lowered<T>, link: &gyro_model::Link) -> Link {
    let moving_bodies = model.coordinate_bodies();
    let moving_body_of = |body| moving_bodies.iter().position(|&b| b == body);
    let moving_body = moving_body_of(link.body).expect("bodies of links have coordinates");
    let constrained =
        |moving_body| lowered.scene.constrained.iter().position(|body| body.moving_body == moving_body);
    let hold = match link.attachment {
        Attachment::Free => Hold::Free,
        Attachment::Constrained => Hold::Constrained(
            constrained(moving_body).expect("it was lowered as such"),
            model.rows_of(RowOwner::Body(link.body)).start,
        ),
        Attachment::Joint { joint, parent, reversed } => Hold::Joint(Hinge {
            joint,
            first_row: model.rows_of(RowOwner::Joint(joint)).start,
            bearing: Bearing::of(model.joints[joint].kind).expect("other kinds are not supported"),
            child: if reversed { Side::First } else { Side::Second },
            loads: moving_body_of(parent).filter(|&parent| constrained(parent).is_none()),
        }),
    };
    Link { moving_body, hold }
}
