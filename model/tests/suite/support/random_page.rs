//! Model files with elements of every kind that refer to each other at random. Tame model files are good as far as that
//! can be arranged, wild ones seldom; neither may make the reader panic.

use std::fmt::Write as _;

use proptest::prelude::*;

/// Kinds of joint with the names of their coordinates.
const KINDS: [(&str, &[&str]); 10] = [
    ("revolute", &["angle"]),
    ("spherical", &[]),
    ("fixed", &[]),
    ("universal", &["first_angle", "second_angle"]),
    ("cylindrical", &["angle", "displacement"]),
    ("prismatic", &["displacement"]),
    ("planar", &["x", "y", "angle"]),
    ("screw", &["angle"]),
    ("point_on_line", &["displacement"]),
    ("rod", &[]),
];
const ROWS: [&str; 10] = ["0,0", "1,0.5", "1,0.5", "2,1", "2.5,-1", "3,NaN", "x", "", "1e99,1e99", "4,1"];

/// A whole model file.
pub(crate) fn page() -> impl Strategy<Value = String> {
    let wildness = prop_oneof![Just(0), Just(0), Just(8), Just(40)];
    let rolls = prop::collection::vec(any::<u8>(), 40..400);
    (rolls, wildness).prop_map(|(rolls, wildness)| write(Dice { rolls, next: 0, wildness }))
}

/// A CSV file, seldom a good one.
pub(crate) fn table() -> impl Strategy<Value = String> {
    let rows = prop::collection::vec(prop::sample::select(ROWS.to_vec()), 0..6);
    prop_oneof![
        Just("t,x\n0,0\n1,0.5\n2,1\n".to_owned()),
        Just("t,x\n-1,0.5\n0.5,0.25\n".to_owned()),
        Just("x,t\n-1,0.5\n0.5,0.25\n3,0".to_owned()),
        rows.prop_map(|rows| format!("t,x\n{}", rows.join("\n"))),
        "[-a-z0-9,.\n\" ]{0,40}",
    ]
}

/// Decisions, one byte each; zeros when they are used up.
struct Dice {
    rolls: Vec<u8>,
    next: usize,
    /// Of 256 decisions, how many go wrong.
    wildness: u8,
}

impl Dice {
    fn roll(&mut self) -> usize {
        self.next += 1;
        self.rolls.get(self.next - 1).copied().map_or(0, usize::from)
    }

    fn below(&mut self, n: usize) -> usize {
        self.roll() % n.max(1)
    }

    fn pick<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[self.below(choices.len())]
    }

    fn is_wild(&mut self) -> bool {
        self.wildness > 0 && self.roll() < usize::from(self.wildness)
    }

    /// A number for any place but one that must not be zero or negative.
    fn number(&mut self) -> &'static str {
        if self.is_wild() {
            return self.pick(&["nan", "\"inp\"", "1e100", "-1e-100", "\"3 mm\"", "\"nobody\"", "[1]", "0"]);
        }
        self.pick(&["0.5", "0", "1", "-1", "0.25", "-2.5e-3", "\"par\"", "\"-par\""])
    }

    fn positive(&mut self) -> &'static str {
        if self.is_wild() { self.number() } else { self.pick(&["1", "0.3", "2.5", "\"par\""]) }
    }

    /// A name of one of `n` things.
    fn name(&mut self, letter: char, n: usize) -> String {
        let index = if self.is_wild() { n } else { self.below(n) };
        format!("\"{letter}{index}\"")
    }

    /// A name of one of `n` bodies but the root.
    fn moving(&mut self, n: usize) -> String {
        if self.is_wild() { self.name('b', n) } else { format!("\"b{}\"", 1 + self.below(n - 1)) }
    }

    fn motion(&mut self, depth: usize) -> String {
        let forms = if depth > 0 { 6 } else { 4 };
        match self.below(forms) {
            0 => self.number().to_owned(),
            1 => format!("{{ polynomial = [{}, {}] }}", self.number(), self.number()),
            2 => {
                let (amplitude, phase) = (self.number(), self.number());
                format!("{{ sinusoid = {{ amplitude = {amplitude}, frequency_hz = 0.5, phase = {phase} }} }}")
            }
            3 => "{ table = \"t.csv\" }".to_owned(),
            form => {
                let parts = [self.motion(depth - 1), self.motion(depth - 1)].join(", ");
                format!("{{ {} = [{parts}] }}", if form == 4 { "sum" } else { "product" })
            }
        }
    }
}

