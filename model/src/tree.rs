//! The trees that the joints make of the bodies, rooted in fixed, driven and free bodies.

use crate::{CoordinateUse, JointKind, Model, Support};

/// A body that has coordinates, with what holds it. Links come root first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Link {
    /// Index into [`Model::bodies`].
    pub body: usize,
    /// What leads to the body from the root.
    pub attachment: Attachment,
}

/// What leads to a body from the root of its tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Attachment {
    /// Nothing: a free root, or a body that only rods hold.
    Free,
    /// Its own six rows: a constrained root.
    Constrained,
    /// A joint from a body nearer to the root, which is the joint's first body unless `reversed`.
    Joint {
        /// Index into [`Model::joints`].
        joint: usize,
        /// Index into [`Model::bodies`] of the body nearer to the root.
        parent: usize,
        /// Whether the parent is the joint's second body.
        reversed: bool,
    },
}

/// The spanning trees of a mechanism.
#[derive(Clone, Debug, Default)]
pub struct Tree {
    /// Bodies with coordinates, parents before children.
    pub links: Vec<Link>,
    /// Joints that carry no body of a tree: they close loops, or are rods.
    pub loop_joints: Vec<usize>,
    /// Bodies that only rods tie to a root, or that legs carry: roots of trees of their own, placed by their own guess.
    pub floating: Vec<usize>,
    /// Bodies that nothing connects to a root.
    pub unreached: Vec<usize>,
}

impl Tree {
    /// Walks the joints breadth first from the roots; bodies and joints are met in the order of the model file.
    ///
    /// Joints that do not say how a body is turned come last: only where the walk ends before every body is reached
    /// does it go on over the first point on a line of the model file that leads to another body, and only where there
    /// is none from the first body that a rod ties to one that is reached.
    pub fn of(model: &Model) -> Self {
        Self::along(model, |joint| u8::from(!model.joints[joint].kind.turns()))
    }

    /// The trees whose joint coordinates describe the mechanism: of the joints of a loop one is cut of whose
    /// coordinates as little as possible is asked ([`Model::use_of_coordinates`]), and of those one that has many, so
    /// that few rows are left. A screw is cut like other joints where one angle says how far it has turned. Where no
    /// joint is cut it is the same tree in the same order.
    ///
    /// A body that three or more legs carry hangs on none of them: it floats, and the ball joints at the ends of all
    /// legs are cut. A leg slides along what a universal or ball joint turns.
    pub fn of_coordinates(model: &Model) -> Self {
        let tree = Self::of(model);
        if tree.loop_joints.is_empty() {
            return tree;
        }
        let tree = Self::by_use(model, |joint| model.use_of_coordinates(joint));
        let mut screws =
            tree.loop_joints.iter().filter(|&&joint| model.joints[joint].kind == JointKind::Screw);
        if screws.all(|&screw| tree.n_angles_past(model, screw) == 1) {
            return tree;
        }
        Self::by_use(model, |joint| match model.joints[joint].kind {
            JointKind::Screw => model.use_of_coordinates(joint).max(CoordinateUse::Value),
            _ => model.use_of_coordinates(joint),
        })
    }

    fn by_use(model: &Model, of: impl Fn(usize) -> CoordinateUse) -> Self {
        let free = |joint: usize| u8::try_from(model.joints[joint].kind.n_free()).unwrap_or(u8::MAX);
        let slides = |joint: usize| {
            model.joints[joint].kind == JointKind::Prismatic && of(joint) != CoordinateUse::Prescribed
        };
        if (0..model.joints.len()).all(|joint| of(joint) == CoordinateUse::None) {
            return Self::walked(model, |joint| if free(joint) <= 1 { 0 } else { free(joint) }, slides);
        }
        // A joint has at most five freedoms.
        let rank = |joint| match of(joint) {
            CoordinateUse::Prescribed => 0,
            CoordinateUse::Value => 1,
            CoordinateUse::Rate => 1 + free(joint).max(1),
            CoordinateUse::None => 7 + free(joint).max(1),
        };
        Self::walked(model, rank, slides)
    }

    /// How many angles of the tree lie between the bodies of a joint.
    fn n_angles_past(&self, model: &Model, joint: usize) -> usize {
        let link_of = |body: usize| self.links.iter().find(|link| link.body == body);
        let to_root = |body: usize| {
            std::iter::successors(link_of(body), |link| match link.attachment {
                Attachment::Joint { parent, .. } => link_of(parent),
                Attachment::Free | Attachment::Constrained => None,
            })
        };
        let [first, second] = [model.joints[joint].first.body, model.joints[joint].second.body];
        let is_on = |body: usize, link: &Link| to_root(body).any(|other| other.body == link.body);
        let apart = to_root(first).filter(|link| !is_on(second, link));
        let apart = apart.chain(to_root(second).filter(|link| !is_on(first, link)));
        let n_angles = |link: &Link| match link.attachment {
            Attachment::Joint { joint, .. } => {
                let coordinates = model.joints[joint].kind.coordinates();
                coordinates.iter().filter(|coordinate| coordinate.is_angle()).count()
            }
            Attachment::Free | Attachment::Constrained => 3,
        };
        apart.map(n_angles).sum()
    }

    /// The same with another order of the joints: those of rank zero are walked breadth first; the others are followed
    /// one by one, lower ranks first and from bodies reached early, only where none of a lower rank leads on.
    pub(crate) fn along(model: &Model, rank: impl Fn(usize) -> u8) -> Self {
        Self::walked(model, rank, |_| false)
    }

