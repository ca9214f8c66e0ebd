//! How bodies and joints hang together: everything that moves is connected, free bodies are roots, and starts do not
//! contradict.

use super::{Place, Problem, Side};
use crate::{Attachment, Body, Joint, JointKind, Link, Model, Support, Tree};

/// Everything that is wrong, in the order of the model file within each kind.
pub(crate) fn problems(model: &Model) -> Vec<Problem> {
    let tree = Tree::of(model);
    let mut found = Vec::new();
    if tree.links.is_empty() && tree.unreached.is_empty() {
        found.push(nothing_moves());
    }
    for (index, joint) in model.joints.iter().enumerate() {
        let both_held = [&joint.first, &joint.second].iter().all(|end| is_held(model, end.body));
        if joint.first.body == joint.second.body {
            found.push(to_itself(model, index));
        } else if both_held {
            found.push(between_held(model, index));
        } else if tree.loop_joints.contains(&index) && is_reached(&tree, joint) {
            found.extend(ties_free_root(model, &tree, index));
        }
    }
    found.extend(tree.unreached.iter().map(|&body| unconnected(model, body)));
    found.extend(tree.links.iter().filter_map(|link| twice_started(model, link)));
    found
}

/// Whether something else than joints decides where a body is.
fn is_held(model: &Model, body: usize) -> bool {
    matches!(model.bodies[body].support, Support::Fixed | Support::Constrained | Support::Driven)
}

/// A joint among bodies that nothing leads to is not a loop yet.
fn is_reached(tree: &Tree, joint: &Joint) -> bool {
    !tree.unreached.contains(&joint.first.body)
}

fn nothing_moves() -> Problem {
    Problem::new(
        Place { owner: super::Owner::Page, key: "body" },
        "nothing in this mechanism can move",
        "every body is fixed",
        "add a [[body]] without `fixed`, held by a [[joint]] or with `free = true`",
    )
}

fn to_itself(model: &Model, index: usize) -> Problem {
    let joint = &model.joints[index];
    Problem::new(
        Place::end(index, Side::Second, "body"),
        format!("joint `{}` joins body `{}` to itself", joint.name, model.bodies[joint.first.body].name),
        "the same body as the first",
        "name two different bodies in `first` and `second`",
    )
    .also(Place::end(index, Side::First, "body"), "the first body")
}

fn between_held(model: &Model, index: usize) -> Problem {
    let joint = &model.joints[index];
    let [first, second] = [&joint.first, &joint.second].map(|end| &model.bodies[end.body]);
    let word = |body: &Body| if body.support == Support::Driven { "driven" } else { "fixed" };
    let (are, help) = match (word(first), word(second)) {
        ("fixed", "fixed") => ("two fixed bodies", "the `fixed` of the body that should move"),
        ("driven", "driven") => {
            ("two driven bodies", "the `driven` of the body that should follow the joint")
        }
        _ => {
            ("a fixed and a driven body", "the `fixed` or `driven` of the body that should follow the joint")
        }
    };
    let alike = word(first) == word(second);
    Problem::new(
        Place::end(index, Side::Second, "body"),
        format!("joint `{}` joins {are}, `{}` and `{}`", joint.name, first.name, second.name),
        format!("{}{}", word(second), if alike { ", too" } else { "" }),
        format!("remove the joint, or {help}"),
    )
    .also(Place::end(index, Side::First, "body"), word(first).to_owned())
}

/// A joint between the tree of a free body and another root. Bodies that only rods hold are not roots that could hold
/// it.
fn ties_free_root(model: &Model, tree: &Tree, index: usize) -> Option<Problem> {
    let joint = &model.joints[index];
    let roots = [&joint.first, &joint.second].map(|end| root(tree, end.body));
    let free = roots.into_iter().find(|&root| model.bodies[root].support == Support::Free)?;
    if roots[0] == roots[1] || roots.iter().any(|root| tree.floating.contains(root)) {
        return None;
    }
    let name = &model.bodies[free].name;
    Some(
        Problem::new(
            Place::joint(index, ""),
            format!("joint `{}` connects the free body `{name}` to a body that is already held", joint.name),
            "leads to another fixed, driven or free body",
            format!("remove `free` of body `{name}`: its joints place it"),
        )
        .also(Place::body(free, "free"), "the free body"),
    )
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
    let label =
        if has_joint { "its joints lead to no fixed, driven or free body" } else { "no joint refers to it" };
    Problem::new(
        Place::body(body, ""),
        format!("body `{name}` is not connected"),
        label.to_owned(),
        "add a [[joint]] that leads to it from a fixed body, or write free = true if it floats in space",
    )
}

/// A body whose angular velocity is given while its joint has a rate.
fn twice_started(model: &Model, link: &Link) -> Option<Problem> {
    let Attachment::Joint { joint: index, .. } = link.attachment else { return None };
    let (joint, body) = (&model.joints[index], &model.bodies[link.body]);
    if joint.kind == JointKind::Fixed || joint.start.rate.is_none() || body.angular_velocity.is_none() {
        return None;
    }
    Some(
        Problem::new(
            Place::joint(index, "rate"),
            format!("the start of body `{}` is given twice", body.name),
            format!("the rate of the joint that holds `{}`", body.name),
            format!(
                "give either the `rate` of joint `{}` or the `angular_velocity` of body `{}`",
                joint.name, body.name
            ),
        )
        .also(Place::body(link.body, "angular_velocity"), "and its angular velocity"),
    )
}
