"""The wall around the truth, as the compiler and the linker keep it.

    compile_wall_test.py COMPILER ROOT PROGRAM NAME=INCLUDE;INCLUDE... [NAME=...]

With the include path that CMake gave each named target, no header beyond the wall may compile, and those that the target
declares must. The program that runs estimators must hold code of estimators and none of the simulator's or the metrics'.
"""

import concurrent.futures
import os
import pathlib
import subprocess
import sys
import unittest

COMPILER, ROOT, PROGRAM = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
TARGETS = {}
for argument in sys.argv[4:]:
    name, path = argument.split("=", 1)
    TARGETS[name] = [folder for folder in path.split(";") if folder]
del sys.argv[1:]

BEYOND = ["sim", "scenes", "metrics", "scenarios", "reports", "io/world", "tools/tarmac"]
# The same file compiles with what a target declares: so it is the wall that refuses the others.
CONTROLS = ["core/recording.h", "core/estimate.h", "estimators/estimator.h", "estimators/registry.h"]


def compile_including(header, folders):
    flags = [flag for folder in folders for flag in ("-isystem" if "eigen" in folder else "-I", folder)]
    text = f'#include "{header}"\nint main() {{ return 0; }}\n'
    return subprocess.run([COMPILER, "-std=c++20", "-fsyntax-only", *flags, "-x", "c++", "-"], input=text,
                          capture_output=True, text=True, check=False)


def results(headers, folders):
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        return dict(zip(headers, pool.map(lambda header: compile_including(header, folders), headers)))


class CompileWall(unittest.TestCase):
    def test_what_a_target_declares_compiles(self):
        for target, folders in TARGETS.items():
            for header, result in results(CONTROLS, folders).items():
                self.assertEqual(result.returncode, 0, f"{target}: {header}\n{result.stderr}")

    def test_nothing_beyond_the_wall_compiles(self):
        headers = sorted(path.relative_to(ROOT).as_posix() for folder in BEYOND for path in (ROOT / folder).rglob("*.h"))
        self.assertIn("sim/truth/ground_truth.h", headers)
        for target, folders in TARGETS.items():
            for header, result in results(headers, folders).items():
                self.assertNotEqual(result.returncode, 0, f"{target} can include {header}")
                # Refused because it is not there for the target, and not for some other flaw.
                self.assertIn(f"fatal error: {header}: No such file or directory", result.stderr)
        print(f"{len(headers)} headers cannot be included by {', '.join(TARGETS)}")

    def test_the_program_that_runs_estimators_holds_no_code_from_beyond(self):
        content = PROGRAM.read_bytes()
        for inside in (b"6tarmac10estimators", b"6tarmac4core", b"6tarmac2io"):  # mangled namespaces
            self.assertIn(inside, content, "a positive control: the program is not stripped, and is the right one")
        for beyond in (b"6tarmac3sim", b"6tarmac6scenes", b"6tarmac7metrics", b"6tarmac7reports", b"rtcIntersect", b"vtk"):
            self.assertNotIn(beyond, content)


if __name__ == "__main__":
    unittest.main()
