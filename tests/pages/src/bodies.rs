//! Bodies and the tree of joints between them.

use crate::dice::{Dice, value};
use crate::page::{Hold, Joint, KINDS, Kind, Page, list};
use crate::vector::{cross, dot};

impl Page {
    /// A root, one to four moving bodies and the joints that hold them.
    pub fn tree(&mut self) {
        let root = self.dice.pick(&[
            Hold::Fixed,
            Hold::Fixed,
            Hold::Fixed,
            Hold::Fixed,
            Hold::Driven,
            Hold::Free,
            Hold::Constrained,
        ]);
        self.body(root);
        let n_moving = self.dice.pick(&[1, 1, 1, 1, 1, 1, 1, 1, 2, 2, 2, 2, 3, 4]);
        for _ in usize::from(root.moves())..n_moving.max(usize::from(root.moves())) {
            if self.dice.once_in(12) {
                self.body(Hold::Free);
            } else {
                let parent = self.dice.below(self.bodies.len());
                self.hung_body(parent);
            }
        }
    }

    fn body(&mut self, hold: Hold) {
        let place = self.place();
        let text = match hold {
            Hold::Fixed => format!("fixed = true\n{place}"),
            Hold::Constrained => {
                let (mass, inertia) = self.mass_and_inertia();
                format!("fixed = \"constrained\"\nmass = {mass}\ninertia = {inertia}\n{place}")
            }
            Hold::Driven => format!("{place}{}", self.prescribed()),
            Hold::Free => {
                let velocity = self.dice.point();
                let velocity = self.tunables(velocity);
                format!("free = true\n{}{place}velocity = {velocity}\n{}", self.solid(), self.spin())
            }
            Hold::Joint => unreachable!("a joint comes with it"),
        };
        let root = if hold == Hold::Free { self.bodies.len() + 1 } else { 0 };
        self.bodies.push((hold, text));
        self.roots.push(root);
        self.held.push(0);
    }

    fn hung_body(&mut self, parent: usize) {
        // Half are the plain hinge, the others any kind.
        let kind = if self.dice.once_in(3) { KINDS[0] } else { self.dice.pick(&KINDS) };
        let child = self.bodies.len();
        let mut text = self.solid();
        if kind.name == "rod" {
            // Far from all else: where the rod is shorter, it draws the body near.
            let place = [(); 3].map(|()| format!("{:.2}", self.dice.between(2.0, 4.0)));
            text += &format!("position = {}\n", list(&place));
        }
        // What a loop ties too follows from its joints.
        if ["rod", "point_on_line"].contains(&kind.name) && !self.is_closed && self.dice.once_in(2) {
            text += &format!("orientation = {}\n", self.orientation());
        }
        let has_spin = ["rod", "point_on_line", "spherical"].contains(&kind.name) && self.dice.once_in(2);
        if has_spin && !self.is_closed {
            text += &self.spin();
        }
        self.bodies.push((Hold::Joint, text));
        self.roots.push(self.roots[parent]);
        self.held.push(if kind.name == "rod" { child } else { self.held[parent] });
        *self.freedoms.entry(self.roots[parent]).or_default() += kind.freedoms;
        self.joint(kind, [parent, child], has_spin);
    }

    /// A joint; the parent may be its second body.
    fn joint(&mut self, kind: Kind, [parent, child]: [usize; 2], has_spin: bool) {
        let [first, second] = if self.dice.once_in(5) { [child, parent] } else { [parent, child] };
        let mut text = format!("kind = {:?}\n", kind.name);
        match kind.name {
            // About as long as its guess is far away.
            "rod" => {
                let length = format!("{:.2}", self.dice.between(4.0, 5.5));
                text += &format!("length = {}\n", self.tunable(length));
            }
            "screw" if self.dice.once_in(2) => text += &format!("lead = {}\n", self.positive()),
            "screw" => text += &format!("pitch = {}\n", self.dice.number()),
            _ => {}
        }
        let frames = self.frames(kind);
        for (key, body, frame) in [("first", first, &frames[0]), ("second", second, &frames[1])] {
            // A rod that pulls at the mass centre need not turn the body when the start is assembled.
            let is_pulled = kind.name == "rod" && body == child;
            let point = if is_pulled { [(); 3].map(|()| "0".to_owned()) } else { self.dice.point() };
            let point = self.tunables(point);
            text += &format!("{key} = {{ body = \"b{body}\", point = {point}{frame} }}\n");
        }
        let has_damping = kind.coordinates.len() == 1 || kind.name == "spherical";
        if has_damping && kind.name != "point_on_line" && self.dice.once_in(4) {
            text += &format!("damping = {}\n", self.positive());
        }
        if kind.freedoms == 1 && self.rotors.once_in(8) {
            text += &format!("armature = {}\n", self.rotors.pick(&["0.02", "0.15", "0.3", "1.25"]));
        }
        let starts = self.starts(kind, has_spin);
        let root = self.roots[parent];
        self.joints.push(Joint { kind, root, text, starts, taken: Vec::new(), following: Vec::new() });
    }

