# SPDX-License-Identifier: Apache-2.0
"""Numbered plates, OpenColorIO's views and photographs of a measured flare with real clicks; frames against `contrejour apply`, pixels by hand."""
import json
import math
import os
import pathlib
import shlex
import shutil
import struct
import subprocess
import zlib

from studio_program import PROGRAM, StudioTest, exr, read_exr, run_tests, scene

CONFIG = """ocio_profile_version: 2
roles: {scene_linear: lin_rec709, default: lin_rec709}
displays:
  Projector:
    - !<View> {name: Half, colorspace: half}
    - !<View> {name: Raw, colorspace: lin_rec709}
colorspaces:
  - !<ColorSpace>
    name: lin_rec709
  - !<ColorSpace>
    name: half
    from_scene_reference: !<MatrixTransform> {matrix: [0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1]}
"""


def grey_png(code, width=48, height=32):
    """An 8-bit RGB PNG of one grey, from the PNG specification."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    rows = (b"\0" + bytes([code]) * 3 * width) * height
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


class Sequence(StudioTest):
    def command(self, *words):
        done = subprocess.run([PROGRAM, *words], cwd=self.folder, capture_output=True, timeout=120)
        self.assertEqual(done.returncode, 0, done.stderr.decode())

    def test_numbered_plates_are_scrubbed_and_exported_as_apply_makes_them(self):
        for frame in (5, 6, 8):
            self.command("render", "heliar", "--starburst", "--light-at", f"0.{frame},0.4:30000", "--size", "64x40", "-o", f"plate.{frame:04d}.exr")
        lines = [["click", "toolbar/plate"], ["frames", 4], ["type", "plate.0006.exr"], ["frames", 2], ["click", "dialog/sequence"], ["frames", 2],
                 ["state", "dialog.json"], ["screenshot", "dialog.png"], ["click", "dialog/accept"], ["wait"], ["key", "f11"], ["frames", 3], ["key", "k"], ["frames", 2],
                 ["key", "."], ["wait"], ["state", "six.json"], ["picture", "six.exr"], ["key", "."], ["wait"], ["state", "seven.json"], ["screenshot", "seven.png"],
                 ["click", "timeline/ruler", 1.0, 0.5], ["wait"], ["drag", "viewport/light/1", 40, 20, 4], ["wait"],
                 ["key", "space"], ["wait"], ["state", "playing.json"], ["key", "space"], ["wait"], ["key", "ctrl+s"], ["wait"],
                 ["key", "ctrl+e"], ["frames", 4], ["click", "export/kind/Frames"], ["frames", 4], ["state", "export.json"], ["click", "dialog/accept"], ["wait"]]
        state = self.state_after(lines, window="1000x720")
        self.assertEqual(self.widget(self.state("dialog.json"), "dialog/path")["value"], "plate.####.exr")
        six, seven, playing = self.state("six.json"), self.state("seven.json"), self.state("playing.json")
        self.assertEqual((six["frame_of_shot"], six["plate_frames"]), (6, [5, 6, 8]))
        self.assertTrue(six["plate"].endswith("/plate.####.exr"))
        self.assertIn("frame 7 of the plate is missing", seven["problem"])
        self.assertEqual(playing["cached_frames"], 4)
        self.assertEqual(state["message"], "wrote 3 of 4 frames; the plate has no frames 7")
        command = shlex.split(self.widget(self.state("export.json"), "export/session-command")["value"])
        self.assertEqual(command[1:], ["apply", "--session", "start.session.json", "--frames", "5-8", "--missing", "skip", "-o", "flare.####.exr"])
        self.command(*command[1:-1], "cli.####.exr")
        pictures = [read_exr(self.folder / f"cli.{frame:04d}.exr") for frame in (5, 6, 8)]
        self.assertEqual(pictures, [read_exr(self.folder / f"flare.{frame:04d}.exr") for frame in (5, 6, 8)])
        self.assertNotEqual(pictures[0], pictures[1])
        self.assertFalse((self.folder / "flare.0007.exr").exists())


class ColourViews(StudioTest):
    def test_a_view_of_the_configuration_changes_the_pixels_not_the_picture(self):
        (self.folder / "show.ocio").write_text(CONFIG)
        (self.folder / "grey.png").write_bytes(grey_png(188))  # 0.5029 by IEC 61966-2-1
        (self.folder / "start.session.json").write_text(scene(**{"light-at": ["0.3,0.3:0.000001"], "detect": "off"}))
        away = [["move", "viewport/picture", 0.5, 0.5], ["frames", 3]]
        lines = [["click", "toolbar/plate"], ["frames", 4], ["type", "grey.png"], ["key", "enter"], ["wait"], ["key", "h"], *away, ["picture", "before.exr"],
                 ["screenshot", "before.png"], ["click", "viewport/transform"], ["wait"], ["frames", 3], ["screenshot", "menu.png"], ["state", "menu.json"],
                 ["click", "viewport/transform/Projector/Half"], ["wait"], *away, ["screenshot", "half.png"], ["picture", "half.exr"], ["state", "half.json"],
                 ["key", "="], ["key", "="], ["wait"], *away, ["screenshot", "brighter.png"], ["key", "ctrl+s"], ["wait"]]
        self.environment_more = {"OCIO": str(self.folder / "show.ocio")}
        state = self.state_after(lines, window="800x560")
        half = self.state("half.json")
        x0, y0, x1, y1 = (int(v) for v in self.widget(half, "viewport/picture")["rect"])
        at = lambda name: self.picture(name)[2][(3 * y0 + y1) // 4][3 * (x0 + 20)]
        self.assertEqual(at("before.png"), 188)
        self.assertEqual(at("half.png"), round(255 * 0.5 * 0.5029))
        self.assertEqual(at("brighter.png"), round(255 * 0.5 * 0.5029 * 2))
        self.assertEqual(read_exr(self.folder / "before.exr"), read_exr(self.folder / "half.exr"))
        self.assertIn("R 0.5029", self.widget(half, "status/probe")["value"])
        self.assertEqual(self.widget(half, "viewport/transform")["value"], "Projector/Half")
        self.assertEqual(json.loads((self.folder / "start.session.json").read_text())["studio-view"]["colour-view"], ["Projector", "Half"])
        self.assertEqual(state["problem"], "")


FLARE = """name = "One disc"
s_max = 0.3
half_field = [0.36, 0.24]

