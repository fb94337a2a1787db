#!/usr/bin/env python3
"""Reads the gate's JUnit XML with a parser: junit_test.py TEST_PROGRAM

The program's GateJunit test writes it; its rows hold markup, control characters and line breaks.
"""

import os
import pathlib
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ET


def main(program):
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "junit.xml"
        subprocess.run([program, "--gtest_filter=GateJunit.*"], check=True, stdout=subprocess.DEVNULL,
                       env={**os.environ, "TARMAC_JUNIT_OUT": str(out)})
        root = ET.parse(out).getroot()
    suite = root.find("testsuite")
    cases = suite.findall("testcase")
    assert root.tag == "testsuites" and len(cases) == 4 == int(suite.get("tests")), root.attrib
    assert all('brake x=<3> & "more"' in case.get("name") for case in cases), [case.attrib for case in cases]

    failures = suite.findall("testcase/failure")
    assert len(failures) == 1 == int(suite.get("failures"))
    assert "worse | much\nworse \\x1b[31m" in failures[0].get("message"), failures[0].attrib
    assert "seed 3: log: out/log.txt" in failures[0].text, failures[0].text

    skipped = suite.findall("testcase/skipped")
    assert len(skipped) == 1 == int(suite.get("skipped"))
    assert "inconclusive" in skipped[0].get("message") and "4.2 %" in skipped[0].get("message"), skipped[0].attrib

    reported = cases[3]
    assert reported.find("failure") is None and "2026-12-31" in reported.find("system-out").text
    assert "recordings of 2 of 10" in suite.find("system-out").text
    print("4 test cases read")


if __name__ == "__main__":
    main(sys.argv[1])
