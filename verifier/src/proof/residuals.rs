//! What is left of what functions compute when the textbook's is taken away.

use super::case::Case;
use super::point::stretched;
use crate::field::Field;
use crate::tape::Term;

/// Of two lists; where one is longer, its rest, so that nothing escapes comparison.
pub fn differences<F: Field>(a: &[F], b: &[F]) -> Vec<F> {
    let both = a.iter().zip(b).map(|(a, b)| a.sub(b));
    let rest = a.iter().skip(b.len()).chain(b.iter().skip(a.len())).cloned();
    both.chain(rest).collect()
}

/// Eqs. (14) and (16) for p of any length: an integrator's stages leave the sphere.
pub(super) fn position_rates<'a>(case: &Case<'a>, function: &str) -> Option<Vec<Term<'a>>> {
    let (longer, n) = (stretched(&case.point, &case.factors), case.n_bodies());
    let accelerations = vec![Term::zero(case.point.context); case.module.n_accelerations.max(6 * n)];
    let found = case.run_with(function, &longer, &accelerations);
    Some(differences(found.get(..7 * n)?, &case.textbook(&longer)?.position_rates()))
}