/// A model file in the making: the joints' coordinates, as far as it has come.
struct Page {
    text: String,
    n_bodies: usize,
    joints: Vec<&'static [&'static str]>,
    n_drivers: usize,
}

fn write(mut dice: Dice) -> String {
    let text = "format = 1\nname = \"random\"\n[parameters]\npar = 0.75\n[inputs]\ninp = 0.5\n".to_owned();
    let n_bodies = 2 + dice.below(4);
    let mut page = Page { text, n_bodies, joints: Vec::new(), n_drivers: 0 };
    for body in 0..n_bodies {
        page.body(&mut dice, body);
    }
    for child in 1..n_bodies {
        let parent = dice.below(child);
        page.joint(&mut dice, [parent, child]);
    }
    for _ in 0..dice.below(3) {
        let first = dice.below(n_bodies);
        let second = (first + 1 + dice.below(n_bodies - 1)) % n_bodies;
        page.joint(&mut dice, [first, second]);
    }
    for _ in 0..dice.below(2) {
        page.coupler(&mut dice);
    }
    for _ in 0..dice.below(2) {
        page.driver(&mut dice);
    }
    for force in 0..dice.below(4) {
        page.force(&mut dice, force);
    }
    for output in 0..dice.below(4) {
        page.output(&mut dice, output);
    }
    page.text
}

impl Page {
    fn body(&mut self, dice: &mut Dice, index: usize) {
        let solid = "mass = 2\ninertia = [1, 1, 1]\n";
        let root = match dice.below(5) {
            0 => format!("{solid}fixed = \"constrained\"\n"),
            1 => format!("{solid}free = true\nvelocity = [1, 0, 0]\n"),
            2 => {
                let (x, angle) = (dice.motion(2), dice.motion(2));
                format!(
                    "driven = {{ translation = [{x}, 0, 0], rotations = [{{ axis = [1, 2, 0], angle = {angle} }}] }}\n"
                )
            }
            _ => "fixed = true\n".to_owned(),
        };
        let own = if index == 0 || dice.is_wild() { root } else { solid.to_owned() };
        let _ = write!(self.text, "[[body]]\nname = \"b{index}\"\n{own}");
        if index > 0 && dice.is_wild() {
            let _ = writeln!(self.text, "position = [{}, 0, 1]", dice.number());
        }
        if index > 0 && dice.below(4) == 0 {
            let _ = writeln!(self.text, "assembly_weight = 2");
        }
    }

    fn joint(&mut self, dice: &mut Dice, [first, second]: [usize; 2]) {
        let (kind, coordinates) = dice.pick(&KINDS);
        let _ = writeln!(self.text, "[[joint]]\nname = \"j{}\"\nkind = \"{kind}\"", self.joints.len());
        let frame = |dice: &mut Dice| {
            let axis = dice.pick(&["[0, 0, 1]", "[1, 2, 2]", "[0, 1, \"par\"]"]);
            format!(", axis = {axis}, zero = [1, 0, 0]")
        };
        let own = match kind {
            "rod" => format!("length = {}\n", dice.positive()),
            "screw" => format!("lead = {}\n", dice.positive()),
            _ => String::new(),
        };
        let frames = match kind {
            "rod" | "spherical" => [String::new(), String::new()],
            "point_on_line" => [frame(dice), String::new()],
            _ => [frame(dice), frame(dice)],
        };
        self.text += &own;
        for (key, body, frame) in [("first", first, &frames[0]), ("second", second, &frames[1])] {
            let (x, y) = (dice.number(), dice.number());
            let _ = writeln!(self.text, "{key} = {{ body = \"b{body}\", point = [{x}, {y}, 0]{frame} }}");
        }
        if let (Some(coordinate), true) = (coordinates.first(), dice.below(3) == 0) {
            let _ = writeln!(self.text, "{coordinate} = {}\nrough = true", dice.number());
        }
        if coordinates.len() == 1 && dice.below(3) == 0 {
            let _ = writeln!(self.text, "damping = {}", dice.positive());
        }
        self.joints.push(coordinates);
    }

