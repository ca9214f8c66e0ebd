//! Surfaces that touch: what rests, and phases.

use super::cones::{Bound, Cones};
use super::equations::{Contacts, Forced, Local, bounds};
use super::guards::size;
use super::loads::{Acting, Jam, Loads};
use super::resolve::{ROUNDING, UNMET};
use super::small::{at, larger, not_below_rounding, plus_product, spread};
use super::{Contact, Error, Phase, Role};
use crate::Real;
use core::array::from_fn;

/// Friction counts as that of what sticks up to this part of its bound.
const WITHIN: f64 = 1.0 - 1e-9;
/// The direction of slip is that of its velocity down to this part of the fastest.
const VAGUE: f64 = 1e-9;
/// Friction that is at its bound where nothing slips may be beyond it by this part.
const LOOSE: f64 = 1e-3;
/// What yields to a force by less than this part of what it would alone is held by others.
const HELD: f64 = 1e-6;
/// Friction that changes an acceleration by less than this part of it holds nothing.
const FEEBLE: f64 = 1e-9;
/// What comes to rest has less than this part of its velocity left after a step.
const SLOWING: f64 = 0.9;
/// So many times what creeps is slow.
const SLOW: f64 = 1e2;
/// What begins to slide has the direction of its beginning for this time, s.
const SUDDEN: f64 = 1e-6;
/// What a solution is off by times this may be nothing.
const UNSURE: f64 = 100.0;
/// Friction in proportion to reactions is found by so many rounds, before all is solved together.
const LOADED: usize = 4;
/// So many contacts change their phase, each some times, until all are consistent.
const REPAIRS: usize = 8;

impl<D, T: Real, const N: usize> Contacts<D, T, N> {
    /// Where what is held by a stop is to be; no number for all else.
    pub(super) fn ends(&self) -> [T; N] {
        from_fn(|k| match self.phases[k] {
            Phase::AtLower => self.contacts[k].ends[0],
            Phase::AtUpper => self.contacts[k].ends[1],
            _ => T::constant(f64::NAN),
        })
    }

    /// Takes from what is held the rates that it has, and brings what the system tells of to these ends, where they are
    /// numbers, by impulses along it.
    pub(super) fn hold<M>(
        &self,
        model: &M,
        (t, y): (T, &mut D::State),
        (held, ends): (&[bool; N], &[T; N]),
        scratch: &mut [D::State; 2],
    ) where
        D: Forced<M, Scalar = T>,
    {
        if !held.contains(&true) {
            return;
        }
        let local = self.local(model, (t, y), held, &mut scratch[0]);
        let rubs = |k: usize| self.contacts[k].role == Role::Seen && held[k] && !ends[k].is_finite();
        let passes: [bool; N] = if (0..N).any(rubs) {
            let slowed = self.slowed(&local, self.loads(model, (t, y), held).as_ref());
            let noise = self.noise(model, (t, y), &mut scratch[0]);
            let least = local.bias.map(|bias| larger(noise, T::constant(FEEBLE) * bias.abs()));
            from_fn(|k| rubs(k) && slowed[k] <= least[k])
        } else {
            [false; N]
        };
        let held = &from_fn(|k| held[k] && !self.spent[k] && !passes[k]);
        let places = self.places(model, (t, y));
        let is_told = |k: usize| matches!(self.contacts[k].role, Role::Gap | Role::Seen);
        let is_off = |k: usize| held[k] && is_told(k) && ends[k].is_finite();
        let gaps = from_fn(|k| if is_off(k) { ends[k] - places[k][0] } else { T::constant(0.0) });
        let moves = spread(&local.compliance, &gaps, held);
        let stops = spread(&local.compliance, &local.rates.map(|rate| -rate), held);
        let own = self.dynamics.rates(model);
        // Positions change by the rates that these impulses would give, for one second.
        let mut moved = y.clone();
        let [before, after] = scratch;
        self.push(model, (t, &mut moved), &moves, [before, after]);
        let zero = [T::constant(0.0); N];
        self.dynamics.forced(model, t, &moved, &zero, after);
        self.dynamics.forced(model, t, y, &zero, before);
        let work =
            self.dynamics.work(model).and_then(|place| y.as_ref().get(place).copied().zip(Some(place)));
        let changes = after.as_ref().iter().zip(before.as_ref()).map(|(after, before)| *after - *before);
        for (place, change) in y.as_mut().iter_mut().zip(changes).take(own.start) {
            *place = *place + change;
        }
        self.push(model, (t, y), &stops, [before, after]);
        if let Some((work, place)) = work {
            y.as_mut()[place] = work;
        }
        self.dynamics.normalise(model, y);
    }

