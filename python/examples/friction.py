"""Bearing friction of a pendulum from a measured swing: least squares with sensitivities of the generated functions."""

import numpy as np
from scipy.optimize import least_squares

import gyro_sim as gyro

PENDULUM = """
format = 1
name = "swing"
gravity = [0, -9.81, 0]

[parameters]
viscous = 0.01          # N m s/rad
dry = 0.01              # N m

[[body]]
name = "wall"
fixed = true

[[body]]
name = "rod"
mass = 1
inertia = [0.0833, 1e-4, 0.0833]

[[joint]]
name = "hinge"
kind = "revolute"
axis = [0, 0, 1]
zero = [0, -1, 0]
first = { body = "wall" }
second = { body = "rod", point = [0, 0.5, 0] }
angle_deg = 60

[[force]]
name = "grease"
kind = "damper"
joint = "hinge"
damping = "viscous"

[[force]]
name = "rubbing"
kind = "coulomb"
joint = "hinge"
level = "dry"
rate = 0.05
"""

NAMES, TRUE, NOISE = ["viscous", "dry"], np.array([0.02, 0.05]), 1e-3
pendulum = gyro.loads(PENDULUM)
pendulum.set(viscous=TRUE[0], dry=TRUE[1])
swing = pendulum.simulate(4.0, tolerance=1e-10, every=0.02)
measured = swing["hinge"] + NOISE * np.random.default_rng(3).normal(size=len(swing))


def motion(parameters):
    pendulum.set(**dict(zip(NAMES, parameters)))
    states, slopes = pendulum.sensitivities(swing.t, NAMES, step=0.01)
    return states[:, 0], slopes[:, 0, :]


fit = least_squares(
    lambda p: (motion(p)[0] - measured) / NOISE, [0.01, 0.01], jac=lambda p: motion(p)[1] / NOISE, bounds=(0, np.inf),
    x_scale=[0.01, 0.01],
)
spread = np.sqrt(np.diag(np.linalg.inv(fit.jac.T @ fit.jac)))
for name, found, sigma, true in zip(NAMES, fit.x, spread, TRUE):
    print(f"{name}: {found:.5f} ± {sigma:.5f}, true {true}")
assert (np.abs(fit.x - TRUE) < 4 * spread).all() and fit.nfev < 30
