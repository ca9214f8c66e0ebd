//! A motion with rigid stops and friction that sticks, under way.

use super::attempt::{Look, Shown};
use super::contract::{Begun, Motion};
use super::course::Course;
use super::feed::{Around, FEW, Fed, Told};
use super::kink::struck;
use super::lens::Pushed;
use super::moving::control;
use crate::approach::Approach;
use crate::touch::{Stop, Surfaces, Touch};
use crate::watch::What;
use gyro_sim::contact::{self, Contact, Contacts, Hybrid, Phase, Restitution};
use gyro_sim::integrate::Method;
use gyro_sim::{
    Correction, Error, JointPlace, JointSpace, Mechanism, Ode, Real, Scalar, Statistics, by_method,
};

/// The contacts of a run; those that it does not have do nothing. Surfaces have three at each point.
const MANY: usize = 96;

type Touching<M, L, A, C, const N: usize> =
    Hybrid<Fed<L, M>, <L as Ode<M>>::State, <M as Mechanism>::Scalar, A, Around<C, M>, N>;

/// A motion with contacts from a state on, by explicit methods.
pub(super) fn touching<M, L, C>(
    (mechanism, lens): (&M, L),
    correction: C,
    approach: &Approach,
    x: &L::State,
    touches: &[Touch],
) -> Begun<M>
where
    M: JointSpace<Scalar: Real> + Clone + 'static,
    L: Pushed<M>,
    C: Correction<L, M> + 'static,
{
    let count = touches.iter().map(|touch| touch.inputs().len()).sum::<usize>();
    if count <= FEW && L::IN_JOINTS {
        return with::<M, L, C, FEW>((mechanism, lens), correction, approach, x, touches);
    }
    with::<M, L, C, MANY>((mechanism, lens), correction, approach, x, touches)
}

/// With room for so many.
fn with<M, L, C, const N: usize>(
    (mechanism, lens): (&M, L),
    correction: C,
    approach: &Approach,
    x: &L::State,
    touches: &[Touch],
) -> Begun<M>
where
    M: JointSpace<Scalar: Real> + Clone + 'static,
    L: Pushed<M>,
    C: Correction<L, M> + 'static,
{
    let (by, from) = ((mechanism, lens), (approach, x));
    Ok(by_method!(
        approach.integrator,
        fixed A => fixed::<M, L, _, C, N>(begin(by, A::new(x), correction, from, touches)?, owners(touches)),
        adaptive A => adaptive::<M, L, _, C, N>(begin(by, A::new(x), correction, from, touches)?, owners(touches)),
        implicit => return Err(super::contract::NOT_TOUCHING.to_owned()),
    ))
}

/// The same by an implicit method.
pub(super) fn touching_by<M, L, A, C>(
    by: (&M, L),
    method: A,
    correction: C,
    approach: &Approach,
    x: &L::State,
    touches: &[Touch],
) -> Begun<M>
where
    M: JointSpace<Scalar: Real> + Clone + 'static,
    L: Pushed<M>,
    A: Method<Contacts<Fed<L, M>, M::Scalar, MANY>, M> + 'static,
    C: Correction<L, M> + 'static,
{
    let hybrid = begin(by, method, correction, (approach, x), touches)?;
    Ok(adaptive::<M, L, A, C, MANY>(hybrid, owners(touches)))
}

fn begin<M, L, A, C, const N: usize>(
    (mechanism, lens): (&M, L),
    method: A,
    correction: C,
    (approach, x): (&Approach, &L::State),
    touches: &[Touch],
) -> Result<Touching<M, L, A, C, N>, String>
where
    M: JointSpace<Scalar: Real> + Clone + 'static,
    L: Pushed<M>,
    A: Method<Contacts<Fed<L, M>, M::Scalar, N>, M> + 'static,
    C: Correction<L, M> + 'static,
{
    let mut contacts = [Contact::new(0, 0); N];
    let mut told = Vec::new();
    for touch in touches {
        let place = told.len();
        let (own, of_own) = match touch {
            Touch::Stop(stop) => {
                let (contact, told) = stopped::<M, L>(mechanism, stop)?;
                (vec![contact], vec![told])
            }
            Touch::Surfaces(one) => {
                let told_of = vec![Told::Surfaces(one.outputs), Told::Elsewhere, Told::Elsewhere];
                (surfaces(place, one)?, told_of)
            }
        };
        let room = contacts.get_mut(place..place + own.len()).ok_or_else(too_many::<N>)?;
        room.copy_from_slice(&own);
        told.extend(of_own);
    }
    let mut equations = Fed::of(lens);
    equations.force(mechanism.clone(), touches, told);
    let zero = Scalar::constant(0.0);
    let correction = equations.corrected(correction);
    let hybrid = Hybrid::with_correction(equations, contacts, method, correction, zero, x);
    Ok(hybrid.with_control(control(approach)))
}

