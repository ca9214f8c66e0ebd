//! Redundant rows, rank and degrees of freedom of mechanisms whose mobility is known.

use gyro_model::{
    AssemblyError, BodyMotion, Driver, JointCoordinate, Kinematics, Model, Motion, Number, Rational,
    RowOwner, Support, analyse, read,
};

fn page(stem: &str) -> Model {
    let folders = ["models", "tests/models"];
    let paths = folders.map(|folder| format!("{}/../{folder}/{stem}.toml", env!("CARGO_MANIFEST_DIR")));
    let text = paths.iter().find_map(|path| std::fs::read_to_string(path).ok()).expect("a model file");
    read(stem, &text).unwrap_or_else(|mistakes| panic!("{mistakes}"))
}

fn number(x: f64) -> Number {
    Number::Exact(Rational::from_float(x).expect("finite"))
}

/// Where a revolute joint is in the pose of the model file, and which bodies it joins.
#[derive(Clone, Copy)]
pub(crate) struct Pin {
    pub(crate) bodies: [usize; 2],
    pub(crate) at: [f64; 3],
    pub(crate) axis: [f64; 3],
}

impl Pin {
    /// A direction across the axis.
    fn zero(&self) -> [f64; 3] {
        let [x, y, _] = self.axis;
        if x == 0.0 && y == 0.0 { [1.0, 0.0, 0.0] } else { [-y, x, 0.0] }
    }

    /// Where it is on a body.
    fn point(&self, body: usize) -> [f64; 3] {
        let n = body as f64;
        let centre = if body == 0 { [0.0; 3] } else { [0.125 * n, 0.25 - 0.0625 * n, 0.03125 * n] };
        std::array::from_fn(|k| self.at[k] - centre[k])
    }
}

/// Bodies with their frames parallel to the global one, joined by revolute joints where those say; body 0 is the
/// ground. Each body's centre is at its number's place of a skew line, so that no coordinate is special.
pub(crate) fn pinned(n_bodies: usize, pins: &[Pin]) -> String {
    let mut text = "format = 1\nname = \"pinned\"\n[[body]]\nname = \"b0\"\nfixed = true\n".to_owned();
    for body in 1..n_bodies {
        text += &format!("[[body]]\nname = \"b{body}\"\nmass = 1\ninertia = [0.01, 0.01, 0.01]\n");
    }
    for (index, pin) in pins.iter().enumerate() {
        text += &format!(
            "[[joint]]\nname = \"j{index}\"\nkind = \"revolute\"\naxis = {:?}\nzero = {:?}\n",
            pin.axis,
            pin.zero()
        );
        for (key, body) in ["first", "second"].into_iter().zip(pin.bodies) {
            let point = pin.point(body);
            text += &format!("{key} = {{ body = \"b{body}\", point = {point:?} }}\n");
        }
    }
    text
}

pub(crate) fn model(page: &str) -> Model {
    read("pinned", page).unwrap_or_else(|mistakes| panic!("{mistakes}"))
}

/// A planar mechanism in the plane spanned by two orthogonal vectors: pins at (x, y), axes along their cross product.
fn planar(n_bodies: usize, pins: &[([usize; 2], [f64; 2])], [u, v]: [[f64; 3]; 2]) -> Model {
    let axis = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let pins: Vec<Pin> = pins
        .iter()
        .map(|&(bodies, [x, y])| Pin { bodies, at: std::array::from_fn(|k| x * u[k] + y * v[k]), axis })
        .collect();
    model(&pinned(n_bodies, &pins))
}

const FLAT: [[f64; 3]; 2] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// The normal is nearly the global x axis: rows along x are nearly dependent, but not quite.
const STEEP: [[f64; 3]; 2] = [[-0.015625, 1.0, 0.0], [0.0, 0.0, 1.0]];
const TILTED: [[f64; 3]; 2] = [[2.0, 1.0, -2.0], [1.0, 2.0, 2.0]];

/// Ground, crank, coupler, rocker.
fn four_bar(at: [[f64; 2]; 4], plane: [[f64; 3]; 2]) -> Model {
    let bodies = [[0, 1], [1, 2], [0, 3], [2, 3]];
    let pins: Vec<_> = bodies.into_iter().zip([at[0], at[1], at[3], at[2]]).collect();
    planar(4, &pins, plane)
}

/// Owners of the redundant rows.
fn owners(model: &Model) -> Vec<RowOwner> {
    let analysis = analyse(model).unwrap_or_else(|error| panic!("{error}"));
    analysis.redundant.iter().map(|redundant| redundant.row.owner).collect()
}

