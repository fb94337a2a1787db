#!/usr/bin/env python3
"""Proves that a gate goes red when it should and hardly ever when it should not: prove_gate.py --build DIR --out DIR

Outside of ctest: about 25 minutes of one core (610 cells). What it does, with placebo_sweep.yaml and placebo_gate.yaml beside it:

  1. a baseline: the sweep with tarmac-estimate as it was built
  2. 20 placebo builds (tarmac-estimate-placebo, seeds 1..20): the same points in another order, the first sweep moved by
     one float32 step. What such a build changes is the noise of the comparison. At most one may be red.
  3. the 20 placebo builds with a regression of 5 % injected: the stored one-sweep RPE times 1.05, on every seed. At
     least 16 must be red.
  4. 20 placebo builds without deskewing, and 20 with one iteration only. All must be red.

In 4 each build is a placebo as well; without that, 20 runs would be one run told 20 times. By default points change
places with those fired next to them (--block 16: the sixteen beams of a firing), because KISS-ICP keeps the first point of
a voxel: an order that has nothing to do with the firing order is another algorithm (docs/gates.md has the figures).
`--block 0` orders the whole sweep anew.

Stopped, it goes on where it was when called again. Exit code 1 when a figure is missed.
"""

import argparse
import collections
import json
import math
import os
import pathlib
import shutil
import sqlite3
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
RPE = "rpe_1sweep_trans_rmse_m"
KINDS = {  # name: (what is set, what must hold of the number of reds, in words)
    "placebo": ([], lambda red, n: red <= max(1, n // 20), "at most 1 of 20"),
    "regression": (None, lambda red, n: red >= math.ceil(0.8 * n), "at least 16 of 20"),
    "no-deskew": (["estimators.kiss-icp.deskew=false"], lambda red, n: red == n, "20 of 20"),
    "one-iteration": (["estimators.kiss-icp.max_iterations=1"], lambda red, n: red == n, "20 of 20"),
}


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, required=True, help="build folder, such as build/release")
    parser.add_argument("--out", type=pathlib.Path, required=True, help="folder for stores and results")
    parser.add_argument("--builds", type=int, default=20, help="how many builds of each kind (default 20)")
    parser.add_argument("--jobs", type=int, default=2, help="cells at once")
    parser.add_argument("--block", type=int, default=16, help="points that may change places; 0: all of a sweep")
    parser.add_argument("--kinds", default=",".join(KINDS), help="some of " + ", ".join(KINDS))
    parser.add_argument("--sweep", type=pathlib.Path, default=HERE / "placebo_sweep.yaml")
    parser.add_argument("--gate", type=pathlib.Path, default=HERE / "placebo_gate.yaml")
    return parser.parse_args()


def tarmac(a, *words, environment=None, allowed=(0,)):
    done = subprocess.run([str(a.build / "tarmac"), *map(str, words)], env={**os.environ, **(environment or {})},
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if done.returncode not in allowed:
        sys.exit(f"tarmac {' '.join(map(str, words))}: exit code {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


def sweep(a, store, sets, placebo_seed=None):
    """Runs the sweep into `store`, or what is missing of it."""
    words = ["sweep", a.sweep, "-o", store, "--jobs", a.jobs, "--cache", a.out / "recordings", "-q"]
    if (store / "store.sqlite").exists():
        words.append("--resume")
    for text in sets:
        words += ["--set", text]
    environment = {}
    if placebo_seed is not None:
        words += ["--estimator-program", (a.build / "tarmac-estimate-placebo").resolve()]
        environment["TARMAC_PLACEBO_SEED"] = str(placebo_seed)
        if a.block > 0:
            environment["TARMAC_PLACEBO_BLOCK"] = str(a.block)
    tarmac(a, *words, environment=environment)


def inject(source, target, factor):
    """A copy of a store whose one-sweep RPE is `factor` times as large."""
    target.mkdir(parents=True, exist_ok=True)
    (target / "store.sqlite").unlink(missing_ok=True)
    with sqlite3.connect(source / "store.sqlite") as old, sqlite3.connect(target / "store.sqlite") as new:
        old.backup(new)
        changed = new.execute("update metric_values set value = value * ? where metric in "
                              "(select id from metric_names where metric = ?)", (factor, RPE)).rowcount
        new.commit()
    if changed <= 0:
        sys.exit(f"{target}: no {RPE} to change")


def judge(a, store):
    """(red or not, rows as `tarmac gate --json` gives them)"""
    text = tarmac(a, "gate", store, "--gate", a.out / "gate.yaml", "--json", "-q", allowed=(0, 1))
    rows = json.loads(text)
    return any(row["verdict"] == "FAIL" for row in rows), rows


def stores_of(a, kind):
    for k in range(1, a.builds + 1):
        store = a.out / f"{kind}-{k}"
        if kind == "regression":
            inject(a.out / f"placebo-{k}", store, 1.05)
        else:
            sweep(a, store, KINDS[kind][0], placebo_seed=k)
        yield store


def spread_of(judged):
    """Of every row: mean, sd over builds of the change, and the median of what could have been detected."""
    changes, detectable = collections.defaultdict(list), collections.defaultdict(list)
    for _, rows in judged:
        for row in rows:
            name = f"{row['case']} {row['estimator']} {row['metric']}"
            if row["change_percent"] is not None:
                changes[name].append(row["change_percent"])
            if row["detectable_percent"] is not None:
                detectable[name].append(row["detectable_percent"])
    for name, values in changes.items():
        mean = sum(values) / len(values)
        sd = math.sqrt(sum((v - mean) ** 2 for v in values) / max(1, len(values) - 1))
        seen = sorted(detectable[name])[len(detectable[name]) // 2] if detectable[name] else float("nan")
        yield name, mean, sd, min(values), max(values), seen


def main():
    a = arguments()
    a.out.mkdir(parents=True, exist_ok=True)
    shutil.copy(a.gate, a.out / "gate.yaml")
    baseline = a.out / "baseline"
    sweep(a, baseline, [])
    if not (a.out / "baseline.yaml").exists():
        tarmac(a, "baseline", "update", baseline, "-o", a.out / "baseline.yaml", "--gate", a.out / "gate.yaml")
    same_red, _ = judge(a, baseline)
    print(f"baseline against itself: {'RED' if same_red else 'not red'}", flush=True)
    fine = not same_red
    for kind in a.kinds.split(","):
        judged = [judge(a, store) for store in stores_of(a, kind)]
        red = sum(is_red for is_red, _ in judged)
        verdicts = collections.Counter(row["verdict"] for _, rows in judged for row in rows)
        kept = KINDS[kind][1](red, len(judged))
        fine = fine and kept
        print(f"{kind}: {red} of {len(judged)} red, wanted {KINDS[kind][2]}: {'ok' if kept else 'MISSED'}; rows: "
              + ", ".join(f"{count} {verdict}" for verdict, count in sorted(verdicts.items())))
        for name, mean, sd, low, high, seen in spread_of(judged):
            print(f"  {name}: change {mean:+.2f} % (sd over builds {sd:.2f}, {low:+.2f} to {high:+.2f}), "
                  f"detectable {seen:.1f} %", flush=True)
    return 0 if fine else 1


if __name__ == "__main__":
    sys.exit(main())