    /// Has what slides go on in its present direction; returns a contact that creeps, slowly and no slower than it did
    /// before, and whether any comes to rest or is so slow that what is fast is its direction.
    pub(super) fn turn<M>(&mut self, model: &M, (t, y): (T, &D::State)) -> (Option<usize>, bool)
    where
        D: Forced<M, Scalar = T>,
    {
        if !self.phases.contains(&Phase::Slides) {
            return (None, false);
        }
        let rates = self.places(model, (t, y)).map(|[_, rate]| rate);
        self.turn_to(&rates);
        let (mut creeps, mut stops) = (None, false);
        for k in 0..N {
            let slip = self.contacts[k].slip().filter(|_| self.phases[k] == Phase::Slides);
            let Some((gap, false)) = slip else { continue };
            let (before, now) = (self.paces[k], pair_size(&rates, gap));
            // What does not move at all is held by other points.
            let moves = |speed: T| speed > self.slowest + self.slowest;
            let slows = moves(before) && now <= T::constant(SLOWING) * before;
            stops |= slows || (moves(now) && now < T::constant(SLOW) * self.creep);
            if moves(now) && now < self.creep && !slows {
                creeps = Some(k);
            }
            self.paces[k] = now;
        }
        (creeps, stops)
    }

    fn turn_to(&mut self, rates: &[T; N]) {
        for k in 0..N {
            let Some((gap, is_second)) = self.contacts[k].slip().filter(|_| self.phases[k] == Phase::Slides)
            else {
                continue;
            };
            let [along, across] = [gap + 1, gap + 2].map(|slip| at(rates, slip));
            let speed = pair_size(rates, gap);
            let vague = speed * T::constant(VAGUE);
            self.vague[k] = larger(self.vague[k], vague);
            if speed > self.vague[k] {
                self.ways[k] = (if is_second { across } else { along }) / speed;
            }
        }
    }

