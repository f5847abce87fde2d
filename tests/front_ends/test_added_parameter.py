# SPDX-License-Identifier: Apache-2.0
"""A parameter that is added to the table, and nowhere else, is in every front end."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

FOLDER = pathlib.Path(os.environ["CONTREJOUR_WITH_PARAMETER"])
NAME = "flare-wobble"


class AddedParameterTest(unittest.TestCase):
    def run_program(self, *arguments, code=0, **environment):
        done = subprocess.run(list(map(str, arguments)), capture_output=True, text=True, timeout=300,
                              env={**os.environ, **environment})
        self.assertEqual(done.returncode, code, done.stderr)
        return done.stdout + done.stderr

    def test_command_line(self):
        program = FOLDER / "cli_with_parameter"
        for command in ("render", "apply"):
            shown = self.run_program(program, command, "--help")
            self.assertIn("--flare-wobble", shown, command)
            self.assertIn("--light-wobble", shown, command)
            self.assertIn("a parameter that a test added (default: 1.5)", " ".join(shown.split()), command)
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "f.exr")
            arguments = ("render", "cooke-triplet", "-o", file, "--size", "24x16", "--wavelengths", "1")
            self.assertIn("from -3 to 7 mm", self.run_program(program, *arguments, f"--{NAME}", "9", code=2))
            preset = pathlib.Path(folder, "look.toml")
            self.run_program(program, *arguments, f"--{NAME}", "2.5", "--save-preset", preset)
            self.assertRegex(preset.read_text(), r'flare-wobble\s*=\s*"?2\.5')
            self.run_program(program, *arguments, "--preset", preset)

    def test_c(self):
        shown = self.run_program(FOLDER / "c_with_parameter", NAME, "2.5")
        self.assertIn("flare-wobble 0 -3 7 mm 1.5\n", shown)
        self.assertIn("set 2.5\n", shown)
        self.assertIn("out of range", self.run_program(FOLDER / "c_with_parameter", NAME, "9", code=1))

    def test_python(self):
        code = """
import contrejour
p = {p.name: p for p in contrejour.parameters()}["flare-wobble"]
assert (p.kind, p.minimum, p.maximum, p.unit, p.default) == ("real", -3, 7, "mm", "1.5"), p
assert contrejour.configure_lens("heliar", flare_wobble=2.5)._values.texts("flare-wobble") == ["2.5"]
try:
    contrejour.render("heliar", flare_wobble=9)
except contrejour.InvalidArgumentError as error:
    print(error)
"""
        self.assertIn("out of range", self.run_program(sys.executable, "-c", code, PYTHONPATH=str(FOLDER)))

    def test_openfx(self):
        program = os.environ["CONTREJOUR_OPENFX_PROGRAM"]
        shown = self.run_program(program, "list", CONTREJOUR_OPENFX_PLUGIN=str(FOLDER / "openfx_with_parameter.ofx"))
        self.assertIn("flare_wobble OfxParamTypeDouble -3 7 1.5\n", shown)
        self.assertNotIn("flare_wobble", self.run_program(program, "list"))


if __name__ == "__main__":
    unittest.main()