/// The rows that are left have the rank, far from losing it, and the dropped ones hold.
fn check_kept(model: &mut Model) {
    let analysis = analyse(model).unwrap_or_else(|error| panic!("{error}"));
    model.redundant = analysis.redundant.clone();
    let stay = model.redundant.iter().filter(|row| row.stays).count();
    assert_eq!(model.rows().len(), analysis.rank + stay);
    assert_eq!(model.degrees_of_freedom(), analysis.degrees_of_freedom);
    assert_eq!(model.degrees_of_freedom(), 6 * model.coordinate_bodies().len() - analysis.rank);
    let (start, kinematics) = (model.assemble().expect("a start"), Kinematics::at(model, 0.0));
    let near: Vec<Vec<f64>> = start.joints.iter().map(|joint| joint.position.clone()).collect();
    let jacobian = kinematics.jacobian(&start.q, &near);
    let rows = model.rows();
    let kept: Vec<usize> = (0..jacobian.nrows()).filter(|&k| rows.contains(&kinematics.rows()[k])).collect();
    let smallest = |matrix: nalgebra::DMatrix<f64>, rank: usize| {
        let mut values = matrix.singular_values().as_slice().to_vec();
        values.sort_by(|a, b| b.total_cmp(a));
        values[rank - 1]
    };
    let [left, all] = [jacobian.select_rows(&kept), jacobian].map(|matrix| smallest(matrix, analysis.rank));
    if !analysis.singular_start {
        assert!(left > 0.05 * all, "the rows that are left are nearly dependent: {left} of {all}");
    }
}

#[test]
fn a_planar_four_bar_has_three_redundant_rows() {
    for plane in [FLAT, TILTED, [TILTED[1], TILTED[0]], STEEP] {
        let mut model = four_bar([[0.0, 0.0], [0.125, 0.25], [0.75, 0.5], [0.5, 0.0]], plane);
        assert_eq!(owners(&model), [RowOwner::Joint(3); 3]);
        let analysis = analyse(&model).expect("checked");
        assert_eq!((analysis.rank, analysis.degrees_of_freedom, analysis.singular_start), (17, 1, false));
        let shared = &analysis.redundant[0].shared_with;
        assert!((0..3).all(|joint| shared.contains(&RowOwner::Joint(joint))), "{shared:?}");
        check_kept(&mut model);
    }
}

#[test]
fn a_start_in_line_does_not_count_more() {
    for plane in [FLAT, TILTED] {
        // A parallelogram, folded flat, and a four-bar whose bars add up: both may go on in two ways.
        for at in [[0.0, 0.25, 0.75, 0.5], [0.0, 0.25, 0.75, 0.375]] {
            let mut model = four_bar(at.map(|x| [x, 0.0]), plane);
            let analysis = analyse(&model).expect("a mechanism");
            assert_eq!(owners(&model), [RowOwner::Joint(3); 3]);
            assert_eq!((analysis.degrees_of_freedom, analysis.singular_start), (1, true));
            check_kept(&mut model);
        }
    }
}

#[test]
fn a_parallelogram_with_a_third_crank_has_seven_redundant_rows() {
    let [up, along] = [[0.125, 0.25], [0.5, 0.0]];
    let crank = |n: f64| [n * along[0], n * along[1]];
    let end = |n: f64| [n * along[0] + up[0], n * along[1] + up[1]];
    let pins = [
        ([0, 1], crank(0.0)),
        ([0, 3], crank(2.0)),
        ([0, 4], crank(1.0)),
        ([1, 2], end(0.0)),
        ([2, 3], end(2.0)),
        ([2, 4], end(1.0)),
    ];
    for plane in [FLAT, TILTED] {
        let mut model = planar(5, &pins, plane);
        let analysis = analyse(&model).expect("a mechanism");
        // 30 rows; four bodies with one degree of freedom have a rank of 23.
        assert_eq!((analysis.rank, analysis.degrees_of_freedom, analysis.redundant.len()), (23, 1, 7));
        assert!(owners(&model).iter().all(|o| [RowOwner::Joint(4), RowOwner::Joint(5)].contains(o)));
        check_kept(&mut model);
    }
}

