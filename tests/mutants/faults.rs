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

/// Changes that do no harm and save time: factoring is given up early, and mechanisms with one or two rates have no Jacobian. File,
/// place and what is there instead.
#[allow(dead_code, reason = "only the build script changes texts")]
const QUICKER: [(&str, &str, &str); 2] = [
    ("normal_form/mod.rs", "const MAX_STEPS: usize = 100_000;", "const MAX_STEPS: usize = 10_000;"),
    ("joint_space/jacobian.rs", "if layout.n_rates > MAX_RATES {", "if layout.n_rates < 3 || layout.n_rates > MAX_RATES {"),
];

/// All faults. An expression that is mutated must not contain another one.
const FAULTS: &[Fault] = &[
    // Rules of differentiation.
    fault("differentiate.rs", "bob", "«graph.mul(a, self.memo[&b])»);", "Graph::ZERO"),
    fault("differentiate.rs", "bob", "let (left, right) = («graph.mul(self.memo[&a], b)»,", "graph.mul(self.memo[&a], self.memo[&b])"),
    fault("differentiate.rs", "bob", "Node::Add(a, b) => «graph.add(self.memo[&a], self.memo[&b])»", "self.memo[&a]"),
    fault("differentiate.rs", "bob", "Node::Neg(a) => «graph.neg(self.memo[&a])»", "self.memo[&a]"),
    fault("differentiate.rs", "chain", "let cos = «graph.cos(a)»;", "graph.sin(a)"),
    fault("differentiate.rs", "chain", "let product = graph.mul(sin, self.memo[&a]);\n                «graph.neg(product)»", "product"),
    fault("differentiate.rs", "screw", "let turned = «graph.sub(plus, minus)»;", "graph.add(plus, minus)"),
    fault("differentiate.rs", "screw", "let square = «graph.dot(&[x, y], &[x, y])»;\n    graph.div(turned", "graph.mul(x, x)"),
    fault("differentiate.rs", "cam", "let slope = graph.symbol(Symbol::Table { table, order: «order + 1» });", "order"),
    // Φ and its derivatives.
    fault("kinematics.rs", "bob", "let gamma = second.iter().map(|&row| «system.graph.neg(row)»)", "row"),
    fault("kinematics.rs", "driven-four-bar", "let nu = phi_t.iter().map(|&row| «system.graph.neg(row)»)", "row"),
    fault("kinematics.rs", "bob", "let second = motion_derivative(system, «&velocity_residual»);", "&phi"),
    fault("constraints.rs", "bob", "let aligned = [(i.f, j.h), «(i.g, j.h)», (i.f, j.g)];", "(i.f, j.h)"),
    fault("constraints.rs", "bob", "let turned = «graph.mat_vec(relative, b_j)»;", "graph.transposed_vec(relative, b_j)"),
    fault("constraints.rs", "free-body", "«system.graph.sub(square, one)»", "square"),
    fault("constraints.rs", "gear", "«system.graph.sub(lag, offset)»", "system.graph.add(lag, offset)"),
    fault("constraints.rs", "rod", "let difference = «graph.sub(quotient, joint.length)»;", "quotient"),
    fault("constraints.rs", "screw", "rows[2] = «system.graph.sub(rows[2], advance)»;", "system.graph.add(rows[2], advance)"),
    fault("coordinate.rs", "bob", "«graph.mat_vec(&j.a, &joint.second.point)»);\n    let (point_i", "graph.transposed_vec(&j.a, &joint.second.point)"),
    fault("coordinate.rs", "slider", "let u = «system.graph.mat_vec(&a, u)»;", "*u"),
    // What vanishes where |p| = 1.
    fault("functions.rs", "free-body", "phi: «equations.phi.clone()»,", "equations.phi.iter().map(|_| Graph::ZERO).collect()"),
    // Rotations and their rates.
    fault("linear.rs", "bob", "let sum = self.dot(&[g[0][k], g[1][k], g[2][k]], w);\n            «self.mul(half, sum)»", "sum"),
    fault("linear.rs", "bob", "[«[n1, e0, e3, n2]», [n2", "[n1, e0, n3, e2]"),
    fault("linear.rs", "bob", "== 1 {\n                        «self.sub(symmetric, skew)»", "self.add(symmetric, skew)"),
    fault("linear.rs", "chain", "== 1 {\n                    «self.sub(symmetric, skew)»", "self.add(symmetric, skew)"),
    fault("linear.rs", "chain", "let shared = «self.sub(shared, Self::ONE)»;", "shared"),
    fault("reassociate.rs", "chain", "«if x == factor { y } else { x }»", "x"),
    fault("reassociate.rs", "chain", "«graph.mul(constant, memo[&factor])»", "memo[&factor]"),
    fault("system.rs", "bob", "let a_rate = «self.graph.mat_mul(&pose.a, &tilde)»;", "self.graph.mat_mul(&tilde, &pose.a)"),
    fault("system.rs", "bob", "let square = «self.graph.mat_mul(&tilde, &tilde)»;", "[ZERO3; 3]"),
    fault("system.rs", "pair", "let rate = «self.graph.sub_mat(&turned, &carried)»;", "turned"),
    fault("system.rs", "pair", "let (both, two) = (graph.mat_mul(&tilde_i, &turned), «graph.integer(2)»);", "graph.integer(1)"),
    fault("system.rs", "pair", "«graph.sub_mat(&of_j, &both)»", "of_j"),
    fault("system.rs", "bob", "let across = «graph.cross(&normal, &axis)»;", "graph.cross(&axis, &normal)"),
    fault("system.rs", "pair", "let ratio = «graph.div(length, stretched)»;", "graph.div(stretched, length)"),
    fault("motion.rs", "chain", "let s = translation.map(|x| «self.time_derivative(x)»);", "x"),
    fault("motion.rs", "carrier", "w = «self.graph.add_vec(&carried, &own)»;", "own"),
    fault("graph.rs", "bob", "            Node::Neg(a) => «self.neg(a)»,", "a"),
    fault("definitions.rs", "pair", "(None, Some(definition)) => «self.of(graph, definition)»", "definition"),
    // What depends on parameters alone.
    fault("set_up.rs", "gyroscope-parameters", "(self.scaled(factor, a), «self.scaled(factor, b)»)", "self.memo[&b]"),
    fault("set_up.rs", "gyroscope-parameters", "let scaled = self.scaled(factor, a);\n                «self.graph.neg(scaled)»", "scaled"),
    fault("set_up.rs", "gyroscope-parameters", "let factor = «self.graph.mul(factor, inner)»;", "inner"),
    fault("set_up.rs", "gyroscope-parameters", "let value = self.value(a);\n                «self.graph.neg(value)»", "value"),
    fault("set_up.rs", "gyroscope-parameters", "let place = «*self.places.entry(id).or_insert(next)»;", "next.min(1)"),
    // Masses and forces.
    fault("dynamics.rs", "bob", "graph.add_vec(&weight, &load.force), «graph.sub_vec(&load.torque, &gyroscopic)»", "graph.add_vec(&load.torque, &gyroscopic)"),
    fault("dynamics.rs", "free-body", "let difference = «graph.sub(inertia[l][l], inertia[j][j])»;", "inertia[l][l]"),
    fault("dynamics.rs", "bob", "let kinetic = «graph.mul(half, twice)»;", "twice"),
    fault("dynamics.rs", "bob", "self.potential = «graph.sub(self.potential, height)»;", "graph.add(self.potential, height)"),
    fault("forces.rs", "torsion", "(«graph.neg(pull)», graph", "pull"),
    fault("forces.rs", "torsion", "«graph.mul(half, double)»)", "double"),
    fault("forces.rs", "stop", "let square = graph.dot(&[depth, softness], &«[depth, softness]»);", "[depth, depth]"),
    fault("forces.rs", "stop", "«graph.add(Graph::ONE, quotient)»", "quotient"),
    fault("forces.rs", "chain", "let on_first = «graph.neg_vec(&on_second)»;", "on_second"),
    fault("forces.rs", "tether", "let force = «graph.sub(elastic, drag)»;", "elastic"),
    fault("forces.rs", "loads", "(given_force, «graph.transposed_vec(&pose.a, &given_torque)»)", "graph.mat_vec(&pose.a, &given_torque)"),
    fault("forces.rs", "loads", "torque: «system.graph.cross(&self.point, &in_body)»", "system.graph.cross(&in_body, &self.point)"),
    fault("forces.rs", "loads", "let power = «graph.add(pushing, turning)»;", "pushing"),
    fault("forces.rs", "friction", "let sliding = «system.graph.tanh(ratio)»;", "ratio"),
    fault("forces.rs", "friction", "(graph.mat_vec(&joint.relative, &drag), «graph.neg_vec(&drag)»)", "drag"),
    // The solve of eq. (17).
    fault("freedom.rs", "bob", "let (of_a, of_b) = (graph.cross(b, h), «graph.cross(h, a)»);", "graph.cross(a, h)"),
    fault("freedom.rs", "pair", "let relative = if reversed { [0, 1, 2].map(turned) } else { «joint.relative» };", "[0, 1, 2].map(turned)"),
    fault("freedom.rs", "universal", "JointKind::Universal => vec![«graph.transposed_vec(&joint.relative, &joint.first.h)», second]", "joint.first.h"),
    fault("freedom.rs", "screw", "Twist { t: «graph.scale_vec(advance, &along)», rho }", "ZERO3"),
    fault("null_space.rs", "pair", "let square = «graph.mat_mul(&transposed(&tilde), &tilde)»;", "graph.mat_mul(&tilde, &tilde)"),
    fault("null_space.rs", "pair", "let moment = «graph.transposed_vec(&self.k, &wanted.t)»;", "graph.mat_vec(&self.k, &wanted.t)"),
    fault("null_space.rs", "pair", "let both_moments = «sum(graph, &moment, &transposed(&moment))»;", "moment"),
    fault("null_space.rs", "pair", "coupling: turned(&«self.coupling», carried, relative)", "self.angular"),
    fault("null_space.rs", "bob", "let rate = «graph.neg(resisted)»;", "resisted"),
    fault("null_space.rs", "bob", "let resisting = «graph.add(inertial, load)»;", "load"),
    fault("null_space.rs", "pair", "bias = «bias.plus(graph, &inertial)»;", "bias"),
    fault("null_space.rs", "pair", "«graph.sub(m[row][column], product)»", "m[row][column]"),
    fault("null_space.rs", "pair", "let towards_centre = «graph.neg_vec(&parent.point)»;", "parent.point"),
    fault("closing.rs", "four-bar", "let rate = dot(graph, gradient, &motions);\n        «graph.sub(rate, rates[row])»", "rate"),
    fault("closing.rs", "four-bar", "let correction = «response.scaled(graph, multiplier).negated(graph)»;", "response.scaled(graph, multiplier)"),
    fault("multipliers.rs", "bob", "lambda[row] = «graph.neg(supplied)»;", "supplied"),
    fault("multipliers.rs", "pair", "lacking[parent.slot] = «lacking[parent.slot].plus(graph, &carried)»;", "carried"),
    fault("ldl.rs", "four-bar", "let factor = «graph.mul(value, inverse)»;", "value"),
    fault("ldl.rs", "four-bar", "let moved = graph.mul(factor, rhs[pivot]);\n                rhs[i] = «graph.sub(rhs[i], moved)»;", "graph.add(rhs[i], moved)"),
    fault("ldl.rs", "four-bar", "x = «graph.sub(x, product)»;", "graph.add(x, product)"),
    // The projection in the metric of the masses.
    fault("trees.rs", "four-bar", "closing::close(graph, kinematics, tree, (&self.closing, «&changes»), free)", "&kinematics.gamma"),
    fault("trees.rs", "pair", "let free = «tree.respond(graph, &excitation).motions»;", "excitation.forced.clone()"),
    fault("freedom.rs", "pair", "accelerated(graph, «&changes[self.rows.clone()]», &self.forced)", "changes"),
    fault("mass_matrix.rs", "gyroscope-combined-offsets", "let linear = «graph.mul(body.mass, linear)»;", "linear"),
    fault("mass_matrix.rs", "gyroscope-combined-offsets", "let product = «graph.mul(inertia, cosine)»;", "Graph::ZERO"),
    fault("mass_matrix.rs", "gyroscope-combined-offsets", "taken[parent.slot] = «taken[parent.slot].plus(graph, &carried)»;", "carried"),
    // Orthogonal motions.
    fault("orthogonal.rs", "gyroscope-light-rings", "let yielded = «part.motion.scaled(graph, share).negated(graph)»;", "part.motion.scaled(graph, share)"),
    fault("orthogonal.rs", "gyroscope-light-rings", "let yielded = graph.mul(share, all[rate]);\n                all[other] = «graph.sub(all[other], yielded)»;", "all[other]"),
    fault("orthogonal.rs", "carried", "let passed_on = graph.mul(share, forces[other]);\n                forces[rate] = «graph.sub(forces[rate], passed_on)»;", "forces[rate]"),
    fault("orthogonal.rs", "gyroscope-light-rings", ".map(|((body, motion), bias)| «body.times(graph, motion).plus(graph, bias)».negated(graph))", "body.times(graph, motion)"),
    // The coordinate partition.
    fault("partition.rs", "bob", "let factor = «graph.mul(half, difference)»;", "difference"),
    fault("partition.rs", "spherical", "let (residual, two) = (graph.sub(Graph::ONE, square), «graph.integer(2)»);", "graph.integer(1)"),
    fault("partition.rs", "bob", "let mut rhs: Vec<_> = residuals.iter().map(|&phi| «graph.neg(phi)»)", "phi"),
    fault("partition.rs", "bob", "let gained = «graph.sub_vec(&p, &unit)»;", "unit"),
    fault("partition.rs", "bob", "let s = «system.graph.sub_vec(&s, &residual)»;", "system.graph.add_vec(&s, &residual)"),
    // Joint coordinates.
    fault("joint_space/carriage.rs", "universal", "let rho = if about_axis_of_parent { «graph.transposed_vec(&self.rotation, &rho)» } else { rho };", "rho"),
    fault("joint_space/carriage.rs", "universal", "let change = «graph.cross(&free.twist.rho, &relative)»;", "graph.cross(&relative, &free.twist.rho)"),
    fault("joint_space/carriage.rs", "pair", "let mut rho = «graph.cross(own, &relative)»;", "ZERO3"),
    fault("joint_space/carriage.rs", "slider", "(of_parent, «2»)", "1"),
    fault("joint_space/carriage.rs", "pair", "let on_body = «graph.neg_vec(&on_body)»;", "on_body"),
    fault("joint_space/carriage.rs", "pair", "let across = «graph.sub(r[row][column], dyad)»;", "r[row][column]"),
    fault("joint_space/carriage.rs", "pair", "«graph.add(even, skew)»", "even"),
    fault("joint_space/carriage.rs", "screw", "let advance = if joint.kind == JointKind::Screw { «advance» } else { ZERO3 };", "ZERO3"),
    fault("joint_space/carriage.rs", "cylindrical", "*point = «graph.add_vec(point, &displacement)»;", "graph.sub_vec(point, &displacement)"),
    fault("joint_space/carriage.rs", "pair", "let (carried, own) = («graph.transposed_vec(&self.rotation, of_parent)», self.relative_spin(graph));", "graph.mat_vec(&self.rotation, of_parent)"),
    fault("joint_space/dynamics.rs", "torsion", "along[at] = «system.graph.add(along[at], part.force)»;", "system.graph.sub(along[at], part.force)"),
    fault("joint_space/dynamics.rs", "friction", "let power = «system.graph.mul(force, rate)»;", "force"),
    fault("joint_space/dynamics.rs", "friction", "*along = «system.graph.sub(*along, drag)»;", "system.graph.add(*along, drag)"),
    fault("joint_space/dynamics.rs", "torsion", "parts.retain(|part| «part.potential.is_none()»);", "true"),
    fault("joint_space/dynamics.rs", "pair", "let own = Twist { t: «graph.add_vec(&at_joint, &bias.on_body)», rho: bias.rho };", "at_joint"),
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
    fault("scales.rs", "pair", "let product = self.graph.mul(x, y);\n                self.with_factor(&«c.mul(&d)», product)", "c.clone()"),
    fault("scales.rs", "pair", "let (c, x) = self.known[&a].clone();\n                («c.neg()», x)", "c"),
    fault("scales.rs", "bob", "let c = «c.mul(&inverse)»;", "c"),
    fault("scales.rs", "bob", "terms[first..].iter_mut().for_each(|(c, _)| *c = «c.neg()»);", "c.clone()"),
    fault("scales.rs", "bob", "total.map_or(constant, |total| «self.graph.add(total, constant)»)", "total"),
    fault("joint_space/mod.rs", "pair", "let linear = if is_global { motion.t } else { «system.graph.mat_vec(&a, &motion.t)» };", "motion.t"),
    fault("joint_space/mod.rs", "pair", "motion = «motion.plus(graph, &yielded)»;", "yielded"),
    fault("joint_space/mod.rs", "spherical", "let p_rate = «graph.euler_rate(&p, &w)»;", "p"),
    fault("joint_space/multipliers.rs", "bob", "lambda[row] = «graph.neg(supplied)»;", "supplied"),
    fault("joint_space/multipliers.rs", "pair", "lacking[parent.slot] = «lacking[parent.slot].plus(graph, &carried)»;", "carried"),
    fault("joint_space/multipliers.rs", "pair", "let turned = «graph.mat_vec(&carriage.rotation, &at_joint.rho)»;", "at_joint.rho"),
    fault("joint_space/multipliers.rs", "pair", "let relative = if reversed { transposed(&carriage.rotation) } else { «carriage.rotation» };", "transposed(&carriage.rotation)"),
    // The Jacobian of the joint form.
    fault("differentiate.rs", "gyroscope-viscous", "Node::Mul(a, b) => vec![(a, b), «(b, a)»],", "(b, b)"),
    fault("differentiate.rs", "friction", "vec![(a, «graph.sub(Graph::ONE, square)»)]", "Graph::ONE"),
    fault("joint_space/jacobian.rs", "pitching-gyroscope", "*entry = «graph.add(*entry, product)»;", "product"),
    fault("joint_space/dynamics.rs", "gyroscope-free-nutation", "let own = «twist.scaled(graph, rates_of_rates[rate])»;", "Twist::ZERO"),
    // Writing.
    fault("emit.rs", "bob", "return self.difference(«*y», *x);", "*x"),
    fault("emit.rs", "bob", "let second = self.expression(subtracted, «Binding::Product»);", "Binding::Sum"),
    fault("emit.rs", "bob", "self.expression(b, «Binding::Product»));\n        (quote! { #first + #second }", "Binding::Sum"),
    fault("emit.rs", "bob", "let minus_x = «quote! { -#x }»;", "quote! { #x }"),
    fault("emit.rs", "bob", "let minus_added = «quote! { -#added }»;", "quote! { #added }"),
    fault("emit.rs", "bob", "let with_b = self.fusible(b).map(|factors| (factors, «a»));", "b"),
    fault("emit.rs", "bob", "Some((self.fusible(a)?, «b»))", "a"),
    fault("emit.rs", "pendulum", "let (a, b) = (self.expression(a, «Binding::Product»), self.expression(b, Binding::Unary));", "Binding::Sum"),
    fault("schedule.rs", "pair", "denominator(b).map(|x| «(a, x)»)", "(x, a)"),
    fault("outputs.rs", "pendulum", "let centripetal = «graph.cross(&pose.w, &speed)»;", "graph.cross(&speed, &pose.w)"),
    fault("outputs.rs", "pendulum", "let felt = «system.graph.sub_vec(&linear, &gravity)»;", "linear"),
    fault("outputs.rs", "pendulum", "«graph.mat_vec(&system.poses[body].a, &taken.torque)»", "taken.torque"),
];
