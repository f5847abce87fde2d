# SPDX-License-Identifier: Apache-2.0
"""The two minutes of docs/studio.md, step by step, and its panels. With CONTREJOUR_WRITE_PICTURES=1 the screenshots become the page's;
CONTREJOUR_STREET then names the plate, street.exr of contrejour-demo, and CONTREJOUR_FOOTAGE the folder of its footage."""
import os
import pathlib
import shutil
import subprocess
import unittest

from studio_program import PROGRAM, StudioTest, read_exr, run_tests, scene

PICTURES = pathlib.Path(__file__).resolve().parents[2] / "docs" / "pictures" / "studio"
WRITES = bool(os.environ.get("CONTREJOUR_WRITE_PICTURES"))
# The first scene in a smaller picture, which is quicker to render.
FIRST_SCENE = {"size": "320x180", "light-at": ["0.22,0.25:4000:5200K"], "coating": "quarter-wave:400:1.38", "blades": "7", "exposure": "6.2",
               "coating-at": ["6:quarter-wave:640:1.38", "11:quarter-wave:700:1.38", "13:quarter-wave:660:1.38",
                              "14:quarter-wave:480:1.38", "16:quarter-wave:560:1.38"]}
NAMES = ("start", "ghost", "coatings", "export")
PANELS = ("plate", "looks", "iris", "compare", "timeline", "measured")
# Three ghosts of a flare as `measure fit` writes them.
MEASURED = """
[[ghosts]]
name = "{name}"
last = 0.3
centre = [{speed}]
half_width = [{size}]
half_height = [{size}, {growth}]
width_in = [0.002]
width_out = [0.002]
border_red = [{red}]
border_green = [{green}]
border_blue = [{blue}]
inside_red = [{red}]
inside_green = [{green}]
inside_blue = [{blue}]
"""