    /// The ends' axes and zero directions.
    fn frames(&mut self, kind: Kind) -> [String; 2] {
        let frame = self.frame();
        match kind.name {
            "rod" | "spherical" => [String::new(), String::new()],
            "point_on_line" => [frame, String::new()],
            // One frame for both is the rule.
            _ if self.dice.once_in(3) => [frame, self.frame()],
            _ => [frame.clone(), frame],
        }
    }

    fn frame(&mut self) -> String {
        loop {
            // Several frames with long numbers take the generator minutes: one in a model file is enough to be wrong.
            let is_rough = self.n_rough == 0 && self.dice.once_in(30);
            let direction = if is_rough { Dice::rough_direction } else { Dice::direction };
            let (axis, zero) = (direction(&mut self.dice), self.dice.direction());
            let [h, z] = [&axis, &zero].map(|v| [0, 1, 2].map(|k| value(&v[k])));
            let normal = cross(h, z);
            // Well away from parallel.
            if dot(normal, normal) > 0.04 * dot(h, h) * dot(z, z) {
                self.n_rough += usize::from(is_rough);
                let axis = if self.dice.once_in(8) { self.tunables(axis) } else { list(&axis) };
                return format!(", axis = {axis}, zero = {}", list(&zero));
            }
        }
    }

    fn starts(&mut self, kind: Kind, has_spin: bool) -> Vec<(&'static str, String)> {
        let mut starts = Vec::new();
        for &coordinate in kind.coordinates {
            if self.dice.once_in(3) {
                continue;
            }
            starts.push(match coordinate {
                "angle" if self.dice.once_in(3) => ("angle_deg", self.dice.degrees()),
                "first_angle" if self.dice.once_in(3) => ("first_angle_deg", self.dice.degrees()),
                "second_angle" if self.dice.once_in(3) => ("second_angle_deg", self.dice.degrees()),
                "angle" | "first_angle" | "second_angle" => {
                    let angle = self.dice.angle();
                    (coordinate, self.tunable(angle))
                }
                _ => {
                    let length = self.dice.signed();
                    (coordinate, self.tunable(length))
                }
            });
        }
        let n_rates = if kind.name == "spherical" { 3 } else { kind.coordinates.len() };
        if kind.name == "spherical" && self.dice.once_in(2) {
            starts.push(("orientation", self.orientation()));
        }
        if n_rates > 0 && !has_spin && !self.is_closed && self.dice.once_in(2) {
            let rates: Vec<_> = (0..n_rates).map(|_| self.dice.signed()).collect();
            starts.push(("rate", if n_rates == 1 { rates[0].clone() } else { list(&rates) }));
        }
        starts
    }

    pub fn positive(&mut self) -> String {
        let number = self.dice.number();
        self.tunable(number)
    }

    /// Euler parameters, of any length.
    fn orientation(&mut self) -> String {
        let p = self.dice.pick(&[
            ["1", "0", "0", "0"],
            ["1", "1", "0", "0"],
            ["0.7071067811865476", "0", "0.7071067811865475", "0"],
            ["3", "0", "-1", "0"],
            ["0.9239", "0", "0", "0.3827"],
            ["1", "2", "3", "4"],
        ]);
        list(&p.map(str::to_owned))
    }

    fn place(&mut self) -> String {
        let mut place = String::new();
        if self.dice.once_in(3) {
            let position = self.dice.point();
            place += &format!("position = {}\n", list(&position));
        }
        if self.dice.once_in(4) {
            place += &format!("orientation = {}\n", self.orientation());
        }
        place
    }

    fn spin(&mut self) -> String {
        let spin = [(); 3].map(|()| self.dice.signed());
        format!("angular_velocity = {}\n", list(&spin))
    }

    /// Mass and inertia, and point masses.
    pub fn solid(&mut self) -> String {
        let (mass, inertia) = self.mass_and_inertia();
        self.point_masses(&mass, &inertia).unwrap_or_else(|| format!("mass = {mass}\ninertia = {inertia}\n"))
    }

    /// Those of a box, as tables, people and programs give them.
    fn mass_and_inertia(&mut self) -> (String, String) {
        let mass = self.dice.number();
        let [x, y, z] = [(); 3].map(|()| self.dice.pick(&[0.1, 0.3, 1.0, 0.02, 0.5]));
        let square = value(&mass) / 12.0;
        let moments = [y * y + z * z, x * x + z * z, x * x + y * y].map(|sides| square * sides);
        let digits = self.dice.pick(&[3, 5, 17]);
        // A sixteenth more than a plate would have: rounding must not make a body impossible.
        let sum: f64 = moments.iter().sum();
        let write = |moment: f64| match digits {
            17 => format!("{:?}", moment + sum / 16.0),
            digits => format!("{:.*e}", digits - 1, moment + sum / 16.0),
        };
        let moments = moments.map(write);
        let inertia = match self.dice.below(5) {
            0 => self.tensor(&moments, sum),
            1 => {
                let moment = self.positive();
                format!("[{moment}, {moment}, {moment}]")
            }
            _ => self.tunables(moments),
        };
        (self.tunable(mass), inertia)
    }

