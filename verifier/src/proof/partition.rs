//! What the coordinate partition of a tree by charts must satisfy.
//!
//! Independent of a body on a revolute joint are one Euler parameter, the special one that the chart names, and the
//! rate about its own axis; of a free body or one on a spherical joint, all Euler parameters but the special one, and
//! w'. A Newton step goes from root to leaf: a body's dot-1 rows are linearised where the bodies before it are
//! corrected already and its own p was first brought to unit length, `u = p (3 − pᵀp) / 2`; its point rows then give
//! its position exactly.

use super::case::Case;
use super::point::stretched;
use super::residuals::differences;
use crate::field::Field;
use crate::point::Point;
use crate::tape::Term;
use crate::textbook::Evaluation;
use gyro_model::{Attachment, JointKind, Link, RowOwner, Support, Tree};
use num_traits::Signed;
use std::ops::Range;

/// How a body is held, as far as the partition is concerned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Hold {
    Constrained,
    Free,
    Spherical { joint: usize },
    Fixed { joint: usize },
    Revolute { joint: usize, reversed: bool },
}

/// A body with coordinates.
#[derive(Clone, Copy, Debug)]
struct Held {
    moving_body: usize,
    hold: Hold,
    /// Place of its chart, where it has one.
    chart: usize,
}

impl Held {
    fn has_chart(&self) -> bool {
        !matches!(self.hold, Hold::Constrained | Hold::Fixed { .. })
    }

    /// Its joint's rows: three for the point, then the dot-1 rows.
    fn rows<'a>(&self, case: &Case<'a>) -> Range<usize> {
        match self.hold {
            Hold::Spherical { joint } | Hold::Fixed { joint } | Hold::Revolute { joint, .. } => {
                case.model.rows_of(RowOwner::Joint(joint))
            }
            Hold::Constrained | Hold::Free => 0..0,
        }
    }

    /// Its axis in its own frame.
    fn axis<'a>(&self, case: &Case<'a>) -> Option<[Term<'a>; 3]> {
        let Hold::Revolute { joint, reversed } = self.hold else { return None };
        let joint = &case.model.joints[joint];
        let end = if reversed { &joint.first } else { &joint.second };
        Some(end.axis.each_ref().map(|x| case.point.number(x)))
    }
}

/// The bodies from root to leaf; `None` where charts cannot serve.
fn bodies<'a>(case: &Case<'a>) -> Option<Vec<Held>> {
    let (moving_bodies, mut chart) = (case.model.coordinate_bodies(), 0);
    let hold = |link: &Link| match link.attachment {
        Attachment::Free => Some(Hold::Free),
        Attachment::Constrained => Some(Hold::Constrained),
        Attachment::Joint { joint, reversed, .. } => match case.model.joints[joint].kind {
            JointKind::Revolute => Some(Hold::Revolute { joint, reversed }),
            JointKind::Spherical => Some(Hold::Spherical { joint }),
            JointKind::Fixed => Some(Hold::Fixed { joint }),
            _ => None,
        },
    };
    let mut held = Vec::new();
    for link in &Tree::of(case.model).links {
        let body = Held {
            moving_body: moving_bodies.iter().position(|&b| b == link.body)?,
            hold: hold(link)?,
            chart,
        };
        chart += usize::from(body.has_chart());
        held.push(body);
    }
    (chart == case.charts.len()).then_some(held)
}

/// A number that is not zero, where there must be a number that is.
fn wrong<'a>(case: &Case<'a>) -> Vec<Term<'a>> {
    vec![Term::one(case.point.context)]
}

/// Of a revolute joint `G(p)ᵀ h'`, of others p: the vectors must be parallel and not zero.
pub fn chart_vectors<'a>(case: &Case<'a>) -> Option<Vec<Term<'a>>> {
    let Some(bodies) = bodies(case) else { return Some(wrong(case)) };
    let vectors = case.run("chart_vectors", &case.point);
    let mut residuals = Vec::new();
    for body in bodies.iter().filter(|body| body.has_chart()) {
        let vector = &vectors[4 * body.chart..4 * body.chart + 4];
        let p = euler(&case.point, body.moving_body);
        let expected = body.axis(case).map_or_else(|| p.to_vec(), |axis| turning(p, &axis).to_vec());
        residuals.extend(across(vector, &expected));
        // One, unless the vector is zero everywhere: then it is not a number.
        let square = dot(vector, vector);
        residuals.push(square.div(&square)?.sub(&Term::one(case.point.context)));
    }
    Some(residuals)
}

