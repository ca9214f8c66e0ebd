/// One thing wrong with the derivation.
struct Fault {
    /// File of the generator.
    file: &'static str,
    /// A piece of its text that is there once, with the expression that goes wrong in `«»`.
    place: &'static str,
    /// What is there instead.
    wrong: &'static str,
    /// A model in whose derivation the expression matters.
    #[allow(dead_code, reason = "the build script has no use for it")]
    page: &'static str,
}

const fn fault(file: &'static str, page: &'static str, place: &'static str, wrong: &'static str) -> Fault {
    Fault { file, place, wrong, page }
}

/// Faults that do no harm, by the beginning of their place, and why.
#[allow(dead_code, reason = "the build script has no use for it")]
const HARMLESS: &[(&str, &str)] = &[("self.expression(b,", "a + (b + c) is a + b + c")];

/// Changes that do no harm and save time: factoring is given up early, and mechanisms with one or two rates have no
/// Jacobian. File, place and what is there instead.
#[allow(dead_code, reason = "only the build script changes texts")]
const QUICKER: [(&str, &str, &str); 2] = [
    ("simplify/normal_form/mod.rs", "const MAX_STEPS: usize = 100_000;", "const MAX_STEPS: usize = 10_000;"),
    ("joint_space/jacobian.rs", "if layout.n_rates > MAX_RATES {", "if layout.n_rates < 3 || layout.n_rates > MAX_RATES {"),
];

