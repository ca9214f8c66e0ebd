use super::*;

#[test]
fn long_axes_have_decades_and_short_ones_round_numbers() {
    let texts = |values: &[f64]| {
        let decades = Decades::of(values.iter().copied(), (1e-16, 1e16));
        decades.ticks().into_iter().map(|(_, text)| text).collect::<Vec<_>>()
    };
    assert_eq!(texts(&[2e-12, 3e-9]), ["1e-12", "1e-11", "1e-10", "1e-9", "1e-8"]);
    assert_eq!(texts(&[1.2, 40.0]), ["1", "2", "5", "10", "20", "50", "100"]);
    assert_eq!(texts(&[]).len(), 4);
}

#[test]
fn what_is_outside_the_limits_is_not_drawn() {
    let line = Line {
        points: vec![(1.0, 1e-3), (10.0, 1e-5), (100.0, 1e40), (1e3, 1e-6)],
        style: Style { colour: BLUE, stroke: Stroke::Solid, marker: Marker::Disc },
    };
    let chart = Chart {
        x: Axis { label: "x".into(), limits: (0.1, 1e4) },
        y: Axis { label: "a < b".into(), limits: (1e-16, 1e2) },
        n_columns: 1,
        panels: vec![Panel { title: "p".into(), lines: vec![line] }],
        ..Chart::default()
    };
    let svg = chart.svg();
    assert!(roxmltree::Document::parse(&svg).is_ok(), "{svg}");
    // Two points before the gap are joined, the one behind it stands alone.
    assert_eq!(svg.matches("<polyline").count(), 1);
    assert!(svg.contains("a &lt; b") && !svg.contains("NaN") && !svg.contains("inf"), "{svg}");
}
