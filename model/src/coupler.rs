//! Rows that tie joint coordinates, or their rates.

use crate::{CoordinateUse, Formula, JointCoordinate, Number, Seen};

/// Joint coordinates that are tied: one row. A joint coordinate that follows others, the coordinate less what it is to
/// be; or a constraint of one's own.
#[derive(Clone, Debug)]
pub struct Coupler {
    /// Name, an identifier.
    pub name: String,
    /// The coordinate that follows; of a constraint there is none.
    pub second: Option<JointCoordinate>,
    /// What it is to be, or what is to be zero.
    pub by: Coupling,
}

/// What a coordinate is to be, or what is to be zero.
#[derive(Clone, Debug)]
pub enum Coupling {
    /// `ratio · first + offset`: a gear, a belt, a rack.
    Linear {
        /// The driving coordinate.
        first: JointCoordinate,
        /// Ratio; of the units of the two coordinates.
        ratio: Number,
        /// Offset, in the unit of the second coordinate.
        offset: Number,
    },
    /// A formula of other joint coordinates: a cam, a variable gear.
    Formula(Formula),
    /// A formula of joint coordinates, and of where frames are, that is zero.
    Zero(Formula),
    /// A formula of joint coordinates and rates, and of how frames lie and move, linear in what moves, that is zero: a
    /// row of velocities, of which nothing follows for positions. Φ of it counts as zero, its row in Φ_q is what the
    /// rates are multiplied by.
    Rate(Formula),
}

impl Coupling {
    /// The formula of a cam or constraint.
    pub fn formula(&self) -> Option<&Formula> {
        match self {
            Self::Linear { .. } => None,
            Self::Formula(formula) | Self::Zero(formula) | Self::Rate(formula) => Some(formula),
        }
    }
}

impl Coupler {
    /// Most coordinates of its row, an output counted for one.
    pub const MOST: usize = 8;

    /// All coordinates of its row.
    pub fn coordinates(&self) -> Vec<JointCoordinate> {
        let mut all: Vec<_> = self.second.into_iter().collect();
        match &self.by {
            Coupling::Linear { first, .. } => all.insert(0, *first),
            by => by.formula().into_iter().for_each(|formula| {
                for (on, _) in formula.uses().filter(|(on, _)| !all.contains(on)).collect::<Vec<_>>() {
                    all.push(on);
                }
            }),
        }
        all
    }

    /// The outputs that its formula sees, each once.
    pub fn outputs(&self) -> Vec<usize> {
        let mut all: Vec<usize> = Vec::new();
        for seen in self.by.formula().into_iter().flat_map(Formula::sees) {
            match seen {
                Seen::Output { output, .. } if !all.contains(&output) => all.push(output),
                _ => {}
            }
        }
        all
    }

    /// Those on whose value, turns included, its row depends.
    pub fn placed(&self) -> Vec<JointCoordinate> {
        let Some(formula) = self.rate() else { return self.coordinates() };
        formula.uses().filter(|(_, of)| *of == CoordinateUse::Value).map(|(on, _)| on).collect()
    }

    /// What kind of section the model file has it in.
    pub fn word(&self) -> &'static str {
        if self.second.is_some() { "coupler" } else { "constraint" }
    }

    /// The formula of a row of velocities.
    pub fn rate(&self) -> Option<&Formula> {
        if let Coupling::Rate(formula) = &self.by { Some(formula) } else { None }
    }

    /// The driving coordinate with ratio and offset, of a gear.
    pub fn linear(&self) -> Option<(JointCoordinate, &Number, &Number)> {
        match &self.by {
            Coupling::Linear { first, ratio, offset } => Some((*first, ratio, offset)),
            _ => None,
        }
    }
}
