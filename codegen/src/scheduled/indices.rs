//! Where numbers stand, by name.

use crate::equations::Equations;
use crate::joint_space::JointSpace;
use gyro_model::{Attachment, CoordinateKind, Model};

/// A place that has a name; of several numbers the first.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Index {
    /// Of which kind it is: `joint` and `joint_rate`, `body` and `body_rate`, `state`, `input`, `parameter`, `output`.
    /// Names are unique among those of a kind and a coordinate.
    pub kind: &'static str,
    /// Which coordinate of a joint that has several.
    pub coordinate: Option<&'static str>,
    /// The name in the model file.
    pub name: String,
    /// The place.
    pub place: usize,
}

/// A coordinate of a joint state: what names it, and where it and its rate stand.
struct Named<'m> {
    name: &'m str,
    of: Of,
    x: usize,
    u: usize,
}

#[derive(Clone, Copy, PartialEq)]
enum Of {
    /// The only coordinate of a joint.
    Joint,
    /// One of several.
    Coordinate(CoordinateKind),
    Orientation,
    Body,
}

/// What stands in a joint state of joints, in the order in which it is listed, with what coordinates are called.
const LISTED: [(Of, Option<&str>); 8] = [
    (Of::Joint, None),
    (Of::Coordinate(CoordinateKind::Angle), Some("angle")),
    (Of::Coordinate(CoordinateKind::Displacement), Some("displacement")),
    (Of::Coordinate(CoordinateKind::FirstAngle), Some("first_angle")),
    (Of::Coordinate(CoordinateKind::SecondAngle), Some("second_angle")),
    (Of::Coordinate(CoordinateKind::X), Some("x")),
    (Of::Coordinate(CoordinateKind::Y), Some("y")),
    (Of::Orientation, Some("orientation")),
];

/// Of joint coordinates and rates in the joint state, of inputs, outputs and parameters; kind for kind.
pub fn indices(equations: &Equations) -> Vec<Index> {
    let model = equations.model;
    let named = equations.joint_space.as_ref().map_or_else(Vec::new, |space| named(model, space));
    let n_x = equations.n_coordinates();
    let mut indices = Vec::new();
    let mut list = |kind: &'static str,
                    (of, coordinate): (Of, Option<&'static str>),
                    at: &dyn Fn(&Named<'_>) -> usize| {
        let listed = named.iter().filter(|named| named.of == of);
        indices.extend(listed.map(|of| Index { kind, coordinate, name: of.name.to_owned(), place: at(of) }));
    };
    LISTED.into_iter().for_each(|of| list("joint", of, &|named| named.x));
    LISTED.into_iter().for_each(|of| list("joint_rate", of, &|named| n_x + named.u));
    list("body", (Of::Body, None), &|named| named.x);
    list("body_rate", (Of::Body, None), &|named| n_x + named.u);
    let mut list = |kind: &'static str, name: &str, place: usize| {
        indices.push(Index { kind, coordinate: None, name: name.to_owned(), place });
    };
    if let Some(space) = &equations.joint_space {
        model.states.iter().zip(space.layout.states()).for_each(|(of, x)| list("state", &of.name, x));
    }
    model.inputs.iter().enumerate().for_each(|(n, input)| list("input", &input.name, n));
    let mut n_before = 0;
    for output in &model.outputs {
        list("output", &output.name, n_before);
        n_before += output.kind.columns().len();
    }
    model.parameters.iter().enumerate().for_each(|(n, parameter)| list("parameter", &parameter.name, n));
    indices
}

/// What stands in x, in its order.
fn named<'m>(model: &'m Model, space: &JointSpace) -> Vec<Named<'m>> {
    let mut named = Vec::new();
    for link in &space.layout.links {
        for scalar in link.scalars.iter().filter(|scalar| scalar.place.x < space.layout.n_coordinates) {
            let joint = &model.joints[scalar.coordinate.joint];
            let is_alone = joint.kind.coordinates().len() == 1;
            let of = if is_alone { Of::Joint } else { Of::Coordinate(scalar.kind) };
            named.push(Named { name: &joint.name, of, x: scalar.place.x, u: scalar.place.u });
        }
        let Some(orientation) = link.orientation else { continue };
        let (name, of, place) = match (link.link.attachment, link.position) {
            (Attachment::Joint { joint, .. }, _) => (&model.joints[joint].name, Of::Orientation, orientation),
            (_, position) => {
                let place = position.expect("nothing else holds it");
                (&model.bodies[link.link.body].name, Of::Body, place)
            }
        };
        named.push(Named { name, of, x: place.x, u: place.u });
    }
    named.sort_by_key(|named| named.x);
    named
}