class Tour(StudioTest):
    def test_two_minutes(self):
        lines = [["wait"], ["move", "status", 0.1, 0.5], ["frames", 2], ["screenshot", "start.png"], ["state", "start.json"],
                 ["drag", "viewport/light/1", 48, 24, 6], ["wait"],
                 ["click", "viewport/picture", 0.763, 0.576], ["wait"], ["move", "status", 0.1, 0.5], ["frames", 2], ["screenshot", "ghost.png"],
                 ["state", "ghost.json"], ["click", "section/surface/11"], ["key", "f4"], ["frames", 4], ["click", "coatings/design"],
                 ["frames", 3], ["click", "coatings/design/v-coat"], ["wait"], ["move", "status", 0.1, 0.5], ["frames", 2],
                 ["screenshot", "coatings.png"], ["state", "coatings.json"], ["key", "ctrl+e"], ["frames", 4], ["screenshot", "export.png"],
                 ["state", "export.json"], ["key", "enter"], ["wait"], ["picture", "shown.exr"], ["state", "end.json"]]
        if WRITES:
            self.run_studio(lines, start=None, window="1200x700")
        else:
            (self.folder / "small.session.json").write_text(scene("distagon-25", **FIRST_SCENE))
            self.run_studio(lines, start="small.session.json", window="1200x700")
        start, ghost, coatings, export, end = (self.state(f"{name}.json") for name in (*NAMES, "end"))
        self.assertEqual(start["shown"]["kind"], "refined")
        self.assertNotEqual(ghost["lights"], start["lights"])
        surfaces = ghost["selection"]["ghost"].split("-")
        self.assertIn("11", surfaces)
        self.assertIn(f"surface {surfaces[1]}, then at {surfaces[0]}", self.widget(ghost, "section/legend")["value"])
        self.assertIn("11:v-coat", coatings["values"]["coating-at"])
        changed = [g for g in coatings["ghosts"] if "11" in g["ghost"].split("-")]
        before = {g["ghost"]: g["flux"] for g in ghost["ghosts"]}
        self.assertTrue(all(g["flux"] < before[g["ghost"]] for g in changed[:3]))
        self.assertIn("--coating-at 11:v-coat", self.widget(export, "export/command")["value"])
        self.assertTrue(end["message"].startswith("wrote ") and end["message"].endswith("/flare.exr"))
        self.assertEqual(read_exr(self.folder / "flare.exr"), read_exr(self.folder / "shown.exr"))
        if WRITES:
            PICTURES.mkdir(parents=True, exist_ok=True)
            for name in NAMES:
                shutil.copy(self.folder / f"{name}.png", PICTURES)

    def test_panels(self):
        self.write_files()
        away = [["move", "status", 0.1, 0.5], ["frames", 3]]
        lines = [["wait"], ["key", "f9"], ["frames", 4], ["wait"], *away, ["screenshot", "looks.png"],
                 ["key", "f10"], ["frames", 4], ["wait"], *away, ["screenshot", "iris.png"],
                 ["key", "f12"], ["key", "c"], ["frames", 3], ["drag", "viewport/light/1", 60, 24, 5], ["wait"], ["key", "w"], ["wait"], *away,
                 ["screenshot", "compare.png"], ["key", "w"],
                 ["key", "f11"], ["key", "f6"], ["key", "k"], ["frames", 3], ["click", "timeline/ruler", 0.6, 0.5], ["wait"],
                 ["drag", "viewport/light/1", 130, -30, 6], ["wait"], ["click", "timeline/ruler", 0.98, 0.5], ["wait"],
                 ["drag", "viewport/light/1", 60, 90, 6], ["wait"], *away, ["screenshot", "timeline.png"], ["state", "timeline.json"],
                 ["key", "ctrl+o"], ["frames", 4], ["type", "three.flare.toml"], ["key", "enter"], ["wait"], ["drag", "measured/kymograph", 0, 18, 4, 0.5, 0.6],
                 ["wait"], *away, ["screenshot", "measured.png"], ["state", "measured.json"],
                 ["click", "toolbar/plate"], ["frames", 4], ["type", os.environ.get("CONTREJOUR_STREET", "plate.exr") if WRITES else "plate.exr"], ["key", "enter"],
                 ["wait"], ["key", "shift+l"], ["wait"], ["key", "f2"], ["key", "f6"], ["frames", 3], ["click", "viewport/auto-exposure"], ["wait"], *away,
                 ["screenshot", "plate.png"], ["state", "plate.json"]]
        self.run_studio(lines, start=None if WRITES else "small.session.json", window="1200x700")
        timeline, measured, plate = (self.state(f"{name}.json") for name in ("timeline", "measured", "plate"))
        self.assertEqual(len(timeline["tracks"]["light 1 position"]), 3)
        self.assertIn("3 ghosts", self.widget(measured, "measured/title")["value"])
        self.assertGreater(float(self.widget(measured, "measured/kymograph")["value"]), 0)
        self.assertEqual(self.widget(measured, "measured/curves")["value"], "3")
        self.assertIn("lights/plate", [w["id"] for w in plate["widgets"]])
        if WRITES:
            for name in PANELS:
                shutil.copy(self.folder / f"{name}.png", PICTURES)

    def write_files(self):
        (self.folder / "small.session.json").write_text(scene("distagon-25", **{**FIRST_SCENE, "size": "160x90"}))
        ghosts = [("1", -0.6, 0.030, 0.0, 0.9, 0.5, 0.2), ("2", 0.35, 0.018, 0.1, 0.3, 0.7, 0.9), ("3", -1.4, 0.045, -0.15, 0.25, 0.2, 0.4)]
        keys = ("name", "speed", "size", "growth", "red", "green", "blue")
        text = 'name = "Three ghosts"\ns_max = 0.3\nhalf_field = [0.36, 0.24]\n' + "".join(MEASURED.format(**dict(zip(keys, g))) for g in ghosts)
        (self.folder / "three.flare.toml").write_text(text)
        subprocess.run([PROGRAM, "render", "heliar", "--starburst", "--light-at", "0.6,0.4:30000", "--size", "96x64", "-o", "plate.exr"],
                       cwd=self.folder, check=True, capture_output=True, timeout=60)

    @unittest.skipUnless(WRITES, "writes the page's pictures of numbered plates; test_plate_frames.py checks them")
    def test_write_pictures_of_a_shot(self):
        plate = sorted(pathlib.Path(os.environ["CONTREJOUR_FOOTAGE"]).glob("plate.*.exr"))[0]
        away = [["move", "status", 0.1, 0.5], ["frames", 3]]
        self.run_studio([["wait"], ["click", "toolbar/plate"], ["frames", 4], ["type", str(plate)], ["frames", 3], ["click", "dialog/sequence"],
                         ["frames", 3], ["click", "dialog/accept"], ["wait"], ["key", "shift+l"], ["wait"], ["key", "f11"], ["frames", 3],
                         ["click", "timeline/ruler", 0.5, 0.5], ["wait"], ["click", "viewport/auto-exposure"], ["wait"], *away,
                         ["click", "viewport/transform"], ["wait"], ["frames", 3], ["screenshot", "sequence.png"]],
                        start=None, window="1200x700")
        shutil.copy(self.folder / "sequence.png", PICTURES)

    def test_the_page_has_its_pictures(self):
        sizes = [(PICTURES / f"{name}.png").stat().st_size for name in (*NAMES, *PANELS, "sequence", "photographs")]
        self.assertLess(sum(sizes), 3 << 20)


if __name__ == "__main__":
    run_tests()
