#!/usr/bin/env python3
"""Trajectory models against each other: tables and figure from a run of the sweep trajectory-models.

    tarmac sweep trajectory-models -o out-models
    tests/estimators/trajectory_models.py out-models --tarmac build/release/tarmac --figure docs/img/trajectory-models.svg

Prints a Markdown table a drive: for every method the unknowns of its motion a sweep; the geometric mean over seeds of deskew error
and one-sweep error with a 95 % interval (of the mean logarithm, by Student's t), ATE, how many sweeps are scored, condition
of the 6-DOF block, by what factor its stated deviations are too small and how many poses their 95 % ellipsoids cover, and
what a sweep costs; and, below, the paired ratio of every causal method with an IMU to ct-icp in deskew error (seed by seed). The
figure has a panel a drive: deskew error by method above, over those unknowns below.

Exit code 1 when a cell did not end well, is missing beside others of its drive, or has no figure.
"""
import argparse
import csv
import math
import os
import subprocess
import sys
import tempfile

DESKEW, STEP, ATE, TIME = "deskew_error_rms_m", "rpe_1sweep_trans_rmse_m", "ate_se3_rmse_m", "sweep_time_p50_ms"
CONDITION, ROOT, COVERED = "solve_condition_6dof_median", "anees_root_per_dof", "nees_covered_percent"
DEGENERATE, SCORED = "oracle_degenerate_percent", "coverage_percent"
STATUS = "status"
METRICS = [DESKEW, STEP, ATE, TIME, CONDITION, ROOT, COVERED, DEGENERATE, SCORED]
# Methods in the order of tables and figure, with the unknowns of their motion a sweep of 0.1 s: six a pose or control point, and
# as many for each derivative of a knot; None: by the motion (6 to 24), not in the lower panels.
DOF = {"rigid": 6, "constant-velocity": 6, "two-pose-slerp": 12, "two-pose-screw": 12, "spline-100ms": 6, "spline-50ms": 12,
       "spline-25ms": 24, "spline-per-sweep": 6, "wnoa": 12, "wnoj": 18, "singer": 18, "two-pose-slerp-imu": 12,
       "two-pose-screw-imu": 12, "spline-100ms-imu": 6, "spline-50ms-imu": 12, "spline-25ms-imu": 24,
       "spline-nonuniform-imu": None, "wnoa-imu": 24,
       "wnoj-imu": 36, "singer-imu": 36, "spline-25ms-imu-offset": 24, "singer-imu-offset": 36, "kiss-icp": 6, "ct-icp": 12,
       "kiss-icp-imu": 6, "steam-lo": 12, "steam-lio": 12, "batch-spline": 24}
FIELD = "estimators.composed.profile="
STUDENT_975 = {1: 12.706, 2: 4.303, 3: 3.182, 4: 2.776, 5: 2.571, 6: 2.447, 7: 2.365, 8: 2.306, 9: 2.262}


def read(tarmac, folder, drives):
    """Adds a folder's cells to {drive: {method: {metric: {seed: value}}}}."""
    with tempfile.TemporaryDirectory() as scratch:
        path = os.path.join(scratch, "cells.csv")
        subprocess.run([tarmac, "table", folder, "--cells", "--metrics", ",".join(METRICS), "--csv", path],
                       check=True, stdout=subprocess.DEVNULL)
        with open(path, newline="") as file:
            for row in csv.DictReader(file):
                case = row["case"]
                drive = case.split(" ")[0].replace("-published", "")
                method = case.split(FIELD)[1] if FIELD in case else row["estimator"]
                if row["status"] != "ok":
                    sys.exit(f"{drive}, {method}, seed {row['seed']} is {row['status']}: run the sweep to its end")
                cell, seed = drives.setdefault(drive, {}).setdefault(method, {m: {} for m in [STATUS, *METRICS]}), int(row["seed"])
                if seed in cell[STATUS]:
                    sys.exit(f"{drive}, {method}, seed {seed} is in two folders")
                cell[STATUS][seed] = row["status"]
                for metric in METRICS:
                    if row[metric]:
                        cell[metric][seed] = float(row[metric])


