//! A model file in the making.

use crate::dice::{Dice, value};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// A kind of joint: name, coordinates, how many rates are free.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kind {
    pub name: &'static str,
    pub coordinates: &'static [&'static str],
    pub freedoms: usize,
}

const fn kind(name: &'static str, coordinates: &'static [&'static str], freedoms: usize) -> Kind {
    Kind { name, coordinates, freedoms }
}

pub const KINDS: [Kind; 10] = [
    kind("revolute", &["angle"], 1),
    kind("spherical", &[], 3),
    kind("fixed", &[], 0),
    kind("universal", &["first_angle", "second_angle"], 2),
    kind("cylindrical", &["angle", "displacement"], 2),
    kind("prismatic", &["displacement"], 1),
    kind("planar", &["x", "y", "angle"], 3),
    kind("screw", &["angle"], 1),
    kind("point_on_line", &["displacement"], 4),
    kind("rod", &[], 5),
];

/// What holds a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Hold {
    Fixed,
    Constrained,
    Driven,
    Free,
    Joint,
}

impl Hold {
    /// Whether the body has coordinates and a mass.
    pub fn moves(self) -> bool {
        matches!(self, Self::Constrained | Self::Free | Self::Joint)
    }
}

#[derive(Clone, Debug)]
pub struct Joint {
    pub kind: Kind,
    /// The tree that it belongs to.
    pub root: usize,
    pub text: String,
    /// Keys that the start is given by; dropped where a coordinate is prescribed or coupled.
    pub starts: Vec<(&'static str, String)>,
    /// Coordinates that a driver or a coupler has taken.
    pub taken: Vec<&'static str>,
    /// Those of them whose start follows from it.
    pub following: Vec<&'static str>,
}

#[derive(Clone, Debug)]
pub struct Page {
    pub dice: Dice,
    /// How numbers are written, apart from what they are; plainly if there is none.
    pub ways: Option<Dice>,
    /// Decides on armatures.
    pub rotors: Dice,
    /// Decides on motions that follow an input.
    pub followers: Dice,
    pub name: String,
    pub parameters: Vec<(String, String)>,
    /// Those that are computed from others.
    pub derived: Vec<(String, String)>,
    pub inputs: Vec<(String, String)>,
    pub gravity: String,
    pub bodies: Vec<(Hold, String)>,
    /// The tree that each body belongs to: a free body's own, or zero.
    pub roots: Vec<usize>,
    /// The last body before it that hangs on a rod, or zero: its place is a guess as long as nothing but rods holds its
    /// tree.
    pub held: Vec<usize>,
    pub joints: Vec<Joint>,
    /// All the rest.
    pub elements: String,
    /// How many ways the joints of each tree leave its bodies to move against one another and its root; those of a free
    /// root are none of them, as nothing can tie it.
    pub freedoms: BTreeMap<usize, usize>,
    /// Whether something will close loops or couple coordinates: then starts are guesses.
    pub is_closed: bool,
    pub n_drivers: usize,
    /// Springs and links: names and kinds.
    pub elastic: Vec<(String, &'static str)>,
    pub n_couplers: usize,
    /// Numbers of outputs that formulas may name.
    pub early: Vec<String>,
    /// Frames with long numbers.
    pub n_rough: usize,
}

impl Page {
    pub fn new(seed: u64) -> Self {
        let mut dice = Dice::new(seed);
        let is_closed = dice.once_in(3);
        let gravity = if dice.once_in(4) { ["0", "0", "0"] } else { dice.pick(&GRAVITIES) };
        let gravity = list(&gravity.map(str::to_owned));
        let mut page = Self {
            dice,
            ways: None,
            rotors: Dice::new(!seed),
            followers: Dice::new(seed.rotate_left(43)),
            name: format!("page_{seed}"),
            parameters: Vec::new(),
            derived: Vec::new(),
            inputs: Vec::new(),
            gravity,
            bodies: Vec::new(),
            roots: Vec::new(),
            held: Vec::new(),
            joints: Vec::new(),
            elements: String::new(),
            freedoms: BTreeMap::new(),
            is_closed,
            n_drivers: 0,
            elastic: Vec::new(),
            n_couplers: 0,
            early: Vec::new(),
            n_rough: 0,
        };
        page.attract(&mut Dice::new(seed.rotate_left(11)));
        page
    }

    /// Puts a central body in the place of a uniform gravity, where no body is by chance.
    fn attract(&mut self, dice: &mut Dice) {
        if !dice.once_in(8) {
            return;
        }
        let (mu, centre) = (dice.pick(&["9.81", "25", "88.29"]), dice.pick(&CENTRES));
        let mu = if dice.once_in(3) {
            self.parameters.push(("mu".to_owned(), mu.to_owned()));
            "\"mu\""
        } else {
            mu
        };
        self.gravity = format!("{{ mu = {mu}, centre = {centre} }}");
    }

