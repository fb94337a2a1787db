#!/usr/bin/env python3
"""The open apron's dials: table and figure from a run of the sweep open-apron-dials, and whether they are monotone.

    tarmac sweep open-apron-dials -o out-dials
    tests/scenes/open_apron_dials.py out-dials --tarmac build/release/tarmac --figure docs/img/open-apron-dials.svg

Prints a Markdown table for each dial: the median over seeds of the oracle's smallest eigenvalue (each seed's own figure
is the median over the sweeps of its drive), and the interval between the second smallest and the second largest seed,
which holds the true median with 96 % for nine seeds (binomial: 1 - 2 (1 + 9) / 2^9). The last column compares a level
with the one before, seed by seed: the median of the ratios and the same interval.

Exit code 1 when a median is not below the one before it, or a ratio's interval lies above 1.
"""
import argparse
import csv
import math
import os
import statistics
import subprocess
import sys
import tempfile

METRIC = "oracle_lambda_min_6dof_median"
DEGENERATE_BELOW = 1e-3


def read_cells(tarmac, folder):
    """{case: {seed: value}} of the cells that are done."""
    with tempfile.TemporaryDirectory() as scratch:
        path = os.path.join(scratch, "cells.csv")
        subprocess.run([tarmac, "table", folder, "--cells", "--metrics", METRIC, "--csv", path],
                       check=True, stdout=subprocess.DEVNULL)
        cases = {}
        with open(path, newline="") as file:
            for row in csv.DictReader(file):
                if row["status"] != "ok":
                    sys.exit(f"seed {row['seed']} of '{row['case']}' is {row['status']}: run the sweep to its end")
                cases.setdefault(row["case"], {})[int(row["seed"])] = float(row[METRIC])
        return cases


def levels_of(cases, block, field):
    """[(level, {seed: value})] of one dial."""
    prefix = f"{block} {field}="
    return [(float(case[len(prefix):]), values) for case, values in cases.items() if case.startswith(prefix)]


def interval(values):
    """Second smallest and second largest; of fewer than nine seeds the extremes."""
    ordered = sorted(values)
    k = 1 if len(ordered) >= 9 else 0
    return ordered[k], ordered[-1 - k]


def dials(cases):
    """Both dials, from the richest to the barest; nothing at all is the common last level."""
    clutter = sorted(levels_of(cases, "clutter", "scene.clutter_per_ha"), key=lambda level: -level[0])
    facade = sorted(levels_of(cases, "facade", "scene.facade_distance_m"))
    bare = clutter[-1]
    assert bare[0] == 0, "the sweep has no level without clutter"
    return [("objects a hectare (no façade)", [(f"{level:g}", values) for level, values in clutter]),
            ("distance to the façade [m] (no clutter)",
             [(f"{level:g}", values) for level, values in facade] + [("none", bare[1])])]


def judge(levels):
    """Ratio of each level to the one before, as (median, low, high); whether the dial is monotone."""
    ratios, monotone = [None], True
    for (_, before), (_, now) in zip(levels, levels[1:]):
        each = [now[seed] / before[seed] for seed in sorted(now)]
        low, high = interval(each)
        ratios.append((statistics.median(each), low, high))
        monotone &= statistics.median(now.values()) < statistics.median(before.values()) and low <= 1
    return ratios, monotone


def number(value):
    return f"{value:.2g}" if value >= 1e-3 else f"{value:.1e}".replace("e-0", "e-")


def print_table(title, levels, ratios):
    print(f"| {title} | median | 96 % interval | ratio to the level before |\n|---|---|---|---|")
    for (label, values), ratio in zip(levels, ratios):
        low, high = interval(values.values())
        text = "" if ratio is None else f"{ratio[0]:.2f} ({ratio[1]:.2f} to {ratio[2]:.2f})"
        print(f"| {label} | {number(statistics.median(values.values()))} | {number(low)} to {number(high)} | {text} |")
    print()


