//! How bodies and joints hang together: trees rooted in fixed and free bodies, and starts that do not contradict.

use super::{Place, Problem, Side};
use crate::{Attachment, Joint, JointKind, Link, Model, Support, Tree};

/// Everything that is wrong, in the order of the page within each kind.
pub(crate) fn problems(model: &Model) -> Vec<Problem> {
    let tree = Tree::of(model);
    let mut found = Vec::new();
    if tree.links.is_empty() && tree.unreached.is_empty() {
        found.push(nothing_moves());
    }
    for (index, joint) in model.joints.iter().enumerate() {
        let both_fixed = [&joint.first, &joint.second].iter().all(|end| is_fixed(model, end.body));
        if joint.first.body == joint.second.body {
            found.push(to_itself(model, index));
        } else if both_fixed {
            found.push(between_fixed(model, index));
        } else if tree.loop_joints.contains(&index) && is_reached(&tree, joint) {
            found.push(closing(model, &tree, index));
        }
    }
    found.extend(tree.unreached.iter().map(|&body| unconnected(model, body)));
    found.extend(tree.links.iter().filter_map(|link| twice_started(model, link)));
    found
}

fn is_fixed(model: &Model, body: usize) -> bool {
    matches!(model.bodies[body].support, Support::Fixed | Support::Constrained)
}

/// A joint among bodies that nothing leads to is no loop yet.
fn is_reached(tree: &Tree, joint: &Joint) -> bool {
    !tree.unreached.contains(&joint.first.body)
}

fn nothing_moves() -> Problem {
    Problem {
        place: Place { owner: super::Owner::Page, key: "body" },
        also: None,
        message: "nothing in this mechanism can move".to_owned(),
        label: "every body is fixed".to_owned(),
        help: "add a [[body]] without `fixed`, held by a [[joint]] or with `free = true`".to_owned(),
    }
}

fn to_itself(model: &Model, index: usize) -> Problem {
    let joint = &model.joints[index];
    Problem {
        place: Place::end(index, Side::Second, "body"),
        also: Some((Place::end(index, Side::First, "body"), "the first body".to_owned())),
        message: format!(
            "joint `{}` joins body `{}` to itself",
            joint.name, model.bodies[joint.first.body].name
        ),
        label: "the same body as the first".to_owned(),
        help: "name two different bodies in `first` and `second`".to_owned(),
    }
}

fn between_fixed(model: &Model, index: usize) -> Problem {
    let joint = &model.joints[index];
    let [first, second] = [&joint.first, &joint.second].map(|end| &model.bodies[end.body].name);
    Problem {
        place: Place::end(index, Side::Second, "body"),
        also: Some((Place::end(index, Side::First, "body"), "fixed".to_owned())),
        message: format!("joint `{}` joins two fixed bodies, `{first}` and `{second}`", joint.name),
        label: "fixed, too".to_owned(),
        help: "remove the joint, or the `fixed` of the body that should move".to_owned(),
    }
}

/// A joint whose bodies are both held without it.
fn closing(model: &Model, tree: &Tree, index: usize) -> Problem {
    let joint = &model.joints[index];
    let roots = [&joint.first, &joint.second].map(|end| root(tree, end.body));
    let free = roots.into_iter().find(|&root| model.bodies[root].support == Support::Free);
    match free {
        Some(free) if roots[0] != roots[1] => ties_free_root(model, index, free),
        _ => Problem {
            place: Place::joint(index, ""),
            also: None,
            message: format!(
                "joint `{}` closes a loop: mechanisms with closed loops are not supported yet",
                joint.name
            ),
            label: "both of its bodies are held without it".to_owned(),
            help: "remove a joint of the loop, so that one path of joints leads to every body".to_owned(),
        },
    }
}

fn ties_free_root(model: &Model, index: usize, free: usize) -> Problem {
    let name = &model.bodies[free].name;
    Problem {
        place: Place::joint(index, ""),
        also: Some((Place::body(free, "free"), "the free body".to_owned())),
        message: format!("joint `{}` ties the free body `{name}` to another root", model.joints[index].name),
        label: "leads to a body that is held otherwise".to_owned(),
        help: format!("remove `free` and the start of body `{name}`: its joint places it"),
    }
}

/// The fixed or free body that a body hangs from.
fn root(tree: &Tree, body: usize) -> usize {
    // Links come root first, so one pass backwards climbs to the top.
    tree.links.iter().rev().fold(body, |at, link| match link.attachment {
        Attachment::Joint { parent, .. } if link.body == at => parent,
        _ => at,
    })
}

fn unconnected(model: &Model, body: usize) -> Problem {
    let name = &model.bodies[body].name;
    let has_joint = model.joints.iter().any(|j| j.first.body == body || j.second.body == body);
    let label = if has_joint { "its joints lead to no fixed or free body" } else { "no joint names it" };
    Problem {
        place: Place::body(body, ""),
        also: None,
        message: format!("body `{name}` is connected to nothing"),
        label: label.to_owned(),
        help:
            "add a [[joint]] that leads to it from a fixed body, or write free = true if it floats in space"
                .to_owned(),
    }
}

/// A body whose angular velocity is given while its joint has a rate.
fn twice_started(model: &Model, link: &Link) -> Option<Problem> {
    let Attachment::Joint { joint: index, .. } = link.attachment else { return None };
    let (joint, body) = (&model.joints[index], &model.bodies[link.body]);
    if joint.kind == JointKind::Fixed || joint.start.rate.is_none() || body.angular_velocity.is_none() {
        return None;
    }
    Some(Problem {
        place: Place::joint(index, "rate"),
        also: Some((Place::body(link.body, "angular_velocity"), "and its own angular velocity".to_owned())),
        message: format!("the start of body `{}` is given twice", body.name),
        label: format!("the rate of the joint that holds `{}`", body.name),
        help: format!(
            "write the `rate` of joint `{}` or the `angular_velocity` of body `{}`",
            joint.name, body.name
        ),
    })
}
