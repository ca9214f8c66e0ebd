//! Vectors and rotations, as far as planting a start needs them.

pub type Vector = [f64; 3];

pub fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn sum(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|k| a[k] + b[k])
}

pub fn difference(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|k| a[k] - b[k])
}

pub fn scaled(factor: f64, a: Vector) -> Vector {
    a.map(|x| factor * x)
}

/// A body's place: mass centre and Euler parameters.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    pub position: Vector,
    pub orientation: [f64; 4],
}

impl Place {
    /// A direction of the body in the global frame: `v + 2 e0 (e × v) + 2 e × (e × v)`.
    pub fn turned(&self, v: Vector) -> Vector {
        let [e0, e1, e2, e3] = self.orientation;
        let e = [e1, e2, e3];
        let across = cross(e, v);
        sum(v, sum(scaled(2.0 * e0, across), scaled(2.0, cross(e, across))))
    }

    /// A global direction in the body's frame.
    pub fn turned_back(&self, v: Vector) -> Vector {
        let [e0, e1, e2, e3] = self.orientation;
        Place { orientation: [e0, -e1, -e2, -e3], ..*self }.turned(v)
    }

    /// A point of the body in the global frame.
    pub fn global(&self, point: Vector) -> Vector {
        sum(self.position, self.turned(point))
    }

    /// A global point in the body's frame.
    pub fn local(&self, point: Vector) -> Vector {
        self.turned_back(difference(point, self.position))
    }

    /// The place after a short time with these velocities, of the mass centre and w' in the body's frame.
    pub fn moved(&self, velocities: &[f64], time: f64) -> Place {
        let [e0, e1, e2, e3] = self.orientation;
        let (e, w) = ([e1, e2, e3], [velocities[3], velocities[4], velocities[5]]);
        // p times (1, w time / 2), normalised.
        let w = scaled(0.5 * time, w);
        let vector = sum(e, sum(scaled(e0, w), cross(e, w)));
        let p = [e0 - dot(e, w), vector[0], vector[1], vector[2]];
        let length = p.iter().map(|x| x * x).sum::<f64>().sqrt();
        let position = sum(self.position, scaled(time, [velocities[0], velocities[1], velocities[2]]));
        Place { position, orientation: p.map(|x| x / length) }
    }
}