/// All faults. An expression that is mutated must not contain another one.
const FAULTS: &[Fault] = &[
    // Rules of differentiation.
    fault("expr/differentiate.rs", "bob", "«graph.mul(a, self.memo[&b])»);", "Graph::ZERO"),
    fault("expr/differentiate.rs", "bob", "let (left, right) = («graph.mul(self.memo[&a], b)»,", "graph.mul(self.memo[&a], self.memo[&b])"),
    fault("expr/differentiate.rs", "bob", "Node::Add(a, b) => «graph.add(self.memo[&a], self.memo[&b])»", "self.memo[&a]"),
    fault("expr/differentiate.rs", "bob", "Node::Neg(a) => «graph.neg(self.memo[&a])»", "self.memo[&a]"),
    fault("expr/differentiate.rs", "chain", "let cos = «graph.cos(a)»;", "graph.sin(a)"),
    fault("expr/differentiate.rs", "chain", "let product = graph.mul(sin, self.memo[&a]);\n                «graph.neg(product)»", "product"),
    fault("expr/differentiate.rs", "screw", "let turned = «graph.sub(plus, minus)»;", "graph.add(plus, minus)"),
    fault("expr/differentiate.rs", "screw", "let square = «graph.dot(&[x, y], &[x, y])»;\n    graph.div(turned", "graph.mul(x, x)"),
    fault("expr/differentiate.rs", "cam", "let slope = graph.symbol(Symbol::Table { table, order: «order + 1» });", "order"),
    // Φ and its derivatives.
    fault("derive/kinematics.rs", "bob", "let gamma = second.iter().map(|&row| «system.graph.neg(row)»)", "row"),
    fault("derive/kinematics.rs", "driven-four-bar", "let nu = phi_t.iter().map(|&row| «system.graph.neg(row)»)", "row"),
    fault("derive/kinematics.rs", "bob", "let second = motion_derivative(system, «&velocity_residual»);", "&phi"),
    fault("derive/constraints.rs", "bob", "let aligned = [(i.f, j.h), «(i.g, j.h)», (i.f, j.g)];", "(i.f, j.h)"),
    fault("derive/frames.rs", "bob", "let turned = «graph.mat_vec(relative, b_j)»;", "graph.transposed_vec(relative, b_j)"),
    fault("derive/constraints.rs", "free-body", "«system.graph.sub(square, one)»", "square"),
    fault("derive/constraints.rs", "gear", "«system.graph.sub(lag, offset)»", "system.graph.add(lag, offset)"),
    fault("derive/constraints.rs", "rod", "let difference = «graph.sub(quotient, joint.length)»;", "quotient"),
    fault("derive/constraints.rs", "carried-four-bar", "dot2(system, &joint, &[joint.first.f, «joint.first.g», joint.first.h]),", "joint.first.h"),
    fault("derive/constraints.rs", "screw", "rows[2] = «system.graph.sub(rows[2], advance)»;", "system.graph.add(rows[2], advance)"),
    fault("derive/joint_coordinate.rs", "bob", "«graph.mat_vec(&j.a, &joint.second.point)»);\n    let (point_i", "graph.transposed_vec(&j.a, &joint.second.point)"),
    fault("derive/joint_coordinate.rs", "slider", "let u = «system.graph.mat_vec(&a, u)»;", "*u"),
    // What vanishes where |p| = 1.
    fault("kernels.rs", "free-body", "Source::Equations(|e| «e.phi.clone()».into())", "e.phi.iter().map(|_| Graph::ZERO).collect::<Vec<_>>()"),
    // Rotations and their rates.
    fault("expr/vector.rs", "bob", "let sum = self.dot(&[g[0][k], g[1][k], g[2][k]], w);\n            «self.mul(half, sum)»", "sum"),
    fault("expr/vector.rs", "bob", "[«[n1, e0, e3, n2]», [n2", "[n1, e0, n3, e2]"),
    fault("expr/vector.rs", "bob", "== 1 {\n                        «self.sub(symmetric, skew)»", "self.add(symmetric, skew)"),
    fault("expr/vector.rs", "chain", "== 1 {\n                    «self.sub(symmetric, skew)»", "self.add(symmetric, skew)"),
    fault("expr/vector.rs", "chain", "let shared = «self.sub(shared, Self::ONE)»;", "shared"),
    fault("simplify/reassociate.rs", "chain", "«if x == factor { y } else { x }»", "x"),
    fault("simplify/reassociate.rs", "chain", "«graph.mul(constant, memo[&factor])»", "memo[&factor]"),
    fault("derive/system.rs", "bob", "let a_rate = «self.graph.mat_mul(&pose.a, &tilde)»;", "self.graph.mat_mul(&tilde, &pose.a)"),
    fault("derive/system.rs", "bob", "let square = «self.graph.mat_mul(&tilde, &tilde)»;", "[ZERO3; 3]"),
    fault("derive/system.rs", "pair", "let rate = «self.graph.sub_mat(&turned, &carried)»;", "turned"),
    fault("derive/system.rs", "pair", "let (both, two) = (graph.mat_mul(&tilde_i, &turned), «graph.integer(2)»);", "graph.integer(1)"),
    fault("derive/system.rs", "pair", "«graph.sub_mat(&of_j, &both)»", "of_j"),
    fault("derive/system.rs", "bob", "let across = «graph.cross(&normal, &axis)»;", "graph.cross(&axis, &normal)"),
    fault("derive/system.rs", "pair", "let ratio = «graph.div(length, stretched)»;", "graph.div(stretched, length)"),
    fault("derive/prescribed_motion.rs", "chain", "let s = translation.map(|x| «self.time_derivative(x)»);", "x"),
    fault("derive/prescribed_motion.rs", "carrier", "w = «self.graph.add_vec(&carried, &own)»;", "own"),
    fault("expr/graph.rs", "bob", "            Node::Neg(a) => «self.neg(a)»,", "a"),
    fault("expr/definitions.rs", "pair", "(None, Some(definition)) => «self.of(graph, definition)»", "definition"),
    // What depends on parameters alone.
    fault("simplify/parameter_setup.rs", "gyroscope-parameters", "(self.scaled(factor, a), «self.scaled(factor, b)»)", "self.memo[&b]"),
    fault("simplify/parameter_setup.rs", "gyroscope-parameters", "let scaled = self.scaled(factor, a);\n                «self.graph.neg(scaled)»", "scaled"),
    fault("simplify/parameter_setup.rs", "gyroscope-parameters", "let factor = «self.graph.mul(factor, inner)»;", "inner"),
    fault("simplify/parameter_setup.rs", "gyroscope-parameters", "let value = self.value(a);\n                «self.graph.neg(value)»", "value"),
    fault("simplify/parameter_setup.rs", "gyroscope-parameters", "let place = «*self.places.entry(id).or_insert(next)»;", "next.min(1)"),
    // Masses and forces.
    fault("derive/dynamics.rs", "bob", "graph.add_vec(&weight, &load.force), «graph.sub_vec(&load.torque, &gyroscopic)»", "graph.add_vec(&load.torque, &gyroscopic)"),
    fault("derive/dynamics.rs", "free-body", "let difference = «graph.sub(inertia[l][l], inertia[j][j])»;", "inertia[l][l]"),
    fault("derive/dynamics.rs", "bob", "let kinetic = «graph.mul(half, twice)»;", "twice"),
    fault("derive/dynamics.rs", "bob", "self.potential = «graph.sub(self.potential, height)»;", "graph.add(self.potential, height)"),
    fault("derive/forces.rs", "torsion", "(«graph.neg(pull)», graph", "pull"),
    fault("derive/forces.rs", "torsion", "«graph.mul(half, double)»)", "double"),
    fault("derive/forces.rs", "stop", "let square = graph.dot(&[depth, softness], &«[depth, softness]»);", "[depth, depth]"),
    fault("derive/forces.rs", "stop", "«graph.add(Graph::ONE, quotient)»", "quotient"),
    fault("derive/forces.rs", "chain", "let on_first = «graph.neg_vec(&on_second)»;", "on_second"),
    fault("derive/forces.rs", "tether", "let force = «graph.sub(elastic, drag)»;", "elastic"),
    fault("derive/forces.rs", "loads", "(given_force, «graph.transposed_vec(&pose.a, &given_torque)»)", "graph.mat_vec(&pose.a, &given_torque)"),
    fault("derive/forces.rs", "loads", "torque: «system.graph.cross(&self.point, &in_body)»", "system.graph.cross(&in_body, &self.point)"),
    fault("derive/forces.rs", "loads", "let power = «graph.add(pushing, turning)»;", "pushing"),
    fault("derive/forces.rs", "friction", "let sliding = «system.graph.tanh(ratio)»;", "ratio"),
    fault("derive/forces.rs", "friction", "(graph.mat_vec(&joint.relative, &drag), «graph.neg_vec(&drag)»)", "drag"),
    // The solve of eq. (17).
    fault("solve/motion_subspace.rs", "bob", "let (of_a, of_b) = (graph.cross(b, h), «graph.cross(h, a)»);", "graph.cross(a, h)"),
    fault("solve/motion_subspace.rs", "pair", "let relative = if reversed { [0, 1, 2].map(turned) } else { «joint.relative» };", "[0, 1, 2].map(turned)"),
    fault("solve/motion_subspace.rs", "universal", "JointKind::Universal => vec![«graph.transposed_vec(&joint.relative, &joint.first.h)», second]", "joint.first.h"),
    fault("solve/motion_subspace.rs", "screw", "SpatialVector { t: «graph.scale_vec(advance, &along)», rho }", "ZERO3"),
    fault("solve/articulated_body.rs", "pair", "let square = «graph.mat_mul(&transposed(&tilde), &tilde)»;", "graph.mat_mul(&tilde, &tilde)"),
    fault("solve/articulated_body.rs", "pair", "let moment = «graph.transposed_vec(&self.k, &wanted.t)»;", "graph.mat_vec(&self.k, &wanted.t)"),
    fault("solve/articulated_body.rs", "pair", "let both_moments = «sum(graph, &moment, &transposed(&moment))»;", "moment"),
    fault("solve/articulated_body.rs", "pair", "coupling: turned(&«self.coupling», carried, relative)", "self.angular"),
    fault("solve/articulated_body.rs", "bob", "let rate = «graph.neg(resisted)»;", "resisted"),
    fault("solve/articulated_body.rs", "bob", "let resisting = «graph.add(inertial, load)»;", "load"),
    fault("solve/articulated_body.rs", "pair", "bias = «bias.plus(graph, &inertial)»;", "bias"),
    fault("solve/articulated_body.rs", "pair", "«graph.sub(m[row][column], product)»", "m[row][column]"),
    fault("solve/articulated_body.rs", "pair", "let towards_centre = «graph.neg_vec(&parent.point)»;", "parent.point"),
    fault("solve/loop_closure.rs", "four-bar", "let rate = dot(graph, gradient, &motions);\n        «graph.sub(rate, rates[row])»", "rate"),
    fault("solve/loop_closure.rs", "four-bar", "let correction = «response.scaled(graph, multiplier).negated(graph)»;", "response.scaled(graph, multiplier)"),
    fault("solve/multipliers.rs", "bob", "lambda[row] = «graph.neg(supplied)»;", "supplied"),
    fault("solve/multipliers.rs", "pair", "lacking[parent.moving_body] = «lacking[parent.moving_body].plus(graph, &carried)»;", "carried"),
    fault("solve/ldl.rs", "four-bar", "let factor = «graph.mul(value, inverse)»;", "value"),
    fault("solve/ldl.rs", "four-bar", "let moved = graph.mul(factor, rhs[pivot]);\n                rhs[i] = «graph.sub(rhs[i], moved)»;", "graph.add(rhs[i], moved)"),
    fault("solve/ldl.rs", "four-bar", "x = «graph.sub(x, product)»;", "graph.add(x, product)"),
    fault("joint_space/loops.rs", "four-bar", "vec![first, «graph.div(area, first)»]", "area"),
    // The projection in the metric of the masses.
    fault("solve/forward_dynamics.rs", "four-bar", "loop_closure::close(graph, kinematics, tree, (&self.loop_rows, «&changes»), free)", "&kinematics.gamma"),
    fault("solve/forward_dynamics.rs", "pair", "let free = «tree.respond(graph, &excitation).motions»;", "excitation.forced.clone()"),
    fault("solve/motion_subspace.rs", "pair", "accelerated(graph, «&changes[self.rows.clone()]», &self.forced)", "changes"),
    fault("solve/reduced_mass_matrix.rs", "gyroscope-combined-offsets", "let linear = «graph.mul(body.mass, linear)»;", "linear"),
    fault("solve/reduced_mass_matrix.rs", "gyroscope-combined-offsets", "let product = «graph.mul(inertia, cosine)»;", "Graph::ZERO"),
    fault("solve/reduced_mass_matrix.rs", "gyroscope-combined-offsets", "taken[parent.moving_body] = «taken[parent.moving_body].plus(graph, &carried)»;", "carried"),
    // Gram–Schmidt.
    fault("solve/gram_schmidt.rs", "gyroscope-light-rings", "let yielded = «part.motion.scaled(graph, share).negated(graph)»;", "part.motion.scaled(graph, share)"),
    fault("solve/gram_schmidt.rs", "gyroscope-light-rings", "let yielded = graph.mul(share, all[rate]);\n                all[other] = «graph.sub(all[other], yielded)»;", "all[other]"),
    fault("solve/gram_schmidt.rs", "carried", "let passed_on = graph.mul(share, forces[other]);\n                forces[rate] = «graph.sub(forces[rate], passed_on)»;", "forces[rate]"),
    fault("solve/gram_schmidt.rs", "gyroscope-light-rings", ".map(|((body, motion), bias)| «body.times(graph, motion).plus(graph, bias)».negated(graph))", "body.times(graph, motion)"),
    // The coordinate partition.
    fault("solve/partition.rs", "bob", "let factor = «graph.mul(half, difference)»;", "difference"),
    fault("solve/partition.rs", "spherical", "let (residual, two) = (graph.sub(Graph::ONE, square), «graph.integer(2)»);", "graph.integer(1)"),
    fault("solve/partition.rs", "bob", "let mut rhs: Vec<_> = residuals.iter().map(|&phi| «graph.neg(phi)»)", "phi"),
    fault("solve/partition.rs", "bob", "let gained = «graph.sub_vec(&p, &unit)»;", "unit"),
    fault("solve/partition.rs", "bob", "let s = «system.graph.sub_vec(&s, &residual)»;", "system.graph.add_vec(&s, &residual)"),
    // Joint coordinates.
    fault("joint_space/link_kinematics.rs", "universal", "let rho = if about_axis_of_parent { «graph.transposed_vec(&self.rotation, &rho)» } else { rho };", "rho"),
    fault("joint_space/link_kinematics.rs", "universal", "let change = «graph.cross(&free.twist.rho, &relative)»;", "graph.cross(&relative, &free.twist.rho)"),
    fault("joint_space/link_kinematics.rs", "pair", "let mut rho = «graph.cross(own, &relative)»;", "ZERO3"),
    fault("joint_space/link_kinematics.rs", "slider", "(of_parent, «2»)", "1"),
    fault("joint_space/link_kinematics.rs", "pair", "let on_body = «graph.neg_vec(&on_body)»;", "on_body"),
    fault("joint_space/link_kinematics.rs", "pair", "let across = «graph.sub(r[row][column], dyad)»;", "r[row][column]"),
    fault("joint_space/link_kinematics.rs", "pair", "«graph.add(even, skew)»", "even"),
    fault("joint_space/link_kinematics.rs", "screw", "let advance = if joint.kind == JointKind::Screw { «advance» } else { ZERO3 };", "ZERO3"),
    fault("joint_space/link_kinematics.rs", "cylindrical", "*point = «graph.add_vec(point, &displacement)»;", "graph.sub_vec(point, &displacement)"),
    fault("joint_space/link_kinematics.rs", "pair", "let (carried, own) = («graph.transposed_vec(&self.rotation, of_parent)», self.relative_spin(graph));", "graph.mat_vec(&self.rotation, of_parent)"),
    fault("joint_space/dynamics.rs", "torsion", "along[at] = «system.graph.add(along[at], part.force)»;", "system.graph.sub(along[at], part.force)"),
    fault("joint_space/dynamics.rs", "friction", "let power = «system.graph.mul(force, rate)»;", "force"),
    fault("joint_space/dynamics.rs", "friction", "*along = «system.graph.sub(*along, drag)»;", "system.graph.add(*along, drag)"),
    fault("joint_space/dynamics.rs", "torsion", "parts.retain(|part| «part.potential.is_none()»);", "true"),
    fault("joint_space/dynamics.rs", "pair", "let own = SpatialVector { t: «graph.add_vec(&at_joint, &bias.on_body)», rho: bias.rho };", "at_joint"),
    fault("joint_space/dynamics.rs", "pair", "motion = «motion.plus(graph, &carried)»;", "motion"),
    fault("joint_space/dynamics.rs", "pair", "forces[rate] = «graph.sub(along, resisted)»;", "graph.add(along, resisted)"),
    fault("joint_space/dynamics.rs", "chain", "let felt = «graph.sub_vec(&linear, gravity)»;", "graph.neg_vec(gravity)"),
    fault("joint_space/dynamics.rs", "pair", "rho: «graph.sub_vec(&gyroscopic, &load.torque)»", "load.torque"),
    fault("joint_space/dynamics.rs", "chain", "t: «graph.neg_vec(&force)»", "force"),
    fault("joint_space/maps.rs", "pair", "let r = «graph.sub_vec(&point, &own_arm)»;", "graph.add_vec(&point, &own_arm)"),
    fault("joint_space/maps.rs", "pair", "let on_body = «graph.sub_vec(&slid.on_body, &turned)»;", "graph.add_vec(&slid.on_body, &turned)"),
    fault("joint_space/maps.rs", "pair", "let inverse = «graph.recip(norm)»;", "norm"),
    fault("joint_space/maps.rs", "pair", "let (difference, sum) = («graph.sub(cosine, sine)», graph.add(cosine, sine));", "graph.sub(sine, cosine)"),
    // The last passes.
    fault("simplify/scales.rs", "pair", "let product = self.graph.mul(x, y);\n                self.with_factor(&«c.mul(&d)», product)", "c.clone()"),
    fault("simplify/scales.rs", "pair", "let (c, x) = self.known[&a].clone();\n                («c.neg()», x)", "c"),
    fault("simplify/scales.rs", "bob", "let c = «c.mul(&inverse)»;", "c"),
    fault("simplify/scales.rs", "bob", "terms[first..].iter_mut().for_each(|(c, _)| *c = «c.neg()»);", "c.clone()"),
    fault("simplify/scales.rs", "bob", "total.map_or(constant, |total| «self.graph.add(total, constant)»)", "total"),
    fault("joint_space/motions.rs", "pair", "let linear = if is_global { motion.t } else { «system.graph.mat_vec(&a, &motion.t)» };", "motion.t"),
    fault("joint_space/motions.rs", "pair", "motion = «motion.plus(graph, &yielded)»;", "yielded"),
    fault("joint_space/maps.rs", "spherical", "let p_rate = «graph.euler_rate(&p, &w)»;", "p"),
    fault("joint_space/multipliers.rs", "bob", "lambda[row] = «graph.neg(supplied)»;", "supplied"),
    fault("joint_space/multipliers.rs", "pair", "lacking[parent.moving_body] = «lacking[parent.moving_body].plus(graph, &carried)»;", "carried"),
    fault("joint_space/multipliers.rs", "pair", "let turned = «graph.mat_vec(&link_kinematics.rotation, &at_joint.rho)»;", "at_joint.rho"),
    fault("joint_space/multipliers.rs", "pair", "let relative = if reversed { transposed(&rotation) } else { «rotation» };", "transposed(&rotation)"),
    // The Jacobian of the joint form.
    fault("expr/differentiate.rs", "gyroscope-viscous", "Node::Mul(a, b) => vec![(a, b), «(b, a)»],", "(b, b)"),
    fault("expr/differentiate.rs", "friction", "vec![(a, «graph.sub(Graph::ONE, square)»)]", "Graph::ONE"),
    fault("joint_space/jacobian.rs", "pitching-gyroscope", "*entry = «graph.add(*entry, product)»;", "product"),
    fault("joint_space/dynamics.rs", "gyroscope-free-nutation", "let own = «twist.scaled(graph, rates_of_rates[rate])»;", "SpatialVector::ZERO"),
    // Writing.
    fault("emit/tokens.rs", "bob", "return self.difference(«*y», *x);", "*x"),
    fault("emit/tokens.rs", "bob", "let second = self.expression(subtracted, «Binding::Product»);", "Binding::Sum"),
    fault("emit/tokens.rs", "bob", "self.expression(b, «Binding::Product»));\n        (quote! { #first + #second }", "Binding::Sum"),
    fault("emit/tokens.rs", "bob", "let minus_x = «quote! { -#x }»;", "quote! { #x }"),
    fault("emit/tokens.rs", "bob", "let minus_added = «quote! { -#added }»;", "quote! { #added }"),
    fault("emit/tokens.rs", "bob", "let with_b = self.fusible(b).map(|factors| (factors, «a»));", "b"),
    fault("emit/tokens.rs", "bob", "Some((self.fusible(a)?, «b»))", "a"),
    fault("emit/tokens.rs", "pendulum", "let (a, b) = (self.expression(a, «Binding::Product»), self.expression(b, Binding::Unary));", "Binding::Sum"),
    fault("expr/schedule.rs", "pair", "denominator(b).map(|x| «(a, x)»)", "(x, a)"),
    fault("derive/outputs.rs", "pendulum", "let centripetal = «graph.cross(&pose.w, &speed)»;", "graph.cross(&speed, &pose.w)"),
    fault("derive/outputs.rs", "pendulum", "let felt = «system.graph.sub_vec(&linear, &gravity)»;", "linear"),
    fault("derive/outputs.rs", "pendulum", "«graph.mat_vec(&system.poses[body].a, &taken.torque)»", "taken.torque"),
];
