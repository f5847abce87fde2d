# SPDX-License-Identifier: Apache-2.0
"""The stubs of the native module have its names and arguments; the package exports what it lists."""
import ast
import importlib.util
import inspect
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import contrejour
from contrejour import _native


PROGRAM = """
import numpy as np
import contrejour
state: contrejour.LensState = contrejour.configure_lens("heliar", f_number=8)
image: np.ndarray = contrejour.render(state, [(12, 8)], width=9, height=6).image
focal: float = state.first_order(550).focal_length_mm
names: list[str] = [ghost.name for ghost in contrejour.ghosts(state)]
dark: np.ndarray = contrejour.read_coating("v-coat").reflectance("N-BK7", [550, 600], 30)
drawing: str = state.section_svg(ghosts=[(2, 5)])
layers: dict[str, np.ndarray] = contrejour.render_layers(state, by="light").layers
"""


def stubs():
    """Names of the stub file: functions with their arguments, classes with their members."""
    tree = ast.parse(pathlib.Path(_native.__file__).with_name("_native.pyi").read_text(encoding="utf-8"))
    names = {}
    for node in tree.body:
        if isinstance(node, ast.FunctionDef):
            names[node.name] = [a.arg for a in node.args.args]
        elif isinstance(node, ast.ClassDef):
            names[node.name] = {
                f.name: [a.arg for a in f.args.args] if not f.decorator_list else None
                for f in node.body
                if isinstance(f, ast.FunctionDef)
            }
        elif isinstance(node, ast.AnnAssign):
            names[node.target.id] = None
    return names


def arguments_of(function):
    """The names of the arguments in the signature that begins a bound function's documentation."""
    signature = function.__doc__.split("\n")[0].split(" -> ")[0]
    return re.findall(r"(?:\(|, )(\w+): ", signature)


class StubsTest(unittest.TestCase):
    def test_native_module(self):
        listed = stubs()
        self.assertEqual(set(listed), {name for name in vars(_native) if not name.startswith("__")})
        for name, expected in listed.items():
            found = getattr(_native, name)
            if isinstance(expected, list):
                self.assertEqual(arguments_of(found), expected, name)
            elif isinstance(expected, dict):
                members = {m for m in vars(found) if not m.startswith("__") and not m.startswith("_pybind11")}
                self.assertEqual(members, {m for m in expected if m != "__init__"}, name)
                for member, arguments in expected.items():
                    if arguments is not None:
                        self.assertEqual(len(arguments_of(getattr(found, member))), len(arguments), f"{name}.{member}")

    def test_types(self):
        """mypy finds no fault in the package, nor in a program that uses it, where mypy is installed."""
        if importlib.util.find_spec("mypy") is None:
            self.skipTest("mypy is not installed (Debian: mypy)")
        with tempfile.TemporaryDirectory() as folder:
            program = pathlib.Path(folder, "program.py")
            program.write_text(PROGRAM, encoding="utf-8")
            environment = {**os.environ, "MYPYPATH": str(pathlib.Path(contrejour.__file__).parents[1])}
            checked = [sys.executable, "-m", "mypy", "--check-untyped-defs", "--no-error-summary", "--cache-dir", folder]
            done = subprocess.run([*checked, str(program)], env=environment, capture_output=True,
                                  text=True, timeout=300)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            done = subprocess.run([*checked, "-p", "contrejour"], env=environment, capture_output=True, text=True, timeout=300)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_package(self):
        self.assertEqual(contrejour.__all__, sorted(contrejour.__all__))
        for name in contrejour.__all__:
            value = getattr(contrejour, name)
            if inspect.isfunction(value) or inspect.isclass(value):
                self.assertTrue(value.__doc__, f"{name} has no documentation")
        self.assertTrue(pathlib.Path(contrejour.__file__).with_name("py.typed").is_file())


if __name__ == "__main__":
    unittest.main()
