//! The classical fourth-order method (Kutta 1901; Hairer, Nørsett and Wanner, *Solving ODEs I*, table II.1.2), with
//! dense output of order 3 by Hermite's cubic.

use super::{Method, Work, combine, rate};
use crate::{Ode, Scalar, System};

/// Work space of the method.
#[derive(Clone, Debug)]
pub struct Kutta4<S> {
    k: [S; 4],
    /// The arguments of the second and the third slope, which belong to the same time.
    stages: [S; 2],
    end: S,
    /// Coefficients of 1, θ, θ², θ³ of the interpolant.
    dense: [S; 4],
}

impl<S: Clone> Kutta4<S> {
    /// Work space for states like this one.
    pub fn new(y: &S) -> Self {
        let copies = |_| y.clone();
        Self {
            k: core::array::from_fn(copies),
            stages: core::array::from_fn(copies),
            end: y.clone(),
            dense: core::array::from_fn(copies),
        }
    }
}

impl<D: Ode<M>, M> Method<D, M> for Kutta4<D::State> {
    const ORDER: u32 = 4;
    const STABILITY: f64 = 2.785;

    #[rustfmt::skip]
    fn attempt(&mut self, system: System<'_, D, M>, t: D::Scalar, h: D::Scalar, y: &D::State, resumes: bool, work: &mut Work) {
        let half = t + h * D::Scalar::constant(0.5);
        let (k, [second, third]) = (&mut self.k, &mut self.stages);
        if !resumes {
            system.derivative(t, y, &mut k[0]);
        }
        work.evaluations += 3 + u64::from(!resumes);
        combine(second, y, h, [(0.5, &k[0])]);
        system.derivative(half, second, &mut k[1]);
        combine(third, y, h, [(0.5, &k[1])]);
        system.derivative(half, third, &mut k[2]);
        combine(&mut self.end, y, h, [(1.0, &k[2])]);
        system.derivative(t + h, &self.end, &mut k[3]);
        combine(&mut self.end, y, h, [
            (1.0 / 6.0, &k[0]), (1.0 / 3.0, &k[1]), (1.0 / 3.0, &k[2]), (1.0 / 6.0, &k[3]),
        ]);
        system.normalise(&mut self.end);
    }

    fn end(&self) -> &D::State {
        &self.end
    }

    fn carry(&mut self) -> bool {
        false
    }

    fn prepare(
        &mut self,
        system: System<'_, D, M>,
        t: D::Scalar,
        h: D::Scalar,
        y: &D::State,
        work: &mut Work,
    ) {
        let [constant, linear, square, cube] = &mut self.dense;
        // The cube's place is free until the slope at the end has been used.
        system.derivative(t + h, &self.end, cube);
        work.evaluations += 1;
        constant.as_mut().copy_from_slice(y.as_ref());
        for (i, y) in y.as_ref().iter().enumerate() {
            let change = self.end.as_ref()[i] - *y;
            let (from, to) = (h * self.k[0].as_ref()[i], h * cube.as_ref()[i]);
            let (left, right) = (change - from, to - change);
            linear.as_mut()[i] = from;
            square.as_mut()[i] = left + left - right;
            cube.as_mut()[i] = right - left;
        }
    }

    fn between(&self, theta: D::Scalar, out: &mut D::State) {
        let [constant, linear, square, cube] = self.dense.each_ref().map(|part| part.as_ref());
        for (i, out) in out.as_mut().iter_mut().enumerate() {
            let inner = D::Scalar::fused(theta, cube[i], square[i]);
            *out = D::Scalar::fused(theta, D::Scalar::fused(theta, inner, linear[i]), constant[i]);
        }
    }

    fn rate(&self) -> [D::Scalar; 2] {
        rate([&self.k[2], &self.k[1]], [&self.stages[1], &self.stages[0]])
    }
}
