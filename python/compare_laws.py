"""Three mechanisms with laws beside code that SymPy makes of their equations, at equal error.

    pip install sympy scipy
    python compare_laws.py path/to/gyro

A load on the wire of a crane, a slider-crank on a motor with its current, and a quadrotor. SymPy's equations are those
that an engineer derives by hand or by its `mechanics`, as C with common subexpressions taken out, in the same method: DOP853
with the coefficients that scipy has. This project's are `gyro export c` of the model file below, with the solver that is
exported. Both are compiled by one compiler with the same options. The error is the largest of the compared numbers at the
end, over their size, against runs of both at 1e-13, which must agree. Each gets the loosest tolerance with which its error
is at most 1e-9, and they are timed in turns: the median of the ratios counts, and the least of the times.
"""

from __future__ import annotations

import ctypes
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import sympy as sp
from scipy.integrate._ivp import dop853_coefficients as dop
from sympy.physics import mechanics as me

TARGET, ROUNDS = 1e-9, 101
LAWS = Path(__file__).resolve().parents[1] / "examples/laws"
CC = [os.environ.get("CC", "cc"), "-std=c99", "-O2", "-ffp-contract=off", "-fPIC", "-shared"]

CRANE = """
format = 1
name = "crane"
gravity = [0, -9.81, 0]
count_work = false
[[body]]
name = "beam"
fixed = true
[[body]]
name = "trolley"
driven = { translation = ["step(t, 0.5, 0, 3, 2)", 0, 0] }
[[body]]
name = "load"
mass = 50
inertia = [2, 2, 2]
[[joint]]
name = "swing"
kind = "planar"
axis = [0, 0, 1]
zero = [1, 0, 0]
first = { body = "beam" }
second = { body = "load" }
y = -4.02
[[driver]]                       # as SymPy's particle, which does not turn
name = "upright"
joint = "swing"
coordinate = "angle"
motion = 0
[[formula]]
name = "out"
of = "4 - step(t, 1, 0, 4, 1.5)"
[[element]]
name = "wire"
kind = "wire"
first = { body = "trolley" }
second = { body = "load" }
stiffness = 25e3
damping = 600
free_length = "out"
"""

t = sp.Symbol("t")


def step(x, x0, y0, x1, y1):
    s = sp.Min(sp.Max((x - x0) / (x1 - x0), 0), 1)
    return y0 + (y1 - y0) * s**2 * (3 - 2 * s)


def crane():
    """A particle in the plane."""
    x, y, vx, vy = y0 = sp.symbols("x y vx vy")
    trolley, out = step(t, 0.5, 0, 3, 2), 4 - step(t, 1, 0, 4, 1.5)
    s = sp.Min(sp.Max((t - sp.Float(0.5)) / sp.Float(2.5), 0), 1)
    trolley_rate = 2 * 6 * s * (1 - s) / sp.Float(2.5)
    dx, dv = x - trolley, vx - trolley_rate
    length = sp.sqrt(dx**2 + y**2)
    pull = 25e3 * (length - out) + 600 * (dx * dv + y * vy) / length
    pull = sp.Piecewise((sp.Max(pull, 0), length > out), (0, True))
    rates = [vx, vy, -pull * dx / length / 50, -pull * y / length / 50 - 9.81]
    return CRANE, 4.0, y0, rates, [0, -4.02, 0, 0], {"JOINT_X_SWING": 0, "JOINT_Y_SWING": 1}


