//! Where the formulas of a model stand.

use crate::{BodyMotion, ForceKind, Formula, Kink, Model, Motion, Number};

/// A formula of a model, and where it stands.
#[derive(Clone, Debug)]
pub struct Site<'m> {
    /// Whose it is, such as ``force `wire` ``.
    pub owner: String,
    /// What it is of that, such as `the tension of`; empty of what has but one.
    pub what: String,
    /// The formula.
    pub formula: &'m Formula,
    /// The force whose own readings it may name.
    pub force: Option<&'m ForceKind>,
}

impl Site<'_> {
    /// The formula by its place, such as ``the tension of force `wire` ``.
    pub fn words(&self) -> String {
        [self.what.as_str(), &self.owner].join(" ").trim().to_owned()
    }
}

impl Model {
    /// All formulas of forces, states, couplers, motions, outputs, events and set points, in this order.
    pub fn sites(&self) -> Vec<Site<'_>> {
        let mut sites = Vec::new();
        for force in &self.forces {
            for (key, numbers) in force.kind.parts().numbers {
                let n = numbers.len();
                for (place, formula) in numbers.iter().map(Number::formula).enumerate() {
                    let Some(formula) = formula else { continue };
                    let of = if n == 1 { String::new() } else { format!("number {} of ", place + 1) };
                    let what = format!("{of}the {} of", key.replace('_', " "));
                    let owner = format!("force `{}`", force.name);
                    sites.push(Site { owner, what, formula, force: Some(&force.kind) });
                }
            }
        }
        let mut add = |what: &str, owner: String, formula| {
            sites.push(Site { owner, what: what.to_owned(), formula, force: None });
        };
        for state in &self.states {
            if let Some(rate) = state.rate.formula() {
                add("the rate of", format!("state `{}`", state.name), rate);
            }
        }
        for coupler in &self.couplers {
            if let Some(formula) = coupler.by.formula() {
                add("", format!("{} `{}`", coupler.word(), coupler.name), formula);
            }
        }
        let drivers = self.drivers.iter().map(|driver| (format!("driver `{}`", driver.name), &driver.motion));
        let bodies = self.bodies.iter().filter_map(|body| Some((&body.name, body.motion.as_ref()?)));
        let bodies = bodies.flat_map(|(name, motion)| {
            BodyMotion::parts(motion).map(move |part| (format!("body `{name}`"), part))
        });
        for (owner, motion) in drivers.chain(bodies) {
            Motion::formulas(motion)
                .into_iter()
                .for_each(|formula| add("the motion of", owner.clone(), formula));
        }
        for output in &self.outputs {
            if let Some(formula) = output.kind.formula() {
                add("", format!("output `{}`", output.name), formula);
            }
        }
        for event in &self.events {
            add("", format!("event `{}`", event.name), &event.of);
        }
        for controller in &self.controllers {
            for formula in controller.setpoints.iter().filter_map(Number::formula) {
                add("a set point of", format!("controller `{}`", controller.name), formula);
            }
        }
        sites
    }

    /// The kinks of all formulas that a motion depends on: whose they are, and where.
    pub fn kinks(&self) -> Vec<(Site<'_>, &Kink)> {
        let is_told = |site: &Site<'_>| {
            ["output", "event", "controller"].iter().any(|word| site.owner.starts_with(word))
        };
        let sites = self.sites().into_iter().filter(|site| !is_told(site));
        sites.flat_map(|site| site.formula.kinks.iter().map(move |kink| (site.clone(), kink))).collect()
    }

    /// The same in words, a line for each owner.
    pub fn kinks_in_words(&self) -> Vec<String> {
        let mut owners: Vec<(String, Vec<&str>)> = Vec::new();
        for (site, kink) in self.kinks() {
            match owners.last_mut().filter(|(owner, _)| *owner == site.owner) {
                Some((_, places)) if places.contains(&kink.words.as_str()) => {}
                Some((_, places)) => places.push(&kink.words),
                None => owners.push((site.owner, vec![&kink.words])),
            }
        }
        owners.into_iter().map(|(owner, places)| format!("{owner} where {}", places.join(", "))).collect()
    }
}
