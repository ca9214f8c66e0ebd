//! Equations whose inputs follow the time.
//!
//! A solver is handed the mechanism by reference, with the inputs that it has. Under error control inputs that vary
//! must be seen at the times of a step's stages: the equations then have a copy of the mechanism, whose inputs they set
//! before each evaluation. Between two knots an input is one cubic, at both ends too: steps end at knots, so that none
//! sees more than one piece.

use super::course::Course;
use super::lens::{Lens, Moving, MovingInputs};
use crate::Input;
use crate::touch::Touch;
use gyro_sim::contact::{Forced, joint_accelerations};
use gyro_sim::{Clearance, Correction, Error, Jacobian, Joint, JointSpace, Mechanism, Ode, Scalar};
use std::cell::{OnceCell, Ref, RefCell};
use std::ops::Range;
use std::rc::Rc;

/// Equations, perhaps with inputs that follow the time.
pub(super) struct Fed<L, M: Mechanism> {
    pub(super) lens: L,
    feed: Shared<M>,
}

/// What equations and their correction share.
pub(super) type Shared<M> = Rc<OnceCell<Feed<M>>>;

pub(super) struct Feed<M: Mechanism> {
    mechanism: RefCell<M>,
    pieces: RefCell<Vec<Piece<M::Scalar>>>,
    /// Of contacts, the inputs that are their forces, and where the reactions of their friction are among the outputs.
    forces: Vec<usize>,
    reactions: Vec<Option<usize>>,
    /// Of surfaces, where their numbers are among the outputs.
    surfaces: Vec<Option<[usize; 7]>>,
}

/// What an input is until the next knot.
struct Piece<T> {
    input: usize,
    origin: T,
    coefficients: [T; 4],
}

impl<T: Scalar> Piece<T> {
    fn new(input: &Input, t: f64) -> Self {
        let (origin, coefficients) = input.piece(t);
        Self { input: input.index, origin: T::constant(origin), coefficients: coefficients.map(T::constant) }
    }

    fn at(&self, t: T) -> Moving<T> {
        let (u, [c0, c1, c2, c3]) = (t - self.origin, self.coefficients);
        let (two, three) = (T::constant(2.0), T::constant(3.0));
        (self.input, [c0 + u * (c1 + u * (c2 + u * c3)), c1 + u * (two * c2 + u * (three * c3))])
    }
}

impl<M: Mechanism> Feed<M> {
    /// The mechanism with its inputs at a time.
    fn at(&self, t: M::Scalar) -> Ref<'_, M> {
        let mut mechanism = self.mechanism.borrow_mut();
        for piece in &*self.pieces.borrow() {
            let (index, [value, _]) = piece.at(t);
            mechanism.set_input(index, value);
        }
        drop(mechanism);
        self.mechanism.borrow()
    }

    /// The same, under these forces of contacts.
    fn under(&self, t: M::Scalar, forces: &[M::Scalar]) -> Ref<'_, M> {
        for (input, force) in self.forces.iter().zip(forces) {
            self.mechanism.borrow_mut().set_input(*input, *force);
        }
        self.at(t)
    }

    fn moving(&self, t: M::Scalar) -> Vec<Moving<M::Scalar>> {
        self.pieces.borrow().iter().map(|piece| piece.at(t)).collect()
    }
}

impl<L, M: Mechanism> Fed<L, M> {
    /// Equations with the inputs that the mechanism has.
    pub(super) fn of(lens: L) -> Self {
        Self { lens, feed: Shared::default() }
    }

    /// Their correction.
    pub(super) fn corrected<C>(&self, correction: C) -> Around<C, M> {
        Around { correction, feed: Rc::clone(&self.feed) }
    }

    /// From now on the inputs follow their course, in a copy of the mechanism.
    pub(super) fn follow(&mut self, mechanism: M) {
        self.force(mechanism, &[]);
    }

