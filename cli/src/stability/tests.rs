use super::*;

/// Whatever the configuration.
const MEDIAN: f64 = 3e-15;

/// The worst in terms of the dense form's.
const WORST: f64 = 2.0;

#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn no_kind_of_configuration_takes_the_digits_of_the_kernels() {
    for model in models(&[]).unwrap() {
        check(&Subject::new(&model).unwrap());
    }
}

/// Of modules with numbers, whose joint dynamics are in joint frames and from base inertial parameters.
#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn joint_frames_and_base_parameters_take_no_digits() {
    let chain = models(&[]).unwrap().pop().unwrap();
    let subject = Subject::new(&chain).unwrap();
    let mut n_in_frames = 0;
    for (place, (_, words)) in KINDS.into_iter().enumerate().step_by(3) {
        for folded in subject.folded_errors(&chain, place, 1) {
            assert!(folded.own <= MEDIAN.max(WORST * folded.dense), "{words}: {:e}", folded.own);
            n_in_frames += usize::from(folded.is_in_joint_frames);
        }
    }
    assert!(n_in_frames >= 2, "{n_in_frames}");
}

fn check(subject: &Subject) {
    for (place, (kind, words)) in KINDS.into_iter().enumerate() {
        let errors = subject.errors(place, 24);
        assert!(errors.len() >= 20, "{words}: {}", errors.len());
        let dense = Column::of(errors.iter().map(|(_, dense)| *dense).collect());
        for (k, kernel) in KERNELS.iter().enumerate() {
            let column = Column::of(errors.iter().map(|(own, _)| own[k]).collect());
            let words = format!("{}, {words}, {kernel}: {column}, dense {dense}", subject.model.name);
            assert_eq!(column.failures, 0, "{words}");
            // In gimbal lock with light rings half the digits are a maximal state's own to lose.
            let is_lost = kind == Kind::GimbalLock && *kernel != "joint_accelerations";
            // The multipliers follow from accelerations that are right in terms of the largest.
            let is_balance = kind == Kind::Everything && *kernel == "corrected_solution";
            let allowed = if is_lost || is_balance { MEDIAN.max(WORST * dense.median) } else { MEDIAN };
            assert!(column.median <= allowed, "{words}");
            if kind != Kind::Everything {
                assert!(column.worst <= WORST * dense.worst, "{words}");
            }
        }
    }
}