def slider_crank():
    """Kane's method with one independent coordinate, the dependent ones by their velocities."""
    r, l = sp.Rational(1, 20), sp.Rational(1, 5)
    q1, q2, q3 = q = me.dynamicsymbols("q1 q2 q3")  # crank, rod against the x axis, piston
    u1, u2, u3 = u = me.dynamicsymbols("u1 u2 u3")
    i = sp.Symbol("i")
    N = me.ReferenceFrame("N")
    A, B = N.orientnew("A", "Axis", (q1, N.z)), N.orientnew("B", "Axis", (q2, N.z))
    A.set_ang_vel(N, u1 * N.z)
    B.set_ang_vel(N, u2 * N.z)
    O = me.Point("O")
    O.set_vel(N, 0)
    P = O.locatenew("P", r * A.x)
    P.v2pt_theory(O, N, A)
    C = P.locatenew("C", l / 2 * B.x)
    C.v2pt_theory(P, N, B)
    S = O.locatenew("S", q3 * N.x)
    S.set_vel(N, u3 * N.x)
    inertia = lambda frame, zz: me.inertia(frame, 0, 0, zz)
    bodies = [
        me.RigidBody("crank", O, A, sp.Float(0.4), (inertia(A, 8e-4), O)),
        me.RigidBody("rod", C, B, sp.Float(0.3), (inertia(B, 1.2e-3), C)),
        me.Particle("piston", S, sp.Float(0.5)),
    ]
    loads = [
        (A, (sp.Float(0.08) * i - sp.Float(1e-3) * u1) * N.z),
        (S, sp.Piecewise((-60 * u3, u3 > 0), (-5 * u3, True)) * N.x),
    ]
    gap = [r * sp.cos(q1) + l * sp.cos(q2) - q3, r * sp.sin(q1) + l * sp.sin(q2)]
    moved = dict(zip([s.diff() for s in q], u))
    kane = me.KanesMethod(
        N, [q1], [u1], kd_eqs=[s.diff() - w for s, w in zip(q, u)],
        q_dependent=[q2, q3], u_dependent=[u2, u3], configuration_constraints=gap,
        velocity_constraints=[sp.diff(g, me.dynamicsymbols._t).subs(moved) for g in gap],
    )
    kane.kanes_equations(bodies, loads)
    plain = dict(zip([*q, *u], sp.symbols("a b x wa wb vx")))
    mass, forcing = (m.subs(moved).subs(plain) for m in (kane.mass_matrix, kane.forcing))
    accelerations = mass.LUsolve(forcing)
    states = [*plain.values(), i]
    rates = [*states[3:6], *accelerations, (24 - sp.Float(1.2) * i - sp.Float(0.08) * plain[u1]) / sp.Float(5e-3)]
    a0 = 1.0
    b0 = -np.arcsin(0.05 * np.sin(a0) / 0.2)
    start = [a0, b0, 0.05 * np.cos(a0) + 0.2 * np.cos(b0), 0, 0, 0, 0]
    page = (LAWS / "dc_motor.toml").read_text().replace("[simulation]", "count_work = false\n[simulation]", 1)
    return page, 0.5, states, rates, start, {"JOINT_SHAFT": 0, "JOINT_CYLINDER": 2, "STATE_MOTOR_CURRENT": 6}


def quadrotor():
    """Newton and Euler, with Euler parameters; tilted by a front propeller that is slower than the others."""
    r, p, v, w = (sp.symbols(names) for names in ("x y z", "p0:4", "vx vy vz", "wx wy wz"))
    c, d = sp.Float(1.1e-5), sp.Float(1.6e-7)
    speeds = [-558, 560, -560, 560]
    arms = [(0.2, 0), (0, 0.2), (-0.2, 0), (0, -0.2)]
    pushes = [(-c if k % 2 == 0 else c) * s * abs(s) for k, s in enumerate(speeds)]
    torque = [
        sum(arm[1] * push for arm, push in zip(arms, pushes)),
        -sum(arm[0] * push for arm, push in zip(arms, pushes)),
        -sum(d * s * abs(s) for s in speeds),
    ]
    p0, p1, p2, p3 = p
    axis = [2 * (p1 * p3 + p0 * p2), 2 * (p2 * p3 - p0 * p1), 1 - 2 * (p1**2 + p2**2)]
    speed = sp.sqrt(sum(s**2 for s in v) + sp.Float(1e-12))
    lift = sum(pushes)
    accelerations = [
        (lift * axis[k] - sp.Float(0.5 * 1.2 * 0.09 * 1.1) * speed * v[k]) / sp.Float(1.2) - (sp.Float(9.81) if k == 2 else 0)
        for k in range(3)
    ]
    j = [sp.Float(8e-3), sp.Float(8e-3), sp.Float(0.014)]
    turning = [(torque[k] - (j[(k + 2) % 3] - j[(k + 1) % 3]) * w[(k + 1) % 3] * w[(k + 2) % 3]) / j[k] for k in range(3)]
    half = sp.Rational(1, 2)
    euler = [
        -half * (p1 * w[0] + p2 * w[1] + p3 * w[2]),
        half * (p0 * w[0] + p2 * w[2] - p3 * w[1]),
        half * (p0 * w[1] + p3 * w[0] - p1 * w[2]),
        half * (p0 * w[2] + p1 * w[1] - p2 * w[0]),
    ]
    states = [*r, *p, *v, *w]
    rates = [*v, *euler, *accelerations, *turning]
    page = (LAWS / "quadrotor.toml").read_text().replace("front = 560", "front = 558", 1)
    page = page.replace("[simulation]", "count_work = false\n[simulation]", 1)
    return page, 3.0, states, rates, [0, 0, 0, 1] + [0] * 9, {f"BODY_FRAME+{k}": k for k in range(7)}


