//! A model lowered to expressions: poses, joint frames, masses. Fixed bodies are constants, the others symbols.

use crate::derive::frames::{End, JointFrames, sine_and_cosine};
use crate::derive::in_time::in_time;
use crate::effort::Effort;
use crate::expr::definitions::{Definitions, Expansion, Values};
use crate::expr::differentiate::Direction;
use crate::expr::domains::Domains;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::symbol::Symbol;
use crate::expr::vector::{Mat3, UNIT3, Vec3, Vec4, ZERO3};
use gyro_model::{Attachment, Computation, JointCoordinate, JointEnd, Model, Number, RowOwner, Spline, Tree};
use std::array::from_fn;

/// Where a body is and how it moves.
#[derive(Clone, Copy, Debug)]
pub struct Pose {
    pub r: Vec3,
    pub p: Vec4,
    /// A(p): entries are symbols that [`System::definitions`] defines.
    pub a: Mat3,
    pub s: Vec3,
    pub w: Vec3,
}

/// The model with its graph.
#[derive(Clone, Debug)]
pub struct System<'m> {
    pub model: &'m Model,
    pub effort: Effort,
    /// In whose joint coordinates the mechanism is described, too.
    pub tree: Tree,
    pub graph: Graph,
    pub definitions: Definitions,
    /// Bodies with coordinates: moving body to index into the model's bodies.
    pub moving_bodies: Vec<usize>,
    /// One for each body of the model.
    pub poses: Vec<Pose>,
    /// One for each joint of the model.
    pub joints: Vec<JointFrames>,
    /// Tables of prescribed motions.
    pub tables: Vec<&'m Spline>,
    /// The angles that something acts on.
    turns: Vec<JointCoordinate>,
}

impl<'m> System<'m> {
    #[cfg(test)]
    pub fn new(model: &'m Model) -> Self {
        Self::with_effort(model, Effort::Full)
    }

    pub fn with_effort(model: &'m Model, effort: Effort) -> Self {
        let (moving_bodies, tree) = (model.coordinate_bodies(), Tree::of_coordinates(model));
        let mut system = Self {
            model,
            effort,
            tree,
            graph: Graph::new(),
            definitions: Definitions::default(),
            moving_bodies,
            poses: Vec::new(),
            joints: Vec::new(),
            tables: Vec::new(),
            turns: model.turn_references(),
        };
        for curve in model.curves_of_equations() {
            system.table(&model.curves[curve].spline);
        }
        let curves = system.tables.iter().map(|&table| table.clone()).collect();
        system.graph.domains = Domains::of(model);
        system.graph.domains.curves = curves;
        system.poses = (0..model.bodies.len()).map(|body| system.pose(body)).collect();
        system.joints = (0..model.joints.len()).map(|joint| system.joint_frames(joint)).collect();
        system.define_angles();
        system
    }

    /// The place of an angle among `Model::turn_references`.
    pub fn turn_of(&self, angle: JointCoordinate) -> usize {
        self.turns.iter().position(|&known| known == angle).expect("acting on an angle gives it a reference")
    }

    /// Each continuous angle: its reference and the principal angle that is left once the frame is turned back by it.
    fn define_angles(&mut self) {
        for (turn, angle) in self.turns.clone().into_iter().enumerate() {
            let (joint, kind) = (self.joints[angle.joint], self.model.coordinate_kind(angle));
            let graph = &mut self.graph;
            let (sine, cosine) = sine_and_cosine(graph, kind, &joint, &joint.relative);
            let reference = graph.symbol(Symbol::Turn(turn));
            let angle = graph.continued(reference, sine, cosine);
            self.definitions.insert_angle(turn, angle, (sine, cosine));
        }
    }

    pub fn moving_body_of(&self, body: usize) -> Option<usize> {
        self.moving_bodies.iter().position(|&b| b == body)
    }

    /// A number of the model file.
    pub fn number(&mut self, number: &Number) -> ExprId {
        match number {
            Number::Exact(value) => self.graph.rational(value.clone()),
            Number::Parameter { index, negated } => {
                let symbol = self.graph.symbol(Symbol::Parameter(*index));
                if *negated { self.graph.neg(symbol) } else { symbol }
            }
            Number::Input { index, negated } => {
                let symbol = self.graph.symbol(Symbol::Input(*index));
                if *negated { self.graph.neg(symbol) } else { symbol }
            }
            Number::Computed(computation) => self.computed(computation),
            Number::Formula(_) => unreachable!("formulas are strengths, which `laws` reads"),
        }
    }

