use super::polynomial::Monomial;
use super::sums::Term;
use super::*;
use crate::expr::evaluate::{evaluate, sample};
use crate::expr::symbol::Symbol;
use gyro_model::parse_decimal;

fn operations(graph: &Graph, roots: &[ExprId]) -> usize {
    Operations::count(graph, roots).total()
}

fn variable(graph: &mut Graph, k: usize) -> ExprId {
    graph.symbol(Symbol::Input(k))
}

fn decimal(graph: &mut Graph, text: &str) -> ExprId {
    graph.rational(parse_decimal(text).expect("a decimal"))
}

fn product(graph: &mut Graph, factors: &[ExprId]) -> ExprId {
    factors.iter().fold(Graph::ONE, |product, &factor| graph.mul(product, factor))
}

fn sum(graph: &mut Graph, summands: &[ExprId]) -> ExprId {
    summands.iter().fold(Graph::ZERO, |sum, &summand| graph.add(sum, summand))
}

/// The two forms have the same values at random points.
fn check(graph: &Graph, before: &[ExprId], after: &[ExprId]) {
    for seed in 0..20 {
        let value = sample(seed);
        let pairs = evaluate(graph, before, &value).into_iter().zip(evaluate(graph, after, &value));
        for (expected, found) in pairs {
            assert!(
                (found - expected).abs() <= 1e-9 * expected.abs().max(1.0),
                "seed {seed}: {found} {expected}"
            );
        }
    }
}

/// The two forms are the same polynomials, exactly.
fn check_exactly(graph: &mut Graph, before: &[ExprId], after: &[ExprId]) {
    let pairs = before.iter().zip(after);
    let differences: Vec<_> = pairs.map(|(&before, &after)| graph.sub(before, after)).collect();
    let zeros = vec![Graph::ZERO; before.len()];
    assert_eq!(normal_form(graph, &[], &differences), zeros);
}

/// Ratios that agree to twelve digits are taken for equal in the search, never in what it finds.
#[test]
fn nearly_equal_sums_are_not_shared() {
    let mut g = Graph::new();
    let [x, y, p, q] = [0, 1, 2, 3].map(|k| variable(&mut g, k));
    let near = decimal(&mut g, "1.00000000000001");
    let terms = [[p, x, Graph::ONE], [p, y, Graph::ONE], [q, x, Graph::ONE], [q, y, near]];
    let terms = terms.map(|factors| product(&mut g, &factors));
    let roots = [g.add(terms[0], terms[1]), g.add(terms[2], terms[3])];
    let form = normal_form(&mut g, &[], &roots);
    assert_ne!(form, roots);
    check_exactly(&mut g, &roots, &form);
}

/// One angle written in two ways has one sine and one cosine: the second relation follows from the first.
#[test]
fn an_angle_in_two_forms_is_related_once() {
    let mut g = Graph::new();
    let [x, y, z] = [0, 1, 2].map(|k| variable(&mut g, k));
    let (whole, parts) = (g.add(y, z), [g.mul(x, y), g.mul(x, z)]);
    let angles = [g.mul(x, whole), g.add(parts[0], parts[1])];
    assert_ne!(angles[0], angles[1]);
    let [one, other] = angles.map(|angle| [g.sin(angle), g.cos(angle)]);
    let squares = [product(&mut g, &[one[0]; 2]), product(&mut g, &[other[1]; 2])];
    let mixed = [product(&mut g, &[one[1], one[1], y]), product(&mut g, &[other[0], other[0], y])];
    let roots = [sum(&mut g, &squares), sum(&mut g, &mixed)];
    let form = normal_form(&mut g, &[], &roots);
    check(&g, &roots, &form);
    assert_eq!(form, [Graph::ONE, y]);
}

/// Even powers of a cosine are cheaper as they are than by sines.
#[test]
fn the_cheaper_square_is_kept() {
    let mut g = Graph::new();
    let [angle, x, y] = [0, 1, 2].map(|k| variable(&mut g, k));
    let (s, c) = (g.sin(angle), g.cos(angle));
    let (sixth, second) = (product(&mut g, &[c; 6]), product(&mut g, &[c, c, x]));
    let roots = [g.mul(s, y), g.add(sixth, second)];
    let form = normal_form(&mut g, &[], &roots);
    check_exactly(&mut g, &roots, &form);
    // s y and c² (c² c² + x).
    assert_eq!(operations(&g, &form), 5);
}

