#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""contrejour look, --look and --save-look."""
import unittest

from program import QUICK, ProgramTest


class Look(ProgramTest):
    def test_list_and_show(self):
        looks = self.json_of("look", "list")["looks"]
        self.assertGreaterEqual(len(looks), 10)
        text = self.run_program("look", "list").stdout.decode()
        for look in looks:
            with self.subTest(look["id"]):
                self.assertIn(look["id"], text)
                shown = self.json_of("look", "show", look["id"])
                self.assertEqual((shown["name"], shown["lens"]), (look["name"], look["lens"]))
                self.assertIn("fnumber", shown["values"])

    def test_what_show_prints_is_the_look(self):
        (self.folder / "a.toml").write_bytes(self.run_program("look", "show", "old-portrait").stdout)
        self.run_program("render", "--look", "old-portrait", "-o", "a.exr", *QUICK)
        self.run_program("render", "--look", "a.toml", "-o", "b.exr", *QUICK)
        self.assertEqual((self.folder / "a.exr").read_bytes(), (self.folder / "b.exr").read_bytes())

    def test_options_override_and_are_saved(self):
        self.run_program("render", "--look", "old-portrait", "-f", "11", "--blades", "5", "--mirror-symmetry", "-o", "a.exr",
                         "--save-look", "mine.toml", *QUICK)
        shown = self.json_of("look", "show", "mine.toml")
        self.assertEqual((shown["lens"], shown["values"]["fnumber"], shown["values"]["blades"]), ("heliar", "11", "5"))
        self.assertEqual(shown["values"]["mirror-symmetry"], "on")
        self.run_program("render", "heliar", "-f", "11", "--blades", "5", "--coating", "none", "--blade-curvature", "0.3",
                         "--starburst", "-o", "b.exr", *QUICK)
        self.run_program("render", "--look", "mine.toml", "--no-mirror-symmetry", "-o", "c.exr", *QUICK)
        self.assertEqual((self.folder / "b.exr").read_bytes(), (self.folder / "c.exr").read_bytes())

    def test_another_lens_takes_a_looks_settings(self):
        self.run_program("render", "tessar", "--look", "old-portrait", "-o", "a.exr", "--save-look", "a.toml", *QUICK)
        self.assertEqual(self.json_of("look", "show", "a.toml")["lens"], "tessar")

    def test_a_look_on_a_photograph(self):
        self.run_program("render", "heliar", "-f", "16", "-o", "plate.exr", *QUICK)
        self.run_program("apply", "--look", "old-portrait", "plate.exr", "-o", "a.exr", "--save-look", "a.toml")
        self.run_program("apply", "heliar", "--look", "a.toml", "plate.exr", "-o", "b.exr")
        self.assertEqual((self.folder / "a.exr").read_bytes(), (self.folder / "b.exr").read_bytes())

    def test_errors(self):
        (self.folder / "bad.toml").write_text("fnumber = 5.6\nblads = 7\n")
        text = self.error_of("render", "--look", "bad.toml", "-o", "a.exr", code=1)
        self.assertIn("bad.toml:2: ", text)
        self.assertIn("blades", text)
        (self.folder / "none.toml").write_text("blades = 7\n")
        self.assertIn("names no lens", self.error_of("render", "--look", "none.toml", "-o", "a.exr", code=1))
        self.assertIn("old-portrait", self.error_of("look", "show", "old-portrat", code=1))
        self.error_of("render", "--look", "absent.toml", "-o", "a.exr", code=1)
        self.error_of("render", "-o", "a.exr", code=2)
        self.error_of("render", "heliar", "-o", "a.exr", "--save-look", "a.txt", code=2)
        self.error_of("render", "heliar", "-o", "a.exr", "--save-look", "no/such/place/a.toml", code=1)
        self.error_of("apply", "heliar", "-o", "a.exr", code=2)
        self.assertEqual(self.files(), ["bad.toml", "none.toml"])


if __name__ == "__main__":
    unittest.main()
