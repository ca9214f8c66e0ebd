//! A motion with rigid stops and friction that sticks, under way.

use super::attempt::{Look, Shown};
use super::contract::{Begun, Motion};
use super::course::Course;
use super::feed::{Around, Fed};
use super::kink::struck;
use super::lens::Lens;
use super::moving::control;
use crate::approach::Approach;
use crate::touch::{Stop, Surfaces, Touch};
use crate::watch::What;
use gyro_sim::contact::{self, Contact, Contacts, Hybrid, Phase, Restitution};
use gyro_sim::integrate::Method;
use gyro_sim::{Correction, Error, Joint, JointPlace, JointSpace, Real, Scalar, Statistics, by_method};

/// The contacts of a run; those that it does not have do nothing. Surfaces have three at each point.
const FEW: usize = 8;
const MANY: usize = 96;

type Touching<M, A, C, const N: usize> =
    Hybrid<Fed<Joint, M>, <M as JointSpace>::Joints, <M as gyro_sim::Mechanism>::Scalar, A, Around<C, M>, N>;

/// A motion with contacts from a joint state on.
pub(super) fn touching<M, C>(
    mechanism: &M,
    correction: C,
    approach: &Approach,
    x: &M::Joints,
    touches: &[Touch],
) -> Begun<M>
where
    M: JointSpace<Scalar: Real, Joints: 'static> + Clone + 'static,
    C: Correction<Joint, M> + 'static,
{
    let count = touches.iter().map(|touch| touch.inputs().len()).sum::<usize>();
    if count <= FEW {
        return with::<M, C, FEW>(mechanism, correction, approach, x, touches);
    }
    with::<M, C, MANY>(mechanism, correction, approach, x, touches)
}

/// With room for so many.
fn with<M, C, const N: usize>(
    mechanism: &M,
    correction: C,
    approach: &Approach,
    x: &M::Joints,
    touches: &[Touch],
) -> Begun<M>
where
    M: JointSpace<Scalar: Real, Joints: 'static> + Clone + 'static,
    C: Correction<Joint, M> + 'static,
{
    Ok(by_method!(
        approach.integrator,
        fixed A => fixed::<M, _, C, N>(begin(mechanism, A::new(x), correction, (approach, x), touches)?, owners(touches)),
        adaptive A => adaptive::<M, _, C, N>(begin(mechanism, A::new(x), correction, (approach, x), touches)?, owners(touches)),
        implicit => return Err(super::contract::NOT_TOUCHING.to_owned()),
    ))
}

fn begin<M, A, C, const N: usize>(
    mechanism: &M,
    method: A,
    correction: C,
    (approach, x): (&Approach, &M::Joints),
    touches: &[Touch],
) -> Result<Touching<M, A, C, N>, String>
where
    M: JointSpace<Scalar: Real, Joints: 'static> + Clone + 'static,
    A: Method<Contacts<Fed<Joint, M>, M::Scalar, N>, M> + 'static,
    C: Correction<Joint, M> + 'static,
{
    let mut contacts = [Contact::new(0, 0); N];
    let mut place = 0;
    for touch in touches {
        let own = match touch {
            Touch::Stop(stop) => vec![contact(mechanism, stop)?],
            Touch::Surfaces(surfaces) => self::surfaces(place, surfaces)?,
        };
        let room = contacts.get_mut(place..place + own.len()).ok_or_else(too_many::<N>)?;
        room.copy_from_slice(&own);
        place += own.len();
    }
    let mut equations = Fed::of(Joint);
    equations.force(mechanism.clone(), touches);
    let zero = Scalar::constant(0.0);
    let correction = equations.corrected(correction);
    let hybrid = Hybrid::with_correction(equations, contacts, method, correction, zero, x);
    Ok(hybrid.with_control(control(approach)))
}

