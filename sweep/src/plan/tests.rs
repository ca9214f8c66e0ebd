use super::*;
use crate::draw::Distribution;

fn plan(sampling: Sampling) -> Plan {
    let unit = |target| Draw::Alone { target, distribution: Distribution::Uniform([0.0, 1.0]) };
    let axis = |target, values: &[f64]| Axis {
        targets: vec![target],
        rows: values.iter().map(|value| vec![*value]).collect(),
    };
    Plan {
        seed: 7,
        sampling,
        targets: (0..4).map(Target::Parameter).collect(),
        axes: vec![axis(0, &[1.0, 2.0]), axis(3, &[10.0, 20.0, 30.0])],
        draws: vec![unit(1), unit(2)],
        repeats: 5,
    }
}

fn values(plan: &Plan, k: u64) -> [f64; 4] {
    let mut values = [0.0; 4];
    Source::new(plan).write(k, &mut values);
    values
}

#[test]
fn a_scenario_depends_on_seed_and_index_alone() {
    for sampling in [Sampling::Random, Sampling::Sobol, Sampling::Saltelli] {
        let plan = plan(sampling);
        let mut source = Source::new(&plan);
        let mut all = Vec::new();
        for k in 0..plan.scenarios() {
            let mut found = [0.0; 4];
            source.write(k, &mut found);
            assert_eq!(found, values(&plan, k));
            all.push(found);
        }
        let other = Plan { seed: 8, ..plan.clone() };
        assert!((0..plan.scenarios()).all(|k| values(&other, k)[1] != all[k as usize][1]), "{sampling:?}");
    }
}

#[test]
fn no_two_scenarios_draw_the_same() {
    for sampling in [Sampling::Random, Sampling::Sobol] {
        let plan = Plan { repeats: 500, ..plan(sampling) };
        let drawn = (0..plan.scenarios()).map(|k| values(&plan, k)[1].to_bits());
        assert_eq!(drawn.collect::<std::collections::BTreeSet<_>>().len(), 3000, "{sampling:?}");
    }
}

#[test]
fn the_last_axis_is_the_fastest() {
    let plan = plan(Sampling::Random);
    assert_eq!((plan.grid(), plan.scenarios()), (6, 30));
    let grid = |k| {
        let [a, _, _, b] = values(&plan, k);
        (a, b)
    };
    assert_eq!([0, 1, 2, 3, 6].map(grid), [(1.0, 10.0), (1.0, 20.0), (1.0, 30.0), (2.0, 10.0), (1.0, 10.0)]);
    assert_ne!(values(&plan, 0)[1], values(&plan, 6)[1]);
}

#[test]
fn a_group_of_saltelli_exchanges_one_draw_each() {
    let plan = Plan { axes: Vec::new(), ..plan(Sampling::Saltelli) };
    assert_eq!(plan.scenarios(), 20);
    let [a, b, first, second] = [8, 9, 10, 11].map(|k| values(&plan, k));
    assert_eq!([first[1], first[2]], [b[1], a[2]]);
    assert_eq!([second[1], second[2]], [a[1], b[2]]);
    assert!(a[1] != b[1] && a[2] != b[2]);
}
