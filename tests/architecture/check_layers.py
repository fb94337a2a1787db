#!/usr/bin/env python3
"""Checks who includes whom, over the whole tree: check_layers.py ROOT

Refused, each with file and line: an include with `..`; a quoted include that is not written from the root or names no file;
one against the table below; a SEES list against it; a heavy library's header outside its place, be it by way of our own
headers; some heavy headers in any header.
Prints what it looked at, so that a check of nothing shows.
"""

import pathlib
import re
import sys

# A layer is the longest folder of this table that holds the file; it sees itself and what stands beside it.
SEES = {
    "core": [],
    "scenes": ["core"],
    "sim/truth": ["core", "scenes"],
    "sim/raycast": ["core", "scenes"],
    "sim": ["core", "scenes", "sim/truth", "sim/raycast"],
    "estimators": ["core"],
    "io/sensor": ["core"],
    "io/world": ["core", "scenes"],
    "io/exr": ["core", "scenes", "sim/truth"],  # a picture of a sweep shows its truth too
    "metrics": ["core", "scenes", "sim/truth", "sim/raycast"],
    "scenarios": ["core"],
    "reports": ["core", "scenes", "metrics"],
    # The program that runs estimators stays on their side of the wall around the truth.
    "tools/estimate": ["core", "io/sensor", "estimators"],
    "tools": ["core", "scenes", "sim", "sim/truth", "sim/raycast", "estimators", "io", "metrics", "scenarios", "reports",
              "tools/estimate"],
    "tests": ["core", "scenes", "sim", "sim/truth", "sim/raycast", "estimators", "io", "metrics", "scenarios", "reports",
              "tools/estimate", "tools"],
}

# Header, library, and the folders that may name it.
HEAVY = [
    (re.compile(r"embree\d?/"), "Embree", ["sim/raycast"]),
    (re.compile(r"vtk\w+(\.h|/)"), "VTK", ["reports", "io/world"]),
    (re.compile(r"ceres/"), "Ceres", ["estimators"]),
    (re.compile(r"(pcl|pcl-\d)/"), "PCL", ["estimators"]),
    (re.compile(r"(OpenEXR|Imath|Imf)"), "OpenEXR", ["io/exr"]),
    (re.compile(r"sqlite3"), "SQLite", ["scenarios"]),
]
# Headers that several sources of one part share and nobody else may include: they may name what sources may.
PRIVATE = {
    "reports/stills_cameras.h": "reports/stills",
    "reports/stills_meshes.h": "reports/stills",
    "reports/stills_state.h": "reports/stills",
}
SOURCES_ONLY = [
    (re.compile(r"vtk\w+(\.h|/)"), "VTK"),
    (re.compile(r"yaml-cpp/"), "yaml-cpp"),
    (re.compile(r"nlohmann/(?!json_fwd)"), "nlohmann json"),
    (re.compile(r"CLI/"), "CLI11"),
    (re.compile(r"sqlite3"), "SQLite"),
]

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
TARGET = re.compile(r"tarmac_(?:library|program|test)\s*\(\s*([\w-]+)([^)]*)\)", re.DOTALL)
KEYWORDS = {"SOURCES", "LINKS", "LABEL"}


def under(path, folder):
    return path == folder or path.startswith(folder + "/")


def layer_of(path):
    """The layer that a path from the root belongs to; None outside all of them."""
    holding = [layer for layer in SEES if under(path, layer)]
    return max(holding, key=len) if holding else None


def allowed(from_layer, path):
    """Whether files of that layer may see that path."""
    layer = layer_of(path)
    if layer == from_layer:
        return True
    # `io` and `tests` stand for all below them; a more special layer needs a name of its own in the list.
    return any(layer == seen or (seen == "io" and under(path, "io")) for seen in SEES[from_layer])


def includes_of(path):
    """(line number, quote, target) of every include of a file."""
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        found = INCLUDE.match(line)
        if found:
            yield number, found.group(1), found.group(2)