/// In steps of fixed length.
fn fixed<M, L, A, C, const N: usize>(
    hybrid: Touching<M, L, A, C, N>,
    owners: Vec<usize>,
) -> Box<dyn Motion<M>>
where
    M: JointSpace<Scalar: Real> + Clone + 'static,
    L: Pushed<M>,
    A: Method<Contacts<Fed<L, M>, M::Scalar, N>, M> + 'static,
    C: Correction<L, M> + 'static,
{
    // It has no error estimate: one step.
    let towards: Towards<M, L, A, C, N> =
        |hybrid, mechanism, t_end, _| hybrid.move_by(mechanism, t_end - hybrid.time());
    Box::new(Contacting { hybrid, towards, course: None, owners })
}

/// Under error control.
fn adaptive<M, L, A, C, const N: usize>(
    hybrid: Touching<M, L, A, C, N>,
    owners: Vec<usize>,
) -> Box<dyn Motion<M>>
where
    M: JointSpace<Scalar: Real> + Clone + 'static,
    L: Pushed<M>,
    A: Method<Contacts<Fed<L, M>, M::Scalar, N>, M> + 'static,
    C: Correction<L, M> + 'static,
{
    let towards: Towards<M, L, A, C, N> = |hybrid, mechanism, t_end, look| {
        let mut x = hybrid.state().clone();
        let watched = hybrid.move_towards(mechanism, t_end, |tried| {
            let show = |equations: &Contacts<Fed<L, M>, M::Scalar, N>, t, x: &L::State, y: &mut M::State| {
                equations.dynamics().lens.show(mechanism, t, x, y);
            };
            look(&mut Shown { tried, x: &mut x, show }).map(Scalar::constant)
        });
        watched.map(|_| ())
    };
    Box::new(Contacting { hybrid, towards, course: None, owners })
}

/// One step, not beyond a time.
type Towards<M, L, A, C, const N: usize> = fn(
    &mut Touching<M, L, A, C, N>,
    &M,
    <M as Mechanism>::Scalar,
    &mut Look<'_, M>,
) -> Result<(), contact::Error>;

/// Whose each contact is.
fn owners(touches: &[Touch]) -> Vec<usize> {
    touches.iter().enumerate().flat_map(|(owner, touch)| vec![owner; touch.inputs().len()]).collect()
}

fn too_many<const N: usize>() -> String {
    format!("more than {} points may touch: leave out shapes that do not, or name those that do", N / 3)
}

/// Surfaces, as contacts from this place on.
fn surfaces<T: Real>(place: usize, surfaces: &Surfaces) -> Result<Vec<Contact<T>>, String> {
    let share = T::constant(surfaces.restitution);
    let law = if surfaces.is_of_impulses { Restitution::Poisson(share) } else { Restitution::Newton(share) };
    let contacts = Contact::surfaces(place, law, surfaces.coefficients.map(T::constant));
    contacts.map(Vec::from).ok_or_else(|| NO_CONTACT.to_owned())
}

const NO_CONTACT: &str = "the numbers of a contact make none";

/// A contact along a coordinate, and where what is told of it is.
fn stopped<M, L>(mechanism: &M, stop: &Stop) -> Result<(Contact<M::Scalar>, Told), String>
where
    M: JointSpace<Scalar: Real>,
    L: Pushed<M>,
{
    let (contact, told) = match (stop.seen, L::IN_JOINTS) {
        (Some(place), _) => (Contact::seen(), Told::Coordinate(place)),
        (None, true) => {
            let [coordinate, rate] = place(mechanism, stop)?;
            (Contact::new(coordinate, rate), Told::Elsewhere)
        }
        (None, false) => (Contact::seen(), Told::InJoints(place(mechanism, stop)?, turn(mechanism, stop))),
    };
    let constant = |x: f64| M::Scalar::constant(x);
    let [levels, coefficients] = [stop.levels, stop.coefficients].map(|pair| pair.map(constant));
    let contact = contact
        .with_stops(stop.ends.map(constant), constant(stop.restitution))
        .and_then(|contact| contact.with_friction(levels[0], levels[1]))
        .and_then(|contact| contact.with_loaded_friction(coefficients[0], coefficients[1]));
    Ok((contact.ok_or(NO_CONTACT)?, told))
}

/// Where the turn reference of a stop's coordinate is in the maximal state.
fn turn<M: Mechanism>(mechanism: &M, stop: &Stop) -> Option<usize> {
    let description = mechanism.description();
    let reading = description.reading(stop.on.0, stop.on.1)?;
    let places = description.turn_references;
    let index = places.iter().position(|place| usize::from(*place) == reading)?;
    Some(mechanism.start().as_ref().len() - places.len() + index)
}

/// Where the coordinate of a stop and its rate are in the joint state.
fn place<M: JointSpace>(mechanism: &M, stop: &Stop) -> Result<[usize; 2], String> {
    let layout = mechanism.joint_layout();
    let (mut coordinate, mut rate) = (0, layout.n_coordinates());
    for place in layout.places {
        if let JointPlace::Scalar { joint, coordinate: own } = *place
            && (usize::from(joint), usize::from(own)) == stop.on
        {
            return Ok([coordinate, rate]);
        }
        coordinate += place.n_coordinates();
        rate += place.n_rates();
    }
    let joint = mechanism.description().joints.get(stop.on.0).map_or("", |joint| joint.name);
    Err(format!(
        "a rigid stop or friction that sticks is on joint `{joint}`, whose coordinate a driver determines: put it on a joint that \
         moves freely"
    ))
}

