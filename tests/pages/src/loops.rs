//! What ties the tree's coordinates: drivers, couplers, and joints that close loops. Loops are closed where the tree
//! already is, so that a consistent start exists.

use crate::closing::Closing;
use crate::dice::{Dice, value};
use crate::page::{KINDS, Page};
use crate::vector::Place;
use gyro_model::{Kinematics, Model, Number, Support, to_f64};

/// How often a place for a loop's joint is looked for.
const TRIES: usize = 20;

impl Page {
    /// Drivers of joint coordinates, seldom more than one.
    pub fn drivers(&mut self) {
        for _ in 0..self.dice.pick(&[0, 0, 0, 1, 1, 2]) {
            let Some((joint, coordinate)) = self.free_coordinate() else { return };
            self.take(joint, coordinate);
            let (on, motion) = (self.on(joint, coordinate), self.motion(2));
            let name = self.n_drivers;
            self.n_drivers += 1;
            self.elements += &format!("\n[[driver]]\nname = \"d{name}\"\n{on}motion = {motion}\n");
        }
    }

    /// A gear, a belt, a rack and pinion, one after the other: `own` is free, `other` may follow a driver or another
    /// coupler.
    pub fn coupler(&mut self) {
        let Some(own) = self.free_coordinate() else { return };
        let coordinates = self.coordinates();
        let pick = |page: &mut Self| coordinates[page.dice.below(coordinates.len())];
        let is_other = |other: &(usize, &str)| *other != own;
        let Some(other) = (0..TRIES).find_map(|_| Some(pick(self)).filter(is_other)) else { return };
        let ratio = self.dice.pick(&["-1.7", "2", "-0.3333333333333333", "0.5", "-3"]).to_owned();
        let [first, second] = if self.dice.once_in(3) { [own, other] } else { [other, own] };
        // What the coordinates are at the start; somebody may have shortened it.
        let start = self.read().assemble().unwrap_or_else(|error| panic!("{}: {error}", self.name));
        let at = |(joint, coordinate): (usize, &str)| {
            let names = self.joints[joint].kind.coordinates;
            let place = names.iter().position(|&name| name == coordinate).expect("one of its coordinates");
            start.joints[joint].position[place]
        };
        let offset = at(second) - value(&ratio) * at(first);
        let offset = if self.dice.once_in(2) { format!("{offset:.3}") } else { format!("{offset:?}") };
        self.take(own.0, own.1);
        self.joints[other.0].taken.push(other.1);
        let ratio = self.tunable(ratio);
        let [first, second] = [first, second]
            .map(|(joint, coordinate)| format!("{{ joint = \"j{joint}\", coordinate = {coordinate:?} }}"));
        let name = self.n_couplers;
        self.n_couplers += 1;
        self.elements += &format!(
            "\n[[coupler]]\nname = \"c{name}\"\nfirst = {first}\nsecond = {second}\nratio = {ratio}\noffset = {offset}\n"
        );
    }

    /// Rows of velocities: a rate that nothing else prescribes follows others.
    pub fn rollings(&mut self, seed: u64) {
        let mut dice = Dice::new(seed.rotate_left(29));
        for name in 0..dice.pick(&[0, 0, 0, 1, 1, 2]) {
            let Some(own) = self.free_coordinate() else { return };
            let root = self.joints[own.0].root;
            if self.freedoms[&root] < 2 {
                return;
            }
            let without = self.clone();
            *self.freedoms_of(root) -= 1;
            self.joints[own.0].taken.push(own.1);
            self.joints[own.0].starts.retain(|(key, _)| !["rate", "rates"].contains(key));
            let coordinates = self.coordinates();
            let mut text = format!("{} rate", self.shown(own));
            for _ in 0..1 + dice.below(5) {
                let [with, by] = [(); 2].map(|()| coordinates[dice.below(coordinates.len())]);
                if with == own {
                    continue;
                }
                let [with, by, factor] = [self.shown(with), self.shown(by), dice.number()];
                text += &match dice.below(4) {
                    0 => format!(" - {factor}*({with} rate)"),
                    1 => format!(" + sin({by})*({with} rate)/2"),
                    2 => format!(" - 0.3*cos({by})*({with} rate)"),
                    _ => format!(" + ({with} rate)*0.2/(2 + {by}^2)"),
                };
            }
            self.elements += &format!("\n[[constraint]]\nname = \"v{name}\"\nrate = \"{text}\"\n");
            if dice.once_in(2) {
                self.elements += &format!(
                    "\n[[output]]\nname = \"of_v{name}\"\nkind = \"constraint\"\nconstraint = \"v{name}\"\n"
                );
            }
            // A loop may move in fewer ways than its tree does.
            if gyro_model::read_with("page.toml", &self.text(), &mut crate::load).is_err() {
                *self = without;
            }
        }
    }

    /// A coordinate as formulas name it.
    pub fn shown(&self, (joint, coordinate): (usize, &str)) -> String {
        match self.joints[joint].kind.coordinates.len() {
            1 => format!("j{joint}"),
            _ => format!("j{joint}.{coordinate}"),
        }
    }

    /// A coordinate that nothing prescribes, if there is one and enough ways to move remain without it.
    pub fn free_coordinate(&mut self) -> Option<(usize, &'static str)> {
        let least = usize::from(self.is_closed);
        let is_free = |(joint, coordinate): &(usize, &str)| {
            let joint = &self.joints[*joint];
            !joint.taken.contains(coordinate) && self.freedoms[&joint.root] > least
        };
        let free: Vec<_> = self.coordinates().into_iter().filter(is_free).collect();
        (!free.is_empty()).then(|| free[self.dice.below(free.len())])
    }

