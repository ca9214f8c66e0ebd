//! Newton–Euler recursion along a chain: outwards the motion, inwards the forces.
//!
//! Luh, Walker and Paul (1980), "On-line computational scheme for mechanical manipulators", in global vectors
//! instead of link frames. With F and T the force and torque (about the joint point J) that a link receives
//! from the one before:
//!
//! ```text
//! F_k = m (r̈_k − g) + F_{k+1}
//! T_k = J ω̇ + ω×J ω + (r_k − J_k)×m (r̈_k − g) + T_{k+1} + (J_{k+1} − J_k)×F_{k+1}
//! ```

use crate::DoubleDouble;
use crate::base_motion::{FrameMotion, unit};
use crate::link::{Freedom, Link};
use crate::rotation::{ORIGIN, Precise, tensor_times};
use crate::trajectory::{decimal, decimals};
use crate::vector::{add, cross, dot, scale, sub};

/// A [`Link`] in double-double numbers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PreciseLink {
    freedom: Freedom,
    axis: Precise,
    before: Precise,
    own: Precise,
    pub(crate) mass: DoubleDouble,
    inertia: [DoubleDouble; 6],
    pub(crate) damping: DoubleDouble,
    pub(crate) stiffness: DoubleDouble,
    pub(crate) free: DoubleDouble,
}

/// Force and torque on a link at its joint point, global.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Load {
    pub(crate) force: Precise,
    pub(crate) torque: Precise,
}

/// One link in motion: its frame has its origin at the mass centre.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LinkMotion {
    pub(crate) frame: FrameMotion,
    /// The link's own joint point, global.
    pub(crate) joint: Precise,
    /// The joint's axis, global.
    pub(crate) axis: Precise,
}

impl PreciseLink {
    pub(crate) fn new(link: &Link) -> Self {
        PreciseLink {
            freedom: link.freedom,
            axis: unit(link.axis),
            before: decimals(link.before),
            own: decimals(link.own),
            mass: decimal(link.mass),
            inertia: decimals(link.inertia),
            damping: decimal(link.damping),
            stiffness: decimal(link.stiffness),
            free: decimal(link.free),
        }
    }

    /// The link's motion on one that moves like `parent`, at coordinate, rate and acceleration `q`.
    pub(crate) fn carried(&self, parent: &FrameMotion, q: [DoubleDouble; 3]) -> LinkMotion {
        let mut frame = *parent;
        let axis = parent.rotation.times(self.axis);
        frame.shift(parent.rotation.times(self.before));
        match self.freedom {
            Freedom::Turn => frame.turn(self.axis, q),
            Freedom::Slide => slide(&mut frame, axis, q),
        }
        let joint = frame.position;
        frame.shift(frame.rotation.times(self.own.map(|x| -x)));
        LinkMotion { frame, joint, axis }
    }

    /// The part of `load` along the coordinate: its generalised force.
    pub(crate) fn along(&self, motion: &LinkMotion, load: &Load) -> DoubleDouble {
        match self.freedom {
            Freedom::Turn => dot(motion.axis, load.torque),
            Freedom::Slide => dot(motion.axis, load.force),
        }
    }

    /// `load` without a generalised force `along` the coordinate.
    pub(crate) fn without(&self, motion: &LinkMotion, load: &Load, along: DoubleDouble) -> Load {
        let share = scale(along, motion.axis);
        match self.freedom {
            Freedom::Turn => Load { torque: sub(load.torque, share), ..*load },
            Freedom::Slide => Load { force: sub(load.force, share), ..*load },
        }
    }

    pub(crate) fn kinetic_energy(&self, motion: &LinkMotion) -> DoubleDouble {
        let frame = &motion.frame;
        let w = frame.rotation.transposed_times(frame.angular_velocity);
        let doubled = self.mass * dot(frame.velocity, frame.velocity) + dot(w, tensor_times(self.inertia, w));
        doubled.times(0.5)
    }

    /// J ω̇ + ω×J ω, global.
    fn spin_change(&self, motion: &LinkMotion) -> Precise {
        let frame = &motion.frame;
        let w = frame.rotation.transposed_times(frame.angular_velocity);
        let e = frame.rotation.transposed_times(frame.angular_acceleration);
        let change = add(tensor_times(self.inertia, e), cross(w, tensor_times(self.inertia, w)));
        frame.rotation.times(change)
    }
}

/// Moves the frame along the global direction `u` fixed in it: v gains u ẋ, a gains u ẍ + 2 ω × u ẋ.
fn slide(frame: &mut FrameMotion, u: Precise, [x, rate, acceleration]: [DoubleDouble; 3]) {
    frame.shift(scale(x, u));
    let velocity = scale(rate, u);
    let coriolis = scale(DoubleDouble::new(2.0), cross(frame.angular_velocity, velocity));
    frame.velocity = add(frame.velocity, velocity);
    frame.acceleration = add(frame.acceleration, add(scale(acceleration, u), coriolis));
}

/// The motion of every link on a base that moves like `base`.
pub(crate) fn outwards<const N: usize>(
    links: &[PreciseLink; N],
    base: &FrameMotion,
    q: [[DoubleDouble; N]; 3],
) -> [LinkMotion; N] {
    let mut parent = *base;
    core::array::from_fn(|k| {
        let motion = links[k].carried(&parent, q.map(|derivative| derivative[k]));
        parent = motion.frame;
        motion
    })
}

/// What every link receives from the one before it.
pub(crate) fn inwards<const N: usize>(
    links: &[PreciseLink; N],
    motions: &[LinkMotion; N],
    gravity: Precise,
) -> [Load; N] {
    let mut loads = [Load { force: ORIGIN, torque: ORIGIN }; N];
    for k in (0..N).rev() {
        let (link, motion) = (&links[k], &motions[k]);
        let inertial = scale(link.mass, sub(motion.frame.acceleration, gravity));
        let arm = sub(motion.frame.position, motion.joint);
        let mut load = Load { force: inertial, torque: add(link.spin_change(motion), cross(arm, inertial)) };
        if k + 1 < N {
            let outer = loads[k + 1];
            let lever = sub(motions[k + 1].joint, motion.joint);
            load.force = add(load.force, outer.force);
            load.torque = add(load.torque, add(outer.torque, cross(lever, outer.force)));
        }
        loads[k] = load;
    }
    loads
}