    /// The number itself or, seldom, a parameter that has it as its default.
    pub fn tunable(&mut self, number: String) -> String {
        if !self.dice.once_in(8) || value(&number) == 0.0 {
            return self.written(number);
        }
        let (sign, size) = match number.strip_prefix('-') {
            Some(size) => ("-", size.to_owned()),
            None => ("", number),
        };
        let name = format!("p{}", self.parameters.len());
        self.parameters.push((name.clone(), size));
        self.computed(sign, &name)
    }

    /// A number as it is, or as the result of arithmetic.
    fn written(&mut self, number: String) -> String {
        let Some(ways) = self.ways.as_mut().filter(|_| value(&number) != 0.0) else { return number };
        match ways.below(25) {
            0 => format!("\"{number} * 3 / 3\""),
            1 => format!("\"-(-{number})\""),
            2 => format!("\"2^-1 * ({number} + {number})\""),
            3 => format!("\"({number} + 1/3) - sqrt(1/9)\""),
            4 => format!("\"1/(1/{number})\""),
            _ => number,
        }
    }

    /// A parameter as it is, or as the result of arithmetic with it.
    fn computed(&mut self, sign: &str, name: &str) -> String {
        let Some(ways) = &mut self.ways else { return format!("\"{sign}{name}\"") };
        match ways.below(8) {
            0 => format!("\"{sign}2*{name} / 2\""),
            1 => format!("\"{sign}{name}^3 / ({name} * {name})\""),
            2 => format!("\"{sign}(3*{name} - 2*{name})\""),
            3 | 4 => {
                let derived = format!("d{}", self.derived.len());
                let text = ways.pick(&["\"NAME / 3\"", "\"1/3 * NAME\"", "\"NAME^2 / (3*NAME)\""]);
                self.derived.push((derived.clone(), text.replace("NAME", name)));
                format!("\"{sign}{derived} * 3\"")
            }
            _ => format!("\"{sign}{name}\""),
        }
    }

    /// A strength: a number, a parameter or an input.
    pub fn strength(&mut self, number: String) -> String {
        if !self.dice.once_in(3) {
            return self.tunable(number);
        }
        // One input may serve several forces; only those that are not negative serve where nothing negative may stand.
        let is_negative = |number: &String| number.starts_with('-');
        let fitting = |(_, known): &&(String, String)| is_negative(&number) || !is_negative(known);
        let known: Vec<_> = self.inputs.iter().filter(fitting).map(|(name, _)| name.clone()).collect();
        let name = if known.is_empty() || self.dice.once_in(3) {
            let name = format!("in{}", self.inputs.len());
            self.inputs.push((name.clone(), number));
            name
        } else {
            known[self.dice.below(known.len())].clone()
        };
        format!("\"{name}\"")
    }

    pub fn tunables(&mut self, numbers: [String; 3]) -> String {
        list(&numbers.map(|number| self.tunable(number)))
    }

    /// The model file's text.
    pub fn text(&self) -> String {
        let mut text = format!("format = 1\nname = {:?}\ngravity = {}\n", self.name, self.gravity);
        // What is computed may stand before what it is computed from.
        let parameters: Vec<_> = self.derived.iter().chain(&self.parameters).cloned().collect();
        let mut inputs = self.inputs.clone();
        let follows = |text: &String| text.contains("followed\"");
        if follows(&self.elements) || self.bodies.iter().any(|(_, body)| follows(body)) {
            inputs.push(("followed".to_owned(), "0".to_owned()));
        }
        for (table, entries) in [("parameters", &parameters), ("inputs", &inputs)] {
            if !entries.is_empty() {
                let _ = writeln!(text, "\n[{table}]");
                entries.iter().for_each(|(name, value)| text += &format!("{name} = {value}\n"));
            }
        }
        for (index, (_, body)) in self.bodies.iter().enumerate() {
            let _ = write!(text, "\n[[body]]\nname = \"b{index}\"\n{body}");
        }
        for (index, joint) in self.joints.iter().enumerate() {
            let _ = write!(text, "\n[[joint]]\nname = \"j{index}\"\n{}", joint.text);
            let starts: Vec<_> = joint.starts.iter().filter(|(key, _)| !joint.follows(key)).collect();
            starts.iter().for_each(|(key, start)| text += &format!("{key} = {start}\n"));
            if self.is_closed && !starts.is_empty() {
                text += "rough = true\n";
            }
        }
        text + &self.elements
    }
}

impl Joint {
    fn follows(&self, key: &str) -> bool {
        key == "rate" && !self.following.is_empty() || self.following.contains(&key.trim_end_matches("_deg"))
    }
}

const GRAVITIES: [[&str; 3]; 5] = [
    ["0", "0", "-9.81"],
    ["0", "-9.81", "0"],
    ["0", "0", "-9.80665"],
    ["9.81", "0", "0"],
    ["0.5", "-9", "1.25"],
];

const CENTRES: [&str; 4] = ["[0.02, 0, -0.03]", "[0.37, -2.9, 1.13]", "[0, 0, -3.07]", "[-1.21, 0.43, 0.17]"];

pub fn list(numbers: &[String]) -> String {
    format!("[{}]", numbers.join(", "))
}

/// The digits that read back as this number.
pub fn printed(numbers: [f64; 3]) -> [String; 3] {
    numbers.map(|number| format!("{number:?}"))
}