    /// The keys of a joint coordinate, separated as in an inline table or by lines.
    fn coordinate(&mut self, dice: &mut Dice, separator: &str) -> String {
        let with: Vec<usize> = (0..self.joints.len()).filter(|&j| !self.joints[j].is_empty()).collect();
        if with.is_empty() || dice.is_wild() {
            return format!("joint = {}{separator}coordinate = \"angle\"", dice.name('j', self.joints.len()));
        }
        let joint = dice.pick(&with);
        let coordinate = dice.pick(self.joints[joint]);
        format!("joint = \"j{joint}\"{separator}coordinate = \"{coordinate}\"")
    }

    fn coupler(&mut self, dice: &mut Dice) {
        let ends = [self.coordinate(dice, ", "), self.coordinate(dice, ", ")];
        let [first, second] = ends;
        let ratio = dice.positive();
        let _ = writeln!(
            self.text,
            "[[coupler]]\nname = \"gear\"\nfirst = {{ {first} }}\nsecond = {{ {second} }}\nratio = {ratio}"
        );
    }

    fn driver(&mut self, dice: &mut Dice) {
        let (on, motion) = (self.coordinate(dice, "\n"), dice.motion(2));
        let _ = writeln!(self.text, "[[driver]]\nname = \"d{}\"\n{on}\nmotion = {motion}", self.n_drivers);
        self.n_drivers += 1;
    }

    fn force(&mut self, dice: &mut Dice, index: usize) {
        let kind = dice.pick(&["spring", "damper", "coulomb", "stop", "motor", "link", "load", "spring"]);
        let (on, x, y) = (self.coordinate(dice, "\n"), dice.positive(), dice.positive());
        let keys = match kind {
            "spring" => format!("{on}\nstiffness = {x}\nfree = {y}"),
            "damper" => format!("{on}\ndamping = {x}"),
            "coulomb" => format!("{on}\nlevel = \"inp\"\nrate = {y}"),
            "stop" => format!("{on}\nlimit = {x}\nside = \"lower\"\nstiffness = {y}\nsoftness = {y}"),
            "link" => {
                let second = dice.moving(self.n_bodies);
                format!("first = {{ body = \"b0\" }}\nsecond = {{ body = {second} }}\ndamping = {y}")
            }
            "load" => {
                let body = dice.moving(self.n_bodies);
                format!("body = {body}\nforce = [{x}, \"-inp\", 0]\nframe = \"body\"")
            }
            _ => format!("{on}\nvalue = {x}"),
        };
        let _ = writeln!(self.text, "[[force]]\nname = \"f{index}\"\nkind = \"{kind}\"\n{keys}");
    }

    fn output(&mut self, dice: &mut Dice, index: usize) {
        let kinds = ["pose", "velocity", "acceleration", "inertial", "reaction", "driver", "energy", "power"];
        let kind = dice.pick(&kinds);
        let kind = if kind == "driver" && self.n_drivers == 0 && !dice.is_wild() { "energy" } else { kind };
        let keys = match kind {
            "reaction" => format!("joint = {}", dice.name('j', self.joints.len())),
            "driver" => format!("driver = {}", dice.name('d', self.n_drivers)),
            "energy" | "power" => String::new(),
            _ => format!("body = {}", dice.moving(self.n_bodies)),
        };
        let _ = writeln!(self.text, "[[output]]\nname = \"o{index}\"\nkind = \"{kind}\"\n{keys}");
    }
}