    /// The phases that are consistent with a state in which these surfaces rest on each other, and those do not slip;
    /// the bounds of some have just been reached.
    ///
    /// # Errors
    /// [`Error::Jammed`] if none are.
    pub(super) fn choose_surfaces<M>(
        &mut self,
        model: &M,
        (t, y): (T, &D::State),
        [rests, still, reached]: [&[bool; N]; 3],
        scratch: &mut D::State,
    ) -> Result<(), Error>
    where
        D: Forced<M, Scalar = T>,
    {
        let zero = T::constant(0.0);
        let places = self.places(model, (t, y));
        let rests_on = |k: usize| rests.get(k).is_some_and(|rests| *rests);
        (self.split, self.spent) = ([zero; N], [false; N]);
        self.phases = from_fn(|k| {
            let (contact, [x, rate]) = (&self.contacts[k], places[k]);
            let is_loaded = contact.slip().is_some_and(|(gap, _)| rests_on(gap)) && contact.acts();
            match contact.role {
                Role::Gap if rests[k] => Phase::AtLower,
                Role::Seen if rests[k] && contact.is_nearer_upper(x) => Phase::AtUpper,
                Role::Seen if rests[k] => Phase::AtLower,
                Role::Slip { .. } if is_loaded && still[k] => Phase::Sticks,
                Role::Slip { .. } if is_loaded => Phase::Slides,
                Role::Gap | Role::Slip { .. } => Phase::Free,
                Role::Coordinate if rate == zero && x <= contact.ends[0] => Phase::AtLower,
                Role::Coordinate if rate == zero && x >= contact.ends[1] => Phase::AtUpper,
                _ if !contact.rubs() => Phase::Free,
                _ if self.is_at_rest(k, rate) => Phase::Sticks,
                _ if rate > zero => Phase::Up,
                _ => Phase::Down,
            }
        });
        let held = self.phases.map(Phase::is_held);
        if !held.contains(&true) {
            return Ok(());
        }
        self.turn_to(&places.map(|[_, rate]| rate));
        let acting = from_fn(|k| match self.contacts[k].role {
            Role::Gap => rests[k],
            Role::Slip { .. } => self.phases[k] != Phase::Free,
            Role::Coordinate | Role::Seen => self.contacts[k].acts(),
        });
        let local = self.local(model, (t, y), &acting, scratch);
        let loads = self.loads(model, (t, y), &acting);
        // Of what does not move at all, as others lock it, that is left which is rounding beside all that moves.
        let noise = self.noise(model, (t, y), scratch);
        self.pass((&local, loads.as_ref()), noise);
        let pulls = self.pulls(&local.rates);
        let bound = |k: usize| match (&self.contacts[k], self.phases[k]) {
            (contact, Phase::Sticks) if contact.slip().is_some() => Bound::Plane(contact.coefficients[1]),
            (_, Phase::Slides) => Bound::Pulled(pulls[k]),
            (_, phase) if phase.is_held() && !self.spent[k] => Bound::Between(bounds(zero, phase)),
            _ => Bound::Given,
        };
        let contacts = self.contacts;
        let mut cones = Cones { contacts: &contacts, compliance: &local.compliance, bounds: from_fn(bound) };
        let kinetic = self.kinetic_forces();
        let jam = |contact| Jam { contact, gain: 1.0 };
        let (mut forces, mut error) = (kinetic, zero);
        // Reactions, to which friction is in proportion, follow all forces.
        for _ in 0..if loads.is_some() { LOADED } else { 1 } {
            let levels = self.levels(&forces, loads.as_ref());
            for ((bound, level), phase) in cones.bounds.iter_mut().zip(levels).zip(self.phases) {
                if let Bound::Between(range) = bound {
                    *range = bounds(level, phase);
                }
            }
            (forces, error) = cones.solved(&local.bias, forces).map_err(|k| self.jammed(t, &jam(k)))?;
        }
        // What does not hold slides, by the kinetic coefficient.
        let slides: [bool; N] = from_fn(|k| {
            let (Bound::Plane(coefficient), Some((gap, _))) = (cones.bounds[k], self.contacts[k].slip())
            else {
                return false;
            };
            let bound = coefficient * at(&forces, gap);
            bound > zero && pair_size(&forces, gap) > bound * T::constant(WITHIN)
        });
        if (0..N).any(|k| slides[k] && self.contacts[k].coefficients[0] < self.contacts[k].coefficients[1]) {
            for k in (0..N).filter(|k| slides[*k]) {
                cones.bounds[k] = Bound::Plane(self.contacts[k].coefficients[0]);
            }
            (forces, error) = cones.solved(&local.bias, kinetic).map_err(|k| self.jammed(t, &jam(k)))?;
        }
        self.weakest = larger(self.weakest, size(forces.iter()) * not_below_rounding(ROUNDING));
        self.slack = [self.weakest; N];
        let fastest = (0..N).filter(|k| acting[*k]).fold(zero, |most, k| larger(most, local.bias[k].abs()));
        self.largest = larger(self.largest, fastest);
        let [rounding, unmet] =
            [ROUNDING, UNMET].map(|limit| larger(not_below_rounding::<T>(limit) * self.largest, noise));
        let accelerations = local.accelerations(&forces);
        let firm: [bool; N] = from_fn(|k| match cones.bounds[k] {
            Bound::Between([low, high]) => low + self.weakest < forces[k] && forces[k] < high - self.weakest,
            Bound::Plane(_) => !slides[k],
            _ => false,
        });
        for k in 0..N {
            match (self.contacts[k].slip(), cones.bounds[k]) {
                // What cannot move, as others hold it, goes on pulling as much as it can.
                (None, Bound::Between(_))
                    if !firm[k] && self.contacts[k].rubs() && !yields(&local.compliance, k, &firm) =>
                {
                    self.spent[k] = true;
                }
                (None, Bound::Between([low, _]))
                    if forces[k] <= low + self.weakest && (reached[k] || accelerations[k] > rounding) =>
                {
                    self.leave(k, Phase::Up);
                }
                (None, Bound::Between([_, high]))
                    if forces[k] >= high - self.weakest && (reached[k] || accelerations[k] < -rounding) =>
                {
                    self.leave(k, Phase::Down);
                }
                (Some((gap, false)), Bound::Plane(_))
                    if slides[k]
                        && pair_size(&accelerations, gap) > larger(rounding, error * T::constant(UNSURE)) =>
                {
                    self.slide(gap, &forces);
                }
                _ => {}
            }
        }
        let stuck: [bool; N] = from_fn(|k| slides[k] && self.phases[k] == Phase::Sticks);
        for k in (0..N).filter(|k| stuck[*k]) {
            match self.contacts[k].slip() {
                Some((gap, false)) if reached[k] => self.slide(gap, &forces),
                Some((gap, false)) => {
                    self.slack[k] = T::constant(LOOSE) * self.contacts[k].coefficients[1] * at(&forces, gap);
                }
                _ => {}
            }
        }
        self.split = forces;
        // Exactly; and what is not consistent with its phase is given another one.
        let mut worst = zero;
        for _ in 0..REPAIRS * N {
            let acting = self.acting(&local, loads.as_ref(), true);
            if let Some(jam) = acting.jam {
                return Err(self.jammed(t, &jam));
            }
            let found = self.worst((&local, &acting), &places, [rests, still]);
            worst = found.map_or(zero, |(_, _, violation)| violation);
            match found {
                Some((k, phase, violation)) if violation > rounding => match (phase, self.contacts[k].slip())
                {
                    (Phase::Slides, Some((gap, _))) => self.slide(gap, &acting.forces),
                    (Phase::Sticks, Some((gap, _))) => {
                        self.phases.iter_mut().skip(gap + 1).take(2).for_each(|to| *to = phase)
                    }
                    (Phase::AtLower | Phase::AtUpper | Phase::Sticks, _) => self.phases[k] = phase,
                    _ => self.leave(k, phase),
                },
                _ => {
                    self.stay(&local, &acting, &places, rounding);
                    return Ok(());
                }
            }
        }
        if worst <= unmet { Ok(()) } else { Err(self.jammed(t, &jam(0))) }
    }

