//! Formulas that an expansion makes cancel: what is generated rounds about as well as they do as they are written.
//!
//! An arm is turned, or a carriage moved, by a motion that is a formula of products, powers, sums that nearly vanish
//! and shifted angles; a load hangs on it by a hinge or a rail, with springs far from where they are slack. Its
//! acceleration is known in closed form, and this is computed here as it is written: in `f64`, and in 384 bits. Neither
//! knows of the generator.

use chacha20::ChaCha8Rng;
use gyro_codegen::{Effort, Functions, ROUNDING};
use gyro_model::Rational;
use gyro_sim::{Joint, JointSpace, Rk4};
use gyro_verifier::atoms::{Atoms, Elementary};
use gyro_verifier::field::{Field, Precision, Real};
use rand::{RngExt, SeedableRng};
use std::fmt::Write as _;

/// Cases; `GYRO_CASES` asks for more.
const CASES: u64 = 16;

/// States of each case.
const STATES: usize = 48;

/// By how many roundings of the result the written formula is worse than what is measured of it, which may be lucky.
const LUCK: f64 = 4.0;

/// A decimal, so that its digits are the same here and in the model file.
#[derive(Clone, Copy, Debug)]
struct Decimal {
    digits: i64,
    places: u32,
}

impl Decimal {
    fn text(self) -> String {
        format!("{}e-{}", self.digits, self.places)
    }

    fn number<F: Number>(self, context: F::Context) -> F {
        let denominator = 10_i64.pow(self.places);
        F::from_rational(context, &Rational::new(self.digits.into(), denominator.into()))
    }
}

/// A number that has sines.
trait Number: Field {
    fn sine(&self) -> Self;
    fn cosine(&self) -> Self;
}

impl Number for f64 {
    fn sine(&self) -> Self {
        self.sin()
    }
    fn cosine(&self) -> Self {
        self.cos()
    }
}

impl Number for Real<'_> {
    fn sine(&self) -> Self {
        Elementary.sin(self)
    }
    fn cosine(&self) -> Self {
        Elementary.cos(self)
    }
}

/// A prescribed motion.
#[derive(Clone, Debug)]
enum Motion {
    Polynomial(Vec<Decimal>),
    Sinusoid([Decimal; 3]),
    Sum(Vec<Motion>),
    Product(Vec<Motion>),
}

/// A function of time with two derivatives.
type Jet<F> = [F; 3];

impl Motion {
    fn text(&self) -> String {
        let listed = |parts: &[Self]| parts.iter().map(Self::text).collect::<Vec<_>>().join(", ");
        match self {
            Self::Polynomial(coefficients) => {
                let texts: Vec<_> = coefficients.iter().map(|c| c.text()).collect();
                format!("{{ polynomial = [{}] }}", texts.join(", "))
            }
            Self::Sinusoid([a, w, p]) => {
                let [a, w, p] = [a, w, p].map(|number| number.text());
                format!("{{ sinusoid = {{ amplitude = {a}, angular_frequency = {w}, phase = {p} }} }}")
            }
            Self::Sum(parts) => format!("{{ sum = [{}] }}", listed(parts)),
            Self::Product(parts) => format!("{{ product = [{}] }}", listed(parts)),
        }
    }