    /// The same body with a part of its mass in two points, whose mass centre is its own.
    fn point_masses(&mut self, mass: &str, inertia: &str) -> Option<String> {
        let ways = self.ways.as_mut().filter(|_| inertia.starts_with('[') && !inertia.starts_with("[["))?;
        if !ways.once_in(4) {
            return None;
        }
        let moments: Vec<&str> = inertia.trim_matches(['[', ']']).split(", ").collect();
        let [x, y] = [ways.pick(&["0.1", "0.25", "1/30"]), ways.pick(&["0.2", "-0.05", "1/7"])];
        let less = |number: &str, what: &str| format!("\"({}) - {what}\"", number.trim_matches('"'));
        // Of 0.02 kg at (2x, 2y) and 0.04 kg at (-x, -y).
        let part = |square: &str| format!("0.12*({square})");
        let squares = [format!("({y})^2"), format!("({x})^2"), format!("({x})^2 + ({y})^2")];
        let rest: Vec<String> =
            moments.iter().zip(&squares).map(|(moment, square)| less(moment, &part(square))).collect();
        let xy = format!("\"0.12*({x})*({y})\"");
        Some(format!(
            "mass = {}\ninertia = {{ xx = {}, yy = {}, zz = {}, xy = {xy} }}\n\
             point_mass = [{{ mass = 0.02, at = [\"2*{x}\", \"2*({y})\", 0] }}, \
             {{ mass = \"1/25\", at = [\"-({x})\", \"-({y})\", 0] }}]\n",
            less(mass, "0.06"),
            rest[0],
            rest[1],
            rest[2]
        ))
    }

    /// With products of inertia, small beside the moments.
    fn tensor(&mut self, [xx, yy, zz]: &[String; 3], sum: f64) -> String {
        let product = |page: &mut Self| format!("{:.2e}", 0.01 * sum * page.dice.between(-1.0, 1.0));
        let [xy, xz, yz] = [product(self), product(self), product(self)];
        if self.dice.once_in(2) {
            return format!("{{ xx = {xx}, yy = {yy}, zz = {zz}, xy = {xy}, xz = {xz} }}");
        }
        format!("[[{xx}, {xy}, {xz}], [{xy}, {yy}, {yz}], [{xz}, {yz}, {zz}]]")
    }

    /// The motion of a driven body.
    fn prescribed(&mut self) -> String {
        let translation =
            [(); 3].map(|()| if self.dice.once_in(2) { "0".to_owned() } else { self.motion(1) });
        let rotations: Vec<_> = (0..self.dice.below(3))
            .map(|_| format!("{{ axis = {}, angle = {} }}", list(&self.dice.direction()), self.motion(1)))
            .collect();
        format!(
            "driven = {{ translation = {}, rotations = [{}] }}\n",
            list(&translation),
            rotations.join(", ")
        )
    }

    /// A motion, which may follow an input. Other dice than those of the rest decide on that.
    pub fn motion(&mut self, depth: usize) -> String {
        let own = self.own_motion(depth);
        if depth == 0 || !self.followers.once_in(6) {
            return own;
        }
        let (form, followed) =
            self.followers.pick(&[("sum", "\"followed\""), ("product", "{ sum = [1, \"-followed\"] }")]);
        format!("{{ {form} = [{own}, {followed}] }}")
    }

    /// A motion, with numbers and parameters.
    fn own_motion(&mut self, depth: usize) -> String {
        let number = |page: &mut Self| {
            let number = page.dice.signed();
            page.tunable(number)
        };
        match self.dice.below(if depth > 0 { 6 } else { 4 }) {
            0 => number(self),
            1 => format!("{{ polynomial = [{}, {}, {}] }}", number(self), number(self), number(self)),
            2 => {
                let frequency = match self.dice.once_in(2) {
                    true => format!("frequency_hz = {}", self.dice.number()),
                    false => format!("angular_frequency = {}", self.positive()),
                };
                let phase = match self.dice.below(3) {
                    0 => format!(", phase_deg = {}", self.dice.degrees()),
                    1 => format!(", phase = {}", self.dice.angle()),
                    _ => String::new(),
                };
                format!("{{ sinusoid = {{ amplitude = {}, {frequency}{phase} }} }}", number(self))
            }
            3 => "{ table = \"t.csv\" }".to_owned(),
            form => {
                let parts = [self.motion(depth - 1), self.motion(depth - 1)].join(", ");
                format!("{{ {} = [{parts}] }}", if form == 4 { "sum" } else { "product" })
            }
        }
    }
}
