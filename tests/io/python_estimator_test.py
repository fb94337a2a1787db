"""The example estimator on a made-up plain folder, as the harness would start it: a program with two arguments."""

import array
import math
import os
import random
import subprocess
import sys
import tempfile
import unittest

PROGRAM = sys.argv.pop(1)

# A hall of 60 x 40 m with pillars: walls alone would leave motion along them to their few corners.
WALLS = [(-20, -18), (40, -18), (40, 22), (-20, 22)]
PILLARS = [(5, 6, 1.0), (12, -7, 0.8), (22, 9, 1.2), (30, -10, 0.9), (-9, -8, 1.0), (-10, 10, 0.7)]
PERIOD_NS, COLUMNS = 100_000_000, 600


def pose_at(t_s):
    """At rest for 0.5 s, then smoothly up to 4 m/s on a curve of 0.2 rad/s: (x, y, yaw)."""
    u = max(0.0, t_s - 0.5)
    s = 4.0 * (u - (1 - math.exp(-u)))
    k = 0.05  # curvature [1/m]
    return math.sin(k * s) / k, (1 - math.cos(k * s)) / k, k * s


def range_m(x, y, angle):
    """Distance to the nearest thing along a ray."""
    dx, dy = math.cos(angle), math.sin(angle)
    nearest = math.inf
    for (ax, ay), (bx, by) in zip(WALLS, WALLS[1:] + WALLS[:1]):
        ex, ey = bx - ax, by - ay
        det = dy * ex - dx * ey
        if abs(det) > 1e-12:
            r = ((ay - y) * ex - (ax - x) * ey) / det
            s = ((ay - y) * dx - (ax - x) * dy) / det
            if r > 0 and 0 <= s <= 1:
                nearest = min(nearest, r)
    for px, py, radius in PILLARS:
        along = (px - x) * dx + (py - y) * dy
        off2 = (px - x) ** 2 + (py - y) ** 2 - along**2
        if along > 0 and off2 < radius**2:
            nearest = min(nearest, along - math.sqrt(radius**2 - off2))
    return nearest


def sweep_bytes(begin_s, noise):
    values = array.array("f")
    for column in range(COLUMNS):
        t_s = column / COLUMNS * PERIOD_NS * 1e-9
        x, y, yaw = pose_at(begin_s + t_s)
        angle = math.pi - 2 * math.pi * column / COLUMNS
        r = range_m(x, y, yaw + angle) + noise.gauss(0, 0.01)
        for z in (-1.8, 0.0, 1.0):  # the lowest counts as ground and must not be used
            values.extend([r * math.cos(angle), r * math.sin(angle), z, 10.0, t_s])
    if sys.byteorder == "big":
        values.byteswap()
    return values.tobytes()


def fabricate(folder, sweeps):
    noise = random.Random(1)
    os.makedirs(os.path.join(folder, "lidar"))
    with open(os.path.join(folder, "lidar", "stamps.txt"), "w", encoding="ascii") as stamps:
        for k in range(sweeps):
            begin_ns = k * PERIOD_NS
            stamps.write(f"{begin_ns} {begin_ns + (COLUMNS - 1) * PERIOD_NS // COLUMNS}\n")
            with open(os.path.join(folder, "lidar", f"{k:06d}.bin"), "wb") as file:
                file.write(sweep_bytes(begin_ns * 1e-9, noise))


def run(folder, output):
    return subprocess.run([sys.executable, PROGRAM, folder, output], capture_output=True, text=True, timeout=100, check=False)


def read_tum(path):
    with open(path, encoding="ascii") as lines:
        return [[float(v) for v in line.split()] for line in lines if not line.startswith("#")]


class PlanarNdt(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory(prefix="tarmac-python-estimator-")
        self.addCleanup(self.folder.cleanup)
        self.input = os.path.join(self.folder.name, "input")
        self.output = os.path.join(self.folder.name, "out.tum")

    def test_follows_a_curve_through_a_hall(self):
        fabricate(self.input, 40)
        result = run(self.input, self.output)
        self.assertEqual(result.returncode, 0, result.stderr)
        poses = read_tum(self.output)
        self.assertEqual(len(poses), 41)
        self.assertEqual(poses[0][0], 0.0)
        worst_m = worst_rad = 0.0
        for pose in poses:
            x, y, yaw = pose_at(pose[0])
            worst_m = max(worst_m, math.hypot(pose[1] - x, pose[2] - y))
            worst_rad = max(worst_rad, abs(2 * math.atan2(pose[6], pose[7]) - yaw))
        travelled_m = math.hypot(*pose_at(poses[-1][0])[:2])
        self.assertGreater(travelled_m, 8)
        print(f"after {travelled_m:.1f} m: worst position error {worst_m:.3f} m, worst yaw error {worst_rad:.4f} rad")
        self.assertLess(worst_m, 0.01 * travelled_m)
        self.assertLess(worst_rad, 0.01)

    def test_same_input_same_bytes(self):
        fabricate(self.input, 8)
        contents = []
        for _ in range(2):
            self.assertEqual(run(self.input, self.output).returncode, 0)
            with open(self.output, "rb") as file:
                contents.append(file.read())
        self.assertEqual(contents[0], contents[1])

    def test_takes_empty_sweeps_points_that_are_not_finite_and_sweeps_out_of_order(self):
        fabricate(self.input, 12)
        with open(os.path.join(self.input, "lidar", "000007.bin"), "wb"):
            pass
        path = os.path.join(self.input, "lidar", "000003.bin")
        with open(path, "ab") as file:
            file.write(array.array("f", [math.nan, math.inf, 0.0, 0.0, 0.0] * 50).tobytes())
        stamps = os.path.join(self.input, "lidar", "stamps.txt")
        with open(stamps, encoding="ascii") as file:
            lines = file.readlines()
        lines[9] = lines[5]
        with open(stamps, "w", encoding="ascii") as file:
            file.writelines(lines)
        result = run(self.input, self.output)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("sweep 9", result.stderr)
        poses = read_tum(self.output)
        self.assertEqual(len(poses), 12)  # begin, and the end of each sweep but the ninth
        for pose in poses:
            self.assertLess(math.hypot(pose[1] - pose_at(pose[0])[0], pose[2] - pose_at(pose[0])[1]), 0.1)

    def test_bad_input_is_named_and_leaves_no_output(self):
        fabricate(self.input, 2)
        with open(os.path.join(self.input, "lidar", "000001.bin"), "ab") as file:
            file.write(b"abcd")
        result = run(self.input, self.output)
        self.assertEqual(result.returncode, 2)
        self.assertIn("000001.bin", result.stderr)
        self.assertFalse(os.path.exists(self.output))
        self.assertEqual(run(os.path.join(self.folder.name, "absent"), self.output).returncode, 2)


if __name__ == "__main__":
    unittest.main()