    fn jet<F: Number>(&self, context: F::Context, t: &F) -> Jet<F> {
        let zero = || F::zero(context);
        let parts =
            |parts: &[Self]| -> Vec<Jet<F>> { parts.iter().map(|part| part.jet(context, t)).collect() };
        match self {
            Self::Polynomial(coefficients) => {
                let time = [t.clone(), F::integer(context, 1), zero()];
                coefficients.iter().rev().fold([zero(), zero(), zero()], |sum, c| {
                    let [x, v, a] = product(context, &sum, &time);
                    [x.add(&c.number(context)), v, a]
                })
            }
            Self::Sinusoid(numbers) => {
                let [a, w, p] = numbers.map(|number| number.number::<F>(context));
                let argument = w.mul(t).add(&p);
                let x = a.mul(&argument.sine());
                let v = a.mul(&w).mul(&argument.cosine());
                let bend = w.mul(&w).mul(&x).neg();
                [x, v, bend]
            }
            Self::Sum(all) => parts(all)
                .iter()
                .fold([zero(), zero(), zero()], |sum, part| std::array::from_fn(|k| sum[k].add(&part[k]))),
            Self::Product(all) => {
                let one = [F::integer(context, 1), zero(), zero()];
                parts(all).iter().fold(one, |all, part| product(context, &all, part))
            }
        }
    }
}

fn product<F: Number>(context: F::Context, a: &Jet<F>, b: &Jet<F>) -> Jet<F> {
    let twice = F::integer(context, 2).mul(&a[1].mul(&b[1]));
    [
        a[0].mul(&b[0]),
        a[0].mul(&b[1]).add(&a[1].mul(&b[0])),
        a[0].mul(&b[2]).add(&twice).add(&a[2].mul(&b[0])),
    ]
}

/// How the load hangs on what is driven.
#[derive(Clone, Copy, Debug)]
enum Hanging {
    /// A carriage on a rail, straight up.
    Rail,
    /// An arm about a hinge.
    Hinge,
}

#[derive(Clone, Debug)]
struct Case {
    hanging: Hanging,
    motion: Motion,
    t_end: Decimal,
    mass: Decimal,
    inertia: Decimal,
    /// From the arm's hinge to the load's, and from there to its mass centre.
    arms: [Decimal; 2],
    gravity: Decimal,
    /// Stiffness and free place of each.
    springs: Vec<[Decimal; 2]>,
}

impl Case {
    fn draw(dice: &mut ChaCha8Rng) -> Self {
        let t_end = dice.random_range(1..40) * 5;
        let mut between = |low, high, places| decimal(dice, low, high, places);
        let (mass, inertia) = (between(100, 5000, 3), between(10, 900, 3));
        let arms = [between(100, 900, 3), between(100, 900, 3)];
        let far = [1000, 100_000, 10_000_000];
        let springs = (0..2).map(|k| [between(0, 5000, 2), between(-far[k], far[k], 3)]).collect();
        let motion = motion(dice, t_end as f64 / 10.0, 2);
        Self {
            hanging: if dice.random_range(0..2) == 0 { Hanging::Rail } else { Hanging::Hinge },
            motion,
            t_end: Decimal { digits: t_end, places: 1 },
            mass,
            inertia,
            arms,
            gravity: Decimal { digits: [0, 981][dice.random_range(0..2)], places: 2 },
            springs,
        }
    }

    fn page(&self) -> String {
        let [kind, place, axis, zero] = match self.hanging {
            Hanging::Rail => ["prismatic", "displacement", "[0, 1, 0]", "[1, 0, 0]"],
            Hanging::Hinge => ["revolute", "angle", "[0, 0, 1]", "[1, 0, 0]"],
        };
        let [a, b] = self.arms.map(|arm| match self.hanging {
            Hanging::Rail => "0".to_owned(),
            Hanging::Hinge => arm.text(),
        });
        let (mass, inertia) = (self.mass.text(), self.inertia.text());
        let mut page = format!(
            "format = 1\nname = \"nasty\"\ngravity = [0, -{}, 0]\n[simulation]\nt_end = {}\n\
             [[body]]\nname = \"wall\"\nfixed = true\n[[body]]\nname = \"arm\"\nmass = 1\ninertia = [1, 1, 1]\n\
             [[body]]\nname = \"load\"\nmass = {mass}\ninertia = [{inertia}, {inertia}, {inertia}]\n\
             [[joint]]\nname = \"drive\"\nkind = \"{kind}\"\naxis = {axis}\nzero = {zero}\n\
             first = {{ body = \"wall\" }}\nsecond = {{ body = \"arm\" }}\n\
             [[joint]]\nname = \"idle\"\nkind = \"{kind}\"\naxis = {axis}\nzero = {zero}\n\
             first = {{ body = \"arm\", point = [{a}, 0, 0] }}\nsecond = {{ body = \"load\", point = [-{b}, 0, 0] }}\n\
             [[driver]]\nname = \"d\"\njoint = \"drive\"\ncoordinate = \"{place}\"\nmotion = {}\n",
            self.gravity.text(),
            self.t_end.text(),
            self.motion.text(),
        );
        for (k, [stiffness, free]) in self.springs.iter().enumerate() {
            let _ = writeln!(
                page,
                "[[force]]\nname = \"s{k}\"\nkind = \"spring\"\njoint = \"idle\"\nstiffness = {}\nfree = {}",
                stiffness.text(),
                free.text()
            );
        }
        page
    }