    /// The same, legs being made of joints that slide.
    fn walked(model: &Model, rank: impl Fn(usize) -> u8, slides: impl Fn(usize) -> bool) -> Self {
        let mut walk = Walk::of(model);
        for (body, support) in model.bodies.iter().map(|body| body.support).enumerate() {
            match support {
                Support::Free => walk.start(body, Some(Attachment::Free)),
                Support::Constrained => walk.start(body, Some(Attachment::Constrained)),
                Support::Fixed | Support::Driven => walk.start(body, None),
                Support::Moving => {}
            }
        }
        loop {
            walk.follow_all(|joint| model.joints[joint].kind.carries() && rank(joint) == 0);
            if !(walk.float_on_legs(&slides) || walk.follow_one(&rank) || walk.float_on_rod()) {
                return walk.finish();
            }
        }
    }

    /// Whether the joints alone hold every body, each by one path: no joint closes a loop and no rod holds a body.
    pub fn is_open(&self) -> bool {
        self.loop_joints.is_empty() && self.floating.is_empty()
    }
}

/// The work in progress.
struct Walk<'m> {
    model: &'m Model,
    tree: Tree,
    reached: Vec<bool>,
    used: Vec<bool>,
    /// Bodies reached, in the order in which joints are followed from them.
    queue: Vec<usize>,
    /// How many of them have been done.
    done: usize,
}

impl<'m> Walk<'m> {
    fn of(model: &'m Model) -> Self {
        let (reached, used) = (vec![false; model.bodies.len()], vec![false; model.joints.len()]);
        Self { model, tree: Tree::default(), reached, used, queue: Vec::new(), done: 0 }
    }

    fn start(&mut self, body: usize, attachment: Option<Attachment>) {
        self.reached[body] = true;
        self.queue.push(body);
        self.tree.links.extend(attachment.map(|attachment| Link { body, attachment }));
    }

    /// Follows joints from all bodies that are reached and have not been done.
    fn follow_all(&mut self, follows: impl Fn(usize) -> bool) {
        while let Some(&parent) = self.queue.get(self.done) {
            self.done += 1;
            for (joint, ends) in self.model.joints.iter().enumerate() {
                let body = match (ends.first.body == parent, ends.second.body == parent) {
                    (true, false) => ends.second.body,
                    (false, true) => ends.first.body,
                    _ => continue,
                };
                if follows(joint) && !self.reached[body] {
                    self.hang(joint, parent, body);
                }
            }
        }
    }

    /// Whether a body could be hung on the first joint that leads to one: by rank, by how early the body was reached
    /// that it leads from, and by the model file.
    fn follow_one(&mut self, rank: impl Fn(usize) -> u8) -> bool {
        let turn = |body: usize| self.queue.iter().position(|&reached| reached == body);
        let next = self.ways(JointKind::carries).min_by_key(|&(joint, from, _)| (rank(joint), turn(from)));
        if let Some((joint, parent, body)) = next {
            self.hang(joint, parent, body);
        }
        next.is_some()
    }

    fn hang(&mut self, joint: usize, parent: usize, body: usize) {
        self.used[joint] = true;
        let reversed = self.model.joints[joint].second.body == parent;
        self.start(body, Some(Attachment::Joint { joint, parent, reversed }));
    }

    /// Whether a body could be reached that legs alone carry, three or more.
    fn float_on_legs(&mut self, slides: impl Fn(usize) -> bool) -> bool {
        let ways: Vec<_> = self.ways(JointKind::carries).collect();
        let is_carried = |body: usize| {
            let mut to = ways.iter().filter(|(.., to)| *to == body);
            to.clone().count() >= 3 && to.all(|&(joint, from, _)| self.is_end_of_leg(joint, from, &slides))
        };
        let next = ways.iter().map(|&(.., body)| body).filter(|&body| is_carried(body)).min();
        if let Some(body) = next {
            self.tree.floating.push(body);
            self.start(body, Some(Attachment::Free));
        }
        next.is_some()
    }

    /// Whether a joint is a ball at the end of a leg.
    fn is_end_of_leg(&self, joint: usize, body: usize, slides: impl Fn(usize) -> bool) -> bool {
        let carrier = |body: usize| {
            self.tree.links.iter().find_map(|link| match link.attachment {
                Attachment::Joint { joint, parent, .. } if link.body == body => Some((joint, parent)),
                _ => None,
            })
        };
        let kind = |joint: usize| self.model.joints[joint].kind;
        let turns = |body: usize| {
            carrier(body)
                .is_some_and(|(joint, _)| matches!(kind(joint), JointKind::Universal | JointKind::Spherical))
        };
        kind(joint) == JointKind::Spherical
            && carrier(body).is_some_and(|(joint, parent)| slides(joint) && turns(parent))
    }

    /// Whether a body could be reached over a rod.
    fn float_on_rod(&mut self) -> bool {
        let next = self.ways(|kind| !kind.carries()).map(|(.., body)| body).min();
        if let Some(body) = next {
            self.tree.floating.push(body);
            self.start(body, Some(Attachment::Free));
        }
        next.is_some()
    }

    /// Joints of some kinds from a body that is reached to one that is not: joint, from, to.
    fn ways(&self, of: impl Fn(JointKind) -> bool) -> impl Iterator<Item = (usize, usize, usize)> {
        let joints = self.model.joints.iter().enumerate().filter(move |(_, joint)| of(joint.kind));
        let ends = joints.flat_map(|(index, joint)| {
            let [first, second] = [joint.first.body, joint.second.body];
            [(index, first, second), (index, second, first)]
        });
        ends.filter(|&(_, from, to)| self.reached[from] && !self.reached[to])
    }

    fn finish(self) -> Tree {
        let Self { mut tree, used, reached, .. } = self;
        tree.loop_joints = (0..used.len()).filter(|&j| !used[j]).collect();
        tree.unreached = (0..reached.len()).filter(|&b| !reached[b]).collect();
        tree
    }
}