/// In steps of fixed length.
fn fixed<M, A, C, const N: usize>(hybrid: Touching<M, A, C, N>, owners: Vec<usize>) -> Box<dyn Motion<M>>
where
    M: JointSpace<Scalar: Real, Joints: 'static> + Clone + 'static,
    A: Method<Contacts<Fed<Joint, M>, M::Scalar, N>, M> + 'static,
    C: Correction<Joint, M> + 'static,
{
    // It has no error estimate: one step.
    let towards: Towards<M, A, C, N> =
        |hybrid, mechanism, t_end, _| hybrid.move_by(mechanism, t_end - hybrid.time());
    Box::new(Contacting { hybrid, towards, course: None, owners })
}

/// Under error control.
fn adaptive<M, A, C, const N: usize>(hybrid: Touching<M, A, C, N>, owners: Vec<usize>) -> Box<dyn Motion<M>>
where
    M: JointSpace<Scalar: Real, Joints: 'static> + Clone + 'static,
    A: Method<Contacts<Fed<Joint, M>, M::Scalar, N>, M> + 'static,
    C: Correction<Joint, M> + 'static,
{
    let towards: Towards<M, A, C, N> = |hybrid, mechanism, t_end, look| {
        let mut x = hybrid.state().clone();
        let watched = hybrid.move_towards(mechanism, t_end, |tried| {
            let show = |_: &Contacts<Fed<Joint, M>, M::Scalar, N>, t, x: &M::Joints, y: &mut M::State| {
                Joint.show(mechanism, t, x, y);
            };
            look(&mut Shown { tried, x: &mut x, show }).map(Scalar::constant)
        });
        watched.map(|_| ())
    };
    Box::new(Contacting { hybrid, towards, course: None, owners })
}

/// One step, not beyond a time.
type Towards<M, A, C, const N: usize> = fn(
    &mut Touching<M, A, C, N>,
    &M,
    <M as gyro_sim::Mechanism>::Scalar,
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

/// A contact along a coordinate of the joint state.
fn contact<M: JointSpace<Scalar: Real>>(mechanism: &M, touch: &Stop) -> Result<Contact<M::Scalar>, String> {
    let layout = mechanism.joint_layout();
    let (mut coordinate, mut rate) = (0, layout.n_coordinates());
    for place in layout.places {
        if let JointPlace::Scalar { joint, coordinate: own } = *place
            && (usize::from(joint), usize::from(own)) == touch.on
        {
            let constant = |x: f64| M::Scalar::constant(x);
            let contact = Contact::new(coordinate, rate)
                .with_stops(touch.ends.map(constant), constant(touch.restitution))
                .and_then(|contact| {
                    contact.with_friction(constant(touch.levels[0]), constant(touch.levels[1]))
                })
                .and_then(|contact| {
                    let [kinetic, at_rest] = touch.coefficients.map(constant);
                    contact.with_loaded_friction(kinetic, at_rest)
                });
            return contact.ok_or_else(|| NO_CONTACT.to_owned());
        }
        coordinate += place.n_coordinates();
        rate += place.n_rates();
    }
    let joint = mechanism.description().joints.get(touch.on.0).map_or("", |joint| joint.name);
    Err(format!(
        "a rigid stop or friction that sticks is on joint `{joint}`, whose coordinate a coupler or a driver determines: put it \
         on the joint that moves freely"
    ))
}

struct Contacting<M: JointSpace, A, C, const N: usize> {
    hybrid: Touching<M, A, C, N>,
    towards: Towards<M, A, C, N>,
    course: Option<Course>,
    /// Of which of the run's contacts each is.
    owners: Vec<usize>,
}

impl<M, A, C, const N: usize> Motion<M> for Contacting<M, A, C, N>
where
    M: JointSpace<Scalar: Real, Joints: 'static> + Clone + 'static,
    A: Method<Contacts<Fed<Joint, M>, M::Scalar, N>, M>,
    C: Correction<Joint, M>,
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
        Joint.show(mechanism, t, &x, y);
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
        let x = struck(&Joint, at, [before, after]);
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
        Correction::<Fed<Joint, M>, M>::switches(self.hybrid.correction())
    }
}
