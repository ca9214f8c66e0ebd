"""Robots as all contenders see them: the same tree of joints, angles and masses."""

import math
import tomllib
import xml.etree.ElementTree as ET
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pinocchio as pin

from plain_aba import Joint


@dataclass
class Robot:
    name: str
    file: str  # in the package's folder of robots
    floats: bool = False

    @property
    def key(self):
        return self.name.replace(" ", "_").replace(",", "")


ROBOTS = [
    Robot("ur5", "ur_description/urdf/ur5_robot.urdf"),
    Robot("panda with fingers", "panda_description/urdf/panda.urdf"),
    Robot("kinova", "kinova_description/robots/kinova.urdf"),
    Robot("xarm7", "xarm_description/urdf/xarm7.urdf"),
    Robot("allegro hand", "allegro_hand_description/urdf/allegro_left_hand.urdf"),
    Robot("solo12", "solo_description/robots/solo12.urdf"),
    Robot("solo12, floating", "solo_description/robots/solo12.urdf", True),
    Robot("go2, floating", "go2_description/urdf/go2.urdf", True),
    Robot("simple_humanoid", "simple_humanoid_description/urdf/simple_humanoid.urdf"),
    Robot("simple_humanoid, floating", "simple_humanoid_description/urdf/simple_humanoid.urdf", True),
    Robot("g1, floating", "g1_description/urdf/g1_29dof_rev_1_0.urdf", True),
    Robot("talos, floating", "talos_data/robots/talos_reduced.urdf", True),
]


def meant(written):
    """A multiple of 45 or 30 degrees where one was rounded, as the importer has it."""
    angle = float(written)
    decimals = len(written.partition(".")[2]) if "e" not in written.lower() else 0
    units = (math.pi / 4, math.pi / 6)
    nearest = min((round(angle / unit) * unit for unit in units), key=lambda multiple: abs(multiple - angle))
    off = abs(nearest - angle)
    return nearest if nearest and (off <= 1e-6 or (decimals >= 4 and off < 10.0**-decimals)) else angle


def tidy(source, target):
    """The robot without what forward dynamics of free joints does not have: shapes, friction, couplings, limits."""
    tree = ET.parse(source)
    for joint in tree.getroot().findall("joint"):
        for tag in ("mimic", "dynamics", "limit"):
            for element in joint.findall(tag):
                joint.remove(element)
        if joint.get("type") == "continuous":
            joint.set("type", "revolute")
        if joint.get("type") in ("revolute", "prismatic"):
            ET.SubElement(joint, "limit", lower="-100", upper="100", effort="100", velocity="100")
        for axis in joint.findall("axis"):
            xyz = np.array([float(x) for x in axis.get("xyz").split()])
            if xyz.any():
                axis.set("xyz", " ".join(repr(float(x)) for x in xyz / np.linalg.norm(xyz)))
    for link in tree.getroot().findall("link"):
        for tag in ("visual", "collision"):
            for element in link.findall(tag):
                link.remove(element)
    for origin in tree.iter("origin"):
        if origin.get("rpy"):
            origin.set("rpy", " ".join(repr(meant(angle)) for angle in origin.get("rpy").split()))
    tree.write(target)


def pinocchio_model(file, floats):
    root = [pin.JointModelFreeFlyer()] if floats else []
    model = pin.buildModelFromUrdf(str(file), *root)
    model.armature[:] = 0
    return model


def clean(numbers):
    """Without what rotations leave of 0 and 1."""
    numbers = np.array(numbers, float)
    whole = np.round(numbers)
    return np.where(abs(numbers - whole) < 1e-12, whole + 0.0, numbers)


def joints(model):
    """The joints of a model, fixed ones lumped by Pinocchio."""
    found = []
    for index in range(1, model.njoints):
        joint, place, inertia = model.joints[index], model.jointPlacements[index], model.inertias[index]
        name, axis = joint.shortname(), np.zeros(3)
        kind = "floating" if "FreeFlyer" in name else "revolute" if name.startswith("JointModelR") else "prismatic"
        if kind != "floating":
            data, rate = model.createData(), np.zeros(model.nv)
            rate[joint.idx_v] = 1
            pin.forwardKinematics(model, data, pin.neutral(model), rate)
            axis = clean(data.v[index].angular if kind == "revolute" else data.v[index].linear)
        found.append(
            Joint(model.parents[index], kind, axis, clean(place.rotation), clean(place.translation), inertia.mass,
                  clean(inertia.lever), clean(inertia.inertia))
        )
    return found


def write_list(joints, file):
    """The list that model.hpp reads."""
    lower = np.tril_indices(3)
    rows = [
        [str(j.parent), j.kind]
        + [repr(float(x)) for x in (*j.axis, *j.rotation.ravel(), *j.translation, j.mass, *j.centre, *j.inertia[lower])]
        for j in joints
    ]
    Path(file).write_text("".join(" ".join(row) + "\n" for row in rows))


class Order:
    """Which joint of our model file is which of Pinocchio's."""

    def __init__(self, urdf, toml, model):
        moving = [j.get("name") for j in ET.parse(urdf).getroot().findall("joint") if j.get("type") != "fixed"]
        page = tomllib.loads(Path(toml).read_text())
        assert len(page["joint"]) == len(moving)
        self.rates = [model.joints[model.getJointId(name)].idx_v for name in moving]
        self.coordinates = [model.joints[model.getJointId(name)].idx_q for name in moving]
        self.model = model

    def state(self, places, length, q, v):
        """Our joint state of a state of Pinocchio's."""
        x, u = [], []
        for place in places:
            if place >= 0:
                x.append(q[self.coordinates[place]])
                u.append(v[self.rates[place]])
                continue
            turn = pin.Quaternion(q[6], q[3], q[4], q[5]).toRotationMatrix()
            centre = self.model.inertias[1].lever
            x += [*(q[:3] + turn @ centre), q[6], q[3], q[4], q[5]]
            u += [*(turn @ (v[:3] + np.cross(v[3:6], centre))), *v[3:6]]
        # Then the work of the motors.
        return np.array(x + u + [0.0] * (length - len(x) - len(u)))

    def torques(self, tau):
        """Our inputs."""
        return np.array([tau[rate] for rate in self.rates])

    def accelerations(self, places, out, q, v):
        """Pinocchio's accelerations of ours."""
        found, at = np.zeros(self.model.nv), 0
        for place in places:
            if place >= 0:
                found[self.rates[place]] = out[at]
                at += 1
                continue
            turn = pin.Quaternion(q[6], q[3], q[4], q[5]).toRotationMatrix()
            centre, w, alpha = self.model.inertias[1].lever, v[3:6], out[at + 3 : at + 6]
            at_centre = turn.T @ out[at : at + 3]
            of_frame = at_centre - np.cross(alpha, centre) - np.cross(w, np.cross(w, centre))
            found[:3], found[3:6] = of_frame - np.cross(w, v[:3]), alpha
            at += 6
        return found