/// Bennett (1903): a spatial loop of four skew revolute axes that moves because `a / sin α = b / sin β`.
#[test]
fn bennetts_linkage_moves() {
    // Opposite sides a, twist α and b, twist β; Denavit–Hartenberg, all offsets zero.
    let (alpha, beta) = (0.5_f64, 1.1_f64);
    let (a, b) = (alpha.sin(), beta.sin());
    let sides = [(a, alpha), (b, beta), (a, alpha), (b, beta)];
    // tan(θ1/2) tan(θ2/2) = sin ½(β + α) / sin ½(β − α), and opposite angles are equal up to sign.
    let first = 0.9_f64;
    let ratio = (0.5 * (beta + alpha)).sin() / (0.5 * (beta - alpha)).sin();
    let second = 2.0 * (ratio / (0.5 * first).tan()).atan();
    let angles = [first, second, -first, -second];
    let mut at = [0.0; 3];
    let mut frame = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let combine = |u: [f64; 3], s: f64, v: [f64; 3], t: f64| std::array::from_fn(|k| s * u[k] + t * v[k]);
    let mut pins = Vec::new();
    for (k, ((length, twist), angle)) in sides.into_iter().zip(angles).enumerate() {
        pins.push(Pin { bodies: [(k + 3) % 4, k], at, axis: frame[2] });
        let [x, y, z] = frame;
        let (sin, cos) = angle.sin_cos();
        let (x, y): ([f64; 3], [f64; 3]) = (combine(x, cos, y, sin), combine(y, cos, x, -sin));
        at = combine(at, 1.0, x, length);
        let (sin, cos) = twist.sin_cos();
        frame = [x, combine(y, cos, z, sin), combine(z, cos, y, -sin)];
    }
    let gap = at.iter().map(|x| x.abs()).fold((frame[2][2] - 1.0).abs(), f64::max);
    assert!(gap < 1e-14, "the loop does not close: {gap}");
    let mut moves = model(&pinned(4, &pins));
    let analysis = analyse(&moves).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((analysis.rank, analysis.degrees_of_freedom, analysis.redundant.len()), (17, 1, 3));
    check_kept(&mut moves);

    // With an axis that is skew in another way the same loop closes, and is rigid.
    pins[1].axis = [0.2, 0.3, 1.0];
    let error = analyse(&rigid(4, &pins)).expect_err("a structure");
    assert!(matches!(&error, AssemblyError::OverConstrained { .. }), "{error}");
}

/// A model that no model file can give, as reading refuses what cannot move: its last joint is added afterwards.
fn rigid(n_bodies: usize, pins: &[Pin]) -> Model {
    let (last, before) = pins.split_last().expect("pins");
    let mut model = model(&pinned(n_bodies, before));
    let mut joint = model.joints[0].clone();
    joint.name = format!("j{}", before.len());
    for (end, body) in [&mut joint.first, &mut joint.second].into_iter().zip(last.bodies) {
        end.body = body;
        end.point = last.point(body).map(number);
        (end.axis, end.zero) = (last.axis.map(number), last.zero().map(number));
    }
    model.joints.push(joint);
    model
}

#[test]
fn a_triangle_is_over_constrained_and_says_what_closes_it() {
    let triangle = |plane: [[f64; 3]; 2]| {
        let [u, v] = plane;
        let axis = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
        let at = |x: f64, y: f64| std::array::from_fn(|k| x * u[k] + y * v[k]);
        let pin = |bodies, at| Pin { bodies, at, axis };
        rigid(3, &[pin([0, 1], at(0.0, 0.0)), pin([0, 2], at(0.5, 0.0)), pin([1, 2], at(0.25, 0.5))])
    };
    for plane in [FLAT, TILTED] {
        let error = analyse(&triangle(plane)).expect_err("a structure");
        assert!(error.to_string().contains("joint `j2`"), "{error}");
        assert!(matches!(error, AssemblyError::OverConstrained { .. }));
    }
}

/// Two bars that just reach: the rows are dependent there and nowhere else, as there is nowhere else.
#[test]
fn a_stretched_triangle_is_no_mechanism() {
    let axis = [0.0, 0.0, 1.0];
    let pin = |bodies, x: f64| Pin { bodies, at: [x, 0.0, 0.0], axis };
    let stretched = rigid(3, &[pin([0, 1], 0.0), pin([0, 2], 1.0), pin([1, 2], 0.375)]);
    let error = analyse(&stretched).expect_err("a structure");
    assert!(matches!(error, AssemblyError::OverConstrained { .. }), "{error}");
}

#[test]
fn mechanisms_without_redundancy_keep_their_rows() {
    for (stem, freedom) in [("four-bar", 1), ("all-joints", 2), ("gyroscope", 3), ("gyroscope-maximal", 3)] {
        let mut model = page(stem);
        model.redundant.clear();
        let analysis = analyse(&model).expect("a mechanism");
        assert_eq!(analysis.redundant, [], "{stem}");
        assert_eq!(analysis.degrees_of_freedom, freedom, "{stem}");
        check_kept(&mut model);
    }
}

fn drive(model: &mut Model, joint: usize) {
    let at = model.assemble().expect("a start").joints[joint].position[0];
    model.joints[joint].start.position = vec![None];
    model.joints[joint].start.rate = None;
    let motion = Motion::Polynomial(vec![number(at), number(0.0), number(1.0)]);
    let coordinate = JointCoordinate { joint, coordinate: 0 };
    model.drivers.push(Driver { name: format!("drive_{joint}"), coordinate, motion });
}

