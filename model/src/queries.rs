//! What can be asked of a model: units, rows, sizes, and the model with other parameters.

use crate::redundancy::analyse_with_start;
use crate::{
    BodyFrame, BodyMotion, CoordinateKind, CoordinateUse, Coupler, ForceKind, Formula, JointCoordinate,
    JointKind, Lines, Model, Motion, Number, Parameter, PointAxes, Rational, RedundantRow, Row, RowOwner,
    RowUnit, Seen, Start, Support, Tree, to_f64,
};
use std::ops::Range;

impl Support {
    /// Whether the body has coordinates of its own.
    pub fn has_coordinates(self) -> bool {
        !matches!(self, Self::Fixed | Self::Driven)
    }
}

impl Model {
    /// Whether anything is hit, sticks or slides: contacts that are rigid.
    pub fn has_rigid_contacts(&self) -> bool {
        !self.contacts.is_empty() || !self.touching.is_empty()
    }

    /// The curves that equations and outputs call, by their places, each once.
    pub fn curves_of_equations(&self) -> Vec<usize> {
        let of_forces = self.forces.iter().flat_map(|force| force.kind.parts().numbers);
        let of_forces = of_forces.flat_map(|(_, numbers)| numbers).filter_map(Number::formula);
        let of_couplers = self.couplers.iter().filter_map(|coupler| coupler.by.formula());
        let of_bodies = self.bodies.iter().filter_map(|body| body.motion.as_ref());
        let motions =
            of_bodies.flat_map(BodyMotion::parts).chain(self.drivers.iter().map(|driver| &driver.motion));
        let of_outputs = self.outputs.iter().filter_map(|output| output.kind.formula());
        let formulas =
            of_forces.chain(of_couplers).chain(motions.flat_map(Motion::formulas)).chain(of_outputs);
        let mut curves: Vec<usize> = formulas.flat_map(Formula::curves).collect();
        curves.sort_unstable();
        curves.dedup();
        curves
    }

    /// The value of a number of the model file with the model's parameters as they are; 0 where it divides by zero,
    /// which neither the model file nor parameters that are set may do.
    pub fn exact(&self, number: &Number) -> Rational {
        self.defined(number).unwrap_or_default()
    }

    /// The same; `None` where it divides by zero.
    pub(crate) fn defined(&self, number: &Number) -> Option<Rational> {
        let values = |parameters: &[Parameter], index: usize| parameters[index].value.clone();
        number.evaluate(&|index| values(&self.parameters, index), &|index| values(&self.inputs, index))
    }

    /// The same, rounded to the nearest `f64`.
    pub fn value(&self, number: &Number) -> f64 {
        to_f64(&self.exact(number))
    }

    /// A vector of numbers, rounded.
    pub fn values<const N: usize>(&self, numbers: &[Number; N]) -> [f64; N] {
        std::array::from_fn(|k| self.value(&numbers[k]))
    }

    /// Indices of the bodies that have coordinates, in the order of the model file: moving body `s` of the generalised
    /// coordinates is body `coordinate_bodies()[s]`, with `q[7s..7s + 7] = (r, p)` and velocities `v[6s..6s + 6] = (s,
    /// w')`.
    pub fn coordinate_bodies(&self) -> Vec<usize> {
        (0..self.bodies.len()).filter(|&b| self.bodies[b].support.has_coordinates()).collect()
    }

    /// The constraint rows in their order, paper eq. (11), redundant ones left out, without the Euler-parameter
    /// normalisations (which follow, one for each coordinate body): constrained bodies, joints, couplers, drivers.
    ///
    /// A constrained body has three position rows `r - r0` and three orientation rows, the vector part of `p0* p`. With
    /// (f, g, h) the joint frame on a body (unit zero direction, `g = h × f`, unit axis) and `d` from the first body's
    /// joint point to the second's, both in the global frame, joints have
    /// - revolute, spherical, fixed, universal: `d` (three components along [`Model::point_axes`], eq. (7)); then
    ///   `f_i·h_j`, `g_i·h_j` (revolute, fixed; eqs. (9), (10)), `f_i·g_j` (fixed), `h_i·h_j` (universal);
    /// - cylindrical, prismatic, screw: `f_i·d`, `g_i·d`; `h_i·d − lead · angle` (screw); `f_i·h_j`, `g_i·h_j`;
    ///   `f_i·g_j` (prismatic);
    /// - planar: `h_i·d`, `f_i·h_j`, `g_i·h_j`;
    /// - point on line: `f_i·d`, `g_i·d`;
    /// - rod: `½ (d·d / length − length)`.
    ///
    /// A coupler has its second coordinate less what that is to be, a constraint its formula, a driver `coordinate −
    /// motion(t)`. The unit of a constraint counts as a length if it names a displacement.
    pub fn rows(&self) -> Vec<Row> {
        let all = self.all_rows();
        all.into_iter().filter(|row| !self.dropped().any(|dropped| dropped.row == *row)).collect()
    }

