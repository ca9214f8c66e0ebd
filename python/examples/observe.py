"""A Kalman filter for a pendulum whose angle is measured with noise: it finds the rate, which is not measured."""

import numpy as np
from scipy.linalg import expm

import gyro_sim as gyro

PENDULUM = """
format = 1
name = "pendulum"
gravity = [0, -9.81, 0]

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
angle_deg = 90
"""

rng = np.random.default_rng(1)
pendulum = gyro.loads(PENDULUM)
dt, noise = 0.01, 0.05
truth = pendulum.simulate(5.0, tolerance=1e-10, every=dt)
measured = truth["hinge"] + noise * rng.normal(size=len(truth))

# The extended filter: the mechanism predicts, its linearisation carries the covariance along.
H, Q, R = np.array([[1.0, 0.0]]), np.diag([1e-10, 1e-6]), np.array([[noise**2]])
estimate, P = np.array([measured[0], 0.0]), np.diag([noise**2, 1.0])
stepper, found = pendulum.stepper(dt, estimate), [estimate]
for z in measured[1:]:
    F = expm(pendulum.linearize(estimate).A * dt)
    stepper.restart(estimate)
    estimate, P = stepper.step(), F @ P @ F.T + Q
    gain = P @ H.T @ np.linalg.inv(H @ P @ H.T + R)
    estimate = estimate + gain @ (z - H @ estimate)
    P = (np.eye(2) - gain @ H) @ P
    found.append(estimate)
angle, rate = np.array(found).T
late = truth.t > 1
errors = [np.sqrt(np.mean((a - b)[late] ** 2)) for a, b in ((angle, truth["hinge"]), (rate, truth.rate("hinge")))]
print(f"noise {noise} rad; error of the angle {errors[0]:.4f} rad, of the rate {errors[1]:.4f} rad/s")
assert errors[0] < noise / 3 and errors[1] < 0.1
