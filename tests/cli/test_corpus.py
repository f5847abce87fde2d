#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Every sample lens file: what is read, refused, off; docs/formats/samples.md has each that is off, with its reason."""
import os
import pathlib
import re
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
import lens_corpus

PROGRAM = pathlib.Path(os.environ.get("CONTREJOUR", "contrejour")).resolve()
LENSES = pathlib.Path(os.environ.get("CONTREJOUR_SHARED_DATA", ROOT.parent / "shared" / "data")) / "lenses"


class Corpus(unittest.TestCase):
    @unittest.skipUnless(LENSES.is_dir(), "needs the shared data, which is not here")
    def test_samples(self):
        summary = lens_corpus.survey(PROGRAM, LENSES)
        refused = {reason: len(names) for reason, names in summary["refused"].items()}
        self.assertEqual(refused, {
            "mirrors": 39, "diffractive, thin, ideal or Fresnel elements": 17,
            "parts of lenses: no stop and no image": 8, "no image of distant objects": 4,
            "axes that tilt or shift for good": 3, "other programs' formats": 2, "no lens, or none with an f-number": 2})
        self.assertEqual((summary["files"], summary["read"]), (451, 376))
        self.assertEqual((summary["stated"], summary["within_1_percent"], summary["within_3_percent"]), (331, 278, 295))
        self.assertEqual(len(summary["stops_placed"]), 6)
        # The reader is right where the file is off.
        self.assertEqual(summary["second_opinions"], 285)
        self.assertEqual(summary["second_opinions_differ"], {})
        page = (ROOT / "docs" / "formats" / "samples.md").read_text(encoding="utf-8")
        rows = re.findall(r"^\| (\S+/\S+) \| (\S+) \| (\S+) \| (.+) \|$", page, re.M)
        self.assertEqual(sorted(name for name, *_ in rows), sorted(summary["off"]))
        for name, stated, has, why in rows:
            with self.subTest(name):
                self.assertAlmostEqual(float(stated) / summary["off"][name][0], 1, delta=2e-3)
                self.assertAlmostEqual(float(has) / summary["off"][name][1], 1, delta=2e-2)
                self.assertGreater(len(why), 5)


if __name__ == "__main__":
    unittest.main()
