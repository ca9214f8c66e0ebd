//! How a run is made: an option counts over the model file, and where neither says, what an expert would take.
//!
//! | | said by | else |
//! |---|---|---|
//! | coordinates | `--coordinates`, `coordinates` | maximal where a correction is asked for, joint where there are any |
//! | steps | fixed by `--step`, `--correct-every` or method rk4 | error control |
//! | method | `--integrator` or `--method`, `method` | rk4 at fixed steps, dop853 else, and rodas4 once that meets a stiff scene |
//! | tolerance | `--tolerance`, `tolerance` | 1e-9, in single precision 1e-6 |
//! | correction | `--correction` or `--method`, `correction` | partition |
//!
//! What an option asks for counts over what the file says of something else: by `--tolerance` the file's rk4 is left,
//! by `--engine assembled` its joint coordinates.

use crate::args::SimulateArgs;
use gyro_model::{Model, Simulation};
use gyro_runner::{Approach, Coordinates, Correction, Integrator, Offers};
use std::fmt;
use std::str::FromStr;

/// What was chosen and why; nothing of what was asked for.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Chosen {
    coordinates: Option<String>,
    method: Option<String>,
}

/// The tolerance where none is given.
const TOLERANCE: f64 = 1e-9;

/// The same in single precision, which has nothing of finer ones.
const SINGLE_TOLERANCE: f64 = 1e-6;

/// A run of fixed steps that would take longer than this, s, is made only by those who say so.
const PATIENCE: f64 = 3600.0;

/// How a run of a model is made that is asked for in this way.
pub(crate) fn choose(model: &Model, args: &SimulateArgs, offers: &Offers) -> (Approach, Chosen) {
    let choice = Choice { page: &model.simulation, args, offers };
    let (coordinates, of_coordinates) = choice.coordinates();
    let is_fixed = choice.is_fixed();
    let (integrator, why) = choice.integrator(is_fixed);
    let tolerance = (!is_fixed).then(|| choice.tolerance());
    let page_correction: Option<Correction> = choice.page.correction.as_deref().and_then(known);
    let approach = Approach {
        integrator,
        tolerance,
        coordinates,
        correction: args.correction().or(page_correction).unwrap_or_default(),
        when: args.correct_when,
        budget: args.budget,
        patience: Some(PATIENCE),
        examine: args.verify || args.linearize.is_some(),
        leaves_stiff: false,
        meets_knots: false,
    };
    let leaves_stiff = why.is_some() && integrator == Integrator::Dop853 && choice.can_turn(&approach);
    let chosen = Chosen { coordinates: of_coordinates, method: why.map(|why| by(&approach, &why)) };
    (Approach { leaves_stiff, ..approach }, chosen)
}

impl Chosen {
    /// The approach of a run that has turned out to be stiff at this time, by a method that does not mind.
    pub(crate) fn turn(&mut self, approach: &Approach, t: f64) -> Approach {
        let turned = Approach { integrator: Integrator::Rodas4, leaves_stiff: false, ..*approach };
        let why = format!("the scene is stiff: from t = {t:.2e} s stability limits the steps of dop853");
        self.method = Some(by(&turned, &why));
        turned
    }
}

impl fmt::Display for Chosen {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let parts: Vec<&str> =
            [&self.coordinates, &self.method].into_iter().flatten().map(String::as_str).collect();
        f.write_str(&parts.join("; "))
    }
}

/// A method with its tolerance, and why.
fn by(approach: &Approach, why: &str) -> String {
    let integrator = approach.integrator;
    match approach.tolerance {
        Some(tolerance) => format!("{integrator} at a tolerance of {tolerance:e}, as {why}"),
        None => format!("{integrator}, as {why}"),
    }
}

/// What a word of a model file stands for, which its reader has checked.
fn known<T: FromStr>(word: &str) -> Option<T> {
    word.parse().ok()
}

struct Choice<'a> {
    page: &'a Simulation,
    args: &'a SimulateArgs,
    offers: &'a Offers,
}

impl Choice<'_> {
    /// Which ones, and why if that was chosen.
    fn coordinates(&self) -> (Coordinates, Option<String>) {
        let Self { page, args, offers, .. } = self;
        let of_page: Option<Coordinates> = page.coordinates.and_then(known);
        let is_corrected =
            args.correction().is_some() || args.correct_every.is_some() || args.correct_when.is_some();
        let lacks = of_page == Some(Coordinates::Joint) && !offers.joint_space && args.engine.is_some();
        let (found, why) = match (args.coordinates, of_page) {
            (Some(coordinates), _) => return (coordinates, None),
            (None, Some(coordinates)) if offers.touches || !(is_corrected || lacks) => {
                return (coordinates, None);
            }
            _ if offers.touches => (Coordinates::Joint, "the mechanism has them".to_owned()),
            _ if is_corrected => (Coordinates::Maximal, "a correction is asked for".to_owned()),
            _ if !offers.joint_space => (Coordinates::Maximal, self.without_joints()),
            _ if page.correction.is_some() => {
                (Coordinates::Maximal, "the model file gives a correction".to_owned())
            }
            _ => (Coordinates::Joint, "the mechanism has them".to_owned()),
        };
        (found, Some(format!("{found} coordinates, as {why}")))
    }

    fn without_joints(&self) -> String {
        format!("engine {} has no others", self.args.engine().name())
    }

    /// Whether steps have a fixed length.
    fn is_fixed(&self) -> bool {
        let args = self.args;
        match (args.tolerance, args.step.or(args.correct_every), args.integrator()) {
            (Some(_), ..) => false,
            (None, Some(_), _) => true,
            (None, None, Some(integrator)) => !integrator.is_adaptive(),
            (None, None, None) => self.page.method == Some(Integrator::Rk4.name()),
        }
    }

    /// The method, and why if that was chosen.
    fn integrator(&self, is_fixed: bool) -> (Integrator, Option<String>) {
        let of_page: Option<Integrator> = self.page.method.and_then(known);
        let why = match (self.args.integrator(), of_page) {
            (Some(integrator), _) => return (integrator, None),
            (None, Some(Integrator::Rk4)) if !is_fixed => "the model file's rk4 has no error estimate",
            (None, Some(Integrator::Rodas4)) if !self.offers.derivatives => {
                "the model file's rodas4 is for generated code"
            }
            (None, Some(integrator)) => return (integrator, None),
            (None, None) => "no method is given",
        };
        let chosen = if is_fixed { Integrator::Rk4 } else { Integrator::Dop853 };
        (chosen, Some(why.to_owned()))
    }

    fn tolerance(&self) -> f64 {
        let of_page = self.page.tolerance.filter(|tolerance| *tolerance >= self.offers.finest_tolerance());
        let is_single = self.offers.epsilon > f64::EPSILON;
        let usual = if is_single { SINGLE_TOLERANCE } else { TOLERANCE };
        self.args.tolerance.or(of_page).unwrap_or(usual)
    }

    /// Whether rodas4 can take over.
    fn can_turn(&self, approach: &Approach) -> bool {
        let turned = Approach { integrator: Integrator::Rodas4, ..*approach };
        // As surfaces come to rest direction changes fast, which is over soon.
        let can_be = !self.offers.touches && self.offers.refused_method(&turned).is_none();
        approach.tolerance.is_some() && can_be
    }
}

#[cfg(test)]
mod tests;