    /// From now on these inputs are forces of contacts, set in a copy of the mechanism.
    pub(super) fn force(&mut self, mechanism: M, touches: &[Touch]) {
        let feed = Feed {
            mechanism: RefCell::new(mechanism),
            pieces: RefCell::default(),
            forces: touches.iter().flat_map(Touch::inputs).copied().collect(),
            reactions: touches.iter().flat_map(reactions).collect(),
            surfaces: touches.iter().flat_map(surfaces).collect(),
        };
        // A motion is begun once.
        let _ = self.feed.set(feed);
    }

    /// The inputs that are forces of contacts.
    pub(super) fn forces(&self) -> &[usize] {
        self.feed.get().map_or(&[], |feed| &feed.forces)
    }

    /// An input changes that follows no course.
    pub(super) fn set_input(&mut self, index: usize, value: f64)
    where
        L: Lens<M>,
    {
        self.lens.set_input(index, value);
        if let Some(feed) = self.feed.get() {
            feed.mechanism.borrow_mut().set_input(index, M::Scalar::constant(value));
        }
    }

    /// A knot has been reached: from here on other pieces hold.
    pub(super) fn enter(&mut self, course: &Course, t: f64) {
        if let Some(feed) = self.feed.get() {
            let pieces = course.inputs().iter().map(|input| Piece::new(input, t));
            feed.pieces.replace(pieces.collect());
        }
    }
}

impl<L: Ode<M, Scalar = M::Scalar>, M: Mechanism> Ode<M> for Fed<L, M> {
    type Scalar = M::Scalar;
    type State = L::State;

    fn derivative(&self, mechanism: &M, t: M::Scalar, y: &L::State, dy: &mut L::State) {
        match self.feed.get() {
            None => self.lens.derivative(mechanism, t, y, dy),
            Some(feed) => self.lens.derivative(&feed.at(t), t, y, dy),
        }
    }

    fn normalise(&self, mechanism: &M, y: &mut L::State) {
        self.lens.normalise(mechanism, y);
    }
}

/// Of each force of a contact the reaction that its friction grows with.
fn reactions(touch: &Touch) -> Vec<Option<usize>> {
    match touch {
        Touch::Stop(stop) => vec![stop.reaction],
        Touch::Surfaces(_) => vec![None; 3],
    }
}

/// Of the first force of surfaces where the numbers of all three are.
fn surfaces(touch: &Touch) -> Vec<Option<[usize; 7]>> {
    match touch {
        Touch::Stop(_) => vec![None],
        Touch::Surfaces(surfaces) => vec![Some(surfaces.outputs), None, None],
    }
}

impl<M: JointSpace<Joints: 'static> + 'static> Forced<M> for Fed<Joint, M> {
    const HAS_REACTIONS: bool = true;
    const HAS_SURFACES: bool = true;

    fn seen(&self, _: &M, t: M::Scalar, x: &M::Joints, forces: &[M::Scalar], out: &mut [[M::Scalar; 3]]) {
        let Some(feed) = self.feed.get() else { return };
        let mechanism = feed.under(t, forces);
        let (mut y, mut outputs) = (mechanism.start(), mechanism.buffers().outputs);
        mechanism.to_maximal(t, x, &mut y);
        mechanism.outputs(t, &y, &mut outputs);
        for (k, places) in feed.surfaces.iter().enumerate() {
            if let (Some(places), Some([gap, along, across])) = (places, out.get_mut(k..k + 3)) {
                let zero = M::Scalar::constant(0.0);
                let [x, rate, second, slip, slip_rate, other, other_rate] =
                    places.map(|place| outputs.as_ref()[place]);
                (*gap, *along, *across) =
                    ([x, rate, second], [zero, slip, slip_rate], [zero, other, other_rate]);
            }
        }
    }

    fn rates(&self, mechanism: &M) -> Range<usize> {
        let layout = mechanism.joint_layout();
        let n = layout.n_coordinates();
        n..n + layout.n_rates()
    }

