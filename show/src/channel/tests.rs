use super::*;

/// What the page does.
fn unpack(channel: &Channel, n: usize, bytes: &[u8]) -> Vec<f64> {
    let mut numbers = vec![0_i32; n];
    for (k, number) in numbers.iter_mut().enumerate() {
        let planes = 0..usize::from(channel.planes);
        let folded = planes.fold(0, |all, plane| all | u32::from(bytes[plane * n + k]) << (8 * plane));
        *number = (folded >> 1).cast_signed() ^ -(folded & 1).cast_signed();
    }
    for _ in 0..channel.order {
        for k in 1..n {
            numbers[k] = numbers[k].wrapping_add(numbers[k - 1]);
        }
    }
    let value = |k: &i32| if *k == NONE { f64::NAN } else { channel.base + channel.step * f64::from(*k) };
    let value = |k: &i32| if channel.step == 0.0 { channel.base } else { value(k) };
    numbers.iter().map(value).map(|v| if channel.log { v.exp2() } else { v }).collect()
}

fn error(values: &[f64], rounding: Rounding) -> (f64, usize) {
    let mut bytes = Vec::new();
    let channel = pack(values, rounding, &mut bytes);
    let again = unpack(&channel, values.len(), &bytes);
    let worst = values.iter().zip(&again).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    (worst, bytes.len())
}

#[test]
fn values_come_back_to_half_a_step() {
    let wave: Vec<f64> = (0..1000).map(|k| (f64::from(k) * 0.1).sin()).collect();
    let jumps: Vec<f64> = (0..1000).map(|k| f64::from(k * 7919 % 1000)).collect();
    let huge: Vec<f64> = [-1.0, 1.0, 0.3].map(|x| x * 8e307).to_vec();
    for (values, range) in [(&wave, 2.0), (&jumps, 1000.0), (&huge, 1.6e308)] {
        for bits in [12, 16, 24, 30] {
            // What jumps is rounded as noise is.
            let kept = if values == &wave { bits } else { bits.min(NOISE.0) };
            let (worst, _) = error(values, Rounding::Bits(bits));
            assert!(worst <= 0.7 * range / 2_f64.powi(i32::from(kept)), "{bits}: {worst}");
        }
    }
}

#[test]
fn smooth_motion_takes_less_than_a_byte() {
    let wave: Vec<f64> = (0..10_000).map(|k| (f64::from(k) * 0.1).sin()).collect();
    let mut bytes = Vec::new();
    pack(&wave, Rounding::Bits(22), &mut bytes);
    let packed = crate::page::deflate(&bytes).len();
    assert!(packed < 10_000, "{packed}");
    assert_eq!(error(&[0.125; 10_000], Rounding::Bits(22)), (0.0, 0));
}

#[test]
fn whole_numbers_stay_what_they_are() {
    let indices: Vec<f64> = (0..3000_u32).map(|k| f64::from(k * 7919 % 100_003)).collect();
    assert_eq!(error(&indices, Rounding::Whole).0, 0.0);
}

#[test]
fn what_is_no_number_stays_so() {
    let values = [1.0, f64::NAN, 2.0, f64::INFINITY];
    let mut bytes = Vec::new();
    let channel = pack(&values, Rounding::Bits(22), &mut bytes);
    let again = unpack(&channel, 4, &bytes);
    assert!((again[0] - 1.0).abs() < 1e-6 && again[1].is_nan() && again[3].is_nan(), "{again:?}");
}

#[test]
fn logarithms_keep_a_part_of_each_value() {
    let values: Vec<f64> = (0..300).map(|k| 10_f64.powi(k % 17 - 16)).collect();
    let mut bytes = Vec::new();
    let channel = pack(&values, Rounding::Octaves, &mut bytes);
    for (a, b) in values.iter().zip(unpack(&channel, 300, &bytes)) {
        assert!((b / a - 1.0).abs() < 0.023, "{a} {b}");
    }
}
