//! Attributes of XML elements, with mistakes told by file, line and element.

use nalgebra::{IsometryMatrix3, Rotation3, Translation3, Vector3};
use roxmltree::{Document, Node};

/// What is wrong with a file and what of it has no counterpart.
#[derive(Debug)]
pub(super) struct Findings<'d> {
    pub(super) file: &'d str,
    pub(super) document: &'d Document<'d>,
    pub(super) problems: Vec<String>,
    pub(super) remarks: Vec<String>,
}

impl Findings<'_> {
    /// A mistake at an element.
    pub(super) fn problem(&mut self, node: Node<'_, '_>, words: &str) {
        let line = self.at(node, words);
        self.problems.push(line);
    }

    /// A message about an element, with its place.
    pub(super) fn at(&self, node: Node<'_, '_>, words: &str) -> String {
        format!("{}:{}: {}: {words}", self.file, self.line(node), title(node))
    }

    /// Something at an element that the model file does not have.
    pub(super) fn remark(&mut self, node: Node<'_, '_>, words: &str) {
        let line = format!("line {}: {}: {words}", self.line(node), title(node));
        self.remarks.push(line);
    }

    /// The line on which an element starts.
    pub(super) fn line(&self, node: Node<'_, '_>) -> u32 {
        self.document.text_pos_at(node.range().start).row
    }

    /// An attribute that must be there.
    pub(super) fn text<'n>(&mut self, node: Node<'n, '_>, name: &str) -> Option<&'n str> {
        let value = node.attribute(name);
        if value.is_none() {
            self.problem(node, &format!("the attribute `{name}` is missing"));
        }
        value
    }

    /// A number that must be there.
    pub(super) fn number(&mut self, node: Node<'_, '_>, name: &str) -> Option<f64> {
        self.text(node, name).and_then(|text| self.parsed(node, name, text))
    }

    /// A number, or its default.
    pub(super) fn number_or(&mut self, node: Node<'_, '_>, name: &str, default: f64) -> Option<f64> {
        node.attribute(name).map_or(Some(default), |text| self.parsed(node, name, text))
    }

    /// Three numbers, or their default.
    pub(super) fn vector_or(
        &mut self,
        node: Node<'_, '_>,
        name: &str,
        default: [f64; 3],
    ) -> Option<Vector3<f64>> {
        let Some(text) = node.attribute(name) else { return Some(default.into()) };
        let words: Vec<&str> = text.split_whitespace().collect();
        let Ok([x, y, z]) = <[&str; 3]>::try_from(words) else {
            self.problem(node, &format!("{name}=\"{text}\": three numbers were expected"));
            return None;
        };
        let mut number = |text| self.parsed(node, name, text);
        let (x, y, z) = (number(x), number(y), number(z));
        Some(Vector3::new(x?, y?, z?))
    }

    /// The pose of an `<origin>` among an element's children: `xyz`, and `rpy`, rotations about the fixed x, y and z
    /// axes in this order.
    pub(super) fn origin(&mut self, node: Node<'_, '_>) -> Option<IsometryMatrix3<f64>> {
        let Some(origin) = child(node, "origin") else { return Some(IsometryMatrix3::identity()) };
        let xyz = self.vector_or(origin, "xyz", [0.0; 3]);
        let rpy = self.vector_or(origin, "rpy", [0.0; 3]);
        let (xyz, rpy) = (xyz?, rpy?);
        let rotation = Rotation3::from_euler_angles(rpy.x, rpy.y, rpy.z);
        Some(IsometryMatrix3::from_parts(Translation3::from(xyz), rotation))
    }

    fn parsed(&mut self, node: Node<'_, '_>, name: &str, text: &str) -> Option<f64> {
        match text.trim().parse::<f64>() {
            Ok(value) if value.is_finite() => Some(value),
            _ => {
                self.problem(node, &format!("{name}=\"{text}\": a finite number was expected"));
                None
            }
        }
    }
}

/// The first child element of a name.
pub(super) fn child<'a, 'i>(node: Node<'a, 'i>, name: &str) -> Option<Node<'a, 'i>> {
    node.children().find(|child| child.has_tag_name(name))
}

/// The element as messages show it, with the named element that it is in.
fn title(node: Node<'_, '_>) -> String {
    let tag = node.tag_name().name();
    match node.attribute("name") {
        Some(name) => format!("<{tag} name=\"{name}\">"),
        None => match node.ancestors().skip(1).find_map(|a| Some((a, a.attribute("name")?))) {
            Some((owner, name)) => format!("<{tag}> of {} `{name}`", owner.tag_name().name()),
            None => format!("<{tag}>"),
        },
    }
}
