//! Poses, typed here: the importer has its own from a library.

/// Rotation and translation.
#[derive(Clone, Copy)]
pub struct Pose {
    pub rotation: [[f64; 3]; 3],
    pub translation: [f64; 3],
}

impl Pose {
    /// An `<origin>`: about the fixed axes x, y, z in this order.
    pub fn origin(xyz: [f64; 3], [roll, pitch, yaw]: [f64; 3]) -> Self {
        let about = |axis, angle| Pose { rotation: rodrigues(axis, angle), translation: [0.0; 3] };
        let turned =
            about([0.0, 0.0, 1.0], yaw) * about([0.0, 1.0, 0.0], pitch) * about([1.0, 0.0, 0.0], roll);
        Pose { translation: xyz, ..turned }
    }

    pub fn turn(axis: [f64; 3], angle: f64) -> Self {
        Pose { rotation: rodrigues(axis, angle), translation: [0.0; 3] }
    }

    pub fn shift(xyz: [f64; 3]) -> Self {
        Pose::origin(xyz, [0.0; 3])
    }
}

impl std::ops::Mul for Pose {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let row = |i: usize, column: &dyn Fn(usize) -> f64| {
            (0..3).map(|k| self.rotation[i][k] * column(k)).sum::<f64>()
        };
        Pose {
            rotation: std::array::from_fn(|i| std::array::from_fn(|j| row(i, &|k| other.rotation[k][j]))),
            translation: std::array::from_fn(|i| self.translation[i] + row(i, &|k| other.translation[k])),
        }
    }
}

/// `cos 1 + (1 − cos) a aᵀ + sin ã`.
pub fn rodrigues(axis: [f64; 3], angle: f64) -> [[f64; 3]; 3] {
    let norm = axis.iter().map(|a| a * a).sum::<f64>().sqrt();
    let [x, y, z] = axis.map(|a| a / norm);
    let (sin, cos) = angle.sin_cos();
    let v = 1.0 - cos;
    [
        [cos + v * x * x, v * x * y - sin * z, v * x * z + sin * y],
        [v * y * x + sin * z, cos + v * y * y, v * y * z - sin * x],
        [v * z * x - sin * y, v * z * y + sin * x, cos + v * z * z],
    ]
}

/// Paper, eq. (3), of unit Euler parameters.
pub fn rotation([e0, e1, e2, e3]: [f64; 4]) -> [[f64; 3]; 3] {
    let half = [
        [e0 * e0 + e1 * e1 - 0.5, e1 * e2 - e0 * e3, e1 * e3 + e0 * e2],
        [e1 * e2 + e0 * e3, e0 * e0 + e2 * e2 - 0.5, e2 * e3 - e0 * e1],
        [e1 * e3 - e0 * e2, e2 * e3 + e0 * e1, e0 * e0 + e3 * e3 - 0.5],
    ];
    half.map(|row| row.map(|a| 2.0 * a))
}

pub fn add(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| a[k] + b[k])
}

pub fn scale(factor: f64, a: [f64; 3]) -> [f64; 3] {
    a.map(|x| factor * x)
}

pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

pub fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub fn turned(rotation: &[[f64; 3]; 3], a: [f64; 3]) -> [f64; 3] {
    rotation.map(|row| dot(row, a))
}

/// By the transposed matrix.
pub fn turned_back(rotation: &[[f64; 3]; 3], a: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| (0..3).map(|i| rotation[i][k] * a[i]).sum())
}
