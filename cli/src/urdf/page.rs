//! The model file of a robot as text.

use super::MARK;
use super::merge::{Body, Merged, Place, Root};
use super::names::{Names, snake_case};
use super::robot::{Inertial, Joint, Kind, Link, Robot};
use nalgebra::{IsometryMatrix3, Point3, UnitQuaternion, Vector3};
use std::fmt::Write as _;

/// Rate at which Coulomb friction reaches tanh(1) of its level: URDF does not say. rad/s or m/s.
const COULOMB_RATE: f64 = 0.01;

/// What rotations leave of a zero.
const ROUNDING: f64 = 1e-15;

/// Writes the model file; adds what is worth knowing about it to the remarks.
pub(super) fn write(
    file: &str,
    robot: &Robot,
    (merged, root): (&Merged, Root),
    remarks: &mut Vec<String>,
) -> String {
    let (mut body_names, mut joint_names) = (Names::default(), Names::default());
    let bodies: Vec<String> =
        merged.bodies.iter().map(|body| body_names.name(&robot.links[body.link].name)).collect();
    let joints: Vec<String> = robot.joints.iter().map(|joint| joint_names.name(&joint.name)).collect();
    for (was, is) in body_names.changed.iter().chain(&joint_names.changed) {
        remarks.push(format!("`{was}` is called `{is}`"));
    }
    let page = Page { robot, merged, bodies, joints };
    remarks.push(of_root(&robot.links[merged.bodies[0].link], root));
    remarks.push("gravity is taken to be 9.81 m/s2 along -z: URDF does not say".to_owned());
    if robot.joints.iter().any(|joint| joint.friction > 0.0) {
        remarks.push(format!("Coulomb friction sets in at {COULOMB_RATE} rad/s or m/s: URDF does not say"));
    }
    let mut text = page.head(file, remarks);
    (0..merged.bodies.len()).for_each(|body| page.body(&mut text, body));
    (0..robot.joints.len()).for_each(|joint| page.joint(&mut text, joint));
    (0..robot.joints.len()).for_each(|joint| page.coupler(&mut text, joint));
    (0..robot.joints.len()).for_each(|joint| page.friction(&mut text, joint));
    text
}

/// What became of the root. A fixed one has its frame where its link's is, a free one at its mass centre, so that the
/// one cannot be made of the other by a word in the model file.
fn of_root(link: &Link, root: Root) -> String {
    let mass = if link.inertial.is_some() { ", its own mass left out" } else { "" };
    match root {
        Root::Fixed => format!("the root link `{}` is fixed{mass}; --floating lets it move", link.name),
        Root::Floating => format!(
            "the root link's body `{}` floats; it starts at rest, with the root's frame at the origin",
            link.name
        ),
    }
}

struct Page<'a> {
    robot: &'a Robot,
    merged: &'a Merged,
    /// Names in the model file.
    bodies: Vec<String>,
    joints: Vec<String>,
}