#[test]
fn identities_vanish() {
    let mut g = Graph::new();
    let (x, angle) = (variable(&mut g, 0), variable(&mut g, 1));
    let (s, c) = (g.sin(angle), g.cos(angle));
    let (ss, cc) = (g.mul(s, s), g.mul(c, c));
    let one = g.add(ss, cc);
    let (scaled, inverse) = (g.mul(one, x), g.recip(one));
    let difference = g.sub(scaled, x);
    assert_eq!(normal_form(&mut g, &[], &[scaled, inverse, difference]), [x, Graph::ONE, Graph::ZERO]);
}

/// Euler parameters: the rotation matrix that they make has rows of unit length. To say it twice does no harm.
#[test]
fn a_point_of_a_sphere_is_reduced() {
    let mut g = Graph::new();
    let [e0, e1, e2, e3, x] = [0, 1, 2, 3, 4].map(|k| variable(&mut g, k));
    let (half, two) = (g.fraction(-1, 2), g.integer(2));
    let terms = [product(&mut g, &[e0, e0]), product(&mut g, &[e1, e1]), half];
    let diagonal = sum(&mut g, &terms);
    let off_diagonal = [(e1, e2, e0, e3), (e1, e3, e2, e0)].map(|(a, b, c, d)| {
        let (first, second) = (g.mul(a, b), g.mul(c, d));
        if a == e1 && b == e2 { g.sub(first, second) } else { g.add(first, second) }
    });
    let row = [diagonal, off_diagonal[0], off_diagonal[1]].map(|entry| g.mul(two, entry));
    let squares = row.map(|entry| g.mul(entry, entry));
    let length = sum(&mut g, &squares);
    let scaled = g.mul(length, x);
    let unit = [vec![e0, e1, e2, e3], vec![e3, e2, e1, e0]];
    assert_eq!(normal_form(&mut g, &unit, &[scaled]), [x]);
}

/// The paper's gyroscope: angle β, rates α̇ and β̇, and γ̇ of the wheel.
struct Gyroscope {
    s: ExprId,
    c: ExprId,
    a: ExprId,
    b: ExprId,
    rate: ExprId,
    ia: ExprId,
    ib: ExprId,
    ic: ExprId,
    j: ExprId,
    w: ExprId,
}

fn gyroscope(g: &mut Graph) -> Gyroscope {
    let [beta, a, b, rate] = [0, 1, 2, 3].map(|k| variable(g, k));
    let [ia, ib, ic, j, w] =
        ["8.00125e-6", "2e-6", "6.00125e-6", "8e-6", "1.25e-5"].map(|text| decimal(g, text));
    Gyroscope { s: g.sin(beta), c: g.cos(beta), a, b, rate, ia, ib, ic, j, w }
}

/// Its mass matrix eliminated from the last row up, every sum written out: pivot and accelerations.
fn eliminated(g: &mut Graph) -> Vec<ExprId> {
    let Gyroscope { s, c, a, b, rate, ia, ib, ic, j, w } = gyroscope(g);
    let terms = [[ia, c, c], [ib, s, s], [j, s, s]].map(|factors| product(g, &factors));
    let (h_aa, h_ag) = (sum(g, &terms), g.mul(j, s));
    let (two, minus, d) = (g.integer(2), g.integer(-1), g.sub(ia, ib));
    let d = g.sub(d, j);
    let terms = [product(g, &[two, d, c, s, a, b]), product(g, &[minus, j, c, b, rate])];
    let r_a = sum(g, &terms);
    let terms = [product(g, &[minus, d, c, s, a, a]), product(g, &[j, c, a, rate]), product(g, &[w, s])];
    let r_b = sum(g, &terms);
    let r_g = product(g, &[minus, j, a, b, c]);
    let l = g.div(h_ag, j);
    let (back, moved) = (g.mul(l, h_ag), g.mul(l, r_g));
    let (pivot, rest) = (g.sub(h_aa, back), g.sub(r_a, moved));
    let (alpha, beta) = (g.div(rest, pivot), g.div(r_b, ic));
    let moved = g.mul(h_ag, alpha);
    let rest = g.sub(r_g, moved);
    vec![pivot, alpha, beta, g.div(rest, j)]
}

