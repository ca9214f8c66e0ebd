//! Laws that are formulas: strengths, potentials, dissipations, outputs. Other dice than those of the rest decide on
//! them, so that what was drawn before stays as it was.

use crate::dice::Dice;
use crate::page::Page;

/// What a formula may name, and the dice that decide on it.
pub struct Words<'d> {
    pub dice: &'d mut Dice,
    pub names: Vec<String>,
}

/// Functions and operators with one operand, whatever that is.
const OF_ONE: [&str; 22] = [
    "sin(X)",
    "cos(X)",
    "tanh(X)",
    "exp(-(X)^2)",
    "ln(2 + (X)^2)",
    "log10(1.5 + cos(X))",
    "sqrt(1 + (X)^2)",
    "abs(X)",
    "sign(X)",
    "floor(X)",
    "atan(X)",
    "asin(0.9*tanh(X))",
    "acos(0.5*sin(X))",
    "tan(0.7*tanh(X))",
    "sinh(tanh(X))",
    "cosh(sin(X))",
    "(X)^2",
    "(X)^3/4",
    "(1 + (X)^2)^1.5",
    "(1 + (X)^2)^-0.3",
    "step(X, -0.5, 0, 0.8, 1)",
    "-(X) deg",
];

/// The same with two.
const OF_TWO: [&str; 14] = [
    "X + Y",
    "X - Y",
    "(X)*(Y)",
    "(X)/(2 + cos(Y))",
    "min(X, Y)",
    "max(X, Y)",
    "hypot(X, Y)",
    "mod(X, 1.5 + sin(Y))",
    "atan2(X, 2 + (Y)^2)",
    "ramp(X, 0.1 + (Y)^2)",
    "if(X > Y, X, 0.5)",
    "if(not(X >= Y), sqrt(Y - (X) + 1e-9), 0)",
    "if(X < 0.2 and Y > -0.3, Y, X)",
    "if(X <= 0.1 or Y >= 0.4, 2*X, -Y)",
];

impl Words<'_> {
    pub fn formula(&mut self, depth: usize) -> String {
        if depth == 0 {
            return match self.dice.below(5) {
                0 => self.dice.pick(&["0.3", "2", "1/3", "30 deg", "pi", "1e-3"]).to_owned(),
                _ => self.name(),
            };
        }
        let x = self.formula(depth - 1);
        if self.dice.once_in(2) {
            let y = self.formula(depth - 1);
            self.dice.pick(&OF_TWO).replace('X', &x).replace('Y', &y)
        } else {
            self.dice.pick(&OF_ONE).replace('X', &x)
        }
    }

    /// One in which no function has numbers alone for operands.
    pub fn of_names(&mut self) -> String {
        let [x, y] = [(); 2].map(|()| self.name());
        let of_two = self.dice.pick(&OF_TWO).replace('X', &x).replace('Y', &y);
        if self.dice.once_in(2) { self.dice.pick(&OF_ONE).replace('X', &of_two) } else { of_two }
    }

    fn name(&mut self) -> String {
        self.names[self.dice.below(self.names.len())].clone()
    }
}

impl Page {
    /// Some laws, in half of the model files.
    pub fn laws(&mut self, seed: u64) {
        let mut dice = Dice::new(seed.rotate_left(17));
        let coordinates = self.coordinates();
        if coordinates.is_empty() || dice.once_in(2) {
            return;
        }
        let name = |(joint, coordinate): &(usize, &str)| match self.joints[*joint].kind.coordinates.len() {
            1 => format!("j{joint}"),
            _ => format!("j{joint}.{coordinate}"),
        };
        let places: Vec<String> = coordinates.iter().map(name).collect();
        let rates: Vec<String> = places.iter().map(|name| format!("{name} rate")).collect();
        let mut names: Vec<String> = places.iter().chain(&rates).cloned().collect();
        names.push("t".to_owned());
        names.extend(self.parameters.iter().chain(&self.inputs).map(|(name, _)| name.clone()));
        names.extend(self.early.iter().cloned());
        self.elements += &format!(
            "\n[[formula]]\nname = \"shared\"\nof = {:?}\n",
            Words { dice: &mut dice, names: names.clone() }.formula(2)
        );
        names.push("shared".to_owned());
        for index in 0..1 + dice.below(3) {
            let depth = 1 + dice.below(2);
            let on = coordinates[dice.below(coordinates.len())];
            let (kind, keys) = match dice.below(5) {
                0 => ("motor", self.motor(&mut dice, on, &names, depth)),
                1 => {
                    let formula = Words { dice: &mut dice, names: names.clone() }.formula(depth);
                    let keys = self.on(on.0, on.1);
                    ("damper", format!("{keys}damping = {:?}\n", format!("0.1 + ({formula})^2")))
                }
                2 => {
                    let mut names = places.clone();
                    names.extend(self.parameters.iter().map(|(name, _)| name.clone()));
                    let x = places[dice.below(places.len())].clone();
                    let formula = Words { dice: &mut dice, names }.formula(depth);
                    ("potential", format!("energy = {:?}\n", format!("0.3*({x})^2 + {formula}")))
                }
                3 => {
                    let x = rates[dice.below(rates.len())].clone();
                    let formula =
                        Words { dice: &mut dice, names: names_of_power(&places, &rates) }.formula(depth);
                    ("dissipation", format!("power = {:?}\n", format!("0.2*({x})^2 + 0.1*({formula})^2")))
                }
                _ => {
                    let Some(body) = self.moving() else { continue };
                    let mut one =
                        || format!("{:?}", Words { dice: &mut dice, names: names.clone() }.formula(1));
                    ("load", format!("body = \"b{body}\"\ntorque = [{}, 0, {}]\n", one(), one()))
                }
            };
            self.elements += &format!("\n[[force]]\nname = \"law{index}\"\nkind = \"{kind}\"\n{keys}");
        }
        let formula = Words { dice: &mut dice, names: names.clone() }.formula(2);
        self.elements += &format!("\n[[output]]\nname = \"told\"\nkind = \"formula\"\nof = {formula:?}\n");
        self.vary_free_length(seed, &names);
        self.states(seed, coordinates[0], names);
    }

