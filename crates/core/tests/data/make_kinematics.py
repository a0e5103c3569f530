#!/usr/bin/env python3
"""Golden data for the kinematics: poses, Jacobians and accelerations by Pinocchio.

    pip install pin==4.1.0
    python3 make_kinematics.py > kinematics.csv

Each arm is built here from published numbers as a chain of joints, without any of Seamline's code: joint axes and the
points they pass through at zero, in the base frame (metres), and the flange at zero.

A row: name, number of joints n, q (n), position (3), quaternion xyzw (4), Jacobian (6 n, row-major: linear rows first,
base frame, at the flange), joint velocity (n), joint acceleration (n), flange acceleration (6: of the flange's origin,
then angular; base frame).
"""
import math
import sys

import numpy as np
import pinocchio as pin

SAMPLES = 25
X, Y, Z = np.eye(3)


def rotation(x_axis, z_axis):
    """Rotation matrix whose x and z columns are given."""
    return np.column_stack([x_axis, np.cross(z_axis, x_axis), z_axis])


def ar2010():
    """Yaskawa AR2010 class: dimensions and axes as in the maker's drawings, see SPEC 10.3."""
    axes = [(Z, (0, 0, 0)), (Y, (0.150, 0, 0)), (-Y, (0.150, 0, 0.760)),
            (-X, (0.150, 0, 0.960)), (-Y, (1.232, 0, 0.960)), (-X, (1.332, 0, 0.960))]
    flange = pin.SE3(rotation(Z, X), np.array([1.332, 0, 0.960]))
    limits = [(-180, 180), (-105, 155), (-86, 160), (-150, 150), (-135, 90), (-210, 210)]
    return [("r", *axis) for axis in axes], flange, np.radians(limits)


def irb2400():
    """ABB IRB 2400/10: dimensions of the maker's product specification."""
    axes = [(Z, (0, 0, 0)), (Y, (0.100, 0, 0.615)), (Y, (0.100, 0, 1.320)),
            (X, (0.100, 0, 1.455)), (Y, (0.855, 0, 1.455)), (X, (0.940, 0, 1.455))]
    flange = pin.SE3(rotation(-Z, X), np.array([0.940, 0, 1.455]))
    limits = [(-180, 180), (-100, 110), (-60, 65), (-200, 200), (-120, 120), (-400, 400)]
    return [("r", *axis) for axis in axes], flange, np.radians(limits)


def ur5e():
    """Universal Robots UR5e: the maker's DH table (a, alpha, d), multiplied out at zero."""
    table = [(0, math.pi / 2, 0.1625), (-0.425, 0, 0), (-0.3922, 0, 0),
             (0, math.pi / 2, 0.1333), (0, -math.pi / 2, 0.0997), (0, 0, 0.0996)]
    joints, frame = [], np.eye(4)
    for a, alpha, d in table:
        joints.append(("r", frame[:3, 2].copy(), frame[:3, 3].copy()))
        c, s = math.cos(alpha), math.sin(alpha)
        frame = frame @ np.array([[1, 0, 0, a], [0, c, -s, 0], [0, s, c, d], [0, 0, 0, 1]])
    return joints, pin.SE3(frame), np.array([(-2 * math.pi, 2 * math.pi)] * 6)


def scara600():
    """Links of 325 and 275 mm, stroke along +z, flange looking down."""
    joints = [("r", Z, (0, 0, 0)), ("r", Z, (0.325, 0, 0)), ("p", Z, (0.6, 0, 0)), ("r", Z, (0.6, 0, 0))]
    flange = pin.SE3(rotation(X, -Z), np.array([0.6, 0, 0]))
    degree = math.pi / 180
    limits = [(-132 * degree, 132 * degree), (-160 * degree, 160 * degree), (-0.2, 0), (-2 * math.pi, 2 * math.pi)]
    return joints, flange, np.array(limits)


def build(joints, flange):
    model, parent, last = pin.Model(), 0, np.zeros(3)
    for i, (kind, axis, point) in enumerate(joints):
        point = np.array(point, dtype=float)
        make = pin.JointModelRevoluteUnaligned if kind == "r" else pin.JointModelPrismaticUnaligned
        placement = pin.SE3(np.eye(3), point - last)
        parent = model.addJoint(parent, make(*[float(x) for x in axis]), placement, f"joint{i + 1}")
        last = point
    offset = pin.SE3(flange.rotation, flange.translation - last)
    frame = model.addFrame(pin.Frame("flange", parent, 0, offset, pin.FrameType.OP_FRAME))
    return model, frame


def rows(name, joints, flange, limits, random):
    model, frame = build(joints, flange)
    data, n = model.createData(), model.nv
    world = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
    for sample in range(SAMPLES):
        q = np.zeros(n) if sample == 0 else random.uniform(limits[:, 0], limits[:, 1])
        velocity, acceleration = random.uniform(-1, 1, n), random.uniform(-1, 1, n)
        jacobian = pin.computeFrameJacobian(model, data, q, frame, world)
        pin.forwardKinematics(model, data, q, velocity, acceleration)
        pose = pin.updateFramePlacement(model, data, frame)
        flange_acceleration = pin.getFrameClassicalAcceleration(model, data, frame, world).vector
        numbers = [q, pose.translation, pin.Quaternion(pose.rotation).coeffs(), jacobian.flatten(),
                   velocity, acceleration, flange_acceleration]
        # Rounding around zero carries no information.
        text = [repr(float(x)) if abs(x) > 1e-15 else "0" for x in np.concatenate(numbers)]
        yield ",".join([name, str(n), *text])


def main():
    random = np.random.default_rng(2010)
    print(f"# made by make_kinematics.py with Pinocchio {pin.__version__}")
    for arm in (ar2010, irb2400, ur5e, scara600):
        sys.stdout.writelines(row + "\n" for row in rows(arm.__name__, *arm(), random))


if __name__ == "__main__":
    main()
