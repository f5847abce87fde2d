#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""--layers: channels that sum to the flare, their names, and the same ones in all frames of a sequence."""
import json
import unittest

import exr
from program import ProgramTest

LENS = ["heliar", "-f", "8", "--size", "60x40"]
LIGHTS = """
[[light]]
name = "head light"
at = [0.7, 0.33]
value = { 1 = 1000, 3 = 3000 }
[[light]]
at = [0.3, 0.6]
value = 200
on = { 1 = true, 2 = false }
"""


class Layers(ProgramTest):
    def layers_of(self, name):
        """The names of the file's layers, which must sum to its R, G and B."""
        picture = exr.Picture(self.folder / name)
        names = sorted({channel.rsplit(".", 1)[0] for channel in picture.channels if "." in channel})
        peak = max(max(picture.channels[c]) for c in "RGB")
        for c in "RGB":
            sums = [sum(values) for values in zip(*(picture.channels[f"{layer}.{c}"] for layer in names))]
            worst = max(abs(a - b) for a, b in zip(sums, picture.channels[c]))
            self.assertLessEqual(worst, 1e-6 * peak)
        return names

    def sum_of(self, name, channel):
        return sum(exr.Picture(self.folder / name).channels[channel])

    def test_parts_ghosts_and_surfaces(self):
        self.run_program("render", *LENS, "-o", "plain.exr", "--starburst", "--glare", "0.05")
        for kind, expected in (("part", ["ghosts", "glare", "starburst"]),
                               ("ghost", ["ghost_1_2", "ghost_2_5", "glare", "rest", "starburst"]),
                               ("surface", None)):
            extra = ["--layer-ghosts", "2-5,1-2"] if kind == "ghost" else []
            self.run_program("render", *LENS, "-o", "f.exr", "--starburst", "--glare", "0.05", "--layers", kind, *extra)
            names = self.layers_of("f.exr")
            if expected:
                self.assertEqual(names, expected)
            plain, layered = (exr.Picture(self.folder / name) for name in ("plain.exr", "f.exr"))
            peak = max(plain.channels["G"])
            worst = max(abs(a - b) for a, b in zip(plain.channels["G"], layered.channels["G"]))
            self.assertLessEqual(worst, 1e-6 * peak)
        self.assertIn("surface_5", names)
        for other in (["--pixel-aspect", "2"], ["--method", "tiled", "--grid", "16"], ["--light-size", "2"]):
            self.run_program("render", *LENS, *other, "-o", "f.exr", "--layers", "ghost", "--layer-count", "3")
            self.assertEqual(len(self.layers_of("f.exr")), 4)

    def test_named_lights_over_frames(self):
        (self.folder / "lights.toml").write_text(LIGHTS)
        render = ["render", *LENS, "-o", "f.#.exr", "--frames", "1-3", "--lights", "lights.toml", "--layers"]
        self.run_program(*render, "light")
        for frame in (1, 2, 3):
            self.assertEqual(self.layers_of(f"f.{frame}.exr"), ["head_light", "light2"])
        self.assertGreater(self.sum_of("f.1.exr", "light2.G"), 0.0)
        self.assertEqual(self.sum_of("f.2.exr", "light2.G"), 0.0)
        ratio = self.sum_of("f.3.exr", "head_light.G") / self.sum_of("f.1.exr", "head_light.G")
        self.assertAlmostEqual(ratio, 3.0, delta=0.01)

        # The layers are a part of the settings that --resume compares.
        before = (self.folder / "f.2.exr").stat().st_mtime_ns
        self.run_program(*render, "light", "--resume")
        self.assertEqual((self.folder / "f.2.exr").stat().st_mtime_ns, before)
        by_ghost = [*render, "ghost", "--layer-count", "2"]
        done = self.run_program(*by_ghost, "--resume", "--json")
        names = {tuple(self.layers_of(f"f.{frame}.exr")) for frame in (1, 2, 3)}
        self.assertEqual(len(names), 1)
        self.assertEqual(len(names.pop()), 3)
        self.assertIn("--layer-ghosts", done.stderr.decode())
        # The list of ghosts is no part of what other programs read.
        self.assertEqual([json.loads(line)["frame"] for line in done.stdout.splitlines()], [1, 2, 3])
        self.assertEqual(self.run_program(*by_ghost, "--list-frames").stdout, b"1-3\n")

    def test_photographs(self):
        values = [0.01] * (60 * 40)
        values[13 * 60 + 41] = 5000.0
        exr.write(self.folder / "plate.exr", {c: (exr.HALF, values) for c in "RGB"}, 60, 40)
        apply = ["apply", "heliar", "-f", "8", "plate.exr", "-o", "out.exr"]
        self.run_program(*apply, "--flare-only", "f.exr", "--light-at", "0.2,0.7:300", "--starburst", "--layers", "light")
        self.assertEqual(self.layers_of("f.exr"), ["light1", "light2"])
        self.assertEqual(sorted(exr.Picture(self.folder / "out.exr").channels), ["B", "G", "R"])
        report = self.run_program(*apply, "--flare-only", "f.exr", "--threshold", "1e5", "--layers", "part", "--json")
        self.assertEqual(json.loads(report.stdout)["lights"], [])
        self.assertEqual(self.layers_of("f.exr"), ["ghosts"])
        self.assertIn("--flare-only", self.error_of(*apply, "--layers", "part", code=1))

    def test_wrong_options(self):
        render = ["render", *LENS, "-o", "f.exr"]
        self.assertIn(".exr", self.error_of("render", *LENS, "-o", "f.png", "--layers", "part", code=1))
        self.assertIn("--layers ghost", self.error_of(*render, "--layers", "part", "--layer-ghosts", "2-5", code=1))
        self.assertIn("no ghost 2-77", self.error_of(*render, "--layers", "ghost", "--layer-ghosts", "2-77", code=1))
        self.assertIn("is not a ghost", self.error_of(*render, "--layers", "ghost", "--layer-ghosts", "x", code=1))
        self.run_program(*render, "--layers", "nothing", code=2)
        self.assertEqual(self.files(), [])


if __name__ == "__main__":
    unittest.main()