    /// The redundant rows that are not there.
    pub fn dropped(&self) -> impl Iterator<Item = &RedundantRow> {
        self.redundant.iter().filter(|row| !row.stays)
    }

    /// Rows of which some always depend on the others, but not always the same ones: sets of places among
    /// [`Model::rows`], of all rows of owners that share a dependency and are not of the trees.
    pub fn dependent_rows(&self) -> Vec<Vec<usize>> {
        let mut sets: Vec<Vec<RowOwner>> = Vec::new();
        for redundant in self.redundant.iter().filter(|row| row.stays) {
            let mut owners = vec![redundant.row.owner];
            owners.extend(&redundant.shared_with);
            let (joined, apart) =
                sets.into_iter().partition(|set: &Vec<_>| set.iter().any(|owner| owners.contains(owner)));
            let joined: Vec<Vec<_>> = joined;
            owners.extend(joined.into_iter().flatten());
            sets = apart;
            sets.push(owners);
        }
        let tree = Tree::of_coordinates(self);
        let closes = |owner: RowOwner| match owner {
            RowOwner::Joint(joint) => tree.loop_joints.contains(&joint),
            RowOwner::Body(_) | RowOwner::Driver(_) | RowOwner::Coupler(_) => false,
        };
        let rows = self.rows();
        let of = |set: Vec<RowOwner>| {
            let own = |place: &usize| closes(rows[*place].owner) && set.contains(&rows[*place].owner);
            (0..rows.len()).filter(own).collect()
        };
        sets.into_iter().map(of).collect()
    }

    /// Powers of two that are near the mechanism's size, m, and mass, kg: units in which dependent rows are compared.
    pub fn units_of_dependence(&self) -> [i32; 2] {
        let masses = self.coordinate_bodies().into_iter().map(|body| self.value(&self.bodies[body].mass));
        let mass: f64 = masses.sum();
        [self.size(), mass].map(|unit| if unit > 0.0 { unit.log2().round() as i32 } else { 0 })
    }

    /// Along which axes the rows of a joint compare its points: global ones, unless the joint loses some of these rows
    /// and which ones depends on how its bodies have turned in space, but not as its first body sees it.
    pub fn point_axes(&self, joint: usize) -> PointAxes {
        let own = |dropped: &&RedundantRow| dropped.row.owner == RowOwner::Joint(joint);
        self.redundant.iter().find(own).map_or(PointAxes::Global, |dropped| dropped.axes)
    }

    /// The same with the redundant rows.
    pub fn all_rows(&self) -> Vec<Row> {
        use RowUnit::{Length, Pure};
        let mut rows = Vec::new();
        let mut own = |owner, units: &[RowUnit]| {
            rows.extend(units.iter().enumerate().map(|(index, &unit)| Row { owner, index, unit }));
        };
        for (index, body) in self.bodies.iter().enumerate() {
            if body.support == Support::Constrained {
                own(RowOwner::Body(index), &[Length, Length, Length, Pure, Pure, Pure]);
            }
        }
        for (index, joint) in self.joints.iter().enumerate() {
            own(RowOwner::Joint(index), joint.kind.row_units());
        }
        for (index, coupler) in self.couplers.iter().enumerate() {
            let lengths = || coupler.coordinates().into_iter().any(|on| !self.coordinate_kind(on).is_angle());
            let is_length = |seen: Seen| match seen {
                Seen::Output { output, number } => {
                    self.outputs[output].kind.columns()[number].1.starts_with('m')
                }
                _ => false,
            };
            let sees = || coupler.by.formula().into_iter().flat_map(Formula::sees).any(is_length);
            let constraint = || if lengths() || sees() { Length } else { Pure };
            own(
                RowOwner::Coupler(index),
                &[coupler.second.map_or_else(constraint, |on| self.coordinate_unit(on))],
            );
        }
        for (index, driver) in self.drivers.iter().enumerate() {
            own(RowOwner::Driver(index), &[self.coordinate_unit(driver.coordinate)]);
        }
        rows
    }

    /// What a joint coordinate is.
    pub fn coordinate_kind(&self, coordinate: JointCoordinate) -> CoordinateKind {
        self.joints[coordinate.joint].kind.coordinates()[coordinate.coordinate]
    }