def complete(drives):
    """The same, methods in the order of DOF; exits where a method of a drive, or a seed of it, is missing."""
    for drive, cells in drives.items():
        seeds = {seed for cell in cells.values() for seed in cell[STATUS]}
        for method in DOF:
            missing = seeds - set(cells[method][STATUS] if method in cells else ())
            if missing:
                sys.exit(f"{drive}, {method}: no seed {', '.join(map(str, sorted(missing)))}: run the sweep to its end")
            for metric in (DESKEW, STEP, ATE, TIME):
                if seeds - set(cells[method][metric]):
                    sys.exit(f"{drive}, {method}: no {metric} for seed {', '.join(map(str, sorted(seeds - set(cells[method][metric]))))}")
    return {drive: {method: cells[method] for method in DOF} for drive, cells in drives.items()}


def mean(values):
    """Geometric mean with its 95 % interval; of one value no interval."""
    logs = [math.log(v) for v in values]
    n, middle = len(logs), sum(logs) / len(logs)
    if n < 2:
        return math.exp(middle), None, None
    half = STUDENT_975[min(n - 1, 9)] * math.sqrt(sum((x - middle) ** 2 for x in logs) / (n - 1) / n)
    return math.exp(middle), math.exp(middle - half), math.exp(middle + half)


def with_digits(value):
    return f"{value:#.2g}" if value < 0.1 else f"{value:.2f}" if value < 10 else f"{value:.1f}" if value < 100 else f"{value:.0f}"


def text(values, scale, interval=True):
    if not values:
        return ""
    m, low, high = mean(values.values())
    if low is None or not interval:
        return with_digits(m * scale)
    return f"{with_digits(m * scale)} ({with_digits(low * scale)} to {with_digits(high * scale)})"


def average(values):
    return f"{sum(values.values()) / len(values):.0f}" if values else ""


def print_drive(drive, methods):
    seeds = sorted(next(iter(methods.values()))[STATUS])
    degenerate = average(next(iter(methods.values()))[DEGENERATE])
    print(f"### {drive}\n\nSeeds {', '.join(map(str, seeds))}; {degenerate} % of the sweeps degenerate by the oracle.\n")
    print("| method | unknowns a sweep | deskew error [mm] | one-sweep error [mm] | ATE [m] | scored [%] | condition | sigmas too small | "
          "covered [%] | ms |\n|---|---:|---|---|---:|---:|---:|---:|---:|---:|")
    for method, cell in methods.items():
        print(f"| `{method}` | {DOF[method] or '6 to 24'} | {text(cell[DESKEW], 1e3)} | {text(cell[STEP], 1e3)} | "
              f"{mean(cell[ATE].values())[0]:.3f} | {average(cell[SCORED])} | {text(cell[CONDITION], 1, False)} | {text(cell[ROOT], 1, False)} | "
              f"{average(cell[COVERED])} | {text(cell[TIME], 1, False)} |")
    print()
    if "ct-icp" not in methods:
        return
    base = methods["ct-icp"][DESKEW]
    print("Deskew error over ct-icp's, seed by seed: " + "; ".join(
        f"`{m}` {text({s: v / base[s] for s, v in cell[DESKEW].items() if s in base}, 1)}"
        for m, cell in methods.items() if "imu" in m or m == "steam-lio") + ".\n")


