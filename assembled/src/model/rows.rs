//! The constraint rows, each a linear combination of what joints measure, minus a function of time.

use crate::model::course::Course;
use crate::model::joint::Joint;
use crate::model::kinds::{Axis, Primitive, primitives};
use crate::model::measure::{Measure, Term};
use crate::model::tracked::{Subject, Tracked};
use crate::number::{Number, number};
use gyro_model::{Coupling, JointCoordinate, JointKind, Model, RowOwner};

/// A constraint row.
#[derive(Clone, Debug)]
pub(crate) enum Row<T> {
    /// One of the six of a constrained body, paper, eqs. (5) and (6).
    Constrained { body: usize, component: usize },
    /// `Σ factor · measure − course(t)`.
    Measured { terms: Vec<Term<T>>, course: Option<Course> },
    /// A formula of what joints measure, or what one measures less that.
    Followed { second: Option<Term<T>>, formula: Tracked<T> },
    /// A formula of what joints measure and of its rates, linear in these: of velocities.
    Rolling(Tracked<T>),
}

impl<T: Number> Row<T> {
    pub(crate) fn new(
        model: &Model,
        moving_bodies: &[usize],
        (joints, pairs): (&[Joint<T>], &[usize]),
        row: &gyro_model::Row,
    ) -> Self {
        let coordinate = |factor: f64, of: JointCoordinate| Term {
            factor: number(factor),
            ..Subject::Coordinate(of).term((joints, pairs))
        };
        let subject = |subject: Subject| subject.term((joints, pairs));
        match row.owner {
            RowOwner::Body(body) => {
                let before = moving_bodies.iter().take_while(|&&b| b != body);
                let held = |&&b: &&usize| model.bodies[b].support == gyro_model::Support::Constrained;
                Self::Constrained { body: before.filter(held).count(), component: row.index }
            }
            RowOwner::Joint(joint) => {
                let primitive = primitives(joints[joint].kind)[row.index].along(model.point_axes(joint));
                let mut terms =
                    vec![Term { factor: T::one(), joint, measure: Measure::Primitive(primitive) }];
                if joints[joint].kind == JointKind::Screw && primitive == Primitive::Dot2(Axis::H) {
                    let lead = model.value(&model.joints[joint].lead);
                    terms.push(coordinate(-lead, JointCoordinate { joint, coordinate: 0 }));
                }
                Self::Measured { terms, course: None }
            }
            RowOwner::Coupler(coupler) => {
                let coupler = &model.couplers[coupler];
                match &coupler.by {
                    Coupling::Linear { first, ratio, offset } => Self::Measured {
                        terms: (coupler.second.map(|on| coordinate(1.0, on)).into_iter())
                            .chain([coordinate(-model.value(ratio), *first)])
                            .collect(),
                        course: Some(Course::constant(model.value(offset))),
                    },
                    Coupling::Formula(formula) | Coupling::Zero(formula) => Self::Followed {
                        second: coupler.second.map(|on| coordinate(1.0, on)),
                        formula: Tracked::new(model, formula, subject),
                    },
                    Coupling::Rate(formula) => Self::Rolling(Tracked::new(model, formula, subject)),
                }
            }
            RowOwner::Driver(driver) => {
                let driver = &model.drivers[driver];
                let course = Some(Course::new(model, &driver.motion));
                Self::Measured { terms: vec![coordinate(1.0, driver.coordinate)], course }
            }
        }
    }
}
