//! Motions prescribed in time, as expressions.

use crate::derive::in_time::in_time;
use crate::derive::laws::{self, OfBodies, Own};
use crate::derive::system::{Pose, System};
use crate::expr::definitions::Definitions;
use crate::expr::differentiate::Derivative;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::symbol::Symbol;
use crate::expr::vector::{Mat3, UNIT3, Vec3, Vec4, ZERO3};
use gyro_model::{BodyMotion, Lines, Motion, Spline};
use std::array::from_fn;

impl<'m> System<'m> {
    /// A function of time.
    pub fn prescribed(&mut self, motion: &'m Motion) -> ExprId {
        match motion {
            Motion::Polynomial(coefficients) => {
                let time = self.graph.symbol(Symbol::Time);
                let mut sum = Graph::ZERO;
                for coefficient in coefficients.iter().rev() {
                    let shifted = self.graph.mul(sum, time);
                    let coefficient = self.number(coefficient);
                    sum = self.graph.add(shifted, coefficient);
                }
                sum
            }
            Motion::Sinusoid { amplitude, angular_frequency, phase } => {
                let [amplitude, frequency, phase] =
                    [amplitude, angular_frequency, phase].map(|n| self.number(n));
                let time = self.graph.symbol(Symbol::Time);
                let turned = self.graph.mul(frequency, time);
                let argument = self.graph.add(turned, phase);
                let sine = self.graph.sin(argument);
                self.graph.mul(amplitude, sine)
            }
            Motion::Sum(parts) => {
                let parts: Vec<_> = parts.iter().map(|part| self.prescribed(part)).collect();
                parts.into_iter().fold(Graph::ZERO, |sum, part| self.graph.add(sum, part))
            }
            Motion::Product(parts) => {
                let parts: Vec<_> = parts.iter().map(|part| self.prescribed(part)).collect();
                parts.into_iter().fold(Graph::ONE, |product, part| self.graph.mul(product, part))
            }
            Motion::Table(spline) => {
                let table = self.table(spline);
                self.graph.symbol(Symbol::Table { table, order: 0 })
            }
            Motion::Lines(lines) => self.line(lines),
            Motion::Input([place, ..]) => self.graph.symbol(Symbol::Input(*place)),
            Motion::Formula(formula) => {
                laws::value(self, formula, |system, seen| laws::see(system, &OfBodies, Own::Nothing, seen))
            }
        }
    }

    /// `x + (t − t0) (v + ½ a (t − t0))`, all but the time inputs.
    fn line(&mut self, lines: &Lines) -> ExprId {
        let [from, place, rate, acceleration] =
            lines.inputs.map(|index| self.graph.symbol(Symbol::Input(index)));
        let (time, half) = (self.graph.symbol(Symbol::Time), self.graph.fraction(1, 2));
        let since = self.graph.sub(time, from);
        let bent = self.graph.mul(acceleration, since);
        let bent = self.graph.mul(half, bent);
        let mean_rate = self.graph.add(rate, bent);
        let way = self.graph.mul(since, mean_rate);
        self.graph.add(place, way)
    }

    /// The place of a table among all.
    pub fn table(&mut self, spline: &'m Spline) -> usize {
        if let Some(known) = self.tables.iter().position(|known| is_same(known, spline)) {
            return known;
        }
        self.tables.push(spline);
        self.tables.len() - 1
    }

    /// The pose and velocities of a body whose motion is prescribed: see [`BodyMotion`].
    pub fn driven_pose(&mut self, body: usize, motion: &'m BodyMotion) -> Pose {
        let start = self.fixed_pose(body);
        let translation = [0, 1, 2].map(|k| self.prescribed(&motion.translation[k]));
        let r = self.graph.add_vec(&start.r, &translation);
        let s = translation.map(|x| self.time_derivative(x));
        let (mut a, mut w) = (start.a, ZERO3);
        // Of the two signs the one nearer to the identity, as the assembly of the start takes it.
        let is_far = self.model.value(&self.model.bodies[body].orientation[0]) < 0.0;
        let mut p = if is_far { self.graph.neg_vec(&start.p) } else { start.p };
        for (axis, angle) in &motion.rotations {
            let axis = self.numbers(axis);
            let axis = self.graph.normalise(&axis);
            let angle = self.prescribed(angle);
            let rate = self.time_derivative(angle);
            let turn = rotation_about(&mut self.graph, &axis, angle);
            // w' of A R is Rᵀ w' of A, plus the rate about the axis.
            let (carried, own) = (self.graph.transposed_vec(&turn, &w), self.graph.scale_vec(rate, &axis));
            w = self.graph.add_vec(&carried, &own);
            a = self.graph.mat_mul(&a, &turn);
            p = turned(&mut self.graph, &p, &axis, angle);
        }
        Pose { r, p, a, s, w }
    }

    fn time_derivative(&mut self, expression: ExprId) -> ExprId {
        let time = in_time(&mut self.graph, self.model);
        Derivative::new(&Definitions::default(), time).of(&mut self.graph, expression)
    }
}

/// `cos I + (1 − cos) u uᵀ + sin ũ` (Rodrigues).
fn rotation_about(graph: &mut Graph, u: &Vec3, angle: ExprId) -> Mat3 {
    let (sin, cos) = (graph.sin(angle), graph.cos(angle));
    let tilde = graph.tilde(u);
    from_fn(|row| {
        from_fn(|column| {
            // u uᵀ + cos (I − u uᵀ): an axis of the frame leaves plain sines and cosines.
            let dyad = graph.mul(u[row], u[column]);
            let across = graph.sub(UNIT3[row][column], dyad);
            let (turning, skew) = (graph.mul(cos, across), graph.mul(sin, tilde[row][column]));
            let even = graph.add(dyad, turning);
            graph.add(even, skew)
        })
    })
}

/// `p ∘ (cos ½angle, u sin ½angle)`.
fn turned(graph: &mut Graph, p: &Vec4, u: &Vec3, angle: ExprId) -> Vec4 {
    let half = graph.fraction(1, 2);
    let half_angle = graph.mul(half, angle);
    let (sin, cos) = (graph.sin(half_angle), graph.cos(half_angle));
    let [x, y, z] = graph.scale_vec(sin, u);
    graph.compose(p, &[cos, x, y, z])
}

/// Whether two tables have the same numbers.
fn is_same(one: &Spline, other: &Spline) -> bool {
    (&one.knots, &one.pieces) == (&other.knots, &other.pieces)
}