/// `G(p)ᵀ a` with G of eq. (15).
pub(super) fn turning<F: Field>(p: &[F], [x, y, z]: &[F; 3]) -> [F; 4] {
    let sum = |terms: [(&F, &F); 3]| {
        let [a, b, c] = terms.map(|(e, a)| e.mul(a));
        a.add(&b).add(&c)
    };
    let [e0, e1, e2, e3] = [&p[0], &p[1], &p[2], &p[3]];
    let [m1, m2, m3] = [e1, e2, e3].map(F::neg);
    [
        sum([(&m1, x), (&m2, y), (&m3, z)]),
        sum([(e0, x), (&m3, y), (e2, z)]),
        sum([(e3, x), (e0, y), (&m1, z)]),
        sum([(&m2, x), (e1, y), (e0, z)]),
    ]
}

/// One Newton step of the dependent positions.
pub fn newton_step<'a>(case: &Case<'a>) -> Option<Vec<Term<'a>>> {
    let Some(bodies) = bodies(case) else { return Some(wrong(case)) };
    let longer = stretched(&case.point, &case.factors);
    let mut residuals = Vec::new();
    for start in [&case.point, &longer] {
        let moved = case.moved("newton_step", start);
        residuals.extend(others_kept(case, start, &moved));
        let phi = case.textbook(&moved)?.phi()?;
        for body in &bodies {
            residuals.extend(lengths(case, body, start, &moved));
            residuals.extend(phi[body.rows(case)].iter().take(3).cloned());
            residuals.extend(held_position(case, body, start, &moved));
        }
    }
    // Away from |p| = 1 the derived Jacobian is not that of eq. (3); the step is one of Newton's to first order only.
    let moved = case.moved("newton_step", &case.point);
    let textbook = case.textbook(&moved)?;
    for body in &bodies {
        residuals.extend(linearised_rows(case, &textbook, body, &moved)?);
    }
    Some(residuals)
}

/// Velocities and what follows them keep their values.
fn others_kept<'a>(case: &Case<'a>, start: &Point<Term<'a>>, moved: &Point<Term<'a>>) -> Vec<Term<'a>> {
    let positions = 7 * case.n_bodies();
    differences(&start.state[positions..], &moved.state[positions..])
}

/// What the step does along p and in the special Euler parameter, for p of any length.
fn lengths<'a>(
    case: &Case<'a>,
    body: &Held,
    start: &Point<Term<'a>>,
    moved: &Point<Term<'a>>,
) -> Vec<Term<'a>> {
    let (p, corrected) = (euler(start, body.moving_body), euler(moved, body.moving_body));
    let number = |n| Term::integer(start.context, n);
    let square = dot(p, p);
    let chart = |vector: &[Term<'a>]| dot(&case.charts[body.chart], vector);
    // Twice the unit u, so that no half is needed.
    let scale = number(3).sub(&square);
    let twice_unit: Vec<Term<'a>> = p.iter().map(|e| e.mul(&scale)).collect();
    let twice: Vec<Term<'a>> = corrected.iter().map(|e| e.add(e)).collect();
    let across_unit = dot(&twice_unit, &differences(&twice, &twice_unit));
    let change = differences(corrected, p);
    match body.hold {
        Hold::Revolute { .. } => vec![across_unit, chart(&change)],
        Hold::Fixed { .. } => vec![across_unit],
        Hold::Free | Hold::Spherical { .. } => {
            let along = dot(p, &change);
            let mut residuals = across(&change, &case.charts[body.chart]);
            residuals.push(along.add(&along).sub(&number(1).sub(&square)));
            residuals
        }
        Hold::Constrained => Vec::new(),
    }
}

