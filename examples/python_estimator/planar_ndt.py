#!/usr/bin/env python3
"""A small registration program outside Tarmac: reads the plain format, writes a TUM trajectory.

    planar_ndt.py INPUT_FOLDER OUTPUT.tum

The vehicle is taken to move in the plane. Upright things (walls, aircraft, poles) are projected onto it and matched to a
map whose cells hold the mean and the covariance of the points seen in them: the normal distributions transform, Biber and
Strasser, IROS 2003. Points are first brought to the sweep's end by the velocity of the last two sweeps. Poses are those of
the LiDAR at each sweep's end, in the frame of the LiDAR at the first sweep's begin; height, roll and pitch stay 0.

Only Python's standard library is used: this shows how a program is connected, not how to be fast or exact.
"""

import array
import math
import os
import sys

CELL_M = 1.0  # edge of a map cell
NOISE_M = 0.05  # added to every cell's spread: keeps walls from being infinitely thin
LOWEST_M, HIGHEST_M = -1.0, 5.0  # of points used, from the sensor: leaves out the ground
NEAREST_M, FARTHEST_M = 2.0, 80.0
POINTS = 4000  # looked at in a sweep
FEWEST_IN_CELL = 5
ITERATIONS = 15


class InputError(Exception):
    """Says what is wrong with the input, and where."""


def read_stamps(folder):
    """Begin and end of each sweep [ns]."""
    path = os.path.join(folder, "lidar", "stamps.txt")
    stamps = []
    try:
        with open(path, encoding="ascii") as lines:
            for number, line in enumerate(lines, 1):
                fields = line.split()
                if len(fields) != 2:
                    raise InputError(f"{path}:{number}: {len(fields)} fields, expected begin and end")
                stamps.append((int(fields[0]), int(fields[1])))
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: {error}") from error
    if not stamps:
        raise InputError(f"{path}: holds no sweep")
    return stamps


