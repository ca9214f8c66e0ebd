//! The method of order 8 of Dormand and Prince with error estimates of orders 5 and 3 and dense output of order 7, by
//! Hairer, Nørsett and Wanner, *Solving Ordinary Differential Equations I* (2nd ed. 1993), section II.5 and appendix;
//! coefficients as in their code DOP853.

use super::{Embedded, Method, Work, combine, rate, sum_at, take_over};
use crate::{Lanes, Ode, Real, Scalar, System};

/// Work space of the method.
#[derive(Clone, Debug)]
pub struct Dop853<S, T> {
    /// Twelve slopes of the step; the slope at its end and three more of the dense output.
    k: [S; 16],
    /// The argument of the twelfth slope.
    stage: S,
    end: S,
    /// The interpolant's start and coefficients.
    dense: [S; 8],
    /// Whether the first slope will be that of the last step's end.
    is_carried: bool,
    rate: [T; 2],
}

impl<S: Clone, T: Scalar> Dop853<S, T> {
    /// Work space for states like this one.
    pub fn new(y: &S) -> Self {
        let copies = |_| y.clone();
        Self {
            k: core::array::from_fn(copies),
            stage: y.clone(),
            end: y.clone(),
            dense: core::array::from_fn(copies),
            is_carried: false,
            rate: [T::constant(0.0); 2],
        }
    }
}

impl<D: Ode<M>, M> Method<D, M> for Dop853<D::State, D::Scalar> {
    const ORDER: u32 = 8;
    const STABILITY: f64 = 6.1;
    const ERROR_ORDER: u32 = 8;

