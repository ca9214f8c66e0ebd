//! Forces and outputs.

use crate::page::{Page, list};
use crate::vector::{Place, Vector, difference, dot};

/// Ends of a link are at least so far apart, m.
const APART: f64 = 0.1;

impl Page {
    /// Forces of all kinds, the bodies being where they are.
    pub fn forces(&mut self, places: &[Place]) {
        for index in 0..self.dice.pick(&[0, 1, 1, 2, 3, 4]) {
            let kind =
                self.dice.pick(&["spring", "damper", "coulomb", "stop", "motor", "motor", "link", "load"]);
            let keys = match kind {
                "link" => self.link(places),
                "load" => self.load(),
                _ => self.along_coordinate(kind),
            };
            if let Some(keys) = keys {
                if matches!(kind, "spring" | "link") {
                    self.elastic.push((format!("f{index}"), kind));
                }
                self.elements += &format!("\n[[force]]\nname = \"f{index}\"\nkind = \"{kind}\"\n{keys}");
            }
        }
    }

    /// A spring on every coordinate, and armatures on some of the joints that can have one: whichever joint of a loop
    /// is cut, something holds it. Other dice than those of the rest decide on it.
    pub fn hold_all(&mut self) {
        for (index, (joint, coordinate)) in self.coordinates().into_iter().enumerate() {
            let (stiffness, free) =
                (self.rotors.pick(&["0.3", "2", "7.5"]), self.rotors.pick(&["0", "-0.4", "1.1"]));
            self.elastic.push((format!("h{index}"), "spring"));
            self.elements += &format!(
                "\n[[force]]\nname = \"h{index}\"\nkind = \"spring\"\njoint = \"j{joint}\"\ncoordinate = \
                 {coordinate:?}\nstiffness = {stiffness}\nfree = {free}\n"
            );
        }
        for joint in &mut self.joints {
            let kind = joint.kind.name;
            let has_rotor = matches!(kind, "revolute" | "prismatic") && !joint.text.contains("armature");
            if has_rotor && self.rotors.once_in(2) {
                joint.text += &format!("armature = {}\n", self.rotors.pick(&["0.02", "0.3"]));
            }
        }
    }

    fn along_coordinate(&mut self, kind: &str) -> Option<String> {
        let coordinates = self.coordinates();
        if coordinates.is_empty() {
            return None;
        }
        let (joint, coordinate) = self.dice.pick(&coordinates);
        let on = self.on(joint, coordinate);
        let keys = match kind {
            "spring" => {
                let free = self.dice.signed();
                format!("stiffness = {}\nfree = {}\n", self.positive(), self.tunable(free))
            }
            "damper" => format!("damping = {}\n", self.positive_strength()),
            "coulomb" => format!("level = {}\nrate = {}\n", self.positive_strength(), self.positive()),
            "stop" => self.stop(),
            _ => {
                let value = self.dice.signed();
                format!("value = {}\n", self.strength(value))
            }
        };
        Some(on + &keys)
    }

    fn positive_strength(&mut self) -> String {
        let number = self.dice.number();
        self.strength(number)
    }

    fn stop(&mut self) -> String {
        let (limit, side) = (self.dice.angle(), self.dice.pick(&["lower", "upper"]));
        let softness = match self.dice.below(3) {
            0 => "1e-9".to_owned(),
            1 => "0.01".to_owned(),
            _ => self.positive(),
        };
        let damping = if self.dice.once_in(2) {
            format!("damping = {}\n", self.positive_strength())
        } else {
            String::new()
        };
        let stiffness = if self.dice.once_in(2) { "1000".to_owned() } else { self.positive() };
        let limit = self.tunable(limit);
        format!(
            "limit = {limit}\nside = \"{side}\"\nstiffness = {stiffness}\nsoftness = {softness}\n{damping}"
        )
    }

