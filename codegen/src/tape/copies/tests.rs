use super::*;

fn kept(row: usize, column: usize) -> Option<Copied> {
    Some(Copied { from: Source { of: Array::Kept { array: 0, column }, is_negative: column == 1 }, row })
}

/// Too few copies are no run, and buffers alone are no reason for one.
#[test]
fn short_runs_stay_apart() {
    let stores: Vec<_> = (0..LEAST_COPIES - 1).map(|row| (row, kept(row, 0))).collect();
    assert_eq!(arranged(&stores), None);
    let stores: Vec<_> = (0..20).map(|row| (row, Some(Copied::of_named("rates", row)))).collect();
    assert_eq!(arranged(&stores), None);
}

/// Whatever runs are found, every place gets its own value once: 200 random tables of copies.
#[test]
fn every_place_gets_its_value() {
    let mut state = 1_u64;
    let mut random = |n: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        usize::try_from(state >> 33).expect("31 bits") % n
    };
    for _ in 0..200 {
        let (n, columns) = (20 + random(80), 1 + random(3));
        let stores: Vec<_> = (0..n)
            .map(|k| (k, kept(if random(9) == 0 { random(n) } else { k / columns }, k % columns)))
            .collect();
        let Some(arranged) = arranged(&stores) else { continue };
        let mut given = arranged.rest;
        for run in arranged.loops.iter().flat_map(|(_, runs)| runs) {
            assert!(run.count >= LEAST_COPIES);
            for k in 0..run.count {
                let place = run.place + k * run.places_apart;
                let expected = Copied { from: run.from, row: run.row + k * run.rows_apart };
                assert_eq!(stores[place].1, Some(expected));
                given.push(place);
            }
        }
        given.sort_unstable();
        assert_eq!(given, (0..n).collect::<Vec<_>>(), "a place is given twice or not at all");
    }
}
