//! The gimbal of `embedded/models/gimbal.toml` for C: `include/gimbal.h` is generated from this file.
//!
//! Memory is the caller's, nothing is allocated, and no call can do more than return an error.
#![no_std]

use core::mem::{align_of, size_of};
use core::panic::PanicInfo;
use embedded_scenes::mechanisms::gimbal;
use gyro_sim::{Error, JointCoordinate, Mechanism, Partitioned, Turns};

/// Never called: `cargo xtask embedded` shows that nothing in what is linked can panic.
#[panic_handler]
fn panic(_: &PanicInfo<'_>) -> ! {
    loop {}
}

/// Words of a `Gimbal`.
pub const GIMBAL_WORDS: usize = 226;

/// A gimbal, in memory of the caller's. What is in it is nobody's business.
///
/// A gimbal that was never initialised is recognised if its memory is zero.
#[repr(C)]
#[derive(Debug)]
pub struct Gimbal {
    /// Private.
    words: [u64; GIMBAL_WORDS],
}

/// How a call ended.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GimbalStatus {
    /// As it should.
    Ok = 0,
    /// A pointer is null or not aligned.
    BadPointer = 1,
    /// `gimbal_init` has not been called.
    NotInitialised = 2,
    /// There is no joint, parameter or input of this number.
    OutOfRange = 3,
    /// A number is not finite, a step not positive, or a parameter one that the mechanism cannot have.
    BadNumber = 4,
    /// The state is no longer finite: the step is too large. From here on the gimbal fails until it is initialised
    /// anew.
    NotFinite = 5,
    /// The constraints cannot be met, likewise.
    NoConvergence = 6,
    /// The pose is singular, likewise.
    Singular = 7,
    /// A correction would be too large, likewise.
    Jump = 8,
}

/// The joints.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GimbalJoint {
    /// Of the outer ring in the base.
    Alpha = 0,
    /// Of the inner ring in the outer.
    Beta = 1,
    /// Of the rotor in the inner ring, continuous over its turns.
    Phi = 2,
}

/// The parameters.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GimbalParameter {
    /// kg.
    RotorMass = 0,
}

/// The inputs.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GimbalInput {
    /// Of the motor on the outer axis, N m.
    Torque = 0,
}

/// Where a joint is and how fast it turns.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GimbalAngle {
    /// rad.
    pub position: f64,
    /// rad/s.
    pub rate: f64,
}

/// What is in the words.
struct Simulation {
    mark: u64,
    status: GimbalStatus,
    t: f64,
    mechanism: gimbal::Gimbal<f64>,
    state: <gimbal::Gimbal<f64> as Mechanism>::State,
    solver: Partitioned<gimbal::Gimbal<f64>>,
    turns: Turns<gimbal::Gimbal<f64>>,
}

/// Says that the words are a simulation.
const MARK: u64 = 0x6769_6d62_616c_3031;

const _: () = assert!(size_of::<Simulation>() <= size_of::<Gimbal>());
const _: () = assert!(align_of::<Simulation>() <= align_of::<Gimbal>());

impl Simulation {
    #[inline(always)]
    fn new() -> Self {
        let mechanism = gimbal::Gimbal::default();
        let state = mechanism.start();
        Self {
            mark: MARK,
            status: GimbalStatus::Ok,
            t: 0.0,
            solver: Partitioned::new(&mechanism, &state),
            turns: Turns::new(&mechanism, 0.0, &state, &[]),
            mechanism,
            state,
        }
    }

    fn step(&mut self, dt: f64, steps: u32) -> GimbalStatus {
        let length = dt * f64::from(steps);
        if let Err(error) = self.solver.advance(&self.mechanism, self.t, dt, steps, &mut self.state) {
            self.status = status(error);
            return self.status;
        }
        self.t += length;
        self.turns.update(&self.mechanism, self.t, length, &self.state);
        GimbalStatus::Ok
    }

    fn angle(&self, joint: u32) -> Option<GimbalAngle> {
        match self.turns.coordinate(&self.mechanism, joint as usize, 0)? {
            JointCoordinate::Angle { position, rate } => Some(GimbalAngle { position, rate }),
            _ => None,
        }
    }
}

fn status(error: Error) -> GimbalStatus {
    match error {
        Error::NotFinite { .. } => GimbalStatus::NotFinite,
        Error::Singular { .. } => GimbalStatus::Singular,
        Error::Jump { .. } => GimbalStatus::Jump,
        // The rest comes of error control, which is not used here.
        _ => GimbalStatus::NoConvergence,
    }
}

