//! The trees that the joints make of the bodies, rooted in fixed and free bodies.

use crate::{Model, Support};

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
    /// Nothing: a free root.
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
    /// Joints that close a loop: both of their bodies were reached without them.
    pub loop_joints: Vec<usize>,
    /// Bodies that no joint connects to a root.
    pub unreached: Vec<usize>,
}

impl Tree {
    /// Walks the joints breadth first from the roots; bodies and joints are met in the order of the page.
    pub fn of(model: &Model) -> Self {
        let mut tree = Self::default();
        let mut reached: Vec<bool> = model.bodies.iter().map(|b| b.support != Support::Moving).collect();
        let mut used = vec![false; model.joints.len()];
        let mut queue: Vec<usize> = (0..reached.len()).filter(|&b| reached[b]).collect();
        for &body in &queue {
            match model.bodies[body].support {
                Support::Free => tree.links.push(Link { body, attachment: Attachment::Free }),
                Support::Constrained => tree.links.push(Link { body, attachment: Attachment::Constrained }),
                Support::Fixed | Support::Moving => {}
            }
        }
        let mut head = 0;
        while let Some(&parent) = queue.get(head) {
            head += 1;
            for (joint, ends) in model.joints.iter().enumerate() {
                let (reversed, body) = match (ends.first.body == parent, ends.second.body == parent) {
                    (true, false) => (false, ends.second.body),
                    (false, true) => (true, ends.first.body),
                    _ => continue,
                };
                if !used[joint] && !reached[body] {
                    (used[joint], reached[body]) = (true, true);
                    let attachment = Attachment::Joint { joint, parent, reversed };
                    tree.links.push(Link { body, attachment });
                    queue.push(body);
                }
            }
        }
        tree.loop_joints = (0..used.len()).filter(|&j| !used[j]).collect();
        tree.unreached = (0..reached.len()).filter(|&b| !reached[b]).collect();
        tree
    }
}
