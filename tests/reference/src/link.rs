//! A body of a chain and the joint that carries it.

/// How a link moves against the one before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Freedom {
    /// It turns about the axis.
    Turn,
    /// It slides along the axis.
    Slide,
}

/// A body and the joint that carries it. All frames are parallel where all coordinates are zero, and have
/// their origin at the body's mass centre (of the base: where it says). Numbers are the decimals they print
/// as.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Link {
    /// How it moves.
    pub freedom: Freedom,
    /// The joint's axis, in both frames; of any length but zero.
    pub axis: [f64; 3],
    /// The joint point in the frame of the link before, m.
    pub before: [f64; 3],
    /// The joint point in the link's own frame, m.
    pub own: [f64; 3],
    /// Mass, kg; zero if the link is only one freedom of several.
    pub mass: f64,
    /// Inertia tensor about the mass centre, kg·m²: `[xx, yy, zz, xy, xz, yz]`.
    pub inertia: [f64; 6],
    /// Force or torque −damping times the rate.
    pub damping: f64,
    /// Force or torque −stiffness times (coordinate − free).
    pub stiffness: f64,
    /// Coordinate at which the spring is free, rad or m.
    pub free: f64,
    /// Coordinate at time zero, rad or m.
    pub start: f64,
    /// Rate at time zero, rad/s or m/s.
    pub rate: f64,
}

impl Link {
    /// A link without mass that turns about `axis` through the origins.
    #[must_use]
    pub fn turning(axis: [f64; 3]) -> Self {
        Link {
            freedom: Freedom::Turn,
            axis,
            before: [0.0; 3],
            own: [0.0; 3],
            mass: 0.0,
            inertia: [0.0; 6],
            damping: 0.0,
            stiffness: 0.0,
            free: 0.0,
            start: 0.0,
            rate: 0.0,
        }
    }

    /// A link without mass that slides along `axis`.
    #[must_use]
    pub fn sliding(axis: [f64; 3]) -> Self {
        Link { freedom: Freedom::Slide, ..Link::turning(axis) }
    }

    /// The same link with mass and principal moments of inertia in the axes of its frame.
    #[must_use]
    pub fn with_body(self, mass: f64, [xx, yy, zz]: [f64; 3]) -> Self {
        Link { mass, inertia: [xx, yy, zz, 0.0, 0.0, 0.0], ..self }
    }
}
