//! Rodas4: the L-stable, stiffly accurate Rosenbrock method of order 4 with an estimate of order 3 and dense output of
//! order 3, by Hairer and Wanner, *Solving Ordinary Differential Equations II* (2nd ed. 1996), section VI.4;
//! coefficients as in their code RODAS (method 1).
//!
//! Each step takes one Jacobian, one factorisation of `I/(γh) − ∂f/∂y` and six solves, and iterates nothing.

use super::{Method, Work, combine, lu, root_mean_square, sum_at};
use crate::contract::Storage;
use crate::{Jacobian, Real, Scalar, System};

/// Work space of the method.
#[derive(Clone, Debug)]
pub struct Rodas4<S, J> {
    jacobian: J,
    factors: J,
    pivots: S,
    /// ∂f/∂t.
    time_slope: S,
    /// f where the step starts.
    first: S,
    slope: S,
    stage: S,
    /// What the stages change; the last one is the error estimate.
    u: [S; 6],
    end: S,
    /// Where the interpolant starts, and its inner coefficients.
    dense: [S; 3],
}

/// The diagonal coefficient γ.
const GAMMA: f64 = 0.25;

impl<S: Clone, J> Rodas4<S, J> {
    /// Work space for states like this one, and for a Jacobian like this one: n × n numbers for a state of n.
    pub fn new(y: &S, jacobian: J) -> Self
    where
        J: Clone,
    {
        let copies = |_| y.clone();
        Self {
            factors: jacobian.clone(),
            jacobian,
            pivots: y.clone(),
            time_slope: y.clone(),
            first: y.clone(),
            slope: y.clone(),
            stage: y.clone(),
            u: core::array::from_fn(copies),
            end: y.clone(),
            dense: core::array::from_fn(copies),
        }
    }

    /// Factorises `I/(γh) − ∂f/∂y`.
    fn factorise<T: Real>(&mut self, h: T)
    where
        S: Storage<T>,
        J: Storage<T>,
    {
        let n = self.pivots.as_ref().len();
        let diagonal = T::constant(1.0) / (T::constant(GAMMA) * h);
        let factors = self.factors.as_mut();
        for (factor, element) in factors.iter_mut().zip(self.jacobian.as_ref()) {
            *factor = -*element;
        }
        for element in factors.iter_mut().step_by(n + 1) {
            *element = *element + diagonal;
        }
        lu::factorise(factors, self.pivots.as_mut());
    }
}

