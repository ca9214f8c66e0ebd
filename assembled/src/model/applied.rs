//! The applied forces of all bodies, paper, eqs. (21) and (22).

use crate::model::lowered::Lowered;
use crate::model::place::{Moment, Place};
use crate::number::Number;

impl<T: Number> Lowered<T> {
    /// Writes `(f, n' − w̃'J'w')`, body after body, with what armatures take while no body accelerates.
    pub(crate) fn applied_force(&self, at: Moment<'_, T>, out: &mut [T]) {
        for (moving_body, (body, out)) in self.scene.bodies.iter().zip(out.as_chunks_mut::<6>().0).enumerate()
        {
            let w = self.scene.w(at.y, moving_body);
            out[..3].copy_from_slice((self.scene.gravity * body.mass).as_slice());
            out[3..].copy_from_slice((-w.cross(&(body.inertia * w))).as_slice());
        }
        self.add_page_force(at, out);
        self.biases_of_rotors(at, |moving_body, wrench| {
            let out = &mut out[6 * moving_body..6 * moving_body + 6];
            let wrench = wrench.force.iter().chain(wrench.torque.iter());
            out.iter_mut().zip(wrench).for_each(|(out, value)| *out += *value);
        });
    }

    /// Adds what friction and the model file's forces exert: `(f, n')`, body after body.
    pub(crate) fn add_page_force(&self, at: Moment<'_, T>, out: &mut [T]) {
        for element in &self.elements {
            element.exert(&self.scene, at, |place, _, wrench| {
                if let Place::Slot(moving_body) = place {
                    let out = &mut out[6 * moving_body..6 * moving_body + 6];
                    let wrench = wrench.force.iter().chain(wrench.torque.iter());
                    out.iter_mut().zip(wrench).for_each(|(out, value)| *out += *value);
                }
            });
        }
    }
}
