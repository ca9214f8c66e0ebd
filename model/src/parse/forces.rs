//! Forces: in joints, between bodies and on bodies.

use super::reader::Reader;
use super::section::{Item, Section};
use super::{laws, outputs, references, tables};
use crate::keys::Kind;
use crate::validate::{Owner, Side};
use crate::{Bushing, BushingLaw, Force, ForceKind, JointCoordinate, LoadFrame, Number, StopSide};

/// All tables of forces, whose names others refer to.
pub(super) fn open<'t>(reader: &mut Reader<'_>, page: &Section<'t>) -> Vec<(Section<'t>, String)> {
    tables::each(reader, page, "force", Owner::Force)
}

/// Reads all forces. Their strengths may be formulas of outputs, which are known by now.
pub(super) fn read(reader: &mut Reader<'_>, sections: Vec<(Section<'_>, String)>) -> Vec<Force> {
    let one = |(index, (mut section, name)): (usize, (Section<'_>, String))| {
        let kind = section.read_kind(reader, |_, _| None);
        // Of a force of unknown kind nothing is asked.
        let nothing = ForceKind::Motor { on: references::NO_COORDINATE, value: Number::integer(0) };
        let kind = kind.map_or(nothing, |kind| Reading { reader, section, index }.force(kind));
        Force { name, kind }
    };
    sections.into_iter().enumerate().map(one).collect()
}

/// A force that is being read.
struct Reading<'r, 't, 's> {
    reader: &'r mut Reader<'t>,
    section: Section<'s>,
    index: usize,
}

impl<'s> Reading<'_, '_, 's> {
    fn force(&mut self, kind: &Kind) -> ForceKind {
        match kind.word {
            "spring" => ForceKind::Spring {
                on: self.on(),
                stiffness: self.number("stiffness"),
                free: self.number("free"),
            },
            "damper" => ForceKind::Damper { on: self.on(), damping: self.number("damping") },
            "coulomb" => {
                ForceKind::Coulomb { on: self.on(), level: self.number("level"), rate: self.number("rate") }
            }
            "stop" => ForceKind::Stop {
                on: self.on(),
                limit: self.number("limit"),
                side: match self.section.word(self.reader, "side") {
                    Some("lower") => StopSide::Lower,
                    _ => StopSide::Upper,
                },
                stiffness: self.number("stiffness"),
                damping: self.number("damping"),
                softness: self.number("softness"),
            },
            "motor" => ForceKind::Motor { on: self.on(), value: self.number("value") },
            "link" => self.link(),
            "bushing" => self.bushing(),
            "potential" => {
                let energy = self.number("energy");
                self.sloping("energy", ForceKind::Potential { energy })
            }
            "dissipation" => {
                let power = self.number("power");
                self.sloping("power", ForceKind::Dissipation { power })
            }
            _ => self.load(),
        }
    }

    fn on(&mut self) -> JointCoordinate {
        references::coordinate(self.reader, &self.section)
    }

    fn number(&mut self, key: &'static str) -> Number {
        self.section.number(self.reader, key)
    }

    fn link(&mut self) -> ForceKind {
        let [first, second] = Side::BOTH.map(|side| self.end(side));
        if !self.section.has("damping") && !self.section.has("tension") {
            self.section.require(self.reader, "stiffness");
        }
        if self.section.has("stiffness") {
            self.section.require_as(self.reader, "free_length", "free_length = ..., in m");
        }
        let [mut stiffness, damping, mut free_length, mut tension] =
            ["stiffness", "damping", "free_length", "tension"].map(|key| self.number(key));
        if matches!(free_length, Number::Formula(_) | Number::Input { .. }) {
            tension = self.pull_of_varying_length().unwrap_or(tension);
            (stiffness, free_length) = (Number::integer(0), Number::integer(0));
        }
        ForceKind::Link { first, second, stiffness, damping, free_length, tension }
    }

    /// The tension of a link whose free length varies, `stiffness (l − free_length) + tension`: its spring stores
    /// nothing that could be counted, as what changes its length does work on it.
    fn pull_of_varying_length(&mut self) -> Option<Number> {
        let item = self.section.require(self.reader, "free_length")?;
        if self.reader.is_named("length") {
            let words = [
                "a `free_length` that varies needs the name `length` for the distance of the link's ends"
                    .to_owned(),
                "a formula, or an input".to_owned(),
                "give what the model file calls `length` another name".to_owned(),
            ];
            item.wrong(self.reader, words);
            return None;
        }
        let stiffness = self.section.require_as(self.reader, "stiffness", "stiffness = ..., in N/m")?;
        let mut text = format!("({})*(length - ({}))", stiffness.written()?, item.written()?);
        if let Some(tension) = self.section.get("tension") {
            text += &format!(" + ({})", tension.written()?);
        }
        let item = Item { key: self.section.key("tension"), ..item };
        laws::strength(self.reader, item, &text)
    }

    fn bushing(&mut self) -> ForceKind {
        let [first, second] = Side::BOTH.map(|side| {
            outputs::frame_at(self.reader, &self.section, (Owner::ForceEnd(self.index, side), side))
        });
        let own = ["damping", "force", "torsion", "torsional_damping", "torque", "moment"];
        if !own.iter().any(|key| self.section.has(key)) {
            self.section.require(self.reader, "stiffness");
        }
        let mut law = |keys: [&'static str; 3]| {
            let [stiffness, damping, load] = keys.map(|key| self.section.vector(self.reader, key));
            BushingLaw { stiffness, damping, load }
        };
        let along = law(["stiffness", "damping", "force"]);
        let about = law(["torsion", "torsional_damping", "torque"]);
        let moment = self.section.vector(self.reader, "moment");
        ForceKind::Bushing(Box::new(Bushing { first, second, along, about, moment }))
    }

    /// What acts by the slopes of a formula, which must not be zero for want of names.
    fn sloping(&mut self, key: &'static str, kind: ForceKind) -> ForceKind {
        let place = self.section.place(key);
        let acts = kind.slopes().is_some_and(|(_, along)| !along.is_empty());
        if let Some(item) = self.section.get(key).filter(|_| !acts && !self.reader.is_doubted(place)) {
            let what = if key == "energy" { "a joint coordinate" } else { "the rate of a joint coordinate" };
            let words = [
                format!("the `{key}` of {} does not name {what}", self.section.title),
                "acts on nothing".to_owned(),
                format!("write a formula of {what}"),
            ];
            item.wrong(self.reader, words);
        }
        kind
    }

    /// A body and a point on it.
    fn end(&mut self, side: Side) -> (usize, [Number; 3]) {
        let Some(end) = self.inner(side) else {
            return (references::NOTHING, [0; 3].map(Number::integer));
        };
        (references::index(self.reader, &end, "body"), end.vector(self.reader, "point"))
    }

    fn inner(&mut self, side: Side) -> Option<Section<'s>> {
        let title = format!("`{}` of {}", side.key(), self.section.title);
        let owner = Owner::ForceEnd(self.index, side);
        self.section.inner(self.reader, side.key(), (owner, &title))
    }

    fn load(&mut self) -> ForceKind {
        let body = references::index(self.reader, &self.section, "body");
        if !self.section.has("torque") {
            self.section.require(self.reader, "force");
        }
        ForceKind::Load {
            body,
            point: self.section.vector(self.reader, "point"),
            force: self.section.vector(self.reader, "force"),
            torque: self.section.vector(self.reader, "torque"),
            frame: match self.section.word(self.reader, "frame") {
                Some("body") => LoadFrame::Body,
                _ => LoadFrame::Global,
            },
        }
    }
}
