use super::*;

#[test]
fn names_are_read_back() {
    for integrator in Integrator::ALL {
        assert_eq!(integrator.name().parse(), Ok(*integrator));
    }
    for correction in [
        Correction::Partition,
        Correction::ClosedForm,
        Correction::MassWeighted,
        Correction::Baumgarte(12.5),
        Correction::None,
    ] {
        assert_eq!(correction.to_string().parse(), Ok(correction));
    }
    for when in [When::Steps(5), When::Violation(1e-9)] {
        assert_eq!(when.to_string().parse(), Ok(when));
    }
    for nonsense in ["", "baumgarte", "baumgarte=-1", "baumgarte=inf", "Partition"] {
        assert_eq!(nonsense.parse::<Correction>(), Err(()));
    }
    for nonsense in ["steps=0", "violation=nan", "steps", "5"] {
        assert_eq!(nonsense.parse::<When>(), Err(()));
    }
}
