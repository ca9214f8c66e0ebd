use super::*;

fn block() -> Block {
    let errors = vec![(0, "at t = 1 s".to_owned()), (2, "é".to_owned())];
    Block { first: 1 << 40, count: 3, numbers: vec![0.1, -0.0, 5e-324, f64::MAX, 1.0, 2.0], errors }
}

#[test]
fn blocks_come_back() {
    let bytes = block().encode();
    assert_eq!(Block::decode(&bytes, 2).unwrap(), block());
    let rows: Vec<_> = block().rows().map(|(k, n, e)| (k, n.to_vec(), e.map(str::to_owned))).collect();
    assert_eq!(rows[1], ((1 << 40) + 1, vec![5e-324, f64::MAX], None));
    assert_eq!(rows[2], ((1 << 40) + 2, vec![1.0, 2.0], Some("é".to_owned())));
    let file = [bytes.clone(), bytes.clone()].concat();
    let mut input = &file[..];
    assert_eq!(next(&mut input).unwrap().as_ref(), Some(&bytes));
    assert_eq!(next(&mut input).unwrap().as_ref(), Some(&bytes));
    assert!(next(&mut input).unwrap().is_none());
}

#[test]
fn no_changed_byte_and_no_cut_goes_unnoticed() {
    let bytes = block().encode();
    for at in 0..bytes.len() {
        let mut changed = bytes.clone();
        changed[at] ^= 0x10;
        assert!(Block::decode(&changed, 2).is_err(), "{at}");
        assert!(next(&mut &changed[..]).is_err(), "{at}");
        assert!(at == 0 || next(&mut &bytes[..at]).is_err(), "{at}");
    }
}
