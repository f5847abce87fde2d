# SPDX-License-Identifier: Apache-2.0
"""Runs the examples, small."""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

import contrejour

EXAMPLES = pathlib.Path(__file__).parents[2] / "examples" / "python"


class ExamplesTest(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = pathlib.Path(holder.name)

    def run_example(self, name, *arguments):
        done = subprocess.run([sys.executable, EXAMPLES / name, *map(str, arguments)], capture_output=True, text=True,
                              timeout=300, cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_flare(self):
        text = self.run_example("flare.py", "cooke-triplet", "flare.exr", "90")
        self.assertIn("flare.exr: ", text)
        self.assertEqual(contrejour.read_picture(self.folder / "flare.exr").shape, (60, 90, 3))

    def test_worst_coating(self):
        text = self.run_example("worst_coating.py", "cooke-triplet")
        shares = [float(line.split(":")[1].split("%")[0]) for line in text.splitlines() if line.startswith("  surface")]
        self.assertEqual(shares, sorted(shares, reverse=True))
        self.assertAlmostEqual(sum(shares), 200, delta=1)  # each ghost reflects at two surfaces
        self.assertGreater(float(text.rsplit(",", 1)[1].split("%")[0]), 5)  # a better coating helps

    def test_ghosts_by_focal_length(self):
        lines = self.run_example("ghosts_by_focal_length.py", "nikon-80-200", "2").splitlines()
        self.assertEqual(len(lines), 3)
        self.assertAlmostEqual(float(lines[1].split()[0]), contrejour.find_lens("nikon-80-200").zoom_mm[0], delta=0.1)

    def test_coating_search(self):
        lines = self.run_example("coating_search.py", "cooke-triplet", "25").splitlines()
        fluxes = [float(line.split()[0]) for line in lines]
        self.assertEqual(len(fluxes), 4)
        self.assertLess(fluxes[3], fluxes[2])
        self.assertEqual(lines, self.run_example("coating_search.py", "cooke-triplet", "25").splitlines())

    def test_build_errors(self):
        lines = self.run_example("build_errors.py", "cooke-triplet", "4").splitlines()
        self.assertEqual(len(lines), 7)
        self.assertTrue(all(float(line.split()[-1]) > 0.01 for line in lines[1:]))

    def test_data_set(self):
        for folder, processes in (("one", 1), ("two", 2)):
            self.run_example("data_set.py", folder, 2, 7, 48, processes)
        manifest = json.loads((self.folder / "one" / "manifest.json").read_text())
        self.assertEqual(len(manifest["pairs"]), 2)
        for pair in manifest["pairs"]:
            clean, flare = (contrejour.read_picture(self.folder / "one" / pair[kind]) for kind in ("clean", "flare"))
            self.assertTrue((flare >= clean).all() and (flare > clean).any())
        for file in (self.folder / "one").iterdir():
            self.assertEqual(file.read_bytes(), (self.folder / "two" / file.name).read_bytes(), file.name)


if __name__ == "__main__":
    unittest.main()