class Panels:
    """An SVG with a column of panels a drive, deskew error from left to right on one logarithmic axis."""

    LEFT, WIDTH, GAP = 175, 150, 14

    def __init__(self, drives, height, title):
        values = [v for cells in drives.values() for c in cells.values() for v in c[DESKEW].values()]
        self.low, self.high = math.floor(math.log10(min(values))), math.ceil(math.log10(max(values)))
        total = self.LEFT + (self.WIDTH + self.GAP) * len(drives) + 10
        self.parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {total} {height}" font-family="sans-serif" '
                      f'font-size="11" fill="#222"><rect width="{total}" height="{height}" fill="#fff"/>',
                      f'<text x="12" y="20" font-size="14">{title[0]}</text>', f'<text x="12" y="36">{title[1]}</text>']

    def left(self, column):
        return self.LEFT + column * (self.WIDTH + self.GAP)

    def x(self, column, value):
        value = min(max(value, 10.0 ** self.low), 10.0 ** self.high)
        return self.left(column) + self.WIDTH * (math.log10(value) - self.low) / (self.high - self.low)

    def text(self, x, y, words, anchor="middle"):
        self.parts.append(f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}">{words}</text>')

    def frame(self, column, top, height):
        self.parts.append(f'<rect x="{self.left(column)}" y="{top}" width="{self.WIDTH}" height="{height}" fill="none" '
                          'stroke="#888"/>')
        for decade in range(self.low, self.high + 1):
            at = self.x(column, 10.0 ** decade)
            self.parts.append(f'<line x1="{at:.1f}" y1="{top}" x2="{at:.1f}" y2="{top + height}" stroke="#ddd"/>')
            if (decade - self.low) % 2 == 1:
                names = {-4: "0.1 mm", -3: "1 mm", -2: "1 cm", -1: "10 cm", 0: "1 m", 1: "10 m"}
                self.text(at, top + height + 14, names.get(decade, f"1e{decade} m"))

    def dot(self, column, y, method, values):
        m, a, b = mean(values)
        colour = "#d70" if "imu" in method or method in ("steam-lio", "batch-spline") else "#146"
        if a is not None:
            self.parts.append(f'<line x1="{self.x(column, a):.1f}" y1="{y:.1f}" x2="{self.x(column, b):.1f}" y2="{y:.1f}" '
                              f'stroke="{colour}" stroke-width="2"/>')
        self.parts.append(f'<circle cx="{self.x(column, m):.1f}" cy="{y:.1f}" r="3.5" fill="{colour}">'
                          f'<title>{method}: {1e3 * m:.2f} mm</title></circle>')

    def write(self, path):
        with open(path, "w") as file:
            file.write("\n".join(self.parts + ["</svg>", ""]))


def write_figure(path, drives):
    methods = [m for m in DOF if any(m in cells for cells in drives.values())]
    row, top = 17, 70
    upper = row * len(methods)
    lower_top, lower = top + upper + 60, 150
    panels = Panels(drives, lower_top + lower + 30, ("Deskew error by trajectory model", "geometric mean over seeds, bar: its "
                    "95 % interval; orange: with IMU; below: the same over the motion's unknowns a sweep"))
    levels = sorted({dof for dof in DOF.values() if dof})
    height_of = {dof: lower_top + lower * (1 - (k + 0.5) / len(levels)) for k, dof in enumerate(levels)}
    for k, method in enumerate(methods):
        panels.text(panels.LEFT - 8, top + row * (k + 0.7), method, "end")
    for dof, y in height_of.items():
        panels.text(panels.LEFT - 8, y + 4, f"{dof} unknowns", "end")
    for column, (drive, cells) in enumerate(drives.items()):
        panels.text(panels.left(column) + panels.WIDTH / 2, top - 8, drive)
        panels.frame(column, top, upper)
        panels.frame(column, lower_top, lower)
        for k, method in enumerate(methods):
            if method not in cells or not cells[method][DESKEW]:
                continue
            values = cells[method][DESKEW].values()
            panels.dot(column, top + row * (k + 0.5), method, values)
            if DOF[method]:
                # Beside each other where degrees of freedom are equal.
                panels.dot(column, height_of[DOF[method]] + 0.5 * (k % 17 - 8), method, values)
    panels.write(path)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="+", help="several: parts of the sweep, run one by one")
    parser.add_argument("--tarmac", default="tarmac")
    parser.add_argument("--figure")
    arguments = parser.parse_args()
    drives = {}
    for folder in arguments.folder:
        read(arguments.tarmac, folder, drives)
    drives = complete(drives)
    for drive, methods in drives.items():
        print_drive(drive, methods)
    if arguments.figure:
        write_figure(arguments.figure, drives)


if __name__ == "__main__":
    main()