    /// What forces, couplers and drivers ask of a joint's coordinates.
    pub fn use_of_coordinates(&self, joint: usize) -> CoordinateUse {
        let forces = self.forces.iter().filter_map(|force| force.kind.parts().on);
        let forces = forces.chain(self.uses_of_formulas());
        let couplers = self.couplers.iter().flat_map(Coupler::coordinates);
        let prescribed = couplers.chain(self.drivers.iter().map(|driver| driver.coordinate));
        let stopped = self.contacts.iter().map(|contact| (contact.on, CoordinateUse::Value));
        let forces = forces.chain(stopped);
        let uses = forces.chain(prescribed.map(|on| (on, CoordinateUse::Prescribed)));
        let of_joint = uses.filter(|(on, _)| on.joint == joint).map(|(_, of)| of);
        let joint = &self.joints[joint];
        let own = [(&joint.damping, CoordinateUse::Rate), (&joint.armature, CoordinateUse::Value)];
        let own = own.into_iter().filter(|(number, _)| !number.is_zero()).map(|(_, of)| of);
        of_joint.chain(own).max().unwrap_or_default()
    }

    fn coordinate_unit(&self, coordinate: JointCoordinate) -> RowUnit {
        if self.coordinate_kind(coordinate).is_angle() { RowUnit::Pure } else { RowUnit::Length }
    }

    /// The formulas of forces, states and outputs: those that are part of the equations.
    pub fn laws(&self) -> impl Iterator<Item = &Formula> {
        let numbers = self.forces.iter().flat_map(|force| force.kind.parts().numbers);
        let forces = numbers.flat_map(|(_, numbers)| numbers).filter_map(Number::formula);
        let outputs = self.outputs.iter().filter_map(|output| output.kind.formula());
        forces.chain(outputs).chain(self.states.iter().filter_map(|state| state.rate.formula()))
    }

    /// What they ask of joint coordinates.
    fn uses_of_formulas(&self) -> impl Iterator<Item = (JointCoordinate, CoordinateUse)> {
        self.laws().flat_map(Formula::uses)
    }

    /// The rows of one joint, coupler, driver or body among [`Model::rows`].
    pub fn rows_of(&self, owner: RowOwner) -> Range<usize> {
        let rows = self.rows();
        let start = rows.iter().position(|r| r.owner == owner).unwrap_or(rows.len());
        start..start + rows.iter().filter(|r| r.owner == owner).count()
    }

    /// The angles on whose continuous value something acts (springs, stops, couplers, drivers, screws), without
    /// repetition, in order of joint and coordinate. The state holds one number for each after the work: the *turn
    /// reference*, whose derivative is the angle's rate, so that it never strays by half a turn; the continuous angle
    /// is `reference + atan2(S cos reference − C sin reference, C cos reference + S sin reference)` with `atan2(S, C)`
    /// the principal angle.
    pub fn turn_references(&self) -> Vec<JointCoordinate> {
        let mut used = Vec::new();
        let forces = self.forces.iter().filter_map(|force| force.kind.parts().on);
        let forces = forces.chain(self.uses_of_formulas());
        used.extend(forces.filter(|(_, of)| *of == CoordinateUse::Value).map(|(on, _)| on));
        used.extend(self.contacts.iter().map(|contact| contact.on));
        used.extend(self.couplers.iter().flat_map(Coupler::placed));
        used.extend(self.drivers.iter().map(|d| d.coordinate));
        let screws = self.joints.iter().enumerate().filter(|(_, j)| j.kind == JointKind::Screw);
        used.extend(screws.map(|(joint, _)| JointCoordinate { joint, coordinate: 0 }));
        used.retain(|&c| self.coordinate_kind(c).is_angle());
        used.sort_by_key(|c| (c.joint, c.coordinate));
        used.dedup();
        used
    }

    /// Whether anything moves by prescription, so that time enters the equations and drivers do work.
    pub fn is_driven(&self) -> bool {
        !self.drivers.is_empty() || self.bodies.iter().any(|b| b.support == Support::Driven)
    }

    /// A length typical of the mechanism, m, by which violations of length rows are divided: the largest distance of a
    /// joint point from its body's mass centre, or radius of gyration of a body with coordinates.
    pub fn size(&self) -> f64 {
        let norm = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        let points =
            self.joints.iter().flat_map(|j| [&j.first.point, &j.second.point]).map(|p| norm(self.values(p)));
        let gyration = self.bodies.iter().filter(|b| b.support.has_coordinates()).map(|b| {
            let [xx, yy, zz, ..] = self.values(&b.inertia);
            (xx.max(yy).max(zz) / self.value(&b.mass)).sqrt()
        });
        let size = points.chain(gyration).fold(0.0, f64::max);
        if size > 0.0 { size } else { 1.0 }
    }

