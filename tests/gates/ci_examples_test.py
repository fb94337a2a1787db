#!/usr/bin/env python3
"""Checks examples/ci against the program: ci_examples_test.py EXAMPLES_CI TARMAC SCENARIOS

Both workflows parse as YAML; every `tarmac` line in the folder names commands and options that `tarmac COMMAND --help`
knows, and sweeps and gates that exist. Needs PyYAML; without it (exit code 77) ctest shows the test as skipped.
"""

import pathlib
import re
import shlex
import subprocess
import sys

try:
    import yaml
except ImportError:
    print("SKIPPED: PyYAML (python3-yaml) is not installed")
    sys.exit(77)


def scripts_of(node):
    """All texts below `run`, `script`, `before_script` and `after_script`."""
    if isinstance(node, dict):
        for key, value in node.items():
            if key in ("run", "script", "before_script", "after_script"):
                yield from [value] if isinstance(value, str) else value
            else:
                yield from scripts_of(value)
    elif isinstance(node, list):
        for item in node:
            yield from scripts_of(item)


def tarmac_calls(text):
    """Arguments of every call of the program in a shell text."""
    for line in text.splitlines():
        found = re.search(r"(?:^|\s)build/release/tarmac\s+(.*)", line)
        if found:
            yield shlex.split(re.split(r"\s(?:\|\||&&|\|)\s", found.group(1))[0])


def help_of(program, words):
    """The help of a command; None where there is no such command (the program would show its own help instead)."""
    above = subprocess.run([program, *words[:-1], "--help"], capture_output=True, text=True, check=True).stdout
    if not re.search(rf"^  {re.escape(words[-1])}\s", above, re.MULTILINE):
        return None
    return subprocess.run([program, *words, "--help"], capture_output=True, text=True, check=True).stdout


def check_call(program, scenarios, words):
    """What is wrong with one call, as texts."""
    command = words[:2] if words[0] == "baseline" else words[:1]
    text = help_of(program, command)
    if text is None:
        yield f"there is no command `tarmac {' '.join(command)}`"
        return
    known = set(re.findall(r"(?<![\w-])--?[A-Za-z][\w-]*", text))
    for word in words[len(command):]:
        if word.startswith("-") and word.split("=")[0] not in known:
            yield f"`tarmac {' '.join(command)}` has no option {word}"
    if command == ["sweep"] and not (scenarios / "sweeps" / f"{words[1]}.yaml").is_file():
        yield f"there is no sweep {words[1]}"
    if "--gate" in words and not (scenarios / "gates" / f"{words[words.index('--gate') + 1]}.yaml").is_file():
        yield f"there is no gate {words[words.index('--gate') + 1]}"


def main(examples, program, scenarios):
    problems, calls = [], 0
    for name, least in (("github.yml", 2), ("gitlab-ci.yml", 2), ("README.md", 2)):
        text = (examples / name).read_text(encoding="utf-8")
        texts = [text] if name.endswith(".md") else list(scripts_of(yaml.safe_load(text)))
        found = [words for script in texts for words in tarmac_calls(script)]
        calls += len(found)
        if len(found) < least:
            problems.append(f"{name}: {len(found)} calls of tarmac, expected at least {least}")
        for words in found:
            problems += [f"{name}: {problem}" for problem in check_call(program, scenarios, words)]
    # A check that refuses nothing checks nothing.
    for wrong in (["sweeep", "regression"], ["gate", "x", "--gaet", "regression"], ["sweep", "no-such-sweep"]):
        if not list(check_call(program, scenarios, wrong)):
            problems.append(f"the check itself let this through: {wrong}")
    for problem in problems:
        print(problem)
    print(f"{calls} calls: {len(problems)} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]), sys.argv[2], pathlib.Path(sys.argv[3])))
