//! Impacts of surfaces.

use super::cones::{Bound, Cones};
use super::equations::{Contacts, Local};
use super::loads::Jam;
use super::resolve::Hit;
use super::small::plus_product;
use crate::Real;
use core::array::from_fn;

impl<D, T: Real, const N: usize> Contacts<D, T, N> {
    /// The impulses of an impact, and the rates after it.
    pub(super) fn struck(
        &self,
        local: &Local<T, N>,
        hits: &[Option<Hit<T>>; N],
    ) -> Result<([T; N], [T; N]), Jam> {
        let zero = T::constant(0.0);
        // Of impulses: compression to the end, then a part of its impulses again, or more where something else pushes.
        let is_poisson = |k: usize| self.contacts[k].is_of_impulses;
        let rebounds = |k: usize| hits[k].map_or(zero, |hit| if is_poisson(k) { zero } else { hit.rebound });
        let least = [zero; N];
        let mut impulses = self.collision(local, &local.rates, hits, (&rebounds, &least))?;
        let mut after = plus_product(&local.rates, &local.compliance, &impulses);
        let shares = |k: usize| match hits[k] {
            Some(hit) if is_poisson(k) && hit.rebound > zero => self.contacts[k].restitution,
            _ => zero,
        };
        if (0..N).any(|k| shares(k) > zero) {
            let least = from_fn(|k| shares(k) * impulses[k]);
            let again = self.collision(local, &after, hits, (&rebounds, &least))?;
            after = plus_product(&after, &local.compliance, &again);
            impulses = from_fn(|k| impulses[k] + again[k]);
        }
        Ok((impulses, after))
    }

    /// Impulses such that surfaces part at these rates at least; no less than these.
    fn collision(
        &self,
        local: &Local<T, N>,
        rates: &[T; N],
        hits: &[Option<Hit<T>>; N],
        (rebounds, least): (&dyn Fn(usize) -> T, &[T; N]),
    ) -> Result<[T; N], Jam> {
        let (zero, infinite) = (T::constant(0.0), T::constant(f64::INFINITY));
        let bound = |k: usize| match (self.contacts[k].slip(), hits[k]) {
            (Some((gap, _)), _) if hits.get(gap).is_some_and(Option::is_some) => {
                Bound::Plane(self.contacts[k].coefficients[0])
            }
            (None, Some(hit)) if hit.outward > zero => Bound::Between([least[k], infinite]),
            (None, Some(_)) => Bound::Between([-infinite, -least[k]]),
            _ => Bound::Given,
        };
        let bias = from_fn(|k| rates[k] - hits[k].map_or(zero, |hit| hit.outward * rebounds(k)));
        let cones = Cones { contacts: &self.contacts, compliance: &local.compliance, bounds: from_fn(bound) };
        cones
            .solved(&bias, *least)
            .map(|(impulses, _)| impulses)
            .map_err(|contact| Jam { contact, gain: 1.0 })
    }
}
