//! Which of the textbook's constraint primitives each kind of joint is made of.

use gyro_model::{JointKind, PointAxes};

/// A direction of a joint frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Axis {
    F,
    G,
    H,
    /// −g.
    MinusG,
}

/// A scalar of a joint; i is the first body, j the second, d from the first's joint point to the second's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Primitive {
    /// A global component of d: one of the three rows of coincident points, paper, eq. (7).
    Point(usize),
    /// `a_i·b_j`, paper, eqs. (9) and (10).
    Dot1(Axis, Axis),
    /// `a_i·d`.
    Dot2(Axis),
    /// `½ (d·d / l − l)` with the joint's length l.
    Distance,
}

impl Primitive {
    /// The primitive with which a row compares points along these axes; any other row stays what it is.
    pub(crate) fn along(self, axes: PointAxes) -> Self {
        match (self, axes) {
            (Self::Point(k), PointAxes::FirstBody) => Self::Dot2([Axis::F, Axis::G, Axis::H][k]),
            _ => self,
        }
    }
}

/// The rows of a kind of joint, in the order of [`gyro_model::Model::rows`]. To the displacement `h_i·d` of a screw
/// comes what its angle advances it by.
pub(crate) fn primitives(kind: JointKind) -> &'static [Primitive] {
    use Axis::{F, G, H};
    use Primitive::{Distance, Dot1, Dot2, Point};
    match kind {
        JointKind::Revolute => &[Point(0), Point(1), Point(2), Dot1(F, H), Dot1(G, H)],
        JointKind::Spherical => &[Point(0), Point(1), Point(2)],
        JointKind::Fixed => &[Point(0), Point(1), Point(2), Dot1(F, H), Dot1(G, H), Dot1(F, G)],
        JointKind::Universal => &[Point(0), Point(1), Point(2), Dot1(H, H)],
        JointKind::Cylindrical => &[Dot2(F), Dot2(G), Dot1(F, H), Dot1(G, H)],
        JointKind::Prismatic => &[Dot2(F), Dot2(G), Dot1(F, H), Dot1(G, H), Dot1(F, G)],
        JointKind::Planar => &[Dot2(H), Dot1(F, H), Dot1(G, H)],
        JointKind::Screw => &[Dot2(F), Dot2(G), Dot2(H), Dot1(F, H), Dot1(G, H)],
        JointKind::PointOnLine => &[Dot2(F), Dot2(G)],
        JointKind::Rod => &[Distance],
    }
}
