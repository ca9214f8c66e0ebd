//! Points at which identities are tested.

use crate::field::{Degree, Field, Modular, Precision, Prime, Real};
use crate::joints::JointLayout;
use crate::module::{Module, n_state};
use crate::point::Point;
use crate::program::Source;
use gyro_model::{Model, to_f64};
use rand::{Rng, RngExt};

/// Draws at most this often until all roots exist: each root of a number that varies exists at every other point.
pub(super) const DRAWS: u64 = 256;

/// A residual in 384 bits that is larger than this part of the largest number on the way to it is not zero: rounding
/// makes 1e-115 of it.
pub(super) const FAR_FROM_ZERO: f64 = 1e-60;

/// A point with what claims need besides.
#[derive(Clone)]
pub(super) struct Draw<F: Field> {
    /// Where.
    pub point: Point<F>,
    /// A vector for each chart.
    pub charts: Vec<[F; 4]>,
    /// A factor for each body.
    pub factors: Vec<F>,
    /// A number for each row.
    pub changes: Vec<F>,
    /// A motion.
    pub motion: Vec<F>,
    /// A joint state, and another one.
    pub joints: [Vec<F>; 2],
}

impl<F: Field> Draw<F> {
    /// What formulas read.
    pub fn read(&self, source: Source) -> F {
        match source {
            Source::Chart(chart, k) => self.charts[chart][k].clone(),
            Source::Factor(moving_body) => self.factors[moving_body].clone(),
            Source::Change(row) => self.changes[row].clone(),
            Source::Motion(k) => self.motion[k].clone(),
            Source::Joint(k) => self.joints[0][k].clone(),
            Source::Before(k) => self.joints[1][k].clone(),
            Source::Acceleration(_) => unreachable!("accelerations are formulas too"),
            source => self.point.given(source).cloned().expect("the model says what there is"),
        }
    }

    /// A random point with |p| = 1: Euler parameters are `(1 − u·u, 2u) / (1 + u·u)` of a random vector u, which
    /// reaches every unit vector but one. `None` where `1 + u·u` vanishes.
    fn with(
        model: &Model,
        module: &Module,
        context: F::Context,
        mut draw: impl FnMut() -> F,
    ) -> Option<Self> {
        let n = model.coordinate_bodies().len();
        let mut state = Vec::new();
        for _ in 0..n {
            state.extend([(); 3].map(|()| draw()));
            state.extend(on_sphere(context, [(); 3].map(|()| draw()))?);
        }
        state.extend((7 * n..n_state(model)).map(|_| draw()));
        let point = Point {
            context,
            t: draw(),
            state,
            parameters: model.parameters.iter().map(|_| draw()).collect(),
            inputs: model.inputs.iter().map(|_| draw()).collect(),
        };
        let charts = (0..module.n_charts.unwrap_or(0)).map(|_| [(); 4].map(|()| draw())).collect();
        let factors = (0..n).map(|_| draw()).collect();
        let joints = [joint_state(module, context, &mut draw)?, joint_state(module, context, &mut draw)?];
        let changes = model.rows().iter().map(|_| draw()).collect();
        let motion = (0..6 * n).map(|_| draw()).collect();
        Some(Self { point, charts, factors, changes, motion, joints })
    }
}

/// A random joint state, with Euler parameters of any length (a random multiple of unit ones, so that their length
/// exists modulo a prime too); nothing of mechanisms that have none.
fn joint_state<F: Field>(
    module: &Module,
    context: F::Context,
    mut draw: impl FnMut() -> F,
) -> Option<Vec<F>> {
    let Some(layout) = &module.joints else { return Some(Vec::new()) };
    let mut state: Vec<F> = (0..layout.n_state()).map(|_| draw()).collect();
    for start in layout.euler() {
        let (length, unit) = (draw(), on_sphere(context, [(); 3].map(|()| draw()))?);
        state[start..start + 4].clone_from_slice(&unit.map(|e| e.mul(&length)));
    }
    Some(state)
}

/// A random point modulo a prime.
pub(super) fn modular<'p, const L: usize>(
    model: &Model,
    module: &Module,
    prime: &'p Prime<L>,
    random: &mut impl Rng,
) -> Option<Draw<Modular<'p, L>>> {
    Draw::with(model, module, prime, || prime.draw(random))
}

/// A random point of numbers between −1 and 1, but with parameters near their defaults.
pub(super) fn real<'c>(
    model: &Model,
    module: &Module,
    precision: &'c Precision,
    random: &mut impl Rng,
) -> Option<Draw<Real<'c>>> {
    let mut draw =
        Draw::with(model, module, precision, || Real::new(precision, random.random_range(-1.0..1.0)))?;
    for (value, parameter) in draw.point.parameters.iter_mut().zip(&model.parameters) {
        *value = Real::new(precision, to_f64(&parameter.value) * random.random_range(0.75..1.25));
    }
    Some(draw)
}

/// The degree of what formulas read in what is drawn.
pub(super) fn degree(model: &Model, module: &Module, source: Source) -> Degree {
    let euler = 3..7;
    let turns = |k: usize| {
        let starts = module.joints.iter().flat_map(JointLayout::euler);
        starts.into_iter().any(|start| (start..start + 4).contains(&k))
    };
    match source {
        Source::State(k) if k < 7 * model.coordinate_bodies().len() && euler.contains(&(k % 7)) => {
            Degree::quotient(2.0, 2.0)
        }
        Source::Joint(k) | Source::Before(k) if turns(k) => Degree::quotient(3.0, 2.0),
        _ => Degree::polynomial(1.0),
    }
}

/// The point with the Euler parameters of each body made longer by a factor of its own.
pub(super) fn stretched<F: Field>(point: &Point<F>, factors: &[F]) -> Point<F> {
    let mut stretched = point.clone();
    for (moving_body, factor) in factors.iter().enumerate() {
        for e in &mut stretched.state[7 * moving_body + 3..7 * moving_body + 7] {
            *e = e.mul(factor);
        }
    }
    stretched
}

fn on_sphere<F: Field>(context: F::Context, u: [F; 3]) -> Option<[F; 4]> {
    let one = F::one(context);
    let square = u.iter().fold(one.sub(&one), |sum, x| sum.add(&x.mul(x)));
    let scale = one.add(&square).inv()?;
    let [x, y, z] = u.map(|x| x.add(&x).mul(&scale));
    Some([one.sub(&square).mul(&scale), x, y, z])
}