/// Puts a gimbal at its start, with all parameters and inputs at their defaults.
///
/// # Safety
/// The pointer is null, or points to memory of a `Gimbal` that nobody else uses meanwhile; so with all functions here.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gimbal_init(gimbal: *mut Gimbal) -> GimbalStatus {
    let place = gimbal.cast::<Simulation>();
    if place.is_null() || !place.is_aligned() {
        return GimbalStatus::BadPointer;
    }
    // SAFETY: there is room for it, as asserted above, and nothing there that would have to be dropped.
    unsafe { place.write(Simulation::new()) };
    GimbalStatus::Ok
}

/// Sets a parameter; from the next step on. What the model file would refuse, such as a mass that is not positive, is
/// refused with `BadNumber`, and the parameter keeps its value.
///
/// # Safety
/// As for `gimbal_init`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gimbal_set_parameter(
    gimbal: *mut Gimbal,
    parameter: u32,
    value: f64,
) -> GimbalStatus {
    // SAFETY: the caller's promise.
    let simulation = match unsafe { simulation(gimbal) } {
        Ok(simulation) => simulation,
        Err(status) => return status,
    };
    let mut changed = simulation.mechanism;
    if !changed.set_parameter(parameter as usize, value) {
        return GimbalStatus::OutOfRange;
    }
    if changed.parameters().check().is_err() {
        return GimbalStatus::BadNumber;
    }
    simulation.mechanism = changed;
    GimbalStatus::Ok
}

/// Sets an input, until it is set anew.
///
/// # Safety
/// As for `gimbal_init`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gimbal_set_input(gimbal: *mut Gimbal, input: u32, value: f64) -> GimbalStatus {
    // SAFETY: the caller's promise.
    let simulation = match unsafe { simulation(gimbal) } {
        Ok(simulation) => simulation,
        Err(status) => return status,
    };
    if !value.is_finite() {
        return GimbalStatus::BadNumber;
    }
    in_range(simulation.mechanism.set_input(input as usize, value))
}

/// Advances by a number of steps of `dt` seconds, corrects the dependent coordinates and reads the joints.
///
/// # Safety
/// As for `gimbal_init`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gimbal_step(gimbal: *mut Gimbal, dt: f64, steps: u32) -> GimbalStatus {
    // SAFETY: the caller's promise.
    let simulation = match unsafe { simulation(gimbal) } {
        Ok(simulation) => simulation,
        Err(status) => return status,
    };
    if !(dt.is_finite() && dt > 0.0) {
        return GimbalStatus::BadNumber;
    }
    simulation.step(dt, steps)
}

/// Writes where a joint was after the last step.
///
/// # Safety
/// As for `gimbal_init`; `angle` is null or points to memory of a `GimbalAngle`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gimbal_read_joint(
    gimbal: *mut Gimbal,
    joint: u32,
    angle: *mut GimbalAngle,
) -> GimbalStatus {
    // SAFETY: the caller's promise.
    let simulation = match unsafe { simulation(gimbal) } {
        Ok(simulation) => simulation,
        Err(status) => return status,
    };
    if angle.is_null() || !angle.is_aligned() {
        return GimbalStatus::BadPointer;
    }
    let Some(read) = simulation.angle(joint) else { return GimbalStatus::OutOfRange };
    // SAFETY: it is aligned, and the caller's promise.
    unsafe { angle.write(read) };
    GimbalStatus::Ok
}

fn in_range(is_in_range: bool) -> GimbalStatus {
    if is_in_range { GimbalStatus::Ok } else { GimbalStatus::OutOfRange }
}

/// What is behind a pointer, if it is a simulation that has not failed.
///
/// # Safety
/// As for `gimbal_init`.
unsafe fn simulation<'a>(gimbal: *mut Gimbal) -> Result<&'a mut Simulation, GimbalStatus> {
    let place = gimbal.cast::<Simulation>();
    if place.is_null() || !place.is_aligned() {
        return Err(GimbalStatus::BadPointer);
    }
    // SAFETY: it is memory of a `Gimbal`; the mark is a number, whatever its bits.
    if unsafe { (&raw const (*place).mark).read() } != MARK {
        return Err(GimbalStatus::NotInitialised);
    }
    // SAFETY: only `gimbal_init` writes the mark, and with it all the rest.
    let simulation = unsafe { &mut *place };
    if simulation.status == GimbalStatus::Ok { Ok(simulation) } else { Err(simulation.status) }
}
