use super::*;
use rand::SeedableRng;

#[test]
fn atoms_satisfy_what_the_functions_do() {
    let prime = Prime::<9>::mersenne();
    let atoms = Drawn::new(&prime, ChaCha8Rng::seed_from_u64(1));
    let one = Modular::one(&prime);
    for x in [prime.draw(&mut ChaCha8Rng::seed_from_u64(2)), one, Modular::integer(&prime, -7)] {
        let (sin, cos) = (atoms.sin(&x), atoms.cos(&x));
        assert_eq!(sin.mul(&sin).add(&cos.mul(&cos)), one);
        assert_eq!(atoms.sin(&x.neg()), sin.neg());
        assert_eq!(atoms.cos(&x.neg()), cos);
        let one_half = Modular::integer(&prime, 2).inv().expect("two is not zero");
        let half = x.mul(&one_half);
        // However a family of angles is met, from its smallest, its largest or between.
        let (quarter, four) = (half.mul(&one_half), twice(twice((cos, sin))));
        assert_eq!(twice(twice((atoms.cos(&quarter), atoms.sin(&quarter)))), (cos, sin));
        let fourfold = x.add(&x).add(&x).add(&x);
        assert_eq!((atoms.cos(&fourfold), atoms.sin(&fourfold)), four);
        // What is met later, far from it, changes none of it.
        let sixteenfold = fourfold.add(&fourfold).add(&fourfold).add(&fourfold);
        assert_eq!((atoms.cos(&sixteenfold), atoms.sin(&sixteenfold)), twice(twice(four)));
        assert_eq!((atoms.cos(&x), atoms.sin(&x)), (cos, sin));
        for (angle, (cos, sin)) in
            [(x.add(&x), twice((cos, sin))), (x, twice((atoms.cos(&half), atoms.sin(&half))))]
        {
            assert_eq!((atoms.cos(&angle), atoms.sin(&angle)), (cos, sin));
        }
        assert_eq!(atoms.tanh(&x.neg()), atoms.tanh(&x).neg());
        assert_eq!(atoms.atan2(&x.neg(), &one), atoms.atan2(&x, &one).neg());
        assert_ne!(atoms.atan2(&x, &one), atoms.atan2(&x, &one.neg()));
        assert!(atoms.atan2(&x.sub(&x), &x).is_zero());
        assert_ne!(atoms.tanh(&x), sin);
        let (exp, minus) = (atoms.exp(&x), x.neg());
        assert_eq!(exp.mul(&atoms.exp(&minus)), one);
        assert_eq!(atoms.exp(&x.sub(&x)), one);
        assert_ne!(exp, atoms.exp(&x.add(&x)));
        assert_eq!(atoms.abs(&minus), atoms.abs(&x));
        assert_eq!([atoms.ln(&x), atoms.floor(&x)], [atoms.ln(&x), atoms.floor(&x)]);
        // A choice is linear in what is chosen; it and its opposite are the whole.
        let (when, unless) = (atoms.when(&x, &exp), atoms.unless(&x, &exp));
        assert_eq!(when.add(&unless), exp);
        assert_eq!(atoms.when(&x, &exp.add(&x)), when.add(&atoms.when(&x, &x)));
        let square = x.mul(&x);
        assert_eq!(atoms.sqrt(&square).mul(&atoms.sqrt(&square)), square);
    }
    assert!(!atoms.missed_root());
    atoms.sqrt(&one.neg());
    assert!(atoms.missed_root(), "−1 is no square modulo a prime that is 3 modulo 4");
}

#[test]
fn what_is_drawn_is_told_apart_and_small_fractions_are_known() {
    let prime = Prime::<9>::mersenne();
    let atoms = Drawn::new(&prime, ChaCha8Rng::seed_from_u64(1));
    let x = prime.draw(&mut ChaCha8Rng::seed_from_u64(2));
    let functions =
        [Function::Exp, Function::Ln, Function::Abs, Function::Floor, Function::When, Function::Unless];
    let values = functions.map(|function| atoms.call(function, [&x, &x]));
    for (n, value) in values.iter().enumerate() {
        assert!(!values[..n].contains(value) && *value != x, "{:?}", functions[n]);
    }
    // Of a condition and its opposite both may be true of neither.
    assert_ne!(atoms.when(&x, &x), atoms.unless(&x.neg(), &x));
    assert_ne!(atoms.floor(&x.neg()), atoms.floor(&x).neg());
    let fraction = |n: i64, d: i64| Modular::from_rational(&prime, &Rational::new(n.into(), d.into()));
    let zero = Modular::zero(&prime);
    for (at, size, whole) in
        [(fraction(7, 2), fraction(7, 2), 3), (fraction(-7, 3), fraction(7, 3), -3), (zero, zero, 0)]
    {
        assert_eq!(atoms.abs(&at), size);
        assert_eq!(atoms.floor(&at), Modular::integer(&prime, whole));
        let (taken, left) = if whole > 0 { (x, zero) } else { (zero, x) };
        assert_eq!([atoms.when(&at, &x), atoms.unless(&at, &x)], [taken, left]);
    }
    let undefined = Modular::undefined(&prime);
    for function in functions {
        let value = atoms.call(function, [&undefined, &x]);
        assert_ne!(value, value, "{function:?}");
    }
}

#[test]
fn curves_are_told_apart_by_table_and_time() {
    let prime = Prime::<9>::mersenne();
    let atoms = Drawn::new(&prime, ChaCha8Rng::seed_from_u64(1));
    let table = |height| Spline::natural(String::new(), &[(0.0, 0.0), (1.0, height)]).expect("a good table");
    let t = Modular::integer(&prime, 3);
    assert_eq!(atoms.spline(&table(1.0), &t), atoms.spline(&table(1.0), &t));
    assert_ne!(atoms.spline(&table(1.0), &t), atoms.spline(&table(2.0), &t));
    assert_ne!(atoms.spline(&table(1.0), &t), atoms.spline(&table(1.0), &t.neg()));
}