/// The same as one writes it by hand.
fn by_hand(g: &mut Graph) -> Vec<ExprId> {
    let Gyroscope { s, c, a, b, rate, ia, ib, ic, j, w } = gyroscope(g);
    let terms = [[ia, c, c], [ib, s, s]].map(|factors| product(g, &factors));
    let (pivot, d, two) = (sum(g, &terms), g.sub(ia, ib), g.integer(2));
    let turned = g.mul(a, s);
    let spin = g.add(rate, turned);
    let (first, second) = (product(g, &[two, d, c, s, a, b]), product(g, &[j, c, b, spin]));
    let top = g.sub(first, second);
    let alpha = g.div(top, pivot);
    let terms = [product(g, &[d, c, s, a, a]), product(g, &[j, c, a, spin]), product(g, &[w, s])];
    let (rest, last) = (g.sub(terms[1], terms[0]), terms[2]);
    let top = g.add(rest, last);
    let beta = g.div(top, ic);
    let (first, second) = (g.mul(s, alpha), product(g, &[a, b, c]));
    let gamma = g.add(first, second);
    vec![pivot, alpha, beta, g.neg(gamma)]
}

#[test]
fn the_gyroscope_is_what_one_finds_by_hand() {
    for shape in [eliminated, by_hand] {
        let mut g = Graph::new();
        let roots = shape(&mut g);
        let form = normal_form(&mut g, &[], &roots);
        check(&g, &roots, &form);
        let (before, after) = (operations(&g, &roots), operations(&g, &form));
        println!("gyroscope: {before} -> {after}");
        // With sin² for cos² it were 22, and digits were lost in gimbal lock where the rings are light.
        assert!(after <= 25, "{before} -> {after}");
        check_exactly(&mut g, &roots, &form);
    }
}

/// Hash tables are seeded at random: what they hold must not reach the output by their order.
#[test]
fn the_form_is_the_same_each_time() {
    let written = || {
        let mut g = Graph::new();
        let roots = chain(&mut g, 2);
        let form = normal_form(&mut g, &[], &roots);
        g.reachable(&form).into_iter().map(|id| (id, g.node(id).clone())).collect::<Vec<_>>()
    };
    assert_eq!(written(), written());
}

#[test]
fn what_is_too_large_stays_as_it_is() {
    let mut g = Graph::new();
    let sums: Vec<_> = (0..20)
        .map(|k| {
            let terms = [0, 1, 2, 3].map(|i| variable(&mut g, 4 * k + i));
            sum(&mut g, &terms)
        })
        .collect();
    let root = product(&mut g, &sums);
    assert_eq!(normal_form(&mut g, &[], &[root]), [root]);
    let nothing = g.recip(Graph::ZERO);
    assert_eq!(normal_form(&mut g, &[], &[nothing]), [nothing]);
}

/// Anything that can be built keeps its values, divisions and functions included.
#[test]
fn values_are_kept() {
    let mut searched = 0;
    for seed in 0..100u64 {
        let mut g = Graph::new();
        let mut pool: Vec<_> = (0..4).map(|k| variable(&mut g, k)).collect();
        pool.extend([-2, 1, 2].map(|n| g.integer(n)));
        let five = g.integer(5);
        pool.push(g.sqrt(five));
        let mut state = seed;
        let mut next = |n: usize| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            usize::try_from(state >> 33).expect("31 bits") % n
        };
        for _ in 0..25 {
            let (a, b) = (pool[next(pool.len())], pool[next(pool.len())]);
            let built = match next(9) {
                0 | 1 => g.add(a, b),
                2 => g.sub(a, b),
                3 => g.sin(a),
                4 => g.cos(a),
                5 => {
                    // Between 2 and 4: neither zero nor without a root.
                    let (sin, three) = (g.sin(a), g.integer(3));
                    let positive = g.add(three, sin);
                    if next(2) == 0 { g.recip(positive) } else { g.sqrt(positive) }
                }
                _ => g.mul(a, b),
            };
            pool.push(built);
        }
        let roots = pool.split_off(20);
        let form = normal_form(&mut g, &[], &roots);
        assert!(operations(&g, &form) <= operations(&g, &roots), "seed {seed}");
        check(&g, &roots, &form);
        // And whether it is cheaper or not.
        let relations = relations(&mut g, &[], &roots);
        if let Some(found) = search(&g, &relations, (&roots, &[])) {
            let form = found.system.build(&mut g);
            assert_eq!(operations(&g, &form), found.cost, "seed {seed}");
            check(&g, &roots, &form);
            searched += 1;
        }
    }
    assert!(searched > 50, "{searched}");
}