    fn computed(&mut self, computation: &Computation) -> ExprId {
        match computation {
            Computation::Sum(a, b) => {
                let (a, b) = (self.number(a), self.number(b));
                self.graph.add(a, b)
            }
            Computation::Product(a, b) => {
                let (a, b) = (self.number(a), self.number(b));
                self.graph.mul(a, b)
            }
            Computation::Quotient(a, b) => {
                let (a, b) = (self.number(a), self.number(b));
                self.graph.div(a, b)
            }
            Computation::Power(base, exponent) => {
                let base = self.number(base);
                self.power(base, *exponent)
            }
        }
    }

    /// A power by repeated squaring.
    pub fn power(&mut self, base: ExprId, exponent: u32) -> ExprId {
        match exponent {
            0 => self.graph.integer(1),
            1 => base,
            _ => {
                let half = self.power(base, exponent / 2);
                let even = self.graph.mul(half, half);
                if exponent.is_multiple_of(2) { even } else { self.graph.mul(even, base) }
            }
        }
    }

    pub fn numbers<const N: usize>(&mut self, numbers: &[Number; N]) -> [ExprId; N] {
        from_fn(|k| self.number(&numbers[k]))
    }

    pub fn mass(&mut self, moving_body: usize) -> ExprId {
        self.number(&self.model.bodies[self.moving_bodies[moving_body]].mass)
    }

