//! Values, Jacobians, ν and γ of the constraint rows, typed from the paper's section 4 and Haug (1989), chapter 11.
//!
//! One walk over the rows serves Φ_q and (Φ_r, Φ_π'): it calls a sink with row, column and value of each entry that is
//! not zero by structure, row by row.

use crate::model::course::Course;
use crate::model::gradient::{Gradient, OF_FORMULA, OF_TWO_JOINTS};
use crate::model::lowered::Lowered;
use crate::model::measure::Term;
use crate::model::motion::{Motion, along_p, along_pi, along_turns};
use crate::model::place::Moment;
use crate::model::primitives::{Pull, Turning};
use crate::model::rows::Row;
use crate::model::scene::Constrained;
use crate::model::textbook::{g_matrix, relative_matrix, tilde};
use crate::model::tracked::Tracked;
use crate::number::{Number, abs, number};
use nalgebra::{Matrix3, RowVector3, SMatrix, Vector3};

/// The motions of the bodies of one joint after another.
struct Pairs<'a, T: Number> {
    lowered: &'a Lowered<T>,
    at: Moment<'a, T>,
    last: Option<(usize, [Motion<T>; 2])>,
    /// What is made of the motion of a body with coordinates.
    moved: fn(Motion<T>) -> Motion<T>,
}

impl<'a, T: Number> Pairs<'a, T> {
    fn new(lowered: &'a Lowered<T>, at: Moment<'a, T>) -> Self {
        Self { lowered, at, last: None, moved: |motion| motion }
    }

    /// The motions of a joint's bodies; most rows ask for the same as the one before.
    fn of(&mut self, joint: usize) -> &[Motion<T>; 2] {
        let Self { lowered, at, last, moved } = self;
        if last.as_ref().is_some_and(|(last, _)| *last != joint) {
            *last = None;
        }
        let evaluate = || {
            let joint = lowered.scene.joint(joint);
            [&joint.first.place, &joint.second.place].map(|place| {
                let motion = lowered.scene.motion(*at, place);
                if place.moving_body().is_some() { moved(motion) } else { motion }
            })
        };
        &last.get_or_insert_with(|| (joint, evaluate())).1
    }
}

impl<T: Number> Lowered<T> {
    /// Writes Φ: joint rows, then normalisations.
    pub(crate) fn phi(&self, at: Moment<'_, T>, out: &mut [T]) {
        self.for_each_jet(at, |row, [value, ..]| out[row] = value);
        for (moving_body, out) in out[self.n_rows()..].iter_mut().enumerate() {
            *out = self.scene.p(at.y, moving_body).norm_squared() - T::one(); // eq. (12)
        }
    }

    /// Φ_q, joint rows and normalisations, columns (r, p) body after body.
    pub(crate) fn phi_q(&self, at: Moment<'_, T>, mut sink: impl FnMut(usize, usize, T)) {
        // The orientation rows are linear in p: rows e1 to e3 of p̄₀ ∘ p, which are G(p₀) p.
        let orientation = |body: &Constrained<T>| g_matrix(&body.p0);
        self.for_each_gradient(at, [along_p, along_turns], orientation, &mut sink);
        for moving_body in 0..self.scene.n_bodies() {
            let p = self.scene.p(at.y, moving_body);
            (0..4).for_each(|k| {
                sink(self.n_rows() + moving_body, 7 * moving_body + 3 + k, number::<T>(2.0) * p[k])
            });
        }
    }

    /// (Φ_r, Φ_π'), joint rows, columns (r, π') body after body.
    pub(crate) fn phi_pi(&self, at: Moment<'_, T>, mut sink: impl FnMut(usize, usize, T)) {
        let orientation = |body: &Constrained<T>| orientation_block(&self.relative_orientation(at.y, body));
        self.for_each_gradient(at, [along_pi; 2], orientation, &mut sink);
    }

    /// Writes ν = −Φ_t: minus the rates of the rows while all bodies with coordinates rest.
    pub(crate) fn nu(&self, at: Moment<'_, T>, out: &mut [T]) {
        out.fill(T::zero());
        if !self.is_driven {
            return;
        }
        let mut resting = Pairs { moved: Motion::at_rest, ..Pairs::new(self, at) };
        for (out, row) in out.iter_mut().zip(&self.rows) {
            *out = match row {
                Row::Constrained { .. } => T::zero(),
                Row::Measured { terms, course } => {
                    -self.measured_jet(terms, course.as_ref(), &mut resting)[1]
                }
                Row::Followed { second, formula } => {
                    -self.followed_jet(second.as_ref(), formula, &mut resting)[1]
                }
                Row::Rolling(formula) => -self.rolling_jet(formula, &mut resting)[1],
            };
        }
    }