[[ghosts]]
name = "1"
last = 0.3
centre = [-0.6]
half_width = [0.03]
half_height = [0.03]
width_in = [0.002]
width_out = [0.002]
"""


class Photographs(StudioTest):
    def write_sweep(self):
        """The disc of FLARE, half as wide, at five angles: a camera of 120 x 80 pixels, a light of 1000 DN per second."""
        levels = "".join(f"{part}_{colour} = [1.0]\n" for part in ("border", "inside") for colour in ("red", "green", "blue"))
        (self.folder / "disc.flare.toml").write_text(FLARE + levels)
        (self.folder / "merged").mkdir()
        width, height, focal = 120, 80, 60 / 0.36
        for k in range(5):
            angle = 6 * (k - 2)
            s = math.tan(math.radians(angle))
            def level(x, y):
                return 1000 / focal ** 2 if math.hypot(x + 0.5 - width / 2 + 0.6 * s * focal, y + 0.5 - height / 2) < 0.015 * focal else 0
            disc = [level(x, y) for y in range(height) for x in range(width)]
            ones = [1.0] * (width * height)
            channels = {c: (exr.FLOAT, disc) for c in "RGB"}
            channels.update({f"{layer}.{c}": (exr.FLOAT, ones) for layer in ("variance", "valid") for c in "RGB"})
            texts = {"headAngleDegrees": f"{angle}", "directImage": f"{width / 2 + focal * s},{height / 2},1000,1000,1000"}
            exr.write(self.folder / "merged" / f"station-{k + 1:04d}.exr", channels, width, height,
                      extra=[(name, "string", text.encode()) for name, text in texts.items()])

    def test_photographs_lie_beside_their_fit(self):
        self.write_sweep()
        lines = [["key", "ctrl+o"], ["frames", 4], ["type", "disc.flare.toml"], ["key", "enter"], ["wait"], ["click", "measured/sweep"], ["frames", 4],
                 ["type", str(self.folder / "merged")], ["key", "enter"], ["wait"], ["drag", "measured/photographs", 0, 14, 3, 0.5, 0.7], ["wait"],
                 ["move", "status", 0.1, 0.5], ["frames", 2], ["screenshot", "photographs.png"]]
        state = self.state_after(lines, window="1200x700")
        self.assertEqual(state["problem"], "")
        self.assertEqual(self.widget(state, "measured/read")["value"], "5 of 5 photographs of merged")
        self.assertEqual(self.widget(state, "measured/captured")["value"], "photograph 5")
        self.assertAlmostEqual(float(self.widget(state, "measured/photographs")["value"]), 12, delta=0.1)
        if os.environ.get("CONTREJOUR_WRITE_PICTURES"):
            shutil.copy(self.folder / "photographs.png", pathlib.Path(__file__).resolve().parents[2] / "docs" / "pictures" / "studio")
        picture = self.picture("photographs.png")
        # Where the disc is twice as wide in the fit as in the photograph, its rim is left.
        def lit(name):
            x0, y0, x1, y1 = (int(v) for v in self.widget(state, f"measured/{name}")["rect"])
            return sum(picture[2][y][3 * x + 1] > 60 for y in range(y0 + 18, y1 - 2) for x in range(x0 + 2, x1 - 2))
        captured, fitted, residual = lit("captured"), lit("fitted"), lit("residual")
        self.assertGreater(captured, 5)
        self.assertAlmostEqual(fitted / captured, 4, delta=1.5)
        self.assertAlmostEqual(residual, fitted - captured, delta=0.4 * fitted)
        self.assertEqual([w["id"] for w in state["widgets"] if w["clipped"] and w["id"].startswith("measured")], [])


if __name__ == "__main__":
    run_tests()
