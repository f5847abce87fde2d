# SPDX-License-Identifier: Apache-2.0
"""The two minutes of docs/studio.md, step by step. With CONTREJOUR_WRITE_PICTURES=1 its screenshots become the page's."""
import os
import pathlib
import shutil

from studio_program import StudioTest, read_exr, run_tests, scene

PICTURES = pathlib.Path(__file__).resolve().parents[2] / "docs" / "pictures" / "studio"
WRITES = bool(os.environ.get("CONTREJOUR_WRITE_PICTURES"))
# The first scene in a smaller picture, which is quicker to render.
FIRST_SCENE = {"size": "320x180", "light-at": ["0.22,0.25:4000:5200K"], "coating": "quarter-wave:400:1.38", "blades": "7", "exposure": "6.2",
               "coating-at": ["6:quarter-wave:640:1.38", "11:quarter-wave:700:1.38", "13:quarter-wave:660:1.38",
                              "14:quarter-wave:480:1.38", "16:quarter-wave:560:1.38"]}
NAMES = ("start", "ghost", "coatings", "export")


class Tour(StudioTest):
    def test_two_minutes(self):
        lines = [["wait"], ["move", "status", 0.1, 0.5], ["frames", 2], ["screenshot", "start.png"], ["state", "start.json"],
                 ["drag", "viewport/light/1", 48, 24, 6], ["wait"],
                 ["click", "viewport/picture", 0.815, 0.74], ["wait"], ["move", "status", 0.1, 0.5], ["frames", 2], ["screenshot", "ghost.png"],
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
        self.assertEqual(end["message"], "wrote flare.exr")
        self.assertEqual(read_exr(self.folder / "flare.exr"), read_exr(self.folder / "shown.exr"))
        if WRITES:
            PICTURES.mkdir(parents=True, exist_ok=True)
            for name in NAMES:
                shutil.copy(self.folder / f"{name}.png", PICTURES)

    def test_the_page_has_its_pictures(self):
        sizes = [(PICTURES / f"{name}.png").stat().st_size for name in NAMES]
        self.assertLess(sum(sizes), 1 << 20)


if __name__ == "__main__":
    run_tests()