    /// Between two points that are well apart.
    fn link(&mut self, places: &[Place]) -> Option<String> {
        let (a, b) = (self.dice.below(places.len()), self.dice.below(places.len()));
        let mut point = || [(); 3].map(|()| (100.0 * self.dice.between(-1.0, 1.0)).round() / 100.0);
        let (first, second) = (point(), point());
        let apart = difference(places[a].global(first), places[b].global(second));
        let moves = self.bodies[a].0.moves() || self.bodies[b].0.moves();
        if a == b || !moves || dot(apart, apart) < APART * APART {
            return None;
        }
        let mut end = |body: usize, point: Vector| {
            let point = point.map(|x| format!("{x:?}"));
            format!("{{ body = \"b{body}\", point = {} }}", self.tunables(point))
        };
        let ends = format!("first = {}\nsecond = {}\n", end(a, first), end(b, second));
        let elastic = format!("stiffness = {}\nfree_length = {}\n", self.positive(), self.positive());
        let viscous = format!("damping = {}\n", self.positive_strength());
        Some(match self.dice.below(3) {
            0 => ends + &elastic,
            1 => ends + &viscous,
            _ => ends + &elastic + &viscous,
        })
    }

    fn load(&mut self) -> Option<String> {
        let body = self.moving()?;
        let mut keys = format!("body = \"b{body}\"\n");
        let vector = |page: &mut Self| {
            list(&[(); 3].map(|()| {
                let number = page.dice.signed();
                page.strength(number)
            }))
        };
        let form = self.dice.below(3);
        if form != 0 {
            keys += &format!("force = {}\n", vector(self));
        }
        if form != 1 {
            keys += &format!("torque = {}\n", vector(self));
        }
        if self.dice.once_in(2) {
            let point = self.dice.point();
            keys += &format!("point = {}\nframe = \"body\"\n", self.tunables(point));
        }
        Some(keys)
    }

    /// A body that joints hold or that floats.
    pub fn moving(&mut self) -> Option<usize> {
        let moving: Vec<_> = (0..self.bodies.len()).filter(|&body| self.bodies[body].0.moves()).collect();
        (!moving.is_empty()).then(|| self.dice.pick(&moving))
    }

    /// What some couplers, springs and links do. Other dice than those of the rest decide on it.
    pub fn elastic_outputs(&mut self) {
        let couplers = (0..self.n_couplers).map(|index| ("coupler", "coupler", format!("c{index}")));
        let elastic = self.elastic.iter().map(|(name, kind)| (*kind, "force", name.clone()));
        let all: Vec<_> = couplers.chain(elastic).collect();
        for (index, (kind, key, name)) in all.into_iter().enumerate() {
            if self.rotors.once_in(3) {
                self.elements +=
                    &format!("\n[[output]]\nname = \"e{index}\"\nkind = \"{kind}\"\n{key} = \"{name}\"\n");
            }
        }
    }

    /// Outputs of the kinds that there are in every mechanism, and of joints and drivers.
    pub fn outputs(&mut self) {
        for index in 0..self.dice.pick(&[0, 0, 1, 2, 3]) {
            let kinds =
                ["pose", "velocity", "acceleration", "inertial", "reaction", "driver", "energy", "power"];
            let kind = self.dice.pick(&kinds);
            let keys = match kind {
                "reaction" if self.joints.is_empty() => continue,
                "driver" if self.n_drivers == 0 => continue,
                "reaction" => format!("joint = \"j{}\"\n", self.dice.below(self.joints.len())),
                "driver" => format!("driver = \"d{}\"\n", self.dice.below(self.n_drivers)),
                "energy" | "power" => String::new(),
                _ => {
                    let Some(body) = self.moving() else { continue };
                    let point = self.dice.point();
                    let place = format!("body = \"b{body}\"\npoint = {}\n", self.tunables(point));
                    // Of numbers that are drawn beside the others, so that what was drawn before stays as it was.
                    let p = [(); 4].map(|()| self.rotors.pick(&["-2", "-1", "0.5", "1", "3"]).to_owned());
                    let orientation = format!("orientation = {}\n", list(&p));
                    if self.rotors.once_in(2) { place + &orientation } else { place }
                }
            };
            match kind {
                "pose" => self.early.push(format!("o{index}.ry")),
                "velocity" | "inertial" => self.early.push(format!("o{index}.wz")),
                _ => {}
            }
            self.elements += &format!("\n[[output]]\nname = \"o{index}\"\nkind = \"{kind}\"\n{keys}");
        }
    }
}
