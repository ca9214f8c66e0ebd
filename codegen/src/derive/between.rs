//! How one frame lies and moves, seen from another: [`gyro_model::Relative`], and the readings of bushings, see
//! [`gyro_model::Bushing`].

use crate::derive::joint_coordinate::Load;
use crate::derive::points;
use crate::derive::system::System;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::vector::{Mat3, Vec3, transposed};
use gyro_model::{BodyFrame, Bushing};

/// How the second of two frames lies and moves, seen from the first, by its axes.
pub struct Seen {
    /// From the first origin to the second.
    pub place: Vec3,
    /// The second frame's axes.
    pub turned: Mat3,
    pub velocity: Vec3,
    /// The angular velocity of the second body less that of the first.
    pub spin: Vec3,
    /// From the first body's mass centre to the second frame's origin, in the first body's frame.
    arm: Vec3,
    /// `A_iᵀ A_j` of the two bodies.
    relative: Mat3,
    /// The axes of the first frame in its body; `None` where they are the body's.
    axes: Option<Mat3>,
}

impl Seen {
    pub fn new(system: &mut System, [first, second]: [&BodyFrame; 2]) -> Self {
        let [own_first, own_second] = [first, second].map(|frame| points::axes(system, frame));
        let (i, j) = (system.poses[first.body], system.poses[second.body]);
        let relative = system.graph.mat_mul(&transposed(&i.a), &j.a);
        let turned = match &own_second {
            Some(axes) => system.graph.mat_mul(&relative, axes),
            None => relative,
        };
        let turned = match &own_first {
            Some(axes) => system.graph.mat_mul(&transposed(axes), &turned),
            None => turned,
        };
        let (arm, moved) = arm(system, first, second);
        let point = system.numbers(&first.point);
        let graph = &mut system.graph;
        let distance = graph.sub_vec(&arm, &point);
        let carried = graph.mat_vec(&relative, &j.w);
        let spin = graph.sub_vec(&carried, &i.w);
        let [place, velocity, spin] =
            [distance, moved, spin].map(|vector| into_frame(graph, own_first.as_ref(), &vector));
        Self { place, turned, velocity, spin, arm, relative, axes: own_first }
    }

    /// The numbers of [`gyro_model::Relative`].
    pub fn numbers(&self) -> Vec<ExprId> {
        let [x, y, z] = self.turned;
        [self.place, x, y, z, self.velocity, self.spin].concat()
    }
}

/// The second frame of a bushing as the first sees it.
pub struct Between {
    /// Components and Cardan angles.
    pub places: [ExprId; 6],
    pub rates: [ExprId; 6],
    /// Of each angle the vector whose product with the relative angular velocity is the angle's rate, by the axes of
    /// the first frame.
    torques: [Vec3; 3],
    pub seen: Seen,
}

impl Between {
    pub fn new(system: &mut System, bushing: &Bushing) -> Self {
        let seen = Seen::new(system, bushing.ends());
        let graph = &mut system.graph;
        let (angles, torques) = cardan_angles(graph, &seen.turned);
        let turning = torques.map(|torque| graph.dot(&torque, &seen.spin));
        Self { places: six(seen.place, angles), rates: six(seen.velocity, turning), torques, seen }
    }

    /// What forces along the readings, and a torque by the axes of the first frame, do to both bodies.
    pub fn loads(
        &self,
        system: &mut System,
        bushing: &Bushing,
        (forces, moment): (&[ExprId; 6], Vec3),
    ) -> [Load; 2] {
        let [first, second] = bushing.ends();
        let (a_i, point) = (system.poses[first.body].a, system.numbers(&second.point));
        let graph = &mut system.graph;
        let [x, y, z, about @ ..] = *forces;
        let torque = self.torques.iter().zip(about).fold(moment, |sum, (axis, strength)| {
            let part = graph.scale_vec(strength, axis);
            graph.add_vec(&sum, &part)
        });
        // Both in the first body's frame.
        let [force, torque] = [[x, y, z], torque].map(|vector| match &self.seen.axes {
            Some(axes) => graph.mat_vec(axes, &vector),
            None => vector,
        });
        let (moment, global) = (graph.cross(&self.seen.arm, &force), graph.mat_vec(&a_i, &force));
        let taken = graph.add_vec(&moment, &torque);
        let on_first = Load { force: graph.neg_vec(&global), torque: graph.neg_vec(&taken) };
        let [pushed, turned] =
            [force, torque].map(|vector| graph.transposed_vec(&self.seen.relative, &vector));
        let moment = graph.cross(&point, &pushed);
        [on_first, Load { force: global, torque: graph.add_vec(&moment, &turned) }]
    }
}

/// From the first body's mass centre to the origin of the second frame, in the first body's frame, and the velocity of
/// that origin seen from there.
fn arm(system: &mut System, first: &BodyFrame, second: &BodyFrame) -> (Vec3, Vec3) {
    let origin = points::PointOfBody::new(system, second.body, &second.point);
    let i = system.poses[first.body];
    let graph = &mut system.graph;
    let (line, drift) = (graph.sub_vec(&origin.position, &i.r), graph.sub_vec(&origin.velocity, &i.s));
    let [arm, drift] = [line, drift].map(|vector| graph.transposed_vec(&i.a, &vector));
    let carried = graph.cross(&i.w, &arm);
    (arm, graph.sub_vec(&drift, &carried))
}

fn into_frame(graph: &mut Graph, axes: Option<&Mat3>, vector: &Vec3) -> Vec3 {
    axes.map_or(*vector, |axes| graph.transposed_vec(axes, vector))
}

/// The angles a, b, c of `R = R_x(a) R_y(b) R_z(c)`, and the vectors whose products with the angular velocity are their
/// rates. With `q = R_yz² + R_zz² = cos² b` the last of them is `(0, R_yz, R_zz)/q`.
///
/// The tangent of half an angle is its sine over one more than its cosine. By that an angle that is zero throughout, as
/// two of them are where all moves about y, is never taken for half a turn.
fn cardan_angles(graph: &mut Graph, r: &Mat3) -> ([ExprId; 3], [Vec3; 3]) {
    let [[xx, xy, xz], [.., yz], [.., zz]] = *r;
    let square = graph.dot(&[yz, zz], &[yz, zz]);
    let cosine = graph.sqrt(square);
    let [minus_xy, minus_yz] = [xy, yz].map(|entry| graph.neg(entry));
    let about_x = twice_angle(graph, minus_yz, zz, cosine);
    let about_z = twice_angle(graph, minus_xy, xx, cosine);
    let angles = [about_x, graph.atan2(xz, cosine), about_z];
    let (inverse, steep) = (graph.recip(square), graph.recip(cosine));
    let about_z = graph.scale_vec(inverse, &[Graph::ZERO, yz, zz]);
    let about_y = graph.scale_vec(steep, &[Graph::ZERO, zz, minus_yz]);
    let lifted = graph.scale_vec(xz, &about_z);
    let about_x = graph.sub_vec(&[Graph::ONE, Graph::ZERO, Graph::ZERO], &lifted);
    (angles, [about_x, about_y, about_z])
}

/// The angle of the point (x, y) at this distance, by that of half the angle.
fn twice_angle(graph: &mut Graph, y: ExprId, x: ExprId, distance: ExprId) -> ExprId {
    let sum = graph.add(distance, x);
    let (tangent, two) = (graph.div(y, sum), graph.integer(2));
    let half = graph.atan2(tangent, Graph::ONE);
    graph.mul(two, half)
}

fn six([a, b, c]: Vec3, [d, e, f]: Vec3) -> [ExprId; 6] {
    [a, b, c, d, e, f]
}