/// Of a free body the position that it had; of a constrained one what the model file gives.
fn held_position<'a>(
    case: &Case<'a>,
    body: &Held,
    start: &Point<Term<'a>>,
    moved: &Point<Term<'a>>,
) -> Vec<Term<'a>> {
    let (before, after) = (start.position(body.moving_body), moved.position(body.moving_body));
    match body.hold {
        Hold::Free => differences(&before[..3], &after[..3]),
        Hold::Constrained => {
            let given = given_pose(case, body.moving_body);
            differences(after, &given)
        }
        _ => Vec::new(),
    }
}

/// The model file's pose of a constrained body, Euler parameters of unit length with `e0` not negative.
fn given_pose<'a>(case: &Case<'a>, moving_body: usize) -> Vec<Term<'a>> {
    let body = &case.model.bodies[case.model.coordinate_bodies()[moving_body]];
    debug_assert_eq!(body.support, Support::Constrained, "only these are given");
    let exact = body.orientation.each_ref().map(|e| case.model.exact(e));
    let square = exact.iter().map(|e| e * e).sum();
    let negative = exact[0].is_negative();
    let length = Term::sqrt_rational(case.point.context, &square);
    let length = if negative { length.neg() } else { length };
    let numbers = body.position.iter().map(|x| case.point.number(x));
    let euler = body.orientation.iter().map(|e| case.point.number(e));
    numbers.chain(euler.map(|e| e.div(&length).unwrap_or(e))).collect()
}

/// The dot-1 rows after the step, to first order in the body's own p.
fn linearised_rows<'a>(
    case: &Case<'a>,
    textbook: &Evaluation<'_, Term<'a>>,
    body: &Held,
    moved: &Point<Term<'a>>,
) -> Option<Vec<Term<'a>>> {
    let (Hold::Revolute { joint, .. } | Hold::Fixed { joint }) = body.hold else { return Some(Vec::new()) };
    let before = euler(&case.point, body.moving_body);
    let change = differences(euler(moved, body.moving_body), before);
    let rows = textbook.linearised(RowOwner::Joint(joint), body.moving_body, before, &change)?;
    Some(rows.into_iter().skip(3).collect())
}

/// The dependent velocities.
pub fn solve_velocities<'a>(case: &Case<'a>) -> Option<Vec<Term<'a>>> {
    let Some(bodies) = bodies(case) else { return Some(wrong(case)) };
    let moved = case.moved("solve_velocities", &case.point);
    let positions = 7 * case.n_bodies();
    let velocities = positions..positions + 6 * case.n_bodies();
    let kept = |range: Range<usize>| differences(&moved.state[range.clone()], &case.point.state[range]);
    let mut residuals = case.textbook(&moved)?.velocity_residual()?;
    residuals.extend(kept(0..positions));
    residuals.extend(kept(velocities.end..moved.state.len()));
    for body in bodies {
        let start = velocities.start + 6 * body.moving_body;
        match body.hold {
            Hold::Free => residuals.extend(kept(start..start + 6)),
            Hold::Spherical { .. } => residuals.extend(kept(start + 3..start + 6)),
            Hold::Revolute { .. } => {
                let axis = body.axis(case).unwrap_or_else(|| [(); 3].map(|()| Term::one(case.point.context)));
                residuals.push(dot(&axis, &kept(start + 3..start + 6)));
            }
            Hold::Fixed { .. } | Hold::Constrained => {}
        }
    }
    Some(residuals)
}

fn euler<'p, 'a>(point: &'p Point<Term<'a>>, moving_body: usize) -> &'p [Term<'a>] {
    &point.position(moving_body)[3..]
}

pub(super) fn dot<F: Field>(a: &[F], b: &[F]) -> F {
    let products = a.iter().zip(b).map(|(a, b)| a.mul(b));
    products.reduce(|sum, x| sum.add(&x)).expect("vectors have components")
}

/// `a_i b_k − a_k b_i`: zero where the vectors are parallel.
fn across<F: Field>(a: &[F], b: &[F]) -> Vec<F> {
    let pairs = (0..a.len()).flat_map(|i| (0..i).map(move |k| (i, k)));
    pairs.map(|(i, k)| a[i].mul(&b[k]).sub(&a[k].mul(&b[i]))).collect()
}