type Vector = [ExprId; 3];

fn cross(g: &mut Graph, a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        let (plus, minus) = (g.mul(a[i], b[j]), g.mul(a[j], b[i]));
        g.sub(plus, minus)
    })
}

fn plus(g: &mut Graph, a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|k| g.add(a[k], b[k]))
}

fn apply(g: &mut Graph, rows: [Vector; 3], x: Vector) -> Vector {
    rows.map(|row| {
        let terms = [0, 1, 2].map(|k| g.mul(row[k], x[k]));
        sum(g, &terms)
    })
}

fn transpose(rows: [Vector; 3]) -> [Vector; 3] {
    [0, 1, 2].map(|k| [rows[0][k], rows[1][k], rows[2][k]])
}

/// A body that turns about its z axis, which stands askew in the body before it.
struct Link {
    rotation: [Vector; 3],
    offset: Vector,
    centre: Vector,
    mass: ExprId,
    inertia: [Vector; 3],
}

/// Two-digit decimals from a seed.
struct Digits(u64);

impl Digits {
    fn next(&mut self, g: &mut Graph) -> ExprId {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let hundredths = i64::try_from(self.0 >> 33).expect("31 bits") % 100;
        g.fraction(if hundredths == 0 { 7 } else { hundredths }, 100)
    }

    fn vector(&mut self, g: &mut Graph) -> Vector {
        [0, 1, 2].map(|_| self.next(g))
    }
}

fn link(g: &mut Graph, digits: &mut Digits, angle: ExprId) -> Link {
    // Two turns by angles with rational sine and cosine.
    let [s, c, t, d] = [(3, 5), (4, 5), (5, 13), (12, 13)].map(|(p, q)| g.fraction(p, q));
    let [minus_s, minus_t] = [s, t].map(|x| g.neg(x));
    let (zero, one) = (Graph::ZERO, Graph::ONE);
    let skew = [[c, minus_s, zero], [s, c, zero], [zero, zero, one]];
    let tilt = [[one, zero, zero], [zero, d, minus_t], [zero, t, d]];
    let (sin, cos) = (g.sin(angle), g.cos(angle));
    let minus_sin = g.neg(sin);
    let turn = [[cos, minus_sin, zero], [sin, cos, zero], [zero, zero, one]];
    let columns = transpose(turn).map(|column| {
        let tilted = apply(g, tilt, column);
        apply(g, skew, tilted)
    });
    let [xx, yy, zz] = digits.vector(g);
    let [xy, yz, zx] = digits.vector(g);
    Link {
        rotation: transpose(columns),
        offset: digits.vector(g),
        centre: digits.vector(g),
        mass: digits.next(g),
        inertia: [[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]],
    }
}

/// The torques that give a chain some accelerations, by the Newton-Euler recursion.
fn torques(
    g: &mut Graph,
    links: &[Link],
    rates: &[ExprId],
    accelerations: &[ExprId],
    up: Vector,
) -> Vec<ExprId> {
    let mut motion = ([Graph::ZERO; 3], [Graph::ZERO; 3], up);
    let mut loads = Vec::new();
    for (link, (&rate, &acceleration)) in links.iter().zip(rates.iter().zip(accelerations)) {
        let (omega, alpha, a) = motion;
        let here = transpose(link.rotation);
        let (tangential, whirl) = (cross(g, alpha, link.offset), cross(g, omega, link.offset));
        let (centripetal, carried) = (cross(g, omega, whirl), apply(g, here, omega));
        let a = plus(g, a, tangential);
        let a = plus(g, a, centripetal);
        let own = [Graph::ZERO, Graph::ZERO, rate];
        let (omega, gyric) = (plus(g, carried, own), cross(g, carried, own));
        let alpha = apply(g, here, alpha);
        let alpha = plus(g, alpha, gyric);
        let alpha = plus(g, alpha, [Graph::ZERO, Graph::ZERO, acceleration]);
        let a = apply(g, here, a);
        motion = (omega, alpha, a);
        let (tangential, whirl) = (cross(g, alpha, link.centre), cross(g, omega, link.centre));
        let (centripetal, spin) = (cross(g, omega, whirl), apply(g, link.inertia, omega));
        let at_centre = plus(g, a, tangential);
        let at_centre = plus(g, at_centre, centripetal);
        let force = at_centre.map(|x| g.mul(link.mass, x));
        let (direct, gyric, lever) =
            (apply(g, link.inertia, alpha), cross(g, omega, spin), cross(g, link.centre, force));
        let torque = plus(g, direct, gyric);
        loads.push((force, plus(g, torque, lever)));
    }
    let (mut force, mut torque) = ([Graph::ZERO; 3], [Graph::ZERO; 3]);
    let mut torques = Vec::new();
    for (link, &(own_force, own_torque)) in links.iter().zip(&loads).rev() {
        (force, torque) = (plus(g, force, own_force), plus(g, torque, own_torque));
        torques.push(torque[2]);
        (force, torque) = (apply(g, link.rotation, force), apply(g, link.rotation, torque));
        let lever = cross(g, link.offset, force);
        torque = plus(g, torque, lever);
    }
    torques
}

