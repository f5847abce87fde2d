# SPDX-License-Identifier: Apache-2.0
"""One lens, one preset, one light: the command line, C and Python render the same picture, bit for bit."""
import os
import pathlib
import subprocess
import tempfile
import unittest

import numpy as np

import contrejour

LENS = "cooke-triplet"
SETTINGS = {"size": "60x40", "fnumber": "5.6", "blades": "6", "coating": "v-coat", "light": "9,5:1000:3200K", "wavelengths": "4",
            "starburst": "on", "error": "0.02"}


def read_pfm(file):
    header, size, scale, pixels = file.read_bytes().split(b"\n", 3)
    assert header == b"PF" and scale == b"-1.0"
    width, height = map(int, size.split())
    return np.frombuffer(pixels, "<f4").reshape(height, width, 3)[::-1]


class SamePictureTest(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = pathlib.Path(holder.name)

    def by_command_line(self, lens, settings):
        options = [f"--{name}" if text == "on" else f"--{name}={text}" for name, text in settings.items()]
        self.run_program(os.environ["CONTREJOUR"], "render", lens, "-o", self.folder / "cli.exr", *options)
        return contrejour.read_picture(self.folder / "cli.exr")

    def by_c(self, lens, settings):
        options = [f"{name}={text}" for name, text in settings.items()]
        self.run_program(os.environ["CONTREJOUR_EXAMPLE_C"], lens, self.folder / "c.pfm", *options)
        return read_pfm(self.folder / "c.pfm")

    def run_program(self, *arguments):
        done = subprocess.run(list(map(str, arguments)), capture_output=True, text=True, timeout=300)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_same_bits(self):
        # The second lens squeezes, so that its square pixels are none on the sensor.
        for lens, more in ((LENS, {}), ("schneider-anamorphic-31", {"pixel-aspect": "1"})):
            settings = {**SETTINGS, **more}
            reference = self.by_command_line(lens, settings)
            self.assertEqual(reference.shape, (40, 60, 3))
            self.assertGreater(reference.max(), 0)
            keywords = {name.replace("-", "_"): text for name, text in settings.items()}
            pictures = {"C": self.by_c(lens, settings), "Python": contrejour.render(lens, **keywords).image}
            for name, picture in pictures.items():
                self.assertEqual(picture.astype("<f4").tobytes(), reference.astype("<f4").tobytes(), f"{name}, {lens}")


if __name__ == "__main__":
    unittest.main()
