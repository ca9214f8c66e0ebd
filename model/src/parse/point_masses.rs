//! Point masses of bodies: the model has each body with them as one, its frame at the mass centre of all.

use super::reader::Reader;
use super::section::Section;
use crate::keys::POINT_MASS;
use crate::validate::{Owner, Place};
use crate::{Body, Model, Number};

/// A mass and where it is in its body's frame.
pub(super) type PointMass = (Number, [Number; 3]);

type Vector = [Number; 3];

/// Reads those of a body.
pub(super) fn read(reader: &mut Reader<'_>, body: &Section<'_>, index: usize) -> Vec<PointMass> {
    let tables = body.get("point_mass").map(|item| item.tables(reader)).unwrap_or_default();
    let masses = tables.into_iter().enumerate().map(|(k, (item, table))| {
        let owner = Owner::PointMass(index, k);
        reader.mark(Place { owner, key: "" }, item.span());
        let title = format!("a point mass of {}", body.title);
        let section = Section::open(reader, owner, title, table, &POINT_MASS);
        section.given(reader, "mass").zip(section.given_vector(reader, "at"))
    });
    let masses: Vec<_> = masses.collect();
    if reader.is_doubted(body.place("point_mass")) || masses.contains(&None) {
        ["mass", "inertia"].iter().for_each(|key| reader.doubt(body.place(key)));
    }
    masses.into_iter().flatten().collect()
}

/// Makes one body of each and its point masses. All that is given in the body's frame moves to the new one.
pub(super) fn add(model: &mut Model, masses: &[Vec<PointMass>]) {
    for (index, masses) in masses.iter().enumerate().filter(|(_, masses)| !masses.is_empty()) {
        if let Some(centre) = join(&mut model.bodies[index], masses) {
            points(model, index).into_iter().for_each(|point| *point = difference(point, &centre));
        }
    }
}

/// The body with its point masses; where their mass centre is in the frame that it had. None if they weigh nothing.
fn join(body: &mut Body, masses: &[PointMass]) -> Option<Vector> {
    let own = (body.mass.clone(), [0; 3].map(Number::integer));
    let all: Vec<&PointMass> =
        std::iter::once(&own).chain(masses).filter(|(mass, _)| !mass.is_zero()).collect();
    let total = all.iter().fold(Number::integer(0), |sum, (mass, _)| sum + mass.clone());
    body.mass = total.clone();
    let moment =
        |k: usize| all.iter().fold(Number::integer(0), |sum, (m, at)| sum + m.clone() * at[k].clone());
    let [x, y, z] = [0, 1, 2].map(|k| moment(k).over(total.clone()));
    let centre = [x?, y?, z?];
    for (k, (first, a)) in all.iter().enumerate() {
        for (second, b) in &all[..k] {
            // About their mass centre two masses have the moment of the reduced mass at their distance: unlike the
            // parallel-axis theorem, this subtracts nothing.
            let reduced = (first.clone() * second.clone()).over(total.clone())?;
            add_moment(&mut body.inertia, &reduced, &difference(a, b));
        }
    }
    place(body, &centre);
    body.frame = centre.clone().map(|x| -x);
    Some(centre)
}

/// Adds m (r·r I − r rᵀ).
fn add_moment(inertia: &mut [Number; 6], mass: &Number, r: &Vector) {
    let product = |a: usize, b: usize| mass.clone() * (r[a].clone() * r[b].clone());
    let [x, y, z] = [0, 1, 2].map(|k| product(k, k));
    let more = [y.clone() + z.clone(), x.clone() + z, x + y, -product(0, 1), -product(0, 2), -product(1, 2)];
    for (element, more) in inertia.iter_mut().zip(more) {
        *element = std::mem::replace(element, Number::integer(0)) + more;
    }
}

/// Position and velocity of the mass centre from those of the frame's origin: r + A c and s + A (w' × c).
fn place(body: &mut Body, centre: &Vector) {
    let Some(offset) = turned(&body.orientation, centre) else { return };
    let rate = body.angular_velocity.as_ref().and_then(|w| turned(&body.orientation, &cross(w, centre)));
    let moved = |start: &Vector, by: Vector| sum(start, &by);
    body.position = moved(&body.position, offset);
    if let Some(rate) = rate {
        body.velocity = moved(&body.velocity, rate);
    }
}

/// A(p) v of Euler parameters of any length: `v + 2 (e0 (e × v) + e × (e × v)) / p·p`.
fn turned(p: &[Number; 4], v: &Vector) -> Option<Vector> {
    let [e0, e @ ..] = p;
    let square = p.iter().fold(Number::integer(0), |sum, e| sum + e.clone() * e.clone());
    let once = cross(e, v);
    let both = sum(&once.clone().map(|x| e0.clone() * x), &cross(e, &once));
    let [x, y, z] = both.map(|x| (Number::integer(2) * x).over(square.clone()));
    Some(sum(v, &[x?, y?, z?]))
}

fn sum(a: &Vector, b: &Vector) -> Vector {
    std::array::from_fn(|k| a[k].clone() + b[k].clone())
}

fn difference(a: &Vector, b: &Vector) -> Vector {
    std::array::from_fn(|k| a[k].clone() - b[k].clone())
}

fn cross(a: &Vector, b: &Vector) -> Vector {
    let minor = |k: usize, l: usize| a[k].clone() * b[l].clone() - a[l].clone() * b[k].clone();
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

/// All points that the model file gives in the frame of a body.
fn points(model: &mut Model, body: usize) -> Vec<&mut Vector> {
    let of_shapes = model.bodies[body].shapes.iter_mut().map(|shape| &mut shape.position);
    let joints = model.joints.iter_mut().flat_map(|joint| [&mut joint.first, &mut joint.second]);
    let of_joints = joints.filter(|end| end.body == body).map(|end| &mut end.point);
    let of_forces = model.forces.iter_mut().flat_map(|force| force.kind.points_mut());
    let of_outputs = model.outputs.iter_mut().flat_map(|output| output.kind.frames_mut());
    let of_outputs = of_outputs.map(|frame| (frame.body, &mut frame.point));
    let others = of_forces.chain(of_outputs).filter(|(of, _)| *of == body).map(|(_, point)| point);
    of_shapes.chain(of_joints).chain(others).collect()
}
