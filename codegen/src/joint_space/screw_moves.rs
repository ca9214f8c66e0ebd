//! From one frame of a body to another, screw by screw: turns about coordinate axes and shifts of the origin (R.
//! Featherstone, *Rigid Body Dynamics Algorithms* (2008), appendix A; S. McMillan and D. Orin, *Efficient computation
//! of articulated-body inertias using successive axial screws*, IEEE Transactions on Robotics and Automation 11
//! (1995)). A symmetric matrix is turned about an axis in ten operations and not by two products of matrices.

use crate::expr::graph::{ExprId, Graph};
use crate::expr::spatial_vector::SpatialVector;
use crate::expr::vector::{Mat3, UNIT3, Vec3, transposed};

/// How a frame lies in the next one: vectors seen in the first become vectors seen in the second.
#[derive(Clone, Copy, Debug)]
pub enum Move {
    /// It is turned about this axis, which both have.
    Turn { axis: usize, sine: ExprId, cosine: ExprId },
    /// It is turned in some other way.
    Rotation(Mat3),
    /// Its origin is here.
    Shift(Vec3),
}

impl Move {
    /// A vector of the first frame in the second one.
    pub fn turned(&self, graph: &mut Graph, v: &Vec3) -> Vec3 {
        match self {
            Self::Turn { axis, sine, cosine } => turned(graph, *axis, (*sine, *cosine), v),
            Self::Rotation(rotation) => graph.mat_vec(rotation, v),
            Self::Shift(_) => *v,
        }
    }

    /// A vector of the second frame in the first one.
    pub fn turned_back(&self, graph: &mut Graph, v: &Vec3) -> Vec3 {
        match self {
            Self::Turn { axis, sine, cosine } => {
                let back = graph.neg(*sine);
                turned(graph, *axis, (back, *cosine), v)
            }
            Self::Rotation(rotation) => graph.transposed_vec(rotation, v),
            Self::Shift(_) => *v,
        }
    }

    /// `R m Rᵀ` of a symmetric matrix.
    pub fn turned_symmetric(&self, graph: &mut Graph, m: &Mat3) -> Mat3 {
        match self {
            Self::Turn { axis, sine, cosine } if *sine != Graph::ZERO && *cosine != Graph::ZERO => {
                turned_symmetric(graph, *axis, (*sine, *cosine), m)
            }
            Self::Shift(_) => *m,
            _ => symmetric(&self.turned_matrix(graph, m)),
        }
    }

    /// `R m Rᵀ` of any matrix.
    pub fn turned_matrix(&self, graph: &mut Graph, m: &Mat3) -> Mat3 {
        match self {
            Self::Turn { axis, sine, cosine } if *sine != Graph::ZERO && *cosine != Graph::ZERO => {
                turned_matrix(graph, *axis, (*sine, *cosine), m)
            }
            Self::Shift(_) => *m,
            _ => {
                let rotation = self.rotation(graph);
                let product = graph.mat_mul(&rotation, m);
                graph.mat_mul(&product, &transposed(&rotation))
            }
        }
    }

    fn rotation(&self, graph: &mut Graph) -> Mat3 {
        let columns = UNIT3.map(|unit| self.turned(graph, &unit));
        transposed(&columns)
    }

    /// A wrench at the first origin as one at the second.
    pub fn wrench(&self, graph: &mut Graph, wrench: &SpatialVector) -> SpatialVector {
        let SpatialVector { t, rho } = wrench;
        if let Self::Shift(arm) = self {
            let moment = graph.cross(arm, t);
            return SpatialVector { t: *t, rho: graph.add_vec(rho, &moment) };
        }
        SpatialVector { t: self.turned(graph, t), rho: self.turned(graph, rho) }
    }

    /// A twist at the second origin as one at the first.
    pub fn twist(&self, graph: &mut Graph, twist: &SpatialVector) -> SpatialVector {
        let SpatialVector { t, rho } = twist;
        if let Self::Shift(arm) = self {
            let turning = graph.cross(rho, arm);
            return SpatialVector { t: graph.add_vec(t, &turning), rho: *rho };
        }
        SpatialVector { t: self.turned_back(graph, t), rho: self.turned_back(graph, rho) }
    }
}

fn turned(graph: &mut Graph, axis: usize, (sine, cosine): (ExprId, ExprId), v: &Vec3) -> Vec3 {
    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut turned = *v;
    let (along, across) = (graph.mul(cosine, v[i]), graph.mul(sine, v[j]));
    turned[i] = graph.sub(along, across);
    let (along, across) = (graph.mul(sine, v[i]), graph.mul(cosine, v[j]));
    turned[j] = graph.add(along, across);
    turned
}

/// With `β = sin (m_ii − m_jj) + 2 cos m_ij`: `m_ii − sin β`, `m_jj + sin β` and `cos β − m_ij`.
fn turned_symmetric(graph: &mut Graph, axis: usize, (sine, cosine): (ExprId, ExprId), m: &Mat3) -> Mat3 {
    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
    let edge = turned(graph, axis, (sine, cosine), &m[axis]);
    let difference = graph.sub(m[i][i], m[j][j]);
    let two = graph.integer(2);
    let twice = graph.mul(two, cosine);
    let (even, odd) = (graph.mul(sine, difference), graph.mul(twice, m[i][j]));
    let both = graph.add(even, odd);
    let (moved, across) = (graph.mul(sine, both), graph.mul(cosine, both));
    let mut turned = *m;
    turned[i][i] = graph.sub(m[i][i], moved);
    turned[j][j] = graph.add(m[j][j], moved);
    turned[i][j] = graph.sub(across, m[i][j]);
    turned[j][i] = turned[i][j];
    for k in [i, j] {
        (turned[axis][k], turned[k][axis]) = (edge[k], edge[k]);
    }
    turned
}

/// With `β = sin (m_ii − m_jj) + cos (m_ij + m_ji)`: `m_ii − sin β`, `m_jj + sin β`, `cos β − m_ji`, `cos β − m_ij`.
fn turned_matrix(graph: &mut Graph, axis: usize, (sine, cosine): (ExprId, ExprId), m: &Mat3) -> Mat3 {
    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
    let row = turned(graph, axis, (sine, cosine), &m[axis]);
    let column = turned(graph, axis, (sine, cosine), &transposed(m)[axis]);
    let (difference, sum) = (graph.sub(m[i][i], m[j][j]), graph.add(m[i][j], m[j][i]));
    let (even, odd) = (graph.mul(sine, difference), graph.mul(cosine, sum));
    let both = graph.add(even, odd);
    let (moved, across) = (graph.mul(sine, both), graph.mul(cosine, both));
    let mut turned = *m;
    turned[i][i] = graph.sub(m[i][i], moved);
    turned[j][j] = graph.add(m[j][j], moved);
    turned[i][j] = graph.sub(across, m[j][i]);
    turned[j][i] = graph.sub(across, m[i][j]);
    for k in [i, j] {
        (turned[axis][k], turned[k][axis]) = (row[k], column[k]);
    }
    turned
}

/// The upper triangle mirrored: entries that are equal become one expression.
pub fn symmetric(m: &Mat3) -> Mat3 {
    std::array::from_fn(|row| std::array::from_fn(|column| m[row.min(column)][row.max(column)]))
}
