//! The schema is fresh. `.ci/schema` holds it against good and bad model files.

mod keys;

use std::path::Path;

/// `UPDATE_EXPECT=1` writes it anew.
#[test]
fn the_schema_is_fresh() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("model.schema.json");
    if std::env::var_os("UPDATE_EXPECT").is_some() {
        std::fs::write(&path, keys::schema()).expect("the folder can be written to");
    }
    let committed = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(committed == keys::schema(), "UPDATE_EXPECT=1 cargo test -p gyro-schema writes it anew");
}
