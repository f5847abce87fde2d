#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Check that every source file names its licence in its first lines.

    check_sources.py [ROOT]     exit 0: all well; 1: each fault as file:line
"""
import pathlib
import sys

LICENCE = "SPDX-License-Identifier: Apache-2.0"
FOLDERS = ("include", "src", "apps", "plugins", "tests", "bench", "fuzz", "tools", "cmake", "python", "examples")
SUFFIXES = {".h", ".c", ".cpp", ".py", ".pyi", ".cmake"}


def is_source(path):
    return path.is_file() and (path.suffix in SUFFIXES or path.name == "CMakeLists.txt")


def check_tree(root):
    """Faults as file:line: text, and how many files were read."""
    files = [root / "CMakeLists.txt", root / "dev"]
    files += [path for top in FOLDERS for path in sorted((root / top).rglob("*")) if is_source(path)]
    files = [path for path in files if path.exists() and "__pycache__" not in path.parts]
    faults = []
    for path in files:
        first_lines = path.read_text(encoding="utf-8").split("\n", 2)[:2]
        if not any(line.endswith(LICENCE) for line in first_lines):
            faults.append(f"{path.relative_to(root).as_posix()}:1: the first line must say {LICENCE}")
    return faults, len(files)


def main(arguments):
    root = pathlib.Path(arguments[0]) if arguments else pathlib.Path(__file__).resolve().parent.parent
    faults, count = check_tree(root)
    for fault in faults:
        print(fault)
    print(f"sources: {count} files, {len(faults)} faults")
    return 1 if faults or count == 0 else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