    /// J' of a body.
    pub fn inertia(&mut self, moving_body: usize) -> Mat3 {
        let [xx, yy, zz, xy, xz, yz] =
            self.numbers(&self.model.bodies[self.moving_bodies[moving_body]].inertia);
        [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
    }

    fn pose(&mut self, body: usize) -> Pose {
        match (self.moving_body_of(body), &self.model.bodies[body].motion) {
            (Some(moving_body), _) => self.moving_pose(moving_body),
            (None, Some(motion)) => self.driven_pose(body, motion),
            (None, None) => self.fixed_pose(body),
        }
    }

    fn moving_pose(&mut self, moving_body: usize) -> Pose {
        let graph = &mut self.graph;
        let p = from_fn(|k| graph.symbol(Symbol::Euler { moving_body, k }));
        let rotation = graph.rotation(&p);
        let a = from_fn(|row| {
            from_fn(|column| {
                let symbol = Symbol::Rotation { moving_body, row, column };
                self.definitions.insert(symbol, rotation[row][column]);
                graph.symbol(symbol)
            })
        });
        Pose {
            r: from_fn(|k| graph.symbol(Symbol::Position { moving_body, k })),
            p,
            a,
            s: from_fn(|k| graph.symbol(Symbol::Velocity { moving_body, k })),
            w: from_fn(|k| graph.symbol(Symbol::Spin { moving_body, k })),
        }
    }

    /// The given pose of a body: of a fixed one, or where a constrained one is held.
    pub fn fixed_pose(&mut self, body: usize) -> Pose {
        let r = self.numbers(&self.model.bodies[body].position);
        let p = self.numbers(&self.model.bodies[body].orientation);
        let p = self.graph.normalise(&p);
        let a = self.graph.rotation(&p);
        Pose { r, p, a, s: ZERO3, w: ZERO3 }
    }

    fn joint_frames(&mut self, joint: usize) -> JointFrames {
        let description = &self.model.joints[joint];
        let (first, second) = (self.end(&description.first), self.end(&description.second));
        let relative = self.relative_rotation(joint, first.body, second.body);
        let [lead, length] = [&description.lead, &description.length].map(|number| self.number(number));
        JointFrames { kind: description.kind, first, second, relative, lead, length }
    }

    /// A_iᵀ A_j, eq. (4). For a body without coordinates it follows from the other matrix alone.
    fn relative_rotation(&mut self, joint: usize, first: usize, second: usize) -> Mat3 {
        let (a_i, a_j) = (self.poses[first].a, self.poses[second].a);
        let both_move = self.moving_body_of(first).is_some() && self.moving_body_of(second).is_some();
        from_fn(|row| {
            from_fn(|column| {
                let (left, right) = (from_fn::<_, 3, _>(|k| a_i[k][row]), from_fn(|k| a_j[k][column]));
                let product = self.graph.dot(&left, &right);
                if !both_move {
                    return product;
                }
                let symbol = Symbol::Relative { joint, row, column };
                self.definitions.insert(symbol, product);
                self.graph.symbol(symbol)
            })
        })
    }

    fn end(&mut self, end: &JointEnd) -> End {
        let (axis, zero) = (self.numbers(&end.axis), self.numbers(&end.zero));
        let point = self.numbers(&end.point);
        let graph = &mut self.graph;
        // g ∥ h × z and f ∥ g × h, in products of the model file's own numbers: of these, those that cancel are written
        // alike, so a component that is zero whatever the parameters are is seen to be zero.
        let normal = graph.cross(&axis, &zero);
        let across = graph.cross(&normal, &axis);
        let (f, h) = (graph.normalise(&across), graph.normalise(&axis));
        // As long as f is before it is normalised, but for the axis: no third root.
        let [length, stretched] = [&axis, &across].map(|v| {
            let square = graph.dot(v, v);
            graph.sqrt(square)
        });
        let ratio = graph.div(length, stretched);
        let g = graph.scale_vec(ratio, &normal);
        End { body: end.body, point, f, g, h }
    }

    /// What the symbols change by along a motion with the given velocities of each moving body, paper eqs. (14) and
    /// (16): `ṙ = s`, `ṗ = ½ Gᵀ w'`, `Ȧ = A w̃'` and, between bodies, `(A_iᵀA_j)˙ = A_iᵀA_j w̃'_j − w̃'_i A_iᵀA_j`.
    pub fn direction(&mut self, motion: &[(Vec3, Vec3)]) -> Direction {
        self.direction_of(motion, 0..self.moving_bodies.len(), 0..self.joints.len())
    }

    /// No motion but a unit velocity or virtual rotation: column `k` of moving body `moving_body`, of (r, π'). What
    /// does not change with it is not named.
    pub fn unit_direction(&mut self, moving_body: usize, k: usize) -> Direction {
        let mut motion = vec![(ZERO3, ZERO3); self.moving_bodies.len()];
        motion[moving_body] = if k < 3 { (UNIT3[k], ZERO3) } else { (ZERO3, UNIT3[k - 3]) };
        let body = self.moving_bodies[moving_body];
        let is_on_it = |joint: &usize| {
            let joint = &self.joints[*joint];
            joint.first.body == body || joint.second.body == body
        };
        let joints: Vec<_> = (0..self.joints.len()).filter(is_on_it).collect();
        self.direction_of(&motion, [moving_body], joints)
    }

    /// What the symbols of some moving bodies and joints change by.
    fn direction_of(
        &mut self,
        motion: &[(Vec3, Vec3)],
        moving_bodies: impl IntoIterator<Item = usize>,
        joints: impl IntoIterator<Item = usize>,
    ) -> Direction {
        let mut direction = Direction::new();
        for moving_body in moving_bodies {
            let (s, w) = &motion[moving_body];
            let pose = self.poses[self.moving_bodies[moving_body]];
            let p_rate = self.graph.euler_rate(&pose.p, w);
            let tilde = self.graph.tilde(w);
            let a_rate = self.graph.mat_mul(&pose.a, &tilde);
            direction.extend((0..3).map(|k| (Symbol::Position { moving_body, k }, s[k])));
            direction.extend((0..4).map(|k| (Symbol::Euler { moving_body, k }, p_rate[k])));
            direction.extend(entries(&a_rate, |row, column| Symbol::Rotation { moving_body, row, column }));
        }
        for joint in joints {
            let (tilde_i, tilde_j) = self.joint_tildes(joint, motion);
            let relative = self.joints[joint].relative;
            let (turned, carried) =
                (self.graph.mat_mul(&relative, &tilde_j), self.graph.mat_mul(&tilde_i, &relative));
            let rate = self.graph.sub_mat(&turned, &carried);
            direction.extend(entries(&rate, |row, column| Symbol::Relative { joint, row, column }));
        }
        direction
    }

    /// The direction of the motion itself, twice differentiable: rates of rotation matrices are symbols that have rules
    /// of their own, `Ä = A w̃'w̃'` and `(A_iᵀA_j)¨ = A_iᵀA_j w̃'_jw̃'_j − 2 w̃'_i A_iᵀA_j w̃'_j + w̃'_iw̃'_i A_iᵀA_j`
    /// (terms in ẇ' left out). That is the product rule; only the order of the products is chosen, so that w̃'w̃' is
    /// shared.
    pub fn motion(&mut self) -> Direction {
        let motion = self.velocities();
        let first = self.direction(&motion);
        let mut direction = in_time(&mut self.graph, self.model);
        for (symbol, derivative) in first {
            let rate = match symbol {
                Symbol::Rotation { moving_body, row, column } => {
                    Symbol::RotationRate { moving_body, row, column }
                }
                Symbol::Relative { joint, row, column } => Symbol::RelativeRate { joint, row, column },
                _ => {
                    direction.insert(symbol, derivative);
                    continue;
                }
            };
            self.definitions.insert(rate, derivative);
            direction.insert(symbol, self.graph.symbol(rate));
        }
        for (moving_body, (_, w)) in motion.iter().enumerate() {
            let tilde = self.graph.tilde(w);
            let square = self.graph.mat_mul(&tilde, &tilde);
            let second = self.graph.mat_mul(&self.poses[self.moving_bodies[moving_body]].a, &square);
            direction.extend(entries(&second, |row, column| Symbol::RotationRate {
                moving_body,
                row,
                column,
            }));
        }
        for joint in 0..self.joints.len() {
            let second = self.relative_second_rate(joint, &motion);
            direction.extend(entries(&second, |row, column| Symbol::RelativeRate { joint, row, column }));
        }
        direction
    }

    fn relative_second_rate(&mut self, joint: usize, motion: &[(Vec3, Vec3)]) -> Mat3 {
        let (tilde_i, tilde_j) = self.joint_tildes(joint, motion);
        let relative = self.joints[joint].relative;
        let graph = &mut self.graph;
        let (square_i, square_j) = (graph.mat_mul(&tilde_i, &tilde_i), graph.mat_mul(&tilde_j, &tilde_j));
        let turned = graph.mat_mul(&relative, &tilde_j);
        let (both, two) = (graph.mat_mul(&tilde_i, &turned), graph.integer(2));
        let both = both.map(|row| graph.scale_vec(two, &row));
        let (of_j, of_i) = (graph.mat_mul(&relative, &square_j), graph.mat_mul(&square_i, &relative));
        let difference = graph.sub_mat(&of_j, &both);
        [0, 1, 2].map(|row| graph.add_vec(&difference[row], &of_i[row]))
    }

    /// w̃' of a joint's first and second body.
    fn joint_tildes(&mut self, joint: usize, motion: &[(Vec3, Vec3)]) -> (Mat3, Mat3) {
        let (first, second) = (self.joints[joint].first.body, self.joints[joint].second.body);
        let spin = |body: usize| self.moving_body_of(body).map_or(ZERO3, |moving_body| motion[moving_body].1);
        let (w_i, w_j) = (spin(first), spin(second));
        (self.graph.tilde(&w_i), self.graph.tilde(&w_j))
    }

    /// The rows that close something, by their place among all rows.
    pub fn loop_closure_rows(&self) -> Vec<usize> {
        let carries = |joint: usize| {
            let carried = |attachment: &Attachment| matches!(attachment, Attachment::Joint { joint: j, .. } if *j == joint);
            self.tree.links.iter().any(|link| carried(&link.attachment))
        };
        let closes = |owner: RowOwner| match owner {
            RowOwner::Body(_) => false,
            RowOwner::Joint(joint) => !carries(joint),
            RowOwner::Coupler(_) | RowOwner::Driver(_) => true,
        };
        let rows = self.model.rows();
        (0..rows.len()).filter(|&row| closes(rows[row].owner)).collect()
    }

    /// Expressions in which some symbols have the given values and all others their definitions.
    pub fn expanded(&mut self, values: &Values, roots: &[ExprId]) -> Vec<ExprId> {
        Expansion::at(&self.definitions, values).all(&mut self.graph, roots)
    }

    /// The velocities (s, w') of each moving body.
    pub fn velocities(&self) -> Vec<(Vec3, Vec3)> {
        self.moving_bodies.iter().map(|&body| (self.poses[body].s, self.poses[body].w)).collect()
    }
}

/// The entries of a matrix with the symbols that they belong to.
fn entries(matrix: &Mat3, symbol: impl Fn(usize, usize) -> Symbol) -> impl Iterator<Item = (Symbol, ExprId)> {
    (0..9).map(move |k| (symbol(k / 3, k % 3), matrix[k / 3][k % 3]))
}