INTEGRATOR = """
#include <math.h>
#include <string.h>
static const double A[12][12] = {%(a)s}, C[12] = {%(c)s}, B[12] = {%(b)s}, E3[13] = {%(e3)s}, E5[13] = {%(e5)s};
static void f(double t, const double *state, double *rate) {
%(body)s}
/* Steps to the end by DOP853, after Hairer, Norsett and Wanner; returns how many derivatives were computed. */
long run(double tolerance, double end, double *y) {
    static double k[13][N];
    double t = 0, h = 1e-4, z[N];
    long count = 1;
    f(0, y, k[0]);
    while (t < end) {
        if (t + h > end) h = end - t;
        for (int s = 1; s < 12; s++) {
            for (int i = 0; i < N; i++) { double sum = 0; for (int j = 0; j < s; j++) sum += A[s][j] * k[j][i]; z[i] = y[i] + h * sum; }
            f(t + C[s] * h, z, k[s]);
        }
        for (int i = 0; i < N; i++) { double sum = 0; for (int j = 0; j < 12; j++) sum += B[j] * k[j][i]; z[i] = y[i] + h * sum; }
        f(t + h, z, k[12]);
        count += 12;
        double five = 0, three = 0;
        for (int i = 0; i < N; i++) {
            double a = 0, b = 0, scale = tolerance * (1 + fmax(fabs(y[i]), fabs(z[i])));
            for (int j = 0; j < 13; j++) { a += E5[j] * k[j][i]; b += E3[j] * k[j][i]; }
            five += a * a / (scale * scale); three += b * b / (scale * scale);
        }
        double error = five == 0 && three == 0 ? 0 : h * five / sqrt((five + 0.01 * three) * N);
        double factor = error == 0 ? 10 : fmin(10, fmax(0.2, 0.9 * pow(error, -0.125)));
        if (error < 1) { t += h; memcpy(y, z, sizeof z); memcpy(k[0], k[12], sizeof z); if (t >= end) break; }
        h *= factor;
    }
    return count;
}
"""

OURS = """
#include "NAME.h"
long run(double tolerance, double end, double *y) {
    static NAME m;
    static NAME_solver s;
    NAME_control control = NAME_default_control(tolerance);
    NAME_real x[UPPER_N_JOINTS];
    NAME_init(&m);
    NAME_joint_start(&m, x);
    NAME_solver_init(&s, UPPER_DOP853, 0, x);
    NAME_solver_set_control(&s, &control);
    if (NAME_solver_advance_to(&s, &m, end) != UPPER_OK) return -1;
    COPY
    return (long)s.statistics.evaluations;
}
"""


