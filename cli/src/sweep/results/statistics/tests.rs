use super::*;

#[test]
fn correlations_are_those_of_lines_and_of_what_does_not_depend() {
    let a = [1.0, 2.0, 3.0, 4.0, f64::NAN];
    assert!((correlation(&a, &[2.0, 4.0, 6.0, 8.0, 1.0]) - 1.0).abs() < 1e-15);
    assert!((correlation(&a, &[-1.0, -2.0, -3.0, -4.0, 9.0]) + 1.0).abs() < 1e-15);
    assert!(correlation(&a, &[1.0, -1.0, -1.0, 1.0, 0.0]).abs() < 1e-15);
    assert!(correlation(&a, &[7.0; 5]).is_nan());
    // The deviation of 1, 2, 3, 4 is the root of 5/3.
    let [mean, deviation] = moments(a[..4].iter().copied());
    assert!(mean == 2.5 && (deviation - (5.0_f64 / 3.0).sqrt()).abs() < 1e-15);
}

#[test]
fn large_studies_have_small_pages() {
    let name = ("a name of usual length".to_owned(), "rad".to_owned());
    let values = |seed: usize| (0..10_000).map(move |k| (((k * 7919 + seed) % 10_007) as f64).sin());
    let columns = |n: usize| -> Vec<Column<'_>> {
        (0..n).map(|k| Column { name: &name, values: values(k).collect() }).collect()
    };
    let few: Vec<Column<'_>> =
        (0..7).map(|k| Column { name: &name, values: values(k).take(300).collect() }).collect();
    let page = table(&columns(7), &columns(30), 1).len()
        + super::super::cloud::histograms(&columns(30)).len()
        + super::super::cloud::scatter(&few, &few).len();
    assert!(page < 290_000, "{page} bytes");
}