    /// Makes the free length of the first link that has one a formula, in half of the model files with laws.
    fn vary_free_length(&mut self, seed: u64, names: &[String]) {
        const KEY: &str = "free_length = ";
        let mut dice = Dice::new(seed.rotate_left(37));
        let Some(start) = self.elements.find(KEY).filter(|_| dice.once_in(2)) else { return };
        let rest = &self.elements[start + KEY.len()..];
        let line = rest.split('\n').next().unwrap_or_default();
        let formula = Words { dice: &mut dice, names: names.to_vec() }.formula(1);
        let varying = format!("{KEY}\"{} + 0.1*sin({formula})\"", line.trim_matches('"'));
        self.elements = self.elements.replacen(&format!("{KEY}{line}"), &varying, 1);
    }

    /// States that forces depend on, in half of the model files with laws.
    fn states(&mut self, seed: u64, on: (usize, &'static str), mut names: Vec<String>) {
        let mut dice = Dice::new(seed.rotate_left(31));
        if dice.once_in(2) {
            return;
        }
        let n_states = 1 + dice.below(2);
        let before = names.clone();
        names.extend((0..n_states).map(|state| format!("s{state}")));
        for state in 0..n_states {
            // What a state starts at rest from must have one place of rest.
            let (names, start) = match dice.below(3) {
                0 => (&before, "\"rest\"".to_owned()),
                1 => (&names, String::new()),
                _ => (&names, dice.pick(&["0.7", "\"-1/3\"", "2e-2"]).to_owned()),
            };
            let formula = Words { dice: &mut dice, names: names.clone() }.formula(2);
            let start = if start.is_empty() { start } else { format!("start = {start}\n") };
            let rate = format!("tanh({formula}) - 1.5*s{state}");
            self.elements += &format!("\n[[state]]\nname = \"s{state}\"\n{start}rate = {rate:?}\n");
        }
        let motor = self.motor(&mut dice, on, &names, 1);
        let value = motor.replace("value = \"", "value = \"0.4*s0 + ");
        self.elements += &format!("\n[[force]]\nname = \"of_states\"\nkind = \"motor\"\n{value}");
    }

    /// Curves, and laws that call them, in a third of the model files, by dice of their own.
    pub fn curves(&mut self, seed: u64) {
        let mut dice = Dice::new(seed.rotate_left(29));
        let coordinates = self.coordinates();
        if coordinates.is_empty() || !dice.once_in(3) {
            return;
        }
        let name = |(joint, coordinate): &(usize, &str)| match self.joints[*joint].kind.coordinates.len() {
            1 => format!("j{joint}"),
            _ => format!("j{joint}.{coordinate}"),
        };
        let places: Vec<String> = coordinates.iter().map(name).collect();
        let rates: Vec<String> = places.iter().map(|name| format!("{name} rate")).collect();
        let n_curves = 1 + dice.below(3);
        for index in 0..n_curves {
            let mut x = dice.between(-2.0, 0.0);
            let mut point = |dice: &mut Dice| {
                x += dice.between(0.2, 0.9);
                format!("[{x:.3}, {:.3}]", dice.between(-1.0, 1.0))
            };
            let points: Vec<String> = (0..2 + dice.below(5)).map(|_| point(&mut dice)).collect();
            let between = dice.pick(&["smooth", "smooth", "monotone", "linear", "steps"]);
            let beyond = dice.pick(&["line", "hold"]);
            self.elements += &format!(
                "\n[[curve]]\nname = \"curve{index}\"\npoints = [{}]\nbetween = \"{between}\"\nbeyond = \"{beyond}\"\n",
                points.join(", ")
            );
        }
        let mut names: Vec<String> = places.iter().chain(&rates).cloned().collect();
        names.push("t".to_owned());
        let mut called = |names: &[String]| {
            let of = Words { dice: &mut dice, names: names.to_vec() }.formula(1);
            format!("curve{}({of})", dice.below(n_curves))
        };
        let (motor, told) = (called(&names), format!("{} + {}", called(&names), called(&names)));
        let (energy, power) = (called(&places), called(&rates));
        let on = coordinates[dice.below(coordinates.len())];
        let keys = self.on(on.0, on.1);
        self.elements += &match dice.below(3) {
            0 => format!("\n[[force]]\nname = \"curved\"\nkind = \"motor\"\n{keys}value = \"-{motor}\"\n"),
            1 => format!(
                "\n[[force]]\nname = \"curved\"\nkind = \"potential\"\nenergy = \"0.3*({})^2 + {energy}\"\n",
                places[0]
            ),
            _ => format!(
                "\n[[force]]\nname = \"curved\"\nkind = \"dissipation\"\npower = \"0.2*({})^2*({power})^2\"\n",
                rates[0]
            ),
        };
        self.elements += &format!("\n[[output]]\nname = \"curve\"\nkind = \"formula\"\nof = \"{told}\"\n");
    }

    fn motor(
        &mut self,
        dice: &mut Dice,
        on: (usize, &'static str),
        names: &[String],
        depth: usize,
    ) -> String {
        let formula = Words { dice, names: names.to_vec() }.formula(depth);
        format!("{}value = {formula:?}\n", self.on(on.0, on.1))
    }
}

fn names_of_power(places: &[String], rates: &[String]) -> Vec<String> {
    places.iter().chain(rates).chain([&"t".to_owned()]).cloned().collect()
}
