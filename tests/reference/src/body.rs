//! Where a body is and how it moves, to compare with.

/// A rigid body at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyState {
    /// Mass centre, global, m.
    pub position: [f64; 3],
    /// Rotation matrix by rows: components in the body's frame into global ones.
    pub rotation: [[f64; 3]; 3],
    /// Velocity of the mass centre, global, m/s.
    pub velocity: [f64; 3],
    /// Angular velocity in the body's frame, rad/s.
    pub angular_velocity: [f64; 3],
}
