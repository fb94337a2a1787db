"""Every header of a folder includes what it needs: headers_test.py COMPILER ROOT FOLDER INCLUDE;INCLUDE..."""

import concurrent.futures
import os
import pathlib
import subprocess
import sys


def compiles_alone(compiler, flags, header):
    # From standard input, quoted includes are looked up in the working folder: `main` makes that the root.
    # Twice: a header without a guard shows too.
    text = f'#include "{header}"\n#include "{header}"\n'
    return subprocess.run([compiler, "-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", "-Wshadow", *flags, "-x", "c++", "-"],
                          input=text, capture_output=True, text=True, check=False)


def main(arguments):
    compiler, root, folder, includes = arguments
    os.chdir(root)
    # The compiler looks into /usr/include by itself; named again it would come before the C++ library's own wrappers.
    paths = dict.fromkeys(path for path in includes.split(";") if path and path != "/usr/include")
    flags = ["-I", root] + [flag for path in paths for flag in ("-isystem", path)]
    headers = sorted(path.relative_to(root).as_posix() for path in pathlib.Path(root, folder).rglob("*.h"))
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        results = list(pool.map(lambda header: compiles_alone(compiler, flags, header), headers))
    failures = 0
    for header, result in zip(headers, results):
        if result.returncode != 0 or result.stderr:
            failures += 1
            print(f"{header} does not compile on its own:\n{result.stderr}")
    print(f"{folder}: {len(headers)} headers, {failures} do not compile on their own")
    return 1 if failures or not headers else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