    /// Writes γ, the right-hand side of `Φ_r r̈ + Φ_π' ẇ' = γ`: minus the second time derivative of the rows where
    /// bodies with coordinates have no acceleration and all others the prescribed one. Haug (1989), section 11.2.
    pub(crate) fn gamma(&self, at: Moment<'_, T>, out: &mut [T]) {
        self.for_each_jet(at, |row, [_, _, second]| out[row] = -second);
    }

    /// Writes `Φ_r s + Φ_π' w' − ν`, which is the time derivative of the rows.
    pub(crate) fn velocity_residual(&self, at: Moment<'_, T>, out: &mut [T]) {
        self.for_each_jet(at, |row, [_, rate, _]| out[row] = rate);
    }

    /// Scalar and vector part of `p̄₀ ∘ p`.
    pub(crate) fn relative_orientation(&self, y: &[T], body: &Constrained<T>) -> (T, Vector3<T>) {
        let relative = relative_matrix(&body.p0) * self.scene.p(y, body.moving_body);
        (relative[0], relative.fixed_rows::<3>(1).into_owned())
    }

    /// Calls `f` with each row, its value and two time derivatives.
    fn for_each_jet(&self, at: Moment<'_, T>, mut f: impl FnMut(usize, [T; 3])) {
        let mut pairs = Pairs::new(self, at);
        for (index, row) in self.rows.iter().enumerate() {
            let jet = match row {
                Row::Constrained { body, component } => {
                    self.constrained_jet(at.y, &self.scene.constrained[*body], *component)
                }
                Row::Measured { terms, course } => self.measured_jet(terms, course.as_ref(), &mut pairs),
                Row::Followed { second, formula } => self.followed_jet(second.as_ref(), formula, &mut pairs),
                Row::Rolling(formula) => self.rolling_jet(formula, &mut pairs),
            };
            f(index, jet);
        }
    }

    /// Calls `f` with each row that is made of measures, and the size of what it adds up.
    pub(crate) fn for_each_size(&self, at: Moment<'_, T>, mut f: impl FnMut(usize, T)) {
        let mut pairs = Pairs::new(self, at);
        for (index, row) in self.rows.iter().enumerate() {
            let Row::Measured { terms, course } = row else { continue };
            let mut size =
                course.as_ref().map_or(0.0, |course| course.jet(gyro_sim::Real::to_f64(at.t))[0].abs());
            for term in terms {
                let [value, ..] = term.measure.jet(self.scene.joint(term.joint), pairs.of(term.joint), at.y);
                size += gyro_sim::Real::to_f64(abs(term.factor * value));
            }
            f(index, number(size));
        }
    }

    fn measured_jet(&self, terms: &[Term<T>], course: Option<&Course>, pairs: &mut Pairs<'_, T>) -> [T; 3] {
        let Moment { t, y } = pairs.at;
        let prescribed = course.map_or([0.0; 3], |course| course.jet(gyro_sim::Real::to_f64(t)));
        let start = prescribed.map(|x| -number::<T>(x));
        terms.iter().fold(start, |sum, term| {
            let jet = term.measure.jet(self.scene.joint(term.joint), pairs.of(term.joint), y);
            [0, 1, 2].map(|k| sum[k] + term.factor * jet[k])
        })
    }

    /// Eqs. (5) and (6). The second derivative of the latter follows from `Ġᵀw' = −½|w'|² p`: −¼|w'|² times the row
    /// itself.
    fn constrained_jet(&self, y: &[T], body: &Constrained<T>, component: usize) -> [T; 3] {
        let w = self.scene.w(y, body.moving_body);
        if component < 3 {
            let displacement = self.scene.r(y, body.moving_body) - body.r0;
            return [displacement[component], self.scene.s(y, body.moving_body)[component], T::zero()];
        }
        let relative = self.relative_orientation(y, body);
        let (row, rate) = (relative.1[component - 3], (orientation_block(&relative) * w)[component - 3]);
        [row, rate, -w.norm_squared() * number(0.25) * row]
    }

