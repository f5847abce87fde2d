# SPDX-License-Identifier: Apache-2.0
"""Plates, looks, iris, comparison, timeline and exports with real clicks; pictures and frames against the command line's."""
import json
import subprocess

from studio_program import PROGRAM, StudioTest, read_exr, run_tests, scene


class PanelTest(StudioTest):
    def command(self, *words):
        done = subprocess.run([PROGRAM, *words], cwd=self.folder, capture_output=True, timeout=120)
        self.assertEqual(done.returncode, 0, done.stderr.decode())

    def plate(self):
        self.command("render", "heliar", "--starburst", "--light-at", "0.6,0.4:30000", "--size", "96x64", "-o", "plate.exr")


class Plates(PanelTest):
    def test_the_plate_of_a_session_is_the_command_lines_bit_for_bit(self):
        self.plate()
        lines = [["click", "toolbar/plate"], ["frames", 4], ["type", "plate.exr"], ["key", "enter"], ["wait"], ["key", "shift+l"], ["wait"],
                 ["key", "f6"], ["frames", 3], ["drag", "viewport/light/1", 30, 20, 4], ["wait"], ["key", "ctrl+s"], ["wait"], ["picture", "shown.exr"]]
        state = self.state_after(lines)
        self.assertIn("open plate plate.exr", state["history"]["steps"])
        self.assertIn("detect 1 light", state["history"]["steps"])
        self.assertTrue(state["history"]["saved"], state["message"])
        self.assertEqual((state["shown"]["width"], state["shown"]["height"]), (96, 64))
        self.assertEqual(self.widget(state, "lights/plate")["value"], str(self.folder / "plate.exr"))
        self.assertEqual(json.loads((self.folder / "start.session.json").read_text())["plate"], {"file": "plate.exr"})
        self.command("apply", "--session", "start.session.json", "-o", "cli.exr")
        self.assertEqual(read_exr(self.folder / "cli.exr"), read_exr(self.folder / "shown.exr"))
        self.assertNotEqual(read_exr(self.folder / "cli.exr"), read_exr(self.folder / "plate.exr"))

    def test_a_session_without_a_plate_needs_a_photograph(self):
        done = subprocess.run([PROGRAM, "apply", "--session", "start.session.json", "-o", "out.exr"], cwd=self.folder, capture_output=True, timeout=60)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("the session has no plate", done.stderr.decode())


class Looks(PanelTest):
    def test_looks_have_pictures_and_a_click_takes_one(self):
        lines = [["key", "f9"], ["frames", 4], ["wait"], ["state", "looks.json"], ["click", "looks/Press camera"], ["wait"], ["state", "taken.json"],
                 ["click", "looks/name"], ["type", "Mine"], ["key", "enter"], ["wait"]]
        state = self.state_after(lines, window="1280x720")
        tiles = [w for w in self.state("looks.json")["widgets"] if w["id"].startswith("looks/") and w["value"] == "rendered"]
        self.assertEqual(len(tiles), 11)
        taken = self.state("taken.json")
        self.assertEqual(taken["history"]["steps"][-1], "look Press camera")
        self.assertEqual(taken["values"]["light-at"], ["0.3,0.3:20000"])
        self.assertTrue((self.folder / "data" / "contrejour" / "looks" / "Mine.toml").exists())
        self.assertEqual(state["thumbnails"], 12)


class Iris(PanelTest):
    def test_blades_are_set_beside_their_pupil(self):
        lines = [["key", "f10"], ["frames", 4], ["wait"], ["state", "before.json"], ["drag", "parameters/blades", 60, 0, 6, 0.3, 0.5], ["wait"]]
        state = self.state_after(lines, window="1280x720")
        self.assertNotIn("blades", self.state("before.json")["values"])
        self.assertGreater(int(state["values"]["blades"][0]), 2)
        self.assertIn("clear", self.widget(state, "iris/pupil")["value"])
        self.assertIn("wide", self.widget(state, "iris/spread")["value"])
        self.assertEqual(state["history"]["steps"][-1], "set blades")


