//! A model and its samples as the page wants them: plain data.

use super::meshes::Meshes;
use super::touches::{touches, upright};
use super::{efforts, laws};
use crate::columns::{self, orientation, scalar};
use crate::events;
use crate::scene::Scene;
use crate::verdict::Outcome;
use gyro_model::{
    Body, ForceKind, JointEnd, LoadFrame, Model, Number, OutputKind, Shape, ShapeKind, Support, Vector,
};
use gyro_runner::{Sample, energy_error};
use gyro_show::{Column, Reaction, Run, Scale};

/// Slot and index of each body with coordinates, those first that [`crate::scene::observed`] has.
pub(crate) fn observed(model: &Model) -> Vec<(usize, usize)> {
    let all = model.coordinate_bodies().into_iter().enumerate();
    let (mut free, others): (Vec<_>, Vec<_>) =
        all.partition(|&(_, b)| model.bodies[b].support == Support::Free);
    free.extend(others);
    free
}

/// What the page shows of a run.
pub(crate) fn scene(scene: &Scene, name: String, outcome: &Outcome, meshes: Meshes) -> gyro_show::Scene {
    let events = events::times(&scene.model, &outcome.occurrences);
    let run = Run { events, ..run(scene, &outcome.samples) };
    gyro_show::Scene { name, mechanism: mechanism(&scene.model, meshes), run }
}

/// What the picture is made of.
pub(super) fn mechanism(model: &Model, meshes: Meshes) -> gyro_show::Mechanism {
    gyro_show::Mechanism {
        name: model.name.clone(),
        gravity: model.values(&model.gravity),
        bodies: model.bodies.iter().map(|body| described(model, &meshes, body)).collect(),
        joints: model
            .joints
            .iter()
            .map(|joint| gyro_show::Joint {
                name: joint.name.clone(),
                kind: format!("{:?}", joint.kind),
                ends: [&joint.first, &joint.second].map(|end| joint_end(model, end)),
                lead: model.value(&joint.lead),
            })
            .collect(),
        links: links(model),
        springs: springs(model),
        loads: loads(model),
        touches: touches(model),
        efforts: efforts::efforts(model),
        meshes: meshes.meshes,
    }
}

fn described(model: &Model, meshes: &Meshes, body: &Body) -> gyro_show::Body {
    gyro_show::Body {
        name: body.name.clone(),
        support: match body.support {
            Support::Moving | Support::Free => gyro_show::Support::Moving,
            Support::Fixed | Support::Constrained => gyro_show::Support::Fixed,
            Support::Driven => gyro_show::Support::Driven,
        },
        free: body.support == Support::Free,
        mass: model.value(&body.mass),
        inertia: model.values(&body.inertia),
        shapes: body.shapes.iter().map(|shape| drawn(model, meshes, shape)).collect(),
    }
}

fn drawn(model: &Model, meshes: &Meshes, shape: &Shape) -> gyro_show::Shape {
    let mut mesh = None;
    let (kind, size) = match &shape.kind {
        ShapeKind::Box(edges) => ("box", model.values(edges).to_vec()),
        ShapeKind::Cylinder(sizes) => ("cylinder", model.values(sizes).to_vec()),
        ShapeKind::Capsule(sizes) => ("capsule", model.values(sizes).to_vec()),
        ShapeKind::Ellipsoid(sizes) => ("ellipsoid", model.values(sizes).to_vec()),
        ShapeKind::Torus(sizes) => ("torus", model.values(sizes).to_vec()),
        ShapeKind::Plane(sizes) => ("plane", model.values(sizes).to_vec()),
        ShapeKind::Vertices(corners) => {
            ("vertices", corners.iter().flat_map(|corner| model.values(corner)).collect())
        }
        ShapeKind::Sphere(radius) => ("sphere", vec![model.value(radius)]),
        ShapeKind::Mesh { file, scale } => {
            mesh = meshes.place(file);
            ("mesh", model.values(scale).to_vec())
        }
    };
    let orientation = upright(model.values(&shape.orientation));
    let color = shape.color.map(|[red, green, blue]| format!("#{red:02x}{green:02x}{blue:02x}"));
    gyro_show::Shape { kind, size, mesh, color, position: model.values(&shape.position), orientation }
}

/// With unit vectors, the zero direction without its part along the axis.
fn joint_end(model: &Model, end: &JointEnd) -> gyro_show::JointEnd {
    let axis = unit(model.values(&end.axis), [0.0, 0.0, 1.0]);
    let zero = model.values(&end.zero);
    let along: f64 = axis.iter().zip(&zero).map(|(a, z)| a * z).sum();
    let across = std::array::from_fn(|k| zero[k] - along * axis[k]);
    let zero = unit(across, [1.0, 0.0, 0.0]);
    gyro_show::JointEnd { body: end.body, point: model.values(&end.point), axis, zero }
}

fn unit(v: [f64; 3], otherwise: [f64; 3]) -> [f64; 3] {
    let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    if length > 0.0 { v.map(|x| x / length) } else { otherwise }
}

fn links(model: &Model) -> Vec<gyro_show::Link> {
    let link = |(index, force): (usize, &gyro_model::Force)| match &force.kind {
        ForceKind::Link { first, second, stiffness, damping, free_length, tension: _ } => {
            Some(gyro_show::Link {
                name: force.name.clone(),
                ends: [first, second].map(|(body, point)| (*body, model.values(point))),
                stiffness: model.value(stiffness),
                damping: model.value(damping),
                free_length: model.value(free_length),
                force: laws::of_link(model, index),
            })
        }
        _ => None,
    };
    model.forces.iter().enumerate().filter_map(link).collect()
}