def built(source, folder, name, more=()):
    (folder / f"{name}.c").write_text(source)
    subprocess.run([*CC, "-o", folder / f"{name}.so", folder / f"{name}.c", *more, "-lm"], check=True)
    run = ctypes.CDLL(folder / f"{name}.so").run
    run.restype, run.argtypes = ctypes.c_long, [ctypes.c_double, ctypes.c_double, ctypes.POINTER(ctypes.c_double)]
    return run


def by_sympy(states, rates, start, picked, folder):
    common, exact = sp.cse([sp.nsimplify(rate) if rate == 0 else rate for rate in rates], optimizations="basic")
    lines = [f"    const double {s} = state[{k}];\n" for k, s in enumerate(states)]
    lines += [f"    const double {name} = {sp.ccode(value)};\n" for name, value in common]
    lines += [f"    rate[{k}] = {sp.ccode(value)};\n" for k, value in enumerate(exact)]
    row = lambda values: ", ".join(repr(float(value)) for value in values)
    text = INTEGRATOR % {
        "a": ", ".join("{" + row(line[:12]) + "}" for line in dop.A[:12]),
        "c": row(dop.C[:12]), "b": row(dop.B), "e3": row(dop.E3), "e5": row(dop.E5), "body": "".join(lines),
    }
    run = built(f"#define N {len(states)}\n" + text, folder, "by_sympy")
    y = (ctypes.c_double * len(states))()

    def go(tolerance, end):
        y[:] = start
        count = run(tolerance, end, y)
        return count, np.array([y[k] for k in picked.values()])

    return go


def by_gyro(gyro, page, picked, folder, name):
    model = folder / f"{name}.toml"
    model.write_text(page)
    subprocess.run([gyro, "export", "c", model, "--out", folder, "-q"], check=True, stdout=subprocess.DEVNULL)
    upper = name.upper()
    copy = " ".join(f"y[{k}] = s.y[{upper}_{key}];" for k, key in enumerate(picked))
    source = OURS.replace("NAME", name).replace("UPPER", upper).replace("COPY", copy)
    run = built(source, folder, "by_gyro", [folder / f"{name}.c"])
    y = (ctypes.c_double * len(picked))()

    def go(tolerance, end):
        count = run(tolerance, end, y)
        assert count > 0
        return count, np.array(y[:])

    return go


def compare(gyro, name, scene, folder):
    page, end, states, rates, start, picked = scene()
    both = {"gyro-sim": by_gyro(gyro, page, picked, folder, name), "SymPy": by_sympy(states, rates, start, picked, folder)}
    first, second = (go(1e-13, end)[1] for go in both.values())
    scale = np.maximum(1.0, np.abs(first))
    assert (np.abs(first - second) / scale).max() < 1e-10, (first, second)
    exact = (first + second) / 2
    error = lambda go, tolerance: (np.abs(go(tolerance, end)[1] - exact) / scale).max()
    chosen = {}
    for who, go in both.items():
        good = [tolerance for tolerance in 10.0 ** -np.arange(4, 13, 0.25) if error(go, tolerance) < TARGET]
        chosen[who] = good[0]
    times = {who: [] for who in both}
    repeat = 20
    for _ in range(ROUNDS):
        for who, go in both.items():
            began = time.perf_counter()
            for _ in range(repeat):
                go(chosen[who], end)
            times[who].append((time.perf_counter() - began) / repeat)
    ours, theirs = (np.array(times[who]) for who in both)
    print(f"{name}: to {TARGET:g} SymPy takes {np.median(theirs / ours):.2f} times as long")
    for who, go in both.items():
        count, _ = go(chosen[who], end)
        print(f"  {who:9} {1e6 * min(times[who]):8.1f} us, {count:6} derivatives, error {error(go, chosen[who]):.1e} at {chosen[who]:.1e}")


def main():
    gyro = Path(sys.argv[1]).resolve()
    for name, scene in (("crane", crane), ("dc_motor", slider_crank), ("quadrotor", quadrotor)):
        with tempfile.TemporaryDirectory() as folder:
            compare(gyro, name, scene, Path(folder))


if __name__ == "__main__":
    main()