struct Contacting<M: JointSpace, L: Pushed<M>, A, C, const N: usize> {
    hybrid: Touching<M, L, A, C, N>,
    towards: Towards<M, L, A, C, N>,
    course: Option<Course>,
    /// Of which of the run's contacts each is.
    owners: Vec<usize>,
}

impl<M, L, A, C, const N: usize> Motion<M> for Contacting<M, L, A, C, N>
where
    M: JointSpace<Scalar: Real> + Clone + 'static,
    L: Pushed<M>,
    A: Method<Contacts<Fed<L, M>, M::Scalar, N>, M>,
    C: Correction<L, M>,
{
    fn step(&mut self, mechanism: &M, h: f64) -> Result<(), contact::Error> {
        self.hybrid.move_by(mechanism, Scalar::constant(h))
    }

    fn step_towards(
        &mut self,
        mechanism: &M,
        t_end: f64,
        look: &mut Look<'_, M>,
    ) -> Result<(), contact::Error> {
        let mut t_end = t_end;
        if let Some(course) = &mut self.course {
            if let Some(knot) = course.pass::<M::Scalar>(self.hybrid.time().to_f64()) {
                self.hybrid.dynamics_mut().enter(course, knot);
                self.hybrid.system_has_changed();
            }
            t_end = course.ahead::<M::Scalar>().map_or(t_end, |knot| knot.min(t_end));
        }
        (self.towards)(&mut self.hybrid, mechanism, Scalar::constant(t_end), look)
    }

    fn correct(&mut self, mechanism: &M) -> Result<(), Error> {
        self.hybrid.correct(mechanism)
    }

    fn time(&self) -> f64 {
        self.hybrid.time().to_f64()
    }

    fn at(&mut self, mechanism: &M, t: f64, y: &mut M::State) -> Result<(), Error> {
        let (mut x, t) = (self.hybrid.state().clone(), Scalar::constant(t));
        self.hybrid.interpolate(mechanism, t, &mut x)?;
        self.hybrid.dynamics().lens.show(mechanism, t, &x, y);
        Ok(())
    }

    fn set_by_itself(
        &mut self,
        mechanism: &M,
        t: f64,
        tell: &mut dyn FnMut(usize, M::Scalar),
    ) -> Result<(), Error> {
        let forces = self.hybrid.forces_at(mechanism, Scalar::constant(t))?;
        for (input, force) in self.hybrid.dynamics().forces().iter().zip(forces) {
            tell(*input, force);
        }
        Ok(())
    }

    fn set_input(&mut self, index: usize, value: f64) {
        self.hybrid.dynamics_mut().set_input(index, value);
        self.hybrid.system_has_changed();
    }

    fn follow(&mut self, _: Option<M>, course: Course) {
        self.hybrid.dynamics_mut().enter(&course, 0.0);
        self.course = Some(course);
        self.hybrid.system_has_changed();
    }

    fn strike(&mut self, before: [&M; 2], after: [&M; 2]) {
        let at = (self.hybrid.time(), self.hybrid.state());
        let x = struck(&self.hybrid.dynamics().lens, at, [before, after]);
        self.hybrid.strike(&x);
    }

    fn resolve(&mut self, mechanism: &M, tell: &mut dyn FnMut(What)) {
        if !self.hybrid.resolve(mechanism) {
            return;
        }
        let is_pair = |contact: usize| self.owners.iter().filter(|owner| **owner == contact).count() > 1;
        let mut last = [None; 2];
        for (&contact, change) in self.owners.iter().zip(self.hybrid.changes()) {
            // Both components of slip do the same.
            if last == [Some(contact); 2] {
                continue;
            }
            last = [Some(contact), last[0]];
            if let Some(rates) = change.hit {
                let [before, after] = rates.map(|rate| rate.to_f64());
                tell(What::Hit { contact, before, after });
            }
            match change.phases {
                [before, after] if before == after => {}
                [_, Phase::AtLower | Phase::AtUpper] => tell(What::Rests { contact }),
                [_, Phase::Sticks] => tell(What::Sticks { contact }),
                [Phase::AtLower | Phase::AtUpper, _] => tell(What::Leaves { contact }),
                [_, Phase::Slides] => tell(What::Slips { contact }),
                [Phase::Sticks, Phase::Free] if is_pair(contact) => {}
                [Phase::Sticks, _] => tell(What::Slips { contact }),
                _ => {}
            }
        }
    }

    fn lost(&self) -> f64 {
        self.hybrid.record().lost.to_f64()
    }

    fn statistics(&self) -> Statistics {
        *self.hybrid.statistics()
    }

    fn chart_switches(&self) -> u64 {
        Correction::<Fed<L, M>, M>::switches(self.hybrid.correction())
    }
}
