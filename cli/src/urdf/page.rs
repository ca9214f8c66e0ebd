//! The model file of a robot as text.

use super::element::settled;
use super::inertia::{rounded, tensor};
use super::merge::{Body, Merged, Place, Root, Settled};
use super::names::{Names, snake_case};
use super::numbers::{euler_parameters, vector};
use super::robot::{Joint, Kind, Limit, Link, Robot};
use super::wrenches::Wrench;
use super::{Wishes, frames, wrenches};
use crate::words;
use nalgebra::{IsometryMatrix3, Point3, Vector3};
use std::fmt::Write as _;
use std::path::Path;

/// Rate at which Coulomb friction reaches tanh(1) of its level: URDF does not say. rad/s or m/s.
const COULOMB_RATE: f64 = 0.01;

/// How far the greatest torque or force of its drive pushes a joint into its stop, rad and m.
const GIVES_WAY: [f64; 2] = [0.01, 1e-3];

/// Lever, m, at which the weight of what a joint carries stands for the torque of a drive that is not known.
const LEVER: f64 = 1.0;

/// No stop is stiffer than what makes all that a joint carries vibrate at this, rad/s: with [`STOP_STEP`] a tenth of a
/// radian a step, and what a joint feels may be a fraction of what it carries.
const FASTEST: f64 = 1000.0;

/// Step of a robot with stops, s.
const STOP_STEP: &str = "1e-4";

/// Width over which a stop sets in, as a part of how far it gives way.
const SOFTNESS: f64 = 0.1;

const GRAVITY: f64 = 9.81;