fn springs(model: &Model) -> Vec<usize> {
    let spring = |force: &gyro_model::Force| match force.kind {
        ForceKind::Spring { on, .. } => Some(on.joint),
        _ => None,
    };
    model.forces.iter().filter_map(spring).collect()
}

fn loads(model: &Model) -> Vec<gyro_show::Load> {
    let load = |force: &gyro_model::Force| match &force.kind {
        ForceKind::Load { body, point, force: along, torque, frame } => {
            let told = |numbers: &[Number; 3]| numbers.each_ref().map(|number| laws::told(model, number));
            Some(gyro_show::Load {
                name: force.name.clone(),
                body: *body,
                point: model.values(point),
                force: told(along),
                torque: told(torque),
                in_body: *frame == LoadFrame::Body,
            })
        }
        _ => None,
    };
    model.forces.iter().filter_map(load).collect()
}

fn run(scene: &Scene, samples: &[Sample]) -> Run {
    let model = &scene.model;
    let order = observed(model);
    let place = |body: usize| order.iter().position(|&(_, b)| b == body);
    let (mut poses, mut velocities) = (Vec::new(), Vec::new());
    for (index, body) in model.bodies.iter().enumerate() {
        let (pose, velocity) = match (place(index), &body.motion) {
            (Some(k), _) => samples.iter().map(|s| (s.bodies[k].pose, s.bodies[k].velocity)).unzip(),
            (None, Some(motion)) => samples
                .iter()
                .map(|s| motion.state(model, body, s.t))
                .map(|at| (pose(at.r, at.p.0), join(at.s.into(), at.w.into())))
                .unzip(),
            (None, None) => (vec![standing(model, body)], Vec::new()),
        };
        poses.push(pose);
        velocities.push(velocity);
    }
    let (columns, reactions) = plotted(scene, samples);
    let times = samples.iter().map(|s| s.t).collect();
    Run { times, poses, velocities, columns, reactions, events: Vec::new() }
}

fn pose(r: Vector, p: [f64; 4]) -> [f64; 7] {
    let r: [f64; 3] = r.into();
    std::array::from_fn(|k| if k < 3 { r[k] } else { p[k - 3] })
}

fn join(s: [f64; 3], w: [f64; 3]) -> [f64; 6] {
    std::array::from_fn(|k| if k < 3 { s[k] } else { w[k - 3] })
}

/// Where a fixed body is.
fn standing(model: &Model, body: &Body) -> [f64; 7] {
    pose(model.values(&body.position).into(), upright(model.values(&body.orientation)))
}

/// What is plotted, in the order of the table: joints, outputs, inputs, energy, violations.
fn plotted(scene: &Scene, samples: &[Sample]) -> (Vec<Column>, Vec<Reaction>) {
    let model = &scene.model;
    let mut plots = Plots { samples, columns: Vec::new() };
    for (index, shown) in columns::coordinates(model).iter().enumerate() {
        plots.coordinate(index, shown);
    }
    let mut reactions = Vec::new();
    let mut next = 0;
    for output in &model.outputs {
        if let OutputKind::Reaction { joint } = output.kind {
            reactions.push(Reaction { joint, column: plots.columns.len() });
        }
        for (suffix, unit) in columns::output_columns(model, output) {
            plots.add(("Outputs", &output.name, suffix, unit), move |s| s.outputs[next]);
            next += 1;
        }
    }
    for (index, input) in model.inputs.iter().enumerate() {
        let unit = columns::input_unit(model, index);
        let value = |s: &Sample| columns::inputs_at(model, &scene.start, s)[index];
        plots.add(("Inputs", &input.name, "", unit), value);
    }
    plots.energy(model.has_work());
    plots.violations();
    (plots.columns, reactions)
}

struct Plots<'a> {
    samples: &'a [Sample],
    columns: Vec<Column>,
}

impl Plots<'_> {
    fn add(
        &mut self,
        (group, title, name, unit): (&'static str, &str, &str, &str),
        value: impl Fn(&Sample) -> f64,
    ) {
        self.columns.push(Column {
            group,
            title: title.to_owned(),
            name: name.to_owned(),
            unit: unit.to_owned(),
            scale: Scale::Linear,
            values: self.samples.iter().map(value).collect(),
        });
    }

    fn coordinate(&mut self, index: usize, shown: &columns::Shown) {
        let title = &shown.name;
        if shown.is_orientation() {
            for (k, name) in ["e0", "e1", "e2", "e3"].into_iter().enumerate() {
                self.add(("Joints", title, name, "1"), |s| orientation(&s.coordinates[index]).0[k]);
            }
            for (k, name) in ["x", "y", "z"].into_iter().enumerate() {
                self.add(("Rates", title, name, "rad/s"), |s| orientation(&s.coordinates[index]).1[k]);
            }
            return;
        }
        self.add(("Joints", title, "", shown.unit()), |s| scalar(&s.coordinates[index]).0);
        self.add(("Rates", title, "", shown.rate_unit()), |s| scalar(&s.coordinates[index]).1);
    }

    fn energy(&mut self, has_work: bool) {
        let Some(first) = self.samples.first().cloned() else { return };
        self.add(("Energy", "energy", "kinetic", "J"), |s| s.kinetic);
        self.add(("Energy", "energy", "potential", "J"), |s| s.potential);
        if has_work {
            self.add(("Energy", "energy", "work", "J"), |s| s.work);
        }
        self.add(("Energy", "error of the energy balance", "", "J"), |s| energy_error(&first, s));
    }

    fn violations(&mut self) {
        let first = self.columns.len();
        self.add(("Violations", "constraints", "", "1"), |s| s.position_violation);
        self.add(("Violations", "velocities", "", "1/s"), |s| s.velocity_violation);
        self.columns[first..].iter_mut().for_each(|column| column.scale = Scale::Log);
    }
}
