//! Where the joint coordinates of a mechanism stand.

use gyro_model::{JointCoordinate, JointKind, Model};

/// The joint state `(x, u [, work])` of a mechanism, as its module says; what is proved is proved of this layout.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct JointLayout {
    /// What stands where.
    pub places: Vec<Place>,
    /// The rows of Φ that the coordinates do not satisfy by themselves, by their places among [`Model::rows`].
    pub closure_rows: Vec<usize>,
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
    /// (r, p) and (s, w') of a body that no joint carries.
    Body {
        /// Its place in [`Model::coordinate_bodies`].
        moving_body: usize,
    },
    /// The turn reference of an angle, which is none of the coordinates.
    Turn(JointCoordinate),
    /// A state of one's own, by its index in [`Model::states`].
    State(usize),
}

impl Freedom {
    /// Whether a model has it.
    fn exists(self, model: &Model) -> bool {
        let kind = |joint: usize| model.joints.get(joint).map(|joint| joint.kind);
        match self {
            Self::Scalar(on) => kind(on.joint).is_some_and(|kind| on.coordinate < kind.coordinates().len()),
            Self::Turn(on) => model.turn_references().contains(&on),
            Self::State(state) => state < model.states.len(),
            Self::Orientation { joint } => {
                matches!(kind(joint), Some(JointKind::Spherical | JointKind::PointOnLine))
            }
            Self::Body { moving_body } => moving_body < model.coordinate_bodies().len(),
        }
    }

    /// Number of coordinates, number of rates.
    pub fn sizes(self) -> (usize, usize) {
        match self {
            Self::Scalar(_) => (1, 1),
            Self::Turn(_) | Self::State(_) => (1, 0),
            Self::Orientation { .. } => (4, 3),
            Self::Body { .. } => (7, 6),
        }
    }

    /// Where among its coordinates Euler parameters start, if there are any.
    pub fn euler(self) -> Option<usize> {
        match self {
            Self::Scalar(_) | Self::Turn(_) | Self::State(_) => None,
            Self::Orientation { .. } => Some(0),
            Self::Body { .. } => Some(3),
        }
    }
}

impl JointLayout {
    /// What a module says of a model's joint state.
    ///
    /// # Errors
    /// What is wrong with it whatever the formulas are: a coordinate that does not exist or stands there twice, rows
    /// that do not exist or are out of order, as many rates and rows as cannot be.
    pub fn new(model: &Model, freedoms: &[Freedom], closure_rows: Vec<usize>) -> Result<Self, String> {
        let (n, n_rows) = (model.coordinate_bodies().len(), model.rows().len());
        let (places, has_work) = (Vec::new(), model.has_work());
        let mut layout = Self { places, closure_rows, n_coordinates: 0, n_rates: 0, has_work };
        for freedom in freedoms {
            if !freedom.exists(model) {
                return Err(format!("{freedom:?} is no coordinate of the model"));
            }
            let (scalar, turn) = match *freedom {
                Freedom::Scalar(on) | Freedom::Turn(on) => (Freedom::Scalar(on), Freedom::Turn(on)),
                other => (other, other),
            };
            if layout.places.iter().any(|place| place.of == scalar || place.of == turn) {
                return Err(format!("{freedom:?} is there twice"));
            }
            layout.add(*freedom);
        }
        let missing = (0..model.states.len()).find(|&state| layout.state(state).is_none());
        if let Some(state) = missing {
            return Err(format!("state `{}` is not there", model.states[state].name));
        }
        let rows = &layout.closure_rows;
        if !rows.is_sorted_by(|a, b| a < b) || rows.last().is_some_and(|&last| last >= n_rows) {
            return Err(format!("{rows:?} are no rows of the model in their order"));
        }
        let satisfied = n_rows - rows.len();
        if satisfied + layout.n_rates != 6 * n {
            let n_rates = layout.n_rates;
            return Err(format!("{n_rates} rates and {satisfied} rows that they satisfy are not {}", 6 * n));
        }
        Ok(layout)
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

    /// Where a turn reference stands.
    pub fn turn(&self, on: JointCoordinate) -> Option<usize> {
        self.places.iter().find(|place| place.of == Freedom::Turn(on)).map(|place| place.x)
    }

    /// Where a state of one's own stands.
    pub fn state(&self, state: usize) -> Option<usize> {
        self.places.iter().find(|place| place.of == Freedom::State(state)).map(|place| place.x)
    }

    /// Where a scalar coordinate stands.
    pub fn scalar(&self, on: JointCoordinate) -> Option<usize> {
        let place = self.places.iter().find(|place| place.of == Freedom::Scalar(on));
        place.map(|place| place.x)
    }
}
