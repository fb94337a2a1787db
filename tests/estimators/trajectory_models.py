#!/usr/bin/env python3
"""Trajectory models against each other: tables and figure from a run of the sweep trajectory-models.

    tarmac sweep trajectory-models -o out-models
    tests/estimators/trajectory_models.py out-models --tarmac build/release/tarmac --figure docs/img/trajectory-models.svg

Prints a Markdown table a drive: for every method the geometric mean over seeds of deskew error and one-sweep error with a 95 %
interval (of the mean logarithm, by Student's t), ATE, and what a sweep costs; and, below, the paired ratio of every method
with an IMU to ct-icp in deskew error (seed by seed).

Exit code 1 when a cell is missing or did not end well.
"""
import argparse
import csv
import math
import os
import subprocess
import sys
import tempfile

METRICS = ["deskew_error_rms_m", "rpe_1sweep_trans_rmse_m", "ate_se3_rmse_m", "sweep_time_p50_ms"]
FIELD = "estimators.composed.profile="
STUDENT_975 = {1: 12.706, 2: 4.303, 3: 3.182, 4: 2.776, 5: 2.571, 6: 2.447, 7: 2.365, 8: 2.306, 9: 2.262}


def read(tarmac, folder):
    """{drive: {method: {metric: {seed: value}}}}; methods in the sweep's order."""
    with tempfile.TemporaryDirectory() as scratch:
        path = os.path.join(scratch, "cells.csv")
        subprocess.run([tarmac, "table", folder, "--cells", "--metrics", ",".join(METRICS), "--csv", path],
                       check=True, stdout=subprocess.DEVNULL)
        drives = {}
        with open(path, newline="") as file:
            for row in csv.DictReader(file):
                case = row["case"]
                drive = case.split(" ")[0].replace("-published", "")
                method = case.split(FIELD)[1] if FIELD in case else row["estimator"]
                if row["status"] != "ok":
                    sys.exit(f"{drive}, {method}, seed {row['seed']} is {row['status']}: run the sweep to its end")
                cell = drives.setdefault(drive, {}).setdefault(method, {m: {} for m in METRICS})
                for metric in METRICS:
                    if row[metric]:
                        cell[metric][int(row["seed"])] = float(row[metric])
        return drives


def mean(values):
    """Geometric mean with its 95 % interval; of one value no interval."""
    logs = [math.log(v) for v in values]
    n, middle = len(logs), sum(logs) / len(logs)
    if n < 2:
        return math.exp(middle), None, None
    half = STUDENT_975[min(n - 1, 9)] * math.sqrt(sum((x - middle) ** 2 for x in logs) / (n - 1) / n)
    return math.exp(middle), math.exp(middle - half), math.exp(middle + half)


def text(values, scale):
    if not values:
        return "n/a"
    m, low, high = mean(values.values())
    digits = 2 if m * scale < 10 else 1 if m * scale < 100 else 0
    f = f"{{:.{digits}f}}"
    return f.format(m * scale) + ("" if low is None else f" ({f.format(low * scale)} to {f.format(high * scale)})")


def print_drive(drive, methods):
    seeds = sorted({s for cell in methods.values() for s in cell[METRICS[0]]})
    print(f"### {drive}\n\nSeeds {', '.join(map(str, seeds))}.\n")
    print("| method | deskew error [mm] | one-sweep error [mm] | ATE [m] | ms a sweep |\n|---|---|---|---|---|")
    for method, cell in methods.items():
        print(f"| `{method}` | {text(cell['deskew_error_rms_m'], 1e3)} | {text(cell['rpe_1sweep_trans_rmse_m'], 1e3)} | "
              f"{mean(cell['ate_se3_rmse_m'].values())[0]:.3f} | {mean(cell['sweep_time_p50_ms'].values())[0]:.0f} |")
    print()
    if "ct-icp" not in methods:
        return
    base = methods["ct-icp"]["deskew_error_rms_m"]
    print("Deskew error over ct-icp's, seed by seed: " + "; ".join(
        f"`{m}` {text({s: v / base[s] for s, v in cell['deskew_error_rms_m'].items() if s in base}, 1)}"
        for m, cell in methods.items() if "imu" in m or m == "steam-lio") + ".\n")


def write_figure(path, drives):
    """A row of dots a method, a panel a drive: deskew error on a logarithmic axis, interval as a bar."""
    methods = list(dict.fromkeys(m for cells in drives.values() for m in cells))
    row, top, left, width = 17, 60, 175, 150
    height = top + row * len(methods) + 50
    values = [v for cells in drives.values() for c in cells.values() for v in c["deskew_error_rms_m"].values()]
    low, high = math.floor(math.log10(min(values))), math.ceil(math.log10(max(values)))
    total = left + (width + 14) * len(drives) + 10
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {total} {height}" font-family="sans-serif" font-size="11" '
             f'fill="#222"><rect width="{total}" height="{height}" fill="#fff"/>',
             '<text x="12" y="22" font-size="14">Deskew error [m] by trajectory model: geometric mean over seeds, bar: 95 % '
             'interval; orange: with IMU</text>']
    for k, method in enumerate(methods):
        parts.append(f'<text x="{left - 8}" y="{top + row * (k + 0.7):.1f}" text-anchor="end">{method}</text>')
    for d, (drive, cells) in enumerate(drives.items()):
        x0 = left + d * (width + 14)
        x = lambda v: x0 + width * (math.log10(v) - low) / (high - low)
        parts.append(f'<text x="{x0 + width / 2}" y="{top - 8}" text-anchor="middle">{drive}</text>')
        parts.append(f'<rect x="{x0}" y="{top}" width="{width}" height="{row * len(methods)}" fill="none" stroke="#888"/>')
        for decade in range(low, high + 1):
            at = x(10.0 ** decade)
            parts.append(f'<line x1="{at:.1f}" y1="{top}" x2="{at:.1f}" y2="{top + row * len(methods)}" stroke="#ddd"/>')
            parts.append(f'<text x="{at:.1f}" y="{top + row * len(methods) + 14}" text-anchor="middle">1e{decade}</text>')
        for k, method in enumerate(methods):
            if method not in cells or not cells[method]["deskew_error_rms_m"]:
                continue
            m, a, b = mean(cells[method]["deskew_error_rms_m"].values())
            y = top + row * (k + 0.5)
            colour = "#d70" if "imu" in method or method in ("steam-lio", "batch-spline") else "#146"
            if a is not None:
                a, b = max(a, 10.0 ** low), min(b, 10.0 ** high)
                parts.append(f'<line x1="{x(a):.1f}" y1="{y}" x2="{x(b):.1f}" y2="{y}" stroke="{colour}" stroke-width="2"/>')
            parts.append(f'<circle cx="{x(m):.1f}" cy="{y}" r="3.5" fill="{colour}"/>')
    with open(path, "w") as file:
        file.write("\n".join(parts + ["</svg>", ""]))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder")
    parser.add_argument("--tarmac", default="tarmac")
    parser.add_argument("--figure")
    arguments = parser.parse_args()
    drives = read(arguments.tarmac, arguments.folder)
    for drive, methods in drives.items():
        print_drive(drive, methods)
    if arguments.figure:
        write_figure(arguments.figure, drives)


if __name__ == "__main__":
    main()
