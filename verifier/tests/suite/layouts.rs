//! The layout of the joint state is what a module says: right ones are proved, wrong ones are not.

use crate::support::{Page, page};
use gyro_model::{JointKind, Model, Support};
use gyro_verifier::{Depth, Report, verify};

/// The places of a tree's joint state: joints in the order of the model file, then free bodies.
pub fn places(model: &Model) -> Vec<String> {
    let mut places = Vec::new();
    for (joint, kind) in model.joints.iter().map(|joint| joint.kind).enumerate() {
        let scalars = 0..kind.coordinates().len();
        places.extend(scalars.map(|k| format!("Scalar {{ joint: {joint}, coordinate: {k} }}")));
        if matches!(kind, JointKind::Spherical | JointKind::PointOnLine) {
            places.push(format!("Orientation {{ joint: {joint} }}"));
        }
    }
    for (moving_body, body) in model.coordinate_bodies().into_iter().enumerate() {
        if model.bodies[body].support == Support::Free {
            places.push(format!("Body {{ body: {moving_body} }}"));
        }
    }
    places.into_iter().map(|place| format!("gyro_sim::JointPlace::{place}")).collect()
}

/// A tree's module that says where its joint coordinates stand, with what follows its places.
pub fn stated(page: &Page, places: &[String], closure_rows: &str) -> String {
    let layout = format!(
        "fn joint_layout(&self) -> &gyro_sim::JointLayout<'_> {{
            const LAYOUT: gyro_sim::JointLayout<'static> = gyro_sim::JointLayout {{
                places: &[{}],
                closure_rows: &[{closure_rows}],
            }};
            &LAYOUT
        }}",
        places.join(", ")
    );
    let code = match page.code.split_once("fn joint_layout") {
        Some((head, rest)) => {
            let (_, rest) = rest.split_once("&LAYOUT\n    }\n").expect("the end of the function");
            format!("{head}{layout}\n{rest}")
        }
        None => page.code.replacen("fn joint_buffers", &format!("{layout} fn joint_buffers"), 1),
    };
    if code.contains("type Closure") {
        return code;
    }
    let code = code.replacen("type Jacobian", "type Closure = [T; 0]; type Jacobian", 1);
    let (head, buffers) = code.split_once("JointBuffers {").expect("buffers");
    format!("{head}JointBuffers {{{}", buffers.replacen("jacobian:", "closure: [], jacobian:", 1))
}

fn report(page: &Page, places: &[String], closure_rows: &str) -> Report {
    verify(&page.model, &stated(page, places, closure_rows), &page.constants, Depth::Quick)
}

#[test]
fn trees_are_proved_for_the_layout_that_they_state() {
    for name in ["torsion", "free-body", "spinning-top", "point-on-line"] {
        let page = page(name);
        let report = report(&page, &places(&page.model), "");
        assert!(report.is_proved(), "{name}: {report}");
    }
}

#[test]
fn wrong_layouts_are_refused() {
    for name in ["torsion", "point-on-line"] {
        let page = page(name);
        let right = places(&page.model);
        let mut wrong = vec![(right[1..].to_vec(), "", "a place is missing")];
        wrong.push(([&right[..1], &right].concat(), "", "a place is there twice"));
        wrong.push((right.clone(), "0", "a row that the coordinates satisfy"));
        wrong.push((right.clone(), "9999", "a row that does not exist"));
        wrong.push((right[1..].to_vec(), "0", "a place is missing, and a row"));
        if right.len() > 1 {
            let mut swapped = right.clone();
            swapped.swap(0, 1);
            wrong.push((swapped, "", "another order"));
        }
        let last = page.model.joints.len();
        for place in [
            format!("Scalar {{ joint: {last}, coordinate: 0 }}"),
            "Scalar { joint: 0, coordinate: 9 }".to_owned(),
            format!("Orientation {{ joint: {last} }}"),
            "Body { body: 99 }".to_owned(),
        ] {
            let mut other = right.clone();
            other[0] = format!("gyro_sim::JointPlace::{place}");
            wrong.push((other, "", "a place that does not exist"));
        }
        for (places, closure_rows, what) in wrong {
            let report = report(&page, &places, closure_rows);
            assert!(report.is_refuted() && !report.is_right(), "{name}, {what}: {report}");
        }
    }
}