    #[rustfmt::skip]
    fn attempt(&mut self, system: System<'_, D, M>, t: D::Scalar, h: D::Scalar, y: &D::State, resumes: bool, work: &mut Work) {
        let at = |c: f64| t + D::Scalar::constant(c) * h;
        let (k, stage) = (&mut self.k, &mut self.stage);
        if !resumes {
            system.derivative(t, y, &mut k[0]);
            if self.is_carried {
                // The twelfth slope of the last step belongs to the same time.
                self.rate = rate([&k[0], &k[11]], [y, stage]);
                self.is_carried = false;
            }
        }
        work.evaluations += 11 + u64::from(!resumes);
        combine(stage, y, h, [
            (0.052_600_151_958_767_73, &k[0]),
        ]);
        system.derivative(at(0.052_600_151_958_767_73), stage, &mut k[1]);
        combine(stage, y, h, [
            (0.019_725_056_984_537_9, &k[0]), (0.059_175_170_953_613_7, &k[1]),
        ]);
        system.derivative(at(0.078_900_227_938_151_6), stage, &mut k[2]);
        combine(stage, y, h, [
            (0.029_587_585_476_806_85, &k[0]), (0.088_762_756_430_420_54, &k[2]),
        ]);
        system.derivative(at(0.118_350_341_907_227_4), stage, &mut k[3]);
        combine(stage, y, h, [
            (0.241_365_134_159_266_7, &k[0]), (-0.884_549_479_328_286_1, &k[2]),
            (0.924_834_003_261_792, &k[3]),
        ]);
        system.derivative(at(0.281_649_658_092_772_6), stage, &mut k[4]);
        combine(stage, y, h, [
            (0.037_037_037_037_037_035, &k[0]), (0.170_828_608_729_473_86, &k[3]),
            (0.125_467_687_566_822_42, &k[4]),
        ]);
        system.derivative(at(0.333_333_333_333_333_3), stage, &mut k[5]);
        combine(stage, y, h, [
            (0.037_109_375, &k[0]), (0.170_252_211_019_544_05, &k[3]), (0.060_216_538_980_455_96, &k[4]),
            (-0.017_578_125, &k[5]),
        ]);
        system.derivative(at(0.25), stage, &mut k[6]);
        combine(stage, y, h, [
            (0.037_092_000_118_504_79, &k[0]), (0.170_383_925_712_239_98, &k[3]),
            (0.107_262_030_446_373_28, &k[4]), (-0.015_319_437_748_624_402, &k[5]),
            (0.008_273_789_163_814_023, &k[6]),
        ]);
        system.derivative(at(0.307_692_307_692_307_7), stage, &mut k[7]);
        combine(stage, y, h, [
            (0.624_110_958_716_075_7, &k[0]), (-3.360_892_629_446_941_4, &k[3]),
            (-0.868_219_346_841_726, &k[4]), (27.592_099_699_446_71, &k[5]),
            (20.154_067_550_477_894, &k[6]), (-43.489_884_181_069_96, &k[7]),
        ]);
        system.derivative(at(0.651_282_051_282_051_3), stage, &mut k[8]);
        combine(stage, y, h, [
            (0.477_662_536_438_264_34, &k[0]), (-2.488_114_619_971_667_7, &k[3]),
            (-0.590_290_826_836_843, &k[4]), (21.230_051_448_181_193, &k[5]),
            (15.279_233_632_882_423, &k[6]), (-33.288_210_968_984_86, &k[7]),
            (-0.020_331_201_708_508_627, &k[8]),
        ]);
        system.derivative(at(0.6), stage, &mut k[9]);
        combine(stage, y, h, [
            (-0.937_142_430_085_987_3, &k[0]), (5.186_372_428_844_064, &k[3]),
            (1.091_437_348_996_729_5, &k[4]), (-8.149_787_010_746_927, &k[5]),
            (-18.520_065_659_996_96, &k[6]), (22.739_487_099_350_505, &k[7]),
            (2.493_605_552_679_652_3, &k[8]), (-3.046_764_471_898_219_6, &k[9]),
        ]);
        system.derivative(at(0.857_142_857_142_857_1), stage, &mut k[10]);
        combine(stage, y, h, [
            (2.273_310_147_516_538, &k[0]), (-10.534_495_466_737_25, &k[3]),
            (-2.000_872_058_224_862_5, &k[4]), (-17.958_931_863_118_8, &k[5]),
            (27.948_884_529_419_96, &k[6]), (-2.858_998_277_135_023_5, &k[7]),
            (-8.872_856_933_530_63, &k[8]), (12.360_567_175_794_303, &k[9]),
            (0.643_392_746_015_763_6, &k[10]),
        ]);
        system.derivative(at(1.0), stage, &mut k[11]);
        combine(&mut self.end, y, h, [
            (0.054_293_734_116_568_765, &k[0]), (4.450_312_892_752_409, &k[5]),
            (1.891_517_899_314_500_3, &k[6]), (-5.801_203_960_010_585, &k[7]),
            (0.311_164_366_957_819_9, &k[8]), (-0.152_160_949_662_516_1, &k[9]),
            (0.201_365_400_804_030_34, &k[10]), (0.044_710_615_727_772_59, &k[11]),
        ]);
        system.normalise(&mut self.end);
    }

    fn end(&self) -> &D::State {
        &self.end
    }

    fn carry(&mut self) -> bool {
        self.is_carried = true;
        false
    }