    /// The load's acceleration relative to what is driven.
    fn written<F: Number>(&self, context: F::Context, [t, x]: [&F; 2]) -> F {
        let [mass, inertia, gravity] =
            [self.mass, self.inertia, self.gravity].map(|number| number.number::<F>(context));
        let [place, rate, bend] = self.motion.jet(context, t);
        let force = self.springs.iter().fold(F::zero(context), |sum, [stiffness, free]| {
            let stretch = x.sub(&free.number(context));
            sum.sub(&stiffness.number::<F>(context).mul(&stretch))
        });
        match self.hanging {
            Hanging::Rail => force.div(&mass).expect("a mass").sub(&gravity).sub(&bend),
            Hanging::Hinge => {
                let [a, b] = self.arms.map(|arm| arm.number::<F>(context));
                let coupling = mass.mul(&a).mul(&b);
                let about = inertia.add(&mass.mul(&b).mul(&b));
                let swing = bend.mul(&x.cosine()).add(&rate.mul(&rate).mul(&x.sine()));
                let weight = mass.mul(&gravity).mul(&b).mul(&place.add(x).cosine());
                let torque = force.sub(&weight).sub(&coupling.mul(&swing));
                torque.div(&about).expect("an inertia").sub(&bend)
            }
        }
    }
}

fn decimal(dice: &mut ChaCha8Rng, low: i64, high: i64, places: u32) -> Decimal {
    Decimal { digits: dice.random_range(low..=high), places }
}

/// A motion of order one up to `t_end`, so deep.
fn motion(dice: &mut ChaCha8Rng, t_end: f64, depth: usize) -> Motion {
    let of_order_one = |scale: f64| Decimal { digits: (scale * 1e12).round() as i64, places: 12 };
    match dice.random_range(0..if depth == 0 { 3 } else { 7 }) {
        // A bump: zero at both ends and one between them.
        0 => {
            let sides = [0.0, 4.0 / t_end, -4.0 / t_end.powi(2)];
            Motion::Polynomial(sides.map(of_order_one).to_vec())
        }
        // A small factor near some time.
        1 => {
            let at = dice.random_range(0.0..1.0);
            Motion::Polynomial([at, -1.0 / t_end].map(of_order_one).to_vec())
        }
        2 => {
            let turns = dice.random_range(1.0..60.0) / t_end;
            let places = dice.random_range(1..6);
            let phase = decimal(dice, -1_000_000, 1_000_000, places);
            Motion::Sinusoid([decimal(dice, 1, 99, 2), of_order_one(turns), phase])
        }
        // A high power, or a long product.
        3 | 4 => {
            let part = motion(dice, t_end, 0);
            Motion::Product(vec![part; dice.random_range(2..45)])
        }
        5 => Motion::Product((0..dice.random_range(2..9)).map(|_| motion(dice, t_end, depth - 1)).collect()),
        // A constant that two terms have, one of them with the other sign.
        _ => {
            let large = dice.random_range(1..100_000_000);
            let constant = |digits| Motion::Polynomial(vec![Decimal { digits, places: 3 }]);
            let inside = motion(dice, t_end, depth - 1);
            Motion::Sum(vec![constant(large), inside, constant(-large)])
        }
    }
}