#[test]
fn a_driver_takes_the_last_freedom_and_a_second_one_is_too_many() {
    let mut model = four_bar([[0.0, 0.0], [0.125, 0.25], [0.75, 0.5], [0.5, 0.0]], FLAT);
    drive(&mut model, 0);
    let analysis = analyse(&model).expect("a driven mechanism");
    assert_eq!((analysis.degrees_of_freedom, analysis.redundant.len()), (0, 3));
    drive(&mut model, 2);
    let error = analyse(&model).expect_err("two drivers");
    let AssemblyError::Driver { driver: 1, name, with } = &error else { panic!("{error}") };
    assert_eq!(name, "drive_2");
    assert!(with.contains(&"driver `drive_0`".to_owned()), "{with:?}");
}

/// A bar between two driven bodies: nothing is wrong until one of them leaves the other.
#[test]
fn driven_bodies_that_part_later_contradict_a_dropped_row() {
    let axis = [0.0, 0.0, 1.0];
    let pin = |bodies, x: f64| Pin { bodies, at: [x, 0.0, 0.0], axis };
    let page = pinned(3, &[pin([0, 1], 0.0), pin([1, 2], 0.5)]);
    let mut model = model(&page);
    let still = || Motion::Polynomial(vec![]);
    for (acceleration, is_good) in [(0.0, true), (1.0, false)] {
        // The second bar is driven where it hangs, along the bar.
        model.bodies[2].support = Support::Driven;
        model.bodies[2].position = [0.25, 0.125, 0.0625].map(number);
        let along = Motion::Polynomial(vec![number(0.0), number(0.0), number(acceleration)]);
        model.bodies[2].motion =
            Some(BodyMotion { translation: [along, still(), still()], rotations: vec![] });
        let analysis = analyse(&model);
        match (&analysis, is_good) {
            (Ok(analysis), true) => assert_eq!((analysis.rank, analysis.redundant.len()), (6, 4)),
            (Err(AssemblyError::Contradiction { owner: RowOwner::Joint(_), .. }), false) => {}
            _ => panic!("{acceleration}: {analysis:?}"),
        }
    }
}

#[test]
fn the_outcome_is_the_same_every_time() {
    let model = page("four-bar-revolute");
    assert_eq!(analyse(&model), analyse(&model.clone()));
    assert_eq!(model.assemble(), model.clone().assemble());
}

/// A row of parallelograms: bars that stand on the ground, couplers between their tips.
fn cells(n: usize) -> String {
    let bar = |name: &str| format!("[[body]]\nname = \"{name}\"\nmass = 1\ninertia = [1e-3, 0.083, 0.083]\n");
    let hinge = |name: &str, first: (&str, f64), second: (&str, f64), angle: f64| {
        let [first, second] =
            [first, second].map(|(body, x)| format!("{{ body = \"{body}\", point = [{x:?}, 0, 0] }}"));
        format!(
            "[[joint]]\nname = \"{name}\"\nkind = \"revolute\"\naxis = [0, 0, 1]\nzero = [1, 0, 0]\n\
             first = {first}\nsecond = {second}\nangle_deg = {angle:?}\nrough = true\n"
        )
    };
    let mut page = "format = 1\nname = \"cells\"\n[[body]]\nname = \"ground\"\nfixed = true\n".to_owned();
    for k in 0..=n {
        page += &bar(&format!("bar{k}"));
        page += &hinge(&format!("pivot{k}"), ("ground", k as f64), (&format!("bar{k}"), -0.5), 90.0);
    }
    for k in 0..n {
        let coupler = format!("coupler{k}");
        page += &bar(&coupler);
        for (bar, end) in [(k, -0.5), (k + 1, 0.5)] {
            page += &hinge(&format!("joint{k}_{bar}"), (&format!("bar{bar}"), 0.5), (&coupler, end), -90.0);
        }
    }
    page
}

/// Each cell loses three rows, on account of its own joints alone, however many there are: benchmark A02 of the IFToMM
/// technical committee for multibody dynamics has 40.
#[test]
fn a_row_of_parallelograms_has_one_freedom() {
    for n in [1, 2, 5, 20] {
        let model = read("cells", &cells(n)).unwrap_or_else(|mistakes| panic!("{mistakes}"));
        let found = analyse(&model).expect("it is assembled when it is read");
        assert_eq!(
            (found.redundant.len(), found.degrees_of_freedom, found.singular_start),
            (3 * n, 1, false)
        );
        assert!(
            found.redundant.iter().all(|dropped| dropped.shared_with.len() == 3),
            "{:?}",
            found.redundant
        );
    }
}
