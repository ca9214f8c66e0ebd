//! All numbers of a model.

use crate::{Attraction, Coupling, Formula, Model, Motion, Number, Shape, ShapeKind, StateStart};

impl Model {
    /// Every number of the model file that stands in the model, those of the start included.
    pub fn numbers(&self) -> Vec<&Number> {
        let mut numbers: Vec<&Number> = self.gravity.iter().collect();
        numbers.extend(self.attraction.iter().flat_map(Attraction::numbers));
        for body in &self.bodies {
            numbers.extend([&body.mass, &body.assembly_weight]);
            numbers.extend(body.inertia.iter().chain(&body.position).chain(&body.orientation));
            numbers.extend(body.velocity.iter().chain(body.angular_velocity.iter().flatten()));
            body.shapes.iter().for_each(|shape| shape.add_numbers(&mut numbers));
            if let Some(motion) = &body.motion {
                motion.translation.iter().for_each(|motion| motion.add_numbers(&mut numbers));
                for (axis, angle) in &motion.rotations {
                    numbers.extend(axis);
                    angle.add_numbers(&mut numbers);
                }
            }
        }
        for joint in &self.joints {
            let ends = [&joint.first, &joint.second];
            numbers.extend(ends.iter().flat_map(|end| end.point.iter().chain(&end.axis).chain(&end.zero)));
            numbers.extend([&joint.damping, &joint.lead, &joint.length, &joint.armature]);
            let start = &joint.start;
            numbers.extend(start.position.iter().flatten().chain(start.rate.iter().flatten()));
            numbers.extend(start.orientation.iter().flatten());
        }
        for coupler in &self.couplers {
            if let Coupling::Linear { first: _, ratio, offset } = &coupler.by {
                numbers.extend([ratio, offset]);
            }
            numbers.extend(coupler.by.formula().into_iter().flat_map(Formula::numbers));
        }
        self.drivers.iter().for_each(|driver| driver.motion.add_numbers(&mut numbers));
        self.forces.iter().flat_map(|force| force.kind.parts().numbers).for_each(|(_, of)| {
            numbers.extend(of);
            numbers.extend(of.iter().filter_map(Number::formula).flat_map(Formula::numbers));
        });
        for frame in self.outputs.iter().flat_map(|output| output.kind.frames()) {
            numbers.extend(frame.point.iter().chain(frame.orientation.iter().flatten()));
        }
        let formulas = self.outputs.iter().filter_map(|output| output.kind.formula());
        numbers.extend(formulas.flat_map(Formula::numbers));
        for state in &self.states {
            if let StateStart::At(start) = &state.start {
                numbers.push(start);
            }
            numbers.push(&state.rate);
            numbers.extend(state.rate.formula().into_iter().flat_map(Formula::numbers));
        }
        self.controllers.iter().for_each(|controller| numbers.extend(controller.numbers()));
        for event in &self.events {
            numbers.push(&event.level);
            numbers.extend(event.of.numbers());
        }
        self.contacts.iter().for_each(|contact| numbers.extend(contact.numbers()));
        for one in &self.touching {
            numbers.extend(one.coefficients.iter().chain([&one.restitution]));
        }
        numbers
    }
}

impl Attraction {
    fn numbers(&self) -> impl Iterator<Item = &Number> {
        std::iter::once(&self.mu).chain(&self.centre)
    }
}

impl Shape {
    fn add_numbers<'m>(&'m self, numbers: &mut Vec<&'m Number>) {
        match &self.kind {
            ShapeKind::Box(sides) | ShapeKind::Ellipsoid(sides) => numbers.extend(sides),
            ShapeKind::Cylinder(sizes)
            | ShapeKind::Capsule(sizes)
            | ShapeKind::Torus(sizes)
            | ShapeKind::Plane(sizes) => numbers.extend(sizes),
            ShapeKind::Vertices(corners) => numbers.extend(corners.as_flattened()),
            ShapeKind::Sphere(radius) => numbers.push(radius),
            ShapeKind::Mesh { scale, .. } => numbers.extend(scale),
        }
        numbers.extend(self.position.iter().chain(&self.orientation));
    }
}

impl Motion {
    fn add_numbers<'m>(&'m self, numbers: &mut Vec<&'m Number>) {
        match self {
            Self::Polynomial(coefficients) => numbers.extend(coefficients),
            Self::Sinusoid { amplitude, angular_frequency, phase } => {
                numbers.extend([amplitude, angular_frequency, phase]);
            }
            Self::Sum(parts) | Self::Product(parts) => {
                parts.iter().for_each(|part| part.add_numbers(numbers));
            }
            Self::Formula(formula) => numbers.extend(formula.numbers()),
            Self::Table(_) | Self::Lines(_) | Self::Input(_) => {}
        }
    }
}
