"""check_layers.py on small trees that are wrong in one way each: a check that passes everything would be none."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPT = sys.argv.pop(1)

SOUND = {
    "core/time.h": "#pragma once\n#include <chrono>\n",
    "core/config.cpp": '#include "core/time.h"\n#include <yaml-cpp/yaml.h>\n',
    "core/CMakeLists.txt": "tarmac_library(tarmac_core\n  SEES core\n  SOURCES config.cpp)\n",
    "scenes/scene.h": '#include "core/time.h"\n',
    "sim/truth/motion.h": '#include "scenes/scene.h"\n',
    "sim/raycast/internal.h": "#include <embree3/rtcore.h>\n",
    "sim/raycast/trace.cpp": '#include "sim/raycast/internal.h"\n',
    "sim/raycast/trace.h": '#include "scenes/scene.h"\n',
    "sim/simulate.h": '#include "sim/truth/motion.h"\n#include "sim/raycast/trace.h"\n',
    "estimators/estimator.h": '#include "core/time.h"\n',
    "estimators/CMakeLists.txt": "tarmac_library(tarmac_estimators SEES core estimators # no truth\n  SOURCES a.cpp)\n",
    "io/sensor/plain.h": '#include "core/time.h"\n',
    "metrics/evaluate.h": '#include "sim/truth/motion.h"\n',
    "reports/page.cpp": '#include "metrics/evaluate.h"\n#include <vtkActor.h>\n',
    "scenarios/scenario.h": '#include "core/time.h"\n',
    "tools/estimate/main.cpp": '#include "estimators/estimator.h"\n#include "io/sensor/plain.h"\n',
    "tools/tarmac/main.cpp": '#include "sim/simulate.h"\n#include "io/sensor/plain.h"\n#include <CLI/CLI.hpp>\n',
    "tests/sim/a_test.cpp": '#include "sim/simulate.h"\n#include "io/sensor/plain.h"\n',
}

# What is put on top of the sound tree, and what the message must hold.
WRONG = [
    ("a dotted path", {"metrics/a.cpp": '#include "../sim/simulate.h"\n'}, "metrics/a.cpp:1: ", "`..`"),
    ("not from the root", {"core/a.cpp": '\n#include "time.h"\n'}, "core/a.cpp:2: ", "from the root"),
    ("no such file", {"core/a.cpp": '#include "core/absent.h"\n'}, "core/a.cpp:1: ", "names no file"),
    ("angle brackets", {"scenes/a.cpp": "#include <core/time.h>\n"}, "scenes/a.cpp:1: ", "with quotes"),
    ("core sees nothing", {"core/a.cpp": '#include "scenes/scene.h"\n'}, "core/a.cpp:1: ", "core may include nothing"),
    ("truth", {"estimators/a.cpp": '#include "sim/truth/motion.h"\n'}, "estimators/a.cpp:1: ", "not sim/truth"),
    ("scene", {"estimators/a.cpp": '#include "scenes/scene.h"\n'}, "estimators/a.cpp:1: ", "not scenes"),
    ("metrics", {"estimators/x/a.h": '# include "metrics/evaluate.h"\n'}, "estimators/x/a.h:1: ", "not metrics"),
    ("the program", {"tools/estimate/a.cpp": '#include "sim/simulate.h"\n'}, "tools/estimate/a.cpp:1: ", "not sim"),
    ("its commands", {"tools/tarmac/a.h": "\n", "tools/estimate/a.cpp": '#include "tools/tarmac/a.h"\n'},
     "tools/estimate/a.cpp:1: ", "not tools"),
    ("io", {"io/sensor/a.cpp": '#include "scenes/scene.h"\n'}, "io/sensor/a.cpp:1: ", "not scenes"),
    ("simulator", {"metrics/a.cpp": '#include "sim/simulate.h"\n'}, "metrics/a.cpp:1: ", "not sim"),
    ("truth in reports", {"reports/a.cpp": '#include "sim/truth/motion.h"\n'}, "reports/a.cpp:1: ", "not sim/truth"),
    ("one way only", {"sim/truth/a.cpp": '#include "sim/simulate.h"\n'}, "sim/truth/a.cpp:1: ", "not sim"),
    ("Embree", {"sim/a.cpp": "#include <embree3/rtcore.h>\n"}, "sim/a.cpp:1: ", "Embree may be named in sim/raycast"),
    ("Embree by a header", {"sim/a.cpp": '#include "sim/raycast/internal.h"\n'}, "sim/a.cpp:1: ", "brings in Embree"),
    ("VTK", {"scenes/a.cpp": "#include <vtkActor.h>\n"}, "scenes/a.cpp:1: ", "VTK may be named in reports"),
    ("VTK in a header", {"reports/a.h": "#include <vtkActor.h>\n"}, "reports/a.h:1: ", "VTK belongs into a .cpp"),
    ("Ceres", {"metrics/a.cpp": "#include <ceres/ceres.h>\n"}, "metrics/a.cpp:1: ", "Ceres may be named in estimators"),
    ("PCL", {"core/a.cpp": "#include <pcl/point_types.h>\n"}, "core/a.cpp:1: ", "PCL may be named in estimators"),
    ("OpenEXR", {"sim/a.cpp": "#include <OpenEXR/ImfRgba.h>\n"}, "sim/a.cpp:1: ", "OpenEXR may be named in io/exr"),
    ("SQLite", {"tools/tarmac/a.cpp": "#include <sqlite3.h>\n"}, "tools/tarmac/a.cpp:1: ",
     "SQLite may be named in scenarios"),
    ("SQLite in a header", {"scenarios/a.h": "#include <sqlite3.h>\n"}, "scenarios/a.h:1: ", "SQLite belongs into a .cpp"),
    ("yaml-cpp in a header", {"core/a.h": "#include <yaml-cpp/yaml.h>\n"}, "core/a.h:1: ", "yaml-cpp belongs into a .cpp"),
    ("json in a header", {"core/a.h": "#include <nlohmann/json.hpp>\n"}, "core/a.h:1: ", "json belongs into a .cpp"),
    ("an include path", {"estimators/x/CMakeLists.txt": "\ntarmac_library(t\n  SEES core sim/truth\n  SOURCES a.cpp)\n"},
     "estimators/x/CMakeLists.txt:2: ", "t SEES sim/truth"),
    ("all of io", {"tools/estimate/CMakeLists.txt": "tarmac_program(tarmac-estimate SEES core io LINKS x)\n"},
     "tools/estimate/CMakeLists.txt:1: ", "SEES io"),
]


def check(tree):
    with tempfile.TemporaryDirectory(prefix="tarmac-layers-") as folder:
        for name, text in tree.items():
            path = pathlib.Path(folder, name)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        return subprocess.run([sys.executable, SCRIPT, folder], capture_output=True, text=True, check=False)


class CheckLayers(unittest.TestCase):
    def test_takes_a_sound_tree(self):
        result = check(SOUND)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)

    def test_refuses_each_wrong_thing_with_file_and_line(self):
        for what, extra, where, message in WRONG:
            with self.subTest(what):
                result = check({**SOUND, **extra})
                self.assertEqual(result.returncode, 1, result.stdout + result.stderr)
                self.assertIn("1 problems", result.stdout)
                self.assertTrue(result.stdout.startswith(where), result.stdout)
                self.assertIn(message, result.stdout)

    def test_a_tree_without_anything_to_check_is_no_success(self):
        self.assertEqual(check({"README.md": ""}).returncode, 1)


if __name__ == "__main__":
    unittest.main()