class Compare(PanelTest):
    def test_a_wipe_shows_the_snapshot_to_the_left_of_the_edge(self):
        (self.folder / "start.session.json").write_text(scene(exposure="5"))
        hide = [["move", "status", 0.1, 0.5], ["frames", 3]]
        lines = [["key", "f12"], ["key", "h"], ["frames", 3], ["click", "compare/take"], ["wait"], *hide, ["screenshot", "before.png"],
                 ["key", "h"], ["frames", 2], ["drag", "viewport/light/1", 90, 40, 5], ["wait"], ["key", "h"], *hide, ["screenshot", "after.png"], ["key", "w"], ["wait"],
                 *hide, ["screenshot", "wiped.png"], ["state", "wiped.json"], ["drag", "viewport/wipe", -60, 0, 4], ["wait"], ["state", "dragged.json"],
                 ["click", "compare/mode/2"], ["wait"], ["state", "difference.json"], ["click", "compare/snapshot/1/restore"], ["wait"]]
        state = self.state_after(lines, window="720x540")
        wiped, dragged = self.state("wiped.json"), self.state("dragged.json")
        x0, y0, x1, y1 = (int(round(v)) for v in self.widget(wiped, "viewport/picture")["rect"])
        middle, gap = (x0 + x1) // 2, 6
        labels = self.widget(wiped, "viewport/wipe/labels")
        self.assertEqual(labels["value"], "Snapshot 1")
        end = min(y1 - 3, int(labels["rect"][1]) - 1)
        rows = [self.picture(f"{name}.png")[2] for name in ("before", "after", "wiped")]
        changed = 0
        for y in range(y0 + 3, end):
            left, right = slice(3 * (x0 + 3), 3 * (middle - 2 * gap)), slice(3 * (middle + 2 * gap), 3 * (x1 - 3))
            self.assertEqual(rows[2][y][left], rows[0][y][left])
            self.assertEqual(rows[2][y][right], rows[1][y][right])
            changed += rows[0][y][left] != rows[1][y][left]
        self.assertGreater(changed, 20)
        self.assertAlmostEqual((dragged["compare"]["edge"] - 0.5) * (x1 - x0), -60, delta=2)
        self.assertLess(dragged["compare"]["psnr_db"], 60)
        self.assertEqual(self.state("difference.json")["compare"]["mode"], 2)
        self.assertEqual(state["history"]["steps"][-1], "back to Snapshot 1")
        self.assertTrue(state["compare"]["equal"])


class Timeline(PanelTest):
    def test_keys_are_set_moved_and_played_and_the_frames_are_the_command_lines(self):
        session = json.loads(scene(size="64x40", **{"light-at": ["0.2,0.3:20000"]}))
        (self.folder / "start.session.json").write_text(json.dumps({**session, "studio-view": {"frames": [1, 5]}}))
        lines = [["key", "f11"], ["frames", 3], ["key", "k"], ["frames", 3],
                 ["key", "."], ["key", "."], ["key", "."], ["drag", "viewport/light/1", 60, 30, 4], ["wait"], ["state", "keyed.json"],
                 ["key", "home"], ["wait"], ["state", "first.json"], ["key", "space"], ["wait"], ["sleep", 0.4], ["state", "playing.json"], ["key", "space"], ["wait"],
                 ["key", "ctrl+s"], ["wait"], ["key", "ctrl+e"], ["frames", 4], ["click", "export/kind/Frames"], ["frames", 4], ["state", "dialog.json"],
                 ["click", "export/session-command/copy"], ["frames", 2], ["state", "copied.json"], ["click", "dialog/accept"], ["wait"]]
        state = self.state_after(lines, window="1000x720")
        last = 5
        keyed, first, playing = self.state("keyed.json"), self.state("first.json"), self.state("playing.json")
        self.assertEqual([k[0] for k in keyed["tracks"]["light 1 position"]], [1, 4])
        self.assertEqual(self.widget(keyed, "timeline/last")["value"], "5")
        self.assertAlmostEqual(first["lights"][0]["at"][0], 0.2, delta=1e-9)
        self.assertEqual(len(first["history"]["steps"]), len(keyed["history"]["steps"]))
        self.assertTrue(playing["plays"])
        self.assertEqual(playing["cached_frames"], last)
        command = self.widget(self.state("dialog.json"), "export/session-command")["value"]
        self.assertEqual(self.state("copied.json")["clipboard"], command)
        self.assertEqual(command, f"contrejour render --session start.session.json --frames 1-{last} -o 'flare.####.exr'")
        self.assertEqual(state["message"], f"wrote {last} of {last} frames")
        self.command("render", "--session", "start.session.json", "--frames", f"1-{last}", "-o", "cli.####.exr")
        pictures = []
        for frame in range(1, last + 1):
            pictures.append(read_exr(self.folder / f"cli.{frame:04d}.exr"))
            self.assertEqual(pictures[-1], read_exr(self.folder / f"flare.{frame:04d}.exr"))
        self.assertNotEqual(pictures[0], pictures[2])


