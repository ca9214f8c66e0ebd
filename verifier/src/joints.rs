//! Where the joint coordinates of a tree stand.

use gyro_model::{JointCoordinate, JointKind, Model, RowOwner, Support, Tree};

/// The joint state of a tree, `(x, u [, work])`: joints in the order of the model file, then free bodies.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct JointLayout {
    /// What stands where.
    pub places: Vec<Place>,
    /// Length of x.
    pub n_coordinates: usize,
    /// Length of u.
    pub n_rates: usize,
    /// Whether the work follows.
    pub has_work: bool,
}

/// Some coordinates with their rates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// What they are.
    pub of: Freedom,
    /// Where they start in the joint state.
    pub x: usize,
    /// Where their rates start in u.
    pub u: usize,
}

/// What moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Freedom {
    /// An angle or a displacement.
    Scalar(JointCoordinate),
    /// Euler parameters of a joint's second body in the first's frame, with the angular velocity relative to the first
    /// in the second's.
    Orientation {
        /// Index into [`Model::joints`].
        joint: usize,
    },
    /// (r, p) and (s, w') of a free body.
    Body {
        /// Its place in [`Model::coordinate_bodies`].
        moving_body: usize,
    },
}

impl Freedom {
    /// Number of coordinates, number of rates.
    pub fn sizes(self) -> (usize, usize) {
        match self {
            Self::Scalar(_) => (1, 1),
            Self::Orientation { .. } => (4, 3),
            Self::Body { .. } => (7, 6),
        }
    }

    /// Where among its coordinates Euler parameters start, if there are any.
    pub fn euler(self) -> Option<usize> {
        match self {
            Self::Scalar(_) => None,
            Self::Orientation { .. } => Some(0),
            Self::Body { .. } => Some(3),
        }
    }
}

impl JointLayout {
    /// Of a mechanism whose joints hold every body by one path, with no row beside the joints' own; `None` of others.
    pub fn of(model: &Model) -> Option<Self> {
        let closes = |owner: &RowOwner| matches!(owner, RowOwner::Coupler(_) | RowOwner::Driver(_));
        if !Tree::of(model).is_open() || model.rows().iter().any(|row| closes(&row.owner)) {
            return None;
        }
        let mut layout =
            Self { places: Vec::new(), n_coordinates: 0, n_rates: 0, has_work: model.has_work() };
        for (joint, kind) in model.joints.iter().map(|joint| joint.kind).enumerate() {
            for coordinate in 0..kind.coordinates().len() {
                layout.add(Freedom::Scalar(JointCoordinate { joint, coordinate }));
            }
            if matches!(kind, JointKind::Spherical | JointKind::PointOnLine) {
                layout.add(Freedom::Orientation { joint });
            }
        }
        for (moving_body, body) in model.coordinate_bodies().into_iter().enumerate() {
            if model.bodies[body].support == Support::Free {
                layout.add(Freedom::Body { moving_body });
            }
        }
        Some(layout)
    }

    fn add(&mut self, of: Freedom) {
        let (coordinates, rates) = of.sizes();
        self.places.push(Place { of, x: self.n_coordinates, u: self.n_rates });
        self.n_coordinates += coordinates;
        self.n_rates += rates;
    }

    /// Length of `(x, u)`.
    pub fn n_motion(&self) -> usize {
        self.n_coordinates + self.n_rates
    }

    /// Length of the joint state.
    pub fn n_state(&self) -> usize {
        self.n_motion() + usize::from(self.has_work)
    }

    /// Where Euler parameters start.
    pub fn euler(&self) -> impl Iterator<Item = usize> {
        self.places.iter().filter_map(|place| place.of.euler().map(|start| place.x + start))
    }

    /// Where a scalar coordinate stands.
    pub fn scalar(&self, on: JointCoordinate) -> Option<usize> {
        let place = self.places.iter().find(|place| place.of == Freedom::Scalar(on));
        place.map(|place| place.x)
    }
}
