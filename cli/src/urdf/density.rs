//! Mass and inertia of shapes at a density, for links whose file has none, or none that a body can have.

use super::inertia::Inertial;
use super::robot::{Kind as Held, Link, Robot};
use super::shapes::{Kind, Shape};
use crate::show::meshes;
use crate::words::{self, listed};
use nalgebra::{Matrix3, Vector3};
use std::path::Path;

/// The vector area of a closed surface is 0, but for this part of its area, which rounding of coordinates leaves.
const CLOSED: f64 = 1e-3;

/// Gives links that have no inertia, or one that no body has, those of their shapes, scaled to the link's mass; and
/// links of which neither they nor what is fixed to them has mass, both. Says so, or what shape cannot be weighed.
pub(super) fn weigh(file: &str, robot: &mut Robot, density: f64) -> Result<(), Vec<String>> {
    let lumps: Vec<usize> = (0..robot.links.len()).map(|link| lump(robot, link)).collect();
    let has_mass = |link: &Link| link.inertial.as_ref().is_some_and(|inertial| inertial.mass > 0.0);
    let heavy: Vec<bool> = (0..robot.links.len())
        .map(|link| {
            robot.links.iter().zip(&lumps).any(|(other, lump)| *lump == lumps[link] && has_mass(other))
        })
        .collect();
    let (mut problems, mut weighed, mut shaped) = (Vec::new(), Vec::new(), Vec::new());
    for (link, is_heavy) in robot.links.iter_mut().zip(heavy) {
        let is_good =
            |inertial: &Inertial| inertial.tensor != Matrix3::zeros() && inertial.elements(false).is_ok();
        let own = link.inertial.take();
        if link.solids.is_empty() || own.as_ref().map_or(is_heavy, is_good) {
            link.inertial = own;
            continue;
        }
        let name = format!("`{}`", link.name);
        let solids: Result<Vec<Inertial>, String> =
            link.solids.iter().map(|shape| solid(shape, density)).collect();
        match (solids.map(|solids| Inertial::sum(&solids)), own) {
            (Err(why), _) => problems.push(format!("{file}:{}: link {name}: --density: {why}", link.line)),
            (Ok(None), own) => link.inertial = own,
            (Ok(Some(solid)), Some(own)) if own.mass > 0.0 => {
                link.inertial = Some(Inertial { centre: own.centre, ..solid.part(own.mass / solid.mass) });
                shaped.push(name);
            }
            (Ok(solid), _) => {
                link.inertial = solid;
                weighed.push(name);
            }
        }
    }
    let told =
        |links: &[String], words: &str| (!links.is_empty()).then(|| format!("{words}: {}", listed(links)));
    let density = words::number(density, 6);
    robot
        .remarks
        .extend(told(&weighed, &format!("mass and inertia are those of the shapes at {density} kg/m3")));
    robot.remarks.extend(told(&shaped, "inertias are those of the shapes, scaled to the masses of the file"));
    if problems.is_empty() { Ok(()) } else { Err(problems) }
}

/// The first of the links that a link is fixed to.
fn lump(robot: &Robot, link: usize) -> usize {
    let held =
        |link: &usize| robot.joints.iter().find(|joint| joint.child == *link && joint.kind == Held::Fixed);
    let carriers = std::iter::successors(Some(link), |link| held(link).map(|joint| joint.parent));
    carriers.take(robot.links.len()).last().unwrap_or(link)
}

/// Mass, mass centre and inertia of a shape, in its link's frame.
fn solid(shape: &Shape, density: f64) -> Result<Inertial, String> {
    // Second moments of mass of the unit of mass, along the shape's axes.
    let (volume, squares) = match &shape.kind {
        Kind::Box(edges) => (edges.iter().product::<f64>(), edges.map(|edge| edge * edge / 12.0)),
        Kind::Cylinder([radius, length]) => {
            let square = radius * radius / 4.0;
            (std::f64::consts::PI * radius * radius * length, [square, square, length * length / 12.0])
        }
        Kind::Sphere(radius) => {
            (4.0 / 3.0 * std::f64::consts::PI * radius.powi(3), [radius * radius / 5.0; 3])
        }
        Kind::Mesh(file, scale) => return enclosed(file, scale, density).map(|mesh| mesh.seen(&shape.pose)),
    };
    let mass = volume * density;
    let tensor = of_squares(&(Matrix3::from_diagonal(&Vector3::from(squares)) * mass));
    let centred = Inertial { mass, centre: Vector3::zeros(), tensor };
    Ok(centred.seen(&shape.pose))
}

/// What a closed surface encloses: the sum over the tetrahedra that its triangles make with the origin.
fn enclosed(file: &Path, scale: &[f64; 3], density: f64) -> Result<Inertial, String> {
    let name = file.display();
    let (vertices, triangles) = meshes::surface(file).map_err(|e| format!("{name}: {e}"))?;
    let scale = Vector3::from(*scale);
    let vertex =
        |k: u32| vertices.get(k as usize).map(|v| Vector3::from(v.map(f64::from)).component_mul(&scale));
    let (mut volume, mut moment, mut squares) = (0.0, Vector3::zeros(), Matrix3::zeros());
    let (mut open, mut area) = (Vector3::zeros(), 0.0);
    for [a, b, c] in triangles {
        let (Some(a), Some(b), Some(c)) = (vertex(a), vertex(b), vertex(c)) else { continue };
        let (part, sum) = (a.dot(&b.cross(&c)) / 6.0, a + b + c);
        volume += part;
        moment += sum * (part / 4.0);
        let own = [a, b, c].iter().fold(sum * sum.transpose(), |all, v| all + v * v.transpose());
        squares += own * (part / 20.0);
        let normal = (b - a).cross(&(c - a)) / 2.0;
        open += normal;
        area += normal.norm();
    }
    // What is flatter than this encloses nothing.
    let is_closed = open.norm() <= CLOSED * area && volume.abs() > CLOSED * CLOSED * area.powf(1.5);
    if !is_closed {
        return Err(format!(
            "{name} encloses no volume: give the link an <inertial> or a <collision> of simple shapes"
        ));
    }
    let (density, centre) = (density * volume.signum(), moment / volume);
    let mass = volume * density;
    let squares = squares * density - centre * centre.transpose() * mass;
    Ok(Inertial { mass, centre, tensor: of_squares(&squares) })
}

/// The inertia tensor of second moments of mass: tr(S) I − S.
fn of_squares(squares: &Matrix3<f64>) -> Matrix3<f64> {
    Matrix3::identity() * squares.trace() - squares
}