    #[rustfmt::skip]
    fn prepare(&mut self, system: System<'_, D, M>, t: D::Scalar, h: D::Scalar, y: &D::State, work: &mut Work) {
        let at = |c: f64| t + D::Scalar::constant(c) * h;
        let [start, difference, left, right, fourth, fifth, sixth, seventh] = &mut self.dense;
        let (k, stage) = (&mut self.k, &mut *start);
        work.evaluations += 4;
        system.derivative(at(1.0), &self.end, &mut k[12]);
        combine(stage, y, h, [
            (0.056_167_502_283_047_954, &k[0]), (0.253_500_210_216_624_83, &k[6]),
            (-0.246_239_037_470_802_5, &k[7]), (-0.124_191_423_263_816_37, &k[8]),
            (0.153_291_798_278_765_68, &k[9]), (0.008_201_052_295_634_69, &k[10]),
            (0.007_567_897_660_545_699, &k[11]), (-0.008_298, &k[12]),
        ]);
        system.derivative(at(0.1), stage, &mut k[13]);
        combine(stage, y, h, [
            (0.031_834_648_163_502_14, &k[0]), (0.028_300_909_672_366_776, &k[5]),
            (0.053_541_988_307_438_566, &k[6]), (-0.054_923_748_571_390_99, &k[7]),
            (-0.000_108_347_328_697_249_32, &k[10]), (0.000_382_571_090_835_658_4, &k[11]),
            (-0.000_340_465_008_687_404_56, &k[12]), (0.141_312_443_674_632_5, &k[13]),
        ]);
        system.derivative(at(0.2), stage, &mut k[14]);
        combine(stage, y, h, [
            (-0.428_896_301_583_791_94, &k[0]), (-4.697_621_415_361_164, &k[5]),
            (7.683_421_196_062_599, &k[6]), (4.068_989_818_397_11, &k[7]), (0.356_727_187_455_281_1, &k[8]),
            (-0.001_399_024_165_159_014_5, &k[12]), (2.947_514_789_152_772_4, &k[13]),
            (-9.150_958_472_179_87, &k[14]),
        ]);
        system.derivative(at(0.777_777_777_777_777_8), stage, &mut k[15]);
        start.as_mut().copy_from_slice(y.as_ref());
        for (i, y) in y.as_ref().iter().enumerate() {
            let change = self.end.as_ref()[i] - *y;
            let (from, to) = (h * k[0].as_ref()[i], h * k[12].as_ref()[i]);
            difference.as_mut()[i] = change;
            left.as_mut()[i] = from - change;
            right.as_mut()[i] = change + change - (to + from);
            fourth.as_mut()[i] = h * sum_at([
                (-8.428_938_276_109_013, &k[0]), (0.566_714_953_519_377_7, &k[5]),
                (-3.068_949_945_949_891_7, &k[6]), (2.384_667_656_512_07, &k[7]),
                (2.117_034_582_445_028, &k[8]), (-0.871_391_583_777_973, &k[9]),
                (2.240_437_430_260_788_3, &k[10]), (0.631_578_778_769_468_8, &k[11]),
                (-0.088_990_336_451_333_31, &k[12]), (18.148_505_520_854_727, &k[13]),
                (-9.194_632_392_478_356, &k[14]), (-4.436_036_387_594_894, &k[15]),
            ], i);
            fifth.as_mut()[i] = h * sum_at([
                (10.427_508_642_579_134, &k[0]), (242.283_491_775_258_17, &k[5]),
                (165.200_451_717_270_28, &k[6]), (-374.546_754_722_690_2, &k[7]),
                (-22.113_666_853_125_306, &k[8]), (7.733_432_668_472_264, &k[9]),
                (-30.674_084_731_089_398, &k[10]), (-9.332_130_526_430_229, &k[11]),
                (15.697_238_121_770_845, &k[12]), (-31.139_403_219_565_178, &k[13]),
                (-9.352_924_358_844_48, &k[14]), (35.816_841_486_394_08, &k[15]),
            ], i);
            sixth.as_mut()[i] = h * sum_at([
                (19.985_053_242_002_433, &k[0]), (-387.037_308_749_351_8, &k[5]),
                (-189.178_138_195_167_58, &k[6]), (527.808_159_205_423_6, &k[7]),
                (-11.573_902_539_959_63, &k[8]), (6.881_232_694_696_3, &k[9]),
                (-1.000_605_096_691_083_8, &k[10]), (0.777_713_779_805_344_3, &k[11]),
                (-2.778_205_752_353_508, &k[12]), (-60.196_695_231_264_12, &k[13]),
                (84.320_405_506_677_16, &k[14]), (11.992_291_136_182_79, &k[15]),
            ], i);
            seventh.as_mut()[i] = h * sum_at([
                (-25.693_933_462_703_75, &k[0]), (-154.189_748_690_236_43, &k[5]),
                (-231.529_379_176_045_5, &k[6]), (357.639_117_910_614_1, &k[7]), (93.405_324_183_624_32, &k[8]),
                (-37.458_323_136_451_63, &k[9]), (104.099_649_508_962_3, &k[10]),
                (29.840_293_426_660_5, &k[11]), (-43.533_456_590_011_14, &k[12]),
                (96.324_553_959_188_28, &k[13]), (-39.177_261_675_615_44, &k[14]),
                (-149.726_836_257_985_64, &k[15]),
            ], i);
        }
    }

