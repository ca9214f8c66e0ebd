//! The coordinate partition.

use crate::engine::Engine;
use crate::mechanism::InProcess;
use gyro_codegen::{Kernel, PartitionForm};
use gyro_sim::pivoting;
use gyro_sim::{Clearance, Error, Lanes, Partition, Real, joint_partition};

/// Which coordinates are independent.
#[derive(Clone, Debug, PartialEq)]
pub enum Independent {
    /// The special Euler parameter of each joint.
    Charts(Vec<u8>),
    /// Coordinates and rates of a tree of joints.
    Joints,
}

impl<T: Real, E: Engine<T>> InProcess<T, E> {
    /// Hands the four-vectors of the charts to `f`.
    fn with_charts<R>(&self, y: &[T], f: impl FnOnce(&[[T; 4]]) -> R) -> R {
        let kernel = self.scheduled().kernels.get(&Kernel::ChartVectors);
        self.with_given(kernel.map_or(0, |kernel| kernel.tape.results.len()), |vectors| {
            self.fill(Kernel::ChartVectors, T::constant(0.0), y, vectors);
            f(vectors.as_chunks::<4>().0)
        })
    }

    /// A solve of the partition on charts.
    fn solve(&self, kernel: Kernel, t: T, charts: &[u8], y: &mut [T]) {
        self.with_given(4 * charts.len(), |given| {
            for (vector, chart) in given.as_chunks_mut::<4>().0.iter_mut().zip(charts) {
                *vector = T::one_hot(*chart);
            }
            self.compute(kernel, t, (&[], given), y);
        });
    }
}

impl<T: Real, E: Engine<T>> Partition for InProcess<T, E> {
    type Independent = Independent;

    fn independent(&self, _t: T, y: &Vec<T>) -> Independent {
        let best = |vectors: &[[T; 4]]| vectors.iter().map(T::best_chart).collect();
        match self.scheduled().partition {
            PartitionForm::Charts => Independent::Charts(self.with_charts(y, best)),
            PartitionForm::Joints => Independent::Joints,
        }
    }

    fn follow(&self, _t: T, y: &Vec<T>, choice: &mut Independent) -> u32 {
        match choice {
            Independent::Joints => 0,
            Independent::Charts(charts) => self.with_charts(y, |vectors| {
                vectors.iter().zip(charts).map(|(vector, chart)| T::follow_chart(vector, chart)).sum()
            }),
        }
    }

    fn newton_step(&self, t: T, choice: &Independent, y: &mut Vec<T>) -> Result<(), Error> {
        match choice {
            Independent::Joints => joint_partition::newton_step(self, t, y),
            Independent::Charts(charts) => {
                self.solve(Kernel::NewtonStep, t, charts, y);
                Ok(())
            }
        }
    }

    fn is_met(&self, t: T, y: &Vec<T>, phi: &Vec<T>) -> bool {
        self.scheduled().partition != PartitionForm::Charts && pivoting::is_met(self, t, y, phi)
    }

    fn solve_velocities(&self, t: T, choice: &Independent, y: &mut Vec<T>) -> Result<(), Error> {
        match choice {
            Independent::Joints => {
                joint_partition::solve_velocities(self, t, y);
                Ok(())
            }
            Independent::Charts(charts) => {
                self.solve(Kernel::SolveVelocities, t, charts, y);
                Ok(())
            }
        }
    }

    fn clearance(&self, t: T, y: &Vec<T>) -> Option<Clearance<T>> {
        // Trees have no singular poses.
        let joint = self.scheduled().joint.as_ref();
        let has_poses = joint.is_none_or(|joint| !joint.closure_rows.is_empty());
        match self.scheduled().partition {
            PartitionForm::Joints if has_poses => joint_partition::clearance(self, t, y),
            _ => None,
        }
    }
}
