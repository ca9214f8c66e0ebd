//! Surfaces of triangles, as fine as a picture needs them.

use crate::channel::{Channel, Rounding, pack};
use serde::Serialize;
use std::collections::HashMap;

/// Triangles of a mesh at most.
const MOST_TRIANGLES: usize = 20_000;

/// Cells of the grid along the longest edge: the most, and the fewest, which few triangles are left of.
const CELLS: (u32, u32) = (1 << 14, 8);

/// How vertices are written; the grid is as fine at most.
const VERTEX: Rounding = Rounding::Bits(15);

/// A surface of triangles. Vertices that share a cell of a grid are one, the mean of them, and triangles that lose an
/// edge by that are left out (Rossignac and Borrel 1993); the grid is the finest, down to a 16 000th of the mesh's
/// longest edge, that leaves 20 000 triangles or fewer.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    vertices: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// The surface with these vertices, in the mesh's own unit, and triangles of their indices; a triangle with a
    /// vertex that is not there or not finite is left out. `None` if no triangle is left.
    #[must_use]
    pub fn new(vertices: &[[f32; 3]], triangles: &[[u32; 3]]) -> Option<Self> {
        let is_good = |k: &u32| vertices.get(*k as usize).is_some_and(|v| v.iter().all(|x| x.is_finite()));
        let good: Vec<[u32; 3]> = triangles.iter().filter(|all| all.iter().all(is_good)).copied().collect();
        let used = || good.iter().flatten().map(|&k| vertices[k as usize].map(f64::from));
        let corner = |of: fn(f64, f64) -> f64, from: f64| {
            used().fold([from; 3], |all, v| std::array::from_fn(|k| of(all[k], v[k])))
        };
        let (least, most) = (corner(f64::min, f64::INFINITY), corner(f64::max, f64::NEG_INFINITY));
        let edge = (0..3).map(|k| most[k] - least[k]).fold(0.0, f64::max);
        let mut cells = CELLS.0;
        loop {
            let mesh = Self::on_grid(vertices, &good, least, edge / f64::from(cells));
            if mesh.triangles.len() <= MOST_TRIANGLES || cells == CELLS.1 {
                return Some(mesh).filter(|mesh| !mesh.triangles.is_empty());
            }
            cells /= 2;
        }
    }

    fn on_grid(vertices: &[[f32; 3]], triangles: &[[u32; 3]], origin: [f64; 3], cell: f64) -> Self {
        let mut known: HashMap<[i64; 3], u32> = HashMap::new();
        let mut sums: Vec<([f64; 3], f64)> = Vec::new();
        let mut vertex = |k: u32| {
            let at = vertices[k as usize].map(f64::from);
            #[expect(clippy::cast_possible_truncation, reason = "at most 2¹⁴, or 0 of a mesh without extent")]
            let key = std::array::from_fn(|k| ((at[k] - origin[k]) / cell).round() as i64);
            let next = u32::try_from(sums.len()).unwrap_or(u32::MAX);
            let index = *known.entry(key).or_insert(next);
            if index == next {
                sums.push(([0.0; 3], 0.0));
            }
            let (sum, count) = &mut sums[index as usize];
            *sum = std::array::from_fn(|k| sum[k] + at[k]);
            *count += 1.0;
            index
        };
        let cornered = triangles.iter().map(|all| all.map(&mut vertex));
        let triangles = cornered.filter(|[a, b, c]| a != b && b != c && c != a).collect();
        let vertices = sums.iter().map(|(sum, count)| sum.map(|x| x / count)).collect();
        Self { vertices, triangles }
    }
}

/// How a mesh is read back.
#[derive(Serialize)]
pub(crate) struct MeshHead {
    /// Numbers of vertices and of triangles.
    n: [usize; 2],
    /// x, y and z of all vertices.
    vertices: Vec<Channel>,
    /// Vertices of the triangles, one triangle after the other.
    triangles: Channel,
}

pub(crate) fn head(mesh: &Mesh, bytes: &mut Vec<u8>) -> MeshHead {
    let along = |k: usize| mesh.vertices.iter().map(|v| v[k]).collect::<Vec<f64>>();
    let vertices = (0..3).map(|k| pack(&along(k), VERTEX, bytes)).collect();
    let corners: Vec<f64> = mesh.triangles.iter().flatten().map(|&k| f64::from(k)).collect();
    let triangles = pack(&corners, Rounding::Whole, bytes);
    MeshHead { n: [mesh.vertices.len(), mesh.triangles.len()], vertices, triangles }
}

#[cfg(test)]
mod tests;