impl<D: Jacobian<M>, M> Method<D, M> for Rodas4<D::State, D::Matrix>
where
    D::Scalar: Real,
{
    const ORDER: u32 = 4;
    const STABILITY: f64 = f64::INFINITY;
    const ERROR_ORDER: u32 = 4;

    #[rustfmt::skip]
    fn attempt(&mut self, system: System<'_, D, M>, t: D::Scalar, h: D::Scalar, y: &D::State, resumes: bool, work: &mut Work) {
        if !resumes {
            system.jacobian(t, y, &mut self.jacobian, &mut self.time_slope);
            system.derivative(t, y, &mut self.first);
            work.jacobians += 1;
        }
        work.evaluations += 5 + u64::from(!resumes);
        self.factorise(h);
        let (factors, pivots, time_slope) = (self.factors.as_ref(), self.pivots.as_ref(), self.time_slope.as_ref());
        let (one, per_h) = (D::Scalar::constant(1.0), D::Scalar::constant(1.0) / h);
        let at = |c: f64| t + D::Scalar::constant(c) * h;
        let solve = |u: &mut D::State, d: f64| {
            if d != 0.0 {
                let weight = D::Scalar::constant(d) * h;
                for (u, slope) in u.as_mut().iter_mut().zip(time_slope) {
                    *u = D::Scalar::fused(weight, *slope, *u);
                }
            }
            lu::solve(factors, pivots, u.as_mut());
        };
        let [u1, u2, u3, u4, u5, u6] = &mut self.u;
        let (slope, stage) = (&mut self.slope, &mut self.stage);

        u1.as_mut().copy_from_slice(self.first.as_ref());
        solve(u1, 0.25);
        combine(stage, y, one, [(1.544, u1)]);
        system.derivative(at(0.386), stage, slope);
        combine(u2, slope, per_h, [(-5.668_8, u1)]);
        solve(u2, -0.104_3);
        combine(stage, y, one, [(0.946_678_528_081_582_6, u1), (0.255_701_169_898_328_4, u2)]);
        system.derivative(at(0.21), stage, slope);
        combine(u3, slope, per_h, [(-2.430_093_356_833_875, u1), (-0.206_359_915_709_191_5, u2)]);
        solve(u3, 0.103_5);
        combine(stage, y, one, [
            (3.314_825_187_068_521, u1), (2.896_124_015_972_201, u2), (0.998_641_913_997_781_7, u3),
        ]);
        system.derivative(at(0.63), stage, slope);
        combine(u4, slope, per_h, [
            (-0.107_352_905_815_137_5, u1), (-9.594_562_251_023_355, u2), (-20.470_286_148_096_16, u3),
        ]);
        solve(u4, -0.036_2);
        combine(stage, y, one, [
            (1.221_224_509_226_641, u1), (6.019_134_481_288_629, u2), (12.537_083_329_320_87, u3),
            (-0.687_886_036_105_895, u4),
        ]);
        system.derivative(at(1.0), stage, slope);
        combine(u5, slope, per_h, [
            (7.496_443_313_967_647, u1), (-10.246_804_314_643_52, u2), (-33.999_903_528_199_05, u3),
            (11.708_908_932_061_6, u4),
        ]);
        solve(u5, 0.0);
        for (stage, u5) in stage.as_mut().iter_mut().zip(u5.as_ref()) {
            *stage = *stage + *u5;
        }
        system.derivative(at(1.0), stage, slope);
        combine(u6, slope, per_h, [
            (8.083_246_795_921_522, u1), (-7.981_132_988_064_893, u2), (-31.521_594_328_743_71, u3),
            (16.319_305_431_231_36, u4), (-6.058_818_238_834_054, u5),
        ]);
        solve(u6, 0.0);
        combine(&mut self.end, stage, one, [(1.0, u6)]);
        system.normalise(&mut self.end);
    }

    fn end(&self) -> &D::State {
        &self.end
    }

    fn carry(&mut self) -> bool {
        false
    }

    #[rustfmt::skip]
    fn prepare(&mut self, _: System<'_, D, M>, _: D::Scalar, _: D::Scalar, y: &D::State, _: &mut Work) {
        let [u1, u2, u3, u4, u5, _] = &self.u;
        let [start, third, fourth] = &mut self.dense;
        start.as_mut().copy_from_slice(y.as_ref());
        for i in 0..y.as_ref().len() {
            third.as_mut()[i] = sum_at([
                (10.126_235_083_445_86, u1), (-7.487_995_877_610_167, u2), (-34.800_918_615_557_47, u3),
                (-7.992_771_707_568_823, u4), (1.025_137_723_295_662, u5),
            ], i);
            fourth.as_mut()[i] = sum_at([
                (-0.676_280_339_280_125_3, u1), (6.087_714_651_680_015, u2), (16.430_843_208_924_78, u3),
                (24.767_225_114_183_86, u4), (-6.594_389_125_716_872, u5),
            ], i);
        }
    }

    fn between(&self, theta: D::Scalar, out: &mut D::State) {
        let [start, third, fourth] = self.dense.each_ref().map(|part| part.as_ref());
        let (end, rest) = (self.end.as_ref(), D::Scalar::constant(1.0) - theta);
        for (i, out) in out.as_mut().iter_mut().enumerate() {
            let bend = D::Scalar::fused(theta, fourth[i], third[i]);
            *out = rest * start[i] + theta * D::Scalar::fused(rest, bend, end[i]);
        }
    }

    /// An L-stable method is not limited by fast rates and does not estimate them.
    fn rate(&self) -> [D::Scalar; 2] {
        [D::Scalar::constant(0.0); 2]
    }

    fn error(&self, _: D::Scalar, weights: &D::State) -> (D::Scalar, usize)
    where
        D::Scalar: Real,
    {
        let error = self.u[5].as_ref();
        root_mean_square(weights, |i| error[i])
    }
}
