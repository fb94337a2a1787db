"""The wall around the truth, as the compiler and the linker keep it.

    compile_wall_test.py COMPILER ROOT PROGRAM NAME=INCLUDE;INCLUDE... [NAME=...]

With the include path that CMake gave each named target, no header beyond the wall may compile, and those that the target
declares must. The program that runs estimators must hold code of estimators and none of the simulator's or the metrics'.
"""

import pathlib
import subprocess
import sys
import tempfile
import unittest

COMPILER, ROOT, PROGRAM = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
TARGETS = {}
for argument in sys.argv[4:]:
    name, path = argument.split("=", 1)
    TARGETS[name] = [folder for folder in path.split(";") if folder]
del sys.argv[1:]

BEYOND = ["sim", "scenes", "metrics", "scenarios", "reports", "io/world", "tools/tarmac"]
# What both targets declare: that these compile shows that it is the wall that refuses the others.
CONTROLS = ["core/recording.h", "core/estimate.h", "estimators/estimator.h", "estimators/registry.h"]


def compile_text(text, folders):
    """Compiles in an empty folder: quoted includes are looked up beside the file first."""
    flags = [flag for folder in folders for flag in ("-isystem" if "eigen" in folder else "-I", folder)]
    with tempfile.TemporaryDirectory(prefix="tarmac-wall-") as folder:
        pathlib.Path(folder, "wall.cpp").write_text(text, encoding="ascii")
        command = [COMPILER, "-std=c++20", "-fsyntax-only", *flags, "wall.cpp"]
        return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)


def headers_beyond():
    return sorted(path.relative_to(ROOT).as_posix() for folder in BEYOND for path in (ROOT / folder).rglob("*.h"))


class CompileWall(unittest.TestCase):
    def test_what_a_target_declares_compiles_and_the_truth_does_not(self):
        truth = "sim/truth/ground_truth.h"
        for target, folders in TARGETS.items():
            sound = "".join(f'#include "{header}"\n' for header in CONTROLS)
            result = compile_text(sound, folders)
            self.assertEqual(result.returncode, 0, f"{target}\n{result.stderr}")
            result = compile_text(sound + f'#include "{truth}"\n', folders)
            self.assertNotEqual(result.returncode, 0, f"{target} can include {truth}")
            # Refused because it is not there for the target, and not for some other flaw.
            self.assertIn(f"fatal error: {truth}: No such file or directory", result.stderr)

    def test_no_header_beyond_the_wall_is_there_for_a_target(self):
        headers = headers_beyond()
        self.assertIn("sim/truth/ground_truth.h", headers)
        text = "".join(f'#if __has_include("{header}")\n#error can include {header}\n#endif\n' for header in headers)
        control = '#if __has_include("core/recording.h")\n#error as it should\n#endif\n'
        for target, folders in TARGETS.items():
            self.assertEqual(compile_text(text, folders).stderr, "", target)
            self.assertIn("as it should", compile_text(control, folders).stderr)
        print(f"{len(headers)} headers are not there for {', '.join(TARGETS)}")

    def test_the_program_that_runs_estimators_holds_no_code_from_beyond(self):
        content = PROGRAM.read_bytes()
        for inside in (b"6tarmac10estimators", b"6tarmac4core", b"6tarmac2io"):  # mangled namespaces
            self.assertIn(inside, content, "a positive control: the program is not stripped, and is the right one")
        for beyond in (b"6tarmac3sim", b"6tarmac6scenes", b"6tarmac7metrics", b"6tarmac7reports", b"rtcIntersect", b"vtk"):
            self.assertNotIn(beyond, content)


if __name__ == "__main__":
    unittest.main()
