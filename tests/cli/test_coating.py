#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""contrejour coating, and --coating with what it prints."""
import re
import unittest
import xml.etree.ElementTree as xml

from program import QUICK, ProgramTest


class Coating(ProgramTest):
    def test_list(self):
        listed = self.json_of("coating", "list")
        self.assertIn("broadband-7", listed["designs"])
        magnesium = next(m for m in listed["materials"] if m["name"] == "MgF2")
        self.assertAlmostEqual(magnesium["n_550"], 1.3785, places=4)
        text = self.run_program("coating", "list").stdout.decode()
        for name in listed["designs"] + [m["name"] for m in listed["materials"]]:
            self.assertIn(name, text)

    def test_show(self):
        shown = self.json_of("coating", "show", "v-coat:600", "--glass", "1.62,36")
        self.assertEqual([layer["material"] for layer in shown["layers"]], ["MgF2", "ZrO2"])
        at_600 = next(row for row in shown["reflectance"] if row["lambda_nm"] == 600)
        self.assertLess(at_600["reflectance_0deg"], 1e-9)
        self.assertLess(at_600["reflectance_0deg"], at_600["reflectance_60deg"])
        text = self.run_program("coating", "show", "quarter-wave").stdout.decode()
        self.assertIn("420 to 680 nm: mean 1.42", text)

    def test_drawing(self):
        self.run_program("coating", "show", "broadband-5", "-o", "r.svg")
        drawing = xml.parse(self.folder / "r.svg").getroot()
        lines = [e for e in drawing.iter() if e.tag.endswith("polyline")]
        self.assertEqual(len(lines), 5)

    def test_what_fit_finds_has_the_colour_and_can_be_used(self):
        wanted = (0x7A, 0x4C, 0xFF)
        fits = self.json_of("coating", "fit", "#7a4cff")["fits"]
        self.assertLess(fits[0]["difference_uv"], 0.002)
        self.assertEqual([f["difference_uv"] for f in fits], sorted(f["difference_uv"] for f in fits))
        shown = self.json_of("coating", "show", fits[0]["coating"])["shown_as"]
        self.assertTrue(re.fullmatch("#[0-9a-f]{6}", shown))
        for channel, value in zip(wanted, bytes.fromhex(shown[1:])):
            self.assertLess(abs(channel - value), 6)
        self.run_program("render", "heliar", "--coating", fits[0]["coating"], "-o", "a.exr", *QUICK)

    def test_a_design_renders_as_its_films(self):
        self.run_program("render", "cooke-triplet", "--coating", "broadband-4", "-o", "a.exr", *QUICK)
        self.run_program("render", "cooke-triplet", "--coating", "none", "-o", "b.exr", *QUICK)
        self.assertNotEqual((self.folder / "a.exr").read_bytes(), (self.folder / "b.exr").read_bytes())

    def test_wrong_words(self):
        self.assertIn("is not a coating", self.error_of("coating", "show", "velvet", code=1))
        self.assertIn("is not a glass", self.error_of("coating", "show", "none", "--glass", "0.5", code=1))
        self.assertIn("did you mean", self.error_of("coating", "show", "none", "--glass", "N-BK8X", code=1))
        self.assertIn("is not a colour", self.error_of("coating", "fit", "#12", code=1))
        self.assertIn("black", self.error_of("coating", "fit", "0,0,0", code=1))
        self.assertIn("is not a film", self.error_of("coating", "show", "stack:MgF3@90", code=1))
        self.assertIn("is not a film", self.error_of("coating", "show", "stack:MgF2@90q", code=1))
        self.assertEqual(self.files(), [])


if __name__ == "__main__":
    unittest.main()
