# SPDX-License-Identifier: Apache-2.0
"""One lens, one preset, one light: the command line, C, Python and the OpenFX plug-in render the same picture, bit for
bit. One lens: they draw the same section."""
import os
import pathlib
import subprocess
import tempfile
import unittest

import numpy as np

import contrejour

LENS = "cooke-triplet"
WIDTH, HEIGHT = 60, 40
SETTINGS = {"fnumber": "5.6", "blades": "6", "coating": "v-coat", "light": "9,5:1000:3200K", "wavelengths": "4",
            "starburst": "on", "error": "0.02"}
FLARE = pathlib.Path(__file__).resolve().parents[2] / "fuzz/corpus/measured_flare/one.flare.toml"


def read_pfm(file):
    header, size, scale, pixels = file.read_bytes().split(b"\n", 3)
    assert header == b"PF" and scale == b"-1.0"
    width, height = map(int, size.split())
    return np.frombuffer(pixels, "<f4").reshape(height, width, 3)[::-1]


class FrontEndsTest(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = pathlib.Path(holder.name)

    def by_command_line(self, lens, settings):
        options = [f"--{name}" if text == "on" else f"--{name}={text}" for name, text in settings.items()]
        size = f"--size={WIDTH}x{HEIGHT}"
        self.run_program(os.environ["CONTREJOUR"], "render", lens, "-o", self.folder / "cli.exr", size, *options)
        return contrejour.read_picture(self.folder / "cli.exr")

    def by_c(self, lens, settings):
        options = [f"{name}={text}" for name, text in settings.items()]
        self.run_program(os.environ["CONTREJOUR_EXAMPLE_C"], lens, self.folder / "c.pfm", f"size={WIDTH}x{HEIGHT}", *options)
        return read_pfm(self.folder / "c.pfm")

    def by_python(self, lens, settings):
        keywords = {name.replace("-", "_"): text for name, text in settings.items()}
        return contrejour.render(lens, width=WIDTH, height=HEIGHT, **keywords).image

    def by_plugin(self, lens, settings):
        # The lens by its file's name, which may be a bundled name, too. Square pixels are the host's.
        options = [f"{name.replace('-', '_')}={text}" for name, text in settings.items() if name != "pixel-aspect"]
        self.run_program(os.environ["CONTREJOUR_OPENFX_PROGRAM"], "render", WIDTH, HEIGHT, self.folder / "ofx.pfm",
                         f"lensFile={lens}", "light1On=off", *options)
        return read_pfm(self.folder / "ofx.pfm")

    def run_program(self, *arguments):
        done = subprocess.run(list(map(str, arguments)), capture_output=True, text=True, timeout=300)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def check_same(self, lens, settings):
        reference = self.by_command_line(lens, settings)
        self.assertEqual(reference.shape, (HEIGHT, WIDTH, 3))
        self.assertGreater(reference.max(), 0)
        for front_end in (self.by_c, self.by_python, self.by_plugin):
            picture = front_end(lens, settings)
            self.assertEqual(picture.astype("<f4").tobytes(), reference.astype("<f4").tobytes(),
                             f"{front_end.__name__}, {lens}")

    def test_same_bits(self):
        self.check_same(LENS, SETTINGS)

    def test_same_bits_of_an_anamorphic_lens(self):
        # The lens squeezes, so that pixels that are square as displayed are none on the sensor.
        self.check_same("schneider-anamorphic-31", {**SETTINGS, "pixel-aspect": "1"})

    def test_same_bits_of_a_measured_flare(self):
        self.check_same(str(FLARE), {"light": "9,5:1000", "fnumber": "2.8", "pixel-aspect": "1"})

    def test_same_section(self):
        self.run_program(os.environ["CONTREJOUR"], "lens", "draw", LENS, "-f", "8", "-o", self.folder / "lens.svg")
        drawn = (self.folder / "lens.svg").read_text(encoding="utf-8")
        state = contrejour.configure_lens(LENS, f_number=8)
        self.assertEqual(state._repr_svg_(), drawn)
        self.run_program(os.environ["CONTREJOUR"], "lens", "draw", LENS, "--ghost", "1-3", "-o", self.folder / "ghost.svg")
        drawn = (self.folder / "ghost.svg").read_text(encoding="utf-8")
        self.assertEqual(contrejour.configure_lens(LENS).section_svg(ghosts=[(1, 3)]), drawn)


if __name__ == "__main__":
    unittest.main()