    /// Nested alternately in θ and 1 − θ.
    fn between(&self, theta: D::Scalar, out: &mut D::State) {
        let parts = self.dense.each_ref().map(|part| part.as_ref());
        let rest = D::Scalar::constant(1.0) - theta;
        for (i, out) in out.as_mut().iter_mut().enumerate() {
            let factors = [theta, rest, theta, rest, theta, rest, theta];
            let mut sum = parts[7][i];
            for (part, factor) in parts[..7].iter().zip(factors).rev() {
                sum = D::Scalar::fused(factor, sum, part[i]);
            }
            *out = sum;
        }
    }

    fn rate(&self) -> [D::Scalar; 2] {
        self.rate
    }

    fn error(&self, h: D::Scalar, weights: &D::State) -> (D::Scalar, usize)
    where
        D::Scalar: Real,
    {
        <Self as Embedded<D, M>>::size(h, weights, |i| Embedded::<D, M>::estimates(self, h, i))
    }
}

impl<D: Ode<M>, M> Embedded<D, M> for Dop853<D::State, D::Scalar> {
    #[rustfmt::skip]
    #[inline(always)]
    fn estimates(&self, _: D::Scalar, i: usize) -> [D::Scalar; 2] {
        let k = &self.k;
        let fifth = sum_at([
            (0.013_120_044_994_194_88, &k[0]), (-1.225_156_446_376_204_4, &k[5]),
            (-0.495_758_949_657_250_2, &k[6]), (1.664_377_182_454_986_4, &k[7]),
            (-0.350_328_848_749_973_66, &k[8]), (0.334_179_118_713_017_5, &k[9]),
            (0.081_923_206_485_115_71, &k[10]), (-0.022_355_307_863_886_294, &k[11]),
        ], i);
        let third = sum_at([
            (-0.189_800_754_072_407_62, &k[0]), (4.450_312_892_752_409, &k[5]),
            (1.891_517_899_314_500_3, &k[6]), (-5.801_203_960_010_585, &k[7]),
            (-0.422_682_321_323_791_97, &k[8]), (-0.152_160_949_662_516_1, &k[9]),
            (0.201_365_400_804_030_34, &k[10]), (0.022_651_792_198_360_825, &k[11]),
        ], i);
        [fifth, third]
    }

    /// The estimates of orders 5 and 3 together, `h e₅² / √(e₅² + e₃²/100)`: asymptotically of order 8.
    #[inline(always)]
    fn size(
        h: D::Scalar,
        weights: &D::State,
        estimates: impl Fn(usize) -> [D::Scalar; 2],
    ) -> (D::Scalar, usize)
    where
        D::Scalar: Real,
    {
        let zero = D::Scalar::constant(0.0);
        let (mut five, mut three, mut n, mut worst) = (zero, zero, 0.0, (zero, 0));
        for (i, weight) in weights.as_ref().iter().enumerate() {
            let [e5, e3] = estimates(i).map(|e| e / *weight);
            if !(e5.is_finite() && e3.is_finite()) {
                return (D::Scalar::constant(f64::INFINITY), i);
            }
            (five, three) = (D::Scalar::fused(e5, e5, five), D::Scalar::fused(e3, e3, three));
            n += 1.0;
            if e5.abs() > worst.0 {
                worst = (e5.abs(), i);
            }
        }
        let both = (five + three * D::Scalar::constant(0.01)) * D::Scalar::constant(n);
        let size = if both > zero { h * (five / both.sqrt()) } else { zero };
        (size, worst.1)
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
        let [first, second, ..] = &mut self.k;
        system.derivative(t, y, second);
        take_over(carried, first, second);
        if let Some(begun) = begun {
            take_over(begun, first, second);
            let zero = D::Scalar::constant(0.0);
            self.rate = self.rate.map(|rate| D::Scalar::select(begun, zero, rate));
        }
        // The twelfth slope of the last attempt belongs to the same time.
        let [slopes, states] = rate([&self.k[0], &self.k[11]], [y, &self.stage]);
        let [slopes_before, states_before] = self.rate;
        self.rate = [
            D::Scalar::select(carried, slopes, slopes_before),
            D::Scalar::select(carried, states, states_before),
        ];
    }
}
