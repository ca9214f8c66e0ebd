//! The pair of orders 5 and 4 of Ch. Tsitouras, *Runge–Kutta pairs of order 5(4) satisfying only the first column
//! simplifying assumption*, Computers & Mathematics with Applications 62 (2011), 770–775, with its interpolant of order
//! 4.

use super::{Embedded, Method, Work, combine, rate, root_mean_square, sum_at, take_over};
use crate::{Lanes, Ode, Real, Scalar, System};

/// Work space of the method.
#[derive(Clone, Debug)]
pub struct Tsit5<S> {
    k: [S; 7],
    /// The argument of the sixth slope.
    stage: S,
    end: S,
    /// Coefficients of θ, θ², θ³, θ⁴ of the interpolant, and where it starts.
    dense: [S; 5],
}

impl<S: Clone> Tsit5<S> {
    /// Work space for states like this one.
    pub fn new(y: &S) -> Self {
        let copies = |_| y.clone();
        Self {
            k: core::array::from_fn(copies),
            stage: y.clone(),
            end: y.clone(),
            dense: core::array::from_fn(copies),
        }
    }
}

impl<D: Ode<M>, M> Method<D, M> for Tsit5<D::State> {
    const ORDER: u32 = 5;
    const STABILITY: f64 = 3.5;
    const ERROR_ORDER: u32 = 5;

    #[rustfmt::skip]
    fn attempt(&mut self, system: System<'_, D, M>, t: D::Scalar, h: D::Scalar, y: &D::State, resumes: bool, work: &mut Work) {
        let at = |c: f64| t + D::Scalar::constant(c) * h;
        let (k, stage) = (&mut self.k, &mut self.stage);
        if !resumes {
            system.derivative(t, y, &mut k[0]);
        }
        work.evaluations += 6 + u64::from(!resumes);
        combine(stage, y, h, [(0.161, &k[0])]);
        system.derivative(at(0.161), stage, &mut k[1]);
        combine(stage, y, h, [(-0.008_480_655_492_356_989, &k[0]), (0.335_480_655_492_357, &k[1])]);
        system.derivative(at(0.327), stage, &mut k[2]);
        combine(stage, y, h, [
            (2.897_153_057_105_493_5, &k[0]), (-6.359_448_489_975_075, &k[1]), (4.362_295_432_869_581_5, &k[2]),
        ]);
        system.derivative(at(0.9), stage, &mut k[3]);
        combine(stage, y, h, [
            (5.325_864_828_439_257, &k[0]), (-11.748_883_564_062_828, &k[1]), (7.495_539_342_889_836_5, &k[2]),
            (-0.092_495_066_361_755_25, &k[3]),
        ]);
        system.derivative(at(0.980_025_540_904_509_7), stage, &mut k[4]);
        combine(stage, y, h, [
            (5.861_455_442_946_42, &k[0]), (-12.920_969_317_847_11, &k[1]), (8.159_367_898_576_159, &k[2]),
            (-0.071_584_973_281_401, &k[3]), (-0.028_269_050_394_068_383, &k[4]),
        ]);
        system.derivative(at(1.0), stage, &mut k[5]);
        combine(&mut self.end, y, h, [
            (0.096_460_766_818_065_23, &k[0]), (0.01, &k[1]), (0.479_889_650_414_499_6, &k[2]),
            (1.379_008_574_103_742, &k[3]), (-3.290_069_515_436_081, &k[4]), (2.324_710_524_099_774, &k[5]),
        ]);
        system.normalise(&mut self.end);
        system.derivative(at(1.0), &self.end, &mut k[6]);
    }

    fn end(&self) -> &D::State {
        &self.end
    }

    fn carry(&mut self) -> bool {
        self.k.swap(0, 6);
        true
    }

