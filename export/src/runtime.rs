//! The run time in C, part for part: only what a mechanism uses is written.

use crate::Precision;

/// A part: the word that calls for it, what it needs, and its text.
struct Part {
    name: &'static str,
    needs: &'static [&'static str],
    text: &'static str,
}

macro_rules! part {
    ($name:literal, $file:literal, $needs:expr) => {
        Part { name: $name, needs: &$needs, text: include_str!(concat!("../c/libm/", $file)) }
    };
}

/// Elementary functions, each behind those that it needs.
const ELEMENTARY: &[Part] = &[
    part!("base", "base.c", []),
    part!("base_f32", "base_f32.c", []),
    part!("libm_scalbn", "scalbn.c", ["base"]),
    part!("rem_pio2_large", "rem_pio2_large.c", ["libm_scalbn"]),
    part!("rem_pio2", "rem_pio2.c", ["rem_pio2_large"]),
    part!("k_sin_cos", "k_sin_cos.c", ["rem_pio2"]),
    part!("libm_sin", "sin.c", ["k_sin_cos"]),
    part!("libm_cos", "cos.c", ["k_sin_cos"]),
    part!("expm1", "expm1.c", ["base"]),
    part!("libm_tanh", "tanh.c", ["expm1"]),
    part!("atan", "atan.c", ["base"]),
    part!("libm_atan2", "atan2.c", ["atan"]),
    part!("libm_pow", "pow.c", ["libm_scalbn"]),
    part!("libm_exp", "exp.c", ["libm_scalbn"]),
    part!("libm_log", "log.c", []),
    part!("gyro_when", "../choice/when.c", []),
    part!("gyro_unless", "../choice/unless.c", []),
    part!("libm_round", "round.c", []),
    part!("k_sin_cos_f32", "k_sin_cos_f32.c", ["base_f32", "rem_pio2_large"]),
    part!("libm_sinf", "sin_f32.c", ["k_sin_cos_f32"]),
    part!("libm_cosf", "cos_f32.c", ["k_sin_cos_f32"]),
    part!("sine", "../single/sine.c", []),
    part!("gyro_sinf", "../single/sin.c", ["libm_sinf", "sine"]),
    part!("gyro_cosf", "../single/cos.c", ["libm_cosf", "sine"]),
    part!("expm1_f32", "expm1_f32.c", ["base_f32"]),
    part!("libm_tanhf", "tanh_f32.c", ["expm1_f32"]),
    part!("atan_f32", "atan_f32.c", ["base_f32"]),
    part!("libm_atan2f", "atan2_f32.c", ["atan_f32"]),
    part!("libm_scalbnf", "scalbn_f32.c", []),
    part!("libm_expf", "exp_f32.c", ["base_f32", "libm_scalbnf"]),
    part!("libm_logf", "log_f32.c", []),
    part!("gyro_whenf", "../choice/when_f32.c", []),
    part!("gyro_unlessf", "../choice/unless_f32.c", []),
    part!("libm_roundf", "round_f32.c", []),
];

/// Whether elementary functions or units mention a name that is more than a word: it may be that of a constant or of a
/// function there.
pub(crate) fn mentions(name: &str) -> bool {
    let mut texts = ELEMENTARY.iter().map(|part| part.text).chain(UNIT);
    let is_name = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let is_in = |text: &str| text.split(|c| !is_name(c)).any(|word| word == name);
    name.contains(|c: char| !c.is_ascii_alphabetic()) && texts.any(is_in)
}

/// The elementary functions that a text calls, with their notice.
pub(crate) fn elementary(text: &str) -> String {
    let mut wanted: Vec<&str> = Vec::new();
    for part in ELEMENTARY.iter().rev() {
        if text.contains(&format!("{}(", part.name)) || wanted.contains(&part.name) {
            wanted.push(part.name);
            wanted.extend(part.needs);
        }
    }
    if wanted.is_empty() {
        return String::new();
    }
    let parts = ELEMENTARY.iter().filter(|part| wanted.contains(&part.name));
    let texts: Vec<&str> = parts.map(|part| part.text).collect();
    // What warns of conversions, which these functions were not written for.
    let ignored = ["conversion", "sign-conversion", "float-conversion", "double-promotion"];
    let ignored = ignored.map(|of| format!("#pragma GCC diagnostic ignored \"-W{of}\"\n")).concat();
    format!(
        "\n{}\n#if defined(__GNUC__)\n#pragma GCC diagnostic push\n{ignored}#endif\n\n{}\n#if defined(__GNUC__)\n\
         #pragma GCC diagnostic pop\n#endif\n",
        include_str!("../c/libm/words.c"),
        texts.join("\n")
    )
}

/// The solver's part of a header.
pub(crate) const SOLVER_HEADER: &str = include_str!("../c/solver/solver.h");

/// The solver.
pub(crate) const SOLVER: &[&str] = &[
    include_str!("../c/solver/methods_head.c"),
    include_str!("../c/solver/orientations.c"),
    include_str!("../c/solver/rk4.c"),
    include_str!("../c/solver/tsit5.c"),
    include_str!("../c/solver/dop853.c"),
];

/// The implicit method, which takes a Jacobian.
pub(crate) const RODAS4: &str = include_str!("../c/solver/rodas4.c");

/// What goes around the methods.
pub(crate) const CONTROL: &[&str] = &[
    include_str!("../c/solver/solver.c"),
    include_str!("../c/solver/steps.c"),
    include_str!("../c/solver/adaptive.c"),
    include_str!("../c/solver/public.c"),
];

/// Singular poses of loops; it goes before the steps.
pub(crate) const POSES: &str = include_str!("../c/solver/poses.c");

/// The interface of units, FMI 3.0.
pub(crate) const UNIT: [&str; 7] = [
    include_str!("../c/fmi/instances.c"),
    include_str!("../c/fmi/variables.c"),
    include_str!("../c/fmi/whole_state.c"),
    include_str!("../c/fmi/derivatives.c"),
    include_str!("../c/fmi/absent.c"),
    include_str!("../c/fmi/exchange.c"),
    include_str!("../c/fmi/cosimulation.c"),
];

/// Curves of tables.
pub(crate) const SPLINE: &str = include_str!("../c/spline.c");

/// Curves that are called, after [`SPLINE`].
pub(crate) const CURVE: &str = include_str!("../c/curve.c");

/// Names that the run time has for what depends on the number type.
pub(crate) fn arithmetic(precision: Precision) -> &'static str {
    match precision {
        Precision::F64 => "#define FABS fabs\n#define SQRT sqrt\n#define EPSILON DBL_EPSILON\n",
        Precision::F32 => "#define FABS fabsf\n#define SQRT sqrtf\n#define EPSILON FLT_EPSILON\n",
    }
}
