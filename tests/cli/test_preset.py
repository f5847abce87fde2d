#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""contrejour preset, --preset and --save-preset."""
import unittest

from program import QUICK, ProgramTest


class Preset(ProgramTest):
    def test_list_and_show(self):
        presets = self.json_of("preset", "list")["looks"]
        self.assertGreaterEqual(len(presets), 10)
        text = self.run_program("preset", "list").stdout.decode()
        for preset in presets:
            with self.subTest(preset["id"]):
                self.assertIn(preset["id"], text)
                shown = self.json_of("preset", "show", preset["id"])
                self.assertEqual((shown["name"], shown["lens"]), (preset["name"], preset["lens"]))
                self.assertIn("fnumber", shown["values"])

    def test_what_show_prints_is_the_preset(self):
        (self.folder / "a.toml").write_bytes(self.run_program("preset", "show", "old-portrait").stdout)
        self.run_program("render", "--preset", "old-portrait", "-o", "a.exr", *QUICK)
        self.run_program("render", "--preset", "a.toml", "-o", "b.exr", *QUICK)
        self.assertEqual((self.folder / "a.exr").read_bytes(), (self.folder / "b.exr").read_bytes())

    def test_options_override_and_are_saved(self):
        self.run_program("render", "--preset", "old-portrait", "-f", "11", "--blades", "5", "--mirror-symmetry", "-o", "a.exr",
                         "--save-preset", "mine.toml", *QUICK)
        shown = self.json_of("preset", "show", "mine.toml")
        self.assertEqual((shown["lens"], shown["values"]["fnumber"], shown["values"]["blades"]), ("heliar", "11", "5"))
        self.assertEqual(shown["values"]["mirror-symmetry"], "on")
        self.run_program("render", "heliar", "-f", "11", "--blades", "5", "--coating", "none", "--blade-curvature", "0.3",
                         "--starburst", "-o", "b.exr", *QUICK)
        self.run_program("render", "--preset", "mine.toml", "--no-mirror-symmetry", "-o", "c.exr", *QUICK)
        self.assertEqual((self.folder / "b.exr").read_bytes(), (self.folder / "c.exr").read_bytes())

    def test_another_lens_takes_a_presets_settings(self):
        self.run_program("render", "tessar", "--preset", "old-portrait", "-o", "a.exr", "--save-preset", "a.toml", *QUICK)
        self.assertEqual(self.json_of("preset", "show", "a.toml")["lens"], "tessar")

    def test_a_preset_on_a_photograph(self):
        self.run_program("render", "heliar", "-f", "16", "-o", "plate.exr", *QUICK)
        self.run_program("apply", "--preset", "old-portrait", "plate.exr", "-o", "a.exr", "--save-preset", "a.toml")
        self.run_program("apply", "heliar", "--preset", "a.toml", "plate.exr", "-o", "b.exr")
        self.assertEqual((self.folder / "a.exr").read_bytes(), (self.folder / "b.exr").read_bytes())

    def test_errors(self):
        (self.folder / "bad.toml").write_text("fnumber = 5.6\nblads = 7\n")
        text = self.error_of("render", "--preset", "bad.toml", "-o", "a.exr", code=1)
        self.assertIn("bad.toml:2: ", text)
        self.assertIn("blades", text)
        (self.folder / "none.toml").write_text("blades = 7\n")
        self.assertIn("names no lens", self.error_of("render", "--preset", "none.toml", "-o", "a.exr", code=1))
        self.assertIn("old-portrait", self.error_of("preset", "show", "old-portrat", code=1))
        self.error_of("render", "--preset", "absent.toml", "-o", "a.exr", code=1)
        self.error_of("render", "-o", "a.exr", code=2)
        self.error_of("render", "heliar", "-o", "a.exr", "--save-preset", "a.txt", code=2)
        self.error_of("render", "heliar", "-o", "a.exr", "--save-preset", "no/such/place/a.toml", code=1)
        self.error_of("apply", "heliar", "-o", "a.exr", code=2)
        self.assertEqual(self.files(), ["bad.toml", "none.toml"])


if __name__ == "__main__":
    unittest.main()
