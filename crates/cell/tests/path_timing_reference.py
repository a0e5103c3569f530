"""Compares the timings of random moves with TOPP-RA, which knows no jerk limit.

By hand, with numpy and toppra from PyPI (0.6 was used):

    cargo run --release -p seamline-cell --example path_timing -- 250 FOLDER
    python crates/cell/tests/path_timing_reference.py FOLDER [crates/cell/tests/data/path_timing_toppra.csv]

The second argument is where the reference times are written, for the test that watches over them.
"""

import logging
import pathlib
import sys

import numpy as np
import toppra
import toppra.algorithm
import toppra.constraint
from toppra.interpolator import AbstractGeometricPath

VELOCITY = np.radians([210.0, 210.0, 220.0, 435.0, 435.0, 700.0])
ACCELERATION = np.radians([1050.0, 1050.0, 1100.0, 3480.0, 3480.0, 5600.0])


class Tabulated(AbstractGeometricPath):
    """Seven joints on a grid: the arm's six, and the path coordinate itself."""

    def __init__(self, places, first, second):
        self.places = places
        one = np.ones((len(places), 1))
        self.tables = [np.zeros((len(places), 7)), np.hstack([first, one]), np.hstack([second, 0.0 * one])]

    def __call__(self, path_positions, order=0):
        index = np.searchsorted(self.places, path_positions)
        return self.tables[order][np.clip(index, 0, len(self.places) - 1)]

    @property
    def dof(self):
        return 7

    @property
    def path_interval(self):
        return np.array([self.places[0], self.places[-1]])

    @property
    def waypoints(self):
        return None


def duration(path, speed, acceleration, scheme):
    v = np.append(VELOCITY, speed)
    a = np.append(ACCELERATION, acceleration)
    constraints = [
        toppra.constraint.JointVelocityConstraint(np.stack([-v, v], axis=1)),
        toppra.constraint.JointAccelerationConstraint(np.stack([-a, a], axis=1), discretization_scheme=scheme),
    ]
    instance = toppra.algorithm.TOPPRA(constraints, path, gridpoints=path.places, solver_wrapper="seidel")
    _, speeds, _ = instance.compute_parameterization(0, 0)
    if speeds is None or not np.all(np.isfinite(speeds)):
        return np.nan
    return np.sum(2.0 * np.diff(path.places) / (speeds[1:] + speeds[:-1]))


def report(name, ratios):
    values = np.array(sorted(ratio[0] for ratio in ratios))
    print(f"{name}, {len(values)}: ours / TOPP-RA least {values[0]:.4f}, median {np.median(values):.4f}, "
          f"95 % {np.quantile(values, 0.95):.4f}, greatest {values[-1]:.4f}")


def main():
    logging.getLogger("toppra").setLevel(logging.CRITICAL)
    ratios, failed = [], 0
    for file in sorted(pathlib.Path(sys.argv[1]).glob("*.bin")):
        numbers = np.fromfile(file, "<f8")
        ours, optimized, length, speed, acceleration = numbers[:5]
        rows = numbers[5:].reshape(-1, 13)
        # A path of length 1 keeps TOPP-RA's solver in its range.
        path = Tabulated(rows[:, 0] / length, rows[:, 1:7] * length, rows[:, 7:13] * length**2)
        found = np.nan
        for scheme in (toppra.constraint.DiscretizationType.Interpolation,
                       toppra.constraint.DiscretizationType.Collocation):
            if not np.isfinite(found):
                found = duration(path, speed / length, acceleration / length, scheme)
        if np.isfinite(found):
            ratios.append((ours / found, file.stem, ours, found, optimized))
        else:
            failed += 1
    print(f"TOPP-RA failed on {failed} moves")
    report("all moves", ratios)
    report("moves that a joint slows", [ratio for ratio in ratios if ratio[4]])
    if len(sys.argv) > 2:
        with open(sys.argv[2], "w", encoding="utf-8") as table:
            table.write("# Times of TOPP-RA (toppra 0.6, PyPI; velocity and acceleration limits, no jerk limit) on the moves\n"
                        "# of the example path_timing; made by crates/cell/tests/path_timing_reference.py.\n"
                        "move,seconds\n")
            table.writelines(f"{int(ratio[1])},{ratio[3]:.5f}\n" for ratio in ratios)
    ratios.sort()
    for ratio in ratios[-5:]:
        print("  %.4f  move %s: %.4f s against %.4f s" % ratio[:4])


if __name__ == "__main__":
    main()