/// The largest error of what is generated, in terms of that of the written formula.
fn growth(case: &Case, effort: Effort, dice: &mut ChaCha8Rng) -> f64 {
    let page = case.page();
    let model = gyro_model::read("nasty.toml", &page).unwrap_or_else(|e| panic!("{e}\n{page}"));
    let generated = gyro_jit::compile::<f64>(&model, &Functions::usual(), effort).unwrap();
    let precision = Precision::new();
    let (mut found, mut allowed) = (0.0_f64, 0.0_f64);
    for state in 0..STATES {
        let t = case.t_end.number::<f64>(()) * (1.0 - state as f64 / STATES as f64);
        let (x, u) = (dice.random_range(-3.0..3.0), dice.random_range(-3.0..3.0));
        let mut rates = generated.joint_buffers().rates;
        generated.joint_accelerations(t, &vec![x, u], &mut rates);
        let exact = case.written(&precision, [&Real::new(&precision, t), &Real::new(&precision, x)]);
        let error = |value: f64| exact.sub(&Real::new(&precision, value)).to_f64().abs();
        found = found.max(error(rates[0]));
        let rounding = LUCK * f64::EPSILON * exact.to_f64().abs();
        allowed = allowed.max(error(case.written((), [&t, &x])).max(rounding));
    }
    found / allowed
}

#[test]
fn forms_round_about_as_well_as_formulas_as_they_are_written() {
    let cases = std::env::var("GYRO_CASES").map_or(CASES, |cases| cases.parse().unwrap());
    let mut worst = 0.0_f64;
    for seed in 0..cases {
        let mut dice = ChaCha8Rng::seed_from_u64(seed);
        let case = Case::draw(&mut dice);
        for effort in [Effort::Quick, Effort::Full] {
            let growth = growth(&case, effort, &mut dice);
            assert!(growth <= ROUNDING, "seed {seed}, {effort:?}: {growth:e} times\n{}", case.page());
            worst = worst.max(growth);
        }
    }
    println!("{cases} cases, at worst {worst:.1} times the error of the written formula");
}

/// A smooth bump of forty factors, which as powers of time has coefficients of 1e40. The load was run by another engine
/// at a finer step.
#[test]
fn a_bump_of_forty_factors_is_driven_as_it_is_written() {
    const STEP: f64 = 0.01;
    let bump = Motion::Product(vec![
        Motion::Polynomial(
            [0, 40, -4].map(|digits| Decimal { digits, places: 2 }).to_vec()
        );
        40
    ]);
    let half = Motion::Polynomial(vec![Decimal { digits: 5, places: 1 }]);
    let number = |digits, places| Decimal { digits, places };
    let case = Case {
        hanging: Hanging::Hinge,
        motion: Motion::Product(vec![half, bump]),
        t_end: number(10, 0),
        mass: number(1, 0),
        inertia: number(1, 1),
        arms: [number(5, 1), number(3, 1)],
        gravity: number(0, 0),
        springs: Vec::new(),
    };
    let model = gyro_model::read("bump.toml", &case.page()).unwrap();
    for effort in [Effort::Quick, Effort::Full] {
        let generated = gyro_jit::compile::<f64>(&model, &Functions::usual(), effort).unwrap();
        let mut x = generated.joint_start();
        let mut rk4 = Rk4::new(&x);
        for step in 0..1000 {
            rk4.step(&Joint, &generated, f64::from(step) * STEP, STEP, &mut x);
        }
        assert!((x[0] + 0.4659).abs() < 1e-4, "{effort:?}: {}", x[0]);
    }
}