    /// Calls the sink with the entries of all rows, those of velocities by the second way of turning; `orientation` is
    /// the derivative of a constrained body's eq. (6).
    fn for_each_gradient<const N: usize>(
        &self,
        at: Moment<'_, T>,
        [turning, rolling]: [Turning<T, N>; 2],
        orientation: impl Fn(&Constrained<T>) -> SMatrix<T, 3, N>,
        sink: &mut impl FnMut(usize, usize, T),
    ) {
        let mut pairs = Pairs::new(self, at);
        for (index, row) in self.rows.iter().enumerate() {
            let sink = |column, value| sink(index, column, value);
            match row {
                Row::Constrained { body, component } => {
                    let body = &self.scene.constrained[*body];
                    constrained_pull(*component, &orientation(body)).walk(body.moving_body, sink);
                }
                Row::Measured { terms, .. } => self.measured_gradient(terms, &mut pairs, turning, sink),
                Row::Followed { second, formula } => {
                    let slopes = formula.slopes(&self.jets(&formula.terms, &mut pairs), false);
                    let sign = if second.is_some() { -T::one() } else { T::one() };
                    let terms =
                        second.iter().copied().chain(formula.times(&slopes, sign)).collect::<Vec<_>>();
                    self.summed_gradient::<N, OF_FORMULA>(&terms, &mut pairs, turning, sink);
                }
                Row::Rolling(formula) => {
                    let slopes = formula.slopes(&self.jets(&formula.terms, &mut pairs), true);
                    let terms: Vec<_> = formula.times(&slopes, T::one()).collect();
                    self.summed_gradient::<N, OF_FORMULA>(&terms, &mut pairs, rolling, sink);
                }
            }
        }
    }

    /// The derivatives of what a joint measures with respect to its bodies' positions.
    fn pulls<const N: usize>(
        &self,
        term: &Term<T>,
        pairs: &mut Pairs<'_, T>,
        turning: Turning<T, N>,
    ) -> [(Option<usize>, Pull<T, N>); 2] {
        let joint = self.scene.joint(term.joint);
        let [first, second] = term.measure.pulls(joint, pairs.of(term.joint), turning);
        [(joint.first.place.moving_body(), first), (joint.second.place.moving_body(), second)]
    }

    /// What joints measure, with its derivatives in time.
    fn jets(&self, terms: &[Term<T>], pairs: &mut Pairs<'_, T>) -> Vec<[T; 3]> {
        let y = pairs.at.y;
        let one = |term: &Term<T>| term.measure.jet(self.scene.joint(term.joint), pairs.of(term.joint), y);
        terms.iter().map(one).collect()
    }

    fn followed_jet(
        &self,
        second: Option<&Term<T>>,
        formula: &Tracked<T>,
        pairs: &mut Pairs<'_, T>,
    ) -> [T; 3] {
        let value = formula.jet(&self.jets(&formula.terms, pairs), pairs.at.t);
        let Some(second) = second else { return value };
        let jets = self.jets(std::slice::from_ref(second), pairs);
        [0, 1, 2].map(|k| jets[0][k] - value[k])
    }

    /// What changes at the rate that the formula tells, and counts as zero.
    fn rolling_jet(&self, formula: &Tracked<T>, pairs: &mut Pairs<'_, T>) -> [T; 3] {
        let [rate, second, _] = formula.jet(&self.jets(&formula.terms, pairs), pairs.at.t);
        [T::zero(), rate, second]
    }

    fn measured_gradient<const N: usize>(
        &self,
        terms: &[Term<T>],
        pairs: &mut Pairs<'_, T>,
        turning: Turning<T, N>,
        mut sink: impl FnMut(usize, T),
    ) {
        if let [term] = terms {
            // One joint's row has nothing to add up; its factor is one, and columns ascend whichever body comes first.
            let mut pulls = self.pulls(term, pairs, turning);
            pulls.sort_by_key(|(moving_body, _)| *moving_body);
            pulls.iter().for_each(|(moving_body, pull)| {
                moving_body.iter().for_each(|moving_body| pull.walk(*moving_body, &mut sink))
            });
            return;
        }
        self.summed_gradient::<N, OF_TWO_JOINTS>(terms, pairs, turning, sink);
    }

    fn summed_gradient<const N: usize, const BODIES: usize>(
        &self,
        terms: &[Term<T>],
        pairs: &mut Pairs<'_, T>,
        turning: Turning<T, N>,
        sink: impl FnMut(usize, T),
    ) {
        let mut gradient = Gradient::<T, N, BODIES>::new();
        for term in terms {
            for (moving_body, pull) in self.pulls(term, pairs, turning) {
                moving_body
                    .into_iter()
                    .for_each(|moving_body| gradient.add(moving_body, pull.times(term.factor)));
            }
        }
        gradient.walk(sink);
    }
}

fn constrained_pull<T: Number, const N: usize>(
    component: usize,
    orientation: &SMatrix<T, 3, N>,
) -> Pull<T, N> {
    if component < 3 {
        let r = Vector3::ith(component, T::one()).transpose();
        return Pull { r_columns: component..component + 1, r, turn: SMatrix::zeros() };
    }
    let turn = orientation.row(component - 3).into_owned();
    Pull { r_columns: 0..0, r: RowVector3::zeros(), turn }
}

/// The derivative of the vector part of q = p̄₀ ∘ p with respect to π': `½ (q₀ I + q̃)`.
fn orientation_block<T: Number>((q0, q): &(T, Vector3<T>)) -> Matrix3<T> {
    (Matrix3::from_diagonal_element(*q0) + tilde(q)) * number::<T>(0.5)
}