def panel(title, levels, left, width, top, height, low_decade, high_decade):
    """One dial as SVG: seeds as dots, medians joined, intervals as bars, the oracle's threshold."""
    def y(value):
        return top + height * (high_decade - math.log10(value)) / (high_decade - low_decade)

    def x(index):
        return left + width * (index + 0.5) / len(levels)

    parts = [f'<rect x="{left}" y="{top}" width="{width}" height="{height}" fill="none" stroke="#888"/>']
    for decade in range(low_decade, high_decade + 1):
        at = y(10 ** decade)
        parts.append(f'<line x1="{left}" y1="{at:.1f}" x2="{left + width}" y2="{at:.1f}" stroke="#ddd"/>')
        parts.append(f'<text x="{left - 6}" y="{at + 4:.1f}" text-anchor="end">1e{decade}</text>')
    at = y(DEGENERATE_BELOW)
    parts.append(f'<line x1="{left}" y1="{at:.1f}" x2="{left + width}" y2="{at:.1f}" stroke="#c33" '
                 'stroke-dasharray="6 4"/>')
    parts.append(f'<text x="{left + width - 6}" y="{at - 5:.1f}" text-anchor="end" fill="#c33">degenerate below</text>')
    path = []
    for index, (label, values) in enumerate(levels):
        middle = x(index)
        low, high = interval(values.values())
        for k, value in enumerate(sorted(values.values())):
            jitter = 2.2 * (k - (len(values) - 1) / 2)
            parts.append(f'<circle cx="{middle + jitter:.1f}" cy="{y(value):.1f}" r="2" fill="#9ab"/>')
        parts.append(f'<line x1="{middle:.1f}" y1="{y(low):.1f}" x2="{middle:.1f}" y2="{y(high):.1f}" stroke="#146" '
                     'stroke-width="2"/>')
        median = statistics.median(values.values())
        parts.append(f'<circle cx="{middle:.1f}" cy="{y(median):.1f}" r="4.5" fill="#146"/>')
        parts.append(f'<text x="{middle:.1f}" y="{top + height + 18}" text-anchor="middle">{label}</text>')
        path.append(f"{middle:.1f},{y(median):.1f}")
    parts.append(f'<polyline points="{" ".join(path)}" fill="none" stroke="#146" stroke-width="1.5"/>')
    parts.append(f'<text x="{left + width / 2}" y="{top + height + 38}" text-anchor="middle">{title}</text>')
    return parts


def write_figure(path, both):
    values = [v for _, levels in both for _, level in levels for v in level.values()]
    low, high = math.floor(math.log10(min(values))), math.ceil(math.log10(max(values)))
    parts = ['<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 960 420" font-family="sans-serif" font-size="13" '
             'fill="#222">', '<rect width="960" height="420" fill="#fff"/>',
             '<text x="20" y="24" font-size="15">Smallest eigenvalue of the oracle, 6 DOF: median of nine seeds '
             '(dots), bar: 96 % interval of the median</text>']
    for index, (title, levels) in enumerate(both):
        parts += panel(title, levels, 70 + 470 * index, 400, 45, 310, low, high)
    os.makedirs(os.path.dirname(path) or ".", exist_ok=True)
    with open(path, "w") as file:
        file.write("\n".join(parts + ["</svg>", ""]))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", help="where the sweep was run")
    parser.add_argument("--tarmac", default="tarmac")
    parser.add_argument("--figure", help="SVG to write")
    arguments = parser.parse_args()
    both = dials(read_cells(arguments.tarmac, arguments.folder))
    all_monotone = True
    for title, levels in both:
        ratios, monotone = judge(levels)
        print_table(title, levels, ratios)
        print(f"{title}: {'monotone' if monotone else 'NOT monotone'}\n")
        all_monotone &= monotone
    if arguments.figure:
        write_figure(arguments.figure, both)
    return 0 if all_monotone else 1


if __name__ == "__main__":
    sys.exit(main())
