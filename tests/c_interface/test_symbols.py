# SPDX-License-Identifier: Apache-2.0
"""Compares the C functions that the shared library exports with the list that programs rely on.

    test_symbols.py LIBRARY symbols.txt

A function is added to the list together with its declaration in contrejour.h; none is ever taken from it while the
library's version stays compatible.
"""
import pathlib
import subprocess
import sys


def exported(library):
    lines = subprocess.run(["nm", "-D", "--defined-only", library], check=True, capture_output=True, text=True).stdout
    names = [line.split() for line in lines.splitlines()]
    return {name[-1] for name in names if len(name) == 3 and name[1] == "T" and name[-1].startswith("cj_")}


def main(library, listed_file):
    listed = set(pathlib.Path(listed_file).read_text(encoding="utf-8").split())
    found = exported(library)
    for name in sorted(listed - found):
        print(f"{name} is listed, but not exported: programs that use it would no longer start")
    for name in sorted(found - listed):
        print(f"{name} is exported, but not listed in {listed_file}")
    if not listed:
        print(f"{listed_file} lists nothing")
    return 0 if listed and listed == found else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