/// Mass matrix and right-hand side of a chain with skewed axes and offsets.
fn chain(g: &mut Graph, n: usize) -> Vec<ExprId> {
    let mut digits = Digits(n as u64);
    let links: Vec<_> = (0..n)
        .map(|k| {
            let angle = variable(g, k);
            link(g, &mut digits, angle)
        })
        .collect();
    let rates: Vec<_> = (n..2 * n).map(|k| variable(g, k)).collect();
    let (still, up) = (vec![Graph::ZERO; n], digits.vector(g));
    let mut roots = torques(g, &links, &rates, &still, up);
    for column in 0..n {
        let mut accelerations = still.clone();
        accelerations[column] = Graph::ONE;
        let column_torques = torques(g, &links, &still, &accelerations, [Graph::ZERO; 3]);
        roots.extend(&column_torques[..n - column]);
    }
    roots
}

/// Each sum as `x (…) + …` with its most frequent literal in front, from the roots as polynomials.
fn horner(g: &mut Graph, roots: &[ExprId]) -> usize {
    let relations = relations(g, &[], roots);
    let choice = vec![0; relations.len()];
    let Expanded { system, .. } =
        expand(g, &relations, &choice, (roots, &[]), &mut 100_000).expect("small enough");
    let mut out = Graph::new();
    let variables: Vec<_> = (0..system.literals.len()).map(|k| variable(&mut out, k)).collect();
    let built: Vec<_> = system.sums[..system.roots]
        .iter()
        .map(|terms| nested(&mut out, &system, &variables, terms))
        .collect();
    operations(&out, &built)
}

fn nested(out: &mut Graph, system: &Sums, variables: &[ExprId], terms: &[Term]) -> ExprId {
    let often = |&literal: &usize| terms.iter().filter(|term| term.monomial.exponent(literal) > 0).count();
    let Some(front) = (0..variables.len()).max_by_key(often).filter(|literal| often(literal) > 0) else {
        let constants = terms.iter().map(|term| {
            let value = system.scales.value(term.scale);
            out.constant(if term.negative { value.neg() } else { value.clone() })
        });
        let constants: Vec<_> = constants.collect();
        return sum(out, &constants);
    };
    let (mut inner, rest): (Vec<_>, Vec<_>) =
        terms.iter().cloned().partition(|term| term.monomial.exponent(front) > 0);
    for term in &mut inner {
        term.monomial = term.monomial.div(&Monomial::power(front, 1));
    }
    let inner = nested(out, system, variables, &inner);
    let factored = out.mul(variables[front], inner);
    let rest = nested(out, system, variables, &rest);
    out.add(factored, rest)
}

#[test]
fn a_chain_is_cheaper_than_by_recursion_and_by_horner() {
    for n in [1, 2, 3] {
        let mut g = Graph::new();
        let roots = chain(&mut g, n);
        let start = std::time::Instant::now();
        let form = normal_form(&mut g, &[], &roots);
        let time = start.elapsed();
        let [before, nested, after] = [operations(&g, &roots), horner(&mut g, &roots), operations(&g, &form)];
        println!("chain of {n}: {before}, by Horner {nested}, factored {after}, in {time:?}");
        check(&g, &roots, &form);
        check_exactly(&mut g, &roots, &form);
        assert!(after <= nested && (n == 1 || after < nested) && after < before, "{before} {nested} {after}");
    }
}
