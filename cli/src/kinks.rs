//! Kinks of laws, as runs end steps there and count them.

use crate::formulas::{formula_of, seen};
use gyro_model::{ForceKind, Formula, Model, Quaternion, Support, Vector};
use gyro_runner::{End, Kink, Levels, Line, Seen, Stay, Summary};

/// The kinks of a model's laws, each once: those that the state tells of, without what is seen between frames of a
/// bushing or from driven bodies.
pub(crate) fn kinks(model: &Model) -> Vec<Kink> {
    let mut kinks = Vec::new();
    for (site, kink) in model.kinks() {
        let told = site.formula.up_to(kink.of);
        let Some(line) = line(model, site.force, &told) else { continue };
        let see = |what| match what {
            gyro_model::Seen::Length => Seen::Distance(line),
            gyro_model::Seen::LengthRate => Seen::DistanceRate(line),
            other => seen(model, other),
        };
        let at = match kink.at {
            gyro_model::Levels::Zero => Levels::At(vec![0.0]),
            gyro_model::Levels::Whole => Levels::Whole,
            gyro_model::Levels::Curve(curve) => Levels::At(model.curves[curve].corners()),
        };
        let of = formula_of(model, &told, see);
        let words = format!("{} where {}", site.owner, kink.words);
        if kinks.iter().all(|known: &Kink| (&known.of, &known.at) != (&of, &at)) {
            let kink = Kink { words, of, at };
            kinks.push(kink);
        }
    }
    kinks
}

/// That the motion has stayed at a kink, if it has.
pub(crate) fn stay(kinks: &[Kink], summary: &Summary) -> Option<String> {
    let Stay { kink, t } = summary.stay?;
    let place = &kinks.get(kink)?.words;
    Some(format!(
        "From t = {t} s on the motion stays where a law is not smooth: {place}. Steps have not ended there any more."
    ))
}

/// The ends of a link whose law names its length; `None` where what the law sees is nothing that the state alone tells.
fn line(model: &Model, force: Option<&ForceKind>, of: &Formula) -> Option<Line> {
    let nowhere = Line([End { slot: None, point: [0.0; 3] }; 2]);
    let is_within = |seen| matches!(seen, gyro_model::Seen::Between(_) | gyro_model::Seen::BetweenRate(_));
    let is_length = |seen| matches!(seen, gyro_model::Seen::Length | gyro_model::Seen::LengthRate);
    match force {
        _ if of.sees().any(is_within) => None,
        Some(ForceKind::Link { first, second, .. }) if of.sees().any(is_length) => {
            let [first, second] = [first, second].map(|(body, point)| end(model, *body, model.values(point)));
            Some(Line([first?, second?]))
        }
        _ => Some(nowhere),
    }
}

fn end(model: &Model, body: usize, point: [f64; 3]) -> Option<End> {
    let slot = model.coordinate_bodies().into_iter().position(|other| other == body);
    let described = &model.bodies[body];
    match described.support {
        Support::Driven => None,
        Support::Fixed => {
            let turned = Quaternion(model.values(&described.orientation)).normalised();
            let place = Vector::from(model.values(&described.position)) + turned.rotate(Vector::from(point));
            Some(End { slot: None, point: place.into() })
        }
        _ => Some(End { slot, point }),
    }
}