    fn work(&self, mechanism: &M) -> Option<usize> {
        Some(Forced::<M>::rates(self, mechanism).end)
    }

    fn forced(&self, mechanism: &M, t: M::Scalar, x: &M::Joints, forces: &[M::Scalar], dx: &mut M::Joints) {
        let Some(feed) = self.feed.get() else { return self.derivative(mechanism, t, x, dx) };
        let mechanism = feed.under(t, forces);
        self.lens.derivative(&*mechanism, t, x, dx);
    }

    fn accelerations(
        &self,
        mechanism: &M,
        t: M::Scalar,
        x: &M::Joints,
        forces: &[M::Scalar],
        dx: &mut M::Joints,
    ) {
        match self.feed.get() {
            None => joint_accelerations(mechanism, t, x, dx),
            Some(feed) => joint_accelerations(&*feed.under(t, forces), t, x, dx),
        }
    }

    fn reactions(
        &self,
        _: &M,
        t: M::Scalar,
        x: &M::Joints,
        forces: &[M::Scalar],
        out: &mut [[M::Scalar; 3]],
    ) {
        let Some(feed) = self.feed.get() else { return };
        let mechanism = feed.under(t, forces);
        let (mut y, mut outputs) = (mechanism.start(), mechanism.buffers().outputs);
        mechanism.to_maximal(t, x, &mut y);
        mechanism.outputs(t, &y, &mut outputs);
        for (out, place) in out.iter_mut().zip(&feed.reactions) {
            if let Some(force) = place.and_then(|place| outputs.as_ref().get(place..place + 3)) {
                out.copy_from_slice(force);
            }
        }
    }
}

impl<L: MovingInputs<M>, M: Mechanism> Jacobian<M> for Fed<L, M> {
    type Matrix = L::Matrix;

    fn jacobian(&self, mechanism: &M, t: M::Scalar, y: &L::State, dfdy: &mut L::Matrix, dfdt: &mut L::State) {
        match self.feed.get() {
            None => self.lens.jacobian(mechanism, t, y, dfdy, dfdt),
            Some(feed) => {
                let inputs = feed.moving(t);
                self.lens.moving_jacobian(&feed.at(t), &inputs, (t, y), dfdy, dfdt);
            }
        }
    }
}

/// A correction of the equations, which sees the inputs that motions follow as the equations do.
pub(super) struct Around<C, M: Mechanism> {
    correction: C,
    feed: Shared<M>,
}

impl<C, M: Mechanism> Around<C, M> {
    /// What is done with the mechanism as it is at a time.
    fn at<R>(&mut self, t: M::Scalar, mechanism: &M, what: impl FnOnce(&mut C, &M) -> R) -> R {
        match self.feed.get() {
            None => what(&mut self.correction, mechanism),
            Some(feed) => what(&mut self.correction, &feed.at(t)),
        }
    }
}

impl<L, M, C> Correction<Fed<L, M>, M> for Around<C, M>
where
    L: Ode<M, Scalar = M::Scalar>,
    M: Mechanism,
    C: Correction<L, M>,
{
    fn correct(&mut self, mechanism: &M, t: M::Scalar, y: &mut L::State) -> Result<(), Error> {
        self.at(t, mechanism, |correction, mechanism| correction.correct(mechanism, t, y))
    }
    fn refer_turns(&mut self, mechanism: &M, t: M::Scalar, y: &mut L::State) {
        self.correction.refer_turns(mechanism, t, y);
    }
    fn violation(&mut self, mechanism: &M, t: M::Scalar, y: &L::State) -> M::Scalar {
        self.at(t, mechanism, |correction, mechanism| correction.violation(mechanism, t, y))
    }
    fn switches(&self) -> u64 {
        self.correction.switches()
    }
    fn clearance(&self, mechanism: &M, t: M::Scalar, y: &L::State) -> Option<Clearance<M::Scalar>> {
        self.correction.clearance(mechanism, t, y)
    }
}