impl Page<'_> {
    fn head(&self, file: &str, remarks: &[String]) -> String {
        let mut text = format!(
            "{MARK} from {file}. A body's frame is at its mass centre, with the axes of its link's\n\
             # <inertial>. What differs from the robot:\n"
        );
        for remark in remarks {
            let _ = writeln!(text, "# - {remark}");
        }
        let name = snake_case(&self.robot.name);
        let _ = write!(text, "format = 1\nname = \"{name}\"\ngravity = [0, 0, -9.81]\n\n");
        text.push_str("[simulation]\nt_end = 1\nstep = 1e-3\n");
        text
    }

    fn body(&self, text: &mut String, body: usize) {
        let Body { link, inertial } = &self.merged.bodies[body];
        let _ = write!(text, "\n[[body]]\nname = \"{}\"\n", self.bodies[body]);
        match inertial {
            Some(inertial) => self.moving(text, *link, inertial),
            None => text.push_str("fixed = true\n"),
        }
        for (index, place) in self.merged.places.iter().enumerate() {
            if place.body == body && index != *link {
                let name = &self.robot.links[index].name;
                let (xyz, p) = (vector(&place.pose.translation.vector), euler_parameters(&place.pose));
                let _ = writeln!(
                    text,
                    "# Link {name}: its frame is at {xyz} in the body's, turned by Euler parameters {p}."
                );
            }
        }
    }

    fn moving(&self, text: &mut String, link: usize, inertial: &Inertial) {
        let carrier = self.robot.joints.iter().find(|j| self.is_carried_by(link, j));
        // The root's body is carried by none, and it is written only where it moves.
        if carrier.is_none_or(|joint| joint.kind == Kind::Floating) {
            let pose = self.merged.places[link].zero * inertial.origin;
            let _ = writeln!(text, "free = true\nposition = {}", vector(&pose.translation.vector));
            let _ = writeln!(text, "orientation = {}", euler_parameters(&pose));
        }
        let [xx, yy, zz, xy, xz, yz] = inertial.inertia;
        let _ = writeln!(text, "mass = {:?}", inertial.mass);
        let _ = if [xy, xz, yz] == [0.0; 3] {
            writeln!(text, "inertia = [{xx:?}, {yy:?}, {zz:?}]")
        } else {
            writeln!(
                text,
                "inertia = {{ xx = {xx:?}, yy = {yy:?}, zz = {zz:?}, xy = {xy:?}, xz = {xz:?}, yz = {yz:?} }}"
            )
        };
    }

    /// Whether a joint carries the body that a link gave its mass to.
    fn is_carried_by(&self, link: usize, joint: &Joint) -> bool {
        let body = self.merged.places[link].body;
        self.merged.places[joint.child].body == body && self.merged.places[joint.parent].body != body
    }

    fn joint(&self, text: &mut String, index: usize) {
        let joint = &self.robot.joints[index];
        let kind = match joint.kind {
            Kind::Revolute => "revolute",
            Kind::Prismatic => "prismatic",
            Kind::Planar => "planar",
            Kind::Fixed => "fixed",
            Kind::Floating => return,
        };
        let (first, second) = (self.merged.places[joint.parent], self.merged.places[joint.child]);
        if first.body == second.body {
            return;
        }
        let _ = write!(text, "\n[[joint]]\nname = \"{}\"\nkind = \"{kind}\"\n", self.joints[index]);
        for (key, place, frame) in
            [("first", first, first.pose * joint.origin), ("second", second, second.pose)]
        {
            let _ = writeln!(text, "{key} = {}", self.end(place, &frame, joint));
        }
        let start = self.start(index);
        if start != 0.0 {
            let key = if joint.kind == Kind::Revolute { "angle" } else { "displacement" };
            let _ = writeln!(text, "{key} = {start:?}");
        }
        if joint.damping > 0.0 && joint.kind.is_single() {
            let _ = writeln!(text, "friction = {:?}", joint.damping);
        }
    }

    /// An end of a joint: the joint's frame in the body's.
    fn end(&self, place: Place, frame: &IsometryMatrix3<f64>, joint: &Joint) -> String {
        let axis = if joint.kind == Kind::Fixed { Vector3::z() } else { joint.axis };
        // Any direction does that is far from the axis; both ends have the same.
        let mut zero = Vector3::zeros();
        zero[axis.iamin()] = 1.0;
        format!(
            "{{ body = \"{}\", point = {}, axis = {}, zero = {} }}",
            self.bodies[place.body],
            vector(&(frame * Point3::origin()).coords),
            vector(&(frame.rotation * axis)),
            vector(&(frame.rotation * zero))
        )
    }

    /// The coordinate at the start: zero, or what the joint follows.
    fn start(&self, index: usize) -> f64 {
        let mimic = self.robot.joints[index].mimic.as_ref();
        mimic.map_or(0.0, |mimic| mimic.multiplier * self.start(mimic.joint) + mimic.offset)
    }

    fn coupler(&self, text: &mut String, index: usize) {
        let Some(mimic) = &self.robot.joints[index].mimic else { return };
        let (name, other) = (&self.joints[index], &self.joints[mimic.joint]);
        let _ = write!(
            text,
            "\n[[coupler]]\nname = \"{name}_mimic\"\nfirst = {{ joint = \"{other}\" }}\nsecond = {{ joint = \"{name}\" }}\n\
             ratio = {:?}\noffset = {:?}\n",
            mimic.multiplier, mimic.offset
        );
    }

    fn friction(&self, text: &mut String, index: usize) {
        let joint = &self.robot.joints[index];
        if joint.friction > 0.0 && joint.kind.is_single() {
            let _ = write!(
                text,
                "\n[[force]]\nname = \"{0}_friction\"\nkind = \"coulomb\"\njoint = \"{0}\"\nlevel = {1:?}\n\
                 rate = {COULOMB_RATE:?}\n",
                self.joints[index], joint.friction
            );
        }
    }
}

fn vector(v: &Vector3<f64>) -> String {
    list(v.as_slice())
}

fn euler_parameters(pose: &IsometryMatrix3<f64>) -> String {
    let p = UnitQuaternion::from_rotation_matrix(&pose.rotation);
    list(&[p.w, p.i, p.j, p.k])
}

fn list(values: &[f64]) -> String {
    let clean = |x: &f64| if x.abs() < ROUNDING { 0.0 } else { *x };
    let texts: Vec<String> = values.iter().map(|x| format!("{:?}", clean(x))).collect();
    format!("[{}]", texts.join(", "))
}
