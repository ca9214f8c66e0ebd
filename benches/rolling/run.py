"""A disc that rolls around a circle: error against run time, by gyro and by peers.

    pip install exudyn mujoco numpy
    python run.py path/to/gyro

The scene is examples/rolling/disc.toml: after each pi seconds the centre of the disc is where it was, whatever the
method. Each line is the least of five runs of fifteen turns, in turns; the time is what integration takes, without
reading, deriving or compiling.
"""

import json
import math
import pathlib
import subprocess
import sys
import tempfile
import time

import exudyn
import exudyn.utilities as exu
import mujoco
import numpy as np

K, R, M, TURN, G, TURNS = 0.2, 0.3, 2.0, 2.0, 9.81, 15
SINE, COSINE = 2 * K / (1 + K * K), (1 - K * K) / (1 + K * K)
ACROSS, ABOUT = M * R * R / 4, M * R * R / 2
SPIN = (ACROSS * TURN**2 * COSINE * SINE - M * G * R * SINE) / (TURN * COSINE * (ABOUT + M * R * R))
CENTRE = np.array([0, 0, R * COSINE])
QUATERNION = np.array([1, K, 0, 0]) / math.hypot(1, K)
END = TURNS * math.pi
PAGE = pathlib.Path(__file__).parents[2] / "examples/rolling/disc.toml"


def turned():
    """The disc's axes as columns; the disc's own axis is y."""
    sine, cosine = SINE, COSINE
    return np.array([[1, 0, 0], [0, cosine, -sine], [0, sine, cosine]])


def off(place):
    return float(np.linalg.norm(np.asarray(place) - CENTRE))


def gyro(program, options):
    """By the command: its own figure of what the run took."""

    def run():
        with tempfile.TemporaryDirectory() as folder:
            command = [program, "simulate", PAGE, "--json", "--quiet", "--no-prove", "--t-end", repr(END)]
            command += ["--every", repr(END), *options, "--out", folder]
            told = json.loads(subprocess.run(command, check=True, capture_output=True).stdout)
        return told["run_time_s"], off(told["outputs"]["at"][:3])

    return run


def exudyn_disc(steps, penalty=None):
    """A constraint, or a penalty of this stiffness."""

    def run():
        system = exudyn.SystemContainer()
        mbs = system.AddSystem()
        ground = mbs.CreateGround()
        inertia = exu.RigidBodyInertia(M, np.diag([ACROSS, ABOUT, ACROSS]))
        body = mbs.CreateRigidBody(
            inertia=inertia,
            referencePosition=CENTRE,
            referenceRotationMatrix=turned(),
            initialVelocity=[R * SPIN, 0, 0],
            initialAngularVelocity=list(turned() @ [0, SPIN, TURN * COSINE]),
            gravity=[0, 0, -G],
        )
        common = dict(axisPosition=[0, 0, 0], axisVector=[0, 1, 0], planePosition=[0, 0, 0], planeNormal=[0, 0, 1])
        if penalty is None:
            mbs.CreateRollingDisc(bodyNumbers=[ground, body], discRadius=R, **common)
        else:
            mbs.CreateRollingDiscPenalty(
                bodyNumbers=[ground, body],
                discRadius=R,
                contactStiffness=penalty,
                contactDamping=2 * math.sqrt(penalty * M),
                dryFriction=[2, 2],
                dryFrictionProportionalZone=1e-5,
                **common,
            )
        mbs.Assemble()
        settings = exudyn.SimulationSettings()
        settings.timeIntegration.endTime = END
        settings.timeIntegration.numberOfSteps = steps
        settings.timeIntegration.verboseMode = 0
        settings.solutionSettings.writeSolutionToFile = False
        settings.timeIntegration.newton.useModifiedNewton = True
        began = time.perf_counter()
        mbs.SolveDynamic(settings)
        took = time.perf_counter() - began
        return took, off(mbs.GetObjectOutputBody(body, exudyn.OutputVariableType.Position, [0, 0, 0]))

    return run


def mujoco_disc(step):
    """A thin cylinder on a plane; its axis is z."""
    model = mujoco.MjModel.from_xml_string(
        f"""<mujoco><option timestep="{step}" gravity="0 0 -{G}" integrator="RK4" cone="elliptic" impratio="100"/>
        <worldbody><geom type="plane" size="9 9 1" friction="2 0 0" condim="3" solref="{max(2 * step, 1e-4)} 1"/>
        <body><freejoint/><inertial pos="0 0 0" mass="{M}" diaginertia="{ACROSS} {ACROSS} {ABOUT}"/>
        <geom type="cylinder" size="{R} 1e-5" friction="2 0 0" condim="3" solref="{max(2 * step, 1e-4)} 1"/>
        </body></worldbody></mujoco>"""
    )

    def run():
        data = mujoco.MjData(model)
        # From axes with y along the disc's axis to those with z along it.
        to = np.array([math.sqrt(0.5), -math.sqrt(0.5), 0, 0])
        own = np.zeros(4)
        mujoco.mju_mulQuat(own, QUATERNION, to)
        data.qpos[:] = [*CENTRE, *own]
        data.qvel[:] = [R * SPIN, 0, 0, 0, -TURN * COSINE, SPIN]
        steps = round(END / step)
        began = time.perf_counter()
        mujoco.mj_step(model, data, nstep=steps)
        return time.perf_counter() - began, off(data.qpos[:3])

    return run


def main():
    program = sys.argv[1]
    joint = [["--tolerance", t] for t in ("1e-4", "1e-6", "1e-8", "1e-10")]
    ways = {f"gyro, dop853 at {o[1]}": gyro(program, o) for o in joint}
    ways |= {f"gyro, rk4 at {h} s": gyro(program, ["--step", h]) for h in ("1e-2", "2e-3")}
    ways |= {f"exudyn, constraint, step {END / n:.0e} s": exudyn_disc(n) for n in (5000, 50000, 500000)}
    ways |= {f"exudyn, penalty 1e6 N/m, step {END / n:.0e} s": exudyn_disc(n, 1e6) for n in (50000, 500000)}
    ways |= {f"mujoco, step {h:.0e} s": mujoco_disc(h) for h in (1e-3, 1e-4)}
    found = {}
    for _ in range(5):
        for name, run in ways.items():
            if name in found and found[name][0] > 20:
                continue
            took, error = run()
            found[name] = min(found.get(name, (math.inf, error)), (took, error))
    print(f"| {TURNS} turns | time, ms | error, m |\n|---|---|---|")
    for name, (took, error) in found.items():
        print(f"| {name} | {1e3 * took:.2f} | {error:.1e} |")


if __name__ == "__main__":
    main()
