#!/usr/bin/env python3
"""How much more a sweep does with two cells at once: throughput.py --build DIR --out DIR [--sweep NAME] [--pairs N]

Outside of ctest, on a machine with nothing else to do. Pairs of the same sweep with --jobs 1 and --jobs 2, one after the
other, each into a folder of its own with recordings of its own, and in each pair the same of processes that do nothing but
count: what the machine itself gives. Prints every pair and the medians.
"""

import argparse
import pathlib
import re
import shutil
import statistics
import subprocess
import sys
import time

COUNTING = """
import time
end = time.perf_counter() + {seconds}
n = 0
while time.perf_counter() < end:
    for _ in range(10000): n += 1
print(n)
"""


def counted(processes, seconds):
    """What so many counting processes reach together."""
    started = [subprocess.Popen([sys.executable, "-c", COUNTING.format(seconds=seconds)], stdout=subprocess.PIPE)
               for _ in range(processes)]
    return sum(int(p.communicate()[0]) for p in started)


def sweep(a, jobs):
    out = a.out / f"jobs-{jobs}"
    shutil.rmtree(out, ignore_errors=True)
    began = time.perf_counter()
    done = subprocess.run([str(a.build / "tarmac"), "sweep", a.sweep, "-o", str(out), "--jobs", str(jobs)],
                          stderr=subprocess.PIPE, text=True)
    wall_s = time.perf_counter() - began
    if done.returncode != 0:
        sys.exit(f"tarmac sweep: exit code {done.returncode}\n{done.stderr}")
    overhead_ms = int(re.search(r"overhead (\d+) ms a cell", done.stderr).group(1))
    return wall_s, overhead_ms


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, required=True, help="build folder, such as build/release")
    parser.add_argument("--out", type=pathlib.Path, required=True, help="folder for the stores")
    parser.add_argument("--sweep", default="regression", help="sweep file or name (default: regression)")
    parser.add_argument("--pairs", type=int, default=5)
    parser.add_argument("--counting-s", type=float, default=5.0, help="how long the counting processes count")
    a = parser.parse_args()
    a.build, a.out = a.build.resolve(), a.out.resolve()
    a.out.mkdir(parents=True, exist_ok=True)
    ratios, counting, overheads = [], [], []
    for pair in range(a.pairs):
        one, two = counted(1, a.counting_s), counted(2, a.counting_s)
        (wall_1, overhead_1), (wall_2, overhead_2) = sweep(a, 1), sweep(a, 2)
        ratios.append(wall_1 / wall_2)
        counting.append(two / one)
        overheads += [overhead_1, overhead_2]
        print(f"pair {pair + 1}: {wall_1:.1f} s with 1, {wall_2:.1f} s with 2: {ratios[-1]:.2f} times the throughput; "
              f"counting processes {counting[-1]:.2f}; overhead {overhead_1} and {overhead_2} ms a cell", flush=True)
    print(f"median of {a.pairs}: {statistics.median(ratios):.2f} times the throughput; counting processes "
          f"{statistics.median(counting):.2f}; overhead {statistics.median(overheads):.0f} ms a cell")


if __name__ == "__main__":
    main()