    fn take(&mut self, joint: usize, coordinate: &'static str) {
        self.joints[joint].taken.push(coordinate);
        self.joints[joint].following.push(coordinate);
        *self.freedoms_of(self.joints[joint].root) -= 1;
    }

    pub fn freedoms_of(&mut self, root: usize) -> &mut usize {
        self.freedoms.get_mut(&root).expect("a tree that has joints")
    }

    /// All joint coordinates.
    pub fn coordinates(&self) -> Vec<(usize, &'static str)> {
        let joints = self.joints.iter().enumerate();
        joints.flat_map(|(index, joint)| joint.kind.coordinates.iter().map(move |&c| (index, c))).collect()
    }

    /// The keys that name a coordinate; one alone need not be named.
    pub fn on(&mut self, joint: usize, coordinate: &str) -> String {
        let is_alone = self.joints[joint].kind.coordinates.len() == 1;
        let named = format!("coordinate = {coordinate:?}\n");
        format!("joint = \"j{joint}\"\n{}", if is_alone && self.dice.once_in(2) { "" } else { &named })
    }

    /// Joints between bodies that hang on each other already.
    pub fn close(&mut self) {
        for _ in 0..1 + self.dice.below(2) {
            let model = self.read();
            let places = places(&model);
            let motions = free_motions(&model);
            let closed = (0..TRIES).find_map(|_| {
                self.closing(&places).filter(|closing| closing.is_regular(&model, &places, &motions))
            });
            if let Some(closing) = closed {
                let root = self.roots[closing.ends[0].body];
                *self.freedoms_of(root) -= 6 - closing.kind.freedoms;
                self.joints.push(closing.joint(root));
            }
        }
    }

    /// A joint that holds where the bodies are; none where it would leave no way to move.
    fn closing(&mut self, places: &[Place]) -> Option<Closing> {
        let bodies = [self.dice.below(places.len()), self.dice.below(places.len())];
        let kinds = ["rod", "rod", "spherical", "point_on_line", "planar", "universal"];
        let name = self.dice.pick(&kinds);
        let kind = *KINDS.iter().find(|kind| kind.name == name)?;
        let [a, b] = bodies;
        let moves = |body: usize| self.bodies[body].0.moves();
        // A free body's tree hangs on nothing else.
        let is_possible = a != b && self.roots[a] == self.roots[b] && (moves(a) || moves(b));
        let mut vector = || [(); 3].map(|()| (100.0 * self.dice.between(-1.0, 1.0)).round() / 100.0);
        let (points, axis, zero) = ([vector(), vector()], vector(), vector());
        let is_possible = is_possible && (name == "rod" || self.held[a] == self.held[b]);
        (is_possible && self.freedoms.get(&self.roots[a]).is_some_and(|free| *free > 6 - kind.freedoms))
            .then(|| Closing::between(kind, bodies, places, points, [axis, zero]))?
    }

    /// The model file as far as it has come.
    ///
    /// # Panics
    /// If it is refused: nothing on it should be wrong.
    pub fn read(&self) -> Model {
        let text = self.text();
        let model = gyro_model::read_with("page.toml", &text, &mut crate::load);
        model.unwrap_or_else(|problems| panic!("{text}\n{problems}"))
    }
}

/// Where the bodies are at the start.
pub fn places(model: &Model) -> Vec<Place> {
    let start = model.assemble().unwrap_or_else(|error| panic!("{}: {error}", model.name));
    let mut moving_bodies = start.q.chunks_exact(7);
    let of = |body: &gyro_model::Body| match body.support {
        Support::Fixed => Place {
            position: body.position.each_ref().map(exact),
            orientation: unit(body.orientation.each_ref().map(exact)),
        },
        Support::Driven => {
            let at = body.motion.as_ref().map(|motion| motion.state(model, body, 0.0)).expect("it is driven");
            Place { position: at.r.into(), orientation: at.p.0 }
        }
        _ => {
            let q = moving_bodies.next().expect("seven numbers a body");
            Place { position: [q[0], q[1], q[2]], orientation: [q[3], q[4], q[5], q[6]] }
        }
    };
    model.bodies.iter().map(of).collect()
}

fn exact(number: &Number) -> f64 {
    match number {
        Number::Exact(value) => to_f64(value),
        _ => unreachable!("places are written out"),
    }
}

fn unit(p: [f64; 4]) -> [f64; 4] {
    let length = p.iter().map(|e| e * e).sum::<f64>().sqrt();
    p.map(|e| e / length)
}

/// Singular values of rows below this are zero but for rounding.
const FREE: f64 = 1e-6;

/// The motions that the rows so far leave free, velocities of mass centres and w' of its bodies with coordinates.
pub fn free_motions(model: &Model) -> Vec<Vec<f64>> {
    let start = model.assemble().unwrap_or_else(|error| panic!("{}: {error}", model.name));
    let near: Vec<Vec<f64>> = start.joints.iter().map(|joint| joint.position.clone()).collect();
    let jacobian = Kinematics::at(model, 0.0).jacobian(&start.q, &near);
    // Of the squared rows, whose singular vectors are as many as there are columns.
    let squared = (jacobian.transpose() * jacobian).symmetric_eigen();
    let free = squared.eigenvalues.iter().enumerate().filter(|(_, value)| **value < FREE * FREE);
    free.map(|(column, _)| squared.eigenvectors.column(column).iter().copied().collect()).collect()
}
