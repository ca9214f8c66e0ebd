//! Directions as model files write them: settled to a bounded number of digits, and compared with what may have been
//! meant.
//!
//! Only the direction of an axis, a zero direction or Euler parameters counts, and formulas are derived from it
//! exactly: what is written with a hundred digits, or a component of 1e-76, would go through every product of the
//! derivation.

use num_bigint::BigInt;
use num_traits::{One, Signed, Zero};

use crate::{Bushing, ForceKind, Model, Motion, Number, Rational, to_f64};

/// Decimal digits of a direction's largest component that count: twice what an `f64` has.
const DIGITS: i32 = 32;

/// A component smaller than this part of the largest may be a zero that somebody computed: an angle of 1.5708 is off by
/// 4e-6.
const NEARLY_ZERO: f64 = 1e-5;

/// An angle as near as this to a right one, rad, may be a right one that somebody rounded, as 1.571 is.
const NEARLY_RIGHT: f64 = 1e-3;

/// An angle as near as this to a right one, rad, is a right one to all digits that there are.
const RIGHT: f64 = 1e-14;

/// Rounds all directions of a model that is being read to [`DIGITS`] digits; what they nearly were is kept in
/// [`Model::remarks`].
pub(crate) fn settle(model: &mut Model) {
    model.remarks.extend(remarks(model));
    for end in model.joints.iter_mut().flat_map(|joint| [&mut joint.first, &mut joint.second]) {
        round(&mut end.axis);
        round(&mut end.zero);
    }
    for body in &mut model.bodies {
        round(&mut body.orientation);
        let rotations = body.motion.iter_mut().flat_map(|motion| &mut motion.rotations);
        rotations.for_each(|(axis, _)| round(axis));
    }
    for force in &mut model.forces {
        if let ForceKind::Bushing(bushing) = &mut force.kind {
            let Bushing { first, second, .. } = &mut **bushing;
            [first, second].into_iter().filter_map(|frame| frame.orientation.as_mut()).for_each(|p| round(p));
        }
    }
}

fn round(direction: &mut [Number]) {
    let largest = direction.iter().filter_map(exact).map(|x| to_f64(x).abs()).fold(0.0, f64::max);
    if largest == 0.0 || !largest.is_finite() {
        return;
    }
    #[expect(clippy::cast_possible_truncation, reason = "the logarithm of an f64")]
    let last = largest.log10().floor() as i32 - DIGITS;
    let power = Rational::from_integer(BigInt::from(10).pow(last.unsigned_abs()));
    let unit = if last < 0 { power.recip() } else { power };
    for number in direction {
        if let Number::Exact(x) = number {
            let units = &*x / &unit;
            if !units.is_integer() {
                *x = units.round() * &unit;
            }
        }
    }
}

fn exact(number: &Number) -> Option<&Rational> {
    if let Number::Exact(x) = number { Some(x) } else { None }
}

fn remarks(model: &Model) -> Vec<String> {
    let mut remarks = Vec::new();
    for joint in &model.joints {
        let first = [&joint.first.axis, &joint.first.zero];
        let second = [&joint.second.axis, &joint.second.zero];
        let ends = if first == second {
            vec![("", first)]
        } else {
            vec![(" on its first body", first), (" on its second body", second)]
        };
        for (end, [axis, zero]) in ends {
            let of = |key: &str| format!("{key} of joint `{}`{end}", joint.name);
            let axis_meant = direction(axis, None);
            remarks.extend(axis_meant.as_ref().map(|meant| nearly(&of("the axis"), "axis", meant)));
            let along = only(axis_meant.as_ref().unwrap_or(axis));
            remarks.extend(
                direction(zero, along).map(|meant| nearly(&of("the zero direction"), "zero", &meant)),
            );
        }
        let coordinates = joint.kind.coordinates().iter().zip(&joint.start.position);
        for (kind, number) in coordinates.filter(|(kind, _)| kind.is_angle()) {
            let (key, of) = (kind.name(), format!("{} of joint `{}`", kind.name(), joint.name));
            remarks.extend(number.as_ref().and_then(|n| {
                right_angle(&of, n, &format!("{key}_deg")).or_else(|| in_degrees(&of, n, key))
            }));
        }
    }
    for body in &model.bodies {
        let of = format!("the orientation of body `{}`", body.name);
        remarks.extend(orientation(&body.orientation).map(|meant| nearly(&of, "orientation", &meant)));
        let Some(motion) = &body.motion else { continue };
        for (axis, angle) in &motion.rotations {
            let of = format!("of a rotation of body `{}`", body.name);
            remarks
                .extend(direction(axis, None).map(|meant| nearly(&format!("the axis {of}"), "axis", &meant)));
            remarks.extend(constant_angle(&of, angle));
        }
    }
    for motion in motions(model) {
        phases(motion, &mut remarks);
    }
    remarks
}

fn motions(model: &Model) -> impl Iterator<Item = &Motion> {
    let of_bodies = model.bodies.iter().filter_map(|body| body.motion.as_ref());
    let of_bodies =
        of_bodies.flat_map(|m| m.translation.iter().chain(m.rotations.iter().map(|(_, angle)| angle)));
    model.drivers.iter().map(|driver| &driver.motion).chain(of_bodies)
}

