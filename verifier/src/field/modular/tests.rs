use super::*;
use chacha20::ChaCha8Rng;
use num_traits::{One, ToPrimitive};
use rand::SeedableRng;

/// Compares every operation with the same one of integers of any size.
fn check<const L: usize>(prime: &Prime<L>) {
    let mut random = ChaCha8Rng::seed_from_u64(3);
    let p = prime.value();
    let largest = Modular::new(prime, &BigInt::from(-1));
    for _ in 0..50 {
        let (a, b) = (prime.draw(&mut random), prime.draw(&mut random));
        for (a, b) in [(a, b), (a, largest), (largest, largest)] {
            let residue = |x: Modular<L>| x.residue().expect("defined");
            let (x, y) = (residue(a), residue(b));
            assert_eq!(residue(a.add(&b)), (&x + &y) % p);
            assert_eq!(residue(a.sub(&b)), (&x + p - &y) % p);
            assert_eq!(residue(a.mul(&b)), (&x * &y) % p);
            assert_eq!(residue(a.neg()), (p - &x) % p);
            assert!(residue(a.inv().expect("not zero").mul(&a)).is_one());
        }
        let square = a.mul(&a);
        assert_eq!(square.sqrt().expect("a square").mul(&square.sqrt().expect("a square")), square);
    }
}

#[test]
fn arithmetic_is_that_of_integers() {
    check(&Prime::<9>::mersenne());
    let mut random = ChaCha8Rng::seed_from_u64(4);
    check(&Prime::<9>::with_roots(&BigUint::from(15_u32), &mut random).expect("room"));
    check(&Prime::<18>::with_roots(&BigUint::one(), &mut random).expect("room"));
}

#[test]
fn roots_are_positive_and_multiply() {
    let mut random = ChaCha8Rng::seed_from_u64(5);
    let prime = Prime::<9>::with_roots(&BigUint::from(2_u32 * 3 * 7), &mut random).expect("room");
    let root = |n: i64| Modular::sqrt_rational(&prime, &Rational::new(n.into(), 3.into()));
    assert_eq!(root(27).residue().and_then(|n| n.to_u32()), Some(3));
    assert_eq!(root(12).residue().and_then(|n| n.to_u32()), Some(2));
    assert_eq!(root(6).mul(&root(14)), root(7).mul(&root(12)));
    assert!(prime.missed().is_empty());
    assert_ne!(root(5), root(5), "five was not asked for");
    assert_eq!(prime.missed(), [Rational::new(5.into(), 3.into())]);
}

#[test]
fn small_fractions_are_found_and_drawn_numbers_are_none() {
    let mut random = ChaCha8Rng::seed_from_u64(6);
    let prime = Prime::<9>::mersenne();
    let large: BigInt = BigInt::from(10).pow(41) + 3;
    for numerator in [0, 1, -1, 22, -355] {
        for denominator in [1, 7, 113] {
            for factor in [BigInt::from(1), large.clone()] {
                let fraction = Rational::new(&factor * numerator, denominator.into());
                assert_eq!(Modular::from_rational(&prime, &fraction).small_fraction(), Some(fraction));
            }
        }
    }
    for _ in 0..50 {
        assert_eq!(prime.draw(&mut random).small_fraction(), None);
    }
    assert_eq!(Modular::undefined(&prime).small_fraction(), None);
}

#[test]
fn what_is_undefined_equals_nothing() {
    let prime = Prime::<9>::mersenne();
    let divisor = BigInt::from(prime.value().clone());
    let undefined = Modular::from_rational(&prime, &Rational::new_raw(1.into(), divisor));
    let zero = Modular::zero(&prime);
    assert_ne!(undefined, undefined);
    assert_ne!(undefined.mul(&zero), zero);
    assert!(!undefined.sub(&undefined).is_zero());
    assert_eq!(zero.inv(), None);
}
