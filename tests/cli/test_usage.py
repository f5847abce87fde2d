#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Wrong usage ends with 2 and says what to do; help ends with 0 and shows examples."""
import unittest

from program import ProgramTest

COMMANDS = [["render"], ["apply"], ["ghosts"], ["compare"], ["lens", "list"], ["lens", "info"], ["lens", "draw"],
            ["lens", "trace"], ["lens", "check"], ["lens", "convert"], ["lens", "browse"],
            ["glass", "list"], ["glass", "show"], ["glass", "closest"], ["preset", "list"], ["preset", "show"], ["bench", "tables"],
            ["bench", "lenses"], ["bench", "hullin"]]


class Usage(ProgramTest):
    def test_help(self):
        for command in COMMANDS:
            done = self.run_program(*command, "--help")
            self.assertIn("Examples:\n  contrejour " + " ".join(command), done.stdout.decode())
            self.assertEqual(done.stderr, b"")
        self.assertIn("render", self.run_program("--help").stdout.decode())
        self.assertRegex(self.run_program("--version").stdout.decode(), r"^contrejour \d+\.\d+\.\d+\n$")

    def test_help_shows_only_what_a_command_uses(self):
        """Options that a command's help omits are accepted and have no effect; options that it shows have one."""
        def help_of(*command):
            return self.run_program(*command, "--help").stdout.decode()

        for command in (["render"], ["apply"]):
            for option in ("--dust ", "--blades ", "--coating ", "--absorption"):
                self.assertIn(option, help_of(*command))
        self.assertNotIn("--dust", help_of("ghosts"))
        self.assertNotIn("--dirt-image", help_of("lens", "trace"))
        for command in (["lens", "info"], ["lens", "draw"]):
            for option in ("--dust", "--blades", "--sensor-pitch", "--absorption"):
                self.assertNotIn(option, help_of(*command))
        unused = ["--dust", "9", "--scratch-angle", "20", "--blades", "7", "--sensor-orders", "2", "--absorption"]
        plain, dirty = (self.run_program("lens", "info", "heliar", *more).stdout for more in ([], unused))
        self.assertEqual(plain, dirty)

    def test_earlier_names_of_options(self):
        """An option's earlier name has the same effect for one version, and the help does not show it."""
        quick = ["--size", "48x32", "--wavelengths", "1"]
        present = ["--dust", "20", "--dust-size", "0.5", "--dirt-plane", "stop", "--dirt-phase", "0.3", "--blades", "7",
                   "--blade-slope-error", "0.2", "--ghost-jitter", "0.1"]
        earlier = {"--dirt-plane": "--dirt-on", "--dirt-phase": "--dirt-time", "--blade-slope-error": "--blade-spread",
                   "--ghost-jitter": "--ghost-scatter"}
        bundle = {"--mirror-symmetry": "--mirror", "--precomputed-pupils": "--pupil-table"}
        self.run_program("render", "heliar", *present, "-o", "a.exr", *quick)
        self.run_program("render", "heliar", *[earlier.get(word, word) for word in present], "-o", "b.exr", *quick)
        self.assertEqual((self.folder / "a.exr").read_bytes(), (self.folder / "b.exr").read_bytes())
        self.run_program("render", "heliar", "--method", "bundle", "--grid", "16", *bundle.values(), "--save-preset", "l.toml",
                         "-o", "c.exr", *quick)
        saved = (self.folder / "l.toml").read_text()
        self.run_program("render", "--look", "l.toml", "--save-look", "m.toml", "-o", "d.exr", *quick)
        self.assertEqual((self.folder / "m.toml").read_text(), saved)
        self.assertEqual(self.run_program("look", "list").stdout, self.run_program("preset", "list").stdout)
        for name in bundle:
            self.assertIn(f"{name[2:]} = true", saved)
        shown = self.run_program("render", "--help").stdout.decode()
        for name in [*earlier.values(), *bundle.values(), "--look", "--save-look"]:
            self.assertNotRegex(shown, name + r"[ ,{]")

    def test_the_lens_is_missing(self):
        """A picture in place of the lens, and a lens without a picture, are distinct errors."""
        (self.folder / "plate.exr").write_bytes(b"")
        self.assertIn("LENS before plate.exr", self.error_of("apply", "plate.exr", "-o", "out.exr", code=2))
        self.assertIn("LENS before A.PNG", self.error_of("apply", "A.PNG", "-o", "out.exr", code=2))
        self.assertIn("IN is required", self.error_of("apply", "heliar", "-o", "out.exr", code=2))

    def test_wrong_options(self):
        render = ["render", "heliar", "-o", "a.exr"]
        for wrong in (
                [], ["lens"], ["frobnicate"], ["render"], ["render", "heliar"], ["render", "heliar", "-o", "a.gif"],
                [*render, "--bogus"], [*render, "--size", "0x10"], [*render, "--size", "10"], [*render, "--size", "-4x4"],
                [*render, "--size", "20000x20000"], [*render, "--size", "99999999999x1"],
                [*render, "-f", "nan"], [*render, "-f", "inf"], [*render, "-f", "0"], [*render, "-f", "8", "-f", "11"],
                [*render, "--value", "-1"], [*render, "--value", "1e400"], [*render, "--value", "1,2"],
                [*render, "--value", "1e300"], [*render, "--value", "1,1,1e39"], [*render, "--light", "1,2:1e16"],
                [*render, "--ghost", "2-5:gain=1e308"], [*render, "--ghost", "2-5:colour=1,1e300,1"],
                [*render, "--ghost", "2-5:offset=1e300,0"], [*render, "--ghost-ramp=0:1e308,1,1"],
                [*render, "--ghost-ramp=-1e308:1,1,1/1e308:1,1,1"], [*render, "--colour", "1e300,1,1"],
                [*render, "--pixel-aspect", "0"], [*render, "--pixel-aspect", "inf"],
                [*render, "--colour", "mauve"], [*render, "--colour", "20K"], [*render, "--light", "1"],
                [*render, "--light", "nan,0"], [*render, "--light", "1,2:3:D65:4:5:6"], [*render, "--focus", "-1"],
                [*render, "--method", "magic"], [*render, "--device", "toaster"], [*render, "--grid", "3"],
                [*render, "--wavelengths", "0"], [*render, "--wavelengths", "2.5"], [*render, "--threads", "-1"],
                [*render, "--threads", "100000"], [*render, "--select", "best"], [*render, "--coating", "paint"],
                [*render, "--blades", "-3"], [*render, "--blades", "1"], [*render, "--blades", "2"], [*render, "--blade-curvature", "1.1"], [*render, "--blade-asymmetry", "-0.1"],
                [*render, "--blade-seed", "-1"], [*render, "--blade-closing", "slowly"], [*render, "--iris-image"],
                [*render, "--preview", "a.exr"], [*render, "--stats", "a.txt"],
                ["apply", "heliar", "in.exr", "-o", "o.exr", "--threshold", "nan"],
                ["apply", "heliar", "in.exr", "-o", "o.exr", "--gain", "-1"],
                ["apply", "heliar", "in.exr", "-o", "o.exr", "--max-lights", "0"],
                ["apply", "heliar", "in.exr", "-o", "o.exr", "--max-value", "0"],
                ["apply", "heliar", "in.exr", "-o", "o.exr", "--max-value", "1e11"],
                ["apply", "heliar", "in.exr", "-o", "o.exr", "--hfov", "180"],
                ["lens", "trace", "heliar", "--ray", "0,0,0"], ["lens", "trace", "heliar", "--ray", "0,0,0,0,0,0"],
                ["lens", "trace", "heliar", "--ray", "0,0,0,0,0,-1"],
                ["lens", "trace", "heliar", "--ray", "0,0,0,0,0,1", "--ghost", "5,5"],
                ["lens", "draw", "heliar", "-o", "a.png"], ["lens", "draw", "heliar", "-o", "a.svg", "--light", "1,1"],
                ["lens", "convert", "heliar", "a.json"], ["ghosts", "heliar", "--light", "1,1", "2,2"],
                ["glass"], ["glass", "show"], ["glass", "closest", "1.5"], ["glass", "closest", "nan", "60"],
                ["bench", "tables", "--systems", "brownie"], ["bench", "tables", "--methods", "magic"],
                ["bench", "hullin", "--figures", "18"], ["bench", "hullin", "--lenses", "brownie"]):
            with self.subTest(wrong):
                self.assertIn("--help)", self.error_of(*wrong, code=2))
        self.assertEqual(self.files(), [])

    def test_did_you_mean(self):
        self.assertIn("--light-at", self.error_of("render", "heliar", "-o", "a.exr", "--lightat", "0,0", code=2))
        self.assertIn("render", self.error_of("rendr", code=2))

    def test_values_a_lens_refuses_are_failures(self):
        for wrong in (["-f", "0.5"], ["--focal", "50"], ["--focus", "1mm"], ["--light", "95,0"],
                      ["--value", "1,1,1", "--colour", "1,1,1"], ["--value", "1e15", "--ghost-gain", "1e12"],
                      ["--value", "1e15", "--ghost-edge-gain", "1e12"], ["--value", "1e15", "--ghost", "2-5:gain=1e3"],
                      ["--value", "1e12", "--colour", "1e12,1,1"], ["--value", "1e15", "--starburst", "--starburst-gain", "100"],
                      ["--value", "1e15", "--ghost-ramp=0:1e3,1,1"]):
            with self.subTest(wrong):
                self.error_of("render", "heliar", "-o", "a.exr", "--size", "8x8", "--grid", "16", *wrong, code=1)
        self.error_of("lens", "trace", "heliar", "--ray", "0,0,0,0,0,1", "--ghost", "2,40", code=1)
        self.assertEqual(self.files(), [])


if __name__ == "__main__":
    unittest.main()