class Section(PanelTest):
    def test_a_surface_is_dragged_by_its_middle_and_by_its_rim(self):
        lines = [["wait"], ["state", "before.json"], ["drag", "section/surface/9", 6, 0, 4], ["wait"], ["state", "moved.json"],
                 ["drag", "section/surface/1/rim", 6, 0, 4], ["wait"]]
        state = self.state_after(lines, window="1000x720")
        before, moved = self.state("before.json"), self.state("moved.json")
        self.assertEqual(moved["history"]["steps"][-1], "move surface 9")
        self.assertEqual(moved["radii"], before["radii"])
        self.assertTrue(moved["edited"])
        self.assertEqual(state["history"]["steps"][-1], "bend surface 1")
        self.assertNotEqual(state["radii"][0], before["radii"][0])


class Exports(PanelTest):
    def test_layers_of_the_dialog_are_those_of_its_command(self):
        lines = [["key", "ctrl+e"], ["frames", 4], ["click", "export/kind/Layers"], ["frames", 4], ["state", "dialog.json"], ["click", "dialog/accept"], ["wait"]]
        state = self.state_after(lines, window="1280x720")
        self.assertTrue(state["message"].startswith("wrote ") and state["message"].endswith("/layers.exr"))
        command = self.widget(self.state("dialog.json"), "export/command")["value"].split()
        self.command(*command[1:-1], "cli.exr")
        self.assertEqual(read_exr(self.folder / "cli.exr"), read_exr(self.folder / "layers.exr"))

    def test_the_report_is_one_page(self):
        lines = [["key", "ctrl+e"], ["frames", 4], ["click", "export/kind/Report"], ["frames", 4], ["click", "dialog/accept"], ["wait"]]
        state = self.state_after(lines, window="1280x720")
        self.assertTrue(state["message"].startswith("wrote ") and state["message"].endswith("/report.html"))
        page = (self.folder / "report.html").read_text()
        self.assertEqual(page.count("<img "), 2)
        self.assertNotIn("http", page.replace("http://www.w3.org", ""))


class Layout(PanelTest):
    def test_nothing_of_the_new_panels_is_clipped(self):
        bars = ("toolbar", "tab", "dialog", "export", "looks/name", "looks/save", "iris", "timeline", "compare", "help")
        for scale in ("1", "1.5"):
            lines = [["wait"]]
            for key in ("f9", "f10", "f11", "f12"):
                lines += [["key", key], ["frames", 4], ["key", "c" if key == "f12" else "k"], ["wait"], ["frames", 3], ["state", f"{key}.json"]]
            lines += [["key", "f1"], ["frames", 3], ["state", "f1.json"], ["key", "escape"], ["key", "ctrl+e"], ["frames", 4], ["click", "export/kind/Layers"],
                      ["frames", 4], ["state", "ctrl+e.json"], ["key", "escape"]]
            self.run_studio(lines, "--scale", scale, window="1280x720")
            for key in ("f9", "f10", "f11", "f12", "f1", "ctrl+e"):
                with self.subTest(scale=scale, panel=key):
                    widgets = self.state(f"{key}.json")["widgets"]
                    fixed = [w["id"] for w in widgets if w["clipped"] and w["id"].startswith(bars)]
                    self.assertEqual(fixed, [])
                    outside = [w["id"] for w in widgets if w["id"].startswith(("dialog", "help")) and (w["rect"][1] < 0 or w["rect"][3] > 720)]
                    self.assertEqual(outside, [])


if __name__ == "__main__":
    run_tests()