fn nearly(of: &str, key: &str, meant: &[Number]) -> String {
    let numbers: Vec<String> = meant.iter().filter_map(exact).map(|x| format!("{}", to_f64(x))).collect();
    let numbers = numbers.join(", ");
    format!(
        "{of} is nearly, not exactly, [{numbers}]; if that is meant, `{key} = [{numbers}]` makes shorter formulas"
    )
}

/// The direction with its nearly zero components zero, if there are any; the component `free` may be anything.
fn direction(written: &[Number; 3], free: Option<usize>) -> Option<[Number; 3]> {
    let values = written.each_ref().map(|x| exact(x).map(to_f64));
    let largest = values.iter().flatten().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    let is_near =
        |k: usize| free != Some(k) && values[k].is_some_and(|x| x != 0.0 && x.abs() < NEARLY_ZERO * largest);
    let all_known = values.iter().all(Option::is_some);
    let without = || -> [Number; 3] {
        std::array::from_fn(|k| if is_near(k) { Number::integer(0) } else { written[k].clone() })
    };
    (all_known && (0..3).any(is_near)).then(without).map(|mut meant| {
        // The length of a direction does not count.
        if let Some(k) = only(&meant) {
            meant[k] = Number::integer(if values[k].is_some_and(|x| x < 0.0) { -1 } else { 1 });
        }
        meant
    })
}

/// The only component of a direction that is not zero.
fn only(direction: &[Number; 3]) -> Option<usize> {
    let mut others = (0..3).filter(|&k| !direction[k].is_zero());
    others.next().filter(|_| others.next().is_none())
}

/// Euler parameters of right angles about coordinate directions, where they are nearly met: all components that are not
/// zero are of one size.
fn orientation(written: &[Number; 4]) -> Option<[Number; 4]> {
    let exact: Vec<&Rational> = written.iter().map(exact).collect::<Option<_>>()?;
    let largest = exact.iter().map(|x| x.abs()).max()?;
    if largest.is_zero() {
        return None;
    }
    let ratios: Vec<Rational> = exact.iter().map(|x| *x / &largest).collect();
    let meant: Vec<i64> = ratios.iter().map(|x| if x.is_positive() { 1 } else { -1 } * i64::from(x.abs() * Rational::from_integer(2.into()) > Rational::one())).collect();
    let off = ratios.iter().zip(&meant).map(|(x, m)| (to_f64(x) - *m as f64).abs()).fold(0.0, f64::max);
    let is_exact = ratios.iter().zip(&meant).all(|(x, m)| *x == Rational::from_integer((*m).into()));
    (!is_exact && off < NEARLY_ZERO).then(|| std::array::from_fn(|k| Number::integer(meant[k])))
}

/// How many right angles a number of radians nearly is: not none, and not to all digits.
fn nearly_right(number: &Number) -> Option<i64> {
    let angle = to_f64(exact(number)?);
    let quarters = angle / std::f64::consts::FRAC_PI_2;
    let off = (quarters - quarters.round()).abs() * std::f64::consts::FRAC_PI_2;
    let is_near = quarters.round() != 0.0 && quarters.abs() < 1e3 && (RIGHT..NEARLY_RIGHT).contains(&off);
    #[expect(clippy::cast_possible_truncation, reason = "below a thousand")]
    is_near.then(|| quarters.round() as i64)
}

fn right_angle(of: &str, number: &Number, key: &str) -> Option<String> {
    let degrees = 90 * nearly_right(number)?;
    let written = to_f64(exact(number)?);
    Some(format!(
        "{of} is {written} rad: nearly, not exactly, {degrees} degrees; if that is meant, write `{key} = {degrees}`"
    ))
}

/// A whole number of radians beyond one turn, which may be meant in degrees.
fn in_degrees(of: &str, number: &Number, key: &str) -> Option<String> {
    let angle = exact(number).filter(|angle| angle.is_integer()).map(to_f64)?;
    let turns = angle.abs() / std::f64::consts::TAU;
    (turns > 1.0).then(|| {
        format!("{of} is {angle} rad, {turns:.2} turns; if degrees are meant, write `{key}_deg = {angle}`")
    })
}

/// A rotation by a constant has a sine and a cosine of decimals, which are nothing exact even at a right angle.
fn constant_angle(of: &str, angle: &Motion) -> Option<String> {
    let Motion::Polynomial(coefficients) = angle else { return None };
    let [Number::Exact(constant)] = &coefficients[..] else { return None };
    let quarters = to_f64(constant) / std::f64::consts::FRAC_PI_2;
    let off = (quarters - quarters.round()).abs() * std::f64::consts::FRAC_PI_2;
    (quarters.round() != 0.0 && off < NEARLY_RIGHT).then(|| {
        format!(
            "the angle {of} is a constant near a right angle, of which no decimal is exact; Euler parameters are: the body's \
             `orientation = [1, 1, 0, 0]` is 90 degrees about x, and makes shorter formulas"
        )
    })
}

fn phases(motion: &Motion, remarks: &mut Vec<String>) {
    match motion {
        Motion::Sinusoid { phase, .. } => remarks.extend(right_angle("a phase", phase, "phase_deg")),
        Motion::Sum(parts) | Motion::Product(parts) => parts.iter().for_each(|part| phases(part, remarks)),
        Motion::Polynomial(_)
        | Motion::Table(_)
        | Motion::Lines(_)
        | Motion::Formula(_)
        | Motion::Input(_) => {}
    }
}

#[cfg(test)]
mod tests;