    /// Whether a coordinate does not move.
    fn is_at_rest(&self, k: usize, rate: T) -> bool {
        match self.contacts[k].role {
            Role::Seen => rate.abs() <= self.slowest,
            _ => rate == T::constant(0.0),
        }
    }

    /// What rounding may make of an acceleration.
    fn noise<M>(&self, model: &M, (t, y): (T, &D::State), scratch: &mut D::State) -> T
    where
        D: Forced<M, Scalar = T>,
    {
        self.dynamics.accelerations(model, t, y, &[T::constant(0.0); N], scratch);
        let own = self.dynamics.rates(model);
        let moves = scratch.as_ref().iter().take(own.end).skip(own.start);
        not_below_rounding::<T>(0.0) * size(moves)
    }

    /// What is to move and cannot, as others hold it, stays, and its friction pulls on.
    fn stay(
        &mut self,
        local: &Local<T, N>,
        Acting { forces, .. }: &Acting<T, N>,
        places: &[[T; 2]; N],
        least: T,
    ) {
        let accelerations = local.accelerations(forces);
        let held = from_fn(|k| self.phases[k].is_held() && !self.spent[k]);
        for k in 0..N {
            let is_to_move = matches!(self.phases[k], Phase::Up | Phase::Down);
            let is_at_rest = accelerations[k].abs() <= least && self.is_at_rest(k, places[k][1]);
            if is_to_move && is_at_rest && !yields(&local.compliance, k, &held) {
                (self.phases[k], self.spent[k], self.split[k]) = (Phase::Sticks, true, forces[k]);
            }
        }
    }

    /// What friction cannot hold, as a coordinate in the dead centre of a linkage, passes through rest; or stays, where
    /// it is locked.
    fn pass(&mut self, (local, loads): (&Local<T, N>, Option<&Loads<T, N>>), noise: T) {
        let slowed = self.slowed(local, loads);
        for k in (0..N).filter(|k| self.contacts[*k].slip().is_none()) {
            let bias = local.bias[k];
            match self.phases[k] {
                Phase::Sticks if slowed[k] <= noise && bias.abs() <= noise => self.spent[k] = true,
                Phase::Sticks if slowed[k] < larger(noise, T::constant(FEEBLE) * bias.abs()) => {
                    self.phases[k] = if bias > T::constant(0.0) { Phase::Up } else { Phase::Down };
                }
                _ => {}
            }
        }
    }

