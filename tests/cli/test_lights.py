#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""lights track and lights import: from frames and tracks to files that apply uses."""
import json
import math
import tomllib
import unittest

import exr
from keys import at_frame
from program import ProgramTest

WIDTH, HEIGHT = 96, 64
LENS = ["heliar", "-f", "8", "--error", "0.003"]


class Lights(ProgramTest):
    def write_frame(self, number, lights, name="plate.{:04d}.exr", width=WIDTH, **more):
        """lights: x, y of a pixel and its level; half of it in the four pixels beside it."""
        values = [0.01] * (width * HEIGHT)
        for x, y, level in lights:
            for dx, dy, part in ((0, 0, 1), (1, 0, 0.5), (-1, 0, 0.5), (0, 1, 0.5), (0, -1, 0.5)):
                if 0 <= x + dx < width and 0 <= y + dy < HEIGHT:
                    values[(y + dy) * width + x + dx] += level * part
        exr.write(self.folder / name.format(number), {c: (exr.HALF, values) for c in "RGB"}, width, HEIGHT, **more)

    def track(self, *arguments, code=0):
        return self.run_program("lights", "track", "plate.####.exr", "-o", "lights.toml", *arguments, code=code)

    def read(self, name="lights.toml"):
        return tomllib.loads((self.folder / name).read_text())

    def test_track_look_correct_and_apply(self):
        """Two lights cross; one of them goes behind something, and the last frame has only the other."""
        for frame in range(1, 13):
            lights = [(4 + 7 * frame, 20, 900.0)] if frame not in (8, 9) else []
            lights.append((90 - 7 * frame, 24, 700.0))
            self.write_frame(frame, lights)
        report = json.loads(self.track("--json", "--search", "0.1").stdout)
        self.assertEqual((report["lights"], report["frames"], report["left_out"]), (2, 12, 0))
        shot = self.read()
        self.assertFalse(shot["parameters"]["detect"])
        first, second = sorted(shot["light"], key=lambda light: -at_frame(light["value"], 1)[0])
        for frame in range(1, 13):
            for light, x, y in ((first, 4.5 + 7 * frame, 20.5), (second, 90.5 - 7 * frame, 24.5)):
                u, v = at_frame(light["at"], frame)
                self.assertAlmostEqual(u * WIDTH, x, delta=0.11)
                self.assertAlmostEqual(v * HEIGHT, y, delta=0.11)
        self.assertNotIn("on", second)
        self.assertAlmostEqual(at_frame(first["value"], 1)[1], 3 * 900, delta=30)
        self.assertAlmostEqual(at_frame(first["value"], 8)[1], 2 / 3 * 3 * 900, delta=30)  # fading
        # A light that is added by hand, and the file used: no light is detected, three are given.
        text = (self.folder / "lights.toml").read_text()
        (self.folder / "lights.toml").write_text(text + '\n[[light]]\nname = "sun"\nat = [1.2, -0.1]\nvalue = 1e5\n')
        done = self.run_program("apply", *LENS, "plate.####.exr", "-o", "out.####.exr", "--frames", "1-2", "--lights", "lights.toml", "--json")
        for line in done.stdout.decode().splitlines():
            frame = json.loads(line)
            self.assertEqual((frame["lights"], len(frame["given_lights"])), ([], 3))

    def test_the_same_light_as_detection_finds(self):
        """A light that stays has the flare of apply's own detection."""
        for frame in (1, 2, 3):
            self.write_frame(frame, [(60, 20, 900.0)])
        self.track("--threshold", "2")
        common = ["apply", *LENS, "plate.0001.exr", "-o", "out.exr", "--flare-only"]
        self.run_program(*common, "detected.exr", "--threshold", "2", "--no-light-shape")
        self.run_program(*common, "tracked.exr", "--lights", "lights.toml")
        detected = exr.Picture(self.folder / "detected.exr").channels["G"]
        tracked = exr.Picture(self.folder / "tracked.exr").channels["G"]
        self.assertGreater(max(detected), 0)
        self.assertLess(max(abs(a - b) for a, b in zip(detected, tracked)), 0.01 * max(detected))

    def test_a_data_window_and_sizes(self):
        for frame in (1, 2, 3):
            self.write_frame(frame, [(30, 20, 900.0)], origin=(10, 5), display=(0, 0, 200, 100))
        self.track("--hfov", "40")
        light = self.read()["light"][0]
        u, v = at_frame(light["at"], 1)
        self.assertAlmostEqual(u * 200, 40.5, delta=0.06)
        self.assertAlmostEqual(v * 100, 25.5, delta=0.06)
        # The mean squared radius of five pixels with weights 1 and 1/2: 2/3; a disc of diameter 2 sqrt(2 * 2/3) pixels.
        pixel = 2 * math.tan(math.radians(20)) / 200
        self.assertAlmostEqual(at_frame(light["size"], 1), math.degrees(2 * math.sqrt(2 * 2 / 3) * pixel), delta=0.02)

    def test_missing_frames_and_bad_ones(self):
        for frame in (1, 2, 3, 5, 6):
            self.write_frame(frame, [(10 + 6 * frame, 20, 900.0)])
        self.assertIn("frames 4 are missing", self.error_of("lights", "track", "plate.####.exr", "-o", "l.toml", "--frames", "1-6", code=1))
        self.track("--frames", "1-6", "--missing", "skip", "--search", "0.2")
        self.assertEqual(len(self.read()["light"]), 1)
        self.assertNotIn("on", self.read()["light"][0])
        self.write_frame(3, [(28, 20, 900.0)], width=WIDTH + 2)
        error = self.error_of("lights", "track", "plate.####.exr", "-o", "l.toml", code=1)
        self.assertIn("frame 3: the picture has 98 x 64 pixels", error)
        (self.folder / "plate.0003.exr").write_bytes(b"no picture")
        self.assertIn("frame 3: plate.0003.exr", self.error_of("lights", "track", "plate.####.exr", "-o", "l.toml", "--threshold", "2", code=1))
        self.assertIn("name of a sequence", self.error_of("lights", "track", "plate.0001.exr", "-o", "l.toml", code=1))
        self.assertNotIn("l.toml", self.files())

    def test_no_light(self):
        for frame in (1, 2):
            self.write_frame(frame, [])
        self.assertIn("--threshold", self.error_of("lights", "track", "plate.####.exr", "-o", "l.toml", code=1))

    def test_import_and_apply(self):
        (self.folder / "tracks.txt").write_text("1001 0.5 63.5\n1003 48 32\n")
        self.run_program("lights", "import", "tracks.txt", "--size", "96x64", "--value", "50000", "-o", "lights.toml")
        light = self.read()["light"][0]
        self.assertEqual([x * s for x, s in zip(at_frame(light["at"], 1001), (96, 64))], [0.5, 0.5])
        self.assertEqual(at_frame(light["at"], 1003), [0.5, 0.5])
        self.write_frame(1002, [])
        self.run_program("apply", *LENS, "plate.####.exr", "-o", "out.####.exr", "--lights", "lights.toml")
        self.assertIn("out.1002.exr", self.files())

    def test_import_a_camera(self):
        (self.folder / "camera.chan").write_text("1 0 0 0 0 0 0 20\n2 0 0 0 0 -5 0 20\n")
        (self.folder / "lamps.csv").write_text("name,x,y,z\nlamp,1,0,-10\nbehind,0,0,5\n")
        done = self.run_program("lights", "import", "camera.chan", "--points", "lamps.csv", "--unit", "1m", "--size", "1920x1080", "-o", "lights.toml")
        self.assertIn("behind", done.stderr.decode())
        shot = self.read()
        (lamp,) = shot["light"]
        angle = math.degrees(math.atan(0.1))
        self.assertAlmostEqual(at_frame(lamp["direction"], 1)[0], angle, places=9)
        self.assertAlmostEqual(at_frame(lamp["direction"], 2)[0], angle - 5, places=9)
        self.assertAlmostEqual(lamp["distance"], 1000 * math.hypot(1, 10), places=6)
        self.assertAlmostEqual(shot["parameters"]["hfov"], 2 * math.degrees(math.atan(16 / 9 * math.tan(math.radians(10)))), places=9)
        rendered = self.run_program("apply", *LENS, self.black(), "-o", "out.exr", "--lights", "lights.toml", "--value", "5000", "--json")
        (given,) = json.loads(rendered.stdout)["given_lights"]
        self.assertAlmostEqual(given["azimuth_deg"], angle, places=6)
        self.assertAlmostEqual(given["elevation_deg"], 0, places=6)

    def black(self):
        self.write_frame(1, [], name="black.exr")
        return "black.exr"

    def test_import_errors(self):
        (self.folder / "a.txt").write_text("hello\n")
        (self.folder / "b.txt").write_text("1 2 3\n2 2\n")
        (self.folder / "c.chan").write_text("1 0 0 0 0 0 0\n")
        base = ["--size", "96x64", "-o", "l.toml"]
        self.assertIn("--format", self.error_of("lights", "import", "a.txt", *base, code=1))
        self.assertIn("b.txt:2: frame 2", self.error_of("lights", "import", "b.txt", *base, code=1))
        self.assertIn("--points", self.error_of("lights", "import", "c.chan", *base, code=1))
        self.assertIn("none.txt", self.error_of("lights", "import", "none.txt", *base, code=1))
        (self.folder / "good.txt").write_text("1 2 3\n")
        self.assertIn("brightness", self.error_of("lights", "import", "good.txt", *base, "--value", "x", code=1))
        self.assertEqual([name for name in self.files() if name.endswith(".toml")], [])


if __name__ == "__main__":
    unittest.main()