    /// Whether something does work that the energy does not account for: friction, dampers, stops, motors, loads,
    /// drivers.
    ///
    /// Such a model carries the work done so far as one more element of its state, after positions and velocities,
    /// unless the model file asks to leave it out (`count_work = false`).
    pub fn has_work(&self) -> bool {
        self.counts_work && self.is_worked_on()
    }

    /// The frames between which bushings act.
    pub fn frames_of_forces(&self) -> impl Iterator<Item = &BodyFrame> {
        let bushings = self.forces.iter().filter_map(|force| match &force.kind {
            ForceKind::Bushing(bushing) => Some(bushing.ends()),
            _ => None,
        });
        bushings.flatten()
    }

    /// Whether something does work that the energy does not account for, counted or not.
    pub fn is_worked_on(&self) -> bool {
        self.is_driven()
            || self.joints.iter().any(|j| !j.damping.is_zero())
            || self.forces.iter().any(|force| force.kind.does_work())
    }

    /// The rows that are dropped shape the formulas: other parameters must leave them as they are. The start is that
    /// of [`Model::assemble`].
    fn keeps_redundant_rows(&self) -> Result<Start, String> {
        let (found, start) = analyse_with_start(self).map_err(|error| error.to_string())?;
        let rows = |redundant: &[RedundantRow]| {
            redundant.iter().map(|r| (r.row, r.axes, r.stays)).collect::<Vec<_>>()
        };
        if rows(&found.redundant) == rows(&self.redundant) {
            let is_same = self.redundant.iter().all(|dropped| dropped.axes == PointAxes::Global);
            return if is_same { Ok(start) } else { self.assemble().map_err(|error| error.to_string()) };
        }
        let (now, before) = (found.redundant.len(), self.redundant.len());
        Err(format!(
            "with these parameters different constraint rows are redundant ({now} instead of {before}): write the \
             numbers into the model file"
        ))
    }

    /// Whether an input may have this value.
    ///
    /// # Errors
    /// The message says what the value makes unphysical.
    pub fn check_input(&self, index: usize, value: &Rational) -> Result<(), String> {
        let mut model = self.clone();
        if let Some(input) = model.inputs.get_mut(index) {
            input.value = value.clone();
        }
        crate::validate::physical(&model).map_or(Ok(()), Err)
    }

    /// The same model with parameters set anew. Start over from the model file's start: assemble it again.
    ///
    /// # Errors
    /// The message names the unknown parameter and the nearest one that exists, or what the new value makes unphysical,
    /// or says that a mechanism with loops cannot be assembled or that other rows have become redundant.
    pub fn with_parameters(&self, settings: &[(String, Rational)]) -> Result<Self, String> {
        self.with_parameters_and_start(settings).map(|(model, _)| model)
    }

    /// The same with where it starts, which has to be assembled to know: nothing where no parameter is given.
    ///
    /// # Errors
    /// As [`Self::with_parameters`].
    pub fn with_parameters_and_start(
        &self,
        settings: &[(String, Rational)],
    ) -> Result<(Self, Option<Start>), String> {
        let mut model = self.clone();
        if settings.is_empty() {
            return Ok((model, None));
        }
        for (name, value) in settings {
            let Some(parameter) = model.parameters.iter_mut().find(|p| p.name == *name) else {
                return Err(crate::parse::not_settable(self, name));
            };
            parameter.value = value.clone();
        }
        if let Some(problem) = crate::validate::physical(&model) {
            return Err(problem);
        }
        model.keeps_redundant_rows().map(|start| (model, Some(start)))
    }
}

impl Model {
    /// All motions along straight lines, each with the name of the driver or body that moves so.
    pub fn lines(&self) -> Vec<(&str, &Lines)> {
        let motions = self.motions();
        motions
            .flat_map(|(name, motion)| motion.lines().into_iter().map(move |lines| (name, lines)))
            .collect()
    }

    /// All inputs that motions follow, each once, with the name of a driver or body that moves so: the indices of its
    /// value, its rate and its acceleration.
    pub fn followed_inputs(&self) -> Vec<(&str, [usize; 3])> {
        let mut found: Vec<(&str, [usize; 3])> = Vec::new();
        for (name, motion) in self.motions() {
            for inputs in motion.inputs() {
                if found.iter().all(|(_, known)| *known != inputs) {
                    found.push((name, inputs));
                }
            }
        }
        found
    }

    /// All motions, each with the name of the driver or body that moves so.
    fn motions(&self) -> impl Iterator<Item = (&str, &Motion)> {
        let of_drivers = self.drivers.iter().map(|driver| (driver.name.as_str(), &driver.motion));
        let of_bodies = self.bodies.iter().flat_map(|body| {
            let parts = body.motion.iter().flat_map(BodyMotion::parts);
            parts.map(|motion| (body.name.as_str(), motion))
        });
        of_drivers.chain(of_bodies)
    }
}