    #[rustfmt::skip]
    fn prepare(&mut self, _: System<'_, D, M>, _: D::Scalar, h: D::Scalar, y: &D::State, _: &mut Work) {
        let k = &self.k;
        let [start, first, second, third, fourth] = &mut self.dense;
        start.as_mut().copy_from_slice(y.as_ref());
        for i in 0..y.as_ref().len() {
            first.as_mut()[i] = h * k[0].as_ref()[i];
            second.as_mut()[i] = h * sum_at([
                (-2.763_706_197_274_826, &k[0]), (0.131_7, &k[1]), (3.930_296_236_894_751_6, &k[2]),
                (-12.411_077_166_933_676, &k[3]), (37.509_313_416_511_04, &k[4]), (-27.896_526_289_197_286, &k[5]),
                (1.5, &k[6]),
            ], i);
            third.as_mut()[i] = h * sum_at([
                (2.913_255_461_821_912_6, &k[0]), (-0.223_4, &k[1]), (-5.941_033_872_131_505, &k[2]),
                (30.338_188_630_282_32, &k[3]), (-88.178_904_894_766_4, &k[4]), (65.091_894_674_793_66, &k[5]),
                (-4.0, &k[6]),
            ], i);
            fourth.as_mut()[i] = h * sum_at([
                (-1.053_088_497_729_021_6, &k[0]), (0.101_7, &k[1]), (2.490_627_285_651_253, &k[2]),
                (-16.548_102_889_244_902, &k[3]), (47.379_521_962_819_28, &k[4]), (-34.870_657_861_496_61, &k[5]),
                (2.5, &k[6]),
            ], i);
        }
    }

    fn between(&self, theta: D::Scalar, out: &mut D::State) {
        let [start, first, second, third, fourth] = self.dense.each_ref().map(|part| part.as_ref());
        for (i, out) in out.as_mut().iter_mut().enumerate() {
            let inner = D::Scalar::fused(theta, fourth[i], third[i]);
            let inner = D::Scalar::fused(theta, inner, second[i]);
            *out = D::Scalar::fused(theta, D::Scalar::fused(theta, inner, first[i]), start[i]);
        }
    }

    fn rate(&self) -> [D::Scalar; 2] {
        rate([&self.k[6], &self.k[5]], [&self.end, &self.stage])
    }

    #[inline(always)]
    fn error(&self, h: D::Scalar, weights: &D::State) -> (D::Scalar, usize)
    where
        D::Scalar: Real,
    {
        <Self as Embedded<D, M>>::size(h, weights, |i| Embedded::<D, M>::estimates(self, h, i))
    }
}

impl<D: Ode<M>, M> Embedded<D, M> for Tsit5<D::State> {
    #[rustfmt::skip]
    #[inline(always)]
    fn estimates(&self, h: D::Scalar, i: usize) -> [D::Scalar; 2] {
        let k = &self.k;
        let error = h * sum_at([
            (-0.001_780_011_052_225_771_4, &k[0]), (-0.000_816_434_459_656_746_9, &k[1]), (0.007_880_878_010_261_995, &k[2]),
            (-0.144_711_007_173_262_9, &k[3]), (0.582_357_165_452_555_2, &k[4]), (-0.458_082_105_929_186_95, &k[5]),
            (1.0 / 66.0, &k[6]),
        ], i);
        [error, D::Scalar::constant(0.0)]
    }

    #[inline(always)]
    fn size(
        _: D::Scalar,
        weights: &D::State,
        estimates: impl Fn(usize) -> [D::Scalar; 2],
    ) -> (D::Scalar, usize)
    where
        D::Scalar: Real,
    {
        root_mean_square(weights, |i| estimates(i)[0])
    }

    fn renew(
        &mut self,
        system: System<'_, D, M>,
        t: D::Scalar,
        y: &D::State,
        carried: <D::Scalar as Lanes>::Mask,
        begun: Option<<D::Scalar as Lanes>::Mask>,
    ) where
        D::Scalar: Lanes,
    {
        let [first, second, .., last] = &mut self.k;
        take_over(carried, first, last);
        if let Some(begun) = begun {
            system.derivative(t, y, second);
            take_over(begun, first, second);
        }
    }
}