    /// The accelerations that friction takes alone.
    fn slowed(&self, local: &Local<T, N>, loads: Option<&Loads<T, N>>) -> [T; N] {
        let sizes = loads.map_or([T::constant(0.0); N], Loads::sizes);
        from_fn(|k| {
            let Contact { levels, coefficients, .. } = self.contacts[k];
            local.compliance[k][k].abs() * (levels[1] + coefficients[1] * sizes[k])
        })
    }

    /// A coordinate or a gap is let go this way; surfaces that part rub no longer.
    fn leave(&mut self, k: usize, way: Phase) {
        self.phases[k] = if self.contacts[k].rubs() { way } else { Phase::Free };
        if self.contacts[k].role == Role::Gap {
            self.phases.iter_mut().skip(k + 1).take(2).for_each(|phase| *phase = Phase::Free);
        }
    }

    /// Surfaces begin to slide where their friction does not want them to.
    fn slide(&mut self, gap: usize, forces: &[T; N]) {
        let (zero, size) = (T::constant(0.0), pair_size(forces, gap));
        for k in (gap + 1..gap + 3).filter(|k| *k < N) {
            self.phases[k] = Phase::Slides;
            self.ways[k] = if size > zero { -forces[k] / size } else { zero };
            self.vague[k] = larger(self.slowest, T::constant(SUDDEN) * self.largest);
        }
    }

    /// The contact that is least consistent with its phase, by how much, as an acceleration, and the phase that is
    /// another one.
    fn worst(
        &self,
        (local, acting): (&Local<T, N>, &Acting<T, N>),
        places: &[[T; 2]; N],
        [rests, still]: [&[bool; N]; 2],
    ) -> Option<(usize, Phase, T)> {
        let (zero, forces) = (T::constant(0.0), &acting.forces);
        let accelerations = local.accelerations(forces);
        let mut worst: Option<(usize, Phase, T)> = None;
        let mut note = |k: usize, phase: Phase, violation: T| {
            if violation > worst.map_or(zero, |(.., most)| most) {
                worst = Some((k, phase, violation));
            }
        };
        for (k, contact) in self.contacts.iter().enumerate() {
            let own = local.compliance[k][k].abs();
            match (contact.slip(), self.phases[k]) {
                (Some((gap, false)), Phase::Sticks) => {
                    let beyond = pair_size(forces, gap) - acting.levels[k] - self.slack[k];
                    note(k, Phase::Slides, beyond * own);
                }
                (Some((gap, false)), Phase::Slides) if still[k] => {
                    let along = (gap + 1..gap + 3).filter(|slip| *slip < N);
                    let along = along.fold(zero, |sum, slip| sum + accelerations[slip] * self.ways[slip]);
                    note(k, Phase::Sticks, -along);
                }
                (Some(_), _) => {}
                (None, phase) if phase.is_held() && !self.spent[k] => {
                    let [low, high] = bounds(acting.levels[k], phase);
                    note(k, Phase::Up, (low - self.weakest - forces[k]) * own);
                    note(k, Phase::Down, (forces[k] - high - self.weakest) * own);
                }
                (None, Phase::Free) if rests[k] => match contact.is_nearer_upper(places[k][0]) {
                    true => note(k, Phase::AtUpper, accelerations[k]),
                    false => note(k, Phase::AtLower, -accelerations[k]),
                },
                (None, Phase::Up) if self.is_at_rest(k, places[k][1]) => {
                    note(k, Phase::Sticks, -accelerations[k]);
                }
                (None, Phase::Down) if self.is_at_rest(k, places[k][1]) => {
                    note(k, Phase::Sticks, accelerations[k]);
                }
                _ => {}
            }
        }
        worst
    }
}

/// Whether a force along a contact moves it while these hold.
fn yields<T: Real, const N: usize>(compliance: &[[T; N]; N], k: usize, firm: &[bool; N]) -> bool {
    let column: [T; N] = from_fn(|i| compliance[i][k]);
    let response = spread(compliance, &column.map(|w| -w), firm);
    plus_product(&column, compliance, &response)[k] > T::constant(HELD) * compliance[k][k]
}

/// The size of the components of two slips.
fn pair_size<T: Real, const N: usize>(numbers: &[T; N], gap: usize) -> T {
    let [along, across] = [gap + 1, gap + 2].map(|slip| at(numbers, slip));
    (along * along + across * across).sqrt()
}