def named_heavily(root, name, known):
    """Heavy libraries whose headers a file brings in, itself or by way of others."""
    if name not in known:
        known[name] = set()  # ends circles
        for _, quote, target in includes_of(root / name):
            known[name] |= {library for pattern, library, _ in HEAVY if pattern.match(target)}
            if quote == '"' and (root / target).is_file():
                known[name] |= named_heavily(root, target, known)
    return known[name]


def check_include(root, name, quote, target, known):
    """What is wrong with one include, as texts."""
    layer = layer_of(name)
    if ".." in target.split("/"):
        yield "`..` in an include: write it from the root"
        return
    for pattern, library, folders in HEAVY:
        if pattern.match(target) and not any(under(name, folder) for folder in folders):
            yield f"{library} may be named in {', '.join(folders)} only"
    if quote == '"' and (root / target).is_file():
        brought = named_heavily(root, target, known)
        for _, library, folders in HEAVY:
            if library in brought and not any(under(name, folder) for folder in folders):
                yield f"brings in {library}, which may be named in {', '.join(folders)} only"
    for pattern, library in SOURCES_ONLY:
        if pattern.match(target) and name.endswith(".h") and name not in PRIVATE:
            yield f"{library} belongs into a .cpp file: it is too heavy for a header"
    if target in PRIVATE and not name.startswith(PRIVATE[target]):
        yield f"{target} is private to {PRIVATE[target]}*"
    ours = layer_of(target) is not None
    if quote == "<":
        if ours and (root / target).exists():
            yield "headers of the project are included with quotes"
        return
    if not ours or not (root / target).is_file():
        yield "names no file of the project: write it from the root, and others' headers in angle brackets"
    elif not allowed(layer, target):
        yield f"{layer} may include {', '.join(SEES[layer]) or 'nothing'} and itself, not {layer_of(target)}"


def check_sources(root, problems):
    files = includes = 0
    known = {}
    for layer in sorted({name.split("/")[0] for name in SEES}):
        for path in sorted((root / layer).rglob("*")):
            if path.suffix not in (".h", ".cpp", ".in"):
                continue
            files += 1
            name = path.relative_to(root).as_posix()
            for number, quote, target in includes_of(path):
                includes += 1
                for problem in check_include(root, name, quote, target, known):
                    problems.append(f"{name}:{number}: #include {target}: {problem}")
    return files, includes


def seen_folders(arguments):
    """The folders after SEES in a target's arguments."""
    inside, folders = False, []
    for word in re.sub(r"#.*", "", arguments).split():
        if word == "SEES" or word in KEYWORDS:
            inside = word == "SEES"
        elif inside:
            folders.append(word)
    return folders


def check_targets(root, problems):
    """A target's SEES is its include path: it must not hold more than its layer may include."""
    targets = 0
    for layer in sorted({name.split("/")[0] for name in SEES}):
        for path in sorted((root / layer).rglob("CMakeLists.txt")):
            name = path.relative_to(root).as_posix()
            text = path.read_text(encoding="utf-8")
            for found in TARGET.finditer(text):
                targets += 1
                number = text.count("\n", 0, found.start()) + 1
                own = layer_of(path.parent.relative_to(root).as_posix())
                for folder in seen_folders(found.group(2)):
                    below = [seen for seen in SEES if under(seen, folder)] or [folder]
                    if not all(allowed(own, seen) for seen in [folder, *below] if layer_of(seen)):
                        problems.append(f"{name}:{number}: {found.group(1)} SEES {folder}, which {own} may not include")
    return targets


def main(arguments):
    root = pathlib.Path(arguments[0])
    problems = []
    files, includes = check_sources(root, problems)
    targets = check_targets(root, problems)
    for problem in problems:
        print(problem)
    print(f"{files} files, {includes} includes, {targets} targets: {len(problems)} problems")
    return 1 if problems or files == 0 or includes == 0 or targets == 0 else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
