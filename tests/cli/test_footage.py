#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The demonstration's moving shot, whose true lights are known: tracking and flare over time."""
import math
import os
import pathlib
import subprocess
import tempfile
import tomllib
import unittest

import exr
from keys import at_frame
from program import PROGRAM, ProgramTest

DEMO = os.environ.get("CONTREJOUR_DEMO", "contrejour-demo")
WIDTH, HEIGHT, FIRST, FRAMES = 320, 180, 1001, 48
NUMBERS = range(FIRST, FIRST + FRAMES)


class Footage(ProgramTest):
    @classmethod
    def setUpClass(cls):
        holder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(holder.cleanup)
        cls.shared = pathlib.Path(holder.name)
        cls.make(cls.shared)
        subprocess.run([PROGRAM, "lights", "track", "plate.####.exr", "-o", "lights.toml"], cwd=cls.shared, check=True,
                       capture_output=True, timeout=300)

    def setUp(self):
        self.folder = self.shared

    @staticmethod
    def make(folder, frames=FRAMES):
        subprocess.run([DEMO, "footage", folder, "--width", str(WIDTH), "--height", str(HEIGHT), "--frames", str(frames)],
                       check=True, capture_output=True, timeout=300)

    def lights(self, name):
        return tomllib.loads((self.folder / name).read_text())["light"]

    @staticmethod
    def place(light, frame):
        u, v = at_frame(light["at"], frame)
        return u * WIDTH, v * HEIGHT

    def distance(self, light, other, frame):
        (x, y), (u, v) = self.place(light, frame), self.place(other, frame)
        return math.hypot(x - u, y - v)

    def is_lit(self, light, frame):
        return at_frame(light.get("on", True), frame) and at_frame(light["value"], frame)[1] > 0

    def test_the_same_seed_gives_the_same_frames(self):
        names = [f"plate.{FIRST + k}.exr" for k in (0, 2)] + ["true-lights.toml"]
        for folder in ("a", "b"):
            self.make(self.folder / folder, 3)
        for name in names:
            self.assertEqual((self.folder / "a" / name).read_bytes(), (self.folder / "b" / name).read_bytes())

    def test_lights_keep_their_names(self):
        """A tracked light is one true light in all frames, also where two of them cross or one passes a pole."""
        tracked, true = self.lights("lights.toml"), self.lights("true-lights.toml")
        by_name = {light["name"]: light for light in true}
        for name in ("bicycle", "taxi sign", "lamp 1", "lamp 2", "lamp 3", "lamp 4", "moon", "headlight left"):
            self.assertIn(name, by_name)
        for light in tracked:
            names = {}
            for frame in NUMBERS:
                if not self.is_lit(light, frame):
                    continue
                near = sorted((self.distance(light, other, frame), other["name"]) for other in true if self.is_lit(other, frame))
                if near[0][0] < 1.5 and near[1][0] > 4:  # no doubt which one it is
                    names.setdefault(near[0][1], []).append(frame)
            self.assertLessEqual(len(names), 1, f"{light['name']} is {names}")

    def test_crossing_lights_are_followed_to_the_end(self):
        """Wherever it stands alone, from before the crossing to after it, a light is the same tracked one."""
        tracked, true = self.lights("lights.toml"), {light["name"]: light for light in self.lights("true-lights.toml")}
        for name in ("bicycle", "taxi sign"):
            found = {}
            for frame in filter(lambda f: self.is_lit(true[name], f), NUMBERS):
                others = [light for light in true.values() if light["name"] != name and self.is_lit(light, frame)]
                if min(self.distance(true[name], other, frame) for other in others) < 5:
                    continue
                distance, nearest = min((self.distance(true[name], light, frame), light["name"])
                                        for light in tracked if self.is_lit(light, frame))
                self.assertLess(distance, 1.0, f"{name} in frame {frame}")
                found.setdefault(nearest, []).append(frame)
            self.assertEqual(len(found), 1, f"{name}: {found}")
            frames, = found.values()
            self.assertLess(frames[0], FIRST + 15)  # they cross in the thirtieth frame
            self.assertGreater(frames[-1], FIRST + 33)

    def test_flare_has_no_step_that_the_lights_have_not(self):
        numbers = NUMBERS[17:33]  # the crossing, and the headlights' sweep
        self.run_program("apply", "heliar", "-f", "8", "--error", "0.003", "plate.####.exr", "-o", "out.####.exr", "--flare-only",
                         "flare.####.exr", "--lights", "lights.toml", "--frames", f"{numbers[0]}-{numbers[-1]}")
        flare = [exr.Picture(self.folder / f"flare.{frame}.exr").total() for frame in numbers]
        tracked = self.lights("lights.toml")
        flux = [[at_frame(light["value"], frame)[1] if self.is_lit(light, frame) else 0.0 for light in tracked]
                for frame in numbers]
        mean_flare, mean_flux = sum(flare) / len(flare), sum(map(sum, flux)) / len(flux)
        for k in range(1, len(numbers)):
            step = abs(flare[k] - flare[k - 1]) / mean_flare
            of_lights = sum(abs(a - b) for a, b in zip(flux[k], flux[k - 1])) / mean_flux
            self.assertLess(step, 0.03 + 1.3 * of_lights, f"frame {numbers[k]}")


if __name__ == "__main__":
    unittest.main()
