//! Coordinates of the tree that couplers and drivers determine: they are put in wherever they occur, and neither a row
//! nor a multiplier of them is left.

use super::layout::{Layout, Place};
use super::relation::{Determined, Relation, linear};
use crate::derive::in_time::in_time;
use crate::derive::system::System;
use crate::expr::definitions::{Definitions, Values};
use crate::expr::differentiate::Derivative;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::symbol::Symbol;
use gyro_model::{JointCoordinate, Model, RowOwner};

/// What couplers and drivers determine, sources before what follows from them; and the owners of the rows that no
/// coordinate can be put in for.
pub fn determined(
    model: &Model,
    is_on_tree: impl Fn(JointCoordinate) -> bool,
) -> (Vec<Determined>, Vec<RowOwner>) {
    let kept: Vec<_> = model.rows().into_iter().map(|row| row.owner).collect();
    let drivers = (0..model.drivers.len()).map(RowOwner::Driver);
    let mut open: Vec<_> = drivers
        .chain((0..model.couplers.len()).map(RowOwner::Coupler))
        .filter(|owner| kept.contains(owner))
        .collect();
    let mut found: Vec<Determined> = Vec::new();
    // What a coordinate is a multiple of in the end.
    let root = |found: &[Determined], mut on: JointCoordinate| {
        while let Some(known) = found.iter().find(|known| known.coordinate == on) {
            match known.by.source(model) {
                Some(source) => on = source,
                None => break,
            }
        }
        on
    };
    loop {
        let next = open.iter().enumerate().find_map(|(place, &owner)| {
            let is_open =
                |on: JointCoordinate| is_on_tree(on) && found.iter().all(|known| known.coordinate != on);
            let by = match owner {
                RowOwner::Driver(driver) => {
                    let coordinate = model.drivers[driver].coordinate;
                    is_open(coordinate).then_some(Determined { coordinate, by: Relation::Driver(driver) })
                }
                RowOwner::Coupler(coupler) => {
                    // A formula is a row that closes loops, or one of velocities.
                    let second = model.couplers[coupler].second?;
                    let (first, ratio, _) = model.couplers[coupler].linear()?;
                    let is_tree = is_on_tree(first) && is_on_tree(second);
                    let is_new = root(&found, first) != root(&found, second);
                    let forward = Determined { coordinate: second, by: Relation::Forward(coupler) };
                    let backward = Determined { coordinate: first, by: Relation::Backward(coupler) };
                    match (is_open(second), is_open(first)) {
                        _ if !(is_tree && is_new) => None,
                        (true, _) => Some(forward),
                        (false, true) if model.value(ratio) != 0.0 => Some(backward),
                        _ => None,
                    }
                }
                _ => None,
            };
            by.map(|by| (place, by))
        });
        let Some((place, by)) = next else { return (sources_first(model, found), open) };
        open.remove(place);
        found.push(by);
    }
}

fn sources_first(model: &Model, mut found: Vec<Determined>) -> Vec<Determined> {
    let mut ordered: Vec<Determined> = Vec::new();
    while !found.is_empty() {
        let waits = |on: JointCoordinate| found.iter().any(|other| other.coordinate == on);
        let next = found.iter().position(|known| !known.by.source(model).is_some_and(waits));
        ordered.push(found.remove(next.expect("no coordinate determines itself")));
    }
    ordered
}

/// The determined coordinates, their rates and the rates' rates in terms of those of the state.
pub fn values(system: &mut System, layout: &Layout) -> Values {
    let mut values = Values::default();
    for known in &layout.determined {
        let place = place_of(layout, known.coordinate);
        let [x, u, rate_of_rate] = match known.by {
            Relation::Driver(driver) => {
                let value = system.prescribed(&system.model.drivers[driver].motion);
                let rate = by_time(system, value);
                [value, rate, by_time(system, rate)]
            }
            Relation::Held(_) => [Graph::ZERO; 3],
            Relation::Forward(coupler) | Relation::Backward(coupler) => {
                let source = known.by.source(system.model).expect("a coupler has two coordinates");
                let of_source = place_of(layout, source);
                let (_, ratio, offset) = linear(system.model, coupler);
                let [ratio, offset] = [ratio, offset].map(|number| system.number(number));
                let graph = &mut system.graph;
                let symbols = symbols(of_source)
                    .map(|symbol| values.get(&symbol).copied().unwrap_or_else(|| graph.symbol(symbol)));
                if matches!(known.by, Relation::Forward(_)) {
                    let scaled = symbols.map(|x| graph.mul(ratio, x));
                    [graph.add(scaled[0], offset), scaled[1], scaled[2]]
                } else {
                    let shifted = graph.sub(symbols[0], offset);
                    [shifted, symbols[1], symbols[2]].map(|x| graph.div(x, ratio))
                }
            }
        };
        for (symbol, value) in symbols(place).into_iter().zip([x, u, rate_of_rate]) {
            values.insert(symbol, value);
        }
    }
    values
}

/// The coordinate, its rate and the rate's rate.
fn symbols(place: Place) -> [Symbol; 3] {
    [Symbol::Coordinate(place.x), Symbol::Rate(place.u), Symbol::RateOfRate(place.u)]
}

pub fn place_of(layout: &Layout, on: JointCoordinate) -> Place {
    layout.scalar(on).expect("joints of a tree have their coordinates").place
}

fn by_time(system: &mut System, value: ExprId) -> ExprId {
    let time = in_time(&mut system.graph, system.model);
    Derivative::new(&Definitions::default(), time).of(&mut system.graph, value)
}
