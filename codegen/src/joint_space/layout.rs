//! Where each joint's coordinates and rates stand.

use super::relation::{Determined, Relation};
use crate::derive::system::System;
use gyro_model::{Attachment, CoordinateKind, JointCoordinate, JointKind, Link};
use std::ops::Range;

/// The joint coordinates x and rates u of a tree: joints in the order of the model file, then free bodies.
///
/// Coordinates that others or time determine are no part of the state. They and their rates are counted on behind
/// those of the state.
#[derive(Clone, Debug)]
pub struct Layout {
    /// One for each link of the tree, root first.
    pub links: Vec<LinkCoordinates>,
    /// Length of x.
    pub n_coordinates: usize,
    /// Length of u.
    pub n_rates: usize,
    /// The coordinates that are no part of the state, in the order of their places.
    pub determined: Vec<Determined>,
    /// The angles of cut joints whose whole turns x counts, with their places in x behind all others. They have no
    /// rates in u.
    pub turns: Vec<(JointCoordinate, usize)>,
    /// Where the first of the states stands in x, behind these. They have no rates in u.
    pub first_state: usize,
    pub n_states: usize,
}

/// The coordinates of one link, in this order.
#[derive(Clone, Debug)]
pub struct LinkCoordinates {
    pub link: Link,
    /// Angles and displacements; the rate of each is its derivative.
    pub scalars: Vec<Scalar>,
    /// Free bodies: r, and its derivative.
    pub position: Option<Place>,
    /// Spherical joints and points on a line: Euler parameters of the second body in the first's frame and the angular
    /// velocity relative to the first, in the second's frame. Free bodies: p and w'.
    pub orientation: Option<Place>,
}

/// An angle or a displacement.
#[derive(Clone, Copy, Debug)]
pub struct Scalar {
    pub coordinate: JointCoordinate,
    pub kind: CoordinateKind,
    pub place: Place,
}

/// Index of the first coordinate and of the first rate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    pub x: usize,
    pub u: usize,
}

impl Layout {
    /// `turns` are the angles of cut joints whose whole turns the state counts.
    pub fn of(system: &System, determined: Vec<Determined>, turns: &[JointCoordinate]) -> Self {
        let mut links = system.tree.links.clone();
        links.sort_by_key(|link| match link.attachment {
            Attachment::Joint { joint, .. } => (0, joint),
            Attachment::Free | Attachment::Constrained => (1, link.body),
        });
        let mut layout = Self {
            links: Vec::new(),
            n_coordinates: 0,
            n_rates: 0,
            determined,
            turns: Vec::new(),
            first_state: 0,
            n_states: system.model.states.len(),
        };
        for link in links {
            let coordinates = layout.place(system, link);
            layout.links.push(coordinates);
        }
        layout.turns = turns.iter().map(|&turn| (turn, layout.take(1, 0).x)).collect();
        layout.first_state = layout.take(layout.n_states, 0).x;
        let behind = |place: usize| Place { x: layout.n_coordinates + place, u: layout.n_rates + place };
        for scalar in layout.links.iter_mut().flat_map(|link| &mut link.scalars) {
            let place = layout.determined.iter().position(|known| known.coordinate == scalar.coordinate);
            scalar.place = place.map_or(scalar.place, behind);
        }
        let order = |link: &LinkCoordinates| system.tree.links.iter().position(|l| l.body == link.link.body);
        layout.links.sort_by_key(order);
        layout
    }

    fn place(&mut self, system: &System, link: Link) -> LinkCoordinates {
        let mut coordinates =
            LinkCoordinates { link, scalars: Vec::new(), position: None, orientation: None };
        match link.attachment {
            Attachment::Constrained => {}
            Attachment::Free => {
                coordinates.position = Some(self.take(3, 3));
                coordinates.orientation = Some(self.take(4, 3));
            }
            Attachment::Joint { joint, .. } => {
                let kind = system.joints[joint].kind;
                for (coordinate, &kind) in kind.coordinates().iter().enumerate() {
                    let coordinate = JointCoordinate { joint, coordinate };
                    let is_determined = self.determined.iter().any(|known| known.coordinate == coordinate);
                    let size = usize::from(!is_determined);
                    coordinates.scalars.push(Scalar { coordinate, kind, place: self.take(size, size) });
                }
                if matches!(kind, JointKind::Spherical | JointKind::PointOnLine) {
                    coordinates.orientation = Some(self.take(4, 3));
                }
            }
        }
        coordinates
    }

    fn take(&mut self, coordinates: usize, rates: usize) -> Place {
        let place = Place { x: self.n_coordinates, u: self.n_rates };
        self.n_coordinates += coordinates;
        self.n_rates += rates;
        place
    }

    /// Number of coordinates of the tree, those included that are no part of the state.
    pub fn n_tree_coordinates(&self) -> usize {
        self.n_coordinates + self.determined.len()
    }

    /// Number of rates of the tree, those included that are no part of the state.
    pub fn n_tree_rates(&self) -> usize {
        self.n_rates + self.determined.len()
    }

    /// Whether a scalar coordinate is zero, as loops hold it.
    pub fn is_held(&self, x: usize) -> bool {
        let known = x.checked_sub(self.n_coordinates).and_then(|place| self.determined.get(place));
        known.is_some_and(|known| matches!(known.by, Relation::Held(_)))
    }

    /// The scalar coordinates that are part of the state.
    pub fn scalars(&self) -> impl Iterator<Item = &Scalar> {
        let all = self.links.iter().flat_map(|link| &link.scalars);
        all.filter(|scalar| scalar.place.x < self.n_coordinates)
    }

    /// Where Euler parameters stand.
    pub fn orientations(&self) -> impl Iterator<Item = Place> {
        self.links.iter().filter_map(|link| link.orientation)
    }

    /// The places of states in x.
    pub fn states(&self) -> Range<usize> {
        self.first_state..self.first_state + self.n_states
    }

    /// Where a scalar coordinate of a joint stands.
    pub fn scalar(&self, coordinate: JointCoordinate) -> Option<&Scalar> {
        self.links.iter().flat_map(|link| &link.scalars).find(|scalar| scalar.coordinate == coordinate)
    }
}