/// Writes the model file; adds what is worth knowing about it to the remarks.
pub(super) fn write(
    file: &str,
    robot: &Robot,
    (merged, wishes): (&Merged, Wishes<'_>),
    remarks: &mut Vec<String>,
) -> String {
    let (mut body_names, mut joint_names) = (Names::default(), Names::default());
    let bodies: Vec<String> =
        merged.bodies.iter().map(|body| body_names.name(&robot.links[body.link].name)).collect();
    let mut named = |joint: &Joint| {
        let is_written = merged.places[joint.parent].body != merged.places[joint.child].body;
        if is_written { joint_names.name(&joint.name) } else { String::new() }
    };
    let joints: Vec<String> = robot.joints.iter().map(&mut named).collect();
    let mut coupled = |(joint, name): (&Joint, &String)| {
        joint.mimic.as_ref().map_or_else(String::new, |_| joint_names.name(&format!("{name}_mimic")))
    };
    let mimics = robot.joints.iter().zip(&joints).map(&mut coupled).collect();
    let framed = frames::of(robot, merged, wishes.frames, &mut joint_names);
    let changed = body_names.changed.iter().chain(&joint_names.changed);
    let changed: Vec<String> = changed.map(|(was, is)| format!("`{was}` is `{is}`")).collect();
    if !changed.is_empty() {
        remarks.push(format!("names: {}", words::listed(&changed)));
    }
    let wrenches = wrenches::of(robot, merged, wishes.wrenches);
    let page = Page { robot, merged, bodies, joints, mimics, wishes, wrenches };
    remarks.extend(page.remarks());
    let mut text = page.head(file, remarks);
    (0..merged.bodies.len()).for_each(|body| page.body(&mut text, body));
    for write in [Page::joint, Page::coupler, Page::friction, Page::motor, Page::stops] {
        page.moving_joints().for_each(|joint| write(&page, &mut text, joint));
    }
    for frame in framed {
        frame.outputs(&mut text, &page.bodies[frame.place.body]);
    }
    for wrench in &page.wrenches {
        wrench.load(&mut text, &page.bodies[wrench.body], &vector(&wrench.point));
    }
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
    /// Names of couplers, should the joints have them.
    mimics: Vec<String>,
    wishes: Wishes<'a>,
    wrenches: Vec<Wrench>,
}

impl Page<'_> {
    /// Joints between two bodies.
    fn moving_joints(&self) -> impl Iterator<Item = usize> {
        let is_moving = |joint: &Joint| joint.kind != Kind::Fixed;
        (0..self.robot.joints.len()).filter(move |index| is_moving(&self.robot.joints[*index]))
    }

    fn remarks(&self) -> Vec<String> {
        let root = &self.robot.links[self.merged.bodies[0].link];
        let mut remarks = vec![
            of_root(root, self.wishes.root),
            format!("gravity is taken to be {GRAVITY} m/s2 along -z: URDF does not say"),
        ];
        let joints = &self.robot.joints;
        if joints.iter().any(|joint| joint.friction > 0.0) {
            remarks
                .push(format!("Coulomb friction sets in at {COULOMB_RATE} rad/s or m/s: URDF does not say"));
        }
        let limited = joints.iter().filter(|joint| joint.limit.is_some()).count() as u64;
        let limited = words::count(limited, "<limit>");
        if self.wishes.limits {
            let [angle, length] = GIVES_WAY;
            remarks.push(format!(
                "{limited}: a stop gives way by {angle} rad or {length} m under the effort of the limit, or, where that is 0, \
                 under the weight of what the joint carries (of a revolute one, at {LEVER} m); it is no stiffer than what \
                 makes that vibrate at {FASTEST} rad/s, and half critically damped. No limit is set to efforts and \
                 velocities"
            ));
        } else if joints.iter().any(|joint| joint.limit.is_some()) {
            remarks.push(format!("{limited} left out: --limits makes stops of them"));
        }
        let starts = self.moving_joints().filter(|joint| self.wishes.limits && self.start(*joint) != 0.0);
        let starts: Vec<String> = starts.map(|joint| format!("`{}`", self.joints[joint])).collect();
        if !starts.is_empty() {
            remarks.push(format!("joints that do not start at 0: {}", words::listed(&starts)));
        }
        for joint in self.moving_joints().filter(|joint| self.wishes.limits && self.limit(*joint).is_none()) {
            if let Some(Limit { lower, upper, .. }) = joints[joint].limit {
                let name = &self.joints[joint];
                remarks.push(format!(
                    "joint `{name}` has no stops: its limits {lower:?} and {upper:?} leave it nothing"
                ));
            }
        }
        remarks.extend(self.remark_on_transmissions());
        remarks
    }

    /// Transmissions may be those of one simulator's plugins, or be left out of a file altogether: every joint gets its
    /// motor, and those that the file has none for are named.
    fn remark_on_transmissions(&self) -> Option<String> {
        let transmitted = &self.robot.transmitted;
        let others = self.motors().filter(|&joint| !transmitted.contains(&self.robot.joints[joint].name));
        let others: Vec<String> = others.map(|joint| format!("`{}`", self.joints[joint])).collect();
        (!transmitted.is_empty() && !others.is_empty()).then(|| {
            format!(
                "--motors: these have a motor though no <transmission> names them: {}",
                words::listed(&others)
            )
        })
    }

    fn head(&self, file: &str, remarks: &[String]) -> String {
        let mut text = format!(
            "# Written by {} from {file}. A body is all links that are fixed to one another; its frame is at their\n\
             # mass centre, with the axes of the link on the body's joint. Links' frames: place and Euler parameters.\n\
             # What differs from the robot:\n",
            self.wishes.tool
        );
        for remark in remarks {
            let _ = writeln!(text, "# - {remark}");
        }
        let name = snake_case(&self.robot.name);
        let name = if gyro_model::is_keyword(&name) { format!("{name}_robot") } else { name };
        let _ = write!(text, "format = 1\nname = \"{name}\"\ngravity = [0, 0, -{GRAVITY}]\n\n");
        let has_stops = self.wishes.limits && self.moving_joints().any(|joint| self.limit(joint).is_some());
        let step = if has_stops { STOP_STEP } else { "1e-3" };
        let _ = write!(text, "[simulation]\nt_end = 1\nstep = {step}\n");
        if self.motors().next().is_some() || !self.wrenches.is_empty() {
            text.push_str("\n[inputs]\n");
        }
        for joint in self.motors() {
            let unit = if self.robot.joints[joint].kind == Kind::Revolute { "N.m" } else { "N" };
            let _ = writeln!(text, "{}_motor = 0  # {unit}", self.joints[joint]);
        }
        self.wrenches.iter().for_each(|wrench| wrench.inputs(&mut text));
        text
    }

    fn body(&self, text: &mut String, index: usize) {
        let body = &self.merged.bodies[index];
        let _ = write!(text, "\n[[body]]\nname = \"{}\"\n", self.bodies[index]);
        match &body.inertial {
            Some(inertial) => self.moving(text, body, inertial),
            None => text.push_str("fixed = true\n"),
        }
        for (place, link) in self.merged.places.iter().zip(&self.robot.links) {
            if place.body == index {
                let (xyz, p) = (vector(&place.pose.translation.vector), euler_parameters(&place.pose));
                let name = link.name.escape_debug();
                let _ = writeln!(text, "# Link {name}: its frame is at {xyz} in the body's, turned by {p}.");
            }
        }
        for (place, link) in self.merged.places.iter().zip(&self.robot.links) {
            for shape in link.shapes.iter().filter(|_| place.body == index) {
                let pose = settled(&(place.pose * shape.pose));
                let _ = writeln!(
                    text,
                    "\n[[body.shape]]\n{}",
                    shape.kind.text(self.wishes.folder.unwrap_or(Path::new("")))
                );
                let _ = writeln!(text, "position = {}", vector(&pose.translation.vector));
                let _ = writeln!(text, "orientation = {}", euler_parameters(&pose));
                if let Some(color) = &shape.color {
                    let _ = writeln!(text, "color = \"{color}\"");
                }
            }
        }
    }

    fn moving(&self, text: &mut String, body: &Body, inertial: &Settled) {
        let carrier = body.carrier.map(|joint| self.robot.joints[joint].kind);
        // The root's body is carried by none, and it is written only where it moves.
        if carrier.is_none_or(|kind| kind == Kind::Floating) {
            let _ = writeln!(text, "free = true\nposition = {}", vector(&body.zero.translation.vector));
            let _ = writeln!(text, "orientation = {}", euler_parameters(&body.zero));
        }
        let [xx, yy, zz, xy, xz, yz] = inertial.inertia;
        if inertial.as_written {
            text.push_str("as_written = true\n");
        }
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

    fn joint(&self, text: &mut String, index: usize) {
        let joint = &self.robot.joints[index];
        let kind = match joint.kind {
            Kind::Revolute => "revolute",
            Kind::Prismatic => "prismatic",
            Kind::Planar => "planar",
            Kind::Fixed | Kind::Floating => return,
        };
        let (first, second) = (self.merged.places[joint.parent], self.merged.places[joint.child]);
        let _ = write!(text, "\n[[joint]]\nname = \"{}\"\nkind = \"{kind}\"\n", self.joints[index]);
        for (key, place, frame) in
            [("first", first, settled(&(first.pose * joint.origin))), ("second", second, second.pose)]
        {
            let _ = writeln!(text, "{key} = {}", self.end(place, &frame, joint));
        }
        let start = self.start(index);
        if start != 0.0 {
            let key = if joint.kind == Kind::Revolute { "angle" } else { "displacement" };
            let _ = writeln!(text, "{key} = {start:?}");
        }
        if joint.damping > 0.0 && joint.kind.is_single() {
            let _ = writeln!(text, "damping = {:?}", joint.damping);
        }
        if let Some(armature) = self.wishes.armature.filter(|_| self.is_driven(index)) {
            let _ = writeln!(text, "armature = {armature:?}");
        }
    }

    /// An end of a joint: the joint's frame in the body's.
    fn end(&self, place: Place, frame: &IsometryMatrix3<f64>, joint: &Joint) -> String {
        let axis = joint.axis;
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

    /// The coordinate at the start: zero, or, if stops are wanted, where they allow it, or what the joint follows.
    fn start(&self, index: usize) -> f64 {
        let joint = &self.robot.joints[index];
        match (&joint.mimic, self.limit(index).filter(|_| self.wishes.limits)) {
            (Some(mimic), _) => rounded(mimic.multiplier * self.start(mimic.joint) + mimic.offset),
            (None, Some(limit)) => 0.0_f64.clamp(limit.lower, limit.upper),
            (None, None) => 0.0,
        }
    }

    /// The limits of a joint, if there is something between them.
    fn limit(&self, index: usize) -> Option<Limit> {
        self.robot.joints[index].limit.filter(|limit| limit.lower < limit.upper)
    }

    /// Joints that are given a motor if that is wished: all but those that follow others.
    fn motors(&self) -> impl Iterator<Item = usize> {
        self.moving_joints().filter(|&index| self.is_driven(index)).filter(|_| self.wishes.motors)
    }

    fn is_driven(&self, index: usize) -> bool {
        let joint = &self.robot.joints[index];
        joint.kind.is_single() && joint.mimic.is_none()
    }

    fn motor(&self, text: &mut String, index: usize) {
        if self.motors().any(|joint| joint == index) {
            let name = &self.joints[index];
            let _ = write!(
                text,
                "\n[[force]]\nname = \"{name}_motor\"\nkind = \"motor\"\njoint = \"{name}\"\nvalue = \"{name}_motor\"\n"
            );
        }
    }

    fn stops(&self, text: &mut String, index: usize) {
        let Some(limit) = self.limit(index).filter(|_| self.wishes.limits) else { return };
        let joint = &self.robot.joints[index];
        let [way, lever] =
            if joint.kind == Kind::Revolute { [GIVES_WAY[0], LEVER] } else { [GIVES_WAY[1], 1.0] };
        let (mass, inertia) = self.carried(index);
        let effort = if limit.effort > 0.0 { limit.effort } else { mass * GRAVITY * lever };
        let name = &self.joints[index];
        let stiffness = (effort / way).min(inertia * FASTEST * FASTEST);
        // Half of what is critical.
        let damping = rounded((stiffness * inertia).sqrt());
        let (stiffness, softness) = (rounded(stiffness), rounded(way * SOFTNESS));
        for (side, at) in [("lower", limit.lower), ("upper", limit.upper)] {
            let _ = write!(
                text,
                "\n[[force]]\nname = \"{name}_{side}_stop\"\nkind = \"stop\"\njoint = \"{name}\"\nside = \"{side}\"\n\
                 limit = {at:?}\nstiffness = {stiffness:?}\ndamping = {damping:?}\nsoftness = {softness:?}\n"
            );
        }
    }

    /// The mass of all that a joint carries, and what of it resists the joint with all others at zero: the mass, or the
    /// moment of inertia about the axis.
    fn carried(&self, index: usize) -> (f64, f64) {
        let joint = &self.robot.joints[index];
        let place = self.merged.places[joint.child];
        let frame = self.merged.bodies[place.body].zero * place.pose;
        let axis = frame.rotation * joint.axis;
        let (mut mass, mut moment) = (0.0, 0.0);
        let mut bodies = vec![place.body];
        while let Some(index) = bodies.pop() {
            let body = &self.merged.bodies[index];
            let Some(inertial) = &body.inertial else { continue };
            let arm = (body.zero.translation.vector - frame.translation.vector).cross(&axis);
            let about = body.zero.rotation.inverse() * axis;
            mass += inertial.mass;
            moment += about.dot(&(tensor(inertial.inertia) * about)) + inertial.mass * arm.norm_squared();
            bodies.extend(self.on(index));
        }
        (mass, if joint.kind == Kind::Revolute { moment } else { mass })
    }

    /// The bodies whose joints are on a body.
    fn on(&self, body: usize) -> impl Iterator<Item = usize> {
        let is_on = move |other: &Body| {
            other
                .carrier
                .is_some_and(|joint| self.merged.places[self.robot.joints[joint].parent].body == body)
        };
        (0..self.merged.bodies.len()).filter(move |other| is_on(&self.merged.bodies[*other]))
    }

    fn coupler(&self, text: &mut String, index: usize) {
        let Some(mimic) = &self.robot.joints[index].mimic else { return };
        let (name, other) = (&self.joints[index], &self.joints[mimic.joint]);
        let _ = write!(
            text,
            "\n[[coupler]]\nname = \"{}\"\nfirst = {{ joint = \"{other}\" }}\nsecond = {{ joint = \"{name}\" }}\n\
             ratio = {:?}\noffset = {:?}\n",
            self.mimics[index], mimic.multiplier, mimic.offset
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
