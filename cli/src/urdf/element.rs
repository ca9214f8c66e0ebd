//! Attributes of XML elements, with mistakes told by file, line and element.

use super::angle::{Angles, at};
use super::document::Node;
use nalgebra::{IsometryMatrix3, Matrix3, Rotation3, Translation3, Vector3};
use std::collections::BTreeMap;

/// What is wrong with a file and what of it has no counterpart.
#[derive(Debug)]
pub(super) struct Findings<'d> {
    pub(super) file: &'d str,
    /// Colours of materials by their names, as model files write them.
    pub(super) colors: BTreeMap<String, String>,
    /// Whether numbers stay as they are where others are likely meant.
    pub(super) as_written: bool,
    pub(super) problems: Vec<String>,
    pub(super) remarks: Vec<String>,
    pub(super) angles: Angles,
    /// Lines of the elements that have no counterpart, by their tags.
    pub(super) unused: BTreeMap<String, Vec<u32>>,
}

/// What to do about a file with macros.
pub(super) const XACRO: &str = "this is xacro: expand the file with `xacro` first";

/// Lengths and components of directions below this are what a computation left of a zero.
const ZERO: f64 = 1e-12;

impl Findings<'_> {
    /// A mistake at an element.
    pub(super) fn problem(&mut self, node: Node<'_>, words: &str) {
        let line = self.at(node, words);
        self.problems.push(line);
    }

    /// A message about an element, with its place.
    pub(super) fn at(&self, node: Node<'_>, words: &str) -> String {
        format!("{}:{}: {}: {words}", self.file, node.line(), title(node))
    }

    /// Something at an element that the model file does not have.
    pub(super) fn remark(&mut self, node: Node<'_>, words: &str) {
        let line = format!("line {}: {}: {words}", node.line(), title(node));
        self.remarks.push(line);
    }

    /// An element that the model file does not have.
    pub(super) fn unused(&mut self, node: Node<'_>) {
        let line = node.line();
        self.unused.entry(node.name().to_owned()).or_default().push(line);
    }

    /// All remarks, those on many elements as one.
    pub(super) fn all_remarks(&self) -> Vec<String> {
        let unused = |(tag, lines): (&String, &Vec<u32>)| {
            format!("{} <{tag}> without counterpart: {}", lines.len(), at(lines.iter()))
        };
        let remarks = self.remarks.iter().cloned();
        remarks.chain(self.angles.remarks()).chain(self.unused.iter().map(unused)).collect()
    }

    /// An attribute that must be there.
    pub(super) fn text<'n>(&mut self, node: Node<'n>, name: &str) -> Option<&'n str> {
        let value = node.attribute(name);
        if value.is_none() {
            self.problem(node, &format!("the attribute `{name}` is missing"));
        }
        value
    }

    /// A number that must be there.
    pub(super) fn number(&mut self, node: Node<'_>, name: &str) -> Option<f64> {
        self.text(node, name).and_then(|text| self.parsed(node, name, text))
    }

    /// A number, or its default.
    pub(super) fn number_or(&mut self, node: Node<'_>, name: &str, default: f64) -> Option<f64> {
        node.attribute(name).map_or(Some(default), |text| self.parsed(node, name, text))
    }

    /// Three numbers, or their default.
    pub(super) fn vector_or(
        &mut self,
        node: Node<'_>,
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
    pub(super) fn origin(&mut self, node: Node<'_>) -> Option<IsometryMatrix3<f64>> {
        let Some(origin) = node.child("origin") else { return Some(IsometryMatrix3::identity()) };
        let xyz = self.vector_or(origin, "xyz", [0.0; 3]);
        let rpy = self.vector_or(origin, "rpy", [0.0; 3]);
        let (xyz, mut rpy) = (xyz?, rpy?);
        let line = origin.line();
        let words = origin.attribute("rpy").unwrap_or_default().split_whitespace();
        for (angle, written) in rpy.iter_mut().zip(words).filter(|_| !self.as_written) {
            *angle = self.angles.meant(written, *angle, line);
        }
        let xyz = xyz.map(|x| if x.abs() < ZERO && !self.as_written { 0.0 } else { x });
        let rotation = Rotation3::from_euler_angles(rpy.x, rpy.y, rpy.z);
        Some(settled(&IsometryMatrix3::from_parts(Translation3::from(xyz), rotation)))
    }

    /// An axis of length 1; `None` if it has no direction.
    pub(super) fn direction(&mut self, node: Node<'_>, xyz: &Vector3<f64>) -> Option<Vector3<f64>> {
        const MEANT: f64 = 1e-6;
        if self.as_written {
            return xyz.try_normalize(0.0);
        }
        let largest = xyz.amax();
        let left_out =
            xyz.iter().filter(|x| x.abs() < MEANT * largest).fold(0.0, |most: f64, x| most.max(x.abs()));
        if left_out > ZERO * largest {
            self.remark(
                node,
                &format!("a component of {:.1e} of the largest is taken for 0", left_out / largest),
            );
        }
        xyz.map(|x| if x.abs() < MEANT * largest { 0.0 } else { x }).try_normalize(0.0)
    }

    fn parsed(&mut self, node: Node<'_>, name: &str, text: &str) -> Option<f64> {
        match text.trim().parse::<f64>() {
            Ok(value) if value.is_finite() => Some(value),
            _ => {
                let cure = if text.contains("${") { format!("; {XACRO}") } else { String::new() };
                self.problem(node, &format!("{name}=\"{text}\": a finite number was expected{cure}"));
                None
            }
        }
    }
}

/// A pose without what rounding has left of right angles: rotations by them are exact, also one after the other.
pub(super) fn settled(pose: &IsometryMatrix3<f64>) -> IsometryMatrix3<f64> {
    const ROUNDING: f64 = 1e-15;
    let exact = |x: f64| {
        let halves = (2.0 * x).round() / 2.0;
        if (x - halves).abs() < ROUNDING { halves } else { x }
    };
    let rotation: Matrix3<f64> = pose.rotation.matrix().map(exact);
    IsometryMatrix3::from_parts(pose.translation, Rotation3::from_matrix_unchecked(rotation))
}

/// The element as messages show it, with the named element that it is in.
fn title(node: Node<'_>) -> String {
    let tag = node.name();
    match node.attribute("name") {
        Some(name) => format!("<{tag} name=\"{name}\">"),
        None => match node.ancestors().skip(1).find_map(|a| Some((a, a.attribute("name")?))) {
            Some((owner, name)) => format!("<{tag}> of {} `{name}`", owner.name()),
            None => format!("<{tag}>"),
        },
    }
}
