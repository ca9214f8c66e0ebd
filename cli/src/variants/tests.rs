use super::*;
use crate::files;

fn words(page: &str) -> Vec<String> {
    let model = crate::scene::read(&files::root().join(page)).unwrap();
    let variants = variants(&model);
    assert!(variants.iter().all(|variant| variant.model.is_ok()), "{page}");
    variants.into_iter().map(|variant| variant.what).collect()
}

#[test]
fn every_element_has_its_variant() {
    let of_viscous = words("models/gyroscope-viscous.toml");
    for what in [
        "without gravity",
        "without the friction of `alpha`",
        "without the offset of `phi` on `inner_ring`",
        "with free masses and inertias",
        "with a free geometry",
        "with a free geometry, zeros too",
    ] {
        assert!(of_viscous.iter().any(|known| known == what), "{what}: {of_viscous:?}");
    }
    let of_driven = words("models/driven-gyroscope.toml");
    assert!(of_driven.iter().any(|what| what.ends_with("fixed")), "{of_driven:?}");
}

#[test]
fn a_linkage_without_an_arm_cannot_be_assembled() {
    let model = crate::scene::read(&files::root().join("models/four-bar.toml")).unwrap();
    assert!(variants(&model).iter().any(|variant| variant.model.is_err()));
}

/// Every variant of models whose formulas see outputs and states is generated.
#[test]
fn what_formulas_see_stays() {
    let functions = gyro_codegen::Functions::named(["joint"]).unwrap();
    for page in ["dc_motor", "crane", "bushed_four_bar"] {
        let path = files::root().join(format!("examples/laws/{page}.toml"));
        let variants = variants(&crate::scene::read(&path).unwrap());
        assert!(variants.iter().any(|variant| variant.what.starts_with("without force")), "{page}");
        let is_mechanics = |variant: &Variant| variant.what == "with an input in place of each formula";
        assert_eq!(variants.iter().any(is_mechanics), page != "bushed_four_bar", "{page}");
        for Variant { what, model } in variants {
            let Ok(model) = model else { continue };
            let scheduled = gyro_codegen::schedule(&model, &functions, gyro_codegen::Effort::Quick);
            assert!(scheduled.is_ok() || model.assemble().is_err(), "{page} {what}");
        }
    }
}