def read_points(folder, k):
    """Some of the sweep's upright points as (x, y, seconds since its begin)."""
    path = os.path.join(folder, "lidar", f"{k:06d}.bin")
    values = array.array("f")
    try:
        with open(path, "rb") as file:
            values.frombytes(file.read())
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: {error}") from error
    if len(values) % 5 != 0:
        raise InputError(f"{path}: {4 * len(values)} bytes, expected a multiple of 20")
    if sys.byteorder == "big":
        values.byteswap()
    # An odd step visits every channel of a sensor that fires 16, 32, 64 or 128 of them in turn.
    step = 5 * (max(1, len(values) // 5 // POINTS) | 1)
    points = []
    for i in range(0, len(values), step):
        x, y, z, t = values[i], values[i + 1], values[i + 2], values[i + 4]
        # A comparison with NaN is false, so points that are not finite drop out here.
        if LOWEST_M < z < HIGHEST_M and NEAREST_M < math.hypot(x, y) < FARTHEST_M:
            points.append((x, y, t))
    return points


def compose(a, b):
    """The planar motion a followed by b, each (x, y, yaw)."""
    c, s = math.cos(a[2]), math.sin(a[2])
    return (a[0] + c * b[0] - s * b[1], a[1] + s * b[0] + c * b[1], a[2] + b[2])


def between(a, b):
    """The motion that leads from pose a to pose b: a^-1 b."""
    c, s = math.cos(a[2]), math.sin(a[2])
    x, y = b[0] - a[0], b[1] - a[1]
    return (c * x + s * y, -s * x + c * y, math.remainder(b[2] - a[2], 2 * math.pi))


def at_end(points, velocity, duration_s):
    """Points as seen from the sweep's end, for a velocity (x, y, yaw) per second in the sensor's frame."""
    out = []
    for x, y, t in points:
        age_s = duration_s - t
        yaw = -velocity[2] * age_s
        c, s = math.cos(yaw), math.sin(yaw)
        out.append((c * x - s * y - velocity[0] * age_s, s * x + c * y - velocity[1] * age_s))
    return out


class Map:
    """Cells with the sums of their points; a cell's Gaussian is computed when it is asked for."""

    def __init__(self):
        self.sums = {}
        self.gaussians = {}

    def add(self, points, pose):
        c, s = math.cos(pose[2]), math.sin(pose[2])
        for x, y in points:
            u, v = pose[0] + c * x - s * y, pose[1] + s * x + c * y
            key = (math.floor(u / CELL_M), math.floor(v / CELL_M))
            cell = self.sums.get(key)
            if cell is None:
                cell = self.sums[key] = [0, 0.0, 0.0, 0.0, 0.0, 0.0]
            # From the cell's corner, so that squares far from the origin lose no digits.
            u -= key[0] * CELL_M
            v -= key[1] * CELL_M
            cell[0] += 1
            cell[1] += u
            cell[2] += v
            cell[3] += u * u
            cell[4] += u * v
            cell[5] += v * v
            self.gaussians.pop(key, None)

    def gaussian(self, u, v):
        """Mean and inverse covariance of the cell at (u, v): (mu, mv, a, b, d) with [[a, b], [b, d]]; or None."""
        key = (math.floor(u / CELL_M), math.floor(v / CELL_M))
        found = self.gaussians.get(key, 0)
        if found != 0:
            return found
        n, su, sv, suu, suv, svv = self.sums.get(key, (0, 0, 0, 0, 0, 0))
        gaussian = None
        if n >= FEWEST_IN_CELL:
            mu, mv = su / n, sv / n
            cuu = suu / n - mu * mu + NOISE_M**2
            cuv = suv / n - mu * mv
            cvv = svv / n - mv * mv + NOISE_M**2
            det = cuu * cvv - cuv * cuv
            gaussian = (mu + key[0] * CELL_M, mv + key[1] * CELL_M, cvv / det, -cuv / det, cuu / det)
        self.gaussians[key] = gaussian
        return gaussian


def solve3(h, g):
    """x with H x = -g, H symmetric 3x3 given as (h00, h01, h02, h11, h12, h22)."""
    h00, h01, h02, h11, h12, h22 = h
    c00, c01, c02 = h11 * h22 - h12 * h12, h02 * h12 - h01 * h22, h01 * h12 - h02 * h11
    det = h00 * c00 + h01 * c01 + h02 * c02
    if abs(det) < 1e-9:
        return (0.0, 0.0, 0.0)
    c11, c12, c22 = h00 * h22 - h02 * h02, h01 * h02 - h00 * h12, h00 * h11 - h01 * h01
    return (
        -(c00 * g[0] + c01 * g[1] + c02 * g[2]) / det,
        -(c01 * g[0] + c11 * g[1] + c12 * g[2]) / det,
        -(c02 * g[0] + c12 * g[1] + c22 * g[2]) / det,
    )


def register(world, points, pose):
    """Gauss-Newton on the sum of -exp(-e' S^-1 e / 2) over all points, from a predicted pose."""
    for _ in range(ITERATIONS):
        c, s = math.cos(pose[2]), math.sin(pose[2])
        h00 = h01 = h02 = h11 = h12 = h22 = g0 = g1 = g2 = 0.0
        for x, y in points:
            rx, ry = c * x - s * y, s * x + c * y
            gaussian = world.gaussian(pose[0] + rx, pose[1] + ry)
            if gaussian is None:
                continue
            mu, mv, a, b, d = gaussian
            eu, ev = pose[0] + rx - mu, pose[1] + ry - mv
            fu, fv = a * eu + b * ev, b * eu + d * ev
            w = math.exp(-0.5 * (eu * fu + ev * fv))
            # d(rx, ry)/d(yaw) = (-ry, rx)
            ju, jv = -a * ry + b * rx, -b * ry + d * rx
            h00 += w * a
            h01 += w * b
            h11 += w * d
            h02 += w * ju
            h12 += w * jv
            h22 += w * (-ry * ju + rx * jv)
            g0 += w * fu
            g1 += w * fv
            g2 += w * (-ry * fu + rx * fv)
        dx, dy, dyaw = solve3((h00, h01, h02, h11, h12, h22), (g0, g1, g2))
        pose = (pose[0] + dx, pose[1] + dy, pose[2] + dyaw)
        if math.hypot(dx, dy) < 1e-4 and abs(dyaw) < 1e-5:
            break
    return pose


def tum_line(t_ns, pose):
    half = 0.5 * math.remainder(pose[2], 2 * math.pi)
    sign = "-" if t_ns < 0 else ""
    seconds = f"{sign}{abs(t_ns) // 10**9}.{abs(t_ns) % 10**9:09d}"
    return f"{seconds} {pose[0]:.9f} {pose[1]:.9f} 0.000000000 0 0 {math.sin(half):.12f} {math.cos(half):.12f}\n"


def estimate(folder):
    """The trajectory as TUM lines."""
    stamps = read_stamps(folder)
    world = Map()
    pose, velocity, last_ns = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), stamps[0][0]
    lines = ["# T_map_lidar, planar\n", tum_line(last_ns, pose)]
    for k, (begin_ns, end_ns) in enumerate(stamps):
        points = read_points(folder, k)
        if begin_ns < last_ns or end_ns <= last_ns:
            print(f"sweep {k} begins before its predecessor ended: left out", file=sys.stderr)
            continue
        step_s = (end_ns - last_ns) * 1e-9
        flat = at_end(points, velocity, (end_ns - begin_ns) * 1e-9)
        predicted = compose(pose, tuple(v * step_s for v in velocity))
        new_pose = register(world, flat, predicted) if world.sums else predicted
        world.add(flat, new_pose)
        velocity = tuple(d / step_s for d in between(pose, new_pose))
        pose, last_ns = new_pose, end_ns
        lines.append(tum_line(end_ns, pose))
    return lines


def main(arguments):
    if len(arguments) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    try:
        lines = estimate(arguments[0])
    except InputError as error:
        print(f"planar_ndt: {error}", file=sys.stderr)
        return 2
    with open(arguments[1] + ".part", "w", encoding="ascii") as out:
        out.writelines(lines)
    os.replace(arguments[1] + ".part", arguments[1])
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
