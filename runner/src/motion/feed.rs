//! Equations whose inputs follow the time.
//!
//! A solver is handed the mechanism by reference, with the inputs that it has. Under error control inputs that vary
//! must be seen at the times of a step's stages: the equations then have a copy of the mechanism, whose inputs they set
//! before each evaluation. Between two knots an input is one cubic, at both ends too: steps end at knots, so that none
//! sees more than one piece.

use super::course::Course;
use super::lens::{Lens, Moving, MovingInputs, Pushed};
use crate::Input;
use crate::touch::Touch;
use gyro_sim::contact::{Forced, joint_accelerations};
use gyro_sim::{Clearance, Correction, Error, Jacobian, JointSpace, Mechanism, Ode, Scalar};
use std::array::from_fn;
use std::cell::{OnceCell, Ref, RefCell};
use std::ops::Range;
use std::rc::Rc;

/// Of so many contacts all combinations of what they do are tried.
pub(super) const FEW: usize = 8;

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
    /// What is to be told of each contact.
    told: Vec<Told>,
}

/// Where what is told of a contact is.
#[derive(Clone, Copy, Debug)]
pub(super) enum Told {
    /// In the state, or with the first force of the same surfaces.
    Elsewhere,
    /// Among the outputs, from here on: a coordinate, its rate and its acceleration.
    Coordinate(usize),
    /// In the joint state: a coordinate, and its rate; and of an angle where its turn reference is in the maximal one.
    InJoints([usize; 2], Option<usize>),
    /// Among the outputs, of surfaces.
    Surfaces([usize; 7]),
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
        self.force(mechanism, &[], Vec::new());
    }

    /// From now on these inputs are forces of contacts, set in a copy of the mechanism.
    pub(super) fn force(&mut self, mechanism: M, touches: &[Touch], told: Vec<Told>) {
        let feed = Feed {
            mechanism: RefCell::new(mechanism),
            pieces: RefCell::default(),
            forces: touches.iter().flat_map(Touch::inputs).copied().collect(),
            reactions: touches.iter().flat_map(reactions).collect(),
            told,
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

impl<L: Lens<M>, M: JointSpace> Fed<L, M> {
    /// The outputs under these forces.
    fn outputs(&self, t: M::Scalar, x: &L::State, forces: &[M::Scalar]) -> Option<M::Outputs> {
        let mechanism = self.feed.get()?.under(t, forces);
        let (mut y, mut outputs) = (mechanism.start(), mechanism.buffers().outputs);
        self.lens.show(&mechanism, t, x, &mut y);
        mechanism.outputs(t, &y, &mut outputs);
        Some(outputs)
    }

    /// The joint state, and u̇ at its place, under these forces.
    fn in_joints(&self, t: M::Scalar, x: &L::State, forces: &[M::Scalar]) -> Option<[M::Joints; 2]> {
        let mechanism = self.feed.get()?.under(t, forces);
        let (mut y, mut joints) = (mechanism.start(), mechanism.joint_start());
        self.lens.show(&mechanism, t, x, &mut y);
        for told in &self.feed.get()?.told {
            // Angles are those that are nearest to what is given.
            if let Told::InJoints([place, _], Some(turn)) = *told {
                joints.as_mut()[place] = y.as_ref()[turn];
            }
        }
        mechanism.to_joints(t, &y, &mut joints);
        let mut slopes = joints.clone();
        joint_accelerations(&*mechanism, t, &joints, &mut slopes);
        Some([joints, slopes])
    }
}

impl<L: Pushed<M>, M: JointSpace> Forced<M> for Fed<L, M> {
    const HAS_REACTIONS: bool = true;
    const HAS_SURFACES: bool = true;

    fn shares(&self, mechanism: &M) -> bool {
        !mechanism.joint_layout().closure_rows.is_empty() || self.forces().len() > FEW
    }

    fn seen(&self, _: &M, t: M::Scalar, x: &L::State, forces: &[M::Scalar], out: &mut [[M::Scalar; 3]]) {
        let told = self.feed.get().map_or(&[][..], |feed| &feed.told);
        let is_output = |told: &Told| matches!(told, Told::Coordinate(_) | Told::Surfaces(_));
        let outputs = told.iter().any(is_output).then(|| self.outputs(t, x, forces)).flatten();
        let output =
            |place: usize| outputs.as_ref().map_or(M::Scalar::constant(0.0), |all| all.as_ref()[place]);
        let joints = told.iter().any(|told| matches!(told, Told::InJoints(..)));
        let joints = joints.then(|| self.in_joints(t, x, forces)).flatten();
        for (k, told) in told.iter().enumerate() {
            match (*told, out.get_mut(k..)) {
                (Told::Coordinate(place), Some([own, ..])) => *own = from_fn(|i| output(place + i)),
                (Told::InJoints([place, rate], _), Some([own, ..])) => {
                    if let Some([x, slopes]) = &joints {
                        *own = [x.as_ref()[place], x.as_ref()[rate], slopes.as_ref()[rate]];
                    }
                }
                (Told::Surfaces(places), Some([gap, along, across, ..])) => {
                    let zero = M::Scalar::constant(0.0);
                    let [x, rate, second, slip, slip_rate, other, other_rate] = places.map(output);
                    (*gap, *along, *across) =
                        ([x, rate, second], [zero, slip, slip_rate], [zero, other, other_rate]);
                }
                _ => {}
            }
        }
    }

    fn rates(&self, mechanism: &M) -> Range<usize> {
        self.lens.rates(mechanism)
    }

    fn work(&self, mechanism: &M) -> Option<usize> {
        self.lens.work(mechanism)
    }

    fn forced(&self, mechanism: &M, t: M::Scalar, x: &L::State, forces: &[M::Scalar], dx: &mut L::State) {
        let Some(feed) = self.feed.get() else { return self.derivative(mechanism, t, x, dx) };
        let mechanism = feed.under(t, forces);
        self.lens.derivative(&*mechanism, t, x, dx);
    }

    fn accelerations(
        &self,
        mechanism: &M,
        t: M::Scalar,
        x: &L::State,
        forces: &[M::Scalar],
        dx: &mut L::State,
    ) {
        match self.feed.get() {
            None => self.lens.accelerate(mechanism, t, x, dx),
            Some(feed) => self.lens.accelerate(&*feed.under(t, forces), t, x, dx),
        }
    }

    fn reactions(&self, _: &M, t: M::Scalar, x: &L::State, forces: &[M::Scalar], out: &mut [[M::Scalar; 3]]) {
        let (Some(feed), Some(outputs)) = (self.feed.get(), self.outputs(t, x, forces)) else { return };
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
